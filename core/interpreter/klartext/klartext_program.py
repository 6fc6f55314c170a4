"""Reading of a Klartext program: its lines, labels, unit and syntax errors.

A block of MDI is read separately, and blocks that need other blocks are errors.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.consequent_faults import told_once
from core.interpreter.shared.control_flow import ControlFlow, Frame
from core.interpreter.shared.diagnostic_log import MOST_OF_A_KIND
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.shared.working_plane import Corners
from core.language.diagnostics import Diagnostic, Severity, refusal
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import read_line
from core.language.klartext.canonical_text import name_text, written
from core.language.klartext.klartext_faults import LABEL, LABEL_TWICE, NESTING, NOT_SUPPORTED, fault, syntax
from core.language.klartext.klartext_line import CONTINUED
from core.language.klartext.klartext_nodes import (
    Begin,
    BlankForm,
    Call,
    End,
    Heading,
    Jump,
    KlartextLine,
    Label,
    Node,
    RoundBlank,
    SystemRead,
)
from core.language.klartext.named_files import Row, file_name, is_table, table_rows
from core.language.line_reading import comment_start
from core.language.source import Source
from core.message import Message

Name = int | str


@dataclass(slots=True)
class Program:
    """A program that was read. ``lines`` has one entry per line.

    ``labels`` maps each label to the index of its line, and ``end`` is the index of END PGM.
    """

    source: Source
    lines: list[KlartextLine]
    labels: dict[Name, int] = field(default_factory=dict)
    end: int = 0
    inch: bool = False
    problems: list[Diagnostic] = field(default_factory=list)
    _texts: dict[int, str] = field(default_factory=dict)
    corners: Corners | None = None  # corners of BLK FORM, mm
    called: dict[str, Program] = field(default_factory=dict)  # called programs by file name in capitals
    # datum and point tables by file name in capitals
    tables: dict[str, dict[int, Row]] = field(default_factory=dict)

    @property
    def blocks(self) -> int:
        """Number of lines that contain more than a comment."""
        return sum(1 for line in self.lines if line.node is not None or line.error is not None)

    def text(self, line: KlartextLine) -> str:
        """Return the block of a line for display, formatted only once."""
        text = self._texts.get(line.number)
        if text is None:
            text = self._texts[line.number] = written(line)
        return text

    def subprogram_end(self, label: int) -> int | None:
        """Return the index of the LBL 0 that ends the subprogram with its label at this index, or None."""
        for index in range(label + 1, self.end):
            node = self.lines[index].node
            if isinstance(node, Label) and node.name == 0:
                return index
        return None


def read_program(source: Source) -> Program:
    """Read all lines and called programs. Never raises; errors are in ``problems``."""
    if (other := _din_iso(source)) is not None:
        return Program(source, [other], end=1, problems=[other.error] if other.error else [])
    lines = _lines(source)
    told_once(lines)
    program = Program(source, lines, end=len(lines))
    found = [line.error for line in lines if line.error is not None]
    for look in (_frame, _labels, _calls):
        found += look(program)
    program.problems = sorted(found, key=lambda each: (each.line, each.column))[: 2 * MOST_OF_A_KIND]
    program.corners = _corners(program)
    for each in source.subprograms:
        name = file_name(each.name)
        if is_table(name):
            program.tables[name] = table_rows(each)
        else:
            program.called[name] = read_program(each)
    return program


_DIN_ISO = re.compile(r"\s*(?:%\s*\S+\s+G7[01]\b|N\s*[0-9]+\s*(?:G[0-9]|[%T]|M[0-9]))", re.IGNORECASE)


def _din_iso(source: Source) -> KlartextLine | None:
    """Return the first line with an error if the program is in DIN/ISO; otherwise None.

    The error is reported only once.
    """
    first = next(((at, text) for at, text in enumerate(source.lines, start=1) if text.strip()), None)
    if first is None or _DIN_ISO.match(first[1]) is None:
        return None
    text = "This program is written in DIN/ISO."
    hint = "Convert the program to Klartext on its original control, or post-process it again."
    problem = fault(first[0], 1, NOT_SUPPORTED, text, hint).diagnostic
    return KlartextLine(first[0], error=problem)


def _lines(source: Source) -> list[KlartextLine]:
    """Return one entry per line; a block with continuation lines (~) is in its first line."""
    texts = source.lines
    found: list[KlartextLine] = []
    while len(found) < len(texts):
        first = len(found)
        last = first
        while last + 1 < len(texts) and texts[last].rstrip().endswith(CONTINUED):
            last += 1
        if last == first:
            found.append(read_line(first + 1, texts[first]))
        else:
            found += _joined(texts[first : last + 1], first + 1)
    return found


def _joined(texts: Sequence[str], number: int) -> Iterator[KlartextLine]:
    """Yield the lines of one block, with an error at its location."""
    pieces = [text[: comment_start(text)].rstrip().removesuffix(CONTINUED) for text in texts]
    if not pieces[0].strip().strip("/").strip().strip("0123456789"):
        pieces[1:] = [""] * (len(pieces) - 1)  # The control splits long comments into continued lines.
    line = read_line(number, " ".join(pieces))
    if (problem := line.error) is not None:
        row, column = 0, problem.column
        while row + 1 < len(pieces) and column > len(pieces[row]) + 1:
            column -= len(pieces[row]) + 1
            row += 1
        line = line._replace(error=replace(problem, line=number + row, column=column))
    yield line
    yield from (KlartextLine(number + below) for below in range(1, len(pieces)))


def _corners(program: Program) -> Corners | None:
    """Return the minimum and maximum corner if both are numbers and enclose a block; otherwise None."""
    scale = MM_PER_INCH if program.inch else 1.0
    found: dict[int, Vector] = {}
    for line in program.lines:
        if isinstance(line.node, RoundBlank):
            return _around(line.node, scale)
        if isinstance(line.node, BlankForm) and all(word.value.q is None for word in line.node.corner):
            low = dict(zip("XYZ", found.get(1, (0.0, 0.0, 0.0)), strict=True))
            at = {
                word.axis: word.value.number * scale + (low[word.axis] if word.incremental else 0.0)
                for word in line.node.corner
            }
            found[line.node.part] = (at["X"], at["Y"], at["Z"])
    if len(found) < 2 or any(low >= high for low, high in zip(found[1], found[2], strict=True)):
        return None
    return found[1], found[2]


def _around(blank: RoundBlank, scale: float) -> Corners | None:
    """Return the corners of the block around a cylinder; None if its dimensions are not numbers."""
    told = (blank.radius, blank.length, blank.above)
    if any(each.q is not None for each in told) or blank.radius.number <= 0.0 or blank.length.number <= 0.0:
        return None
    radius, length, above = (each.number * scale for each in told)
    ends = dict.fromkeys("XYZ", (-radius, radius)) | {blank.tool_axis: (above - length, above)}
    low, high = zip(*(ends[axis] for axis in "XYZ"), strict=True)
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _frame(program: Program) -> Iterator[Diagnostic]:
    """Yield the errors of BEGIN PGM and END PGM, which must be first and last and match."""
    with_blocks = [index for index, line in enumerate(program.lines) if line.node or line.error]
    first = program.lines[with_blocks[0]] if with_blocks else None
    if first is None or not isinstance(first.node, Begin):
        if first is None or first.error is None:
            hint = "Start the program with BEGIN PGM, the program name and the unit."
            yield _wrong(first.number if first else 1, "BEGIN PGM is missing.", hint)
        return
    program.inch = first.node.inch
    ends = ((index, node) for index in with_blocks if isinstance(node := program.lines[index].node, End))
    program.end, last = next(ends, (program.end, None))
    if last is None:
        yield _wrong(with_blocks[-1] + 1, "END PGM is missing.", "Check that the file is complete.")
        return
    for index in with_blocks[1:]:
        if isinstance(program.lines[index].node, Begin):
            yield _wrong(index + 1, "BEGIN PGM appears twice.", "Put only one program in a file.")
    behind = next((index for index in with_blocks if index > program.end), None)
    if behind is not None:
        yield _wrong(behind + 1, "This block is after END PGM.", "Move this block to a line before END PGM.")
    if first.node.inch != last.inch:
        text = "BEGIN PGM and END PGM specify different units."
        yield _wrong(program.end + 1, text, "Write the same unit in BEGIN PGM and END PGM.")
    elif last.name and first.node.name.upper() != last.name.upper():
        text = Message(
            "BEGIN PGM names {node}, but END PGM names {last}.", node=first.node.name, last=last.name
        )
        hint = "Check that the file is complete."
        yield Diagnostic(program.end + 1, 1, Severity.WARNING, "program-name", text, hint)


def _wrong(line: int, text: str, hint: str) -> Diagnostic:
    return syntax(line, 1, text, hint).diagnostic


def _labels(program: Program) -> Iterator[Diagnostic]:
    for index, line in enumerate(program.lines[: program.end]):
        node = line.node
        if not isinstance(node, Label) or node.name == 0:
            continue
        if program.labels.setdefault(node.name, index) != index:
            text = Message(
                "LBL {node} is also on line {labels}.",
                node=name_text(node.name),
                labels=program.labels[node.name] + 1,
            )
            yield fault(line.number, node.column, LABEL_TWICE, text, "Use a different number.").diagnostic


def _calls(program: Program) -> Iterator[Diagnostic]:
    """Yield an error for each call of a missing label or of a subprogram without an end."""
    for line in program.lines[: program.end]:
        node = line.node
        if not isinstance(node, (Call, Jump)):
            continue
        name, at = name_text(node.name), program.labels.get(node.name)
        if at is None:
            text, hint = (
                Message("LBL {name} is not in the program.", name=name),
                ("Correct the label number, or add the label."),
            )
            yield fault(line.number, node.column, LABEL, text, hint).diagnostic
        elif isinstance(node, Call) and node.repeat is None and program.subprogram_end(at) is None:
            text = Message("The subprogram LBL {name} has no LBL 0.", name=name)
            yield syntax(line.number, node.column, text, "End the subprogram with LBL 0.").diagnostic


DEEPEST_CALL = 19


@dataclass(slots=True)
class _Level(Frame[Program]):
    section: bool = False  # a subprogram of the active program, which LBL 0 ends


class Flow(ControlFlow[_Level]):
    """Position in a program: labels, jumps, repeats and called programs."""

    def __init__(self, program: Program) -> None:
        super().__init__(_Level(program, 0, program.end))
        self._main = program
        self.ended_by_code = False

    @property
    def program(self) -> Program:
        """The program of the last line that was read."""
        return self.here.routine

    @property
    def _begun(self) -> int:
        """Index of the frame in which the active program started."""
        return max(at for at, each in enumerate(self.frames) if not each.section)

    def next(self) -> KlartextLine | None:
        """Return the next line, or None at the END PGM of the main program."""
        while self.at >= self.end:
            begun = self._begun
            if not begun:
                return None
            del self.frames[begun:]
            self._go_on()
        self.at += 1
        return self.here.routine.lines[self.at - 1]

    def through_subprogram(self, label: int | str) -> Flow | None:
        """Return a flow through one subprogram of the active program; None if it does not exist."""
        program = self.program
        at = program.labels.get(label)
        if at is None or program.subprogram_end(at) is None:
            return None
        own = Flow(program)
        own.at = program.end
        own.enter(_Level(program, at + 1, program.end, section=True))
        return own

    def beside(self, name: str) -> Program | None:
        """Return a program in the folder of the main program, or None."""
        return self._main.called.get(file_name(name))

    def through_program(self, name: str) -> Flow | None:
        """Return a flow through a program in the folder of the main program; None if it does not exist."""
        program = self.beside(name)
        return None if program is None else Flow(program)

    def next_node(self) -> Node | None:
        """Return the block of the next line that has one, without a jump; or None."""
        lines = self.program.lines
        rest = (lines[at].node for at in range(self.at, self.end))
        return next((node for node in rest if node is not None and not isinstance(node, Heading)), None)

    def end_all(self) -> None:
        """End the program with M2 or M30."""
        super().end_all()
        self.ended_by_code = True

    def call(self, line: int, node: Call, times: int) -> None:
        """Execute CALL LBL, or ``times`` repeats of its section. Raises ProgramError if nested too deeply."""
        target = self.here.routine.labels.get(node.name)
        if target is None:
            return  # already reported when the program was read
        if node.repeat is not None:
            self._repeat(line, target, times)
            return
        if len(self.frames) - self._begun > DEEPEST_CALL:
            text = Message(
                "Calls are nested more than {deepest_call} levels deep at LBL {node}.",
                deepest_call=DEEPEST_CALL,
                node=name_text(node.name),
            )
            hint = "A subprogram must not call itself."
            raise fault(line, node.column, NESTING, text, hint)
        self.enter(replace(self.here, at=target + 1, left={}, section=True))

    def label(self, node: Label) -> None:
        """Execute LBL: LBL 0 ends the active subprogram, and other labels only mark a position."""
        if node.name == 0 and self.here.section:
            self.leave()

    def jump(self, node: Jump) -> None:
        """Continue after a label."""
        target = self.here.routine.labels.get(node.name)
        if target is not None:  # otherwise, the error was already reported when the program was read
            self.at = target + 1

    @property
    def reads_the_control(self) -> bool:
        """Whether the program or a called program has FN 18."""
        programs = (self._main, *self._main.called.values())
        return any(isinstance(line.node, SystemRead) for each in programs for line in each.lines)

    def table(self, name: str) -> dict[int, Row] | None:
        """Return the rows of a table in the folder of the program; None if it does not exist."""
        return self._main.tables.get(file_name(name))

    def call_program(self, name: str, line: int) -> Program | None:
        """Enter another program; return None if it does not exist.

        Raises ProgramError if calls are nested too deeply.
        """
        called = self.beside(name)
        if called is None:
            return None
        if sum(not each.section for each in self.frames) > DEEPEST_CALL:
            text = Message(
                "Program calls are nested more than {deepest_call} levels deep at {name}.",
                deepest_call=DEEPEST_CALL,
                name=name,
            )
            raise fault(line, 1, NESTING, text, "A program must not call itself.")
        self.enter(_Level(called, 0, called.end, file=called.source.name, place=self.shown_line(line)))
        return called

    def _repeat(self, line: int, target: int, times: int) -> None:
        left = self.here.left
        still = left.get(line, times)
        if still > 0:
            left[line] = still - 1
            self.at = target + 1
        else:
            left.pop(line, None)


_HINT = "Use this command in a program."
_NEEDS_OTHERS: tuple[tuple[type, str], ...] = (
    (nodes.Begin, "BEGIN PGM begins a program"),
    (nodes.End, "END PGM ends a program and cannot be used in MDI"),
    (nodes.BlankForm, "BLK FORM defines the blank of a program and cannot be used in MDI"),
    (nodes.Label, "LBL marks a position in a program and cannot be used in MDI"),
    (nodes.Call, "CALL LBL jumps to another block and cannot be used in MDI"),
    (nodes.Jump, "A jump goes to another block and cannot be used in MDI"),
    (nodes.ProgramCall, "CALL PGM calls another program and cannot be used in MDI"),
    (nodes.Corner, "RND and CHF are allowed only between two blocks of a contour"),
)


def read_single(source: Source, *, inch: bool) -> Program:
    """Return a block of MDI as a program of one block. Never raises.

    Blocks that need other blocks are reported as errors.
    """
    line = read_line(1, source.lines[0] if source.lines else "")
    problem = line.error or _alone(line)
    return Program(source, [line], end=1, inch=inch, problems=[problem] if problem is not None else [])


def _alone(line: nodes.KlartextLine) -> Diagnostic | None:
    """Return the error for a block that needs other blocks, or None."""
    node = line.node
    column = getattr(node, "column", 1) or 1
    if line.skip:
        return _refuse(1, "/ skips a program block and has no meaning in MDI")
    for kind, why in _NEEDS_OTHERS:
        if isinstance(node, kind):
            return _refuse(column, why)
    if isinstance(node, nodes.Move):
        if node.form.startswith(("APPR", "DEP")):
            return _refuse(
                column,
                Message(
                    "{form} approaches or departs from a contour and cannot be used in MDI", form=node.form
                ),
            )
        if node.compensation in {"L", "R"}:
            return _refuse(
                column,
                Message(
                    "R{compensation} needs a contour of more than one block and cannot be used in MDI",
                    compensation=node.compensation,
                ),
            )
    if isinstance(node, nodes.CycleLine) and node.number == 12:
        return _refuse(column, "Cycle 12 selects another program and cannot be used in MDI")
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return refusal(1, column, "not-alone-mdi", Message("{what}.", what=what), _HINT)
