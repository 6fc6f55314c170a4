"""Machine files that have changed: shown and accepted from a console; a real machine does not run before."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from app.cli.errors import EXIT_OK, CommandError

if TYPE_CHECKING:
    from core.machine.changes import Change
    from core.machine.model import Machine

MOST = 5  # changes that a run tells; a check tells all


def changed(machine: Machine) -> tuple[Change, ...]:
    """What differs from the file that was accepted last; nothing for one that never was. CommandError."""
    from app.cli.opened_store import opened_store
    from app.compose.accepted import differences

    with opened_store(read_only=True) as store:
        return differences(machine, store) or ()


def demand_accepted(machine: Machine) -> None:
    """A run tells what has changed; on a machine that is not simulated it does not begin. CommandError."""
    from app.compose.backends import real_time

    try:
        told = changed(machine)
    except CommandError:
        if real_time(machine):
            raise
        return  # a simulation needs no store
    if not told:
        return
    lines = [str(change) for change in told[:MOST]]
    if len(told) > MOST:
        lines.append(f"… and {len(told) - MOST} more: turndesk machine check {machine.source}")
    if real_time(machine):
        why = f"{machine.source} has changed since it was accepted ({'; '.join(lines)})"
        raise CommandError(f"{why}; turndesk machine accept {machine.source}, or F10 on the screen")
    sys.stderr.write("".join(f"{machine.source} has changed: {line}\n" for line in lines))


def accept(file: str) -> int:
    """Shows what has changed, and takes the file as it is now. Raises CommandError."""
    from app.cli.opened_store import opened_store
    from app.compose.accepted import differences, key_of, record_of
    from app.compose.machine import read_machine

    machine = read_machine(file)
    with opened_store() as store:
        told = differences(machine, store)
        store.set_setting(key_of(machine), record_of(machine)).result()
        said = "; ".join(str(change) for change in told or ())
        store.log_event("machine", f"machine file {machine.source} accepted{': ' if said else ''}{said}")
    sys.stdout.write("".join(f"  {change}\n" for change in told or ()))
    how = (
        "it was not known here" if told is None else f"{len(told)} changes" if told else "it had not changed"
    )
    sys.stdout.write(f"{machine.source} is accepted: {how}\n")
    return EXIT_OK
