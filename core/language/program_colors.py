"""Interface to the syntax coloring of all dialects."""

from __future__ import annotations

from collections.abc import Callable

from core.language.source import Dialect
from core.language.syntax_colors import PLAIN_STATE, ColoredSpan


def color_program_line(
    dialect: Dialect, text: str, state_before: int = PLAIN_STATE
) -> tuple[list[ColoredSpan], int]:
    """Return the colored spans of a line, with errors last, and the state for the next line.

    ``state_before`` is the state that was returned for the previous line. The module of a dialect is
    imported on first use.
    """
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext import klartext_colors

        return klartext_colors.color_line(text, state_before)
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik import sinumerik_colors

        return sinumerik_colors.color_line(text), PLAIN_STATE
    from core.language.omniturn import omniturn_colors

    return omniturn_colors.color_line(text, state_before)


MAX_LINES_BACK = 20_000
"""Number of lines before a line that can determine its colors."""


def find_coloring_start(
    dialect: Dialect,
    line: int,
    read_line: Callable[[int], str],
    find_last_line_with: Callable[[str, int], int],
) -> int:
    """Return the line from which the coloring can begin with ``PLAIN_STATE`` to color ``line``.

    Lines count from 0. ``find_last_line_with`` returns the last line before a line that contains a
    character, or -1.
    """
    if dialect is Dialect.SINUMERIK:
        return line
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext.klartext_line import CONTINUATION_SIGN

        start = line
        while start > max(0, line - MAX_LINES_BACK) and read_line(start - 1).rstrip().endswith(
            CONTINUATION_SIGN
        ):
            start -= 1
        return start
    from core.language.omniturn.plane_switching_lines import parse_plane_switching_start

    start = find_last_line_with("~", line)
    while start >= max(0, line - MAX_LINES_BACK):
        if parse_plane_switching_start(read_line(start)) is not None:
            return start
        start = find_last_line_with("~", start)
    return line
