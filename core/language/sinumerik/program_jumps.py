"""Lines that steer the program: GOTOF, GOTOB, IF, CASE, WHILE, FOR, LOOP, REPEAT, PROC, DEF, MSG, STOPRE."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from core.language.formulas import INDICES, Formula, FormulaError, FormulaReader, Operation
from core.language.line_reading import LineReader
from core.language.sinumerik.array_values import Values, read_values
from core.language.sinumerik.call_arguments import Parameter, read_parameters
from core.language.sinumerik.sinumerik_formulas import GRAMMAR, formula_at
from core.message import Message


class Steering(StrEnum):
    """What a line does besides words."""

    GOTO_FORWARD = "GOTOF"
    GOTO_BACK = "GOTOB"
    GOTO_START = "GOTOS"
    GOTO = "GOTO"
    IF = "IF"
    ELSE = "ELSE"
    END_IF = "ENDIF"
    CASE = "CASE"
    WHILE = "WHILE"
    END_WHILE = "ENDWHILE"
    FOR = "FOR"
    END_FOR = "ENDFOR"
    LOOP = "LOOP"
    END_LOOP = "ENDLOOP"
    REPEAT = "REPEAT"
    REPEAT_BLOCK = "REPEATB"
    UNTIL = "UNTIL"
    DEFINE = "DEF"
    PROCEDURE = "PROC"
    EXTERN = "EXTERN"
    MESSAGE = "MSG"
    ALARM = "SETAL"
    STOP_READING = "STOPRE"
    DISPLAY_OFF = "DISPLOF"
    DISPLAY_ON = "DISPLON"
    SINGLE_BLOCK_OFF = "SBLOF"
    SINGLE_BLOCK_ON = "SBLON"
    GROUP_BEGIN = "GROUP_BEGIN"
    GROUP_END = "GROUP_END"
    RETURN = "RET"


class Defined(NamedTuple):
    """A variable of DEF with the formula of its first value; None is 0.

    ``sizes`` are those of an array, one for each of its dimensions; ``values`` a list for its elements.
    """

    name: str
    formula: Formula | None
    kind: str = "REAL"
    sizes: tuple[Formula, ...] = ()
    text: str = ""
    values: Values | None = None


class Choice(NamedTuple):
    """One branch of CASE; without ``formula`` that of DEFAULT."""

    formula: Formula | None
    steering: Steering
    target: str


class Jump(NamedTuple):
    """One steering line. ``condition`` of IF, CASE, WHILE, UNTIL; ``target`` of a jump: a label, or N123.

    ``name first last`` are variable, start and end of FOR; ``name parameters saves`` of PROC; ``pieces`` are
    texts and formulas of MSG. REPEAT goes from ``target`` to ``until``, ``passes`` times. ``other`` is one
    more IF … GOTO of the block. ``column`` from 1.
    """

    steering: Steering
    column: int
    condition: Formula | None = None
    target: str = ""
    name: str = ""
    first: Formula | None = None
    last: Formula | None = None
    pieces: tuple[str | Formula, ...] = ()
    defined: tuple[Defined, ...] = ()
    choices: tuple[Choice, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    saves: bool = False
    until: str = ""
    passes: Formula | None = None
    other: Jump | None = None


_WORDS = re.compile("(" + "|".join(sorted(Steering, key=len, reverse=True)) + r")(?![A-Z0-9_=])")
_GOTO = re.compile(r"\s*(GOTO[FBS]?)(?![A-Z0-9_])\s*")
_TARGET = re.compile(r"(?:N[0-9]+|[A-Z_][A-Z_][A-Z0-9_]*)\s*")
_NAME = re.compile(r"\s*(R[0-9]+|[A-Z_][A-Z_][A-Z0-9_]*)\s*=")
_TO = re.compile(r"\s*TO(?![A-Z])")
_OF = re.compile(r"\s*OF(?![A-Z0-9_])")
_DEFAULT = re.compile(r"\s*DEFAULT(?![A-Z0-9_])")
_NEXT_IF = re.compile(r"\s*IF(?![A-Z0-9_])")
_REPEATED = re.compile(r"\s*([A-Z_][A-Z_][A-Z0-9_]*|N[0-9]+)(?![A-Z0-9_])(?!\s*=)")
_PASSES = re.compile(r"\s*P(?:\s*=\s*|(?=[0-9]))")
_TYPE = re.compile(
    r"\s*(?:NCK\s|CHAN\s)?\s*(REAL|INT|BOOL|CHAR|STRING|AXIS|FRAME)(?![A-Z])(?:\s*\[[^\]]*\])?"
)
_VARIABLE = re.compile(r"\s*([A-Z_][A-Z_][A-Z0-9_]*)\s*(\[|=|,|$)")
_PROCEDURE = re.compile(r"\s*([A-Z_][A-Z_][A-Z0-9_]*|L[0-9]+)\s*")
_ATTRIBUTE = re.compile(r"\s*(SAVE|DISPLOF|DISPLON|SBLOF|SBLON|ACTBLOCNO|PREPRO)(?![A-Z0-9_])")
_JOINED = re.compile(r'\s*(?:"([^"]*)"|<<)')
_ANY_BRACKET = re.compile(r"\s*\([^()]*\)\s*$")
_OPEN = re.compile(r"\s*\(")
_SIGN = re.compile(r"\s*([,=]?)")
_NO_TEXT = ("MSG needs its text in parentheses", 'Write MSG("TEXT").')
_NUMBERS = frozenset({"REAL", "INT", "BOOL", "CHAR"})
_TOLERATED_BRACKET = frozenset({Steering.GROUP_BEGIN, Steering.GROUP_END, Steering.RETURN})


def steering_word(text: str, at: int) -> Steering | None:
    """The word of a steering line that stands here (``text`` in capitals)."""
    match = _WORDS.match(text, at)
    return None if match is None else Steering(match.group(1))


def read_jump(text: str, written: str, at: int, steering: Steering) -> Jump:
    """The line whose steering word stands at ``at``; ``written`` in its own case. Raises FormulaError."""
    reader = _Reader(text, written, at, steering)
    jump = reader.jump()
    reader.demand_end()
    return jump


class _Reader(LineReader):
    def __init__(self, text: str, written: str, at: int, steering: Steering) -> None:
        super().__init__(text, at + len(steering))
        self._written, self._steering = written, steering
        self._column = at + 1

    def jump(self) -> Jump:
        read = {
            **dict.fromkeys((Steering.GOTO, Steering.GOTO_FORWARD, Steering.GOTO_BACK), self._goto),
            **dict.fromkeys((Steering.WHILE, Steering.UNTIL), self._conditional),
            **dict.fromkeys((Steering.REPEAT, Steering.REPEAT_BLOCK), self._repeat),
            Steering.IF: self._if,
            Steering.CASE: self._case,
            Steering.FOR: self._for,
            Steering.DEFINE: self._define,
            Steering.PROCEDURE: self._procedure,
            Steering.EXTERN: self._extern,
            Steering.MESSAGE: self._message,
            Steering.ALARM: self._alarm,
        }.get(self._steering)
        if self._steering in _TOLERATED_BRACKET:
            self.take(_ANY_BRACKET)
        return Jump(self._steering, self._column) if read is None else read()

    def _demand(self, pattern: re.Pattern[str], problem: str, hint: str) -> re.Match[str]:
        """Return what the pattern matches here, and move behind it. Raises FormulaError without a match."""
        match = self.take(pattern)
        if match is None:
            raise FormulaError(self.at, problem, hint)
        return match

    def _goto(self) -> Jump:
        return Jump(self._steering, self._column, target=self._target())

    def _conditional(self) -> Jump:
        return Jump(self._steering, self._column, self._formula())

    def _define(self) -> Jump:
        return Jump(self._steering, self._column, defined=tuple(self._definitions()))

    def demand_end(self) -> None:
        if not self.done:
            self.blanks()
            raise FormulaError(
                self.at,
                Message("Unexpected text after {steering}", steering=self._steering),
                "Put the extra text in a separate block.",
            )

    def _if(self) -> Jump:
        """With a jump behind the condition the whole branch; without one the beginning of IF … ENDIF."""
        condition = self._formula()
        match = self.take(_GOTO)
        if match is None:
            return Jump(Steering.IF, self._column, condition)
        steering = Steering(match.group(1))
        target = "" if steering is Steering.GOTO_START else self._target()
        jump = Jump(steering, self._column, condition, target)
        if another := self.take(_NEXT_IF):
            self._column = another.end() - 1
            jump = jump._replace(other=self._if())
        return jump

    def _case(self) -> Jump:
        """CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C."""
        condition, choices = self._formula(), list[Choice]()
        self._demand(_OF, "CASE needs OF", "Write, for example, CASE R1 OF 1 GOTOF A DEFAULT GOTOF B.")
        while not self.done:
            formula = None if self.take(_DEFAULT) else self._formula()
            jump = self._demand(_GOTO, "A CASE branch needs a jump", "Write, for example, 1 GOTOF LABEL.")
            choices.append(Choice(formula, Steering(jump.group(1)), self._target()))
        if not choices:
            raise FormulaError(self.at, "CASE has no branch", "Write, for example, CASE R1 OF 1 GOTOF A.")
        return Jump(Steering.CASE, self._column, condition, choices=tuple(choices))

    def _for(self) -> Jump:
        hint = "Write, for example, FOR R1 = 1 TO 5."
        name = self._demand(_NAME, "FOR needs a variable and =", hint).group(1)
        first = self._formula()
        self._demand(_TO, "FOR needs TO", hint)
        return Jump(Steering.FOR, self._column, name=name, first=first, last=self._formula())

    def _repeat(self) -> Jump:
        """REPEAT alone begins REPEAT … UNTIL; with a label or two it runs a part of the program again."""
        labels = list[str]()
        while len(labels) < 2 and (match := self.take(_REPEATED)):
            labels.append(match.group(1))
        if not labels:
            return Jump(self._steering, self._column)
        passes = self._formula() if self.take(_PASSES) else None
        return Jump(self._steering, self._column, target=labels[0], until=labels[-1] if labels[1:] else "",
                    passes=passes)  # fmt: skip

    def _definitions(self) -> list[Defined]:
        at, hint = self.at, "Write, for example, DEF REAL NAME = 0."
        kind = self._demand(_TYPE, "DEF needs REAL, INT, BOOL or STRING", hint)[1]
        if kind not in _NUMBERS | {"STRING"}:
            text = Message("Variables of type {name} are not supported", name=kind)
            raise FormulaError(at, text, "Use REAL, INT, BOOL or STRING.")
        found = [self._defined(kind)]
        while not self.done:
            found.append(self._defined(kind))
        return found

    def _defined(self, kind: str) -> Defined:
        hint = "Write, for example, DEF REAL NAME = 0."
        variable = self._demand(_VARIABLE, "DEF needs a variable name", hint)
        made, after = Defined(variable.group(1), None, kind), variable.group(2)
        if after == "[":
            self.at -= 1
            made = made._replace(sizes=self._sizes())
            after = self._sign()
        if after == "=":
            made = self._first_value(made)
            self._sign()
        return made

    def _first_value(self, made: Defined) -> Defined:
        """What stands behind the = of DEF: a text, a list for an array, a formula."""
        quoted = _JOINED.match(self._written, self.at)
        if made.kind == "STRING" and quoted and quoted[1] is not None:
            self.at = quoted.end()
            return made._replace(text=quoted[1])
        listed = read_values(self.upper, self.at, bare=True) if made.sizes else None
        if listed is None:
            return made._replace(formula=self._formula())
        self.at = listed[1]
        return made._replace(values=listed[0])

    def _sizes(self) -> tuple[Formula, ...]:
        reader = FormulaReader(GRAMMAR, self.upper, self.at)
        size = reader.index()
        self.at = reader.at
        return size.operands if isinstance(size, Operation) and size.name == INDICES else (size,)

    def _sign(self) -> str:
        """A comma or = that stands here."""
        match = self.take(_SIGN)
        return "" if match is None else match[1]

    def _procedure(self) -> Jump:
        name, parameters = self._heading()
        saves = False
        while match := self.take(_ATTRIBUTE):
            saves = saves or match[1] == "SAVE"
        return Jump(self._steering, self._column, name=name, parameters=parameters, saves=saves)

    def _extern(self) -> Jump:
        name, parameters = self._heading()
        return Jump(self._steering, self._column, name=name, parameters=parameters)

    def _heading(self) -> tuple[str, tuple[Parameter, ...]]:
        problem = Message("{steering} needs a subprogram name", steering=self._steering)
        match = self._demand(_PROCEDURE, problem, "Write, for example, PROC NAME(REAL LENGTH).")
        parameters = tuple[Parameter, ...]()
        if self.upper.startswith("(", self.at):
            parameters, self.at = read_parameters(self.upper, self._written, self.at)
        return match[1], parameters

    def _message(self) -> Jump:
        """MSG("TEXT"<<R1): texts and formulas, joined by <<."""
        closing = self.upper.rstrip()
        if not closing.endswith(")"):
            raise FormulaError(self.at, *_NO_TEXT)
        self._demand(_OPEN, *_NO_TEXT)
        end = len(closing) - 1
        pieces: list[str | Formula] = []
        while self.upper[self.at : end].strip():
            if match := _JOINED.match(self._written, self.at, end):
                self.at = match.end()
                pieces += [] if match[1] is None else [match[1]]
            elif self.upper[self.at : end].lstrip().startswith(","):
                break  # what stands behind the text says only how it is shown
            else:
                pieces.append(self._formula())
        self.at = len(self.upper)
        return Jump(self._steering, self._column, pieces=tuple(pieces))

    def _alarm(self) -> Jump:
        self._demand(_OPEN, "SETAL needs a number in parentheses", "Write, for example, SETAL(65000).")
        number = self._formula()
        self.at = len(self.upper)
        return Jump(self._steering, self._column, number)

    def _target(self) -> str:
        self.blanks()
        hint = "Write a label, or N with a block number."
        return self._demand(_TARGET, "A jump needs a label", hint).group().strip()

    def _formula(self) -> Formula:
        made, self.at = formula_at(self.upper, self.at)
        return made
