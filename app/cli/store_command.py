"""The command ``turndesk store``, which manages the store.

The command backs up, restores, exports, imports, upgrades and verifies the store.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.change_author import (
    COMMAND_LINE_USER,
    add_author_option,
    add_confirmation_options,
    get_change_author,
    get_permitted_user,
    log_user_change,
)
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, convert_to_command_error
from app.desk.data_folder import find_data_folder
from core.access.access_table import ProtectedChange
from core.message import Message

if TYPE_CHECKING:
    from app.cli.actions.change_confirmation import OffsetChanges
    from app.cli.program_options import SubParsers
    from core.store.store import Store
    from core.store.store_rows import FieldValue, OffsetRow


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``store`` and its actions."""
    parser = subparsers.add_parser("store")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, what, text in (
        ("backup", "FILE", "copy all stored data to FILE, even while the data is in use"),
        (
            "restore",
            "FILE",
            ("replace the stored data with a backup; the replaced data is saved next to the new data"),
        ),
        ("export", "DIR", "write programs, offsets.toml, and events, runs and measured parts as CSV"),
        ("import", "DIR", "import programs, offsets, tools and presets from an exported folder"),
    ):
        action = actions.add_parser(name, help=text)
        action.add_argument("path", metavar=what)
        if name in {"restore", "import"}:
            add_author_option(action)
        if name == "import":
            add_confirmation_options(action)
    actions.add_parser(
        "upgrade",
        help="upgrade the stored data of an older TurnDesk version, as the operator screen also does",
    )
    verify = actions.add_parser(
        "verify", help="check every database page, reference and program text of the stored data"
    )
    verify.add_argument("--json", action="store_true", help="print only JSON on stdout")


def run(args: argparse.Namespace) -> int:
    """Run the action of ``turndesk store``. Raises CommandError if the action fails."""
    return STORE_ACTIONS[args.action](args)


# --- Store of this installation, opened for one command --------------------------------------------------


@contextmanager
def convert_store_errors() -> Iterator[None]:
    """Convert a StoreError inside the block to a CommandError."""
    from core.store.store_errors import StoreError

    with convert_to_command_error(StoreError):
        yield


@contextmanager
def open_store(*, read_only: bool = False) -> Iterator[Store]:
    """Open the store for the block and close it afterwards. Raises CommandError for every store error."""
    from core.store.store import Store

    with convert_store_errors(), Store.open(find_data_folder(), read_only=read_only) as store:
        yield store


@contextmanager
def _show_progress(description: str) -> Iterator[Callable[[int, int], None]]:
    """Show progress on a terminal. Yield the function that reports the finished part and the total."""
    from app.cli.proofs.progress_bar import ProgressBar

    with ProgressBar(description) as progress:

        def report_part(finished: int, total: int) -> None:
            progress.total = total
            progress.report_progress(finished)

        yield report_part


# --- Actions ---------------------------------------------------------------------------------------------


def _backup(args: argparse.Namespace) -> int:
    from core.store import backup

    with convert_store_errors(), _show_progress(f"backing up to {args.path}") as report_pages:
        backup.back_up_store(find_data_folder(), Path(args.path), report_pages)
    sys.stdout.write(f"{find_data_folder()} was backed up to {args.path}\n")
    return EXIT_OK


def _restore(args: argparse.Namespace) -> int:
    from core.store import backup

    who = get_permitted_user(open_store, args, ProtectedChange.RESTORE)
    with convert_store_errors(), _show_progress(f"restoring {args.path}") as report_pages:
        kept = backup.restore_store(find_data_folder(), Path(args.path), report_pages)
    saved = Message("; the previous data was saved as {saved}", saved=kept) if kept else ""
    log_user_change(open_store, who, Message("restored from {path}{saved}", path=args.path, saved=saved))
    done = Message(
        "{folder} was restored from {path}{saved}", folder=find_data_folder(), path=args.path, saved=saved
    )
    sys.stdout.write(f"{done}\n")
    return EXIT_OK


def _export(args: argparse.Namespace) -> int:
    from core.store import store_export

    with open_store(read_only=True) as store:
        count = store_export.export_store(store, Path(args.path))
    sys.stdout.write(f"exported to {args.path}: programs: {count}, the offsets, the events and the runs\n")
    return EXIT_OK


def _import(args: argparse.Namespace) -> int:
    from app.cli.actions.change_confirmation import confirm_changes
    from app.offsets.offsets_file import read_offset_rows, read_shape_rows
    from core.store import store_export
    from core.store.offsets.offset_tables import ChangeReason
    from core.store.store_rows import OffsetKind

    folder = Path(args.path)
    offsets_file = folder / store_export.OFFSETS
    tools, secondary, zero = read_offset_rows(offsets_file) if offsets_file.exists() else ({}, {}, {})
    shapes = read_shape_rows(offsets_file) if offsets_file.exists() else {}
    with open_store() as store:
        programs = store_export.read_exported_programs(folder)
        mill, why = (
            store_export.read_exported_mill_rows(folder),
            Message("import from {folder}", folder=folder.name),
        )
        offsets: OffsetChanges = {
            OffsetKind.TOOL: _row_values(tools),
            OffsetKind.SECONDARY: _row_values(secondary),
            OffsetKind.ZERO: _row_values(zero),
            OffsetKind.SHAPE: _row_values(shapes),
            **mill,
        }
        named = get_change_author(store, args, ProtectedChange.RESTORE)
        confirm_changes(
            store, args, {kind: offsets[kind] for kind in (OffsetKind.TOOL, OffsetKind.SECONDARY, *mill)}
        )
        who = "import" if named == COMMAND_LINE_USER else named
        store.write(
            lambda c: store_export.import_programs_and_offsets(c, programs, offsets, ChangeReason(why, who))
        ).result()
    counts: str = Message(
        "{programs_count}, tool offsets: {tools_count}, secondary offsets: {secondary_count}",
        programs_count=len(programs),
        tools_count=len(tools),
        secondary_count=len(secondary),
    )
    if any(mill.values()):
        counts += Message(
            ", mill tools: {mill_count}, presets: {mill_count2}",
            mill_count=len(mill[OffsetKind.MILL_TOOL]),
            mill_count2=len(mill[OffsetKind.PRESET]),
        )
    sys.stdout.write(f"imported from {folder}: programs: {counts}\n")
    return EXIT_OK


def _row_values(rows: Mapping[int, OffsetRow]) -> dict[int, Mapping[str, FieldValue]]:
    """Return the imported rows by number, with all fields of each row as changes."""
    return {number: row._asdict() for number, row in rows.items()}


def _upgrade(_args: argparse.Namespace) -> int:
    """Upgrade the store by opening it for writing. A copy of the old version is saved in the same folder."""
    from core.store.store_file import has_store

    there = has_store(find_data_folder())
    if there:
        with open_store():
            pass
    status_text = (
        Message("the data store in {data_folder} is up to date", data_folder=find_data_folder())
        if there
        else Message("{data_folder} does not contain any stored data yet", data_folder=find_data_folder())
    )
    sys.stdout.write(f"{status_text}\n")
    return EXIT_OK


def _verify(args: argparse.Namespace) -> int:
    from core.store import backup
    from core.store.store_file import STORE_FILE_NAME, has_store

    path = find_data_folder() / STORE_FILE_NAME
    with convert_store_errors(), _show_progress(f"verifying {path}") as report_checks:
        problems = backup.find_all_store_problems(path, report_checks) if has_store(path.parent) else ()
    if args.json:
        sys.stdout.write(json.dumps({"store": str(path), "problems": problems}) + "\n")
    elif not problems:
        sys.stdout.write(
            f"{path} is undamaged\n"
            if has_store(find_data_folder())
            else Message("{data_folder} does not contain any stored data yet", data_folder=find_data_folder())
            + "\n"
        )
    sys.stderr.write("".join(f"turndesk: {path}: {problem}\n" for problem in problems))
    return EXIT_ERRORS if problems else EXIT_OK


STORE_ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "backup": _backup,
    "restore": _restore,
    "export": _export,
    "import": _import,
    "upgrade": _upgrade,
    "verify": _verify,
}
