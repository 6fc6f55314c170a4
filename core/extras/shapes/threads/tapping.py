"""Tapping on the axis with a floating holder, and the standard drill size for the hole."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from core.extras.shapes.cutting_data import Work, rpm
from core.extras.shapes.lines.code_lines import Code, Tap, plain
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number, text
from core.extras.shapes.threads.thread_series import METRIC, TAPERED, Series, in_unit, size_of
from core.extras.shapes.threads.thread_values import (
    INSIDE,
    LEFT,
    RIGHT,
    class_choices,
    limits_of,
    series_of,
    unknown_name,
)
from core.extras.shapes.usual_fields import MOST_RPM, too_deep, too_fast, tool_field
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch, tool

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
    """Yield metric drill sizes: tenths up to 14 mm, quarters up to 50 mm."""
    yield from (n / 10 for n in range(10, 140))
    yield from (n / 4 for n in range(56, 201))


def drill_for(least: float, most: float, *, metric: bool) -> tuple[str, float] | None:
    """Return name and size of the drill for a hole between two limits, in mm or inches; or None.

    The drill is the largest that is not above the middle, because drills cut oversize. Otherwise the next
    larger drill is used.
    """
    sold = {f"{size:g}": size for size in _metric()} if metric else _INCH
    fits = sorted((size, name) for name, size in sold.items() if least <= size <= most)
    middle = (least + most) / 2.0 + (_OVER if metric else 0.0)
    below = [each for each in fits if each[0] <= middle]
    chosen = below[-1] if below else fits[0] if fits else None
    return None if chosen is None else (chosen[1], chosen[0])


_SLOW = 0.4  # fraction of the speed of a drill, because the flanks of a tap rub
_MOST_RPM = 600.0
_SHORT = 1.0  # pitches before the depth, because the spindle overruns while it reverses
_COARSEST = 0.2  # in/rev, the highest feed of the control without G35


FLOATING, RIGID = "FLOATING", "RIGID"


def _rigid(values: Values) -> bool:
    return text(values, "HOLDER") == RIGID


def _named(values: Values) -> bool:
    return series_of(values) is not Series.OWN


def _pitch(values: Values, setting: Setting) -> Value | None:
    found = size_of(series_of(values), text(values, "SIZE"))
    if found is None:
        return None
    return round(in_unit(found.pitch, series_of(values), metric=setting.metric), 6)


def _across(values: Values, setting: Setting) -> Value | None:
    found = size_of(series_of(values), text(values, "SIZE"))
    if found is None:
        return None
    return round(in_unit(found.diameter, series_of(values), metric=setting.metric), 4)


def _turns(values: Values, setting: Setting) -> Value | None:
    across = number(values, "DIA")
    if not across:
        return None
    return max(50.0, 50.0 * math.floor(min(_SLOW * rpm(Work.DRILL, across, setting), _MOST_RPM) / 50.0))


def _tap(filled: Filled, setting: Setting, code: Code) -> None:
    pitch = filled.n("PITCH")
    start = math.ceil(max(setting.near, 3.0 * pitch) * 100.0 - 1e-6) / 100.0
    into = "M04" if filled.t("HAND") == LEFT else "M03"
    end = -(filled.n("DEEP") - (0.0 if _rigid(filled.values) else filled.n("SHORT")))
    held = _rigid(filled.values)
    code.tap(filled.n("T"), Tap(start, end, pitch, filled.n("RPM"), into, filled.n("DWELL"), held))
    code.away()


def _checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    series, pitch = series_of(filled.values), filled.n("PITCH")
    if series in TAPERED or series is Series.ACME:
        yield Refusal(
            "SERIES",
            Message(
                "{series} threads cannot be tapped with this shape: cut the thread with G33.", series=series
            ),
        )
    if pitch * setting.mm / 25.4 > _COARSEST:
        most = _COARSEST * 25.4 / setting.mm
        yield Refusal(
            "PITCH",
            Message(
                "A pitch of {pitch} is more than the largest feed, {maximum}: cut the thread with G33.",
                pitch=f"{pitch:g}",
                maximum=f"{most:g}",
            ),
        )
    if filled.n("SHORT") >= filled.n("DEEP") and not _rigid(filled.values):
        yield Refusal(
            "SHORT",
            Message(
                "The tap would stop {number} short of depth {number2}, so nothing is cut.",
                number=f"{filled.n('SHORT'):g}",
                number2=f"{filled.n('DEEP'):g}",
            ),
        )
    speed = pitch * filled.n("RPM") * setting.mm / 25.4
    if speed > 300.0:
        yield Refusal(
            "RPM",
            Message(
                "At S{number} the axis needs {speed} in/min, but the axis limit is 300 in/min: "
                "enter a lower speed.",
                number=f"{filled.n('RPM'):g}",
                speed=f"{speed:.0f}",
            ),
        )
    shape, name = setting.tool(filled.n("T")), f"T{filled.n('T'):.0f}"
    if shape is not None and shape.pitch and abs(shape.pitch / setting.mm - pitch) > 0.01 * pitch:
        yield Refusal(
            "T",
            Message(
                "The tool data of {name} specifies a pitch of {pitch}, but this thread has a "
                "pitch of {needed}: use another tap.",
                name=name,
                pitch=f"{shape.pitch / setting.mm:.5g}",
                needed=f"{pitch:.5g}",
            ),
        )
    yield from too_deep(filled, setting)
    yield from too_fast(filled, setting)


def _says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    known = limits_of({**filled.values, "SIDE": INSIDE, "CLASS": _usual_class(filled)}, setting)
    if known is None:
        return ()
    series = series_of(filled.values)
    places, unit = (2 if setting.metric else 4), in_unit(1.0, series, metric=setting.metric)
    least, most = (plain(value * unit, places) for value in known.minor)
    told = Message(
        "hole diameter before tapping: {crest}; limits {minimum} to {maximum}",
        crest=plain(known.crest * unit, places),
        minimum=least,
        maximum=most,
    )
    drill = drill_for(*known.minor, metric=series in METRIC)
    return (
        (told,)
        if drill is None
        else (told, Message("tap drill: {series}", series=_called(*drill, series, setting)))
    )


def _called(name: str, size: float, series: Series, setting: Setting) -> str:
    """Return the name of a drill, with its size in the program's unit if the name is in another unit."""
    size = in_unit(size, series, metric=setting.metric)
    shown = plain(size, 3 if setting.metric else 4)
    named = Message("{unit} mm", unit=name) if series in METRIC else name
    return (
        named
        if series in METRIC and setting.metric
        else Message("{named}, {value}", named=named, value=shown)
    )


def _usual_class(filled: Filled) -> str:
    allowed = class_choices({**filled.values, "SIDE": INSIDE})
    return allowed[0] if allowed else ""


def _sketch(_filled: Filled) -> Sketch:
    wall = part((0, 0), (0, 10), (-24, 10), (-24, 0))
    teeth = [(-k, 4.0 if k % 2 else 3.4) for k in range(15)]
    body = tool((-14, -3.4), (-14, 3.4), (8, 3.4), (8, -3.4))
    dims = (Dim("DEEP", (-14, 10), (0, 10), 3), Dim("DIA", (-17, -4), (-17, 4)), Dim("PITCH", (-4, 6.4)))
    return sketch(wall, body, cut(*teeth), dims=dims)


TAP = Shape(
    "TAP",
    "tapping on the spindle centerline: feed in, reverse the spindle, feed out at the pitch",
    (
        tool_field(ToolKind.TAP),
        Field("SERIES", "SERIES", Kind.CHOICE, Series.UNC.value, tuple(each.value for each in Series)),
        Field("SIZE", "SIZE", Kind.NAME, None, only=_named),
        Field("DIA", "DIAMETER", Kind.DIAMETER, _across, marked=True),
        Field("PITCH", "PITCH", Kind.LENGTH, _pitch),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("HAND", "HAND", Kind.CHOICE, RIGHT, (RIGHT, LEFT)),
        Field(
            "SHORT",
            "STOP DISTANCE BEFORE DEPTH",
            Kind.LENGTH,
            lambda v, _s: round(_SHORT * number(v, "PITCH"), 4),
            zero=True,
            only=lambda v: not _rigid(v),
        ),
        Field("DWELL", "DWELL DURING REVERSAL", Kind.SECONDS, 0.5, zero=True, most=60),
        Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, _turns, most=MOST_RPM),
    ),
    _tap,
    _sketch,
    _checks,
    first=unknown_name,
    says=_says,
)


def _sinumerik_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from _checks(filled, setting)
    if not _rigid(filled.values):
        return
    if not setting.shop.spindle_is_c:
        yield Refusal(
            "HOLDER",
            "The spindle of this machine cannot be positioned and turned in sync with Z: "
            "use a floating tap holder.",
        )
    elif filled.n("RPM") > setting.shop.c_rpm:
        most = f"{setting.shop.c_rpm:g}"
        yield Refusal(
            "RPM",
            Message(
                "A rigid tap turns with the C axis, which reaches {maximum} rpm: enter {maximum2} or less.",
                maximum=most,
                maximum2=most,
            ),
        )


def _held_turns(values: Values, setting: Setting) -> Value | None:
    """Return the proposed rpm, limited to that of the C axis for a rigid tap."""
    turns = _turns(values, setting)
    most = setting.shop.c_rpm if _rigid(values) else math.inf
    return min(turns, most) if isinstance(turns, float) else turns


SINUMERIK_TAP = replace(
    TAP,
    checks=_sinumerik_checks,
    fields=(
        TAP.fields[0],
        Field("HOLDER", "HOLDER", Kind.CHOICE, FLOATING, (FLOATING, RIGID)),
        *(replace(each, start=_held_turns) if each.word == "RPM" else each for each in TAP.fields[1:]),
    ),
)
"""The same by CYCLE840, or by CYCLE84 without a holder that gives."""
