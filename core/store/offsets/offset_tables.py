"""Tables of the tool, secondary and zero offsets, the tool shapes and the presets, with their history.

All tables have the same structure: rows by number, and a history of steps. A step contains all changes of
one entry by the operator. Undoing a step adds another step to the history.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from core.message import Message
from core.store import row_checksums
from core.store.store_errors import StoreError
from core.store.store_rows import (
    FIELDS_BY_KIND,
    MILL_TOOL_NUMBERS,
    OFFSET_NUMBERS,
    PRESET_NUMBERS,
    TOOL_ROW_NUMBERS,
    ZERO_CODES,
    FieldType,
    FieldValue,
    MillToolRow,
    OffsetChange,
    OffsetKind,
    OffsetRow,
    PresetRow,
    RowField,
    RowT,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
    convert_to_inches,
    get_utc_now_text,
)
from core.tool_edges import format_edge_name, get_tool_number

ChangesByNumber = Mapping[int, tuple[OffsetRow | None, OffsetRow | None]]
_NO_SHAPE = "no tool shape change to undo"
MAX_STEP_NUMBER = 2**62  # the largest integer of SQLite is about twice this value


class ChangeReason(NamedTuple):
    """The reason for a change of an offset, and the user or function that makes the change."""

    text: str
    author: str


@dataclass(frozen=True, slots=True)
class HistoryTable:
    """The definition of a history table: its row-number column and the columns of an offset row.

    Each column of an offset row occurs twice, with the values before and after a change.
    """

    name: str
    key_column: str
    value_columns: tuple[str, ...]
    kind_sql_expression: str  # SQL expression for the kind of a row
    nothing_to_undo_message: str

    @property
    def old_and_new_columns(self) -> list[str]:
        """Return the names of the value columns before a change, and then after a change."""
        return [f"{side}_{column}" for side in ("old", "new") for column in self.value_columns]


@dataclass(frozen=True, slots=True)
class _OffsetTableSchema:
    """Schema of an offset table: its name, letter, valid row numbers, row type and history table."""

    name: str
    letter: str
    valid_numbers: Container[int]
    row_type: type[OffsetRow]
    history_table: HistoryTable


def _columns(kind: OffsetKind) -> tuple[str, ...]:
    return tuple(field.column for field in FIELDS_BY_KIND[kind].values())


# Tool offsets and secondary offsets share one history. The columns of a secondary offset are the first
# columns of a tool offset.
_OFFSET_LOG = HistoryTable(
    "offset_changes", "number", _columns(OffsetKind.TOOL), "kind", "no offset change to undo"
)
_ZEROS = HistoryTable(
    "zero_offset_changes", "code", _columns(OffsetKind.ZERO), "'zero'", "no G54…G59 change to undo"
)
_SHAPES = HistoryTable("tool_shape_changes", "number", _columns(OffsetKind.SHAPE), "'shape'", _NO_SHAPE)
_MILL_TOOLS = HistoryTable(
    "mill_tool_changes",
    "number",
    _columns(OffsetKind.MILL_TOOL),
    "'mill tool'",
    "no tool data change to undo",
)
_PRESETS = HistoryTable(
    "datum_preset_changes",
    "number",
    _columns(OffsetKind.PRESET),
    "'preset'",
    "no preset change to undo",
)
HISTORY_TABLES = (_OFFSET_LOG, _ZEROS, _SHAPES, _MILL_TOOLS, _PRESETS)
OFFSET_TABLES = {
    OffsetKind.TOOL: _OffsetTableSchema("tool_offsets", "T", TOOL_ROW_NUMBERS, ToolOffsetRow, _OFFSET_LOG),
    OffsetKind.SECONDARY: _OffsetTableSchema(
        "secondary_offsets", "D", OFFSET_NUMBERS, SecondaryOffsetRow, _OFFSET_LOG
    ),
    OffsetKind.ZERO: _OffsetTableSchema("zero_offsets", "G", ZERO_CODES, ZeroOffsetRow, _ZEROS),
    OffsetKind.SHAPE: _OffsetTableSchema("tool_shapes", "T", TOOL_ROW_NUMBERS, ToolShapeRow, _SHAPES),
    OffsetKind.MILL_TOOL: _OffsetTableSchema("mill_tools", "T", MILL_TOOL_NUMBERS, MillToolRow, _MILL_TOOLS),
    OffsetKind.PRESET: _OffsetTableSchema("datum_presets", "PRESET ", PRESET_NUMBERS, PresetRow, _PRESETS),
}


def read_current_rows(connection: sqlite3.Connection, kind: OffsetKind) -> dict[int, OffsetRow]:
    """Return the rows of a table that have been set, by number. Damaged rows are omitted."""
    table = OFFSET_TABLES[kind]
    columns = ", ".join((table.history_table.key_column, *_columns(kind)))
    rows = row_checksums.query_raw_rows(
        connection, f"SELECT {columns} FROM {table.name} ORDER BY {table.history_table.key_column}"
    )
    broken = row_checksums.find_broken_rows(connection, table.name)
    return {
        number: _row(kind, row_checksums.decode_values(values))
        for number, *values in rows
        if isinstance(number, int) and number not in broken
    }


def read_typed_rows(connection: sqlite3.Connection, kind: OffsetKind, row: type[RowT]) -> dict[int, RowT]:
    """Return the rows of a table that have the type ``row``, by number. Damaged rows are omitted."""
    return {
        number: each for number, each in read_current_rows(connection, kind).items() if isinstance(each, row)
    }


def read_tool_offsets(connection: sqlite3.Connection) -> dict[int, ToolOffsetRow]:
    """Return the tool offsets that have been set, by number."""
    return read_typed_rows(connection, OffsetKind.TOOL, ToolOffsetRow)


def change_row(
    connection: sqlite3.Connection,
    kind: OffsetKind,
    number: int,
    reason: ChangeReason,
    new_values: Mapping[str, FieldValue],
) -> OffsetRow:
    """Set the fields in ``new_values``, leave the other fields unchanged, and return the new row.

    If a tool becomes the master tool, the previous master tool is cleared. Raises StoreError for an unknown
    number or field and for a value that the store does not accept. Also raises StoreError for an additional
    cutting edge whose tool has no offset yet or that would become the master tool, for a master tool
    without an offset, and for a tool shape without a tool type.
    """
    rows = read_current_rows(connection, kind)
    new_rows = _make_new_rows(kind, rows, {number: new_values})
    changes = _find_differences(rows, new_rows)
    if changes:
        apply_changes(connection, kind, changes, reason)
    return new_rows[number]


def change_rows(
    connection: sqlite3.Connection,
    new_values: Mapping[OffsetKind, Mapping[int, Mapping[str, FieldValue]]],
    reason: ChangeReason,
) -> int:
    """Set the fields of several rows as one step, and return the number of changed rows.

    ``new_values`` contains the new values by table and number. The rules and the StoreError are those of
    ``change_row``; a cutting edge and its tool may be set in the same step. An error changes nothing.
    """
    changes: dict[OffsetKind, ChangesByNumber] = {}
    for kind, values in new_values.items():
        rows = read_current_rows(connection, kind)
        changes[kind] = _find_differences(rows, _make_new_rows(kind, rows, values))
    step = _next_step(connection)
    for kind, changed in changes.items():
        if changed:
            apply_changes(connection, kind, changed, reason, step=step)
    return sum(map(len, changes.values()))


def _make_new_rows(
    kind: OffsetKind, rows: Mapping[int, OffsetRow], new_values: Mapping[int, Mapping[str, FieldValue]]
) -> dict[int, OffsetRow]:
    """Return all rows of a table with the new values. Raises StoreError as ``change_row`` does."""
    new_rows = dict(rows)
    for number, values in new_values.items():
        check_row_number(kind, number)
        check_edge(kind, number, rows.keys() | new_values.keys(), values)
        if number not in rows and values.get("master") and not {"x", "z"} <= values.keys():
            raise StoreError(make_no_offset_message(number), "never-set")
        new = new_rows[number] = apply_field_changes(kind, number, new_rows.get(number), values)
        if isinstance(new, ToolShapeRow) and not new.kind:
            text = Message(
                "{number} does not have a tool shape yet; enter the tool type first: {range}",
                number=format_edge_name(number),
                range=FIELDS_BY_KIND[kind]["kind"].range_text,
            )
            raise StoreError(text, "no-shape")
        if isinstance(new, ToolOffsetRow) and new.master:
            new_rows |= {n: row._replace(master=False) for n, row in _other_masters(new_rows, number)}
    return new_rows


def _find_differences(rows: Mapping[int, OffsetRow], new_rows: Mapping[int, OffsetRow]) -> ChangesByNumber:
    return {n: (rows.get(n), row) for n, row in new_rows.items() if row != rows.get(n)}


def check_edge(
    kind: OffsetKind, number: int, rows: Container[int], new_values: Mapping[str, FieldValue]
) -> None:
    """Raise StoreError if an additional cutting edge has no tool yet, or would become the master tool."""
    if kind is not OffsetKind.TOOL or get_tool_number(number) == number:
        return
    if get_tool_number(number) not in rows:
        raise StoreError(
            Message(
                "the offset of {number} has never been set; set cutting edge D1 of this tool "
                "before {number2}",
                number=format_edge_name(get_tool_number(number)),
                number2=format_edge_name(number),
            ),
            "never-set",
        )
    if new_values.get("master"):
        raise StoreError(
            Message(
                "{number} is an additional cutting edge; set cutting edge D1 of this tool as the master",
                number=format_edge_name(number),
            ),
            "not-first-edge",
        )


def _other_masters(rows: Mapping[int, OffsetRow], number: int) -> list[tuple[int, ToolOffsetRow]]:
    tools = [(n, row) for n, row in rows.items() if n != number and isinstance(row, ToolOffsetRow)]
    return [(n, row) for n, row in tools if row.master]


def make_no_offset_message(number: int) -> str:
    """Return the message for a tool without an offset, which cannot be the master tool."""
    return Message(
        "the offset of {number} has never been set, so the offsets of other tools "
        "cannot be relative to this tool; touch off this tool first",
        number=format_edge_name(number),
    )


def check_row_number(kind: OffsetKind, number: int) -> None:
    """Raise StoreError if no offset of this kind has the number."""
    table = OFFSET_TABLES[kind]
    if number in table.valid_numbers:
        return
    if kind is OffsetKind.ZERO:
        raise StoreError(
            Message("G{number} does not exist; settable offsets are G54…G59", number=number), "unknown-number"
        )
    if kind in {OffsetKind.MILL_TOOL, OffsetKind.PRESET}:
        last = MILL_TOOL_NUMBERS[-1] if kind is OffsetKind.MILL_TOOL else PRESET_NUMBERS[-1]
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


def apply_field_changes(
    kind: OffsetKind, number: int, old_row: OffsetRow | None, new_values: Mapping[str, FieldValue]
) -> OffsetRow:
    """Return the row with the fields in ``new_values`` replaced.

    Raises StoreError if a field does not exist or a value is out of range.
    """
    fields, table = FIELDS_BY_KIND[kind], OFFSET_TABLES[kind]
    for name, value in new_values.items():
        field = fields.get(name)
        if field is None or not field.is_valid_value(value):
            word, shown = (field.label, _told(field, value)) if field else (name, value)
            whose = format_edge_name(number) if table.letter == "T" else f"{table.letter}{number}"
            entry_text = Message("{whose} {word} {value}", whose=whose, word=word, value=shown)
            accepted = field.range_text if field else ", ".join(fields)
            raise StoreError(
                Message("{details} is out of range; enter {accepted}", details=entry_text, accepted=accepted),
                "out-of-range",
            )
    before = old_row or table.row_type()
    return _row(kind, [new_values.get(name, getattr(before, name)) for name in fields])


def _told(field: RowField, value: FieldValue) -> str:
    if isinstance(value, str):
        return repr(value)
    return (
        Message("{mm} in", mm=f"{convert_to_inches(value):g}")
        if field.field_type is FieldType.LENGTH
        else f"{value:g}"
    )


def _row(kind: OffsetKind, values: Sequence[FieldValue | None]) -> OffsetRow:
    """Return a row that is made from its columns.

    NULL columns, which come from older versions, get zero or empty values.
    """
    whole = [_plain(field, value) for field, value in zip(FIELDS_BY_KIND[kind].values(), values, strict=True)]
    return OFFSET_TABLES[kind].row_type._make(whole)


def _plain(field: RowField, value: FieldValue | None) -> FieldValue:
    if field.field_type is FieldType.TEXT:
        return str(value or "")
    if field.field_type is FieldType.BOOLEAN:
        return bool(value)
    return int(value or 0) if field.field_type is FieldType.INTEGER else float(value or 0.0)


def remove_row(connection: sqlite3.Connection, kind: OffsetKind, number: int, reason: ChangeReason) -> bool:
    """Remove one offset or shape as one step, and return whether it was set.

    Raises StoreError for an unknown number, or if the tool still has other cutting edges.
    """
    check_row_number(kind, number)
    rows = read_current_rows(connection, kind)
    old = rows.get(number)
    edges = [
        format_edge_name(n)
        for n in rows
        if kind is OffsetKind.TOOL and n != number and get_tool_number(n) == number
    ]
    if edges:
        raise StoreError(
            Message(
                "{number} has other cutting edges; clear {edges} first",
                number=format_edge_name(number),
                edges=", ".join(edges),
            ),
            "has-further-edges",
        )
    if old is not None:
        apply_changes(connection, kind, {number: (old, None)}, reason)
    return old is not None


def clear(connection: sqlite3.Connection, kind: OffsetKind, reason: ChangeReason) -> int:
    """Remove all rows of a table as one step, and return the number of removed rows."""
    rows = read_current_rows(connection, kind)
    if rows:
        apply_changes(connection, kind, {number: (old, None) for number, old in rows.items()}, reason)
    return len(rows)


def apply_changes(
    connection: sqlite3.Connection,
    kind: OffsetKind,
    changes: ChangesByNumber,
    reason: ChangeReason,
    undone_step: int | None = None,
    step: int | None = None,
) -> tuple[OffsetChange, ...]:
    """Write changes and their history as one step, and return the history entries of the step.

    ``step`` is the number of a step that also changes another table. If it is None, a new step is started.
    """
    table, log = OFFSET_TABLES[kind], OFFSET_TABLES[kind].history_table
    step = _next_step(connection) if step is None else step
    at, columns = get_utc_now_text(), _columns(kind)
    # All old rows are deleted first, so that the table never has two master tools.
    connection.executemany(
        f"DELETE FROM {table.name} WHERE {log.key_column} = ?", [(number,) for number in changes]
    )
    _insert(
        connection,
        table.name,
        [log.key_column, *columns],
        [(number, *new) for number, (_old, new) in changes.items() if new is not None],
    )
    kind_map = {"kind": kind.value} if log.kind_sql_expression == "kind" else {}
    sides = [f"{side}_{column}" for side in ("old", "new") for column in columns]
    nothing = (None,) * len(columns)
    _insert(
        connection,
        log.name,
        ["step", "undoes", "at", *kind_map, log.key_column, "why", "who", *sides],
        [
            (step, undone_step, at, *kind_map.values(), number, *reason, *(old or nothing), *(new or nothing))
            for number, (old, new) in changes.items()
        ],
    )
    return select_changes(connection, log, "WHERE step = ? ORDER BY id", (step,))


def _insert(
    connection: sqlite3.Connection, table: str, columns: list[str], rows: list[tuple[object, ...]]
) -> None:
    marks = ", ".join("?" * len(columns))
    connection.executemany(f"INSERT INTO {table} ({', '.join(columns)}) VALUES ({marks})", rows)


def _next_step(connection: sqlite3.Connection) -> int:
    """Return the next step number, considering the histories of all tables.

    The order of the steps follows these numbers, so a changed clock cannot reorder the steps.
    """
    return 1 + max(_newest_step(connection, log) for log in HISTORY_TABLES)


def _newest_step(connection: sqlite3.Connection, log: HistoryTable) -> int:
    """Return the latest valid step number of a history, ignoring invalid values.

    Invalid values can only result from another program or from damage.
    """
    asked = f"SELECT coalesce(max(step), 0) FROM {log.name}"
    (last,) = connection.execute(asked).fetchone()
    if not isinstance(last, int) or last >= MAX_STEP_NUMBER:
        # a scan of the whole table, needed only for an invalid value
        only = "WHERE typeof(step) = 'integer' AND step < ?"
        (last,) = connection.execute(f"{asked} {only}", (MAX_STEP_NUMBER,)).fetchone()
    return int(last)


def select_changes(
    connection: sqlite3.Connection, log: HistoryTable, sql_suffix: str, parameters: tuple[int | str, ...]
) -> tuple[OffsetChange, ...]:
    """Return the changes in a history table that match an SQL clause.

    ``sql_suffix`` is the clause after the table name, and ``parameters`` are its values. Raises StoreError
    if a matching entry is damaged.
    """
    rows = connection.execute(
        f"SELECT id, step, undoes, at, {log.kind_sql_expression}, {log.key_column}, why, who, "
        f"{', '.join(log.old_and_new_columns)}"
        f" FROM {log.name} {sql_suffix}",
        parameters,
    )
    found = rows.fetchall()
    if found:
        broken = row_checksums.find_broken_rows(connection, log.name, min(row[0] for row in found))
        for entry in [row[0] for row in found if row[0] in broken]:
            raise make_damaged_entry_error(entry)
    return tuple(_change(log, row) for row in found)


def make_damaged_entry_error(entry: object) -> StoreError:
    """Return the error for a damaged entry of the offset history."""
    return StoreError(
        Message(
            "entry {entry} of the offset history is damaged; the offsets themselves are verified "
            "by separate checksums. Restore a backup to recover the history",
            entry=entry,
        ),
        "damaged-history",
    )


def _change(log: HistoryTable, row: Sequence[Any]) -> OffsetChange:
    """Return a history row as an offset change.

    Raises StoreError if the row contains invalid values.
    """
    half, (i, step, undoes, at, kind, number, why, who, *both) = len(log.value_columns), row
    try:
        old, new = _make_row_side(kind, both[:half]), _make_row_side(kind, both[half:])
        return OffsetChange(i, step, undoes, at, OffsetKind(kind), number, old, new, why, who)
    except (ValueError, TypeError, OverflowError) as error:
        raise make_damaged_entry_error(i) from error


def _make_row_side(kind: str, values: list[FieldValue | None]) -> OffsetRow | None:
    """Return the offset row before or after a change, made from its columns in the history.

    The result is None if the offset was not set at that time.
    """
    if values[0] is None:
        return None
    return _row(OffsetKind(kind), values[: len(FIELDS_BY_KIND[OffsetKind(kind)])])
