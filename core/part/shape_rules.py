"""Rules for tool shapes: the fields that apply to each kind of tool, and contradictions to report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from core.message import Message
from core.part.insert_codes import InsertCodeError, decode_insert_code, parse_holder
from core.part.tool_outline import BORING_ENTERING_ANGLES, ENTERING_ANGLES
from core.part.tool_polygons import PartError, split_into_convex_pieces
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.tool_edges import TIP_DIRECTIONS

_EDGED_TOOL_FIELDS = ("hand", "tip", "nose_radius", "insert", "holder", "entry", "stick_out", "rear")
_ROUND_TOOL_FIELDS = ("tip", "diameter", "length", "stick_out")
# Fields that apply to each kind, in the order of the form. The other fields of a shape are ignored.
FIELDS_BY_KIND: Mapping[ToolKind, tuple[str, ...]] = {
    ToolKind.TURNING: _EDGED_TOOL_FIELDS,
    ToolKind.BORING: (*_EDGED_TOOL_FIELDS[:5], "diameter", *_EDGED_TOOL_FIELDS[5:]),
    ToolKind.GROOVING: (
        *_EDGED_TOOL_FIELDS[:3],
        "width",
        "length",
        "holder",
        "diameter",
        "stick_out",
        "rear",
    ),
    ToolKind.PARTING: (*_EDGED_TOOL_FIELDS[:3], "width", "length", "holder", "stick_out", "rear"),
    ToolKind.THREADING: (
        *_EDGED_TOOL_FIELDS[:3],
        "point",
        "pitch",
        "length",
        "holder",
        "diameter",
        "stick_out",
        "rear",
    ),
    ToolKind.DRILL: ("tip", "diameter", "point", "length", "stick_out", "flutes"),
    ToolKind.CENTER_DRILL: ("tip", "diameter", "width", "point", "stick_out"),
    ToolKind.REAMER: (*_ROUND_TOOL_FIELDS, "flutes"),
    ToolKind.TAP: ("hand", "tip", "diameter", "pitch", "length", "stick_out", "flutes"),
    ToolKind.END_MILL: ("tip", "nose_radius", "diameter", "length", "stick_out", "flutes"),
    ToolKind.FORM: ("hand", "tip", "nose_radius", "profile", "holder", "stick_out", "rear"),
}


class ShapeMistake(NamedTuple):
    """A contradiction in a tool shape, with the field that should be changed."""

    field_name: str
    message: str
    code: str  # identifies the fault, like the code of a ``CodedError``


def find_shape_mistakes(shape: ToolShape) -> tuple[ShapeMistake, ...]:
    """Return all contradictions and invalid values of a shape.

    The result is empty if the shape can be drawn.
    """
    return tuple(mistake for rule in _RULES for mistake in rule(shape))


def _insert(shape: ToolShape) -> Iterator[ShapeMistake]:
    if shape.kind not in {ToolKind.TURNING, ToolKind.BORING} or not shape.insert.strip():
        return
    try:
        insert = decode_insert_code(shape.insert)
    except InsertCodeError as error:
        yield ShapeMistake("insert", str(error), error.code)
        return
    if insert.corner_angles and 2.0 * shape.nose_radius >= insert.inscribed_circle:
        yield ShapeMistake(
            "nose_radius",
            Message("the nose radius is too large for insert {insert}", insert=shape.insert),
            "nose-too-large",
        )
    yield from _check_entry_angle(shape, insert.shape, insert.point_angle)


def _check_entry_angle(shape: ToolShape, letter: str, point: float) -> Iterator[ShapeMistake]:
    """Check that the end cutting edge does not extend in front of the tip."""
    holder = parse_holder(shape.holder)
    coded = (
        holder.entering_angle_deg
        if holder and not (holder.is_angle_for_facing and not shape.internal)
        else 0.0
    )
    neutral = shape.hand is ToolHand.NEUTRAL or 0 in shape.direction
    usual = (
        0.0 if neutral else (BORING_ENTERING_ANGLES if shape.internal else ENTERING_ANGLES).get(letter, 0.0)
    )
    angle = shape.entry or coded or usual
    if angle + point > 180.0:
        text = Message(
            "an entering angle of {angle}° leaves no clearance for a point angle of {point}°; "
            "use at most {point2}°",
            angle=f"{angle:g}",
            point=f"{point:g}",
            point2=f"{180 - point:g}",
        )
        yield ShapeMistake("entry", text, "no-clearance")


def _tip(shape: ToolShape) -> Iterator[ShapeMistake]:
    if shape.is_rotating and 0 not in TIP_DIRECTIONS[shape.tip]:
        text = Message(
            "tip quadrant {tip} does not fit a rotating tool; use 7 (along the spindle), 8 "
            "(across the spindle) or 6 (from the rear)",
            tip=shape.tip,
        )
        yield ShapeMistake("tip", text, "not-an-end")
    across = TIP_DIRECTIONS[shape.tip][1]
    if shape.rear and across and not shape.is_rotating and (across > 0) is shape.internal:
        template = (
            "tip quadrant {tip} is for a front tool; the tip of a rear tool is on the X− side: use quadrant "
            "3, 4 or 8"
            if shape.internal
            else "tip quadrant {tip} is for a front tool; the tip of a rear tool is on the X+ side: use "
            "quadrant 1, 2 or 6"
        )
        yield ShapeMistake("tip", Message(template, tip=shape.tip), "tool-in-front")


def _sizes(shape: ToolShape) -> Iterator[ShapeMistake]:
    groove = shape.kind in {ToolKind.GROOVING, ToolKind.PARTING}
    if groove and shape.width and 2.0 * shape.nose_radius > shape.width:
        yield ShapeMistake(
            "nose_radius",
            "the nose radius is more than half the width of the cutting edge",
            "corners-too-wide",
        )
    if shape.kind is ToolKind.END_MILL and shape.diameter and 2.0 * shape.nose_radius > shape.diameter:
        yield ShapeMistake(
            "nose_radius", "the corner radius is larger than half the diameter", "nose-too-large"
        )
    if shape.is_rotating and shape.stick_out and shape.length > shape.stick_out:
        yield ShapeMistake(
            "length", "the cutting length is longer than the stick-out of the tool", "too-long"
        )
    if shape.kind is ToolKind.CENTER_DRILL and shape.diameter and shape.width >= shape.diameter:
        yield ShapeMistake(
            "width",
            "the pilot diameter must be less than the diameter of the center drill",
            "pilot-too-thick",
        )
    if shape.kind is ToolKind.TAP and shape.diameter and 2.0 * shape.pitch >= shape.diameter:
        yield ShapeMistake("pitch", "the pitch is too coarse for the tap diameter", "pitch-too-coarse")


def _outlines(shape: ToolShape) -> Iterator[ShapeMistake]:
    holder = parse_holder(shape.holder)
    profile = shape.profile if shape.kind is ToolKind.FORM else ()
    for field, points in (("profile", profile), ("holder", holder.outline if holder else ())):
        if not points:
            continue
        try:
            pieces = split_into_convex_pieces(points) if len(points) > 2 else ()
        except PartError as error:
            yield ShapeMistake(field, str(error), error.code)
            continue
        if not pieces:
            yield ShapeMistake(
                field, "an outline needs three points that are not on a straight line", "too-few-points"
            )


_RULES: tuple[Callable[[ToolShape], Iterator[ShapeMistake]], ...] = (_insert, _tip, _sizes, _outlines)
