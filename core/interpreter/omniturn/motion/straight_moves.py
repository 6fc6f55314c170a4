"""Straight moves: the meaning of X and Z, rounding to the resolution, and checks of all moves."""

from __future__ import annotations

from math import copysign, floor, hypot, isfinite

from core.interpreter.omniturn.motion.feeds import check_move_feed, set_plain_move_feed
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import PlainMove, Statement
from core.interpreter.shared import units
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import make_program_error
from core.language.omniturn import Word, lex_line
from core.message import Message

_COARSE = (0.00005, 0.00025, 0.0005)  # inches of radius, by G36, G35, G35F2
_DIAMETERS = frozenset({"X"})  # words that are diameters under G72
ROUNDING_TOLERANCE = 1e-6  # of a step; tolerance for the rounding of decimal fractions


def make_plain_move_block(state: State, line: int, text: str, move: PlainMove) -> Block | None:
    """Return the block of a line with only G00 or G01, X, Z and F.

    The result is None if the line must be executed as a full statement. Raises the same errors as
    ``make_straight_move``.
    """
    x, z, f, g, fine = move
    same = (g < 0 and f is None) or are_words_already_active(state, g, f)
    if not same and (g == 0 or f is None or not set_plain_move_feed(state, f)):
        return None
    # Numbers with four decimal places are multiples of every resolution except a coarse one.
    if fine or state.modal.coarse:
        x, z = round_coordinates(state, line, text, x, z)
    if x is not None:
        x *= state.mm_per_x_unit
    if z is not None:
        z *= state.mm_per_z_unit
    return make_straight_move(state, line, text, x, z)


def are_words_already_active(state: State, g: int, f: float | None) -> bool:
    """Return whether the G00 or G01 and the F of a line are already active.

    ``g`` is negative if the line has no G code, and ``f`` is None if the line has no F.
    """
    if g == 0:
        return f is None and state.modal.rapid and not state.title_rapid
    if state.steady_feed is None:
        return g < 0 and f is None
    return f is None or state.convert_feed(f) == state.steady_feed


def make_statement_move(state: State, statement: Statement) -> Block:
    """Return the straight move of a line after all checks. Raises ProgramError if a check fails."""
    x, z = round_to_resolution(state, statement, "X"), round_to_resolution(state, statement, "Z")
    state.fast = False
    return make_straight_move(state, statement.line, statement.get_block_text("move"), x, z)


def make_straight_move(state: State, line: int, text: str, x: float | None, z: float | None) -> Block:
    """Return the straight move to X and Z in mm, where None is a word that is not programmed.

    If ``state.fast`` is True, an earlier move with this state passed all checks, so only the length is
    checked. Raises ProgramError if a check fails.
    """
    x0, z0 = state.x, state.z
    if state.absolute:  # This is the same as ``set_position`` but avoids the call.
        state.px = state.px if x is None else x
        state.pz = state.pz if z is None else z
    else:
        state.px += x or 0.0
        state.pz += z or 0.0
    state.x = x1 = state.px + state.secondary_x
    state.z = z1 = state.pz + state.secondary_z
    if state.fast:
        if state.cut and abs(x1 - x0) + abs(z1 - z0) > state.slow_length_mm:
            check_move_feed(state, line, x0, x1, hypot(x1 - x0, z1 - z0))
        rpm, surface_speed = state.rpm, None
    else:
        check_move_after_tool(state, line, x, z)
        check_move_feed(state, line, x0, x1, hypot(x1 - x0, z1 - z0))
        warn_about_unintended_rapid(state, line)
        modal = state.modal
        rpm, surface_speed = state.compute_rpm_at(x1), modal.active_surface_speed
        # The limit of G95 depends on the spindle speed, which changes between moves only under G96.
        state.fast = (
            not modal.css and not modal.coarse and not state.reported and not state.contour.is_buffering
        )
    state.blocks = n = state.blocks + 1
    c = state.c
    return Block(
        n, line, state.kind, text, x0, z0, c, x1, z1, c, state.offset_x, state.offset_z,
        state.modal, state.feed, state.per_rev, rpm, surface_speed,
    )  # fmt: skip


def set_position(state: State, x: float | None, z: float | None) -> None:
    """Set the position to X and Z in mm under G90 or G91, including the secondary offset."""
    if state.absolute:
        state.px = state.px if x is None else x
        state.pz = state.pz if z is None else z
    else:
        state.px += x or 0.0
        state.pz += z or 0.0
    state.x, state.z = state.px + state.secondary_x, state.pz + state.secondary_z


def check_move_after_tool(state: State, line: int, x: float | None, z: float | None) -> None:
    """Raise ProgramError (``tool-first-move``) unless the first motion after a T word has X and Z."""
    tool_line, state.tool_line = state.tool_line, 0
    if tool_line and (x is None or z is None):
        where = Message("the T word on line {tool_line}", tool_line=tool_line) if tool_line > 0 else "the T"
        text = Message(
            "The first move after {place} has no {ending}.", place=where, ending="X" if x is None else "Z"
        )
        raise make_program_error(
            line, 0, "tool-first-move", text, "Write both X and Z, or write G92 before this move."
        )


def warn_about_unintended_rapid(state: State, line: int) -> None:
    """Log a warning if a move is a rapid only because of a line such as ``G00 (TITLE)``."""
    if state.title_rapid and state.modal.rapid:
        text = "This move is a rapid because of the G00 next to the comment on line {title_rapid}."
        hint = "Write G01 if the move is meant to cut."
        state.log.add_warning(line, 0, "title-rapid", text, hint, title_rapid=state.title_rapid)
    state.title_rapid = 0


def round_to_resolution(state: State, statement: Statement, letter: str) -> float | None:
    """Return a length word in mm, rounded to the resolution, or None without the word.

    X is a radius according to G72 or G73. A warning is logged if the number was rounded.
    """
    word = statement.words.get(letter)
    if word is None or word.value is None or not isfinite(word.value):
        return None
    value, finer = _nearest_step(state, letter, word.value)
    if finer:
        _warn_of_finer(state, statement.line, word, value)
    return value * (state.mm_per_x_unit if letter in _DIAMETERS else state.mm_per_z_unit)


def round_mill_length(state: State, line: int, word: Word) -> float:
    """Return a length word of the virtual mill in mm, rounded to the resolution.

    The length is never halved. A warning is logged if the number was rounded.
    """
    step = units.METRIC_STEP_MM if state.modal.metric else _COARSE[state.modal.coarse]
    value, finer = _nearest(step, word.value or 0.0)
    if finer:
        text = "{word} is finer than the resolution; {value} is used."
        hint = "Round the number."
        state.log.add_warning(
            line, word.column, "finer-than-step", text, hint, word=word.text, value=f"{value:.5f}"
        )
    return value * state.mm_per_z_unit


def round_coordinates(
    state: State, line: int, text: str, x: float | None, z: float | None
) -> tuple[float | None, float | None]:
    """Return X and Z of a line rounded to the resolution, and log a warning for each rounded word."""
    new_x, x_finer = (None, False) if x is None else _nearest_step(state, "X", x)
    new_z, z_finer = (None, False) if z is None else _nearest_step(state, "Z", z)
    if x_finer or z_finer:
        for word in lex_line(line, text).words:
            if word.letter not in {"X", "Z"}:
                continue
            value, finer = _nearest_step(state, word.letter, word.value or 0.0)
            if finer:
                _warn_of_finer(state, line, word, value)
    return new_x, new_z


def get_resolution(state: State, letter: str) -> float:
    """Return the resolution of the control for a letter, in the unit of the program."""
    modal = state.modal
    if modal.metric:
        return units.METRIC_STEP_MM
    return _COARSE[modal.coarse] * (2 if modal.diameter and letter in _DIAMETERS else 1)


def _nearest_step(state: State, letter: str, value: float) -> tuple[float, bool]:
    """Return the number rounded to the resolution, and whether rounding changed the number."""
    return _nearest(get_resolution(state, letter), value)


def _nearest(step: float, value: float) -> tuple[float, bool]:
    count = value / step
    whole = copysign(
        floor(abs(count) + 0.5 + ROUNDING_TOLERANCE), count
    )  # half a step is rounded away from zero
    if abs(count - whole) <= max(ROUNDING_TOLERANCE, abs(count) * 1e-12):
        return value, False
    return whole * step, True


def _warn_of_finer(state: State, line: int, word: Word, value: float) -> None:
    name = "mm" if state.modal.metric else "in"
    step = f"{get_resolution(state, word.letter):.5f}".rstrip("0")
    state.log.add_warning(
        line,
        word.column,
        "finer-than-step",
        "{word} is finer than the resolution of {step} {name}; {value} is used.",
        "Round the number.",
        word=word.text,
        step=step,
        name=name,
        value=f"{value:.5f}",
    )


def execute_dimension_modes(state: State, statement: Statement) -> None:
    """Execute the codes of a line for absolute or incremental distances, units, and X as a diameter."""
    if not statement.modal_codes:
        return
    modal = state.modal
    for code in statement.modal_codes:
        if code in {90, 91}:
            modal = modal._replace(absolute=code == 90)
        elif code in {70, 71}:
            modal = modal._replace(metric=code == 71)
        elif code in {72, 73}:
            modal = modal._replace(diameter=code == 72)
    state.set_modal(modal)
