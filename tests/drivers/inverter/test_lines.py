"""The whole way: machine file, pyserial, a pty, and at its end a pymodbus server or a scripted Huanyang."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest

import resources
from app.cli.main import main
from app.compose.backends.backend_entry import ConnectedMachine
from app.compose.backends.connection import connect_machine
from app.compose.backends.machine_check import check_machine
from app.compose.machine.machine_files import load_machine
from core.faults import get_fault_code
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.inverter.command_monitor import PRESS_ESTOP_TEXT
from drivers.wakeups import ManualClock, RealClock
from tests.coded import raises_code
from tests.drivers.inverter.benches import FAMILIES, FOLDER, OWN, memory_of
from tests.drivers.inverter.inverter_simulators import HuanyangSlave, Inverter
from tests.drivers.inverter.lines import HuanyangEnd, ModbusServer, Pair, inverter, until
from tests.late_computer import stalls_told
from tests.texts import text

pytestmark = pytest.mark.real_time  # an inverter that answers late is one that does not answer


@dataclass
class Wired:
    """A machine file whose inverter hangs on a pty."""

    machine: Machine
    path: Path
    cable: Pair
    inverter: Inverter


def machine_file(folder: Path, family: str, port: str) -> Path:
    """The shipped sample with this inverter, and next to it the file of the invented one."""
    shutil.copy(FOLDER / OWN, folder)
    text = resources.read_machine_file("gt75-vfd.toml")
    text = text.replace(
        'family = "delta-vfdb", port = "/dev/ttyUSB1"', f'family = "{family}", port = "{port}"'
    )
    path = folder / "own.toml"
    path.write_text(text)
    return path


@pytest.fixture(params=FAMILIES)
def wired(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Wired]:
    """Each family at the end of its line."""
    one = inverter()
    with ExitStack() as stack:
        stack.enter_context(stalls_told())
        cable = stack.enter_context(Pair())
        if request.param == "huanyang":
            stack.enter_context(HuanyangEnd(cable.far, HuanyangSlave(one)))
        else:
            stack.enter_context(ModbusServer(cable.far, memory_of(request.param, one)))
        path = machine_file(tmp_path, request.param, cable.near)
        yield Wired(load_machine(path), path, cable, one)


@pytest.fixture
def connected(wired: Wired) -> Iterator[ConnectedMachine]:
    """Its ports."""
    made = connect_machine(wired.machine, RealClock())
    yield made
    made.close()


def test_spindle_turns_reverses_and_stops_over_a_serial_line(
    connected: ConnectedMachine, wired: Wired
) -> None:
    spindle = connected.ports.spindle
    spindle.set_speed(-600.0)
    until(lambda: abs(spindle.speed() + 600.0) < 2.0, "600 rpm back")
    assert wired.inverter.motor.speed == pytest.approx(-600.0, abs=2.0)
    spindle.set_speed(0.0)
    until(lambda: spindle.speed() == 0.0, "standstill")
    assert spindle.read_fault() == ""


def test_ignored_stop_asks_the_operator_for_the_estop(connected: ConnectedMachine, wired: Wired) -> None:
    spindle = connected.ports.spindle
    spindle.set_speed(900.0)
    until(lambda: spindle.speed() > 800.0, "900 rpm")
    wired.inverter.deaf = True
    spindle.set_speed(0.0)
    until(lambda: spindle.read_fault() != "", "a fault")
    assert get_fault_code(spindle.read_fault(), "driver") == "ignores-stop"
    assert PRESS_ESTOP_TEXT in spindle.read_fault()


def test_disconnected_cable_is_a_fault_again_after_clearing(
    connected: ConnectedMachine, wired: Wired
) -> None:
    spindle = connected.ports.spindle
    spindle.set_speed(900.0)
    until(lambda: spindle.speed() > 800.0, "900 rpm")
    wired.cable.cut()
    until(lambda: spindle.read_fault() != "", "a fault")
    assert get_fault_code(spindle.read_fault(), "driver") == "inverter-silent"
    assert PRESS_ESTOP_TEXT in spindle.read_fault()
    connected.ports.axes.clear_fault()
    until(lambda: spindle.read_fault() != "", "the fault again")


def test_spindle_starts_after_silence_ends_and_the_fault_is_cleared(
    connected: ConnectedMachine, wired: Wired
) -> None:
    spindle = connected.ports.spindle
    wired.cable.silent = True
    until(lambda: spindle.read_fault() != "", "a fault")
    wired.cable.silent = False

    def turns() -> bool:
        connected.ports.axes.clear_fault()
        try:
            spindle.set_speed(300.0)
        except DriverError:
            return False
        return True

    until(turns, "it takes a speed")
    until(lambda: abs(spindle.speed() - 300.0) < 2.0, "300 rpm")


def test_estop_prevents_a_spindle_start(connected: ConnectedMachine) -> None:
    assert connected.on_screen_station is not None
    connected.on_screen_station.press_estop()
    with raises_code(DriverError, "spindle-off", "E-stop"):
        connected.ports.spindle.set_speed(100.0)
    connected.ports.spindle.set_speed(0.0)


def test_machine_check_reads_the_inverter_and_leaves_it_stopped(
    wired: Wired, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["machine", "check", str(wired.path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    ports = {port["name"]: port for port in report["ports"]}
    spindle = ports.pop("spindle")
    assert spindle["state"] == spindle["verdict"] == "ok"
    assert {port["verdict"] for port in ports.values()} == {"not checked"}
    assert spindle["detail"].startswith("0 rpm, ")
    assert "0.00 Hz" in spindle["detail"]
    assert any("encoder" in warning for warning in report["warnings"])
    assert wired.inverter.stops > 0
    assert not wired.inverter.running


def test_driver_host_stops_the_inverter_when_the_control_is_gone(wired: Wired) -> None:
    """The process that owns the drivers owns the inverter too: it stops it when the control is gone."""
    path = wired.path
    path.write_text(path.read_text().replace('backend = "sim"', 'backend = "sim"\nfeeder = true'))
    made = connect_machine(load_machine(path), RealClock())
    try:
        spindle = made.ports.spindle
        spindle.set_speed(500.0)
        until(lambda: abs(spindle.speed() - 500.0) < 2.0, "500 rpm")
    finally:
        made.close()
    until(lambda: not wired.inverter.running, "stopped by the driver host")


def test_missing_port_is_reported_in_one_line(tmp_path: Path) -> None:
    path = machine_file(tmp_path, "huanyang", "/dev/ttyNONE7")
    answers = check_machine(load_machine(path))
    assert [(row.name, row.state) for row in answers.rows] == [("spindle", text("shopfloor.no-answer"))]
    (told,) = answers.faults
    assert "huanyang" in told
    assert "/dev/ttyNONE7" in told


def test_manual_clock_is_rejected(tmp_path: Path) -> None:
    machine = load_machine(machine_file(tmp_path, "huanyang", "/dev/ttyNONE7"))
    with raises_code(DriverError, "driver", "real time"):
        connect_machine(machine, ManualClock())
