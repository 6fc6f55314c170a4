"""When an offset may change: corrections at any time at which no hand moves the slides, the rest at rest."""

from __future__ import annotations

from app.desk import prompt_line
from app.desk.translation import tr
from core.executor.snapshot import Snapshot, State

CORRECTIONS = frozenset({"wear_x", "wear_z", "remark"})  # of a tool; all of a secondary offset


def refusal(snapshot: Snapshot, *, correction: bool) -> str:
    """Why nothing may be changed now; empty when it may.

    A correction (wear, secondary offset) may be entered while parts run: the part under way keeps the
    offsets that it was proved with. What says where a tip is waits until no program is under way.
    """
    state = snapshot.state
    if state in {State.JOG, State.HOME}:
        return tr("THE SLIDES ARE MOVING: OFFSETS CHANGE AT REST")
    if state in prompt_line.UNDER_WAY and not correction:
        return tr("A PROGRAM IS UNDER WAY: ONLY WEAR AND F9 CORRECTIONS MAY CHANGE")
    return ""


def standing(snapshot: Snapshot) -> str:
    """What a change entered now will count for; empty between cycles."""
    if snapshot.state not in prompt_line.UNDER_WAY:
        return ""
    if snapshot.cycle_repeat:
        return tr("PARTS RUN: A CORRECTION COUNTS FROM THE NEXT PART, ONCE IT IS PROVED")
    return tr("THE PART UNDER WAY KEEPS ITS OFFSETS: A CORRECTION COUNTS FROM THE NEXT CYCLE START")


def counts_later(snapshot: Snapshot) -> str:
    """What stands behind SAVED."""
    if snapshot.state not in prompt_line.UNDER_WAY:
        return ""
    return (
        tr("; IT COUNTS FROM THE NEXT PART")
        if snapshot.cycle_repeat
        else tr("; IT COUNTS FROM THE NEXT CYCLE START")
    )
