"""Shapes for tapers, edges and bores, whose contours are defined by a few dimensions."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.common_fields import (
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_surface_speed_field,
    make_tool_field,
    propose_bar_diameter,
)
from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.turning import (
    ALLOWANCE_FIELD,
    COMPENSATION_FIELD,
    INSIDE,
    OUTSIDE,
    ROUGHING_DEPTH_FIELD,
    ROUGHING_FEED_FIELD,
    check_compensation,
    check_cutting_data,
    check_pass_depth,
    write_contour,
)
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
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch

CHAMFER, ROUND = "CHAMFER", "RADIUS"


def _taper_rows(filled: ShapeInstance) -> tuple[ContourPoint, ...]:
    begin = -filled.get_number("AT")
    return ContourPoint(filled.get_number("SMALL"), begin), ContourPoint(
        filled.get_number("LARGE"), begin - filled.get_number("LONG")
    )


def _large(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
    angle = number(values, "ANGLE")
    if not angle or abs(angle) >= 90:
        return None
    return round(number(values, "SMALL") + 2.0 * number(values, "LONG") * math.tan(math.radians(angle)), 5)


def _taper(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    write_contour(filled, setting, code, _taper_rows(filled), is_inside=False)


def _taper_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    if filled.get_number("LARGE") < filled.get_number("SMALL"):
        yield FieldError(
            "LARGE", "The taper gets smaller toward the chuck, so a turning tool would run into the stock."
        )
    if filled.get_number("FROM") and filled.get_number("LARGE") > filled.get_number("FROM") + 1e-9:
        yield FieldError(
            "LARGE",
            Message(
                "Diameter {number} is more than the stock diameter of {number2}.",
                number=f"{filled.get_number('LARGE'):g}",
                number2=f"{filled.get_number('FROM'):g}",
            ),
        )
    yield from check_compensation(filled, setting)
    yield from check_cutting_data(filled, setting)


def _taper_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, 0), (0, 5), (-4, 5), (-16, 9), (-24, 9), (-24, 0))
    return make_sketch(
        solid,
        make_cut_outline((-4, 5), (-16, 9)),
        dimensions=(
            Dimension("SMALL", (-4, -5), (-4, 5)),
            Dimension("LARGE", (-16, -9), (-16, 9)),
            Dimension("AT", (-4, 9), (0, 9), 4),
            Dimension("LONG", (-16, 9), (-4, 9), 4),
            Dimension("ANGLE", (-10, 4)),
        ),
    )


_USUAL_CONTOUR = (
    ROUGHING_DEPTH_FIELD,
    ALLOWANCE_FIELD,
    ROUGHING_FEED_FIELD,
    make_feed_field(Operation.FINISH),
)

TAPER_SHAPE = Shape(
    "TAPER TURN",
    "a taper defined by two diameters, or by one diameter and an angle",
    (
        make_tool_field(ToolKind.TURNING),
        ShapeField("FROM", "STOCK DIAMETER", FieldKind.DIAMETER, propose_bar_diameter, allows_zero=True),
        ShapeField("SMALL", "DIAMETER AT THE FACE", FieldKind.DIAMETER),
        ShapeField("AT", "DISTANCE FROM Z0 TO START", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("LONG", "LENGTH", FieldKind.LENGTH),
        ShapeField("ANGLE", "ANGLE TO THE AXIS", FieldKind.ANGLE, 0.0, maximum=89.0, allows_zero=True),
        ShapeField("LARGE", "DIAMETER AT THE CHUCK", FieldKind.DIAMETER, _large),
        *_USUAL_CONTOUR,
        make_rpm_field(Operation.TURN, make_diameter_reader("LARGE")),
        make_surface_speed_field(),
        COMPENSATION_FIELD,
    ),
    _taper,
    _taper_sketch,
    _taper_checks,
)


def _edge_rows(filled: ShapeInstance) -> tuple[ContourPoint, ...]:
    across, edge, at = filled.get_number("DIAM"), filled.get_number("EDGE"), -filled.get_number("AT")
    inside = filled.get_text("SIDE") == INSIDE
    begin = across + 2.0 * edge if inside else across - 2.0 * edge
    arc = 0.0 if filled.get_text("KIND") == CHAMFER else (-edge if inside else edge)
    return ContourPoint(begin, at), ContourPoint(across, at - edge, arc=arc)


def _edge(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    write_contour(filled, setting, code, _edge_rows(filled), is_inside=filled.get_text("SIDE") == INSIDE)


def _edge_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    across, edge = filled.get_number("DIAM"), filled.get_number("EDGE")
    yield from check_pass_depth(filled, setting, "EDGE", edge * math.sqrt(0.5))
    if filled.get_text("SIDE") == OUTSIDE and 2.0 * edge > across + 1e-9:
        yield FieldError(
            "EDGE",
            Message(
                "An edge size of {edge} is more than half of diameter {across}: enter {across2} or less.",
                edge=f"{edge:g}",
                across=f"{across:g}",
                across2=f"{across / 2:g}",
            ),
        )
    yield from check_compensation(filled, setting)
    yield from check_cutting_data(filled, setting)


def _edge_sketch(filled: ShapeInstance) -> Sketch:
    top = ((0, 6), (-4, 10)) if filled.get_text("KIND") == CHAMFER else ((0, 6), (-1.2, 8.8), (-4, 10))
    solid = make_part_outline((0, 0), *top, (-22, 10), (-22, 0))
    return make_sketch(
        solid,
        make_cut_outline(*top),
        dimensions=(
            Dimension("DIAM", (-14, -10), (-14, 10)),
            Dimension("EDGE", (-4, 10), (0, 10), 3),
            Dimension("AT", (0, 3)),
        ),
    )


EDGE_SHAPE = Shape(
    "EDGE TURN",
    "a chamfer or a radius on an edge, on the outside or in a bore",
    (
        make_tool_field(ToolKind.TURNING, ToolKind.BORING),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        ShapeField("KIND", "KIND", FieldKind.CHOICE, CHAMFER, (CHAMFER, ROUND)),
        ShapeField("DIAM", "DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("EDGE", "SIZE", FieldKind.LENGTH),
        ShapeField("AT", "DISTANCE FROM Z0 TO FACE", FieldKind.LENGTH, 0.0, allows_zero=True),
        make_feed_field(Operation.FINISH),
        make_rpm_field(Operation.TURN, make_diameter_reader("DIAM")),
        COMPENSATION_FIELD,
    ),
    _edge,
    _edge_sketch,
    _edge_checks,
)


def _bore_rows(filled: ShapeInstance) -> tuple[ContourPoint, ...]:
    across, deep, edge = filled.get_number("DIAM"), -filled.get_number("DEEP"), filled.get_number("EDGE")
    mouth = (
        (ContourPoint(across + 2.0 * edge, 0.0), ContourPoint(across, -edge))
        if edge
        else (ContourPoint(across, 0.0),)
    )
    return *mouth, ContourPoint(None, deep), ContourPoint(filled.get_number("HOLE"), None)


def _bore(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    write_contour(filled, setting, code, _bore_rows(filled), is_inside=True)


def _bore_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    across, deep, hole = filled.get_number("DIAM"), filled.get_number("DEEP"), filled.get_number("HOLE")
    if hole >= across:
        yield FieldError(
            "HOLE",
            Message(
                "The hole diameter of {hole} is not less than the bore diameter of {across}, so "
                "nothing is cut.",
                hole=f"{hole:g}",
                across=f"{across:g}",
            ),
        )
    if filled.get_number("EDGE") >= deep:
        yield FieldError(
            "EDGE",
            Message(
                "The chamfer is at least as long as the bore depth of {depth}: enter a smaller chamfer.",
                depth=f"{deep:g}",
            ),
        )
    tool = setting.tool(filled.get_number("T"))
    if tool is not None and tool.diameter and tool.diameter > hole * setting.mm:
        yield FieldError(
            "T",
            Message(
                "The boring bar of T{number} has a diameter of {diameter}, but the hole "
                "diameter is {hole}, so the bar does not fit; drill a larger hole, or use a "
                "smaller boring bar.",
                number=f"{filled.get_number('T'):.0f}",
                diameter=f"{tool.diameter / setting.mm:.4g}",
                hole=f"{hole:g}",
            ),
        )
    if tool is not None and tool.stick_out and tool.stick_out < deep * setting.mm:
        yield FieldError(
            "DEEP",
            Message(
                "The reach of T{number} is only {stick_out}, but the bore is {depth} deep: use "
                "a longer boring bar.",
                number=f"{filled.get_number('T'):.0f}",
                stick_out=f"{tool.stick_out / setting.mm:.4g}",
                depth=f"{deep:g}",
            ),
        )
    yield from check_compensation(filled, setting)
    yield from check_cutting_data(filled, setting)


def _bore_sketch(_filled: ShapeInstance) -> Sketch:
    wall = make_part_outline((0, 10), (0, 7), (-1.5, 5.5), (-15, 5.5), (-15, 3), (-24, 3), (-24, 10))
    return make_sketch(
        wall,
        make_cut_outline((0, 7), (-1.5, 5.5), (-15, 5.5), (-15, 3)),
        dimensions=(
            Dimension("DIAM", (-8, -5.5), (-8, 5.5)),
            Dimension("HOLE", (-19, -3), (-19, 3)),
            Dimension("DEEP", (-15, 10), (0, 10), 3),
            Dimension("EDGE", (0, 7)),
        ),
    )


BORE_SHAPE = Shape(
    "BORE",
    "a drilled hole bored to a diameter, with a chamfer at the mouth of the hole",
    (
        make_tool_field(ToolKind.BORING),
        ShapeField("HOLE", "HOLE DIAMETER", FieldKind.DIAMETER),
        ShapeField("DIAM", "DIAMETER", FieldKind.DIAMETER),
        ShapeField("DEEP", "DEPTH", FieldKind.LENGTH),
        ShapeField("EDGE", "CHAMFER AT BORE MOUTH", FieldKind.LENGTH, 0.0, allows_zero=True),
        ROUGHING_DEPTH_FIELD,
        ALLOWANCE_FIELD,
        ROUGHING_FEED_FIELD,
        make_feed_field(Operation.BORE),
        make_rpm_field(Operation.BORE, make_diameter_reader("DIAM")),
        make_surface_speed_field(),
        COMPENSATION_FIELD,
    ),
    _bore,
    _bore_sketch,
    _bore_checks,
)
