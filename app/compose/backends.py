"""From a machine file to ports: in this process, or through the feeder's.

Feeder and pendant are loaded by the machines that have them: everybody waits for what a start loads.
"""

from __future__ import annotations

import sys

from app.compose.backend_entry import Connected, backend_of, has_inverter, played
from core.machine.machine_model import Machine
from core.ports import Clock

FEEDER = sys.platform != "win32"  # elsewhere a simulated machine lives in the control's own process
PENDANT = "pendant"  # its table


def connect(machine: Machine, clock: Clock) -> Connected:
    """Everything the executor needs. Raises DriverError for what does not answer."""
    if PENDANT not in machine.hardware.tables:
        return _connected(machine, clock)
    from app.compose.pendant_wire import wired, with_pendant

    return with_pendant(machine, _connected(wired(machine), clock))


def _connected(machine: Machine, clock: Clock) -> Connected:
    backend = backend_of(machine)
    apart = backend.driven is not None and machine.hardware.feeder and FEEDER
    if backend.connect is not None and not apart:
        return backend.connect(machine, clock)
    from app.compose.feeder_backend import connect_feeder

    return connect_feeder(machine, clock)


def real_time(machine: Machine) -> bool:
    """Whether something of it keeps its own time: no clock that is moved by hand will do."""
    return has_inverter(machine) or not played(machine)
