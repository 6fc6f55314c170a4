"""``turndesk machine accept``, and what a changed machine file means to ``check`` and ``run``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.cli.main import main

Captured = pytest.CaptureFixture[str]
PROGRAM = "G90G94F200\nT1\nX.5Z0\nM30\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    (tmp_path / "part.nc").write_text(PROGRAM)
    (tmp_path / "offsets.toml").write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
    return tmp_path


def machine_file(folder: Path, shipped: str = "gt75.toml", **changes: str) -> str:
    text = resources.read_machine_file(shipped)
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "own.toml"
    path.write_text(text)
    return str(path)


def run(folder: Path, machine: str) -> int:
    words = ["run", str(folder / "part.nc"), "--headless", "--machine", machine]
    return main([*words, "--offsets", str(folder / "offsets.toml"), "--json"])


def test_machine_file_never_accepted_runs_without_change_warning(folder: Path, capsys: Captured) -> None:
    path = machine_file(folder)
    assert run(folder, path) == 0
    machine_file(folder, **{"seed = 1": "seed = 2"})
    assert run(folder, path) == 0
    assert "changed" not in capsys.readouterr().err


def test_change_after_acceptance_is_shown_by_check_and_run(folder: Path, capsys: Captured) -> None:
    path = machine_file(folder)
    assert main(["machine", "accept", path]) == 0
    assert "this file was never accepted before" in capsys.readouterr().out
    machine_file(folder, **{"vmax = 300": "vmax = 280", "max_feed = 300": "max_feed = 250"})
    assert main(["machine", "check", path]) == 0
    assert "changed since it was accepted: axis.X.vmax: 300 → 280" in capsys.readouterr().out
    assert main(["machine", "check", path, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["changes"][0] == {"path": "limits.max_feed", "old": "300", "new": "250"}
    assert run(folder, path) == 0  # simulated: told, and run all the same
    told = capsys.readouterr()
    assert "has changed: axis.X.vmax: 300 → 280" in told.err
    assert json.loads(told.out.splitlines()[-1])["state"] == "complete"
    assert main(["machine", "accept", path]) == 0
    assert "  limits.max_feed: 300 → 250" in capsys.readouterr().out
    assert run(folder, path) == 0
    assert "changed" not in capsys.readouterr().err


def test_real_machine_does_not_run_until_changes_are_accepted(folder: Path, capsys: Captured) -> None:
    path = machine_file(folder, "gt75-vfd.toml")
    assert main(["machine", "accept", path]) == 0
    machine_file(folder, "gt75-vfd.toml", **{"rpm = [50, 3500]": "rpm = [50, 3400]"})
    capsys.readouterr()
    assert run(folder, path) == 2
    told = capsys.readouterr().err
    assert "spindle.rpm: [50, 3500] → [50, 3400]" in told
    assert f"turndesk machine accept {path}" in told


def test_a_bad_file_is_not_accepted(folder: Path, capsys: Captured) -> None:
    path = machine_file(folder, **{"vmax = 300": "vmax = 0"})
    assert main(["machine", "accept", path]) == 2
    assert "axis.X.vmax = 0" in capsys.readouterr().err
