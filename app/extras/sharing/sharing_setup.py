"""Setup of program sharing: the location from the machine file, and the identity of this machine."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.runs.journal import Journal
from app.desk.command_errors import CommandError
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.desk.translation import tr
from core.executor.snapshot import LogEvent
from core.extras.sharing.sharing_table import SharingTable
from core.file_replacement import write_atomically
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store import Store

if TYPE_CHECKING:
    from app.extras.sharing.sharing import ProgramSharing, SharingResult
    from app.extras.sharing.sharing_model import SharingModel
    from core.extras.sharing.shared_location import SharedLocation

# not in the store, so that another machine with a copied setup or backup gets its own id
MACHINE_ID_FILE = "sharing-id"


def make_program_sharing(machine: Machine, get_store: Callable[[], Store]) -> ProgramSharing | None:
    """Return the program sharing of a machine, or None if the machine file has no [sharing] table.

    Raises CommandError if the machine id cannot be read or stored, and DataFolderError if the user has no
    data folder.
    """
    table = machine.hardware.find_driver_table(SharingTable)
    if table is None:
        return None
    from app.extras.sharing.sharing import ProgramSharing

    folder = find_data_folder()
    return ProgramSharing(
        make_shared_location(table),
        table.desk or machine.name,
        read_machine_id(folder),
        folder / "programs",
        get_store,
    )


def attach_sharing(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Attach the page of shared programs to TurnDesk.

    If there is no store or no [sharing] table, the page shows the reason why nothing is shared.
    """
    sharing = None
    if journal is not None:
        try:
            sharing = make_program_sharing(machine, journal.require_store)
        except CommandError as error:
            desk.say(tr(Message("PROGRAMS NOT SHARED: {why}", why=error)))
    desk.page_registry.attach_lazy_model(
        "app.extras.sharing.sharing_model.SharingModel", partial(_model, desk, sharing)
    )


def _model(desk: Desk, sharing: ProgramSharing | None) -> SharingModel:
    from app.extras.sharing.sharing_model import SharingModel

    return SharingModel(desk, sharing)


def start_sharing(desk: Desk, journal: Journal) -> Callable[[], None] | None:
    """Start the synchronization thread, and return a function that stops the thread.

    Returns None if there is no [sharing] table or the shared location cannot be used.
    """
    table = (
        desk.machine.machine.hardware.find_driver_table(SharingTable)
        if desk.machine.machine is not None
        else None
    )
    if table is None:
        return None
    from app.extras.sharing.sharing import SharingThread
    from app.extras.sharing.sharing_model import SharingModel

    model = desk.page_registry.find_model(SharingModel)
    if model is None or model.program_sharing is None:
        return None
    result_handler = SharingResultHandler(desk, journal)
    thread = SharingThread(model.program_sharing, table.look, result_handler.handle_result)
    model.synchronize_now, model.get_waiting_time_s = thread.synchronize_now, thread.get_waiting_time_s
    thread.start()
    return thread.close


@dataclass(slots=True)
class SharingResultHandler:
    """Handler of synchronization results, called on the sharing thread.

    It reports each message only once.
    """

    desk: Desk
    journal: Journal
    _trouble: str = ""
    _told: frozenset[str] = frozenset()

    def handle_result(self, result: SharingResult) -> None:
        """Log an error of the synchronization.

        If another machine has a newer version of the loaded program, show a message on the prompt line.
        """
        if result.error_text and result.error_text != self._trouble:
            self.journal.hear(LogEvent(self.desk.read_snapshot().t, "warning", result.error_text))
        self._trouble = result.error_text
        from core.extras.sharing.shared_versions import ProgramVersions, make_program_key

        name = self.desk.program_loader.loaded_program.name
        family = result.versions_by_program.get(make_program_key(name), ProgramVersions())
        fresh = (
            frozenset(each.id for each in family.newest_remote_versions) - self._told
            if family.local_version_id
            else frozenset()
        )
        if fresh:
            self._told |= fresh
            who = next(each.desk for each in family.newest_remote_versions if each.id in fresh)
            text = tr(Message("{name} WAS CHANGED ON {machine}. F1, X: SHOW CHANGES", name=name, machine=who))
            self.desk.hear(LogEvent(self.desk.read_snapshot().t, "shared", text))  # shown with the next frame


def make_shared_location(table: SharingTable) -> SharedLocation:
    """Return the shared location that is configured in the machine file, without opening it."""
    if table.postgresql:
        from core.extras.sharing.shared_database import SharedDatabase

        return SharedDatabase(table.postgresql)
    from core.extras.sharing.shared_folder import SharedFolder

    return SharedFolder(Path(table.folder).expanduser())


def read_machine_id(folder: Path) -> str:
    """Return the unique id of this machine, which is created and stored at the first call.

    Raises CommandError if the id cannot be read or stored.
    """
    from core.extras.sharing.version_record import is_machine_id

    path = folder / MACHINE_ID_FILE
    try:
        text = path.read_text(encoding="ascii").strip() if path.exists() else ""
        if is_machine_id(text):
            return text
        return store_machine_id(folder, secrets.token_hex(16))
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(
            Message("{path} cannot be used: {error}", path=path, error=error), "unusable"
        ) from error


def store_machine_id(folder: Path, machine_id: str) -> str:
    """Store the given id as the id of this machine and return it."""
    write_atomically(folder / MACHINE_ID_FILE, f"{machine_id}\n".encode())
    return machine_id
