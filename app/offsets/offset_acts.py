"""What a change of an offset is, for the table of levels: a correction, or where a tip or a zero is."""

from __future__ import annotations

from collections.abc import Collection

from core.access.access_table import Act
from core.store.store_rows import Kind

CORRECTIONS = {
    Kind.TOOL: frozenset({"wear_x", "wear_z", "remark"}),
    Kind.MILL_TOOL: frozenset({"dl", "dr", "dr2"}),
}
"""Fields of a tool that are corrections; of a secondary offset all are."""

_ACTS = {
    Kind.TOOL: Act.TOOLS,
    Kind.SECONDARY: Act.WEAR,
    Kind.ZERO: Act.ZEROS,
    Kind.SHAPE: Act.SHAPES,
    Kind.MILL_TOOL: Act.TOOLS,
    Kind.PRESET: Act.PRESETS,
}


def act_of(kind: Kind, fields: Collection[str] = ()) -> Act:
    """What it is to change these fields; without fields: to clear, or to take a change back."""
    only = CORRECTIONS.get(kind, frozenset())
    return Act.WEAR if fields and only.issuperset(fields) else _ACTS[kind]
