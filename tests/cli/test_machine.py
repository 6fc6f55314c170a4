"""``turndesk machine check``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.cli.machine_command import table
from app.cli.main import main
from drivers.simulated.simulated_machine import SimIO

Captured = pytest.CaptureFixture[str]


def test_shipped_lathe_is_good_and_answers(capsys: Captured) -> None:
    assert main(["machine", "check"]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    assert "gt75.toml is valid: GT-75" in told.out
    for name in ("X", "Z", "C", "spindle", "input TB2-5", "input 16"):
        assert f"  {name} " in told.out


def test_json_has_every_drive_and_input(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(resources.machine_file("gt75.toml").replace("GT-75", "OWN", 2))
    assert main(["machine", "check", str(path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["file"], report["errors"]) == (str(path), [])
    states = {port["name"]: port["state"] for port in report["ports"]}
    assert states["X"] == "ok"
    assert states["input collet_closed"] == "on"


def test_every_mistake_is_a_line(capsys: Captured, tmp_path: Path) -> None:
    text = resources.machine_file("gt75.toml").replace("amax = 120", "amax = 0", 1)
    path = tmp_path / "bad.toml"
    path.write_text(text.replace("lease_ms", "leese_ms"))
    assert main(["machine", "check", str(path)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    lines = told.err.splitlines()
    assert len(lines) == 3  # amax, the unknown key, the missing one
    assert any("machine.leese_ms: unknown key; did you mean lease_ms?" in line for line in lines)
    assert any("axis.X.amax = 0: expected a number" in line for line in lines)


def test_mistakes_as_json(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(resources.machine_file("gt75.toml") + "\n[profibus]\nbaud = 9600\n")
    assert main(["machine", "check", str(path), "--json"]) == 2
    report = json.loads(capsys.readouterr().out)
    assert [error["path"] for error in report["errors"]] == ["[profibus]"]
    assert report["ports"] == []


def test_unreadable_file_is_told(capsys: Captured, tmp_path: Path) -> None:
    assert main(["machine", "check", str(tmp_path / "none.toml")]) == 2
    assert "No such file" in capsys.readouterr().err


def test_the_table_fits_a_terminal() -> None:
    rows = [
        ("node X", "1", "ok", "CiA 402, " + "vendor 0000015Ah, " * 5),
        ("input a", "401.6000.1.0", "on", ""),
    ]
    lines = list(table(rows))
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith("  node X   1             ok  CiA 402, vendor")
    assert lines[1].startswith(" " * 29 + "vendor") or lines[1].startswith(" " * 29 + "0000015Ah")
    assert lines[-1] == "  input a  401.6000.1.0  on"


def test_terminals_positions_and_outputs_are_in_the_table(capsys: Captured) -> None:
    assert main(["machine", "check"]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["ok", "X", "ok", "homed,", "at", "0", "in"] in lines
    assert ["ok", "output", "collet", "OUT-2", "on"] in lines
    assert ["ok", "input", "end_of_bar", "IN-6", "off"] in lines


def test_an_inverter_that_is_not_there_has_its_row(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(resources.machine_file("gt75-vfd.toml").replace("/dev/ttyUSB1", str(tmp_path / "none")))
    assert main(["machine", "check", str(path), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert [(port["name"], port["state"]) for port in report["ports"]] == [("spindle", "no answer")]
    assert "cannot be opened" in report["trouble"][0]


def test_an_input_that_the_machine_does_not_have_is_trouble(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = SimIO.inputs
    monkeypatch.setattr(
        SimIO, "inputs", lambda io: {name: on for name, on in there(io).items() if name != "guard"}
    )
    assert main(["machine", "check"]) == 1
    told = capsys.readouterr()
    assert "turndesk: gt75.toml: input guard: missing; the machine does not have this terminal" in told.err
    lines = [line.split() for line in told.out.splitlines()]
    assert ["FAIL", "input", "guard", "IN-4", "missing"] in [line[:5] for line in lines]
