"""Tool tables of the tests, read from a text."""

from __future__ import annotations

from pathlib import Path

from core.extras.tool_tables.table_file import format_of, read_table
from core.extras.tool_tables.tool_entry import Reading, ToolEntry, ToolTable

INCH = Reading(unit="in")


def table_of(folder: Path, name: str, text: str | bytes, options: Reading = INCH) -> ToolTable:
    """Write the text to a file and read its tools."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_table(path, format_of(name), options)


def tool_of(folder: Path, name: str, text: str | bytes, options: Reading = INCH) -> ToolEntry:
    """Return the only tool of a text."""
    (tool,) = table_of(folder, name, text, options).tools.values()
    return tool
