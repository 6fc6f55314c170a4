"""Comparison of the machine file in use with the machine file that was last accepted."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from app.desk.persistence import Persistence
from app.desk.status.machine_file_changes import MachineFileChanges
from core.executor.commands import Command, EnableDrives
from core.machine.machine_file import MISSING_VALUE, KeyChange, compare_machine_files
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError

_TEXT, _DRIVES = "text", "drives"


class SettingsReader(Protocol):
    """Reader of settings in the store."""

    def read_setting(self, key: str) -> object:
        """Return the value that the store has for this settings key."""
        ...


def get_settings_key(machine: Machine) -> str:
    """Return the settings key of a machine file, which contains the resolved path of the file."""
    path = Path(machine.source)
    place = path.resolve() if path.exists() else machine.source
    return " ".join(("machine file", str(place)))


def create_acceptance_record(machine: Machine) -> dict[str, object]:
    """Return the record to store when a user accepts a machine file.

    The record contains the text of the file and a hash of the values that are written to each node at
    startup.
    """
    return {_TEXT: machine.text, _DRIVES: _hashes(machine)}


def list_file_differences(machine: Machine, settings: SettingsReader) -> tuple[KeyChange, ...] | None:
    """Return the differences from the accepted machine file, or None if this file was never accepted."""
    record = settings.read_setting(get_settings_key(machine))
    if not isinstance(record, dict) or not isinstance(record.get(_TEXT), str):
        return None
    changes = compare_machine_files(record[_TEXT], machine.text)
    if changes or not isinstance(old := record.get(_DRIVES), dict):
        return changes
    new = _hashes(machine)  # the file is the same, but the values derived from it may differ
    return tuple(
        KeyChange(
            Message("canopen.nodes.{name}, all values written to the node", name=name),
            str(old.get(name, MISSING_VALUE)),
            now,
        )
        for name, now in new.items()
        if old.get(name) != now
    )


def prepare_change_review(
    machine: Machine, persistence: Persistence, log_text: Callable[[str], None]
) -> MachineFileChanges:
    """Return the changes of the machine file for the screen.

    A new machine file is accepted automatically, because the operator has chosen it. ``log_text`` writes to
    the event log.
    """
    changes = list_file_differences(machine, persistence)

    def save_acceptance() -> None:
        persistence.save_setting(get_settings_key(machine), create_acceptance_record(machine))
        what, name = "; ".join(str(change) for change in changes or ()), persistence.who()
        done = Message(
            "machine file {path} accepted by {name}" if name else "machine file {path} accepted",
            path=machine.source,
            name=name,
        )
        log_text(Message("{done}: {changes}", done=done, changes=what) if what else done)

    if changes is None:
        save_acceptance()
    return MachineFileChanges(machine.source, changes or (), save_acceptance)


def make_guarded_post(
    post_command: Callable[[Command], None],
    reviewed_changes: MachineFileChanges,
    report_refusal: Callable[[str], None],
) -> Callable[[Command], None]:
    """Return a function that posts commands, but can reject switching the drives on.

    It rejects only this command, and only while changes of the machine file are not accepted.
    """

    def post_if_accepted(command: Command) -> None:
        if reviewed_changes.barred and isinstance(command, EnableDrives):
            report_refusal(reviewed_changes.barred)
        else:
            post_command(command)

    return post_if_accepted


def _hashes(machine: Machine) -> dict[str, str]:
    if machine.backend != "canopen":
        return {}
    from app.compose.backends.canopen_backend import list_startup_objects

    try:
        objects = list_startup_objects(machine)
    except DriverError:
        return {}
    return {name: hashlib.sha256(repr(each).encode()).hexdigest()[:12] for name, each in objects.items()}
