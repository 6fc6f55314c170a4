"""Texts and units for position, feed, spindle and lamps of one snapshot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from app.desk.status import formats
from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.ports import Unknown

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import Swivel

# --- lamps --------------------------------------------------------------------------------------------


TURNING = 1.0  # Speed in rpm above which a spindle counts as turning.
AT_ZERO = 0.01  # Tolerance in degrees within which a table counts as being at 0.
UNKNOWN = "?"  # Replaces an unknown value, or follows the last known value.
LATHE = ("X", "Z", "C")


@dataclass(frozen=True, slots=True)
class Lamp:
    """A word on the screen that lights, with the key that switches it, if any."""

    word: str
    lit: bool
    key: str = ""
    warn: bool = False


def modes_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """Return the lamps of the four run switches. NO COUNT is included only while it is on."""
    return (
        Lamp("SINGLE BLOCK", snapshot.single_block, "S"),
        Lamp("OPTIONAL STOP", snapshot.optional_stop, "O"),
        Lamp("BLOCK DELETE", snapshot.block_delete, "/"),
        Lamp("CYCLE REPEAT", snapshot.cycle_repeat, "C"),
        *((Lamp("NO COUNT", lit=True, key="P", warn=True),) if snapshot.no_count else ()),
    )


def lamps_of(snapshot: Snapshot, *, table: bool = True) -> tuple[Lamp, ...]:
    """Return the lamps of the spindle, coolant, collet and live tool, or of a mill's rotary axes.

    The outputs are identified by their names in the machine file (coolant, collet, live1 …). ``table`` is
    True if a rotary table turns on this mill.
    """
    if snapshot.axes != LATHE:
        return (
            _spindle_lamp(snapshot),
            _output_lamp(snapshot, Lamp("COOLANT", "coolant" in snapshot.outputs)),
            *_rotary_lamps(snapshot, table=table),
        )
    live = Lamp("LIVE TOOL", any(name.startswith("live") for name in snapshot.outputs))
    coolant = Lamp("COOLANT", "coolant" in snapshot.outputs)
    if Unknown.OUTPUTS in snapshot.unknown and "collet" not in snapshot.absent:
        collet = Lamp("COLLET ?", lit=True, warn=True)
    else:
        collet = _collet_lamp(snapshot)
    return (_spindle_lamp(snapshot), _output_lamp(snapshot, coolant), collet, _output_lamp(snapshot, live))


def drives_lamp(snapshot: Snapshot, key: str = "") -> Lamp:
    """Return the lamp of the drives, which lights while the drives have power.

    An alarm also removes the power. Without a response of the drives, the lamp shows a question mark.
    """
    if Unknown.SLIDES in snapshot.unknown:
        return Lamp("DRIVES ?", lit=True, key=key, warn=True)
    return Lamp("DRIVES ON", snapshot.powered, key)


def _output_lamp(snapshot: Snapshot, lamp: Lamp) -> Lamp:
    """Return the lamp, or a lamp with a question mark if the outputs are unknown."""
    if Unknown.OUTPUTS not in snapshot.unknown:
        return lamp
    return Lamp(Message("{word} {unknown}", word=lamp.word, unknown=UNKNOWN), lit=True, warn=True)


def _rotary_lamps(snapshot: Snapshot, *, table: bool) -> tuple[Lamp, ...]:
    """Return the lamps of a mill for the tilted plane and for a table or head that is not at 0."""
    tilted = snapshot.swivel is not None and snapshot.swivel.system.tilted
    rotary = zip(snapshot.axes, snapshot.actual, strict=True)
    turned = any(abs(math.remainder(at, 360.0)) > AT_ZERO for name, at in rotary if name in "ABC")
    return Lamp("TILTED PLANE", lit=tilted), Lamp("TABLE ROTATED" if table else "HEAD ROTATED", lit=turned)


def _spindle_lamp(snapshot: Snapshot) -> Lamp:
    """Return the spindle's lamp, which depends on the measured speed, so that it also shows coasting."""
    if Unknown.SPINDLE in snapshot.unknown:
        return Lamp("SPINDLE UNKNOWN", lit=True, warn=True)
    if snapshot.orienting:
        return Lamp("SPINDLE ORIENTING", lit=True, warn=True)
    if snapshot.oriented is not None:
        return Lamp("SPINDLE ORIENTED", lit=True)
    turning = abs(snapshot.rpm_actual) > TURNING
    if turning and snapshot.rpm_command == 0:
        return Lamp("SPINDLE COASTING", lit=True, warn=True)
    if turning:
        return Lamp("SPINDLE REV" if snapshot.rpm_actual < 0 else "SPINDLE FWD", lit=True)
    return Lamp("SPINDLE", lit=False)


def _collet_lamp(snapshot: Snapshot) -> Lamp:
    """Return the collet's lamp. It depends on the output and not on the program's modal state."""
    if "collet" in snapshot.absent:
        return Lamp("MANUAL COLLET", lit=False)
    if "collet" in snapshot.outputs:
        return Lamp("COLLET CLOSED", lit=True)
    return Lamp("COLLET OPEN", lit=True, warn=True)


# --- positions of a mill ------------------------------------------------------------------------------


ANGLE_PLACES = 3  # Decimals of a rotary axis on the screen.
_SLIDES = 3


def plane_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Return the tip's position in the working plane in mm, and the angles of the rotary axes in degrees."""
    zero = swivel.system.kinematics.zero
    return (*swivel.system.place.point(_slides(snapshot.actual)), *_shown(snapshot, swivel, zero))


def home_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Return the positions of the linear axes from home in mm, and the rotary axes in degrees."""
    return (*_slides(snapshot.actual), *_shown(snapshot, swivel, {}))


def figures_to_go(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Return the distance to go of the block, along the axes of the working plane and the rotary axes."""
    end = snapshot.block_end if snapshot.block else snapshot.actual
    here, there = (swivel.system.place.point(_slides(at)) for at in (snapshot.actual, end))
    slides = (goal - at for goal, at in zip(there, here, strict=True))
    return (*slides, *(b - a for a, b in zip(snapshot.actual[_SLIDES:], end[_SLIDES:], strict=True)))


def system_words(swivel: Swivel | None) -> str:
    """Return the name of the coordinate system of the displayed positions."""
    if swivel is None:
        return tr("MACHINE")
    if not swivel.system.tilted:
        return tr("WORKPIECE")
    return tr(Message("TILTED PLANE FROM LINE {line}", line=swivel.system.line))


def rotary_angle(degrees: float) -> str:
    """Return the angle of a rotary axis in degrees as text."""
    return formats.fixed(degrees, ANGLE_PLACES)


def _slides(at: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = at[:_SLIDES]
    return x, y, z


def _shown(snapshot: Snapshot, swivel: Swivel, zero: Mapping[str, float]) -> list[float]:
    """Return the rotary axes from their zeros. A modulo axis is between 0 and 360 degrees."""
    found = []
    for name, at in zip(snapshot.axes[_SLIDES:], snapshot.actual[_SLIDES:], strict=True):
        axis, angle = swivel.system.kinematics.rotary(name), at - zero.get(name, 0.0)
        wraps = axis is not None and axis.modulo
        found.append(round(angle, ANGLE_PLACES) % 360.0 if wraps else angle)
    return found


ROTARY = frozenset("ABC")  # Axes in degrees.


class Readout(StrEnum):
    """The kind of value that the large position display shows."""

    POSITION = "POSITION"
    TO_GO = "DISTANCE TO GO"
    HOME = "FROM HOME"

    @property
    def following(self) -> Readout:
        """The next kind of value, in a cycle."""
        order = list(Readout)
        return order[(order.index(self) + 1) % len(order)]


@dataclass(frozen=True, slots=True)
class AxisFigures:
    """One row of the position display.

    ``mark`` is Ø or R for X. ``beside`` is the second value. If ``known`` is False, the axis does not
    respond, and the values are the last known ones.
    """

    name: str
    mark: str
    value: str
    beside: str
    homed: bool
    known: bool = True


@dataclass(frozen=True, slots=True)
class PositionFigures:
    """The position display. All values have one unit and come from one snapshot."""

    readout: Readout
    beside: Readout
    unit: str
    x_words: str
    axes: tuple[AxisFigures, ...]


def coordinates(snapshot: Snapshot, readout: Readout) -> tuple[float, ...]:
    """Return the values of a readout in the order of ``snapshot.axes``, in mm or degrees. X is a radius."""
    actual, swivel = snapshot.actual, snapshot.swivel
    if swivel is not None:
        return _OF_MILL[readout](snapshot, swivel)
    if readout is Readout.HOME:
        return _wrapped(actual, snapshot)
    if readout is Readout.TO_GO:
        end = snapshot.block_end if snapshot.block else actual
        return tuple(there - here for there, here in zip(end, actual, strict=True))
    x, z, *rest = actual
    if snapshot.axes == LATHE:
        rest[0] -= snapshot.modal.offset_c
    return _wrapped((x - snapshot.offset[0], z - snapshot.offset[1], *rest), snapshot)


_OF_MILL = {
    Readout.POSITION: plane_figures,
    Readout.TO_GO: figures_to_go,
    Readout.HOME: home_figures,
}


def _wrapped(at: tuple[float, ...], snapshot: Snapshot) -> tuple[float, ...]:
    """Return the position with C between 0 and 360 degrees, if the modal state wraps C."""
    if not snapshot.modal.wraps_c:
        return at
    return (*at[:-1], round(at[-1], formats.ANGLE_PLACES) % 360.0)


def position_figures(
    snapshot: Snapshot, readout: Readout, with_c: bool, metric: bool, third_axis: str = "C"
) -> PositionFigures:
    """Return both values of every axis. The second value is the distance to go, or the position.

    ``metric`` selects mm, otherwise inches. ``with_c`` includes the C axis of a lathe, under the name
    ``third_axis``.
    """
    diameter = snapshot.reads_diameter
    beside = Readout.POSITION if readout is Readout.TO_GO else Readout.TO_GO
    large, small = (_figures(snapshot, r, metric, diameter) for r in (readout, beside))
    mark = "" if snapshot.axes != LATHE else "Ø" if diameter else "R"
    known = Unknown.SLIDES not in snapshot.unknown
    names = (*snapshot.axes[:2], third_axis) if snapshot.axes == LATHE else snapshot.axes
    rows = [
        AxisFigures(name, mark if name == "X" else "", a, b, homed, known)
        for name, a, b, homed in zip(names, large, small, snapshot.homed, strict=True)
    ]
    return PositionFigures(
        readout=readout,
        beside=beside,
        unit=_unit(metric, snapshot.modal.metric),
        x_words=_words(snapshot, readout),
        axes=tuple(rows if with_c or snapshot.axes != LATHE else rows[:2]),
    )


def _words(snapshot: Snapshot, readout: Readout) -> str:
    """Return whether X is a diameter or radius on a lathe, or the coordinate system on a mill."""
    if snapshot.axes != LATHE:
        return system_words(None if readout is Readout.HOME else snapshot.swivel)
    words = tr("X IS A DIAMETER") if snapshot.reads_diameter else tr("X IS A RADIUS")
    if snapshot.reads_diameter == snapshot.modal.diameter:
        return words
    return join_messages(
        "  ·  ", (words, tr("CONTROL USES G72 Ø") if snapshot.modal.diameter else tr("CONTROL USES G73 R"))
    )


def _unit(metric: bool, control: bool) -> str:
    """Return the unit of the values, with a note if the control uses the other unit."""
    names = ("INCH", "MM")
    return (
        names[metric]
        if metric == control
        else Message("{names}  ·  CONTROL USES {names2}", names=names[metric], names2=names[control])
    )


def _figures(snapshot: Snapshot, readout: Readout, metric: bool, diameter: bool) -> list[str]:
    angle = formats.angle if snapshot.axes == LATHE else rotary_angle
    turning = () if snapshot.axes == LATHE and snapshot.modal.linear_c else ROTARY
    return [
        angle(value) if name in turning else formats.length(_doubled(name, value, diameter), metric)
        for name, value in zip(snapshot.axes, coordinates(snapshot, readout), strict=True)
    ]


def _doubled(name: str, value: float, diameter: bool) -> float:
    return 2 * value if name == "X" and diameter else value


# --- feed and spindle ---------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FeedFigures:
    """Programmed and measured feed, in the unit of the program's feed mode."""

    value: str
    unit: str
    actual: str
    actual_unit: str
    override: float
    prefix: str = ""  # MM before a metric feed, as the original control shows it.


@dataclass(frozen=True, slots=True)
class SpindleFigures:
    """Commanded and measured speed in rpm, surface speed, override and the AUTO/OFF switch."""

    direction: str
    rpm: str
    actual: str
    surface: str
    surface_label: str
    override: float
    auto: bool
    known: bool = True  # False: the spindle does not respond and may be turning.
    load: str = ""  # In percent, if the machine measures it.


def feed_figures(snapshot: Snapshot, metric: bool) -> FeedFigures:
    """Return the programmed and the measured feed. ``metric`` selects mm, otherwise inches."""
    modal = snapshot.modal
    per_rev = modal.per_rev and not snapshot.rapid
    turns = abs(snapshot.rpm_actual) / 60
    if snapshot.turns:
        value = formats.fixed(snapshot.feed * (1 if per_rev else 60), 4 if per_rev else 1)
        return FeedFigures(value, formats.turn_unit(per_rev), formats.NOTHING, "", snapshot.feed_override)
    if per_rev:
        speed = snapshot.velocity / turns if turns > TURNING / 60 else math.nan
    else:
        speed = snapshot.velocity
    unit = formats.feed_unit(metric, per_rev)
    known = snapshot.rapid or snapshot.feed > 0
    measured = formats.feed(speed, metric, per_rev) if math.isfinite(speed) else formats.NOTHING
    if Unknown.SLIDES in snapshot.unknown or (per_rev and Unknown.SPINDLE in snapshot.unknown):
        measured = UNKNOWN
    value = "RAPID" if snapshot.rapid else formats.feed(snapshot.feed, metric, modal.per_rev)
    return FeedFigures(
        value=value if known else formats.NOTHING,
        unit="" if snapshot.rapid else unit,
        actual=measured,
        actual_unit=unit,
        override=snapshot.feed_override,
        prefix="MM" if metric else "",
    )


def _directions(language: str) -> tuple[str, str, str]:
    if language == "omniturn":
        return tr("M03 FWD"), tr("M04 REV"), tr("M05 OFF")
    return tr("M3 FWD"), tr("M4 REV"), tr("M5 OFF")


def spindle_figures(snapshot: Snapshot, metric: bool, language: str) -> SpindleFigures:
    """Return the commanded and measured speed, and the surface speed in m/min or ft/min.

    ``language`` is the machine's programming language, because OmniTurn writes M05 and other languages M5.
    """
    modal = snapshot.modal
    if Unknown.SPINDLE in snapshot.unknown:
        return SpindleFigures(
            direction="UNKNOWN",
            rpm=UNKNOWN,
            actual=UNKNOWN,
            surface=UNKNOWN,
            surface_label="M/MIN" if metric else "SFM",
            override=snapshot.spindle_override,
            auto=snapshot.spindle_auto,
            known=False,
        )
    radius = snapshot.actual[0] - snapshot.offset[0]
    # On a mill, the surface speed depends on the tool's radius, which is not known here.
    lathe = snapshot.axes == LATHE
    surface = 2 * math.pi * radius * snapshot.rpm_actual / 60 if lathe else math.nan
    command = snapshot.rpm_command
    forward, reverse, off = _directions(language)
    direction = forward if command > 0 else reverse if command < 0 else off
    if snapshot.oriented is not None:
        direction = tr(Message("ORIENTED {angle}", angle=formats.angle(snapshot.oriented)))
    return SpindleFigures(
        direction=f"{direction} · G96" if modal.css else direction,
        rpm=formats.rpm(command),
        actual=formats.rpm(snapshot.rpm_actual),
        surface=formats.surface_speed(surface, metric),
        surface_label="M/MIN" if metric else "SFM",
        override=snapshot.spindle_override,
        auto=snapshot.spindle_auto,
        load=f"{snapshot.spindle_load:.0f} %" if snapshot.spindle_load is not None else "",
    )
