"""Who changes something on the command line: his name for the history, and whether his level is enough.

Without levels nobody is asked. With them a name is worth what its PIN is: it is asked at the terminal, or
read as a line of the standard input.
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
from core.access.access_table import Act, Level, level_for
from core.message import Message, error_code

if TYPE_CHECKING:
    from core.store.people import People, PersonRow
    from core.store.store import Store
    from core.store.store_errors import StoreError

COMMAND_LINE = "command line"  # in the history, where there are no levels and nobody is named


def add_as_option(parser: argparse.ArgumentParser) -> None:
    """``--as NAME``."""
    parser.add_argument(
        "--as",
        dest="as_name",
        metavar="NAME",
        help="user who makes the change, for the history (default: the system user); if access "
        "levels are on, TurnDesk asks for the PIN of this user",
    )


def who_changes(store: Store, args: argparse.Namespace, *acts: Act) -> str:
    """The name for the history of what is changed.

    Raises CommandError where levels are on and his is too low for one of it, or the PIN wrong.
    """
    people, act = store.people.read_people(), max(acts, key=level_for)
    if not people.on:
        return args.as_name or COMMAND_LINE
    name, needed = args.as_name or getpass.getuser(), level_for(act)
    row = people.named(name)
    if row is None and (args.as_name or needed > Level.OPERATOR):
        raise CommandError(
            Message(
                "{act}, but user {name} does not exist; {people}",
                act=_needs(act),
                name=name,
                people=_remedy(people, needed),
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
                level=Level(row.level).name,
                people=_remedy(people, needed),
            ),
            "level-too-low",
        )
    _demand_pin(store, row)
    return row.name


def _needs(act: Act) -> str:
    return Message(
        "{act}: access level {act2} or higher is required", act=act.value, act2=level_for(act).name
    )


def _remedy(people: People, needed: Level) -> str:
    """Say who can make a change of this level, or how levels are turned off."""
    able = [row.name for row in people.rows if row.level >= needed and row.has_pin]
    if not able:
        return (
            "no user with a PIN has this access level; 'turndesk access reset' at the machine "
            "turns access levels off"
        )
    return Message("use --as with one of these users: {able}", able=", ".join(able))


def _demand_pin(store: Store, row: PersonRow) -> None:
    """Raises CommandError for a wrong one, and where this TurnDesk cannot check PINs."""
    from app.compose.extra import extras

    remedy = _remedy(store.people.read_people(), Level.SERVICE)
    if not any(extra.demand_pin(store, row, remedy) for extra in extras().values()):
        raise CommandError(
            Message(
                "access levels are on, but this TurnDesk is installed without sign-in, so the PIN of user "
                "{row} cannot be checked",
                row=row.name,
            ),
            "no-sign-in",
        )


Opened = Callable[[], AbstractContextManager["Store"]]
"""Opens the store of this installation for a command."""


def who_may(opened: Opened, args: argparse.Namespace, *acts: Act) -> str:
    """Who does what needs no store of its own; empty where there are no levels and nobody is named.

    Raises CommandError as ``who_changes`` does. It can be done beside a desk that runs where there are no
    levels: only a PIN has to be written down. Nobody may do it where the store cannot be read, for its levels
    are unknown; only a restore is allowed then, after a service reset at the machine's own keyboard.
    """
    from app.desk.data_folder import data_folder
    from core.store.store import Store
    from core.store.store_errors import StoreError

    try:
        with Store.open(data_folder(), read_only=True) as store:
            on = store.people.read_people().on
    except StoreError as error:
        if error_code(error) != "older-version":
            return _by_service_reset(error, acts)
        on = True  # opening it to write brings it up to date
    if not on and not args.as_name:
        return ""
    with opened() as store:
        return who_changes(store, args, *acts)


RESET = "RESET"


def _by_service_reset(error: StoreError, acts: Collection[Act]) -> str:
    """Return the name for the log. Raise CommandError unless a restore is confirmed at the machine."""
    if Act.RESTORE not in acts:
        raise CommandError(
            Message("the access levels that apply to this change cannot be read: {error}", error=error),
            error_code(error),
        ) from error
    sys.stderr.write(f"turndesk: {error}\n")
    demand_own_keyboard(
        Message(
            "The users and their PINs cannot be read. A restore deletes all of them, and this "
            "will be logged. Type {reset} to continue: ",
            reset=RESET,
        )
    )
    return Message("{user} (service reset at the keyboard)", user=getpass.getuser())


def demand_own_keyboard(question: str) -> None:
    """Raise CommandError unless the user confirms the question at a terminal of this machine."""
    if not sys.stdin.isatty() or os.environ.get("SSH_CONNECTION"):
        raise CommandError(
            "the service reset must be typed on the machine's own keyboard, in a terminal", "not-a-terminal"
        )
    sys.stdout.write(question)
    sys.stdout.flush()
    if sys.stdin.readline().strip() != RESET:
        raise CommandError("nothing was changed", "not-confirmed")


def note_change(opened: Opened, who: str, text: str) -> None:
    """A line in the log of the store that is in place now, where it is known by whom."""
    if who:
        with opened() as store:
            store.events.log_event("change", text, who=who).result()
