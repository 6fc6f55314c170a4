"""Groove and part off: plunges of a blade, chamfers at both edges, several grooves at one pitch."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.part.tool_shape import ToolKind
from core.shapes.code_lines import Code
from core.shapes.cutting_data import Work
from core.shapes.number_words import plain
from core.shapes.shape import Filled, Shape
from core.shapes.shape_fields import Field, Kind, Refusal, Value, Values, number
from core.shapes.shape_setting import Setting
from core.shapes.sketch import Dim, Sketch, cut, part, sketch, tool
from core.shapes.turning import begin_spindle, end_spindle
from core.shapes.usual_fields import (
    around,
    bar,
    feed_field,
    per_rev,
    rpm_field,
    surface_field,
    too_fast,
    tool_field,
)

FRONT, REAR, INSIDE = "FRONT", "REAR", "BORE"
LEFT, RIGHT = "LEFT", "RIGHT"
_FREE = {False: 0.02, True: 0.5}  # by metric: beside the diameter
_OVERLAP = 0.8  # of the blade from plunge to plunge


def _width(values: Values, setting: Setting) -> Value | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.width / setting.mm, 5) if shape is not None and shape.width else None


def _corner(values: Values, setting: Setting) -> Value | None:
    """The corner that was touched off, as the tool's sheet says; of an unknown tool the one at the chuck."""
    shape = setting.tool(number(values, "T"))
    return RIGHT if shape is not None and shape.direction[0] > 0 else LEFT


def _side(filled: Filled) -> float:
    """-1: the tool works at X negative."""
    return -1.0 if filled.t("SIDE") == REAR else 1.0


_BLADE = Field("WIDE", "WIDTH OF THE BLADE", Kind.LENGTH, _width, marked=True)
_SET = Field("CORNER", "CORNER TOUCHED OFF", Kind.CHOICE, _corner, (LEFT, RIGHT))


class _Blade:
    """Where the tool is programmed so that one of its corners stands where it should."""

    def __init__(self, filled: Filled, code: Code) -> None:
        self.wide = filled.n("WIDE")
        self.left = filled.t("CORNER") == LEFT
        self._side, self._code = _side(filled), code

    def at(self, chuck: float) -> float:
        """Programmed Z that has the corner at the chuck there."""
        return chuck if self.left else chuck + self.wide

    def face(self, front: float) -> float:
        """Programmed Z that has the corner at the face there."""
        return self.at(front - self.wide)

    def rapid(self, r: float | None = None, z: float | None = None) -> None:
        self._code.rapid(None if r is None else self._side * r, z)

    def cut(self, r: float | None = None, z: float | None = None, feed: float = 0.0) -> None:
        self._code.cut(None if r is None else self._side * r, z, feed)


# --- groove


def _plunges(filled: Filled) -> int:
    over = filled.n("LONG") - filled.n("WIDE")
    return 1 + math.ceil(over / (_OVERLAP * filled.n("WIDE")) - 1e-9) if over > 1e-9 else 1


def _groove(filled: Filled, setting: Setting, code: Code) -> None:
    free = -_FREE[setting.metric] if filled.t("SIDE") == INSIDE else _FREE[setting.metric]
    outer = filled.n("TOP") / 2.0 + free
    blade, chuck = _Blade(filled, code), -filled.n("AT") - filled.n("LONG")
    many = int(filled.n("COUNT"))
    begin_spindle(filled, setting, code, _side(filled) * outer, None)
    if many > 1 and _plunges(filled) == 1 and not filled.n("EDGE") and not setting.called:
        _loop(filled, code, outer, blade.at(chuck))
    else:
        for k in range(max(many, 1)):
            _one_groove(filled, blade, code, outer, chuck - k * filled.n("PITCH"), free)
    end_spindle(filled, code)


def _loop(filled: Filled, code: Code, outer: float, first: float) -> None:
    """Grooves of one plunge each, as a loop of distances."""
    deep = _side(filled) * (filled.n("TOP") / 2.0 - filled.n("BOTTOM") / 2.0 + outer - filled.n("TOP") / 2.0)
    code.rapid(z=first)
    code.write("G91", f"LS{filled.n('COUNT'):.0f}", f"G95F{plain(filled.n('FEED'), 6)}{code.x(-deep)}")
    if filled.n("DWELL"):
        code.write(f"G04F{plain(filled.n('DWELL'))}")
    code.write(f"G00{code.x(deep)}", code.z(-filled.n("PITCH")), "LF", "G90")


def _one_groove(filled: Filled, blade: _Blade, code: Code, outer: float, chuck: float, free: float) -> None:
    count, feed, bottom = _plunges(filled), filled.n("FEED"), filled.n("BOTTOM") / 2.0
    front = chuck + filled.n("LONG")
    steps = [front - blade.wide + (chuck - front + blade.wide) * k / max(count - 1, 1) for k in range(count)]
    for at in steps if count > 1 else [chuck]:
        blade.rapid(z=blade.at(at))
        blade.cut(bottom, feed=feed)
        if at == steps[-1] and count > 1:
            blade.cut(z=blade.face(front))  # along the bottom
        elif filled.n("DWELL"):
            code.write(f"G04F{plain(filled.n('DWELL'))}")
        blade.rapid(outer)
    edge, sign = filled.n("EDGE"), math.copysign(1.0, free)
    if edge:
        top = filled.n("TOP") / 2.0
        for z, inner in (
            (blade.face(front) + edge, blade.face(front)),
            (blade.at(chuck) - edge, blade.at(chuck)),
        ):
            out = math.copysign(abs(free), z - inner)
            blade.rapid(z=z + out)
            blade.cut(top - sign * edge, inner, feed=feed)
            blade.rapid(outer)


def _groove_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    top, bottom, wide, long = (filled.n(word) for word in ("TOP", "BOTTOM", "WIDE", "LONG"))
    inside = filled.t("SIDE") == INSIDE
    if wide > long + 1e-9:
        yield Refusal(
            "LONG", f"The groove of {long:g} is narrower than the blade of {wide:g}: take a narrower one."
        )
    if inside and bottom <= top:
        yield Refusal("BOTTOM", f"A groove in a bore of {top:g} goes outwards: {bottom:g} is not more.")
    if not inside and bottom >= top:
        yield Refusal("BOTTOM", f"The bottom of {bottom:g} is not less than the diameter of {top:g}.")
    yield from _reach(filled, setting, abs(top - bottom) / 2.0, "BOTTOM")
    if filled.n("COUNT") > 1 and filled.n("PITCH") < long:
        words = f"Grooves of {long:g} at a pitch of {filled.n('PITCH'):g} run into each other: type more."
        yield Refusal("PITCH", words)
    if filled.n("EDGE") >= abs(top - bottom) / 2.0:
        yield Refusal("EDGE", "The chamfer is as deep as the groove: type less.")
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED")


def _reach(filled: Filled, setting: Setting, deep: float, word: str) -> Iterator[Refusal]:
    """The blade is long enough, and as wide as its sheet says."""
    shape, wide, name = setting.tool(filled.n("T")), filled.n("WIDE"), f"T{filled.n('T'):.0f}"
    if shape is None:
        return
    if shape.length and deep > shape.length / setting.mm + 1e-9:
        yield Refusal(
            word, f"{deep:.4g} deep: {name} reaches {shape.length / setting.mm:.4g}. Take a longer blade."
        )
    if shape.width and abs(shape.width / setting.mm - wide) > 0.001 / setting.mm * 25.4:
        yield Refusal("WIDE", f"{name} is {shape.width / setting.mm:.4g} wide by its sheet: type that.")


def _groove_sketch(filled: Filled) -> Sketch:
    solid = part((0, 0), (0, 10), (-8, 10), (-8, 6), (-14, 6), (-14, 10), (-26, 10), (-26, 0))
    blade = tool((-14, 14), (-14, 6.2), (-11, 6.2), (-11, 14))
    return sketch(
        solid,
        cut((-8, 10), (-8, 6), (-14, 6), (-14, 10)),
        blade,
        dims=(
            Dim("TOP", (-22, -10), (-22, 10)),
            Dim("BOTTOM", (-9.5, -6), (-9.5, 6)),
            Dim("AT", (-8, 10), (0, 10), 2),
            Dim("LONG", (-14, 3), (-8, 3), 0),
            Dim("WIDE", (-14, 14), (-11, 14), 2),
            *((Dim("PITCH", (-22, 14)),) if filled.n("COUNT") > 1 else ()),
        ),
    )


def _several(values: Values) -> bool:
    return number(values, "COUNT") > 1.0


GROOVE = Shape(
    "GROOVE",
    "one or several, outside, from behind or in a bore, edges broken",
    (
        tool_field(ToolKind.GROOVING),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR, INSIDE)),
        Field("TOP", "DIAMETER", Kind.DIAMETER, bar),
        Field("BOTTOM", "BOTTOM DIAMETER", Kind.DIAMETER),
        Field("AT", "BEGINS BEHIND Z0", Kind.LENGTH, zero=True),
        _BLADE,
        Field("LONG", "WIDTH OF THE GROOVE", Kind.LENGTH, lambda v, _s: number(v, "WIDE") or None),
        _SET,
        Field("EDGE", "CHAMFER AT BOTH EDGES", Kind.LENGTH, 0.0, zero=True),
        Field("COUNT", "HOW MANY", Kind.COUNT, 1.0, most=1000),
        Field("PITCH", "PITCH", Kind.LENGTH, None, only=_several),
        Field("DWELL", "DWELL AT THE BOTTOM", Kind.SECONDS, 0.1, zero=True, most=60),
        feed_field(Work.GROOVE),
        rpm_field(Work.GROOVE, around("TOP")),
    ),
    _groove,
    _groove_sketch,
    _groove_checks,
)


# --- part off


def _part_off(filled: Filled, setting: Setting, code: Code) -> None:
    free = _FREE[setting.metric]
    bar_r, back, feed = filled.n("FROM") / 2.0, -filled.n("LONG"), filled.n("FEED")
    blade = _Blade(filled, code)
    kerf = blade.face(back)
    begin_spindle(filled, setting, code, _side(filled) * (bar_r + free), None)
    blade.rapid(z=kerf)
    own, following = filled.n("BACK"), filled.n("NEXT")
    if own or following:
        blade.cut(bar_r - max(own, following) - free, feed=feed)
        blade.rapid(bar_r + free)
    if following:
        blade.rapid(z=kerf - following - free)
        blade.cut(bar_r - following, kerf, feed=feed)
        blade.rapid(bar_r + free)
    if own:
        blade.rapid(z=kerf + own + free)
        blade.cut(bar_r - own, kerf, feed=feed)
    blade.cut(filled.n("TO") / 2.0, feed=feed)
    blade.rapid(bar_r + free)
    end_spindle(filled, code)


def _part_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    top, end = filled.n("FROM"), filled.n("TO")
    if end >= top:
        yield Refusal("TO", f"It parts off from {top:g} inwards: {end:g} is not less.")
    for word in ("BACK", "NEXT"):
        if filled.n(word) >= (top - end) / 2.0 > 0.0:
            yield Refusal(word, f"A chamfer of {filled.n(word):g} takes all of the wall: type less.")
    if filled.n("BACK") > filled.n("LONG"):
        yield Refusal("BACK", "The chamfer is longer than the part: type less.")
    yield from _reach(filled, setting, (top - end) / 2.0, "FROM")
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED")


def _part_sketch(_filled: Filled) -> Sketch:
    solid = part(
        (0, 0), (0, 10), (-13, 10), (-14, 9), (-14, 0.4), (-17, 0.4), (-17, 9), (-18, 10), (-27, 10), (-27, 0)
    )
    return sketch(
        solid,
        cut((-13, 10), (-14, 9), (-14, 0.4), (-17, 0.4), (-17, 9), (-18, 10)),
        tool((-17, 16), (-17, 10.5), (-14, 10.5), (-14, 16)),
        dims=(
            Dim("FROM", (-24, -10), (-24, 10)),
            Dim("TO", (-14, 0.4)),
            Dim("LONG", (-14, 10), (0, 10), 3),
            Dim("WIDE", (-17, 16), (-14, 16), 2),
            Dim("BACK", (-12.4, 9)),
            Dim("NEXT", (-20.5, 9)),
        ),
    )


def _beyond(values: Values, setting: Setting) -> Value | None:
    return bar(values, setting)


PART_OFF = Shape(
    "PART OFF",
    "to the centre or to a bore, chamfers on both sides of the cut",
    (
        tool_field(ToolKind.PARTING, ToolKind.GROOVING),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR)),
        Field("FROM", "DIAMETER", Kind.DIAMETER, _beyond),
        Field("TO", "TO DIAMETER", Kind.DIAMETER, 0.0, zero=True),
        Field("LONG", "LENGTH OF THE PART", Kind.LENGTH),
        _BLADE,
        _SET,
        Field("BACK", "CHAMFER OF THE PART", Kind.LENGTH, 0.0, zero=True),
        Field("NEXT", "CHAMFER OF THE BAR", Kind.LENGTH, 0.0, zero=True),
        feed_field(Work.PART),
        rpm_field(Work.PART, around("FROM")),
        surface_field(),
    ),
    _part_off,
    _part_sketch,
    _part_checks,
)
