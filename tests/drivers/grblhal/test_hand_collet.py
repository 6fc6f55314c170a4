"""A bench lathe with a collet closed by hand: told in the machine file, no trouble, and no M12."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from core.table_schema import MachineFileError
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky
from tests.texts import text

CLAMPED = (
    'collet  = { at = "out.0", safe = "keep" }    # on: clamped; closed by hand: collet = { at = "none" }'
)
BY_HAND = 'collet  = { at = "none" }'
PART = "G90G94F300\nX.1Z.1\n{}G01X.05F60\nM30\n"


def by_hand(*changes: tuple[str, str]) -> Machine:
    """The shipped machine without an output for its collet."""
    return grbl_machine((CLAMPED, BY_HAND), *changes)


def test_output_configured_as_absent_is_accepted() -> None:
    bench = GrblBench(by_hand(), quirky())
    assert not any("collet" in warning for warning in bench.machine.ports.warnings)
    assert "collet" not in bench.machine.ports.io.get_outputs()
    assert bench.shot.absent == {"collet"}


def test_program_that_needs_an_absent_output_is_refused_before_start() -> None:
    bench = GrblBench(by_hand(), quirky())
    bench.start(PART.format(""))
    bench.until(MachineState.IDLE)
    assert not bench.alarms()
    bench.start(PART.format("M13\nM12\n"))
    assert bench.state is MachineState.IDLE
    assert text("executor.no-such-for-line", line=3, what="output collet") in bench.shot.start_refusal_reason


def test_output_missing_from_the_machine_file_is_a_file_error() -> None:
    with pytest.raises(MachineFileError, match=r'io\.out\.collet: .*at = "none"'):
        grbl_machine((CLAMPED, ""))


def test_m_code_needs_an_output_that_is_present() -> None:
    with pytest.raises(MachineFileError, match=r"m_codes\.25\.output"):
        by_hand(('catcher = { at = "out.1", safe = false }', 'catcher = { at = "none" }'))
