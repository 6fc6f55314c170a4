"""Lexer of OmniTurn lines. Numbers have a strict syntax, and any other text is an error."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.language.line_reading import SIGNED_NUMBER, uppercase_ascii
from core.language.omniturn import other_controls, word_faults
from core.language.omniturn.intended_code import find_foreign_code, replace_letter_l
from core.language.omniturn.omniturn_words import LETTERS_WITHOUT_NUMBER, LexedLine, Word
from core.message import Message

MAX_LINE_LENGTH = 8192

# Most lines of a long program consist only of these words, which need no check of each character.
_NUMBER = r"[+-]?(?:[0-9]{1,4}(?:\.[0-9]{0,8})?|\.[0-9]{1,8})"
_USUAL_LINE = re.compile(f"(?:[XZIKRFS]{_NUMBER}|[GM][0-9]{{2}}(?![0-9.]))+")
# lines of usual words that may belong to another control
_MAY_BE_FOREIGN = re.compile("G(?:04X|74|75|76|92S)")
_USUAL_WORD = re.compile(r"(([A-Z])([-+0-9.]+))")
_WORD = re.compile(rf"(LS|LF|RF|CA|CI|[A-Z}}])({SIGNED_NUMBER})?")
_THREAD = re.compile(r"G3[34](?![0-9.])")
_TO_NEXT_LETTER = re.compile(r"[^A-Z}]+")
_ZERO_LETTER = re.compile(r"O[0-9.]*")
_EXPONENT = re.compile(r"E[+-]?[0-9]+")
_THREE_LETTERS = re.compile(r"[^\W\d_]{3}")
_COMMENT = re.compile(r"\([^)]*\)?")
_LETTERS = re.compile(r"[^\W\d_]+")
# Three or more letters are text, and so are one or two letters without a number. Numbers may be between them.
_LONG, _SHORT = r"(?>[^\W\d_]{3,})", r"(?>[^\W\d_]+)(?!\s*[+\-.]*\d)"
_NEXT = rf"(?:{_LONG}|{_SHORT}|(?>[^\W\d_]{{2}})(?=\s)|\d+(?:\.\d*)?|\.\d+)"
_PROSE = re.compile(rf"(?<![^\W\d_])(?:{_LONG}|{_SHORT})(?:[\s,.;:!?'\"/&+-]*{_NEXT})*[.,;:!?]*")
_THREAD_SIGNS = frozenset("PCO")
_ZERO_SLIPS = re.compile(r"(?:[GMXZFS]O+)+[A-Z]?")
_NUMBER_SIGNS = frozenset("0123456789.")
_SPACE = re.compile(r"\s")


class _Code(NamedTuple):
    """The code of a line in upper case, without blanks and comment.

    ``columns`` contains the source column of each character.
    """

    text: str
    original_text: str
    columns: range | list[int]


def lex_line(number: int, text: str) -> LexedLine:
    """Read the words of line ``number``.

    The function does not raise exceptions. The returned line contains its errors with their columns.
    """
    if len(text) > MAX_LINE_LENGTH:
        return LexedLine(number, errors=(word_faults.make_line_length_error(number, len(text)),))
    if _USUAL_LINE.fullmatch(text) and not _MAY_BE_FOREIGN.search(text):
        words = _usual_words(text)
        if words is not None:
            return LexedLine(number, words, text=text)
    if "l" in text and (misread := _letter_l(number, text)) is not None:
        return LexedLine(number, errors=(misread,), text=text)
    if text.count("(") > 1 and (inner := _nested_comment(text)) is not None:
        return LexedLine(
            number,
            errors=(word_faults.make_fixed_message_error(number, inner + 1, "comment-nested"),),
            text=text,
        )
    errors: list[Diagnostic] = []
    if _THREE_LETTERS.search(text) or text[:1] in "%oO: ":
        text, prose_errors = _blank_prose(number, text)
        errors += prose_errors
    written, columns, comment, comment_column = _without_comment(number, text, errors)
    code = _Code(uppercase_ascii(written), written, columns)
    block_delete = code.text.startswith("/")
    intent = find_foreign_code(code.text)
    if intent is not None:
        error = make_error_diagnostic(
            number, columns[intent.start_index], intent.diagnostic_code, intent.message, intent.remedy
        )
        return LexedLine(number, (), comment, comment_column, block_delete, written, (error,))
    words = _Scanner(number, code, errors).scan_words(1 if block_delete else 0)
    return LexedLine(number, words, comment, comment_column, block_delete, written, tuple(errors))


def _nested_comment(text: str) -> int | None:
    """Return the index of an opening parenthesis within a comment, or None if no comment is nested.

    Also returns None if a parenthesis is not closed.
    """
    depth, inner = 0, None
    for at, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth == 2 and inner is None:
            inner = at
    return inner if depth == 0 else None


def _letter_l(number: int, text: str) -> Diagnostic | None:
    """Return the error for a letter l instead of the digit 1, or None if no such letter is found.

    Also returns None if the line has other errors.
    """
    code = _with_blank_comments(text)
    fixed = replace_letter_l(code)
    if fixed == code or lex_line(number, fixed).errors:
        return None
    at = next(i for i, (was, now) in enumerate(zip(code, fixed, strict=True)) if was != now)
    word = next(
        found for found in _WORD.finditer(uppercase_ascii(fixed)) if found.start() <= at < found.end()
    )
    message = Message("{code}: letter l in a number.", code=code[word.start() : word.end()])
    return make_error_diagnostic(number, at + 1, "letter-l", message, Message("Write {name}.", name=word[0]))


def _blank_prose(number: int, text: str) -> tuple[str, list[Diagnostic]]:
    """Return the line with plain text replaced by blanks, and one error for each such text."""
    bare = _with_blank_comments(text)
    habit = other_controls.explain_foreign_line(bare)
    if habit is not None:
        column = len(bare) - len(bare.lstrip()) + 1
        kept = "".join(" " if sign == bare[at] else sign for at, sign in enumerate(text))
        return kept, [make_error_diagnostic(number, column, *habit)]
    errors: list[Diagnostic] = []
    for found in _prose_in(bare):
        start, end = found.span()
        if bare[start - 1 : start] == ";":  # a comment in the style of other controls
            start -= 1
            errors.append(
                word_faults.make_invalid_character_error(number, start + 1, ";", is_after_number=False)
            )
        else:
            errors.append(word_faults.make_stray_text_error(number, start + 1, found[0].strip()))
        text = text[:start] + " " * (end - start) + text[end:]
    return text, errors


def _with_blank_comments(text: str) -> str:
    """Return the line with its comments replaced by blanks."""
    return _COMMENT.sub(lambda found: " " * len(found[0]), text)


def _prose_in(bare: str) -> Iterator[re.Match[str]]:
    """Yield a match for each plain text in the line, including the characters between its words."""
    thread = _THREAD.search(bare.upper().replace(" ", "")) is not None
    for found in _PROSE.finditer(bare):
        words = _LETTERS.findall(found[0].upper())
        if thread:
            words = [word for word in words if not _THREAD_SIGNS.issuperset(word)]
        if any(len(word) >= 3 and not _ZERO_SLIPS.fullmatch(word) for word in words):
            yield found


def _usual_words(text: str) -> tuple[Word, ...] | None:
    """Return the words of a line with only common words, or None if a word needs a complete check."""
    words: list[Word] = []
    column = 1
    for written, letter, number in _USUAL_WORD.findall(text):
        value = float(number)
        if letter == "F" and value <= 0:
            return None
        words.append(Word(letter, value, column, written))
        column += len(written)
    return tuple(words)


def _without_comment(
    number: int, text: str, errors: list[Diagnostic]
) -> tuple[str, range | list[int], str | None, int]:
    if "(" not in text:
        written, columns = _without_blanks(text, 1)
        return written, columns, None, 0
    written, kept, comments, first, at = "", list[int](), list[str](), 0, 0
    while (start := text.find("(", at)) >= 0:
        piece, columns = _without_blanks(text[at:start], at + 1)
        written, kept = written + piece, kept + list(columns)
        first = first or start + 1
        end = text.find(")", start)
        if end < 0:
            errors.append(word_faults.make_fixed_message_error(number, start + 1, "comment-open"))
            end = len(text)
        comments.append(text[start + 1 : end])
        at = end + 1
    piece, columns = _without_blanks(text[at:], at + 1)
    return written + piece, kept + list(columns), " ".join(comments), first


def _without_blanks(text: str, column: int) -> tuple[str, range | list[int]]:
    if not _SPACE.search(text):
        return text, range(column, column + len(text))
    kept = [(sign, column + i) for i, sign in enumerate(text) if not sign.isspace()]
    return "".join(sign for sign, _ in kept), [at for _, at in kept]


class _Scanner:
    """Scanner of the code of one line, which reports unreadable text and skips it."""

    def __init__(self, number: int, code: _Code, errors: list[Diagnostic]) -> None:
        self._number = number
        self._code = code
        self._errors = errors
        self._thread = _THREAD.search(code.text) is not None

    def scan_words(self, index: int) -> tuple[Word, ...]:
        found: list[Word] = []
        text = self._code.text
        while index < len(text):
            match = _WORD.match(text, index)
            if match is None:
                index = self._skip(index, after_number=bool(found) and text[index - 1].isdigit())
                continue
            if self._thread and match[1] in {"CA", "CI"}:
                found.append(
                    Word("C", None, self._column(index), self._code.original_text[index : index + 1])
                )
                index += 1
                continue
            index = self._read(match, found)
        return tuple(found)

    def _read(self, match: re.Match[str], words: list[Word]) -> int:
        """Read one word, check for errors after the word, and return the index of the next word."""
        letter, digits, end = match[1], match[2], match.end()
        text = self._code.text
        if letter == "O" and not self._thread:
            return self._letter_o(match.start(), match.start())
        if digits is None and letter not in LETTERS_WITHOUT_NUMBER:
            return self._without_number(letter, match)
        if digits is None and text[end : end + 1] in {"+", "-", "."}:
            return self._without_number(letter, match)
        if digits is not None and self._is_letter_o(end):
            return self._letter_o(match.start(), end)
        value = None if digits is None else float(digits) if len(digits) < 32 else float("inf")
        written = self._code.original_text[match.start() : end]
        word = Word(letter, value, self._column(match.start()), written)
        fault = word_faults.find_word_error(self._number, word, digits)
        if fault is not None:
            self._errors.append(fault)
        words.append(word)
        return self._after_number(end) if digits is not None else end

    def _without_number(self, letter: str, match: re.Match[str]) -> int:
        text, end = self._code.text, match.end()
        follower = text[end : end + 1]
        if follower == "O":
            return self._letter_o(match.start(), end)
        if follower == "," or other_controls.explain_character(follower) is not None:
            return self._skip(end, after_number=False)
        column = self._column(match.start())
        self._errors.append(word_faults.make_missing_number_error(self._number, column, letter, follower))
        skipped = _TO_NEXT_LETTER.match(text, end)
        return skipped.end() if skipped else end

    def _after_number(self, at: int) -> int:
        text = self._code.text
        exponent = _EXPONENT.match(text, at)
        if exponent is not None:
            self._errors.append(
                word_faults.make_fixed_message_error(self._number, self._column(at), "exponent")
            )
            return exponent.end()
        return at

    def _is_letter_o(self, index: int) -> bool:
        """Return whether a letter O at this index is part of a number.

        In a thread, O can also be a word.
        """
        text = self._code.text
        return text[index : index + 1] == "O" and (
            not self._thread or text[index + 1 : index + 2] in _NUMBER_SIGNS
        )

    def _letter_o(self, start: int, index: int) -> int:
        """Report the letter O at ``index`` in the word that starts at ``start``.

        Returns the end of the word.
        """
        match = _ZERO_LETTER.match(self._code.text, index)
        end = match.end() if match else index + 1
        word = self._code.original_text[start:end]
        self._errors.append(word_faults.make_letter_o_error(self._number, self._column(index), word))
        return end

    def _skip(self, at: int, *, after_number: bool) -> int:
        sign = self._code.original_text[at]
        after_number = after_number or (at > 0 and self._code.text[at - 1] == ".")
        self._errors.append(
            word_faults.make_invalid_character_error(
                self._number, self._column(at), sign, is_after_number=after_number
            )
        )
        match = _TO_NEXT_LETTER.match(self._code.text, at)
        return match.end() if match else at + 1

    def _column(self, at: int) -> int:
        return self._code.columns[at]
