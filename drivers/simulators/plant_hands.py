"""Operator actions and faults of the simulated machine, by call or at scheduled times."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from core.ports import DriverError
from drivers.operator_station import StationHands
from drivers.simulated.simulated_table import PlannedFault
from drivers.simulators.plant import Plant
from drivers.simulators.servo_axis import TURN, Servo


class PlantHands(StationHands):
    """Controls of the operator station and faults of the machine, callable from any thread."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant.panel, plant.touch, plant.clock)
        self._plant = plant

    @contextmanager
    def _now(self) -> Iterator[float]:
        """Lock the machine and yield the time of the clock in seconds."""
        with self._plant.touch:
            yield self._plant.advance()

    def press_estop(self) -> None:
        """Press the E-stop, which latches."""
        self._plant.press_estop()

    def release_estop(self) -> None:
        """Release the E-stop."""
        with self._now():
            self._plant.panel.estop = False

    def set_input(self, name: str, on: bool) -> None:
        """Set an input of the machine file. Raises DriverError for an unknown name."""
        with self._plant.touch:
            self._plant.terminals.set_input(name, on)

    # --- faults -------------------------------------------------------------------------------------------

    def jam(self, axis: str, on: bool = True) -> None:
        """Block an axis mechanically, or free it."""
        with self._now():
            self._servo(axis).jammed = on

    def encoder_stuck(self, axis: str, on: bool = True) -> None:
        """Freeze the encoder reading of an axis, or release it."""
        with self._now():
            servo = self._servo(axis)
            servo.stuck = servo.reading if on else None

    def runaway(self, axis: str, speed: float) -> None:
        """Make a powered axis move at ``speed`` regardless of its setpoints; 0 ends the fault.

        The speed is in mm/s or degrees/s.
        """
        with self._now():
            self._servo(axis).runaway = speed

    def loose_gib(self, axis: str, play: float) -> None:
        """Give an axis ``play`` mm of lost motion at each reversal; 0 ends the fault."""
        with self._now():
            servo = self._servo(axis)
            servo.worn.loosen(play, servo.p)

    def encoder_ripple(self, axis: str, size: float, turn: float = TURN) -> None:
        """Give an encoder an error of amplitude ``size`` mm that repeats every ``turn`` mm; 0 ends it."""
        with self._now():
            worn = self._servo(axis).worn
            worn.ripple, worn.turn = size, turn

    def encoder_missed(self, axis: str, size: float, turn: float = TURN) -> None:
        """Make an encoder lose ``size`` mm once in every ``turn`` mm; 0 ends the fault."""
        with self._now():
            worn = self._servo(axis).worn
            worn.missed, worn.turn = size, turn

    def belt_slip(self, fraction: float) -> None:
        """Make the spindle lose up to this fraction of its speed while cutting; 0 ends the fault."""
        with self._now() as now:
            self._plant.spindle.faults.belt = fraction
            self._plant.spindle.cut_load(now, cutting=False)

    def push(self, axis: str, way: float) -> None:
        """Displace an axis by hand, with or without power."""
        with self._now():
            self._servo(axis).push(way)

    def switch_output(self, name: str, on: bool) -> None:
        """Switch an output independently of the control, as a fuse or a manually operated relay does."""
        with self._now() as now:
            self._plant.terminals.write(name, on, now)

    def drive_fault(self, axis: str, text: str = "drive fault") -> None:
        """Trip the drive of an axis."""
        with self._plant.touch:
            self._plant.trip(f"{axis}: {text}")

    def spindle_bog(self, fraction: float) -> None:
        """Limit the spindle to this fraction of the commanded speed; 1 ends the fault."""
        with self._now():
            self._plant.spindle.faults.bog = fraction

    def spindle_wander(self, fraction: float, period: float = 2.0) -> None:
        """Make the spindle speed oscillate by this fraction, with a period in seconds."""
        with self._now():
            self._plant.spindle.faults.wander = fraction
            self._plant.spindle.faults.wander_period = period

    def spindle_ignores_stop(self, on: bool = True) -> None:
        """Make the inverter ignore commands for a lower speed."""
        with self._now():
            self._plant.spindle.faults.ignores_stop = on

    def spindle_fault(self, text: str) -> None:
        """Trip the inverter so that the spindle coasts; an empty text ends the fault."""
        with self._now():
            self._plant.spindle.faults.fault = text

    def spindle_never_oriented(self, on: bool = True) -> None:
        """Prevent the drive from reporting that the spindle is oriented."""
        with self._now():
            self._plant.spindle.faults.never_oriented = on

    def collet_sensor_stuck(self, on: bool = True) -> None:
        """Freeze the collet switch in its present state."""
        with self._now() as now:
            self._plant.terminals.read(now)
            self._plant.terminals.sensor_stuck = on

    def station_silent(self, on: bool = True) -> None:
        """Disconnect the operator station, or connect it again."""
        with self._plant.touch:
            self._plant.panel.silence(on, self._plant.clock.now())

    def pot_noise(self, width: float) -> None:
        """Add noise of up to ``width`` to both pots, as a worn wiper does."""
        with self._plant.touch:
            self._plant.panel.noise = width

    # --- true states, known only in a simulation ----------------------------------------------------------

    def true_position(self) -> tuple[float, ...]:
        """Return the true positions of the axes, independent of the encoders."""
        with self._plant.lock:
            self._plant.advance()
            return tuple(servo.where for servo in self._plant.servos)

    def outputs(self) -> dict[str, bool]:
        """Return the actual states of the outputs by name."""
        with self._plant.lock:
            return dict(self._plant.terminals.outputs)

    def spindle_turns(self) -> float:
        """Return the true revolutions of the spindle, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.turns

    def spindle_rpm(self) -> float:
        """Return the true spindle speed in rpm, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def _servo(self, axis: str) -> Servo:
        return self._plant.servos[self._plant.names.index(axis)]


# --- Scheduled faults of a machine file.


class Schedule:
    """Schedule that starts and ends faults; the plant calls it with the time of the clock."""

    def __init__(self, machine: PlantHands, faults: Sequence[PlannedFault]) -> None:
        self._acts: list[tuple[float, Callable[[], None]]] = []
        for fault in faults:
            breaks, mends = _acts(machine, fault)
            self._acts.append((fault.at, breaks))
            if fault.seconds > 0.0 and mends is not None:
                self._acts.append((fault.at + fault.seconds, mends))
        self._acts.sort(key=lambda act: act[0])

    def due(self, now: float) -> None:
        """Apply all scheduled actions up to ``now`` in order."""
        while self._acts and self._acts[0][0] <= now:
            self._acts.pop(0)[1]()


def _acts(machine: PlantHands, fault: PlannedFault) -> tuple[Callable[[], None], Callable[[], None] | None]:
    """Return the action that starts a fault and the action that ends it.

    The second is None for a drive fault, which remains until it is cleared.
    """
    if fault.what == "estop":
        return machine.press_estop, machine.release_estop
    axis, value, text = fault.axis, fault.value, fault.text
    # Arguments of the method of this name that start the fault and that end it.
    known: dict[str, tuple[tuple[object, ...], tuple[object, ...] | None]] = {
        "jam": ((axis,), (axis, False)),
        "encoder_stuck": ((axis,), (axis, False)),
        "runaway": ((axis, value), (axis, 0.0)),
        "loose_gib": ((axis, value), (axis, 0.0)),
        "encoder_ripple": ((axis, value, fault.turn), (axis, 0.0)),
        "encoder_missed": ((axis, value, fault.turn), (axis, 0.0)),
        "belt_slip": ((value,), (0.0,)),
        "drive_fault": ((axis, text or "drive fault"), None),
        "spindle_bog": ((value,), (1.0,)),
        "spindle_wander": ((value,), (0.0,)),
        "spindle_ignores_stop": ((), (False,)),
        "spindle_fault": ((text or "spindle drive fault",), ("",)),
        "spindle_never_oriented": ((), (False,)),
        "collet_sensor_stuck": ((), (False,)),
        "station_silent": ((), (False,)),
        "pot_noise": ((value,), (0.0,)),
    }
    if fault.what not in known:
        raise DriverError("the simulator cannot simulate the fault {what}", what=f"{fault.what!r}")
    act, (breaks, mends) = getattr(machine, fault.what), known[fault.what]
    return partial(act, *breaks), None if mends is None else partial(act, *mends)
