"""Drilling cycles G81 (one pass) and G83 (pecks), along Z from the start point."""

from __future__ import annotations

from core.interpreter.omniturn.codes.code_rules import check_word_number
from core.interpreter.omniturn.cycles.canned_cycles import LIFT_MM, check_pass_count, read_length_mm
from core.interpreter.omniturn.motion.straight_moves import round_to_resolution
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared import units
from core.interpreter.shared.contour_passes import CycleMove, count_passes

_RETRACT_RATE = 200 * units.MM_PER_INCH / 60  # mm/s, without L
_ROUNDING_TOLERANCE = 1e-6  # of a peck; tolerance for the rounding of decimal fractions


def plan_drilling(state: State, statement: Statement) -> list[CycleMove]:
    """Return the motions of G81: a feed move to Z, and a rapid back to the start.

    Raises ProgramError for invalid words.
    """
    moves = _position(state, statement)
    x = moves[-1].x if moves else state.x
    depth = _depth(state, statement)
    return [*moves, CycleMove(x, depth), CycleMove(x, state.z, state.modal.rapid_rate)]


def plan_pecking(state: State, statement: Statement) -> list[CycleMove]:
    """Return the motions of G83, which drills in pecks of depth K.

    After each peck, the tool retracts to R and returns to the distance C above the last depth. The last
    peck drills the remaining depth. The cycle ends at the start point. Raises ProgramError for invalid
    words.
    """
    moves = _position(state, statement)
    x = moves[-1].x if moves else state.x
    start, depth = state.z, _depth(state, statement)
    peck = read_length_mm(state, statement, "K")
    if peck > (start - depth) * (1.0 + _ROUNDING_TOLERANCE):
        deep = state.modal.format_length(start - depth)
        state.log.add_warning(
            statement.line,
            statement.words["K"].column,
            "peck-depth",
            "{text}: the peck exceeds the hole depth of {depth}.",
            "Correct K, or drill with G81.",
            text=statement.words["K"].text,
            depth=deep,
        )
    count = count_passes(start - depth, peck)
    check_pass_count(statement, "K", count, "pecks")
    rate, clear = _rate(state, statement), LIFT_MM
    if "C" in statement.words:
        clear = read_length_mm(state, statement, "C")
    out = _retract(state, statement, max(start - peck, depth))
    for k in range(1, count + 1):
        reached = depth if k == count else start - k * peck
        moves += [CycleMove(x, reached), CycleMove(x, out, rate)]
        if k < count and reached + clear < out:
            moves.append(CycleMove(x, reached + clear, rate))
    return [*moves, CycleMove(x, start, rate)]


def _position(state: State, statement: Statement) -> list[CycleMove]:
    """Return the move to the X position of the hole, or an empty list if X is not programmed."""
    x = round_to_resolution(state, statement, "X")
    if x is None:
        return []
    return [
        CycleMove(x + (state.secondary_x if state.absolute else state.x), state.z, state.modal.rapid_rate)
    ]


def _depth(state: State, statement: Statement) -> float:
    depth = read_length_mm(state, statement, "Z") + (state.secondary_z if state.absolute else state.z)
    if depth >= state.z:
        raise statement.make_error(
            "Z",
            "cycle-depth",
            "The bottom of the hole at {depth} is not deeper than the start point at {z}.",
            "Correct Z, or move the start point farther away from the part.",
            depth=state.modal.format_length(depth),
            z=state.modal.format_length(state.z),
        )
    return depth


def _retract(state: State, statement: Statement, first: float) -> float:
    """Return the Z position of the retract, which is R if programmed, or else the start point."""
    r = round_to_resolution(state, statement, "R")
    if r is None:
        return state.z
    out = r + (state.secondary_z if state.absolute else state.z)
    text = "{text} is inside the hole, at or below the depth of the first peck."
    hint = "R is the Z position to which the drill retracts from the hole."
    statement.check_condition(out > first, "R", "cycle-retract", text, hint, text=statement.words["R"].text)
    return out


def _rate(state: State, statement: Statement) -> float:
    """Return the feed rate L of the retract and return moves, or its default, in mm/s."""
    value = statement.get_value("L")
    if value is None:
        return min(_RETRACT_RATE, state.setup.limits.max_feed_mm_s)
    rate = value * units.get_mm_per_unit(is_metric=state.modal.metric) / 60
    return check_word_number(state, statement, "L", rate) or 0.0
