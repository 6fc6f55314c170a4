"""Who changes something on the command line: his name for the history, and whether his level is enough.

Without levels nobody is asked. With them a name is worth what its PIN is: it is asked at the terminal, or
read as a line of the standard input.
"""

from __future__ import annotations

import argparse
import getpass
import sys
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from core.access.access_table import Act, Level, level_for

if TYPE_CHECKING:
    from core.store.people import People, PersonRow
    from core.store.store import Store

COMMAND_LINE = "command line"  # in the history, where there are no levels and nobody is named
_WRONG = "wrong PINs"  # the setting that the desk keeps too


def add_as_option(parser: argparse.ArgumentParser) -> None:
    """``--as NAME``."""
    parser.add_argument(
        "--as",
        dest="as_name",
        metavar="NAME",
        help="who changes it, for the history; where there are levels his PIN is asked, "
        "and without this option that of the system's user",
    )


def who_changes(store: Store, args: argparse.Namespace, *acts: Act) -> str:
    """The name for the history of what is changed.

    Raises CommandError where levels are on and his is too low for one of it, or the PIN wrong.
    """
    people, act = store.people(), max(acts, key=level_for)
    if not people.on:
        return args.as_name or COMMAND_LINE
    name, needed = args.as_name or getpass.getuser(), level_for(act)
    row = people.named(name)
    if row is None and (args.as_name or needed > Level.OPERATOR):
        raise CommandError(
            f"{_needs(act)}; {name} is not among the people: {_remedy(people, needed)}", "unknown-person"
        )
    if row is None:
        return name
    if row.level < needed:
        raise CommandError(
            f"{_needs(act)}; {row.name} is of {Level(row.level).name}: {_remedy(people, needed)}",
            "level-too-low",
        )
    _demand_pin(store, row)
    return row.name


def _needs(act: Act) -> str:
    return f"{act.value} may be changed from {level_for(act).name} level on"


def _remedy(people: People, needed: Level) -> str:
    able = [row.name for row in people.rows if row.level >= needed]
    if not able:
        return "nobody has it any more, 'turndesk access reset' at the machine switches levels off"
    return f"give --as one of {', '.join(able)}"


def _demand_pin(store: Store, row: PersonRow) -> None:
    """Raises CommandError for a wrong one, which is logged, and lets the next wait."""
    from core.access.pins import Hashed, is_pin, wait_after

    kept = store.setting(_WRONG)
    wrong = kept if isinstance(kept, int) else 0
    if pause := wait_after(wrong):
        sys.stderr.write(f"turndesk: {wrong} wrong PINs in a row: the next can be typed in {pause:.0f} s\n")
        time.sleep(pause)
    pin = asked_pin(f"PIN of {row.name}: ")
    store.set_setting(_WRONG, wrong + 1).result()  # before it is looked at: who ends us then is counted too
    if is_pin(pin, Hashed(row.salt, row.hash)):
        store.set_setting(_WRONG, None).result()
        return
    told = f"wrong PIN for {row.name}, {wrong + 1} in a row, on the command line"
    store.log_event("access", told, who=getpass.getuser()).result()
    raise CommandError(
        f"that is not the PIN of {row.name}; nothing was changed, and it is in the log", "wrong-pin"
    )


def asked_pin(question: str) -> str:
    """What is typed, which nobody sees; without a terminal a line of the standard input."""
    if sys.stdin.isatty():
        return getpass.getpass(question)
    return sys.stdin.readline().strip()


Opened = Callable[[], AbstractContextManager["Store"]]
"""Opens the store of this installation for a command."""


def who_may(opened: Opened, args: argparse.Namespace, *acts: Act) -> str:
    """Who does what needs no store of its own; empty where there are no levels and nobody is named.

    Raises CommandError as ``who_changes`` does. It can be done beside a desk that runs where there are no
    levels: only a PIN has to be written down. A store that cannot be read has no levels that anybody could
    ask for, or damage would be a lock.
    """
    from app.desk.data_folder import data_folder
    from core.store.store import Store
    from core.store.store_errors import StoreError

    try:
        with Store.open(data_folder(), read_only=True) as store:
            on = store.people().on
    except StoreError:
        return args.as_name or ""
    if not on and not args.as_name:
        return ""
    with opened() as store:
        return who_changes(store, args, *acts)


def note_change(opened: Opened, who: str, text: str) -> None:
    """A line in the log of the store that is in place now, where it is known by whom."""
    if who:
        with opened() as store:
            store.log_event("change", text, who=who).result()
