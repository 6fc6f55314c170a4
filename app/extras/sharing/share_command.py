"""Command ``turndesk share``: status, publish, take and compare shared programs; its JSON keys."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from app.cli.store_command import opened_store
from app.cli.who_changes import add_as_option, note_change, who_may
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, as_command_error
from core.access.access_table import Act
from core.json_key import Output, below, keys
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.sharing.sharing import Shared, Sharing
    from core.extras.sharing.shared_versions import Family, SharedVersion


def add_parser(subparsers: SubParsers) -> None:
    """Declare the actions and options of the command."""
    parser = subparsers.add_parser("share")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    begin = actions.add_parser(
        "begin", help="set up the shared location specified in [sharing], once for all controls"
    )
    status = actions.add_parser(
        "status",
        help="show which programs are newer on other controls and which control has which "
        "version, without changing anything",
    )
    publish = actions.add_parser(
        "publish", help="publish new local versions now and check for new versions on other controls"
    )
    publish.add_argument(
        "--claim",
        action="store_true",
        help="take over the name of this control from a computer that no longer exists",
    )
    compare = actions.add_parser(
        "compare", help="show line by line how a version from another control would change the program"
    )
    take = actions.add_parser("take", help="copy a version from another control into the program folder")
    keep = actions.add_parser("keep", help="use the local version instead of the changes made elsewhere")
    for action in (compare, take, keep):
        action.add_argument("name", metavar="PROGRAM")
    for action in (compare, take):
        action.add_argument(
            "--id",
            metavar="ID",
            help="first characters of the version ID, as shown by 'turndesk share status'",
        )
    for action in (begin, status, publish, compare, take, keep):
        action.add_argument("--machine", metavar="FILE", help="machine file with a [sharing] table")
        action.add_argument("--json", action="store_true", help="print only JSON on stdout")
    for action in (begin, publish, take, keep):
        add_as_option(action)


def run(args: argparse.Namespace) -> int:
    """Execute the action. Raises CommandError."""
    from app.compose.machine.machine_setup import read_machine
    from app.extras.sharing.place_answer import answered
    from app.extras.sharing.sharing import TakeError
    from app.extras.sharing.sharing_desk import sharing_of
    from core.extras.sharing.shared_place import SharingError

    machine, acts = read_machine(args.machine), _acts(args)
    who = who_may(opened_store, args, *acts) if acts else ""
    with (
        as_command_error(SharingError, TakeError),
        opened_store(read_only=args.action in _READING) as store,
    ):
        sharing = sharing_of(machine, lambda: store)
        if sharing is None:
            raise CommandError(
                "the machine file has no [sharing] table; add it with a folder or a database",
                "no-sharing",
            )
        status = answered(sharing.place, lambda: _ACTIONS[args.action](sharing, args))
    if acts:
        program = f"program {args.name}: " if args.action in {"take", "keep"} else ""
        note_change(opened_store, who, f"{program}share {args.action}")
    return status


def _acts(args: argparse.Namespace) -> tuple[Act, ...]:
    """Return the permissions that the action needs, or an empty tuple if it only reads."""
    if args.action in _LOOKING:
        return ()
    alone = args.action == "begin" or getattr(args, "claim", False)
    return (Act.SHARED_PLACE,) if alone else (Act.PROGRAMS,)


# --- actions ---------------------------------------------------------------------------------------------


def _begin(sharing: Sharing, args: argparse.Namespace) -> int:
    sharing.place.begin()
    _say(
        args,
        Message("{place} is set up for shared programs", place=sharing.place.name),
        {"place": sharing.place.name},
    )
    return EXIT_OK


def _status(sharing: Sharing, args: argparse.Namespace) -> int:
    shared = sharing.peek()
    sys.stdout.write(json.dumps(told(sharing, shared)) + "\n" if args.json else _table(sharing, shared))
    if shared.trouble:
        sys.stderr.write(f"turndesk: {shared.trouble}\n")
    return EXIT_ERRORS if shared.trouble else EXIT_OK


def _publish(sharing: Sharing, args: argparse.Namespace) -> int:
    if args.claim:
        _claim(sharing)
    shared = _looked(sharing)
    if shared.trouble:
        raise CommandError(shared.trouble, "not-shared")
    count = sum(bool(family.here) for family in shared.families.values())
    programs = "the only program" if count == 1 else Message("all {count} programs", count=count)
    _say(
        args,
        Message(
            "{place} contains {programs} from {machine}",
            place=sharing.place.name,
            programs=programs,
            machine=sharing.desk,
        ),
        told(sharing, shared),
    )
    return EXIT_OK


def _claim(sharing: Sharing) -> None:
    from app.desk.data_folder import data_folder
    from app.extras.sharing.sharing_desk import claim
    from core.extras.sharing.shared_versions import key_of

    found = sharing.place.look({}).desks
    homes = [each.home for each in found if key_of(each.desk) == key_of(sharing.desk)]
    if homes:
        sharing.home = claim(data_folder(), homes[0])


def _compare(sharing: Sharing, args: argparse.Namespace) -> int:
    from app.editor.versions import differences, lines_of

    version = _chosen(sharing.peek(), args)
    rows = differences(lines_of(sharing.text_here(version.key)), lines_of(sharing.text(version)))
    if args.json:
        changes = [{"sign": row.sign, "here": row.old, "there": row.new, "text": row.text} for row in rows]
        sys.stdout.write(json.dumps({"version": _of(version), "changes": changes}) + "\n")
        return EXIT_OK
    sys.stdout.write(
        "".join(f"{row.old or '':>5} {row.new or '':>5} {row.sign} {row.text}\n" for row in rows)
    )
    return EXIT_OK


def _take(sharing: Sharing, args: argparse.Namespace) -> int:
    version = _chosen(_looked(sharing), args)
    before = sharing.now.families[version.key].here
    name = sharing.take(version)
    _looked(sharing)
    template = (
        "{name} is now the version from control {machine}; the previous program text was saved as a version"
        if before
        else "{name} is now the version from control {machine}"
    )
    said = Message(template, name=name, machine=version.desk)
    _say(args, said, {"taken": _of(version), "file": name})
    return EXIT_OK


def _keep(sharing: Sharing, args: argparse.Namespace) -> int:
    from core.extras.sharing.shared_versions import key_of

    _looked(sharing)
    sharing.keep(key_of(args.name))
    shared = _looked(sharing)
    wait = (
        Message("; the local version is not published yet: {problem}", problem=shared.trouble)
        if shared.trouble
        else ""
    )
    _say(
        args,
        Message("the local version of {name} is used{wait}", name=args.name, wait=wait),
        {"kept": args.name, "trouble": shared.trouble},
    )
    return EXIT_OK


_ACTIONS = {
    "begin": _begin,
    "status": _status,
    "publish": _publish,
    "compare": _compare,
    "take": _take,
    "keep": _keep,
}
_LOOKING = frozenset({"status", "compare"})
_READING = _LOOKING | {"begin"}  # the store is opened read-only while TurnDesk runs


def _looked(sharing: Sharing) -> Shared:
    shared = sharing.look()
    for name, why in shared.refused.items():
        sys.stderr.write(f"turndesk: {name} is not shared: {why}\n")
    return shared


def _chosen(shared: Shared, args: argparse.Namespace) -> SharedVersion:
    from core.extras.sharing.shared_versions import key_of

    family = shared.families.get(key_of(args.name))
    if family is None:
        raise CommandError(
            Message(
                "no control shares a program named {name}; {problem}",
                name=args.name,
                problem=shared.trouble or "for details, run: turndesk share status",
            ),
            "not-shared-program",
        )
    if args.id:
        found = [each for each in family.versions.values() if each.id.startswith(args.id)]
        if len(found) != 1:
            template = (
                "found {count} versions of {name} with an ID that begins with {id}; see turndesk share "
                "status --json"
                if found
                else "no version of {name} has an ID that begins with {id}; see turndesk share status --json"
            )
            raise CommandError(
                Message(template, count=len(found), name=args.name, id=args.id), "no-one-version"
            )
        return found[0]
    if not family.elsewhere:
        raise CommandError(
            Message(
                "no other control has a newer version of {name}; {problem}",
                name=args.name,
                problem=shared.trouble or "there is nothing to copy",
            ),
            "nothing-newer",
        )
    if len(family.elsewhere) > 1:
        which = ", ".join(
            Message("{item} from {machine}", item=each.id[:8], machine=each.desk) for each in family.elsewhere
        )
        raise CommandError(
            Message(
                "other controls have {elsewhere_count} newer versions of {name}: {which}; "
                "choose one with --id ID",
                name=args.name,
                elsewhere_count=len(family.elsewhere),
                which=which,
            ),
            "many-versions",
        )
    return family.elsewhere[0]


# --- output ----------------------------------------------------------------------------------------------


def _say(args: argparse.Namespace, words: str, values: dict[str, object]) -> None:
    sys.stdout.write((json.dumps(values) if args.json else words) + "\n")


def told(sharing: Sharing, shared: Shared) -> dict[str, object]:
    """Return all known data for scripts."""
    return {
        "place": sharing.place.name,
        "desk": sharing.desk,
        "trouble": shared.trouble or None,
        "waiting": shared.waiting,
        "programs": [_program(shared, family) for _, family in sorted(shared.families.items())],
        "desks": [{"desk": each.desk, "told": each.at, "has": dict(each.has)} for each in shared.desks],
        "strays": list(shared.strays),
        "not_shared": dict(shared.refused),
    }


def _program(shared: Shared, family: Family) -> dict[str, object]:
    here = family.versions.get(family.here)
    newest = family.newest
    return {
        "program": (here or newest[0]).program,
        "state": family.state,
        "here": _of(here) if here is not None else None,
        "elsewhere": [_of(each) | {"on": list(shared.who_has(each.id))} for each in family.elsewhere],
        "versions": len(family.versions),
    }


def _of(version: SharedVersion) -> dict[str, object]:
    return {
        "id": version.id,
        "desk": version.desk,
        "saved": version.saved,
        "size": version.size,
        "why": version.why,
        "follows": list(version.follows),
    }


_STATES = {
    "same": "the newest",
    "newer": "newer elsewhere",
    "both": "changed on this control and elsewhere",
    "new": "not here",
}


def _table(sharing: Sharing, shared: Shared) -> str:
    lines = [f"{sharing.desk} shares in {sharing.place.name}; versions that wait: {shared.waiting}\n"]
    for _, family in sorted(shared.families.items()):
        name = (family.versions.get(family.here) or family.newest[0]).program
        lines.append(f"{name:24}  {_STATES[family.state]}\n")
        for each in family.elsewhere:
            on = ", ".join(shared.who_has(each.id)) or ("-" if shared.trouble else "no desk")
            lines.append(f"    {each.id[:8]}  {each.desk}  {each.saved}  {each.size} bytes  on {on}\n")
    lines += [f"{name} is not shared: {why}\n" for name, why in shared.refused.items()]
    if shared.strays:
        lines.append(f"no versions, left as they are: {', '.join(shared.strays[:5])}\n")
    return "".join(lines)


_VERSION = keys(
    """
id | string | | ID of the version.
desk | string | | Machine that saved the version.
saved | string | UTC | Time at which it was saved.
size | integer | bytes | Size of the program.
why | string | | Reason for saving.
follows | list | | IDs of the versions on which it is based.
"""
)
_SHARED = (
    *keys(
        """
place | string | | The shared location.
desk | string | | Name of this machine in the list of machines.
trouble | string or null | | Why the shared location does not respond; null if it responds.
waiting | integer | | Versions that are not yet published.
programs | list | | Shared programs.
programs[].program | string | | File name of the program.
programs[].state | string | | same, newer (a newer version exists on another machine), both (changed here
    and on another machine) or new (not on this machine).
programs[].here | object or null | | Version on this machine; null if not available.
"""
    ),
    *below("programs[].here.", _VERSION),
    *keys(
        "programs[].elsewhere | list | | Newest versions of other machines that this machine does not have."
    ),
    *below("programs[].elsewhere[].", _VERSION),
    *keys(
        """
programs[].elsewhere[].on | list | | Machines that have this version.
programs[].versions | integer | | Number of known versions.
desks | list | | Machines that share programs.
desks[].desk | string | | Name of the machine.
desks[].told | string | UTC | Time of its last report.
desks[].has | object | | Its programs.
desks[].has.* | string | | ID of the version, by program.
strays | list | | Files in the shared location that are not versions.
not_shared | object | | Programs that are not shared.
not_shared.* | string | | Reason, by program.
"""
    ),
)
SHARE_STATUS = Output("share status --json, share publish --json", "One object.", _SHARED)
SHARE_BEGIN = Output("share begin --json", "One object.", keys("place | string | | The shared location."))
SHARE_COMPARE = Output(
    "share compare PROGRAM --json",
    "One object.",
    (
        *keys("version | object | | The version that is compared."),
        *below("version.", _VERSION),
        *keys(
            """
changes | list | | Lines of the comparison.
changes[].sign | string | | + (added), − as a hyphen (removed) or a space (unchanged).
changes[].here | integer or null | | Line in the local program; null if the local program does not contain it.
changes[].there | integer or null | | Line in the other version; null if that version does not contain it.
changes[].text | string | | Text of the line.
"""
        ),
    ),
)
SHARE_TAKE = Output(
    "share take PROGRAM --json",
    "One object.",
    (
        *keys("taken | object | | The version that was copied."),
        *below("taken.", _VERSION),
        *keys("file | string | | File name in the program folder."),
    ),
)
SHARE_KEEP = Output(
    "share keep PROGRAM --json",
    "One object.",
    keys(
        """
kept | string | | File name of the program.
trouble | string | | Why the version is not published yet; empty if it is published.
"""
    ),
)
OUTPUTS = (SHARE_BEGIN, SHARE_STATUS, SHARE_COMPARE, SHARE_TAKE, SHARE_KEEP)
FOLLOWS = "store verify --json"
"""The command that the commands of this feature follow in the reference."""
