"""The readers of tool tables, for the tests of files that are none: ``tests/fuzz/test_file_doors.py``."""

from __future__ import annotations

from pathlib import Path

from core.extras.tool_tables.table_file import FORMATS, read_tool_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTable, ToolTableError


def _read(path: Path) -> ToolTable:
    word = next(word for word, each in FORMATS.items() if path.suffix in each.suffixes)
    return read_tool_table(path, word, TableReadingOptions())


DOORS = tuple(
    (f"tools{each.suffixes[0]}", _read, ToolTableError, "unreadable", "too-large")
    for each in FORMATS.values()
)
