"""Jog with a key or touch that is held down, and the step lengths and speeds of the jog.

The motion ends when one of these events occurs:

- The key is released or stops repeating.
- The window loses the keyboard focus.
- Another key or touch is pressed.
- The jog step is changed.
- The screen stalls.

If the motion ended for another reason than a release, no axis moves again until all keys are released and a
key is pressed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

from app.desk.late_presses import BlockedLateAction
from app.desk.status.formats import MM_PER_INCH
from app.desk.translation import tr
from app.offsets.offset_values import UnitMode
from core.executor.commands import Command, Jog, JogByStep, StopJog
from core.executor.hand_motion.jog_line import Direction
from core.executor.snapshot import MachineState, Snapshot
from core.machine.machine_model import Machine

INCH_STEPS, MM_STEPS, DEGREE_STEPS = (
    (0.1, 0.01, 0.001, 0.0001),
    (1.0, 0.1, 0.01, 0.001),
    (1.0, 0.5, 0.1, 0.02),
)
INCH_SPEEDS, MM_SPEEDS = (1.0, 5.0, 20.0, 50.0), (25.0, 125.0, 500.0, 1250.0)  # Per minute.
ROTARY_SPEEDS_DEG_S = (3.0, 15.0, 60.0, 180.0)  # Per second.
STEP_SPEED_MM_S = 20 * MM_PER_INCH / 60  # mm/s: the longest step takes a third of a second.
ROTARY_STEP_SPEED_DEG_S = 60.0  # degrees/s
ROTARY_RAPID_DEG_S = 360.0  # degrees/s
CONTINUOUS_STEP_INDEX = -1


@dataclass(slots=True)
class JogSpeeds:
    """Selected jog step and jog speed.

    ``step_index`` is CONTINUOUS_STEP_INDEX or the index of one of four step lengths. ``speed_index`` is the
    index of one of four speeds.
    """

    machine: Machine
    step_index: int = CONTINUOUS_STEP_INDEX
    speed_index: int = 1

    def select_next_step(self) -> None:
        """Select the next jog step.

        The order is continuous, then the steps from the longest to the shortest, and then continuous again.
        """
        self.step_index = (
            self.step_index + 1 if self.step_index < len(INCH_STEPS) - 1 else CONTINUOUS_STEP_INDEX
        )

    def select_next_speed(self) -> None:
        """Select the next faster speed, or the slowest speed after the fastest."""
        self.speed_index = (self.speed_index + 1) % len(INCH_SPEEDS)

    def _turns(self, axis: str) -> bool:
        return self.machine.find_axis(axis).is_rotary

    def find_step_length(self, axis: str, value_mode: UnitMode, step_index: int | None = None) -> float:
        """Return the travel of an axis in one jog step, in mm or degrees.

        If X is displayed as a diameter, one step changes the displayed diameter by the selected length. The
        travel of X is then half of the selected length.
        """
        step_index = self.step_index if step_index is None else step_index
        if self._turns(axis):
            return DEGREE_STEPS[step_index]
        length = MM_STEPS[step_index] if value_mode.is_metric else INCH_STEPS[step_index] * MM_PER_INCH
        return length / 2 if axis == "X" and value_mode.is_diameter else length

    def format_step(self, axis: str, value_mode: UnitMode, step_index: int) -> str:
        """Return the length of a jog step for one axis as text."""
        return (
            _short(DEGREE_STEPS[step_index])
            if self._turns(axis)
            else make_step_labels(value_mode)[step_index]
        )

    def find_step_speed(self, axis: str) -> float:
        """Return the speed of a jog step in mm/s or degrees/s."""
        if self._turns(axis):
            return min(ROTARY_STEP_SPEED_DEG_S, self.machine.find_axis(axis).max_speed)
        return min(STEP_SPEED_MM_S, self.machine.limits.manual_rapid)

    def find_continuous_speed(self, axis: str, value_mode: UnitMode, *, is_rapid: bool) -> float:
        """Return the speed of a continuous jog in mm/s or degrees/s."""
        if self._turns(axis):
            return min(
                ROTARY_RAPID_DEG_S if is_rapid else ROTARY_SPEEDS_DEG_S[self.speed_index],
                self.machine.find_axis(axis).max_speed,
            )
        if is_rapid:
            return self.machine.limits.manual_rapid
        slow = (
            MM_SPEEDS[self.speed_index]
            if value_mode.is_metric
            else INCH_SPEEDS[self.speed_index] * MM_PER_INCH
        )
        return min(slow / 60, self.machine.limits.manual_rapid)


def make_step_labels(value_mode: UnitMode) -> tuple[str, ...]:
    """Return the lengths of the jog steps as key labels."""
    return tuple(_short(step) for step in (MM_STEPS if value_mode.is_metric else INCH_STEPS))


def make_speed_labels(value_mode: UnitMode) -> tuple[str, ...]:
    """Return the jog speeds of linear axes as key labels, in mm or inches per minute."""
    return tuple(f"{speed:g}" for speed in (MM_SPEEDS if value_mode.is_metric else INCH_SPEEDS))


def make_rotary_speed_labels() -> tuple[str, ...]:
    """Return the jog speeds of rotary axes as key labels, in degrees per minute."""
    return tuple(f"{60 * speed:g}" for speed in ROTARY_SPEEDS_DEG_S)


def format_rapid_speed(machine: Machine, value_mode: UnitMode) -> str:
    """Return the manual rapid speed as text, in mm or inches per minute."""
    return f"{machine.limits.manual_rapid * 60 / value_mode.unit_length_mm:.0f}"


def _short(step: float) -> str:
    return f"{step:.4f}".rstrip("0").rstrip(".").removeprefix("0")


# --- directions ---------------------------------------------------------------------------------------


ArrowPoint = tuple[int, int]  # Right and down, as the operator sees the machine; (0, 0): no arrow.
_NO_ARROW: ArrowPoint = (0, 0)


@dataclass(frozen=True, slots=True)
class JogDirection:
    """Jog direction: its axis and sign, its key, and its cell in the cross of arrow keys.

    ``key_name`` is the Qt name of the key, and ``label`` is the text on the key.
    """

    axis_name: str
    direction_sign: int
    cell_column: int
    cell_row: int
    key_name: str
    label: str
    arrow_direction: ArrowPoint = _NO_ARROW
    displayed_axis_name: str = ""  # The displayed name of the axis, if it differs.


# A lathe from above: X+ points toward the operator, Z+ to the right.
_LATHE_DIRECTIONS = (
    JogDirection("X", -1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("Z", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("Z", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("X", 1, 1, 2, "Down", "↓", (0, 1)),
)
_LATHE_C_DIRECTIONS = (
    JogDirection("C", -1, 0, 2, "PageDown", "PgDn"),
    JogDirection("C", 1, 2, 2, "PageUp", "PgUp"),
)
# A mill from above: X+ points to the right, Y+ away from the operator, Z+ up.
_MILL_DIRECTIONS = (
    JogDirection("Y", 1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("X", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("X", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("Y", -1, 1, 2, "Down", "↓", (0, 1)),
    JogDirection("Z", 1, 2, 0, "PageUp", "PgUp"),
    JogDirection("Z", -1, 2, 2, "PageDown", "PgDn"),
)
# Cells and keys of + and − for rotary axes, in the machine's order.
_ROTARY_DIRECTIONS = (
    ((0, 0, "Insert", "Ins"), (0, 2, "Delete", "Del")),
    ((3, 0, "BracketRight", "]"), (3, 2, "BracketLeft", "[")),
)


def make_jog_directions(machine: Machine) -> tuple[JogDirection, ...]:
    """Return all jog directions of a machine.

    A lathe has jog directions for C only if its spindle can be positioned as an axis.
    """
    if machine.kind != "mill":
        turning = tuple(
            replace(each, displayed_axis_name=machine.get_displayed_axis_name("C"))
            for each in _LATHE_C_DIRECTIONS
        )
        return _LATHE_DIRECTIONS + (turning if machine.is_c_enabled else ())
    found = list(_MILL_DIRECTIONS)
    rotary = [axis.name for axis in machine.axes if axis.is_rotary]
    for name, ends in zip(rotary, _ROTARY_DIRECTIONS, strict=False):
        for sign, end in zip((1, -1), ends, strict=True):
            column, row, key, label = end
            found.append(JogDirection(name, sign, column, row, key, label))
    return tuple(found)


MOTION_TIMEOUT_S = 0.3  # Seconds within which the machine must begin to move.
REPEAT_TIMEOUT_S = 0.5  # Seconds without a repeat of a repeating key, after which its release counts as lost.
RENEWALS_PER_LEASE = 4  # Renewals per lease.


@dataclass(slots=True)
class ActiveJog:
    """Continuous jog that remains active while its key or touch is held down."""

    input_source: str
    axis_name: str
    velocity: float
    is_rapid: bool
    start_time_s: float
    last_post_time_s: float
    last_update_time_s: float
    key_repeat_time_s: float | None = None  # Time of the last key repeat; None before the first repeat.
    is_moving: bool = False
    direction: Direction | None = None


@dataclass(slots=True)
class HeldJog:
    """Jog that runs while a key or touch is held down.

    ``motion_lease_s`` is the time in seconds after which the control stops the motion unless the lease is
    renewed. ``find_refusal`` returns the reason why jogging is not possible now, or an empty string if it
    is possible. ``read_clock`` returns a monotonic time in seconds.
    """

    starting_action: ClassVar[BlockedLateAction] = BlockedLateAction.JOG
    jog_speeds: JogSpeeds
    motion_lease_s: float
    post_command: Callable[[Command], None]
    show_message: Callable[[str], None]
    clear_message: Callable[[], None]
    read_clock: Callable[[], float]
    find_refusal: Callable[[], str]
    value_mode: UnitMode = field(default_factory=UnitMode)
    # Direction in a tilted plane (3D-ROT).
    find_direction: Callable[[str], Direction | None] = field(default=lambda _axis: None)
    # Returns whether a late press must not start the action.
    refuses_late_press: Callable[[BlockedLateAction], bool] = field(default=lambda _starting: False)
    active_jog: ActiveJog | None = None
    is_rapid_armed: bool = False  # Rapid was selected on the screen, for the next jog only.
    last_button_name: str = ""  # Input name of the last press, if it was a button at the machine.
    pressed_keys: set[str] = field(default_factory=set)  # Keys and touches that are pressed.
    _ended: str = ""  # Reason for the end of the last jog, shown again when the axis is at rest.

    def handle_direction_press(
        self, key_source: str, axis: str, direction_sign: int, *, is_rapid: bool, button_name: str = ""
    ) -> None:
        """Handle a press on a jog direction. ``key_source`` identifies the key or touch.

        ``button_name`` is the input name of a jog button on the machine, or an empty string for other keys.
        """
        others, self._ended = self.pressed_keys - {key_source}, ""
        self.is_rapid_armed = False
        self.pressed_keys.add(key_source)
        if others or self.active_jog is not None:
            self.stop_jog(tr("TWO KEYS PRESSED, JOG STOPPED. RELEASE BOTH, THEN PRESS ONE"))
        elif self.refuses_late_press(self.starting_action):
            pass
        elif why := self.find_refusal():
            self.show_message(why)
        else:
            self.last_button_name = button_name
            self._start_jog(key_source, axis, direction_sign, is_rapid)

    def _start_jog(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        """Start a step or a continuous jog.

        A subclass can start another type of motion.
        """
        if self.jog_speeds.step_index != CONTINUOUS_STEP_INDEX:
            self._start_step(axis, sign, rapid)
        else:
            self._begin(source, axis, sign, rapid)

    def _start_step(self, axis: str, sign: int, rapid: bool) -> None:
        """Jog the axis by one step.

        Holding the key down does not make the step longer.
        """
        if rapid:
            self.show_message(tr("RAPID NEEDS CONTINUOUS JOG. SELECT CONT OR RELEASE SHIFT"))
            return
        self.clear_message()
        distance = sign * self.jog_speeds.find_step_length(axis, self.value_mode)
        self.post_command(
            JogByStep(axis, distance, self.jog_speeds.find_step_speed(axis), self.find_direction(axis))
        )

    def _begin(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        velocity = sign * self.jog_speeds.find_continuous_speed(axis, self.value_mode, is_rapid=rapid)
        along = self.find_direction(axis)
        self._hold(
            source,
            axis,
            velocity,
            rapid,
            Jog(axis, velocity, self.motion_lease_s, self.last_button_name, along),
        )

    def _hold(self, source: str, axis: str, velocity: float, rapid: bool, command: Command) -> None:
        self.clear_message()
        now = self.read_clock()
        along = command.along if isinstance(command, Jog) else None
        self.active_jog = ActiveJog(source, axis, velocity, rapid, now, now, now, direction=along)
        self.post_command(command)

    def record_key_repeat(self, key_source: str) -> None:
        """Store the time of a key repeat, which shows that the key is still held down."""
        if self.active_jog is not None and self.active_jog.input_source == key_source:
            self.active_jog.key_repeat_time_s = self.read_clock()

    def release_key(self, key_source: str) -> None:
        """Handle the release of a key or touch."""
        self.pressed_keys.discard(key_source)
        if self.active_jog is not None and self.active_jog.input_source == key_source:
            self.stop_jog("")

    def stop_for_other_key(self) -> None:
        """Stop the jog because another key was pressed.

        An operator who presses another key may no longer be watching the axis.
        """
        if self.active_jog is not None:
            self.stop_jog(tr("JOG STOPPED: ANOTHER KEY WAS PRESSED"))

    def release_shift_key(self) -> None:
        """Stop a rapid jog when Shift is released."""
        if self.active_jog is not None and self.active_jog.is_rapid:
            self.stop_jog(tr("SHIFT RELEASED. RAPID STOPPED"))

    def release_all_keys(self, reason: str = "") -> None:
        """Treat all keys as released and stop the jog, because release events may be lost."""
        self.pressed_keys.clear()
        if self.active_jog is not None:
            self.stop_jog(reason)

    def stop_jog(self, reason: str) -> None:
        """Stop the jog.

        No axis moves again until all keys are released.
        """
        if self.active_jog is not None:
            self.active_jog = None
            self.post_command(StopJog())
        if reason:
            self._ended = reason
            self.show_message(reason)

    def update(self, snapshot: Snapshot) -> None:
        """Renew the motion lease of the jog, or stop the jog if it is no longer permitted.

        This method is called once per frame.
        """
        self.value_mode = UnitMode(snapshot.modal.metric, snapshot.shows_diameter)
        held, now = self.active_jog, self.read_clock()
        if held is None:
            self._repeat_reason(snapshot)
            return
        away, held.last_update_time_s = now - held.last_update_time_s, now
        if away > self.motion_lease_s:
            self.stop_jog(tr("SCREEN FROZE. JOG STOPPED"))
        elif held.key_repeat_time_s is not None and now - held.key_repeat_time_s > REPEAT_TIMEOUT_S:
            self.stop_jog(tr("JOG KEY SIGNAL LOST. RELEASE THE KEY, THEN PRESS IT AGAIN"))
        elif snapshot.state is MachineState.JOG:
            held.is_moving = True
            self._renew(held, now)
        elif (
            held.is_moving
            or snapshot.state is not MachineState.IDLE
            or now - held.start_time_s > MOTION_TIMEOUT_S
        ):
            self.active_jog = None  # The machine has ended the motion or never began it.
            self.post_command(StopJog())

    def _repeat_reason(self, snapshot: Snapshot) -> None:
        """Show again why the jog stopped, if a change of the machine state has cleared the message."""
        if self._ended and snapshot.state is not MachineState.JOG:
            self.show_message(self._ended)
            self._ended = ""

    def _renew(self, held: ActiveJog, now: float) -> None:
        if now - held.last_post_time_s >= self.motion_lease_s / RENEWALS_PER_LEASE:
            held.last_post_time_s = now
            self.post_command(self._renewal(held))

    def _renewal(self, held: ActiveJog, /) -> Command:
        return Jog(held.axis_name, held.velocity, self.motion_lease_s, self.last_button_name, held.direction)
