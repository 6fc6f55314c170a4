"""Grooving with CYCLE93, with straight or tapered flanks, outside or inside, and part-off with CYCLE92.

WIDG is the width of the bottom, and SPL is the corner of the surface at which the groove begins. Tapered
flanks make the groove wider toward the surface. The tool width is the distance between its two cutting edges,
D and _DN in the tool table, or D+1 without _DN, as on the original control.

Part-off is slower near the axis. The active edge moves down at SPL. The meaning of the parameters of CYCLE92
follows the manufacturer's operating manuals, and their names and order follow published lists. The digits of
``_DMODE`` and ``_AMODE`` are not documented, so that only depths as diameters are accepted.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import radians, tan
from typing import NamedTuple

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.contour_passes import equal_depths
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import Modal
from core.interpreter.shared.units import FEET_PER_MINUTE, METRES_PER_MINUTE
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    NO_DIRECTION,
    NO_FEED,
    RETRACT,
    Cycle,
    Step,
    dwell,
)
from core.tool_edges import edge_key, edge_name, edge_of, tool_of

WRONG_WIDTH = 61602
WRONG_FORM = 61603
_SAME = 1e-6  # mm
_STEEPEST = 89.999  # degrees
_USUAL_WIDTH = 3.0  # mm; assumed width of a tool that is not in the table
_CUTS = "{name} would need {count} cuts, which is too many"
_OVERLAP = 0.95  # of the tool width; the maximum offset between adjacent cuts


class Groove(NamedTuple):
    """Geometry of a groove in mm, with X as a radius.

    ``out`` is the sign of X from the bottom to the opening.

    The bottom extends from ``low`` to ``high`` along Z. The flanks extend ``low_run`` and ``high_run``
    farther at the ``top``.
    """

    out: float
    top: float
    bottom: float
    low: float
    high: float
    low_run: float = 0.0
    high_run: float = 0.0


def groove_of(cycle: Cycle) -> Groove:
    """Return the groove of a call. Raises ProgramError with the name of an invalid parameter."""
    kind = (cycle.machining("VARI", range(1, 19)) - 1) % 10 + 1
    cycle.check(kind <= 8, "VARI", "{name} must be 1 to 8 or 11 to 18", "Correct the value.", 61002)
    cycle.zero_only("STA1", "program a groove on a taper as a CYCLE95 contour")
    for name in ("RCO1", "RCO2", "RCI1", "RCI2"):
        cycle.zero_only(name, "program the corners as a CYCLE95 contour, or chamfer them with G1")
    text = "{name} is {kind}, which specifies a face groove and is not supported"
    hint = "Program a face groove as a CYCLE95 contour or in G1 blocks."
    cycle.check(kind % 2 != 0, "VARI", text, hint, "not-in-subset", kind=kind)
    inside, right = kind in {3, 7}, kind > 4
    x, z = cycle.over_zero("SPD") / 2.0, cycle.needed("SPL")
    width, depth = cycle.over_zero("WIDG"), cycle.over_zero("DIAG", WRONG_FORM)
    out = -1.0 if inside else 1.0
    here, there = _run(cycle, "ANG1", depth), _run(cycle, "ANG2", depth)
    low, high = (z - here - width, z - here) if right else (z + here, z + here + width)
    runs = (there, here) if right else (here, there)
    text = "{name} makes the groove reach past the spindle centerline"
    cycle.check(x - out * depth >= 0.0, "DIAG", text, "Correct SPD or DIAG.", WRONG_FORM)
    return Groove(out, x, x - out * depth, low, high, *runs)


def _run(cycle: Cycle, name: str, depth: float) -> float:
    """Return the Z extent of a flank from the bottom to the surface, in mm. Raises ProgramError."""
    angle = cycle.number(name)
    text = "{name} must be a flank angle from 0 to less than 90 degrees"
    cycle.check(0.0 <= angle <= _STEEPEST, name, text)
    return depth * tan(radians(angle))


def tool_width(cycle: Cycle, widest: float) -> tuple[float, bool]:
    """Return the width of the tool in mm, and whether the active edge is its lower corner.

    A tool that is not in the table gets at most the width ``widest``, with a warning; such a program cannot
    start. Raises ProgramError if the table has only one of the two edges.
    """
    state = cycle.state
    key, tools = state.modal.tool, state.setup.tools
    cycle.demand_tool()
    number = cycle.whole("_DN", 0, 0, 9) or edge_of(key) + 1
    other = edge_key(tool_of(key), number)
    if key not in tools and other not in tools:
        width = min(_USUAL_WIDTH, widest)
        text = "{call} assumes a tool {width} mm wide because {key} is not set."
        hint = "Set both tool corners on the TOOL OFFSETS page (F8)."
        cycle.warn("tool-width", text, hint, width=width, key=edge_name(key))
        return width, False
    if key not in tools or other not in tools:
        name = edge_name(other)
        text = "{call} needs the tool width, but the other tool corner ({name}) is not set."
        hint = "Set {other} on the TOOL OFFSETS page (F8)."
        raise cycle.refused(WRONG_WIDTH, text, hint, name=name, other=edge_name(other))
    here, there = tools[key], tools[other]
    # A corner farther in the plus direction has the smaller machine position at part zero.
    way = here.z - there.z
    text = "{key} and {other} are at the same position, so the tool has no width."
    hint = "Correct the offsets of the two tool corners."
    cycle.require(abs(way) >= _SAME, WRONG_WIDTH, text, hint, key=edge_name(key), other=edge_name(other))
    return abs(way), way > 0.0


def groove(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE93: adjacent cuts in steps of IDEP, then flanks and bottom.

    Raises ProgramError for invalid parameters.
    """
    shape = groove_of(cycle)
    bottom_left, flank_left = cycle.size("FAL1"), cycle.size("FAL2")
    width, at_low = tool_width(cycle, shape.high - shape.low - 2.0 * flank_left)
    room = shape.high - shape.low - 2.0 * flank_left - width
    text = "{name} is {high} including FAL2 on both flanks, but the tool is {width} wide"
    hint = "Use a narrower tool."
    cycle.check(room >= -_SAME, "WIDG", text, hint, WRONG_WIDTH, high=shape.high - shape.low, width=width)
    feed = cycle.known_feed(cycle.state.modal.feed)
    off = cycle.size("_VRT") or RETRACT
    plan = _Plan(cycle, shape, feed, shape.top + shape.out * off, 0.0 if at_low else width)
    steps = cycle.off_part(shape.top + shape.out * off, shape.out)
    bottom = shape.bottom + shape.out * bottom_left
    count = cycle.pass_count(max(room, 0.0), width * _OVERLAP, "WIDG", _CUTS)
    for k in range(count + 1):
        place = shape.high - flank_left - width - (room * k / count if count else 0.0)
        steps += plan.plunge(place, bottom)
    steps += plan.beside(shape.high - flank_left - width, shape.high_run, width, bottom)
    steps += plan.beside(shape.low + flank_left, -shape.low_run, width, bottom)
    if bottom_left or flank_left or count or shape.high_run or shape.low_run:
        steps += plan.finish(width)
    return cycle.blocks(steps)


class _Plan:
    """Motions by depth and Z position of the lower tool corner."""

    def __init__(self, cycle: Cycle, shape: Groove, feed: float, clear: float, corner: float) -> None:
        self._cycle, self._shape, self._feed = cycle, shape, feed
        self._clear, self._corner = clear, corner
        self._infeed, self._dwell = cycle.size("IDEP"), cycle.number("DTB")
        cycle.check(self._dwell >= 0.0, "DTB", "{name} must be a time of 0 s or more")

    def plunge(self, place: float, bottom: float) -> list[Step]:
        """Return a plunge in steps of IDEP, a dwell, and the retract.

        A short retract after each step breaks the chip.
        """
        shape = self._shape
        whole = abs(bottom - shape.top)
        text = "{name} would need {count} steps, which is too many"
        count = max(self._cycle.pass_count(whole, self._infeed, "IDEP", text), 1) if self._infeed else 1
        steps = [self._to(self._clear, place)]
        for k, below in enumerate(equal_depths(whole, count), 1):
            depth = shape.top - shape.out * below
            steps.append(self._to(depth, place, self._feed))
            if k < count:
                steps.append(self._to(depth + shape.out * RETRACT, place))
        return [*steps, *dwell(self._dwell), self._to(self._clear, place)]

    def beside(self, place: float, run: float, width: float, bottom: float) -> list[Step]:
        """Return plunges from ``place`` outward under a flank with the extent ``run``, each less deep."""
        count = self._cycle.pass_count(abs(run), width * _OVERLAP, "ANG1", _CUTS, "Check the angles.")
        steps: list[Step] = []
        for share in (k / (count + 1) for k in range(1, count + 1)):
            depth = bottom + (self._shape.top - bottom) * share
            steps += self.plunge(place + run * share, depth)
        return steps

    def finish(self, width: float) -> list[Step]:
        """Return the finishing moves down each flank and along the bottom to the middle."""
        shape, feed = self._shape, self._feed
        high, middle = shape.high - width, (shape.low + shape.high - width) / 2.0
        steps: list[Step] = []
        for corner, run in ((high, shape.high_run), (shape.low, -shape.low_run)):
            steps.append(self._to(self._clear, corner + run))
            if run:
                steps.append(self._to(shape.top, corner + run, feed))
            steps += [
                self._to(shape.bottom, corner, feed),
                self._to(shape.bottom, middle, feed),
                self._to(self._clear, middle),
            ]
        return steps

    def _to(self, depth: float, place: float, feed: float | None = None) -> Step:
        return Step(depth, place + self._corner, feed)


WRONG_DEPTH = 61604
_SPEED = "{name} is {value}, which is not a valid speed for this spindle"
_DIRECTION = {3: 1, 4: -1}  # spindle direction by _SDAC


def part_off(cycle: Cycle) -> Iterator[Block]:
    """Yield the blocks of CYCLE92: down to _DIAG1 at _FF1, then to _DIAG2 at _FF2 and _SS2 rpm.

    With the limit _SV2, _SV1 is a surface speed as for G96; otherwise it is in rpm. After the cycle, the
    previous speed is active again, or the last speed of the cycle if there was none. Raises ProgramError
    before the first block.
    """
    cycle.zero_only("_RC", "cut the chamfer or the radius with G1 before the cycle")
    cycle.zero_only("_VARI", "the tool only retracts, because this machine has no parts catcher")
    text = "{name} specifies depths measured from SPD, which is not supported"
    hint = "Enter _DIAG1 and _DIAG2 as diameters, and omit _AMODE."
    cycle.check(not cycle.whole("_AMODE", 0, 0, 10**8) % 100, "_AMODE", text, hint, "not-in-subset")
    slow, last = _depths(cycle)
    first, second = _feeds(cycle)
    before = cycle.state.modal
    fast = _speed(cycle, before)
    rpm = cycle.number("_SS2")
    cycle.check(0.0 <= rpm <= cycle.state.setup.limits.max_rpm, "_SS2", _SPEED, value=rpm)
    place, surface = cycle.needed("SPL"), cycle.needed("SPD") / 2.0
    clear = surface + (cycle.size("_SDIS") or RETRACT)
    down = [*cycle.off_part(clear), Step(max(clear, cycle.x), place), Step(clear, place)]
    through = [Step(last, place, second), Step(clear, place)]
    return _blocks(cycle, (fast, before, rpm), [*down, Step(slow, place, first)], through)


def _depths(cycle: Cycle) -> tuple[float, float]:
    """Return the radii at which the tool slows down and stops. Raises ProgramError."""
    surface, last = cycle.over_zero("SPD"), cycle.needed("_DIAG2")
    slow = cycle.length("_DIAG1", last) if cycle.given("_DIAG1") else last
    if not last <= slow <= surface:
        text = "{name} is {slow} but must be between SPD {surface} and _DIAG2 {last}"
        hint = "Enter diameters, with SPD as the largest."
        raise cycle.wrong("_DIAG1", text, hint, WRONG_DEPTH, slow=slow, surface=surface, last=last)
    return slow / 2.0, last / 2.0


def _feeds(cycle: Cycle) -> tuple[float, float]:
    first = cycle.known_feed(cycle.feed("_FF1"), NO_FEED, "Write _FF1.")
    second = cycle.feed("_FF2") if cycle.number("_FF2") else first
    return first, second or first


def _speed(cycle: Cycle, before: Modal) -> Modal:
    """Return the modal state with the speed that applies down to _DIAG1.

    Raises ProgramError if the spindle does not run.
    """
    value, most = cycle.number("_SV1"), cycle.number("_SV2")
    direction = cycle.whole("_SDAC", 0, 0, 4)
    if direction and direction not in _DIRECTION:
        text = "{name} cannot be {value}"
        raise cycle.wrong("_SDAC", text, "Enter 3 for M3 or 4 for M4.", NO_DIRECTION, value=direction)
    modal = before._replace(spindle=_DIRECTION.get(direction, before.spindle))
    highest = cycle.state.setup.limits.max_rpm
    fine = value >= 0.0 and most >= 0.0 and (value <= highest or most)
    cycle.check(fine, "_SV1", _SPEED, value=value)
    if value and most:
        unit = METRES_PER_MINUTE if before.metric else FEET_PER_MINUTE
        modal = modal._replace(css=True, surface_speed=value * unit, css_max=most)
    elif value:
        modal = modal._replace(css=False, rpm=value)
    if not modal.spindle or not (modal.surface_speed if modal.css else modal.rpm):
        text = "the spindle is stopped, and neither _SV1 with _SDAC nor S with M3 starts it."
        raise cycle.refused(NO_DIRECTION, text, "Write S and M3 before this block.")
    return modal


def _blocks(
    cycle: Cycle, speeds: tuple[Modal, Modal, float], down: list[Step], through: list[Step]
) -> Iterator[Block]:
    """Yield the blocks of both sections, each at its speed. All checks are in the first section."""
    fast, before, rpm = speeds
    state = cycle.state
    slow = fast._replace(css=False, rpm=rpm) if rpm else fast
    if fast != before:
        state.adopt(fast)
        yield _turning(cycle)
    yield from cycle.blocks(down)
    cycle.x, cycle.z = down[-1].x, down[-1].z
    if slow != fast:
        state.adopt(slow)
        yield _turning(cycle)
    yield from cycle.blocks(through)
    if slow != before:
        state.adopt(state.modal._replace(css=before.css, surface_speed=before.surface_speed, rpm=before.rpm,
                                         css_max=before.css_max))  # fmt: skip
        if state.rpm:
            yield _turning(cycle)
        else:
            state.adopt(slow)  # The spindle continues to turn, so the modal state has its speed.


def _turning(cycle: Cycle) -> Block:
    """Return the block that runs the spindle at the active speed."""
    state = cycle.state
    text = f"G96 S{(state.css or 0.0) / METRES_PER_MINUTE:g}" if state.css else f"S{abs(state.rpm):g}"
    return state.action(cycle.line.number, text, SpindleRun(state.rpm, state.css))
