"""kill -9 of the control while a controller with its own planner moves: ``turndesk machine peer``."""

from __future__ import annotations

import re
import select
import socket
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import resources
from tests.free_port import free_port
from tests.killed.bench import PATIENCE, Process, process, until

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc")
# 50.8 mm of X in 5.7 s
PROGRAM = "G90G94\nM03S600\nM08\nG01X2.Z2.F30\nX0.Z0.\nM30\n"


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    text = resources.read_machine_file("gt75-grblhal.toml")
    port = f"tcp://127.0.0.1:{free_port()}"
    for old, new in (("/dev/ttyACM0", port), ("two_hand_start = true", "two_hand_start = false")):
        assert old in text, old
        text = text.replace(old, new, 1)
    path = tmp_path / "grbl.toml"
    path.write_text(text)
    return path


@pytest.fixture
def controller(machine: Path, tmp_path: Path) -> Iterator[Process]:
    with process(tmp_path / "peer", "app.cli.main", "machine", "peer", str(machine)) as peer:
        assert peer.popen.stdout is not None
        assert b"grblHAL" in peer.popen.stdout.readline()
        yield peer


def report(machine: Path) -> str:
    """What the controller answers to a status request of somebody who has just connected."""
    found = re.search(r'port = "tcp://127.0.0.1:(\d+)"', machine.read_text())
    assert found is not None
    with socket.create_connection(("127.0.0.1", int(found[1])), PATIENCE) as line:
        line.sendall(b"\x87")
        text = ""
        while "\n" not in text.partition("<")[2]:
            assert select.select([line], [], [], PATIENCE)[0]
            text += line.recv(4096).decode()
    return text[text.index("<") :]


def test_controller_finishes_queued_motion_after_control_is_killed(
    controller: Process, machine: Path, tmp_path: Path
) -> None:
    program = tmp_path / "part.nc"
    program.write_text(PROGRAM)
    words = ("tests.killed.operator", str(machine), str(program))
    with process(tmp_path / "home", *words) as control:

        def moving() -> bool:
            control.listen()
            return bool(control.lines) and int(str(control.lines[-1]["x"])) >= 4

        until(moving, lambda: control.lines[-3:])
        control.kill_all()
        assert not control.family()  # nobody between the control and its controller
    said = [""]

    def rests() -> bool:
        said[0] = report(machine)
        return said[0].startswith("<Idle")

    until(rests, lambda: said)
    place = re.search(r"MPos:([-.\d]+),", said[0])
    assert place is not None
    # 0.6 s of it at 9 mm/s behind the last word, never the rest of the way; spindle and coolant stay on
    assert 4.0 < float(place[1]) < 40.0
    assert re.search(r"\|A:S\w*F", said[0])
    with process(tmp_path / "home", *words) as again:
        until(lambda: again.says("state", "RUNNING"), lambda: again.lines[-3:])
        assert again.lines[-1]["alarms"] == []
