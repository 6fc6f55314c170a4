"""``turndesk machine check`` and ``run`` on a machine with a bus, and what they say without one."""

from __future__ import annotations

import builtins
import json
import sys
from pathlib import Path

import pytest

import resources
from app.cli.main import main
from core.message import CodedError

Captured = pytest.CaptureFixture[str]
CAN = resources.read_machine_file("gt75-canopen.toml")


def virtual(tmp_path: Path, **changes: str) -> Path:
    """The shipped bus within this process, with slides that know where they are."""
    text = CAN.replace('interface = "socketcan"', 'interface = "virtual"')
    text = text.replace('channel = "can0"', f'channel = "{tmp_path.name}"')
    for old, new in changes.items():
        text = text.replace(old, new)
    path = tmp_path / "bus.toml"
    path.write_text(text)
    return path


def test_every_drive_and_input_on_the_bus_responds(capsys: Captured, tmp_path: Path) -> None:
    path = virtual(tmp_path)
    assert main(["machine", "check", str(path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    ports = {port["name"]: port["detail"] for port in report["ports"]}
    assert report["backend"] == "canopen"
    assert ports["X"] == "not homed, at 0 in"
    assert ports["spindle"] == "0 rpm"
    assert ports["input collet_closed"] == ports["input guard"] == "on"
    assert {port["verdict"] for port in report["ports"]} == {"not checked"}  # the bus is in this process


def test_missing_bus_is_reported_in_one_line(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "shop.toml"
    path.write_text(CAN.replace('channel = "can0"', 'channel = "can77"'))
    assert main(["machine", "check", str(path)]) == 1
    told = capsys.readouterr().err
    assert "CAN interface socketcan, channel can77" in told
    assert "ip link set can77 up" in told
    assert "Traceback" not in told


def test_missing_drive_is_reported_by_name(capsys: Captured, tmp_path: Path) -> None:
    path = virtual(tmp_path)
    path.write_text(path.read_text().replace("spindle = { id = 3 }", 'spindle = { id = 3, eds = "no.eds" }'))
    assert main(["machine", "check", str(path)]) == 1
    assert "spindle: the EDS file" in capsys.readouterr().err


def test_missing_canopen_library_is_reported_and_simulation_runs(
    capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = builtins.__import__

    def without(name: str, *rest: object, **more: object) -> object:
        if name.partition(".")[0] == "can":
            raise ModuleNotFoundError("No module named 'can'", name="can")
        return real(name, *rest, **more)  # type: ignore[arg-type]

    for name in [name for name in sys.modules if name.startswith("drivers.canopen.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", without)
    assert main(["machine", "check", str(virtual(tmp_path))]) == 1
    assert "needs python-can; install it with: pip install 'turndesk[canopen]'" in capsys.readouterr().err
    assert main(["machine", "check"]) == 0


def test_a_program_runs_on_the_bus(capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    part = tmp_path / "part.nc"
    part.write_text("G90G94F200\nT1\nX.5Z0\nG01X.4Z-.2F60\nX.5\nZ0\nM30\n")
    offsets = tmp_path / "offsets.toml"
    offsets.write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
    path = virtual(tmp_path, **{"absolute = false": "absolute = true"})
    words = ["run", str(part), "--headless", "--machine", str(path), "--offsets", str(offsets), "--json"]
    assert main(words) == 0, capsys.readouterr().err
    told = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert told["state"] == "complete"
    assert told["final"]["x"] == pytest.approx(0.5, abs=1e-4)
    assert told["underruns"] == 0
    assert told["alarms"] == []


def test_peer_command_is_rejected_without_a_bus(refusals: list[CodedError]) -> None:
    assert main(["machine", "peer", str(Path(resources.__file__).parent / "machines" / "gt75.toml")]) == 2
    assert [each.code for each in refusals] == ["no-peer"]
