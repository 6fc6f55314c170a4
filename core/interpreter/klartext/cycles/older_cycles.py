"""Cycles numbered below 200: pecking, tapping, slot, rectangular pocket and circular pocket.

The cycle numbers are 1 (pecking), 2, 17 and 18 (tapping), 3 (slot), 4 (rectangular pocket) and 5 (circular
pocket). The tool must be at the set-up clearance above the surface when such a cycle is called.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from core.geometry.lines_and_arcs import Arc, Point
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.flow.word_values import value
from core.interpreter.klartext.klartext_state import State
from core.interpreter.shared.elementary_blocks import Block
from core.language.klartext.klartext_faults import CYCLE_MISSING
from core.language.klartext.klartext_nodes import CycleLine

CycleLines = Mapping[int, CycleLine]
_MIN_LENGTH_MM = 1e-6  # mm
# overlap factor of the tool diameter; machine parameter 7430 of the control is 1.4 times the radius
_OVERLAP = 0.7
_MAX_LEVELS = 10_000


class OlderCycleData:
    """The values in the lines of a cycle numbered below 200."""

    def __init__(self, state: State, lines: CycleLines, column: int) -> None:
        self._state = state
        self._lines = lines
        self._column = column

    @property
    def cycle_number(self) -> int:
        """Return the number of the cycle, or 0 if no lines are defined."""
        return next(iter(self._lines.values())).cycle_number if self._lines else 0

    def read_number(self, line_number: int, axis: str = "") -> float:
        """Return the first number of a definition line, or the number of its word for ``axis``.

        Raises ProgramError if the number is missing.
        """
        words = self._lines[line_number].words if line_number in self._lines else ()
        word = next((each for each in words if each.axis == axis), None)
        if word is None:
            text = "Line {number}.{part} of the cycle has no {axis}."
            hint = "Complete the CYCL DEF."
            raise self._state.make_error(
                self._column,
                CYCLE_MISSING,
                text,
                hint,
                number=self.cycle_number,
                part=line_number,
                axis=axis or "number",
            )
        return value(self._state, word.value.as_formula)

    def read_length_mm(self, line_number: int, axis: str = "") -> float:
        """Return the first number or an axis word of a definition line, converted to mm."""
        return self.read_number(line_number, axis) * self._state.mm_per_unit

    def read_feed(self, line_number: int) -> float | None:
        """Return the feed of a line as programmed, or None for a rapid."""
        line = self._lines.get(line_number)
        return word_values.evaluate_feed(self._state, line.feed if line else None, self._column)

    def read_cutting_feed(self, line_number: int) -> float:
        """Return the cutting feed of a line per minute, or the active feed if the line has no F word.

        Raises ProgramError for a rapid, or if there is no valid feed.
        """
        found = self.read_feed(line_number)
        if found is None:
            text = "A pocket cannot be milled at rapid."
            raise self._state.make_error(self._column, CYCLE_MISSING, text, "Write F in CYCL DEF.")
        return found

    def read_direction(self, line_number: int) -> float:
        """Return the direction of rotation, which is 1 for DR+ (counterclockwise) or -1 for DR-."""
        line = self._lines.get(line_number)
        return -1.0 if line is not None and line.rotation_direction == "-" else 1.0

    def has_axis_word(self, line_number: int, axis: str) -> bool:
        """Return whether a definition line has a word for this axis."""
        return line_number in self._lines and any(
            word.axis == axis for word in self._lines[line_number].words
        )


def _pecking(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 1, which drills in pecks with full retracts.

    After each retract, a rapid returns to just above the last depth.
    """
    clear, feed = tool.z_position, data.read_feed(5)
    depth, step = abs(data.read_length_mm(2)), abs(data.read_length_mm(3))
    surface = clear - data.read_length_mm(1)
    near = 0.6 if depth <= 30.0 else min(depth / 50.0, 7.0)
    for done in _levels(tool, depth, step):
        yield tool.move_to_z(surface - done, feed)
        if done < depth:
            yield tool.move_to_z(clear)
            yield tool.move_to_z(min(clear, surface - done + near))
    yield from tool.make_dwell_blocks(data.read_number(4))
    yield tool.move_to_z(clear)


def _tapping(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of tapping with a feed (cycle 2) or with a pitch (cycle 17).

    The sign of the pitch determines the direction.
    """
    rigid = data.cycle_number == _RIGID
    clear, before = tool.z_position, tool.signed_rpm
    if rigid:
        tool.warn_about_unsynchronized_z()
    lead = data.read_length_mm(3) if rigid else tool.convert_feed_to_lead(data.read_cutting_feed(4))
    rpm, lead = tool.compute_thread_rpm(lead) if rigid else tool.running_rpm, abs(lead)
    yield from tool.set_spindle_speed(rpm)
    yield tool.make_tapping_block(
        clear - data.read_length_mm(1) - abs(data.read_length_mm(2)), lead, is_in_hole=True
    )
    if not rigid:
        yield from tool.make_dwell_blocks(data.read_number(3), is_in_hole=True)
    yield tool.run_spindle(-rpm, is_in_hole=True)
    yield tool.make_tapping_block(clear, lead)
    yield from tool.set_spindle_speed(before)


def _slot(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 3, a slot milled level by level.

    On each level, the tool mills along the first side. After the last level, it mills once around the slot
    at the full width.
    """
    first, second = _sides(data, 4), _sides(data, 5)
    (x, y), clear = tool.xy_position, tool.z_position
    end = x + first[0], y + first[1]
    text = "The slot of cycle 3 has no length."
    tool.check_condition(
        math.hypot(*first) > _MIN_LENGTH_MM, text, "Write the length of the slot in line 3.4."
    )
    width = (abs(second[0]) + abs(second[1])) / 2.0 - tool.radius_mm
    tool.check_condition(width >= -_MIN_LENGTH_MM, "The tool is wider than the slot.", "Use a smaller tool.")
    surface, feed = clear - data.read_length_mm(1), data.read_cutting_feed(6)
    ends = [(x, y), end]
    for at, done in enumerate(_levels(tool, abs(data.read_length_mm(2)), abs(data.read_length_mm(3)))):
        yield tool.move_to_z(surface - done, data.read_feed(3))
        yield tool.move_straight(ends[1 - at % 2], None, feed)
    if width > _MIN_LENGTH_MM:
        yield from _round_slot(tool, (x, y), end, width, feed)
    yield tool.move_to_z(clear)
    yield tool.move_straight((x, y))


def _round_slot(tool: CycleTool, start: Point, end: Point, width: float, feed: float) -> Iterator[Block]:
    length = math.dist(start, end)
    u = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    v = -u[1] * width, u[0] * width
    corners = [
        (start[0] - v[0], start[1] - v[1]),
        (end[0] - v[0], end[1] - v[1]),
        (end[0] + v[0], end[1] + v[1]),
        (start[0] + v[0], start[1] + v[1]),
    ]
    for corner in (*corners, corners[0]):
        yield tool.move_straight(corner, None, feed)


def _pocket(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 4, a pocket milled in rectangles from the center out on each level."""
    (x, y), clear = tool.xy_position, tool.z_position
    half = (
        abs(data.read_length_mm(4, "X")) / 2.0 - tool.radius_mm,
        abs(data.read_length_mm(5, "Y")) / 2.0 - tool.radius_mm,
    )
    tool.check_condition(
        min(half) >= -_MIN_LENGTH_MM, "The tool is wider than the pocket.", "Use a smaller tool."
    )
    surface, feed, turn = clear - data.read_length_mm(1), data.read_cutting_feed(6), data.read_direction(6)
    count = _ring_count(tool, min(half))
    for done in _levels(tool, abs(data.read_length_mm(2)), abs(data.read_length_mm(3))):
        yield tool.move_straight((x, y), None, feed)
        yield tool.move_to_z(surface - done, data.read_feed(3))
        for ring in range(1, count + 1):
            inset = min(half) * (1.0 - ring / count)
            a, b = half[0] - inset, half[1] - inset
            corners = [
                (x + a, y - turn * b),
                (x + a, y + turn * b),
                (x - a, y + turn * b),
                (x - a, y - turn * b),
            ]
            for corner in (*corners, corners[0]):
                yield tool.move_straight(corner, None, feed)
    yield tool.move_to_z(clear)
    yield tool.move_straight((x, y))


def _circular_pocket(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 5, a pocket milled in circles from the center out on each level."""
    (x, y), clear = tool.xy_position, tool.z_position
    radius = abs(data.read_length_mm(4, "R" if data.has_axis_word(4, "R") else "")) - tool.radius_mm
    tool.check_condition(
        radius >= -_MIN_LENGTH_MM, "The tool is wider than the pocket.", "Use a smaller tool."
    )
    surface, feed, turn = clear - data.read_length_mm(1), data.read_cutting_feed(5), data.read_direction(5)
    count = _ring_count(tool, radius)
    for done in _levels(tool, abs(data.read_length_mm(2)), abs(data.read_length_mm(3))):
        yield tool.move_straight((x, y), None, feed)
        yield tool.move_to_z(surface - done, data.read_feed(3))
        for ring in range(1, count + 1):
            start = x + radius * ring / count, y
            yield tool.move_straight(start, None, feed)
            yield tool.move_on_arc(Arc(start, start, (x, y), clockwise=turn < 0.0), tool.z_position, feed)
    yield tool.move_to_z(clear)
    yield tool.move_straight((x, y))


def _thread_cutting(data: OlderCycleData, tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 18, which cuts a thread from the tool position to the depth.

    The feed is pitch times spindle speed. The spindle stops at the depth.
    """
    tool.warn_about_unsynchronized_z()
    rpm, pitch, depth = tool.programmed_rpm, data.read_length_mm(2), data.read_length_mm(1)
    text = "Cycle 18 needs a spindle speed and a pitch."
    tool.check_condition(rpm and pitch, text, "Program S in TOOL CALL and PITCH in cycle 18.")
    yield tool.run_spindle(rpm if pitch > 0.0 else -rpm)
    yield tool.make_tapping_block(tool.z_position + depth, abs(pitch), is_in_hole=True)
    yield tool.stop_spindle()


def _ring_count(tool: CycleTool, width: float) -> int:
    """Return the number of rings from the center of a pocket to its wall."""
    step = tool.radius_mm * 2.0 * _OVERLAP
    return max(1, math.ceil(width / step)) if step > _MIN_LENGTH_MM else 1


def _sides(cycle_data: OlderCycleData, part: int) -> Point:
    return (
        cycle_data.read_length_mm(part, "X") if cycle_data.has_axis_word(part, "X") else 0.0,
        cycle_data.read_length_mm(part, "Y") if cycle_data.has_axis_word(part, "Y") else 0.0,
    )


def _levels(tool: CycleTool, depth: float, step: float) -> Iterator[float]:
    """Yield the depth after each infeed, ending with the total depth."""
    if step <= 0.0 or step >= depth:
        yield depth
        return
    count = math.ceil(depth / step - 1e-9)
    text = "An infeed of {step} mm would need {count} passes, which is too many."
    tool.check_condition(count <= _MAX_LEVELS, text, "Increase the infeed.", step=step, count=count)
    yield from (min(step * at, depth) for at in range(1, count + 1))


_RIGID = 17
OLDER_CYCLES: dict[int, Callable[[OlderCycleData, CycleTool], Iterator[Block]]] = {
    1: _pecking,
    2: _tapping,
    3: _slot,
    4: _pocket,
    5: _circular_pocket,
    17: _tapping,
    18: _thread_cutting,
}
"""Functions that run the older cycles, by cycle number."""

LAST_LINE_NUMBERS = {1: 5, 2: 4, 3: 6, 4: 6, 5: 5, 17: 3, 18: 2}
"""Last line number after the decimal point, by cycle number.

The control rejects a cycle with a missing line.
"""
