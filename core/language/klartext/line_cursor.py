"""A place on a line, and the words that can be taken from there. Case-blind; columns count from 1."""

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
    """``TRANS DATUM`` with any blanks between, and no letter behind."""
    return re.compile(r"\s+".join(map(re.escape, words.split())) + r"(?![A-Z])")


class Cursor(LineReader):
    """Reads one line from left to right; ``upper`` is the line in capitals, of the same length."""

    def __init__(self, line: int, text: str, at: int = 0) -> None:
        super().__init__(ascii_upper(text), at)
        self.line = line
        self.text = text
        self.blanks()

    @property
    def column(self) -> int:
        """Column of what comes next."""
        return self.at + 1

    @property
    def done(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.upper)

    @property
    def next_word(self) -> str:
        """What comes next up to a blank, as written."""
        match = _WORD.match(self.text, self.at)
        return match.group() if match else ""

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Return what the pattern matches here, and move to what follows; None without a match."""
        match = pattern.match(self.upper, self.at)
        if match is not None:
            self.at = after_blanks(self.upper, match.end())
        return match

    def keyword(self, *choices: str) -> str | None:
        """The first of the keywords that stands here; go behind it."""
        for words in choices:
            if self.take(_keyword(words)):
                return words
        return None

    def rest(self) -> str:
        """All that is left, as written."""
        text = self.text[self.at :].strip()
        self.at = len(self.upper)
        return text

    def value(self, what: str) -> Value:
        """A signed number or Q parameter. Raises ProgramError naming ``what`` lacks one."""
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
        """A number; no Q parameter here."""
        column, match = self.column, self.take(_PLAIN)
        if match is None:
            raise self.expected(Message("{what} has no number", what=what), "Enter a number.")
        return Value(_number(*match.groups()), column=column)

    def whole(self, what: str, most: int) -> int:
        """A whole number without a sign, up to ``most``."""
        column, match = self.column, self.take(_WHOLE)
        if match is None:
            raise self.expected(Message("{what} needs a whole number", what=what))
        digits = match.group()
        if len(digits) > 9 or int(digits) > most:
            text = Message("{what} accepts numbers up to {maximum}.", what=what, maximum=most)
            raise fault(self.line, column, INPUT_VALUE, text, "Correct the number.")
        return int(digits)

    def name(self, what: str, most: int) -> int | str:
        """A number, or a name in quotes."""
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
        """All that is left as the name of a file, in quotes or not; empty where nothing is."""
        self._demand_no_text()
        return self.rest().strip('"')

    def _demand_no_text(self) -> None:
        """Raises ProgramError for a text parameter that is to hold a name."""
        if _TEXT_PARAMETER.match(self.upper, self.at):
            raise STRING.error(self.line, self.column)

    def quoted(self) -> str | None:
        """What stands in quotes here; None where nothing does."""
        start = self.at
        match = self.take(_QUOTED)
        return None if match is None else self.text[start + 1 : start + len(match.group(1)) + 1]

    def expected(self, message: str, hint: str = "") -> ProgramError:
        """A syntax error here, saying what stands in the place."""
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
        """Raise ProgramError with this message where anything follows."""
        if not self.done:
            raise self.expected(message, hint)

    def advice(self, hint: str) -> str:
        """A hint, and what to do where text or a typographic character stands in the place."""
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


# --- words that several blocks share: feeds, retracts, axis words


_FEED = re.compile(r"F\s*(MAX|AUTO)(?![A-Z0-9])")
_FEED_VALUE = re.compile(r"F([UZ]?)(?=\s*[+-]?\s*[0-9.,Q])")
_FEED_TIME = re.compile(r"F(?:MAX)?T(?=\s*[0-9.,Q])")
_FEED_WORD = re.compile(r"F(?![A-Z])")
_RETRACT = re.compile(r"MB(?![A-Z])|MB(?=MAX)")


def feed(cursor: Cursor) -> Feed | None:
    """``F200``, ``FQ5``, ``FU0.1``, ``FZ0.05``, ``FMAX``, ``F AUTO`` where one stands here."""
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
    """``MB50``, ``MB 50``, ``MB MAX`` where one stands here."""
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
    """All axis words that stand here, each letter once. Raises ProgramError for a doubled one."""
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
    """Return all words that are here, by name, each once; the group of the pattern is the name.

    Raises ProgramError for a word that is here twice.
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
    """Raise ProgramError for a word that the block already has."""
    if known:
        raise doubled(cursor, column, what)


def doubled(cursor: Cursor, column: int, what: str) -> ProgramError:
    """Return the error for a word that is programmed twice."""
    text = Message("{word} is programmed twice in the block.", word=what)
    return syntax(cursor.line, column, text, "Remove one of the two.")
