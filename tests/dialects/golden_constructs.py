"""Goldens of the code books: each entry's small program, what comes of it, and where its refusal is told.

``tests/programs/constructs/LANGUAGE/CHAPTER.golden``, a section for each entry of the book::

    == RND
    L X+20 Y+0 R0 F400
    RND R3
    L X+20 Y+20
    --
    1 feed 17 0 50 F 400
    3 arc 20 3 50 way 4.712389 F 400
    3 feed 20 20 50 F 400
    refused 3 1 Rounding not possible

The program stands between the book's head and tail, or on its own where the entry is ``whole``; its lines
count from 1. ``rows`` are those of ``golden_rows.py`` for its lines alone; ``...`` stands for any number
of them, ``extent X X Y Y Z Z`` for the least and the greatest ends of all moves at feed (``extent X X Z
Z`` on a lathe), ``way MM`` for the length of them all, ``blank X X Y Y Z Z`` for the corners of BLK FORM;
``*`` in a row is any figure. ``warning`` and ``note LINE CODE`` are all that is told beside. ``refused
LINE COLUMN CODE`` is the first error of the lines that the book has as the entry's refusal, with ``on
MACHINE`` behind it where it is another one that refuses. Lines that start_pass with ``#`` say how a figure
was reckoned; ``machine NAME`` asks for another shipped machine, ``axes`` for the rotary axes in the rows,
``positions`` for those of the machine.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import SharedProgram, get_code_book
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.language.code_book import CodeBookEntry
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource
from core.tool_edges import make_edge_row_number
from tests.dialects.golden_rows import Row, row, same

FOLDER = Path(__file__).parents[1] / "programs" / "constructs"


@dataclass(frozen=True)
class Ground:
    """What the programs of a language run on: the shipped machine and the tools in its table."""

    machine: str
    name: str
    tools: dict[int, ToolOffset]
    last: str = ""  # what ends every program


GROUNDS = {
    Dialect.KLARTEXT: Ground("ac-table-mill", "EXAMPLE.H", {1: ToolOffset()}, "END PGM EXAMPLE MM\n"),
    Dialect.SINUMERIK: Ground(
        "sinumerik-modulo",
        "EXAMPLE.MPF",
        {1: ToolOffset(name="ROUGHER", quadrant=3), make_edge_row_number(1, 2): ToolOffset(z=-3.0)},
    ),
}


@dataclass
class Golden:
    """One section: the entry's head, its program, and what the section says of it."""

    head: str
    program: str
    machine: str = ""
    axes: bool = False
    positions: bool = False
    rows: list[list[str]] = field(default_factory=list)
    sums: dict[str, list[float]] = field(default_factory=dict)
    told: list[str] = field(default_factory=list)
    refused: str = ""
    refusing: str = ""

    def tell(self, text: str) -> None:
        """Take a line behind ``--``."""
        words = text.split()
        if words[0] == "machine":
            self.machine = words[1]
        elif words == ["axes"]:
            self.axes = True
        elif words == ["positions"]:
            self.positions = True
        elif words[0] == "refused":
            self.refused, _, machine = " ".join(words[1:]).partition(" on ")
            self.refusing = machine or self.machine
        elif words[0] in ("warning", "note"):
            self.told.append(" ".join(words))
        elif words[0] in ("extent", "way", "blank"):
            self.sums[words[0]] = [float(each) for each in words[1:]]
        elif words[0] == "..." or words[0].isdigit():
            self.rows.append(words)
        else:
            raise ValueError(f"{self.head}: a line that says nothing: {text}")


@cache
def goldens(dialect: Dialect) -> dict[str, Golden]:
    """All sections of a language by the head of their entry; ValueError for one that stands there twice."""
    found: dict[str, Golden] = {}
    for path in sorted((FOLDER / dialect).glob("*.golden")):
        for section in ("\n" + path.read_text("utf-8")).split("\n== ")[1:]:
            head, _, rest = section.partition("\n")
            program, _, said = f"{rest}\n".partition("--\n")
            golden = Golden(head.strip(), program)
            for text in said.splitlines():
                if text.strip() and not text.startswith("#"):
                    golden.tell(text)
            if golden.head in found:
                raise ValueError(f"{golden.head} stands there twice")
            found[golden.head] = golden
    return found


@dataclass(frozen=True)
class Ran:
    """What came of an entry's lines: their rows and the findings; lines count from the first of them."""

    blocks: list[Block]
    findings: list[Diagnostic]
    before: int  # lines of the book's head
    tail: range  # lines of the book's tail

    def rows(self, golden: Golden) -> list[Row]:
        """Their elementary blocks, as the golden wants to see them."""
        found = []
        for block in self.blocks:
            if block.line > self.before and block.line not in self.tail:
                _, *words = row(block, axes=golden.axes, machine=golden.positions)
                found.append([block.line - self.before, *words])
        return found

    @property
    def feeds(self) -> list[Block]:
        """Their moves that cut."""
        mine = [each for each in self.blocks if each.line > self.before and each.line not in self.tail]
        return [each for each in mine if each.moves and not each.rapid and each.kind is not BlockKind.PLANE]

    def told(self, *weights: Severity) -> list[str]:
        """Findings of these weights: ``weight LINE CODE``."""
        found = [each for each in self.findings if each.severity in weights]
        return [f"{each.severity} {self._line(each)} {each.code}" for each in found]

    @property
    def first_error(self) -> str:
        """``LINE COLUMN CODE``; empty without one."""
        found = [each for each in self.findings if each.severity is Severity.ERROR]
        return f"{self._line(found[0])} {found[0].column} {found[0].code}" if found else ""

    def _line(self, finding: Diagnostic) -> int:
        return finding.line - self.before if finding.line else 0


def ran(dialect: Dialect, entry: CodeBookEntry, lines: str, machine: str = "") -> Ran:
    """Run these lines as the book's entry stands: between head and tail, with the programs beside it."""
    ground, book = GROUNDS[dialect], get_code_book(dialect)
    head, tail = ("", "") if entry.whole else (book.head, book.lines_after_example)
    lines = lines if lines.endswith("\n") or entry.whole else f"{lines}\n"
    last = "" if entry.whole else entry.behind + ground.last
    files = tuple(ProgramSource(name, each) for name, each in entry.files)
    source = ProgramSource(ground.name, f"{head}{lines}{tail}{last}", subprograms=files)
    setup = create_power_up_setup(
        load_shipped_machine(machine or ground.machine), tool_offsets=ground.tools, secondary_offsets={}
    )
    run = SharedProgram(source).start_pass(setup)
    blocks = list(run.generate_blocks())
    before, behind = head.count("\n"), head.count("\n") + lines.count("\n") + 1
    return Ran(blocks, run.diagnostics, before, range(behind, behind + tail.count("\n")))


def differences(found: list[Row], wanted: list[list[str]]) -> str:
    """Where the rows are not what a table says, in words; empty where they are."""
    at, loose = 0, False
    for number, want in enumerate(wanted):
        if want == ["..."]:
            loose = True
            continue
        while loose and at < len(found) and not same(found[at], want):
            at += 1
        last = number == len(wanted) - 1
        if loose and last and found and same(found[-1], want):
            at = len(found) - 1
        if at >= len(found):
            return f"missing: {' '.join(want)}"
        if not same(found[at], want):
            return f"{found[at]}   but the table says   {' '.join(want)}"
        at, loose = at + 1, False
    return "" if loose or at == len(found) else f"and then there is {found[at]}"


def extent(blocks: list[Block]) -> list[float]:
    """Least and greatest end of these moves, axis by axis: X Y Z of the working plane, on a lathe X Z."""
    ends = [(each.x, each.z) if each.swivel is None else tuple(each.swivel.end) for each in blocks]
    return [figure for axis in zip(*ends, strict=True) for figure in (min(axis), max(axis))]


def way(blocks: list[Block]) -> float:
    """Length of these moves on all axes of a mill, mm."""
    return sum(each.travel.length for each in blocks if each.travel is not None)


def blank(blocks: list[Block]) -> list[float]:
    """Corners of the blank that BLK FORM has told, axis by axis; empty without one."""
    found = next((each.swivel.system.blank_corners for each in blocks if each.swivel is not None), None)
    return [] if found is None else [figure for axis in zip(*found, strict=True) for figure in axis]
