"""Simulated drives and terminals on a real bus. The user operates them by typing commands."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from core.machine.machine_model import Machine
from core.message import Message
from core.ports import Clock, DriverError
from drivers.canopen.canopen_table import CanopenTable
from drivers.driver_host.host_loop import REAL_TIME_PRIORITY, lock_host_memory, request_real_time_scheduling
from drivers.wakeups import ManualClock

if TYPE_CHECKING:
    from drivers.simulators.canopen_devices import CanopenDevices
    from drivers.simulators.plant_controls import PlantControls

# --- Operation of a simulated machine in another process, by commands typed in its terminal.


HELP_TEXT = (
    "start (palm buttons), hold, estop, release, auto on|off, feed 0…150, spindle 0…100, "
    "input NAME on|off, jam AXIS on|off, cable on|off"
)
_CHUNK = 4096


class LineReader:
    """Non-blocking reader of whole lines from a file descriptor."""

    def __init__(self, source: int) -> None:
        self._source = source
        self._open = True
        self._text = b""
        # In the background of a shell, a read would stop this process. With the signal ignored, the read
        # fails and reading ends.
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)

    def read_lines(self) -> Iterator[str]:
        """Yield the lines that were typed since the last call."""
        if self._open and select.select([self._source], [], [], 0)[0]:
            data = b""
            with contextlib.suppress(OSError):
                data = os.read(self._source, _CHUNK)
            self._open = bool(data)
            self._text += data
        while b"\n" in self._text:
            line, _, self._text = self._text.partition(b"\n")
            if words := line.decode(errors="replace").strip():
                yield words


def execute_command(command: str, devices: CanopenDevices) -> str:
    """Execute one typed command, and return the result or the error as text."""
    name, *values = command.split()
    try:
        act = _COMMANDS[name]
        act(devices, *values)
    except (KeyError, TypeError, ValueError):
        return Message("{line}: unknown command; use {help}", line=command, help=HELP_TEXT)
    except DriverError as error:
        return Message("{line}: {error}", line=command, error=error)
    return Message("{line}: done", line=command)


def _hold(peers: CanopenDevices) -> None:
    peers.machine.press_hold()
    peers.machine.release_hold()


def _on(word: str) -> bool:
    return {"on": True, "off": False}[word]


def _percent(word: str) -> float:
    return float(word) / 100.0


def _hand(act: Callable[[PlantControls, str], None]) -> Callable[[CanopenDevices, str], None]:
    return lambda peers, word: act(peers.machine, word)


def _jam(peers: CanopenDevices, axis: str, word: str) -> None:
    if axis not in peers.plant.axis_drives:
        raise DriverError(
            "drive {axis} does not exist; use one of {drives}",
            axis=axis,
            drives=", ".join(peers.plant.axis_drives),
        )
    peers.machine.jam(axis, _on(word))


_COMMANDS: dict[str, Callable[..., None]] = {
    "start": lambda peers: peers.machine.press_start(),
    "hold": _hold,
    "estop": lambda peers: peers.machine.press_estop(),
    "release": lambda peers: peers.machine.release_estop(),
    "auto": _hand(lambda hands, word: hands.set_spindle_auto(_on(word))),
    "feed": _hand(lambda hands, word: hands.set_feed_pot(_percent(word))),
    "spindle": _hand(lambda hands, word: hands.set_spindle_pot(_percent(word))),
    "input": lambda peers, name, word: peers.machine.set_input(name, _on(word)),
    "jam": _jam,
    "cable": lambda peers, word: peers.cable(is_disconnected=not _on(word)),
}

_CYCLE_S = 0.001  # s
_STEP_S = 0.005  # s, the step in which a delayed simulation catches up, frame by frame


def simulate_devices(
    machine: Machine,
    should_continue: Callable[[], bool],
    print_line: Callable[[str], None],
    read_lines: Callable[[], Iterable[str]],
    create_devices: Callable[[Machine, Clock], CanopenDevices],
) -> None:
    """Simulate the devices on the machine file's bus while ``should_continue`` returns True.

    ``print_line`` outputs messages, and ``read_lines`` returns typed lines. Raises DriverError if the bus
    cannot be opened, or if its interface works only within one process.
    """
    can = machine.hardware.find_driver_table(CanopenTable)
    assert can is not None  # checked by a rule of the machine file
    if not can.supports_separate_process:
        raise DriverError(
            "the CAN interface virtual works only within a single process that also simulates "
            "the drives; use udp_multicast"
        )
    clock, zero, epoch = ManualClock(), time.monotonic(), time.time()
    peers = create_devices(machine, clock)
    lock_host_memory()
    # drives respond on time; if priority is refused, the driver host has already reported it
    request_real_time_scheduling(REAL_TIME_PRIORITY - 10)
    peers.convert_arrival_time = lambda stamp: stamp - epoch
    print_line(
        Message(
            "simulated drives for {machine} on {interface} {channel}; press Ctrl-C to stop",
            machine=machine.name,
            interface=can.interface,
            channel=can.channel,
        )
    )
    try:
        while should_continue():
            while (late := time.monotonic() - zero - clock.now()) > _STEP_S:
                clock.advance(_STEP_S)
                peers.process_frames()
            clock.advance(max(late, 0.0))
            peers.process_frames(_CYCLE_S)
            for line in read_lines():
                print_line(execute_command(line, peers))
    finally:
        peers.close()
