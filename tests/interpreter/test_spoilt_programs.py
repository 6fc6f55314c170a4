"""Programs of every language, spoilt: each is proved or refused, and what is said has its place."""

from __future__ import annotations

import random

import pytest

from app.compose.machine.machine_files import shipped_machine
from app.compose.machine.machine_setup import setup_for
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, Source
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
def test_a_spoilt_program_is_proved_or_refused(dialect: Dialect, seed: int) -> None:
    name, source = MACHINES[dialect]
    machine = shipped_machine(name)
    text = mutated(random.Random(seed), dialect)
    report = prove(Source(source, text), setup_for(machine, tools={1: ToolOffset()}, secondary={}), machine)
    assert report.elementary > 0 or report.errors
    low, high = report.ways.cycle
    assert report.ways.proved >= 1
    assert report.errors or low - 1e-6 <= report.times.cycle <= high + 1e-6
    for found in report.diagnostics:
        assert 0 <= found.line <= text.count("\n") + 1
        assert found.message
        assert found.count >= 1
        assert not found.check or (found.code == found.check and found.hint)
