"""Tool shapes for the proof, made from the stored shapes and the tool offsets."""

from __future__ import annotations

from collections.abc import Mapping

from core.message import Message
from core.part.insert_codes import parse_outline
from core.part.shape_rules import ShapeMistake, find_shape_mistakes
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.store.store_rows import ToolOffsetRow, ToolShapeRow
from core.tool_edges import TIP_DIRECTIONS, format_edge_name, get_tool_number


def make_tool_shape(row: ToolShapeRow, tool: ToolOffsetRow | None) -> ToolShape:
    """Return the tool's shape with the nose radius and tip quadrant from its tool offset.

    Both values are 0 for a tool without an offset.
    """
    offset = tool or ToolOffsetRow()
    read = {
        "kind": ToolKind(row.kind),
        "hand": ToolHand(row.hand),
        "profile": parse_outline(row.profile) or (),
    }
    return ToolShape(**row._asdict() | read, tip=offset.quadrant, nose_radius=offset.nose_radius)


def make_tool_shapes(
    shapes: Mapping[int, ToolShapeRow], tools: Mapping[int, ToolOffsetRow]
) -> dict[int, ToolShape]:
    """Return the valid shapes by tool number. Invalid shapes are omitted because they cannot be drawn.

    An additional cutting edge has the shape of its tool, but its own nose radius and tip quadrant.
    """
    edges = {key: shapes[get_tool_number(key)] for key in tools if get_tool_number(key) in shapes}
    return {
        number: make_tool_shape(row, tools.get(number))
        for number, row in {**edges, **shapes}.items()
        if not find_shape_row_mistakes(row, tools.get(number))
    }


def describe_shape_mistakes(
    shapes: Mapping[int, ToolShapeRow], tools: Mapping[int, ToolOffsetRow]
) -> tuple[str, ...]:
    """Return an error text for every mistake in the shapes.

    Each field was valid when it was entered. Mistakes result from later changes of other fields or offsets.
    """
    return tuple(
        Message(
            "{number} {field}: {wrong}",
            number=format_edge_name(number),
            field=wrong.field_name,
            wrong=wrong.message,
        )
        for number, row in shapes.items()
        for wrong in find_shape_row_mistakes(row, tools.get(number))
    )


def find_shape_row_mistakes(row: ToolShapeRow, tool: ToolOffsetRow | None) -> tuple[ShapeMistake, ...]:
    """Return the mistakes in a shape, such as contradictory fields, an invalid code or an invalid outline."""
    if row.profile and parse_outline(row.profile) is None:
        text = "a profile needs at least three points, each with Z and X in mm, for example 0,0 2.5,0 1.2,1.5"
        return (ShapeMistake("profile", text, "not-an-outline"),)
    return find_shape_mistakes(make_tool_shape(row, tool))


def is_quadrant_for_other_side(row: ToolShapeRow, tool: ToolOffsetRow, tip_x_mm: float) -> bool:
    """Return whether the tip quadrant of a tool is for the other side of the part than its tip.

    ``tip_x_mm`` is X of the tip relative to part zero. The result is False for a rotating tool, and for a
    quadrant that points neither to the axis nor away from it.
    """
    shape = make_tool_shape(row, tool)
    if shape.is_rotating or TIP_DIRECTIONS[tool.quadrant][1] == 0:
        return False
    return tip_x_mm * (-1.0 if shape.is_rear_tool else 1.0) < 0.0
