"""The generated program, written out as plain absolute lines, interprets to the same path."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.interpreter.omniturn.codes.code_table import CODE_CHAPTERS
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource, load_source
from tests.worked import FOLDER

INCH = 25.4
# Words are rounded to the control's step of .00005 in; half of it may be lost at each end.
STEP = 0.00005 * INCH
NOSE = 0.015 * INCH
SAMPLES = Path(__file__).parents[2] / "resources" / "programs"
PLAIN = {BlockKind.RAPID, BlockKind.FEED, BlockKind.ARC}
SECONDARY = {n: SecondaryOffset(-NOSE, -NOSE, NOSE) for n in range(1, 5)}


def programs() -> list[tuple[str, ProgramSource]]:
    book = [
        (code.name, ProgramSource(code.name, code.example_program))
        for _, codes in CODE_CHAPTERS
        for code in codes
    ]
    files = [*sorted(SAMPLES.glob("*.nc")), *sorted(FOLDER.glob("*.nc"))]
    return book + [(path.stem, load_source(path)) for path in files]


def moves(source: ProgramSource, tools: dict[int, ToolOffset]) -> list[Block]:
    """The moves of a program in machine coordinates; empty when it has errors."""
    setup = create_power_up_setup(load_machine(None), tool_offsets=tools, secondary_offsets=SECONDARY)
    interpreter = Interpreter(read_program(source), setup)
    blocks = [block for block in islice(interpreter.generate_blocks(), 20_000) if block.moves]
    return [] if interpreter.has_errors else blocks


def written(blocks: list[Block]) -> str:
    """Absolute radius lines in machine coordinates, each with its path feed in inches a minute."""
    return "G90G94F300G73\n" + "".join(map(_line, blocks)) + "M30\n"


def _line(block: Block) -> str:
    speed = block.feed * abs(block.rpm) / 60 if block.per_rev else block.feed
    words = f"X{block.mx / INCH:.9f}Z{block.mz / INCH:.9f}F{min(speed * 60 / INCH, 300):.9f}\n"
    if block.kind is not BlockKind.ARC:
        return words
    i, k = block.cx + block.offset_x, block.cz + block.offset_z
    return f"G0{2 if block.clockwise else 3}I{i / INCH:.9f}K{k / INCH:.9f}{words}"


@pytest.mark.parametrize(
    ("name", "source"), programs(), ids=lambda value: value if isinstance(value, str) else ""
)
def test_plain_lines_reproduce_the_path(name: str, source: ProgramSource) -> None:
    tools, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    path = [b for b in moves(source, {n: ToolOffset() for n in range(1, 9)} | dict(tools)) if _long_enough(b)]
    if not path or not PLAIN.issuperset(block.kind for block in path):
        pytest.skip(f"{name} has no moves, or moves that plain lines cannot say")
    again = moves(ProgramSource(f"{name} again", written(path)), {})
    assert len(again) == len(path)
    for one, two in zip(path, again, strict=True):
        assert (two.mx, two.mz) == pytest.approx((one.mx, one.mz), abs=STEP)
        assert (one.kind is BlockKind.ARC) is (two.kind is BlockKind.ARC)
        if one.kind is BlockKind.ARC:
            assert one.clockwise is two.clockwise
            centre = (one.cx + one.offset_x, one.cz + one.offset_z)
            assert (two.cx, two.cz) == pytest.approx(centre, abs=STEP)


def _long_enough(block: Block) -> bool:
    return abs(block.x - block.x0) + abs(block.z - block.z0) > 2 * STEP or block.kind is BlockKind.ARC
