"""A Klartext program read once: its lines, labels and unit, and what is wrong with it as text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from core.geometry.rotation_frames import Vector
from core.interpreter.diagnostic_log import MOST_OF_A_KIND
from core.interpreter.units import MM_PER_INCH
from core.interpreter.working_plane import Corners
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext import read_line
from core.language.klartext.canonical_text import name_text, written
from core.language.klartext.klartext_faults import LABEL, LABEL_TWICE, NESTING, fault, syntax
from core.language.klartext.klartext_nodes import Begin, BlankForm, Call, End, KlartextLine, Label
from core.language.source import Source

Name = int | str


@dataclass(slots=True)
class Program:
    """``lines`` has one entry a line; ``labels`` the index of each label's line; ``end`` that of END PGM."""

    source: Source
    lines: list[KlartextLine]
    labels: dict[Name, int] = field(default_factory=dict)
    end: int = 0
    inch: bool = False
    problems: list[Diagnostic] = field(default_factory=list)
    _texts: dict[int, str] = field(default_factory=dict)
    corners: Corners | None = None  # of BLK FORM, mm

    @property
    def blocks(self) -> int:
        """Lines that hold more than a comment."""
        return sum(1 for line in self.lines if line.node is not None or line.error is not None)

    def text(self, line: KlartextLine) -> str:
        """The block of a line as it is shown, written once however often it is executed."""
        text = self._texts.get(line.number)
        if text is None:
            text = self._texts[line.number] = written(line)
        return text

    def subprogram_end(self, label: int) -> int | None:
        """Index of the LBL 0 that ends the subprogram whose label stands at this index."""
        for index in range(label + 1, self.end):
            node = self.lines[index].node
            if isinstance(node, Label) and node.name == 0:
                return index
        return None


def read_program(source: Source) -> Program:
    """Read every line and look the structure over. Raises nothing: see ``problems``."""
    lines = [read_line(number, text) for number, text in enumerate(source.lines, start=1)]
    program = Program(source, lines, end=len(lines))
    found = [line.error for line in lines if line.error is not None]
    for look in (_frame, _labels, _calls):
        found += look(program)
    program.problems = sorted(found, key=lambda each: (each.line, each.column))[: 2 * MOST_OF_A_KIND]
    program.corners = _corners(program)
    return program


def _corners(program: Program) -> Corners | None:
    """Least and greatest corner, where both are given in numbers and hold a block between them."""
    scale = MM_PER_INCH if program.inch else 1.0
    found: dict[int, Vector] = {}
    for line in program.lines:
        if isinstance(line.node, BlankForm) and all(word.value.q is None for word in line.node.corner):
            at = {word.axis: word.value.number * scale for word in line.node.corner}
            found[line.node.part] = (at["X"], at["Y"], at["Z"])
    if len(found) < 2 or any(low >= high for low, high in zip(found[1], found[2], strict=True)):
        return None
    return found[1], found[2]


def _frame(program: Program) -> Iterator[Diagnostic]:
    """BEGIN PGM first and END PGM last, of the same program."""
    with_blocks = [index for index, line in enumerate(program.lines) if line.node or line.error]
    first = program.lines[with_blocks[0]] if with_blocks else None
    if first is None or not isinstance(first.node, Begin):
        if first is None or first.error is None:
            hint = "The first block names program and unit."
            yield _wrong(first.number if first else 1, "BEGIN PGM is missing.", hint)
        return
    program.inch = first.node.inch
    ends = ((index, node) for index in with_blocks if isinstance(node := program.lines[index].node, End))
    program.end, last = next(ends, (program.end, None))
    if last is None:
        yield _wrong(with_blocks[-1] + 1, "END PGM is missing.", "Look whether the file is whole.")
        return
    for index in with_blocks[1:]:
        if isinstance(program.lines[index].node, Begin):
            yield _wrong(index + 1, "BEGIN PGM stands twice.", "A file holds one program.")
    behind = next((index for index in with_blocks if index > program.end), None)
    if behind is not None:
        yield _wrong(behind + 1, "This block stands behind END PGM.", "Move it before END PGM.")
    if first.node.inch != last.inch:
        text = "BEGIN PGM and END PGM name different units."
        yield _wrong(program.end + 1, text, "Write the unit of the program in both.")
    elif first.node.name.upper() != last.name.upper():
        text = f"The program begins as {first.node.name} and ends as {last.name}."
        hint = "Look whether the file is whole."
        yield Diagnostic(program.end + 1, 1, Severity.WARNING, "program-name", text, hint)


def _wrong(line: int, text: str, hint: str) -> Diagnostic:
    return syntax(line, 1, text, hint).diagnostic


def _labels(program: Program) -> Iterator[Diagnostic]:
    for index, line in enumerate(program.lines[: program.end]):
        node = line.node
        if not isinstance(node, Label) or node.name == 0:
            continue
        if program.labels.setdefault(node.name, index) != index:
            text = f"LBL {name_text(node.name)} stands on line {program.labels[node.name] + 1} too."
            yield fault(line.number, node.column, LABEL_TWICE, text, "Give it another number.").diagnostic


def _calls(program: Program) -> Iterator[Diagnostic]:
    """Calls of labels that are not there, and of subprograms without an end."""
    for line in program.lines[: program.end]:
        node = line.node
        if not isinstance(node, Call):
            continue
        name, at = name_text(node.name), program.labels.get(node.name)
        if at is None:
            text, hint = f"LBL {name} is nowhere in the program.", "Correct the number, or write the label."
            yield fault(line.number, node.column, LABEL, text, hint).diagnostic
        elif node.repeat is None and program.subprogram_end(at) is None:
            text = f"The subprogram LBL {name} has no LBL 0."
            yield syntax(line.number, node.column, text, "Write LBL 0 behind it.").diagnostic


DEEPEST_CALL = 19


@dataclass(slots=True)
class _Level:
    """One subprogram under way: where to go on, and the repeats still to do by the line of their call."""

    back: int
    left: dict[int, int] = field(default_factory=dict)


class Flow:
    """``at`` is the index of the line to execute next, ``end`` that of END PGM."""

    def __init__(self, program: Program) -> None:
        self.at = 0
        self.end = program.end
        self._labels = program.labels
        self._levels = [_Level(back=program.end)]

    def call(self, line: int, node: Call) -> None:
        """CALL LBL. Raises ProgramError for calls nested too deep."""
        target = self._labels.get(node.name)
        if target is None:
            return  # told when the program was read
        if node.repeat is not None:
            self._repeat(line, target, node.repeat)
            return
        if len(self._levels) > DEEPEST_CALL:
            text = f"Calls are nested more than {DEEPEST_CALL} deep at LBL {name_text(node.name)}."
            hint = "A subprogram must not call itself."
            raise fault(line, node.column, NESTING, text, hint)
        self._levels.append(_Level(back=self.at))
        self.at = target + 1

    def label(self, node: Label) -> None:
        """LBL: 0 ends the subprogram under way, others mark a place."""
        if node.name == 0 and len(self._levels) > 1:
            self.at = self._levels.pop().back

    def _repeat(self, line: int, target: int, times: int) -> None:
        left = self._levels[-1].left
        still = left.get(line, times)
        if still > 0:
            left[line] = still - 1
            self.at = target + 1
        else:
            left.pop(line, None)
