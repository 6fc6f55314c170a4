"""From a machine file to ports: in this process, or through the feeder's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.compose.feeder_process import driven, has_station
from app.compose.inverter_backend import has_inverter, with_inverter
from app.compose.simulated_backend import simulated
from app.desk.station_hands import StationPanel
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError, MachinePorts
from drivers.canopen.canopen_table import CanopenTable
from drivers.clocks import RealClock
from drivers.feeder.feeder_client import FeederHands, Line, feeder_ports
from drivers.feeder.feeder_links import LoopLink
from drivers.feeder.feeder_server import Feeder


@dataclass(frozen=True, slots=True)
class Connected:
    """The ports of a machine. ``panel``: the station on the screen, None where the machine has its own."""

    ports: MachinePorts
    panel: StationPanel | None
    set_input: Callable[[str, bool], None] | None  # of a simulated machine
    close: Callable[[], None]


def connect(machine: Machine, clock: Clock) -> Connected:
    """Everything the executor needs. Raises DriverError for what does not answer."""
    if machine.backend == "sim" and not machine.hardware.feeder:
        return _in_process(machine, clock)
    if machine.backend == "grblhal":
        return _controller(machine, clock)
    if machine.backend not in {"sim", "canopen"}:
        raise DriverError(f"{machine.source}: there is no driver for backend {machine.backend} yet")
    line, close = _line(machine, clock)
    try:
        ports = feeder_ports(line)
    except DriverError:
        close()
        raise
    hands = FeederHands(line)
    panel = hands if played(machine) or not has_station(machine) else None
    return Connected(ports, panel, hands.set_input if played(machine) else None, close)


def _controller(machine: Machine, clock: Clock) -> Connected:
    """A controller that plans by itself; it knows no buttons, so the station is the screen's."""
    from app.compose.grblhal_backend import grblhal_machine

    controller = grblhal_machine(machine, clock)
    return Connected(controller.ports, controller.panel, None, controller.close)


def _in_process(machine: Machine, clock: Clock) -> Connected:
    """The simulated machine, whose spindle may be a real one."""
    simulation = simulated(machine, clock)
    ports, hands = simulation.ports, simulation.machine
    if not has_inverter(machine):
        return Connected(ports, hands, hands.set_input, lambda: None)
    ports, close = with_inverter(machine, ports, clock)
    return Connected(ports, hands, hands.set_input, close)


def real_time(machine: Machine) -> bool:
    """Whether something of it keeps its own time: no clock that is moved by hand will do."""
    return has_inverter(machine) or not played(machine)


def played(machine: Machine) -> bool:
    """Whether the machine is simulated, on a virtual bus or on none."""
    can = machine.hardware.table(CanopenTable)
    return machine.backend == "sim" or (
        machine.backend == "canopen" and can is not None and not can.bus.own_process
    )


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
    return machine.backend == "canopen" and played(machine)
