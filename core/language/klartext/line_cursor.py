"""Cursor in a Klartext line, and parsers of the words at the cursor.

Case is ignored. Columns count from 1.
"""

from __future__ import annotations

import re
from functools import lru_cache

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import (
    INPUT_VALUE_INCORRECT,
    STRING_FUNCTIONS,
    make_klartext_error,
    make_syntax_error,
    make_unsupported_error,
)
from core.language.klartext.klartext_words import AxisWord, FeedWord, RetractWord, Value
from core.language.line_reading import (
    LineReader,
    describe_typographic_character,
    find_non_blank,
    uppercase_ascii,
)
from core.message import Message

NUMBER_PATTERN = r"(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)"
_VALUE = re.compile(rf"([+-]?)\s*(?:({NUMBER_PATTERN})|(Q[LR]?)\s*([0-9]+))(?![0-9.,])")
_PLAIN = re.compile(rf"([+-]?)\s*({NUMBER_PATTERN})(?![0-9.,])")
_TEXT = re.compile(r"\(?[^\W\d_]{3}|\(")
_WHOLE = re.compile(r"[0-9]+(?![0-9.,])")
_QUOTED = re.compile(r'"([^"]*)"')
_WORD = re.compile(r"[^\s]+")
_TEXT_PARAMETER = re.compile(r"QS\s*[0-9]")
_MAX_Q_NUMBER = 1999


@lru_cache(maxsize=256)
def _keyword(words: str) -> re.Pattern[str]:
    """Return a pattern for a keyword such as ``TRANS DATUM``.

    Any number of blanks may separate its words, and no letter may follow the last word.
    """
    return re.compile(r"\s+".join(map(re.escape, words.split())) + r"(?![A-Z])")


class LineCursor(LineReader):
    """Cursor that reads one line from left to right.

    ``uppercase_text`` is the line in capitals, with the same length.
    """

    def __init__(self, line: int, text: str, index: int = 0) -> None:
        super().__init__(uppercase_ascii(text), index)
        self.line_number = line
        self.text = text
        self.skip_blanks()

    @property
    def column(self) -> int:
        """Return the column of the next character."""
        return self.index + 1

    @property
    def is_at_end(self) -> bool:
        """Return whether the cursor is at the end of the line."""
        return self.index >= len(self.uppercase_text)

    @property
    def next_word(self) -> str:
        """Return the text from the cursor to the next blank, as written."""
        match = _WORD.match(self.text, self.index)
        return match.group() if match else ""

    def match_pattern(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Return the match of the pattern at the cursor, or None if the pattern does not match.

        After a match, the cursor is after the matched text and the following blanks.
        """
        match = pattern.match(self.uppercase_text, self.index)
        if match is not None:
            self.index = find_non_blank(self.uppercase_text, match.end())
        return match

    def read_keyword(self, *choices: str) -> str | None:
        """Read the first of these keywords that is at the cursor, or return None if none of them is."""
        for words in choices:
            if self.match_pattern(_keyword(words)):
                return words
        return None

    def read_remaining_text(self) -> str:
        """Read the rest of the line, as written."""
        text = self.text[self.index :].strip()
        self.index = len(self.uppercase_text)
        return text

    def read_value(self, description: str) -> Value:
        """Read a signed number or a Q parameter.

        Raises ProgramError with ``description`` in the message if the value is missing. Also raises
        ProgramError for a Q parameter above Q1999.
        """
        column, match = self.column, self.match_pattern(_VALUE)
        if match is None:
            raise self.make_expected_error(
                Message("{what} has no value", what=description),
                "Write a number such as +10, or a Q parameter.",
            )
        sign, number, kind, q = match.groups()
        if q is not None:
            high = self._q(int(q) if len(q) <= 4 else _MAX_Q_NUMBER + 1, column)
            return Value(0.0, high, sign == "-", column, kind)
        return Value(_number(sign, number), column=column)

    def read_number(self, description: str) -> Value:
        """Read a number, but not a Q parameter.

        Raises ProgramError with ``description`` in the message if the number is missing.
        """
        column, match = self.column, self.match_pattern(_PLAIN)
        if match is None:
            raise self.make_expected_error(
                Message("{what} has no number", what=description), "Enter a number."
            )
        return Value(_number(*match.groups()), column=column)

    def read_whole_number(self, description: str, maximum: int) -> int:
        """Read an unsigned whole number up to ``maximum``.

        Raises ProgramError if the number is missing or too large.
        """
        column, match = self.column, self.match_pattern(_WHOLE)
        if match is None:
            raise self.make_expected_error(Message("{what} needs a whole number", what=description))
        digits = match.group()
        if len(digits) > 9 or int(digits) > maximum:
            text = Message("{what} accepts numbers up to {maximum}.", what=description, maximum=maximum)
            raise make_klartext_error(
                self.line_number, column, INPUT_VALUE_INCORRECT, text, "Correct the number."
            )
        return int(digits)

    def read_name(self, description: str, maximum: int) -> int | str:
        """Read a number, or a name in quotation marks.

        Raises ProgramError if the name or number is missing or invalid.
        """
        self._check_no_text_parameter()
        start = self.index
        match = self.match_pattern(_QUOTED)
        if match is None:
            return self.read_whole_number(description, maximum)
        name = self.text[start + 1 : start + len(match.group(1)) + 1]
        if not name.strip():
            raise make_syntax_error(
                self.line_number,
                start + 1,
                Message("{what} has an empty name.", what=description),
                "Write the name.",
            )
        return name

    def read_file_name(self) -> str:
        """Read the rest of the line as a file name, and return it without quotation marks.

        The result is an empty string if no text remains.
        """
        self._check_no_text_parameter()
        return self.read_remaining_text().strip('"')

    def _check_no_text_parameter(self) -> None:
        """Raise ProgramError if a string parameter is used as a name."""
        if _TEXT_PARAMETER.match(self.uppercase_text, self.index):
            raise STRING_FUNCTIONS.make_error(self.line_number, self.column)

    def read_quoted_text(self) -> str | None:
        """Read a text in quotation marks, or return None if the cursor is not at a quotation mark."""
        start = self.index
        match = self.match_pattern(_QUOTED)
        return None if match is None else self.text[start + 1 : start + len(match.group(1)) + 1]

    def make_expected_error(self, message: str, hint: str = "") -> ProgramError:
        """Return a syntax error at the cursor that also shows the text at the cursor."""
        here = (
            Message("; found '{next_word}'", next_word=self.next_word)
            if not self.is_at_end
            else "; the line ends here"
        )
        return make_syntax_error(
            self.line_number,
            self.column,
            Message("{message}{position}.", message=message, position=here),
            self.choose_hint(hint),
        )

    def check_at_end(self, message: str, hint: str = "") -> None:
        """Raise ProgramError with this message if the line continues after the cursor."""
        if not self.is_at_end:
            raise self.make_expected_error(message, hint)

    def choose_hint(self, hint: str) -> str:
        """Return a specific hint for the text at the cursor, or ``hint`` if no specific hint exists.

        Specific hints exist for plain text and for typographic characters.
        """
        word = "" if self.is_at_end else self.next_word
        instead = next(filter(None, map(describe_typographic_character, word)), None)
        if instead is not None:
            return instead[1]
        return (
            Message("{hint} A comment begins with a semicolon (;).", hint=hint).lstrip()
            if _TEXT.match(word)
            else hint
        )

    def _q(self, number: int, column: int) -> int:
        if number > _MAX_Q_NUMBER:
            text = Message("Q parameters go up to Q{highest_q}.", highest_q=_MAX_Q_NUMBER)
            raise make_klartext_error(
                self.line_number,
                column,
                INPUT_VALUE_INCORRECT,
                text,
                "Use a parameter with a smaller number.",
            )
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


def read_feed(cursor: LineCursor) -> FeedWord | None:
    """Read a feed such as ``F200``, ``FQ5``, ``FU0.1``, ``FMAX`` or ``F AUTO``.

    Returns None if no F is at the cursor. Raises ProgramError for an invalid or unsupported feed.
    """
    column = cursor.column
    fixed = cursor.match_pattern(_FEED)
    if fixed is not None:
        return FeedWord(fixed.group(1).lower(), None, column)
    if _FEED_TIME.match(cursor.uppercase_text, cursor.index):
        raise make_unsupported_error(cursor.line_number, column, "Feed specified by travel time (FT, FMAXT)")
    if match := cursor.match_pattern(_FEED_VALUE):
        return FeedWord("value", cursor.read_value(match.group()), column, match.group(1))
    if cursor.match_pattern(_FEED_WORD):
        raise cursor.make_expected_error(
            "F has no value", "Write a number, a Q parameter, MAX or AUTO after F."
        )
    return None


def read_retract(cursor: LineCursor) -> RetractWord | None:
    """Read ``MB50``, ``MB 50`` or ``MB MAX``, or return None if no MB is at the cursor."""
    column = cursor.column
    if cursor.match_pattern(_RETRACT) is None:
        return None
    if cursor.read_keyword("MAX"):
        return RetractWord(None, column)
    return RetractWord(cursor.read_number("MB"), column)


@lru_cache(maxsize=16)
def _axis_word(letters: str, incremental: bool) -> re.Pattern[str]:
    return re.compile(rf"({'I?' if incremental else ''})([{letters}])(?=\s*[+\-0-9.,Q])")


def read_axis_words(
    cursor: LineCursor, letters: str, *, allows_incremental: bool = True
) -> tuple[AxisWord, ...]:
    """Read all axis words at the cursor. Raises ProgramError if a letter is repeated."""
    pattern = _axis_word(letters, allows_incremental)
    found: list[AxisWord] = []
    while True:
        column, match = cursor.column, cursor.match_pattern(pattern)
        if match is None:
            return tuple(found)
        sign, axis = match.groups()
        if any(word.axis == axis for word in found):
            raise make_repeated_word_error(cursor, column, f"{sign}{axis}")
        found.append(AxisWord(axis, cursor.read_value(f"{sign}{axis}"), sign == "I", column))


def read_words_by_name(cursor: LineCursor, pattern: re.Pattern[str]) -> dict[str, AxisWord]:
    """Read all words at the cursor, and return them by name.

    The name of a word is its group in the pattern. Raises ProgramError if a word is repeated.
    """
    found: dict[str, AxisWord] = {}
    while True:
        column, match = cursor.column, cursor.match_pattern(pattern)
        if match is None:
            return found
        name = match[1]
        check_word_not_repeated(cursor, column, name in found, name)
        found[name] = AxisWord(name, cursor.read_value(name), column=column)


def check_word_not_repeated(
    cursor: LineCursor, column: int, previous_words: object, description: str
) -> None:
    """Raise ProgramError if ``previous_words`` shows that the word is repeated in the block."""
    if previous_words:
        raise make_repeated_word_error(cursor, column, description)


def make_repeated_word_error(cursor: LineCursor, column: int, description: str) -> ProgramError:
    """Return the error for a word that is programmed twice."""
    text = Message("{word} is programmed twice in the block.", word=description)
    return make_syntax_error(cursor.line_number, column, text, "Remove one of the two.")
