"""``turndesk scope``: a run's record told and exported; what is no record is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

PROGRAM = "G90G94F300\nM03S600\nT1\nX.5Z.1\nG01X.6Z.2F30\nM30\n"


@pytest.fixture
def ring(turndesk: Turndesk, offsets: Path, home: Path, tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(PROGRAM)
    assert turndesk("run", path, "--headless", "--offsets", offsets).status == 0
    return home / "records" / "run.ring"


def test_headless_run_saves_a_recording(turndesk: Turndesk, ring: Path) -> None:
    (told,) = turndesk("scope", ring, "--json").lines
    assert (told["file"], told["rate"], told["csv"]) == (str(ring), 1000.0, None)
    assert told["about"]["machine"] == "GT-75"
    by_name = {each["name"]: each for each in told["channels"]}
    assert by_name["spindle speed"]["max"] == pytest.approx(600.0)
    assert by_name["Z demand"]["max"] == pytest.approx(0.2 * 25.4)
    assert (by_name["X demand"]["unit"], by_name["output coolant"]["logic"]) == ("mm", True)
    shown = turndesk("scope", ring)
    assert shown.status == 0
    assert "machine: GT-75" in shown.out
    assert "spindle speed" in shown.out


def test_recording_samples_are_written_to_file_or_stdout(
    turndesk: Turndesk, ring: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out.csv"
    assert turndesk("scope", ring, "--csv", out).status == 0
    assert turndesk("scope", ring, "--csv").out == out.read_text()
    assert turndesk("scope", ring, "--csv", "-").out == out.read_text()
    (told,) = turndesk("scope", ring, "--json", "--csv", out).lines
    rows = list(csv.DictReader(out.read_text().splitlines()))
    assert len(rows) == told["samples"]
    assert float(rows[-1]["t [s]"]) == pytest.approx(told["seconds"], abs=1e-6)
    assert float(rows[-1]["X demand [mm]"]) == 0.6 * 25.4


def test_json_and_csv_cannot_both_use_stdout(turndesk: Turndesk, ring: Path) -> None:
    told = turndesk("scope", ring, "--json", "--csv")
    assert (told.status, told.out) == (2, "")
    assert told.code == "json-needs-file"


@pytest.mark.parametrize("text", ["", "G01X1\n"])
def test_file_that_is_not_a_recording_is_rejected(turndesk: Turndesk, tmp_path: Path, text: str) -> None:
    path = tmp_path / "part.nc"
    path.write_text(text)
    told = turndesk("scope", path)
    assert (told.status, told.out) == (2, "")
    assert told.code == "not-a-record"
    assert str(path) in told.err
    assert turndesk("scope", tmp_path / "gone.scope").status == 2


def test_missing_csv_folder_is_reported(turndesk: Turndesk, ring: Path, tmp_path: Path) -> None:
    told = turndesk("scope", ring, "--csv", tmp_path / "no" / "out.csv")
    assert told.status == 2
    assert "out.csv" in told.err
