"""Jog steps, speeds and directions: what can be chosen, and which key moves which axis."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.desk.status.formats import MM_PER_INCH
from app.offsets.offset_values import Mode
from core.machine.machine_model import Machine

INCH_STEPS, MM_STEPS, DEGREE_STEPS = (
    (0.1, 0.01, 0.001, 0.0001),
    (1.0, 0.1, 0.01, 0.001),
    (1.0, 0.5, 0.1, 0.02),
)
INCH_SPEEDS, MM_SPEEDS = (1.0, 5.0, 20.0, 50.0), (25.0, 125.0, 500.0, 1250.0)  # a minute
DEGREE_SPEEDS = (3.0, 15.0, 60.0, 180.0)  # a second
STEP_SPEED = 20 * MM_PER_INCH / 60  # mm/s: the longest step is over in a third of a second
STEP_SPEED_C = 60.0  # degrees/s
C_RAPID = 360.0  # degrees/s
CONTINUOUS = -1


@dataclass(slots=True)
class JogSpeeds:
    """What is chosen now; ``step`` CONTINUOUS or one of four lengths, ``speed`` one of four."""

    machine: Machine
    step: int = CONTINUOUS
    speed: int = 1

    def next_step(self) -> None:
        """Continuous, then from the longest step to the shortest, then continuous again."""
        self.step = self.step + 1 if self.step < len(INCH_STEPS) - 1 else CONTINUOUS

    def next_speed(self) -> None:
        """Faster, and from the fastest to the slowest."""
        self.speed = (self.speed + 1) % len(INCH_SPEEDS)

    def _turns(self, axis: str) -> bool:
        return self.machine.axis(axis).rotary

    def distance(self, axis: str, mode: Mode, step: int | None = None) -> float:
        """Length of a step, mm or degrees; one of X changes the figure shown, Ø or R, by its length."""
        step = self.step if step is None else step
        if self._turns(axis):
            return DEGREE_STEPS[step]
        length = MM_STEPS[step] if mode.metric else INCH_STEPS[step] * MM_PER_INCH
        return length / 2 if axis == "X" and mode.diameter else length

    def step_word(self, axis: str, mode: Mode, step: int) -> str:
        """The length of a step of this axis as it is written."""
        return _short(DEGREE_STEPS[step]) if self._turns(axis) else step_words(mode)[step]

    def step_speed(self, axis: str) -> float:
        """How fast a step goes, mm/s or degrees/s."""
        if self._turns(axis):
            return min(STEP_SPEED_C, self.machine.axis(axis).vmax)
        return min(STEP_SPEED, self.machine.limits.manual_rapid)

    def velocity(self, axis: str, mode: Mode, *, rapid: bool) -> float:
        """How fast a held jog goes, mm/s or degrees/s."""
        if self._turns(axis):
            return min(C_RAPID if rapid else DEGREE_SPEEDS[self.speed], self.machine.axis(axis).vmax)
        if rapid:
            return self.machine.limits.manual_rapid
        slow = MM_SPEEDS[self.speed] if mode.metric else INCH_SPEEDS[self.speed] * MM_PER_INCH
        return min(slow / 60, self.machine.limits.manual_rapid)


def step_words(mode: Mode) -> tuple[str, ...]:
    """The steps as they are written on their keys."""
    return tuple(_short(step) for step in (MM_STEPS if mode.metric else INCH_STEPS))


def speed_words(mode: Mode) -> tuple[str, ...]:
    """The speeds as they are written on their keys, a minute."""
    return tuple(f"{speed:g}" for speed in (MM_SPEEDS if mode.metric else INCH_SPEEDS))


def turn_words() -> tuple[str, ...]:
    """The speeds of an axis that turns, degrees a minute."""
    return tuple(f"{60 * speed:g}" for speed in DEGREE_SPEEDS)


def rapid_word(machine: Machine, mode: Mode) -> str:
    """The rapid of hand moves a minute."""
    return f"{machine.limits.manual_rapid * 60 / mode.unit:.0f}"


def _short(step: float) -> str:
    return f"{step:.4f}".rstrip("0").rstrip(".").removeprefix("0")


# --- directions ---------------------------------------------------------------------------------------


Arrow = tuple[int, int]  # right and down, as the operator sees the machine; (0, 0): none
_NO_ARROW: Arrow = (0, 0)


@dataclass(frozen=True, slots=True)
class JogDirection:
    """One target: axis and sign, its cell in the cross, and its key by Qt's name with how it is written."""

    axis: str
    sign: int
    column: int
    row: int
    key: str
    label: str
    arrow: Arrow = _NO_ARROW
    shown: str = ""  # the axis as the operator calls it, where that is another name


# A lathe from above: X+ is towards the operator, Z+ to the right.
_LATHE = (
    JogDirection("X", -1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("Z", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("Z", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("X", 1, 1, 2, "Down", "↓", (0, 1)),
)
_LATHE_C = (JogDirection("C", -1, 0, 2, "PageDown", "PgDn"), JogDirection("C", 1, 2, 2, "PageUp", "PgUp"))
# A mill from above: X+ to the right, Y+ away from the operator, Z+ up.
_MILL = (
    JogDirection("Y", 1, 1, 0, "Up", "↑", (0, -1)),
    JogDirection("X", -1, 0, 1, "Left", "←", (-1, 0)),
    JogDirection("X", 1, 2, 1, "Right", "→", (1, 0)),
    JogDirection("Y", -1, 1, 2, "Down", "↓", (0, 1)),
    JogDirection("Z", 1, 2, 0, "PageUp", "PgUp"),
    JogDirection("Z", -1, 2, 2, "PageDown", "PgDn"),
)
# Of its rotary axes in the machine's order: cells and keys of + and −.
_ROTARY = (
    ((0, 0, "Insert", "Ins"), (0, 2, "Delete", "Del")),
    ((3, 0, "BracketRight", "]"), (3, 2, "BracketLeft", "[")),
)


def directions_of(machine: Machine) -> tuple[JogDirection, ...]:
    """All targets of a machine; a lathe has those of C where its spindle can be positioned."""
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
