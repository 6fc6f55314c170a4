"""Entry point for the syntax coloring of all languages."""

from __future__ import annotations

from core.language.source import Dialect
from core.language.syntax_colours import PLAIN, Span


def spans(dialect: Dialect, text: str, before: int = PLAIN) -> tuple[list[Span], int]:
    """Return the colored spans of a line, with errors last, and the state for the next line.

    ``before`` is the state that the previous line returned. The module of a language is imported on first
    use.
    """
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext import klartext_colours

        return klartext_colours.spans(text, before)
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik import sinumerik_colours

        return sinumerik_colours.spans(text), PLAIN
    from core.language.omniturn import omniturn_colours

    return omniturn_colours.spans(text, before)
