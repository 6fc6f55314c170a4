"""Conditions for opening a page or a program, checked by the keys and by the page itself.

The original control cancels the spindle-on command when its editor is opened, so that the operator does not
type next to a turning chuck. No command of the executor does only that, because Reset also cancels the
program. TurnDesk therefore refuses to open the editor until the spindle has stopped. While a cycle runs, the
machine uses the program as it was loaded. Another program can be edited and proved during that time, and
Pause, Scroll Lock and Esc stop the machine as on other pages.
"""

from __future__ import annotations

from app.desk.programs.program_loading import Loaded, Phase
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.status.readouts import TURNING
from app.desk.translation import tr
from core.executor.snapshot import CYCLE, Snapshot, State
from core.ports import Unknown

BY_HAND = frozenset({State.JOG, State.HOME})
SLIDES = "AXES ARE MOVING. WAIT UNTIL THEY STOP BEFORE EDITING"
SPINDLE_ON = "SPINDLE IS ON. STOP IT (M05 OR R). EDIT WHEN IT IS AT REST"
SPINDLE_UNKNOWN = "SPINDLE MAY BE TURNING: PRESS E-STOP. DO NOT EDIT NOW"
COASTING = "SPINDLE IS COASTING. WAIT UNTIL IT STOPS BEFORE EDITING"
NO_PROGRAM = "CHOOSE A PROGRAM FIRST (F2), OR TYPE A NEW NAME THERE"
CHOOSING = "PROGRAM RUNNING. LET IT END, OR STOP IT AND PRESS R FIRST"
MOVED = "AXES ARE MOVING. STOP THEM (H) BEFORE CHOOSING A PROGRAM"


def program_barred(snapshot: Snapshot) -> str:
    """Return why another program cannot be chosen. Empty if a program can be chosen."""
    if snapshot.state in BY_HAND:
        return MOVED
    return CHOOSING if snapshot.state in UNDER_WAY else ""


def editor_barred(snapshot: Snapshot, *, named: bool = True) -> str:
    """Return why the editor cannot be opened. Empty if the editor can be opened.

    ``named`` is False if no program is selected.
    """
    if snapshot.state in BY_HAND:
        return SLIDES
    if snapshot.state not in UNDER_WAY:
        if snapshot.rpm_command:
            return SPINDLE_ON
        if Unknown.SPINDLE in snapshot.unknown:
            return SPINDLE_UNKNOWN
        if abs(snapshot.rpm_actual) > TURNING:
            return COASTING
    return "" if named else NO_PROGRAM


def mdi_barred(snapshot: Snapshot) -> str:
    """Return why MDI cannot be opened. Empty if MDI can be opened."""
    if snapshot.state in CYCLE:
        return tr("TO OPEN MDI, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    return ""


def searchto_barred(snapshot: Snapshot, loaded: Loaded) -> str:
    """Return why SEARCHTO cannot be opened or cannot continue. Empty if SEARCHTO is possible."""
    if snapshot.state in CYCLE:
        return tr("TO USE SEARCHTO, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    if loaded.source is None or loaded.job is None:
        return tr("CHOOSE A PROGRAM FIRST (F2)")
    if loaded.phase is not Phase.READY:
        return tr("FIX PROGRAM ERRORS FIRST")
    return ""
