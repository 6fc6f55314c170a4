"""Thread cycles CYCLE97, 98 and 99: straight or tapered, single- or multi-start, in equal depths or chips.

CYCLE98 cuts a chain of three threads in one pass, each with its lead and taper. The passes are those of G33.
A start angle is equivalent to a start point that is farther away by a fraction of the lead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import radians, sqrt, tan

from core.geometry.lines_and_arcs import Point
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    MACHINING_TYPE,
    MOST_PASSES,
    RETRACT,
    Cycle,
    Step,
)
from core.interpreter.sinumerik.motion.thread_moves import check_spindle

WRONG_LEAD = 61001
_SAME = 1e-6  # mm

COARSE_LEADS = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5,
    22: 2.5, 24: 3.0, 27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0, 52: 5.0,
    56: 5.5, 60: 5.5, 64: 6.0, 68: 6.0,
}  # fmt: skip
"""Lead of the ISO coarse thread by its size, mm: what MPIT means."""


def coarse_lead(size: float) -> float:
    """Return the lead of a coarse thread in mm; 0 if the size has none. Left-hand sizes are negative."""
    return COARSE_LEADS.get(round(abs(size)), 0.0) if size == round(size) else 0.0


def check_lead(cycle: Cycle, lead: float, name: str) -> None:
    """Raise ProgramError with the name of a parameter if the lead is 0."""
    hint = "Enter PIT, or MPIT from 3 to 68 for M3 to M68."
    cycle.check(lead, name, "{name} does not define a lead", hint, WRONG_LEAD)


def _lead(cycle: Cycle) -> float:
    """Return the lead from PIT or MPIT in mm. Raises ProgramError."""
    for name in ("_PIT1", "_GST", "_MID", "_FDEP"):
        if cycle.line.call == "CYCLE99":
            cycle.zero_only(name, "CYCLE99 supports only the functions of CYCLE97")
    pit, size = cycle.length("PIT"), cycle.number("MPIT")
    if cycle.given("PIT") and pit:
        text = "{name} is a lead and must be greater than 0"
        cycle.check(pit >= 0.0, "PIT", text, "Correct the value.", WRONG_LEAD)
        if size and abs(COARSE_LEADS.get(round(size), 0.0) - pit) > 1e-6:
            text = "{name} does not match a thread with lead {pit}"
            raise cycle.wrong("MPIT", text, "Omit MPIT.", WRONG_LEAD, pit=pit)
        return pit
    lead = coarse_lead(size) if size >= 0.0 else 0.0
    check_lead(cycle, lead, "MPIT" if cycle.given("MPIT") else "PIT")
    return lead


def _depths(cycle: Cycle, *, equal_chip: bool) -> tuple[float, ...]:
    """Return the depths of the passes: NRC to TDEP minus FAL, one for FAL, then NID without infeed."""
    depth, left = cycle.over_zero("TDEP"), cycle.size("FAL")
    count, idle = cycle.whole("NRC", 1, 0, MOST_PASSES), cycle.whole("NID", 0, 0, MOST_PASSES)
    text = "{name} is not less than TDEP, so no depth remains for roughing"
    cycle.check(left < depth, "FAL", text, "Reduce FAL.")
    cycle.check(count or left, "NRC", "{name} is 0, so nothing would be cut", "Enter the number of passes.")
    rough = [(depth - left) * (sqrt(i / count) if equal_chip else i / count) for i in range(1, count + 1)]
    return (*rough, *((depth,) if left or not rough else ()), *([depth] * idle))


def _shifts(cycle: Cycle, depths: tuple[float, ...]) -> tuple[float, ...]:
    """Return the shift of each pass along the flank by IANG; a negative IANG alternates the flanks."""
    angle = cycle.number("IANG")
    if cycle.line.call == "CYCLE99" and cycle.number("VARI") // 100 % 10 == 2:
        angle = -abs(angle)
    text = "{name} must be a flank angle of less than 60 degrees"
    cycle.check(-60.0 < angle < 60.0, "IANG", text, "Enter half the thread angle.")
    slope = tan(radians(abs(angle)))
    turn = -1.0 if angle < 0.0 else 1.0
    return tuple(depth * slope * (turn if i % 2 else 1.0) for i, depth in enumerate(depths))


def _kind(cycle: Cycle) -> int:
    """Return the type from VARI: 1 outside, 2 inside in equal depths; 3 outside, 4 inside in equal chips.

    In CYCLE99, VARI has more digits: 300103 means 3, and 2 in the hundreds place alternates the flanks.
    """
    if cycle.line.call != "CYCLE99":
        return cycle.machining("VARI", range(1, 5))
    value = cycle.whole("VARI", 0, 0, 9_999_999)
    if value % 10 not in {1, 2, 3, 4} or value // 100_000 % 10 not in {0, 3}:
        text = (
            "{name} is {value}: the last digit must be 1 to 4, and the sixth digit must be 3 (roughing and "
            "finishing together)"
        )
        raise cycle.wrong("VARI", text, "Enter a value from 300101 to 300104.", MACHINING_TYPE, value=value)
    return value % 10


def _starts(cycle: Cycle) -> tuple[float, int]:
    """Return the start angle of the first thread in degrees, and the number of starts.

    Raises ProgramError for an invalid angle.
    """
    starts = cycle.whole("NUMTH" if cycle.line.call == "CYCLE99" else "NUMT", 0, 0, 100) or 1
    return cycle.angle("NSP", "{name} must be a start angle from 0 to less than 360 degrees"), starts


def thread_cycle(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE97 or CYCLE99. Raises ProgramError before the first block."""
    lead, kind = _lead(cycle), _kind(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    z0, z1 = cycle.needed("SPL"), cycle.needed("FPL")
    text = "{name} is the same position as the start of the thread"
    cycle.check(abs(z1 - z0) >= _SAME, "FPL", text, "Correct SPL or FPL.")
    along = 1.0 if z1 > z0 else -1.0
    x0, x1 = cycle.over_zero("DM1") / 2.0, cycle.over_zero("DM2") / 2.0
    slope = (x1 - x0) / (z1 - z0)
    begin, end = z0 - along * cycle.size("APP"), z1 + along * cycle.size("ROP")
    x_begin, x_end = x0 + slope * (begin - z0), x0 + slope * (end - z0)
    passes = _passes(cycle, kind)
    off = cycle.size("_SDIS" if cycle.line.call == "CYCLE99" else "_VRT") or RETRACT
    clear = max(out * x_begin, out * x_end) * out + out * off
    slope = (x_end - x_begin) / (end - begin)

    def start(later: float, shift: float) -> Point:
        z = begin - along * (later - shift)
        return x_begin + slope * (z - begin), z

    return _cut(cycle, passes, _later(cycle, [lead]), out, clear, start, [((x_end, end), lead)])


def thread_chain(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE98. Raises ProgramError before the first block."""
    kind = _kind(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    places = [(cycle.over_zero(f"DM{k}") / 2.0, cycle.needed(f"PO{k}")) for k in range(1, 5)]
    leads = [cycle.over_zero(f"PP{k}", WRONG_LEAD) for k in range(1, 4)]
    along = 1.0 if places[1][1] > places[0][1] else -1.0
    for k, (a, b) in enumerate(pairwise(places), 2):
        text = "{name} does not continue the thread in the same Z direction"
        hint = "PO1 to PO4 must follow each other in the same Z direction."
        cycle.check(along * (b[1] - a[1]) >= _SAME, f"PO{k}", text, hint)
    passes = _passes(cycle, kind)
    later = _later(cycle, leads)
    clear = max(out * x for x, _ in places) * out + out * (cycle.size("_VRT") or RETRACT)
    ends = [*places[1:3], _beyond(places[2], places[3], along * cycle.size("ROP"))]
    app = cycle.size("APP")

    def start(later: float, shift: float) -> Point:
        return _beyond(places[1], places[0], -along * (app + later - shift))

    return _cut(cycle, passes, later, out, clear, start, list(zip(ends, leads, strict=True)))


def _passes(cycle: Cycle, kind: int) -> list[tuple[float, float]]:
    """Return the depth and the start shift of each pass. Raises ProgramError."""
    depths = _depths(cycle, equal_chip=kind in {3, 4})
    return list(zip(depths, _shifts(cycle, depths), strict=True))


def _later(cycle: Cycle, leads: list[float]) -> list[float]:
    """Return the delay of the thread of each start along Z, in mm. Raises ProgramError."""
    first, starts = _starts(cycle)
    for lead in leads:
        check_spindle(cycle.state, cycle.statement, lead)
    cycle.state.threads = ()
    return [leads[0] * (first / 360.0 + start / starts) for start in range(starts)]


def _cut(
    cycle: Cycle,
    passes: list[tuple[float, float]],
    starts: list[float],
    out: float,
    clear: float,
    start: Callable[[float, float], Point],
    ends: list[tuple[Point, float]],
) -> Iterator[Block]:
    """Return the blocks of all passes: approach, infeed, thread to ``ends`` by their leads, retract, return.

    ``start`` returns the start point on the surface for a delay and a shift. ``clear`` is X of the retract.
    """
    steps: list[Step] = []
    for later in starts:
        for depth, shift in passes:
            x0, z0 = start(later, shift)
            steps += [Step(clear, z0), Step(x0 - out * depth, z0)]
            steps += [Step(x - out * depth, z, lead, thread=True) for (x, z), lead in ends]
            steps += [Step(clear, steps[-1].z), Step(clear, z0)]
    return cycle.blocks(steps)


def _beyond(a: Point, b: Point, far: float) -> Point:
    """Return the point on the line from ``a`` through ``b`` that is ``far`` along Z from ``b``."""
    return b[0] + (b[0] - a[0]) / (b[1] - a[1]) * far, b[1] + far
