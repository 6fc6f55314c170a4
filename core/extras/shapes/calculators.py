"""Calculators of the editor: taper triangle, thread passes, and feed and speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from core.extras.shapes import cutting_data
from core.extras.shapes.cutting_data import MATERIALS, Work, rough_depth
from core.extras.shapes.lines.code_lines import Code, plain
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import (
    Field,
    Kind,
    Proposal,
    Refusal,
    Setting,
    Value,
    Values,
    number,
    text,
)
from core.extras.shapes.threads.thread_values import filled_depth
from core.extras.shapes.threads.threading import THREAD, first_depth, first_word
from core.extras.shapes.usual_fields import MOST_RPM, too_fast
from core.message import Message
from core.sketch import Dim, Sketch, cut, part, sketch

_INCHES, _MILLIMETRES = 12.0, 1000.0


# --- Triangle: a taper from any three of diameters, length and angle


def triangle(known: Mapping[str, Value]) -> dict[str, float]:
    """Return SMALL, LARGE, LONG and ANGLE (degrees to the axis), calculated if three of them are known."""
    at = {word: number(known, word) for word in ("SMALL", "LARGE", "LONG", "ANGLE") if word in known}
    if {"SMALL", "LARGE", "LONG"} <= at.keys() and at["LONG"]:
        at["ANGLE"] = math.degrees(math.atan((at["LARGE"] - at["SMALL"]) / 2.0 / at["LONG"]))
    elif "ANGLE" in at and 0.0 < abs(at["ANGLE"]) < 90.0:
        slope = math.tan(math.radians(at["ANGLE"]))
        if {"SMALL", "LARGE"} <= at.keys():
            at["LONG"] = (at["LARGE"] - at["SMALL"]) / 2.0 / slope
        elif {"SMALL", "LONG"} <= at.keys():
            at["LARGE"] = at["SMALL"] + 2.0 * at["LONG"] * slope
        elif {"LARGE", "LONG"} <= at.keys():
            at["SMALL"] = at["LARGE"] - 2.0 * at["LONG"] * slope
    return at


def _of_triangle(word: str) -> Proposal:
    def proposed(values: Values, _setting: Setting) -> Value | None:
        found = triangle(values).get(word)
        return None if found is None else round(found, 5)

    return proposed


def _taper_lines(filled: Filled, _setting: Setting, code: Code) -> None:
    code.write(
        code.point(filled.n("SMALL") / 2.0, 0.0), code.point(filled.n("LARGE") / 2.0, -filled.n("LONG"))
    )


def _taper_checks(filled: Filled, _setting: Setting) -> Iterator[Refusal]:
    found = triangle({word: filled.n(word) for word in ("SMALL", "LARGE", "LONG")})
    angle = found.get("ANGLE", 0.0)
    if abs(angle - filled.n("ANGLE")) > 0.01:
        words = Message(
            "These four values do not define a taper: the angle would be {angle}. Clear one of the values.",
            angle=f"{angle:.4g}",
        )
        yield Refusal("ANGLE", words)
    if filled.n("SMALL") < 0.0 or filled.n("LARGE") < 0.0:
        yield Refusal("SMALL", "The taper crosses the spindle centerline: check the angle and the length.")


def _taper_says(filled: Filled, _setting: Setting) -> tuple[str, ...]:
    rise, long = (filled.n("LARGE") - filled.n("SMALL")) / 2.0, filled.n("LONG")
    ratio = f"1 : {plain(long / (2.0 * rise), 4)}" if rise else "none"
    return (
        Message("slant length {rise}", rise=plain(math.hypot(rise, long), 4)),
        Message("included angle {number}°", number=plain(2.0 * filled.n("ANGLE"), 4)),
        Message("taper ratio on the diameter: {ratio}", ratio=ratio),
    )


def _taper_sketch(_filled: Filled) -> Sketch:
    solid = part((0, 0), (0, 5), (-16, 9), (-22, 9), (-22, 0))
    dims = (
        Dim("SMALL", (-1, -5), (-1, 5)),
        Dim("LARGE", (-18, -9), (-18, 9)),
        Dim("LONG", (-16, 9), (0, 9), 4),
        Dim("ANGLE", (-8, 5)),
    )
    return sketch(solid, cut((0, 5), (-16, 9)), dims=dims)


TRIANGLE = Shape(
    "TRIANGLE",
    "calculates a taper from any three of four values: the two diameters, the length and the angle",
    (
        Field("SMALL", "DIAMETER AT THE FACE", Kind.COORDINATE, _of_triangle("SMALL")),
        Field("LARGE", "DIAMETER AT THE CHUCK", Kind.COORDINATE, _of_triangle("LARGE")),
        Field("LONG", "LENGTH", Kind.LENGTH, _of_triangle("LONG")),
        Field("ANGLE", "ANGLE TO THE AXIS", Kind.ANGLE, _of_triangle("ANGLE"), most=89.9),
    ),
    _taper_lines,
    _taper_sketch,
    _taper_checks,
    noted=False,
    says=_taper_says,
)


# --- Feed and speed


def _around(values: Values, setting: Setting) -> float:
    """Return the rpm for one unit of surface speed; 0 if the diameter is unknown."""
    across = number(values, "DIA")
    return (_MILLIMETRES if setting.metric else _INCHES) / (math.pi * across) if across else 0.0


def _work(values: Values) -> Work:
    return Work(text(values, "WORK").lower() or Work.TURN)


def _of_material(values: Values, setting: Setting) -> Setting:
    return replace(setting, material=text(values, "MATERIAL"))


def _surface(values: Values, setting: Setting) -> Value | None:
    turns = _around(values, setting)
    if "RPM" in values and turns:
        return round(number(values, "RPM") / turns, 1)
    return cutting_data.surface_speed(_work(values), _of_material(values, setting))


def _turns(values: Values, setting: Setting) -> Value | None:
    turns = _around(values, setting)
    if not turns:
        return None
    wanted = number(values, "SURF") * turns
    return float(max(1, math.floor(min(wanted, setting.shop.max_rpm))))


def _per_turn(values: Values, setting: Setting) -> Value | None:
    rpm = number(values, "RPM")
    if "RATE" in values and rpm:
        return round(number(values, "RATE") / rpm, 5)
    return cutting_data.feed(_work(values), _of_material(values, setting), 0.0, number(values, "DIA"))


def _per_minute(values: Values, _setting: Setting) -> Value | None:
    rpm, feed = number(values, "RPM"), number(values, "FEED")
    return round(rpm * feed, 3) if rpm and feed else None


def _speed_lines(filled: Filled, _setting: Setting, code: Code) -> None:
    code.write(f"M03S{plain(filled.n('RPM'), 0)}", f"G95F{plain(filled.n('FEED'), 6)}")


def _speed_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from too_fast(filled, setting)
    rate = filled.n("RPM") * filled.n("FEED")
    if abs(rate - filled.n("RATE")) > 0.01 * max(rate, 1e-6):
        words = Message(
            "{number} rpm at {number2} per revolution is {rate} per minute: clear one of the values.",
            number=f"{filled.n('RPM'):g}",
            number2=f"{filled.n('FEED'):g}",
            rate=f"{rate:.4g}",
        )
        yield Refusal("RATE", words)


def _speed_says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    turns = _around(filled.values, setting)
    real = filled.n("RPM") / turns if turns else 0.0
    unit = "m/min" if setting.metric else "ft/min"
    return (
        Message("equivalent feed per minute: G94F{number}", number=plain(filled.n("RATE"), 3)),
        Message(
            "S{number} gives a surface speed of {real} {unit} at this diameter",
            number=f"{filled.n('RPM'):.0f}",
            real=f"{real:.0f}",
            unit=unit,
        ),
        *_depth_says(filled, setting),
    )


def _depth_says(filled: Filled, setting: Setting) -> Iterator[str]:
    """Yield the depth of a roughing pass, for turning and boring."""
    work = _work(filled.values)
    if work in {Work.TURN, Work.BORE}:
        now = _of_material(filled.values, setting)
        depth = rough_depth(now, 0.0, filled.n("DIA"), inside=work is Work.BORE)
        yield Message("roughing passes {depth} deep per side", depth=plain(depth, 4))


def _speed_sketch(_filled: Filled) -> Sketch:
    solid = part((0, 0), (0, 8), (-22, 8), (-22, 0))
    dims = (Dim("DIA", (-14, -8), (-14, 8)), Dim("FEED", (-4, 10)), Dim("RPM", (-19, 4)))
    return sketch(solid, cut((0, 8), (-8, 8)), dims=dims)


SPEED = Shape(
    "FEED AND SPEED",
    "rpm, surface speed, feed per revolution and feed per minute: TurnDesk calculates "
    "the values that you leave empty",
    (
        Field("MATERIAL", "MATERIAL", Kind.CHOICE, "STEEL", tuple(MATERIALS)),
        Field("WORK", "WORK", Kind.CHOICE, Work.TURN.upper(), tuple(each.upper() for each in Work)),
        Field("DIA", "DIAMETER", Kind.DIAMETER, lambda _v, s: s.bar or None),
        Field("SURF", "SURFACE SPEED", Kind.SURFACE, _surface),
        Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, _turns, most=MOST_RPM),
        Field("FEED", "FEED PER REVOLUTION", Kind.FEED, _per_turn),
        Field("RATE", "FEED PER MINUTE", Kind.RATE, _per_minute),
    ),
    _speed_lines,
    _speed_sketch,
    _speed_checks,
    noted=False,
    says=_speed_says,
)


# --- Thread


def _own(word: str) -> Field:
    found = THREAD.field(word)
    assert found is not None
    return found


def _first(values: Values, _setting: Setting) -> Value | None:
    passes = number(values, "PASSES")
    deep = abs(number(values, "CREST") - number(values, "ROOT")) / 2.0
    return round(deep / math.sqrt(passes), 5) if passes and deep else None


def _thread_lines(filled: Filled, setting: Setting, code: Code) -> None:
    infeed = filled.n("INFEED")
    c = "" if not infeed else "C" if infeed == 29.0 else f"C{plain(infeed)}"
    words = f"{code.x(filled.n('ROOT') / 2.0)}{code.z(-filled.n('LONG'))}"
    words += code.x(first_word(filled, setting), "I")
    code.write(f"G33{words}K{plain(filled.n('PITCH'), 6)}{c}")


def _thread_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from THREAD.checks(filled, setting)
    deep = first_depth(filled)
    if abs(deep - filled.n("FIRST")) > 1e-4:
        words = Message(
            "{number} passes require a first pass {depth} deep: clear one of the two values.",
            number=f"{filled.n('PASSES'):g}",
            depth=plain(deep, 5),
        )
        yield Refusal("FIRST", words)


def _passes(values: Values, setting: Setting) -> Value | None:
    """Return the number of passes for the specified first depth, or else the insert makers' proposal."""
    first, deep = number(values, "FIRST"), abs(number(values, "CREST") - number(values, "ROOT")) / 2.0
    if first and deep:
        return (deep / first) ** 2
    return _own("PASSES").proposed(values, setting)


def _thread_says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    deep, first, count = filled_depth(filled), first_depth(filled), filled.n("PASSES")
    outwards = -1.0 if filled.t("SIDE") == "BORE" else 1.0
    shown = 1.0 if setting.diameter else 0.5
    at = [
        filled.n("CREST") - outwards * 2.0 * min(first * math.sqrt(k), deep)
        for k in range(1, math.ceil(count) + 1)
    ]
    start = filled.n("CREST") - outwards * 2.0 * first
    return (
        Message(
            "thread depth {depth} per side, depth of the first pass {first}",
            depth=plain(deep, 4),
            first=plain(first, 4),
        ),
        Message("the tool starts at X {value}", value=plain(shown * start, 4)),
        Message("X position of each pass: {value}", value=" ".join(plain(shown * x, 4) for x in at)),
    )


THREADS = Shape(
    "THREAD PASSES",
    "diameters, depth and passes of a standard thread",
    (
        *(_own(word) for word in ("SERIES", "SIZE", "SIDE", "CLASS", "PITCH", "CREST", "ROOT")),
        Field(
            "LONG",
            "LENGTH",
            Kind.LENGTH,
            lambda v, s: _own("LONG").proposed(v, s) or 10.0 * number(v, "PITCH") or None,
        ),
        Field("PASSES", "PASSES", Kind.RATIO, _passes, most=60),
        Field("FIRST", "DEPTH OF FIRST PASS", Kind.LENGTH, _first),
        _own("INFEED"),
    ),
    _thread_lines,
    THREAD.sketch,
    _thread_checks,
    noted=False,
    first=THREAD.first,
    says=_thread_says,
)
