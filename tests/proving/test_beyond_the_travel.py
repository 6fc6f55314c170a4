"""A program that leaves the travel everywhere is refused with as many findings as somebody reads."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import MAX_FINDINGS, prove

MACHINE = load_machine(None)
HEAD = ("G90G94F300", "T1", "X.5Z.1")


def beyond(count: int) -> list[int]:
    """The lines that are refused when so many moves, from line 4 on, go beyond Z-6, where the travel ends."""
    moves = [f"Z-{7 + k / 1000:.3f}" for k in range(count)]
    setup = create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource("A", "\n".join((*HEAD, *moves, "Z.1", "M30", ""))), setup, MACHINE)
    return [each.line for each in report.errors if each.code == "soft-limit"]


@pytest.mark.parametrize("count", [1, 99, 100])
def test_few_travel_violations_are_all_reported(count: int) -> None:
    assert beyond(count) == list(range(4, 4 + count))


@pytest.mark.parametrize("count", [101, 2500])
def test_travel_violations_are_limited_to_100(count: int) -> None:
    assert MAX_FINDINGS == 100
    assert beyond(count) == list(range(4, 104))
