"""From a machine file to ports: in this process, or through the feeder's."""

from __future__ import annotations

import os
from collections.abc import Callable

from app.compose.backend_entry import Connected, backend_of, has_inverter, has_station, played
from app.compose.feeder_process import driven
from app.compose.pendant_wire import wired, with_pendant
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError
from drivers.clocks import RealClock
from drivers.feeder.feeder_hands import FeederHands
from drivers.feeder.feeder_line import Line
from drivers.feeder.feeder_links import LoopLink
from drivers.feeder.feeder_ports import feeder_ports
from drivers.feeder.feeder_server import Feeder

FEEDER = os.name == "posix"  # elsewhere a simulated machine lives in the control's own process


def connect(machine: Machine, clock: Clock) -> Connected:
    """Everything the executor needs. Raises DriverError for what does not answer."""
    return with_pendant(machine, _connected(wired(machine), clock))


def _connected(machine: Machine, clock: Clock) -> Connected:
    backend = backend_of(machine)
    apart = backend.driven is not None and machine.hardware.feeder and FEEDER
    if backend.connect is not None and not apart:
        return backend.connect(machine, clock)
    line, close = _line(machine, clock)
    try:
        ports = feeder_ports(line)
    except DriverError:
        close()
        raise
    hands = FeederHands(line)
    panel = hands if played(machine) or not has_station(machine) else None
    return Connected(ports, panel, hands.set_input if played(machine) else None, close)


def real_time(machine: Machine) -> bool:
    """Whether something of it keeps its own time: no clock that is moved by hand will do."""
    return has_inverter(machine) or not played(machine)


def _line(machine: Machine, clock: Clock) -> tuple[Line, Callable[[], None]]:
    """The feeder in its own process where time is real, else the same messages in this thread."""
    if isinstance(clock, RealClock) and not _virtual(machine):
        from app.compose.feeder_process import FeederProcess

        process = FeederProcess(machine, clock)
        return process.line, process.close
    owned = driven(machine, clock)
    return Line(LoopLink(Feeder(owned, refresh=machine.hardware.refresh)), clock), owned.close


def _virtual(machine: Machine) -> bool:
    """A bus that cannot be reached from another process."""
    return backend_of(machine).connect is None and played(machine)
