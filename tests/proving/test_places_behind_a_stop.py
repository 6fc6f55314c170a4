"""A place that a hand may have changed at a stop: what fails with it in the proof is a warning."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove

LATHE, MILL = load_shipped_machine("sinumerik-modulo"), load_shipped_machine("ac-table-mill")
STOP, READ = "M0", "R1=$AA_IW[Z]"


def told(name: str, text: str, code: str) -> list[tuple[int, str]]:
    machine = MILL if name.endswith(".h") else LATHE
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource(name, text), setup, machine)
    return [(each.line, str(each.severity)) for each in report.diagnostics if each.code == code]


@pytest.mark.parametrize(
    ("lines", "weight"),
    [
        (("G0 X30 Z0", STOP, READ, "R2=10/R1"), "warning"),
        (("G0 X30 Z0", STOP, "G0 X=10/$AA_IW[Z]", ""), "warning"),
        (("G0 X30 Z0", READ, STOP, "R2=10/R1"), "error"),
        (("G0 X30 Z0", STOP, "R1=0", "R2=10/R1"), "error"),
        (("G0 X30 Z0", "", READ, "R2=10/R1"), "error"),
    ],
)
def test_error_after_program_stop_has_its_severity_on_lathe(lines: tuple[str, ...], weight: str) -> None:
    ((_, severity),) = told("a.mpf", "T1 D1\n" + "\n".join(lines) + "\nM30\n", "arithmetic")
    assert severity == weight


@pytest.mark.parametrize(
    ("lines", "weight"),
    [
        (("STOP", "FN 18: SYSREAD Q1 = ID270 NR1 IDX1", "Q2 = 1 / Q1"), "warning"),
        (("M0", "FN 18: SYSREAD Q1 = ID270 NR1 IDX1", "FN 4: Q2 = +1 DIV +Q1"), "warning"),
        (("FN 18: SYSREAD Q1 = ID270 NR1 IDX1", "STOP", "Q2 = 1 / Q1"), "error"),
        (("STOP", "Q1 = 0", "Q2 = 1 / Q1"), "error"),
    ],
)
def test_error_after_program_stop_has_its_severity_on_mill(lines: tuple[str, ...], weight: str) -> None:
    head = "BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+0 Y+0 Z+5 R0 FMAX\n"
    ((_, severity),) = told("a.h", head + "\n".join(lines) + "\nEND PGM A MM\n", "Arithmetical error")
    assert severity == weight


def test_run_ends_at_error_after_program_stop() -> None:
    """What the executor goes through has it as an error, for it knows where the axes stand."""
    text = f"T1 D1\nG0 X30 Z0\n{STOP}\n{READ}\nR2=10/R1\nM30\n"
    running = interpret_program(
        ProgramSource("a.mpf", text),
        create_power_up_setup(LATHE, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
    )
    assert [block.line for block in running.generate_blocks()] == [1, 2, 3]
    assert running.has_errors
