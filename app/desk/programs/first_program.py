"""The program that is on the desk when the screen opens."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.translation import tr
from core.message import Message

if TYPE_CHECKING:
    from app.desk.desk import Desk


def begin_with(desk: Desk, named: str | None) -> None:
    """At the start: the program that was interrupted, or else the one that is ``named``."""
    found = desk.snapshot().interrupted
    path = str(Path(named).absolute()) if named is not None else ""
    if found is None:
        if named is not None and not desk.choose(path):
            desk.say(Message("FILE NOT FOUND: {named}", named=named))
    elif named is not None and Path(named).name == found.program and desk.choose(path):
        return
    elif not desk.choose(found.program):
        desk.say(
            tr(
                Message(
                    "INTERRUPTED PROGRAM {name} NOT FOUND. F2: CHOOSE A PROGRAM",
                    name=found.program,
                )
            )
        )
    elif named is not None:
        desk.say(
            tr(Message("{name} NOT LOADED: THE INTERRUPTED JOB WAS LOADED INSTEAD", name=Path(named).name))
        )
