"""Ports of the simulated machine, which is the default backend."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from core.ports import (
    AxisSample,
    Cam,
    Clock,
    FloatArray,
    GearState,
    MachinePorts,
    MotionSegments,
    StationState,
    StopMode,
    TouchLatch,
)
from drivers.port_checks import (
    LOG_ROWS,
    SampleRingBuffer,
    require_estop_released,
    require_existing_axis,
    require_spindle_ready,
    require_stopped_spindle,
)
from drivers.simulators.plant import SimulatedPlant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_controls import FaultSchedule, PlantControls


class _PlantPort:
    """The base class of the ports of a simulated plant."""

    def __init__(self, plant: SimulatedPlant) -> None:
        self._plant = plant


class SimAxes(_PlantPort):
    """Axis port (``core.ports.AxisSink``) of the simulated machine."""

    def __init__(self, plant: SimulatedPlant) -> None:
        super().__init__(plant)
        self.axes = plant.axis_names
        self.commit = plant.config.commit_time_s

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        return self._plant.clock.now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue in seconds, or the current time for an empty queue."""
        with self._plant.lock:
            return self._plant.setpoint_queue.get_end_time(self._plant.clock.now())

    def splice(self, segments: MotionSegments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if a fault is active, the power is off or an axis is homing. Also raises
        DriverError if the setpoints are invalid or the drives cannot follow them.
        """
        self._plant.splice_segments(segments)

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at ``time_s``."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.setpoint_queue.get_commanded_state(time_s)

    def sample(self) -> AxisSample:
        """Return the state of the axes at the last time step of the model."""
        plant = self._plant
        with plant.lock:
            plant.advance()
            actual = tuple([servo.reading for servo in plant.servos])
            demand, velocity = plant.setpoint_queue.get_commanded_state(plant.model_time_s)
            if not plant.enabled:
                demand = actual
            return AxisSample(
                t=plant.model_time_s,
                demand=demand,
                actual=actual,
                following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
                enabled=plant.enabled,
                homed=tuple([servo.homed for servo in plant.servos]),
                moving=any(velocity) or any(abs(servo.v) > 0.01 for servo in plant.servos),
                fault=plant.fault,
            )

    def enable(self, is_on: bool) -> None:
        """Switch the drives on or off.

        When switching on, raises DriverError if the E-stop is pressed or a fault is active. Switching off
        is always possible.
        """
        self._plant.set_drive_power(is_on)

    def stop(self, mode: StopMode) -> None:
        """Stop the axes by the ramps of the drives."""
        self._plant.stop(mode)

    def home(self, axis: str) -> None:
        """Start homing an axis.

        ``sample().homed`` becomes True when homing is done.
        """
        require_existing_axis(axis, self.axes)
        self._plant.home_axis(axis)

    def clear_fault(self) -> None:
        """Clear the fault without switching on the drives."""
        with self._plant.lock:
            self._plant.clear_fault()


class SimSpindleGear(_PlantPort):
    """Port for axes that follow the spindle (``core.ports.SpindleGear``) on the simulated machine."""

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle.

        Raises DriverError if a fault is active, the power is off, an axis is homing or moving, or the
        spindle is not turning in the direction of the cam. Also raises DriverError if the cam is invalid or
        too fast.
        """
        self._plant.engage_cam(cam)

    def geared(self) -> GearState | None:
        """Return the positions for the current spindle angle, or None if no axis follows the spindle."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.setpoint_queue.read_gear_state()


class SimSampleSource(_PlantPort):
    """Scope samples (``core.ports.SampleSource``) of the simulated machine.

    Sampling starts with the first request.
    """

    def __init__(self, plant: SimulatedPlant) -> None:
        super().__init__(plant)
        self.sample_rate_hz = 1.0 / plant.config.model_step_s

    def take_samples(self, max_rows: int = LOG_ROWS) -> FloatArray:
        """Return at most ``max_rows`` samples since the last call, oldest first."""
        plant = self._plant
        with plant.lock:
            if plant.sample_log is None:
                plant.sample_log = SampleRingBuffer(len(plant.axis_names))
            return plant.sample_log.pop_rows(max_rows)


class SimSpindlePort(_PlantPort):
    """Spindle port (``core.ports.Spindle``) of the simulated machine."""

    def set_speed(self, rpm: float) -> None:
        """Run the spindle at the signed speed ``rpm``; 0 stops it.

        For a speed other than 0, raises DriverError if the E-stop is pressed or the inverter has a fault.
        """
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            if rpm:
                _require_spindle(plant)
            plant.spindle.command_speed(now, rpm)

    def start_coasting(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        with self._plant.lock:
            self._plant.spindle.command_speed(self._plant.advance(), 0.0, should_coast=True)

    def speed(self) -> float:
        """Return the measured speed in rpm, with its sign."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time and the counted revolutions of the encoder, or None without an encoder.

        The resolution is a quarter of an encoder pulse.
        """
        if not self._plant.config.spindle.pulses_per_rev:
            return None
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.time_s, self._plant.spindle.counted_revolutions

    def read_fault(self) -> str:
        """Return the fault text of the inverter, or an empty string without a fault."""
        return self._plant.spindle.faults.fault_text


def _require_spindle(plant: SimulatedPlant) -> None:
    """Raise DriverError if the E-stop is pressed or the inverter has a fault."""
    require_estop_released(plant.station_panel.estop)
    require_spindle_ready(plant.spindle.faults.fault_text)


class SimOrientingSpindle(_PlantPort):
    """Port that orients the spindle (``core.ports.OrientingSpindle``) of the simulated machine."""

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        """Orient the spindle to an angle in degrees.

        Raises DriverError if the E-stop is pressed or the inverter has a fault. Also raises DriverError
        while the spindle turns, unless an orientation is already active.
        """
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            _require_spindle(plant)
            require_stopped_spindle(plant.spindle.is_turning)
            plant.spindle.orient_spindle(now, angle, direction)

    def release_spindle(self) -> None:
        """Cancel the orientation of the spindle."""
        with self._plant.lock:
            self._plant.advance()
            self._plant.spindle.cancel_orientation()

    def is_oriented(self) -> bool:
        """Return whether the spindle is at the commanded angle."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.is_oriented


class SimIO(_PlantPort):
    """Input and output port (``core.ports.DigitalIO``) of the simulated machine."""

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name, with True for an active input."""
        with self._plant.lock:
            return self._plant.terminals.read_inputs(self._plant.advance())

    def get_outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name, as last written."""
        with self._plant.lock:
            return dict(self._plant.terminals.output_states)

    def write(self, name: str, is_on: bool) -> None:
        """Switch one output. Raises DriverError for an unknown name."""
        with self._plant.lock:
            self._plant.terminals.write(name, is_on, self._plant.advance())

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state."""
        with self._plant.lock:
            self._plant.terminals.switch_to_safe_state(self._plant.advance())


class SimTouchInput(_PlantPort):
    """Probe port (``core.ports.TouchInput``) of the simulated machine.

    The time resolution of a touch is that of the model.
    """

    def arm_latch(self) -> None:
        """Clear the latched touch, so that the next touch is latched."""
        with self._plant.lock:
            self._plant.advance()
            if self._plant.terminals.setter is not None:
                self._plant.terminals.setter.kept = None

    def read_latch(self) -> TouchLatch | None:
        """Return the first touch since ``arm_latch``, or None without a touch."""
        with self._plant.lock:
            self._plant.advance()
            setter = self._plant.terminals.setter
            kept = setter.kept if setter is not None else None
            return TouchLatch(*kept, self._plant.config.model_step_s) if kept is not None else None


class SimStation(_PlantPort):
    """Operator station (``core.ports.OperatorStation``) of the simulated machine."""

    def read_state(self) -> StationState:
        """Return the current state of the operator station."""
        plant = self._plant
        with plant.lock:
            state, _ = plant.read_station_and_inputs(plant.clock.now())
            load = plant.spindle.load_percent if plant.config.has_spindle_load_input else None
        return state if load is None else replace(state, spindle_load=load)


class Simulation(NamedTuple):
    """Ports of the simulated machine for the executor, and controls for tests and the operator."""

    ports: MachinePorts
    machine: PlantControls


def build_simulation(config: SimConfig, clock: Clock) -> Simulation:
    """Create a simulated machine that uses ``clock``, and return its ports and its controls."""
    plant = SimulatedPlant(config, clock)
    ports = MachinePorts(
        clock=clock,
        axes=SimAxes(plant),
        spindle=SimSpindlePort(plant),
        io=SimIO(plant),
        station=SimStation(plant),
        gear=SimSpindleGear(plant),
        orientation=SimOrientingSpindle(plant) if config.spindle.can_orient else None,
        halt_machine=plant.stop_machine,
        wakeup=plant.wakeup,
        samples=SimSampleSource(plant),
        touch=SimTouchInput(plant) if config.setter is not None else None,
    )
    machine = PlantControls(plant)
    if config.planned_faults:
        plant.apply_due_faults = FaultSchedule(machine, config.planned_faults).apply_due_actions
    return Simulation(ports, machine)
