"""Parsing of a program into executable lines, its structure and its syntax errors.

An MDI line is parsed like a line of a program, but words that depend on other lines are errors.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.consequent_faults import remove_consequent_findings
from core.interpreter.omniturn.flow.loops_and_subroutines import (
    ProgramStructure,
    find_structure,
    get_subroutine_number,
)
from core.interpreter.omniturn.motion.plain_moves import (
    ExecutableLines,
    LineColumns,
    parse_lines,
    parse_plain_move,
)
from core.interpreter.omniturn.omniturn_statement import (
    PLANE_FLOW,
    UNREADABLE_FLOW,
    ExecutableLine,
    Statement,
    make_statement,
    make_unreadable_statement,
)
from core.interpreter.shared.diagnostic_log import merge_repeated_findings
from core.language.diagnostics import Diagnostic, ProgramError, Severity, make_error_diagnostic
from core.language.omniturn import LexedLine, lex_line
from core.language.omniturn.other_controls import recognize_control
from core.language.omniturn.plane_switching_lines import (
    PlaneSwitchingLine,
    is_missing_tilde,
    is_program_end,
    lex_plane_switching_line,
    parse_plane_switching_start,
)
from core.language.source import ProgramSource
from core.message import Message

# --- common deviations: one note for each kind in a file, or an error for each in strict mode


_UNUSUAL_COMMENT_CHARACTERS = frozenset("!@#$%^&*\"'?><,/\\|=-.")

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


class StyleChecker:
    """Collector of a program's deviations from the style that the original control requires."""

    def __init__(self, *, strict: bool) -> None:
        self.findings: list[Diagnostic] = []
        self._strict = strict
        self._places: dict[str, int] = {}  # kind → index in ``findings``

    def record_deviation(self, kind: str, line: int, column: int = 0, occurrence_count: int = 1) -> None:
        """Record ``occurrence_count`` occurrences of a deviation.

        ``line`` and ``column`` are the location of the first occurrence.
        """
        at = self._places.get(kind)
        if at is not None and not self._strict:
            self.findings[at] = replace(
                self.findings[at], occurrence_count=self.findings[at].occurrence_count + occurrence_count
            )
            return
        self._places[kind] = len(self.findings)
        message, hint = _KINDS[kind]
        severity = Severity.ERROR if self._strict else Severity.NOTE
        self.findings.append(
            Diagnostic(line, column, severity, kind, message, hint, occurrence_count=occurrence_count)
        )

    def check_file(self, source: ProgramSource) -> None:
        """Record deviations in the line ends of the file."""
        if "\r" in source.text:
            self.record_deviation("line-ends", 1, occurrence_count=source.text.count("\r"))
        if source.text and source.text[-1] not in "\r\n":
            self.record_deviation("last-newline", len(source.lines))

    def check_line(self, line: LexedLine, statement: Statement) -> None:
        """Record deviations in the comments and tool numbers of one line."""
        tool = statement.words.get("T")
        if tool is not None and tool.text[1:].startswith("0") and len(tool.text) > 2:
            self.record_deviation("tool-zero", line.line_number, tool.column)
        if line.comment is None:
            return
        if not statement.is_executable:
            self.record_deviation("title-line", line.line_number, line.comment_column)
        if statement.flow_code == "}":
            self.record_deviation("subroutine-comment", line.line_number, line.comment_column)
        if not _UNUSUAL_COMMENT_CHARACTERS.isdisjoint(line.comment):
            self.record_deviation("comment-character", line.line_number, line.comment_column)


_MAX_FINDINGS = 100
_NEAR = 5  # lines


@dataclass(frozen=True, slots=True)
class Program:
    """A program ready for execution.

    ``executable_lines`` has one entry per line. ``machine_m_code_lines`` are the lines with M codes of the
    machine file.
    """

    source: ProgramSource
    executable_lines: ExecutableLines
    structure: ProgramStructure
    diagnostics: tuple[Diagnostic, ...]
    block_count: int  # lines with more than a comment
    has_units_code: bool  # whether the program contains G70 or G71
    machine_m_code_lines: tuple[Statement, ...]  # lines whose M code must be in the machine file
    input_dependent_calls: tuple[Statement, ...] = ()  # lines whose subroutine call depends on an input
    # line and subroutine number of each call, and of each contour in a subroutine
    subroutine_calls: tuple[tuple[int, int], ...] = ()

    def copy_for_pass(self) -> Program:
        """Return a copy for one pass. The pass can change the lines of the copy independently."""
        return replace(self, executable_lines=self.executable_lines.copy_lines())

    def get_line(self, number: int) -> LexedLine:
        """Return the words of the line with this number, counted from 1."""
        return lex_line(number, self.source.lines[number - 1])

    def get_statement(self, number: int) -> Statement | None:
        """Return the statement of the line with this number (from 1), or None for an empty line."""
        ready = self.executable_lines[number - 1]
        return make_statement(self.get_line(number)) if isinstance(ready, tuple) else ready


class _Reader:
    def __init__(self, source: ProgramSource, *, strict: bool) -> None:
        self.source = source
        self.style = StyleChecker(strict=strict)
        self.blank_line_count = 0  # number of blank lines
        self.statements: list[Statement] = []
        self.problems: list[Diagnostic] = []
        self._plane = 0  # line of a (~PL..) without its (END) so far

    def read_lines(self) -> ExecutableLines:
        lines = parse_lines(self.source.lines, self._line, reads_every_line="~" in self.source.text)
        if self._plane:
            self._plane_open(self._plane)
        return lines

    def _line(self, number: int, text: str) -> ExecutableLine:
        move = parse_plain_move(text)
        return self.read_statement(number, text) if move is None or self._plane else move

    def read_statement(self, number: int, text: str) -> Statement | None:
        if not text or text.isspace():
            self.style.record_deviation("blank-line", number)
            self.blank_line_count += 1
            return None
        if self._plane and is_program_end(text):
            self._plane_open(number)
        entry = parse_plane_switching_start(text)
        if entry is not None or self._plane:
            return self._in_plane(number, text, entry)
        line = lex_line(number, text)
        self.problems.extend(line.errors)
        try:
            statement = make_statement(line)
        except ProgramError as problem:
            self.problems.append(problem.diagnostic)
            statement = make_unreadable_statement(line)
        self._suspect_plane(number, text)
        self.style.check_line(line, statement)
        self.statements.append(statement)
        return statement

    def _suspect_plane(self, number: int, text: str) -> None:
        """Report a plane code such as (PLXC) that lacks the required ~.

        Without ~, all lines up to (END) would be treated as comments.
        """
        following = islice(self.source.lines, number, number + _NEAR)
        lacks = is_missing_tilde(text, following) if "(" in text else None
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

    def _in_plane(self, number: int, text: str, entry: PlaneSwitchingLine | None) -> Statement:
        """Parse one line within coordinate transformation (plane switching), from its start to (END)."""
        statement = Statement(number, text.strip(), flow_code=PLANE_FLOW)
        try:
            statement.plane_switching_line = (
                entry if entry is not None and not self._plane else lex_plane_switching_line(number, text)
            )
        except ProgramError as problem:
            self.problems.append(problem.diagnostic)
            statement.flow_code = UNREADABLE_FLOW
        if statement.plane_switching_line is not None and statement.plane_switching_line.name:
            self._plane = 0 if statement.plane_switching_line.name == "END" else number
        self.statements.append(statement)
        return statement

    def _plane_open(self, number: int) -> None:
        text = Message(
            "The plane command (~PLXC) or (~PLZC) on line {plane} has no matching (END).", plane=self._plane
        )
        self.problems.append(
            make_error_diagnostic(number, 1, "plane-open", text, "Write (END) alone on a line.")
        )
        self._plane = 0


def read_program(source: ProgramSource, is_strict: bool = False) -> Program:
    """Parse all lines of a program, find its loops, subroutines and end, and collect its errors.

    The function does not raise exceptions. If ``is_strict`` is True, deviations from the style that the
    manual of the original control requires are errors.
    """
    reader = _Reader(source, strict=is_strict)
    ready = reader.read_lines()
    length = len(ready)
    structure, faults = find_structure(reader.statements, length)
    if not length:
        faults = [make_error_diagnostic(0, 0, "file-empty", "The program is empty.", "Write G90 and M30.")]
    reader.style.check_file(source)
    problems = [*reader.problems, *faults, *_comments_in_loops(reader.statements, structure)]
    if not any(fault.code in {"after-end", "no-end", "subroutine-twice"} for fault in faults):
        problems += _check_after_end(ready, structure)
    problems.sort(key=lambda problem: (problem.line, problem.column))
    problems = merge_repeated_findings(remove_consequent_findings(problems, source.lines))
    if any(problem.severity is Severity.ERROR for problem in problems):
        problems = [*filter(None, (recognize_control(source.lines),)), *problems]
    return Program(
        source=source,
        executable_lines=ready,
        structure=structure,
        diagnostics=(*_limit_findings(problems), *_limit_findings(reader.style.findings)),
        block_count=_executable(reader, length),
        has_units_code=any({70, 71}.intersection(statement.modal_codes) for statement in reader.statements),
        machine_m_code_lines=tuple(
            statement for statement in reader.statements if is_machine_m_code(statement)
        ),
        input_dependent_calls=tuple(
            statement for statement in reader.statements if statement.depends_on_input
        ),
        subroutine_calls=tuple(_calls(reader.statements)),
    )


def is_machine_m_code(statement: Statement) -> bool:
    """Return whether the line has an M code that only the machine file can define."""
    return (
        statement.m_number is not None
        and statement.m_code_entry is None
        and f"M{statement.m_number}" not in FLOW_CODES
    )


def _calls(statements: list[Statement]) -> Iterator[tuple[int, int]]:
    for statement in statements:
        if statement.calls_subroutine:
            yield statement.line, get_subroutine_number(statement)
        elif statement.is_contour_cycle and "P" in statement.words:
            yield statement.line, int(statement.get_value("P") or 0)


def read_statement(number: int, text: str) -> tuple[Statement | None, list[Diagnostic]]:
    """Parse one line, and return its statement and its errors.

    The statement is None for an empty line.
    """
    reader = _Reader(ProgramSource("", text), strict=False)
    statement = reader.read_statement(number, text)
    return statement, reader.problems


def _executable(reader: _Reader, length: int) -> int:
    comments = sum(1 for statement in reader.statements if not statement.is_executable)
    return length - reader.blank_line_count - comments


def _comments_in_loops(statements: list[Statement], structure: ProgramStructure) -> list[Diagnostic]:
    found: list[Diagnostic] = []
    depth = 0
    text, hint = "A comment is inside a loop.", "Move the comment before LS."
    for statement in statements:
        depth += (statement.line - 1 in structure.loop_ends) - (statement.line - 1 in structure.loop_starts)
        if depth and statement.comment is not None:
            found.append(Diagnostic(statement.line, 0, Severity.WARNING, "comment-in-loop", text, hint))
    return found


def _check_after_end(ready: ExecutableLines, structure: ProgramStructure) -> list[Diagnostic]:
    """Return a list with an error if a move follows M30 outside of subroutines.

    Only the first such move is reported. Without such a move, the list is empty.
    """
    inside = False
    starts, ends = set(structure.subroutine_starts.values()), set(structure.subroutine_ends.values())
    for at in range(structure.main_end_index, len(ready)):
        inside = (inside or at in starts) and at not in ends
        if not inside and isinstance(ready[at], tuple):
            text = "This line is after the end of the program but not in a subroutine."
            hint = "Move this line before M30, or start a subroutine with }n."
            return [make_error_diagnostic(at + 1, 1, "after-end", text, hint)]
    return []


def _limit_findings(problems: list[Diagnostic]) -> list[Diagnostic]:
    """Return at most 100 findings; errors take precedence over warnings."""
    if len(problems) <= _MAX_FINDINGS:
        return problems
    by_weight = sorted(problems, key=lambda problem: problem.severity is not Severity.ERROR)
    return sorted(by_weight[:_MAX_FINDINGS], key=lambda problem: (problem.line, problem.column))


_HINT = "Use this command in a program."


def read_mdi_line(source: ProgramSource) -> Program:
    """Parse an MDI line and return it as a program with one line.

    The function does not raise exceptions. Words that depend on other lines are reported as errors.
    """
    text = source.lines[0] if source.lines else ""
    try:
        statement, problems = read_statement(1, text)
    except ProgramError as problem:
        statement, problems = None, [problem.diagnostic]
    if statement is not None and not problems:
        refused = _check_context(statement)
        problems = [refused] if refused is not None else []
    executable = statement is not None and statement.is_executable
    unknown = (statement,) if statement is not None and is_machine_m_code(statement) else ()
    return Program(
        source=source,
        executable_lines=ExecutableLines(LineColumns.make_empty(1), {0: statement}),
        structure=ProgramStructure({}, {}, {}, {}, 1, {}),
        diagnostics=tuple(problems),
        block_count=int(executable),
        has_units_code=True,
        machine_m_code_lines=unknown,
    )


def _check_context(statement: Statement) -> Diagnostic | None:
    """Return the error for a line that depends on other lines, or None if it can be executed alone."""
    if statement.flow_code and statement.flow_code != UNREADABLE_FLOW:
        return _refuse(statement, 1, _steers(statement))
    if statement.has_block_delete:
        return _refuse(statement, 1, "/ skips a program line and has no meaning in MDI.")
    for code in statement.modal_codes:
        if G_CODES[code].mdi_error_text:
            return _refuse(statement, 1, Message(G_CODES[code].mdi_error_text, code=f"G{code}"))
    if statement.code_word is not None and statement.code_entry.mdi_error_text:
        return _refuse(
            statement,
            statement.code_word.column,
            Message(statement.code_entry.mdi_error_text, code=statement.code_word.text),
        )
    radius = statement.words.get("R")
    if radius is not None and statement.has_x_or_z_move and statement.one_shot_code is None:
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
    if statement.flow_code == PLANE_FLOW:
        plane = FLOW_CODES["~PLXC"]
        return Message(plane.mdi_error_text, code=statement.text)
    word = statement.m_word.text if statement.m_word else statement.flow_code
    return Message(FLOW_CODES[statement.flow_code].mdi_error_text, code=word)


def _refuse(statement: Statement, column: int, text: str) -> Diagnostic:
    return make_error_diagnostic(statement.line, column, "not-alone-mdi", text, _HINT)
