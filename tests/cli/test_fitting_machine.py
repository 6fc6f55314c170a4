"""Klartext proved without --machine: on the shipped mill that can run it, and that is said."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

FRAME = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S999\n2 L X+0 Y+0 Z+100 FMAX\n{line}\n9 END PGM A MM\n"


def file_with(folder: Path, line: str, name: str = "a.h") -> Path:
    path = folder / name
    path.write_text(FRAME.format(line=line))
    return path


@pytest.mark.parametrize(
    ("line", "machine"),
    [
        ("3 PLANE AXIAL A+30 C+0 TURN FMAX", "ac-table-mill"),
        ("3 PLANE AXIAL B+30 TURN FMAX", "bc-table-mill"),
        ("3 PLANE AXIAL B+115 TURN FMAX", "head-table-mill"),
        ("3 L Z+50 FMAX", "ac-table-mill"),
    ],
)
def test_prove_selects_and_names_a_shipped_machine_that_fits(
    turndesk: Turndesk, tmp_path: Path, line: str, machine: str
) -> None:
    told = turndesk("prove", file_with(tmp_path, line), "--json")
    assert told.status == 0, told.out
    assert f"a.h is proved on the shipped {machine}; --machine" in told.err
    assert json.loads(told.out)["dialect"] == "klartext"


def test_specified_machine_is_used_even_if_it_does_not_fit(turndesk: Turndesk, tmp_path: Path) -> None:
    path = file_with(tmp_path, "3 PLANE AXIAL B+30 TURN FMAX")
    told = turndesk("prove", path, "--machine", "ac-table-mill")
    assert told.status == 1
    assert "no rotary axis B" in told.out
    assert "shipped" not in told.err


@pytest.mark.parametrize(
    ("line", "machine"),
    [
        ("3 L B+30 C+10 FMAX", "bc-table-mill"),
        ("3 L IA+5 FMAX ; B+3", "ac-table-mill"),
        ("3 L B+Q3 FMAX", "bc-table-mill"),
    ],
)
def test_faulty_program_is_proved_on_machine_that_has_its_axes(
    turndesk: Turndesk, tmp_path: Path, line: str, machine: str
) -> None:
    """What is wrong in it is what is told, not an axis that the first mill has not."""
    told = turndesk("prove", file_with(tmp_path, f"2 Q3 = 4\n{line}\n4 L X+9 F"))
    assert told.status == 1
    assert machine in told.err
    assert "axis B" not in told.out


def test_program_that_fits_no_shipped_mill_is_proved_on_the_first(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("prove", file_with(tmp_path, "3 L X+9 F"))
    assert told.status == 1
    assert "ac-table-mill" in told.err


@pytest.mark.parametrize(
    ("program", "machine", "named"),
    [
        ("resources/programs/roof.h", "gt75", "ac-table-mill"),
        ("resources/programs/ring.mpf", "ac-table-mill", "sinumerik-modulo"),
        ("resources/programs/pin.nc", "ac-table-mill", "gt75"),
    ],
)
def test_unsuitable_machine_error_names_one_that_fits(
    turndesk: Turndesk, program: str, machine: str, named: str
) -> None:
    told = turndesk("prove", program, "--machine", machine)
    assert told.status == 1
    assert f"--machine {named}" in told.out


def test_each_program_of_a_folder_gets_its_own_machine(turndesk: Turndesk, tmp_path: Path) -> None:
    """Two mills and a lathe, proved at once; what is kept of one machine is not taken for another."""
    folder = tmp_path / "mixed"
    folder.mkdir()
    file_with(folder, "3 PLANE AXIAL A+30 C+0 TURN FMAX")
    file_with(folder, "3 PLANE AXIAL B+30 TURN FMAX", "b.h")
    (folder / "c.mpf").write_text("N10 G90 G94 DIAMON\nN20 G0 X20 Z5\nN30 M30\n")
    (folder / "d.nc").write_text("G90G94F10G72\nG00X1Z1\nM30\n")
    for _ in range(2):
        told = turndesk("prove", folder, "--json", "--jobs", "1")
        assert told.status == 0, told.out + told.err
        rows = [json.loads(line) for line in told.out.splitlines()]
        assert [row["dialect"] for row in rows] == ["klartext", "klartext", "sinumerik", "omniturn"]
        assert all(f"on the shipped {name};" in told.err for name in ("ac-table-mill", "bc-table-mill"))
