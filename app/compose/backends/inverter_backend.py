"""A frequency inverter on a serial line takes the place of a backend's own spindle."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path

from app.compose.backends.serial_ports import open_wire
from core.machine.machine_model import Machine
from core.ports import AxisSink, Clock, DriverError, FloatArray, MachinePorts, SampleSource, Unknown
from drivers.inverter.inverter_attendant import AttendantThread
from drivers.inverter.inverter_spindle import Encoder, InverterSpindle, attendant
from drivers.inverter.inverter_table import InverterTable
from drivers.waiting import StepClock

BY_FREQUENCY = (
    "no spindle encoder is connected, so the spindle speed is the inverter's output "
    "frequency; slip is not detected, and threads cannot be cut"
)


def with_inverter(
    machine: Machine,
    ports: MachinePorts,
    clock: Clock,
    close: Callable[[], None],
    measures: Encoder | None = None,
) -> tuple[MachinePorts, Callable[[], None]]:
    """The ports with the inverter for their spindle, and how to let all of it go: the spindle first.

    ``close`` lets the rest go, also where the inverter does not answer: DriverError. ``measures`` is an
    encoder beside the backend's spindle.
    """
    try:
        thread, joined = _attended(machine, ports, clock, measures)
    except DriverError:
        close()
        raise

    def let_go() -> None:
        thread.close()
        close()

    return joined, let_go


def _attended(
    machine: Machine, ports: MachinePorts, clock: Clock, measures: Encoder | None
) -> tuple[AttendantThread, MachinePorts]:
    if isinstance(clock, StepClock):
        raise DriverError(
            "an inverter on a serial line works only in real time, not with a clock that is advanced manually"
        )
    config = machine.hardware.table(InverterTable)
    assert config is not None  # a rule of the machine file
    line = config.line
    attended = attendant(config, lambda: open_wire(line), clock, Path(machine.source).parent)
    thread = AttendantThread(attended)
    try:
        attended.connect()
    except DriverError as error:
        attended.close()
        raise DriverError(
            "inverter {family} on {port}: {error}", family=config.family, port=line.port, error=error
        ) from error
    thread.start()
    own = ports.spindle if machine.backend != "sim" and ports.spindle.angle() is not None else None
    encoder = measures or own
    spindle = InverterSpindle(
        config,
        attended,
        clock,
        encoder=encoder,
        alive=lambda: thread.alive,
        revive=thread.revive,
        estop=lambda: ports.station.snapshot().estop,
        lost=ports.spindle.fault if machine.backend == "canopen" else str,
    )
    said = (*attended.warnings, *(() if encoder else (BY_FREQUENCY,)))
    joined = dataclasses.replace(
        ports,
        axes=ClearingAxes(ports.axes, spindle.clear_fault),
        spindle=spindle,
        gear=ports.gear if encoder else None,
        orientation=None,
        samples=SlidesAlone(ports.samples, len(ports.axes.axes), lambda: spindle.load)
        if ports.samples is not None
        else None,
        warnings=(*ports.warnings, *said),
        wakeup=None,  # nobody rings for what the inverter does by itself
        halt=partial(halt_with, ports, spindle),
        unknown=partial(unknown_with, ports, spindle),
        spindle_lag=spindle.lag,
    )
    return thread, joined


def unknown_with(ports: MachinePorts, spindle: InverterSpindle) -> frozenset[Unknown]:
    """Of the rest what it says; of the spindle what its own line and its encoder say."""
    rest = ports.unknown() - {Unknown.SPINDLE}
    return rest | {Unknown.SPINDLE} if spindle.unknown else rest


def halt_with(ports: MachinePorts, spindle: InverterSpindle) -> None:
    """The inverter's thread takes its stop from any other; then the rest."""
    spindle.coast()
    if ports.halt is not None:
        ports.halt()


class SlidesAlone:
    """``SampleSource``: the same samples without what they say of a spindle, which is not the one that turns.

    Of that one the record has what is measured at each tick.
    """

    def __init__(self, inner: SampleSource, axes: int, load: Callable[[], float]) -> None:
        self.rate, self._inner, self._load = inner.rate, inner, load
        self._spindle = slice(1 + 3 * axes, 4 + 3 * axes)

    def take(self, most: int = 8192) -> FloatArray:
        """Speed and turns of the spindle are not known; its load is what the inverter said last."""
        rows = self._inner.take(most)
        rows[:, self._spindle] = float("nan")
        rows[:, self._spindle.stop - 1] = self._load()
        return rows


class ClearingAxes:
    """``AxisSink``: the same axes, whose fault is cleared together with the spindle's."""

    def __init__(self, inner: AxisSink, beside: Callable[[], None]) -> None:
        self._clear, self._beside = inner.clear_fault, beside
        self.axes, self.commit = inner.axes, inner.commit
        self.now, self.horizon, self.demand_at = inner.now, inner.horizon, inner.demand_at
        self.splice, self.sample, self.enable = inner.splice, inner.sample, inner.enable
        self.stop, self.home = inner.stop, inner.home

    def clear_fault(self) -> None:
        """Both. Raises DriverError."""
        self._beside()
        self._clear()
