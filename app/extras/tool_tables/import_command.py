"""Import of a tool table, with a preview of the changes and questions for confirmation.

The whole import is one step in the offset history.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.actions.change_confirmation import confirm_changes
from app.cli.change_author import get_change_author
from app.cli.store_command import open_store
from app.compose.machine.machine_setup import read_machine
from app.desk.command_errors import EXIT_OK, CommandError
from app.desk.toml_file import raise_mistakes
from app.extras.tool_tables.import_plan import (
    FieldChange,
    ImportStatus,
    StoredTools,
    ToolImportPlan,
    collect_changes,
)
from app.extras.tool_tables.table_options import parse_columns, parse_tool_numbers
from core.access.access_table import ProtectedChange
from core.extras.tool_tables.table_file import find_table_format, read_tool_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTable, ToolTableError
from core.json_keys import JsonOutput, declare_keys
from core.message import Message
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.store_rows import FIELDS_BY_KIND, FieldType, FieldValue, convert_to_inches

if TYPE_CHECKING:
    from core.store.store import Store


def import_tool_table(args: argparse.Namespace) -> int:
    """Show the changes that a tool table would make, and import the table after the user confirms.

    Raises CommandError if the table is invalid or cannot be imported.
    """
    if args.machine:
        read_machine(args.machine)  # reports a mistake in the option before anything is asked
    may_save = args.yes or not args.json
    with open_store(read_only=not may_save) as store:
        who = (
            get_change_author(store, args, ProtectedChange.TOOLS, ProtectedChange.SHAPES) if may_save else ""
        )
        word, table = _read(Path(args.file), args)
        stored = StoredTools(store.offsets.tool_offsets.read_rows(), store.offsets.tool_shapes.read_rows())
        plans = stored.make_import_plans(table, imports_positions=not args.no_positions)
        raise_mistakes(Path(args.file), list(stored.find_shape_errors(plans)))
        if not args.json:
            sys.stdout.writelines(f"{line}\n" for line in _preview(table, plans))
        wanted = _confirmed(plans, args) if may_save else ()
        if wanted:
            _save(store, args, wanted, who)
    if args.json:
        _write_json(args.file, word, table, plans, wanted)
    else:
        _tell(wanted)
    return EXIT_OK


def _tell(saved: tuple[ToolImportPlan, ...]) -> None:
    summary = Message("imported: {names}; 'turndesk offsets undo' undoes the import", names=_names(saved))
    sys.stdout.write(f"{summary}\n" if saved else "nothing was changed\n")


# --- the file and the options ------------------------------------------------------------------------------


def _read(path: Path, args: argparse.Namespace) -> tuple[str, ToolTable]:
    """Return the name of the file format and the tool table in the file.

    Raises CommandError if the file is not a valid tool table.
    """
    options = TableReadingOptions(
        args.unit, args.x, parse_columns(args.columns), args.number, parse_tool_numbers(args.only)
    )
    try:
        word = args.format or find_table_format(path.name)
        return word, read_tool_table(path, word, options)
    except ToolTableError as error:
        raise CommandError(str(error), error.code) from error


# --- questions ---------------------------------------------------------------------------------------------


def _confirmed(plans: tuple[ToolImportPlan, ...], args: argparse.Namespace) -> tuple[ToolImportPlan, ...]:
    """Ask the user to confirm the planned changes, and return the confirmed plans.

    Raises CommandError if there is no terminal for the question.
    """
    new = tuple(plan for plan in plans if plan.status is ImportStatus.NEW)
    changed = tuple(plan for plan in plans if plan.status is ImportStatus.CHANGED)
    if args.yes:
        if changed and not args.replace:
            sys.stderr.write(
                Message(
                    "turndesk: not changed: {names}; add --replace to change existing tools\n",
                    names=_names(changed),
                )
            )
        return new + changed if args.replace else new
    if not new and not changed:
        return ()
    if not sys.stdin.isatty():
        raise CommandError(
            "the import is not confirmed; add --yes, and --replace to change tools that already exist",
            "not-confirmed",
        )
    wanted: tuple[ToolImportPlan, ...] = ()
    if new and _answer(Message("Import the new tools {names}? Press Y and Enter: ", names=_names(new))):
        wanted += new
    question = Message("Replace the values of {names} as shown? Press Y and Enter: ", names=_names(changed))
    if changed and (args.replace or _answer(question)):
        wanted += changed
    return wanted


def _names(plans: Iterable[ToolImportPlan]) -> str:
    return ", ".join(f"T{plan.tool_number}" for plan in plans)


def _answer(question: str) -> bool:
    sys.stderr.write(question)
    sys.stderr.flush()
    return sys.stdin.readline().strip().upper() == "Y"


# --- saving ------------------------------------------------------------------------------------------------


def _save(store: Store, args: argparse.Namespace, plans: tuple[ToolImportPlan, ...], who: str) -> None:
    """Save the planned changes as one step of the offset history.

    Raises CommandError if a value exceeds the travel of the machine, or if the user does not confirm a
    suspicious change. Raises StoreError if the store rejects the change.
    """
    changes = collect_changes(plans)
    confirm_changes(store, args, changes)
    reason = ChangeReason(args.why or Message("import {file}", file=Path(args.file).name), who)
    store.write(lambda connection: offset_tables.change_rows(connection, changes, reason)).result()


# --- preview -----------------------------------------------------------------------------------------------


def _preview(table: ToolTable, plans: Iterable[ToolImportPlan]) -> Iterator[str]:
    """Yield the lines of the preview, one for each changed field and each note."""
    for plan in plans:
        name = f"T{plan.tool_number}"
        if plan.status is ImportStatus.UNCHANGED:
            yield Message("{name} is unchanged", name=name)
        elif plan.status is ImportStatus.SKIPPED:
            yield Message("{name} is not imported ({place})", name=name, place=plan.file_position)
        elif plan.status is ImportStatus.NEW:
            yield Message("{name} is new ({place})", name=name, place=plan.file_position)
        else:
            yield Message("{name} exists and changes ({place})", name=name, place=plan.file_position)
        yield from (f"  {_change(each)}" for each in plan.field_changes)
        yield from (Message("  note: {note}", note=note) for note in plan.notes)
    yield from table.notes


def _change(change: FieldChange) -> str:
    field = FIELDS_BY_KIND[change.offset_kind][change.field_name]
    old = "not set" if change.old_value in {None, ""} else _shown(field.field_type, change.old_value)
    return f"{field.label}: {old} → {_shown(field.field_type, change.new_value)}"


def _shown(sort: FieldType, value: FieldValue | None) -> str:
    if isinstance(value, str) or value is None:
        return str(value)
    if sort is FieldType.LENGTH:
        return f"{convert_to_inches(value):.5f} in"
    if sort is FieldType.BOOLEAN:
        return "yes" if value else "no"
    return f"{value:g}°" if sort is FieldType.ANGLE else f"{value:g}"


def _write_json(
    file: str, word: str, table: ToolTable, plans: Iterable[ToolImportPlan], saved: tuple[ToolImportPlan, ...]
) -> None:
    tools = [
        {
            "number": plan.tool_number,
            "place": plan.file_position,
            "status": plan.status.value,
            "saved": plan in saved,
            "changes": [_change_json(each) for each in plan.field_changes],
            "notes": list(plan.notes),
        }
        for plan in plans
    ]
    result = {"file": file, "format": word, "tools": tools, "notes": list(table.notes)}
    sys.stdout.write(json.dumps(result) + "\n")


def _change_json(change: FieldChange) -> dict[str, object]:
    is_length = FIELDS_BY_KIND[change.offset_kind][change.field_name].field_type is FieldType.LENGTH
    values = [
        convert_to_inches(value) if is_length and value is not None and not isinstance(value, str) else value
        for value in (change.old_value, change.new_value)
    ]
    return {"table": change.offset_kind.value, "field": change.field_name, "old": values[0], "new": values[1]}


IMPORT_OUTPUT = JsonOutput(
    "tools import FILE --json",
    "One object. Lengths are in inches, X is a radius. Without `--yes`, nothing is imported.",
    declare_keys(
        """
file | string | | The file.
format | string | | Its format, as in --from.
tools | list | | Tools of the file.
tools[].number | integer | | Tool number T.
tools[].place | string | | Place in the file.
tools[].status | string | | new, changed, unchanged or left-out (the tool has no values that can be imported).
tools[].saved | boolean | | Whether the changes were saved.
tools[].changes | list | | Values that differ.
tools[].changes[].table | string | | tool or shape.
tools[].changes[].field | string | | Field, as in `offsets show --json`.
tools[].changes[].old | string or number or boolean or null | in, ° | Stored value; null if it is not set.
tools[].changes[].new | string or number or boolean | in, ° | Value of the file.
tools[].notes | list | | Notes about this tool, as sentences.
notes | list | | Notes about the file, as sentences.
"""
    ),
)
