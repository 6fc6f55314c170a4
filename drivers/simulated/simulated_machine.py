"""The simulated machine behind ``core.ports``: default backend, and the machine of everyone who has none."""

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
    """What looks at the plant."""

    def __init__(self, plant: Plant) -> None:
        self._plant = plant


class SimAxes(_OnPlant):
    """``core.ports.AxisSink`` on the plant."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant)
        self.axes = plant.names
        self.commit = plant.config.commit

    def now(self) -> float:
        """The machine's clock."""
        return self._plant.clock.now()

    def horizon(self) -> float:
        """End of what is queued; now when nothing is."""
        with self._plant.lock:
            return self._plant.queue.horizon(self._plant.clock.now())

    def splice(self, segments: Segments) -> None:
        """Queue setpoints; raises DriverError as the port says."""
        self._plant.splice(segments)

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Queued position and velocity at ``t``."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.queue.demand_at(t)

    def sample(self) -> AxisSample:
        """The axes now, on the model's grid."""
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
        """Drives on or off; raises DriverError in E-stop or fault."""
        self._plant.power(on)

    def stop(self, how: Stop) -> None:
        """The drives' own stop, at once."""
        self._plant.stop(how)

    def home(self, axis: str) -> None:
        """Start looking for the home switch; ``sample().homed`` says when it is found."""
        demand_axis(axis, self.axes)
        self._plant.home(axis)

    def clear_fault(self) -> None:
        """Forget the fault; the drives stay off."""
        with self._plant.lock:
            self._plant.clear_fault()


class SimGear(_OnPlant):
    """``core.ports.Gear`` on the plant."""

    def mesh(self, cam: Cam) -> None:
        """Follow the spindle; raises DriverError as the port says."""
        self._plant.mesh(cam)

    def geared(self) -> Geared | None:
        """Where on the cam the slides are."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.queue.geared()


class SimSamples(_OnPlant):
    """``core.ports.SampleSource`` on the plant: its model's grid, from the first time on that it is asked."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant)
        self.rate = 1.0 / plant.config.step

    def take(self, most: int = KEPT) -> FloatArray:
        """What has been sampled since."""
        plant = self._plant
        with plant.lock:
            if plant.log is None:
                plant.log = SampleLog(len(plant.names))
            return plant.log.take(most)


class SimSpindlePort(_OnPlant):
    """``core.ports.Spindle`` on the plant."""

    def run(self, rpm: float) -> None:
        """Turn at ``rpm``, signed; raises DriverError in E-stop or inverter fault, unless asked to stop."""
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            if rpm:
                _demand_spindle(plant)
            plant.spindle.order(now, rpm)

    def coast(self) -> None:
        """No torque: it runs down by itself."""
        with self._plant.lock:
            self._plant.spindle.order(self._plant.advance(), 0.0, coast=True)

    def speed(self) -> float:
        """Measured rpm, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def angle(self) -> tuple[float, float] | None:
        """(time, revolutions counted), in steps of the encoder's four edges; None without an encoder."""
        if not self._plant.config.spindle.ppr:
            return None
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.t, self._plant.spindle.counted

    def fault(self) -> str:
        """What the inverter says is wrong; empty when well."""
        return self._plant.spindle.faults.fault


def _demand_spindle(plant: Plant) -> None:
    """Raise DriverError in E-stop, or with a fault of the inverter."""
    demand_estop_released(plant.panel.estop)
    demand_spindle(plant.spindle.faults.fault)


class SimOrientation(_OnPlant):
    """``core.ports.SpindleOrientation`` on the plant."""

    def orient(self, angle: float, sense: int = 0) -> None:
        """Bring it to an angle; raises DriverError while it turns, in E-stop or with a fault."""
        plant = self._plant
        with plant.lock:
            now = plant.advance()
            _demand_spindle(plant)
            plant.spindle.orient(now, angle, sense)

    def release(self) -> None:
        """Hold it no longer."""
        with self._plant.lock:
            self._plant.advance()
            self._plant.spindle.release()

    def oriented(self) -> bool:
        """Whether it is held at its angle."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.oriented


class SimIO(_OnPlant):
    """``core.ports.DigitalIO`` on the plant."""

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name, active is True."""
        with self._plant.lock:
            return self._plant.terminals.read(self._plant.advance())

    def outputs(self) -> Mapping[str, bool]:
        """All outputs as last written."""
        with self._plant.lock:
            return dict(self._plant.terminals.outputs)

    def write(self, name: str, on: bool) -> None:
        """Switch one output; raises DriverError for an unknown name."""
        with self._plant.lock:
            self._plant.terminals.write(name, on, self._plant.advance())

    def safe(self) -> None:
        """Every output to its safe state."""
        with self._plant.lock:
            self._plant.terminals.safe(self._plant.advance())


class SimTouch(_OnPlant):
    """``core.ports.TouchInput`` on the plant: on its model's grid."""

    def arm(self) -> None:
        """Forget what was kept."""
        with self._plant.lock:
            self._plant.advance()
            if self._plant.terminals.setter is not None:
                self._plant.terminals.setter.kept = None

    def latched(self) -> Latch | None:
        """The first touch since."""
        with self._plant.lock:
            self._plant.advance()
            setter = self._plant.terminals.setter
            kept = setter.kept if setter is not None else None
            return Latch(*kept, self._plant.config.step) if kept is not None else None


class SimStation(_OnPlant):
    """``core.ports.Station`` on the plant."""

    def snapshot(self) -> StationState:
        """The station as the control reads it now."""
        plant = self._plant
        with plant.lock:
            state, _ = plant.hands(plant.clock.now())
            load = plant.spindle.load if plant.config.measures_load else None
        return state if load is None else replace(state, spindle_load=load)


class Simulation(NamedTuple):
    """The ports for the executor, and the handle for whoever plays the operator."""

    ports: MachinePorts
    machine: PlantHands


def build_simulation(config: SimConfig, clock: Clock) -> Simulation:
    """One simulated machine on ``clock``: its ports and its handle."""
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
