"""kill -9, with real processes and real drives' reactions: what stops, what stays."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from drivers.simulators.canopen_devices import CanopenDevices
from tests.drivers.driver_host.bus import SteadyClock, bus_file, peers_on

pytestmark = pytest.mark.real_time
END = 20.0 * 1.42  # mm at which the path ends


@dataclass
class Shop:
    """The drives here, the control and its driver host in processes of their own."""

    peers: CanopenDevices
    clock: SteadyClock
    control: subprocess.Popen[bytes]
    host: int = 0
    lines: list[dict[str, object]] = field(default_factory=list)

    def until(self, ready: Callable[[], bool]) -> None:
        """Play the drives until ``ready``."""
        began = time.monotonic()
        while not ready():
            assert time.monotonic() < began + self.clock.patience, (
                self.x,
                self.peers.plant.axis_drives["X"].power_states.state,
                self.lines,
            )
            while self.clock.step():
                self.peers.process_frames()
            self.peers.process_frames(0.001)
            self._listen()

    def play(self, seconds: float) -> None:
        """Play the drives for so long."""
        end = self.clock.now() + seconds
        self.until(lambda: self.clock.now() >= end)

    @property
    def x(self) -> float:
        return self.peers.plant.axis_drives["X"].setpoint_position

    def _listen(self) -> None:
        out = self.control.stdout
        assert out is not None
        if select.select([out], [], [], 0.0)[0] and (line := out.readline()):
            self.lines.append(json.loads(line))


@pytest.fixture
def shop(tmp_path: Path) -> Iterator[Shop]:
    """X and Z on their way, at a third of it; spindle and coolant on."""
    path = bus_file(tmp_path)
    clock = SteadyClock()
    peers = peers_on(path, clock)
    words = [sys.executable, "-m", "tests.drivers.driver_host.control", str(path)]
    control = subprocess.Popen(words, stdout=subprocess.PIPE)
    made = Shop(peers, clock, control)
    try:
        made.until(lambda: bool(made.lines))
        made.host = int(str(made.lines[0]["feeder"]))
        made.until(lambda: made.x > 5.0)
        yield made
    finally:
        for pid in (control.pid, made.host):
            if pid and _alive(pid):
                with suppress(ProcessLookupError):  # a driver host without a control ends by itself
                    os.kill(pid, signal.SIGKILL)
        control.wait()
        assert control.stdout is not None
        control.stdout.close()
        peers.close()


def _alive(pid: int) -> bool:
    """Not ended, and no zombie either."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_killed_control_leaves_axes_that_stop_on_their_path(shop: Shop) -> None:
    drives, board = shop.peers.plant.axis_drives, shop.peers.plant.terminals
    off: list[float] = []
    os.kill(shop.control.pid, signal.SIGKILL)
    while _alive(shop.host):
        shop.play(0.02)
        off.append(abs(drives["X"].setpoint_position - drives["Z"].setpoint_position))
    assert max(off) < 0.01  # on the diagonal all the way: both drives together
    assert shop.x == pytest.approx(END, abs=0.01)  # to the end of what was queued
    shop.until(lambda: not drives["X"].power_states.is_powered)  # an orphan takes the power too
    shop.play(2.0)
    assert not board.output_states["coolant"]
    assert board.output_states["collet"]
    shop.until(lambda: abs(shop.peers.machine.get_spindle_rpm()) < 1.0)


def test_killed_driver_host_leaves_the_drives_to_stop_the_axes(shop: Shop) -> None:
    drives, board = shop.peers.plant.axis_drives, shop.peers.plant.terminals
    before = shop.x
    os.kill(shop.host, signal.SIGKILL)
    shop.until(lambda: not drives["X"].power_states.is_powered and not drives["Z"].power_states.is_powered)
    # 160 ms in the drives' queues, then v²/2a: less than 5 mm
    assert shop.x - before < 6.0
    assert shop.x < END - 5.0
    shop.until(lambda: not board.output_states["coolant"])  # three heartbeats
    assert board.output_states["collet"]
    shop.until(lambda: abs(shop.peers.machine.get_spindle_rpm()) < 1.0)
    shop.until(lambda: len(shop.lines) > 1)
    assert shop.lines[1]["code"] == "feeder-gone"


def test_suspended_driver_host_gives_no_sign_of_life(shop: Shop) -> None:
    """SIGSTOP: the process is there and does nothing. Its heartbeat must not go on."""
    drives, board = shop.peers.plant.axis_drives, shop.peers.plant.terminals
    os.kill(shop.host, signal.SIGSTOP)
    shop.until(lambda: not drives["X"].power_states.is_powered and not drives["Z"].power_states.is_powered)
    shop.until(lambda: not board.output_states["coolant"])
    shop.until(lambda: len(shop.lines) > 1)
    assert shop.lines[1]["code"] == "feeder-silent"
