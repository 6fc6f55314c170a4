"""Export of the stored tools to a tool table that another program can read."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_OK, CommandError, convert_to_command_error
from app.extras.tool_tables.table_options import parse_columns, parse_tool_numbers
from core.extras.tool_tables import csv_table
from core.extras.tool_tables.csv_columns import NUMBER
from core.extras.tool_tables.table_file import FORMATS, TableFormat, find_table_format
from core.extras.tool_tables.tool_entry import OFFSET_FIELDS, TABLE_FIELDS, ToolEntry, ToolTableError
from core.message import Message
from core.store.store_rows import OFFSET_NUMBERS, FieldValue, ToolOffsetRow, ToolShapeRow


def export_table(args: argparse.Namespace) -> int:
    """Write the tools to a new file, and report the values that the file format cannot represent.

    Raises CommandError if the file exists, if TurnDesk cannot write the format, or if there are no tools.
    """
    path = Path(args.file)
    format_name = _find_format(args)
    table_format = FORMATS[format_name]
    columns = _read_columns(args, format_name)
    numbers = parse_tool_numbers(args.only) or frozenset(OFFSET_NUMBERS)
    _check_path(path)
    with open_store(read_only=True) as store:
        tools, shapes = store.offsets.tool_offsets.read_rows(), store.offsets.tool_shapes.read_rows()
    entries = [
        make_entry(number, tools.get(number), shapes.get(number))
        for number in sorted((tools.keys() | shapes.keys()) & numbers)
    ]
    exported = [each for each in entries if table_format.can_export(each)]
    if not exported:
        raise CommandError("there are no tools to export; enter tools, or check --only", "no-tools")
    text = (
        csv_table.format_columns(exported, args.unit, columns)
        if columns
        else table_format.format_text(exported, args.unit)
    )
    _write(path, text)
    sys.stdout.writelines(f"{line}\n" for line in _report(entries, exported, tools, table_format, columns))
    return EXIT_OK


def make_entry(number: int, tool: ToolOffsetRow | None, shape: ToolShapeRow | None) -> ToolEntry:
    """Return a stored tool as an entry of a tool table. Wear and the master mark are omitted."""
    offset: dict[str, FieldValue] = {}
    if tool is not None:
        offset = {name: getattr(tool, name) for name in OFFSET_FIELDS}
        offset = {name: value for name, value in offset.items() if value or name in {"x", "z"}}
    row = {name: getattr(shape, name) for name in ToolShapeRow._fields} if shape is not None else {}
    values = {name: value for name, value in row.items() if value and shape is not None and shape.kind}
    return ToolEntry(number, f"T{number}", offset, values)


def _find_format(args: argparse.Namespace) -> str:
    """Return the file format from the option ``--to`` or from the file suffix.

    Raises CommandError if TurnDesk cannot write this format.
    """
    with convert_to_command_error(ToolTableError):
        found: str = args.format or find_table_format(Path(args.file).name)
    if FORMATS[found].exported_fields:
        return found
    writable = ", ".join(word for word, each in FORMATS.items() if each.exported_fields)
    text = Message(
        "{title} cannot be written; use --to with one of {formats}",
        title=FORMATS[found].title,
        formats=writable,
    )
    raise CommandError(text, "unknown-format")


def _read_columns(args: argparse.Namespace, format_name: str) -> dict[str, str]:
    """Return the column headings of a CSV file, by field.

    Raises CommandError if headings are specified for another format, or if the tool number has no heading.
    """
    columns = parse_columns(args.columns)
    if columns and format_name != "csv":
        raise CommandError("--map is only for CSV files; leave it out", "unknown-option")
    unknown = sorted(columns.keys() - TABLE_FIELDS.keys() - {NUMBER, *csv_table.DERIVED_FIELDS})
    if unknown:
        text = Message("--map {key}: this field cannot be exported; leave it out", key=unknown[0])
        raise CommandError(text, "unknown-key")
    if columns and NUMBER not in columns:
        raise CommandError("--map has no column for the tool number; add number=COLUMN", "no-number-column")
    return columns


def _check_path(path: Path) -> None:
    """Raise CommandError if the file exists or has no folder."""
    if path.exists():
        text = Message("{file} already exists and will not be overwritten; use a different name", file=path)
        raise CommandError(text, "file-exists")
    if not path.parent.is_dir():
        raise CommandError(
            Message("{file} cannot be written: its folder does not exist", file=path), "no-folder"
        )


def _write(path: Path, text: str) -> None:
    from app.programs.atomic_files import FileOperationError, write_new_file

    with convert_to_command_error(FileOperationError):
        write_new_file(path, text.encode())


def _report(
    entries: Iterable[ToolEntry],
    exported: Iterable[ToolEntry],
    tools: Mapping[int, ToolOffsetRow],
    table_format: TableFormat,
    columns: Mapping[str, str],
) -> Iterator[str]:
    """Yield lines that list the exported tools and the values that the file does not contain."""
    names = [f"T{each.tool_number}" for each in exported]
    yield Message("exported: {names}", names=", ".join(names))
    fields = csv_table.list_written_fields(columns) if columns else table_format.exported_fields
    for each in entries:
        name = f"T{each.tool_number}"
        if name not in names:
            yield Message("{name} is not exported: this format has no such kind of tool", name=name)
            continue
        values = {**each.offset_values, **each.shape_values}
        lost = [TABLE_FIELDS[key].label for key, value in values.items() if value and key not in fields]
        row = tools.get(each.tool_number)
        if row is not None and (row.wear_x or row.wear_z):
            lost.append("wear")
        if lost:
            yield Message("{name}: not exported: {names}", name=name, names=", ".join(lost))
    if any(number not in OFFSET_NUMBERS for number in tools):
        yield Message("not exported: further cutting edges (D2 to D9)")
