"""Groove shape in the face of a part, cut along Z with a face grooving blade."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.common_fields import (
    check_feeds,
    check_rpm,
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_tool_field,
)
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.bar_work import BLADE_CLEARANCE, check_blade
from core.extras.shapes.forms.turning import write_spindle_end, write_spindle_start
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

OUTER, MIDDLE, INNER = "OUTER", "MIDDLE", "INNER"
_CORNERS = {OUTER: 0.0, MIDDLE: 0.5, INNER: 1.0}  # distance from the outer corner in blade widths
_FACE_DIRECTION = (-1, 0)  # of tip quadrant 7
_OVERLAP = 0.8  # distance between plunges as a fraction of the blade width
_MOST_PECKS = 200


def _propose_width(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.width / setting.mm, 5) if shape is not None and shape.width else None


def _propose_corner(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    """Return the middle for a grooving blade in the tool data, because quadrant 7 is measured there."""
    shape = setting.tool(number(values, "T"))
    return MIDDLE if shape is not None and shape.kind is ToolKind.GROOVING else OUTER


def _list_outer_radii(filled: ShapeInstance) -> list[float]:
    """Return the radius of the outer blade corner for each plunge, from the outside to the inside.

    The first plunge is at the outer diameter, where the clearance of the blade fits the groove.
    """
    wide = filled.get_number("WIDE")
    first, last = filled.get_number("OUTER") / 2.0, filled.get_number("INNER") / 2.0 + wide
    over = first - last
    steps = math.ceil(over / (_OVERLAP * wide) - 1e-9) if over > 1e-9 else 0
    return [first - over * k / max(steps, 1) for k in range(steps + 1)]


def _write_plunge(filled: ShapeInstance, code: CodeWriter, above: float) -> None:
    """Write one plunge along Z from ``above`` the face to the depth, in pecks if specified."""
    at, deep, feed = (filled.get_number(word) for word in ("AT", "DEEP", "FEED"))
    peck = filled.get_number("PECK") or deep
    count = math.ceil(deep / peck - 1e-9)
    for k in range(1, count + 1):
        if k > 1:
            code.write_rapid(z=above)
            code.write_rapid(z=at - (k - 1) * peck + (above - at))
        code.write_cut(z=at - min(k * peck, deep), feed=feed)


def _face_groove(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    above = filled.get_number("AT") + BLADE_CLEARANCE[setting.metric]
    corner = _CORNERS[filled.get_text("CORNER")] * filled.get_number("WIDE")
    radii = [radius - corner for radius in _list_outer_radii(filled)]
    write_spindle_start(filled, setting, code, radii[0], filled.get_number("AT") + setting.near)
    for k, radius in enumerate(radii):
        if k:
            code.write_rapid(x=radius)
        code.write_rapid(z=above)
        _write_plunge(filled, code, above)
        if k == len(radii) - 1 and k:
            code.write_cut(x=radii[0], feed=filled.get_number("FEED"))  # cut along the bottom
        else:
            code.write_dwell(filled.get_number("DWELL"))
        code.write_rapid(z=above)
    write_spindle_end(filled, code)


def _find_conflicts(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    outer, inner, wide, deep, peck = (
        filled.get_number(word) for word in ("OUTER", "INNER", "WIDE", "DEEP", "PECK")
    )
    if inner >= outer:
        yield FieldError(
            "INNER",
            Message(
                "The inner diameter {inner} must be less than the outer diameter {outer}.",
                inner=f"{inner:g}",
                outer=f"{outer:g}",
            ),
        )
    elif wide > (outer - inner) / 2.0 + 1e-9:
        yield FieldError(
            "WIDE",
            Message(
                "The groove is {groove} wide, but the blade is {blade} wide: use a narrower blade.",
                groove=f"{(outer - inner) / 2.0:g}",
                blade=f"{wide:g}",
            ),
        )
    shape = setting.tool(filled.get_number("T"))
    if shape is not None and shape.direction != _FACE_DIRECTION:
        yield FieldError(
            "T",
            Message(
                "The tool data of T{tool} describes a blade that cuts diameters: use another blade, or "
                "enter tip quadrant 7 for a blade that cuts faces.",
                tool=f"{filled.get_number('T'):.0f}",
            ),
        )
    if peck and deep > _MOST_PECKS * peck:
        yield FieldError(
            "PECK",
            Message(
                "With a peck depth of {peck}, the groove needs more than {count} pecks: "
                "enter a larger depth.",
                peck=f"{peck:g}",
                count=_MOST_PECKS,
            ),
        )
    yield from check_blade(filled, setting, deep, "DEEP")
    yield from check_rpm(filled, setting)
    yield from check_feeds(filled, setting, "FEED")


def _make_face_groove_sketch(_filled: ShapeInstance) -> Sketch:
    walls = ((0, 9), (-5, 9), (-5, 5), (0, 5))
    solid = make_part_outline((0, 0), (0, 5), *reversed(walls[1:3]), (0, 9), (0, 12), (-18, 12), (-18, 0))
    return make_sketch(
        solid,
        make_cut_outline(*walls),
        make_tool_outline((-4.8, 9), (-4.8, 7), (5, 7), (5, 9)),
        dimensions=(
            Dimension("OUTER", (0, -9), (0, 9)),
            Dimension("INNER", (-3, -5), (-3, 5)),
            Dimension("DEEP", (-5, 12), (0, 12), 3),
            Dimension("WIDE", (5, 7), (5, 9)),
            Dimension("AT", (0, 11)),
        ),
    )


FACE_GROOVE_SHAPE = Shape(
    "FACE GROOVE",
    "a ring groove or a recess in the face, cut along Z from the outer to the inner diameter",
    (
        make_tool_field(ToolKind.GROOVING, ToolKind.FORM),
        ShapeField("OUTER", "OUTER DIAMETER", FieldKind.DIAMETER),
        ShapeField("INNER", "INNER DIAMETER", FieldKind.DIAMETER, allows_zero=True),
        ShapeField("AT", "FACE AT Z", FieldKind.COORDINATE, 0.0),
        ShapeField("DEEP", "DEPTH", FieldKind.LENGTH),
        ShapeField("WIDE", "BLADE WIDTH", FieldKind.LENGTH, _propose_width, is_in_comment=True),
        ShapeField("CORNER", "POINT USED FOR TOUCH-OFF", FieldKind.CHOICE, _propose_corner, tuple(_CORNERS)),
        ShapeField("PECK", "PECK DEPTH", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("DWELL", "DWELL AT BOTTOM", FieldKind.SECONDS, 0.1, allows_zero=True, maximum=60),
        make_feed_field(Operation.GROOVE),
        make_rpm_field(Operation.GROOVE, make_diameter_reader("OUTER")),
    ),
    _face_groove,
    _make_face_groove_sketch,
    _find_conflicts,
)
