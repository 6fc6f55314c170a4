"""Shapes for a live tool with the spindle as C axis: cross holes, flats and slots in planes XC and ZC."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from core.extras.shapes import cutting_data
from core.extras.shapes.cutting_data import Work
from core.extras.shapes.forms.drilling import _across
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.lines.live_lines import Faces, Holes, LiveLines, SinumerikLiveLines, Slots
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Proposal, Refusal, Setting, Value, Values, number
from core.extras.shapes.usual_fields import MOST_RPM, bar, too_deep, tool_field
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Outline, Sketch, cut, part, sketch, tool

_LIVE_RPM = 3000.0  # speed of a small live tool, for which OmniTurn has no word
_TEETH = 2.0
Checks = Callable[[Filled, Setting], Iterator[Refusal]]
FRONT, REAR = "FRONT", "REAR"


def _rate(work: Work) -> Proposal:
    """Return a proposal for the feed per minute, from the live tool's speed and two teeth of a mill."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        turns = number(values, "LRPM") or _LIVE_RPM
        if work is Work.DRILL:
            turn = cutting_data.feed(work, setting, number(values, "T"), number(values, "DIA"))
            return round(turn * turns * 0.5, 0 if setting.metric else 1)
        turn = cutting_data.feed(work, setting) * _TEETH
        return round(turn * turns, 0 if setting.metric else 1)

    return proposed


def _lines(filled: Filled, setting: Setting, code: Code) -> LiveLines:
    """Return a writer for the language of the program."""
    kind = SinumerikLiveLines if setting.dialect is Dialect.SINUMERIK else LiveLines
    return kind(code, filled.n("LRPM"))


def _step(values: Values, _setting: Setting) -> Value | None:
    many = number(values, "COUNT")
    return round(360.0 / many, 4) if many else None


# --- Cross holes


def _cross(filled: Filled, setting: Setting, code: Code) -> None:
    sign = -1.0 if filled.t("SIDE") == REAR else 1.0
    surface = filled.n("FROM") / 2.0
    holes = Holes(
        sign * (surface + setting.near / 2.0), sign * (surface - filled.n("DEEP")), -filled.n("AT"),
        filled.n("ANGLE"), int(filled.n("COUNT")), filled.n("STEP"), filled.n("RATE"),
    )  # fmt: skip
    _lines(filled, setting, code).holes(filled.n("T"), holes)


def _cross_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    deep, across = filled.n("DEEP"), filled.n("FROM")
    if deep > across:
        yield Refusal(
            "DEEP",
            Message(
                "Depth {depth} is more than the diameter of {across}: the drill would come out on the "
                "far side.",
                depth=f"{deep:g}",
                across=f"{across:g}",
            ),
        )
    if filled.n("COUNT") > 1 and abs(filled.n("STEP")) * filled.n("COUNT") > 360.0 + 1e-6:
        words = Message(
            "{number} holes spaced {number2}° apart go around the part more than once: enter a "
            "smaller angle.",
            number=f"{filled.n('COUNT'):.0f}",
            number2=f"{filled.n('STEP'):g}",
        )
        yield Refusal("STEP", words)
    yield from too_deep(filled, setting)


def _cross_sketch(_filled: Filled) -> Sketch:
    solid = part((0, -10), (0, 10), (-26, 10), (-26, -10))
    return sketch(
        solid,
        cut((-10, 10), (-10, 2), (-13, 2), (-13, 10)),
        tool((-10, 17), (-10, 11.5), (-11.5, 10.5), (-13, 11.5), (-13, 17)),
        dims=(
            Dim("FROM", (-22, -10), (-22, 10)),
            Dim("AT", (-11.5, 10), (0, 10), 3),
            Dim("DEEP", (-7, 2), (-7, 10)),
            Dim("DIA", (-13, 17), (-10, 17), 1),
            Dim("ANGLE", (-12, -2)),
            Dim("STEP", (-12, -6)),
        ),
    )


CROSS = Shape(
    "CROSS DRILL",
    "radial holes around the part, drilled with the spindle stopped in position",
    (
        tool_field(ToolKind.DRILL, ToolKind.END_MILL),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR)),
        Field("DIA", "DRILL DIAMETER", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "PART DIAMETER", Kind.DIAMETER, bar),
        Field("AT", "DISTANCE FROM Z0 TO CENTER", Kind.LENGTH),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("ANGLE", "FIRST ANGLE", Kind.ANGLE, 0.0, zero=True),
        Field("COUNT", "HOLES", Kind.COUNT, 1.0, most=360),
        Field("STEP", "ANGLE BETWEEN HOLES", Kind.ANGLE, _step, only=lambda v: number(v, "COUNT") > 1),
        Field("RATE", "FEED PER MINUTE", Kind.RATE, _rate(Work.DRILL), most=300),
    ),
    _cross,
    _cross_sketch,
    _cross_checks,
)


# --- Flats in the plane XC


def _flat_path(filled: Filled, setting: Setting) -> tuple[float, list[tuple[float, float]]]:
    """Return X of the entry, and the path of the tool center around the flats, seen from the front."""
    many, radius = int(filled.n("FLATS")), filled.n("DIA") / 2.0
    away = filled.n("ACROSS") / 2.0 + radius
    outside = filled.n("FROM") / 2.0 + radius
    if many == 1:
        half = math.sqrt(max(outside**2 - away**2, 0.0)) + setting.near / 4.0
        return math.hypot(away, half) + setting.near / 4.0, [(away, -half), (away, half)]
    if many == 2:
        half = outside + setting.near / 4.0
        entry = math.hypot(away, half) + setting.near / 4.0
        return entry, [(away, -half), (away, half), (-away, half), (-away, -half)]
    corner = away / math.cos(math.pi / many)
    round_ = [
        (corner * math.cos(2.0 * math.pi * k / many), corner * math.sin(2.0 * math.pi * k / many))
        for k in range(many + 1)
    ]
    return max(corner, outside) + setting.near / 2.0, round_


def _flats(filled: Filled, setting: Setting, code: Code) -> None:
    entry, path = _flat_path(filled, setting)
    long, deep = filled.n("LONG"), filled.n("DEEP") or filled.n("LONG")
    many = max(1, math.ceil(long / deep - 1e-9))
    levels = [-long * k / many for k in range(1, many + 1)]
    faces = Faces(entry, path, levels, filled.n("RATE"), int(filled.n("FLATS")) == 2)
    _lines(filled, setting, code).faces(filled.n("T"), faces)


def _flats_checks(filled: Filled, _setting: Setting) -> Iterator[Refusal]:
    across, stock, many = filled.n("ACROSS"), filled.n("FROM"), int(filled.n("FLATS"))
    if across >= stock:
        yield Refusal(
            "ACROSS",
            Message(
                "{across} across flats is not less than the part diameter of {stock}, so nothing is cut.",
                across=f"{across:g}",
                stock=f"{stock:g}",
            ),
        )
    corner = across / math.cos(math.pi / many) if many > 2 else 0.0
    if many > 2 and corner > stock + 1e-9 and filled.t("CORNERS") == "SHARP":
        yield Refusal(
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
    if filled.n("DEEP") > filled.n("LONG"):
        yield Refusal(
            "DEEP", "The depth per pass is more than the length of the flats: enter a smaller depth."
        )


def _flats_sketch(filled: Filled) -> Sketch:
    many = max(2, int(filled.n("FLATS") or 6))
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
            Outline(tuple(round_), "part", closed=True),
            Outline(body, "cut", closed=True),
            Outline(tuple(mill), "tool", closed=True),
        ),
        (
            Dim("ACROSS", (-12, -flat), (-12, flat), 0),
            Dim("FROM", (-10, -10), (10, -10), -3),
            Dim("DIA", (4, flat + 3)),
            Dim("FLATS", (0, 2)),
            Dim("LONG", (0, -3)),
        ),
    )


FLATS = Shape(
    "MILL FLATS",
    "flats or a hexagon on the end of the part, in the XC plane",
    (
        tool_field(ToolKind.END_MILL),
        Field("DIA", "CUTTER DIAMETER", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "PART DIAMETER", Kind.DIAMETER, bar),
        Field("FLATS", "FLATS", Kind.COUNT, 6.0, most=36),
        Field("ACROSS", "ACROSS FLATS", Kind.DIAMETER),
        Field(
            "CORNERS",
            "CORNERS",
            Kind.CHOICE,
            "ROUND",
            ("ROUND", "SHARP"),
            only=lambda v: number(v, "FLATS") > 2,
        ),
        Field("LONG", "LENGTH", Kind.LENGTH),
        Field("DEEP", "DEPTH PER PASS", Kind.LENGTH, lambda v, _s: number(v, "LONG") or None),
        Field("RATE", "FEED PER MINUTE", Kind.RATE, _rate(Work.MILL), most=300),
    ),
    _flats,
    _flats_sketch,
    _flats_checks,
)


# --- Slots in the plane ZC


def _slot(filled: Filled, setting: Setting, code: Code) -> None:
    radius, deep = filled.n("FROM") / 2.0, filled.n("DEEP")
    levels = max(1, math.ceil(deep / (filled.n("PASS") or deep) - 1e-9))
    angles = [filled.n("ANGLE") + k * filled.n("STEP") for k in range(int(filled.n("COUNT")))]
    depths = [radius - deep * level / levels for level in range(1, levels + 1)]
    slots = Slots(
        filled.n("FROM"), -filled.n("AT"), filled.n("LONG"), filled.n("TURN"), angles, depths,
        radius + setting.near / 2.0, filled.n("RATE"),
    )  # fmt: skip
    _lines(filled, setting, code).slots(filled.n("T"), slots)


def _slot_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    if filled.n("DEEP") > filled.n("FROM") / 2.0:
        yield Refusal(
            "DEEP",
            Message(
                "Depth {number} goes past the spindle centerline of a part {number2} in "
                "diameter: enter a smaller depth.",
                number=f"{filled.n('DEEP'):g}",
                number2=f"{filled.n('FROM'):g}",
            ),
        )
    if not filled.n("LONG") and not filled.n("TURN"):
        yield Refusal(
            "LONG", "The slot has no length: enter its length along Z, or its angle around the part."
        )
    if filled.n("PASS") > filled.n("DEEP"):
        yield Refusal(
            "PASS", "The depth per pass is more than the slot depth: enter a smaller depth per pass."
        )
    yield from too_deep(filled, setting)


def _slot_sketch(_filled: Filled) -> Sketch:
    solid = part((0, -10), (0, 10), (-28, 10), (-28, -10))
    return sketch(
        solid,
        Outline(((-6, 2), (-18, 2), (-18, -2), (-6, -2)), "cut", closed=True),
        dims=(
            Dim("FROM", (-24, -10), (-24, 10)),
            Dim("AT", (-6, 10), (0, 10), 2),
            Dim("LONG", (-18, 10), (-6, 10), 2),
            Dim("DIA", (-12, -2), (-12, 2)),
            Dim("DEEP", (-12, 6)),
            Dim("TURN", (-12, -6)),
        ),
    )


SLOT = Shape(
    "MILL SLOT",
    "a keyway along Z, around the part or on a helix, in the ZC plane",
    (
        tool_field(ToolKind.END_MILL),
        Field("DIA", "CUTTER DIAMETER", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "PART DIAMETER", Kind.DIAMETER, bar),
        Field("AT", "DISTANCE FROM Z0 TO START", Kind.LENGTH, 0.0, zero=True),
        Field("LONG", "LENGTH ALONG Z", Kind.LENGTH, 0.0, zero=True),
        Field("TURN", "ANGLE AROUND THE PART", Kind.ANGLE, 0.0, zero=True, most=3600),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("PASS", "DEPTH PER PASS", Kind.LENGTH, lambda v, _s: number(v, "DEEP") or None),
        Field("ANGLE", "FIRST ANGLE", Kind.ANGLE, 0.0, zero=True),
        Field("COUNT", "SLOTS", Kind.COUNT, 1.0, most=60),
        Field("STEP", "ANGLE BETWEEN SLOTS", Kind.ANGLE, _step, only=lambda v: number(v, "COUNT") > 1),
        Field("RATE", "FEED PER MINUTE", Kind.RATE, _rate(Work.MILL), most=300),
    ),
    _slot,
    _slot_sketch,
    _slot_checks,
)


# --- SINUMERIK: the live tool is spindle 2; C and its planes require an axis


def _live_checks(checks: Checks) -> Checks:
    def checked(filled: Filled, setting: Setting) -> Iterator[Refusal]:
        if not setting.shop.third_axis:
            yield Refusal("T", "This machine has no third axis that holds and turns the part.")
        elif setting.shop.third_axis.startswith("Y") and filled.shape.name != CROSS.name:
            yield Refusal(
                "T",
                "The third axis of this machine is named Y, but the plane of this shape needs a separate Y "
                "axis: mill this shape on another machine.",
            )
        elif not setting.shop.live_output:
            yield Refusal(
                "T",
                "This machine has no output that drives a live tool: define an output named "
                "live under [io.out] in the machine file.",
            )
        yield from checks(filled, setting)

    return checked


def _spindle_two(shape: Shape) -> Shape:
    speed = Field("LRPM", "LIVE TOOL SPEED", Kind.RPM, _LIVE_RPM, most=MOST_RPM)
    fields = (*shape.fields[:-1], speed, shape.fields[-1])
    return replace(shape, fields=fields, checks=_live_checks(shape.checks))


SINUMERIK_CROSS, SINUMERIK_FLATS, SINUMERIK_SLOT = map(_spindle_two, (CROSS, FLATS, SLOT))
