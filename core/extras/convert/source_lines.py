"""Lines of a source program: comments, block numbers, words and assignments."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.expressions import ExpressionReader, Variables
from core.extras.convert.source_options import SourceControl

_BLOCK = re.compile(r"\s*(?P<delete>/\d?)?\s*(?:N\s*(?P<n>\d+(?:\.\d+)?))?\s*", re.IGNORECASE)
_PROGRAM = re.compile(r"\s*[O:]\s*(?P<o>\d+)(?!\d)\s*(?P<rest>.*)", re.IGNORECASE)
_O_WORD = re.compile(r"\s*O\s*(?P<o>\d+|<[^>]+>)\s*(?P<key>[A-Za-z]+)(?P<rest>.*)", re.IGNORECASE)


class SourceLine(NamedTuple):
    """One line of the source program.

    ``code`` is the text with comments replaced by blanks. ``n`` is the block number, or 0 if it has none.
    If the line has an O word, ``o_word`` is its number or name and ``o_keyword`` its keyword.
    ``words_start_index`` is the index at which the other words begin.
    """

    line_number: int
    code: str
    comment: str
    text: str
    n: float = 0
    o_word: str = ""
    o_keyword: str = ""
    words_start_index: int = 0
    has_block_delete: bool = False


class SourceWord(NamedTuple):
    """A word of a source line, such as X1.5.

    ``has_decimal_point`` is False only for a number without a decimal point.
    """

    letter: str
    value: float
    has_decimal_point: bool
    line_number: int
    column: int
    text: str


@dataclass(frozen=True, slots=True)
class SourceStatement:
    """The words of a source line with their values, in the order in which they are written."""

    line_number: int
    words: tuple[SourceWord, ...]
    comment: str = ""

    def find_word(self, letter: str) -> SourceWord | None:
        """Return the last word of the line with this letter, or None if the letter does not occur."""
        return next((each for each in reversed(self.words) if each.letter == letter), None)

    def find_words(self, letter: str) -> Sequence[SourceWord]:
        """Return all words of the line with this letter."""
        return [each for each in self.words if each.letter == letter]

    def has_g_code(self, *codes: float) -> bool:
        """Return whether the line contains one of these G codes."""
        return any(each.letter == "G" and each.value in codes for each in self.words)


def split_lines(texts: Sequence[str], control: SourceControl) -> list[SourceLine]:
    """Return the lines of a source program.

    Raises ProgramError if a comment has no end.
    """
    return [_line(number, text, control) for number, text in enumerate(texts, start=1)]


def _line(number: int, text: str, control: SourceControl) -> SourceLine:
    code, comment = _without_comments(number, text)
    if code.lstrip().startswith("%"):
        return SourceLine(number, "", comment, text)
    head = _BLOCK.match(code)
    assert head is not None
    n, deleted, start = float(head["n"] or 0), head["delete"] is not None, head.end()
    o_word = _O_WORD.match(code, start)
    if control is SourceControl.LINUXCNC and o_word is not None:
        return SourceLine(
            number,
            code,
            comment,
            text,
            n,
            o_word["o"].lower(),
            o_word["key"].lower(),
            o_word.start("rest"),
            deleted,
        )
    program = _PROGRAM.match(code, start)
    if program is not None:
        return SourceLine(number, code, comment, text, n, program["o"], "", program.start("rest"), deleted)
    return SourceLine(number, code, comment, text, n, words_start_index=start, has_block_delete=deleted)


def _without_comments(number: int, text: str) -> tuple[str, str]:
    code: list[str] = []
    comments: list[str] = []
    at = 0
    while at < len(text):
        if text[at] == "(":
            end = text.find(")", at)
            if end < 0:
                raise make_error(number, at + 1, "parentheses")
            comments.append(text[at + 1 : end].strip())
            code.append(" " * (end + 1 - at))
            at = end + 1
        elif text[at] == ";":
            comments.append(text[at + 1 :].strip())
            break
        else:
            code.append(text[at])
            at += 1
    return "".join(code).rstrip(), " ".join(filter(None, comments))


def read_words(line: SourceLine, variables: Variables) -> SourceStatement:
    """Return a line's words and assign its variables. Raises ProgramError if a word is invalid."""
    reader = ExpressionReader(line.line_number, line.code, variables, line.words_start_index)
    assigned: dict[str, float] = {}
    words = tuple(_words(reader, assigned))
    variables.update(assigned)
    return SourceStatement(line.line_number, words, line.comment)


def _words(reader: ExpressionReader, assigned: dict[str, float]) -> Iterator[SourceWord]:
    while reader.peek_character():
        begin = reader.at
        if reader.peek_character() == "#":
            key = reader.read_variable_key()
            if not reader.skip_text("="):
                raise make_error(reader.line, begin + 1, "bad-word", text=reader.text[begin : begin + 24])
            assigned[key] = reader.read_expression()
            continue
        corner = reader.skip_text(",")
        letter = reader.peek_character().upper()
        if not letter.isalpha():
            raise make_error(reader.line, begin + 1, "bad-word", text=reader.text[begin : begin + 24])
        reader.at += 1
        value, has_point = reader.read_value()
        text = reader.text[begin : reader.at].strip()
        yield SourceWord(("," if corner else "") + letter, value, has_point, reader.line, begin + 1, text)
