"""Program of the tour: it proves on its tools and stock, and its copy with a wrong sign is rejected."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.extras.tour.tour_script import (
    FAULTY_PROGRAM_NAME,
    PROGRAM_NAME,
    RIGHT_WORD,
    TOOLS_PATH,
    TOUR_STEPS,
    StepEnd,
    find_wrong_line,
    read_programs,
)
from core.language.source import load_source
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove


def prove_text(folder: Path, text: str) -> ProofReport:
    path = folder / "tour.nc"
    path.write_text(text)
    machine, tools = load_machine(None), read_offsets_file(TOOLS_PATH).tool_offsets
    return prove(
        load_source(path), create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={}), machine
    )


def test_program_proves_and_takes_about_forty_seconds(tmp_path: Path) -> None:
    proof = prove_text(tmp_path, read_programs()[PROGRAM_NAME])
    assert proof.diagnostics == ()
    assert proof.missing_tool_numbers == ()
    assert 35.0 <= proof.program_times.cycle_time_s <= 45.0


def test_program_turns_threads_mills_with_c_and_parts_off() -> None:
    text = read_programs()[PROGRAM_NAME]
    for word in ("(TURNING TOOL)", "G33", "M19", "(~PLXC)", "(PART OFF)"):
        assert word in text


def test_wrong_sign_is_the_only_difference_between_the_programs() -> None:
    programs = read_programs()
    right, wrong = (programs[name].splitlines() for name in (PROGRAM_NAME, FAULTY_PROGRAM_NAME))
    (line,) = (n for n, (a, b) in enumerate(zip(right, wrong, strict=True), 1) if a != b)
    assert line == find_wrong_line(programs[FAULTY_PROGRAM_NAME])
    assert wrong[line - 1].replace("Z-.05", "Z.05") == right[line - 1]


@pytest.mark.parametrize("text", ["", "G90\nM30\n", RIGHT_WORD])
def test_program_without_the_wrong_word_has_no_wrong_line(text: str) -> None:
    assert find_wrong_line(text) == 0


def test_steps_wait_only_for_tools_of_the_program() -> None:
    text = read_programs()[PROGRAM_NAME]
    for step in TOUR_STEPS:
        assert (step.end is StepEnd.TOOL) is bool(step.tool)
        assert not step.tool or f"\nT{step.tool}(" in text
