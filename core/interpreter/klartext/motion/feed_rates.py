"""Feeds per revolution or per tooth (FU, FZ, M136), and the plunging factor (M103).

These feeds are converted to feeds per minute with the spindle speed that is active in their block.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from core.interpreter.klartext.klartext_state import POINT_TOLERANCE, State
from core.language.diagnostics import Severity
from core.language.klartext.klartext_faults import INPUT_VALUE_INCORRECT, WRONG_RPM, make_unsupported_error
from core.language.klartext.klartext_words import MFunction

REVOLUTION, TOOTH = "U", "Z"
MAX_FEED = 99_999.999
_TEST_ANGLE_DEG = 0.001  # degrees; test distance of a rotary move
_MIN_MM_PER_DEGREE = 1e-6  # mm per degree
_TENTHS = 10.0  # F of an INCH program is in tenths of an inch


def execute_feed_codes(state: State, codes: Sequence[MFunction]) -> None:
    """Execute M136, M137 and M103.

    M136 selects a feed per revolution, M137 selects a feed per minute, and M103 sets the plunging factor in
    percent. A change between M136 and M137 cancels the active feed, because its number has another unit.
    Raises ProgramError for M136 in an INCH program, for M103 with a Q parameter, and for a factor that is
    not above 0 and at most 100 percent.
    """
    for code in codes:
        if code.number in {136, 137}:
            _count_revolutions(state, code)
        elif code.number == 103:
            state.plunging_feed_factor = None if code.feed is None else _factor(state, code)


def _count_revolutions(state: State, code: MFunction) -> None:
    if code.number == 136 and state.mm_per_unit != 1.0:
        raise make_unsupported_error(state.line_number, code.column, "M136 in an INCH program")
    if state.is_feed_per_revolution != (code.number == 136):
        state.feed = state.tool_feed = None
    state.is_feed_per_revolution = code.number == 136


def _factor(state: State, code: MFunction) -> float:
    value = code.feed.value if code.feed is not None else None
    assert value is not None  # guaranteed by the reader
    if value.parameter_number is not None:
        raise make_unsupported_error(state.line_number, value.column, "M103 with a Q parameter")
    if not 0.0 < value.number <= 100.0:
        text = "M103 F{number} must be above 0 and at most 100 percent."
        hint = "Write M103 F20 for a fifth of the feed."
        raise state.make_error(value.column, INPUT_VALUE_INCORRECT, text, hint, number=value.number)
    return value.number / 100.0


def convert_to_feed_per_minute(state: State, feed: float, base: str, column: int) -> float:
    """Convert a feed to a feed per minute in mm, or in tenths of an inch in an INCH program.

    Raises ProgramError if the spindle is stopped, the number of teeth is unknown, or the feed is too high.
    """
    if not base:
        return feed
    word = "F under M136" if state.is_feed_per_revolution and base == REVOLUTION else f"F{base}"
    rpm = state.modal.rpm if state.modal.spindle else 0.0
    if rpm <= 0.0:
        text = "{word} depends on the spindle speed, but the spindle is stopped."
        hint = "Start the spindle with M3 or M4 before this block."
        raise state.make_error(column, WRONG_RPM, text, hint, word=word)
    made = feed * rpm * (_teeth(state, column) if base == TOOTH else 1)
    made *= 1.0 if state.mm_per_unit == 1.0 else _TENTHS
    if made > MAX_FEED:
        text = "{word} {feed} at S{rpm} gives a feed rate of {count}, which is above the maximum."
        hint = "Correct the feed rate."
        raise state.make_error(
            column, INPUT_VALUE_INCORRECT, text, hint, word=word, feed=feed, rpm=rpm, count=made
        )
    text = "{word} uses the programmed S, so the spindle override does not change the feed rate."
    state.log_finding_once(column, Severity.NOTE, "feed-by-programmed-speed", text, word=word)
    return made


def _teeth(state: State, column: int) -> int:
    tool = state.modal.tool
    row = state.setup.mill_tools.get(tool)
    if row is None or row.tooth_count < 1:
        text = "FZ is feed per tooth, but the number of teeth (CUT) of tool {tool} is not in the tool table."
        hint = "Enter the number of teeth (CUT) in the tool table, or program F."
        raise state.make_error(column, INPUT_VALUE_INCORRECT, text, hint, tool=tool)
    return row.tooth_count


def reduce_plunging_feed(state: State, feed: float | None, length: float, descent: float) -> float | None:
    """Return the feed of a downward move, reduced by the factor of M103.

    ``length`` is the length of the move, and ``descent`` is its downward Z component.
    """
    if state.plunging_feed_factor is None or feed is None or descent <= POINT_TOLERANCE:
        return feed
    return feed * min(1.0, state.plunging_feed_factor * length / descent)


def compute_rotary_feed(state: State, feed: float, targets: Mapping[str, float]) -> float:
    """Return the feed in degrees/s of a move to ``targets`` in which only rotary axes move.

    F is normally in degrees/min. Under M116, F is in mm/min of the tip relative to the workpiece. It is
    then converted with the distance of the tip from the rotary axes at the start of the move. If this
    distance is 0, F is in degrees/min.
    """
    travel_deg_by_axis = {name: goal - state.rotary_angles[name] for name, goal in targets.items()}
    whole = math.hypot(*travel_deg_by_axis.values())
    if not state.is_rotary_feed_at_tip or whole <= POINT_TOLERANCE:
        return feed / 60.0
    begin = {
        name: state.rotary_angles[name] + travel_deg_by_axis.get(name, 0.0) * _TEST_ANGLE_DEG / whole
        for name in state.rotary_angles
    }
    there, here = (
        state.kinematics.make_transform(angles, tool_length=state.tool_length_mm).convert_to_frame_point(
            state.linear_position
        )
        for angles in (begin, state.rotary_angles)
    )
    per_degree = math.dist(there, here) / _TEST_ANGLE_DEG
    return state.convert_feed_to_mm_s(feed) / per_degree if per_degree > _MIN_MM_PER_DEGREE else feed / 60.0
