"""Angles of straight moves, programmed with A or ``,A`` on Fanuc controls."""

from __future__ import annotations

from math import cos, radians, sin

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_state import SourceState

_SAME = 1e-6


def is_angle_word(state: SourceState, word: SourceWord) -> bool:
    """Return whether a word is the angle of a straight cut."""
    return state.source_control.is_fanuc and state.motion_code == 1 and word.letter in {"A", ",A"}


def find_angle_target(state: SourceState, statement: SourceStatement) -> tuple[float, float] | None:
    """Return the end point of a straight cut with an angle, or None if no angle is programmed.

    The angle is in degrees from the direction of Z+ toward X+. Raises ProgramError unless the line contains
    either X or Z. With neither, the end point would depend on the next line.
    """
    word = next((each for each in statement.words if is_angle_word(state, each)), None)
    if word is None:
        return None
    has_x, has_z = (any(each.letter in pair for each in statement.words) for pair in ("XU", "ZW"))
    x0, z0 = state.get_position(word)
    x, z = state.find_target(statement)
    across, along = sin(radians(word.value)), cos(radians(word.value))
    if has_x == has_z or x is None or z is None or abs(across if has_x else along) < _SAME:
        raise make_error(word.line_number, word.column, "angle-word", word=word.text)
    return (x, z0 + (x - x0) * along / across) if has_x else (x0 + (z - z0) * across / along, z)
