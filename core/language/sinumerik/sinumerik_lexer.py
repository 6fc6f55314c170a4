"""Lexer of SINUMERIK blocks. Text outside the grammar is an error."""

from __future__ import annotations

import re

from core.language.diagnostics import Diagnostic
from core.language.formulas import FormulaError
from core.language.line_reading import SIGNED, after_blanks, ascii_upper, comment_start, typed
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik.block_reader import BlockReader, read_values
from core.language.sinumerik.call_arguments import Argument, read_arguments
from core.language.sinumerik.cycle_names import CYCLES, CYCLES_OUTSIDE, CYCLES_TAKEN
from core.language.sinumerik.iso_words import iso_habit
from core.language.sinumerik.program_jumps import Jump, Steering, read_jump, steering_word
from core.language.sinumerik.sinumerik_alarms import SYNTAX, fault
from core.language.sinumerik.sinumerik_words import LONGEST_LINE, OWN, Form, Line, Word, words_as_c
from core.language.sinumerik.word_values import PARAMETER, Value, beyond, demand_parameters, value_at
from core.message import Message

_NUMBER = re.compile(SIGNED)
_HEAD = re.compile(r"\s*(?:/([0-9]?))?\s*(?:([N:])([0-9]+))?\s*(?:([A-Z_][A-Z_][A-Z0-9_]*)\s*:)?\s*")
# Nearly all words match this pattern and need no check of each character.
_PLAIN = re.compile(rf"\s*([GMXYZCIJKFSTD])({SIGNED})(?=[\sA-Z]|$)")
_NAME = re.compile(r"[A-Z_][A-Z_][A-Z0-9_]*|L[0-9]+(?![0-9.])")
_ASSIGNED = re.compile(r"(R[0-9]+|[A-Z_]+[0-9]*)\s*=(?!=)\s*")
_OF_SPINDLE = re.compile(r"([MSTD])([0-9]+)")
_INDEXED = re.compile(r"(SPOSA?|LIMS)\s*\[\s*([A-Z0-9]+)\s*\]\s*=(?!=)\s*")
_QUOTED = re.compile(r'"([^"]*)"')
_BLANK = re.compile(r"\s*\([^()]*\)")
_NUMBERED = re.compile(r"\s*\(\s*([0-9]*)\s*\)")
_ELEMENT = re.compile(r"(R|[A-Z_][A-Z_][A-Z0-9_]*)\s*\[\s*")
_OF_AN_AXIS = re.compile(r"(?:[ABCUVWXYZ][0-9]?|AX[0-9]+)\s*\]")
_SET = re.compile(r"\s*=(?!=)\s*")
_SYSTEM = re.compile(r"\$[A-Z0-9_]+")
_BRACKET = re.compile(r"\s*\(")
_PROGRAM = re.compile(r'\s*"?([A-Z_][A-Z0-9_]*|L[0-9]+)"?(?![A-Z0-9_])')
_FORM = re.compile(r"([A-Z]+)\s*(\()?\s*")
_FORMS = frozenset(str(form) for form in Form if form)
_REST_OF_WORD = re.compile(r"\S*\([^)]*\)?|\S+")
_PASSES = re.compile(r"\s*P\s*=?\s*([0-9]+)")
_MOST_PASSES = 9999
_CALLS = frozenset({"MCALL", "CALL"})
_TRANSFORMATIONS = frozenset({"TRANSMIT", "TRACYL", "TRAFOOF"})


def lex_line(number: int, text: str, third_axis: str = OWN) -> Line:
    """Read the words of line ``number``.

    This function never raises; the line contains its errors with columns.

    ``third_axis`` is the name of the machine's third axis. Its words are returned as words of C.
    """
    end = comment_start(text)
    code, comment = text[:end], end + 1 if end < len(text) else 0
    upper = ascii_upper(code)
    head = _HEAD.match(upper)
    assert head is not None  # The pattern always matches, because all its parts are optional.
    level, kind, count, label = head.groups()
    block = f"{kind}{count}" if kind else label or Message("in line {line}", line=number)
    wrong = -1
    if third_axis != OWN:
        upper, wrong = words_as_c(upper, third_axis)
    scanner = _Scanner(number, block, upper, code)
    if wrong >= 0:
        scanner.no_axis(wrong, third_axis)
    if len(text) > LONGEST_LINE:
        scanner.refuse(
            1,
            Message("the block is too long ({text_count} characters)", text_count=len(text)),
            Message("Split the block; the maximum is {longest_line} characters.", longest_line=LONGEST_LINE),
        )
    elif steering := steering_word(upper, head.end()):
        scanner.steer(head.end(), steering)
    else:
        scanner.scan(head.end())
    if scanner.errors and len(text) <= LONGEST_LINE:
        scanner.tell_habit()
    words = scanner.words
    if third_axis != OWN:
        words = [w._replace(text=f"{third_axis}{w.text[1:]}") if w.name == OWN else w for w in words]
    return Line(
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

    def __init__(self, number: int, block: str, text: str, written: str) -> None:
        self.words: list[Word] = []
        self.jump: Jump | None = None
        self._written = written
        self.errors: list[Diagnostic] = []
        self.call, self.call_column, self.passes = "", 0, 1
        self.arguments: tuple[Argument, ...] | None = None
        self.modal_call = False
        self._number, self._block, self._text = number, block, text

    def steer(self, at: int, steering: Steering) -> None:
        """Read a program control line."""
        try:
            self.jump = read_jump(self._text, self._written, at, steering)
        except FormulaError as problem:
            self.refuse(problem.at + 1, f"{problem}", problem.hint)

    def scan(self, at: int) -> None:
        """Read all words from index ``at`` on."""
        text = self._text
        while at < len(text):
            if match := _PLAIN.match(text, at):
                at = self._plain(match)
            elif text[at].isspace():
                at += 1
            elif match := _ASSIGNED.match(text, at) or _INDEXED.match(text, at):
                at = self._assigned(match)
            elif match := _ELEMENT.match(text, at):
                at = self._element(match)
            elif match := _SYSTEM.match(text, at):
                at = self._outside(
                    at, match.end(), match[0], "system variables cannot be assigned on this control"
                )
            elif match := _NAME.match(text, at):
                at = self._named(match)
            elif text[at].isalpha() and text[at].isascii():
                at = self._letter(at)
            else:
                _, hint = typed(text[at]) or ("", "Remove the character; comments start with ;")
                at = self._skip(at, Message("{name} is not a valid word", name=text[at]), hint)

    def _plain(self, match: re.Match[str]) -> int:
        """Add a letter with a plain number."""
        letter, number = match.groups()
        word = Word(letter, float(number), match.start(1) + 1, letter + number)
        if wrong := beyond(word):
            self.refuse(word.column, *wrong)
        self.words.append(word)
        return match.end()

    def no_axis(self, at: int, third_axis: str) -> None:
        """Report a C word on a machine whose third axis has another name."""
        self._outside(
            at,
            at + 1,
            OWN,
            Message("this lathe has no C axis; its third axis is {third_axis}", third_axis=third_axis),
        )

    def tell_habit(self) -> None:
        """Replace the first error with the advice for an ISO word if the block contains one."""
        if habit := iso_habit(self._text):
            number, block = self._number, self._block
            self.errors[:] = [fault(number, habit.at + 1, "other-control", block, habit.text, habit.hint)]

    def refuse(self, column: int, text: str, hint: str) -> None:
        """Report a syntax alarm at this column."""
        self._tell(
            fault(
                self._number, column, SYNTAX, self._block, Message("syntax error: {what}.", what=text), hint
            )
        )

    def _tell(self, found: Diagnostic) -> None:
        """Add the finding if it is the first error of the block.

        Later errors may be consequences of the first error.
        """
        if not self.errors:
            self.errors.append(found)

    def _skip(self, at: int, text: str, hint: str) -> int:
        self.refuse(at + 1, text, hint)
        rest = _REST_OF_WORD.match(self._text, at)
        return rest.end() if rest else at + 1

    def _outside(self, at: int, end: int, name: str, why: str) -> int:
        """Report a word of the language that TurnDesk does not execute."""
        text, hint = (
            Message("{word}: {problem}.", word=name, problem=why),
            ("Remove this text from the program."),
        )
        self._tell(fault(self._number, at + 1, "not-in-subset", self._block, text, hint))
        rest = _REST_OF_WORD.match(self._text, end)
        return rest.end() if rest and not self._text[end : end + 1].isspace() else end

    def _letter(self, at: int) -> int:
        """Read a letter and its number."""
        text, letter = self._text, self._text[at]
        if letter == "N" and text[at + 1 : at + 2].isdigit():
            return self._skip(
                at,
                "the block number is not at the start of the block",
                "Write the block number at the start.",
            )
        if letter not in known.LETTERS:
            why = known.LETTERS_OUTSIDE.get(letter, "this word does not exist on this control")
            return self._outside(at, at + 1, letter, why)
        match = _NUMBER.match(text, at + 1)
        if match is None:
            instead = typed(self._text[at + 1 : at + 2])
            hint = (
                instead[1]
                if instead
                else Message("Write {letter} with a number, or {letter2}=…", letter=letter, letter2=letter)
            )
            return self._skip(at, Message("{what} has no number", what=letter), hint)
        return self._keep(Word(letter, float(match[0]), at + 1, text[at : match.end()]), match.end())

    def _named(self, match: re.Match[str]) -> int:
        """Read a keyword or a subprogram name; a subprogram name must be alone in its block."""
        name, at, end = match[0], match.start(), match.end()
        if name in known.KEYS:
            return self._key(name, at, end)
        if name in known.OF_A_SPINDLE:
            return self._of_a_spindle(name, at, end)
        if name in _CALLS and not self.words:
            return self._behind_call(name, at, end)
        if name in known.NAMES_OUTSIDE:
            return self._outside(at, end, name, known.WHY_OUTSIDE[name])
        base = name.rstrip("0123456789")
        if name in known.ASSIGNED or base in known.ASSIGNED - known.LETTERS:
            return self._skip(
                at, Message("{base} needs = and a value", base=base), Message("Write {base}=…", base=base)
            )
        return self._program(name, at, end)

    def _program(self, name: str, at: int, end: int) -> int:
        if not self.words and not self.call:
            return self._called(name, at, end)
        if name in CYCLES or name in CYCLES_OUTSIDE or name in CYCLES_TAKEN:
            return self._skip(
                at,
                Message("{name} is not allowed after other words", name=name),
                "Put the call in a separate block.",
            )
        hint = "Begin a comment with a semicolon (;). Put a subprogram name alone in its block."
        return self._skip(at, Message("{name} is not a valid word", name=name), hint)

    def _key(self, name: str, at: int, end: int) -> int:
        """Read a word without a value, or with arguments in parentheses."""
        if name in _TRANSFORMATIONS:
            return self._transformation(name, at, end)
        self.words.append(Word(name, None, at + 1, name))
        blank = _BLANK.match(self._text, end) if name == "WORKPIECE" else None
        return end if blank is None else blank.end()

    def _transformation(self, name: str, at: int, end: int) -> int:
        """Read TRANSMIT, TRACYL or TRAFOOF with its arguments."""
        arguments: tuple[Argument, ...] | None = ()
        if bracket := _BRACKET.match(self._text, end):
            arguments, end = self._arguments(name, bracket)
        if arguments is not None:
            self.words.append(Word(name, None, at + 1, name, arguments=arguments))
        return end

    def _arguments(self, name: str, bracket: re.Match[str]) -> tuple[tuple[Argument, ...] | None, int]:
        """Return the arguments in parentheses, or None if they are invalid, and the index after them."""
        try:
            reader = BlockReader(self._text, self._written, bracket.end() - 1)
            return read_arguments(reader), reader.at
        except FormulaError as problem:
            what = Message("{name}: {problem}", name=name, problem=problem)
            self.refuse(problem.at + 1, what, problem.hint)
            return None, len(self._text)

    def _of_a_spindle(self, name: str, at: int, end: int) -> int:
        """Read SETMS, WAITS or SETMS(1); without a number, the word applies to spindle 1."""
        match = _NUMBERED.match(self._text, end)
        number = int(match[1] or 1) if match is not None else 1
        word = Word(name, float(number), at + 1, f"{name}({number})", spindle=number)
        self.words.append(word)
        return match.end() if match is not None else end

    def _behind_call(self, word: str, at: int, end: int) -> int:
        """Read the program name after MCALL or CALL; MCALL without a name is also valid."""
        match = _PROGRAM.match(self._text, end)
        self.modal_call, self.call_column = word == "MCALL", at + 1
        if match is not None:
            return self._called(match[1], match.start(1), match.end())
        if word == "CALL" or self._text[end:].strip():
            self.refuse(
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
            if not 1 <= self.passes <= _MOST_PASSES:
                self.refuse(
                    end,
                    Message("P{passes} is not a valid repeat count", passes=passes[1]),
                    Message("Write a repeat count from P1 to P{most_passes}.", most_passes=_MOST_PASSES),
                )
        if rest := self._text[end:].strip():
            self.refuse(
                end + 1,
                Message("{rest} is not allowed after {name}", rest=rest, name=name),
                "Put the call alone in its block.",
            )
        return len(self._text)

    def _element(self, match: re.Match[str]) -> int:
        """Read an assignment to R[ ] or to an element of an array."""
        name, at = match[1], match.start()
        if name in known.NAMES_OUTSIDE or _OF_AN_AXIS.match(self._text, match.end()):
            why = known.WHY_OUTSIDE.get(name, "this control does not support axis-specific words")
            return self._outside(at, match.end(), name, why)
        if name in known.WITHOUT_EQUALS:
            return self._without_equals(name, at)
        try:
            reader = BlockReader(self._text, self._written, self._text.index("[", at))
            place = reader.index()
            demand_parameters(place, at)
            if reader.take(_SET) is None:
                return self._skip(
                    at,
                    Message("{name}[ ] needs = and a value", name=name),
                    Message("Write {name}[1]=…", name=name),
                )
            listed = read_values(reader, bare=False)
            value = value_at(self._text, reader.at) if listed is None else Value(0.0, None, reader.at)
        except FormulaError as problem:
            return self._skip(
                at, Message("{name}[ ]= has no value: {problem}", name=name, problem=problem), problem.hint
            )
        written = "".join(self._text[at : value.end].split())
        named = "R0" if name == "R" else name
        word = Word(named, value.number, at + 1, written, Form.PLAIN, value.formula, element=place)
        return self._keep(word._replace(values=listed), value.end)

    def _assigned(self, match: re.Match[str]) -> int:
        """Read a word with an equals sign."""
        name, at, end = match[1], match.start(), match.end()
        index = match[2] if match.re is _INDEXED else None
        if of := _OF_SPINDLE.fullmatch(name):
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
            self.words[-1] = self.words[-1]._replace(spindle=int(index[:9]))
        return end

    def _with_value(self, name: str, at: int, end: int) -> int:
        is_r = PARAMETER.fullmatch(name)
        if name == "T" and (quoted := _QUOTED.match(self._written, end)):
            word = Word("T", None, at + 1, f'T="{quoted[1]}"', string=quoted[1].strip())
            self.words.append(word)
            return quoted.end()
        if name in known.WITHOUT_EQUALS:
            return self._without_equals(name, at)
        assigned = name in known.ASSIGNED or name == "M"
        if is_r is None and not assigned and (len(name) == 1 or name in known.NAMES_OUTSIDE):
            why = known.LETTERS_OUTSIDE.get(name) or known.WHY_OUTSIDE.get(name)
            return self._outside(at, end, name, why or "this control does not support this word")
        if is_r is not None and int(is_r[1][:9]) > known.MOST_R:
            return self._outside(
                at, end, name, Message("R parameters are R0 to R{most_r}", most_r=known.MOST_R)
            )
        found = _FORM.match(self._text, end)
        if found is not None and found[1] in _FORMS:
            return self._target(name, at, found)
        return self._value(name, at, end)

    def _without_equals(self, name: str, at: int) -> int:
        """Report a value that is assigned to a word without one."""
        text = Message("{name} does not accept a value", name=name)
        return self._skip(at, text, Message("Write {name} without an equals sign.", name=name))

    def _value(self, name: str, at: int, end: int) -> int:
        try:
            value = value_at(self._text, end)
        except FormulaError as problem:
            return self._skip(
                at, Message("{name}= has no value: {problem}", name=name, problem=problem), problem.hint
            )
        written = "".join(self._text[at : value.end].split())
        return self._keep(Word(name, value.number, at + 1, written, Form.PLAIN, value.formula), value.end)

    def _target(self, name: str, at: int, found: re.Match[str]) -> int:
        """Read a target such as AC( ), IC( ), DC( ), ACP( ) or ACN( )."""
        form, bracket = found[1], found[2]
        if form not in known.FORMS.get(name, frozenset()):
            allowed = ", ".join(sorted(known.FORMS.get(name, ()))) or "a number or a formula"
            return self._skip(
                at,
                Message("{name}= does not accept {form}", name=name, form=form),
                Message("Use {allowed}.", allowed=allowed),
            )
        hint = Message("Write {name}={form}(…).", name=name, form=form)
        if bracket is None:
            return self._skip(at, Message("{form} needs parentheses", form=form), hint)
        try:
            value = value_at(self._text, found.end())
        except FormulaError as problem:
            what = Message("{form} has no value in its parentheses: {problem}", form=form, problem=problem)
            return self._skip(at, what, hint)
        close = after_blanks(self._text, value.end)
        if self._text[close : close + 1] != ")":
            return self._skip(at, Message("the closing parenthesis of {form} is missing", form=form), hint)
        written = "".join(self._text[at : close + 1].split())
        word = Word(name, value.number, at + 1, written, Form(form), value.formula)
        return self._keep(word, close + 1)

    def _keep(self, word: Word, end: int) -> int:
        after = self._text[end : end + 1]
        if after in {".", "+", "-", "*", "=", "(", ")", ","}:
            return self._skip(
                word.column - 1,
                Message("{word}{after} is not a valid number", word=word.text, after=after),
                "Correct the number.",
            )
        if wrong := beyond(word):
            self.refuse(word.column, *wrong)
        self.words.append(word)
        return end
