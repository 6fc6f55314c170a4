"""Command ``turndesk access`` for users, levels and PINs, and the PIN prompt of other commands."""

from __future__ import annotations

import argparse
import getpass
import json
import sys
import time
from typing import TYPE_CHECKING

from app.cli.change_author import RESET, add_author_option, get_change_author, require_terminal_confirmation
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_OK, CommandError, convert_to_command_error
from core.access.access_table import ACCESS_RULES, AccessLevel, ProtectedChange
from core.json_keys import JsonOutput, declare_keys
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.store.store import Store
    from core.store.user_records import UserRow


ACCESS_LIST_OUTPUT = JsonOutput(
    "access list --json",
    "One object.",
    declare_keys(
        """
on | boolean | | Whether access levels are on.
damaged | boolean | | Whether an entry of a user is damaged, so that this user cannot log in.
people | list | | Users.
people[].name | string | | Name.
people[].level | string | | Level: OPERATOR, SETUP or SERVICE.
"""
    ),
)
ACCESS_TABLE_OUTPUT = JsonOutput(
    "access table --json",
    "One object with a key for each kind of change, such as ZERO OFFSETS.",
    declare_keys(
        """
*.level | string | | Level that the change needs.
*.what | string | | Description of the change.
"""
    ),
)
OUTPUTS = {"scope FILE --json": (ACCESS_LIST_OUTPUT, ACCESS_TABLE_OUTPUT)}


_DAMAGED = (
    "levels are on, but an entry of the people is damaged and lets nobody in; enter it again, "
    "or reset the levels: turndesk access reset\n"
)
_LEVELS = {level.name.lower(): level for level in AccessLevel}


def add_parser(subparsers: SubParsers) -> None:
    """Declare the actions and options of the command."""
    parser = subparsers.add_parser("access")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, text in (
        ("list", "list the users and their access levels"),
        ("table", "show the access level that each type of change requires"),
    ):
        actions.add_parser(name, help=text).add_argument(
            "--json", action="store_true", help="print only JSON on stdout"
        )
    add = actions.add_parser("add", help="add a user; adding the first user turns access levels on")
    add.add_argument("name", metavar="NAME")
    add.add_argument(
        "--level",
        choices=list(_LEVELS),
        default="service",
        help="access level (default: service); the first user must have the service level",
    )
    pin = actions.add_parser("pin", help="change the PIN of a user")
    pin.add_argument("name", metavar="NAME")
    gone = actions.add_parser("remove", help="remove a user; removing the last user turns access levels off")
    gone.add_argument("name", metavar="NAME")
    for each in (add, pin, gone):
        add_author_option(each)
    actions.add_parser(
        "reset",
        help="delete all users and PINs, which turns access levels off; works without a PIN, only "
        "at the machine's own keyboard, and is logged",
    )


def run(args: argparse.Namespace) -> int:
    """Execute the action that the user specified.

    Raises CommandError if the action fails.
    """
    if args.action == "table":
        sys.stdout.write(_table(json_wanted=args.json))
        return EXIT_OK
    if args.action == "reset":
        require_terminal_confirmation(
            Message(
                "All users and their PINs will be deleted, and this will be logged. Type {reset} to "
                "continue: ",
                reset=RESET,
            )
        )
    with open_store(read_only=args.action == "list") as store:
        sys.stdout.write(_ACTIONS[args.action](store, args))
    return EXIT_OK


def _table(*, json_wanted: bool) -> str:
    if json_wanted:
        rules = {
            act.value: {"level": rule.minimum_level.name, "what": rule.description}
            for act, rule in ACCESS_RULES.items()
        }
        return json.dumps(rules) + "\n"
    return "".join(f"{rule.minimum_level.name:<9} {rule.description}\n" for rule in ACCESS_RULES.values())


def _list(store: Store, args: argparse.Namespace) -> str:
    people = store.people.read_users()
    if args.json:
        rows = [{"name": row.name, "level": AccessLevel(row.level).name} for row in people.rows]
        return (
            json.dumps({"on": people.is_access_restricted, "damaged": people.has_damaged_row, "people": rows})
            + "\n"
        )
    if not people.is_access_restricted:
        return "levels are off: everybody may change everything\n"
    lines = "".join(f"{AccessLevel(row.level).name:<9} {row.name}\n" for row in people.rows)
    return lines + (_DAMAGED if people.has_damaged_row else "")


def _add(store: Store, args: argparse.Namespace) -> str:
    from core.store.user_records import normalize_user_name

    level, name = _LEVELS[args.level], normalize_user_name(args.name)
    if store.people.read_users().find_user(name) is not None:
        raise CommandError(
            Message("user {name} already exists; to change the PIN, use 'turndesk access pin'", name=name),
            "name-in-use",
        )
    return _save_user(store, args, name, level, "entered")


def _person(store: Store, name: str) -> UserRow:
    row = store.people.read_users().find_user(name)
    if row is None:
        raise CommandError(
            Message("user {name} does not exist; 'turndesk access list' shows all users", name=name),
            "unknown-person",
        )
    return row


def _pin(store: Store, args: argparse.Namespace) -> str:
    row = _person(store, args.name)
    return _save_user(store, args, row.name, AccessLevel(row.level), "has a new PIN")


def _save_user(store: Store, args: argparse.Namespace, name: str, level: AccessLevel, done: str) -> str:
    """Ask for the PIN twice and store the user with the PIN."""
    from app.extras.access.access_command import read_pin
    from core.extras.access.pins import PinError, check_pin, hash_pin
    from core.store import user_records

    who = get_change_author(store, args, ProtectedChange.PEOPLE)
    pin = read_pin(Message("new PIN for {name}: ", name=name))
    with convert_to_command_error(PinError):
        check_pin(pin)
    if read_pin("repeat the new PIN: ") != pin:
        raise CommandError("the two PINs do not match; nothing was saved", "pins-differ")
    row = user_records.UserRow(name, level, *hash_pin(pin))
    store.people.save_user(row).result()
    store.events.log_event("access", f"{name} {done}: {level.name}", author=who).result()
    return f"{name} {done}: {level.name}\n"


def _remove(store: Store, args: argparse.Namespace) -> str:
    row = _person(store, args.name)
    who = get_change_author(store, args, ProtectedChange.PEOPLE)
    store.people.remove_user(row.name).result()
    store.events.log_event("access", Message("{row} removed", row=row.name), author=who).result()
    return f"{row.name} is taken away\n"


# --- service reset ---------------------------------------------------------------------------------------


def _reset(store: Store, _args: argparse.Namespace) -> str:
    count = store.people.remove_all_users().result()
    store.settings.save_setting("wrong PINs", None)
    result_text = Message(
        "service reset at the keyboard: {count} users and their PINs were deleted, and access levels are off",
        count=count,
    )
    store.events.log_event("access", result_text, author=getpass.getuser()).result()
    return f"{result_text}\n"


_ACTIONS = {"list": _list, "add": _add, "pin": _pin, "remove": _remove, "reset": _reset}


_WRONG = "wrong PINs"  # setting, shared with the operator screen


def require_pin(store: Store, row: UserRow, remedy: str) -> None:
    """Ask for the PIN of a user. After wrong PINs, the prompt is delayed.

    Raises CommandError if no PIN is stored or the PIN is wrong. Wrong PINs are logged.
    """
    from core.extras.access.pins import (
        PinHash,
        calculate_retry_delay,
        hash_pin,
        is_hash_outdated,
        is_pin_correct,
    )

    if not row.has_pin:
        raise CommandError(
            Message("no PIN is stored for user {row}; {remedy}", row=row.name, remedy=remedy), "no-pin"
        )
    kept = store.settings.read_setting(_WRONG)
    wrong = kept if isinstance(kept, int) else 0
    if pause := calculate_retry_delay(wrong):
        sys.stderr.write(f"turndesk: {wrong} wrong PINs in a row; try again in {pause:.0f} s\n")
        time.sleep(pause)
    pin = read_pin(Message("PIN for {row}: ", row=row.name))
    # counted before the check, so that ending TurnDesk does not avoid the wait
    store.settings.save_setting(_WRONG, wrong + 1).result()
    stored = PinHash(row.salt, row.hash)
    if is_pin_correct(pin, stored):
        if is_hash_outdated(stored):
            renewed = row._replace(**hash_pin(pin)._asdict())
            store.people.save_user(renewed).result()
        store.settings.save_setting(_WRONG, None).result()
        return
    log_text = Message(
        "wrong PIN for {row} entered on the command line; consecutive wrong PINs: {wrong}",
        row=row.name,
        wrong=wrong + 1,
    )
    store.events.log_event("access", log_text, author=getpass.getuser()).result()
    raise CommandError(
        Message("wrong PIN for user {row}; nothing was changed, and the attempt was logged", row=row.name),
        "wrong-pin",
    )


def read_pin(prompt: str) -> str:
    """Read a PIN from the terminal without echo, or read one line from stdin if it is not a terminal."""
    if sys.stdin.isatty():
        return getpass.getpass(prompt)
    return sys.stdin.readline().strip()
