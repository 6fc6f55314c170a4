"""The special functions, the list of programs and the settings of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.program_transfer import PLAIN, SerialLines, proving
from app.desk.access import Access
from app.desk.data_folder import BACKUPS, data_folder
from app.desk.desk import Desk
from app.desk.latest import Latest
from app.desk.persistence import Persistence
from app.desk.program_loading import LoadingSteps
from app.desk.screen_settings import SettingsBook
from app.jobs.jobs_function import JobsFunction
from app.programs.folder_chooser import FolderChooser
from app.programs.import_export import ImportExport
from app.programs.preview import DrawThumbnail, Preview
from app.programs.program_list import ProgramList
from app.programs.run_history import RunHistory
from app.quality.parts_function import MeasuredPartsFunction
from app.quality.shift_function import ShiftReport
from app.scope.scope_function import ScopeFunction
from app.special.access_levels import AccessLevels
from app.special.backup_and_restore import BackupAndRestore
from app.special.drive_status import DriveStatus
from app.special.inputs_outputs import InputsOutputs
from app.special.lamps_and_sound import DeskSounds, LampsAndSound
from app.special.logged_events import LoggedEvents
from app.special.machine_file_acceptance import MachineFileAcceptance
from app.special.part_count import PartCounter
from app.special.parts_counter import PartsCounterFunction
from app.special.preferences import ScreenPreferences
from app.special.setup_sheet_function import SetupSheetFunction
from app.special.special_functions import SpecialFunction, SpecialFunctions
from app.special.spindle_limit import SpindleSpeedLimit
from app.transfer.serial_transfer import SerialTransfer
from core.language.source import Dialect, usual_ending
from core.machine.backup_table import BackupTable
from core.machine.machine_model import Machine
from core.machine.serial_table import DncModel

MakeFunction = Callable[[Desk, Machine, Persistence, Latest], SpecialFunction]


def _backup(desk: Desk, machine: Machine, persistence: Persistence, worker: Latest) -> SpecialFunction:
    table = machine.hardware.table(BackupTable)
    daily = Path(table.folder) if table is not None and table.folder else None
    backup = BackupAndRestore(desk, persistence, worker, data_folder() / BACKUPS, daily=daily)

    def restored() -> None:
        desk.settings.reload()
        desk.counter.reload()
        desk.access.reload()

    backup.restored = restored
    return backup


def _setup_sheet(desk: Desk, machine: Machine, persistence: Persistence, worker: Latest) -> SpecialFunction:
    return SetupSheetFunction(desk, machine, persistence, worker, data_folder() / "sheets")


def _transfer(
    desk: Desk, machine: Machine, persistence: Persistence, workshop: LoadingSteps, own: Path
) -> SpecialFunction:
    """RS-232, at first as [dnc] of the machine file says. What comes in is proved as an import is."""
    lines = SerialLines(proving(workshop), usual_ending(Dialect(machine.language)))
    return SerialTransfer(desk, persistence, lines, machine.hardware.table(DncModel) or PLAIN, own)


# One line for each special function, in the order of the list; one whose hardware is not there has none.
ITEMS: tuple[MakeFunction, ...] = (
    lambda desk, machine, _keep, _worker: SpindleSpeedLimit(desk, machine.spindle),
    lambda desk, _machine, _keep, _worker: PartsCounterFunction(desk),
    lambda desk, machine, _keep, _worker: InputsOutputs(desk, machine),
    lambda desk, machine, _keep, _worker: DriveStatus(desk, machine),
    lambda desk, _machine, persistence, worker: LoggedEvents(desk, persistence, worker),
    _backup,
    lambda desk, _machine, _keep, _worker: ScreenPreferences(desk),
    lambda desk, _machine, _keep, _worker: MachineFileAcceptance(desk, desk.changes),
)


def furnish(
    desk: Desk,
    machine: Machine,
    persistence: Persistence,
    workshop: LoadingSteps,
    own: Path | None = None,
    thumbnail: DrawThumbnail | None = None,
) -> None:
    """Give the desk what it remembers, and the pages that show it.

    ``workshop`` keeps nothing of what it proves; ``own`` is the operator's folder; ``thumbnail`` draws the
    part of a program.
    """
    desk.access = desk.book.access = Access(persistence, desk.say, desk.clock)
    desk.settings = SettingsBook(persistence)
    desk.counter = PartCounter(persistence)
    desk.record = RunHistory(persistence)
    worker = Latest("editing-special")
    own = own or data_folder() / "programs"
    functions = [make(desk, machine, persistence, worker) for make in ITEMS]
    functions.append(_transfer(desk, machine, persistence, workshop, own))
    functions.append(_setup_sheet(desk, machine, persistence, worker))
    functions.append(ScopeFunction(desk))
    functions.append(MeasuredPartsFunction(desk))
    functions.append(JobsFunction(desk))
    functions.append(ShiftReport(desk, machine.name, worker, data_folder() / "sheets"))
    sounds = DeskSounds(desk, persistence)
    desk.attach(sounds)
    desk.hears = sounds.see
    functions.append(LampsAndSound(desk, machine, sounds))
    functions.append(AccessLevels(desk, persistence))
    desk.attach(SpecialFunctions(functions, worker))
    desk.attach(_files(desk, persistence, Preview(workshop, thumbnail), own))


def _files(desk: Desk, persistence: Persistence, preview: Preview, own: Path) -> ProgramList:
    """The list of programs; what comes in is proved with the offsets of that moment."""
    workshop = preview.workshop

    def check(path: Path) -> str:
        job = workshop.make_job(workshop.read(path), False)
        proved = workshop.prove(job, lambda _count: None)
        errors = proved.proof.errors
        result = f"{len(errors)} ERRORS: {errors[0]}" if errors else "PROVED"
        persistence.program_proved(path.name, result, None if errors else proved.proof.cycle_time)
        return errors[0] if errors else ""

    worker = Latest("editing-programs")
    transfer = ImportExport(desk, own, persistence, worker, check, FolderChooser(Path.home()))
    return ProgramList(desk, own, persistence, worker, preview, transfer)
