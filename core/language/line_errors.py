"""Syntax errors of single program lines, for an editor that cannot wait for the proof of a long program."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, ProgramError
from core.language.program_colors import color_program_line
from core.language.source import Dialect
from core.language.syntax_colors import PLAIN_STATE, SyntaxKind


def find_line_errors(
    dialect: Dialect, line_number: int, text: str, state_before: int = PLAIN_STATE
) -> tuple[Diagnostic, ...]:
    """Return the syntax errors of a line, which was read without its context.

    ``state_before`` is the coloring state that the preceding lines pass to the line. Errors that depend on
    other lines are not found.
    """
    spans, _state = color_program_line(dialect, text, state_before)
    if all(span.kind is not SyntaxKind.ERROR for span in spans):
        return ()
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext.klartext_line import parse_line  # noqa: PLC0415 - only if needed

        error = parse_line(line_number, text).error
        return (error,) if error is not None else ()
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik import sinumerik_lexer  # noqa: PLC0415 - only if needed

        return tuple(sinumerik_lexer.lex_line(line_number, text).errors)
    return _find_omniturn_errors(line_number, text, state_before)


def _find_omniturn_errors(line_number: int, text: str, state_before: int) -> tuple[Diagnostic, ...]:
    from core.language.omniturn.omniturn_lexer import lex_line  # noqa: PLC0415 - only if needed
    from core.language.omniturn.plane_switching_lines import lex_plane_switching_line  # noqa: PLC0415 - only if needed

    if state_before == PLAIN_STATE:
        return tuple(lex_line(line_number, text).errors)
    try:
        lex_plane_switching_line(line_number, text)
    except ProgramError as fault:
        return (fault.diagnostic,)
    return ()
