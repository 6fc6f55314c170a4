"""CYCLE98: three threads one behind the other in one sweep, each with its lead and taper."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import RETRACT, Cycle, Step
from core.interpreter.sinumerik.thread_cycle import WRONG_LEAD, depths_of, kind_of, shifts_of, starts_of
from core.interpreter.sinumerik.thread_moves import check_spindle

_SAME = 1e-6


def thread_chain(cycle: Cycle) -> Iterator[Block]:
    """All passes of all starts. Raises ProgramError before the first."""
    kind = kind_of(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    places = [(cycle.over_zero(f"DM{k}") / 2.0, cycle.needed(f"PO{k}")) for k in range(1, 5)]
    leads = [cycle.over_zero(f"PP{k}", WRONG_LEAD) for k in range(1, 4)]
    along = 1.0 if places[1][1] > places[0][1] else -1.0
    for k, (a, b) in enumerate(pairwise(places), 2):
        if along * (b[1] - a[1]) < _SAME:
            text = "{name} does not continue the thread in the same Z direction"
            raise cycle.wrong(f"PO{k}", text, "PO1 to PO4 must follow each other in the same Z direction.")
    depths = depths_of(cycle, equal_chip=kind in {3, 4})
    shifts, (first, starts) = shifts_of(cycle, depths), starts_of(cycle)
    for lead in leads:
        check_spindle(cycle.state, cycle.statement, lead)
    cycle.state.threads = ()
    clear = max(out * x for x, _ in places) * out + out * (cycle.size("_VRT") or RETRACT)
    ends = [*places[1:3], _beyond(places[2], places[3], along * cycle.size("ROP"))]
    steps: list[Step] = []
    for start in range(starts):
        later = leads[0] * (first / 360.0 + start / starts)
        for depth, shift in zip(depths, shifts, strict=True):
            begin = _beyond(places[1], places[0], -along * (cycle.size("APP") + later - shift))
            steps += [Step(clear, begin[1]), Step(begin[0] - out * depth, begin[1])]
            steps += [
                Step(x - out * depth, z, lead, thread=True) for (x, z), lead in zip(ends, leads, strict=True)
            ]
            steps += [Step(clear, ends[-1][1]), Step(clear, begin[1])]
    return cycle.blocks(steps)


def _beyond(a: tuple[float, float], b: tuple[float, float], far: float) -> tuple[float, float]:
    """The point of the line through both that lies ``far`` along Z from ``b``."""
    return b[0] + (b[0] - a[0]) / (b[1] - a[1]) * far, b[1] + far
