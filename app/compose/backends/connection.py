"""From a machine file to ports: in this process, or through the driver host's.

The driver host is loaded by the machines that have it: everybody waits for what a start loads.
"""

from __future__ import annotations

import sys

from app.compose.backends.backend_entry import Connected, backend_of, has_inverter, played
from app.compose.extra import extras
from core.machine.machine_model import Machine
from core.ports import Clock

HAS_DRIVER_HOST = sys.platform != "win32"  # elsewhere a simulated machine lives in the control's own process


def connect(machine: Machine, clock: Clock) -> Connected:
    """Everything the executor needs. Raises DriverError for what does not answer."""
    connected = _connected(wired(machine), clock)
    for extra in extras().values():
        connected = extra.connect(machine, connected)
    return connected


def wired(machine: Machine) -> Machine:
    """Return the machine as its backend is wired: without the inputs that optional features provide."""
    for extra in extras().values():
        machine = extra.wired(machine)
    return machine


def _connected(machine: Machine, clock: Clock) -> Connected:
    backend = backend_of(machine)
    apart = backend.driven is not None and machine.hardware.feeder and HAS_DRIVER_HOST
    if backend.connect is not None and not apart:
        return backend.connect(machine, clock)
    from app.compose.backends.driver_host_backend import connect_driver_host

    return connect_driver_host(machine, clock)


def real_time(machine: Machine) -> bool:
    """Whether something of it keeps its own time: no clock that is moved by hand will do."""
    return has_inverter(machine) or not played(machine)
