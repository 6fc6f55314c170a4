"""Drilling on the axis: G81 for a hole in one pass, G83 with pecking."""

from __future__ import annotations

from collections.abc import Iterator

from core.extras.shapes.cutting_data import Work
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number
from core.extras.shapes.usual_fields import (
    around,
    feed_field,
    per_rev,
    rpm_field,
    too_deep,
    too_fast,
    tool_field,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch, tool

_DEEP = 5.0  # largest depth without pecking, in diameters


def _across(values: Values, setting: Setting) -> Value | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.diameter / setting.mm, 5) if shape is not None and shape.diameter else None


def _peck(values: Values, _setting: Setting) -> Value | None:
    """Return a peck depth of one diameter for holes deeper than three diameters, otherwise 0."""
    across, deep = number(values, "DIA"), number(values, "DEEP")
    return round(across, 3) if across and deep - number(values, "START") > 3.0 * across else 0.0


def _drill(filled: Filled, setting: Setting, code: Code) -> None:
    start = setting.near / 2.0 - filled.n("START")
    code.begin(filled.n("T"), filled.n("RPM"), 0.0, start)
    code.drill(-filled.n("DEEP"), filled.n("PECK"), filled.n("FEED"), filled.n("START"))
    code.away()


def _drill_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    deep, start, peck, across = (filled.n(word) for word in ("DEEP", "START", "PECK", "DIA"))
    if start >= deep:
        yield Refusal(
            "START",
            Message(
                "The hole starts at a depth of {start} and ends at {depth}, so nothing is drilled.",
                start=f"{start:g}",
                depth=f"{deep:g}",
            ),
        )
    if peck and peck > deep - start + setting.near:
        yield Refusal(
            "PECK",
            Message("A peck of {peck} is deeper than the hole: enter 0 for no pecking.", peck=f"{peck:g}"),
        )
    if not peck and deep - start > _DEEP * across:
        yield Refusal(
            "PECK",
            Message(
                "Drilling {depth} diameters deep without pecking clogs the drill: enter a peck depth.",
                depth=f"{(deep - start) / across:.1f}",
            ),
        )
    shape = setting.tool(filled.n("T"))
    name = f"T{filled.n('T'):.0f}"
    yield from too_deep(filled, setting)
    if shape is not None and shape.diameter and abs(shape.diameter / setting.mm - across) > 1e-4:
        yield Refusal(
            "DIA",
            Message(
                "The drill diameter in the tool data of {name} is {diameter}: enter that diameter.",
                name=name,
                diameter=f"{shape.diameter / setting.mm:.4g}",
            ),
        )
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED")


def _drill_sketch(_filled: Filled) -> Sketch:
    wall = part((0, 0), (0, 10), (-24, 10), (-24, 0))
    return sketch(
        wall,
        cut((0, 3), (-14, 3), (-16, 0), (-14, -3), (0, -3)),
        tool((8, 3), (1, 3), (-1, 0), (1, -3), (8, -3)),
        dims=(
            Dim("DIA", (-6, -3), (-6, 3)),
            Dim("DEEP", (-16, 10), (0, 10), 3),
            Dim("PECK", (-11, 0)),
            Dim("START", (1, 6)),
        ),
    )


DRILL = Shape(
    "DRILL",
    "a hole on the spindle centerline, drilled in one pass or with pecking",
    (
        tool_field(ToolKind.DRILL, ToolKind.CENTRE_DRILL),
        Field("DIA", "DRILL DIAMETER", Kind.DIAMETER, _across, marked=True),
        Field("DEEP", "DEPTH AT DRILL POINT", Kind.LENGTH),
        Field("START", "PREDRILLED DEPTH", Kind.LENGTH, 0.0, zero=True),
        Field("PECK", "PECK", Kind.LENGTH, _peck, zero=True),
        feed_field(Work.DRILL),
        rpm_field(Work.DRILL, around("DIA")),
    ),
    _drill,
    _drill_sketch,
    _drill_checks,
)
