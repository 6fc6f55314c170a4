"""Tool shapes as the proof uses them, from the stored shapes and the tool offsets."""

from __future__ import annotations

from collections.abc import Mapping

from core.message import Message
from core.part.insert_codes import outline_points
from core.part.shape_rules import ShapeMistake, shape_mistakes
from core.part.tool_shape import Hand, ToolKind, ToolShape
from core.store.store_rows import ShapeRow, ToolRow
from core.tool_edges import edge_name, tool_of


def shape_of(row: ShapeRow, tool: ToolRow | None) -> ToolShape:
    """Return the shape of a tool with the nose radius and tip quadrant of its offset.

    Both are 0 for a tool without an offset.
    """
    offset = tool or ToolRow()
    read = {
        "kind": ToolKind(row.kind),
        "hand": Hand(row.hand),
        "profile": outline_points(row.profile) or (),
    }
    return ToolShape(**row._asdict() | read, tip=offset.quadrant, nose_radius=offset.nose_radius)


def tool_shapes(shapes: Mapping[int, ShapeRow], tools: Mapping[int, ToolRow]) -> dict[int, ToolShape]:
    """Return the valid shapes by tool number. Invalid shapes are omitted because they cannot be drawn.

    A further cutting edge has the shape of its tool, with its own nose radius and tip quadrant.
    """
    edges = {key: shapes[tool_of(key)] for key in tools if tool_of(key) in shapes}
    return {
        number: shape_of(row, tools.get(number))
        for number, row in {**edges, **shapes}.items()
        if not row_mistakes(row, tools.get(number))
    }


def wrong_shapes(shapes: Mapping[int, ShapeRow], tools: Mapping[int, ToolRow]) -> tuple[str, ...]:
    """Return an error text for every mistake in the shapes.

    Each field was valid when it was entered. A mistake results from a later change of another field or
    offset.
    """
    return tuple(
        Message("{number} {field}: {wrong}", number=edge_name(number), field=wrong.field, wrong=wrong.text)
        for number, row in shapes.items()
        for wrong in row_mistakes(row, tools.get(number))
    )


def row_mistakes(row: ShapeRow, tool: ToolRow | None) -> tuple[ShapeMistake, ...]:
    """Return the mistakes in a shape: contradicting fields, or an invalid code or outline."""
    if row.profile and outline_points(row.profile) is None:
        text = "a profile needs at least three points, each with Z and X in mm, for example 0,0 2.5,0 1.2,1.5"
        return (ShapeMistake("profile", text, "not-an-outline"),)
    return shape_mistakes(shape_of(row, tool))
