"""Actions of ``turndesk offsets``: show, set and undo stored offsets and tool shapes in inches."""

from __future__ import annotations

import argparse
import json
import re
import sqlite3
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from app.cli.actions.change_confirmation import confirm_changes
from app.cli.change_author import get_change_author
from app.cli.store_command import open_store
from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.command_errors import EXIT_OK, CommandError
from app.desk.toml_file import describe_unknown_key
from app.offsets.change_rules import find_required_access_right
from app.offsets.offset_values import format_specified_fields
from app.offsets.offsets_file import KEY_ALIASES, TOOL_TABLE_KEYS, find_range_error, format_value
from core.access.access_table import ProtectedChange
from core.message import Message
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.store_rows import (
    FIELDS_BY_KIND,
    MM_PER_INCH,
    OFFSET_NUMBERS,
    ZERO_CODES,
    FieldType,
    FieldValue,
    MillToolRow,
    OffsetChange,
    OffsetKind,
    OffsetRow,
    PresetRow,
    RowField,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
    convert_to_inches,
    replace_fields,
)
from core.tool_edges import format_edge_name, make_edge_row_number

if TYPE_CHECKING:
    from core.store.store import Store


_OFFSET = re.compile(r"([TDG])0*(\d{1,4})", re.IGNORECASE)
_EDGE = re.compile(r"T0*(\d{1,2})\s*D([1-9])", re.IGNORECASE)
_MILL_PATTERN = re.compile(r"(TOOL|PRESET)0*(\d{1,4})", re.IGNORECASE)
_KIND = {"T": OffsetKind.TOOL, "D": OffsetKind.SECONDARY, "G": OffsetKind.ZERO}
_MILL_KIND = {"TOOL": OffsetKind.MILL_TOOL, "PRESET": OffsetKind.PRESET}
_LETTER = {
    **{kind: letter for letter, kind in _KIND.items()},
    OffsetKind.SHAPE: "T",
    OffsetKind.MILL_TOOL: "TOOL",
    OffsetKind.PRESET: "PRESET",
}
_NAMES = (
    "T1…T32 (T1D2 is the second edge of T1), D1…D32 or G54…G59; on a mill, TOOL1…TOOL999 or PRESET1…PRESET99"
)
_CLEARED = {"T": "tool offsets", "D": "secondary offsets", "G": "zero offsets"}
NO_SHAPE_KIND = "none"  # kind=none removes the shape of a tool
_EXAMPLES = {OffsetKind.ZERO: "z=-120", OffsetKind.MILL_TOOL: "L=80.5", OffsetKind.PRESET: "x=100"}
_ALIASES = {
    OffsetKind.TOOL: KEY_ALIASES,
    **{
        kind: {field.label.lower(): name for name, field in FIELDS_BY_KIND[kind].items()}
        for kind in _MILL_KIND.values()
    },
}
_FLAGS = {"1": True, "yes": True, "true": True, "0": False, "no": False, "false": False}


def _show(args: argparse.Namespace) -> int:
    with open_store(read_only=True) as store:
        rows = {kind: store.offsets.get_table(kind).read_rows() for kind in OffsetKind}
    if args.json:
        tables_json = {
            kind.value: {n: _convert_to_inches(kind, row) for n, row in table.items()}
            for kind, table in rows.items()
            if table or kind in {OffsetKind.TOOL, OffsetKind.SECONDARY}
        }
        sys.stdout.write(json.dumps(tables_json) + "\n")
        return EXIT_OK
    lines = [_line(_name(kind, n), row) for kind, table in rows.items() for n, row in table.items()]
    sys.stdout.write("".join(f"{line}\n" for line in lines) or "no offsets are set\n")
    return EXIT_OK


def _convert_to_inches(kind: OffsetKind, row: OffsetRow) -> dict[str, FieldValue]:
    """Return all fields of an offset row by name, in the units in which the user enters them.

    Lengths of tools are in inches.
    """
    values: list[FieldValue] = list(row)
    return {
        name: _convert_type(field, value)
        for (name, field), value in zip(FIELDS_BY_KIND[kind].items(), values, strict=True)
    }


def _line(name: str, row: OffsetRow) -> str:
    if isinstance(row, ToolShapeRow):
        return f"{name:<3} {_format_shape(row)}"
    if isinstance(row, ZeroOffsetRow):
        return Message(
            "{name} X {x}  Z {z} mm  C {c}°",
            name=name,
            x=f"{row.x:+.3f}",
            z=f"{row.z:+.3f}",
            c=f"{row.c:+.3f}",
        )
    if isinstance(row, MillToolRow | PresetRow):
        return Message("{name} {row}  (mill, mm)", name=f"{name:<4}", row=format_specified_fields(row))
    r = row.nose_radius if isinstance(row, ToolOffsetRow) else row.r
    x, z, r = convert_to_inches(row.x), convert_to_inches(row.z), convert_to_inches(r)
    line = f"{name:<3} X {x:+.5f}  Z {z:+.5f}  R {r:.5f}"
    return line + _format_details(row) if isinstance(row, ToolOffsetRow) else line


def _format_shape(row: ToolShapeRow) -> str:
    """Return the defined fields of a tool shape in the form in which a user enters them."""
    field_texts = [f"{row.kind} {row.hand}"]
    values: list[FieldValue] = list(row)
    for field, value in zip(FIELDS_BY_KIND[OffsetKind.SHAPE].values(), values, strict=True):
        if value and not field.choices:
            field_texts.append(
                f"{field.name}="
                f"{format_value(_convert_type(field, value)) if not isinstance(value, str) else value}"
            )
    return "  ".join(field_texts)


def _format_details(row: ToolOffsetRow) -> str:
    """Return a tool's wear, tip orientation, master mark and remark as text. Unset values are omitted."""
    wear = (
        Message(
            "  wear X {wear_x} Z {wear_z}",
            wear_x=f"{convert_to_inches(row.wear_x):+.5f}",
            wear_z=f"{convert_to_inches(row.wear_z):+.5f}",
        )
        if row.wear_x or row.wear_z
        else ""
    )
    tip = f"  tip {row.quadrant}" if row.quadrant else ""
    return wear + tip + ("  master" if row.master else "") + (f"  {row.remark}" if row.remark else "")


def _set(args: argparse.Namespace) -> int:
    kind, number = _named(args.offset)
    values = _parse_entries(kind, args.values)
    shape = {
        name: value
        for name, value in values.items()
        if kind is OffsetKind.TOOL and name in FIELDS_BY_KIND[OffsetKind.SHAPE]
    }
    offset = {name: value for name, value in values.items() if name not in shape}
    acts = [find_required_access_right(kind, offset)] if offset else []
    acts += [ProtectedChange.SHAPES] if shape else []
    with open_store() as store:
        reason = ChangeReason(args.why, get_change_author(store, args, *acts))
        gone = shape.get("kind") == NO_SHAPE_KIND
        if shape and not gone:
            _check_shape(store, number, shape, offset)
        changes = {each: values for each, values in ((kind, offset), (OffsetKind.SHAPE, shape)) if values}
        confirm_changes(store, args, {each: {number: values} for each, values in changes.items()})
        rows = store.write(lambda connection: _set_all(connection, number, changes, reason)).result()
    name = _name(kind, number)
    sys.stdout.write("".join(f"{_line(name, row)}\n" for row in rows) or f"{name} has no shape\n")
    return EXIT_OK


def _set_all(
    connection: sqlite3.Connection,
    number: int,
    changes: Mapping[OffsetKind, Mapping[str, FieldValue]],
    reason: ChangeReason,
) -> list[OffsetRow]:
    """Set the offset and the shape of one tool in one transaction.

    The shape is removed if its kind is ``none``.
    """
    rows = list[OffsetRow]()
    for kind, values in changes.items():
        if values.get("kind") == NO_SHAPE_KIND:
            offset_tables.remove_row(connection, kind, number, reason)
        else:
            rows.append(offset_tables.change_row(connection, kind, number, reason, values))
    return rows


def _check_shape(
    store: Store, number: int, shape: dict[str, FieldValue], offset: dict[str, FieldValue]
) -> None:
    """Raise CommandError if the tool's shape is inconsistent or its kind is missing.

    CommandError is also raised if the tool has no stored offset yet and ``offset`` does not contain both X
    and Z.
    """
    from app.desk.stored_shapes import find_shape_row_mistakes

    row = replace_fields(store.offsets.tool_shapes.read_rows().get(number, ToolShapeRow()), shape)
    if not row.kind:
        kinds = FIELDS_BY_KIND[OffsetKind.SHAPE]["kind"].range_text
        raise CommandError(
            Message(
                "{number} does not have a tool shape yet; also set kind= to one of {kinds}",
                number=format_edge_name(number),
                kinds=kinds,
            ),
            "no-shape",
        )
    tools = store.offsets.tool_offsets.read_rows()
    if offset and number not in tools and not {"x", "z"} <= offset.keys():
        text = Message(
            "{number} was never set; if you set only {offset}, the offset of the other axis remains 0",
            number=format_edge_name(number),
            offset=" and ".join(offset),
        )
        raise CommandError(
            Message("{text}; enter both x and z, or touch the tool off first", text=text), "needs-both-axes"
        )
    tool = replace_fields(tools.get(number, ToolOffsetRow()), offset)
    if mistakes := find_shape_row_mistakes(row, tool):
        raise CommandError(
            f"{format_edge_name(number)}: "
            + "; ".join(f"{wrong.field_name}: {wrong.message}" for wrong in mistakes),
            "invalid-shape",
        )


def _name(kind: OffsetKind, number: int) -> str:
    return format_edge_name(number) if _LETTER[kind] == "T" else f"{_LETTER[kind]}{number}"


def _named(text: str) -> tuple[OffsetKind, int]:
    of_mill = _MILL_PATTERN.fullmatch(text)
    if of_mill:
        return _MILL_KIND[of_mill[1].upper()], int(of_mill[2])  # the store reports invalid numbers
    edge = _EDGE.fullmatch(text)
    if edge and int(edge[1]) in OFFSET_NUMBERS:
        return OffsetKind.TOOL, make_edge_row_number(int(edge[1]), int(edge[2]))
    match = _OFFSET.fullmatch(text)
    kind = _KIND[match[1].upper()] if match else OffsetKind.TOOL
    if match and int(match[2]) in (ZERO_CODES if kind is OffsetKind.ZERO else OFFSET_NUMBERS):
        return kind, int(match[2])
    if match and kind is OffsetKind.ZERO:
        raise CommandError(
            Message("{text} is not a settable zero offset; use G54…G59", text=text), "unknown-zero"
        )
    raise CommandError(
        Message("{text} is not an offset; use {names}", text=text, names=_NAMES), "unknown-offset"
    )


def _parse_entries(kind: OffsetKind, entries: list[str]) -> dict[str, FieldValue]:
    """Return the fields from entries such as ``x=1.25``, with lengths in mm.

    Raises CommandError for the first invalid entry.
    """
    values: dict[str, FieldValue] = {}
    for entry in entries:
        key, equals, text = entry.partition("=")
        key = key.strip().lower()
        if not equals:
            such = _EXAMPLES.get(kind, "x=1.25")
            raise CommandError(
                Message(
                    "{entry} does not set a value; write KEY=VALUE, such as {such}", entry=entry, such=such
                ),
                "no-value",
            )
        fields = TOOL_TABLE_KEYS if kind is OffsetKind.TOOL else FIELDS_BY_KIND[kind]
        aliases = _ALIASES.get(kind, {})
        field = fields.get(aliases.get(key, key))
        if field is None:
            raise CommandError(describe_unknown_key(key, fields), "unknown-key")
        if field.name in values:
            raise CommandError(Message("{key} is specified twice; remove one", key=key), "key-twice")
        values[field.name] = _entered(field, text)
    return values


def _entered(field: RowField, text: str) -> FieldValue:
    value = _parse_value(field, text)
    if field.choices:
        return _parse_choice(field, str(value).lower())
    if field.field_type in {FieldType.METRIC_LENGTH, FieldType.ANGLE, FieldType.MINUTES}:
        return value  # zero offsets and mill values, whose range the store checks
    if mistake := find_range_error(field.name, field, value, _convert_type(field, value)):
        raise CommandError(mistake, "out-of-range")
    return value


def _parse_choice(field: RowField, word: str) -> str:
    """Return ``word`` if it is one of the field's choices, and otherwise raise CommandError.

    The error names the most similar choice.
    """
    known = (*field.choices, NO_SHAPE_KIND) if field.name == "kind" else field.choices
    if word not in known:
        raise CommandError(f"{field.name}: {describe_unknown_key(word, known)}", "unknown-word")
    return word


def _convert_type(field: RowField, value: FieldValue) -> FieldValue:
    """Return a stored field value in the unit in which the user enters it."""
    return (
        convert_to_inches(value)
        if field.field_type is FieldType.LENGTH and not isinstance(value, str)
        else value
    )


def _parse_value(field: RowField, text: str) -> FieldValue:
    """Return the field value of an entered text, with lengths in mm.

    Raises CommandError if the text is invalid.
    """
    if field.field_type is FieldType.TEXT:
        return text.strip()
    if field.field_type is FieldType.BOOLEAN and text.strip().lower() not in _FLAGS:
        raise CommandError(
            Message("{field} = {text} is not valid; use 1 or 0", field=field.name, text=text), "not-a-flag"
        )
    if field.field_type is FieldType.BOOLEAN:
        return _FLAGS[text.strip().lower()]
    try:
        value = evaluate_expression(text)
    except InvalidEntryError as error:
        raise CommandError(f"{field.name}: {error}", "not-a-number") from error
    if field.field_type is FieldType.INTEGER:
        return int(value) if value.is_integer() else value
    return value * MM_PER_INCH if field.field_type is FieldType.LENGTH else value


def _clear(args: argparse.Namespace) -> int:
    """Clear one offset or a whole offset table as a single change, which the user can undo."""
    letter = args.offset.upper()
    with open_store() as store:
        if letter in {**_KIND, **_MILL_KIND}:
            table = {**_KIND, **_MILL_KIND}[letter]
            who = get_change_author(store, args, find_required_access_right(table))
            count = store.offsets.get_table(table).remove_all_rows(args.why, author=who).result()
        else:
            kind, number = _named(args.offset)
            who = get_change_author(store, args, find_required_access_right(kind))
            count = store.offsets.get_table(kind).remove_row(number, args.why, author=who).result()
            letter = _name(kind, number)
    if not count:
        sys.stdout.write(f"{letter} was not set, so there was nothing to clear\n")
    else:
        cleared_name = _CLEARED.get(letter, letter)
        sys.stdout.write(f"{cleared_name} cleared: {int(count)}; 'turndesk offsets undo' restores them\n")
    return EXIT_OK


def _history(args: argparse.Namespace) -> int:
    if args.limit < 1:
        raise CommandError(Message("--limit {limit} is too small; use 1 or more", limit=args.limit), "limit")
    with open_store(read_only=True) as store:
        changes = (
            store.offsets.get_table(OffsetKind(args.table)).read_history(limit=args.limit)
            if args.table
            else store.offsets.read_history(limit=args.limit)
        )
    if args.json:
        sys.stdout.write(json.dumps([_change_json(change) for change in changes]) + "\n")
    else:
        sys.stdout.write(
            "".join(f"{_format_change(change)}\n" for change in changes) or "no offset has been changed yet\n"
        )
    return EXIT_OK


def _change_json(change: OffsetChange) -> dict[str, object]:
    """Return a change for JSON output, with lengths in inches."""
    fields: dict[str, object] = change._asdict()
    for side, row in (("old", change.old), ("new", change.new)):
        fields[side] = row and _convert_to_inches(change.kind, row)
    return fields


def _format_change(change: OffsetChange) -> str:
    """Return a change as a line of text."""
    sides = ["not set" if row is None else _line("", row).strip() for row in (change.old, change.new)]
    name = _name(change.kind, change.number)
    return f"{change.at}  {name:<3} {' → '.join(sides)}  {change.why} ({change.who})"


def _undo(args: argparse.Namespace) -> int:
    with open_store() as store:
        kinds = [OffsetKind(args.table)] if args.table else list(OffsetKind)
        who = get_change_author(store, args, *map(find_required_access_right, kinds))
        undone = (
            store.offsets.get_table(OffsetKind(args.table)).undo_last_step(args.why, who=who)
            if args.table
            else store.offsets.undo_last_step(args.why, author=who)
        )
        changes = undone.result()
    sys.stdout.write("".join(f"{_format_change(change)}\n" for change in changes))
    return EXIT_OK


OFFSET_ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "show": _show,
    "set": _set,
    "clear": _clear,
    "history": _history,
    "undo": _undo,
}
