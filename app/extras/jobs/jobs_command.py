"""Command ``turndesk jobs``, which manages the queue of programs and their part counts.

The module also declares the JSON keys of the command.
"""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from app.cli.change_author import COMMAND_LINE_USER, add_author_option, get_change_author
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_OK, CommandError
from core.access.access_table import ProtectedChange
from core.json_keys import JsonOutput, declare_keys
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.store.production.job_queue import JobRow
    from core.store.store import Store


def add_parser(subparsers: SubParsers) -> None:
    """Declare the actions and options of the command."""
    parser = subparsers.add_parser("jobs")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    listing = actions.add_parser("list", help="list the queue in order, with the number of parts made")
    listing.add_argument("--json", action="store_true", help="print only JSON on stdout")
    more = actions.add_parser("add", help="add a job to the end of the queue")
    more.add_argument(
        "name", metavar="PROGRAM", help="name of a program in the program folder, as F2 lists it"
    )
    more.add_argument("parts", type=int, metavar="PARTS", help="number of parts to make")
    more.add_argument(
        "--note",
        default="",
        metavar="TEXT",
        help="note such as order, customer or material, up to 80 characters",
    )
    move = actions.add_parser("move", help="move a job to another position in the queue")
    move.add_argument(
        "place", type=int, metavar="PLACE", help="job number as shown by 'turndesk jobs list', starting at 1"
    )
    move.add_argument("to", type=int, metavar="TO")
    gone = actions.add_parser("remove", help="remove a job; the part count of its program is retained")
    gone.add_argument("place", type=int, metavar="PLACE")
    clear = actions.add_parser("clear", help="remove finished jobs")
    for each in (more, move, gone, clear):
        add_author_option(each)
    clear.add_argument("--all", action="store_true", help="remove all jobs, finished or not")


def run(args: argparse.Namespace) -> int:
    """Execute the action that the user specified.

    Raises CommandError if the action fails.
    """
    with open_store(read_only=args.action == "list") as store:
        who = (
            get_change_author(store, args, ProtectedChange.JOBS)
            if args.action != "list"
            else COMMAND_LINE_USER
        )
        result_text = _ACTIONS[args.action](store, args)
        if who != COMMAND_LINE_USER:
            store.events.log_event("change", f"jobs: {result_text.strip()}", author=who).result()
    sys.stdout.write(result_text)
    return EXIT_OK


def _list(store: Store, args: argparse.Namespace) -> str:
    jobs = store.jobs.read_jobs()
    if args.json:
        return json.dumps({"jobs": [_told(place, row) for place, row in enumerate(jobs, 1)]}, indent=1) + "\n"
    if not jobs:
        return "no job waits; 'turndesk jobs add PROGRAM PARTS' adds one\n"
    return "".join(_line(place, row) for place, row in enumerate(jobs, 1))


def _told(place: int, row: JobRow) -> dict[str, object]:
    return {
        "place": place,
        "program": row.program,
        "parts": row.parts_to_make,
        "made": row.parts_made,
        "left": row.remaining_part_count,
        "state": _state(row),
        "note": row.note,
        "added": row.added_at,
    }


def _state(row: JobRow) -> str:
    if row.is_done:
        return "done"
    return "under way" if row.is_active else "waiting"


def _line(place: int, row: JobRow) -> str:
    note = f"  {row.note}" if row.note else ""
    return f"{place:3d}  {row.program}  {row.parts_made} of {row.parts_to_make} parts  {_state(row)}{note}\n"


def _add(store: Store, args: argparse.Namespace) -> str:
    from app.compose.program_proving import get_samples_folder
    from app.desk.data_folder import find_data_folder
    from app.desk.programs.program_folder import ProgramFolders

    folder = find_data_folder() / "programs"
    path = ProgramFolders((folder, get_samples_folder())).find_path(args.name)
    if path is None or path.parent not in {folder, get_samples_folder()}:
        raise CommandError(
            Message(
                "program {name} is not in {folder}; copy it there first",
                name=args.name,
                folder=folder,
            ),
            "not-a-program",
        )
    store.jobs.add_job(path.name, args.parts, args.note).result()
    return f"{path.name}, {args.parts} parts, is job {len(store.jobs.read_jobs())}\n"


def _move(store: Store, args: argparse.Namespace) -> str:
    row = _at(store, args.place)
    _at(store, args.to)
    store.jobs.move_job(row.id, args.to).result()
    return f"{row.program} is job {args.to}\n"


def _remove(store: Store, args: argparse.Namespace) -> str:
    row = _at(store, args.place)
    store.jobs.remove_job(row.id).result()
    return f"{row.program} is taken out, {row.parts_made} of {row.parts_to_make} parts made\n"


def _clear(store: Store, args: argparse.Namespace) -> str:
    count = store.jobs.clear_jobs(remove_all=args.all).result()
    return f"{count} {'job' if count == 1 else 'jobs'} taken out\n"


def _at(store: Store, place: int) -> JobRow:
    jobs = store.jobs.read_jobs()
    if not 1 <= place <= len(jobs):
        known = (
            Message("jobs in the queue: {jobs_count}", jobs_count=len(jobs)) if jobs else "the queue is empty"
        )
        raise CommandError(
            Message(
                "job {place} does not exist ({known}); 'turndesk jobs list' shows the job numbers",
                place=place,
                known=known,
            ),
            "unknown-job",
        )
    return jobs[place - 1]


_ACTIONS = {"list": _list, "add": _add, "move": _move, "remove": _remove, "clear": _clear}


JOBS_OUTPUT = JsonOutput(
    "jobs list --json",
    "One object.",
    declare_keys(
        """
jobs | list | | The job queue, in order.
jobs[].place | integer | | Position, from 1.
jobs[].program | string | | File name of the program.
jobs[].parts | integer | | Parts to make.
jobs[].made | integer | | Parts made.
jobs[].left | integer | | Parts that remain to be made.
jobs[].state | string | | waiting, in progress or done.
jobs[].note | string | | Note.
jobs[].added | string | UTC | Time at which the job was added.
"""
    ),
)
OUTPUTS = {"shift --json": (JOBS_OUTPUT,)}
