"""Frequency inverter on a serial line, in place of the backend's own spindle."""

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
    """Return the ports with the inverter as spindle, and a function that closes both, the spindle first.

    ``close`` closes the other devices. It is also called if the inverter does not respond. ``measures`` is an
    encoder in addition to the backend's spindle. Raises DriverError if the inverter does not respond.
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
    assert config is not None  # checked by a rule of the machine file
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
        wakeup=None,  # the inverter does not notify changes
        halt=partial(halt_with, ports, spindle),
        unknown=partial(unknown_with, ports, spindle),
        spindle_lag=spindle.lag,
    )
    return thread, joined


def unknown_with(ports: MachinePorts, spindle: InverterSpindle) -> frozenset[Unknown]:
    """Return the unknown parts of the backend, with the spindle judged by the inverter and its encoder."""
    rest = ports.unknown() - {Unknown.SPINDLE}
    return rest | {Unknown.SPINDLE} if spindle.unknown else rest


def halt_with(ports: MachinePorts, spindle: InverterSpindle) -> None:
    """Stop the inverter from any thread, then the other devices."""
    spindle.coast()
    if ports.halt is not None:
        ports.halt()


class SlidesAlone:
    """A ``SampleSource`` without the spindle values of the backend, whose spindle is not used.

    The record has the values of the real spindle from each tick.
    """

    def __init__(self, inner: SampleSource, axes: int, load: Callable[[], float]) -> None:
        self.rate, self._inner, self._load = inner.rate, inner, load
        self._spindle = slice(1 + 3 * axes, 4 + 3 * axes)

    def take(self, most: int = 8192) -> FloatArray:
        """Return the samples with unknown spindle speed and revolutions, and the inverter's last load."""
        rows = self._inner.take(most)
        rows[:, self._spindle] = float("nan")
        rows[:, self._spindle.stop - 1] = self._load()
        return rows


class ClearingAxes:
    """An ``AxisSink`` whose faults are cleared together with those of the spindle."""

    def __init__(self, inner: AxisSink, beside: Callable[[], None]) -> None:
        self._clear, self._beside = inner.clear_fault, beside
        self.axes, self.commit = inner.axes, inner.commit
        self.now, self.horizon, self.demand_at = inner.now, inner.horizon, inner.demand_at
        self.splice, self.sample, self.enable = inner.splice, inner.sample, inner.enable
        self.stop, self.home = inner.stop, inner.home

    def clear_fault(self) -> None:
        """Clear the faults of the spindle and of the axes. Raises DriverError."""
        self._beside()
        self._clear()
