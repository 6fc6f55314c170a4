"""Connection of a machine through the driver host, in a separate process or in this one for tests."""

from __future__ import annotations

from collections.abc import Callable

from app.compose.backends.backend_entry import Connected, backend_of, has_station, played
from app.compose.backends.driver_host_process import DriverHostProcess, driven
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError
from drivers.driver_host.host_line import Line, LoopLink
from drivers.driver_host.host_ports import HostHands, host_ports
from drivers.driver_host.host_server import DriverHost
from drivers.waiting import RealClock


def connect_driver_host(machine: Machine, clock: Clock, lock: int | None = None) -> Connected:
    """Start the driver host and return the machine's ports. Raises DriverError if it does not respond.

    ``lock`` is a file descriptor that the driver host process holds until it has ended.
    """
    line, close = _line(machine, clock, lock)
    try:
        ports = host_ports(line)
    except DriverError:
        close()
        raise
    hands = HostHands(line)
    panel = hands if played(machine) or not has_station(machine) else None
    return Connected(ports, panel, hands.set_input if played(machine) else None, close)


def _line(machine: Machine, clock: Clock, lock: int | None) -> tuple[Line, Callable[[], None]]:
    """Return the connection to the driver host and its close function.

    With a real clock the driver host is a process; otherwise the same messages run in this thread.
    """
    if isinstance(clock, RealClock) and not _virtual(machine):
        process = DriverHostProcess(machine, clock, lock)
        return process.line, process.close
    owned = driven(machine, clock)
    return Line(LoopLink(DriverHost(owned, refresh=machine.hardware.refresh)), clock), owned.close


def _virtual(machine: Machine) -> bool:
    """Return whether the machine has a bus that another process cannot reach."""
    return backend_of(machine).connect is None and played(machine)
