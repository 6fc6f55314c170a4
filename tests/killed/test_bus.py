"""kill -9 of whole controls whose drives are on a bus; the drives tell what they did."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from core.store.store import Store
from drivers.simulators.canopen_devices import CanopenDevices
from drivers.wakeups import RealClock
from tests.drivers.driver_host.bus import SteadyClock, bus_file, peers_on
from tests.killed.bench import Process, process

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
SCREEN = ("tests.killed.operator", "{machine}", "{program}")
HEADLESS = ("app.cli.main", "run", "{program}", "--headless", "--json", "--machine", "{machine}")
# X and Z together on a diagonal, out and back: wherever it is cut, both have gone as far.
PROGRAM = "G90G94\nM03S600\nM08\nG01X1.Z1.F30\nX0.Z0.\nX1.Z1.\nX0.Z0.\nM30\n"
ONE_BUTTON = ("two_hand_start = true", "two_hand_start = false")


@dataclass
class Shop:
    """The machine's end of the bus."""

    peers: CanopenDevices
    clock: SteadyClock

    def until(self, ready: Callable[[], bool], what: Callable[[], object]) -> None:
        """Play the drives until it is so."""
        deadline = RealClock()
        while not ready():
            assert deadline.now() < self.clock.patience, what()
            while self.clock.step():
                self.peers.process_frames()
            self.peers.process_frames(0.001)

    @property
    def place(self) -> tuple[float, float]:
        drives = self.peers.plant.axis_drives
        return drives["X"].setpoint_position, drives["Z"].setpoint_position

    @property
    def powered(self) -> bool:
        return any(drive.power_states.is_powered for drive in self.peers.plant.axis_drives.values())


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    return bus_file(tmp_path, ONE_BUTTON)


@pytest.fixture
def shop(machine: Path) -> Iterator[Shop]:
    clock = SteadyClock()
    peers = peers_on(machine, clock)
    yield Shop(peers, clock)
    peers.close()


def words(command: tuple[str, ...], machine: Path, folder: Path) -> list[str]:
    program = folder / "part.nc"
    program.write_text(PROGRAM)
    return [word.format(machine=machine, program=program) for word in command]


def moving(shop: Shop, control: Process) -> None:
    """A quarter of the way, spindle and coolant on."""

    def so() -> bool:
        control.listen()
        return shop.place[0] > 6.0

    shop.until(so, lambda: (control.lines[-3:], shop.place, control.popen.poll()))
    assert shop.peers.plant.terminals.output_states["coolant"]


@pytest.mark.parametrize("command", [SCREEN, HEADLESS], ids=["screen", "headless"])
def test_killed_control_stops_on_path_with_outputs_off(
    command: tuple[str, ...], shop: Shop, machine: Path, tmp_path: Path
) -> None:
    home = tmp_path / "home"
    with process(home, *words(command, machine, tmp_path)) as control:
        moving(shop, control)
        off: list[float] = []
        if command is SCREEN:
            control.kill_all()
        else:
            control.kill()

        def gone() -> bool:
            off.append(abs(shop.place[0] - shop.place[1]))
            return not control.family()

        shop.until(gone, lambda: (control.family(), shop.place))
        shop.until(lambda: not shop.powered, lambda: shop.place)
        shop.until(
            lambda: abs(shop.peers.machine.get_spindle_rpm()) < 1.0, shop.peers.machine.get_spindle_rpm
        )
        stands = shop.place
        later = shop.clock.now() + 1.0
        shop.until(lambda: shop.clock.now() >= later, lambda: "")
    assert max(off) < 0.01  # mm off the diagonal
    assert shop.place == pytest.approx(stands, abs=1e-6)
    assert not shop.peers.plant.terminals.output_states["coolant"]
    assert shop.peers.plant.terminals.output_states["collet"]
    if command is HEADLESS:  # a job is interrupted: nothing begins over it that was not meant
        with process(home, *words(command, machine, tmp_path)) as unasked:
            shop.until(lambda: unasked.popen.poll() is not None, lambda: shop.place)
            assert unasked.popen.poll() == 2
            assert shop.place == pytest.approx(stands, abs=1e-6)
        command = (*HEADLESS, "--anew")
    with process(home, *words(command, machine, tmp_path)) as again:  # at once
        moved = shop.place[0]
        shop.until(lambda: abs(shop.place[0] - moved) > 3.0, lambda: (again.popen.poll(), shop.place))
    if command is SCREEN:
        with Store.open(home, read_only=True) as store:
            assert [run.program for run in store.runs.read_run_records()] == ["part.nc"]
