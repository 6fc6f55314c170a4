"""Reading of a program: its lines ready for execution, its structure and its syntax errors.

A line of MDI is read like a line of a program, but words that need other lines are errors.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.consequent_faults import without_follow_ups
from core.interpreter.omniturn.flow.loops_and_subroutines import Structure, call_target, find_structure
from core.interpreter.omniturn.motion.plain_moves import Columns, ReadyLines, read_lines, read_move
from core.interpreter.omniturn.omniturn_statement import (
    PLANE,
    UNREADABLE,
    ReadyLine,
    Statement,
    statement_of,
    unreadable,
)
from core.interpreter.shared.diagnostic_log import without_repeats
from core.language.diagnostics import Diagnostic, ProgramError, Severity, refusal
from core.language.omniturn import Line, lex_line
from core.language.omniturn.other_controls import recognize
from core.language.omniturn.plane_switching_lines import (
    PlaneLine,
    ends_program,
    lacks_sign,
    lex_plane,
    plane_entry,
)
from core.language.source import Source
from core.message import Message

# --- common deviations: one note for each kind in a file, or an error for each in strict mode


_ODD_IN_COMMENT = frozenset("!@#$%^&*\"'?><,/\\|=-.")

_KINDS = {
    "blank-line": (
        "The line is blank.",
        ("Delete the line if the program must run on the original control."),
    ),
    "title-line": ("The line contains only a comment.", ("Put the comment on a line with a command.")),
    "comment-character": (
        "The comment contains characters other than letters, digits and spaces.",
        ("Use only letters, digits and spaces."),
    ),
    "tool-zero": ("The tool number has a leading zero.", "Write T1 instead of T01."),
    "subroutine-comment": (
        "A comment is on the line that starts a subroutine.",
        ("Move the comment to the next line."),
    ),
    "line-ends": (
        "The lines end with a carriage return.",
        ("Save the file with the line endings that this machine uses."),
    ),
    "last-newline": ("The last line has no line ending.", "Press Enter at the end of the last line."),
}


class Style:
    """Collector of style deviations in one program."""

    def __init__(self, *, strict: bool) -> None:
        self.found: list[Diagnostic] = []
        self._strict = strict
        self._places: dict[str, int] = {}  # kind → index in ``found``

    def tell(self, kind: str, line: int, column: int = 0, count: int = 1) -> None:
        """Record ``count`` occurrences of ``kind``, the first of them at this location."""
        at = self._places.get(kind)
        if at is not None and not self._strict:
            self.found[at] = replace(self.found[at], count=self.found[at].count + count)
            return
        self._places[kind] = len(self.found)
        message, hint = _KINDS[kind]
        severity = Severity.ERROR if self._strict else Severity.NOTE
        self.found.append(Diagnostic(line, column, severity, kind, message, hint, count=count))

    def look_at_file(self, source: Source) -> None:
        """Record deviations in the line ends of the file."""
        if "\r" in source.text:
            self.tell("line-ends", 1, count=source.text.count("\r"))
        if source.text and source.text[-1] not in "\r\n":
            self.tell("last-newline", len(source.lines))

    def look_at(self, line: Line, statement: Statement) -> None:
        """Record deviations in the comments and tool numbers of one line."""
        tool = statement.words.get("T")
        if tool is not None and tool.text[1:].startswith("0") and len(tool.text) > 2:
            self.tell("tool-zero", line.number, tool.column)
        if line.comment is None:
            return
        if not statement.executable:
            self.tell("title-line", line.number, line.comment_column)
        if statement.flow == "}":
            self.tell("subroutine-comment", line.number, line.comment_column)
        if not _ODD_IN_COMMENT.isdisjoint(line.comment):
            self.tell("comment-character", line.number, line.comment_column)


_MOST_PROBLEMS = 100
_NEAR = 5  # lines


@dataclass(frozen=True, slots=True)
class Program:
    """A program ready for execution.

    ``ready`` has one entry per line; ``m_codes`` are M codes of the machine file.
    """

    source: Source
    ready: ReadyLines
    structure: Structure
    diagnostics: tuple[Diagnostic, ...]
    blocks: int  # lines with more than a comment
    names_units: bool  # whether the program contains G70 or G71
    m_codes: tuple[Statement, ...]  # lines whose M code must be in the machine file
    asks: tuple[Statement, ...] = ()  # lines whose subroutine call depends on an input
    # line and subroutine number of each call, and of each contour in a subroutine
    calls: tuple[tuple[int, int], ...] = ()

    def for_one_pass(self) -> Program:
        """Return a copy for one pass, which changes its lines independently."""
        return replace(self, ready=self.ready.copy())

    def line(self, number: int) -> Line:
        """Return the words of a line, which is counted from 1."""
        return lex_line(number, self.source.lines[number - 1])

    def statement(self, number: int) -> Statement | None:
        """Return the statement of a line, which is counted from 1; None for an empty line."""
        ready = self.ready[number - 1]
        return statement_of(self.line(number)) if isinstance(ready, tuple) else ready


class _Reader:
    def __init__(self, source: Source, *, strict: bool) -> None:
        self.source = source
        self.style = Style(strict=strict)
        self.blank = 0  # number of blank lines
        self.statements: list[Statement] = []
        self.problems: list[Diagnostic] = []
        self._plane = 0  # line of a (~PL..) without its (END) so far

    def read(self) -> ReadyLines:
        lines = read_lines(self.source.lines, self._line, in_order="~" in self.source.text)
        if self._plane:
            self._plane_open(self._plane)
        return lines

    def _line(self, number: int, text: str) -> ReadyLine:
        move = read_move(text)
        return self.statement(number, text) if move is None or self._plane else move

    def statement(self, number: int, text: str) -> Statement | None:
        if not text or text.isspace():
            self.style.tell("blank-line", number)
            self.blank += 1
            return None
        if self._plane and ends_program(text):
            self._plane_open(number)
        entry = plane_entry(text)
        if entry is not None or self._plane:
            return self._in_plane(number, text, entry)
        line = lex_line(number, text)
        self.problems.extend(line.errors)
        try:
            statement = statement_of(line)
        except ProgramError as problem:
            self.problems.append(problem.diagnostic)
            statement = unreadable(line)
        self._suspect_plane(number, text)
        self.style.look_at(line, statement)
        self.statements.append(statement)
        return statement

    def _suspect_plane(self, number: int, text: str) -> None:
        """Report a (PLXC) without its ~, because it and its moves are then only comments."""
        following = islice(self.source.lines, number, number + _NEAR)
        lacks = lacks_sign(text, following) if "(" in text else None
        if lacks is not None:
            name = text.strip().upper()
            message = Message(
                "The ~ is missing, so {name} and the lines up to (END) are comments and nothing is milled.",
                name=name,
            )
            weight = Severity.ERROR if lacks else Severity.WARNING
            self.problems.append(
                Diagnostic(
                    number, 1, weight, "plane-sign", message, Message("Write (~{name}.", name=name[1:])
                )
            )

    def _in_plane(self, number: int, text: str, entry: PlaneLine | None) -> Statement:
        """Read a line from the entry of plane switching to (END), both included."""
        statement = Statement(number, text.strip(), flow=PLANE)
        try:
            statement.plane = entry if entry is not None and not self._plane else lex_plane(number, text)
        except ProgramError as problem:
            self.problems.append(problem.diagnostic)
            statement.flow = UNREADABLE
        if statement.plane is not None and statement.plane.name:
            self._plane = 0 if statement.plane.name == "END" else number
        self.statements.append(statement)
        return statement

    def _plane_open(self, number: int) -> None:
        text = Message(
            "The plane command (~PLXC) or (~PLZC) on line {plane} has no matching (END).", plane=self._plane
        )
        self.problems.append(refusal(number, 1, "plane-open", text, "Write (END) alone on a line."))
        self._plane = 0


def read_program(source: Source, strict: bool = False) -> Program:
    """Read all lines, find loops, subroutines and the end, and collect the errors. Never raises.

    With ``strict``, style deviations that the manual of the original control forbids are errors.
    """
    reader = _Reader(source, strict=strict)
    ready = reader.read()
    length = len(ready)
    structure, faults = find_structure(reader.statements, length)
    if not length:
        faults = [refusal(0, 0, "file-empty", "The program is empty.", "Write G90 and M30.")]
    reader.style.look_at_file(source)
    problems = [*reader.problems, *faults, *_comments_in_loops(reader.statements, structure)]
    if not any(fault.code in {"after-end", "no-end", "subroutine-twice"} for fault in faults):
        problems += _beyond_the_end(ready, structure)
    problems.sort(key=lambda problem: (problem.line, problem.column))
    problems = without_repeats(without_follow_ups(problems, source.lines))
    if any(problem.severity is Severity.ERROR for problem in problems):
        problems = [*filter(None, (recognize(source.lines),)), *problems]
    return Program(
        source=source,
        ready=ready,
        structure=structure,
        diagnostics=(*_capped(problems), *_capped(reader.style.found)),
        blocks=_executable(reader, length),
        names_units=any({70, 71}.intersection(statement.modal) for statement in reader.statements),
        m_codes=tuple(statement for statement in reader.statements if of_machine_file(statement)),
        asks=tuple(statement for statement in reader.statements if statement.asks),
        calls=tuple(_calls(reader.statements)),
    )


def of_machine_file(statement: Statement) -> bool:
    """Return whether the line has an M code that is not built into the control."""
    return statement.m is not None and statement.m_code is None and f"M{statement.m}" not in FLOW_CODES


def _calls(statements: list[Statement]) -> Iterator[tuple[int, int]]:
    for statement in statements:
        if statement.calls:
            yield statement.line, call_target(statement)
        elif statement.contour_cycle and "P" in statement.words:
            yield statement.line, int(statement.value("P") or 0)


def read_statement(number: int, text: str) -> tuple[Statement | None, list[Diagnostic]]:
    """Return one line as a statement, with its errors; None for an empty line."""
    reader = _Reader(Source("", text), strict=False)
    statement = reader.statement(number, text)
    return statement, reader.problems


def _executable(reader: _Reader, length: int) -> int:
    comments = sum(1 for statement in reader.statements if not statement.executable)
    return length - reader.blank - comments


def _comments_in_loops(statements: list[Statement], structure: Structure) -> list[Diagnostic]:
    found: list[Diagnostic] = []
    depth = 0
    text, hint = "A comment is inside a loop.", "Move the comment before LS."
    for statement in statements:
        depth += (statement.line - 1 in structure.loop_ends) - (statement.line - 1 in structure.loop_starts)
        if depth and statement.comment is not None:
            found.append(Diagnostic(statement.line, 0, Severity.WARNING, "comment-in-loop", text, hint))
    return found


def _beyond_the_end(ready: ReadyLines, structure: Structure) -> list[Diagnostic]:
    """Return an error for the first move after M30 that is not in a subroutine; an empty list without one."""
    inside = False
    starts, ends = set(structure.subroutines.values()), set(structure.subroutine_ends.values())
    for at in range(structure.main_end, len(ready)):
        inside = (inside or at in starts) and at not in ends
        if not inside and isinstance(ready[at], tuple):
            text = "This line is after the end of the program but not in a subroutine."
            hint = "Move this line before M30, or start a subroutine with }n."
            return [refusal(at + 1, 1, "after-end", text, hint)]
    return []


def _capped(problems: list[Diagnostic]) -> list[Diagnostic]:
    """Return at most 100 findings. Errors have priority, so that warnings cannot displace an error."""
    if len(problems) <= _MOST_PROBLEMS:
        return problems
    by_weight = sorted(problems, key=lambda problem: problem.severity is not Severity.ERROR)
    return sorted(by_weight[:_MOST_PROBLEMS], key=lambda problem: (problem.line, problem.column))


_HINT = "Use this command in a program."


def read_single(source: Source) -> Program:
    """Return a line of MDI as a program of one line. Never raises.

    Words that need other lines are reported as errors.
    """
    text = source.lines[0] if source.lines else ""
    try:
        statement, problems = read_statement(1, text)
    except ProgramError as problem:
        statement, problems = None, [problem.diagnostic]
    if statement is not None and not problems:
        refused = _alone(statement)
        problems = [refused] if refused is not None else []
    executable = statement is not None and statement.executable
    unknown = (statement,) if statement is not None and of_machine_file(statement) else ()
    return Program(
        source=source,
        ready=ReadyLines(Columns.empty(1), {0: statement}),
        structure=Structure({}, {}, {}, {}, 1, {}),
        diagnostics=tuple(problems),
        blocks=int(executable),
        names_units=True,
        m_codes=unknown,
    )


def _alone(statement: Statement) -> Diagnostic | None:
    """Return the error for a line that needs other lines, or None."""
    if statement.flow and statement.flow != UNREADABLE:
        return _refuse(statement, 1, _steers(statement))
    if statement.block_delete:
        return _refuse(statement, 1, "/ skips a program line and has no meaning in MDI.")
    for code in statement.modal:
        if G_CODES[code].not_in_mdi:
            return _refuse(statement, 1, Message(G_CODES[code].not_in_mdi, code=f"G{code}"))
    if statement.code is not None and statement.entry.not_in_mdi:
        return _refuse(
            statement,
            statement.code.column,
            Message(statement.entry.not_in_mdi, code=statement.code.text),
        )
    radius = statement.words.get("R")
    if radius is not None and statement.moves and statement.one_shot is None:
        return _refuse(
            statement,
            radius.column,
            Message(
                "{radius} rounds the corner with the next move, but MDI runs only one line.",
                radius=radius.text,
            ),
        )
    return None


def _steers(statement: Statement) -> str:
    if statement.flow == PLANE:
        plane = FLOW_CODES["~PLXC"]
        return Message(plane.not_in_mdi, code=statement.text)
    word = statement.m_word.text if statement.m_word else statement.flow
    return Message(FLOW_CODES[statement.flow].not_in_mdi, code=word)


def _refuse(statement: Statement, column: int, text: str) -> Diagnostic:
    return refusal(statement.line, column, "not-alone-mdi", text, _HINT)
