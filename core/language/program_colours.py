"""One door to the colours of all languages."""

from __future__ import annotations

from core.language.source import Dialect
from core.language.syntax_colours import PLAIN, Span


def spans(dialect: Dialect, text: str, before: int = PLAIN) -> tuple[list[Span], int]:
    """The coloured parts of a line, faults last so that they are seen, and the state for the next line.

    ``before`` is what the line before handed on. A language is loaded when a text of it is shown.
    """
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext import klartext_colours

        return klartext_colours.spans(text, before)
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik import sinumerik_colours

        return sinumerik_colours.spans(text), PLAIN
    from core.language.omniturn import omniturn_colours

    return omniturn_colours.spans(text, before)
