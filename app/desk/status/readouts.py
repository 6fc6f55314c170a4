"""Texts and units of one snapshot for the position, feed and spindle displays and the lamps."""

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
from core.ports import UnknownPart

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import PlanePosition

# --- lamps --------------------------------------------------------------------------------------------


TURNING_RPM = 1.0  # Speed in rpm above which a spindle counts as turning.
ZERO_TOLERANCE_DEG = 0.01  # Tolerance in degrees within which a table counts as being at 0.
UNKNOWN_VALUE = "?"  # Replaces an unknown value, or follows the last known value.
LATHE_AXES = ("X", "Z", "C")


@dataclass(frozen=True, slots=True)
class Lamp:
    """Lamp on the screen, with its label and the key that switches it, if any."""

    label: str
    is_lit: bool
    switch_key: str = ""
    is_warning: bool = False


def make_mode_lamps(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """Return the lamps of the four run switches.

    The lamp NO COUNT is included only while the switch is on.
    """
    return (
        Lamp("SINGLE BLOCK", snapshot.single_block, "S"),
        Lamp("OPTIONAL STOP", snapshot.optional_stop, "O"),
        Lamp("BLOCK DELETE", snapshot.block_delete, "/"),
        Lamp("CYCLE REPEAT", snapshot.cycle_repeat, "C"),
        *((Lamp("NO COUNT", is_lit=True, switch_key="P", is_warning=True),) if snapshot.no_count else ()),
    )


def make_lamps(snapshot: Snapshot, *, is_table_rotary: bool = True) -> tuple[Lamp, ...]:
    """Return the lamps of a lathe or of a mill. The lamps of a mill include its rotary axes.

    Outputs are identified by their names in the machine file (coolant, collet, live1 …).
    ``is_table_rotary`` is True if the mill has a rotary table.
    """
    if snapshot.axes != LATHE_AXES:
        return (
            _make_spindle_lamp(snapshot),
            _make_output_lamp(snapshot, Lamp("COOLANT", "coolant" in snapshot.outputs)),
            *_make_rotary_lamps(snapshot, table=is_table_rotary),
        )
    live = Lamp("LIVE TOOL", any(name.startswith("live") for name in snapshot.outputs))
    coolant = Lamp("COOLANT", "coolant" in snapshot.outputs)
    if UnknownPart.OUTPUTS in snapshot.unknown and "collet" not in snapshot.absent:
        collet = Lamp("COLLET ?", is_lit=True, is_warning=True)
    else:
        collet = _make_collet_lamp(snapshot)
    return (
        _make_spindle_lamp(snapshot),
        _make_output_lamp(snapshot, coolant),
        collet,
        _make_output_lamp(snapshot, live),
    )


def make_drives_lamp(snapshot: Snapshot, key: str = "") -> Lamp:
    """Return the lamp of the drives, which is lit while the drives have power.

    An alarm also switches the drive power off. If the drives do not respond, the lamp shows a question
    mark.
    """
    if UnknownPart.AXES in snapshot.unknown:
        return Lamp("DRIVES ?", is_lit=True, switch_key=key, is_warning=True)
    return Lamp("DRIVES ON", snapshot.powered, key)


def _make_output_lamp(snapshot: Snapshot, lamp: Lamp) -> Lamp:
    """Return the lamp of an output. If the outputs are unknown, the lamp shows a question mark."""
    if UnknownPart.OUTPUTS not in snapshot.unknown:
        return lamp
    return Lamp(
        Message("{word} {unknown}", word=lamp.label, unknown=UNKNOWN_VALUE), is_lit=True, is_warning=True
    )


def _make_rotary_lamps(snapshot: Snapshot, *, table: bool) -> tuple[Lamp, ...]:
    """Return a mill's lamps for a tilted plane and for a table or head that is not at 0 degrees."""
    tilted = snapshot.swivel is not None and snapshot.swivel.system.is_tilted
    rotary = zip(snapshot.axes, snapshot.actual, strict=True)
    turned = any(abs(math.remainder(at, 360.0)) > ZERO_TOLERANCE_DEG for name, at in rotary if name in "ABC")
    return Lamp("TILTED PLANE", is_lit=tilted), Lamp(
        "TABLE ROTATED" if table else "HEAD ROTATED", is_lit=turned
    )


def _make_spindle_lamp(snapshot: Snapshot) -> Lamp:
    """Return the spindle's lamp, which is also lit while the spindle coasts.

    The lamp depends on the measured speed.
    """
    if UnknownPart.SPINDLE in snapshot.unknown:
        return Lamp("SPINDLE UNKNOWN", is_lit=True, is_warning=True)
    if snapshot.is_orienting:
        return Lamp("SPINDLE ORIENTING", is_lit=True, is_warning=True)
    if snapshot.oriented is not None:
        return Lamp("SPINDLE ORIENTED", is_lit=True)
    turning = abs(snapshot.rpm_actual) > TURNING_RPM
    if turning and snapshot.rpm_command == 0:
        return Lamp("SPINDLE COASTING", is_lit=True, is_warning=True)
    if turning:
        return Lamp("SPINDLE REV" if snapshot.rpm_actual < 0 else "SPINDLE FWD", is_lit=True)
    return Lamp("SPINDLE", is_lit=False)


def _make_collet_lamp(snapshot: Snapshot) -> Lamp:
    """Return the collet's lamp, which depends on the output and not on the program's modal state."""
    if "collet" in snapshot.absent:
        return Lamp("MANUAL COLLET", is_lit=False)
    if "collet" in snapshot.outputs:
        return Lamp("COLLET CLOSED", is_lit=True)
    return Lamp("COLLET OPEN", is_lit=True, is_warning=True)


# --- positions of a mill ------------------------------------------------------------------------------


ROTARY_ANGLE_DECIMALS = 3  # Decimals of a rotary axis on the screen.
_LINEAR_AXIS_COUNT = 3


def find_plane_position(snapshot: Snapshot, swivel: PlanePosition) -> tuple[float, ...]:
    """Return the tool tip position in the working plane in mm, with the rotary axis angles in degrees."""
    zero = swivel.system.kinematics.zero_angles
    return (
        *swivel.system.transform.convert_to_frame_point(_slides(snapshot.actual)),
        *_find_shown_position(snapshot, swivel, zero),
    )


def find_home_distances(snapshot: Snapshot, swivel: PlanePosition) -> tuple[float, ...]:
    """Return the distances of the linear axes from home in mm, and of the rotary axes in degrees."""
    return (*_slides(snapshot.actual), *_find_shown_position(snapshot, swivel, {}))


def find_remaining_distances(snapshot: Snapshot, swivel: PlanePosition) -> tuple[float, ...]:
    """Return the remaining distance to the block end for each working-plane axis and rotary axis.

    Values are in mm and degrees.
    """
    end = snapshot.block_end if snapshot.block else snapshot.actual
    here, there = (
        swivel.system.transform.convert_to_frame_point(_slides(at)) for at in (snapshot.actual, end)
    )
    slides = (goal - at for goal, at in zip(there, here, strict=True))
    return (
        *slides,
        *(b - a for a, b in zip(snapshot.actual[_LINEAR_AXIS_COUNT:], end[_LINEAR_AXIS_COUNT:], strict=True)),
    )


def get_coordinate_system_name(swivel: PlanePosition | None) -> str:
    """Return the name of the coordinate system of the displayed positions."""
    if swivel is None:
        return tr("MACHINE")
    if not swivel.system.is_tilted:
        return tr("WORKPIECE")
    return tr(Message("TILTED PLANE FROM LINE {line}", line=swivel.system.plane_block_line))


def format_rotary_angle(degrees: float) -> str:
    """Return the angle of a rotary axis in degrees as text with three decimals."""
    return formats.format_fixed(degrees, ROTARY_ANGLE_DECIMALS)


def _slides(at: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = at[:_LINEAR_AXIS_COUNT]
    return x, y, z


def _find_shown_position(snapshot: Snapshot, swivel: PlanePosition, zero: Mapping[str, float]) -> list[float]:
    """Return the displayed angles of the rotary axes in degrees, each relative to its zero angle.

    The angle of a modulo axis is from 0 to 360 degrees.
    """
    found = []
    for name, at in zip(
        snapshot.axes[_LINEAR_AXIS_COUNT:], snapshot.actual[_LINEAR_AXIS_COUNT:], strict=True
    ):
        axis, angle = swivel.system.kinematics.find_rotary_axis(name), at - zero.get(name, 0.0)
        wraps = axis is not None and axis.is_modulo
        found.append(round(angle, ROTARY_ANGLE_DECIMALS) % 360.0 if wraps else angle)
    return found


ROTARY_AXES = frozenset("ABC")  # Axes in degrees.


class ReadoutKind(StrEnum):
    """Kind of value that the large position display shows."""

    POSITION = "POSITION"
    TO_GO = "DISTANCE TO GO"
    HOME = "FROM HOME"

    @property
    def next_kind(self) -> ReadoutKind:
        """Return the next kind of value. The first kind follows the last kind."""
        order = list(ReadoutKind)
        return order[(order.index(self) + 1) % len(order)]


@dataclass(frozen=True, slots=True)
class AxisReadout:
    """One row of the position display.

    ``diameter_mark`` is Ø or R for X. ``second_value`` is the value displayed next to ``value``. If
    ``is_known`` is False, the axis does not respond, and the values are the last known values.
    """

    name: str
    diameter_mark: str
    value: str
    second_value: str
    is_homed: bool
    is_known: bool = True


@dataclass(frozen=True, slots=True)
class PositionReadout:
    """Position display. All its values have the same unit and come from one snapshot."""

    main_kind: ReadoutKind
    second_kind: ReadoutKind
    unit: str
    x_label: str
    axes: tuple[AxisReadout, ...]


def find_readout_values(snapshot: Snapshot, readout: ReadoutKind) -> tuple[float, ...]:
    """Return the values of a readout in the order of ``snapshot.axes``, in mm or degrees. X is a radius."""
    actual, swivel = snapshot.actual, snapshot.swivel
    if swivel is not None:
        return _MILL_SYSTEMS[readout](snapshot, swivel)
    if readout is ReadoutKind.HOME:
        return _wrap_angles(actual, snapshot)
    if readout is ReadoutKind.TO_GO:
        end = snapshot.block_end if snapshot.block else actual
        return tuple(there - here for there, here in zip(end, actual, strict=True))
    x, z, *rest = actual
    if snapshot.axes == LATHE_AXES:
        rest[0] -= snapshot.modal.offset_c
    return _wrap_angles((x - snapshot.offset[0], z - snapshot.offset[1], *rest), snapshot)


_MILL_SYSTEMS = {
    ReadoutKind.POSITION: find_plane_position,
    ReadoutKind.TO_GO: find_remaining_distances,
    ReadoutKind.HOME: find_home_distances,
}


def _wrap_angles(at: tuple[float, ...], snapshot: Snapshot) -> tuple[float, ...]:
    """Return the axis positions.

    If C is a modulo axis in the modal state, its angle is from 0 to 360 degrees.
    """
    if not snapshot.modal.is_c_axis_modulo:
        return at
    return (*at[:-1], round(at[-1], formats.ANGLE_DECIMALS) % 360.0)


def make_position_readout(
    snapshot: Snapshot, readout: ReadoutKind, has_c_axis: bool, is_metric: bool, third_axis: str = "C"
) -> PositionReadout:
    """Return the position display, which has two values for every axis.

    The second value is the distance to go, or the position if the first value is the distance to go.
    ``is_metric`` selects mm instead of inches. ``has_c_axis`` includes the C axis of a lathe, which is
    named ``third_axis``.
    """
    diameter = snapshot.shows_diameter
    second_kind = ReadoutKind.POSITION if readout is ReadoutKind.TO_GO else ReadoutKind.TO_GO
    large, small = (_figures(snapshot, r, is_metric, diameter) for r in (readout, second_kind))
    mark = "" if snapshot.axes != LATHE_AXES else "Ø" if diameter else "R"
    known = UnknownPart.AXES not in snapshot.unknown
    names = (*snapshot.axes[:2], third_axis) if snapshot.axes == LATHE_AXES else snapshot.axes
    rows = [
        AxisReadout(name, mark if name == "X" else "", a, b, homed, known)
        for name, a, b, homed in zip(names, large, small, snapshot.homed, strict=True)
    ]
    return PositionReadout(
        main_kind=readout,
        second_kind=second_kind,
        unit=_find_unit(is_metric, snapshot.modal.metric),
        x_label=_find_x_label(snapshot, readout),
        axes=tuple(rows if has_c_axis or snapshot.axes != LATHE_AXES else rows[:2]),
    )


def _find_x_label(snapshot: Snapshot, readout: ReadoutKind) -> str:
    """Return the label of X.

    On a lathe, the label shows whether X is a diameter or a radius. On a mill, it names the coordinate
    system.
    """
    if snapshot.axes != LATHE_AXES:
        return get_coordinate_system_name(None if readout is ReadoutKind.HOME else snapshot.swivel)
    words = tr("X IS A DIAMETER") if snapshot.shows_diameter else tr("X IS A RADIUS")
    if snapshot.shows_diameter == snapshot.modal.diameter:
        return words
    return join_messages(
        "  ·  ", (words, tr("CONTROL USES G72 Ø") if snapshot.modal.diameter else tr("CONTROL USES G73 R"))
    )


def _find_unit(metric: bool, control: bool) -> str:
    """Return the unit of the displayed values, with a note if the control uses a different unit."""
    names = ("INCH", "MM")
    return (
        names[metric]
        if metric == control
        else Message("{names}  ·  CONTROL USES {names2}", names=names[metric], names2=names[control])
    )


def _figures(snapshot: Snapshot, readout: ReadoutKind, metric: bool, diameter: bool) -> list[str]:
    angle = formats.format_angle if snapshot.axes == LATHE_AXES else format_rotary_angle
    turning = () if snapshot.axes == LATHE_AXES and snapshot.modal.is_c_linear else ROTARY_AXES
    return [
        angle(value) if name in turning else formats.format_length(_doubled(name, value, diameter), metric)
        for name, value in zip(snapshot.axes, find_readout_values(snapshot, readout), strict=True)
    ]


def _doubled(name: str, value: float, diameter: bool) -> float:
    return 2 * value if name == "X" and diameter else value


# --- feed and spindle ---------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FeedReadout:
    """Programmed and measured feed as text, in the unit of the program's feed mode."""

    programmed_value: str
    programmed_unit: str
    measured_value: str
    measured_unit: str
    override_fraction: float
    value_prefix: str = ""  # MM before a metric feed, as the original control shows it.


@dataclass(frozen=True, slots=True)
class SpindleReadout:
    """Commanded and measured speed, surface speed, override, and setting of the spindle switch.

    The commanded and measured speeds are in rpm. The spindle switch has the positions AUTO and OFF.
    """

    direction: str
    commanded_rpm: str
    measured_rpm: str
    surface_speed: str
    surface_speed_label: str
    override_fraction: float
    is_auto: bool
    is_known: bool = True  # False: the spindle does not respond and may be turning.
    load_text: str = ""  # In percent, if the machine measures it.


def make_feed_readout(snapshot: Snapshot, is_metric: bool) -> FeedReadout:
    """Return the programmed and the measured feed. ``is_metric`` selects mm instead of inches."""
    modal = snapshot.modal
    per_rev = modal.per_rev and not snapshot.rapid
    turns = abs(snapshot.rpm_actual) / 60
    if snapshot.turns:
        value = formats.format_fixed(snapshot.feed * (1 if per_rev else 60), 4 if per_rev else 1)
        return FeedReadout(
            value, formats.find_rotary_feed_unit(per_rev), formats.NO_VALUE, "", snapshot.feed_override
        )
    if per_rev:
        speed = snapshot.velocity / turns if turns > TURNING_RPM / 60 else math.nan
    else:
        speed = snapshot.velocity
    unit = formats.find_feed_unit(is_metric, per_rev)
    known = snapshot.rapid or snapshot.feed > 0
    measured = formats.format_feed(speed, is_metric, per_rev) if math.isfinite(speed) else formats.NO_VALUE
    if UnknownPart.AXES in snapshot.unknown or (per_rev and UnknownPart.SPINDLE in snapshot.unknown):
        measured = UNKNOWN_VALUE
    value = "RAPID" if snapshot.rapid else formats.format_feed(snapshot.feed, is_metric, modal.per_rev)
    return FeedReadout(
        programmed_value=value if known else formats.NO_VALUE,
        programmed_unit="" if snapshot.rapid else unit,
        measured_value=measured,
        measured_unit=unit,
        override_fraction=snapshot.feed_override,
        value_prefix="MM" if is_metric else "",
    )


def _directions(language: str) -> tuple[str, str, str]:
    if language == "omniturn":
        return tr("M03 FWD"), tr("M04 REV"), tr("M05 OFF")
    return tr("M3 FWD"), tr("M4 REV"), tr("M5 OFF")


def make_spindle_readout(snapshot: Snapshot, is_metric: bool, program_language: str) -> SpindleReadout:
    """Return the commanded and measured spindle speed, and the surface speed in m/min or ft/min.

    ``program_language`` is the machine's program language. The code for spindle stop is M05 in OmniTurn and
    M5 in the other languages.
    """
    modal = snapshot.modal
    if UnknownPart.SPINDLE in snapshot.unknown:
        return SpindleReadout(
            direction="UNKNOWN",
            commanded_rpm=UNKNOWN_VALUE,
            measured_rpm=UNKNOWN_VALUE,
            surface_speed=UNKNOWN_VALUE,
            surface_speed_label="M/MIN" if is_metric else "SFM",
            override_fraction=snapshot.spindle_override,
            is_auto=snapshot.spindle_auto,
            is_known=False,
        )
    radius = snapshot.actual[0] - snapshot.offset[0]
    # On a mill, the surface speed depends on the tool's radius, which is not known here.
    lathe = snapshot.axes == LATHE_AXES
    surface = 2 * math.pi * radius * snapshot.rpm_actual / 60 if lathe else math.nan
    command = snapshot.rpm_command
    forward, reverse, off = _directions(program_language)
    direction = forward if command > 0 else reverse if command < 0 else off
    if snapshot.oriented is not None:
        direction = tr(Message("ORIENTED {angle}", angle=formats.format_angle(snapshot.oriented)))
    return SpindleReadout(
        direction=f"{direction} · G96" if modal.css else direction,
        commanded_rpm=formats.rpm(command),
        measured_rpm=formats.rpm(snapshot.rpm_actual),
        surface_speed=formats.format_surface_speed(surface, is_metric),
        surface_speed_label="M/MIN" if is_metric else "SFM",
        override_fraction=snapshot.spindle_override,
        is_auto=snapshot.spindle_auto,
        load_text=f"{snapshot.spindle_load:.0f} %" if snapshot.spindle_load is not None else "",
    )
