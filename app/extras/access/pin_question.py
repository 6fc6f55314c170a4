"""The PIN of who changes something on the command line: asked, checked, and slower with each wrong one."""

from __future__ import annotations

import getpass
import sys
import time

from app.desk.command_errors import CommandError
from core.extras.access.pins import Hashed, hashed, is_outdated, is_pin, wait_after
from core.message import Message
from core.store.people import PersonRow, keep_person
from core.store.store import Store

_WRONG = "wrong PINs"  # the setting that the desk keeps too


def demand_pin(store: Store, row: PersonRow, remedy: str) -> None:
    """Raises CommandError for a wrong one, which is logged, and lets the next wait."""
    if not row.has_pin:
        raise CommandError(
            Message("no PIN is stored for user {row}; {remedy}", row=row.name, remedy=remedy), "no-pin"
        )
    kept = store.setting(_WRONG)
    wrong = kept if isinstance(kept, int) else 0
    if pause := wait_after(wrong):
        sys.stderr.write(f"turndesk: {wrong} wrong PINs in a row; try again in {pause:.0f} s\n")
        time.sleep(pause)
    pin = asked_pin(Message("PIN for {row}: ", row=row.name))
    store.set_setting(_WRONG, wrong + 1).result()  # before it is looked at: who ends us then is counted too
    stored = Hashed(row.salt, row.hash)
    if is_pin(pin, stored):
        if is_outdated(stored):
            renewed = row._replace(**hashed(pin)._asdict())
            store.write(lambda c: keep_person(c, renewed)).result()
        store.set_setting(_WRONG, None).result()
        return
    told = Message(
        "wrong PIN for {row} entered on the command line; consecutive wrong PINs: {wrong}",
        row=row.name,
        wrong=wrong + 1,
    )
    store.log_event("access", told, who=getpass.getuser()).result()
    raise CommandError(
        Message("wrong PIN for user {row}; nothing was changed, and the attempt was logged", row=row.name),
        "wrong-pin",
    )


def asked_pin(question: str) -> str:
    """What is typed, which nobody sees; without a terminal a line of the standard input."""
    if sys.stdin.isatty():
        return getpass.getpass(question)
    return sys.stdin.readline().strip()
