"""The promise of a restart: from every good line and in every pass, each block is that of the full run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.restart.restart_point import RestartPoint
from core.interpreter.shared.actions import InputRead
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Severity
from core.language.source import ProgramSource, load_source
from tests.interpreter.programs import ALL_TOOLS, setup
from tests.interpreter.restart.again import all_of, begun, of_each_line, told
from tests.interpreter.test_golden import circumstances
from tests.worked import FOLDER

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[3]
GOLDEN = sorted(path for path in (ROOT / "tests" / "programs").glob("*.nc") if "refuse" not in path.name)
WORKED = sorted(FOLDER.glob("*.nc")) if FOLDER.is_dir() else []
SAMPLES = sorted((ROOT / "resources" / "programs").glob("*.nc"))


def golden_setup(path: Path) -> InterpreterSetup:
    table = path.with_suffix(".expected").read_text().splitlines()
    return circumstances([line[1:].split() for line in table if line.startswith("#")])


def runs(source: ProgramSource, given: InterpreterSetup) -> bool:
    return not any(d.severity is Severity.ERROR for d in read_program(source).diagnostics) and bool(
        given.tools
    )


def check(source: ProgramSource, given: InterpreterSetup) -> int:
    """Compare every good line; how many there were."""
    full = all_of(source, given)
    good = [each for each in of_each_line(source, given) if isinstance(each, RestartPoint)]
    for found in good:
        begin = begun(given, found)
        assert begin.begin is not None
        again = all_of(source, begin)[len(begin.begin.approach_steps) :]
        rest = [block for block in full if block.n > found.checkpoint.blocks]
        if any(isinstance(block.action, InputRead) for block in full):  # the count depends on the answers
            rest = full[len(full) - len(again) :]
            again = [replace(block, n=0) for block in again]
            rest = [replace(block, n=0) for block in rest]
        assert [told(block) for block in again] == [told(block) for block in rest], found.line_number
        once = found.visit.visit_count == 1 and not found.visit.enclosing_levels
        assert not (again and once) or again[0].line >= found.line_number or again[0].line in _called(source)
    return len({found.line_number for found in good})


def _called(source: ProgramSource) -> set[int]:
    return set(range(read_program(source).structure.main_end_index, len(source.lines) + 1))


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_every_valid_line_of_the_golden_programs_restarts(path: Path) -> None:
    source, given = load_source(path), golden_setup(path)
    assert runs(source, given)
    check(source, given)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_every_valid_line_of_the_samples_restarts(path: Path) -> None:
    source = load_source(path)
    assert check(source, setup(tools=ALL_TOOLS)) > len(source.lines) / 3


@pytest.mark.skipif(not WORKED, reason="the worked examples are not at hand")
@pytest.mark.parametrize("path", WORKED, ids=lambda path: path.stem)
def test_every_valid_line_of_the_worked_examples_restarts(path: Path) -> None:
    source, given = load_source(path), setup(secondary=dict.fromkeys(range(1, 9), (-0.015, -0.015, 0.015)))
    try:
        all_of(source, given)
    except AssertionError as error:
        pytest.skip(f"needs circumstances of its own: {error}"[:150])
    check(source, given)
