"""WAITING: what a program waits for, in words, and how the wait ends."""

from __future__ import annotations

from app.desk.translation import tr
from core.executor.snapshot import Snapshot

_ENDS = {
    "AT SPEED": "THE SPINDLE COMES TO ITS SPEED: THE PROGRAM GOES ON BY ITSELF",
    "DWELL": "A DWELL OF THE PROGRAM (G04): IT GOES ON BY ITSELF",
    "COLLET": "THE COLLET MOVES: THE PROGRAM GOES ON BY ITSELF",
    "SPINDLE STOP": "THE SPINDLE COMES TO REST: THE PROGRAM GOES ON BY ITSELF",
    "SPINDLE STOPPED": "THE SPINDLE WAS STOPPED: SWITCH IT OFF AND BACK TO AUTO (A), THEN CYCLE START",
    "SPINDLE SWITCH OFF": "THE SPINDLE SWITCH STANDS AT OFF: A TURNS IT TO AUTO",
    "SPINDLE OVERRIDE AT 0": "THE SPINDLE POT STANDS AT 0: TURN IT UP (.)",
    "FEED OVERRIDE AT 0": "THE FEED POT STANDS AT 0: TURN IT UP (+)",
    "FEED HOLD BEHIND THE TAP": "THE TAP FIRST COMES OUT OF ITS HOLE; E-STOP STOPS IT AT ONCE",
    "GUARD OPEN": "THE GUARD IS OPEN: CLOSE IT",
}
GIVES_UP = "FEED HOLD (PAUSE), THEN R GIVES THE PROGRAM UP"


def waits_for(snapshot: Snapshot) -> str:
    """For the title: what it is, and of an input the state that is waited for."""
    name = snapshot.waiting_for
    if not name or name in _ENDS:
        return name
    if _is_input(snapshot):
        state = tr("OFF") if name in snapshot.inputs else tr("ON")
        return tr("INPUT {name} TO COME {state}").format(name=name, state=state)
    return name


def how_it_ends(snapshot: Snapshot, simulated: bool = False) -> str:
    """For the prompt line; empty where nothing is known of it. ``simulated``: inputs are switched here."""
    name = snapshot.waiting_for
    if not name:
        return ""
    if name in _ENDS:
        return f"{tr(_ENDS[name])}  ·  {tr(GIVES_UP)}"
    if not _is_input(snapshot):
        return ""
    words = tr("THE PROGRAM WAITS FOR {what}").format(what=waits_for(snapshot))
    if simulated:
        words += "  ·  " + tr("F10, 3, RETURN, F4 SWITCHES THE SIMULATED INPUTS")
    return f"{words}  ·  {tr(GIVES_UP)}"


def _is_input(snapshot: Snapshot) -> bool:
    """A wait of M91 to M95 names the input's terminal; all other waits are words of the control's own."""
    return " " not in snapshot.waiting_for
