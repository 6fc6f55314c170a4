"""Cross holes, flats and slots: the spindle held as C axis, a live tool, the planes XC and ZC."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.part.tool_shape import ToolKind
from core.shapes import cutting_data
from core.shapes.code_lines import Code
from core.shapes.cutting_data import Work
from core.shapes.drilling import _across
from core.shapes.number_words import plain
from core.shapes.shape import Filled, Shape
from core.shapes.shape_fields import Field, Kind, Proposal, Refusal, Value, Values, number
from core.shapes.shape_setting import Setting
from core.shapes.sketch import Dim, Outline, Sketch, cut, part, sketch, tool
from core.shapes.usual_fields import bar, too_deep, tool_field

_LIVE_RPM = 3000.0  # of a small live tool; nothing commands it
_TEETH = 2.0
FRONT, REAR = "FRONT", "REAR"


def _rate(work: Work) -> Proposal:
    """A minute, since the live tool's speed is its own: by ``_LIVE_RPM`` and two teeth of a mill."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        if work is Work.DRILL:
            turn = cutting_data.feed(work, setting, number(values, "T"), number(values, "DIA"))
            return round(turn * _LIVE_RPM * 0.5, 0 if setting.metric else 1)
        turn = cutting_data.feed(work, setting) * _TEETH
        return round(turn * _LIVE_RPM, 0 if setting.metric else 1)

    return proposed


def _step(values: Values, _setting: Setting) -> Value | None:
    many = number(values, "COUNT")
    return round(360.0 / many, 4) if many else None


def _wait(degrees: float, setting: Setting) -> float:
    """Seconds of dwell in which C has arrived: the drive gives no word of it."""
    return math.ceil(10.0 * (abs(degrees) / (6.0 * setting.shop.c_rpm) + 0.5)) / 10.0


def _held(filled: Filled, setting: Setting, code: Code, x: float, z: float) -> None:
    """The tool beside the part, the spindle stopped and held, the live tool on."""
    code.begin(filled.n("T"), 0.0, x, z)
    code.write("M05", f"M{setting.shop.live[0]:02d}", "M19")


def _released(setting: Setting, code: Code) -> None:
    code.forget()
    code.away()
    code.write(f"M{setting.shop.live[1]:02d}", "M05")


def _angle(code: Code, word: str, degrees: float, setting: Setting) -> None:
    if word == "CA" or degrees:
        code.write(f"{word}{plain(degrees, 3)}", f"G04F{plain(_wait(degrees, setting), 1)}")


# --- cross holes


def _cross(filled: Filled, setting: Setting, code: Code) -> None:
    sign = -1.0 if filled.t("SIDE") == REAR else 1.0
    surface = filled.n("FROM") / 2.0
    out, deep = sign * (surface + setting.near / 2.0), sign * (surface - filled.n("DEEP"))
    many = int(filled.n("COUNT"))
    _held(filled, setting, code, out, -filled.n("AT"))
    _angle(code, "CA", filled.n("ANGLE"), setting)
    if many > 1:
        code.write(f"LS{many}")
    code.write(f"G94F{plain(filled.n('RATE'))}{code.x(deep)}", f"G00{code.x(out)}")
    if many > 1:
        _angle(code, "CI", filled.n("STEP"), setting)
        code.write("LF")
    _released(setting, code)


def _cross_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    deep, across = filled.n("DEEP"), filled.n("FROM")
    if deep > across:
        yield Refusal(
            "DEEP", f"{deep:g} is more than the diameter of {across:g}: the drill comes out behind it."
        )
    if filled.n("COUNT") > 1 and abs(filled.n("STEP")) * filled.n("COUNT") > 360.0 + 1e-6:
        words = f"{filled.n('COUNT'):.0f} holes at {filled.n('STEP'):g}° go round more than once: type less."
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
    "holes from the side, all around, the spindle held",
    (
        tool_field(ToolKind.DRILL, ToolKind.END_MILL),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR)),
        Field("DIA", "DIAMETER OF THE DRILL", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "DIAMETER OF THE PART", Kind.DIAMETER, bar),
        Field("AT", "CENTRE BEHIND Z0", Kind.LENGTH),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("ANGLE", "FIRST ANGLE", Kind.ANGLE, 0.0, zero=True),
        Field("COUNT", "HOLES", Kind.COUNT, 1.0, most=360),
        Field("STEP", "ANGLE FROM HOLE TO HOLE", Kind.ANGLE, _step, only=lambda v: number(v, "COUNT") > 1),
        Field("RATE", "FEED A MINUTE", Kind.RATE, _rate(Work.DRILL), most=300),
    ),
    _cross,
    _cross_sketch,
    _cross_checks,
)


# --- flats by the plane XC


def _flat_path(filled: Filled, setting: Setting) -> tuple[float, list[tuple[float, float]]]:
    """X of the entry, and the tool's centre round the flats, seen from the front."""
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
    _held(filled, setting, code, -entry, setting.near)
    long, deep = filled.n("LONG"), filled.n("DEEP") or filled.n("LONG")
    levels = max(1, math.ceil(long / deep - 1e-9))
    rate = f"F{plain(filled.n('RATE'))}"
    start = path[0]
    code.write(f"G94{rate}", "(~PLXC)")  # a shape before may have left feeds by the turn
    for k in range(1, levels + 1):
        code.write(f"(X{plain(entry, 4)}Y0F{plain(_QUICK * _mm(setting), 0)})") if k > 1 else None
        code.write(f"({code.z(-long * k / levels)}{rate})")
        code.write(f"(X{plain(start[0], 4)}Y{plain(start[1], 4)}{rate})")
        code.lines += [f"(X{plain(x, 4)}Y{plain(y, 4)})" for x, y in path[1:]]
        code.write(f"(X{plain(entry, 4)}Y0)") if path[-1] == start or len(path) != 4 else None
    code.write("(END)")
    code.write(f"G00{code.x(-entry)}")
    _released(setting, code)


_QUICK = 50.0  # in/min: beside the part, in the plane


def _mm(setting: Setting) -> float:
    return 25.4 / setting.mm


def _flats_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    across, stock, many = filled.n("ACROSS"), filled.n("FROM"), int(filled.n("FLATS"))
    if across >= stock:
        yield Refusal(
            "ACROSS", f"{across:g} across flats is not less than the part of {stock:g}: nothing is cut."
        )
    corner = across / math.cos(math.pi / many) if many > 2 else 0.0
    if many > 2 and corner > stock + 1e-9 and filled.t("CORNERS") == "SHARP":
        words = f"{many} flats of {across:g} have corners at {corner:.4f}, the part is {stock:g}"
        yield Refusal("ACROSS", f"{words}: type less, or CORNERS ROUND.")
    if filled.n("DEEP") > filled.n("LONG"):
        yield Refusal("DEEP", "A pass is deeper than the flats are long: type less.")
    if setting.called:
        return


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
    "flats or a hexagon on the end, in the plane XC",
    (
        tool_field(ToolKind.END_MILL),
        Field("DIA", "DIAMETER OF THE MILL", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "DIAMETER OF THE PART", Kind.DIAMETER, bar),
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
        Field("DEEP", "DEPTH OF A PASS", Kind.LENGTH, lambda v, _s: number(v, "LONG") or None),
        Field("RATE", "FEED A MINUTE", Kind.RATE, _rate(Work.MILL), most=300),
    ),
    _flats,
    _flats_sketch,
    _flats_checks,
)


# --- slots by the plane ZC


def _slot(filled: Filled, setting: Setting, code: Code) -> None:
    surface = filled.n("FROM")
    out = surface / 2.0 + setting.near / 2.0
    _held(filled, setting, code, -out, -filled.n("AT"))
    rate, many = filled.n("RATE"), int(filled.n("COUNT"))
    along, around = filled.n("LONG"), filled.n("TURN") / 360.0 * math.pi * surface
    levels = max(1, math.ceil(filled.n("DEEP") / (filled.n("PASS") or filled.n("DEEP")) - 1e-9))
    for k in range(many):
        angle = filled.n("ANGLE") + k * filled.n("STEP")
        if k or angle:
            _angle(code, "CA", angle, setting)
        code.write(f"G94F{plain(rate)}", "(~PLZC)", f"(D{plain(surface, 4)})")
        for level in range(1, levels + 1):
            z = surface - 2.0 * filled.n("DEEP") * level / levels
            there, back = f"(X{plain(along, 4)}Y{plain(around, 4)}F{plain(rate)})", "(X0Y0)"
            code.write(f"(Z{plain(z, 4)}F{plain(rate / 2.0)})", there if level % 2 else back)
        code.write(f"(Z{plain(2.0 * out, 4)}F{plain(_QUICK * _mm(setting), 0)})")
        if levels % 2:
            code.write("(X0Y0)")
        code.write("(END)")
    _released(setting, code)


def _slot_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    if filled.n("DEEP") > filled.n("FROM") / 2.0:
        yield Refusal(
            "DEEP", f"{filled.n('DEEP'):g} goes beyond the axis of {filled.n('FROM'):g}: type less."
        )
    if not filled.n("LONG") and not filled.n("TURN"):
        yield Refusal("LONG", "The slot goes nowhere: type its length, or the angle that it goes round.")
    if filled.n("PASS") > filled.n("DEEP"):
        yield Refusal("PASS", "A pass is deeper than the slot: type less.")
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
    "a keyway along, around or on a helix, in the plane ZC",
    (
        tool_field(ToolKind.END_MILL),
        Field("DIA", "DIAMETER OF THE MILL", Kind.DIAMETER, _across, marked=True),
        Field("FROM", "DIAMETER OF THE PART", Kind.DIAMETER, bar),
        Field("AT", "BEGINS BEHIND Z0", Kind.LENGTH, 0.0, zero=True),
        Field("LONG", "LENGTH ALONG Z", Kind.LENGTH, 0.0, zero=True),
        Field("TURN", "ANGLE THAT IT GOES ROUND", Kind.ANGLE, 0.0, zero=True, most=3600),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("PASS", "DEPTH OF A PASS", Kind.LENGTH, lambda v, _s: number(v, "DEEP") or None),
        Field("ANGLE", "FIRST ANGLE", Kind.ANGLE, 0.0, zero=True),
        Field("COUNT", "SLOTS", Kind.COUNT, 1.0, most=60),
        Field("STEP", "ANGLE FROM SLOT TO SLOT", Kind.ANGLE, _step, only=lambda v: number(v, "COUNT") > 1),
        Field("RATE", "FEED A MINUTE", Kind.RATE, _rate(Work.MILL), most=300),
    ),
    _slot,
    _slot_sketch,
    _slot_checks,
)
