"""Selection of the program that is loaded when the screen opens."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.programs.program_choice import LAST_PROGRAM_SETTING
from app.desk.translation import tr
from core.executor.snapshot import CYCLE_STATES
from core.message import Message

if TYPE_CHECKING:
    from app.desk.desk import Desk


def load_first_program(desk: Desk, name: str | None) -> None:
    """Load the running or interrupted program, or else the program ``name``."""
    if desk.read_snapshot().state in CYCLE_STATES:
        _show_running_program(desk, name)
        return
    found = desk.read_snapshot().interrupted
    path = str(Path(name).absolute()) if name is not None else ""
    if found is None:
        if name is not None and not desk.program_choice.load_by_name(path):
            desk.say(Message("FILE NOT FOUND: {named}", named=name))
    elif name is not None and Path(name).name == found.program and desk.program_choice.load_by_name(path):
        return
    elif not desk.program_choice.load_by_name(found.program):
        desk.say(
            tr(
                Message(
                    "INTERRUPTED PROGRAM {name} NOT FOUND. F2: CHOOSE A PROGRAM",
                    name=found.program,
                )
            )
        )
    elif name is not None:
        desk.say(
            tr(Message("{name} NOT LOADED: THE INTERRUPTED JOB WAS LOADED INSTEAD", name=Path(name).name))
        )


def _show_running_program(desk: Desk, named: str | None) -> None:
    """Load the program that the control is still running after the screen has restarted."""
    now = desk.read_snapshot()
    last = desk.settings_store.persistence.read_setting(LAST_PROGRAM_SETTING)
    known = (Path(each) for each in (named, last) if isinstance(each, str))
    path = next((each for each in known if each.name == now.program), None)
    path = path or desk.program_choice.program_folders.find_path(now.program)
    if path is None:
        words = "RUNNING PROGRAM {name} NOT FOUND. ITS TEXT IS NOT SHOWN"
    else:
        words = "SCREEN RESTARTED. PROGRAM {name} IS NOT FINISHED"
        desk.program_loader.start_loading(path.absolute(), now.block_delete)
    desk.show_warning(tr(Message(words, name=now.program)))
