"""``turndesk jobs``: the queue of programs that are to be made, and how many parts of each."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from app.cli.store_command import opened_store
from app.cli.who_changes import COMMAND_LINE, add_as_option, who_changes
from app.desk.command_errors import EXIT_OK, CommandError
from core.access.access_table import Act

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.store.job_queue import JobRow
    from core.store.store import Store


def add_parser(subparsers: SubParsers) -> None:
    """The subcommand with its actions."""
    parser = subparsers.add_parser("jobs", help="the queue of programs that are made next, with their counts")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    listing = actions.add_parser("list", help="the queue in its order, with what is made")
    listing.add_argument("--json", action="store_true", help="machine-readable output alone on stdout")
    more = actions.add_parser("add", help="one more job at the end of the queue")
    more.add_argument("name", metavar="PROGRAM", help="of the program folder, as F2 finds it")
    more.add_argument("parts", type=int, metavar="PARTS", help="how many are to be made")
    more.add_argument("--note", default="", metavar="TEXT", help="order, customer, material: 80 letters")
    move = actions.add_parser("move", help="a job to another place of the queue")
    move.add_argument("place", type=int, metavar="PLACE", help="as 'turndesk jobs list' counts them, from 1")
    move.add_argument("to", type=int, metavar="TO")
    gone = actions.add_parser("remove", help="take a job out; the part count of its program stays")
    gone.add_argument("place", type=int, metavar="PLACE")
    clear = actions.add_parser("clear", help="take out what is done")
    for each in (more, move, gone, clear):
        add_as_option(each)
    clear.add_argument("--all", action="store_true", help="everything, done or not")


def run(args: argparse.Namespace) -> int:
    """Does what ``args`` asks; raises CommandError with one sentence."""
    with opened_store(read_only=args.action == "list") as store:
        who = who_changes(store, args, Act.JOBS) if args.action != "list" else COMMAND_LINE
        told = _ACTIONS[args.action](store, args)
        if who != COMMAND_LINE:
            store.log_event("change", f"jobs: {told.strip()}", who=who).result()
    sys.stdout.write(told)
    return EXIT_OK


def _list(store: Store, args: argparse.Namespace) -> str:
    jobs = store.jobs()
    if args.json:
        return json.dumps({"jobs": [_told(place, row) for place, row in enumerate(jobs, 1)]}, indent=1) + "\n"
    if not jobs:
        return "no job waits; 'turndesk jobs add PROGRAM PARTS' adds one\n"
    return "".join(_line(place, row) for place, row in enumerate(jobs, 1))


def _told(place: int, row: JobRow) -> dict[str, object]:
    return {
        "place": place,
        "program": row.program,
        "parts": row.wanted,
        "made": row.made,
        "left": row.left,
        "state": _state(row),
        "note": row.note,
        "added": row.added,
    }


def _state(row: JobRow) -> str:
    if row.done:
        return "done"
    return "under way" if row.under_way else "waiting"


def _line(place: int, row: JobRow) -> str:
    note = f"  {row.note}" if row.note else ""
    return f"{place:3d}  {row.program}  {row.made} of {row.wanted} parts  {_state(row)}{note}\n"


def _add(store: Store, args: argparse.Namespace) -> str:
    from app.compose.workshop import samples
    from app.desk.data_folder import data_folder
    from app.desk.program_folder import ProgramFolders
    from core.store import job_queue

    folder = data_folder() / "programs"
    path = ProgramFolders((folder, samples())).find(args.name)
    if path is None or path.parent not in {folder, samples()}:
        raise CommandError(
            f"{args.name} is not among the programs of {folder}; put it there first", "not-a-program"
        )
    store.write(lambda c: job_queue.add(c, path.name, args.parts, args.note)).result()
    return f"{path.name}, {args.parts} parts, is job {len(store.jobs())}\n"


def _move(store: Store, args: argparse.Namespace) -> str:
    from core.store import job_queue

    row = _at(store, args.place)
    _at(store, args.to)
    store.write(lambda c: job_queue.move(c, row.id, args.to)).result()
    return f"{row.program} is job {args.to}\n"


def _remove(store: Store, args: argparse.Namespace) -> str:
    from core.store import job_queue

    row = _at(store, args.place)
    store.write(lambda c: job_queue.remove(c, row.id)).result()
    return f"{row.program} is taken out, {row.made} of {row.wanted} parts made\n"


def _clear(store: Store, args: argparse.Namespace) -> str:
    from core.store import job_queue

    count = store.write(lambda c: job_queue.clear(c, everything=args.all)).result()
    return f"{count} {'job' if count == 1 else 'jobs'} taken out\n"


def _at(store: Store, place: int) -> JobRow:
    jobs = store.jobs()
    if not 1 <= place <= len(jobs):
        known = f"there are {len(jobs)}" if jobs else "the queue is empty"
        raise CommandError(
            f"there is no job {place}: {known}; 'turndesk jobs list' numbers them", "unknown-job"
        )
    return jobs[place - 1]


_ACTIONS = {"list": _list, "add": _add, "move": _move, "remove": _remove, "clear": _clear}
