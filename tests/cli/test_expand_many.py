"""Many moves are written at once, to the letter as each by itself."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.cli.outputs.omniturn_output import (
    format_decimals,
    format_row,
    format_series,
    make_block_json,
    make_series_json,
    round_exactly,
)
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.elementary_blocks import StraightMoveSeries, TimedSeries
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.proving.program_timeline import TimedBlock, Timeline, iter_timed_blocks

MACHINE = load_machine(None)
HEADS = (
    "G90G94F300G72\nM03S2000\nT1\nX1Z.1\nG95F.003\n",
    "G90G94F12.7G71\nT1D1\nX20Z2\n",
    "G90G94F300G73\nT1\nX1Z.1\n",
)
MOVES = "".join(f"X{0.5 + k % 7 * 0.01:.4f}Z{-0.0001 * k:.5f}\n" for k in range(300))


def moves_of(head: str) -> tuple[TimedSeries, list[TimedBlock]]:
    """The program's plain moves as a series, and the same one by one."""
    setup = create_power_up_setup(
        MACHINE,
        tool_offsets={1: ToolOffset(x=-3.1, z=2.7)},
        secondary_offsets={1: SecondaryOffset(x=0.0133, z=-0.02)},
    )
    source = ProgramSource("A", f"{head}{MOVES}M30\n")
    alone = [
        each for each in iter_timed_blocks(Timeline.from_program(source, setup, MACHINE)) if each[0].line > 6
    ]
    alone = [each for each in alone if each[0].moves]
    blocks = [block for block, _, _ in alone]
    n, line = (np.array([getattr(block, name) for block in blocks]) for name in ("n", "line"))
    ways = {name: np.array([getattr(each, name) for each in blocks]) for name in ("x0", "z0", "x", "z")}
    series = StraightMoveSeries(blocks[0], source.lines, n, line, **ways)
    assert list(map(repr, series)) == list(map(repr, blocks))
    t0, t1 = (np.array(column) for column in list(zip(*alone, strict=True))[1:])
    return TimedSeries(series, t0, t1), alone


@pytest.mark.parametrize("head", HEADS)
def test_series_table_matches_row_by_row_table(head: str) -> None:
    together, alone = moves_of(head)
    assert format_series(together) == "".join(format_row(block, t0) for block, t0, _ in alone)


@pytest.mark.parametrize("head", HEADS)
def test_series_json_matches_block_by_block_json(head: str) -> None:
    together, alone = moves_of(head)
    told = [json.dumps(make_block_json(block, block.text, t0, t1)) + "\n" for block, t0, t1 in alone]
    assert make_series_json(together) == "".join(told)


FIGURES = (
    st.floats(-1e7, 1e7)
    | st.integers(-(10**10), 10**10).map(lambda n: n / 2e9)
    | st.integers(-(10**13), 10**13).map(lambda n: n / 1e6)
)


def same(values: list[float], places: int) -> bool:
    """Whether a column is rounded and written as each value by itself."""
    alone = [repr(round(value, places) + 0.0) for value in values]
    column = np.array(values)
    return list(map(repr, round_exactly(column, places).tolist())) == format_decimals(column, places) == alone


@given(st.lists(FIGURES, min_size=1, max_size=20), st.sampled_from([6, 9]))
def test_decimals_are_rounded_as_python_rounds_them(values: list[float], places: int) -> None:
    assert same(values, places)


@pytest.mark.parametrize("value", [0.5e-9, 1.5e-9, 2.5e-9, -0.5e-9, -1e-12, 0.1234567885, 1e5 + 2.5e-9, 1e15])
def test_values_near_half_a_step_are_rounded_as_python_rounds_them(value: float) -> None:
    """A half of a step is no binary number: its decimals say where it goes, and no product with 1e9."""
    assert same([value, math.nextafter(value, math.inf), math.nextafter(value, -math.inf)], 9)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.0"), (-0.0, "0.0"), (1.0, "1.0"), (-100.0, "-100.0"), (0.0001, "0.0001"),
        (-0.00009, "-9e-05"),
        (12.3, "12.3"),
        (999.999999999, "999.999999999"), (1000.0, "1000.0"), (-0.500000001, "-0.500000001"),
        (1e16, "1e+16"),
    ],
)  # fmt: skip
def test_leading_and_trailing_zeros_are_omitted(value: float, text: str) -> None:
    assert format_decimals(np.array([value, value]), 9) == [text, text]


def test_empty_array_formats_as_empty_list() -> None:
    assert format_decimals(np.empty(0), 6) == []
