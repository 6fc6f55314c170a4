"""Export of the store to plain text files in inches, for reading, moving or another control."""

from __future__ import annotations

import csv
import io
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from core.file_lock import unfinished_folder
from core.file_placing import folder_in_place
from core.input_file import MB, input_bytes
from core.message import Message
from core.store import program_records
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import Reason
from core.store.store import Store
from core.store.store_errors import Cause, StoreError, cause_of, said, why
from core.store.store_rows import FIELDS, EventRow, Field, Kind, Row, RunRow, Sort, Value, inches
from core.tool_edges import edge_of, tool_of

PROGRAMS, OFFSETS, EVENTS, RUNS = "programs", "offsets.toml", "events.csv", "runs.csv"
TABLES = {  # complete tables of measured parts and mills, in mm and seconds as stored
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
TABLE_OF = {Kind.MILL_TOOL: "mill_tools.csv", Kind.PRESET: "presets.csv"}
_ALL = 2**62
_LARGEST = 64 * MB  # limit for one table or program


def export(store: Store, folder: Path) -> int:
    """Write the newest version of every program and the other data; return the number of programs.

    The folder appears only when it is complete. Raises StoreError if the folder exists and is not empty, or
    cannot be written.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise StoreError(
                Message("{folder} is not empty; specify a new folder for the export", folder=folder),
                "folder-not-empty",
            )
        with unfinished_folder(folder) as scratch:
            unfinished = scratch / folder.name
            count = _write_all(store, unfinished)
            folder_in_place(unfinished, folder)
    except OSError as error:
        if cause_of(folder, error) is Cause.FULL:
            raise why(folder, error) from error
        raise StoreError(
            Message(
                "{target} cannot be written ({error}); check the folder, its free space and its permissions",
                target=folder,
                error=said(error),
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
    _write_table(folder / RUNS, _run_columns(), store.runs.read_records())
    with store.read() as connection:
        for name, table in TABLES.items():
            rows = connection.execute(f"SELECT * FROM {table}")
            _write_table(folder / name, (column[0] for column in rows.description), rows)
    return len(names)


def _file_name(name: object) -> str:
    """Return a program's file name. Raises StoreError if the name is invalid or leads out of the folder."""
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
    for code, zero in store.offsets.zero.read_rows().items():
        yield Message("[zero.{code}]  # mm and degrees", code=code)
        yield from (f"{name} = {value!r}" for name, value in zero._asdict().items())
    tools, shapes = store.offsets.tools.read_rows(), store.offsets.shapes.read_rows()
    for number in sorted({*tools, *shapes}):
        yield f"[tool.{_key(number)}]"
        if number in tools:
            yield from _entry_lines(Kind.TOOL, tools[number])
        if number in shapes:
            yield from _entry_lines(Kind.SHAPE, shapes[number])
    for number, row in store.offsets.secondary.read_rows().items():
        yield f"[secondary.{number}]"
        yield from _entry_lines(Kind.SECONDARY, row)


def _key(number: int) -> str:
    """Return the TOML key of a tool, such as 3, or of a further cutting edge, such as 3.d2."""
    return f"{number}" if number == tool_of(number) else f"{tool_of(number)}.d{edge_of(number)}"


def _entry_lines(kind: Kind, row: Row) -> Iterator[str]:
    for name, value in row._asdict().items():
        yield f"{name} = {_toml(FIELDS[kind][name], value)}"


def _toml(field: Field, value: Value) -> str:
    """Return an offset's value in TOML syntax, lengths in inches."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return str(value).lower()
    return repr(inches(value)) if field.sort is Sort.LENGTH else str(value)


def _run_columns() -> Iterator[str]:
    """Yield the columns of the run table, with ``_s`` appended to times in seconds."""
    for name in RunRow._fields:
        yield f"{name}_s" if name in {"best", "latest", "planned"} else name


def _write_table(path: Path, head: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
    """Write a CSV file for spreadsheets; unknown values are empty cells."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(head)
        table.writerows(rows)


def mill_rows(folder: Path) -> dict[Kind, dict[int, dict[str, Value]]]:
    """Return tools and presets of a mill from an exported folder, by number; missing fields are omitted.

    Raises StoreError if a table cannot be read.
    """
    return {kind: _rows(folder / TABLE_OF[kind], kind) for kind in TABLE_OF}


def _rows(path: Path, kind: Kind) -> dict[int, dict[str, Value]]:
    if not path.exists():
        return {}
    try:
        text = input_bytes(path, _LARGEST).decode("utf-8")
        table = list(csv.DictReader(io.StringIO(text, newline="")))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StoreError(
            Message("{path} cannot be read ({error}); export the data again", path=path, error=error),
            "unreadable-export",
        ) from error
    return dict(_numbered(path, line, row, kind) for line, row in enumerate(table, start=2))


def _numbered(path: Path, line: int, row: dict[str, str], kind: Kind) -> tuple[int, dict[str, Value]]:
    """Return the number and values of one row.

    Raises StoreError with the line number if the row is invalid.
    """
    try:
        fields = {each.column: each for each in FIELDS[kind].values()}
        values = {
            fields[column].name: text if fields[column].sort is Sort.TEXT else _number(fields[column], text)
            for column, text in row.items()
            if column in fields
        }
        return int(row["number"]), values
    except (KeyError, ValueError, TypeError) as error:
        text = Message(
            "{path} line {line}: {error}; each row must have a number and its values, as written "
            "by 'store export'",
            path=path,
            line=line,
            error=error,
        )
        raise StoreError(text, "unreadable-export") from error


def _number(field: Field, text: str) -> Value:
    return int(text) if field.sort in {Sort.WHOLE, Sort.FLAG} else float(text)


def program_files(folder: Path) -> dict[str, bytes]:
    """Return the programs of an exported folder by name. Raises StoreError if the folder is not an export."""
    try:
        return {path.name: input_bytes(path, _LARGEST) for path in sorted((folder / PROGRAMS).iterdir())}
    except OSError as error:
        raise StoreError(
            Message(
                "{folder} is not an exported folder ({error}); specify a folder that 'store export' created",
                folder=folder,
                error=said(error),
            ),
            "not-an-export",
        ) from error


def import_all(
    connection: sqlite3.Connection,
    programs: Mapping[str, bytes],
    offsets: Mapping[Kind, Mapping[int, Mapping[str, Value]]],
    reason: Reason,
) -> None:
    """Save programs by name and rows of offsets by number, within the caller's transaction.

    Raises StoreError if a name is invalid, or if a number or value is out of range.
    """
    for name, text in programs.items():
        program_records.save(connection, name, text, reason.why)
    for kind, rows in offsets.items():
        for number, values in rows.items():
            offset_tables.change(connection, kind, number, reason, values)
