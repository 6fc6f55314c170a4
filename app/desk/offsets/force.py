"""From the rows of the store to what the interpreter counts with."""

from __future__ import annotations

from collections.abc import Mapping

from core.interpreter.setup import SecondaryOffset, ToolOffset
from core.store.rows import SecondaryRow, ToolRow


def tool_offsets(rows: Mapping[int, ToolRow]) -> dict[int, ToolOffset]:
    """Of the tools: geometry and wear together."""
    return {n: ToolOffset(*row.offset, row.nose_radius) for n, row in rows.items()}


def secondary_offsets(rows: Mapping[int, SecondaryRow]) -> dict[int, SecondaryOffset]:
    """Of the secondary offsets."""
    return {n: SecondaryOffset(*row) for n, row in rows.items()}
