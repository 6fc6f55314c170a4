"""A machine that is driven by the feeder: in a process of its own, or on a clock moved by hand in ours."""

from __future__ import annotations

from collections.abc import Callable

from app.compose.backends.backend_entry import Connected, backend_of, has_station, played
from app.compose.backends.feeder_process import FeederProcess, driven
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError
from drivers.feeder.feeder_line import Line, LoopLink
from drivers.feeder.feeder_ports import FeederHands, feeder_ports
from drivers.feeder.feeder_server import Feeder
from drivers.waiting import RealClock


def connect_feeder(machine: Machine, clock: Clock) -> Connected:
    """Start the feeder and ask it for the machine's ports. Raises DriverError for what does not answer."""
    line, close = _line(machine, clock)
    try:
        ports = feeder_ports(line)
    except DriverError:
        close()
        raise
    hands = FeederHands(line)
    panel = hands if played(machine) or not has_station(machine) else None
    return Connected(ports, panel, hands.set_input if played(machine) else None, close)


def _line(machine: Machine, clock: Clock) -> tuple[Line, Callable[[], None]]:
    """The feeder in its own process where time is real, else the same messages in this thread."""
    if isinstance(clock, RealClock) and not _virtual(machine):
        process = FeederProcess(machine, clock)
        return process.line, process.close
    owned = driven(machine, clock)
    return Line(LoopLink(Feeder(owned, refresh=machine.hardware.refresh)), clock), owned.close


def _virtual(machine: Machine) -> bool:
    """A bus that cannot be reached from another process."""
    return backend_of(machine).connect is None and played(machine)
