"""One SINUMERIK block on its own, as it is typed in MDI (MDA): what needs other blocks is refused."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, refusal
from core.language.sinumerik.program_jumps import Steering
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import CORNERS, Line
from core.language.sinumerik.third_axis_name import OWN
from core.language.source import Source
from core.message import Message

_HINT = "Use this command in a program."
_ALONE = frozenset({Steering.DEFINE, Steering.MESSAGE})


def needs_others(source: Source, third_axis: str = OWN) -> Diagnostic | None:
    """Why the block means nothing on its own, with its column; None where it does."""
    line = lex_line(1, source.lines[0] if source.lines else "", third_axis)
    if line.errors:
        return None  # told when it is executed
    if line.skip is not None:
        return _refuse(1, "/ skips a program block and has no meaning in MDI")
    if line.call or line.modal_call:
        return _refuse(
            line.call_column,
            Message("{call} calls another program and cannot be used in MDI", call=line.call),
        )
    if line.jump is not None and line.jump.steering not in _ALONE:
        return _refuse(
            line.jump.column,
            Message(
                "{steering} jumps to another block and cannot be used in MDI", steering=line.jump.steering
            ),
        )
    return _words(line)


def _words(line: Line) -> Diagnostic | None:
    """A word that means something with the blocks behind it alone."""
    for word in line.words:
        if word.name in CORNERS:
            return _refuse(
                word.column, Message("{word} is allowed only between two blocks of a contour", word=word.text)
            )
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return refusal(1, column, "not-alone-mdi", Message("{what}.", what=what), _HINT)
