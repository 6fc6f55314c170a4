"""WAITING: what a program waits for, in words, and how the wait ends."""

from __future__ import annotations

from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages

_ENDS = {
    "AT SPEED": "SPINDLE COMING TO SPEED: PROGRAM CONTINUES AUTOMATICALLY",
    "DWELL": "PROGRAM DWELL (G04): CONTINUES AUTOMATICALLY",
    "COLLET": "COLLET MOVING: PROGRAM CONTINUES AUTOMATICALLY",
    "SPINDLE STOP": "SPINDLE STOPPING: PROGRAM CONTINUES AUTOMATICALLY",
    "SPINDLE STOPPED": ("TURN SPINDLE SWITCH OFF, THEN TO AUTO (A). PRESS CYCLE START"),
    "SPINDLE SWITCH OFF": "SPINDLE SWITCH IS OFF. A: SWITCH TO AUTO",
    "SPINDLE OVERRIDE AT 0": "SPINDLE OVERRIDE IS AT 0. TO RAISE IT, PRESS THE DOT KEY (.)",
    "FEED OVERRIDE AT 0": "FEED OVERRIDE IS AT 0: TURN IT UP (+)",
    "FEED HOLD BEHIND THE TAP": "THE TAP BACKS OUT OF THE HOLE FIRST. E-STOP: STOP AT ONCE",
    "GUARD OPEN": "THE GUARD IS OPEN: CLOSE IT",
}
GIVES_UP = "PAUSE (FEED HOLD), THEN R: CANCEL THE PROGRAM"


def waits_for(snapshot: Snapshot) -> str:
    """For the title: what it is, and of an input the state that is waited for."""
    name = snapshot.waiting_for
    if not name or name in _ENDS:
        return name
    if _is_input(snapshot):
        state = tr("OFF") if name in snapshot.inputs else tr("ON")
        return tr(Message("INPUT {name} TO TURN {state}", name=name, state=state))
    return name


def how_it_ends(snapshot: Snapshot, simulated: bool = False) -> str:
    """For the prompt line; empty where nothing is known of it. ``simulated``: inputs are switched here."""
    name = snapshot.waiting_for
    if not name:
        return ""
    if name in _ENDS:
        return join_messages("  ·  ", (tr(_ENDS[name]), tr(GIVES_UP)))
    if not _is_input(snapshot):
        return ""
    words = tr(Message("PROGRAM WAITING FOR {what}", what=waits_for(snapshot)))
    if simulated:
        words += "  ·  " + tr("F10, 3, ENTER, F4: SWITCH SIMULATED INPUTS")
    return join_messages("  ·  ", (words, tr(GIVES_UP)))


def _is_input(snapshot: Snapshot) -> bool:
    """A wait of M91 to M95 names the input's terminal; all other waits are words of the control's own."""
    return " " not in snapshot.waiting_for
