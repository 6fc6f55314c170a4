"""What an operator does at the simulated machine, and what breaks in it: by call, or at planned times."""

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
    """Buttons of the station and faults of the machine; every method may be called from any thread."""

    def __init__(self, plant: Plant) -> None:
        super().__init__(plant.panel, plant.touch, plant.clock)
        self._plant = plant

    @contextmanager
    def _now(self) -> Iterator[float]:
        """Keep the machine in hand, at the clock's time in seconds."""
        with self._plant.touch:
            yield self._plant.advance()

    def press_estop(self) -> None:
        """Hit the E-stop: it latches."""
        self._plant.press_estop()

    def release_estop(self) -> None:
        """Twist the E-stop free."""
        with self._now():
            self._plant.panel.estop = False

    def set_input(self, name: str, on: bool) -> None:
        """Make an input of the machine file true or false; raises DriverError for an unknown name."""
        with self._plant.touch:
            self._plant.terminals.set_input(name, on)

    # --- faults -------------------------------------------------------------------------------------------

    def jam(self, axis: str, on: bool = True) -> None:
        """Something blocks the slide."""
        with self._now():
            self._servo(axis).jammed = on

    def encoder_stuck(self, axis: str, on: bool = True) -> None:
        """The encoder no longer counts."""
        with self._now():
            servo = self._servo(axis)
            servo.stuck = servo.reading if on else None

    def runaway(self, axis: str, speed: float) -> None:
        """Its drive goes its own way at this speed, mm/s or degrees/s, while it has power; 0 mends it."""
        with self._now():
            self._servo(axis).runaway = speed

    def loose_gib(self, axis: str, play: float) -> None:
        """The slide has ``play`` mm against its screw, which each reversal loses; 0 sets the gib again."""
        with self._now():
            servo = self._servo(axis)
            servo.worn.loosen(play, servo.p)

    def encoder_ripple(self, axis: str, size: float, turn: float = TURN) -> None:
        """Its encoder is wrong by up to ``size`` mm once in each ``turn`` mm; 0 mends it."""
        with self._now():
            worn = self._servo(axis).worn
            worn.ripple, worn.turn = size, turn

    def encoder_missed(self, axis: str, size: float, turn: float = TURN) -> None:
        """Its encoder does not count ``size`` mm at one spot of each ``turn`` mm; 0 mends it."""
        with self._now():
            worn = self._servo(axis).worn
            worn.missed, worn.turn = size, turn

    def belt_slip(self, fraction: float) -> None:
        """The spindle loses up to this fraction of its speed in the cut; 0 is a belt that holds."""
        with self._now() as now:
            self._plant.spindle.faults.belt = fraction
            self._plant.spindle.cut_load(now, cutting=False)

    def push(self, axis: str, way: float) -> None:
        """Somebody moves a slide that has no power, or forces one that has."""
        with self._now():
            self._servo(axis).push(way)

    def switch_output(self, name: str, on: bool) -> None:
        """Somebody else switches an output: a fuse, a terminal, a hand at the relay."""
        with self._now() as now:
            self._plant.terminals.write(name, on, now)

    def drive_fault(self, axis: str, text: str = "drive fault") -> None:
        """A drive trips."""
        with self._plant.touch:
            self._plant.trip(f"{axis}: {text}")

    def spindle_bog(self, fraction: float) -> None:
        """The motor reaches only this fraction of what is commanded; 1 is healthy."""
        with self._now():
            self._plant.spindle.faults.bog = fraction

    def spindle_wander(self, fraction: float, period: float = 2.0) -> None:
        """The speed swings by this fraction about what is commanded, once in ``period`` seconds."""
        with self._now():
            self._plant.spindle.faults.wander = fraction
            self._plant.spindle.faults.wander_period = period

    def spindle_ignores_stop(self, on: bool = True) -> None:
        """The inverter no longer obeys when asked to slow down."""
        with self._now():
            self._plant.spindle.faults.ignores_stop = on

    def spindle_fault(self, text: str) -> None:
        """The inverter trips and the spindle coasts; an empty text mends it."""
        with self._now():
            self._plant.spindle.faults.fault = text

    def spindle_never_oriented(self, on: bool = True) -> None:
        """The drive does not say that the spindle stands at its angle, whether it does or not."""
        with self._now():
            self._plant.spindle.faults.never_oriented = on

    def collet_sensor_stuck(self, on: bool = True) -> None:
        """The collet's switch stays where it is."""
        with self._now() as now:
            self._plant.terminals.read(now)
            self._plant.terminals.sensor_stuck = on

    def station_silent(self, on: bool = True) -> None:
        """The station's cable is off."""
        with self._plant.touch:
            self._plant.panel.silence(on, self._plant.clock.now())

    def pot_noise(self, width: float) -> None:
        """A worn wiper: both pots jump by up to ``width``."""
        with self._plant.touch:
            self._plant.panel.noise = width

    # --- what only a simulation can know ------------------------------------------------------------------

    def true_position(self) -> tuple[float, ...]:
        """Where the slides really are, encoder or not."""
        with self._plant.lock:
            self._plant.advance()
            return tuple(servo.where for servo in self._plant.servos)

    def outputs(self) -> dict[str, bool]:
        """What hangs on the outputs, whatever anybody has written."""
        with self._plant.lock:
            return dict(self._plant.terminals.outputs)

    def spindle_turns(self) -> float:
        """How many turns the spindle has really made, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.turns

    def spindle_rpm(self) -> float:
        """How fast the spindle really turns."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def _servo(self, axis: str) -> Servo:
        return self._plant.servos[self._plant.names.index(axis)]


# --- What breaks by itself, and when: the faults of a machine file.


class Schedule:
    """Breaks and mends as time passes; the plant calls it with the clock's time."""

    def __init__(self, machine: PlantHands, faults: Sequence[PlannedFault]) -> None:
        self._acts: list[tuple[float, Callable[[], None]]] = []
        for fault in faults:
            breaks, mends = _acts(machine, fault)
            self._acts.append((fault.at, breaks))
            if fault.seconds > 0.0 and mends is not None:
                self._acts.append((fault.at + fault.seconds, mends))
        self._acts.sort(key=lambda act: act[0])

    def due(self, now: float) -> None:
        """Everything up to ``now``, in order."""
        while self._acts and self._acts[0][0] <= now:
            self._acts.pop(0)[1]()


def _acts(machine: PlantHands, fault: PlannedFault) -> tuple[Callable[[], None], Callable[[], None] | None]:
    """How it breaks, and how it is mended; a drive's fault stays until somebody clears it."""
    if fault.what == "estop":
        return machine.press_estop, machine.release_estop
    axis, value, text = fault.axis, fault.value, fault.text
    # What the method of this name is given to break it, and to mend it.
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
