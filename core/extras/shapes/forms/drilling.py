"""Drilling on the spindle axis, with G81 in one pass or with G83 in pecks."""

from __future__ import annotations

from collections.abc import Iterator

from core.extras.shapes.common_fields import (
    check_feeds,
    check_flute_length,
    check_rpm,
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_tool_field,
)
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import CodeWriter
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    number,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch, make_tool_outline

_DEEP = 5.0  # largest depth without pecking, in diameters


def _across(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.diameter / setting.mm, 5) if shape is not None and shape.diameter else None


def _peck(values: FieldValues, _settings: ProgramSettings) -> FieldValue | None:
    """Propose a peck depth of one drill diameter for a hole deeper than three diameters.

    For a shallower hole, the result is 0 (no pecking).
    """
    across, deep = number(values, "DIA"), number(values, "DEEP")
    return round(across, 3) if across and deep - number(values, "START") > 3.0 * across else 0.0


def _drill(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    start = setting.near / 2.0 - filled.get_number("START")
    code.write_tool_start(filled.get_number("T"), filled.get_number("RPM"), 0.0, start)
    code.write_drilling(
        -filled.get_number("DEEP"),
        filled.get_number("PECK"),
        filled.get_number("FEED"),
        filled.get_number("START"),
    )
    code.write_retract()


def _drill_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    deep, start, peck, across = (filled.get_number(word) for word in ("DEEP", "START", "PECK", "DIA"))
    if start >= deep:
        yield FieldError(
            "START",
            Message(
                "The hole starts at a depth of {start} and ends at {depth}, so nothing is drilled.",
                start=f"{start:g}",
                depth=f"{deep:g}",
            ),
        )
    if peck and peck > deep - start + setting.near:
        yield FieldError(
            "PECK",
            Message("A peck of {peck} is deeper than the hole: enter 0 for no pecking.", peck=f"{peck:g}"),
        )
    if not peck and deep - start > _DEEP * across:
        yield FieldError(
            "PECK",
            Message(
                "Drilling {depth} diameters deep without pecking clogs the drill: enter a peck depth.",
                depth=f"{(deep - start) / across:.1f}",
            ),
        )
    shape = setting.tool(filled.get_number("T"))
    name = f"T{filled.get_number('T'):.0f}"
    yield from check_flute_length(filled, setting)
    if shape is not None and shape.diameter and abs(shape.diameter / setting.mm - across) > 1e-4:
        yield FieldError(
            "DIA",
            Message(
                "The drill diameter in the tool data of {name} is {diameter}: enter that diameter.",
                name=name,
                diameter=f"{shape.diameter / setting.mm:.4g}",
            ),
        )
    yield from check_rpm(filled, setting)
    yield from check_feeds(filled, setting, "FEED")


def _drill_sketch(_filled: ShapeInstance) -> Sketch:
    wall = make_part_outline((0, 0), (0, 10), (-24, 10), (-24, 0))
    return make_sketch(
        wall,
        make_cut_outline((0, 3), (-14, 3), (-16, 0), (-14, -3), (0, -3)),
        make_tool_outline((8, 3), (1, 3), (-1, 0), (1, -3), (8, -3)),
        dimensions=(
            Dimension("DIA", (-6, -3), (-6, 3)),
            Dimension("DEEP", (-16, 10), (0, 10), 3),
            Dimension("PECK", (-11, 0)),
            Dimension("START", (1, 6)),
        ),
    )


DRILLING_SHAPE = Shape(
    "DRILL",
    "a hole on the spindle centerline, drilled in one pass or with pecking",
    (
        make_tool_field(ToolKind.DRILL, ToolKind.CENTER_DRILL),
        ShapeField("DIA", "DRILL DIAMETER", FieldKind.DIAMETER, _across, is_in_comment=True),
        ShapeField("DEEP", "DEPTH AT DRILL POINT", FieldKind.LENGTH),
        ShapeField("START", "PREDRILLED DEPTH", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("PECK", "PECK", FieldKind.LENGTH, _peck, allows_zero=True),
        make_feed_field(Operation.DRILL),
        make_rpm_field(Operation.DRILL, make_diameter_reader("DIA")),
    ),
    _drill,
    _drill_sketch,
    _drill_checks,
)
