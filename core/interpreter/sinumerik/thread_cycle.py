"""CYCLE97: a thread, straight or tapered, with one start or several, in passes of equal depth or equal chip.

The passes are those of G33; a start angle is the same as beginning so much of the lead further away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians, sqrt, tan

from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import MACHINING_TYPE, MOST_PASSES, RETRACT, Cycle, Step
from core.interpreter.sinumerik.thread_moves import check_spindle

WRONG_LEAD = 61001

COARSE_LEADS = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5,
    22: 2.5, 24: 3.0, 27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0, 52: 5.0,
    56: 5.5, 60: 5.5, 64: 6.0, 68: 6.0,
}  # fmt: skip
"""Lead of the ISO coarse thread by its size, mm: what MPIT means."""


@dataclass(frozen=True, slots=True)
class Thread:
    """mm, X a radius. ``out`` is +1 for a thread outside, -1 inside; ``along`` the sign of the way along Z.

    ``z0 x0`` lie on the part's surface where the pass starts, ``z1 x1`` where it ends, run-in and run-out
    included. ``depths`` are those of the passes below the surface, ``shifts`` how much later each begins.
    """

    out: float
    along: float
    x0: float
    z0: float
    x1: float
    z1: float
    lead: float
    off: float
    depths: tuple[float, ...]
    shifts: tuple[float, ...]


def lead_of(cycle: Cycle) -> float:
    """PIT, or what MPIT stands for. Raises ProgramError."""
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
    lead = COARSE_LEADS.get(round(size), 0.0) if size == round(size) else 0.0
    if not lead:
        name = "MPIT" if cycle.given("MPIT") else "PIT"
        text = "{name} does not define a lead"
        raise cycle.wrong(name, text, "Enter PIT, or MPIT from 3 to 68 for M3 to M68.", WRONG_LEAD)
    return lead


def read_thread(cycle: Cycle) -> Thread:
    """The thread that a call asks for. Raises ProgramError by the parameter's name."""
    lead = lead_of(cycle)
    kind = kind_of(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    z0, z1 = cycle.needed("SPL"), cycle.needed("FPL")
    text = "{name} is the same position as the start of the thread"
    cycle.check(abs(z1 - z0) >= 1e-06, "FPL", text, "Correct SPL or FPL.")
    along = 1.0 if z1 > z0 else -1.0
    x0 = cycle.over_zero("DM1") / 2.0
    x1 = cycle.over_zero("DM2") / 2.0
    slope = (x1 - x0) / (z1 - z0)
    app, rop = cycle.size("APP"), cycle.size("ROP")
    depths = depths_of(cycle, equal_chip=kind in {3, 4})
    shifts = shifts_of(cycle, depths)
    off = cycle.size("_SDIS" if cycle.line.call == "CYCLE99" else "_VRT") or RETRACT
    begin, end = z0 - along * app, z1 + along * rop
    return Thread(
        out, along, x0 + slope * (begin - z0), begin, x0 + slope * (end - z0), end, lead, off, depths, shifts
    )


def depths_of(cycle: Cycle, *, equal_chip: bool) -> tuple[float, ...]:
    """Roughing to TDEP less FAL in NRC passes, FAL in one, then NID passes without infeed."""
    depth, left = cycle.over_zero("TDEP"), cycle.size("FAL")
    count, idle = cycle.whole("NRC", 1, 0, MOST_PASSES), cycle.whole("NID", 0, 0, MOST_PASSES)
    text = "{name} is not less than TDEP, so no depth remains for roughing"
    cycle.check(left < depth, "FAL", text, "Reduce FAL.")
    cycle.check(count or left, "NRC", "{name} is 0, so nothing would be cut", "Enter the number of passes.")
    rough = [(depth - left) * (sqrt(i / count) if equal_chip else i / count) for i in range(1, count + 1)]
    return (*rough, *((depth,) if left or not rough else ()), *([depth] * idle))


def shifts_of(cycle: Cycle, depths: tuple[float, ...]) -> tuple[float, ...]:
    """Along the flank by IANG; under 0 on both flanks in turn."""
    angle = cycle.number("IANG")
    if cycle.line.call == "CYCLE99" and cycle.number("VARI") // 100 % 10 == 2:
        angle = -abs(angle)
    text = "{name} must be a flank angle of less than 60 degrees"
    cycle.check(-60.0 < angle < 60.0, "IANG", text, "Enter half the thread angle.")
    slope = tan(radians(abs(angle)))
    turn = -1.0 if angle < 0.0 else 1.0
    return tuple(depth * slope * (turn if i % 2 else 1.0) for i, depth in enumerate(depths))


def kind_of(cycle: Cycle) -> int:
    """1 outside, 2 inside with passes of equal depth; 3 outside, 4 inside with equal chips: of VARI.

    Of CYCLE99 VARI has more digits: 300103 is 3, and the hundreds 2 are both flanks in turn.
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


def starts_of(cycle: Cycle) -> tuple[float, int]:
    """Start angle of the first thread, degrees, and how many there are. Raises ProgramError."""
    starts = cycle.whole("NUMTH" if cycle.line.call == "CYCLE99" else "NUMT", 0, 0, 100) or 1
    first = cycle.number("NSP")
    text = "{name} must be a start angle from 0 to less than 360 degrees"
    cycle.check(0.0 <= first < 360.0, "NSP", text)
    return first, starts


def thread_cycle(cycle: Cycle) -> Iterator[Block]:
    """All passes of all starts. Raises ProgramError before the first."""
    thread = read_thread(cycle)
    first, starts = starts_of(cycle)
    check_spindle(cycle.state, cycle.statement, thread.lead)
    cycle.state.threads = ()
    steps: list[Step] = []
    for start in range(starts):
        begin = thread.lead * (first / 360.0 + start / starts)
        for depth, shift in zip(thread.depths, thread.shifts, strict=True):
            steps += _pass(thread, depth, begin - shift)
    return cycle.blocks(steps)


def _pass(thread: Thread, depth: float, further: float) -> list[Step]:
    """To the start, ``further`` mm away from the part; in; along; out; back."""
    clear = max(thread.out * thread.x0, thread.out * thread.x1) * thread.out + thread.out * thread.off
    begin = thread.z0 - thread.along * further
    slope = (thread.x1 - thread.x0) / (thread.z1 - thread.z0)
    x0 = thread.x0 + slope * (begin - thread.z0) - thread.out * depth
    x1 = thread.x1 - thread.out * depth
    return [
        Step(clear, begin),
        Step(x0, begin),
        Step(x1, thread.z1, thread.lead, thread=True),
        Step(clear, thread.z1),
        Step(clear, begin),
    ]
