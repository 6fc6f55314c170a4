"""Why a page or a program cannot be opened now: asked by the keys that offer it, and by the page itself.

The control cancels the spindle-on command when its editor is entered, so that nobody writes beside a
turning chuck. No command of the executor does just that (Reset gives the program up as well), so entering is
refused until the spindle has stopped. While a cycle runs the machine has its program as it was loaded:
another one may be written and proved meanwhile, and Pause, Scroll Lock and Esc stop as everywhere.
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
    """Return why no other program can be chosen; empty when one can."""
    if snapshot.state in BY_HAND:
        return MOVED
    return CHOOSING if snapshot.state in UNDER_WAY else ""


def editor_barred(snapshot: Snapshot, *, named: bool = True) -> str:
    """Return why the editor cannot be entered; ``named``: there is a program to edit."""
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
    """Return why MDI cannot be opened; empty when it can."""
    if snapshot.state in CYCLE:
        return tr("TO OPEN MDI, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    return ""


def searchto_barred(snapshot: Snapshot, loaded: Loaded) -> str:
    """Return why SEARCHTO cannot be opened, or does not go on; empty when it can."""
    if snapshot.state in CYCLE:
        return tr("TO USE SEARCHTO, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    if loaded.source is None or loaded.job is None:
        return tr("CHOOSE A PROGRAM FIRST (F2)")
    if loaded.phase is not Phase.READY:
        return tr("FIX PROGRAM ERRORS FIRST")
    return ""
