"""What ``turndesk offsets`` does. Inches at the door, millimetres in the store."""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable

from app.cli import zero_actions
from app.cli.errors import EXIT_OK, CommandError
from app.cli.offset_file import out_of_range, shown
from app.cli.opened_store import opened_store
from app.cli.toml_file import unknown
from app.cli.zero_file import TABLE
from app.desk.arithmetic import EntryError, value_of
from core.store.fields import FIELDS, Field, Sort
from core.store.rows import MM_PER_INCH, OFFSETS, Change, Kind, Row, ToolRow, Value, inches

_OFFSET = re.compile(r"([TD])0*(\d{1,4})", re.IGNORECASE)
_KIND = {"T": Kind.TOOL, "D": Kind.SECONDARY}
_LETTER = {kind: letter for letter, kind in _KIND.items()}


_FLAGS = {"1": True, "yes": True, "true": True, "0": False, "no": False, "false": False}


def _show(args: argparse.Namespace) -> int:
    with opened_store(read_only=True) as store:
        rows: dict[Kind, dict[int, Row]] = {
            Kind.TOOL: {**store.tools()},
            Kind.SECONDARY: {**store.secondary()},
        }
        zero = store.zero_offsets()
    if args.json:
        told: dict[str, object] = {
            kind.value: {n: _in_inches(kind, row) for n, row in table.items()} for kind, table in rows.items()
        }
        if zero:
            told[TABLE] = zero_actions.as_json(zero)
        sys.stdout.write(json.dumps(told) + "\n")
        return EXIT_OK
    lines = [_line(f"{_LETTER[kind]}{n}", row) for kind, table in rows.items() for n, row in table.items()]
    lines += [zero_actions.line(code, row) for code, row in zero.items()]
    sys.stdout.write("".join(f"{line}\n" for line in lines) or "no offsets are set\n")
    return EXIT_OK


def _in_inches(kind: Kind, row: Row) -> dict[str, Value]:
    """Every field by its name, lengths in inches."""
    values: list[Value] = list(row)
    return {
        name: _typed(field, value) for (name, field), value in zip(FIELDS[kind].items(), values, strict=True)
    }


def _line(name: str, row: Row) -> str:
    x, z, r = (inches(value) for value in row[:3])
    line = f"{name:<3} X {x:+.5f}  Z {z:+.5f}  R {r:.5f}"
    return line + _more(row) if isinstance(row, ToolRow) else line


def _more(row: ToolRow) -> str:
    """What else is set of a tool."""
    wear = (
        f"  wear X {inches(row.wear_x):+.5f} Z {inches(row.wear_z):+.5f}" if row.wear_x or row.wear_z else ""
    )
    tip = f"  tip {row.quadrant}" if row.quadrant else ""
    return wear + tip + ("  master" if row.master else "") + (f"  {row.remark}" if row.remark else "")


def _set(args: argparse.Namespace) -> int:
    code = zero_actions.code_of(args.offset)
    if code is not None:
        return zero_actions.set_zero(code, args.values, args.why)
    kind, number = _named(args.offset)
    values = _values(kind, args.values)
    with opened_store() as store:
        new = store.set_offset(kind, number, args.why, values, who="command line").result()
    sys.stdout.write(_line(f"{_LETTER[kind]}{number}", new) + "\n")
    return EXIT_OK


def _named(text: str) -> tuple[Kind, int]:
    match = _OFFSET.fullmatch(text)
    if not match or int(match[2]) not in OFFSETS:
        raise CommandError(f"{text} is no offset; name T1…T32, D1…D32 or G54…G59")
    return _KIND[match[1].upper()], int(match[2])


def _values(kind: Kind, entries: list[str]) -> dict[str, Value]:
    """Fields from entries such as ``x=1.25``, lengths mm. Raises CommandError for the first mistake."""
    values: dict[str, Value] = {}
    for entry in entries:
        key, equals, text = entry.partition("=")
        key = key.strip().lower()
        if not equals:
            raise CommandError(f"{entry} sets nothing; write KEY=VALUE, such as x=1.25")
        if key not in FIELDS[kind]:
            raise CommandError(unknown(key, FIELDS[kind]))
        if key in values:
            raise CommandError(f"{key} is given twice; give it once")
        values[key] = _entered(FIELDS[kind][key], text)
    return values


def _entered(field: Field, text: str) -> Value:
    value = _value(field, text)
    if mistake := out_of_range(field, value):
        raise CommandError(f"{field.name} = {shown(_typed(field, value))} {mistake}")
    return value


def _typed(field: Field, value: Value) -> Value:
    """The value again in the unit of the entry."""
    return inches(value) if field.sort is Sort.LENGTH and not isinstance(value, str) else value


def _value(field: Field, text: str) -> Value:
    """What the text comes to; lengths mm. Raises CommandError."""
    if field.sort is Sort.TEXT:
        return text.strip()
    if field.sort is Sort.FLAG and text.strip().lower() not in _FLAGS:
        raise CommandError(f"{field.name} = {text} is neither 1 nor 0")
    if field.sort is Sort.FLAG:
        return _FLAGS[text.strip().lower()]
    try:
        value = value_of(text)
    except EntryError as error:
        raise CommandError(f"{field.name}: {error}") from error
    if field.sort is Sort.WHOLE:
        return int(value) if value.is_integer() else value
    return value * MM_PER_INCH


def _clear(args: argparse.Namespace) -> int:
    with opened_store() as store:
        count = store.clear_secondary(args.why, who="command line").result()
    sys.stdout.write(f"secondary offsets cleared: {count}; 'turndesk offsets undo' brings them back\n")
    return EXIT_OK


def _history(args: argparse.Namespace) -> int:
    if args.limit < 1:
        raise CommandError(f"--limit {args.limit} shows nothing; give 1 or more")
    with opened_store(read_only=True) as store:
        changes = store.history(limit=args.limit)
    if args.json:
        sys.stdout.write(json.dumps([_change(change) for change in changes]) + "\n")
    else:
        sys.stdout.write(
            "".join(f"{_told(change)}\n" for change in changes) or "no offset was ever changed\n"
        )
    return EXIT_OK


def _change(change: Change) -> dict[str, object]:
    """One change for a program to read, inches."""
    fields: dict[str, object] = change._asdict()
    for side, row in (("old", change.old), ("new", change.new)):
        fields[side] = row and _in_inches(change.kind, row)
    return fields


def _told(change: Change) -> str:
    """One change for a person to read."""
    sides = ["not set" if row is None else _line("", row).strip() for row in (change.old, change.new)]
    name = f"{_LETTER[change.kind]}{change.number}"
    return f"{change.at}  {name:<3} {' → '.join(sides)}  {change.why} ({change.who})"


def _undo(args: argparse.Namespace) -> int:
    with opened_store() as store:
        changes = store.undo_offset(args.why, who="command line").result()
    sys.stdout.write("".join(f"{_told(change)}\n" for change in changes))
    return EXIT_OK


ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "show": _show,
    "set": _set,
    "clear": _clear,
    "history": _history,
    "undo": _undo,
}
