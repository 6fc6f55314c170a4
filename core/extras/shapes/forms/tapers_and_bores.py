"""Taper, edge and bore: contours defined by a few values."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.contour import Row
from core.extras.shapes.cutting_data import Work
from core.extras.shapes.forms.turning import (
    COMP,
    INSIDE,
    LEAVE,
    OUTSIDE,
    RFEED,
    ROUGH,
    compensated,
    cut_contour,
    cutting_checks,
    too_deep_pass,
)
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number
from core.extras.shapes.usual_fields import around, bar, feed_field, rpm_field, surface_field, tool_field
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch

CHAMFER, ROUND = "CHAMFER", "RADIUS"


def _taper_rows(filled: Filled) -> tuple[Row, ...]:
    begin = -filled.n("AT")
    return Row(filled.n("SMALL"), begin), Row(filled.n("LARGE"), begin - filled.n("LONG"))


def _large(values: Values, _setting: Setting) -> Value | None:
    angle = number(values, "ANGLE")
    if not angle or abs(angle) >= 90:
        return None
    return round(number(values, "SMALL") + 2.0 * number(values, "LONG") * math.tan(math.radians(angle)), 5)


def _taper(filled: Filled, setting: Setting, code: Code) -> None:
    cut_contour(filled, setting, code, _taper_rows(filled), inside=False)


def _taper_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    if filled.n("LARGE") < filled.n("SMALL"):
        yield Refusal(
            "LARGE", "The taper gets smaller toward the chuck, so a turning tool would run into the stock."
        )
    if filled.n("FROM") and filled.n("LARGE") > filled.n("FROM") + 1e-9:
        yield Refusal(
            "LARGE",
            Message(
                "Diameter {number} is more than the stock diameter of {number2}.",
                number=f"{filled.n('LARGE'):g}",
                number2=f"{filled.n('FROM'):g}",
            ),
        )
    yield from compensated(filled, setting)
    yield from cutting_checks(filled, setting)


def _taper_sketch(_filled: Filled) -> Sketch:
    solid = part((0, 0), (0, 5), (-4, 5), (-16, 9), (-24, 9), (-24, 0))
    return sketch(
        solid,
        cut((-4, 5), (-16, 9)),
        dims=(
            Dim("SMALL", (-4, -5), (-4, 5)),
            Dim("LARGE", (-16, -9), (-16, 9)),
            Dim("AT", (-4, 9), (0, 9), 4),
            Dim("LONG", (-16, 9), (-4, 9), 4),
            Dim("ANGLE", (-10, 4)),
        ),
    )


_USUAL_CONTOUR = (ROUGH, LEAVE, RFEED, feed_field(Work.FINISH))

TAPER = Shape(
    "TAPER TURN",
    "a taper defined by two diameters, or by one diameter and an angle",
    (
        tool_field(ToolKind.TURNING),
        Field("FROM", "STOCK DIAMETER", Kind.DIAMETER, bar, zero=True),
        Field("SMALL", "DIAMETER AT THE FACE", Kind.DIAMETER),
        Field("AT", "DISTANCE FROM Z0 TO START", Kind.LENGTH, 0.0, zero=True),
        Field("LONG", "LENGTH", Kind.LENGTH),
        Field("ANGLE", "ANGLE TO THE AXIS", Kind.ANGLE, 0.0, most=89.0, zero=True),
        Field("LARGE", "DIAMETER AT THE CHUCK", Kind.DIAMETER, _large),
        *_USUAL_CONTOUR,
        rpm_field(Work.TURN, around("LARGE")),
        surface_field(),
        COMP,
    ),
    _taper,
    _taper_sketch,
    _taper_checks,
)


def _edge_rows(filled: Filled) -> tuple[Row, ...]:
    across, edge, at = filled.n("DIAM"), filled.n("EDGE"), -filled.n("AT")
    inside = filled.t("SIDE") == INSIDE
    begin = across + 2.0 * edge if inside else across - 2.0 * edge
    arc = 0.0 if filled.t("KIND") == CHAMFER else (-edge if inside else edge)
    return Row(begin, at), Row(across, at - edge, arc=arc)


def _edge(filled: Filled, setting: Setting, code: Code) -> None:
    cut_contour(filled, setting, code, _edge_rows(filled), inside=filled.t("SIDE") == INSIDE)


def _edge_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    across, edge = filled.n("DIAM"), filled.n("EDGE")
    yield from too_deep_pass(filled, setting, "EDGE", edge * math.sqrt(0.5))
    if filled.t("SIDE") == OUTSIDE and 2.0 * edge > across + 1e-9:
        yield Refusal(
            "EDGE",
            Message(
                "An edge size of {edge} is more than half of diameter {across}: enter {across2} or less.",
                edge=f"{edge:g}",
                across=f"{across:g}",
                across2=f"{across / 2:g}",
            ),
        )
    yield from compensated(filled, setting)
    yield from cutting_checks(filled, setting)


def _edge_sketch(filled: Filled) -> Sketch:
    top = ((0, 6), (-4, 10)) if filled.t("KIND") == CHAMFER else ((0, 6), (-1.2, 8.8), (-4, 10))
    solid = part((0, 0), *top, (-22, 10), (-22, 0))
    return sketch(
        solid,
        cut(*top),
        dims=(Dim("DIAM", (-14, -10), (-14, 10)), Dim("EDGE", (-4, 10), (0, 10), 3), Dim("AT", (0, 3))),
    )


EDGE = Shape(
    "EDGE TURN",
    "a chamfer or a radius on an edge, on the outside or in a bore",
    (
        tool_field(ToolKind.TURNING, ToolKind.BORING),
        Field("SIDE", "SIDE", Kind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        Field("KIND", "KIND", Kind.CHOICE, CHAMFER, (CHAMFER, ROUND)),
        Field("DIAM", "DIAMETER", Kind.DIAMETER, bar),
        Field("EDGE", "SIZE", Kind.LENGTH),
        Field("AT", "DISTANCE FROM Z0 TO FACE", Kind.LENGTH, 0.0, zero=True),
        feed_field(Work.FINISH),
        rpm_field(Work.TURN, around("DIAM")),
        COMP,
    ),
    _edge,
    _edge_sketch,
    _edge_checks,
)


def _bore_rows(filled: Filled) -> tuple[Row, ...]:
    across, deep, edge = filled.n("DIAM"), -filled.n("DEEP"), filled.n("EDGE")
    mouth = (Row(across + 2.0 * edge, 0.0), Row(across, -edge)) if edge else (Row(across, 0.0),)
    return *mouth, Row(None, deep), Row(filled.n("HOLE"), None)


def _bore(filled: Filled, setting: Setting, code: Code) -> None:
    cut_contour(filled, setting, code, _bore_rows(filled), inside=True)


def _bore_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    across, deep, hole = filled.n("DIAM"), filled.n("DEEP"), filled.n("HOLE")
    if hole >= across:
        yield Refusal(
            "HOLE",
            Message(
                "The hole diameter of {hole} is not less than the bore diameter of {across}, so "
                "nothing is cut.",
                hole=f"{hole:g}",
                across=f"{across:g}",
            ),
        )
    if filled.n("EDGE") >= deep:
        yield Refusal(
            "EDGE",
            Message(
                "The chamfer is at least as long as the bore depth of {depth}: enter a smaller chamfer.",
                depth=f"{deep:g}",
            ),
        )
    tool = setting.tool(filled.n("T"))
    if tool is not None and tool.diameter and tool.diameter > hole * setting.mm:
        yield Refusal(
            "T",
            Message(
                "The boring bar of T{number} has a diameter of {diameter}, but the hole "
                "diameter is {hole}, so the bar does not fit; drill a larger hole, or use a "
                "smaller boring bar.",
                number=f"{filled.n('T'):.0f}",
                diameter=f"{tool.diameter / setting.mm:.4g}",
                hole=f"{hole:g}",
            ),
        )
    if tool is not None and tool.stick_out and tool.stick_out < deep * setting.mm:
        yield Refusal(
            "DEEP",
            Message(
                "The reach of T{number} is only {stick_out}, but the bore is {depth} deep: use "
                "a longer boring bar.",
                number=f"{filled.n('T'):.0f}",
                stick_out=f"{tool.stick_out / setting.mm:.4g}",
                depth=f"{deep:g}",
            ),
        )
    yield from compensated(filled, setting)
    yield from cutting_checks(filled, setting)


def _bore_sketch(_filled: Filled) -> Sketch:
    wall = part((0, 10), (0, 7), (-1.5, 5.5), (-15, 5.5), (-15, 3), (-24, 3), (-24, 10))
    return sketch(
        wall,
        cut((0, 7), (-1.5, 5.5), (-15, 5.5), (-15, 3)),
        dims=(
            Dim("DIAM", (-8, -5.5), (-8, 5.5)),
            Dim("HOLE", (-19, -3), (-19, 3)),
            Dim("DEEP", (-15, 10), (0, 10), 3),
            Dim("EDGE", (0, 7)),
        ),
    )


BORE = Shape(
    "BORE",
    "a drilled hole bored to a diameter, with a chamfer at the mouth of the hole",
    (
        tool_field(ToolKind.BORING),
        Field("HOLE", "HOLE DIAMETER", Kind.DIAMETER),
        Field("DIAM", "DIAMETER", Kind.DIAMETER),
        Field("DEEP", "DEPTH", Kind.LENGTH),
        Field("EDGE", "CHAMFER AT BORE MOUTH", Kind.LENGTH, 0.0, zero=True),
        ROUGH,
        LEAVE,
        RFEED,
        feed_field(Work.BORE),
        rpm_field(Work.BORE, around("DIAM")),
        surface_field(),
        COMP,
    ),
    _bore,
    _bore_sketch,
    _bore_checks,
)
