"""Shapes for a live tool with the spindle as C axis: cross holes, flats and slots."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from core.extras.shapes import cutting_data
from core.extras.shapes.common_fields import (
    MAX_RPM,
    check_flute_length,
    make_tool_field,
    propose_bar_diameter,
)
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.drilling import _across
from core.extras.shapes.lines.code_lines import CodeWriter
from core.extras.shapes.lines.live_lines import (
    CylinderSlots,
    FaceMilling,
    LiveToolWriter,
    RadialHoles,
    SinumerikLiveToolWriter,
)
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    ValueProposal,
    number,
)
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import (
    Dimension,
    Outline,
    Sketch,
    make_cut_outline,
    make_part_outline,
    make_sketch,
    make_tool_outline,
)

_LIVE_RPM = 3000.0  # speed of a small live tool, for which OmniTurn has no word
_TEETH = 2.0
ShapeCheck = Callable[[ShapeInstance, ProgramSettings], Iterator[FieldError]]
FRONT, REAR = "FRONT", "REAR"


def _rate(work: Operation) -> ValueProposal:
    """Return a function that proposes the feed per minute from the speed of the live tool.

    A mill is assumed to have two teeth.
    """

    def propose_feed_per_minute(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
        turns = number(values, "LRPM") or _LIVE_RPM
        if work is Operation.DRILL:
            turn = cutting_data.propose_feed(work, setting, number(values, "T"), number(values, "DIA"))
            return round(turn * turns * 0.5, 0 if setting.metric else 1)
        turn = cutting_data.propose_feed(work, setting) * _TEETH
        return round(turn * turns, 0 if setting.metric else 1)

    return propose_feed_per_minute


def _lines(filled_shape: ShapeInstance, settings: ProgramSettings, code: CodeWriter) -> LiveToolWriter:
    """Return a live tool writer for the language of the program."""
    kind = SinumerikLiveToolWriter if settings.dialect is Dialect.SINUMERIK else LiveToolWriter
    return kind(code, filled_shape.get_number("LRPM"))


def _step(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
    many = number(values, "COUNT")
    return round(360.0 / many, 4) if many else None


# --- Cross holes


def _cross(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    sign = -1.0 if filled.get_text("SIDE") == REAR else 1.0
    surface = filled.get_number("FROM") / 2.0
    holes = RadialHoles(
        sign * (surface + setting.near / 2.0),
        sign * (surface - filled.get_number("DEEP")),
        -filled.get_number("AT"),
        filled.get_number("ANGLE"),
        int(filled.get_number("COUNT")),
        filled.get_number("STEP"),
        filled.get_number("RATE"),
    )
    _lines(filled, setting, code).write_holes(filled.get_number("T"), holes)


def _cross_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    deep, across = filled.get_number("DEEP"), filled.get_number("FROM")
    if deep > across:
        yield FieldError(
            "DEEP",
            Message(
                "Depth {depth} is more than the diameter of {across}: the drill would come out on the "
                "far side.",
                depth=f"{deep:g}",
                across=f"{across:g}",
            ),
        )
    if (
        filled.get_number("COUNT") > 1
        and abs(filled.get_number("STEP")) * filled.get_number("COUNT") > 360.0 + 1e-6
    ):
        words = Message(
            "{number} holes spaced {number2}° apart go around the part more than once: enter a "
            "smaller angle.",
            number=f"{filled.get_number('COUNT'):.0f}",
            number2=f"{filled.get_number('STEP'):g}",
        )
        yield FieldError("STEP", words)
    yield from check_flute_length(filled, setting)


def _cross_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, -10), (0, 10), (-26, 10), (-26, -10))
    return make_sketch(
        solid,
        make_cut_outline((-10, 10), (-10, 2), (-13, 2), (-13, 10)),
        make_tool_outline((-10, 17), (-10, 11.5), (-11.5, 10.5), (-13, 11.5), (-13, 17)),
        dimensions=(
            Dimension("FROM", (-22, -10), (-22, 10)),
            Dimension("AT", (-11.5, 10), (0, 10), 3),
            Dimension("DEEP", (-7, 2), (-7, 10)),
            Dimension("DIA", (-13, 17), (-10, 17), 1),
            Dimension("ANGLE", (-12, -2)),
            Dimension("STEP", (-12, -6)),
        ),
    )


CROSS_HOLES_SHAPE = Shape(
    "CROSS DRILL",
    "radial holes around the part, drilled with the spindle stopped in position",
    (
        make_tool_field(ToolKind.DRILL, ToolKind.END_MILL),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, FRONT, (FRONT, REAR)),
        ShapeField("DIA", "DRILL DIAMETER", FieldKind.DIAMETER, _across, is_in_comment=True),
        ShapeField("FROM", "PART DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("AT", "DISTANCE FROM Z0 TO CENTER", FieldKind.LENGTH),
        ShapeField("DEEP", "DEPTH", FieldKind.LENGTH),
        ShapeField("ANGLE", "FIRST ANGLE", FieldKind.ANGLE, 0.0, allows_zero=True),
        ShapeField("COUNT", "HOLES", FieldKind.COUNT, 1.0, maximum=360),
        ShapeField(
            "STEP", "ANGLE BETWEEN HOLES", FieldKind.ANGLE, _step, applies_to=lambda v: number(v, "COUNT") > 1
        ),
        ShapeField("RATE", "FEED PER MINUTE", FieldKind.RATE, _rate(Operation.DRILL), maximum=300),
    ),
    _cross,
    _cross_sketch,
    _cross_checks,
)


# --- Flats in the plane XC


def _flat_path(
    filled_shape: ShapeInstance, settings: ProgramSettings
) -> tuple[float, list[tuple[float, float]]]:
    """Return the X of the approach, and the path of the cutter center around the flats.

    The points of the path are (x, y) as seen from the front of the part.
    """
    many, radius = int(filled_shape.get_number("FLATS")), filled_shape.get_number("DIA") / 2.0
    away = filled_shape.get_number("ACROSS") / 2.0 + radius
    outside = filled_shape.get_number("FROM") / 2.0 + radius
    if many == 1:
        half = math.sqrt(max(outside**2 - away**2, 0.0)) + settings.near / 4.0
        return math.hypot(away, half) + settings.near / 4.0, [(away, -half), (away, half)]
    if many == 2:
        half = outside + settings.near / 4.0
        entry = math.hypot(away, half) + settings.near / 4.0
        return entry, [(away, -half), (away, half), (-away, half), (-away, -half)]
    corner = away / math.cos(math.pi / many)
    round_ = [
        (corner * math.cos(2.0 * math.pi * k / many), corner * math.sin(2.0 * math.pi * k / many))
        for k in range(many + 1)
    ]
    return max(corner, outside) + settings.near / 2.0, round_


def _flats(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    entry, path = _flat_path(filled, setting)
    long, deep = filled.get_number("LONG"), filled.get_number("DEEP") or filled.get_number("LONG")
    many = max(1, math.ceil(long / deep - 1e-9))
    levels = [-long * k / many for k in range(1, many + 1)]
    faces = FaceMilling(entry, path, levels, filled.get_number("RATE"), int(filled.get_number("FLATS")) == 2)
    _lines(filled, setting, code).write_face_milling(filled.get_number("T"), faces)


def _flats_checks(filled: ShapeInstance, _setting: ProgramSettings) -> Iterator[FieldError]:
    across, stock, many = (
        filled.get_number("ACROSS"),
        filled.get_number("FROM"),
        int(filled.get_number("FLATS")),
    )
    if across >= stock:
        yield FieldError(
            "ACROSS",
            Message(
                "{across} across flats is not less than the part diameter of {stock}, so nothing is cut.",
                across=f"{across:g}",
                stock=f"{stock:g}",
            ),
        )
    corner = across / math.cos(math.pi / many) if many > 2 else 0.0
    if many > 2 and corner > stock + 1e-9 and filled.get_text("CORNERS") == "SHARP":
        yield FieldError(
            "ACROSS",
            Message(
                "{many} flats at {across} across flats have corners at diameter {corner}, but "
                "the part diameter is {stock}: enter a smaller value, or set CORNERS to ROUND.",
                many=many,
                across=f"{across:g}",
                corner=f"{corner:.4f}",
                stock=f"{stock:g}",
            ),
        )
    if filled.get_number("DEEP") > filled.get_number("LONG"):
        yield FieldError(
            "DEEP", "The depth per pass is more than the length of the flats: enter a smaller depth."
        )


def _flats_sketch(filled: ShapeInstance) -> Sketch:
    many = max(2, int(filled.get_number("FLATS") or 6))
    round_ = [(10 * math.cos(k * math.pi / 24), 10 * math.sin(k * math.pi / 24)) for k in range(48)]
    flat = 8.0
    if many == 2:
        body: tuple[tuple[float, float], ...] = ((flat, -6.0), (flat, 6.0), (-flat, 6.0), (-flat, -6.0))
    else:
        r = flat / math.cos(math.pi / many)
        body = tuple(
            (r * math.sin(2 * math.pi * (k + 0.5) / many), r * math.cos(2 * math.pi * (k + 0.5) / many))
            for k in range(many)
        )
    mill = [(2 * math.cos(k * math.pi / 8), flat + 2 + 2 * math.sin(k * math.pi / 8)) for k in range(16)]
    return Sketch(
        (
            Outline(tuple(round_), "part", is_closed=True),
            Outline(body, "cut", is_closed=True),
            Outline(tuple(mill), "tool", is_closed=True),
        ),
        (
            Dimension("ACROSS", (-12, -flat), (-12, flat), 0),
            Dimension("FROM", (-10, -10), (10, -10), -3),
            Dimension("DIA", (4, flat + 3)),
            Dimension("FLATS", (0, 2)),
            Dimension("LONG", (0, -3)),
        ),
    )


FLATS_SHAPE = Shape(
    "MILL FLATS",
    "flats or a hexagon on the end of the part, in the XC plane",
    (
        make_tool_field(ToolKind.END_MILL),
        ShapeField("DIA", "CUTTER DIAMETER", FieldKind.DIAMETER, _across, is_in_comment=True),
        ShapeField("FROM", "PART DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("FLATS", "FLATS", FieldKind.COUNT, 6.0, maximum=36),
        ShapeField("ACROSS", "ACROSS FLATS", FieldKind.DIAMETER),
        ShapeField(
            "CORNERS",
            "CORNERS",
            FieldKind.CHOICE,
            "ROUND",
            ("ROUND", "SHARP"),
            applies_to=lambda v: number(v, "FLATS") > 2,
        ),
        ShapeField("LONG", "LENGTH", FieldKind.LENGTH),
        ShapeField("DEEP", "DEPTH PER PASS", FieldKind.LENGTH, lambda v, _s: number(v, "LONG") or None),
        ShapeField("RATE", "FEED PER MINUTE", FieldKind.RATE, _rate(Operation.MILL), maximum=300),
    ),
    _flats,
    _flats_sketch,
    _flats_checks,
)


# --- Slots in the plane ZC


def _slot(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    radius, deep = filled.get_number("FROM") / 2.0, filled.get_number("DEEP")
    levels = max(1, math.ceil(deep / (filled.get_number("PASS") or deep) - 1e-9))
    angles = [
        filled.get_number("ANGLE") + k * filled.get_number("STEP")
        for k in range(int(filled.get_number("COUNT")))
    ]
    depths = [radius - deep * level / levels for level in range(1, levels + 1)]
    slots = CylinderSlots(
        filled.get_number("FROM"),
        -filled.get_number("AT"),
        filled.get_number("LONG"),
        filled.get_number("TURN"),
        angles,
        depths,
        radius + setting.near / 2.0,
        filled.get_number("RATE"),
    )
    _lines(filled, setting, code).write_slots(filled.get_number("T"), slots)


def _slot_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    if filled.get_number("DEEP") > filled.get_number("FROM") / 2.0:
        yield FieldError(
            "DEEP",
            Message(
                "Depth {number} goes past the spindle centerline of a part {number2} in "
                "diameter: enter a smaller depth.",
                number=f"{filled.get_number('DEEP'):g}",
                number2=f"{filled.get_number('FROM'):g}",
            ),
        )
    if not filled.get_number("LONG") and not filled.get_number("TURN"):
        yield FieldError(
            "LONG", "The slot has no length: enter its length along Z, or its angle around the part."
        )
    if filled.get_number("PASS") > filled.get_number("DEEP"):
        yield FieldError(
            "PASS", "The depth per pass is more than the slot depth: enter a smaller depth per pass."
        )
    yield from check_flute_length(filled, setting)


def _slot_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, -10), (0, 10), (-28, 10), (-28, -10))
    return make_sketch(
        solid,
        Outline(((-6, 2), (-18, 2), (-18, -2), (-6, -2)), "cut", is_closed=True),
        dimensions=(
            Dimension("FROM", (-24, -10), (-24, 10)),
            Dimension("AT", (-6, 10), (0, 10), 2),
            Dimension("LONG", (-18, 10), (-6, 10), 2),
            Dimension("DIA", (-12, -2), (-12, 2)),
            Dimension("DEEP", (-12, 6)),
            Dimension("TURN", (-12, -6)),
        ),
    )


SLOT_SHAPE = Shape(
    "MILL SLOT",
    "a keyway along Z, around the part or on a helix, in the ZC plane",
    (
        make_tool_field(ToolKind.END_MILL),
        ShapeField("DIA", "CUTTER DIAMETER", FieldKind.DIAMETER, _across, is_in_comment=True),
        ShapeField("FROM", "PART DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("AT", "DISTANCE FROM Z0 TO START", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("LONG", "LENGTH ALONG Z", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("TURN", "ANGLE AROUND THE PART", FieldKind.ANGLE, 0.0, allows_zero=True, maximum=3600),
        ShapeField("DEEP", "DEPTH", FieldKind.LENGTH),
        ShapeField("PASS", "DEPTH PER PASS", FieldKind.LENGTH, lambda v, _s: number(v, "DEEP") or None),
        ShapeField("ANGLE", "FIRST ANGLE", FieldKind.ANGLE, 0.0, allows_zero=True),
        ShapeField("COUNT", "SLOTS", FieldKind.COUNT, 1.0, maximum=60),
        ShapeField(
            "STEP", "ANGLE BETWEEN SLOTS", FieldKind.ANGLE, _step, applies_to=lambda v: number(v, "COUNT") > 1
        ),
        ShapeField("RATE", "FEED PER MINUTE", FieldKind.RATE, _rate(Operation.MILL), maximum=300),
    ),
    _slot,
    _slot_sketch,
    _slot_checks,
)


# --- SINUMERIK: the live tool is spindle 2; C and its planes require an axis


def _live_checks(checks: ShapeCheck) -> ShapeCheck:
    def check_live_tool_shape(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
        if not setting.shop.third_axis_name:
            yield FieldError("T", "This machine has no third axis that holds and turns the part.")
        elif setting.shop.third_axis_name.startswith("Y") and filled.shape.name != CROSS_HOLES_SHAPE.name:
            yield FieldError(
                "T",
                "The third axis of this machine is named Y, but the plane of this shape needs a separate Y "
                "axis: mill this shape on another machine.",
            )
        elif not setting.shop.has_live_output:
            yield FieldError(
                "T",
                "This machine has no output that drives a live tool: define an output named "
                "live under [io.out] in the machine file.",
            )
        yield from checks(filled, setting)

    return check_live_tool_shape


def _spindle_two(shape: Shape) -> Shape:
    speed = ShapeField("LRPM", "LIVE TOOL SPEED", FieldKind.RPM, _LIVE_RPM, maximum=MAX_RPM)
    fields = (*shape.fields[:-1], speed, shape.fields[-1])
    return replace(shape, fields=fields, find_field_conflicts=_live_checks(shape.find_field_conflicts))


SINUMERIK_CROSS, SINUMERIK_FLATS, SINUMERIK_SLOT = map(
    _spindle_two, (CROSS_HOLES_SHAPE, FLATS_SHAPE, SLOT_SHAPE)
)
