"""Lines that steer the program: GOTOF, GOTOB, IF, WHILE, FOR, LOOP, REPEAT, DEF, MSG, STOPRE."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError, FormulaReader
from core.language.sinumerik.sinumerik_formulas import GRAMMAR


class Steering(StrEnum):
    """What a line does besides words."""

    GOTO_FORWARD = "GOTOF"
    GOTO_BACK = "GOTOB"
    GOTO = "GOTO"
    IF = "IF"
    ELSE = "ELSE"
    END_IF = "ENDIF"
    WHILE = "WHILE"
    END_WHILE = "ENDWHILE"
    FOR = "FOR"
    END_FOR = "ENDFOR"
    LOOP = "LOOP"
    END_LOOP = "ENDLOOP"
    REPEAT = "REPEAT"
    UNTIL = "UNTIL"
    DEFINE = "DEF"
    MESSAGE = "MSG"
    STOP_READING = "STOPRE"
    RETURN = "RET"


class Defined(NamedTuple):
    """A variable of DEF, and the formula of its first value; None is 0."""

    name: str
    formula: Formula | None


class Jump(NamedTuple):
    """One steering line. ``condition`` of IF, WHILE, UNTIL; ``target`` of a jump, a label or N with a number.

    ``name first last`` are variable, start and end of FOR; ``text`` is that of MSG; ``column`` from 1.
    """

    steering: Steering
    column: int
    condition: Formula | None = None
    target: str = ""
    name: str = ""
    first: Formula | None = None
    last: Formula | None = None
    text: str = ""
    defined: tuple[Defined, ...] = ()


_WORDS = re.compile("(" + "|".join(sorted(Steering, key=len, reverse=True)) + r")(?![A-Z0-9_=])")
_GOTO = re.compile(r"\s*(GOTO[FB]?)(?![A-Z0-9_])\s*")
_TARGET = re.compile(r"(?:N[0-9]+|[A-Z_][A-Z_][A-Z0-9_]*)\s*")
_NAME = re.compile(r"\s*(R[0-9]+|[A-Z_][A-Z_][A-Z0-9_]*)\s*=")
_TO = re.compile(r"\s*TO(?![A-Z])")
_TYPE = re.compile(r"\s*(REAL|INT|BOOL)(?![A-Z])")
_VARIABLE = re.compile(r"\s*([A-Z_][A-Z_][A-Z0-9_]*)\s*(=|,|$)")
_MESSAGE = re.compile(r'\s*\(\s*(?:"([^"]*)"\s*)?\)\s*$')


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


class _Reader:
    def __init__(self, text: str, written: str, at: int, steering: Steering) -> None:
        self._text, self._written, self._steering = text, written, steering
        self._column = at + 1
        self._at = at + len(steering)

    def jump(self) -> Jump:
        read = {
            **dict.fromkeys((Steering.GOTO, Steering.GOTO_FORWARD, Steering.GOTO_BACK), self._goto),
            **dict.fromkeys((Steering.WHILE, Steering.UNTIL), self._conditional),
            Steering.IF: self._if,
            Steering.FOR: self._for,
            Steering.DEFINE: self._define,
            Steering.MESSAGE: self._message,
        }.get(self._steering)
        return Jump(self._steering, self._column) if read is None else read()

    def _goto(self) -> Jump:
        return Jump(self._steering, self._column, target=self._target())

    def _conditional(self) -> Jump:
        return Jump(self._steering, self._column, self._formula())

    def _define(self) -> Jump:
        return Jump(self._steering, self._column, defined=tuple(self._definitions()))

    def demand_end(self) -> None:
        rest = self._text[self._at :]
        if rest.strip():
            at = self._at + len(rest) - len(rest.lstrip())
            raise FormulaError(at, f"More stands behind {self._steering}", "Put it into a block of its own.")

    def _if(self) -> Jump:
        """With a jump behind the condition the whole branch; without one the beginning of IF … ENDIF."""
        condition = self._formula()
        match = _GOTO.match(self._text, self._at)
        if match is None:
            return Jump(Steering.IF, self._column, condition)
        self._at = match.end()
        return Jump(Steering(match.group(1)), self._column, condition, self._target())

    def _for(self) -> Jump:
        match = _NAME.match(self._text, self._at)
        if match is None:
            raise FormulaError(self._at, "FOR needs a variable and =", "Write FOR R1 = 1 TO 5.")
        self._at = match.end()
        first = self._formula()
        to = _TO.match(self._text, self._at)
        if to is None:
            raise FormulaError(self._at, "FOR needs TO", "Write FOR R1 = 1 TO 5.")
        self._at = to.end()
        last = self._formula()
        return Jump(Steering.FOR, self._column, name=match.group(1), first=first, last=last)

    def _definitions(self) -> list[Defined]:
        match = _TYPE.match(self._text, self._at)
        if match is None:
            raise FormulaError(self._at, "DEF needs REAL, INT or BOOL", "Other types are not read here.")
        self._at = match.end()
        found: list[Defined] = []
        while True:
            variable = _VARIABLE.match(self._text, self._at)
            if variable is None:
                raise FormulaError(self._at, "DEF needs the name of a variable", "Write DEF REAL NAME = 0.")
            self._at = variable.end()
            formula = None
            if variable.group(2) == "=":
                formula = self._formula()
                rest = self._text[self._at :].lstrip()
                self._at = len(self._text) - len(rest) + rest.startswith(",")
            found.append(Defined(variable.group(1), formula))
            if not self._text[self._at :].strip():
                return found

    def _message(self) -> Jump:
        match = _MESSAGE.match(self._written, self._at)
        if match is None:
            raise FormulaError(self._at, "MSG needs its text in brackets and quotes", 'Write MSG("TEXT").')
        self._at = len(self._text)
        return Jump(self._steering, self._column, text=match.group(1) or "")

    def _target(self) -> str:
        while self._text[self._at : self._at + 1].isspace():
            self._at += 1
        match = _TARGET.match(self._text, self._at)
        if match is None:
            raise FormulaError(self._at, "A jump needs a label", "Write the label, or N with its number.")
        self._at = match.end()
        return match.group().strip()

    def _formula(self) -> Formula:
        reader = FormulaReader(GRAMMAR, self._text, self._at)
        made = reader.formula()
        self._at = reader.at
        return made
