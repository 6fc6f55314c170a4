"""Programs of every language, spoilt: each is proved or refused, and what is said has its place."""

from __future__ import annotations

import random

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, ProgramSource
from core.proving.prove_program import prove
from tests.interpreter.mutation import mutated

pytestmark = pytest.mark.long

MACHINES = {
    Dialect.OMNITURN: ("gt75", "spoilt"),
    Dialect.KLARTEXT: ("ac-table-mill", "spoilt.h"),
    Dialect.SINUMERIK: ("sinumerik-modulo", "spoilt.mpf"),
}
CASES = [
    *((Dialect.OMNITURN, seed) for seed in range(150)),
    *((dialect, seed) for dialect in (Dialect.KLARTEXT, Dialect.SINUMERIK) for seed in range(80)),
]


@pytest.mark.parametrize(("dialect", "seed"), CASES)
def test_corrupted_program_is_proved_or_rejected(dialect: Dialect, seed: int) -> None:
    name, source = MACHINES[dialect]
    machine = load_shipped_machine(name)
    text = mutated(random.Random(seed), dialect)
    report = prove(
        ProgramSource(source, text),
        create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
        machine,
    )
    assert report.elementary_block_count > 0 or report.errors
    low, high = report.branch_summary.cycle_time_range
    assert report.branch_summary.proved_count >= 1
    assert report.errors or low - 1e-6 <= report.program_times.cycle_time_s <= high + 1e-6
    for found in report.diagnostics:
        assert 0 <= found.line <= text.count("\n") + 1
        assert found.message
        assert found.occurrence_count >= 1
        assert not found.check_name or (found.code == found.check_name and found.hint)
