"""``turndesk run`` on slides that do not know where they are, and on the machine of the specification."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.cli.main import main
from tests.machine.spoil import spec_text

Captured = pytest.CaptureFixture[str]


def run(tmp_path: Path, machine: str) -> int:
    (tmp_path / "part.nc").write_text("G90G94F200\nT1\nX.5Z0\nG01X.4Z-.2F60\nX.5\nZ0\nM30\n")
    (tmp_path / "offsets.toml").write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
    (tmp_path / "own.toml").write_text(machine)
    words = ["run", str(tmp_path / "part.nc"), "--headless", "--machine", str(tmp_path / "own.toml")]
    return main([*words, "--offsets", str(tmp_path / "offsets.toml"), "--json"])


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))


def test_unhomed_axes_are_homed_before_the_run_and_reported(tmp_path: Path, capsys: Captured) -> None:
    text = resources.read_machine_file("gt75.toml")
    text = text.replace("absolute = true ", "home = { order = 2, speed = 60 }  # X goes last:", 1)
    text = text.replace("absolute = true\n", "home = { order = 1, speed = 60 }\n", 1)
    assert run(tmp_path, text) == 0
    told = capsys.readouterr()
    assert "homing X, Z" in told.err
    assert json.loads(told.out.splitlines()[-1])["final"]["x"] == pytest.approx(0.5)


def test_homed_axes_are_not_homed_again(tmp_path: Path, capsys: Captured) -> None:
    assert run(tmp_path, resources.read_machine_file("gt75.toml")) == 0
    assert "homing" not in capsys.readouterr().err


def test_a_program_runs_on_the_machine_of_the_specification(tmp_path: Path, capsys: Captured) -> None:
    assert run(tmp_path, spec_text().replace("realtime = true", "realtime = false")) == 0
    told = capsys.readouterr()
    outcome = json.loads(told.out.splitlines()[-1])
    assert outcome["state"] == "complete"
    assert (outcome["underruns"], outcome["alarms"]) == (0, [])
    assert outcome["final"] == {"x": pytest.approx(0.5), "z": pytest.approx(0.0), "c": 0.0}
    # its window is .04 in; the simulated drive lags a tenth of v · 7.96 ms: .004 in at 300 in/min
    assert outcome["max_following_error"] < 0.02
