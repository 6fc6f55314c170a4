"""One SINUMERIK block on its own, as it is typed in MDI (MDA): what needs other blocks is refused."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, refusal
from core.language.sinumerik.program_jumps import Steering
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import CORNERS, Line
from core.language.sinumerik.third_axis_name import OWN
from core.language.source import Source

_HINT = "Use this command in a program."
_ALONE = frozenset({Steering.DEFINE, Steering.MESSAGE})


def needs_others(source: Source, third_axis: str = OWN) -> Diagnostic | None:
    """Why the block means nothing on its own, with its column; None where it does."""
    line = lex_line(1, source.lines[0] if source.lines else "", third_axis)
    if line.errors:
        return None  # told when it is executed
    if line.skip is not None:
        return _refuse(1, "/ skips a block of a program and has no meaning here")
    if line.call or line.modal_call:
        return _refuse(line.call_column, f"{line.call} calls another program")
    if line.jump is not None and line.jump.steering not in _ALONE:
        return _refuse(line.jump.column, f"{line.jump.steering} goes to another block")
    return _words(line)


def _words(line: Line) -> Diagnostic | None:
    """A word that means something with the blocks behind it alone."""
    for word in line.words:
        if word.name in CORNERS:
            return _refuse(word.column, f"{word.text} belongs between two blocks of a contour")
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return refusal(1, column, "not-alone-mdi", f"{what}.", _HINT)
