"""The tool that stands in the part: the way out of it, or in words how the operator takes it out by hand."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk import formats
from app.desk.drawing.approach import Leg as Drawn
from app.desk.words import tr
from core.executor.interrupted_job import CONTROL_LOST
from core.executor.job import Job
from core.executor.snapshot import Snapshot
from core.interpreter.checkpoint import ApproachStep, Begin, Checkpoint, Leg
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import Choices, MachineNow, retract_from_work, way_out
from core.interpreter.restart.restart_lines import Interruption
from core.interpreter.restart.restart_retract import Retract, ToolPlace


@dataclass(frozen=True, slots=True)
class Leaving:
    """The way out alone: its legs, and at which feed they go in the part. ``trouble``: why there is none."""

    begin: Begin
    legs: tuple[Drawn, ...]
    feed: str
    trouble: str = ""


def leaving_of(cut: CutRecord, snapshot: Snapshot, job: Job, choices: Choices) -> Leaving:
    """The way out from where the tool stands now."""
    now = now_of(snapshot, job)
    found, tool = retract_from_work(cut, now)
    steps = way_out(cut, now, choices) if found.known else ()
    begin = Begin(Checkpoint(snapshot.modal), single=True, way=steps)
    metric = snapshot.modal.metric
    feed = f"{formats.feed(choices.modest, metric, False)} {formats.feed_unit(metric, False)}"
    trouble = jog_words(found, tool)
    if not trouble and not steps:
        trouble = tr("T{tool} STANDS CLEAR OF THE PART ALREADY").format(tool=tool)
    return Leaving(begin, drawn(steps, snapshot, cut.offsets.get(tool, (0.0, 0.0))), feed, trouble)


def now_of(snapshot: Snapshot, job: Job) -> MachineNow:
    """The machine of this instant, and what of the loaded program was interrupted.

    In a text that was changed since, the number of a block tells nothing any more.
    """
    found = snapshot.interrupted
    broken = None
    same = found is not None and found.program == job.source.name and found.text == job.text_digest
    if found is not None and same and found.block:
        stale = found.why == CONTROL_LOST
        broken = Interruption(found.block, found.tool, found.where, found.begun, stale)
    return MachineNow(snapshot.demand, snapshot.modal, broken)


def drawn(
    steps: tuple[ApproachStep, ...], snapshot: Snapshot, offset: tuple[float, float]
) -> tuple[Drawn, ...]:
    """The legs of a way in the frame of one tool; the first is where that stands now."""
    x, z = snapshot.demand[0], snapshot.demand[1]
    legs = [Drawn(z - offset[1], x - offset[0])]
    for step in steps:
        if isinstance(step, Leg):
            x, z = x if step.x is None else step.x, z if step.z is None else step.z
            legs.append(Drawn(z - offset[1], x - offset[0], step.rapid, f"{len(legs)} {step.text}"))
    return tuple(legs)


def jog_words(found: Retract, tool: int) -> str:
    """What the operator has to do by hand where no way out is sure; empty where one is."""
    if found.known:
        return ""
    if found.lies is ToolPlace.TAP:
        words = tr("T{tool} IS A TAP IN ITS THREAD: TURN IT OUT BY HAND WITH THE SPINDLE, Z FOLLOWING")
    elif found.lies is ToolPlace.THREAD:
        words = tr("T{tool} STANDS IN A THREAD: JOG X OFF THE THREAD FIRST, NOT Z")
    elif found.lies is ToolPlace.TURNED:
        words = tr("C HAS TURNED SINCE T{tool} WENT IN: TURN THE SPINDLE FREE BY HAND AND JOG T{tool} OUT")
    else:
        words = _towards(*found.away)
    return words.format(tool=tool, x="X+" if found.away[0] > 0 else "X-")


def _towards(x: int, z: int) -> str:
    if x and z:
        return tr("T{tool} STANDS IN THE PART: JOG IT OUT BY THE WAY IT CAME, {x} AND Z+ TOGETHER")
    if x:
        return tr("T{tool} STANDS IN THE PART: JOG {x} OUT OF IT FIRST, NOT Z")
    if z:
        return tr("T{tool} STANDS IN THE PART: JOG Z+ OUT OF IT FIRST, NOT X")
    return tr("HOW T{tool} CAME TO STAND HERE IS NOT KNOWN: JOG IT CLEAR OF THE PART BY THE WAY IT CAME")
