"""The machine that the operator screen was opened for last; commands about offsets take its travel."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.machine_setup import read_machine
from app.desk.command_errors import CommandError
from core.message import Message

if TYPE_CHECKING:
    from app.compose.accepted_machine import Settings
    from app.desk.persistence import Persistence
    from core.machine.machine_model import Machine

_KEY = "machine in use"  # the setting: the path of its file, or the name of a shipped machine


def remember_machine(machine_file: str | None, persistence: Persistence) -> None:
    """Store which machine is in use; None: the shipped lathe."""
    path = Path(machine_file) if machine_file else None
    place = str(path.resolve()) if path is not None and path.exists() else machine_file
    if persistence.setting(_KEY) != place:
        persistence.save_setting(_KEY, place)


def machine_in_use(settings: Settings) -> Machine:
    """Return the machine in use. Raises CommandError if its file cannot be read."""
    place = settings.setting(_KEY)
    try:
        return read_machine(place if isinstance(place, str) else None)
    except CommandError as error:
        raise CommandError(
            Message("the travel of the current machine is unknown: {error}. Use --machine FILE", error=error),
            error.code,
        ) from error
