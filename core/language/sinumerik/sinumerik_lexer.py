"""Lexer of SINUMERIK blocks. Any text that the grammar does not allow is an error."""

from __future__ import annotations

import re

from core.language.diagnostics import Diagnostic
from core.language.formulas import FormulaError
from core.language.line_reading import (
    SIGNED_NUMBER,
    describe_typographic_character,
    find_comment_start,
    find_non_blank,
    uppercase_ascii,
)
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik.block_reader import MAX_R_NUMBER, BlockReader, read_value_list
from core.language.sinumerik.call_arguments import CallArgument, read_arguments
from core.language.sinumerik.control_statements import (
    ControlKeyword,
    ControlStatement,
    find_control_keyword,
    read_control_statement,
)
from core.language.sinumerik.cycle_names import CYCLE_PARAMETERS, IGNORED_CYCLES, UNSUPPORTED_CYCLES
from core.language.sinumerik.iso_words import find_iso_word
from core.language.sinumerik.sinumerik_alarms import SYNTAX_ERROR, make_alarm_diagnostic
from core.language.sinumerik.sinumerik_words import (
    INTERNAL_AXIS_NAME,
    MAX_LINE_LENGTH,
    LexedBlock,
    PositionMode,
    Word,
    rename_axis_words,
)
from core.language.sinumerik.word_values import (
    R_PARAMETER_PATTERN,
    ParsedValue,
    check_parameter_numbers,
    find_range_error,
    parse_value,
)
from core.message import Message

_NUMBER = re.compile(SIGNED_NUMBER)
_HEAD = re.compile(r"\s*(?:/([0-9]?))?\s*(?:([N:])([0-9]+))?\s*(?:([A-Z_][A-Z_][A-Z0-9_]*)\s*:)?\s*")
# Nearly all words match this pattern and need no check of each character.
_PLAIN = re.compile(rf"\s*([GMXYZCIJKFSTD])({SIGNED_NUMBER})(?=[\sA-Z]|$)")
_NAME = re.compile(r"[A-Z_][A-Z_][A-Z0-9_]*|L[0-9]+(?![0-9.])")
_ASSIGNED = re.compile(r"(R[0-9]+|[A-Z_]+[0-9]*)\s*=(?!=)\s*")
_SPINDLE_WORD = re.compile(r"([MSTD])([0-9]+)")
_INDEXED = re.compile(r"(SPOSA?|LIMS)\s*\[\s*([A-Z0-9]+)\s*\]\s*=(?!=)\s*")
_QUOTED = re.compile(r'"([^"]*)"')
_BLANK = re.compile(r"\s*\([^()]*\)")
_NUMBERED = re.compile(r"\s*\(\s*([0-9]*)\s*\)")
_ELEMENT = re.compile(r"(R|[A-Z_][A-Z_][A-Z0-9_]*)\s*\[\s*")
_AXIS_WORD = re.compile(r"(?:[ABCUVWXYZ][0-9]?|AX[0-9]+)\s*\]")
_SET = re.compile(r"\s*=(?!=)\s*")
_SYSTEM = re.compile(r"\$[A-Z0-9_]+")
_BRACKET = re.compile(r"\s*\(")
_PROGRAM = re.compile(r'\s*"?([A-Z_][A-Z0-9_]*|L[0-9]+)"?(?![A-Z0-9_])')
_FORM = re.compile(r"([A-Z]+)\s*(\()?\s*")
_FORMS = frozenset(str(form) for form in PositionMode if form)
_REST_OF_WORD = re.compile(r"\S*\([^)]*\)?|\S+")
_PASSES = re.compile(r"\s*P\s*=?\s*([0-9]+)")
_MAX_PASSES = 9999
_CALLS = frozenset({"MCALL", "CALL"})
_TRANSFORMATIONS = frozenset({"TRANSMIT", "TRACYL", "TRAFOOF"})


def lex_line(number: int, text: str, third_axis: str = INTERNAL_AXIS_NAME) -> LexedBlock:
    """Read the words of line ``number``.

    The function does not raise exceptions. The returned block contains its errors with their columns.
    ``third_axis`` is the name of the machine's third axis, whose words are returned as words of C.
    """
    end = find_comment_start(text)
    code, comment = text[:end], end + 1 if end < len(text) else 0
    upper = uppercase_ascii(code)
    head = _HEAD.match(upper)
    assert head is not None  # The pattern always matches, because all its parts are optional.
    level, kind, count, label = head.groups()
    block = f"{kind}{count}" if kind else label or Message("in line {line}", line=number)
    wrong = -1
    if third_axis != INTERNAL_AXIS_NAME:
        upper, wrong = rename_axis_words(upper, third_axis)
    scanner = _Scanner(number, block, upper, code)
    if wrong >= 0:
        scanner.report_missing_axis(wrong, third_axis)
    if len(text) > MAX_LINE_LENGTH:
        scanner.report_error(
            1,
            Message("the block is too long ({text_count} characters)", text_count=len(text)),
            Message(
                "Split the block; the maximum is {longest_line} characters.", longest_line=MAX_LINE_LENGTH
            ),
        )
    elif steering := find_control_keyword(upper, head.end()):
        scanner.read_control_line(head.end(), steering)
    else:
        scanner.scan_words(head.end())
    if scanner.errors and len(text) <= MAX_LINE_LENGTH:
        scanner.report_iso_word()
    words = scanner.words
    if third_axis != INTERNAL_AXIS_NAME:
        words = [
            w._replace(text=f"{third_axis}{w.text[1:]}") if w.name == INTERNAL_AXIS_NAME else w for w in words
        ]
    return LexedBlock(
        number,
        block,
        tuple(words),
        label or "",
        None if level is None else int(level or 0),
        scanner.call,
        scanner.call_column,
        scanner.passes,
        comment,
        code[head.end() :].strip(),
        tuple(scanner.errors),
        scanner.jump,
        scanner.arguments,
        scanner.modal_call,
    )


class _Scanner:
    """Scanner of the code of one block, which reports unreadable text and skips it."""

    def __init__(self, number: int, block: str, text: str, original_text: str) -> None:
        self.words: list[Word] = []
        self.jump: ControlStatement | None = None
        self._written = original_text
        self.errors: list[Diagnostic] = []
        self.call, self.call_column, self.passes = "", 0, 1
        self.arguments: tuple[CallArgument, ...] | None = None
        self.modal_call = False
        self._number, self._block, self._text = number, block, text

    def read_control_line(self, index: int, keyword: ControlKeyword) -> None:
        """Read a program control line."""
        try:
            self.jump = read_control_statement(self._text, self._written, index, keyword)
        except FormulaError as problem:
            self.report_error(problem.index + 1, f"{problem}", problem.hint)

    def scan_words(self, index: int) -> None:
        """Read all words from ``index`` to the end of the block."""
        text = self._text
        while index < len(text):
            if match := _PLAIN.match(text, index):
                index = self._plain(match)
            elif text[index].isspace():
                index += 1
            elif match := _ASSIGNED.match(text, index) or _INDEXED.match(text, index):
                index = self._read_assignment(match)
            elif match := _ELEMENT.match(text, index):
                index = self._element(match)
            elif match := _SYSTEM.match(text, index):
                index = self._report_unsupported(
                    index, match.end(), match[0], "system variables cannot be assigned on this control"
                )
            elif match := _NAME.match(text, index):
                index = self._named(match)
            elif text[index].isalpha() and text[index].isascii():
                index = self._letter(index)
            else:
                _, hint = describe_typographic_character(text[index]) or (
                    "",
                    "Remove the character; comments start with ;",
                )
                index = self._skip(index, Message("{name} is not a valid word", name=text[index]), hint)

    def _plain(self, match: re.Match[str]) -> int:
        """Read a word that consists of one letter and a number without a formula."""
        letter, number = match.groups()
        word = Word(letter, float(number), match.start(1) + 1, letter + number)
        if wrong := find_range_error(word):
            self.report_error(word.column, *wrong)
        self.words.append(word)
        return match.end()

    def report_missing_axis(self, index: int, third_axis: str) -> None:
        """Report a C word on a machine whose third axis has another name."""
        self._report_unsupported(
            index,
            index + 1,
            INTERNAL_AXIS_NAME,
            Message("this lathe has no C axis; its third axis is {third_axis}", third_axis=third_axis),
        )

    def report_iso_word(self) -> None:
        """If the block contains an ISO word, replace the first error with the advice for this word."""
        if habit := find_iso_word(self._text):
            number, block = self._number, self._block
            self.errors[:] = [
                make_alarm_diagnostic(
                    number, habit.start_index + 1, "other-control", block, habit.explanation, habit.remedy
                )
            ]

    def report_error(self, column: int, text: str, hint: str) -> None:
        """Report a syntax alarm at this column."""
        self._add_finding(
            make_alarm_diagnostic(
                self._number,
                column,
                SYNTAX_ERROR,
                self._block,
                Message("syntax error: {what}.", what=text),
                hint,
            )
        )

    def _add_finding(self, finding: Diagnostic) -> None:
        """Add the finding if it is the first error of the block.

        Later errors may be consequences of the first error.
        """
        if not self.errors:
            self.errors.append(finding)

    def _skip(self, at: int, text: str, hint: str) -> int:
        self.report_error(at + 1, text, hint)
        rest = _REST_OF_WORD.match(self._text, at)
        return rest.end() if rest else at + 1

    def _report_unsupported(self, index: int, end: int, name: str, reason: str) -> int:
        """Report a word of the SINUMERIK language that TurnDesk does not support."""
        text, hint = (
            Message("{word}: {problem}.", word=name, problem=reason),
            ("Remove this text from the program."),
        )
        self._add_finding(
            make_alarm_diagnostic(self._number, index + 1, "not-in-subset", self._block, text, hint)
        )
        rest = _REST_OF_WORD.match(self._text, end)
        return rest.end() if rest and not self._text[end : end + 1].isspace() else end

    def _letter(self, index: int) -> int:
        """Read a letter and its number."""
        text, letter = self._text, self._text[index]
        if letter == "N" and text[index + 1 : index + 2].isdigit():
            return self._skip(
                index,
                "the block number is not at the start of the block",
                "Write the block number at the start.",
            )
        if letter not in known.ADDRESS_LETTERS:
            why = known.UNSUPPORTED_LETTERS.get(letter, "this word does not exist on this control")
            return self._report_unsupported(index, index + 1, letter, why)
        match = _NUMBER.match(text, index + 1)
        if match is None:
            instead = describe_typographic_character(self._text[index + 1 : index + 2])
            hint = (
                instead[1]
                if instead
                else Message("Write {letter} with a number, or {letter2}=…", letter=letter, letter2=letter)
            )
            return self._skip(index, Message("{what} has no number", what=letter), hint)
        return self._keep(Word(letter, float(match[0]), index + 1, text[index : match.end()]), match.end())

    def _named(self, match: re.Match[str]) -> int:
        """Read a keyword or a subprogram name.

        A subprogram name must be alone in its block.
        """
        name, at, end = match[0], match.start(), match.end()
        if name in known.NAMED_FUNCTIONS:
            return self._key(name, at, end)
        if name in known.SPINDLE_WORDS:
            return self._read_spindle_word(name, at, end)
        if name in _CALLS and not self.words:
            return self._read_called_name(name, at, end)
        if name in known.UNSUPPORTED_NAMES:
            return self._report_unsupported(at, end, name, known.UNSUPPORTED_REASONS[name])
        base = name.rstrip("0123456789")
        if name in known.WORDS_WITH_VALUE or base in known.WORDS_WITH_VALUE - known.ADDRESS_LETTERS:
            return self._skip(
                at, Message("{base} needs = and a value", base=base), Message("Write {base}=…", base=base)
            )
        return self._program(name, at, end)

    def _program(self, name: str, at: int, end: int) -> int:
        if not self.words and not self.call:
            return self._called(name, at, end)
        if name in CYCLE_PARAMETERS or name in UNSUPPORTED_CYCLES or name in IGNORED_CYCLES:
            return self._skip(
                at,
                Message("{name} is not allowed after other words", name=name),
                "Put the call in a separate block.",
            )
        hint = "Begin a comment with a semicolon (;). Put a subprogram name alone in its block."
        return self._skip(at, Message("{name} is not a valid word", name=name), hint)

    def _key(self, name: str, index: int, end: int) -> int:
        """Read a keyword that has either no value or arguments in parentheses."""
        if name in _TRANSFORMATIONS:
            return self._transformation(name, index, end)
        self.words.append(Word(name, None, index + 1, name))
        blank = _BLANK.match(self._text, end) if name == "WORKPIECE" else None
        return end if blank is None else blank.end()

    def _transformation(self, name: str, index: int, end: int) -> int:
        """Read TRANSMIT, TRACYL or TRAFOOF with its arguments."""
        arguments: tuple[CallArgument, ...] | None = ()
        if bracket := _BRACKET.match(self._text, end):
            arguments, end = self._arguments(name, bracket)
        if arguments is not None:
            self.words.append(Word(name, None, index + 1, name, arguments=arguments))
        return end

    def _arguments(self, name: str, bracket: re.Match[str]) -> tuple[tuple[CallArgument, ...] | None, int]:
        """Return the arguments in parentheses, or None if they are invalid, and the index after them."""
        try:
            reader = BlockReader(self._text, self._written, bracket.end() - 1)
            return read_arguments(reader), reader.index
        except FormulaError as problem:
            what = Message("{name}: {problem}", name=name, problem=problem)
            self.report_error(problem.index + 1, what, problem.hint)
            return None, len(self._text)

    def _read_spindle_word(self, name: str, index: int, end: int) -> int:
        """Read SETMS, WAITS or SETMS(1).

        Without a number, the word applies to spindle 1.
        """
        match = _NUMBERED.match(self._text, end)
        number = int(match[1] or 1) if match is not None else 1
        word = Word(name, float(number), index + 1, f"{name}({number})", spindle_number=number)
        self.words.append(word)
        return match.end() if match is not None else end

    def _read_called_name(self, word: str, index: int, end: int) -> int:
        """Read the program name after MCALL or CALL. The name is optional after MCALL."""
        match = _PROGRAM.match(self._text, end)
        self.modal_call, self.call_column = word == "MCALL", index + 1
        if match is not None:
            return self._called(match[1], match.start(1), match.end())
        if word == "CALL" or self._text[end:].strip():
            self.report_error(
                end + 1,
                Message("{word} needs a program name", word=word),
                Message("Write {word} NAME.", word=word),
            )
        return len(self._text)

    def _called(self, name: str, at: int, end: int) -> int:
        self.call, self.call_column = name, at + 1
        if bracket := _BRACKET.match(self._text, end):
            self.arguments, end = self._arguments(name, bracket)
        passes = _PASSES.match(self._text, end)
        if passes is not None:
            end = passes.end()
            self.passes = int(passes[1][:9])
            if not 1 <= self.passes <= _MAX_PASSES:
                self.report_error(
                    end,
                    Message("P{passes} is not a valid repeat count", passes=passes[1]),
                    Message("Write a repeat count from P1 to P{most_passes}.", most_passes=_MAX_PASSES),
                )
        if rest := self._text[end:].strip():
            self.report_error(
                end + 1,
                Message("{rest} is not allowed after {name}", rest=rest, name=name),
                "Put the call alone in its block.",
            )
        return len(self._text)

    def _element(self, match: re.Match[str]) -> int:
        """Read an assignment to R[ ] or to an element of an array."""
        name, at = match[1], match.start()
        if name in known.UNSUPPORTED_NAMES or _AXIS_WORD.match(self._text, match.end()):
            why = known.UNSUPPORTED_REASONS.get(name, "this control does not support axis-specific words")
            return self._report_unsupported(at, match.end(), name, why)
        if name in known.WORDS_WITHOUT_EQUALS:
            return self._without_equals(name, at)
        try:
            reader = BlockReader(self._text, self._written, self._text.index("[", at))
            place = reader.read_index()
            check_parameter_numbers(place, at)
            if reader.match_pattern(_SET) is None:
                return self._skip(
                    at,
                    Message("{name}[ ] needs = and a value", name=name),
                    Message("Write {name}[1]=…", name=name),
                )
            listed = read_value_list(reader, allows_bare_list=False)
            value = (
                parse_value(self._text, reader.index)
                if listed is None
                else ParsedValue(0.0, None, reader.index)
            )
        except FormulaError as problem:
            return self._skip(
                at, Message("{name}[ ]= has no value: {problem}", name=name, problem=problem), problem.hint
            )
        written = "".join(self._text[at : value.end_index].split())
        named = "R0" if name == "R" else name
        word = Word(
            named, value.number, at + 1, written, PositionMode.PLAIN, value.formula, element_index=place
        )
        return self._keep(word._replace(values=listed), value.end_index)

    def _read_assignment(self, match: re.Match[str]) -> int:
        """Read a word with an equals sign."""
        name, at, end = match[1], match.start(), match.end()
        index = match[2] if match.re is _INDEXED else None
        if of := _SPINDLE_WORD.fullmatch(name):
            name, index = of[1], of[2]
        if index is not None and not index.isdigit():
            return self._skip(
                at,
                Message("{name} needs a spindle number as its index", name=name),
                Message("Write {name}[1]=…", name=name),
            )
        before = len(self.words)
        end = self._with_value(name, at, end)
        if index is not None and len(self.words) > before:
            self.words[-1] = self.words[-1]._replace(spindle_number=int(index[:9]))
        return end

    def _with_value(self, name: str, at: int, end: int) -> int:
        is_r = R_PARAMETER_PATTERN.fullmatch(name)
        if name == "T" and (quoted := _QUOTED.match(self._written, end)):
            word = Word("T", None, at + 1, f'T="{quoted[1]}"', quoted_name=quoted[1].strip())
            self.words.append(word)
            return quoted.end()
        if name in known.WORDS_WITHOUT_EQUALS:
            return self._without_equals(name, at)
        assigned = name in known.WORDS_WITH_VALUE or name == "M"
        if is_r is None and not assigned and (len(name) == 1 or name in known.UNSUPPORTED_NAMES):
            why = known.UNSUPPORTED_LETTERS.get(name) or known.UNSUPPORTED_REASONS.get(name)
            return self._report_unsupported(at, end, name, why or "this control does not support this word")
        if is_r is not None and int(is_r[1][:9]) > MAX_R_NUMBER:
            return self._report_unsupported(
                at, end, name, Message("R parameters are R0 to R{most_r}", most_r=MAX_R_NUMBER)
            )
        found = _FORM.match(self._text, end)
        if found is not None and found[1] in _FORMS:
            return self._target(name, at, found)
        return self._value(name, at, end)

    def _without_equals(self, name: str, index: int) -> int:
        """Report an equals sign after a word that does not accept a value."""
        text = Message("{name} does not accept a value", name=name)
        return self._skip(index, text, Message("Write {name} without an equals sign.", name=name))

    def _value(self, name: str, at: int, end: int) -> int:
        try:
            value = parse_value(self._text, end)
        except FormulaError as problem:
            return self._skip(
                at, Message("{name}= has no value: {problem}", name=name, problem=problem), problem.hint
            )
        written = "".join(self._text[at : value.end_index].split())
        return self._keep(
            Word(name, value.number, at + 1, written, PositionMode.PLAIN, value.formula), value.end_index
        )

    def _target(self, name: str, index: int, found: re.Match[str]) -> int:
        """Read a target position such as AC( ), IC( ), DC( ), ACP( ) or ACN( )."""
        form, bracket = found[1], found[2]
        if form not in known.FORMS_BY_WORD.get(name, frozenset()):
            allowed = ", ".join(sorted(known.FORMS_BY_WORD.get(name, ()))) or "a number or a formula"
            return self._skip(
                index,
                Message("{name}= does not accept {form}", name=name, form=form),
                Message("Use {allowed}.", allowed=allowed),
            )
        hint = Message("Write {name}={form}(…).", name=name, form=form)
        if bracket is None:
            return self._skip(index, Message("{form} needs parentheses", form=form), hint)
        try:
            value = parse_value(self._text, found.end())
        except FormulaError as problem:
            what = Message("{form} has no value in its parentheses: {problem}", form=form, problem=problem)
            return self._skip(index, what, hint)
        close = find_non_blank(self._text, value.end_index)
        if self._text[close : close + 1] != ")":
            return self._skip(index, Message("the closing parenthesis of {form} is missing", form=form), hint)
        written = "".join(self._text[index : close + 1].split())
        word = Word(name, value.number, index + 1, written, PositionMode(form), value.formula)
        return self._keep(word, close + 1)

    def _keep(self, word: Word, end: int) -> int:
        after = self._text[end : end + 1]
        if after in {".", "+", "-", "*", "=", "(", ")", ","}:
            return self._skip(
                word.column - 1,
                Message("{word}{after} is not a valid number", word=word.text, after=after),
                "Correct the number.",
            )
        if wrong := find_range_error(word):
            self.report_error(word.column, *wrong)
        self.words.append(word)
        return end
