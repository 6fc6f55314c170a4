"""Sharing of programs put together: the place that the machine file names, and this desk's own id."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from pathlib import Path

from app.desk.command_errors import CommandError
from app.desk.data_folder import data_folder
from app.sharing.sharing import Sharing
from core.machine.machine_model import Machine
from core.machine.sharing_table import SharingTable
from core.sharing.shared_place import SharedPlace
from core.sharing.version_record import is_home
from core.store.store import Store

HOME_FILE = "sharing-id"  # beside the store and not in it: a setup or a backup of another desk has another
COPY = "sharing.git"  # of the repository


def sharing_of(machine: Machine, store: Callable[[], Store]) -> Sharing | None:
    """None: the machine file has no [sharing]. Raises CommandError where the data folder takes no file."""
    table = machine.hardware.table(SharingTable)
    if table is None:
        return None
    folder = data_folder()
    return Sharing(
        place_of(table, folder), table.desk or machine.name, home_of(folder), folder / "programs", store
    )


def place_of(table: SharingTable, folder: Path) -> SharedPlace:
    """The place; nothing is opened yet."""
    if table.git:
        from core.sharing.shared_git import SharedGit

        return SharedGit(table.git, folder / COPY)
    if table.postgresql:
        from core.sharing.shared_database import SharedDatabase

        return SharedDatabase(table.postgresql)
    from core.sharing.shared_folder import SharedFolder

    return SharedFolder(Path(table.folder).expanduser())


def home_of(folder: Path) -> str:
    """What tells this desk from all others; made once. Raises CommandError."""
    path = folder / HOME_FILE
    try:
        text = path.read_text(encoding="ascii").strip() if path.exists() else ""
        if is_home(text):
            return text
        return claim(folder, secrets.token_hex(16))
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(f"{path} cannot be used: {error}") from error


def claim(folder: Path, home: str) -> str:
    """This desk goes on as the one of this id."""
    folder.mkdir(parents=True, exist_ok=True)
    draft = folder / f"{HOME_FILE}.part"
    draft.write_text(home + "\n", encoding="ascii")
    draft.replace(folder / HOME_FILE)
    return home
