"""Thread cycles CYCLE97, 98 and 99 for straight or tapered screw threads with one or more starts.

The passes have equal depths or equal chip cross sections, and each pass is a thread move as with G33.
CYCLE98 cuts a chain of three threads in one pass, each with its own lead and taper. A start angle is
produced by a start point that is farther away by a fraction of the lead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import radians, sqrt, tan

from core.geometry.lines_and_arcs import Point
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    DEFAULT_RETRACT_MM,
    MAX_PASS_COUNT,
    WRONG_MACHINING_TYPE,
    CycleCall,
    CycleStep,
)
from core.interpreter.sinumerik.motion.thread_moves import check_thread_spindle

WRONG_THREAD_LEAD = 61001
_SAME = 1e-6  # mm

COARSE_THREAD_LEADS_MM = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5,
    22: 2.5, 24: 3.0, 27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0, 52: 5.0,
    56: 5.5, 60: 5.5, 64: 6.0, 68: 6.0,
}  # fmt: skip
"""Leads of ISO coarse threads in mm, by thread size. MPIT selects the lead."""


def get_coarse_thread_lead(nominal_size: float) -> float:
    """Return the lead of a coarse metric thread in mm, or 0 if the standard has no such size.

    A negative size specifies a left-hand thread.
    """
    return (
        COARSE_THREAD_LEADS_MM.get(round(abs(nominal_size)), 0.0)
        if nominal_size == round(nominal_size)
        else 0.0
    )


def check_lead_nonzero(cycle: CycleCall, lead: float, name: str) -> None:
    """Raise ProgramError if the lead is 0; the error names the parameter ``name``."""
    hint = "Enter PIT, or MPIT from 3 to 68 for M3 to M68."
    cycle.check_parameter(lead, name, "{name} does not define a lead", hint, WRONG_THREAD_LEAD)


def _read_lead(cycle: CycleCall) -> float:
    """Return the lead from PIT or MPIT in mm.

    Raises ProgramError if the lead is not defined or is negative, if PIT and MPIT do not match, or if
    CYCLE99 uses a parameter that is not supported.
    """
    for name in ("_PIT1", "_GST", "_MID", "_FDEP"):
        if cycle.line.called_name == "CYCLE99":
            cycle.check_unsupported_parameter(name, "CYCLE99 supports only the functions of CYCLE97")
    pit, size = cycle.read_length_mm("PIT"), cycle.read_number("MPIT")
    if cycle.has_argument("PIT") and pit:
        text = "{name} is a lead and must be greater than 0"
        cycle.check_parameter(pit >= 0.0, "PIT", text, "Correct the value.", WRONG_THREAD_LEAD)
        if size and abs(COARSE_THREAD_LEADS_MM.get(round(size), 0.0) - pit) > 1e-6:
            text = "{name} does not match a thread with lead {pit}"
            raise cycle.make_parameter_error("MPIT", text, "Omit MPIT.", WRONG_THREAD_LEAD, pit=pit)
        return pit
    lead = get_coarse_thread_lead(size) if size >= 0.0 else 0.0
    check_lead_nonzero(cycle, lead, "MPIT" if cycle.has_argument("MPIT") else "PIT")
    return lead


def _depths(cycle: CycleCall, *, equal_chip: bool) -> tuple[float, ...]:
    """Return the depth of each pass.

    NRC roughing passes cut to TDEP minus FAL, one finishing pass removes FAL, and NID passes repeat without
    infeed.
    """
    depth, left = cycle.read_positive_length_mm("TDEP"), cycle.read_unsigned_length_mm("FAL")
    count, idle = (
        cycle.read_whole_number("NRC", 1, 0, MAX_PASS_COUNT),
        cycle.read_whole_number("NID", 0, 0, MAX_PASS_COUNT),
    )
    text = "{name} is not less than TDEP, so no depth remains for roughing"
    cycle.check_parameter(left < depth, "FAL", text, "Reduce FAL.")
    cycle.check_parameter(
        count or left, "NRC", "{name} is 0, so nothing would be cut", "Enter the number of passes."
    )
    rough = [(depth - left) * (sqrt(i / count) if equal_chip else i / count) for i in range(1, count + 1)]
    return (*rough, *((depth,) if left or not rough else ()), *([depth] * idle))


def _shifts(cycle: CycleCall, depths: tuple[float, ...]) -> tuple[float, ...]:
    """Return the shift of each pass along the flank, as specified by the infeed angle IANG.

    With a negative IANG, the passes alternate between both flanks.
    """
    angle = cycle.read_number("IANG")
    if cycle.line.called_name == "CYCLE99" and cycle.read_number("VARI") // 100 % 10 == 2:
        angle = -abs(angle)
    text = "{name} must be a flank angle of less than 60 degrees"
    cycle.check_parameter(-60.0 < angle < 60.0, "IANG", text, "Enter half the thread angle.")
    slope = tan(radians(abs(angle)))
    turn = -1.0 if angle < 0.0 else 1.0
    return tuple(depth * slope * (turn if i % 2 else 1.0) for i, depth in enumerate(depths))


def _kind(cycle: CycleCall) -> int:
    """Return the machining type of the thread, from 1 to 4, as specified by VARI.

    - 1 is outside and 2 is inside, in passes of equal depth.
    - 3 is outside and 4 is inside, in passes of equal chip cross section.

    In CYCLE99, VARI has more digits. For example, 300103 means type 3. If the hundreds digit is 2, the
    passes alternate between both flanks.
    """
    if cycle.line.called_name != "CYCLE99":
        return cycle.read_machining_type("VARI", range(1, 5))
    value = cycle.read_whole_number("VARI", 0, 0, 9_999_999)
    if value % 10 not in {1, 2, 3, 4} or value // 100_000 % 10 not in {0, 3}:
        text = (
            "{name} is {value}: the last digit must be 1 to 4, and the sixth digit must be 3 (roughing and "
            "finishing together)"
        )
        raise cycle.make_parameter_error(
            "VARI", text, "Enter a value from 300101 to 300104.", WRONG_MACHINING_TYPE, value=value
        )
    return value % 10


def _starts(cycle: CycleCall) -> tuple[float, int]:
    """Return the start angle of the first thread in degrees, and the number of starts.

    Raises ProgramError for an invalid angle or number of starts.
    """
    starts = (
        cycle.read_whole_number("NUMTH" if cycle.line.called_name == "CYCLE99" else "NUMT", 0, 0, 100) or 1
    )
    return cycle.read_angle_deg("NSP", "{name} must be a start angle from 0 to less than 360 degrees"), starts


def run_threading(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE97 or CYCLE99.

    Raises ProgramError before the first block if a parameter is invalid.
    """
    lead, kind = _read_lead(cycle), _kind(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    z0, z1 = cycle.read_required_length_mm("SPL"), cycle.read_required_length_mm("FPL")
    text = "{name} is the same position as the start of the thread"
    cycle.check_parameter(abs(z1 - z0) >= _SAME, "FPL", text, "Correct SPL or FPL.")
    along = 1.0 if z1 > z0 else -1.0
    x0, x1 = cycle.read_positive_length_mm("DM1") / 2.0, cycle.read_positive_length_mm("DM2") / 2.0
    slope = (x1 - x0) / (z1 - z0)
    begin, end = (
        z0 - along * cycle.read_unsigned_length_mm("APP"),
        z1 + along * cycle.read_unsigned_length_mm("ROP"),
    )
    x_begin, x_end = x0 + slope * (begin - z0), x0 + slope * (end - z0)
    passes = _passes(cycle, kind)
    off = (
        cycle.read_unsigned_length_mm("_SDIS" if cycle.line.called_name == "CYCLE99" else "_VRT")
        or DEFAULT_RETRACT_MM
    )
    clear = max(out * x_begin, out * x_end) * out + out * off
    slope = (x_end - x_begin) / (end - begin)

    def compute_start_point(later: float, shift: float) -> Point:
        z = begin - along * (later - shift)
        return x_begin + slope * (z - begin), z

    return _cut(
        cycle, passes, _start_delays(cycle, [lead]), out, clear, compute_start_point, [((x_end, end), lead)]
    )


def run_chain_threading(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE98.

    Raises ProgramError before the first block if a parameter is invalid.
    """
    kind = _kind(cycle)
    out = -1.0 if kind in {2, 4} else 1.0
    places = [
        (cycle.read_positive_length_mm(f"DM{k}") / 2.0, cycle.read_required_length_mm(f"PO{k}"))
        for k in range(1, 5)
    ]
    leads = [cycle.read_positive_length_mm(f"PP{k}", WRONG_THREAD_LEAD) for k in range(1, 4)]
    along = 1.0 if places[1][1] > places[0][1] else -1.0
    for k, (a, b) in enumerate(pairwise(places), 2):
        text = "{name} does not continue the thread in the same Z direction"
        hint = "PO1 to PO4 must follow each other in the same Z direction."
        cycle.check_parameter(along * (b[1] - a[1]) >= _SAME, f"PO{k}", text, hint)
    passes = _passes(cycle, kind)
    later = _start_delays(cycle, leads)
    clear = max(out * x for x, _ in places) * out + out * (
        cycle.read_unsigned_length_mm("_VRT") or DEFAULT_RETRACT_MM
    )
    ends = [*places[1:3], _extend_line(places[2], places[3], along * cycle.read_unsigned_length_mm("ROP"))]
    app = cycle.read_unsigned_length_mm("APP")

    def compute_start_point(later: float, shift: float) -> Point:
        return _extend_line(places[1], places[0], -along * (app + later - shift))

    return _cut(cycle, passes, later, out, clear, compute_start_point, list(zip(ends, leads, strict=True)))


def _passes(cycle: CycleCall, kind: int) -> list[tuple[float, float]]:
    """Return the depth and the start shift of each pass. Raises ProgramError for invalid parameters."""
    depths = _depths(cycle, equal_chip=kind in {3, 4})
    return list(zip(depths, _shifts(cycle, depths), strict=True))


def _start_delays(cycle: CycleCall, leads: list[float]) -> list[float]:
    """Return how far the start point of each thread start is moved back along Z, in mm.

    Raises ProgramError for invalid parameters, and if the spindle is stopped, is under G96, or is too fast
    for one of the leads.
    """
    first, starts = _starts(cycle)
    for lead in leads:
        check_thread_spindle(cycle.state, cycle.statement, lead)
    cycle.state.threads = ()
    return [leads[0] * (first / 360.0 + start / starts) for start in range(starts)]


def _cut(
    cycle: CycleCall,
    passes: list[tuple[float, float]],
    starts: list[float],
    outward_sign: float,
    clearance_x: float,
    start: Callable[[float, float], Point],
    end_points: list[tuple[Point, float]],
) -> Iterator[Block]:
    """Return the blocks of all passes.

    Each pass consists of the approach, the infeed, the threads to ``end_points`` with their leads, the
    retract and the return. The function ``start`` returns the start point of a pass on the surface, given
    the delay along Z and the shift along the flank. ``clearance_x`` is X of the retract.
    """
    steps: list[CycleStep] = []
    for later in starts:
        for depth, shift in passes:
            x0, z0 = start(later, shift)
            steps += [CycleStep(clearance_x, z0), CycleStep(x0 - outward_sign * depth, z0)]
            steps += [
                CycleStep(x - outward_sign * depth, z, lead, is_thread=True) for (x, z), lead in end_points
            ]
            steps += [CycleStep(clearance_x, steps[-1].z), CycleStep(clearance_x, z0)]
    return cycle.make_blocks(steps)


def _extend_line(a: Point, b: Point, distance: float) -> Point:
    """Return the point beyond ``b`` on the line from ``a`` through ``b``.

    The point is at the distance ``distance`` from ``b`` along Z.
    """
    return b[0] + (b[0] - a[0]) / (b[1] - a[1]) * distance, b[1] + distance
