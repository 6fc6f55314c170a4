"""What ``turndesk offsets`` does. Inches at the door, millimetres in the store."""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterable

from app.cli.errors import EXIT_OK, CommandError
from app.cli.offset_file import KEYS, out_of_range
from app.cli.opened_store import opened_store
from app.cli.toml_file import unknown
from app.desk.arithmetic import EntryError, value_of
from core.store.rows import MM_PER_INCH, OFFSETS, Change, Kind, inches

_OFFSET = re.compile(r"([TD])0*(\d{1,4})", re.IGNORECASE)
_KIND = {"T": Kind.TOOL, "D": Kind.SECONDARY}
_LETTER = {kind: letter for letter, kind in _KIND.items()}


def _show(args: argparse.Namespace) -> int:
    with opened_store(read_only=True) as store:
        tools = {n: _in_inches(row._asdict()) for n, row in store.tools().items()}
        secondary = {n: _in_inches(row._asdict()) for n, row in store.secondary().items()}
    if args.json:
        sys.stdout.write(json.dumps({"tool": tools, "secondary": secondary}) + "\n")
        return EXIT_OK
    lines = [_line(f"T{n}", values.values()) for n, values in tools.items()]
    lines += [_line(f"D{n}", values.values()) for n, values in secondary.items()]
    sys.stdout.write("".join(f"{line}\n" for line in lines) or "no offsets are set\n")
    return EXIT_OK


def _in_inches(row: dict[str, float]) -> dict[str, float]:
    return {key: inches(value) for key, value in row.items()}


def _line(name: str, values: Iterable[float]) -> str:
    x, z, r = values
    return f"{name:<3} X {x:+.5f}  Z {z:+.5f}  R {r:.5f}"


def _set(args: argparse.Namespace) -> int:
    kind, number = _named(args.offset)
    values = _values(kind, args.values)
    with opened_store() as store:
        if kind is Kind.TOOL:
            store.set_tool(number, args.why, **values, who="command line").result()
        else:
            store.set_secondary(number, args.why, **values, who="command line").result()
        new = (store.tools() if kind is Kind.TOOL else store.secondary())[number]
    sys.stdout.write(_line(f"{_LETTER[kind]}{number}", (inches(value) for value in new)) + "\n")
    return EXIT_OK


def _named(text: str) -> tuple[Kind, int]:
    match = _OFFSET.fullmatch(text)
    if not match or int(match[2]) not in OFFSETS:
        raise CommandError(f"{text} is no offset; name T1…T32 or D1…D32")
    return _KIND[match[1].upper()], int(match[2])


def _values(kind: Kind, entries: list[str]) -> dict[str, float]:
    """Keys and millimetres from ``x=1.25`` entries. Raises CommandError for the first that is no good."""
    values: dict[str, float] = {}
    for entry in entries:
        key, equals, text = entry.partition("=")
        key = key.strip().lower()
        if not equals:
            raise CommandError(f"{entry} sets nothing; write KEY=VALUE, such as x=1.25")
        if key not in KEYS[kind]:
            raise CommandError(unknown(key, KEYS[kind]))
        if key in values:
            raise CommandError(f"{key} is given twice; give it once")
        values[key] = _inches_entered(kind, key, text) * MM_PER_INCH
    return values


def _inches_entered(kind: Kind, key: str, text: str) -> float:
    try:
        value = value_of(text)
    except EntryError as error:
        raise CommandError(f"{key}: {error}") from error
    if mistake := out_of_range(kind, key, value):
        raise CommandError(f"{key} = {value:g} {mistake}")
    return value


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
    for side in ("old", "new"):
        values = change.old if side == "old" else change.new
        fields[side] = values and dict(zip(KEYS[change.kind], map(inches, values), strict=True))
    return fields


def _told(change: Change) -> str:
    """One change for a person to read."""
    sides = ["not set" if v is None else _line("", map(inches, v)).strip() for v in (change.old, change.new)]
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
