"""Parser of program control lines, which contain jumps, IF, CASE, loops, REPEAT, PROC, DEF, MSG or STOPRE."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError, get_index_formulas
from core.language.sinumerik.block_reader import MAX_R_NUMBER, BlockReader, ValueList, read_value_list
from core.language.sinumerik.call_arguments import ProcParameter, read_parameters
from core.message import Message


class ControlKeyword(StrEnum):
    """Keyword that starts a program control line."""

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


class VariableDefinition(NamedTuple):
    """A variable that DEF defines. The formula of its initial value is None for the value 0.

    ``dimensions`` contains the dimensions of an array, and ``values`` contains the values of its elements.
    """

    name: str
    formula: Formula | None
    type_name: str = "REAL"
    dimensions: tuple[Formula, ...] = ()
    text: str = ""
    values: ValueList | None = None


class CaseBranch(NamedTuple):
    """One branch of CASE; ``formula`` is None for the DEFAULT branch."""

    formula: Formula | None
    jump_keyword: ControlKeyword
    target_label: str


class ControlStatement(NamedTuple):
    """One program control line. ``column`` counts from 1.

    - ``condition`` belongs to IF, CASE, WHILE and UNTIL.
    - ``target_label`` of a jump is a label or a block number such as N123.
    - ``identifier``, ``start_value`` and ``end_value`` are the variable, the start and the end of FOR.
    - PROC uses ``identifier``, ``parameters`` and ``has_save_keyword``.
    - ``message_parts`` contains the texts and formulas of MSG.
    - REPEAT executes the lines from ``target_label`` to ``end_label`` ``repeat_count`` more times.
    - ``else_jump`` is another IF … GOTO in the same block.
    """

    keyword: ControlKeyword
    column: int
    condition: Formula | None = None
    target_label: str = ""
    identifier: str = ""
    start_value: Formula | None = None
    end_value: Formula | None = None
    message_parts: tuple[str | Formula, ...] = ()
    definitions: tuple[VariableDefinition, ...] = ()
    case_branches: tuple[CaseBranch, ...] = ()
    parameters: tuple[ProcParameter, ...] = ()
    has_save_keyword: bool = False
    end_label: str = ""
    repeat_count: Formula | None = None
    else_jump: ControlStatement | None = None


_WORDS = re.compile("(" + "|".join(sorted(ControlKeyword, key=len, reverse=True)) + r")(?![A-Z0-9_=])")
_GOTO = re.compile(r"\s*(GOTO[FBS]?)(?![A-Z0-9_])\s*")
_TARGET = re.compile(r"(?:N[0-9]+|[A-Z_][A-Z_][A-Z0-9_]*)\s*")
_NAME = re.compile(r"\s*(R([0-9]+)|[A-Z_][A-Z_][A-Z0-9_]*)\s*=")
_TO_KEYWORD = re.compile(r"\s*TO(?![A-Z])")
_CASE_KEYWORD = re.compile(r"\s*OF(?![A-Z0-9_])")
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
_TOLERATED_BRACKET = frozenset({ControlKeyword.GROUP_BEGIN, ControlKeyword.GROUP_END, ControlKeyword.RETURN})


def find_control_keyword(text: str, index: int) -> ControlKeyword | None:
    """Return the keyword at ``index`` in ``text`` (a line in capitals), or None if there is no match."""
    match = _WORDS.match(text, index)
    return None if match is None else ControlKeyword(match.group(1))


def read_control_statement(
    text: str, original_text: str, index: int, keyword: ControlKeyword
) -> ControlStatement:
    """Read the control statement whose keyword is at ``index``.

    ``text`` is the line in capitals, and ``original_text`` is the line as written. Raises FormulaError for
    invalid syntax.
    """
    reader = _Reader(text, original_text, index, keyword)
    jump = reader.read_statement()
    reader.check_at_end()
    return jump


class _Reader(BlockReader):
    def __init__(self, text: str, original_text: str, index: int, keyword: ControlKeyword) -> None:
        super().__init__(text, original_text, index + len(keyword))
        self._steering, self._column = keyword, index + 1

    def read_statement(self) -> ControlStatement:
        read = {
            **dict.fromkeys(
                (ControlKeyword.GOTO, ControlKeyword.GOTO_FORWARD, ControlKeyword.GOTO_BACK), self._goto
            ),
            **dict.fromkeys((ControlKeyword.WHILE, ControlKeyword.UNTIL), self._conditional),
            **dict.fromkeys((ControlKeyword.REPEAT, ControlKeyword.REPEAT_BLOCK), self._repeat),
            ControlKeyword.IF: self._if,
            ControlKeyword.CASE: self._case,
            ControlKeyword.FOR: self._for,
            ControlKeyword.DEFINE: self._define,
            ControlKeyword.PROCEDURE: self._procedure,
            ControlKeyword.EXTERN: self._extern,
            ControlKeyword.MESSAGE: self._message,
            ControlKeyword.ALARM: self._alarm,
        }.get(self._steering)
        if self._steering in _TOLERATED_BRACKET:
            self.match_pattern(_ANY_BRACKET)
        return ControlStatement(self._steering, self._column) if read is None else read()

    def _goto(self) -> ControlStatement:
        return ControlStatement(self._steering, self._column, target_label=self._target())

    def _conditional(self) -> ControlStatement:
        return ControlStatement(self._steering, self._column, self.read_formula())

    def _define(self) -> ControlStatement:
        return ControlStatement(self._steering, self._column, definitions=tuple(self._definitions()))

    def check_at_end(self) -> None:
        self.skip_blanks()
        if self.remaining_text:
            text = Message("Unexpected text after {steering}", steering=self._steering)
            raise FormulaError(self.index, text, "Put the extra text in a separate block.")

    def _if(self) -> ControlStatement:
        """Read an IF, which is a conditional jump, or starts IF … ENDIF if no jump follows the condition."""
        condition = self.read_formula()
        match = self.match_pattern(_GOTO)
        if match is None:
            return ControlStatement(ControlKeyword.IF, self._column, condition)
        steering = ControlKeyword(match.group(1))
        target = "" if steering is ControlKeyword.GOTO_START else self._target()
        jump = ControlStatement(steering, self._column, condition, target)
        if self.match_pattern(_NEXT_IF):
            self._column = self.index - 1
            jump = jump._replace(else_jump=self._if())
        return jump

    def _case(self) -> ControlStatement:
        """Read a line such as CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C."""
        condition, choices = self.read_formula(), list[CaseBranch]()
        self.match_required(
            _CASE_KEYWORD, "CASE needs OF", "Write, for example, CASE R1 OF 1 GOTOF A DEFAULT GOTOF B."
        )
        while self.remaining_text:
            formula = None if self.match_pattern(_DEFAULT) else self.read_formula()
            jump = self.match_required(
                _GOTO, "A CASE branch needs a jump", "Write, for example, 1 GOTOF LABEL."
            )
            choices.append(CaseBranch(formula, ControlKeyword(jump.group(1)), self._target()))
        if not choices:
            raise FormulaError(self.index, "CASE has no branch", "Write, for example, CASE R1 OF 1 GOTOF A.")
        return ControlStatement(ControlKeyword.CASE, self._column, condition, case_branches=tuple(choices))

    def _for(self) -> ControlStatement:
        hint = "Write, for example, FOR R1 = 1 TO 5."
        variable = self.match_required(_NAME, "FOR needs a variable and =", hint)
        name, number = variable.groups()
        if number is not None and int(number) > MAX_R_NUMBER:
            text = Message("R{number} is not a valid parameter", number=number)
            limit = Message("Use a parameter from R0 to R{most_r}.", most_r=MAX_R_NUMBER)
            raise FormulaError(variable.start(1), text, limit)
        first = self.read_formula()
        self.match_required(_TO_KEYWORD, "FOR needs TO", hint)
        return ControlStatement(
            ControlKeyword.FOR,
            self._column,
            identifier=name,
            start_value=first,
            end_value=self.read_formula(),
        )

    def _repeat(self) -> ControlStatement:
        """Read a REPEAT, which starts REPEAT … UNTIL or, with labels, repeats a program section."""
        labels = list[str]()
        while len(labels) < 2 and (match := self.match_pattern(_REPEATED)):
            labels.append(match.group(1))
        if not labels:
            return ControlStatement(self._steering, self._column)
        passes = self.read_formula() if self.match_pattern(_PASSES) else None
        until = labels[-1] if labels[1:] else ""
        return ControlStatement(
            self._steering, self._column, target_label=labels[0], end_label=until, repeat_count=passes
        )

    def _definitions(self) -> list[VariableDefinition]:
        hint = "Write, for example, DEF REAL NAME = 0."
        kind = self.match_required(_TYPE, "DEF needs REAL, INT, BOOL or STRING", hint)
        if kind[1] not in _NUMBERS | {"STRING"}:
            text = Message("Variables of type {name} are not supported", name=kind[1])
            raise FormulaError(kind.start(), text, "Use REAL, INT, BOOL or STRING.")
        found = [self._defined(kind[1])]
        while self.remaining_text:
            found.append(self._defined(kind[1]))
        return found

    def _defined(self, kind: str) -> VariableDefinition:
        hint = "Write, for example, DEF REAL NAME = 0."
        name, after = self.match_required(_VARIABLE, "DEF needs a variable name", hint).groups()
        made = VariableDefinition(name, None, kind)
        if after == "[":
            self.index -= 1
            made = made._replace(dimensions=get_index_formulas(self.read_index()))
            after = self._sign()
        if after == "=":
            made = self._first_value(made)
            self._sign()
        return made

    def _first_value(self, definition: VariableDefinition) -> VariableDefinition:
        """Read the initial value in DEF, which is a string, a list for an array, or a formula."""
        quoted = _JOINED.match(self.original_text, self.index)
        if definition.type_name == "STRING" and quoted and quoted[1] is not None:
            self.index = quoted.end()
            return definition._replace(text=quoted[1])
        values = read_value_list(self, allows_bare_list=True) if definition.dimensions else None
        return (
            definition._replace(formula=self.read_formula())
            if values is None
            else definition._replace(values=values)
        )

    def _sign(self) -> str:
        """Read a comma or an equals sign, or return an empty string for any other character."""
        match = self.match_pattern(_SIGN)
        return "" if match is None else match[1]

    def _procedure(self) -> ControlStatement:
        jump = self._extern()
        saves = False
        while match := self.match_pattern(_ATTRIBUTE):
            saves = saves or match[1] == "SAVE"
        return jump._replace(has_save_keyword=saves)

    def _extern(self) -> ControlStatement:
        text = Message("{steering} needs a subprogram name", steering=self._steering)
        match = self.match_required(_PROCEDURE, text, "Write, for example, PROC NAME(REAL LENGTH).")
        parameters = read_parameters(self) if self.remaining_text.startswith("(") else ()
        return ControlStatement(self._steering, self._column, identifier=match[1], parameters=parameters)

    def _message(self) -> ControlStatement:
        """Read a line such as MSG("TEXT"<<R1), in which << concatenates texts and formulas."""
        closing = self.uppercase_text.rstrip()
        if not closing.endswith(")"):
            raise FormulaError(self.index, *_NO_TEXT)
        self.match_required(_OPEN, *_NO_TEXT)
        end = len(closing) - 1
        pieces: list[str | Formula] = []
        while self.uppercase_text[self.index : end].strip():
            if match := _JOINED.match(self.original_text, self.index, end):
                self.index = match.end()
                pieces += [] if match[1] is None else [match[1]]
            elif self.uppercase_text[self.index : end].lstrip().startswith(","):
                break  # The text after the comma only changes how the message is displayed.
            else:
                pieces.append(self.read_formula())
        self.index = len(self.uppercase_text)
        return ControlStatement(self._steering, self._column, message_parts=tuple(pieces))

    def _alarm(self) -> ControlStatement:
        self.match_required(_OPEN, "SETAL needs a number in parentheses", "Write, for example, SETAL(65000).")
        number = self.read_formula()
        self.index = len(self.uppercase_text)
        return ControlStatement(self._steering, self._column, number)

    def _target(self) -> str:
        self.skip_blanks()
        match = self.match_required(
            _TARGET, "A jump needs a label", "Write a label, or N with a block number."
        )
        return match.group().strip()
