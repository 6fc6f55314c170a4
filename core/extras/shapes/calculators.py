"""Calculators of the editor: taper triangle, thread passes, and feed and speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from core.extras.shapes import cutting_data
from core.extras.shapes.common_fields import MAX_RPM, check_rpm
from core.extras.shapes.cutting_data import CUTTING_DATA, Operation, propose_roughing_depth
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import CodeWriter, format_short_number
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    ValueProposal,
    number,
    text,
)
from core.extras.shapes.threads.thread_values import calculate_thread_depth
from core.extras.shapes.threads.threading import THREAD_SHAPE, calculate_first_depth, round_first_depth
from core.message import Message
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch

_INCHES, _MILLIMETRES = 12.0, 1000.0


# --- Triangle: a taper from any three of diameters, length and angle


def solve_taper(known_values: Mapping[str, FieldValue]) -> dict[str, float]:
    """Return the known values of a taper, and the fourth value if three are known.

    The values are SMALL, LARGE, LONG and ANGLE. ANGLE is the angle to the axis in degrees.
    """
    at = {
        word: number(known_values, word)
        for word in ("SMALL", "LARGE", "LONG", "ANGLE")
        if word in known_values
    }
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


def _of_triangle(word: str) -> ValueProposal:
    def propose_taper_value(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
        found = solve_taper(values).get(word)
        return None if found is None else round(found, 5)

    return propose_taper_value


def _taper_lines(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    code.append_lines(
        code.format_point(filled.get_number("SMALL") / 2.0, 0.0),
        code.format_point(filled.get_number("LARGE") / 2.0, -filled.get_number("LONG")),
    )


def _taper_checks(filled: ShapeInstance, _setting: ProgramSettings) -> Iterator[FieldError]:
    found = solve_taper({word: filled.get_number(word) for word in ("SMALL", "LARGE", "LONG")})
    angle = found.get("ANGLE", 0.0)
    if abs(angle - filled.get_number("ANGLE")) > 0.01:
        words = Message(
            "These four values do not define a taper: the angle would be {angle}. Clear one of the values.",
            angle=f"{angle:.4g}",
        )
        yield FieldError("ANGLE", words)
    if filled.get_number("SMALL") < 0.0 or filled.get_number("LARGE") < 0.0:
        yield FieldError("SMALL", "The taper crosses the spindle centerline: check the angle and the length.")


def _taper_says(filled: ShapeInstance, _setting: ProgramSettings) -> tuple[str, ...]:
    rise, long = (filled.get_number("LARGE") - filled.get_number("SMALL")) / 2.0, filled.get_number("LONG")
    ratio = f"1 : {format_short_number(long / (2.0 * rise), 4)}" if rise else "none"
    return (
        Message("slant length {rise}", rise=format_short_number(math.hypot(rise, long), 4)),
        Message("included angle {number}°", number=format_short_number(2.0 * filled.get_number("ANGLE"), 4)),
        Message("taper ratio on the diameter: {ratio}", ratio=ratio),
    )


def _taper_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, 0), (0, 5), (-16, 9), (-22, 9), (-22, 0))
    dims = (
        Dimension("SMALL", (-1, -5), (-1, 5)),
        Dimension("LARGE", (-18, -9), (-18, 9)),
        Dimension("LONG", (-16, 9), (0, 9), 4),
        Dimension("ANGLE", (-8, 5)),
    )
    return make_sketch(solid, make_cut_outline((0, 5), (-16, 9)), dimensions=dims)


TAPER_CALCULATOR = Shape(
    "TRIANGLE",
    "calculates a taper from any three of four values: the two diameters, the length and the angle",
    (
        ShapeField("SMALL", "DIAMETER AT THE FACE", FieldKind.COORDINATE, _of_triangle("SMALL")),
        ShapeField("LARGE", "DIAMETER AT THE CHUCK", FieldKind.COORDINATE, _of_triangle("LARGE")),
        ShapeField("LONG", "LENGTH", FieldKind.LENGTH, _of_triangle("LONG")),
        ShapeField("ANGLE", "ANGLE TO THE AXIS", FieldKind.ANGLE, _of_triangle("ANGLE"), maximum=89.9),
    ),
    _taper_lines,
    _taper_sketch,
    _taper_checks,
    has_comment=False,
    make_notes=_taper_says,
)


# --- Feed and speed


def _around(values: FieldValues, settings: ProgramSettings) -> float:
    """Return the spindle speed in rpm for a surface speed of 1, or 0 if the diameter is unknown."""
    across = number(values, "DIA")
    return (_MILLIMETRES if settings.metric else _INCHES) / (math.pi * across) if across else 0.0


def _work(values: FieldValues) -> Operation:
    return Operation(text(values, "WORK").lower() or Operation.TURN)


def _of_material(values: FieldValues, setting: ProgramSettings) -> ProgramSettings:
    return replace(setting, material=text(values, "MATERIAL"))


def _surface(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    turns = _around(values, setting)
    if "RPM" in values and turns:
        return round(number(values, "RPM") / turns, 1)
    return cutting_data.propose_surface_speed(_work(values), _of_material(values, setting))


def _turns(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    turns = _around(values, setting)
    if not turns:
        return None
    wanted = number(values, "SURF") * turns
    return float(max(1, math.floor(min(wanted, setting.shop.max_rpm))))


def _per_turn(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    rpm = number(values, "RPM")
    if "RATE" in values and rpm:
        return round(number(values, "RATE") / rpm, 5)
    return cutting_data.propose_feed(_work(values), _of_material(values, setting), 0.0, number(values, "DIA"))


def _per_minute(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
    rpm, feed = number(values, "RPM"), number(values, "FEED")
    return round(rpm * feed, 3) if rpm and feed else None


def _speed_lines(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    code.append_lines(
        f"M03S{format_short_number(filled.get_number('RPM'), 0)}",
        f"G95F{format_short_number(filled.get_number('FEED'), 6)}",
    )


def _speed_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from check_rpm(filled, setting)
    rate = filled.get_number("RPM") * filled.get_number("FEED")
    if abs(rate - filled.get_number("RATE")) > 0.01 * max(rate, 1e-6):
        words = Message(
            "{number} rpm at {number2} per revolution is {rate} per minute: clear one of the values.",
            number=f"{filled.get_number('RPM'):g}",
            number2=f"{filled.get_number('FEED'):g}",
            rate=f"{rate:.4g}",
        )
        yield FieldError("RATE", words)


def _speed_says(filled: ShapeInstance, setting: ProgramSettings) -> tuple[str, ...]:
    turns = _around(filled.field_values, setting)
    real = filled.get_number("RPM") / turns if turns else 0.0
    unit = "m/min" if setting.metric else "ft/min"
    return (
        Message(
            "equivalent feed per minute: G94F{number}",
            number=format_short_number(filled.get_number("RATE"), 3),
        ),
        Message(
            "S{number} gives a surface speed of {real} {unit} at this diameter",
            number=f"{filled.get_number('RPM'):.0f}",
            real=f"{real:.0f}",
            unit=unit,
        ),
        *_make_depth_remarks(filled, setting),
    )


def _make_depth_remarks(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[str]:
    """Yield a remark about the depth of a roughing pass, for turning and boring."""
    work = _work(filled_shape.field_values)
    if work in {Operation.TURN, Operation.BORE}:
        now = _of_material(filled_shape.field_values, settings)
        depth = propose_roughing_depth(
            now, 0.0, filled_shape.get_number("DIA"), is_inside=work is Operation.BORE
        )
        yield Message("roughing passes {depth} deep per side", depth=format_short_number(depth, 4))


def _speed_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, 0), (0, 8), (-22, 8), (-22, 0))
    dims = (Dimension("DIA", (-14, -8), (-14, 8)), Dimension("FEED", (-4, 10)), Dimension("RPM", (-19, 4)))
    return make_sketch(solid, make_cut_outline((0, 8), (-8, 8)), dimensions=dims)


SPEED_CALCULATOR = Shape(
    "FEED AND SPEED",
    "rpm, surface speed, feed per revolution and feed per minute: TurnDesk calculates "
    "the values that you leave empty",
    (
        ShapeField("MATERIAL", "MATERIAL", FieldKind.CHOICE, "STEEL", tuple(CUTTING_DATA)),
        ShapeField(
            "WORK",
            "WORK",
            FieldKind.CHOICE,
            Operation.TURN.upper(),
            tuple(each.upper() for each in Operation),
        ),
        ShapeField("DIA", "DIAMETER", FieldKind.DIAMETER, lambda _v, s: s.bar or None),
        ShapeField("SURF", "SURFACE SPEED", FieldKind.SURFACE_SPEED, _surface),
        ShapeField("RPM", "SPINDLE SPEED, RPM", FieldKind.RPM, _turns, maximum=MAX_RPM),
        ShapeField("FEED", "FEED PER REVOLUTION", FieldKind.FEED, _per_turn),
        ShapeField("RATE", "FEED PER MINUTE", FieldKind.RATE, _per_minute),
    ),
    _speed_lines,
    _speed_sketch,
    _speed_checks,
    has_comment=False,
    make_notes=_speed_says,
)


# --- Thread


def _own(word: str) -> ShapeField:
    found = THREAD_SHAPE.find_field(word)
    assert found is not None
    return found


def _first(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
    passes = number(values, "PASSES")
    deep = abs(number(values, "CREST") - number(values, "ROOT")) / 2.0
    return round(deep / math.sqrt(passes), 5) if passes and deep else None


def _thread_lines(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    infeed = filled.get_number("INFEED")
    c = "" if not infeed else "C" if infeed == 29.0 else f"C{format_short_number(infeed)}"
    words = f"{code.format_x(filled.get_number('ROOT') / 2.0)}{code.format_z(-filled.get_number('LONG'))}"
    words += code.format_x(round_first_depth(filled, setting), "I")
    code.append_lines(f"G33{words}K{format_short_number(filled.get_number('PITCH'), 6)}{c}")


def _thread_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from THREAD_SHAPE.find_field_conflicts(filled, setting)
    deep = calculate_first_depth(filled)
    if abs(deep - filled.get_number("FIRST")) > 1e-4:
        words = Message(
            "{number} passes require a first pass {depth} deep: clear one of the two values.",
            number=f"{filled.get_number('PASSES'):g}",
            depth=format_short_number(deep, 5),
        )
        yield FieldError("FIRST", words)


def _passes(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Return the number of thread passes that results from the specified first depth.

    If no first depth is specified, return the number that insert makers recommend.
    """
    first, deep = number(values, "FIRST"), abs(number(values, "CREST") - number(values, "ROOT")) / 2.0
    if first and deep:
        return (deep / first) ** 2
    return _own("PASSES").propose_value(values, settings)


def _thread_says(filled: ShapeInstance, setting: ProgramSettings) -> tuple[str, ...]:
    deep, first, count = (
        calculate_thread_depth(filled),
        calculate_first_depth(filled),
        filled.get_number("PASSES"),
    )
    outwards = -1.0 if filled.get_text("SIDE") == "BORE" else 1.0
    shown = 1.0 if setting.diameter else 0.5
    at = [
        filled.get_number("CREST") - outwards * 2.0 * min(first * math.sqrt(k), deep)
        for k in range(1, math.ceil(count) + 1)
    ]
    start = filled.get_number("CREST") - outwards * 2.0 * first
    return (
        Message(
            "thread depth {depth} per side, depth of the first pass {first}",
            depth=format_short_number(deep, 4),
            first=format_short_number(first, 4),
        ),
        Message("the tool starts at X {value}", value=format_short_number(shown * start, 4)),
        Message(
            "X position of each pass: {value}", value=" ".join(format_short_number(shown * x, 4) for x in at)
        ),
    )


THREAD_CALCULATOR = Shape(
    "THREAD PASSES",
    "diameters, depth and passes of a standard thread",
    (
        *(_own(word) for word in ("SERIES", "SIZE", "SIDE", "CLASS", "PITCH", "CREST", "ROOT")),
        ShapeField(
            "LONG",
            "LENGTH",
            FieldKind.LENGTH,
            lambda v, s: _own("LONG").propose_value(v, s) or 10.0 * number(v, "PITCH") or None,
        ),
        ShapeField("PASSES", "PASSES", FieldKind.RATIO, _passes, maximum=60),
        ShapeField("FIRST", "DEPTH OF FIRST PASS", FieldKind.LENGTH, _first),
        _own("INFEED"),
    ),
    _thread_lines,
    THREAD_SHAPE.make_sketch,
    _thread_checks,
    has_comment=False,
    find_blocking_errors=THREAD_SHAPE.find_blocking_errors,
    make_notes=_thread_says,
)
