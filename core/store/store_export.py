"""The store as plain files that any editor reads, in inches: for looking, for moving, for another control."""

from __future__ import annotations

import csv
import json
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from core.store.offset_fields import Field, Sort
from core.store.store import Store
from core.store.store_errors import Cause, StoreError, cause_of, why
from core.store.store_rows import FIELDS, EventRow, Kind, Row, RunRow, Value, inches

PROGRAMS, OFFSETS, EVENTS, RUNS = "programs", "offsets.toml", "events.csv", "runs.csv"
TABLES = {  # of measured parts: whole tables, mm and seconds as the store has them
    "features.csv": "part_features",
    "readings.csv": "part_readings",
    "cycles.csv": "part_cycles",
    "stops.csv": "production_stops",
    "tool_lives.csv": "tool_lives",
    "insert_changes.csv": "insert_changes",
}
_ALL = 2**62


def export(store: Store, folder: Path) -> int:
    """Writes the newest version of every program, and all that is kept besides; answers how many programs.

    The folder appears when all of it is written. Raises StoreError when it is there already and not empty.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise StoreError(f"{folder} is not empty; name a new folder for the export")
        with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.parent) as scratch:
            unfinished = Path(scratch, folder.name)
            count = _write_all(store, unfinished)
            unfinished.replace(folder)
    except OSError as error:
        if cause_of(folder, error) is Cause.FULL:
            raise why(folder, error) from error
        raise StoreError(
            f"{folder} cannot be written ({error}); check the folder, its space and rights"
        ) from error
    return count


def _write_all(store: Store, folder: Path) -> int:
    (folder / PROGRAMS).mkdir(parents=True)
    names = [row.name for row in store.programs()]
    for name in names:
        (folder / PROGRAMS / name).write_bytes(store.load_program(name))
    (folder / OFFSETS).write_text("\n".join(_offset_lines(store)) + "\n", encoding="utf-8")
    _write_table(folder / EVENTS, EventRow._fields, reversed(store.events(limit=_ALL)))
    _write_table(folder / RUNS, _run_columns(), store.runs())
    with store.read() as connection:
        for name, table in TABLES.items():
            rows = connection.execute(f"SELECT * FROM {table}")
            _write_table(folder / name, (column[0] for column in rows.description), rows)
    return len(names)


def _offset_lines(store: Store) -> Iterator[str]:
    yield "# Offsets in inches, X a radius."
    for code, zero in store.zero_offsets().items():
        yield f"[zero.{code}]  # mm and degrees"
        yield from (f"{name} = {value!r}" for name, value in zero._asdict().items())
    tools, shapes = store.tools(), store.shapes()
    for number in sorted({*tools, *shapes}):
        yield f"[tool.{number}]"
        if number in tools:
            yield from _entry_lines(Kind.TOOL, tools[number])
        if number in shapes:
            yield from _entry_lines(Kind.SHAPE, shapes[number])
    for number, row in store.secondary().items():
        yield f"[secondary.{number}]"
        yield from _entry_lines(Kind.SECONDARY, row)


def _entry_lines(kind: Kind, row: Row) -> Iterator[str]:
    for name, value in row._asdict().items():
        yield f"{name} = {_toml(FIELDS[kind][name], value)}"


def _toml(field: Field, value: Value) -> str:
    """A value of an offset as TOML writes it."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return str(value).lower()
    return repr(inches(value)) if field.sort is Sort.LENGTH else str(value)


def _run_columns() -> Iterator[str]:
    """Times say that they are seconds."""
    for name in RunRow._fields:
        yield f"{name}_s" if name in {"best", "latest", "planned"} else name


def _write_table(path: Path, head: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
    """For spreadsheets; what is not known is an empty cell."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(head)
        table.writerows(rows)


def program_files(folder: Path) -> dict[str, bytes]:
    """The programs of an exported folder by name. Raises StoreError when it is no such folder."""
    try:
        return {path.name: path.read_bytes() for path in sorted((folder / PROGRAMS).iterdir())}
    except OSError as error:
        raise StoreError(
            f"{folder} is no exported folder ({error}); name one that 'store export' wrote"
        ) from error
