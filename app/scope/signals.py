"""Signals of the scope with their quantity, unit and source.

Most signals are channels of a record. Velocity, acceleration and ripple are derived from channels.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.status.formats import MM_PER_INCH
from app.desk.translation import tr
from core.message import Message
from core.records import record
from core.records.record import Channel

FloatArray = npt.NDArray[np.float64]


class Quantity(Enum):
    """Measured quantity with its name, metric unit, inch unit and minimum range; one lane per quantity."""

    POSITION = ("POSITION", "mm", "in", 1e-3)
    ERROR = ("FOLLOWING ERROR", "mm", "in", 1e-3)
    VELOCITY = ("VELOCITY", "mm/s", tr("in/s"), 0.1)
    ACCELERATION = ("ACCELERATION", "mm/s²", tr("in/s²"), 10.0)
    ANGLE = ("ANGLE", "°", "°", 0.1)
    ANGLE_ERROR = ("FOLLOWING ERROR", "°", "°", 0.01)
    TURNING = ("ANGULAR SPEED", "°/s", "°/s", 1.0)
    TURNING_CHANGE = ("ANGULAR ACCELERATION", "°/s²", "°/s²", 10.0)
    SPINDLE = ("SPINDLE", "rpm", "rpm", 10.0)
    RIPPLE = ("SPINDLE RIPPLE", "rpm", "rpm", 1.0)
    TURNS = ("SPINDLE REVOLUTIONS", tr("turns"), tr("turns"), 1.0)
    LOAD = ("LOAD", "%", "%", 10.0)
    OVERRIDE = ("OVERRIDE", "%", "%", 10.0)
    QUEUE = ("QUEUE", "ms", "ms", 10.0)
    LATENESS = ("CYCLE DELAY", "ms", "ms", 1.0)
    NUMBER = ("LINE", "", "", 5.0)
    LOGIC = ("INPUTS AND OUTPUTS", "", "", 1.0)

    @property
    def title(self) -> str:
        """English name of the quantity."""
        return str(self.value[0])

    @property
    def least(self) -> float:
        """Smallest useful range in internal units."""
        return float(self.value[3])

    @property
    def length(self) -> bool:
        """Whether the unit depends on the choice of millimeters or inches."""
        return self.unit(True) != self.unit(False)

    def unit(self, metric: bool) -> str:
        """Return the display unit in the operator's language."""
        return tr(self.value[1] if metric else self.value[2])

    def scale(self, metric: bool) -> float:
        """Return the factor from internal units to display units."""
        if self is Quantity.OVERRIDE:
            return 100.0
        if self in {Quantity.QUEUE, Quantity.LATENESS}:
            return 1000.0
        return 1.0 / MM_PER_INCH if self.length and not metric else 1.0

    def places(self, metric: bool) -> int:
        """Return the number of decimals."""
        return _PLACES[self] + (1 if self.length and not metric else 0)


_PLACES = {
    Quantity.POSITION: 4,
    Quantity.ERROR: 4,
    Quantity.VELOCITY: 3,
    Quantity.ACCELERATION: 1,
    Quantity.ANGLE: 3,
    Quantity.ANGLE_ERROR: 4,
    Quantity.TURNING: 2,
    Quantity.TURNING_CHANGE: 1,
    Quantity.SPINDLE: 1,
    Quantity.RIPPLE: 2,
    Quantity.TURNS: 3,
    Quantity.LOAD: 1,
    Quantity.OVERRIDE: 0,
    Quantity.QUEUE: 1,
    Quantity.LATENESS: 2,
    Quantity.NUMBER: 0,
    Quantity.LOGIC: 0,
}

Derive = Callable[[FloatArray, FloatArray], FloatArray]


def _as_it_is(_times: FloatArray, values: FloatArray) -> FloatArray:
    return values


@dataclass(frozen=True, slots=True)
class Signal:
    """One curve: its channel, its calculation, and the calculation window ``span`` in seconds.

    ``letter`` is the axis, or empty for signals of the machine. ``word`` is the English name. ``raw`` is set
    if the name comes from the machine file and is not translated.
    """

    key: str
    word: str
    quantity: Quantity
    channel: str
    letter: str = ""
    derive: Derive = _as_it_is
    span: float = 0.0
    raw: bool = False

    @property
    def title(self) -> str:
        """Name of the signal in the operator's language."""
        word = self.word if self.raw else tr(self.word)
        return f"{self.letter} {word}" if self.letter else word

    @property
    def note(self) -> str:
        """Text about the calculation window, or an empty string for directly sampled signals."""
        return tr(Message("{ms} ms window", ms=f"{1000.0 * self.span:g}")) if self.span else ""

    def values(self, times: FloatArray, column: FloatArray) -> FloatArray:
        """Return the values of the signal for the samples of its channel, in internal units."""
        return self.derive(times, column)


def _speed(key: str, word: str, letter: str, channel: str, quantity: Quantity) -> Signal:
    span = record.VELOCITY_SPAN
    return Signal(key, word, quantity, channel, letter, record.velocity, span)


def _of_axis(letter: str, rotary: bool) -> list[Signal]:
    place, off, fast, faster = (
        (Quantity.ANGLE, Quantity.ANGLE_ERROR, Quantity.TURNING, Quantity.TURNING_CHANGE)
        if rotary
        else (Quantity.POSITION, Quantity.ERROR, Quantity.VELOCITY, Quantity.ACCELERATION)
    )
    demand, actual = Message("{item} demand", item=letter), Message("{item} actual", item=letter)
    span = record.ACCELERATION_SPAN
    return [
        Signal(demand, tr("commanded position"), place, demand, letter),
        Signal(actual, tr("measured position"), place, actual, letter),
        Signal(
            Message("{letter} following error", letter=letter),
            tr("following error"),
            off,
            Message("{letter} following error", letter=letter),
            letter,
        ),
        _speed(
            Message("{letter} demand velocity", letter=letter), tr("commanded velocity"), letter, demand, fast
        ),
        _speed(Message("{letter} velocity", letter=letter), tr("velocity"), letter, actual, fast),
        Signal(
            Message("{letter} acceleration", letter=letter),
            tr("acceleration"),
            faster,
            actual,
            letter,
            record.acceleration,
            span,
        ),
        Signal(
            Message("{letter} load", letter=letter),
            tr("load"),
            Quantity.LOAD,
            Message("{letter} load", letter=letter),
            letter,
        ),
    ]


_MACHINE = (
    Signal("spindle command", tr("Commanded spindle speed"), Quantity.SPINDLE, "spindle command"),
    Signal("spindle speed", tr("Measured spindle speed"), Quantity.SPINDLE, "spindle speed"),
    Signal(
        "spindle ripple",
        tr("Spindle ripple"),
        Quantity.RIPPLE,
        "spindle speed",
        "",
        record.ripple,
        record.RIPPLE_SPAN,
    ),
    Signal("spindle turns", tr("Spindle revolutions"), Quantity.TURNS, "spindle turns"),
    Signal("spindle load", tr("Spindle load"), Quantity.LOAD, "spindle load"),
    Signal("feed override", tr("Feed override"), Quantity.OVERRIDE, "feed override"),
    Signal("spindle override", tr("Spindle override"), Quantity.OVERRIDE, "spindle override"),
    Signal("queue", tr("Setpoint queue depth"), Quantity.QUEUE, "queue"),
    Signal("lateness", tr("Control cycle delay"), Quantity.LATENESS, "lateness"),
    Signal("line", tr("Line"), Quantity.NUMBER, "line"),
)


def signals_of(channels: Sequence[Channel]) -> tuple[Signal, ...]:
    """Return all signals that the channels provide, in the order of the list."""
    there = {each.name: each for each in channels}
    found: list[Signal] = []
    for channel in channels:
        letter, _, what = channel.name.partition(" ")
        if what == "demand" and len(letter) == 1:
            found += _of_axis(letter, channel.unit == "deg")
    found += _MACHINE
    for channel in channels:
        if channel.logic:
            name = channel.name.partition(" ")[2]
            found.append(Signal(channel.name, name, Quantity.LOGIC, channel.name, raw=True))
    return tuple(each for each in found if each.channel in there)


def first_chosen(signals: Sequence[Signal]) -> tuple[str, ...]:
    """Return the keys of the signals that are shown first.

    They are the following errors and velocities of the axes, and the spindle, as many as the smallest screen
    can list.
    """
    slides = [each.letter for each in signals if each.quantity is Quantity.ERROR][:3]
    wanted = [f"{letter} {name}" for name in ("following error", "velocity") for letter in slides]
    wanted += ["spindle command"] if len(slides) < 3 else []
    wanted += ["spindle speed"]
    there = {each.key for each in signals}
    return tuple(each for each in wanted if each in there)
