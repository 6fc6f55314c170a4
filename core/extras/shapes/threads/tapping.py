"""Tapping on the axis with a floating holder, and selection of the standard tap drill."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from core.extras.shapes.common_fields import MAX_RPM, check_flute_length, check_rpm, make_tool_field
from core.extras.shapes.cutting_data import Operation, rpm
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import CodeWriter, TappingCycle, format_short_number
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    number,
    text,
)
from core.extras.shapes.threads.thread_series import (
    METRIC_SERIES,
    TAPERED_SERIES,
    ThreadSeries,
    convert_length,
    find_thread_size,
)
from core.extras.shapes.threads.thread_values import (
    INSIDE,
    LEFT,
    RIGHT,
    check_thread_name,
    find_thread_limits,
    get_thread_series,
    list_side_tolerance_classes,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch, make_tool_outline

_NUMBERS = (
    *(2280, 2210, 2130, 2090, 2055, 2040, 2010, 1990, 1960, 1935, 1910, 1890, 1850, 1820, 1800, 1770),
    *(1730, 1695, 1660, 1610, 1590, 1570, 1540, 1520, 1495, 1470, 1440, 1405, 1360, 1285, 1200, 1160),
    *(1130, 1110, 1100, 1065, 1040, 1015, 995, 980, 960, 935, 890, 860, 820, 810, 785, 760, 730, 700),
    *(670, 635, 595, 550, 520, 465, 430, 420, 410, 400),
)  # =
_LETTERS = (
    *(234, 238, 242, 246, 250, 257, 261, 266, 272, 277, 281, 290, 295),
    *(302, 316, 323, 332, 339, 348, 358, 368, 377, 386, 397, 404, 413),
)  # =
_INCH = {f"#{n}": size / 10_000 for n, size in enumerate(_NUMBERS, 1)}
_INCH |= {chr(ord("A") + n): size / 1000 for n, size in enumerate(_LETTERS)}
_INCH |= {str(Fraction(n, 64)): n / 64 for n in range(3, 97)}
_OVER = 0.025  # mm, permitted excess over the middle of the limits for metric drills, whose steps are large


def _metric() -> Iterator[float]:
    """Yield metric drill sizes, in steps of 0.1 mm up to 14 mm and in steps of 0.25 mm up to 50 mm."""
    yield from (n / 10 for n in range(10, 140))
    yield from (n / 4 for n in range(56, 201))


def find_tap_drill(minimum: float, maximum: float, *, is_metric: bool) -> tuple[str, float] | None:
    """Return the name and size of the standard drill for a hole between two limits.

    Limits and size are in mm or inches. Because drills cut oversize, the largest drill up to the middle of
    the limits is preferred, or else the smallest drill within the limits. Return None if no drill fits.
    """
    sold = {f"{size:g}": size for size in _metric()} if is_metric else _INCH
    fits = sorted((size, name) for name, size in sold.items() if minimum <= size <= maximum)
    middle = (minimum + maximum) / 2.0 + (_OVER if is_metric else 0.0)
    below = [each for each in fits if each[0] <= middle]
    chosen = below[-1] if below else fits[0] if fits else None
    return None if chosen is None else (chosen[1], chosen[0])


_SLOW = 0.4  # fraction of the speed of a drill, because the flanks of a tap rub
_MOST_RPM = 600.0
_SHORT = 1.0  # pitches before the depth, because the spindle overruns while it reverses
_COARSEST = 0.2  # in/rev, the highest feed of the control without G35


FLOATING, RIGID = "FLOATING", "RIGID"


def _rigid(values: FieldValues) -> bool:
    return text(values, "HOLDER") == RIGID


def _named(values: FieldValues) -> bool:
    return get_thread_series(values) is not ThreadSeries.CUSTOM


def _pitch(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    found = find_thread_size(get_thread_series(values), text(values, "SIZE"))
    if found is None:
        return None
    return round(convert_length(found.pitch, get_thread_series(values), is_metric=setting.metric), 6)


def _across(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    found = find_thread_size(get_thread_series(values), text(values, "SIZE"))
    if found is None:
        return None
    return round(convert_length(found.diameter, get_thread_series(values), is_metric=setting.metric), 4)


def _turns(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    across = number(values, "DIA")
    if not across:
        return None
    return max(50.0, 50.0 * math.floor(min(_SLOW * rpm(Operation.DRILL, across, setting), _MOST_RPM) / 50.0))


def _tap(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    pitch = filled.get_number("PITCH")
    start = math.ceil(max(setting.near, 3.0 * pitch) * 100.0 - 1e-6) / 100.0
    into = "M04" if filled.get_text("HAND") == LEFT else "M03"
    end = -(filled.get_number("DEEP") - (0.0 if _rigid(filled.field_values) else filled.get_number("SHORT")))
    held = _rigid(filled.field_values)
    code.write_tapping(
        filled.get_number("T"),
        TappingCycle(start, end, pitch, filled.get_number("RPM"), into, filled.get_number("DWELL"), held),
    )
    code.write_retract()


def _checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    series, pitch = get_thread_series(filled.field_values), filled.get_number("PITCH")
    if series in TAPERED_SERIES or series is ThreadSeries.ACME:
        yield FieldError(
            "SERIES",
            Message(
                "{series} threads cannot be tapped with this shape: cut the thread with G33.", series=series
            ),
        )
    if pitch * setting.mm / 25.4 > _COARSEST:
        most = _COARSEST * 25.4 / setting.mm
        yield FieldError(
            "PITCH",
            Message(
                "A pitch of {pitch} is more than the largest feed, {maximum}: cut the thread with G33.",
                pitch=f"{pitch:g}",
                maximum=f"{most:g}",
            ),
        )
    if filled.get_number("SHORT") >= filled.get_number("DEEP") and not _rigid(filled.field_values):
        yield FieldError(
            "SHORT",
            Message(
                "The tap would stop {number} short of depth {number2}, so nothing is cut.",
                number=f"{filled.get_number('SHORT'):g}",
                number2=f"{filled.get_number('DEEP'):g}",
            ),
        )
    speed = pitch * filled.get_number("RPM") * setting.mm / 25.4
    if speed > 300.0:
        yield FieldError(
            "RPM",
            Message(
                "At S{number} the axis needs {speed} in/min, but the axis limit is 300 in/min: "
                "enter a lower speed.",
                number=f"{filled.get_number('RPM'):g}",
                speed=f"{speed:.0f}",
            ),
        )
    shape, name = setting.tool(filled.get_number("T")), f"T{filled.get_number('T'):.0f}"
    if shape is not None and shape.pitch and abs(shape.pitch / setting.mm - pitch) > 0.01 * pitch:
        yield FieldError(
            "T",
            Message(
                "The tool data of {name} specifies a pitch of {pitch}, but this thread has a "
                "pitch of {needed}: use another tap.",
                name=name,
                pitch=f"{shape.pitch / setting.mm:.5g}",
                needed=f"{pitch:.5g}",
            ),
        )
    yield from check_flute_length(filled, setting)
    yield from check_rpm(filled, setting)


def _says(filled: ShapeInstance, setting: ProgramSettings) -> tuple[str, ...]:
    known = find_thread_limits(
        {**filled.field_values, "SIDE": INSIDE, "CLASS": _usual_class(filled)}, setting
    )
    if known is None:
        return ()
    series = get_thread_series(filled.field_values)
    places, unit = (2 if setting.metric else 4), convert_length(1.0, series, is_metric=setting.metric)
    least, most = (format_short_number(value * unit, places) for value in known.minor_diameter)
    hole_size_text = Message(
        "hole diameter before tapping: {crest}; limits {minimum} to {maximum}",
        crest=format_short_number(known.crest_diameter * unit, places),
        minimum=least,
        maximum=most,
    )
    drill = find_tap_drill(*known.minor_diameter, is_metric=series in METRIC_SERIES)
    return (
        (hole_size_text,)
        if drill is None
        else (hole_size_text, Message("tap drill: {series}", series=_called(*drill, series, setting)))
    )


def _called(name: str, size: float, series: ThreadSeries, settings: ProgramSettings) -> str:
    """Return the name of a drill, followed by its size if the name is in another unit.

    The size is in the program's unit.
    """
    size = convert_length(size, series, is_metric=settings.metric)
    shown = format_short_number(size, 3 if settings.metric else 4)
    named = Message("{unit} mm", unit=name) if series in METRIC_SERIES else name
    return (
        named
        if series in METRIC_SERIES and settings.metric
        else Message("{named}, {value}", named=named, value=shown)
    )


def _usual_class(filled: ShapeInstance) -> str:
    allowed = list_side_tolerance_classes({**filled.field_values, "SIDE": INSIDE})
    return allowed[0] if allowed else ""


def _sketch(_filled: ShapeInstance) -> Sketch:
    wall = make_part_outline((0, 0), (0, 10), (-24, 10), (-24, 0))
    teeth = [(-k, 4.0 if k % 2 else 3.4) for k in range(15)]
    body = make_tool_outline((-14, -3.4), (-14, 3.4), (8, 3.4), (8, -3.4))
    dims = (
        Dimension("DEEP", (-14, 10), (0, 10), 3),
        Dimension("DIA", (-17, -4), (-17, 4)),
        Dimension("PITCH", (-4, 6.4)),
    )
    return make_sketch(wall, body, make_cut_outline(*teeth), dimensions=dims)


TAPPING_SHAPE = Shape(
    "TAP",
    "tapping on the spindle centerline: feed in, reverse the spindle, feed out at the pitch",
    (
        make_tool_field(ToolKind.TAP),
        ShapeField(
            "SERIES",
            "SERIES",
            FieldKind.CHOICE,
            ThreadSeries.UNC.value,
            tuple(each.value for each in ThreadSeries),
        ),
        ShapeField("SIZE", "SIZE", FieldKind.NAME, None, applies_to=_named),
        ShapeField("DIA", "DIAMETER", FieldKind.DIAMETER, _across, is_in_comment=True),
        ShapeField("PITCH", "PITCH", FieldKind.LENGTH, _pitch),
        ShapeField("DEEP", "DEPTH", FieldKind.LENGTH),
        ShapeField("HAND", "HAND", FieldKind.CHOICE, RIGHT, (RIGHT, LEFT)),
        ShapeField(
            "SHORT",
            "STOP DISTANCE BEFORE DEPTH",
            FieldKind.LENGTH,
            lambda v, _s: round(_SHORT * number(v, "PITCH"), 4),
            allows_zero=True,
            applies_to=lambda v: not _rigid(v),
        ),
        ShapeField("DWELL", "DWELL DURING REVERSAL", FieldKind.SECONDS, 0.5, allows_zero=True, maximum=60),
        ShapeField("RPM", "SPINDLE SPEED, RPM", FieldKind.RPM, _turns, maximum=MAX_RPM),
    ),
    _tap,
    _sketch,
    _checks,
    find_blocking_errors=check_thread_name,
    make_notes=_says,
)


def _sinumerik_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from _checks(filled, setting)
    if not _rigid(filled.field_values):
        return
    if not setting.shop.is_spindle_c_axis:
        yield FieldError(
            "HOLDER",
            "The spindle of this machine cannot be positioned and turned in sync with Z: "
            "use a floating tap holder.",
        )
    elif filled.get_number("RPM") > setting.shop.max_c_axis_rpm:
        most = f"{setting.shop.max_c_axis_rpm:g}"
        yield FieldError(
            "RPM",
            Message(
                "A rigid tap turns with the C axis, which reaches {maximum} rpm: enter {maximum2} or less.",
                maximum=most,
                maximum2=most,
            ),
        )


def _propose_tapping_rpm(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Return the proposed rpm; for a rigid tap it is limited to the maximum rpm of the C axis."""
    turns = _turns(values, settings)
    most = settings.shop.max_c_axis_rpm if _rigid(values) else math.inf
    return min(turns, most) if isinstance(turns, float) else turns


SINUMERIK_TAPPING_SHAPE = replace(
    TAPPING_SHAPE,
    find_field_conflicts=_sinumerik_checks,
    fields=(
        TAPPING_SHAPE.fields[0],
        ShapeField("HOLDER", "HOLDER", FieldKind.CHOICE, FLOATING, (FLOATING, RIGID)),
        *(
            replace(each, default=_propose_tapping_rpm) if each.name == "RPM" else each
            for each in TAPPING_SHAPE.fields[1:]
        ),
    ),
)
"""Tapping form for SINUMERIK, with CYCLE840 or, without a floating tap holder, CYCLE84."""
