"""Operator actions and simulated faults of the simulated machine, called directly or scheduled."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from core.ports import DriverError
from drivers.operator_station import StationControls
from drivers.simulated.simulated_table import PlannedFault
from drivers.simulators.plant import SimulatedPlant
from drivers.simulators.servo_axis import SCREW_LEAD_MM, SimulatedServo


class PlantControls(StationControls):
    """Controls of the operator station and simulated faults of the machine.

    Any thread may call the methods.
    """

    def __init__(self, plant: SimulatedPlant) -> None:
        super().__init__(plant.station_panel, plant.action_lock, plant.clock)
        self._plant = plant

    @contextmanager
    def _locked_time(self) -> Iterator[float]:
        """Lock the machine, and yield the clock time in seconds while the machine is locked."""
        with self._plant.action_lock:
            yield self._plant.advance()

    def press_estop(self) -> None:
        """Press the E-stop, which latches until it is released."""
        self._plant.press_estop()

    def release_estop(self) -> None:
        """Release the E-stop."""
        with self._locked_time():
            self._plant.station_panel.estop = False

    def set_input(self, name: str, on: bool) -> None:
        """Set an input of the machine file.

        Raises DriverError if the input does not exist.
        """
        with self._plant.action_lock:
            self._plant.terminals.set_input(name, on)

    # --- faults -------------------------------------------------------------------------------------------

    def jam(self, axis: str, jammed: bool = True) -> None:
        """Jam an axis mechanically, or release it if ``jammed`` is False."""
        with self._locked_time():
            self._servo(axis).jammed = jammed

    def encoder_stuck(self, axis: str, stuck: bool = True) -> None:
        """Freeze the encoder reading of an axis, or unfreeze it if ``stuck`` is False."""
        with self._locked_time():
            servo = self._servo(axis)
            servo.stuck = servo.reading if stuck else None

    def runaway(self, axis: str, speed: float) -> None:
        """Make a powered axis move at ``speed`` regardless of its setpoints; 0 ends the fault.

        The speed is in mm/s or degrees/s.
        """
        with self._locked_time():
            self._servo(axis).runaway = speed

    def loose_gib(self, axis: str, play_mm: float) -> None:
        """Simulate a loose gib: the slide loses ``play_mm`` at each reversal; 0 ends the fault."""
        with self._locked_time():
            servo = self._servo(axis)
            servo.worn.set_gib_play(play_mm, servo.p)

    def encoder_ripple(self, axis: str, amplitude_mm: float, period_mm: float = SCREW_LEAD_MM) -> None:
        """Give the encoder of an axis a periodic error; an amplitude of 0 ends the fault.

        The error has an amplitude of ``amplitude_mm`` and a period of ``period_mm``.
        """
        with self._locked_time():
            worn = self._servo(axis).worn
            worn.ripple, worn.turn = amplitude_mm, period_mm

    def encoder_missed(self, axis: str, lost_mm: float, period_mm: float = SCREW_LEAD_MM) -> None:
        """Make an encoder miss ``lost_mm`` of travel once per ``period_mm``; 0 ends the fault."""
        with self._locked_time():
            worn = self._servo(axis).worn
            worn.missed, worn.turn = lost_mm, period_mm

    def belt_slip(self, fraction: float) -> None:
        """Make the spindle lose up to ``fraction`` of its speed while a tool is cutting; 0 ends the fault."""
        with self._locked_time() as now:
            self._plant.spindle.faults.belt_slip_fraction = fraction
            self._plant.spindle.set_cutting(now, is_cutting=False)

    def push(self, axis: str, distance: float) -> None:
        """Displace an axis by ``distance``, as if by hand, with or without power."""
        with self._locked_time():
            self._servo(axis).push(distance)

    def switch_output(self, name: str, state: bool) -> None:
        """Switch an output independently of the control.

        This simulates a blown fuse or a manually operated relay.
        """
        with self._locked_time() as now:
            self._plant.terminals.write(name, state, now)

    def drive_fault(self, axis: str, text: str = "drive fault") -> None:
        """Trip the drive of an axis with ``text`` as the fault text."""
        with self._plant.action_lock:
            self._plant.trip_drives(f"{axis}: {text}")

    def spindle_bog(self, fraction: float) -> None:
        """Limit the spindle to a fraction of its commanded speed, as under overload; 1 ends the fault."""
        with self._locked_time():
            self._plant.spindle.faults.speed_fraction = fraction

    def spindle_wander(self, fraction: float, period: float = 2.0) -> None:
        """Make the spindle speed oscillate by ``fraction`` of the speed; ``period`` is in seconds."""
        with self._locked_time():
            self._plant.spindle.faults.oscillation_fraction = fraction
            self._plant.spindle.faults.oscillation_period_s = period

    def spindle_ignores_stop(self, ignored: bool = True) -> None:
        """Make the inverter ignore commands for a lower speed, or obey them if ``ignored`` is False."""
        with self._locked_time():
            self._plant.spindle.faults.is_stop_ignored = ignored

    def spindle_fault(self, text: str) -> None:
        """Trip the inverter with ``text`` as the fault text, so that the spindle coasts.

        An empty string ends the fault.
        """
        with self._locked_time():
            self._plant.spindle.faults.fault_text = text

    def spindle_never_oriented(self, never_oriented: bool = True) -> None:
        """Prevent the report of an oriented spindle, or permit it again if ``never_oriented`` is False."""
        with self._locked_time():
            self._plant.spindle.faults.is_never_oriented = never_oriented

    def collet_sensor_stuck(self, stuck: bool = True) -> None:
        """Freeze the collet switch in its current state, or release it if ``stuck`` is False."""
        with self._locked_time() as now:
            self._plant.terminals.read_inputs(now)
            self._plant.terminals.is_collet_sensor_stuck = stuck

    def station_silent(self, silent: bool = True) -> None:
        """Disconnect the operator station, or connect the station again."""
        with self._plant.action_lock:
            self._plant.station_panel.set_cable_disconnected(silent, self._plant.clock.now())

    def pot_noise(self, width: float) -> None:
        """Add noise with an amplitude of ``width`` to both potentiometers, as a worn wiper causes."""
        with self._plant.action_lock:
            self._plant.station_panel.noise_amplitude = width

    # --- true states, known only in a simulation ----------------------------------------------------------

    def get_true_positions(self) -> tuple[float, ...]:
        """Return the true positions of the axes, which do not depend on the encoders."""
        with self._plant.lock:
            self._plant.advance()
            return tuple(servo.where for servo in self._plant.servos)

    def outputs(self) -> dict[str, bool]:
        """Return the actual states of the outputs by name."""
        with self._plant.lock:
            return dict(self._plant.terminals.output_states)

    def spindle_turns(self) -> float:
        """Return the true revolutions of the spindle, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.revolutions

    def get_spindle_rpm(self) -> float:
        """Return the true spindle speed in rpm, signed."""
        with self._plant.lock:
            self._plant.advance()
            return self._plant.spindle.speed

    def _servo(self, axis: str) -> SimulatedServo:
        return self._plant.servos[self._plant.axis_names.index(axis)]


# --- Scheduled faults of a machine file.


class FaultSchedule:
    """Schedule that starts and ends faults at specified times.

    The plant calls ``apply_due_actions`` with the time of its clock.
    """

    def __init__(self, machine: PlantControls, faults: Sequence[PlannedFault]) -> None:
        self._acts: list[tuple[float, Callable[[], None]]] = []
        for fault in faults:
            breaks, mends = _fault_actions(machine, fault)
            self._acts.append((fault.at, breaks))
            if fault.seconds > 0.0 and mends is not None:
                self._acts.append((fault.at + fault.seconds, mends))
        self._acts.sort(key=lambda act: act[0])

    def apply_due_actions(self, now: float) -> None:
        """Apply all scheduled actions that are due at time ``now``, in order."""
        while self._acts and self._acts[0][0] <= now:
            self._acts.pop(0)[1]()


def _fault_actions(
    machine: PlantControls, fault: PlannedFault
) -> tuple[Callable[[], None], Callable[[], None] | None]:
    """Return the action that starts a fault and the action that ends the fault.

    For a drive fault, the second action is None, because the fault remains active until it is cleared.
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
