"""Export of the store to plain text files in inches, for reading or transfer to another control."""

from __future__ import annotations

import csv
import io
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from core.file_lock import create_unfinished_folder
from core.file_replacement import move_folder_into_place
from core.input_file import BYTES_PER_MB, read_input_bytes
from core.message import Message
from core.store import program_records
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.store import Store
from core.store.store_errors import (
    StoreError,
    StoreErrorCause,
    find_store_error_cause,
    get_system_error_text,
    why,
)
from core.store.store_rows import (
    FIELDS_BY_KIND,
    EventRow,
    FieldType,
    FieldValue,
    OffsetKind,
    OffsetRow,
    RowField,
    RunRow,
    convert_to_inches,
)
from core.tool_edges import get_edge_number, get_tool_number

PROGRAMS, OFFSETS, EVENTS, RUNS = "programs", "offsets.toml", "events.csv", "runs.csv"
TABLES_BY_FILE_NAME = {  # complete tables of measured parts and mills, in mm and seconds as stored
    "features.csv": "part_features",
    "readings.csv": "part_readings",
    "cycles.csv": "part_cycles",
    "stops.csv": "production_stops",
    "tool_lives.csv": "tool_lives",
    "insert_changes.csv": "insert_changes",
    "mill_tool_lives.csv": "mill_tool_lives",
    "mill_tools.csv": "mill_tools",
    "presets.csv": "datum_presets",
}
MILL_FILE_NAMES = {OffsetKind.MILL_TOOL: "mill_tools.csv", OffsetKind.PRESET: "presets.csv"}
_ALL = 2**62
_MAX_FILE_BYTES = 64 * BYTES_PER_MB  # limit for one table or program


def export_store(store: Store, folder: Path) -> int:
    """Write the newest version of every program and the other data, and return the number of programs.

    The folder appears only when it is complete. Raises StoreError if the folder exists and is not empty, or
    cannot be written. Also raises StoreError if the name of a program is invalid, or if its newest version
    does not match its checksum.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise StoreError(
                Message("{folder} is not empty; specify a new folder for the export", folder=folder),
                "folder-not-empty",
            )
        with create_unfinished_folder(folder) as scratch:
            unfinished = scratch / folder.name
            count = _write_all(store, unfinished)
            move_folder_into_place(unfinished, folder)
    except OSError as error:
        if find_store_error_cause(folder, error) is StoreErrorCause.FULL:
            raise why(folder, error) from error
        raise StoreError(
            Message(
                "{target} cannot be written ({error}); check the folder, its free space and its permissions",
                target=folder,
                error=get_system_error_text(error),
            ),
            "cannot-write",
        ) from error
    return count


def _write_all(store: Store, folder: Path) -> int:
    (folder / PROGRAMS).mkdir(parents=True)
    names = [row.name for row in store.programs.list_programs()]
    for name in names:
        (folder / PROGRAMS / _file_name(name)).write_bytes(store.programs.load_version(name))
    (folder / OFFSETS).write_text("\n".join(_offset_lines(store)) + "\n", encoding="utf-8")
    _write_table(folder / EVENTS, EventRow._fields, reversed(store.events.read_events(limit=_ALL)))
    _write_table(folder / RUNS, _run_columns(), store.runs.read_run_records())
    with store.read() as connection:
        for name, table in TABLES_BY_FILE_NAME.items():
            rows = connection.execute(f"SELECT * FROM {table}")
            _write_table(folder / name, (column[0] for column in rows.description), rows)
    return len(names)


def _file_name(name: object) -> str:
    """Return the file name of a program.

    Raises StoreError if the name is invalid or leads outside the folder.
    """
    if isinstance(name, str) and name and Path(name).name == name and "\0" not in name:
        return name
    raise StoreError(
        Message(
            "the data store has a program with the invalid name {name}; restore a backup", name=f"{name!r}"
        ),
        "invalid-name",
    )


def _offset_lines(store: Store) -> Iterator[str]:
    yield "# Offsets in inches; X is a radius."
    for code, zero in store.offsets.zero_offsets.read_rows().items():
        yield Message("[zero.{code}]  # mm and degrees", code=code)
        yield from (f"{name} = {value!r}" for name, value in zero._asdict().items())
    tools, shapes = store.offsets.tool_offsets.read_rows(), store.offsets.tool_shapes.read_rows()
    for number in sorted({*tools, *shapes}):
        yield f"[tool.{_key(number)}]"
        if number in tools:
            yield from _entry_lines(OffsetKind.TOOL, tools[number])
        if number in shapes:
            yield from _entry_lines(OffsetKind.SHAPE, shapes[number])
    for number, row in store.offsets.secondary_offsets.read_rows().items():
        yield f"[secondary.{number}]"
        yield from _entry_lines(OffsetKind.SECONDARY, row)


def _key(number: int) -> str:
    """Return the TOML key of a tool, such as 3, or of an additional cutting edge, such as 3.d2."""
    return (
        f"{number}"
        if number == get_tool_number(number)
        else f"{get_tool_number(number)}.d{get_edge_number(number)}"
    )


def _entry_lines(kind: OffsetKind, row: OffsetRow) -> Iterator[str]:
    for name, value in row._asdict().items():
        yield f"{name} = {_toml(FIELDS_BY_KIND[kind][name], value)}"


def _toml(field: RowField, value: FieldValue) -> str:
    """Return an offset value in TOML syntax, with lengths in inches."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return str(value).lower()
    return repr(convert_to_inches(value)) if field.field_type is FieldType.LENGTH else str(value)


def _run_columns() -> Iterator[str]:
    """Yield the column names of the run table, with the suffix ``_s`` for times in seconds."""
    for name in RunRow._fields:
        yield f"{name}_s" if name in {"best", "latest", "planned"} else name


def _write_table(path: Path, head: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
    """Write a CSV file for spreadsheets, with empty cells for unknown values."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(head)
        table.writerows(rows)


def read_exported_mill_rows(folder: Path) -> dict[OffsetKind, dict[int, dict[str, FieldValue]]]:
    """Return the tools and presets of a mill from an exported folder, by number.

    Fields without a column are omitted. Raises StoreError if a table cannot be read, or if a row is
    incomplete.
    """
    return {kind: _rows(folder / MILL_FILE_NAMES[kind], kind) for kind in MILL_FILE_NAMES}


def _rows(path: Path, kind: OffsetKind) -> dict[int, dict[str, FieldValue]]:
    if not path.exists():
        return {}
    try:
        text = read_input_bytes(path, _MAX_FILE_BYTES).decode("utf-8")
        table = list(csv.DictReader(io.StringIO(text, newline="")))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StoreError(
            Message("{path} cannot be read ({error}); export the data again", path=path, error=error),
            "unreadable-export",
        ) from error
    return dict(_numbered(path, line, row, kind) for line, row in enumerate(table, start=2))


def _numbered(
    path: Path, line: int, row: dict[str, str | None], kind: OffsetKind
) -> tuple[int, dict[str, FieldValue]]:
    """Return the number and the values of one row.

    Raises StoreError with the line number if the row is invalid.
    """
    try:
        cells = _get_complete_cells(row)
        fields = {each.column: each for each in FIELDS_BY_KIND[kind].values()}
        values = {
            fields[column].name: text
            if fields[column].field_type is FieldType.TEXT
            else _number(fields[column], text)
            for column, text in cells.items()
            if column in fields
        }
        return int(cells["number"]), values
    except (KeyError, ValueError) as error:
        text = Message(
            "{path} line {line}: {error}; each row must have a number and its values, as written "
            "by 'store export'",
            path=path,
            line=line,
            error=error,
        )
        raise StoreError(text, "unreadable-export") from error


def _get_complete_cells(row: Mapping[str, str | None]) -> dict[str, str]:
    """Return the cells of a CSV row by column.

    Raises ValueError if the row has too few or too many cells.
    """
    cells = {column: text for column, text in row.items() if column is not None and text is not None}
    if len(cells) < len(row):
        raise ValueError(Message("the row does not have one cell for each column"))
    return cells


def _number(field: RowField, text: str) -> FieldValue:
    return int(text) if field.field_type in {FieldType.INTEGER, FieldType.BOOLEAN} else float(text)


def read_exported_programs(folder: Path) -> dict[str, bytes]:
    """Return the programs of an exported folder by name.

    Raises StoreError if the folder is not an export, or if a program cannot be read or is larger than 64
    MB.
    """
    try:
        return {
            path.name: read_input_bytes(path, _MAX_FILE_BYTES)
            for path in sorted((folder / PROGRAMS).iterdir())
        }
    except OSError as error:
        raise StoreError(
            Message(
                "{folder} is not an exported folder ({error}); specify a folder that 'store export' created",
                folder=folder,
                error=get_system_error_text(error),
            ),
            "not-an-export",
        ) from error


def import_programs_and_offsets(
    connection: sqlite3.Connection,
    programs: Mapping[str, bytes],
    offsets: Mapping[OffsetKind, Mapping[int, Mapping[str, FieldValue]]],
    reason: ChangeReason,
) -> None:
    """Save programs by name and offset rows by number, within the caller's transaction.

    Raises StoreError if a program name is invalid, if a number or value is out of range, or for another
    reason listed in ``change_row``.
    """
    for name, text in programs.items():
        program_records.save_program_version(connection, name, text, reason.text)
    for kind, rows in offsets.items():
        for number, values in rows.items():
            offset_tables.change_row(connection, kind, number, reason, values)
