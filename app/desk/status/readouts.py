"""Position, feed, spindle and lit words of one snapshot: which figures there are, and in which unit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from app.desk.status import formats
from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.interpreter.shared.working_plane import Swivel
from core.message import Message, join_messages
from core.ports import Unknown

# --- lit words ----------------------------------------------------------------------------------------


TURNING = 1.0  # rpm above which a spindle is said to turn
AT_ZERO = 0.01  # degrees from 0 at which a table still stands there
UNKNOWN = "?"  # in the place of a figure that nobody knows, or behind the last that was known
LATHE = ("X", "Z", "C")


@dataclass(frozen=True, slots=True)
class Lamp:
    """A lit word, and the key that switches it, if one does."""

    word: str
    lit: bool
    key: str = ""
    warn: bool = False


def modes_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """The four switches of a run, with their keys; NO COUNT only while it is on, because few runs are dry."""
    return (
        Lamp("SINGLE BLOCK", snapshot.single_block, "S"),
        Lamp("OPTIONAL STOP", snapshot.optional_stop, "O"),
        Lamp("BLOCK DELETE", snapshot.block_delete, "/"),
        Lamp("CYCLE REPEAT", snapshot.cycle_repeat, "C"),
        *((Lamp("NO COUNT", lit=True, key="P", warn=True),) if snapshot.no_count else ()),
    )


def lamps_of(snapshot: Snapshot, *, table: bool = True) -> tuple[Lamp, ...]:
    """From the outputs that are on; their names are those of the machine files (coolant, collet, live1 …).

    ``table``: whether a table turns on this mill, and not its head alone.
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
    """As the drives tell it: an alarm takes their power too, and of those unheard nothing is known."""
    if Unknown.SLIDES in snapshot.unknown:
        return Lamp("DRIVES ?", lit=True, key=key, warn=True)
    return Lamp("DRIVES ON", snapshot.powered, key)


def _output_lamp(snapshot: Snapshot, lamp: Lamp) -> Lamp:
    """The lamp; of an output that nobody hears neither on nor off can be said."""
    if Unknown.OUTPUTS not in snapshot.unknown:
        return lamp
    return Lamp(Message("{word} {unknown}", word=lamp.word, unknown=UNKNOWN), lit=True, warn=True)


def _rotary_lamps(snapshot: Snapshot, *, table: bool) -> tuple[Lamp, ...]:
    """Of a mill: whether moves count in a tilted plane, and whether table or head stand anywhere but at 0."""
    tilted = snapshot.swivel is not None and snapshot.swivel.system.tilted
    rotary = zip(snapshot.axes, snapshot.actual, strict=True)
    turned = any(abs(math.remainder(at, 360.0)) > AT_ZERO for name, at in rotary if name in "ABC")
    return Lamp("TILTED PLANE", lit=tilted), Lamp("TABLE ROTATED" if table else "HEAD ROTATED", lit=turned)


def _spindle_lamp(snapshot: Snapshot) -> Lamp:
    """Turning is told from the measured speed: one that coasts is as dangerous as one that is driven."""
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
    """The output decides, not the program's word: it is what holds the bar."""
    if "collet" in snapshot.absent:
        return Lamp("MANUAL COLLET", lit=False)
    if "collet" in snapshot.outputs:
        return Lamp("COLLET CLOSED", lit=True)
    return Lamp("COLLET OPEN", lit=True, warn=True)


# --- figures of a mill --------------------------------------------------------------------------------


ANGLE_PLACES = 3  # the display step of a rotary table
_SLIDES = 3


def plane_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Where the tip stands in the working plane, mm, and the rotary axes as they are shown."""
    zero = swivel.system.kinematics.zero
    return (*swivel.system.place.point(_slides(snapshot.actual)), *_shown(snapshot, swivel, zero))


def home_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Where the slides stand from home, and the rotary axes as they are shown."""
    return (*_slides(snapshot.actual), *_shown(snapshot, swivel, {}))


def figures_to_go(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """What is left of the block: along the axes of the working plane, and of the rotary axes."""
    end = snapshot.block_end if snapshot.block else snapshot.actual
    here, there = (swivel.system.place.point(_slides(at)) for at in (snapshot.actual, end))
    slides = (goal - at for goal, at in zip(there, here, strict=True))
    return (*slides, *(b - a for a, b in zip(snapshot.actual[_SLIDES:], end[_SLIDES:], strict=True)))


def system_words(swivel: Swivel | None) -> str:
    """Which system the figures count in."""
    if swivel is None:
        return tr("MACHINE")
    if not swivel.system.tilted:
        return tr("WORKPIECE")
    return tr(Message("TILTED PLANE FROM LINE {line}", line=swivel.system.line))


def rotary_angle(degrees: float) -> str:
    """The angle of a rotary axis, in degrees."""
    return formats.fixed(degrees, ANGLE_PLACES)


def _slides(at: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = at[:_SLIDES]
    return x, y, z


def _shown(snapshot: Snapshot, swivel: Swivel, zero: Mapping[str, float]) -> list[float]:
    """Rotary axes from their zeros; of a modulo axis 0 to under 360, what is written as 360 is 0."""
    found = []
    for name, at in zip(snapshot.axes[_SLIDES:], snapshot.actual[_SLIDES:], strict=True):
        axis, angle = swivel.system.kinematics.rotary(name), at - zero.get(name, 0.0)
        wraps = axis is not None and axis.modulo
        found.append(round(angle, ANGLE_PLACES) % 360.0 if wraps else angle)
    return found


ROTARY = frozenset("ABC")  # axes that are read in degrees


class Readout(StrEnum):
    """What the large figures show."""

    POSITION = "POSITION"
    TO_GO = "DISTANCE TO GO"
    HOME = "FROM HOME"

    @property
    def following(self) -> Readout:
        """The one that the key goes on to."""
        order = list(Readout)
        return order[(order.index(self) + 1) % len(order)]


@dataclass(frozen=True, slots=True)
class AxisFigures:
    """One row of the readout; ``mark`` says Ø or R on X, ``beside`` is the second figure.

    Not ``known``: nothing is heard of the slide any more, the figures are the last that were.
    """

    name: str
    mark: str
    value: str
    beside: str
    homed: bool
    known: bool = True


@dataclass(frozen=True, slots=True)
class PositionFigures:
    """The readout: all of it in one unit, from one instant."""

    readout: Readout
    beside: Readout
    unit: str
    x_words: str
    axes: tuple[AxisFigures, ...]


def coordinates(snapshot: Snapshot, readout: Readout) -> tuple[float, ...]:
    """The figures of a readout in the order of ``snapshot.axes``: mm with X a radius, and degrees."""
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
    """C from 0 to under 360 where the program counts it so; what would be shown as 360 is 0."""
    if not snapshot.modal.wraps_c:
        return at
    return (*at[:-1], round(at[-1], formats.ANGLE_PLACES) % 360.0)


def position_figures(
    snapshot: Snapshot, readout: Readout, with_c: bool, metric: bool, third_axis: str = "C"
) -> PositionFigures:
    """Both figures of every axis; the second is the distance to go, or the position beside that.

    ``metric``: mm, else inches. C is a row of a lathe only ``with_c``, under the name of ``third_axis``.
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
    """What X is on a lathe; on a mill the system that the figures count in."""
    if snapshot.axes != LATHE:
        return system_words(None if readout is Readout.HOME else snapshot.swivel)
    words = tr("X IS A DIAMETER") if snapshot.reads_diameter else tr("X IS A RADIUS")
    if snapshot.reads_diameter == snapshot.modal.diameter:
        return words
    return join_messages(
        "  ·  ", (words, tr("CONTROL USES G72 Ø") if snapshot.modal.diameter else tr("CONTROL USES G73 R"))
    )


def _unit(metric: bool, control: bool) -> str:
    """The unit of the figures; where the control is in the other one, that is said beside it."""
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
    """Programmed and actual feed in the unit of the program's mode."""

    value: str
    unit: str
    actual: str
    actual_unit: str
    override: float
    prefix: str = ""  # MM before a metric feed, as the control shows it


@dataclass(frozen=True, slots=True)
class SpindleFigures:
    """Commanded and actual rpm, surface speed, override and the AUTO/OFF switch."""

    direction: str
    rpm: str
    actual: str
    surface: str
    surface_label: str
    override: float
    auto: bool
    known: bool = True  # else nothing is heard of it: it may turn
    load: str = ""  # per cent, where the machine measures it


def feed_figures(snapshot: Snapshot, metric: bool) -> FeedFigures:
    """Feed as it is programmed and as it is measured; ``metric``: mm, else inches."""
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
    """Speed as it is commanded and measured, and the surface speed in m/min or feet/min.

    ``language`` is the machine's own: OmniTurn writes M05 what Klartext and SINUMERIK write M5.
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
    lathe = snapshot.axes == LATHE  # on a mill it would be the tool's, whose radius nobody knows
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
