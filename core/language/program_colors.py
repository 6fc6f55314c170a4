"""Interface to the syntax coloring of all dialects."""

from __future__ import annotations

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
