"""Connection of a machine through the driver host.

The driver host runs in a separate process, or in this process for tests.
"""

from __future__ import annotations

from collections.abc import Callable

from app.compose.backends.backend_entry import ConnectedMachine, find_backend, has_own_station, is_simulated
from app.compose.backends.driver_host_process import DriverHostProcess, create_host_drivers
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError
from drivers.driver_host.host_connection import HostConnection, InProcessLink
from drivers.driver_host.host_ports import HostStationControls, create_host_ports
from drivers.driver_host.host_server import DriverHost
from drivers.wakeups import RealClock


def connect_driver_host(
    machine: Machine, clock: Clock, lock_descriptor: int | None = None
) -> ConnectedMachine:
    """Start the driver host and return the connected machine.

    Raises DriverError if the host does not respond or its drivers report an error.

    ``lock_descriptor`` is a file descriptor that the driver host process does not close before it ends.
    """
    line, close = _open_connection(machine, clock, lock_descriptor)
    try:
        ports = create_host_ports(line)
    except DriverError:
        close()
        raise
    hands = HostStationControls(line)
    panel = hands if is_simulated(machine) or not has_own_station(machine) else None
    return ConnectedMachine(ports, panel, hands.set_input if is_simulated(machine) else None, close)


def _open_connection(
    machine: Machine, clock: Clock, lock: int | None
) -> tuple[HostConnection, Callable[[], None]]:
    """Return the connection to the driver host and the function that closes the connection.

    With a real clock, the driver host is a separate process. Otherwise it handles the same messages in this
    thread.
    """
    if isinstance(clock, RealClock) and not _is_virtual(machine):
        process = DriverHostProcess(machine, clock, lock)
        return process.connection, process.close
    owned = create_host_drivers(machine, clock)
    return HostConnection(
        InProcessLink(DriverHost(owned, refresh_periods=machine.hardware.refresh_timeouts_s)), clock
    ), owned.close


def _is_virtual(machine: Machine) -> bool:
    """Return whether the machine uses a virtual bus that another process cannot reach."""
    return find_backend(machine).connect is None and is_simulated(machine)
