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
    Geared,
    Latch,
    MachinePorts,
    Segments,
    StationState,
    Stop,
)
from drivers.port_parts import KEPT, SampleLog, demand_axis, demand_estop_released, demand_spindle
from drivers.simulators.plant import Plant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_hands import PlantHands, Schedule


class _OnPlant:
    """Base class of the ports of a plant."""

    def __init__(self, plant: Plant) -> None:
        self._plant = plant


class SimAxes(_OnPlant):
    """``core.ports.AxisSink`` of the simulated machine."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant)
        self.axes = plant.names
        self.commit = plant.config.commit

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        return self._plant.clock.now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue, or the present time if it is empty."""
        with self._plant.lock:
            return self._plant.queue.horizon(self._plant.clock.now())

    def splice(self, segments: Segments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if they are invalid or the drives cannot follow.
        """
        self._plant.splice(segments)

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at time ``t``."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.queue.demand_at(t)

    def sample(self) -> AxisSample:
        """Return the state of the axes at the last grid point of the model."""
        plant = self._plant
        with plant.lock:
            plant.advance()
            actual = tuple([servo.reading for servo in plant.servos])
            demand, velocity = plant.queue.demand_at(plant.t)
            if not plant.enabled:
                demand = actual
            return AxisSample(
                t=plant.t,
                demand=demand,
                actual=actual,
                following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
                enabled=plant.enabled,
                homed=tuple([servo.homed for servo in plant.servos]),
                moving=any(velocity) or any(abs(servo.v) > 0.01 for servo in plant.servos),
                fault=plant.fault,
            )

    def enable(self, on: bool) -> None:
        """Switch the drives on or off.

        Raises DriverError when switching on in E-stop or with a fault; switching off is always possible.
        """
        self._plant.power(on)

    def stop(self, how: Stop) -> None:
        """Stop the axes by the ramps of the drives."""
        self._plant.stop(how)

    def home(self, axis: str) -> None:
        """Start to home an axis; ``sample().homed`` becomes True when it is done."""
        demand_axis(axis, self.axes)
        self._plant.home(axis)

    def clear_fault(self) -> None:
        """Clear the fault; the drives remain off."""
        with self._plant.lock:
            self._plant.clear_fault()


class SimGear(_OnPlant):
    """``core.ports.Gear`` of the simulated machine."""

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle. Raises DriverError if the cam is invalid or too fast."""
        self._plant.mesh(cam)

    def geared(self) -> Geared | None:
        """Return the position of the axes on the cam, or None if they do not follow the spindle."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.queue.geared()


class SimSamples(_OnPlant):
    """``core.ports.SampleSource`` of the simulated machine; sampling starts with the first request."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant)
        self.rate = 1.0 / plant.config.step

    def take(self, most: int = KEPT) -> FloatArray:
        """Return at most ``most`` samples since the last call, oldest first."""
        plant = self._plant
        with plant.lock:
            if plant.log is None:
                plant.log = SampleLog(len(plant.names))
            return plant.log.take(most)


class SimSpindlePort(_OnPlant):
    """``core.ports.Spindle`` of the simulated machine."""

    def run(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed; 0 stops it.

        Raises DriverError in E-stop or with an inverter fault if the speed is not 0.
        """
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            if rpm:
                _demand_spindle(plant)
            plant.spindle.order(now, rpm)

    def coast(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        with self._plant.lock:
            self._plant.spindle.order(self._plant.advance(), 0.0, coast=True)

    def speed(self) -> float:
        """Return the measured speed in rpm, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, counted revolutions) pair, or None without an encoder.

        The resolution is a quarter of a pulse.
        """
        if not self._plant.config.spindle.ppr:
            return None
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.t, self._plant.spindle.counted

    def fault(self) -> str:
        """Return the fault text of the inverter, or an empty text without a fault."""
        return self._plant.spindle.faults.fault


def _demand_spindle(plant: Plant) -> None:
    """Raise DriverError in E-stop or with an inverter fault."""
    demand_estop_released(plant.panel.estop)
    demand_spindle(plant.spindle.faults.fault)


class SimOrientation(_OnPlant):
    """``core.ports.SpindleOrientation`` of the simulated machine."""

    def orient(self, angle: float, sense: int = 0) -> None:
        """Turn the spindle to an angle in degrees. Raises DriverError in E-stop or with an inverter fault."""
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            _demand_spindle(plant)
            plant.spindle.orient(now, angle, sense)

    def release(self) -> None:
        """Cancel the orientation."""
        with self._plant.lock:
            self._plant.advance()
            self._plant.spindle.release()

    def oriented(self) -> bool:
        """Return whether the spindle is at the commanded angle."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.oriented


class SimIO(_OnPlant):
    """``core.ports.DigitalIO`` of the simulated machine."""

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name; True is active."""
        with self._plant.lock:
            return self._plant.terminals.read(self._plant.advance())

    def outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name, as last written."""
        with self._plant.lock:
            return dict(self._plant.terminals.outputs)

    def write(self, name: str, on: bool) -> None:
        """Switch one output. Raises DriverError for an unknown name."""
        with self._plant.lock:
            self._plant.terminals.write(name, on, self._plant.advance())

    def safe(self) -> None:
        """Set every output to its safe state."""
        with self._plant.lock:
            self._plant.terminals.safe(self._plant.advance())


class SimTouch(_OnPlant):
    """``core.ports.TouchInput`` of the simulated machine, at the resolution of the model's grid."""

    def arm(self) -> None:
        """Clear the latched touch."""
        with self._plant.lock:
            self._plant.advance()
            if self._plant.terminals.setter is not None:
                self._plant.terminals.setter.kept = None

    def latched(self) -> Latch | None:
        """Return the first touch since ``arm``, or None."""
        with self._plant.lock:
            self._plant.advance()
            setter = self._plant.terminals.setter
            kept = setter.kept if setter is not None else None
            return Latch(*kept, self._plant.config.step) if kept is not None else None


class SimStation(_OnPlant):
    """``core.ports.Station`` of the simulated machine."""

    def snapshot(self) -> StationState:
        """Return the present state of the operator station."""
        plant = self._plant
        with plant.lock:
            state, _ = plant.hands(plant.clock.now())
            load = plant.spindle.load if plant.config.measures_load else None
        return state if load is None else replace(state, spindle_load=load)


class Simulation(NamedTuple):
    """Ports for the executor, and the controls by which a test or operator acts on the machine."""

    ports: MachinePorts
    machine: PlantHands


def build_simulation(config: SimConfig, clock: Clock) -> Simulation:
    """Create a simulated machine on ``clock`` and return its ports and its controls."""
    plant = Plant(config, clock)
    ports = MachinePorts(
        clock=clock,
        axes=SimAxes(plant),
        spindle=SimSpindlePort(plant),
        io=SimIO(plant),
        station=SimStation(plant),
        gear=SimGear(plant),
        orientation=SimOrientation(plant) if config.spindle.orients else None,
        halt=plant.halt,
        wakeup=plant.wakeup,
        samples=SimSamples(plant),
        touch=SimTouch(plant) if config.setter is not None else None,
    )
    machine = PlantHands(plant)
    if config.faults:
        plant.due = Schedule(machine, config.faults).due
    return Simulation(ports, machine)
