"""Cursor of a Klartext line, and readers of the words at the cursor.

Case is ignored. Columns count from 1.
"""

from __future__ import annotations

import re
from functools import lru_cache

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import INPUT_VALUE, STRING, fault, syntax, unsupported
from core.language.klartext.klartext_nodes import AxisWord, Feed, Retract, Value
from core.language.line_reading import LineReader, after_blanks, ascii_upper, typed
from core.message import Message

NUMBER = r"(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)"
_VALUE = re.compile(rf"([+-]?)\s*(?:({NUMBER})|(Q[LR]?)\s*([0-9]+))(?![0-9.,])")
_PLAIN = re.compile(rf"([+-]?)\s*({NUMBER})(?![0-9.,])")
_TEXT = re.compile(r"\(?[^\W\d_]{3}|\(")
_WHOLE = re.compile(r"[0-9]+(?![0-9.,])")
_QUOTED = re.compile(r'"([^"]*)"')
_WORD = re.compile(r"[^\s]+")
_TEXT_PARAMETER = re.compile(r"QS\s*[0-9]")
_HIGHEST_Q = 1999


@lru_cache(maxsize=256)
def _keyword(words: str) -> re.Pattern[str]:
    """Return a pattern for a keyword such as ``TRANS DATUM``.

    Any blanks may separate its words, and no letter may follow the last word.
    """
    return re.compile(r"\s+".join(map(re.escape, words.split())) + r"(?![A-Z])")


class Cursor(LineReader):
    """Reader of one line from left to right; ``upper`` is the line in capitals, with the same length."""

    def __init__(self, line: int, text: str, at: int = 0) -> None:
        super().__init__(ascii_upper(text), at)
        self.line = line
        self.text = text
        self.blanks()

    @property
    def column(self) -> int:
        """Column of the next character."""
        return self.at + 1

    @property
    def done(self) -> bool:
        """Whether the end of the line is reached."""
        return self.at >= len(self.upper)

    @property
    def next_word(self) -> str:
        """The text from here to the next blank, as written."""
        match = _WORD.match(self.text, self.at)
        return match.group() if match else ""

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Return the match of the pattern at the cursor, or None without a match.

        After a match, the cursor is past the match and the blanks after it.
        """
        match = pattern.match(self.upper, self.at)
        if match is not None:
            self.at = after_blanks(self.upper, match.end())
        return match

    def keyword(self, *choices: str) -> str | None:
        """Read the first of these keywords that is at the cursor; return None without a match."""
        for words in choices:
            if self.take(_keyword(words)):
                return words
        return None

    def rest(self) -> str:
        """Read the rest of the line, as written."""
        text = self.text[self.at :].strip()
        self.at = len(self.upper)
        return text

    def value(self, what: str) -> Value:
        """Read a signed number or a Q parameter. Raises ProgramError if it is missing.

        The message names ``what``.
        """
        column, match = self.column, self.take(_VALUE)
        if match is None:
            raise self.expected(
                Message("{what} has no value", what=what), "Write a number such as +10, or a Q parameter."
            )
        sign, number, kind, q = match.groups()
        if q is not None:
            high = self._q(int(q) if len(q) <= 4 else _HIGHEST_Q + 1, column)
            return Value(0.0, high, sign == "-", column, kind)
        return Value(_number(sign, number), column=column)

    def number(self, what: str) -> Value:
        """Read a number, but not a Q parameter. Raises ProgramError if it is missing.

        The message names ``what``.
        """
        column, match = self.column, self.take(_PLAIN)
        if match is None:
            raise self.expected(Message("{what} has no number", what=what), "Enter a number.")
        return Value(_number(*match.groups()), column=column)

    def whole(self, what: str, most: int) -> int:
        """Read an unsigned whole number up to ``most``. Raises ProgramError if it is missing or too large."""
        column, match = self.column, self.take(_WHOLE)
        if match is None:
            raise self.expected(Message("{what} needs a whole number", what=what))
        digits = match.group()
        if len(digits) > 9 or int(digits) > most:
            text = Message("{what} accepts numbers up to {maximum}.", what=what, maximum=most)
            raise fault(self.line, column, INPUT_VALUE, text, "Correct the number.")
        return int(digits)

    def name(self, what: str, most: int) -> int | str:
        """Read a number or a name in quotation marks. Raises ProgramError if it is missing or invalid."""
        self._demand_no_text()
        start = self.at
        match = self.take(_QUOTED)
        if match is None:
            return self.whole(what, most)
        name = self.text[start + 1 : start + len(match.group(1)) + 1]
        if not name.strip():
            raise syntax(
                self.line, start + 1, Message("{what} has an empty name.", what=what), "Write the name."
            )
        return name

    def file(self) -> str:
        """Read the rest of the line as a file name, without quotation marks.

        The result is empty if nothing remains.
        """
        self._demand_no_text()
        return self.rest().strip('"')

    def _demand_no_text(self) -> None:
        """Raise ProgramError if a string parameter is used as a name."""
        if _TEXT_PARAMETER.match(self.upper, self.at):
            raise STRING.error(self.line, self.column)

    def quoted(self) -> str | None:
        """Read a text in quotation marks; return None if the cursor is not at a quotation mark."""
        start = self.at
        match = self.take(_QUOTED)
        return None if match is None else self.text[start + 1 : start + len(match.group(1)) + 1]

    def expected(self, message: str, hint: str = "") -> ProgramError:
        """Return a syntax error at the cursor, with the text found there."""
        here = (
            Message("; found '{next_word}'", next_word=self.next_word)
            if not self.done
            else "; the line ends here"
        )
        return syntax(
            self.line,
            self.column,
            Message("{message}{position}.", message=message, position=here),
            self.advice(hint),
        )

    def demand_end(self, message: str, hint: str = "") -> None:
        """Raise ProgramError with this message if anything follows."""
        if not self.done:
            raise self.expected(message, hint)

    def advice(self, hint: str) -> str:
        """Return the hint, or a better hint if the cursor is at plain text or at a typographic character."""
        word = "" if self.done else self.next_word
        instead = next(filter(None, map(typed, word)), None)
        if instead is not None:
            return instead[1]
        return (
            Message("{hint} A comment begins with a semicolon (;).", hint=hint).lstrip()
            if _TEXT.match(word)
            else hint
        )

    def _q(self, number: int, column: int) -> int:
        if number > _HIGHEST_Q:
            text = Message("Q parameters go up to Q{highest_q}.", highest_q=_HIGHEST_Q)
            raise fault(self.line, column, INPUT_VALUE, text, "Use a parameter with a smaller number.")
        return number


def _number(sign: str, digits: str) -> float:
    number = float(digits.replace(",", "."))
    return -number if sign == "-" and number else number


# --- words of several blocks: feeds, retracts, axis words


_FEED = re.compile(r"F\s*(MAX|AUTO)(?![A-Z0-9])")
_FEED_VALUE = re.compile(r"F([UZ]?)(?=\s*[+-]?\s*[0-9.,Q])")
_FEED_TIME = re.compile(r"F(?:MAX)?T(?=\s*[0-9.,Q])")
_FEED_WORD = re.compile(r"F(?![A-Z])")
_RETRACT = re.compile(r"MB(?![A-Z])|MB(?=MAX)")


def feed(cursor: Cursor) -> Feed | None:
    """Read a feed such as ``F200``, ``FQ5``, ``FU0.1``, ``FMAX`` or ``F AUTO``.

    Returns None without F. Raises ProgramError for a feed that is invalid or not supported.
    """
    column = cursor.column
    fixed = cursor.take(_FEED)
    if fixed is not None:
        return Feed(fixed.group(1).lower(), None, column)
    if _FEED_TIME.match(cursor.upper, cursor.at):
        raise unsupported(cursor.line, column, "Feed specified by travel time (FT, FMAXT)")
    if match := cursor.take(_FEED_VALUE):
        return Feed("value", cursor.value(match.group()), column, match.group(1))
    if cursor.take(_FEED_WORD):
        raise cursor.expected("F has no value", "Write a number, a Q parameter, MAX or AUTO after F.")
    return None


def retract(cursor: Cursor) -> Retract | None:
    """Read ``MB50``, ``MB 50`` or ``MB MAX``; return None without MB."""
    column = cursor.column
    if cursor.take(_RETRACT) is None:
        return None
    if cursor.keyword("MAX"):
        return Retract(None, column)
    return Retract(cursor.number("MB"), column)


@lru_cache(maxsize=16)
def _axis_word(letters: str, incremental: bool) -> re.Pattern[str]:
    return re.compile(rf"({'I?' if incremental else ''})([{letters}])(?=\s*[+\-0-9.,Q])")


def axis_words(cursor: Cursor, letters: str, *, incremental: bool = True) -> tuple[AxisWord, ...]:
    """Read all axis words at the cursor. Raises ProgramError if a letter is repeated."""
    pattern = _axis_word(letters, incremental)
    found: list[AxisWord] = []
    while True:
        column, match = cursor.column, cursor.take(pattern)
        if match is None:
            return tuple(found)
        sign, axis = match.groups()
        if any(word.axis == axis for word in found):
            raise doubled(cursor, column, f"{sign}{axis}")
        found.append(AxisWord(axis, cursor.value(f"{sign}{axis}"), sign == "I", column))


def words_once(cursor: Cursor, pattern: re.Pattern[str]) -> dict[str, AxisWord]:
    """Read all words at the cursor, and return them by name, which is the group of the pattern.

    Raises ProgramError if a word is repeated.
    """
    found: dict[str, AxisWord] = {}
    while True:
        column, match = cursor.column, cursor.take(pattern)
        if match is None:
            return found
        name = match[1]
        demand_once(cursor, column, name in found, name)
        found[name] = AxisWord(name, cursor.value(name), column=column)


def demand_once(cursor: Cursor, column: int, known: object, what: str) -> None:
    """Raise ProgramError if the block already has the word."""
    if known:
        raise doubled(cursor, column, what)


def doubled(cursor: Cursor, column: int, what: str) -> ProgramError:
    """Return the error for a word that is programmed twice."""
    text = Message("{word} is programmed twice in the block.", word=what)
    return syntax(cursor.line, column, text, "Remove one of the two.")
