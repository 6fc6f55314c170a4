"""What a driver must offer.

Times are seconds of one monotonic clock; lengths are mm (X a radius), C is degrees.
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
UnknownPart = faults.UnknownPart
ALL_UNKNOWN_PARTS = faults.ALL_UNKNOWN_PARTS


class StopMode(StrEnum):
    """How to come to rest: at once and unpowered, braked then unpowered, or braked and held."""

    OFF = "off"
    RAMP_OFF = "ramp-off"
    RAMP_HOLD = "ramp-hold"


class Segments(NamedTuple):
    """Motion of all axes together in pieces of constant acceleration.

    ``t`` (n,) start times, ``dt`` (n,) lengths, ``p v a`` (n, axes) position, velocity and acceleration at
    the start of each piece. At rest after the last piece.
    """

    t: FloatArray
    dt: FloatArray
    p: FloatArray
    v: FloatArray
    a: FloatArray

    @classmethod
    def make_rest(cls, start_time_s: float, position: Sequence[float] | FloatArray) -> Segments:
        """At this place from ``t`` on: they cut off whatever was queued behind."""
        still = np.zeros((1, len(position)))
        return cls(
            np.array([start_time_s]), np.zeros(1), np.array([position], dtype=np.float64), still, still
        )


_NO_MOTION = 1e-6  # s; what rounding may leave of a last piece, on a clock of hours


def is_queue_finished(queue_end: float, now: float) -> bool:
    """Whether what was queued is over: one rule for whoever asks, with a tolerance for rounding."""
    return queue_end <= now + _NO_MOTION


class AxisSample(NamedTuple):
    """What the axes do at one instant; tuples in the sink's order of axes."""

    t: float
    demand: tuple[float, ...]
    actual: tuple[float, ...]
    following_error: tuple[float, ...]
    enabled: bool
    homed: tuple[bool, ...]
    moving: bool
    fault: str


class SampleSource(Protocol):
    """What a driver has sampled at its own rate, for the scope. The executor asks for it once a tick.

    A row is flat: time, demand of each axis, actual of each, load of each (per cent of what its drive can),
    spindle speed (rpm), spindle turns (counted), spindle load (per cent), and for how long the queue goes on
    (s). What is not told is nan. Times rise; while nothing at all changes rows may be further apart.
    """

    sample_rate_hz: float  # samples a second while something moves

    def take(self, max_rows: int = 8192) -> FloatArray:
        """What has been sampled since it was last taken, (n, 5 + 3 axes), the oldest first and ``max_rows``
        at a time; where nobody takes them the oldest are lost.
        """
        ...


class AxisSink(Protocol):
    """Where setpoints go. A queue is always a complete trajectory that ends at rest."""

    axes: tuple[str, ...]
    commit: float  # nothing before now() + commit can be changed any more

    def now(self) -> float:
        """Seconds of the driver's clock, by which setpoints are played."""
        ...

    def horizon(self) -> float:
        """End of what is queued; not before now() when something is queued."""
        ...

    def splice(self, segments: Segments) -> None:
        """Replace everything from ``segments.t[0]`` on.

        Raises DriverError unless it starts at or after now() + commit, continues position and velocity of
        what stays, and ends at rest.
        """
        ...

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Queued position and velocity at ``t``; what a splice at ``t`` has to continue."""
        ...

    def sample(self) -> AxisSample:
        """What is known of the axes now; from memory, at once."""
        ...

    def enable(self, on: bool) -> None:
        """Switch the drives of all axes on or off. Raises DriverError; a drive that then fails is a fault."""
        ...

    def stop(self, mode: StopMode) -> None:
        """Drop the queue and come to rest in this way. Raises DriverError."""
        ...

    def home(self, axis: str) -> None:
        """Begin to home this axis; ``sample`` tells when it is done. Raises DriverError."""
        ...

    def clear_fault(self) -> None:
        """Ask for a way out of a fault; ``sample`` tells whether there was one. Raises DriverError."""
        ...


class Spindle(Protocol):
    """The main spindle; rpm is signed, positive as M03 turns."""

    def run_at(self, rpm: float) -> None: ...

    def coast(self) -> None: ...

    def speed(self) -> float:
        """Measured rpm, signed."""
        ...

    def read_angle(self) -> tuple[float, float] | None:
        """(time, revolutions counted since power-up) from the encoder, or None without one."""
        ...

    def read_fault(self) -> str: ...


class SpindleCAxis(Protocol):
    """The spindle's drive as C, where it is the same drive: changed over at standstill."""

    def set_c_mode(self, enabled: bool, orient: bool = False) -> None:
        """Ask for it to be held as C, or to turn again; C keeps its count.

        ``orient``: it turns by the short way until its count is also its place from the index, in whole
        turns. Raises DriverError while it turns or has no power.
        """
        ...

    def is_c_ready(self) -> bool:
        """Whether C may move, and stays where it is put."""
        ...


class OrientingSpindle(Protocol):
    """The spindle's drive stops it at an angle and holds it there, until it is to turn or is let go."""

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        """Bring it to ``angle``, degrees from its index, 0 to under 360 and rising as M03 turns.

        ``direction``: 1 it turns there as M03 does, -1 as M04, 0 by the short way. Raises DriverError while
        it turns, without power or with a fault.
        """
        ...

    def release_spindle(self) -> None:
        """Hold it no longer; on its way to an angle it comes to rest."""
        ...

    def is_oriented(self) -> bool:
        """Whether it stands at the angle that was asked for last, and is held there."""
        ...


class Cam(NamedTuple):
    """Motion over the turns of the spindle instead of over time.

    ``way.t`` and ``way.dt`` are turns from the encoder's count ``start_revolutions`` on, in the direction
    ``sign`` in which the spindle turns; ``way.v`` and ``way.a`` are per turn. At rest until it begins and
    behind its end. ``following_segments`` goes on from that end by time; its ``t`` are seconds from there.
    """

    start_revolutions: float
    sign: float
    way: Segments
    following_segments: Segments | None = None


class GearState(NamedTuple):
    """Where on its cam a driver is: turns from ``start_revolutions``, and turns by which it is behind the
    spindle.

    ``speed`` is what the spindle turns by its encoder, turns/s, positive the way the cam counts.
    """

    revolutions: float
    lag_revolutions: float
    speed: float


class SpindleGear(Protocol):
    """Slides that follow the spindle inside the driver, at its own rate, by its own reading of the encoder.

    The slides are those of the sink beside it, the encoder counts as ``Spindle.angle``. A gear slips rather
    than ask a slide for more than it can: it falls behind and catches up. A spindle that stands leaves the
    slides standing.
    """

    def mesh(self, cam: Cam) -> None:
        """Follow the spindle; while it is being followed, replace everything from ``cam.way.t[0]`` on.

        Raises DriverError unless the way begins at or behind what the spindle will reach within the sink's
        commit, continues what stays, and ends at rest. The sink's ``demand_at`` and ``horizon`` then foretell
        from the present speed, as far as the end of the way. Its ``splice`` releases a gear that has not yet
        moved anything and is refused elsewhere; its ``stop`` brakes from wherever the slides are.
        """
        ...

    def geared(self) -> GearState | None:
        """None when the slides do not follow the spindle, or no longer."""
        ...


class DigitalIO(Protocol):
    """Inputs and outputs by the names of the machine file."""

    def inputs(self) -> Mapping[str, bool]:
        """All inputs as last told; from memory, at once."""
        ...

    def outputs(self) -> Mapping[str, bool]:
        """As they are, whoever has switched them, as far as the driver is told; else as last written."""
        ...

    def write(self, name: str, on: bool) -> None:
        """Switch one output. Raises DriverError."""
        ...

    def switch_to_safe_state(self) -> None:
        """Every output to its safe state."""
        ...


@dataclass(frozen=True, slots=True)
class StationState:
    """The operator station at one instant. ``start`` is the two-hand relay's output, never the buttons."""

    estop: bool = False
    start: bool = False
    hold: bool = False
    spindle_auto: bool = True
    spindle_pot: float = 1.0  # 0…1
    feed_pot: float = 1.0  # 0…1.5 where the machine has one
    handwheel: int = 0  # counts since power-up, where the machine has one
    age: float = 0.0  # seconds since the station last spoke
    trouble: str = ""  # what of it is gone and holds the cycle, in a sentence: a pendant pulled out
    wheel_trouble: str = ""  # why its handwheel and jog buttons are not to be believed now
    spindle_load: float | None = None  # per cent, where the machine has such an input


class Station(Protocol):
    """Buttons, pots and switches of the operator station."""

    def read_state(self) -> StationState:
        """The station as last told, with its age; from memory, at once."""
        ...


PROBE_INPUT = "probe"  # the input of a touch probe or tool setter, on while it is touched


class TouchLatch(NamedTuple):
    """Where the slides were when the input ``probe`` came on.

    ``place`` by the encoders, in the sink's order of axes; ``max_delay_s``: s by which it may have been
    taken late, so that a slide at v has been up to v · late further back.
    """

    time_s: float
    axis_positions: tuple[float, ...]
    max_delay_s: float


class TouchInput(Protocol):
    """A driver that keeps the place of a touch at its own rate. Without one a tick of the executor counts."""

    def arm_latch(self) -> None:
        """Forget what was kept; the next time that the input comes on is kept."""
        ...

    def read_latch(self) -> TouchLatch | None:
        """The first touch since it was armed; None as long as there was none."""
        ...


class Wakeup(Protocol):
    """How a driver tells by itself that something has changed: a machine at rest is then looked at ten times
    a second, and at once when it rings.
    """

    def is_settled(self) -> bool:
        """Whether nothing that a look tells changes any more without a ring. Asked at rest."""
        ...

    def wake(self) -> None:
        """From any thread: look now."""
        ...

    def wait(self, seconds: float) -> bool:
        """Until it rings, so long at most; whether it has. What rang before counts."""
        ...


class Clock(Protocol):
    """Monotonic time, and the only way to wait for it."""

    def now(self) -> float:
        """Seconds; the beginning means nothing."""
        ...

    def sleep_until(self, t: float) -> None:
        """Back at ``t`` or a little later; at once where that is past."""
        ...


@dataclass(frozen=True, slots=True)
class MachinePorts:
    """Everything the executor drives, put together in one place of the app."""

    clock: Clock
    axes: AxisSink
    spindle: Spindle
    io: DigitalIO
    station: Station
    warnings: Sequence[str] = ()
    gear: SpindleGear | None = None  # None: threads follow the spindle by setpoints in time
    lock: SpindleCAxis | None = None  # None: C has a drive of its own, or needs no change-over
    orientation: OrientingSpindle | None = None  # None: the spindle stops anywhere
    blocks: BlockController | None = None  # a controller that plans by itself: it takes no setpoints
    trip_monitor: faults.TrippingDriverHost | None = (
        None  # None: nothing switches off by itself when the control is silent
    )
    untraced: str = ""  # why the drives do not follow every setpoint, but only the end of each move
    wakeup: Wakeup | None = None  # None: it is looked at in every tick, at rest too
    samples: SampleSource | None = None  # None: the scope has what the axes say at each tick
    # What is not known now. The ports go on to tell the last that was known of it, and nobody may take that
    # for the present: a spindle of which nothing is heard may turn. Known again once its wire tells it anew.
    unknown: Callable[[], frozenset[UnknownPart]] = frozenset
    # Seconds by which a slow wire delays a command to the spindle and the measured speed that shows it.
    spindle_lag: Callable[[], float] = float
    touch: TouchInput | None = None  # None: where a touch was is known to a tick of the executor
    # Stops slides and spindle, outputs safe, by a way of its own: for the watchdog, from any thread and again
    # and again, when the executor is dead or stuck. It never waits for what the executor may hold.
    halt_machine: Callable[[], None] | None = None
