"""Tool tables of the tests, read from a text."""

from __future__ import annotations

from pathlib import Path

from core.extras.tool_tables.table_file import find_table_format, read_tool_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolEntry, ToolTable

INCH = TableReadingOptions(unit="in")


def table_of(folder: Path, name: str, text: str | bytes, options: TableReadingOptions = INCH) -> ToolTable:
    """Write the text to a file and read its tools."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_tool_table(path, find_table_format(name), options)


def tool_of(folder: Path, name: str, text: str | bytes, options: TableReadingOptions = INCH) -> ToolEntry:
    """Return the only tool of a text."""
    (tool,) = table_of(folder, name, text, options).tools.values()
    return tool
