"""The command line against the simulator on a pseudo terminal and on TCP, in real time."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli.main import main
from core.ports import DriverError
from drivers.grblhal.grblhal_transport import open_transport, parse_tcp_address
from drivers.simulators.grblhal_connections import PtyConnection, TcpConnection, run_simulator
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import ConnectionAttempt, RealClock
from tests.coded import raises_code
from tests.drivers.grblhal.bench import SHIPPED
from tests.drivers.ptys import open_pty

Captured = pytest.CaptureFixture[str]


@pytest.fixture(params=["pty", "tcp"])
def machine_file(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Path]:
    """A machine file whose controller answers."""
    if request.param == "pty":
        for handle in open_pty():
            os.close(handle)
    end: PtyConnection | TcpConnection = (
        PtyConnection() if request.param == "pty" else TcpConnection("127.0.0.1", 0)
    )
    over = threading.Event()
    peer = threading.Thread(
        target=run_simulator, args=(end, GrblFirmware(RealClock()), lambda: not over.is_set())
    )
    peer.start()
    file = tmp_path / "grblhal.toml"
    file.write_text(SHIPPED.replace("/dev/ttyACM0", end.device_name), encoding="utf-8")
    yield file
    over.set()
    peer.join(60.0)
    assert not peer.is_alive()


def test_machine_check_and_run_succeed_over_the_connection(
    machine_file: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    assert main(["machine", "check", "--json", str(machine_file)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["backend"] == "grblhal"
    (x,) = [row for row in told["ports"] if row["name"] == "X"]
    assert (x["state"], x["detail"]) == ("not checked", "homed, at 0 in")  # a step drive reports nothing
    program = tmp_path / "part.nc"
    program.write_text("G90G94F300\nX.1Z.1\nG01X.05F60\nM08\nM30\n", encoding="utf-8")
    assert main(["run", str(program), "--headless", "--json", "--machine", str(machine_file)]) == 0
    outcome = json.loads(capsys.readouterr().out)
    assert outcome["state"] == "complete"
    assert (outcome["final"]["x"], outcome["final"]["z"]) == pytest.approx((0.05, 0.1))


def test_missing_controller_is_reported_in_one_line(tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "grblhal.toml"
    file.write_text(SHIPPED.replace("/dev/ttyACM0", "/dev/nothing-here"), encoding="utf-8")
    assert main(["machine", "check", str(file)]) == 1
    assert "/dev/nothing-here" in capsys.readouterr().err


@pytest.mark.parametrize("port", ["tcp://127.0.0.1", "tcp://:23", "tcp://host:a"])
def test_a_bad_address_is_refused(port: str) -> None:
    with raises_code(DriverError, "driver", port, "tcp://host:port"):
        open_transport(port, 115_200)


@pytest.mark.parametrize(
    ("port", "reason"),
    [
        ("tcp://127.0.0.1:65536", "bad-port"),
        ("socket://127.0.0.1:70000/", "bad-port"),
        ("tcp://127.0.0.1:9999999999", "bad-address"),
        (f"tcp://{'a' * 70}:80", "bad-host"),  # a label has at most 63 characters
    ],
)
def test_address_that_no_computer_can_have_is_rejected(port: str, reason: str) -> None:
    with raises_code(DriverError, "driver") as told:
        open_transport(port, 115_200)
    assert told.value.reason == reason


def test_largest_port_number_is_accepted() -> None:
    assert parse_tcp_address("tcp://[::1]:65535") == ("::1", 65535)
    assert parse_tcp_address("/dev/ttyACM0") is None


@pytest.mark.parametrize("error", [OSError(12, "Cannot allocate memory"), DriverError("no such device")])
def test_connection_that_cannot_be_reopened_is_reported(error: Exception) -> None:
    def fail() -> None:
        raise error

    with raises_code(DriverError, "driver", error.args[-1]):
        ConnectionAttempt(fail, synchronous=True).take_connection()
