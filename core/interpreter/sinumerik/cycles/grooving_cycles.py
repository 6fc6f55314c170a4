"""Grooving (CYCLE93) with straight or tapered flanks, and part-off (CYCLE92).

Grooves are outside or inside. WIDG is the width of the bottom, and SPL is the corner of the surface at
which the groove begins. Tapered flanks make the groove wider toward the surface. The tool width is the
distance between the two cutting edges of the tool. These edges are D and _DN in the tool table, or D+1
without _DN, as on the original control.

Part-off is slower near the spindle axis, and the active cutting edge moves in X at Z = SPL. The parameters
of CYCLE92 follow the manufacturer's operating manuals, and their names and order follow published lists.
The digits of ``_DMODE`` and ``_AMODE`` are not documented. Depths are therefore accepted only as diameters.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import radians, tan
from typing import NamedTuple

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.contour_passes import compute_equal_depths
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.shared.units import MM_S_PER_FT_MIN, MM_S_PER_M_MIN
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    DEFAULT_RETRACT_MM,
    NO_FEED,
    NO_SPINDLE_DIRECTION,
    CycleCall,
    CycleStep,
    make_dwell_steps,
)
from core.tool_edges import format_edge_name, get_edge_number, get_tool_number, make_edge_row_number

WRONG_GROOVE_WIDTH = 61602
WRONG_GROOVE_FORM = 61603
_SAME = 1e-6  # mm
_STEEPEST = 89.999  # degrees
_USUAL_WIDTH = 3.0  # mm; assumed width of a tool that is not in the table
_CUTS = "{name} would need {count} cuts, which is too many"
_OVERLAP = 0.95  # of the tool width; the maximum offset between adjacent cuts


class GrooveGeometry(NamedTuple):
    """The geometry of a groove in mm, with X as a radius.

    ``outward_sign`` is the sign of X from the bottom to the opening. The bottom extends from
    ``bottom_min_z`` to ``bottom_max_z``. At ``surface_radius``, the groove is wider by
    ``low_flank_z_extent`` and ``high_flank_z_extent`` at its two ends.
    """

    outward_sign: float
    surface_radius: float
    bottom_radius: float
    bottom_min_z: float
    bottom_max_z: float
    low_flank_z_extent: float = 0.0
    high_flank_z_extent: float = 0.0


def read_groove(cycle: CycleCall) -> GrooveGeometry:
    """Return the groove of a cycle call. Raises ProgramError, naming the parameter, if one is invalid."""
    kind = (cycle.read_machining_type("VARI", range(1, 19)) - 1) % 10 + 1
    cycle.check_parameter(kind <= 8, "VARI", "{name} must be 1 to 8 or 11 to 18", "Correct the value.", 61002)
    cycle.check_unsupported_parameter("STA1", "program a groove on a taper as a CYCLE95 contour")
    for name in ("RCO1", "RCO2", "RCI1", "RCI2"):
        cycle.check_unsupported_parameter(
            name, "program the corners as a CYCLE95 contour, or chamfer them with G1"
        )
    text = "{name} is {kind}, which specifies a face groove and is not supported"
    hint = "Program a face groove as a CYCLE95 contour or in G1 blocks."
    cycle.check_parameter(kind % 2 != 0, "VARI", text, hint, "not-in-subset", kind=kind)
    inside, right = kind in {3, 7}, kind > 4
    x, z = cycle.read_positive_length_mm("SPD") / 2.0, cycle.read_required_length_mm("SPL")
    width, depth = (
        cycle.read_positive_length_mm("WIDG"),
        cycle.read_positive_length_mm("DIAG", WRONG_GROOVE_FORM),
    )
    out = -1.0 if inside else 1.0
    here, there = _flank_extent(cycle, "ANG1", depth), _flank_extent(cycle, "ANG2", depth)
    low, high = (z - here - width, z - here) if right else (z + here, z + here + width)
    runs = (there, here) if right else (here, there)
    text = "{name} makes the groove reach past the spindle centerline"
    cycle.check_parameter(x - out * depth >= 0.0, "DIAG", text, "Correct SPD or DIAG.", WRONG_GROOVE_FORM)
    return GrooveGeometry(out, x, x - out * depth, low, high, *runs)


def _flank_extent(cycle: CycleCall, name: str, depth: float) -> float:
    """Return the Z extent of a flank from the bottom to the surface, in mm.

    Raises ProgramError for an invalid flank angle.
    """
    angle = cycle.read_number(name)
    text = "{name} must be a flank angle from 0 to less than 90 degrees"
    cycle.check_parameter(0.0 <= angle <= _STEEPEST, name, text)
    return depth * tan(radians(angle))


def get_tool_width(cycle: CycleCall, max_width: float) -> tuple[float, bool]:
    """Return the width of the tool in mm, and whether the active edge is its lower corner.

    For a tool that is not in the table, the width is 3 mm, or ``max_width`` if this is smaller. A warning
    is logged, and a program with this warning cannot start. Raises ProgramError in the following cases:

    - No tool with an offset is active, or _DN is invalid.
    - The table contains only one of the two edges, or both edges are at the same position.
    """
    state = cycle.state
    key, tools = state.modal.tool, state.setup.tools
    cycle.check_active_tool()
    number = cycle.read_whole_number("_DN", 0, 0, 9) or get_edge_number(key) + 1
    other = make_edge_row_number(get_tool_number(key), number)
    if key not in tools and other not in tools:
        width = min(_USUAL_WIDTH, max_width)
        text = "{call} assumes a tool {width} mm wide because {key} is not set."
        hint = "Set both tool corners on the TOOL OFFSETS page (F8)."
        cycle.log_warning("tool-width", text, hint, width=width, key=format_edge_name(key))
        return width, False
    if key not in tools or other not in tools:
        name = format_edge_name(other)
        text = "{call} needs the tool width, but the other tool corner ({name}) is not set."
        hint = "Set {other} on the TOOL OFFSETS page (F8)."
        raise cycle.make_call_error(WRONG_GROOVE_WIDTH, text, hint, name=name, other=format_edge_name(other))
    here, there = tools[key], tools[other]
    # A corner farther in the plus direction has the smaller machine position at part zero.
    corner_offset_mm = here.z - there.z
    text = "{key} and {other} are at the same position, so the tool has no width."
    hint = "Correct the offsets of the two tool corners."
    cycle.require_condition(
        abs(corner_offset_mm) >= _SAME,
        WRONG_GROOVE_WIDTH,
        text,
        hint,
        key=format_edge_name(key),
        other=format_edge_name(other),
    )
    return abs(corner_offset_mm), corner_offset_mm > 0.0


def run_grooving(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE93.

    The cycle makes adjacent cuts in steps of IDEP and then finishes the flanks and the bottom. Raises
    ProgramError for invalid parameters.
    """
    shape = read_groove(cycle)
    bottom_left, flank_left = cycle.read_unsigned_length_mm("FAL1"), cycle.read_unsigned_length_mm("FAL2")
    width, at_low = get_tool_width(cycle, shape.bottom_max_z - shape.bottom_min_z - 2.0 * flank_left)
    room = shape.bottom_max_z - shape.bottom_min_z - 2.0 * flank_left - width
    text = "{name} is {high} including FAL2 on both flanks, but the tool is {width} wide"
    hint = "Use a narrower tool."
    cycle.check_parameter(
        room >= -_SAME,
        "WIDG",
        text,
        hint,
        WRONG_GROOVE_WIDTH,
        high=shape.bottom_max_z - shape.bottom_min_z,
        width=width,
    )
    feed = cycle.require_feed(cycle.state.modal.feed)
    off = cycle.read_unsigned_length_mm("_VRT") or DEFAULT_RETRACT_MM
    plan = _Plan(
        cycle, shape, feed, shape.surface_radius + shape.outward_sign * off, 0.0 if at_low else width
    )
    steps = cycle.make_clearance_steps(shape.surface_radius + shape.outward_sign * off, shape.outward_sign)
    bottom = shape.bottom_radius + shape.outward_sign * bottom_left
    count = cycle.compute_pass_count(max(room, 0.0), width * _OVERLAP, "WIDG", _CUTS)
    for k in range(count + 1):
        place = shape.bottom_max_z - flank_left - width - (room * k / count if count else 0.0)
        steps += plan.plan_plunge(place, bottom)
    steps += plan.plan_flank_plunges(
        shape.bottom_max_z - flank_left - width, shape.high_flank_z_extent, width, bottom
    )
    steps += plan.plan_flank_plunges(
        shape.bottom_min_z + flank_left, -shape.low_flank_z_extent, width, bottom
    )
    if bottom_left or flank_left or count or shape.high_flank_z_extent or shape.low_flank_z_extent:
        steps += plan.plan_finishing(width)
    return cycle.make_blocks(steps)


class _Plan:
    """Planner of grooving motions; positions are a depth and Z of the tool corner with the lower Z."""

    def __init__(
        self, cycle: CycleCall, shape: GrooveGeometry, feed: float, clearance: float, corner: float
    ) -> None:
        self._cycle, self._shape, self._feed = cycle, shape, feed
        self._clear, self._corner = clearance, corner
        self._infeed, self._dwell = cycle.read_unsigned_length_mm("IDEP"), cycle.read_number("DTB")
        cycle.check_parameter(self._dwell >= 0.0, "DTB", "{name} must be a time of 0 s or more")

    def plan_plunge(self, z_position: float, bottom: float) -> list[CycleStep]:
        """Return a plunge in steps of IDEP, a dwell, and the retract.

        A short retract after each step breaks the chip.
        """
        shape = self._shape
        whole = abs(bottom - shape.surface_radius)
        text = "{name} would need {count} steps, which is too many"
        count = (
            max(self._cycle.compute_pass_count(whole, self._infeed, "IDEP", text), 1) if self._infeed else 1
        )
        steps = [self._to(self._clear, z_position)]
        for k, below in enumerate(compute_equal_depths(whole, count), 1):
            depth = shape.surface_radius - shape.outward_sign * below
            steps.append(self._to(depth, z_position, self._feed))
            if k < count:
                steps.append(self._to(depth + shape.outward_sign * DEFAULT_RETRACT_MM, z_position))
        return [*steps, *make_dwell_steps(self._dwell), self._to(self._clear, z_position)]

    def plan_flank_plunges(
        self, z_position: float, flank_extent: float, width: float, bottom: float
    ) -> list[CycleStep]:
        """Return plunges of decreasing depth that remove the material in front of a tapered flank.

        The plunges start at ``z_position`` and continue outward. ``flank_extent`` is the Z extent of the
        flank in mm.
        """
        count = self._cycle.compute_pass_count(
            abs(flank_extent), width * _OVERLAP, "ANG1", _CUTS, "Check the angles."
        )
        steps: list[CycleStep] = []
        for share in (k / (count + 1) for k in range(1, count + 1)):
            depth = bottom + (self._shape.surface_radius - bottom) * share
            steps += self.plan_plunge(z_position + flank_extent * share, depth)
        return steps

    def plan_finishing(self, width: float) -> list[CycleStep]:
        """Return the finishing moves down each flank and along the bottom to its middle."""
        shape, feed = self._shape, self._feed
        high, middle = shape.bottom_max_z - width, (shape.bottom_min_z + shape.bottom_max_z - width) / 2.0
        steps: list[CycleStep] = []
        for corner, run in (
            (high, shape.high_flank_z_extent),
            (shape.bottom_min_z, -shape.low_flank_z_extent),
        ):
            steps.append(self._to(self._clear, corner + run))
            if run:
                steps.append(self._to(shape.surface_radius, corner + run, feed))
            steps += [
                self._to(shape.bottom_radius, corner, feed),
                self._to(shape.bottom_radius, middle, feed),
                self._to(self._clear, middle),
            ]
        return steps

    def _to(self, depth: float, place: float, feed: float | None = None) -> CycleStep:
        return CycleStep(depth, place + self._corner, feed)


WRONG_PART_OFF_DEPTH = 61604
_SPEED = "{name} is {value}, which is not a valid speed for this spindle"
_DIRECTION = {3: 1, 4: -1}  # spindle direction by _SDAC


def run_part_off(cycle: CycleCall) -> Iterator[Block]:
    """Yield the blocks of CYCLE92 (part-off).

    - The tool feeds to _DIAG1 at _FF1, and then to _DIAG2 at _FF2 and _SS2 rpm.
    - If the speed limit _SV2 is specified, _SV1 is a surface speed as for G96. Otherwise, it is in rpm.
    - After the cycle, the previous speed is active again, or the cycle's last speed if there was none.

    Raises ProgramError before the first block if a parameter is invalid.
    """
    cycle.check_unsupported_parameter("_RC", "cut the chamfer or the radius with G1 before the cycle")
    cycle.check_unsupported_parameter(
        "_VARI", "the tool only retracts, because this machine has no parts catcher"
    )
    text = "{name} specifies depths measured from SPD, which is not supported"
    hint = "Enter _DIAG1 and _DIAG2 as diameters, and omit _AMODE."
    cycle.check_parameter(
        not cycle.read_whole_number("_AMODE", 0, 0, 10**8) % 100, "_AMODE", text, hint, "not-in-subset"
    )
    slow, last = _depths(cycle)
    first, second = _feeds(cycle)
    before = cycle.state.modal
    fast = _speed(cycle, before)
    rpm = cycle.read_number("_SS2")
    cycle.check_parameter(0.0 <= rpm <= cycle.state.setup.limits.max_rpm, "_SS2", _SPEED, value=rpm)
    place, surface = cycle.read_required_length_mm("SPL"), cycle.read_required_length_mm("SPD") / 2.0
    clear = surface + (cycle.read_unsigned_length_mm("_SDIS") or DEFAULT_RETRACT_MM)
    down = [
        *cycle.make_clearance_steps(clear),
        CycleStep(max(clear, cycle.x), place),
        CycleStep(clear, place),
    ]
    through = [CycleStep(last, place, second), CycleStep(clear, place)]
    return _blocks(cycle, (fast, before, rpm), [*down, CycleStep(slow, place, first)], through)


def _depths(cycle: CycleCall) -> tuple[float, float]:
    """Return the radius at which the feed is reduced and the radius at which the cut ends, in mm.

    Raises ProgramError if the parameters are inconsistent.
    """
    surface, last = cycle.read_positive_length_mm("SPD"), cycle.read_required_length_mm("_DIAG2")
    slow = cycle.read_length_mm("_DIAG1", last) if cycle.has_argument("_DIAG1") else last
    if not last <= slow <= surface:
        text = "{name} is {slow} but must be between SPD {surface} and _DIAG2 {last}"
        hint = "Enter diameters, with SPD as the largest."
        raise cycle.make_parameter_error(
            "_DIAG1", text, hint, WRONG_PART_OFF_DEPTH, slow=slow, surface=surface, last=last
        )
    return slow / 2.0, last / 2.0


def _feeds(cycle: CycleCall) -> tuple[float, float]:
    first = cycle.require_feed(cycle.read_feed("_FF1"), NO_FEED, "Write _FF1.")
    second = cycle.read_feed("_FF2") if cycle.read_number("_FF2") else first
    return first, second or first


def _speed(cycle: CycleCall, initial_modal: ModalState) -> ModalState:
    """Return the modal state with the speed that applies down to _DIAG1.

    Raises ProgramError if the spindle is stopped, or if _SV1, _SV2 or _SDAC is invalid.
    """
    value, most = cycle.read_number("_SV1"), cycle.read_number("_SV2")
    direction = cycle.read_whole_number("_SDAC", 0, 0, 4)
    if direction and direction not in _DIRECTION:
        text = "{name} cannot be {value}"
        raise cycle.make_parameter_error(
            "_SDAC", text, "Enter 3 for M3 or 4 for M4.", NO_SPINDLE_DIRECTION, value=direction
        )
    modal = initial_modal._replace(spindle=_DIRECTION.get(direction, initial_modal.spindle))
    highest = cycle.state.setup.limits.max_rpm
    fine = value >= 0.0 and most >= 0.0 and (value <= highest or most)
    cycle.check_parameter(fine, "_SV1", _SPEED, value=value)
    if value and most:
        unit = MM_S_PER_M_MIN if initial_modal.metric else MM_S_PER_FT_MIN
        modal = modal._replace(css=True, surface_speed=value * unit, max_css_rpm=most)
    elif value:
        modal = modal._replace(css=False, rpm=value)
    if not modal.spindle or not (modal.surface_speed if modal.css else modal.rpm):
        text = "the spindle is stopped, and neither _SV1 with _SDAC nor S with M3 starts it."
        raise cycle.make_call_error(NO_SPINDLE_DIRECTION, text, "Write S and M3 before this block.")
    return modal


def _blocks(
    cycle: CycleCall,
    speeds: tuple[ModalState, ModalState, float],
    first_steps: list[CycleStep],
    last_steps: list[CycleStep],
) -> Iterator[Block]:
    """Yield the blocks of the two sections of a part-off, each with its own spindle speed.

    All checks are made before the first block of the first section.
    """
    fast, before, rpm = speeds
    state = cycle.state
    slow = fast._replace(css=False, rpm=rpm) if rpm else fast
    first, last = _check_sections(cycle, ((fast, first_steps), (slow, last_steps)))
    if fast != before:
        state.set_modal_state(fast)
        yield _turning(cycle)
    for step, feed in first:
        yield cycle.make_block(step, feed)
    if slow != fast:
        state.set_modal_state(slow)
        yield _turning(cycle)
    for step, feed in last:
        yield cycle.make_block(step, feed)
    if slow != before:
        state.set_modal_state(
            state.modal._replace(
                css=before.css,
                surface_speed=before.surface_speed,
                rpm=before.rpm,
                max_css_rpm=before.max_css_rpm,
            )
        )
        if state.rpm:
            yield _turning(cycle)
        else:
            state.set_modal_state(slow)  # The spindle continues to turn, so the modal state has its speed.


def _check_sections(
    cycle: CycleCall, sections: Iterable[tuple[ModalState, list[CycleStep]]]
) -> list[list[tuple[CycleStep, float]]]:
    """Return the steps of consecutive sections with their feeds, each section in its modal state.

    The active modal state does not change. Raises ProgramError for an invalid feed.
    """
    state, before = cycle.state, cycle.state.modal
    checked = []
    try:
        for modal, steps in sections:
            state.set_modal_state(modal)
            checked.append(cycle.check_steps(steps))
            cycle.x, cycle.z = steps[-1].x, steps[-1].z
    finally:
        state.set_modal_state(before)
    return checked


def _turning(cycle: CycleCall) -> Block:
    """Return the block that runs the spindle at the active speed."""
    state = cycle.state
    text = f"G96 S{(state.css or 0.0) / MM_S_PER_M_MIN:g}" if state.css else f"S{abs(state.rpm):g}"
    return state.action(cycle.line.line_number, text, SpindleRun(state.rpm, state.css))
