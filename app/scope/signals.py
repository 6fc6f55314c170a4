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
    """Measured quantities, each with its name, metric unit, inch unit and minimum range.

    The chart has one lane per quantity.
    """

    POSITION = ("POSITION", "mm", "in", 1e-3)
    FOLLOWING_ERROR = ("FOLLOWING ERROR", "mm", "in", 1e-3)
    VELOCITY = ("VELOCITY", "mm/s", tr("in/s"), 0.1)
    ACCELERATION = ("ACCELERATION", "mm/s²", tr("in/s²"), 10.0)
    ANGLE = ("ANGLE", "°", "°", 0.1)
    ANGLE_ERROR = ("FOLLOWING ERROR", "°", "°", 0.01)
    ROTATION_SPEED = ("ANGULAR SPEED", "°/s", "°/s", 1.0)
    ROTATION_ACCELERATION = ("ANGULAR ACCELERATION", "°/s²", "°/s²", 10.0)
    SPINDLE = ("SPINDLE", "rpm", "rpm", 10.0)
    SPEED_RIPPLE = ("SPINDLE RIPPLE", "rpm", "rpm", 1.0)
    REVOLUTIONS = ("SPINDLE REVOLUTIONS", tr("turns"), tr("turns"), 1.0)
    LOAD = ("LOAD", "%", "%", 10.0)
    OVERRIDE = ("OVERRIDE", "%", "%", 10.0)
    QUEUE_TIME = ("QUEUE", "ms", "ms", 10.0)
    DELAY = ("CYCLE DELAY", "ms", "ms", 1.0)
    LINE_NUMBER = ("LINE", "", "", 5.0)
    LOGIC_LEVEL = ("INPUTS AND OUTPUTS", "", "", 1.0)

    @property
    def title(self) -> str:
        """Return the English name of the quantity."""
        return str(self.value[0])

    @property
    def smallest_range(self) -> float:
        """Return the smallest useful range in internal units."""
        return float(self.value[3])

    @property
    def is_length(self) -> bool:
        """Return whether the quantity is displayed in millimeters or inches, as the operator selects."""
        return self.unit(True) != self.unit(False)

    def unit(self, is_metric: bool) -> str:
        """Return the display unit in the operator's language."""
        return tr(self.value[1] if is_metric else self.value[2])

    def find_display_scale(self, is_metric: bool) -> float:
        """Return the factor from internal units to display units."""
        if self is Quantity.OVERRIDE:
            return 100.0
        if self in {Quantity.QUEUE_TIME, Quantity.DELAY}:
            return 1000.0
        return 1.0 / MM_PER_INCH if self.is_length and not is_metric else 1.0

    def places(self, is_metric: bool) -> int:
        """Return the number of decimals of a displayed value."""
        return _DECIMALS[self] + (1 if self.is_length and not is_metric else 0)


_DECIMALS = {
    Quantity.POSITION: 4,
    Quantity.FOLLOWING_ERROR: 4,
    Quantity.VELOCITY: 3,
    Quantity.ACCELERATION: 1,
    Quantity.ANGLE: 3,
    Quantity.ANGLE_ERROR: 4,
    Quantity.ROTATION_SPEED: 2,
    Quantity.ROTATION_ACCELERATION: 1,
    Quantity.SPINDLE: 1,
    Quantity.SPEED_RIPPLE: 2,
    Quantity.REVOLUTIONS: 3,
    Quantity.LOAD: 1,
    Quantity.OVERRIDE: 0,
    Quantity.QUEUE_TIME: 1,
    Quantity.DELAY: 2,
    Quantity.LINE_NUMBER: 0,
    Quantity.LOGIC_LEVEL: 0,
}

DeriveValues = Callable[[FloatArray, FloatArray], FloatArray]


def _as_it_is(_times: FloatArray, values: FloatArray) -> FloatArray:
    return values


@dataclass(frozen=True, slots=True)
class ScopeSignal:
    """Signal that the scope can show as a curve, calculated from one channel.

    ``calculation_window_s`` is the length of the calculation window in seconds. ``axis_letter`` is the axis,
    or empty for signals of the machine. ``display_name`` is the English name. ``is_untranslated`` is True if
    the name comes from the machine file.
    """

    key: str
    display_name: str
    quantity: Quantity
    channel_name: str
    axis_letter: str = ""
    derive_values: DeriveValues = _as_it_is
    calculation_window_s: float = 0.0
    is_untranslated: bool = False

    @property
    def title(self) -> str:
        """Return the name of the signal in the operator's language."""
        word = self.display_name if self.is_untranslated else tr(self.display_name)
        return f"{self.axis_letter} {word}" if self.axis_letter else word

    @property
    def note(self) -> str:
        """Return the text about the calculation window, or an empty string for directly sampled signals."""
        return (
            tr(Message("{ms} ms window", ms=f"{1000.0 * self.calculation_window_s:g}"))
            if self.calculation_window_s
            else ""
        )

    def calculate_values(self, times: FloatArray, column: FloatArray) -> FloatArray:
        """Return the values of the signal for the samples of its channel, in internal units."""
        return self.derive_values(times, column)


def _speed(key: str, word: str, letter: str, channel: str, quantity: Quantity) -> ScopeSignal:
    span = record.DEFAULT_VELOCITY_SPAN_S
    return ScopeSignal(key, word, quantity, channel, letter, record.calculate_velocity, span)


def _of_axis(letter: str, rotary: bool) -> list[ScopeSignal]:
    place, off, fast, faster = (
        (Quantity.ANGLE, Quantity.ANGLE_ERROR, Quantity.ROTATION_SPEED, Quantity.ROTATION_ACCELERATION)
        if rotary
        else (Quantity.POSITION, Quantity.FOLLOWING_ERROR, Quantity.VELOCITY, Quantity.ACCELERATION)
    )
    demand, actual = Message("{item} demand", item=letter), Message("{item} actual", item=letter)
    span = record.ACCELERATION_SPAN_S
    return [
        ScopeSignal(demand, tr("commanded position"), place, demand, letter),
        ScopeSignal(actual, tr("measured position"), place, actual, letter),
        ScopeSignal(
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
        ScopeSignal(
            Message("{letter} acceleration", letter=letter),
            tr("acceleration"),
            faster,
            actual,
            letter,
            record.calculate_acceleration,
            span,
        ),
        ScopeSignal(
            Message("{letter} load", letter=letter),
            tr("load"),
            Quantity.LOAD,
            Message("{letter} load", letter=letter),
            letter,
        ),
    ]


_MACHINE_SIGNALS = (
    ScopeSignal("spindle command", tr("Commanded spindle speed"), Quantity.SPINDLE, "spindle command"),
    ScopeSignal("spindle speed", tr("Measured spindle speed"), Quantity.SPINDLE, "spindle speed"),
    ScopeSignal(
        "spindle ripple",
        tr("Spindle ripple"),
        Quantity.SPEED_RIPPLE,
        "spindle speed",
        "",
        record.calculate_speed_ripple,
        record.RIPPLE_SPAN_S,
    ),
    ScopeSignal("spindle turns", tr("Spindle revolutions"), Quantity.REVOLUTIONS, "spindle turns"),
    ScopeSignal("spindle load", tr("Spindle load"), Quantity.LOAD, "spindle load"),
    ScopeSignal("feed override", tr("Feed override"), Quantity.OVERRIDE, "feed override"),
    ScopeSignal("spindle override", tr("Spindle override"), Quantity.OVERRIDE, "spindle override"),
    ScopeSignal("queue", tr("Setpoint queue depth"), Quantity.QUEUE_TIME, "queue"),
    ScopeSignal("lateness", tr("Control cycle delay"), Quantity.DELAY, "lateness"),
    ScopeSignal("line", tr("Line"), Quantity.LINE_NUMBER, "line"),
)


def list_signals(channels: Sequence[Channel]) -> tuple[ScopeSignal, ...]:
    """Return all signals that the channels provide, in the order of the signal list."""
    there = {each.name: each for each in channels}
    found: list[ScopeSignal] = []
    for channel in channels:
        letter, _, what = channel.name.partition(" ")
        if what == "demand" and len(letter) == 1:
            found += _of_axis(letter, channel.unit == "deg")
    found += _MACHINE_SIGNALS
    for channel in channels:
        if channel.logic:
            name = channel.name.partition(" ")[2]
            found.append(
                ScopeSignal(channel.name, name, Quantity.LOGIC_LEVEL, channel.name, is_untranslated=True)
            )
    return tuple(each for each in found if each.channel_name in there)


def find_default_signal_keys(signals: Sequence[ScopeSignal]) -> tuple[str, ...]:
    """Return the keys of the signals that the scope shows initially.

    These are the following errors and velocities of the axes, and the spindle. The number is limited to the
    rows that fit on the smallest screen.
    """
    slides = [each.axis_letter for each in signals if each.quantity is Quantity.FOLLOWING_ERROR][:3]
    wanted = [f"{letter} {name}" for name in ("following error", "velocity") for letter in slides]
    wanted += ["spindle command"] if len(slides) < 3 else []
    wanted += ["spindle speed"]
    there = {each.key for each in signals}
    return tuple(each for each in wanted if each in there)
