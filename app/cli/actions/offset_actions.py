"""Actions of ``turndesk offsets``: show, set and undo offsets and tool shapes of the store, in inches."""

from __future__ import annotations

import argparse
import json
import re
import sqlite3
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from app.cli.actions.meant_changes import demand_meant
from app.cli.store_command import opened_store
from app.cli.who_changes import who_changes
from app.desk.arithmetic import EntryError, value_of
from app.desk.command_errors import EXIT_OK, CommandError
from app.desk.toml_file import unknown
from app.offsets.change_rules import act_of
from app.offsets.offset_values import stated_fields
from app.offsets.offsets_file import ALIASES, TOOL_KEYS, out_of_range, shown
from core.access.access_table import Act
from core.message import Message
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import Reason
from core.store.store_rows import (
    FIELDS,
    MM_PER_INCH,
    OFFSETS,
    ZERO_CODES,
    Change,
    Field,
    Kind,
    MillRow,
    PresetRow,
    Row,
    ShapeRow,
    Sort,
    ToolRow,
    Value,
    ZeroRow,
    inches,
    with_fields,
)
from core.tool_edges import edge_key, edge_name

if TYPE_CHECKING:
    from core.store.store import Store


_OFFSET = re.compile(r"([TDG])0*(\d{1,4})", re.IGNORECASE)
_EDGE = re.compile(r"T0*(\d{1,2})\s*D([1-9])", re.IGNORECASE)
_OF_MILL = re.compile(r"(TOOL|PRESET)0*(\d{1,4})", re.IGNORECASE)
_KIND = {"T": Kind.TOOL, "D": Kind.SECONDARY, "G": Kind.ZERO}
_MILL_KIND = {"TOOL": Kind.MILL_TOOL, "PRESET": Kind.PRESET}
_LETTER = {
    **{kind: letter for letter, kind in _KIND.items()},
    Kind.SHAPE: "T",
    Kind.MILL_TOOL: "TOOL",
    Kind.PRESET: "PRESET",
}
_NAMES = (
    "T1…T32 (T1D2 is the second edge of T1), D1…D32 or G54…G59; on a mill, TOOL1…TOOL999 or PRESET1…PRESET99"
)
_CLEARED = {"T": "tool offsets", "D": "secondary offsets", "G": "zero offsets"}
NO_SHAPE = "none"  # kind=none removes the shape of a tool
_SUCH = {Kind.ZERO: "z=-120", Kind.MILL_TOOL: "L=80.5", Kind.PRESET: "x=100"}
_ALIASES = {
    Kind.TOOL: ALIASES,
    **{
        kind: {field.word.lower(): name for name, field in FIELDS[kind].items()}
        for kind in _MILL_KIND.values()
    },
}
_FLAGS = {"1": True, "yes": True, "true": True, "0": False, "no": False, "false": False}


def _show(args: argparse.Namespace) -> int:
    with opened_store(read_only=True) as store:
        rows = {kind: store.offsets.table(kind).read_rows() for kind in Kind}
    if args.json:
        told = {
            kind.value: {n: _in_inches(kind, row) for n, row in table.items()}
            for kind, table in rows.items()
            if table or kind in {Kind.TOOL, Kind.SECONDARY}
        }
        sys.stdout.write(json.dumps(told) + "\n")
        return EXIT_OK
    lines = [_line(_name(kind, n), row) for kind, table in rows.items() for n, row in table.items()]
    sys.stdout.write("".join(f"{line}\n" for line in lines) or "no offsets are set\n")
    return EXIT_OK


def _in_inches(kind: Kind, row: Row) -> dict[str, Value]:
    """Return every field by name in the unit of entry, which is inches for lengths of tools."""
    values: list[Value] = list(row)
    return {
        name: _typed(field, value) for (name, field), value in zip(FIELDS[kind].items(), values, strict=True)
    }


def _line(name: str, row: Row) -> str:
    if isinstance(row, ShapeRow):
        return f"{name:<3} {_shape(row)}"
    if isinstance(row, ZeroRow):
        return Message(
            "{name} X {x}  Z {z} mm  C {c}°",
            name=name,
            x=f"{row.x:+.3f}",
            z=f"{row.z:+.3f}",
            c=f"{row.c:+.3f}",
        )
    if isinstance(row, MillRow | PresetRow):
        return Message("{name} {row}  (mill, mm)", name=f"{name:<4}", row=stated_fields(row))
    r = row.nose_radius if isinstance(row, ToolRow) else row.r
    x, z, r = inches(row.x), inches(row.z), inches(r)
    line = f"{name:<3} X {x:+.5f}  Z {z:+.5f}  R {r:.5f}"
    return line + _more(row) if isinstance(row, ToolRow) else line


def _shape(row: ShapeRow) -> str:
    """Return the specified fields of a shape in the syntax of entry."""
    told = [f"{row.kind} {row.hand}"]
    values: list[Value] = list(row)
    for field, value in zip(FIELDS[Kind.SHAPE].values(), values, strict=True):
        if value and not field.choices:
            told.append(
                f"{field.name}={shown(_typed(field, value)) if not isinstance(value, str) else value}"
            )
    return "  ".join(told)


def _more(row: ToolRow) -> str:
    """Return the wear, tip, master mark and remark of a tool, if they are set."""
    wear = (
        Message(
            "  wear X {wear_x} Z {wear_z}",
            wear_x=f"{inches(row.wear_x):+.5f}",
            wear_z=f"{inches(row.wear_z):+.5f}",
        )
        if row.wear_x or row.wear_z
        else ""
    )
    tip = f"  tip {row.quadrant}" if row.quadrant else ""
    return wear + tip + ("  master" if row.master else "") + (f"  {row.remark}" if row.remark else "")


def _set(args: argparse.Namespace) -> int:
    kind, number = _named(args.offset)
    values = _values(kind, args.values)
    shape = {
        name: value for name, value in values.items() if kind is Kind.TOOL and name in FIELDS[Kind.SHAPE]
    }
    offset = {name: value for name, value in values.items() if name not in shape}
    acts = [act_of(kind, offset)] if offset else []
    acts += [Act.SHAPES] if shape else []
    with opened_store() as store:
        reason = Reason(args.why, who_changes(store, args, *acts))
        gone = shape.get("kind") == NO_SHAPE
        if shape and not gone:
            _check_shape(store, number, shape, offset)
        changes = {each: values for each, values in ((kind, offset), (Kind.SHAPE, shape)) if values}
        demand_meant(store, args, {each: {number: values} for each, values in changes.items()})
        rows = store.write(lambda connection: _set_all(connection, number, changes, reason)).result()
    name = _name(kind, number)
    sys.stdout.write("".join(f"{_line(name, row)}\n" for row in rows) or f"{name} has no shape\n")
    return EXIT_OK


def _set_all(
    connection: sqlite3.Connection, number: int, changes: Mapping[Kind, Mapping[str, Value]], reason: Reason
) -> list[Row]:
    """Set the offset and the shape of one tool in one transaction."""
    rows = list[Row]()
    for kind, values in changes.items():
        if values.get("kind") == NO_SHAPE:
            offset_tables.remove(connection, kind, number, reason)
        else:
            rows.append(offset_tables.change(connection, kind, number, reason, values))
    return rows


def _check_shape(store: Store, number: int, shape: dict[str, Value], offset: dict[str, Value]) -> None:
    """Raise CommandError if the tool's shape is inconsistent or does not have a kind."""
    from app.desk.stored_shapes import row_mistakes

    row = with_fields(store.offsets.shapes.read_rows().get(number, ShapeRow()), shape)
    if not row.kind:
        kinds = FIELDS[Kind.SHAPE]["kind"].range
        raise CommandError(
            Message(
                "{number} does not have a tool shape yet; also set kind= to one of {kinds}",
                number=edge_name(number),
                kinds=kinds,
            ),
            "no-shape",
        )
    tools = store.offsets.tools.read_rows()
    if offset and number not in tools and not {"x", "z"} <= offset.keys():
        text = Message(
            "{number} was never set; if you set only {offset}, the offset of the other axis remains 0",
            number=edge_name(number),
            offset=" and ".join(offset),
        )
        raise CommandError(
            Message("{text}; enter both x and z, or touch the tool off first", text=text), "needs-both-axes"
        )
    tool = with_fields(tools.get(number, ToolRow()), offset)
    if mistakes := row_mistakes(row, tool):
        raise CommandError(
            f"{edge_name(number)}: " + "; ".join(f"{wrong.field}: {wrong.text}" for wrong in mistakes),
            "invalid-shape",
        )


def _name(kind: Kind, number: int) -> str:
    return edge_name(number) if _LETTER[kind] == "T" else f"{_LETTER[kind]}{number}"


def _named(text: str) -> tuple[Kind, int]:
    of_mill = _OF_MILL.fullmatch(text)
    if of_mill:
        return _MILL_KIND[of_mill[1].upper()], int(of_mill[2])  # the store reports invalid numbers
    edge = _EDGE.fullmatch(text)
    if edge and int(edge[1]) in OFFSETS:
        return Kind.TOOL, edge_key(int(edge[1]), int(edge[2]))
    match = _OFFSET.fullmatch(text)
    kind = _KIND[match[1].upper()] if match else Kind.TOOL
    if match and int(match[2]) in (ZERO_CODES if kind is Kind.ZERO else OFFSETS):
        return kind, int(match[2])
    if match and kind is Kind.ZERO:
        raise CommandError(
            Message("{text} is not a settable zero offset; use G54…G59", text=text), "unknown-zero"
        )
    raise CommandError(
        Message("{text} is not an offset; use {names}", text=text, names=_NAMES), "unknown-offset"
    )


def _values(kind: Kind, entries: list[str]) -> dict[str, Value]:
    """Return the fields from entries such as ``x=1.25``, lengths in mm.

    Raises CommandError for the first error.
    """
    values: dict[str, Value] = {}
    for entry in entries:
        key, equals, text = entry.partition("=")
        key = key.strip().lower()
        if not equals:
            such = _SUCH.get(kind, "x=1.25")
            raise CommandError(
                Message(
                    "{entry} does not set a value; write KEY=VALUE, such as {such}", entry=entry, such=such
                ),
                "no-value",
            )
        fields = TOOL_KEYS if kind is Kind.TOOL else FIELDS[kind]
        aliases = _ALIASES.get(kind, {})
        field = fields.get(aliases.get(key, key))
        if field is None:
            raise CommandError(unknown(key, fields), "unknown-key")
        if field.name in values:
            raise CommandError(Message("{key} is specified twice; remove one", key=key), "key-twice")
        values[field.name] = _entered(field, text)
    return values


def _entered(field: Field, text: str) -> Value:
    value = _value(field, text)
    if field.choices:
        return _chosen(field, str(value).lower())
    if field.sort in {Sort.METRIC, Sort.ANGLE, Sort.MINUTES}:
        return value  # zero offsets and mill values, whose range the store checks
    if mistake := out_of_range(field.name, field, value, _typed(field, value)):
        raise CommandError(mistake, "out-of-range")
    return value


def _chosen(field: Field, word: str) -> str:
    """Return one of the field's choices. Raises CommandError with the most similar choice."""
    known = (*field.choices, NO_SHAPE) if field.name == "kind" else field.choices
    if word not in known:
        raise CommandError(f"{field.name}: {unknown(word, known)}", "unknown-word")
    return word


def _typed(field: Field, value: Value) -> Value:
    """Return the value in the unit of entry."""
    return inches(value) if field.sort is Sort.LENGTH and not isinstance(value, str) else value


def _value(field: Field, text: str) -> Value:
    """Return the value of a text, lengths in mm. Raises CommandError if the text is invalid."""
    if field.sort is Sort.TEXT:
        return text.strip()
    if field.sort is Sort.FLAG and text.strip().lower() not in _FLAGS:
        raise CommandError(
            Message("{field} = {text} is not valid; use 1 or 0", field=field.name, text=text), "not-a-flag"
        )
    if field.sort is Sort.FLAG:
        return _FLAGS[text.strip().lower()]
    try:
        value = value_of(text)
    except EntryError as error:
        raise CommandError(f"{field.name}: {error}", "not-a-number") from error
    if field.sort is Sort.WHOLE:
        return int(value) if value.is_integer() else value
    return value * MM_PER_INCH if field.sort is Sort.LENGTH else value


def _clear(args: argparse.Namespace) -> int:
    """Clear one offset or a whole table as one step, which can be undone."""
    letter = args.offset.upper()
    with opened_store() as store:
        if letter in {**_KIND, **_MILL_KIND}:
            table = {**_KIND, **_MILL_KIND}[letter]
            who = who_changes(store, args, act_of(table))
            count = store.offsets.table(table).remove_all_rows(args.why, who=who).result()
        else:
            kind, number = _named(args.offset)
            who = who_changes(store, args, act_of(kind))
            count = store.offsets.table(kind).remove_row(number, args.why, who=who).result()
            letter = _name(kind, number)
    if not count:
        sys.stdout.write(f"{letter} was not set, so there was nothing to clear\n")
    else:
        told = _CLEARED.get(letter, letter)
        sys.stdout.write(f"{told} cleared: {int(count)}; 'turndesk offsets undo' restores them\n")
    return EXIT_OK


def _history(args: argparse.Namespace) -> int:
    if args.limit < 1:
        raise CommandError(Message("--limit {limit} is too small; use 1 or more", limit=args.limit), "limit")
    with opened_store(read_only=True) as store:
        changes = (
            store.offsets.table(Kind(args.table)).read_history(limit=args.limit)
            if args.table
            else store.offsets.read_history(limit=args.limit)
        )
    if args.json:
        sys.stdout.write(json.dumps([_change(change) for change in changes]) + "\n")
    else:
        sys.stdout.write(
            "".join(f"{_told(change)}\n" for change in changes) or "no offset has been changed yet\n"
        )
    return EXIT_OK


def _change(change: Change) -> dict[str, object]:
    """Return a change for JSON output, with lengths in inches."""
    fields: dict[str, object] = change._asdict()
    for side, row in (("old", change.old), ("new", change.new)):
        fields[side] = row and _in_inches(change.kind, row)
    return fields


def _told(change: Change) -> str:
    """Return a change as a line of text."""
    sides = ["not set" if row is None else _line("", row).strip() for row in (change.old, change.new)]
    name = _name(change.kind, change.number)
    return f"{change.at}  {name:<3} {' → '.join(sides)}  {change.why} ({change.who})"


def _undo(args: argparse.Namespace) -> int:
    with opened_store() as store:
        kinds = [Kind(args.table)] if args.table else list(Kind)
        who = who_changes(store, args, *map(act_of, kinds))
        undone = (
            store.offsets.table(Kind(args.table)).undo_last_step(args.why, who=who)
            if args.table
            else store.offsets.undo_last_step(args.why, who=who)
        )
        changes = undone.result()
    sys.stdout.write("".join(f"{_told(change)}\n" for change in changes))
    return EXIT_OK


ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "show": _show,
    "set": _set,
    "clear": _clear,
    "history": _history,
    "undo": _undo,
}
