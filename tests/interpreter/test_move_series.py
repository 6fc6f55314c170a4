"""Moves made many at once are those that are made one by one: every field of every block, every finding."""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.omniturn.motion.plain_moves import LineColumns, parse_columns, parse_plain_move
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared.elementary_blocks import Block, StraightMoveSeries
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.interpreter.mutation import SEEDS, mutated
from tests.interpreter.programs import body, inches, lines, setup

pytestmark = pytest.mark.long

PROGRAMS = sorted((Path(__file__).parents[1] / "programs").glob("*.nc"))
NEVER = 10**9


@contextmanager
def at_once(least: int, most: int = 20_000) -> Iterator[None]:
    """Series from ``least`` moves on, of ``most`` at most; lines are read all at once, or each alone."""
    long = NEVER if least == NEVER else 1
    with (
        patch("core.interpreter.omniturn.omniturn_interpreter.LONG_PROGRAM_LINE_COUNT", long),
        patch("core.interpreter.omniturn.motion.move_series.MIN_SERIES_LENGTH", least),
        patch("core.interpreter.omniturn.motion.move_series.MAX_RUN_LENGTH", most),
        patch("core.interpreter.omniturn.motion.plain_moves.MAX_RUN_LENGTH", most),
        patch("core.interpreter.omniturn.motion.plain_moves._FEW", long),
    ):
        yield


def gone_through(text: str, given: InterpreterSetup) -> tuple[list[str], list[Diagnostic], int]:
    """The blocks with all their fields, what was found, and how many series there were."""
    interpreter = Interpreter(read_program(ProgramSource("PART", text)), given)
    passed = list(interpreter.generate_series())
    series = sum(isinstance(each, StraightMoveSeries) for each in passed)
    blocks = chain.from_iterable(each if isinstance(each, StraightMoveSeries) else [each] for each in passed)
    return [repr(block) for block in blocks], interpreter.diagnostics, series


def assert_same(text: str, given: InterpreterSetup | None = None, most: int = 20_000) -> int:
    """Both ways give the same; how many series there were."""
    given = given or setup()
    with at_once(NEVER):
        blocks = [
            repr(block)
            for block in Interpreter(read_program(ProgramSource("PART", text)), given).generate_blocks()
        ]
        alone = gone_through(text, given)
    with at_once(2, most):
        many = gone_through(text, given)
    assert alone[0] == blocks
    assert many[:2] == alone[:2]
    return many[2]


NUMBER = st.one_of(
    st.sampled_from(["0", "-0", "1.", ".5", "-.00001", "+2", "0.00005", "1.23455", "-0.12345", "9999.99999"]),
    st.integers(-99999, 99999).map(lambda n: f"{n / 10000:.4f}"),
    st.integers(-99999, 99999).map(lambda n: f"{n / 10000:.5f}"),
)


def word(letters: str) -> st.SearchStrategy[str]:
    return st.builds(str.__add__, st.sampled_from(list(letters)), NUMBER)


MOVE = st.builds(
    "{}{}{}{}".format,
    st.sampled_from(["", "", "", "", "G01", "G00", "g01", "G10", "G09"]),
    word("Xx") | st.just(""),
    word("Zz") | st.just(""),
    st.sampled_from(["", "", "", "F.003", "F20", "F.00300", "F0", "f.003", "F.004", "F300", "F9"]),
)
OTHERS = (
    "G90 G91 G70 G71 G72 G73 G95F.003 G94F20 G95F.06 G96S300 G97S500 G00 G01 LS3 LS20 LF T1 T2D1X1Z1 G41 G40 "
    "G36 G35 M19 M05 (A) X1C.1 X X1Z1X1"
)
OTHER = st.sampled_from([*OTHERS.split(" "), ""])
TAME = st.builds(
    "{}{}{}".format,
    word("X"),
    word("Z") | st.just(""),
    st.sampled_from(["", "", "", "F.003", "F.0030", "F.004", "F.05", "F.00005", "F.051", "F.00004"]),
)
RUN = st.lists(TAME, min_size=1, max_size=9)
LOOP = st.builds(lambda times, moves: [f"LS{times}", *moves, "LF"], st.integers(1, 40), RUN)
ODD = st.one_of(MOVE, OTHER).map(lambda text: [text])
LINES = st.lists(st.one_of(RUN, RUN, RUN, LOOP, ODD), max_size=9).map(
    lambda each: list(chain.from_iterable(each))
)


@settings(max_examples=400, deadline=None)
@given(LINES, st.integers(2, 30))
def test_series_matches_single_lines_for_any_moves(moves: list[str], most: int) -> None:
    assert_same(body("G95F.003", "X1Z1", *moves), most=most)


@settings(max_examples=60, deadline=None)
@given(st.lists(MOVE, min_size=1, max_size=30))
def test_column_reader_matches_single_line_reader(moves: list[str]) -> None:
    read, alone = LineColumns.make_empty(len(moves)), LineColumns.make_empty(len(moves))
    with patch("core.interpreter.omniturn.motion.plain_moves._FEW", 1):
        parse_columns("\n".join(moves), read)
    for at, text in enumerate(moves):
        if (move := parse_plain_move(text)) is not None:
            alone.store_line(at, move)
    for column, expected in zip(read, alone, strict=True):
        many, one = np.asarray(column)[alone.is_plain_move], np.asarray(expected)[alone.is_plain_move]
        assert np.array_equal(many, one, equal_nan=True)
        assert np.array_equal(np.signbit(many), np.signbit(one))
    assert (read.is_plain_move == alone.is_plain_move).all()


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_series_matches_single_lines_for_sample_programs(path: Path) -> None:
    secondary = dict.fromkeys(range(1, 5), (-0.015, -0.015, 0.015))
    assert_same(path.read_text("latin-1"), setup(secondary=secondary), most=5)


@pytest.mark.parametrize("seed", range(200))
def test_series_matches_single_lines_for_corrupted_programs(seed: int) -> None:
    chance = random.Random(seed)
    text = mutated(chance).split("\n")
    at = chance.randrange(len(text))
    text[at:at] = [f"X{chance.uniform(0.1, 1):.4f}Z{chance.uniform(-2, 0):.4f}" for _ in range(8)]
    assert_same("\n".join(text))


def reported(text: str) -> str:
    machine = load_machine(None)
    given = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset() for n in range(1, 33)}, secondary_offsets={}
    )
    return repr(prove(ProgramSource("PART", text), given, machine))


@pytest.mark.parametrize("seed", range(40))
def test_report_of_series_matches_report_of_single_lines(seed: int) -> None:
    """Lengths, times, reach and findings of whole programs, soft limits among them."""
    chance = random.Random(seed)
    moves = [f"X{chance.uniform(0, 3):.4f}Z{chance.uniform(-9, 1):.4f}" for _ in range(60)]
    text = body("G95F.003", "X1Z1", *moves, "LS30", "X1.1", "Z-1.23", "X2", "LF", "T1", "G00X1Z1", *moves)
    text = chance.choice([text, mutated(chance), chance.choice(SEEDS)])
    with at_once(NEVER):
        alone = reported(text)
    with at_once(2):
        assert reported(text) == alone


def test_long_program_runs_in_series() -> None:
    moves = [f"X{1 + k % 7 / 100:.4f}Z{-k / 10000:.4f}" for k in range(20)]
    assert assert_same(body("G95F.003", "X1Z1", *moves, "M08", *moves)) == 2


def test_loop_passes_run_in_one_series() -> None:
    assert assert_same(body("G95F.003", "X1Z1", "G91", "X.01", "LS1000", "X.001", "Z-.001F.003", "LF")) == 1


@pytest.mark.parametrize("feeds", [("F.004", "F.003"), ("F.004", "F.00300"), ("", "F.05")])
def test_loop_with_feed_changes_runs_in_one_series(feeds: tuple[str, str]) -> None:
    first, last = feeds
    assert assert_same(body("G95F.003", "X1Z1", "LS100", f"X1.1{first}", f"X1{last}", "LF")) == 1


@pytest.mark.parametrize(
    ("before", "feed"),
    [
        ("G95F.003", "F.051"),  # warned of
        ("G95F.003", "F.00004"),  # refused
        ("G94F20", "F300"),  # that of the first line: a rapid
        ("G94F20", "G00F20"),
        ("G00X2", "F20"),  # after a rapid
    ],
)
def test_line_whose_feed_needs_statement_runs_outside_series(before: str, feed: str) -> None:
    assert assert_same(body(before, "X1Z1", "LS100", f"X1.1{feed}", "LF")) == 0


def test_lines_with_feed_on_each_line_run_in_one_series() -> None:
    moves = [f"X{1 + k % 7 / 100:.4f}Z{-k / 100:.4f}F.00{1 + k % 5}" for k in range(200)]
    assert assert_same(body("G95F.003", "X1Z1", *moves)) == 1
    assert assert_same(body("G94F20", "X1Z1", *[f"Z-{k}F{1 + k % 9}" for k in range(50)])) == 1


def test_low_feed_warnings_name_line_of_each_slow_move() -> None:
    feeds = [3, 0.1, 3, 0.2, 3]
    text = body("G94F3", "X1Z1", *[f"Z-{k}F{feed}" for k, feed in enumerate(feeds, 1)])
    with at_once(2):
        found = gone_through(text, setup())[1]
    assert [each.line for each in found if each.code == "feed-low"] == [5, 6, 8]
    assert assert_same(text) == 1


def test_rounded_words_are_reported_up_to_limit() -> None:
    moves = [f"X1.{k:05d}Z-{k / 7:.5f}" for k in range(300)]
    assert assert_same(body("G95F.003", "X1Z1", *moves)) == 1


def test_run_limits_match_those_of_single_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("core.interpreter.omniturn.omniturn_interpreter.MAX_BLOCK_COUNT", 77)
    assert_same(body("G94F20", "X1Z1", "LS1000", "X1", "X2", "LF"))
    assert_same(body("G94F20", "X1Z1", *["X1", "X2"] * 100))
    monkeypatch.setattr("core.interpreter.omniturn.omniturn_interpreter.MAX_LINE_COUNT", 50)
    assert_same(body("G94F20", "X1Z1", "LS1000", "X1", "X2", "LF"))
    assert_same(body("G94F20", "X1Z1", *["X1", "X2"] * 100))


def test_series_behaves_as_sequence_of_blocks() -> None:
    """X and Z alternate, so that the ends can be said without counting: 1, 1 → 2, 1 → 2, 0 → 1, 0."""
    with at_once(2):
        text = lines("G90G94F300", "F20", "X1Z1", "X2", "Z0", "X1", "M30")
        made = list(Interpreter(read_program(ProgramSource("A", text)), setup()).generate_series())
    row = next(each for each in made if isinstance(each, StraightMoveSeries))
    ends = [inches(x=2, z=1), inches(x=2, z=0), inches(x=1, z=0)]
    assert [{"x": block.x, "z": block.z} for block in row] == [pytest.approx(end) for end in ends]
    assert [(block.n, block.line, block.text) for block in row] == [(2, 4, "X2"), (3, 5, "Z0"), (4, 6, "X1")]
    assert (row[-1].line, row[1].x0, [block.line for block in row[1:]]) == (6, row[0].x, [5, 6])
    assert isinstance(row[1:], StraightMoveSeries)
    with pytest.raises(IndexError):
        row[3]


def test_lines_of_long_program_match_those_of_short_program() -> None:
    texts = ["X1.5Z-2", "", "G01X1F.003", "X1.23456", "M08", "Z3"] * 500
    with at_once(2):
        steps = read_program(ProgramSource("A", lines(*texts))).executable_lines
    assert [parse_plain_move(text) for text in texts] == [s if isinstance(s, tuple) else None for s in steps]
    changed = steps[5]
    steps[5] = None
    assert (steps[5], steps[4:6], steps.find_next_statement(5)) == (None, [steps[4], None], 5)
    assert changed == (None, 3.0, None, -1, False)
    assert isinstance(
        next(iter(Interpreter(read_program(ProgramSource("A", body("X1F9"))), setup()).generate_series())),
        Block,
    )
