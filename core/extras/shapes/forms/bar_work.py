"""Bar work: bar feed loop, parting off to the center or a bore, and the blade for plunges."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.cutting_data import Work
from core.extras.shapes.forms.turning import begin_spindle, end_spindle
from core.extras.shapes.lines.code_lines import Bars, Code, write_bars
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number, size
from core.extras.shapes.usual_fields import (
    around,
    bar,
    feed_field,
    next_tool,
    per_rev,
    rpm_field,
    surface_field,
    too_fast,
    tool_field,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Outline, Sketch, cut, part, sketch, tool

FRONT, REAR, INSIDE = "FRONT", "REAR", "BORE"
LEFT, RIGHT = "LEFT", "RIGHT"
FREE = {False: 0.02, True: 0.5}
"""By metric: how far beside the diameter a blade stands."""


def _width(values: Values, setting: Setting) -> Value | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.width / setting.mm, 5) if shape is not None and shape.width else None


def _corner(values: Values, setting: Setting) -> Value | None:
    """Return the touched-off corner from the tool data; for an unknown tool, the corner at the chuck."""
    shape = setting.tool(number(values, "T"))
    return RIGHT if shape is not None and shape.direction[0] > 0 else LEFT


def side_of(filled: Filled) -> float:
    """Return -1 if the tool works at negative X, otherwise 1."""
    return -1.0 if filled.t("SIDE") == REAR else 1.0


BLADE_FIELD = Field("WIDE", "BLADE WIDTH", Kind.LENGTH, _width, marked=True)
CORNER_FIELD = Field("CORNER", "CORNER USED FOR TOUCH-OFF", Kind.CHOICE, _corner, (LEFT, RIGHT))


class Blade:
    """Writer of moves that position one corner of a blade.

    ``start`` is the radius from which the blade approaches.
    """

    def __init__(self, filled: Filled, code: Code, start: float = 0.0) -> None:
        self.wide = filled.n("WIDE")
        self.left = filled.t("CORNER") == LEFT
        self._side, self._code = side_of(filled), code
        self._r, self._z = start, math.inf

    def _at(self, r: float | None, z: float | None) -> None:
        self._r = self._r if r is None else r
        self._z = self._z if z is None else z

    def at(self, chuck: float) -> float:
        """Return the programmed Z that puts the chuck-side corner at ``chuck``."""
        return chuck if self.left else chuck + self.wide

    def face(self, front: float) -> float:
        """Return the programmed Z that puts the face-side corner at ``front``."""
        return self.at(front - self.wide)

    def over(self, z: float, r: float) -> None:
        """Move along Z at the present radius, then to radius ``r``; omit moves that are not necessary."""
        if z != self._z:
            self.rapid(z=z)
        if r != self._r:
            self.rapid(r)

    def rapid(self, r: float | None = None, z: float | None = None) -> None:
        """Write a rapid to a radius on the tool's side of the axis and to a programmed Z."""
        self._at(r, z)
        self._code.rapid(None if r is None else self._side * r, z)

    def cut(self, r: float | None = None, z: float | None = None, feed: float = 0.0) -> None:
        """Write a feed move to a radius and a programmed Z."""
        self._at(r, z)
        self._code.cut(None if r is None else self._side * r, z, feed)

    def dwell(self, seconds: float) -> None:
        """Write a dwell; 0 s writes nothing."""
        self._code.dwell(seconds)


def reach(filled: Filled, setting: Setting, deep: float, word: str) -> Iterator[Refusal]:
    """Yield errors if the blade is too short, or if its width differs from the tool data."""
    shape, wide, name = setting.tool(filled.n("T")), filled.n("WIDE"), f"T{filled.n('T'):.0f}"
    if shape is None:
        return
    if shape.length and deep > shape.length / setting.mm + 1e-9:
        yield Refusal(
            word,
            Message(
                "Depth {depth} is more than the reach of {name}, which is {length}. Use a longer blade.",
                depth=f"{deep:.4g}",
                name=name,
                length=f"{shape.length / setting.mm:.4g}",
            ),
        )
    if shape.width and abs(shape.width / setting.mm - wide) > 0.001 / setting.mm * 25.4:
        yield Refusal(
            "WIDE",
            Message(
                "The blade width in the tool data of {name} is {width}: enter that width.",
                name=name,
                width=f"{shape.width / setting.mm:.4g}",
            ),
        )


def _part_off(filled: Filled, setting: Setting, code: Code) -> None:
    free = FREE[setting.metric]
    bar_r, back, feed = filled.n("FROM") / 2.0, -filled.n("LONG"), filled.n("FEED")
    blade = Blade(filled, code)
    kerf = blade.face(back)
    begin_spindle(filled, setting, code, side_of(filled) * (bar_r + free), None)
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
        yield Refusal(
            "TO",
            Message(
                "Parting off starts at diameter {top} and runs inward: end diameter {end} must be less.",
                top=f"{top:g}",
                end=f"{end:g}",
            ),
        )
    for word in ("BACK", "NEXT"):
        if filled.n(word) >= (top - end) / 2.0 > 0.0:
            yield Refusal(
                word,
                Message(
                    "A chamfer of {word} removes the whole wall: enter a smaller chamfer.",
                    word=f"{filled.n(word):g}",
                ),
            )
    if filled.n("BACK") > filled.n("LONG"):
        yield Refusal("BACK", "The chamfer is longer than the part: enter a smaller chamfer.")
    yield from reach(filled, setting, (top - end) / 2.0, "FROM")
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


PART_OFF = Shape(
    "PART OFF",
    "parts off to the center or to a bore, with chamfers on both sides of the cut",
    (
        tool_field(ToolKind.PARTING, ToolKind.GROOVING),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR)),
        Field("FROM", "DIAMETER", Kind.DIAMETER, bar),
        Field("TO", "END DIAMETER", Kind.DIAMETER, 0.0, zero=True),
        Field("LONG", "PART LENGTH", Kind.LENGTH),
        BLADE_FIELD,
        CORNER_FIELD,
        Field("BACK", "CHAMFER ON THE PART", Kind.LENGTH, 0.0, zero=True),
        Field("NEXT", "CHAMFER ON THE BAR", Kind.LENGTH, 0.0, zero=True),
        feed_field(Work.PART),
        rpm_field(Work.PART, around("FROM")),
        surface_field(),
    ),
    _part_off,
    _part_sketch,
    _part_checks,
)


EACH, ONCE = "EACH PART", "ONCE"


def _sub(_values: Values, setting: Setting) -> Value | None:
    return float(setting.free_sub)


def _loop(filled: Filled, _setting: Setting, code: Code) -> None:
    write_bars(
        code,
        Bars(
            int(filled.n("COUNT")), filled.n("LONG"), filled.t("FEEDS") == EACH, filled.n("STOP"),
            filled.n("STOCK"), filled.n("RATE"), int(filled.n("SUB")),
        )
    )  # fmt: skip


def _checks(_filled: Filled, setting: Setting) -> Iterator[Refusal]:
    if setting.called:
        yield Refusal(
            "COUNT",
            "A bar feed loop cannot be inside another bar feed loop: write this shape "
            "before or after the other loop.",
        )


def _sketch(_filled: Filled) -> Sketch:
    bar = part((0, 0), (0, 7), (-30, 7), (-30, 0))
    cuts = [Outline(((z, 0.0), (z, 7.0)), "cut") for z in (-8, -16, -24)]
    return sketch(
        bar,
        *cuts,
        tool((1, -3), (1, 3), (4, 3), (4, -3)),
        dims=(
            Dim("LONG", (-16, 7), (-8, 7), 3),
            Dim("COUNT", (-20, -4)),
            Dim("STOCK", (0, 10)),
            Dim("STOP", (5, -5)),
        ),
    )


def _tail(filled: Filled) -> tuple[str, ...]:
    return f"}}{filled.n('SUB'):.0f}", "M99"


LOOP = Shape(
    "BAR LOOP",
    "feeds the bar to a stop and repeats the following lines for a number of "
    "parts; these lines make the part",
    (
        Field("COUNT", "PARTS", Kind.COUNT, None, most=100_000),
        Field("LONG", "BAR LENGTH PER PART + CUT-OFF", Kind.LENGTH),
        Field("FEEDS", "FEED THE BAR", Kind.CHOICE, EACH, (EACH, ONCE)),
        Field("STOP", "TOOL USED AS STOP", Kind.TOOL, lambda _v, s: float(next_tool(s)), most=32),
        Field("STOCK", "FACING ALLOWANCE", Kind.LENGTH, size(0.025, 0.6), zero=True),
        Field("RATE", "BAR FEED PER MINUTE", Kind.RATE, size(50.0, 1200.0)),
        Field("SUB", "PART SUBROUTINE NUMBER", Kind.COUNT, _sub, most=9999),
    ),
    _loop,
    _sketch,
    _checks,
    ends=_tail,
)


def no_chuck(setting: Setting, word: str) -> Iterator[Refusal]:
    """Yield an error at this field if a SINUMERIK program cannot open the chuck of this machine."""
    if setting.shop.chuck is None:
        yield Refusal(
            word,
            "This machine has no M codes that open and close the chuck: assign two M codes "
            "to the output named collet under [m_codes] in the machine file.",
        )


def _sinumerik_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from no_chuck(setting, "FEEDS")
    yield from _checks(filled, setting)


def _sinumerik_tail(filled: Filled) -> tuple[str, ...]:
    return f"%_N_PART_{filled.n('SUB'):.0f}_SPF", "M17"


SINUMERIK_LOOP = replace(LOOP, checks=_sinumerik_checks, ends=_sinumerik_tail)
"""The same with a subprogram, and M codes of the machine's own for the chuck."""
