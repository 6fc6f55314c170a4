"""Tables of the tool, secondary and zero offsets, the tool shapes and the presets, with their history.

All tables have the same structure: rows by number, and a history of steps. A step contains all changes of one
entry. Undoing a step adds another step to the history.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from core.message import Message
from core.store import row_sums
from core.store.store_errors import StoreError
from core.store.store_rows import (
    FIELDS,
    MILL_TOOLS,
    OFFSETS,
    PRESETS,
    TOOL_ROWS,
    ZERO_CODES,
    Change,
    Field,
    Kind,
    MillRow,
    PresetRow,
    Row,
    RowT,
    SecondaryRow,
    ShapeRow,
    Sort,
    ToolRow,
    Value,
    ZeroRow,
    inches,
    utc_now,
)
from core.tool_edges import edge_name, tool_of

Changes = Mapping[int, tuple[Row | None, Row | None]]
_NO_SHAPE = "no tool shape change to undo"
MOST_STEPS = 2**62  # the largest integer of SQLite is about twice this value


class Reason(NamedTuple):
    """The reason for a change of an offset, and the user or function that makes the change."""

    why: str
    who: str


@dataclass(frozen=True, slots=True)
class Log:
    """A history table, with the column of the row's number and the columns of a row.

    The columns occur twice, with the values before and after a change.
    """

    name: str
    key: str
    columns: tuple[str, ...]
    kind: str  # SQL expression for the kind of a row
    nothing_left: str

    @property
    def sides(self) -> list[str]:
        return [f"{side}_{column}" for side in ("old", "new") for column in self.columns]


@dataclass(frozen=True, slots=True)
class _Table:
    """A table of offsets: its name, letter, valid numbers, row type and history."""

    name: str
    letter: str
    numbers: Container[int]
    row: type[Row]
    log: Log


def _columns(kind: Kind) -> tuple[str, ...]:
    return tuple(field.column for field in FIELDS[kind].values())


# Tool offsets and secondary offsets share one history. The columns of a secondary offset are the first
# columns of a tool offset.
_OFFSET_LOG = Log("offset_changes", "number", _columns(Kind.TOOL), "kind", "no offset change to undo")
_ZEROS = Log("zero_offset_changes", "code", _columns(Kind.ZERO), "'zero'", "no G54…G59 change to undo")
_SHAPES = Log("tool_shape_changes", "number", _columns(Kind.SHAPE), "'shape'", _NO_SHAPE)
_MILL_TOOLS = Log(
    "mill_tool_changes",
    "number",
    _columns(Kind.MILL_TOOL),
    "'mill tool'",
    "no tool data change to undo",
)
_PRESETS = Log(
    "datum_preset_changes",
    "number",
    _columns(Kind.PRESET),
    "'preset'",
    "no preset change to undo",
)
LOGS = (_OFFSET_LOG, _ZEROS, _SHAPES, _MILL_TOOLS, _PRESETS)
TABLES = {
    Kind.TOOL: _Table("tool_offsets", "T", TOOL_ROWS, ToolRow, _OFFSET_LOG),
    Kind.SECONDARY: _Table("secondary_offsets", "D", OFFSETS, SecondaryRow, _OFFSET_LOG),
    Kind.ZERO: _Table("zero_offsets", "G", ZERO_CODES, ZeroRow, _ZEROS),
    Kind.SHAPE: _Table("tool_shapes", "T", TOOL_ROWS, ShapeRow, _SHAPES),
    Kind.MILL_TOOL: _Table("mill_tools", "T", MILL_TOOLS, MillRow, _MILL_TOOLS),
    Kind.PRESET: _Table("datum_presets", "PRESET ", PRESETS, PresetRow, _PRESETS),
}


def current(connection: sqlite3.Connection, kind: Kind) -> dict[int, Row]:
    """Return the rows of a table that have been set, by number. Damaged rows are omitted."""
    table = TABLES[kind]
    columns = ", ".join((table.log.key, *_columns(kind)))
    rows = row_sums.raw(connection, f"SELECT {columns} FROM {table.name} ORDER BY {table.log.key}")
    broken = row_sums.broken(connection, table.name)
    return {
        number: _row(kind, row_sums.readable(values))
        for number, *values in rows
        if isinstance(number, int) and number not in broken
    }


def rows_of(connection: sqlite3.Connection, kind: Kind, row: type[RowT]) -> dict[int, RowT]:
    """Return the rows of a table that have the type ``row``, by number. Damaged rows are omitted."""
    return {number: each for number, each in current(connection, kind).items() if isinstance(each, row)}


def tools(connection: sqlite3.Connection) -> dict[int, ToolRow]:
    """Return the tool offsets that have been set, by number."""
    return rows_of(connection, Kind.TOOL, ToolRow)


def change(
    connection: sqlite3.Connection, kind: Kind, number: int, reason: Reason, wanted: Mapping[str, Value]
) -> Row:
    """Set the fields in ``wanted``, leave the other fields, and return the new row.

    If a tool becomes the master tool, the previous master tool is cleared. Raises StoreError for an unknown
    number and for a value that the store does not accept.
    """
    check_number(kind, number)
    rows = current(connection, kind)
    old = rows.get(number)
    _check_edge(kind, number, rows, wanted)
    if old is None and wanted.get("master") and not {"x", "z"} <= wanted.keys():
        raise StoreError(never_set(number), "never-set")
    new = changed(kind, number, old, wanted)
    if isinstance(new, ShapeRow) and not new.kind:
        raise StoreError(
            Message(
                "{number} does not have a tool shape yet; enter the tool type first: {range}",
                number=edge_name(number),
                range=FIELDS[kind]["kind"].range,
            ),
            "no-shape",
        )
    if new != old:
        changes: dict[int, tuple[Row | None, Row | None]] = {number: (old, new)}
        if isinstance(new, ToolRow) and new.master:
            changes |= {n: (row, row._replace(master=False)) for n, row in _other_masters(rows, number)}
        apply(connection, kind, changes, reason)
    return new


def change_rows(
    connection: sqlite3.Connection,
    wanted: Mapping[Kind, Mapping[int, Mapping[str, Value]]],
    reason: Reason,
) -> int:
    """Set the fields of several rows, by table and number, as one step; return the number of changed rows.

    Raises StoreError for an unknown number and for a value that the store does not accept. Nothing is then
    changed. The master tool cannot be changed with this function.
    """
    pairs: dict[Kind, Changes] = {}
    for kind, values in wanted.items():
        rows = current(connection, kind)
        for number in values:
            check_number(kind, number)
        new = {n: changed(kind, n, rows.get(n), fields) for n, fields in values.items()}
        pairs[kind] = {n: (rows.get(n), row) for n, row in new.items() if row != rows.get(n)}
    step = _next_step(connection)
    for kind, changes in pairs.items():
        if changes:
            apply(connection, kind, changes, reason, step=step)
    return sum(map(len, pairs.values()))


def _check_edge(kind: Kind, number: int, rows: Mapping[int, Row], wanted: Mapping[str, Value]) -> None:
    """Raise StoreError if a cutting edge has no tool yet, or is to become the master tool."""
    if kind is not Kind.TOOL or tool_of(number) == number:
        return
    if tool_of(number) not in rows:
        raise StoreError(
            Message(
                "the offset of {number} has never been set; set cutting edge D1 of this tool "
                "before {number2}",
                number=edge_name(tool_of(number)),
                number2=edge_name(number),
            ),
            "never-set",
        )
    if wanted.get("master"):
        raise StoreError(
            Message(
                "{number} is an additional cutting edge; set cutting edge D1 of this tool as the master",
                number=edge_name(number),
            ),
            "not-first-edge",
        )


def _other_masters(rows: Mapping[int, Row], number: int) -> list[tuple[int, ToolRow]]:
    return [(n, row) for n, row in rows.items() if n != number and isinstance(row, ToolRow) and row.master]


def never_set(number: int) -> str:
    """Return the message that a tool without an offset cannot be the master tool."""
    return Message(
        "the offset of {number} has never been set, so the offsets of other tools "
        "cannot be relative to this tool; touch off this tool first",
        number=edge_name(number),
    )


def check_number(kind: Kind, number: int) -> None:
    """Raise StoreError if no offset of this kind has the number."""
    table = TABLES[kind]
    if number in table.numbers:
        return
    if kind is Kind.ZERO:
        raise StoreError(
            Message("G{number} does not exist; settable offsets are G54…G59", number=number), "unknown-number"
        )
    if kind in {Kind.MILL_TOOL, Kind.PRESET}:
        last = MILL_TOOLS[-1] if kind is Kind.MILL_TOOL else PRESETS[-1]
        raise StoreError(
            Message(
                "{letter}{number} does not exist; use 1 to {last}",
                letter=table.letter,
                number=number,
                last=last,
            ),
            "unknown-number",
        )
    raise StoreError(
        Message(
            "{letter}{number} does not exist; offsets are {letter2}1…32",
            letter=table.letter,
            number=number,
            letter2=table.letter,
        ),
        "unknown-number",
    )


def changed(kind: Kind, number: int, old: Row | None, wanted: Mapping[str, Value]) -> Row:
    """Return the row with the fields in ``wanted`` replaced. Raises StoreError if a value is out of range."""
    fields, table = FIELDS[kind], TABLES[kind]
    for name, value in wanted.items():
        field = fields.get(name)
        if field is None or not field.takes(value):
            word, shown = (field.word, _told(field, value)) if field else (name, value)
            whose = edge_name(number) if table.letter == "T" else f"{table.letter}{number}"
            told = Message("{whose} {word} {value}", whose=whose, word=word, value=shown)
            accepted = field.range if field else ", ".join(fields)
            raise StoreError(
                Message("{details} is out of range; enter {accepted}", details=told, accepted=accepted),
                "out-of-range",
            )
    before = old or table.row()
    return _row(kind, [wanted.get(name, getattr(before, name)) for name in fields])


def _told(field: Field, value: Value) -> str:
    if isinstance(value, str):
        return repr(value)
    return Message("{mm} in", mm=f"{inches(value):g}") if field.sort is Sort.LENGTH else f"{value:g}"


def _row(kind: Kind, values: Sequence[Value | None]) -> Row:
    """Return a row made from its columns. NULL columns, from older versions, get zero or empty values."""
    whole = [_plain(field, value) for field, value in zip(FIELDS[kind].values(), values, strict=True)]
    return TABLES[kind].row._make(whole)


def _plain(field: Field, value: Value | None) -> Value:
    if field.sort is Sort.TEXT:
        return str(value or "")
    if field.sort is Sort.FLAG:
        return bool(value)
    return int(value or 0) if field.sort is Sort.WHOLE else float(value or 0.0)


def remove(connection: sqlite3.Connection, kind: Kind, number: int, reason: Reason) -> bool:
    """Remove one offset or shape as one step; return whether it was set.

    Raises StoreError if the tool still has other cutting edges.
    """
    check_number(kind, number)
    rows = current(connection, kind)
    old = rows.get(number)
    edges = [edge_name(n) for n in rows if kind is Kind.TOOL and n != number and tool_of(n) == number]
    if edges:
        raise StoreError(
            Message(
                "{number} has other cutting edges; clear {edges} first",
                number=edge_name(number),
                edges=", ".join(edges),
            ),
            "has-further-edges",
        )
    if old is not None:
        apply(connection, kind, {number: (old, None)}, reason)
    return old is not None


def clear(connection: sqlite3.Connection, kind: Kind, reason: Reason) -> int:
    """Remove all rows of a table as one step; return the number of rows removed."""
    rows = current(connection, kind)
    if rows:
        apply(connection, kind, {number: (old, None) for number, old in rows.items()}, reason)
    return len(rows)


def apply(
    connection: sqlite3.Connection,
    kind: Kind,
    changes: Changes,
    reason: Reason,
    undoes: int | None = None,
    step: int | None = None,
) -> tuple[Change, ...]:
    """Write changes and their history as one step; return the step's history entries.

    ``step`` is the number of a step that also changes another table; None begins a new step.
    """
    table, log = TABLES[kind], TABLES[kind].log
    step = _next_step(connection) if step is None else step
    at, columns = utc_now(), _columns(kind)
    # All old rows are deleted first, so that the table never has two master tools.
    connection.executemany(f"DELETE FROM {table.name} WHERE {log.key} = ?", [(number,) for number in changes])
    _insert(
        connection,
        table.name,
        [log.key, *columns],
        [(number, *new) for number, (_old, new) in changes.items() if new is not None],
    )
    told = {"kind": kind.value} if log.kind == "kind" else {}
    sides = [f"{side}_{column}" for side in ("old", "new") for column in columns]
    nothing = (None,) * len(columns)
    _insert(
        connection,
        log.name,
        ["step", "undoes", "at", *told, log.key, "why", "who", *sides],
        [
            (step, undoes, at, *told.values(), number, *reason, *(old or nothing), *(new or nothing))
            for number, (old, new) in changes.items()
        ],
    )
    return select(connection, log, "WHERE step = ? ORDER BY id", (step,))


def _insert(
    connection: sqlite3.Connection, table: str, columns: list[str], rows: list[tuple[object, ...]]
) -> None:
    marks = ", ".join("?" * len(columns))
    connection.executemany(f"INSERT INTO {table} ({', '.join(columns)}) VALUES ({marks})", rows)


def _next_step(connection: sqlite3.Connection) -> int:
    """Return the next step number over all histories.

    A changed clock cannot reorder the steps, because their order follows these numbers.
    """
    return 1 + max(_newest_step(connection, log) for log in LOGS)


def _newest_step(connection: sqlite3.Connection, log: Log) -> int:
    """Return the latest valid step number of a history, ignoring invalid values.

    Invalid values can only come from another program or from damage.
    """
    asked = f"SELECT coalesce(max(step), 0) FROM {log.name}"
    (last,) = connection.execute(asked).fetchone()
    if not isinstance(last, int) or last >= MOST_STEPS:
        # a scan of the whole table, needed only for an invalid value
        only = "WHERE typeof(step) = 'integer' AND step < ?"
        (last,) = connection.execute(f"{asked} {only}", (MOST_STEPS,)).fetchone()
    return int(last)


def select(
    connection: sqlite3.Connection, log: Log, tail: str, values: tuple[int | str, ...]
) -> tuple[Change, ...]:
    rows = connection.execute(
        f"SELECT id, step, undoes, at, {log.kind}, {log.key}, why, who, {', '.join(log.sides)}"
        f" FROM {log.name} {tail}",
        values,
    )
    found = rows.fetchall()
    if found:
        broken = row_sums.broken(connection, log.name, min(row[0] for row in found))
        for entry in [row[0] for row in found if row[0] in broken]:
            raise damaged_entry(entry)
    return tuple(_change(log, row) for row in found)


def damaged_entry(entry: object) -> StoreError:
    return StoreError(
        Message(
            "entry {entry} of the offset history is damaged; the offsets themselves are verified "
            "by separate checksums. Restore a backup to recover the history",
            entry=entry,
        ),
        "damaged-history",
    )


def _change(log: Log, row: Sequence[Any]) -> Change:
    """Return a history row as a change. Raises StoreError if the row contains invalid values."""
    half, (i, step, undoes, at, kind, number, why, who, *both) = len(log.columns), row
    try:
        old, new = _side(kind, both[:half]), _side(kind, both[half:])
        return Change(i, step, undoes, at, Kind(kind), number, old, new, why, who)
    except (ValueError, TypeError, OverflowError) as error:
        raise damaged_entry(i) from error


def _side(kind: str, values: list[Value | None]) -> Row | None:
    """Return the row before or after a change; None if the offset was not set."""
    if values[0] is None:
        return None
    return _row(Kind(kind), values[: len(FIELDS[Kind(kind)])])
