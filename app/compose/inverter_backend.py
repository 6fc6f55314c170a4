"""A frequency inverter on a serial line takes the place of a backend's own spindle."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial

from app.compose.serial_ports import open_wire
from core.machine.machine_model import Machine
from core.ports import AxisSample, AxisSink, Clock, DriverError, MachinePorts, Segments, Stop
from drivers.clocks import StepClock
from drivers.feeder.feeder_server import Driven
from drivers.inverter.inverter_attendant import Keeper
from drivers.inverter.inverter_spindle import Encoder, InverterSpindle, attendant, well
from drivers.inverter.inverter_table import InverterTable

BY_FREQUENCY = (
    "spindle speed is the inverter's output frequency: no encoder is connected; "
    "slip is not seen, and no thread can be cut"
)


def has_inverter(machine: Machine) -> bool:
    """Whether an inverter of its own turns the spindle."""
    return machine.hardware.spindle_driver == "vfd"


def with_inverter(
    machine: Machine, ports: MachinePorts, clock: Clock, measures: Encoder | None = None
) -> tuple[MachinePorts, Callable[[], None]]:
    """The ports with the inverter for their spindle, and how to let it go.

    ``measures`` is an encoder beside the backend's spindle. Raises DriverError for one that does not answer.
    """
    if isinstance(clock, StepClock):
        raise DriverError(
            "an inverter on a line needs real time; it cannot follow a clock that is moved by hand"
        )
    table = machine.hardware.table(InverterTable)
    assert table is not None  # a rule of the machine file
    line, config = table.line, table.config
    attended = attendant(config, lambda: open_wire(line), clock)
    keeper = Keeper(attended)
    try:
        attended.connect()
    except DriverError as error:
        attended.close()
        raise DriverError(f"inverter {config.family} on {line.port}: {error}") from error
    keeper.start()
    own = ports.spindle if machine.backend != "sim" and ports.spindle.angle() is not None else None
    encoder = measures or own
    spindle = InverterSpindle(
        config,
        attended,
        clock,
        encoder=encoder,
        alive=lambda: keeper.alive,
        estop=lambda: ports.station.snapshot().estop,
        lost=ports.spindle.fault if machine.backend == "canopen" else well,
    )
    said = (*attended.warnings, *(() if encoder else (BY_FREQUENCY,)))
    joined = dataclasses.replace(
        ports,
        axes=ClearingAxes(ports.axes, spindle.clear_fault),
        spindle=spindle,
        gear=ports.gear if encoder else None,
        warnings=(*ports.warnings, *said),
        halt=partial(halt_with, ports, spindle),
    )
    return joined, keeper.close


def halt_with(ports: MachinePorts, spindle: InverterSpindle) -> None:
    """The inverter's thread takes its stop from any other; then the rest."""
    spindle.coast()
    if ports.halt is not None:
        ports.halt()


class WithInverter:
    """``Driven``: a set of drivers whose spindle is on a line of its own, for the process that owns both."""

    def __init__(self, inner: Driven, machine: Machine, clock: Clock) -> None:
        self._inner = inner
        self.hands = inner.hands
        try:
            self.ports, self._let_go = with_inverter(machine, inner.ports, clock)
        except DriverError:
            inner.close()
            raise

    def tick(self) -> None:
        """The inverter has its own thread."""
        self._inner.tick()

    def close(self) -> None:
        """Spindle first."""
        self._let_go()
        self._inner.close()


class ClearingAxes:
    """``AxisSink``: the same axes, whose fault is cleared together with the spindle's."""

    def __init__(self, inner: AxisSink, beside: Callable[[], None]) -> None:
        self._inner, self._beside = inner, beside
        self.axes, self.commit = inner.axes, inner.commit

    def now(self) -> float:
        """The machine's clock."""
        return self._inner.now()

    def horizon(self) -> float:
        """End of what is queued."""
        return self._inner.horizon()

    def splice(self, segments: Segments) -> None:
        """As the port says."""
        self._inner.splice(segments)

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """As the port says."""
        return self._inner.demand_at(t)

    def sample(self) -> AxisSample:
        """The axes now."""
        return self._inner.sample()

    def enable(self, on: bool) -> None:
        """Drives on or off."""
        self._inner.enable(on)

    def stop(self, how: Stop) -> None:
        """The drives' own stop."""
        self._inner.stop(how)

    def home(self, axis: str) -> None:
        """Start homing."""
        self._inner.home(axis)

    def clear_fault(self) -> None:
        """Both. Raises DriverError."""
        self._beside()
        self._inner.clear_fault()
