"""Arcs of a source program, programmed by G02 and G03 with R, or with I and K."""

from __future__ import annotations

from math import dist, hypot, sqrt

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_state import SourceState

_TOLERANCE = 0.0005 * 25.4  # mm; OmniTurn rejects larger differences of the radii
_SAME = 1e-6  # mm


def append_arc(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the arc that a line programs. Raises ProgramError if feed, center or radius is invalid."""
    if state.feed is None:
        raise make_error(code.line_number, code.column, "feed-missing")
    if state.plane_code != 18:
        plane = f"G{state.plane_code:g}"
        raise make_error(code.line_number, code.column, "plane", word=code.text, plane=plane)
    start = state.get_position(code)
    x, z = state.find_target(statement)
    assert x is not None
    assert z is not None
    clockwise = state.motion_code == 2
    if state.options.front:
        clockwise = not clockwise
    r, i, k = (statement.find_word(letter) for letter in "RIK")
    if r is not None:
        for each in (i, k):
            if each is not None:
                state.add_warning(each, "left-out", word=each.text)
        center = _center(start, (x, z), state.convert_length(r), r, clockwise=clockwise)
    elif i is not None or k is not None:
        center = (
            start[0] + (state.convert_length(i) if i is not None else 0.0),
            start[1] + (state.convert_length(k) if k is not None else 0.0),
        )
    else:
        raise make_error(code.line_number, code.column, "arc-centre")
    first, last = dist(start, center), dist((x, z), center)
    if abs(first - last) > _TOLERANCE or first < _SAME:
        raise make_error(
            code.line_number, code.column, "arc-radius", first=f"{first:.4f}", last=f"{last:.4f}"
        )
    # OmniTurn sees X+ downward, so that the direction is reversed.
    state.append_move(
        StepKind.ARC, statement.line_number, x, z, cx=center[0], cz=center[1], clockwise=not clockwise,
        feed=state.feed, per_rev=state.is_feed_per_rev,
    )  # fmt: skip


def _center(
    start: tuple[float, float], end: tuple[float, float], r: float, word: SourceWord, *, clockwise: bool
) -> tuple[float, float]:
    dx, dz = end[0] - start[0], end[1] - start[1]
    chord = hypot(dx, dz)
    if chord < _SAME or chord / 2 > abs(r) + _TOLERANCE:
        raise make_error(word.line_number, word.column, "arc-too-small", radius=f"{word.value:g}")
    height = sqrt(max(r * r - chord * chord / 4, 0.0))
    side = height / chord * (1 if clockwise == (r > 0) else -1)
    # To the right of the travel with Z to the right and X upward.
    return (start[0] + end[0]) / 2 - dz * side, (start[1] + end[1]) / 2 + dx * side
