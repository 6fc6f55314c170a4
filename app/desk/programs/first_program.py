"""Choice of the program that is loaded when the screen opens."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.programs.program_choice import LAST_PROGRAM
from app.desk.translation import tr
from core.executor.snapshot import CYCLE
from core.message import Message

if TYPE_CHECKING:
    from app.desk.desk import Desk


def begin_with(desk: Desk, named: str | None) -> None:
    """Load the first program: the running or interrupted program, or else the program ``named``."""
    if desk.snapshot().state in CYCLE:
        _show_program_under_way(desk, named)
        return
    found = desk.snapshot().interrupted
    path = str(Path(named).absolute()) if named is not None else ""
    if found is None:
        if named is not None and not desk.programs.choose(path):
            desk.say(Message("FILE NOT FOUND: {named}", named=named))
    elif named is not None and Path(named).name == found.program and desk.programs.choose(path):
        return
    elif not desk.programs.choose(found.program):
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


def _show_program_under_way(desk: Desk, named: str | None) -> None:
    """Load the program that the control is already running, because the screen was restarted."""
    now = desk.snapshot()
    last = desk.settings.persistence.read_setting(LAST_PROGRAM)
    known = (Path(each) for each in (named, last) if isinstance(each, str))
    path = next((each for each in known if each.name == now.program), None)
    path = path or desk.programs.folders.find(now.program)
    if path is None:
        words = "RUNNING PROGRAM {name} NOT FOUND. ITS TEXT IS NOT SHOWN"
    else:
        words = "SCREEN RESTARTED. PROGRAM {name} IS NOT FINISHED"
        desk.session.load(path.absolute(), now.block_delete)
    desk.warn(tr(Message(words, name=now.program)))
