"""``turndesk machine check``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.cli.machine_command import format_check_table, summarize_names
from app.cli.main import main
from app.compose.backends import machine_check, simulated_backend
from app.compose.backends.backend_entry import FAILED_STATES, Backend, MachineCheckRow, find_backend
from app.compose.control.process_rights_check import ProcessRight
from app.compose.machine.machine_files import load_shipped_machine
from drivers.simulated.simulated_machine import SimIO

Captured = pytest.CaptureFixture[str]


def test_shipped_lathe_is_valid_and_its_ports_respond(capsys: Captured) -> None:
    assert main(["machine", "check"]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    first, second, *rights = told.out.splitlines()
    assert rights[0].startswith("  computer: real-time priority: ")
    assert first.startswith("gt75.toml is valid: GT-75")
    assert second.endswith(": X, Z, C, spindle, station, 25 inputs, 14 outputs")


@pytest.mark.parametrize("missing", ["", "other programs can delay the control"])
def test_machine_check_prints_each_right_and_its_remedy(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch, missing: str
) -> None:
    rights = (ProcessRight("real-time priority", "no" if missing else "SCHED_RR 40", missing),)
    monkeypatch.setattr(machine_check, "check_rights", lambda: rights)
    assert main(["machine", "check"]) == 0
    lines = capsys.readouterr().out.splitlines()[2:]
    assert lines == (
        ["  computer: real-time priority: no", "    other programs can delay the control"]
        if missing
        else ["  computer: real-time priority: SCHED_RR 40"]
    )


def test_machine_check_json_lists_every_drive_and_input(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(resources.read_machine_file("gt75.toml").replace("GT-75", "OWN", 2))
    assert main(["machine", "check", str(path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["file"], report["errors"]) == (str(path), [])
    ports = {port.pop("name"): port for port in report["ports"]}
    assert len(ports) == 44
    assert {port["state"] for port in ports.values()} == {"not checked"}
    assert {port["verdict"] for port in ports.values()} == {"not checked"}
    assert ports["X"]["detail"] == "homed, at 0 in"
    assert (ports["input collet_closed"]["at"], ports["input collet_closed"]["detail"]) == ("IN-5", "on")


def test_each_mistake_in_machine_file_is_one_line(capsys: Captured, tmp_path: Path) -> None:
    text = resources.read_machine_file("gt75.toml").replace("amax = 120", "amax = 0", 1)
    path = tmp_path / "bad.toml"
    path.write_text(text.replace("lease_ms", "leese_ms"))
    assert main(["machine", "check", str(path)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    lines = told.err.splitlines()
    assert len(lines) == 3  # amax, the unknown key, the missing one
    assert any("machine.leese_ms: unknown key; did you mean lease_ms?" in line for line in lines)
    assert any("axis.X.amax = 0: expected a number" in line for line in lines)


def test_mistakes_in_machine_file_are_listed_in_json(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(resources.read_machine_file("gt75.toml") + "\n[profibus]\nbaud = 9600\n")
    assert main(["machine", "check", str(path), "--json"]) == 2
    report = json.loads(capsys.readouterr().out)
    assert [error["path"] for error in report["errors"]] == ["[profibus]"]
    assert report["ports"] == []


def test_unreadable_machine_file_is_reported(capsys: Captured, tmp_path: Path) -> None:
    assert main(["machine", "check", str(tmp_path / "none.toml")]) == 2
    assert "No such file" in capsys.readouterr().err


def test_the_table_fits_a_terminal() -> None:
    rows = [
        ("node X", "1", "ok", "CiA 402, " + "vendor 0000015Ah, " * 5),
        ("input a", "401.6000.1.0", "on", ""),
    ]
    lines = list(format_check_table(rows))
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith("  node X   1             ok  CiA 402, vendor")
    assert lines[1].startswith(" " * 29 + "vendor") or lines[1].startswith(" " * 29 + "0000015Ah")
    assert lines[-1] == "  input a  401.6000.1.0  on"


def board(monkeypatch: pytest.MonkeyPatch, *measured: str) -> None:
    """Replace the simulated backend by a real one, whose hardware reports these rows."""
    backend = Backend(
        "board", connect=simulated_backend.BACKEND.connect, list_measured_row_names=lambda _machine: measured
    )
    monkeypatch.setattr(simulated_backend, "BACKEND", backend)


def test_machine_check_table_shows_only_measured_rows(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    board(monkeypatch, "board", "X", "input end_of_bar", "no such row")
    assert main(["machine", "check"]) == 0
    told = [line.split() for line in capsys.readouterr().out.splitlines()[1:]]
    *lines, last = [words for words in told if words[0] in {"ok", "not"}]
    assert lines == [
        ["ok", "board", "ok"],
        ["ok", "X", "ok", "homed,", "at", "0", "in"],
        ["ok", "input", "end_of_bar", "IN-6", "off"],
    ]
    assert last[-8:] == ["Z,", "C,", "spindle,", "station,", "24", "inputs,", "14", "outputs"]


def test_driver_without_a_connection_is_reported_as_not_checked(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    board(monkeypatch)
    assert main(["machine", "check", "--json"]) == 0
    ports = json.loads(capsys.readouterr().out)["ports"]
    assert {port["verdict"] for port in ports} == {"not checked"}


@pytest.mark.parametrize("state", FAILED_STATES)
def test_failed_row_remains_failed_if_nothing_was_measured(state: str) -> None:
    row = MachineCheckRow("X", "", state, "why").mark_unchecked(())
    assert (row.result_text, row.state, row.detail) == ("FAIL", state, "why")


@pytest.mark.parametrize(
    ("name", "measured"),
    [
        ("gt75", set()),
        ("gt75-vfd", set()),
        ("gt75-hal", set()),
        ("gt75-parport", {"spindle"}),
        ("gt75-mesa-7i76e", {"spindle", "station"}),
        ("gt75-mesa-7i97", {"X", "Z", "spindle", "station"}),
        ("gt75-ethercat", {"X", "Z", "spindle", "station"}),
        ("gt75-canopen", {"X", "Z", "spindle", "station"}),
        ("gt75-grblhal", {"controller", "spindle"}),
    ],
)
def test_only_ports_with_feedback_are_listed_as_measured(name: str, measured: set[str]) -> None:
    machine = load_shipped_machine(name)
    rows = set(find_backend(machine).list_measured_row_names(machine))
    inputs = {f"input {each}" for each in machine.inputs} if measured else set()
    assert rows == measured | inputs


def test_summary_counts_terminals_and_names_a_single_one() -> None:
    assert summarize_names(["X", "input estop", "output a", "output b"]) == "X, input estop, 2 outputs"
    assert summarize_names([]) == ""


def test_unreachable_inverter_has_its_row(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(
        resources.read_machine_file("gt75-vfd.toml").replace("/dev/ttyUSB1", str(tmp_path / "none"))
    )
    assert main(["machine", "check", str(path), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert [(port["name"], port["state"]) for port in report["ports"]] == [("spindle", "no answer")]
    assert "cannot be opened" in report["trouble"][0]


def test_input_that_the_machine_does_not_have_fails_the_check(
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
