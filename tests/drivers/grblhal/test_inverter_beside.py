"""An inverter beside the controller: it turns the spindle, the controller moves and at most measures."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.backends.connection import connect_machine
from app.compose.backends.grblhal_backend import create_grblhal_config
from app.compose.machine.machine_files import load_machine, parse_machine
from core.ports import DriverError
from core.table_schema import MachineFileError
from drivers.simulators.grblhal_connections import TcpConnection, run_simulator
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.simulators.spindle_motor import SpindleFaults
from drivers.wakeups import RealClock
from tests.coded import raises_code
from tests.drivers.grblhal.bench import SHIPPED, quirky
from tests.drivers.inverter.inverter_simulators import HuanyangSlave, Inverter
from tests.drivers.inverter.lines import HuanyangEnd, Pair, inverter, until
from tests.late_computer import stalls_told

pytestmark = pytest.mark.real_time  # an inverter that answers late is one that does not answer
Captured = pytest.CaptureFixture[str]
_VFD = 'driver = "vfd"\nvfd = {{ family = "huanyang", port = "{}", comm_loss_s = 1.5, hz_per_rpm = 0.01667 }}'


class Belt:
    """The controller's encoder on a spindle that it does not turn; whatever it orders goes nowhere."""

    def __init__(self, turned: Inverter) -> None:
        self._turned = turned
        self.faults = SpindleFaults()
        self.ordered = 0.0
        self.most = 0.0  # Hz that the inverter was told

    @property
    def speed(self) -> float:
        return self._turned.motor.speed

    @property
    def revolutions(self) -> float:
        return self._turned.motor.revolutions

    def advance_to(self, now: float) -> None:  # noqa: ARG002  a motor's
        """The inverter's peer does."""
        self.most = max(self.most, self._turned.hz)

    def command_speed(self, time_s: float, rpm: float) -> None:  # noqa: ARG002  a motor's
        self.ordered = max(self.ordered, abs(rpm))


@dataclass
class Both:
    """A machine file whose controller and inverter answer."""

    path: Path
    inverter: Inverter
    firmware: GrblFirmware
    belt: Belt


@pytest.fixture(params=["encoder", "none"])
def both(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Both]:
    one = inverter()
    firmware = GrblFirmware(RealClock(), quirky(encoder=request.param == "encoder"))
    belt = Belt(one)
    firmware.spindle = belt
    end, over = TcpConnection("127.0.0.1", 0), threading.Event()
    peer = threading.Thread(target=run_simulator, args=(end, firmware, lambda: not over.is_set()))
    with ExitStack() as stack:
        stack.enter_context(stalls_told())
        cable = stack.enter_context(Pair())
        stack.enter_context(HuanyangEnd(cable.far, HuanyangSlave(one)))
        peer.start()
        path = tmp_path / "both.toml"
        text = SHIPPED.replace("/dev/ttyACM0", end.device_name)
        path.write_text(text.replace('driver = "grblhal"', _VFD.format(cable.near)), encoding="utf-8")
        yield Both(path, one, firmware, belt)
        over.set()
        peer.join(60.0)


def test_inverter_spindle_turns_both_directions_and_reports_its_speed(both: Both) -> None:
    made = connect_machine(load_machine(both.path), RealClock())
    try:
        spindle = made.ports.spindle

        def speed() -> float:
            made.ports.axes.sample()  # the driver's round
            return spindle.speed()

        spindle.set_speed(600.0)
        until(lambda: abs(speed() - 600.0) < 3.0, "600 rpm")
        spindle.set_speed(-600.0)
        early = []
        while not both.inverter.back:
            early.append(speed())
        assert all(speed > -60.0 for speed in early)
        until(lambda: abs(speed() + 600.0) < 3.0, "600 rpm back")
        assert both.inverter.motor.speed == pytest.approx(-600.0, abs=5.0)
        spindle.set_speed(0.0)
        until(lambda: speed() == 0.0, "standstill")
        assert spindle.read_fault() == ""
        assert both.belt.ordered == 0.0
        assert not [line for line in both.firmware.program.executed_lines if line.startswith(("M3", "M4"))]
    finally:
        made.close()


def test_threads_need_the_controllers_encoder(both: Both) -> None:
    made = connect_machine(load_machine(both.path), RealClock())
    try:
        assert made.ports.blocks is not None
        able = both.firmware.behavior.encoder
        assert ("thread" in made.ports.blocks.capabilities) is able
        by_frequency = [told for told in made.ports.warnings if "frequency" in told]
        assert bool(by_frequency) is not able
        assert not [told for told in made.ports.warnings if "$30" in told]
    finally:
        made.close()


def test_program_runs_with_an_inverter_spindle(
    both: Both, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    program = tmp_path / "part.nc"
    program.write_text("G90G94F300\nM03S600\nX.1Z.1\nG01X.05F60\nM05\nM30\n", encoding="utf-8")
    assert main(["run", str(program), "--headless", "--machine", str(both.path)]) == 0
    assert "complete" in capsys.readouterr().out
    assert both.inverter.stops >= 1
    assert not both.inverter.running


def test_inverter_follows_the_constant_surface_speed(
    both: Both, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """100 ft/min are 1200 in: at a radius of .2 in 1200/(2π·.2) = 955 rpm, from 382 at .5 in."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    program = tmp_path / "face.nc"
    text = "G90G94F300\nM03S380\nX.5Z.1\nG96S100\nG01X.2F10\nG04F1\nG97S380\nM05\nM30\n"
    program.write_text(text, encoding="utf-8")
    assert main(["run", str(program), "--headless", "--machine", str(both.path)]) == 0, capsys.readouterr()
    assert both.belt.most == pytest.approx(955.0 * 0.01667, rel=0.02)
    assert both.belt.ordered == 0.0


def test_missing_inverter_is_reported_in_one_line_and_controller_released(both: Both) -> None:
    text = both.path.read_text(encoding="utf-8")
    port = text.partition('family = "huanyang", port = "')[2].partition('"')[0]
    missing = parse_machine(text.replace(port, "/dev/ttyNONE7"), "missing.toml")
    with raises_code(DriverError, "driver", "huanyang", "/dev/ttyNONE7"):
        connect_machine(missing, RealClock())
    connect_machine(load_machine(both.path), RealClock()).close()


def test_other_spindle_driver_with_grblhal_is_rejected() -> None:
    text = SHIPPED.replace('driver = "grblhal"', 'driver = "cia402"')
    with pytest.raises((DriverError, MachineFileError), match=r"spindle\.driver"):
        create_grblhal_config(parse_machine(text, "bad.toml"))
