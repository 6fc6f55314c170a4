"""Conditions for opening a page or a program, which both the keys and the page check.

The original control stops the spindle when its editor is opened, so that the operator does not type next to
a rotating chuck. The executor cannot stop only the spindle, because Reset also cancels the program.
TurnDesk therefore does not open the editor until the spindle has stopped.

While a cycle runs, the machine uses the program as it was loaded. A different program can be edited and
proved during that time. Pause, Scroll Lock and Esc stop the machine as on other pages.
"""

from __future__ import annotations

from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.status.readouts import TURNING_RPM
from app.desk.translation import tr
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot
from core.ports import UnknownPart

MANUAL_STATES = frozenset({MachineState.JOG, MachineState.HOMING})
AXES_MOVING = "AXES ARE MOVING. WAIT UNTIL THEY STOP BEFORE EDITING"
SPINDLE_ON = "SPINDLE IS ON. STOP IT (M05 OR R). EDIT WHEN IT IS AT REST"
SPINDLE_UNKNOWN = "SPINDLE MAY BE TURNING: PRESS E-STOP. DO NOT EDIT NOW"
SPINDLE_COASTING = "SPINDLE IS COASTING. WAIT UNTIL IT STOPS BEFORE EDITING"
NO_PROGRAM = "CHOOSE A PROGRAM FIRST (F2), OR TYPE A NEW NAME THERE"
PROGRAM_RUNNING = "PROGRAM RUNNING. LET IT END, OR STOP IT AND PRESS R FIRST"
STOP_AXES_FIRST = "AXES ARE MOVING. STOP THEM (H) BEFORE CHOOSING A PROGRAM"


def find_program_refusal(snapshot: Snapshot) -> str:
    """Return the reason why the operator cannot choose another program now.

    The result is an empty string if another program can be chosen.
    """
    if snapshot.state in MANUAL_STATES:
        return STOP_AXES_FIRST
    return PROGRAM_RUNNING if snapshot.state in ACTIVE_STATES else ""


def find_editor_refusal(snapshot: Snapshot, *, has_name: bool = True) -> str:
    """Return the reason why the editor cannot be opened now, or an empty string if it can be opened.

    ``has_name`` is False if no program is selected.
    """
    if snapshot.state in MANUAL_STATES:
        return AXES_MOVING
    if snapshot.state not in ACTIVE_STATES:
        if snapshot.rpm_command:
            return SPINDLE_ON
        if UnknownPart.SPINDLE in snapshot.unknown:
            return SPINDLE_UNKNOWN
        if abs(snapshot.rpm_actual) > TURNING_RPM:
            return SPINDLE_COASTING
    return "" if has_name else NO_PROGRAM


def find_mdi_refusal(snapshot: Snapshot) -> str:
    """Return the reason why MDI cannot be opened now, or an empty string if it can be opened."""
    if snapshot.state in CYCLE_STATES:
        return tr("TO OPEN MDI, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    return ""


def find_restart_refusal(snapshot: Snapshot, loaded: LoadedProgram) -> str:
    """Return the reason why SEARCHTO cannot be opened or continued now, or an empty string if it can."""
    if snapshot.state in CYCLE_STATES:
        return tr("TO USE SEARCHTO, LET THE PROGRAM END, OR STOP IT AND PRESS R")
    if loaded.source is None or loaded.job is None:
        return tr("CHOOSE A PROGRAM FIRST (F2)")
    if loaded.phase is not LoadingPhase.READY:
        return tr("FIX PROGRAM ERRORS FIRST")
    return ""
