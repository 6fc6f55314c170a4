"""Parsing of a Klartext program into lines, labels, the unit and syntax errors.

An MDI block is parsed separately. An MDI block that depends on other blocks is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.consequent_faults import remove_repeated_errors
from core.interpreter.shared.control_flow import ControlFlow, FlowFrame
from core.interpreter.shared.diagnostic_log import MAX_FINDINGS_PER_KIND
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.shared.working_plane import BlankCorners
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext import parse_line
from core.language.klartext.canonical_text import format_block, format_name
from core.language.klartext.klartext_faults import (
    EXCESSIVE_NESTING,
    LABEL_NOT_FOUND,
    LABEL_REPEATED,
    NOT_SUPPORTED,
    make_klartext_error,
    make_syntax_error,
)
from core.language.klartext.klartext_line import CONTINUATION_SIGN
from core.language.klartext.klartext_nodes import (
    BeginBlock,
    BlankCorner,
    ConditionalJump,
    CylinderBlank,
    EndBlock,
    HeadingLine,
    KlartextLine,
    Label,
    LabelCall,
    Node,
    SystemRead,
)
from core.language.klartext.named_files import TableRow, is_table_file, normalize_file_name, read_table_rows
from core.language.line_reading import find_comment_start
from core.language.source import ProgramSource
from core.message import Message

LabelName = int | str


@dataclass(slots=True)
class Program:
    """A parsed program with one entry in ``lines`` per program line.

    ``labels`` maps each label to the index of its line. ``end_index`` is the index of END PGM.
    """

    source: ProgramSource
    lines: list[KlartextLine]
    labels: dict[LabelName, int] = field(default_factory=dict)
    end_index: int = 0
    is_inch: bool = False
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _texts: dict[int, str] = field(default_factory=dict)
    blank_corners: BlankCorners | None = None  # corners of BLK FORM, mm
    called_programs: dict[str, Program] = field(
        default_factory=dict
    )  # called programs by file name in capitals
    # datum and point tables by file name in capitals
    tables_by_name: dict[str, dict[int, TableRow]] = field(default_factory=dict)

    @property
    def block_count(self) -> int:
        """Return the number of lines that contain more than a comment."""
        return sum(1 for line in self.lines if line.node is not None or line.error is not None)

    def text(self, line: KlartextLine) -> str:
        """Return the block of a line as display text, which is formatted only once and then cached."""
        text = self._texts.get(line.line_number)
        if text is None:
            text = self._texts[line.line_number] = format_block(line)
        return text

    def find_subprogram_end(self, label_index: int) -> int | None:
        """Return the index of the LBL 0 that ends a subprogram, or None if no LBL 0 follows.

        ``label_index`` is the index of the line with the label of the subprogram.
        """
        for index in range(label_index + 1, self.end_index):
            node = self.lines[index].node
            if isinstance(node, Label) and node.name == 0:
                return index
        return None


def read_program(source: ProgramSource) -> Program:
    """Parse all lines of a program and of the programs that it calls.

    The function does not raise exceptions; errors are in ``diagnostics``.
    """
    if (other := _din_iso(source)) is not None:
        return Program(source, [other], end_index=1, diagnostics=[other.error] if other.error else [])
    lines = _lines(source)
    remove_repeated_errors(lines)
    program = Program(source, lines, end_index=len(lines))
    found = [line.error for line in lines if line.error is not None]
    for look in (_frame, _labels, _calls):
        found += look(program)
    program.diagnostics = sorted(found, key=lambda each: (each.line, each.column))[
        : 2 * MAX_FINDINGS_PER_KIND
    ]
    program.blank_corners = _corners(program)
    for each in source.subprograms:
        name = normalize_file_name(each.name)
        if is_table_file(name):
            program.tables_by_name[name] = read_table_rows(each)
        else:
            program.called_programs[name] = read_program(each)
    return program


_DIN_ISO = re.compile(r"\s*(?:%\s*\S+\s+G7[01]\b|N\s*[0-9]+\s*(?:G[0-9]|[%T]|M[0-9]))", re.IGNORECASE)


def _din_iso(source: ProgramSource) -> KlartextLine | None:
    """Return the first line with an error if the program is in DIN/ISO format, or None otherwise.

    The error is reported only once.
    """
    first = next(((at, text) for at, text in enumerate(source.lines, start=1) if text.strip()), None)
    if first is None or _DIN_ISO.match(first[1]) is None:
        return None
    text = "This program is written in DIN/ISO."
    hint = "Convert the program to Klartext on its original control, or post-process it again."
    problem = make_klartext_error(first[0], 1, NOT_SUPPORTED, text, hint).diagnostic
    return KlartextLine(first[0], error=problem)


def _lines(source: ProgramSource) -> list[KlartextLine]:
    """Return one entry per program line.

    A block with continuation lines (~) is in the entry of its first line.
    """
    texts = source.lines
    found: list[KlartextLine] = []
    while len(found) < len(texts):
        first = len(found)
        last = first
        while last + 1 < len(texts) and texts[last].rstrip().endswith(CONTINUATION_SIGN):
            last += 1
        if last == first:
            found.append(parse_line(first + 1, texts[first]))
        else:
            found += _join_lines(texts[first : last + 1], first + 1)
    return found


def _join_lines(texts: Sequence[str], number: int) -> Iterator[KlartextLine]:
    """Yield one entry per line of a block; the first entry contains the whole block and any error.

    The error has the number of the line on which it occurs. The other entries are empty.
    """
    pieces = [text[: find_comment_start(text)].rstrip().removesuffix(CONTINUATION_SIGN) for text in texts]
    if not pieces[0].strip().strip("/").strip().strip("0123456789"):
        pieces[1:] = [""] * (len(pieces) - 1)  # The control splits long comments into continued lines.
    line = parse_line(number, " ".join(pieces))
    if (problem := line.error) is not None:
        row, column = 0, problem.column
        while row + 1 < len(pieces) and column > len(pieces[row]) + 1:
            column -= len(pieces[row]) + 1
            row += 1
        line = line._replace(error=replace(problem, line=number + row, column=column))
    yield line
    yield from (KlartextLine(number + below) for below in range(1, len(pieces)))


def _corners(program: Program) -> BlankCorners | None:
    """Return the minimum and maximum corners of the blank, or None if they are invalid.

    They are valid if all coordinates are numbers and the corners enclose a volume.
    """
    scale = MM_PER_INCH if program.is_inch else 1.0
    found: dict[int, Vector] = {}
    for line in program.lines:
        if isinstance(line.node, CylinderBlank):
            return _cylinder_corners(line.node, scale)
        if isinstance(line.node, BlankCorner) and all(
            word.value.parameter_number is None for word in line.node.axis_words
        ):
            low = dict(zip("XYZ", found.get(1, (0.0, 0.0, 0.0)), strict=True))
            at = {
                word.axis: word.value.number * scale + (low[word.axis] if word.is_incremental else 0.0)
                for word in line.node.axis_words
            }
            found[line.node.corner_number] = (at["X"], at["Y"], at["Z"])
    if len(found) < 2 or any(low >= high for low, high in zip(found[1], found[2], strict=True)):
        return None
    return found[1], found[2]


def _cylinder_corners(blank: CylinderBlank, scale: float) -> BlankCorners | None:
    """Return the corners of the box around a cylindrical blank, or None if a dimension is not a number."""
    dimensions = (blank.radius, blank.length, blank.height_above_datum)
    if (
        any(each.parameter_number is not None for each in dimensions)
        or blank.radius.number <= 0.0
        or blank.length.number <= 0.0
    ):
        return None
    radius, length, above = (each.number * scale for each in dimensions)
    ends = dict.fromkeys("XYZ", (-radius, radius)) | {blank.tool_axis: (above - length, above)}
    low, high = zip(*(ends[axis] for axis in "XYZ"), strict=True)
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _frame(program: Program) -> Iterator[Diagnostic]:
    """Yield the errors and warnings about BEGIN PGM and END PGM.

    BEGIN PGM must be the first block, and END PGM must be the last block. Their units and names must match.
    """
    with_blocks = [index for index, line in enumerate(program.lines) if line.node or line.error]
    first = program.lines[with_blocks[0]] if with_blocks else None
    if first is None or not isinstance(first.node, BeginBlock):
        if first is None or first.error is None:
            hint = "Start the program with BEGIN PGM, the program name and the unit."
            yield _wrong(first.line_number if first else 1, "BEGIN PGM is missing.", hint)
        return
    program.is_inch = first.node.is_inch
    ends = ((index, node) for index in with_blocks if isinstance(node := program.lines[index].node, EndBlock))
    program.end_index, last = next(ends, (program.end_index, None))
    if last is None:
        yield _wrong(with_blocks[-1] + 1, "END PGM is missing.", "Check that the file is complete.")
        return
    for index in with_blocks[1:]:
        if isinstance(program.lines[index].node, BeginBlock):
            yield _wrong(index + 1, "BEGIN PGM appears twice.", "Put only one program in a file.")
    surplus = next((index for index in with_blocks if index > program.end_index), None)
    if surplus is not None:
        yield _wrong(surplus + 1, "This block is after END PGM.", "Move this block to a line before END PGM.")
    if first.node.is_inch != last.is_inch:
        text = "BEGIN PGM and END PGM specify different units."
        yield _wrong(program.end_index + 1, text, "Write the same unit in BEGIN PGM and END PGM.")
    elif last.name and first.node.name.upper() != last.name.upper():
        text = Message(
            "BEGIN PGM names {node}, but END PGM names {last}.", node=first.node.name, last=last.name
        )
        hint = "Check that the file is complete."
        yield Diagnostic(program.end_index + 1, 1, Severity.WARNING, "program-name", text, hint)


def _wrong(line: int, text: str, hint: str) -> Diagnostic:
    return make_syntax_error(line, 1, text, hint).diagnostic


def _labels(program: Program) -> Iterator[Diagnostic]:
    for index, line in enumerate(program.lines[: program.end_index]):
        node = line.node
        if not isinstance(node, Label) or node.name == 0:
            continue
        if program.labels.setdefault(node.name, index) != index:
            text = Message(
                "LBL {node} is also on line {labels}.",
                node=format_name(node.name),
                labels=program.labels[node.name] + 1,
            )
            yield make_klartext_error(
                line.line_number, node.column, LABEL_REPEATED, text, "Use a different number."
            ).diagnostic


def _calls(program: Program) -> Iterator[Diagnostic]:
    """Yield an error for each call of a label that is missing or whose subprogram has no end."""
    for line in program.lines[: program.end_index]:
        node = line.node
        if not isinstance(node, (LabelCall, ConditionalJump)):
            continue
        name, at = format_name(node.name), program.labels.get(node.name)
        if at is None:
            text, hint = (
                Message("LBL {name} is not in the program.", name=name),
                ("Correct the label number, or add the label."),
            )
            yield make_klartext_error(line.line_number, node.column, LABEL_NOT_FOUND, text, hint).diagnostic
        elif (
            isinstance(node, LabelCall)
            and node.repeat_count is None
            and program.find_subprogram_end(at) is None
        ):
            text = Message("The subprogram LBL {name} has no LBL 0.", name=name)
            yield make_syntax_error(
                line.line_number, node.column, text, "End the subprogram with LBL 0."
            ).diagnostic


MAX_CALL_DEPTH = 19


@dataclass(slots=True)
class _Level(FlowFrame[Program]):
    is_subprogram: bool = False  # a subprogram of the active program, which LBL 0 ends


class Flow(ControlFlow[_Level]):
    """Execution position in a program, including its label calls, repeats and called programs."""

    def __init__(self, program: Program) -> None:
        super().__init__(_Level(program, 0, program.end_index))
        self._main = program
        self.is_ended_by_code = False

    @property
    def program(self) -> Program:
        """Return the program to which the most recently read line belongs."""
        return self.active_frame.routine

    @property
    def _program_frame_index(self) -> int:
        """Return the index of the frame in which the active program started."""
        return max(at for at, each in enumerate(self.frames) if not each.is_subprogram)

    def read_next_line(self) -> KlartextLine | None:
        """Return the next line, or None at the END PGM of the main program."""
        while self.next_index >= self.end_index:
            begun = self._program_frame_index
            if not begun:
                return None
            del self.frames[begun:]
            self._resume_frame()
        self.next_index += 1
        return self.active_frame.routine.lines[self.next_index - 1]

    def make_subprogram_flow(self, label: int | str) -> Flow | None:
        """Return a flow through one subprogram of the active program, or None if it does not exist."""
        program = self.program
        at = program.labels.get(label)
        if at is None or program.find_subprogram_end(at) is None:
            return None
        own = Flow(program)
        own.next_index = program.end_index
        own.enter_subprogram(_Level(program, at + 1, program.end_index, is_subprogram=True))
        return own

    def find_program(self, name: str) -> Program | None:
        """Return a program in the folder of the main program, or None if it does not exist."""
        return self._main.called_programs.get(normalize_file_name(name))

    def make_program_flow(self, name: str) -> Flow | None:
        """Return a flow through a program in the folder of the main program, or None if it does not exist."""
        program = self.find_program(name)
        return None if program is None else Flow(program)

    def peek_next_node(self) -> Node | None:
        """Return the next block in the program text without following jumps, or None at the end."""
        lines = self.program.lines
        rest = (lines[at].node for at in range(self.next_index, self.end_index))
        return next((node for node in rest if node is not None and not isinstance(node, HeadingLine)), None)

    def end_program(self) -> None:
        """End the program at M2 or M30."""
        super().end_program()
        self.is_ended_by_code = True

    def call_label(self, line: int, node: LabelCall, repeat_count: int) -> None:
        """Execute CALL LBL: call the subprogram, or repeat its section ``repeat_count`` times.

        Raises ProgramError if calls are nested too deeply.
        """
        target = self.active_frame.routine.labels.get(node.name)
        if target is None:
            return  # already reported when the program was read
        if node.repeat_count is not None:
            self._repeat(line, target, repeat_count)
            return
        if len(self.frames) - self._program_frame_index > MAX_CALL_DEPTH:
            text = Message(
                "Calls are nested more than {deepest_call} levels deep at LBL {node}.",
                deepest_call=MAX_CALL_DEPTH,
                node=format_name(node.name),
            )
            hint = "A subprogram must not call itself."
            raise make_klartext_error(line, node.column, EXCESSIVE_NESTING, text, hint)
        self.enter_subprogram(
            replace(self.active_frame, next_index=target + 1, remaining_repeats={}, is_subprogram=True)
        )

    def execute_label(self, node: Label) -> None:
        """Execute LBL.

        LBL 0 ends the active subprogram. Other labels only mark a position.
        """
        if node.name == 0 and self.active_frame.is_subprogram:
            self.return_to_caller()

    def jump_to_label(self, node: ConditionalJump) -> None:
        """Continue with the line after the label to which a jump refers."""
        target = self.active_frame.routine.labels.get(node.name)
        if target is not None:  # otherwise, the error was already reported when the program was read
            self.next_index = target + 1

    @property
    def has_system_reads(self) -> bool:
        """Return whether the program or a called program contains FN 18."""
        programs = (self._main, *self._main.called_programs.values())
        return any(isinstance(line.node, SystemRead) for each in programs for line in each.lines)

    def read_table(self, name: str) -> dict[int, TableRow] | None:
        """Return the rows of a table in the folder of the program, or None if the table does not exist."""
        return self._main.tables_by_name.get(normalize_file_name(name))

    def call_program(self, name: str, line: int) -> Program | None:
        """Call another program and return it, or return None if the program does not exist.

        Raises ProgramError if calls are nested too deeply.
        """
        called = self.find_program(name)
        if called is None:
            return None
        if sum(not each.is_subprogram for each in self.frames) > MAX_CALL_DEPTH:
            text = Message(
                "Program calls are nested more than {deepest_call} levels deep at {name}.",
                deepest_call=MAX_CALL_DEPTH,
                name=name,
            )
            raise make_klartext_error(line, 1, EXCESSIVE_NESTING, text, "A program must not call itself.")
        self.enter_subprogram(
            _Level(
                called,
                0,
                called.end_index,
                file_name=called.source.name,
                call_line=self.get_displayed_line(line),
            )
        )
        return called

    def _repeat(self, line: int, target: int, times: int) -> None:
        left = self.active_frame.remaining_repeats
        still = left.get(line, times)
        if still > 0:
            left[line] = still - 1
            self.next_index = target + 1
        else:
            left.pop(line, None)
