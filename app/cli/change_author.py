"""Identification of a user who changes data on the command line, with a check of access levels.

If access levels are off, nothing is checked. Otherwise the user must enter the PIN, either at the terminal
or as a line of standard input.
"""

from __future__ import annotations

import argparse
import getpass
import os
import sys
from collections.abc import Callable, Collection
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from core.access.access_table import AccessLevel, ProtectedChange, get_required_level
from core.message import Message, get_error_code

if TYPE_CHECKING:
    from core.store.store import Store
    from core.store.store_errors import StoreError
    from core.store.user_records import UserList, UserRow

COMMAND_LINE_USER = (
    "command line"  # name in the history if there are no access levels and no user is specified
)


def add_author_option(parser: argparse.ArgumentParser) -> None:
    """Add the option ``--as NAME``, which names the user who makes the change."""
    parser.add_argument(
        "--as",
        dest="as_name",
        metavar="NAME",
        help="user who makes the change, for the history (default: the system user); if access "
        "levels are on, TurnDesk asks for the PIN of this user",
    )


def add_confirmation_options(parser: argparse.ArgumentParser) -> None:
    """Add the options ``--yes`` and ``--machine`` for suspicious changes of offsets."""
    parser.add_argument(
        "--yes", action="store_true", help="make suspicious offset changes without asking for confirmation"
    )
    parser.add_argument(
        "--machine",
        metavar="FILE",
        help="machine file with the travel limits for the offsets (default: the machine file of "
        "the operator screen)",
    )


def get_change_author(store: Store, args: argparse.Namespace, *acts: ProtectedChange) -> str:
    """Return the name of the user for the change history.

    ``acts`` has at least one kind of change. Raises CommandError if access levels are on and one of these
    conditions applies: the user is unknown, the user's level is too low, or the PIN is missing, wrong or
    cannot be checked. Raises StoreError if the store cannot be read or written.
    """
    people, act = store.people.read_users(), max(acts, key=get_required_level)
    if not people.is_access_restricted:
        return args.as_name or COMMAND_LINE_USER
    name, needed = args.as_name or getpass.getuser(), get_required_level(act)
    row = people.find_user(name)
    if row is None and (args.as_name or needed > AccessLevel.OPERATOR):
        raise CommandError(
            Message(
                "{act}, but user {name} does not exist; {people}",
                act=_needs(act),
                name=name,
                people=_access_remedy(people, needed),
            ),
            "unknown-person",
        )
    if row is None:
        return name
    if row.level < needed:
        raise CommandError(
            Message(
                "{act}, but user {row} has access level {level}; {people}",
                act=_needs(act),
                row=row.name,
                level=AccessLevel(row.level).name,
                people=_access_remedy(people, needed),
            ),
            "level-too-low",
        )
    _require_pin(store, row)
    return row.name


def _needs(act: ProtectedChange) -> str:
    return Message(
        "{act}: access level {act2} or higher is required", act=act.value, act2=get_required_level(act).name
    )


def _access_remedy(people: UserList, needed: AccessLevel) -> str:
    """Return the error remedy, which names the users with a sufficient access level.

    If no such user has a PIN, the remedy explains how to turn access levels off.
    """
    able = [row.name for row in people.rows if row.level >= needed and row.has_pin]
    if not able:
        return (
            "no user with a PIN has this access level; 'turndesk access reset' at the machine "
            "turns access levels off"
        )
    return Message("use --as with one of these users: {able}", able=", ".join(able))


def _require_pin(store: Store, row: UserRow) -> None:
    """Ask for the user's PIN.

    Raises CommandError if no PIN is stored, if the PIN is wrong, or if this installation cannot check PINs.
    """
    from app.compose.optional_features import extras

    remedy = _access_remedy(store.people.read_users(), AccessLevel.SERVICE)
    if not any(extra.require_pin(store, row, remedy) for extra in extras().values()):
        raise CommandError(
            Message(
                "access levels are on, but this TurnDesk is installed without sign-in, so the PIN of user "
                "{row} cannot be checked",
                row=row.name,
            ),
            "no-sign-in",
        )


OpenStore = Callable[[], AbstractContextManager["Store"]]
"""Function that opens the store of this installation for a command."""


def get_permitted_user(open_store: OpenStore, args: argparse.Namespace, *acts: ProtectedChange) -> str:
    """Return the name of the user who may perform an action outside the store.

    The name is empty if access levels are off and no user was named. In this case, the store is only read,
    so that the function also works while TurnDesk is running. If the store cannot be read, its access
    levels are unknown. Only a restore is then permitted, after a service reset at the machine's own
    keyboard. Raises CommandError like ``get_change_author``, and if the access levels cannot be read.
    """
    from app.desk.data_folder import find_data_folder
    from core.store.store import Store
    from core.store.store_errors import StoreError

    try:
        with Store.open(find_data_folder(), read_only=True) as store:
            on = store.people.read_users().is_access_restricted
    except StoreError as error:
        if get_error_code(error) != "older-version":
            return _confirm_reset(error, acts)
        on = True  # opening the store for writing upgrades it
    if not on and not args.as_name:
        return ""
    with open_store() as store:
        return get_change_author(store, args, *acts)


RESET = "RESET"


def _confirm_reset(error: StoreError, actions: Collection[ProtectedChange]) -> str:
    """Return the user name for the log after the user confirms a restore at the machine.

    Raises CommandError if ``actions`` does not include a restore, or if the user does not confirm the
    restore on a terminal of this machine.
    """
    if ProtectedChange.RESTORE not in actions:
        raise CommandError(
            Message("the access levels that apply to this change cannot be read: {error}", error=error),
            get_error_code(error),
        ) from error
    sys.stderr.write(f"turndesk: {error}\n")
    require_terminal_confirmation(
        Message(
            "The users and their PINs cannot be read. A restore deletes all of them, and this "
            "will be logged. Type {reset} to continue: ",
            reset=RESET,
        )
    )
    return Message("{user} (service reset at the keyboard)", user=getpass.getuser())


def require_terminal_confirmation(question: str) -> None:
    """Raise CommandError unless the user confirms the question on a terminal of this machine."""
    if not sys.stdin.isatty() or os.environ.get("SSH_CONNECTION"):
        raise CommandError(
            "the service reset must be typed on the machine's own keyboard, in a terminal", "not-a-terminal"
        )
    sys.stdout.write(question)
    sys.stdout.flush()
    if sys.stdin.readline().strip() != RESET:
        raise CommandError("nothing was changed", "not-confirmed")


def log_user_change(open_store: OpenStore, user_name: str, text: str) -> None:
    """Log a change in the current store if the user is known."""
    if user_name:
        with open_store() as store:
            store.events.log_event("change", text, author=user_name).result()
