"""Descriptions of the keys in the JSON output of ``turndesk offsets``."""

from __future__ import annotations

from core.json_keys import JsonKey, JsonOutput, declare_keys, declare_row_keys, prefix_keys
from core.store import table_keys
from core.store.store_rows import (
    MillToolRow,
    PresetRow,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)


def _inch_keys(columns: tuple[JsonKey, ...]) -> tuple[JsonKey, ...]:
    """Return the JSON keys for columns of the store, as ``offsets --json`` prints them.

    Lengths of lathe tools are in inches.
    """
    return tuple(key._replace(unit="in" if key.unit == "mm" else key.unit) for key in columns)


_OFFSETS = {
    "tool": _inch_keys(declare_row_keys("", ToolOffsetRow, table_keys.TOOL_OFFSET_COLUMNS)),
    "secondary": _inch_keys(declare_row_keys("", SecondaryOffsetRow, table_keys.SECONDARY_OFFSET_COLUMNS)),
    "zero": declare_row_keys("", ZeroOffsetRow, table_keys.ZERO_OFFSET_COLUMNS),
    "shape": _inch_keys(declare_row_keys("", ToolShapeRow, table_keys.TOOL_SHAPE_COLUMNS)),
    "mill tool": declare_row_keys("", MillToolRow, table_keys.MILL_TOOL_COLUMNS),
    "preset": declare_row_keys("", PresetRow, table_keys.PRESET_COLUMNS),
}
_NUMBER_KEYS = {
    "tool": "Tool offsets by T; edge 2 of T3 has the key 200003",
    "secondary": "Secondary offsets by D",
    "zero": "Zero offsets by 54 to 59; the key exists only if one is set",
    "shape": "Tool shapes by T; the key exists only if one is set",
    "mill tool": "Tools of a mill by number; the key exists only if one is set",
    "preset": "Presets of a mill by number; the key exists only if one is set",
}
OFFSETS_SHOW_OUTPUT = JsonOutput(
    "offsets show --json",
    "One object.",
    tuple(
        key
        for kind, columns in _OFFSETS.items()
        for key in (
            JsonKey(kind, "object", "", f"{_NUMBER_KEYS[kind]}."),
            *prefix_keys(f"{kind}.*.", columns),
        )
    ),
)
OFFSETS_HISTORY_OUTPUT = JsonOutput(
    "offsets history --json",
    "A list of changes, the newest first. `old` and `new` have the keys of `offsets show`.",
    prefix_keys(
        "[].",
        (
            *declare_keys(
                """
id | integer | | Number of the change.
step | integer | | Number of the step; changes of one step were made together.
undoes | integer or null | | Step that this change undoes; null if it is not an undo.
at | string | UTC | Time of the change.
kind | string | | Table: tool, secondary, zero, shape, mill tool or preset.
number | integer | | Number of the offset.
old | object or null | | Row before the change; null if it was not set.
old.* | string or number or boolean | | One value of the row.
new | object or null | | Row after the change; null if it was cleared.
new.* | string or number or boolean | | One value of the row.
why | string | | Reason for the change.
who | string | | User or TurnDesk function that made the change.
"""
            ),
        ),
    ),
)
