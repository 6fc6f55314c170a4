"""Arcs with G02 and G03, defined by the radius R or by the center words I and K."""

from __future__ import annotations

from math import degrees, dist, pi

from core.geometry.lines_and_arcs import Point, compute_arc_length, find_arc_center
from core.interpreter.omniturn.codes.code_rules import check_conditions, check_word_groups, check_word_number
from core.interpreter.omniturn.motion.feeds import check_move_feed
from core.interpreter.omniturn.motion.straight_moves import (
    check_move_after_tool,
    round_to_resolution,
    set_position,
    warn_about_unintended_rapid,
)
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared import units
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message

_TOLERANCE = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)
_TOLERANCE_MM = 1e-9  # mm
_ROUNDING_TOLERANCE = 0.01  # radians; tolerance for rounded end points and centers at half a circle


def make_arc_block(state: State, statement: Statement) -> Block:
    """Return the block of an arc.

    Raises ProgramError if its words do not define an arc, if the arc is not allowed in the active modes or
    as the first move after T, or if its feed is missing or invalid. The position of the state is the end
    point even after an error.
    """
    x, z = round_to_resolution(state, statement, "X"), round_to_resolution(state, statement, "Z")
    start, programmed = (state.x, state.z), (state.px, state.pz)
    set_position(
        state, x, z
    )  # The position is set before any error, so that later lines start from the correct point.
    check_move_after_tool(state, statement.line, x, z)
    check_conditions(state, statement, statement.code_entry)
    check_word_groups(statement, statement.code_entry)
    clockwise = statement.one_shot_code == 2
    if "R" in statement.words:
        centre = _centre_by_radius(state, statement, start, clockwise=clockwise)
    else:
        centre = _center_by_words(state, statement, programmed)
        _check_radii(state, statement, dist(start, centre), dist((state.x, state.z), centre))
    length = compute_arc_length(start, (state.x, state.z), centre, is_clockwise=clockwise)
    check_move_feed(state, statement.line, start[0], state.x, length)
    _warn_about_large_arc(state, statement, length / dist(start, centre))
    warn_about_unintended_rapid(state, statement.line)
    return state.move(
        BlockKind.ARC,
        statement.line,
        statement.get_block_text("move"),
        (*start, state.c),
        state.feed,
        is_feed_per_rev=state.per_rev,
        rpm=state.compute_rpm_at(state.x),
        surface_speed=state.modal.active_surface_speed,
        center=centre,
        is_clockwise=clockwise,
    )


def _warn_about_large_arc(state: State, statement: Statement, sweep: float) -> None:
    """Log a warning for an arc of more than half a circle with I and K.

    An insert can rarely cut such an arc, so the direction code is probably wrong.
    """
    if pi + _ROUNDING_TOLERANCE < sweep < 2.0 * pi - _ROUNDING_TOLERANCE:
        text = "The arc spans {sweep} degrees."
        hint = "Check G02 and G03, and the signs of I and K."
        state.log.add_warning(
            statement.line, statement.code_column, "arc-over-half", text, hint, sweep=f"{degrees(sweep):.0f}"
        )


def _centre_by_radius(state: State, statement: Statement, start: Point, *, clockwise: bool) -> Point:
    radius = check_word_number(state, statement, "R", round_to_resolution(state, statement, "R")) or 0.0
    chord = dist(start, (state.x, state.z))
    if chord <= _TOLERANCE_MM:
        text = "The arc programmed with R ends at its start point."
        raise statement.make_error("R", "arc-no-chord", text, "Program a full circle with I and K.")
    if chord > 2 * radius + _TOLERANCE:
        shown, half = state.modal.format_length(radius), state.modal.format_length(chord / 2)
        text = Message(
            "R is {value}; an arc between these points needs a radius of {half} or more.",
            value=shown,
            half=half,
        )
        hint = "Correct R or the end point."
        halved = dist((start[0] / 2, start[1]), (state.x / 2, state.z))
        if not state.modal.diameter and halved <= 2 * radius + _TOLERANCE:
            hint = "G73 is active, so X is a radius. If the X words are diameters, write G72 before them."
        raise statement.make_error("R", "arc-radius", text, hint)
    return find_arc_center(start, (state.x, state.z), radius, is_clockwise=clockwise)


def _center_by_words(state: State, statement: Statement, start: Point) -> Point:
    """Return the center of an arc that is programmed with I and K.

    I and K are coordinates under G90 with G73, and distances from the start point otherwise.
    """
    i, k = round_to_resolution(state, statement, "I"), round_to_resolution(state, statement, "K")
    if state.modal.diameter or not state.absolute:
        return start[0] + (i or 0.0) + state.secondary_x, start[1] + (k or 0.0) + state.secondary_z
    if i is None or k is None:
        letter = "I" if i is None else "K"
        given = "K" if i is None else "I"
        text = "{letter} is missing; with G90 and G73 active, I and K are the coordinates of the arc center."
        raise statement.make_error(given, "arc-coordinate-missing", text, "Add {letter}.", letter=letter)
    return i + state.secondary_x, k + state.secondary_z


def _check_radii(state: State, statement: Statement, first: float, last: float) -> None:
    if first <= _TOLERANCE_MM:
        text = "The arc center is at the start point of the arc."
        raise statement.make_error("", "arc-no-radius", text, "Correct I and K.")
    if abs(first - last) <= _TOLERANCE:
        return
    text = Message(
        "The arc's radius is {first} at its start and {last} at its end.",
        first=state.modal.format_length(first),
        last=state.modal.format_length(last),
    )
    if state.modal.diameter or not state.absolute:
        hint = "On this line, I and K are distances from the start point of the arc."
    else:
        hint = "On this line, I and K are the coordinates of the arc center."
    raise statement.make_error("", "arc-radius", text, hint)
