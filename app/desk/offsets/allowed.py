"""When an offset may change: never under a running program, corrections also at a stop between parts."""

from __future__ import annotations

from app.desk import prompts
from app.desk.words import tr
from core.executor.snapshot import Snapshot, State

CORRECTIONS = frozenset({"wear_x", "wear_z", "remark"})  # of a tool; all of a secondary offset


def refusal(snapshot: Snapshot, *, correction: bool) -> str:
    """Why nothing may be changed now; empty when it may.

    A correction (wear, secondary offset) may also be entered while M00 or M01 stands; all the rest, which
    says where a tip is, only when no program is under way.
    """
    state = snapshot.state
    if state in {State.JOG, State.HOME}:
        return tr("THE SLIDES ARE MOVING: OFFSETS CHANGE AT REST")
    if state is State.PROGRAM_STOP:
        if correction:
            return ""
        return tr("A PROGRAM IS UNDER WAY: AT A STOP ONLY WEAR AND F9 CORRECTIONS MAY CHANGE")
    if state in prompts.MOVING | prompts.INTERRUPTED:
        if correction:
            return tr("A CYCLE IS UNDER WAY: CORRECTIONS CHANGE BETWEEN CYCLES, OR AT AN M00 OR M01 STOP")
        return tr("A PROGRAM IS UNDER WAY: TOOL OFFSETS CHANGE BETWEEN CYCLES ONLY")
    return ""


def standing(snapshot: Snapshot) -> str:
    """What a change entered at a stop will count for; empty between cycles."""
    if snapshot.state is not State.PROGRAM_STOP:
        return ""
    if snapshot.cycle_repeat:
        return tr("A CORRECTION SWITCHES CYCLE REPEAT OFF: IT COUNTS FROM THE NEXT CYCLE START")
    return tr("THE JOB UNDER WAY KEEPS ITS OFFSETS: A CHANGE COUNTS FROM THE NEXT CYCLE START")


def counts_later(snapshot: Snapshot) -> str:
    """What stands behind SAVED."""
    return tr("; IT COUNTS FROM THE NEXT CYCLE START") if snapshot.state is State.PROGRAM_STOP else ""
