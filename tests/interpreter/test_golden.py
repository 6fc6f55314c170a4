"""Whole programs against tables worked out by hand: ``tests/programs/NAME.nc`` and ``NAME.expected``.

A table has one row for each elementary block, ``line what …``: inches, X a radius, in the program's frame::

    5 feed 0.50000 -1.25000 0.00400 in/rev 1000
    6 arc 0.60000 -1.35000 cw 0.50000 -1.35000 0.00400 in/rev 1000

The last number is the speed of the spindle; ``c`` and degrees stand before the feed where C turns. Warnings
and notes follow: ``warning LINE COLUMN CODE``. A program that must not run: ``error LINE COLUMN CODE`` only.
Circumstances come first, after ``#``: ``tool n x z``, ``secondary n x z r`` (x a radius), ``input TERMINAL``
(closed), ``block-delete``, ``metric``, ``start x z``; ``machine`` asks for machine positions in the table.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Severity
from core.language.source import ProgramSource
from tests.dialects.golden_rows import flow_words, switch_words
from tests.interpreter.programs import ALL_TOOLS, INCH, in_feed, setup

PROGRAMS = Path(__file__).parents[1] / "programs"
NAMES = sorted(path.stem for path in PROGRAMS.glob("*.nc"))
NEAR = 6e-6  # half of the fifth place
RPM_NEAR = 6e-3


def circumstances(header: list[list[str]]) -> InterpreterSetup:
    """What the lines after ``#`` say."""
    given = {words[0] for words in header}
    closed = {words[1] for words in header if words[0] == "input"}
    numbers = [(words[0], [float(each) for each in words[1:]]) for words in header if words[0] != "input"]
    offsets = {int(n[0]): ToolOffset(n[1] * INCH, n[2] * INCH) for name, n in numbers if name == "tool"}
    start = next((n for name, n in numbers if name == "start"), [0.0, 0.0])
    return setup(
        tools={**ALL_TOOLS, **offsets},
        secondary={int(n[0]): tuple(n[1:]) for name, n in numbers if name == "secondary"},
        inputs=closed.__contains__,
        block_delete="block-delete" in given,
        metric="metric" in given,
        start=(start[0], start[1]),
    )


def action_words(action: actions.Action) -> list[str | float]:
    """What a block does, in the words of the tables."""
    words = frame_words(action) or switch_words(action) or flow_words(action)
    return words or [
        {actions.SpindleStop: "spindle-off", actions.CycleRepeatCancel: "repeat-off"}[type(action)]
    ]


def frame_words(action: actions.Action) -> list[str | float]:
    """T, G10, G92, S and G04; nothing for any other."""
    words: list[str | float] = []
    match action:
        case actions.ToolChange(tool):
            words = ["tool", tool]
        case actions.WorkShift(x, z):
            words = ["shift", x / INCH, z / INCH]
        case actions.Preset(x, z):
            words = ["preset", x / INCH, z / INCH]
        case actions.SpindleRun(rpm, None):
            words = ["spindle", rpm]
        case actions.SpindleRun(rpm, float(surface)):
            words = ["surface", surface / INCH / 12 * 60, rpm]
        case actions.Dwell(seconds):
            words = ["dwell", seconds]
    return words


def row(block: Block, *, machine: bool) -> list[str | float]:
    """A block as its row of the table."""
    if block.action is not None:
        return [block.line, *action_words(block.action)]
    place = (block.mx, block.mz) if machine else (block.x, block.z)
    words: list[str | float] = [block.line, str(block.kind), place[0] / INCH, place[1] / INCH]
    if block.kind is BlockKind.ARC:
        words += ["cw" if block.clockwise else "ccw", block.cx / INCH, block.cz / INCH]
    if block.c != block.c0:
        words += ["c", block.c]
    if block.kind is BlockKind.ROTATE:
        return [*words, block.rpm, "rpm"]
    return [*words, in_feed(block), "in/rev" if block.per_rev else "in/min", block.rpm]


def is_number(word: str) -> bool:
    """Whether a word of a table is a figure."""
    return word.lstrip("-").replace(".", "", 1).isdigit()


def same(found: list[str | float], expected: list[str]) -> bool:
    """Whether a row says what the table says; the speed, its last figure, to two places."""
    if len(found) != len(expected):
        return False
    for at, (have, want) in enumerate(zip(found, expected, strict=True)):
        near = RPM_NEAR if at == len(found) - 1 and at > 1 else NEAR
        if isinstance(have, str) or not is_number(want):
            if str(have) != want:
                return False
        elif abs(have - float(want)) > near:
            return False
    return True


def shown(words: list[str | float]) -> str:
    """A row as the table writes it."""
    return " ".join(f"{word:.5f}" if isinstance(word, float) else str(word) for word in words)


@pytest.mark.parametrize("name", NAMES)
def test_program_produces_blocks_of_its_table(name: str) -> None:
    table = [text.split() for text in (PROGRAMS / f"{name}.expected").read_text("utf-8").splitlines()]
    header = [words[1:] for words in table if words[:1] == ["#"]]
    findings = [words for words in table if words and words[0] in set(Severity)]
    blocks = [words for words in table if words and words[0].isdigit()]
    assert len(header) + len(findings) + len(blocks) == len(table), "a row that says nothing"
    source = ProgramSource(name, (PROGRAMS / f"{name}.nc").read_text("utf-8"))
    interpreter = Interpreter(read_program(source), circumstances(header))
    found = [row(block, machine=["machine"] in header) for block in interpreter.generate_blocks()]
    told = [[str(d.severity), str(d.line), str(d.column), d.code] for d in interpreter.diagnostics]
    if any(words[0] == "error" for words in findings):
        assert not blocks
        errors = [words for words in told if words[0] == "error"]
        assert errors[: len(findings)] == findings  # what follows from the mistake may follow
        _, line, column, _ = findings[0]
        assert column == "0" or not [r for r in found if str(r[0]) == line and str(r[1]) in set(BlockKind)]
        return
    assert sorted(told) == sorted(findings)
    for have, want in zip(found, blocks, strict=False):
        assert same(have, want), f"{shown(have)}   but the table says   {' '.join(want)}"
    assert len(found) == len(blocks)


def test_every_golden_program_has_its_table() -> None:
    assert NAMES
    assert sorted(path.stem for path in PROGRAMS.glob("*.expected")) == NAMES
