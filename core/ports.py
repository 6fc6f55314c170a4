"""Interfaces that drivers implement for the executor.

Times are in seconds of one monotonic clock. Lengths are in millimeters, X is a radius, and C is in degrees.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from core import faults
from core.block_ports import BlockController

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
Fault = faults.Fault
FaultCode = faults.FaultCode
DriverError = faults.DriverError
UnknownPart = faults.UnknownMachinePart
ALL_UNKNOWN_PARTS = faults.ALL_UNKNOWN_PARTS


class StopMode(StrEnum):
    """Stop modes of the axes: remove power at once, brake and remove power, or brake and keep power."""

    OFF = "off"
    RAMP_OFF = "ramp-off"
    RAMP_HOLD = "ramp-hold"


class MotionSegments(NamedTuple):
    """Motion of all axes as a sequence of segments with constant acceleration.

    ``start_times_s`` (n,) contains the start times and ``durations_s`` (n,) the durations. ``positions``,
    ``velocities`` and ``accelerations`` (n, axes) contain the position, velocity and acceleration at the
    start of each segment. The axes are at rest after the last segment.
    """

    start_times_s: FloatArray
    durations_s: FloatArray
    positions: FloatArray
    velocities: FloatArray
    accelerations: FloatArray

    @classmethod
    def make_standstill(cls, start_time_s: float, position: Sequence[float] | FloatArray) -> MotionSegments:
        """Return segments that hold this position from ``start_time_s`` on.

        Splicing these segments into the queue discards all motion that was queued after this time.
        """
        still = np.zeros((1, len(position)))
        return cls(
            np.array([start_time_s]), np.zeros(1), np.array([position], dtype=np.float64), still, still
        )


_NO_MOTION = 1e-6  # s; what rounding may leave of a last piece, on a clock of hours


def is_queue_finished(queue_end: float, now: float) -> bool:
    """Return whether the queue has ended, with a tolerance for rounding.

    All callers use this function, so that they apply the same rule.
    """
    return queue_end <= now + _NO_MOTION


class AxisSample(NamedTuple):
    """State of the axes at one time; the tuples are in the axis order of the axis sink."""

    t: float
    demand: tuple[float, ...]
    actual: tuple[float, ...]
    following_error: tuple[float, ...]
    enabled: bool
    homed: tuple[bool, ...]
    moving: bool
    fault: str


class SampleSource(Protocol):
    """Source of the samples that a driver records at its own rate, for the scope.

    The executor reads the samples once per tick. Each row contains, in this order:

    - the time, and the demand and actual position of each axis
    - the load of each axis, in percent of what its drive can deliver
    - the spindle speed (rpm), the counted spindle revolutions and the spindle load (percent)
    - the remaining time of the setpoint queue (s)

    Values that are not reported are NaN. Times increase; rows may be further apart while no value changes.
    """

    sample_rate_hz: float  # samples a second while something moves

    def take_samples(self, max_rows: int = 8192) -> FloatArray:
        """Return and remove the samples since the last call, as an array (n, 5 + 3 axes), oldest first.

        A call returns at most ``max_rows`` rows. If samples are not read in time, the oldest ones are lost.
        """
        ...


class AxisSink(Protocol):
    """Interface for axis setpoints, whose queue always contains a complete path that ends at rest."""

    axes: tuple[str, ...]
    commit: float  # nothing before now() + commit can be changed any more

    def now(self) -> float:
        """Return the time of the clock by which the driver executes setpoints, in seconds."""
        ...

    def horizon(self) -> float:
        """Return the end time of the setpoint queue in seconds.

        While motion is queued, this time is not earlier than now().
        """
        ...

    def splice(self, segments: MotionSegments) -> None:
        """Replace all queued motion from ``segments.start_times_s[0]`` on.

        Raises DriverError unless the segments start at or after now() + commit, continue the position and
        velocity of the remaining queue, and end at rest. Also raises DriverError if the drives have no
        power, if an axis is homing, or if the segments exceed the limits of an axis.
        """
        ...

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued position and velocity at ``time_s``.

        A splice at this time must continue both.
        """
        ...

    def sample(self) -> AxisSample:
        """Return the current state of the axes from memory, without waiting."""
        ...

    def enable(self, is_on: bool) -> None:
        """Switch the drives of all axes on or off.

        Raises DriverError if the driver cannot switch them. A drive that fails later reports a fault.
        """
        ...

    def stop(self, mode: StopMode) -> None:
        """Discard the setpoint queue and stop the axes in the given mode.

        Raises DriverError if the driver fails.
        """
        ...

    def home(self, axis: str) -> None:
        """Start homing an axis; ``sample`` reports when homing has ended.

        Raises DriverError if homing cannot start, for example without power or while an axis is moving.
        """
        ...

    def clear_fault(self) -> None:
        """Request that the drive fault is cleared; ``sample`` reports whether a fault remains.

        Raises DriverError if the fault cannot be cleared or the driver fails.
        """
        ...


class Spindle(Protocol):
    """The main spindle. Its speed in rpm is signed; M03 is positive."""

    def set_speed(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed; 0 stops the spindle."""
        ...

    def start_coasting(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        ...

    def speed(self) -> float:
        """Return the measured, signed speed in rpm."""
        ...

    def read_angle(self) -> tuple[float, float] | None:
        """Return the encoder's time and revolutions since power-up, or None without an encoder."""
        ...

    def read_fault(self) -> str:
        """Return the fault of the spindle drive, or an empty string without a fault."""
        ...


class SpindleCAxis(Protocol):
    """A spindle drive that also serves as the C axis; the mode is changed at standstill."""

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        """Request C-axis mode or spindle mode; the position count of C is retained.

        If ``should_orient`` is True, the spindle then turns by the shortest path until the angle of the
        position count equals the spindle angle from the index (modulo 360°). A request for C-axis mode
        raises DriverError if the spindle turns (reason SPINDLE_TURNS), if it has no power, or if C has a
        fault.
        """
        ...

    def is_c_ready(self) -> bool:
        """Return whether C-axis mode is active, so that C can move and holds its position."""
        ...


class OrientingSpindle(Protocol):
    """A spindle whose drive can stop it at an angle and hold it there.

    The drive holds the spindle until it is commanded to turn or is released.
    """

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        """Turn the spindle to ``angle`` in degrees from its index, from 0 to less than 360.

        The angle increases in the direction of M03. ``direction`` is 1 for the direction of M03, -1 for the
        direction of M04, or 0 for the shortest path. Raises DriverError if the spindle turns (reason
        SPINDLE_TURNS), has no power or has a fault.
        """
        ...

    def release_spindle(self) -> None:
        """Release the spindle from its angle; stop it if it is still turning to the angle."""
        ...

    def is_oriented(self) -> bool:
        """Return whether the drive holds the spindle at the last requested angle."""
        ...


class Cam(NamedTuple):
    """Electronic cam: motion of the axes as a function of spindle revolutions instead of time.

    ``segments.start_times_s`` and ``segments.durations_s`` are revolutions from the encoder count
    ``start_revolutions`` on, in the direction ``sign`` of the spindle. ``segments.velocities`` and
    ``segments.accelerations`` are per revolution. The axes are at rest before and after the cam.
    ``following_segments`` is motion as a function of time after the cam; its ``start_times_s`` are seconds
    from the end of the cam.
    """

    start_revolutions: float
    sign: float
    segments: MotionSegments
    following_segments: MotionSegments | None = None


class GearState(NamedTuple):
    """State of an electronic gear: the position on its cam, the lag of the axes, and the spindle speed.

    The position is in revolutions from ``start_revolutions``. ``lag_revolutions`` is the number of
    revolutions by which the axes lag the spindle. ``speed`` is the spindle speed from the encoder in
    revolutions per second, positive in the direction of the cam.
    """

    cam_revolutions: float
    lag_revolutions: float
    speed: float


class SpindleGear(Protocol):
    """Electronic gearing of the axes to the spindle inside the driver.

    The driver uses its own encoder reading at its own rate. The axes are those of the sink of the same
    machine, and the encoder counts as in ``Spindle.read_angle``. The gear slips instead of exceeding the
    limits of an axis: the axis lags and then catches up. If the spindle stops, the axes stop too.
    """

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle with a cam, or replace the rest of an active cam.

        The replacement starts at ``cam.segments.start_times_s[0]``. Raises DriverError unless the cam
        starts at or after the position that the spindle will reach within the sink's commit time, continues
        the remaining motion, and ends at rest. Also raises DriverError if:

        - the drives have no power
        - the spindle does not turn in the direction of the cam
        - the axes are not at rest before a first cam
        - the cam exceeds the limits of an axis

        The sink's ``demand_at`` and ``horizon`` then predict from the current speed, up to the end of the
        cam. Its ``splice`` releases a gear that has not moved an axis yet and is rejected otherwise. Its
        ``stop`` brakes from the current position of the axes.
        """
        ...

    def geared(self) -> GearState | None:
        """Return the state of the gear, or None if the axes do not follow the spindle."""
        ...


class DigitalIO(Protocol):
    """Digital inputs and outputs by their names in the machine file."""

    def inputs(self) -> Mapping[str, bool]:
        """Return the last reported state of all inputs from memory, without waiting."""
        ...

    def get_outputs(self) -> Mapping[str, bool]:
        """Return the current state of all outputs, even if a device other than the control switched them.

        An output whose state is not reported to the driver has the last written state.
        """
        ...

    def write(self, name: str, is_on: bool) -> None:
        """Switch an output on or off.

        Raises DriverError if the machine file does not define the output, or if the driver cannot switch
        it.
        """
        ...

    def switch_to_safe_state(self) -> None:
        """Switch every output to its safe state."""
        ...


@dataclass(frozen=True, slots=True)
class StationState:
    """State of the operator station at one instant.

    ``start`` is the output of the two-hand relay, not the state of the buttons.
    """

    estop: bool = False
    start: bool = False
    hold: bool = False
    spindle_auto: bool = True
    spindle_pot: float = 1.0  # 0…1
    feed_pot: float = 1.0  # 0…1.5 where the machine has one
    handwheel: int = 0  # counts since power-up, where the machine has one
    age: float = 0.0  # seconds since the last report of the station
    trouble: str = ""  # the reason for a feed hold, such as a disconnected pendant
    wheel_trouble: str = ""  # the reason why handwheel and jog buttons are ignored now
    spindle_load: float | None = None  # percent, if the machine has such an input


class OperatorStation(Protocol):
    """Interface of the operator station, with its buttons, potentiometers and switches."""

    def read_state(self) -> StationState:
        """Return the last reported state of the station with its age, from memory and without waiting."""
        ...


PROBE_INPUT = "probe"  # the input of a touch probe or tool setter, on while it is touched


class TouchLatch(NamedTuple):
    """Latched position of the axes at the instant when the input ``probe`` turned on.

    ``axis_positions`` are encoder positions in the axis order of the sink. ``max_delay_s`` is the maximum
    delay of the reading in seconds. At axis speed v, the true touch position may therefore be up to v ×
    ``max_delay_s`` before the recorded position.
    """

    time_s: float
    axis_positions: tuple[float, ...]
    max_delay_s: float


class TouchInput(Protocol):
    """A driver input that latches the axis positions at a probe touch, at the driver's own rate.

    Without such an input, the executor reads the positions once per tick.
    """

    def arm_latch(self) -> None:
        """Clear the latch; the next rising edge of the input is latched."""
        ...

    def read_latch(self) -> TouchLatch | None:
        """Return the first touch since the latch was armed, or None if there was no touch."""
        ...


class WakeupSignal(Protocol):
    """A signal by which a driver reports that something has changed.

    With this signal, the executor polls a machine at rest only ten times per second, and immediately after
    a wakeup.
    """

    def can_rely_on_wakeups(self) -> bool:
        """Return whether the driver announces every further change with a wakeup.

        The executor calls this function only while the machine is at rest.
        """
        ...

    def request_poll(self) -> None:
        """Request an immediate poll; any thread may call this function."""
        ...

    def wait_for_wakeup(self, seconds: float) -> bool:
        """Wait for a wakeup for at most ``seconds``; return whether a wakeup occurred.

        A wakeup that occurred before the call counts.
        """
        ...


class Clock(Protocol):
    """Monotonic clock, and the only permitted function for waiting until a time."""

    def now(self) -> float:
        """Return the time in seconds from an arbitrary origin."""
        ...

    def sleep_until(self, time_s: float) -> None:
        """Wait until ``time_s`` or slightly later; return immediately if ``time_s`` is in the past."""
        ...


@dataclass(frozen=True, slots=True)
class MachinePorts:
    """All ports that the executor uses to access the machine, assembled in one place of the app."""

    clock: Clock
    axes: AxisSink
    spindle: Spindle
    io: DigitalIO
    station: OperatorStation
    warnings: Sequence[str] = ()
    gear: SpindleGear | None = None  # None: threads follow the spindle by setpoints in time
    lock: SpindleCAxis | None = None  # None if C has a separate drive or does not change over
    orientation: OrientingSpindle | None = None  # None: the spindle stops anywhere
    blocks: BlockController | None = None  # controller that plans motion from blocks, not setpoints
    trip_monitor: faults.TrippingDriverHost | None = (
        None  # None if nothing trips when the control does not respond
    )
    untraced: str = ""  # the reason why the drives follow only the end of each move
    wakeup: WakeupSignal | None = None  # None if the executor polls in every tick, also at rest
    samples: SampleSource | None = None  # None if the scope records the axes at each tick
    # Parts whose state is unknown now. The ports still return the last known values, which must not be used
    # as present values: a spindle that does not report may turn. A new report makes the state known again.
    unknown: Callable[[], frozenset[UnknownPart]] = frozenset
    # Seconds by which a slow line delays a spindle command and the measured speed.
    spindle_lag: Callable[[], float] = float
    touch: TouchInput | None = None  # None if a touch is detected only at a tick of the executor
    # Stops axes and spindle and switches the outputs to their safe states. The watchdog calls this function
    # repeatedly from its thread if the executor has ended or is stuck. It never waits for locks of the
    # executor.
    halt_machine: Callable[[], None] | None = None
