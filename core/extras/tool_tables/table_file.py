"""Reader of tool table files, which limits the file size as a protection against malicious files.

The format name or the file suffix determines the format.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from core.extras.tool_tables import csv_table, freecad_tools, fusion_export, fusion_library, linuxcnc_table
from core.extras.tool_tables.tool_entry import (
    TABLE_FIELDS,
    TableReader,
    TableReadingOptions,
    ToolEntry,
    ToolTable,
    ToolTableError,
)
from core.input_file import BYTES_PER_MB, TooLargeError, read_input_bytes
from core.message import Message

MAX_TABLE_BYTES = 16 * BYTES_PER_MB
_CONTROL = re.compile(rb"[\x00-\x08\x0b\x0e-\x19\x1b-\x1f]")


class TableFormat(NamedTuple):
    """A format of tool tables.

    The format has a name for users, file suffixes, and a function that reads the text of a table. If the
    file can be an archive, ``unpack`` returns the text in it; its parameters are the file name, the data and
    the maximum number of bytes. If the format can be written, ``exported_fields`` are the fields that it can
    contain, and ``format_text`` returns the text of a table in a unit of ``MM_PER_UNIT``.
    """

    title: str
    suffixes: tuple[str, ...]
    read_text: Callable[[TableReader, str], None]
    unpack: Callable[[str, bytes, int], bytes] | None = None
    exported_fields: frozenset[str] = frozenset()
    format_text: Callable[[Iterable[ToolEntry], str], str] = csv_table.format_table
    can_export: Callable[[ToolEntry], bool] = bool


FORMATS: Mapping[str, TableFormat] = {
    "linuxcnc": TableFormat(
        "LinuxCNC tool table",
        (".tbl",),
        linuxcnc_table.read_tools,
        exported_fields=linuxcnc_table.EXPORTED_FIELDS,
        format_text=linuxcnc_table.format_table,
    ),
    "mach": TableFormat("Mach tool table", (".dat",), csv_table.read_tools),
    "csv": TableFormat(
        "CSV", (".csv", ".txt", ".tsv"), csv_table.read_tools, exported_fields=frozenset(TABLE_FIELDS)
    ),
    "fusion": TableFormat(
        "Fusion tool library",
        (".json", ".tools"),
        fusion_library.read_tools,
        fusion_library.unpack,
        fusion_export.EXPORTED_FIELDS,
        fusion_export.format_library,
        fusion_export.can_export,
    ),
    "freecad": TableFormat("FreeCAD tool bits", (".fctb", ".fctl"), freecad_tools.read_tools),
}
"""Readable table formats, by the value of the option --from."""


def find_table_format(name: str) -> str:
    """Return the table format that a file's suffix implies. Raises ToolTableError if none matches."""
    suffix = Path(name).suffix.lower()
    for word, each in FORMATS.items():
        if suffix in each.suffixes:
            return word
    text = Message(
        "{name}: the format cannot be recognized from the file name; add --from with one of {formats}",
        name=name,
        formats=", ".join(FORMATS),
    )
    raise ToolTableError(text, "unknown-format")


def read_tool_table(path: Path, format_name: str, options: TableReadingOptions) -> ToolTable:
    """Return the tools of a file in format ``format_name``.

    Raises ToolTableError if the file is unreadable, is too large or is not UTF-8 text, if the table has
    mistakes, or if it has no tools.
    """
    table = TableReader(path.name, options, path.parent)
    table_format = FORMATS[format_name]
    data = _bytes(path)
    if table_format.unpack:
        data = table_format.unpack(path.name, data, MAX_TABLE_BYTES)
    table_format.read_text(table, _text(path.name, data, format_name))
    return table.make_table()


def _bytes(path: Path) -> bytes:
    """Return the contents of a file. Raises ToolTableError if it is too large or unreadable."""
    try:
        return read_input_bytes(path, MAX_TABLE_BYTES)
    except TooLargeError as error:
        text = Message("{path} is larger than 16 MB, so it is not a tool table; check the name", path=path)
        raise ToolTableError(text, "too-large") from error
    except OSError as error:
        text = Message(
            "{path} cannot be read ({cause}); check the name and the permissions",
            path=path,
            cause=error.strerror,
        )
        raise ToolTableError(text, "unreadable") from error


def _text(name: str, data: bytes, word: str) -> str:
    """Return the text of a file. Raises ToolTableError if the file is binary or not UTF-8."""
    if binary := _CONTROL.search(data):
        remedy = (
            "export the table from Mach as CSV" if word == "mach" else "check the file and the option --from"
        )
        text = Message(
            "{name}: byte {place} is not text, so this is a binary file; {remedy}",
            name=name,
            place=binary.start(),
            remedy=remedy,
        )
        raise ToolTableError(text, "binary-table")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        text = Message(
            "{name}: byte {place} is not UTF-8; save the file as UTF-8", name=name, place=error.start
        )
        raise ToolTableError(text, "not-utf8") from error
