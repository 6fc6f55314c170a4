"""Command ``turndesk share``, which shows, publishes, copies and compares shared programs.

The module also declares the JSON keys of the command.
"""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, get_permitted_user, log_user_change
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, convert_to_command_error
from core.access.access_table import ProtectedChange
from core.json_keys import JsonOutput, declare_keys, prefix_keys
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.sharing.sharing import ProgramSharing, SharingResult
    from core.extras.sharing.shared_versions import ProgramVersions, SharedVersion


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
        add_author_option(action)


def run(args: argparse.Namespace) -> int:
    """Execute the action that the user specified.

    Raises CommandError if there is no [sharing] table or the action fails.
    """
    from app.compose.machine.machine_setup import read_machine
    from app.extras.sharing.location_wait import run_location_work
    from app.extras.sharing.sharing import VersionCopyError
    from app.extras.sharing.sharing_setup import make_program_sharing
    from core.extras.sharing.shared_location import SharingError

    machine, acts = read_machine(args.machine), _acts(args)
    who = get_permitted_user(open_store, args, *acts) if acts else ""
    with (
        convert_to_command_error(SharingError, VersionCopyError),
        open_store(read_only=args.action in _READING) as store,
    ):
        sharing = make_program_sharing(machine, lambda: store)
        if sharing is None:
            raise CommandError(
                "the machine file has no [sharing] table; add it with a folder or a database",
                "no-sharing",
            )
        status = run_location_work(sharing.location, lambda: _ACTIONS[args.action](sharing, args))
    if acts:
        program = f"program {args.name}: " if args.action in {"take", "keep"} else ""
        log_user_change(open_store, who, f"{program}share {args.action}")
    return status


def _acts(args: argparse.Namespace) -> tuple[ProtectedChange, ...]:
    """Return the permissions that the action requires, or an empty tuple if it changes nothing."""
    if args.action in _LOOKING:
        return ()
    alone = args.action == "begin" or getattr(args, "claim", False)
    return (ProtectedChange.SHARED_PLACE,) if alone else (ProtectedChange.PROGRAMS,)


# --- actions ---------------------------------------------------------------------------------------------


def _begin(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    sharing.location.set_up()
    _say(
        args,
        Message("{place} is set up for shared programs", place=sharing.location.name),
        {"place": sharing.location.name},
    )
    return EXIT_OK


def _status(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    shared = sharing.preview_synchronization()
    sys.stdout.write(
        json.dumps(make_status_json(sharing, shared)) + "\n" if args.json else _table(sharing, shared)
    )
    if shared.error_text:
        sys.stderr.write(f"turndesk: {shared.error_text}\n")
    return EXIT_ERRORS if shared.error_text else EXIT_OK


def _publish(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    if args.claim:
        _claim(sharing)
    shared = _looked(sharing)
    if shared.error_text:
        raise CommandError(shared.error_text, "not-shared")
    count = sum(bool(family.local_version_id) for family in shared.versions_by_program.values())
    programs = "the only program" if count == 1 else Message("all {count} programs", count=count)
    _say(
        args,
        Message(
            "{place} contains {programs} from {machine}",
            place=sharing.location.name,
            programs=programs,
            machine=sharing.machine_name,
        ),
        make_status_json(sharing, shared),
    )
    return EXIT_OK


def _claim(sharing: ProgramSharing) -> None:
    from app.desk.data_folder import find_data_folder
    from app.extras.sharing.sharing_setup import store_machine_id
    from core.extras.sharing.shared_versions import make_program_key

    found = sharing.location.read_contents({}).machine_states
    homes = [
        each.machine_id
        for each in found
        if make_program_key(each.machine_name) == make_program_key(sharing.machine_name)
    ]
    if homes:
        sharing.machine_id = store_machine_id(find_data_folder(), homes[0])


def _compare(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    from app.editor.version_history import compare_texts, decode_text

    version = _chosen(sharing.preview_synchronization(), args)
    rows = compare_texts(
        decode_text(sharing.read_local_text(version.program_key)),
        decode_text(sharing.read_version_text(version)),
    )
    if args.json:
        changes = [{"sign": row.sign, "here": row.old, "there": row.new, "text": row.text} for row in rows]
        sys.stdout.write(json.dumps({"version": _of(version), "changes": changes}) + "\n")
        return EXIT_OK
    sys.stdout.write(
        "".join(f"{row.old or '':>5} {row.new or '':>5} {row.sign} {row.text}\n" for row in rows)
    )
    return EXIT_OK


def _take(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    version = _chosen(_looked(sharing), args)
    before = sharing.last_result.versions_by_program[version.program_key].local_version_id
    name = sharing.copy_version(version)
    _looked(sharing)
    template = (
        "{name} is now the version from control {machine}; the previous program text was saved as a version"
        if before
        else "{name} is now the version from control {machine}"
    )
    said = Message(template, name=name, machine=version.desk)
    _say(args, said, {"taken": _of(version), "file": name})
    return EXIT_OK


def _keep(sharing: ProgramSharing, args: argparse.Namespace) -> int:
    from core.extras.sharing.shared_versions import make_program_key

    _looked(sharing)
    sharing.resolve_with_local_version(make_program_key(args.name))
    shared = _looked(sharing)
    wait = (
        Message("; the local version is not published yet: {problem}", problem=shared.error_text)
        if shared.error_text
        else ""
    )
    _say(
        args,
        Message("the local version of {name} is used{wait}", name=args.name, wait=wait),
        {"kept": args.name, "trouble": shared.error_text},
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


def _looked(sharing: ProgramSharing) -> SharingResult:
    shared = sharing.synchronize()
    for name, why in shared.rejected_files.items():
        sys.stderr.write(f"turndesk: {name} is not shared: {why}\n")
    return shared


def _chosen(shared: SharingResult, args: argparse.Namespace) -> SharedVersion:
    from core.extras.sharing.shared_versions import make_program_key

    family = shared.versions_by_program.get(make_program_key(args.name))
    if family is None:
        raise CommandError(
            Message(
                "no control shares a program named {name}; {problem}",
                name=args.name,
                problem=shared.error_text or "for details, run: turndesk share status",
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
    if not family.newest_remote_versions:
        raise CommandError(
            Message(
                "no other control has a newer version of {name}; {problem}",
                name=args.name,
                problem=shared.error_text or "there is nothing to copy",
            ),
            "nothing-newer",
        )
    if len(family.newest_remote_versions) > 1:
        which = ", ".join(
            Message("{item} from {machine}", item=each.id[:8], machine=each.desk)
            for each in family.newest_remote_versions
        )
        raise CommandError(
            Message(
                "other controls have {elsewhere_count} newer versions of {name}: {which}; "
                "choose one with --id ID",
                name=args.name,
                elsewhere_count=len(family.newest_remote_versions),
                which=which,
            ),
            "many-versions",
        )
    return family.newest_remote_versions[0]


# --- output ----------------------------------------------------------------------------------------------


def _say(args: argparse.Namespace, words: str, values: dict[str, object]) -> None:
    sys.stdout.write((json.dumps(values) if args.json else words) + "\n")


def make_status_json(sharing: ProgramSharing, result: SharingResult) -> dict[str, object]:
    """Return all known data about shared programs as a JSON object for scripts."""
    return {
        "place": sharing.location.name,
        "desk": sharing.machine_name,
        "trouble": result.error_text or None,
        "waiting": result.unpublished_version_count,
        "programs": [_program(result, family) for _, family in sorted(result.versions_by_program.items())],
        "desks": [
            {"desk": each.machine_name, "told": each.reported_at, "has": dict(each.version_ids)}
            for each in result.machine_states
        ],
        "strays": list(result.foreign_items),
        "not_shared": dict(result.rejected_files),
    }


def _program(shared: SharingResult, family: ProgramVersions) -> dict[str, object]:
    here = family.versions.get(family.local_version_id)
    newest = family.newest_versions
    return {
        "program": (here or newest[0]).program,
        "state": family.sharing_state,
        "here": _of(here) if here is not None else None,
        "elsewhere": [
            _of(each) | {"on": list(shared.find_machines_with_version(each.id))}
            for each in family.newest_remote_versions
        ],
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


def _table(sharing: ProgramSharing, shared: SharingResult) -> str:
    lines = [
        f"{sharing.machine_name} shares in {sharing.location.name}; versions that wait: "
        f"{shared.unpublished_version_count}\n"
    ]
    for _, family in sorted(shared.versions_by_program.items()):
        name = (family.versions.get(family.local_version_id) or family.newest_versions[0]).program
        lines.append(f"{name:24}  {_STATES[family.sharing_state]}\n")
        for each in family.newest_remote_versions:
            on = ", ".join(shared.find_machines_with_version(each.id)) or (
                "-" if shared.error_text else "no desk"
            )
            lines.append(f"    {each.id[:8]}  {each.desk}  {each.saved}  {each.size} bytes  on {on}\n")
    lines += [f"{name} is not shared: {why}\n" for name, why in shared.rejected_files.items()]
    if shared.foreign_items:
        lines.append(f"no versions, left as they are: {', '.join(shared.foreign_items[:5])}\n")
    return "".join(lines)


_VERSION = declare_keys(
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
    *declare_keys(
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
    *prefix_keys("programs[].here.", _VERSION),
    *declare_keys(
        "programs[].elsewhere | list | | Newest versions of other machines that this machine does not have."
    ),
    *prefix_keys("programs[].elsewhere[].", _VERSION),
    *declare_keys(
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
SHARE_STATUS_OUTPUT = JsonOutput("share status --json, share publish --json", "One object.", _SHARED)
SHARE_BEGIN_OUTPUT = JsonOutput(
    "share begin --json", "One object.", declare_keys("place | string | | The shared location.")
)
SHARE_COMPARE_OUTPUT = JsonOutput(
    "share compare PROGRAM --json",
    "One object.",
    (
        *declare_keys("version | object | | The version that is compared."),
        *prefix_keys("version.", _VERSION),
        *declare_keys(
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
SHARE_COPY_OUTPUT = JsonOutput(
    "share take PROGRAM --json",
    "One object.",
    (
        *declare_keys("taken | object | | The version that was copied."),
        *prefix_keys("taken.", _VERSION),
        *declare_keys("file | string | | File name in the program folder."),
    ),
)
SHARE_KEEP_OUTPUT = JsonOutput(
    "share keep PROGRAM --json",
    "One object.",
    declare_keys(
        """
kept | string | | File name of the program.
trouble | string | | Why the version is not published yet; empty if it is published.
"""
    ),
)
OUTPUTS = (
    SHARE_BEGIN_OUTPUT,
    SHARE_STATUS_OUTPUT,
    SHARE_COMPARE_OUTPUT,
    SHARE_COPY_OUTPUT,
    SHARE_KEEP_OUTPUT,
)
PRECEDING_COMMAND = "store verify --json"
"""Command that precedes the commands of this feature in the command reference."""
