"""Setup of program sharing: the shared location of the machine file, and the identity of this machine."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.runs.journal import Journal
from app.desk.command_errors import CommandError
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.desk.translation import tr
from core.executor.snapshot import Event
from core.extras.sharing.sharing_table import SharingTable
from core.file_placing import write_in_place
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store import Store

if TYPE_CHECKING:
    from app.extras.sharing.sharing import Shared, Sharing
    from app.extras.sharing.sharing_model import SharingModel
    from core.extras.sharing.shared_place import SharedPlace

# not in the store, so that another machine with a copied setup or backup gets its own id
HOME_FILE = "sharing-id"


def sharing_of(machine: Machine, store: Callable[[], Store]) -> Sharing | None:
    """Return the sharing of a machine, or None without [sharing].

    Raises CommandError if the id cannot be stored.
    """
    table = machine.hardware.table(SharingTable)
    if table is None:
        return None
    from app.extras.sharing.sharing import Sharing

    folder = data_folder()
    return Sharing(place_of(table), table.desk or machine.name, home_of(folder), folder / "programs", store)


def attach_sharing(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Attach the page. Without a store or [sharing], the page states why nothing is shared."""
    sharing = None
    if journal is not None:
        try:
            sharing = sharing_of(machine, journal.opened)
        except CommandError as error:
            desk.say(tr(Message("PROGRAMS NOT SHARED: {why}", why=error)))
    desk.pages.attach_later("app.extras.sharing.sharing_model.SharingModel", partial(_model, desk, sharing))


def _model(desk: Desk, sharing: Sharing | None) -> SharingModel:
    from app.extras.sharing.sharing_model import SharingModel

    return SharingModel(desk, sharing)


def start_sharing(desk: Desk, journal: Journal) -> Callable[[], None] | None:
    """Start the synchronization thread, and return a function that stops it.

    Returns None without [sharing] or if the location cannot be used.
    """
    table = desk.machine.model.hardware.table(SharingTable) if desk.machine.model is not None else None
    if table is None:
        return None
    from app.extras.sharing.sharing import SharingThread
    from app.extras.sharing.sharing_model import SharingModel

    model = desk.pages.find(SharingModel)
    if model is None or model.sharing is None:
        return None
    heard = Heard(desk, journal)
    thread = SharingThread(model.sharing, table.look, heard.hear)
    model.look_now, model.silent_for = thread.look_now, thread.silent_for
    thread.start()
    return thread.close


@dataclass(slots=True)
class Heard:
    """Handler of synchronization results on the sharing thread. Each message is reported once."""

    desk: Desk
    journal: Journal
    _trouble: str = ""
    _told: frozenset[str] = frozenset()

    def hear(self, shared: Shared) -> None:
        """Log an error, and report on the prompt line that the loaded program is newer on another machine."""
        if shared.trouble and shared.trouble != self._trouble:
            self.journal.hear(Event(self.desk.snapshot().t, "warning", shared.trouble))
        self._trouble = shared.trouble
        from core.extras.sharing.shared_versions import Family, key_of

        name = self.desk.session.now.name
        family = shared.families.get(key_of(name), Family())
        fresh = frozenset(each.id for each in family.elsewhere) - self._told if family.here else frozenset()
        if fresh:
            self._told |= fresh
            who = next(each.desk for each in family.elsewhere if each.id in fresh)
            text = tr(Message("{name} WAS CHANGED ON {machine}. F1, X: SHOW CHANGES", name=name, machine=who))
            self.desk.hear(Event(self.desk.snapshot().t, "shared", text))  # shown with the next frame


def place_of(table: SharingTable) -> SharedPlace:
    """Return the shared location without opening it."""
    if table.postgresql:
        from core.extras.sharing.shared_database import SharedDatabase

        return SharedDatabase(table.postgresql)
    from core.extras.sharing.shared_folder import SharedFolder

    return SharedFolder(Path(table.folder).expanduser())


def home_of(folder: Path) -> str:
    """Return the unique id of this machine, created once. Raises CommandError."""
    from core.extras.sharing.version_record import is_home

    path = folder / HOME_FILE
    try:
        text = path.read_text(encoding="ascii").strip() if path.exists() else ""
        if is_home(text):
            return text
        return claim(folder, secrets.token_hex(16))
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(
            Message("{path} cannot be used: {error}", path=path, error=error), "unusable"
        ) from error


def claim(folder: Path, home: str) -> str:
    """Store an id as that of this machine, and return it."""
    write_in_place(folder / HOME_FILE, f"{home}\n".encode())
    return home
