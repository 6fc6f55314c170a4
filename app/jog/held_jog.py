"""Continuous jog while one key or touch is held down, with its steps, speeds and directions.

The motion ends when the key is released, when the window loses the keyboard, at another key or touch, after a
change of the step, after a stall of the screen, or if the key stops repeating. After such an end, nothing
moves until all keys are released and one is pressed again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

from app.desk.late_presses import Starting
from app.desk.status.formats import MM_PER_INCH
from app.desk.translation import tr
from app.offsets.offset_values import Mode
from core.executor.commands import Command, Jog, JogStep, JogStop
from core.executor.hand_motion.jog_line import Direction
from core.executor.snapshot import Snapshot, State
from core.machine.machine_model import Machine

INCH_STEPS, MM_STEPS, DEGREE_STEPS = (
    (0.1, 0.01, 0.001, 0.0001),
    (1.0, 0.1, 0.01, 0.001),
    (1.0, 0.5, 0.1, 0.02),
)
INCH_SPEEDS, MM_SPEEDS = (1.0, 5.0, 20.0, 50.0), (25.0, 125.0, 500.0, 1250.0)  # Per minute.
DEGREE_SPEEDS = (3.0, 15.0, 60.0, 180.0)  # Per second.
STEP_SPEED = 20 * MM_PER_INCH / 60  # mm/s: the longest step takes a third of a second.
STEP_SPEED_C = 60.0  # degrees/s
C_RAPID = 360.0  # degrees/s
CONTINUOUS = -1


@dataclass(slots=True)
class JogSpeeds:
    """The selected step and speed.

    ``step`` is CONTINUOUS or the index of one of four lengths. ``speed`` is the index of one of four speeds.
    """

    machine: Machine
    step: int = CONTINUOUS
    speed: int = 1

    def next_step(self) -> None:
        """Select the next step: continuous, then from the longest to the shortest, and continuous again."""
        self.step = self.step + 1 if self.step < len(INCH_STEPS) - 1 else CONTINUOUS

    def next_speed(self) -> None:
        """Select the next faster speed, or after the fastest the slowest."""
        self.speed = (self.speed + 1) % len(INCH_SPEEDS)

    def _turns(self, axis: str) -> bool:
        return self.machine.axis(axis).rotary

    def distance(self, axis: str, mode: Mode, step: int | None = None) -> float:
        """Return the length of a step in mm or degrees.

        If X is a diameter, a step of X changes the displayed diameter by the step length.
        """
        step = self.step if step is None else step
        if self._turns(axis):
            return DEGREE_STEPS[step]
        length = MM_STEPS[step] if mode.metric else INCH_STEPS[step] * MM_PER_INCH
        return length / 2 if axis == "X" and mode.diameter else length

    def step_word(self, axis: str, mode: Mode, step: int) -> str:
        """Return the length of a step of this axis as text."""
        return _short(DEGREE_STEPS[step]) if self._turns(axis) else step_words(mode)[step]

    def step_speed(self, axis: str) -> float:
        """Return the speed of a step in mm/s or degrees/s."""
        if self._turns(axis):
            return min(STEP_SPEED_C, self.machine.axis(axis).vmax)
        return min(STEP_SPEED, self.machine.limits.manual_rapid)

    def velocity(self, axis: str, mode: Mode, *, rapid: bool) -> float:
        """Return the speed of a continuous jog in mm/s or degrees/s."""
        if self._turns(axis):
            return min(C_RAPID if rapid else DEGREE_SPEEDS[self.speed], self.machine.axis(axis).vmax)
        if rapid:
            return self.machine.limits.manual_rapid
        slow = MM_SPEEDS[self.speed] if mode.metric else INCH_SPEEDS[self.speed] * MM_PER_INCH
        return min(slow / 60, self.machine.limits.manual_rapid)


def step_words(mode: Mode) -> tuple[str, ...]:
    """Return the step lengths as key labels."""
    return tuple(_short(step) for step in (MM_STEPS if mode.metric else INCH_STEPS))


def speed_words(mode: Mode) -> tuple[str, ...]:
    """Return the speeds of linear axes as key labels, in mm or inches per minute."""
    return tuple(f"{speed:g}" for speed in (MM_SPEEDS if mode.metric else INCH_SPEEDS))


def turn_words() -> tuple[str, ...]:
    """Return the speeds of rotary axes as key labels, in degrees per minute."""
    return tuple(f"{60 * speed:g}" for speed in DEGREE_SPEEDS)


def rapid_word(machine: Machine, mode: Mode) -> str:
    """Return the manual rapid speed as text, in mm or inches per minute."""
    return f"{machine.limits.manual_rapid * 60 / mode.unit:.0f}"


def _short(step: float) -> str:
    return f"{step:.4f}".rstrip("0").rstrip(".").removeprefix("0")


# --- directions ---------------------------------------------------------------------------------------


Arrow = tuple[int, int]  # Right and down, as the operator sees the machine; (0, 0): no arrow.
_NO_ARROW: Arrow = (0, 0)


@dataclass(frozen=True, slots=True)
class JogDirection:
    """One jog direction: axis and sign, its cell in the cross, and its key with Qt's name and a label."""

    axis: str
    sign: int
    column: int
    row: int
    key: str
    label: str
    arrow: Arrow = _NO_ARROW
    shown: str = ""  # The displayed name of the axis, if it differs.


# A lathe from above: X+ points toward the operator, Z+ to the right.
_LATHE = (
    JogDirection("X", -1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("Z", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("Z", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("X", 1, 1, 2, "Down", "↓", (0, 1)),
)
_LATHE_C = (JogDirection("C", -1, 0, 2, "PageDown", "PgDn"), JogDirection("C", 1, 2, 2, "PageUp", "PgUp"))
# A mill from above: X+ points to the right, Y+ away from the operator, Z+ up.
_MILL = (
    JogDirection("Y", 1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("X", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("X", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("Y", -1, 1, 2, "Down", "↓", (0, 1)),
    JogDirection("Z", 1, 2, 0, "PageUp", "PgUp"),
    JogDirection("Z", -1, 2, 2, "PageDown", "PgDn"),
)
# Cells and keys of + and − for rotary axes, in the machine's order.
_ROTARY = (
    ((0, 0, "Insert", "Ins"), (0, 2, "Delete", "Del")),
    ((3, 0, "BracketRight", "]"), (3, 2, "BracketLeft", "[")),
)


def directions_of(machine: Machine) -> tuple[JogDirection, ...]:
    """Return all jog directions of a machine. A lathe has C only if its spindle can be positioned."""
    if machine.kind != "mill":
        turning = tuple(replace(each, shown=machine.shown("C")) for each in _LATHE_C)
        return _LATHE + (turning if machine.c_enabled else ())
    found = list(_MILL)
    rotary = [axis.name for axis in machine.axes if axis.rotary]
    for name, ends in zip(rotary, _ROTARY, strict=False):
        for sign, end in zip((1, -1), ends, strict=True):
            column, row, key, label = end
            found.append(JogDirection(name, sign, column, row, key, label))
    return tuple(found)


BEGINS = 0.3  # Seconds within which the machine must begin to move.
SILENT = 0.5  # Seconds without a repeat of a repeating key, after which its release counts as lost.
RENEWED = 4  # Renewals per lease.


@dataclass(slots=True)
class Held:
    """One continuous jog while its key or touch is held down."""

    source: str
    axis: str
    velocity: float
    rapid: bool
    since: float
    posted: float
    looked: float
    repeated: float | None = None  # Time of the last key repeat; None before the first repeat.
    moving: bool = False
    along: Direction | None = None


@dataclass(slots=True)
class HeldJog:
    """The jog of one key or touch.

    ``lease`` is in seconds. ``barred`` returns why jogging is not possible now. ``clock`` returns monotonic
    time in seconds.
    """

    starting: ClassVar[Starting] = Starting.JOG
    speeds: JogSpeeds
    lease: float
    post: Callable[[Command], None]
    say: Callable[[str], None]
    clear: Callable[[], None]
    clock: Callable[[], float]
    barred: Callable[[], str]
    mode: Mode = field(default_factory=Mode)
    # Direction in a tilted plane (3D-ROT).
    along: Callable[[str], Direction | None] = field(default=lambda _axis: None)
    # Returns whether a late press must not start the action.
    refuses: Callable[[Starting], bool] = field(default=lambda _starting: False)
    held: Held | None = None
    rapid_armed: bool = False  # Rapid was selected on the screen, for the next jog only.
    button: str = ""  # Input name of the last press, if it was a button at the machine.
    down: set[str] = field(default_factory=set)  # Keys and touches that are pressed.
    _ended: str = ""  # Reason for the end of the last jog, shown again when the axis is at rest.

    def press(self, source: str, axis: str, sign: int, *, rapid: bool, button: str = "") -> None:
        """Handle a press on a direction.

        ``source`` is the key or touch. ``button`` is the input name of a button at the machine, or empty.
        """
        others, self._ended = self.down - {source}, ""
        self.rapid_armed = False
        self.down.add(source)
        if others or self.held is not None:
            self.stop(tr("TWO KEYS PRESSED, JOG STOPPED. RELEASE BOTH, THEN PRESS ONE"))
        elif self.refuses(self.starting):
            pass
        elif why := self.barred():
            self.say(why)
        else:
            self.button = button
            self._go(source, axis, sign, rapid)

    def _go(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        """Start a step or a continuous jog. Subclasses may start another motion."""
        if self.speeds.step != CONTINUOUS:
            self._step(axis, sign, rapid)
        else:
            self._begin(source, axis, sign, rapid)

    def _step(self, axis: str, sign: int, rapid: bool) -> None:
        """Start one step. Holding the key does not make the step longer."""
        if rapid:
            self.say(tr("RAPID NEEDS CONTINUOUS JOG. SELECT CONT OR RELEASE SHIFT"))
            return
        self.clear()
        distance = sign * self.speeds.distance(axis, self.mode)
        self.post(JogStep(axis, distance, self.speeds.step_speed(axis), self.along(axis)))

    def _begin(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        velocity = sign * self.speeds.velocity(axis, self.mode, rapid=rapid)
        along = self.along(axis)
        self._hold(source, axis, velocity, rapid, Jog(axis, velocity, self.lease, self.button, along))

    def _hold(self, source: str, axis: str, velocity: float, rapid: bool, command: Command) -> None:
        self.clear()
        now = self.clock()
        along = command.along if isinstance(command, Jog) else None
        self.held = Held(source, axis, velocity, rapid, now, now, now, along=along)
        self.post(command)

    def repeated(self, source: str) -> None:
        """Note a key repeat, which shows that the key is still down."""
        if self.held is not None and self.held.source == source:
            self.held.repeated = self.clock()

    def release(self, source: str) -> None:
        """Handle the release of a key or touch."""
        self.down.discard(source)
        if self.held is not None and self.held.source == source:
            self.stop("")

    def other_key(self) -> None:
        """End the jog because another key was pressed, so that the operator may not be watching the axis."""
        if self.held is not None:
            self.stop(tr("JOG STOPPED: ANOTHER KEY WAS PRESSED"))

    def shift_released(self) -> None:
        """End a rapid jog when Shift is released."""
        if self.held is not None and self.held.rapid:
            self.stop(tr("SHIFT RELEASED. RAPID STOPPED"))

    def let_go(self, why: str = "") -> None:
        """Release all keys and end the jog, because no release event will arrive."""
        self.down.clear()
        if self.held is not None:
            self.stop(why)

    def stop(self, why: str) -> None:
        """End the jog. Nothing moves until all keys are released."""
        if self.held is not None:
            self.held = None
            self.post(JogStop())
        if why:
            self._ended = why
            self.say(why)

    def look(self, snapshot: Snapshot) -> None:
        """Renew the lease of the jog, or end the jog after an error; called once a frame."""
        self.mode = Mode(snapshot.modal.metric, snapshot.reads_diameter)
        held, now = self.held, self.clock()
        if held is None:
            self._say_again(snapshot)
            return
        away, held.looked = now - held.looked, now
        if away > self.lease:
            self.stop(tr("SCREEN FROZE. JOG STOPPED"))
        elif held.repeated is not None and now - held.repeated > SILENT:
            self.stop(tr("JOG KEY SIGNAL LOST. RELEASE THE KEY, THEN PRESS IT AGAIN"))
        elif snapshot.state is State.JOG:
            held.moving = True
            self._renew(held, now)
        elif held.moving or snapshot.state is not State.IDLE or now - held.since > BEGINS:
            self.held = None  # The machine has ended the motion or never began it.
            self.post(JogStop())

    def _say_again(self, snapshot: Snapshot) -> None:
        """Show the reason of the end again, because a change of state removed the first message."""
        if self._ended and snapshot.state is not State.JOG:
            self.say(self._ended)
            self._ended = ""

    def _renew(self, held: Held, now: float) -> None:
        if now - held.posted >= self.lease / RENEWED:
            held.posted = now
            self.post(self._renewal(held))

    def _renewal(self, held: Held, /) -> Command:
        return Jog(held.axis, held.velocity, self.lease, self.button, held.along)
