"""Part off: to the centre or to a bore, chamfers on both sides of the cut."""

from __future__ import annotations

from collections.abc import Iterator

from core.extras.shapes.blade import BLADE_FIELD, CORNER_FIELD, FREE, FRONT, REAR, Blade, reach, side_of
from core.extras.shapes.cutting_data import Work
from core.extras.shapes.forms.turning import begin_spindle, end_spindle
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal
from core.extras.shapes.shape_setting import Setting
from core.extras.shapes.usual_fields import (
    around,
    bar,
    feed_field,
    per_rev,
    rpm_field,
    surface_field,
    too_fast,
    tool_field,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch, tool


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
