"""Connection of a machine to its ports, in this process or through the driver host.

The driver host module is loaded only for machines that use it, because loading delays the start.
"""

from __future__ import annotations

import sys

from app.compose.backends.backend_entry import ConnectedMachine, find_backend, has_inverter, is_simulated
from app.compose.optional_features import extras
from core.machine.machine_model import Machine
from core.ports import Clock

# on other systems a simulated machine runs in the control's process
HAS_DRIVER_HOST = sys.platform != "win32"


def connect_machine(machine: Machine, clock: Clock, lock_descriptor: int | None = None) -> ConnectedMachine:
    """Return the ports and functions that the executor needs.

    Raises DriverError if no driver exists for the backend, or if a device does not respond.

    ``lock_descriptor`` is a file descriptor that a driver host process inherits and does not close before
    it ends.
    """
    connected = _connected(remove_feature_inputs(machine), clock, lock_descriptor)
    for extra in extras().values():
        connected = extra.add_ports(machine, connected)
    return connected


def remove_feature_inputs(machine: Machine) -> Machine:
    """Return a copy of the machine without the inputs that optional features provide.

    The remaining inputs are wired to the machine's backend.
    """
    for extra in extras().values():
        machine = extra.remove_own_inputs(machine)
    return machine


def _connected(machine: Machine, clock: Clock, lock: int | None) -> ConnectedMachine:
    backend = find_backend(machine)
    apart = backend.create_drivers is not None and machine.hardware.uses_driver_host and HAS_DRIVER_HOST
    if backend.connect is not None and not apart:
        return backend.connect(machine, clock)
    from app.compose.backends.driver_host_backend import connect_driver_host

    return connect_driver_host(machine, clock, lock)


def needs_real_time(machine: Machine) -> bool:
    """Return whether a part of the machine runs in real time and therefore cannot use a manual clock."""
    return has_inverter(machine) or not is_simulated(machine)
