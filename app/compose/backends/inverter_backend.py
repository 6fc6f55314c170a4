"""Connection of a frequency inverter on a serial line, which replaces the backend's spindle."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path

from app.compose.backends.serial_ports import open_serial_port
from core.machine.machine_model import Machine
from core.ports import AxisSink, Clock, DriverError, FloatArray, MachinePorts, SampleSource, UnknownPart
from drivers.inverter.inverter_control import InverterThread
from drivers.inverter.inverter_spindle import InverterSpindle, SpindleEncoder, create_inverter_control
from drivers.inverter.inverter_table import InverterTable
from drivers.wakeups import ManualClock

NO_ENCODER_TEXT = (
    "no spindle encoder is connected, so the spindle speed is the inverter's output "
    "frequency; slip is not detected, and threads cannot be cut"
)


def add_inverter(
    machine: Machine,
    ports: MachinePorts,
    clock: Clock,
    close_devices: Callable[[], None],
    encoder: SpindleEncoder | None = None,
) -> tuple[MachinePorts, Callable[[], None]]:
    """Return the ports with the inverter as spindle, and a function that closes the devices.

    The function closes the spindle and then calls ``close_devices``, which closes the other devices.
    ``close_devices`` is also called if the inverter cannot be connected. ``encoder`` is an encoder that
    measures the spindle speed. Raises DriverError if the inverter does not respond or does not fit the
    machine file, if its serial port cannot be opened, or if ``clock`` is a manual clock.
    """
    try:
        thread, joined = _attended(machine, ports, clock, encoder)
    except DriverError:
        close_devices()
        raise

    def close_all_devices() -> None:
        thread.close()
        close_devices()

    return joined, close_all_devices


def _attended(
    machine: Machine, ports: MachinePorts, clock: Clock, measures: SpindleEncoder | None
) -> tuple[InverterThread, MachinePorts]:
    if isinstance(clock, ManualClock):
        raise DriverError(
            "an inverter on a serial line works only in real time, not with a clock that is advanced manually"
        )
    config = machine.hardware.find_driver_table(InverterTable)
    assert config is not None  # checked by a rule of the machine file
    line = config.line_settings
    attended = create_inverter_control(
        config, lambda: open_serial_port(line), clock, Path(machine.source).parent
    )
    thread = InverterThread(attended)
    try:
        attended.open_and_check_line()
    except DriverError as error:
        attended.close()
        raise DriverError(
            "inverter {family} on {port}: {error}", family=config.family, port=line.port, error=error
        ) from error
    thread.start()
    own = ports.spindle if machine.backend != "sim" and ports.spindle.read_angle() is not None else None
    encoder = measures or own
    spindle = InverterSpindle(
        config,
        attended,
        clock,
        encoder=encoder,
        is_thread_alive=lambda: thread.is_alive,
        restart_thread=thread.restart,
        is_estop_pressed=lambda: ports.station.read_state().estop,
        get_encoder_fault=ports.spindle.read_fault if machine.backend == "canopen" else str,
    )
    said = (*attended.warnings, *(() if encoder else (NO_ENCODER_TEXT,)))
    joined = dataclasses.replace(
        ports,
        axes=FaultClearingAxes(ports.axes, spindle.clear_fault),
        spindle=spindle,
        gear=ports.gear if encoder else None,
        orientation=None,
        samples=AxisOnlySamples(ports.samples, len(ports.axes.axes), lambda: spindle.load_percent)
        if ports.samples is not None
        else None,
        warnings=(*ports.warnings, *said),
        wakeup=None,  # the inverter does not notify changes
        halt_machine=partial(halt_inverter_and_machine, ports, spindle),
        unknown=partial(find_unknown_machine_parts, ports, spindle),
        spindle_lag=spindle.get_line_delay,
    )
    return thread, joined


def find_unknown_machine_parts(ports: MachinePorts, spindle: InverterSpindle) -> frozenset[UnknownPart]:
    """Return the parts of the machine that do not report their state.

    The spindle is included if neither the inverter nor its encoder reports its state.
    """
    rest = ports.unknown() - {UnknownPart.SPINDLE}
    return rest | {UnknownPart.SPINDLE} if spindle.is_state_unknown else rest


def halt_inverter_and_machine(ports: MachinePorts, spindle: InverterSpindle) -> None:
    """Stop the inverter and then the other devices. Any thread may call this function."""
    spindle.start_coasting()
    if ports.halt_machine is not None:
        ports.halt_machine()


class AxisOnlySamples:
    """A ``SampleSource`` without spindle values, for a backend whose own spindle is not used.

    The scope record gets the values of the real spindle at each tick.
    """

    def __init__(self, samples: SampleSource, axis_count: int, read_load: Callable[[], float]) -> None:
        self.sample_rate_hz, self._inner, self._load = samples.sample_rate_hz, samples, read_load
        self._spindle = slice(1 + 3 * axis_count, 4 + 3 * axis_count)

    def take_samples(self, max_rows: int = 8192) -> FloatArray:
        """Return the backend's samples with the latest load that the inverter reported.

        The spindle speed and the revolutions are unknown.
        """
        rows = self._inner.take_samples(max_rows)
        rows[:, self._spindle] = float("nan")
        rows[:, self._spindle.stop - 1] = self._load()
        return rows


class FaultClearingAxes:
    """An ``AxisSink`` that clears the faults of the spindle together with the faults of the axes."""

    def __init__(self, axis_sink: AxisSink, clear_spindle: Callable[[], None]) -> None:
        self._clear, self._beside = axis_sink.clear_fault, clear_spindle
        self.axes, self.commit = axis_sink.axes, axis_sink.commit
        self.now, self.horizon, self.demand_at = axis_sink.now, axis_sink.horizon, axis_sink.demand_at
        self.splice, self.sample, self.enable = axis_sink.splice, axis_sink.sample, axis_sink.enable
        self.stop, self.home = axis_sink.stop, axis_sink.home

    def clear_fault(self) -> None:
        """Clear the faults of the spindle and of the axes.

        Raises DriverError if a device does not respond.
        """
        self._beside()
        self._clear()
