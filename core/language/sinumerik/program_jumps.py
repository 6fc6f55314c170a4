"""Reader of program control lines: jumps, IF, CASE, loops, REPEAT, PROC, DEF, MSG and STOPRE."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError, indices_of
from core.language.sinumerik.block_reader import BlockReader, Values, read_values
from core.language.sinumerik.call_arguments import Parameter, read_parameters
from core.message import Message


class Steering(StrEnum):
    """Keyword of a program control line."""

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
    """A variable of DEF with the formula of its initial value; None means 0.

    ``sizes`` are the dimensions of an array, and ``values`` is a list of values for its elements.
    """

    name: str
    formula: Formula | None
    kind: str = "REAL"
    sizes: tuple[Formula, ...] = ()
    text: str = ""
    values: Values | None = None


class Choice(NamedTuple):
    """One branch of CASE; ``formula`` is None for the DEFAULT branch."""

    formula: Formula | None
    steering: Steering
    target: str


class Jump(NamedTuple):
    """One program control line. ``condition`` belongs to IF, CASE, WHILE and UNTIL.

    ``target`` of a jump is a label or a block number such as N123. ``name``, ``first`` and ``last`` are the
    variable, start and end of FOR. PROC uses ``name``, ``parameters`` and ``saves``. ``pieces`` are the texts
    and formulas of MSG. REPEAT executes the lines from ``target`` to ``until`` another ``passes`` times.
    ``other`` is a further IF … GOTO in the block. ``column`` counts from 1.
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
    """Return the keyword at index ``at`` of ``text``, a line in capitals, or None."""
    match = _WORDS.match(text, at)
    return None if match is None else Steering(match.group(1))


def read_jump(text: str, written: str, at: int, steering: Steering) -> Jump:
    """Read the line whose keyword is at ``at``; ``written`` is the original text. Raises FormulaError."""
    reader = _Reader(text, written, at, steering)
    jump = reader.jump()
    reader.demand_end()
    return jump


class _Reader(BlockReader):
    def __init__(self, text: str, written: str, at: int, steering: Steering) -> None:
        super().__init__(text, written, at + len(steering))
        self._steering, self._column = steering, at + 1

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
        """Return the match of the pattern at this position and move past it.

        Raises FormulaError without a match.
        """
        match = self.take(pattern)
        if match is None:
            raise FormulaError(self.at, problem, hint)
        return match

    def _goto(self) -> Jump:
        return Jump(self._steering, self._column, target=self._target())

    def _conditional(self) -> Jump:
        return Jump(self._steering, self._column, self.formula())

    def _define(self) -> Jump:
        return Jump(self._steering, self._column, defined=tuple(self._definitions()))

    def demand_end(self) -> None:
        self.blanks()
        if self.rest:
            text = Message("Unexpected text after {steering}", steering=self._steering)
            raise FormulaError(self.at, text, "Put the extra text in a separate block.")

    def _if(self) -> Jump:
        """Read an IF: a conditional jump, or the start of IF … ENDIF if no jump follows the condition."""
        condition = self.formula()
        match = self.take(_GOTO)
        if match is None:
            return Jump(Steering.IF, self._column, condition)
        steering = Steering(match.group(1))
        target = "" if steering is Steering.GOTO_START else self._target()
        jump = Jump(steering, self._column, condition, target)
        if self.take(_NEXT_IF):
            self._column = self.at - 1
            jump = jump._replace(other=self._if())
        return jump

    def _case(self) -> Jump:
        """Read a line such as CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C."""
        condition, choices = self.formula(), list[Choice]()
        self.demand(_OF, "CASE needs OF", "Write, for example, CASE R1 OF 1 GOTOF A DEFAULT GOTOF B.")
        while self.rest:
            formula = None if self.take(_DEFAULT) else self.formula()
            jump = self.demand(_GOTO, "A CASE branch needs a jump", "Write, for example, 1 GOTOF LABEL.")
            choices.append(Choice(formula, Steering(jump.group(1)), self._target()))
        if not choices:
            raise FormulaError(self.at, "CASE has no branch", "Write, for example, CASE R1 OF 1 GOTOF A.")
        return Jump(Steering.CASE, self._column, condition, choices=tuple(choices))

    def _for(self) -> Jump:
        hint = "Write, for example, FOR R1 = 1 TO 5."
        name = self.demand(_NAME, "FOR needs a variable and =", hint).group(1)
        first = self.formula()
        self.demand(_TO, "FOR needs TO", hint)
        return Jump(Steering.FOR, self._column, name=name, first=first, last=self.formula())

    def _repeat(self) -> Jump:
        """Read a REPEAT: the start of REPEAT … UNTIL, or with labels the repetition of a program section."""
        labels = list[str]()
        while len(labels) < 2 and (match := self.take(_REPEATED)):
            labels.append(match.group(1))
        if not labels:
            return Jump(self._steering, self._column)
        passes = self.formula() if self.take(_PASSES) else None
        until = labels[-1] if labels[1:] else ""
        return Jump(self._steering, self._column, target=labels[0], until=until, passes=passes)

    def _definitions(self) -> list[Defined]:
        hint = "Write, for example, DEF REAL NAME = 0."
        kind = self.demand(_TYPE, "DEF needs REAL, INT, BOOL or STRING", hint)
        if kind[1] not in _NUMBERS | {"STRING"}:
            text = Message("Variables of type {name} are not supported", name=kind[1])
            raise FormulaError(kind.start(), text, "Use REAL, INT, BOOL or STRING.")
        found = [self._defined(kind[1])]
        while self.rest:
            found.append(self._defined(kind[1]))
        return found

    def _defined(self, kind: str) -> Defined:
        hint = "Write, for example, DEF REAL NAME = 0."
        name, after = self.demand(_VARIABLE, "DEF needs a variable name", hint).groups()
        made = Defined(name, None, kind)
        if after == "[":
            self.at -= 1
            made = made._replace(sizes=indices_of(self.index()))
            after = self._sign()
        if after == "=":
            made = self._first_value(made)
            self._sign()
        return made

    def _first_value(self, made: Defined) -> Defined:
        """Read the text after the = of DEF: a string, a list for an array, or a formula."""
        quoted = _JOINED.match(self.written, self.at)
        if made.kind == "STRING" and quoted and quoted[1] is not None:
            self.at = quoted.end()
            return made._replace(text=quoted[1])
        values = read_values(self, bare=True) if made.sizes else None
        return made._replace(formula=self.formula()) if values is None else made._replace(values=values)

    def _sign(self) -> str:
        """Read a comma or an equals sign; return an empty string for any other character."""
        match = self.take(_SIGN)
        return "" if match is None else match[1]

    def _procedure(self) -> Jump:
        jump = self._extern()
        saves = False
        while match := self.take(_ATTRIBUTE):
            saves = saves or match[1] == "SAVE"
        return jump._replace(saves=saves)

    def _extern(self) -> Jump:
        text = Message("{steering} needs a subprogram name", steering=self._steering)
        match = self.demand(_PROCEDURE, text, "Write, for example, PROC NAME(REAL LENGTH).")
        parameters = read_parameters(self) if self.rest.startswith("(") else ()
        return Jump(self._steering, self._column, name=match[1], parameters=parameters)

    def _message(self) -> Jump:
        """Read a line such as MSG("TEXT"<<R1): texts and formulas that << concatenates."""
        closing = self.upper.rstrip()
        if not closing.endswith(")"):
            raise FormulaError(self.at, *_NO_TEXT)
        self.demand(_OPEN, *_NO_TEXT)
        end = len(closing) - 1
        pieces: list[str | Formula] = []
        while self.upper[self.at : end].strip():
            if match := _JOINED.match(self.written, self.at, end):
                self.at = match.end()
                pieces += [] if match[1] is None else [match[1]]
            elif self.upper[self.at : end].lstrip().startswith(","):
                break  # The text after the comma only changes how the message is displayed.
            else:
                pieces.append(self.formula())
        self.at = len(self.upper)
        return Jump(self._steering, self._column, pieces=tuple(pieces))

    def _alarm(self) -> Jump:
        self.demand(_OPEN, "SETAL needs a number in parentheses", "Write, for example, SETAL(65000).")
        number = self.formula()
        self.at = len(self.upper)
        return Jump(self._steering, self._column, number)

    def _target(self) -> str:
        self.blanks()
        match = self.demand(_TARGET, "A jump needs a label", "Write a label, or N with a block number.")
        return match.group().strip()
