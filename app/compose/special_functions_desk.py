"""Assembly of the special functions (F10), one line for each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.extra import extras, insert_after
from app.compose.program_transfer import PLAIN, SerialLines, proving
from app.desk.background_work import Latest
from app.desk.data_folder import BACKUPS, data_folder
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.production.parts_watch import PartsWatch
from app.scope.scope_function import ScopeFunction
from app.special.backup_and_restore import BackupAndRestore
from app.special.counters import PartsCounterFunction, ToolLifeFunction
from app.special.inputs_outputs import DriveStatus, InputsOutputs
from app.special.lamps_and_sound import DeskSounds, LampsAndSound
from app.special.machine_records import LoggedEvents, MachineFileAcceptance
from app.special.operator_settings import RParameters, ScreenPreferences, SpindleSpeedLimit
from app.special.setup_sheet_function import SetupSheetFunction
from app.special.special_functions import SpecialFunction, SpecialFunctions
from app.transfer.serial_transfer import SerialTransfer
from core.language.source import Dialect, usual_ending
from core.machine.desk_tables import BackupTable, DncModel
from core.machine.machine_model import Machine

MakeFunction = Callable[[Desk, Machine, Persistence, Latest], SpecialFunction]


def _backup(desk: Desk, machine: Machine, persistence: Persistence, worker: Latest) -> SpecialFunction:
    table = machine.hardware.table(BackupTable)
    daily = Path(table.folder) if table is not None and table.folder else None
    backup = BackupAndRestore(desk, persistence, worker, data_folder() / BACKUPS, daily=daily)

    def restored() -> None:
        desk.settings.reload()
        desk.runs.counter.reload()
        desk.access.reload()

    backup.restored = restored
    return backup


def _setup_sheet(desk: Desk, machine: Machine, persistence: Persistence, worker: Latest) -> SpecialFunction:
    return SetupSheetFunction(desk, machine, persistence, worker, data_folder() / "sheets")


def _transfer(
    desk: Desk, machine: Machine, persistence: Persistence, workshop: LoadingSteps, own: Path
) -> SpecialFunction:
    """Return the RS-232 function, with the settings of [dnc] at first. Received programs are proved."""
    lines = SerialLines(proving(workshop), usual_ending(Dialect(machine.language)))
    return SerialTransfer(desk, persistence, lines, machine.hardware.table(DncModel) or PLAIN, own)


# One line for each special function, in the order of the list. Functions without their hardware are not
# shown.
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


def special_functions(
    desk: Desk,
    machine: Machine,
    persistence: Persistence,
    workshop: LoadingSteps,
    own: Path,
    sounds: DeskSounds,
) -> SpecialFunctions:
    """Return all special functions.

    ``workshop`` proves programs received over RS-232, and ``own`` is the folder of the operator's programs.
    """
    worker = Latest("editing-special")
    functions = [make(desk, machine, persistence, worker) for make in ITEMS]
    functions.append(_transfer(desk, machine, persistence, workshop, own))
    functions.append(_setup_sheet(desk, machine, persistence, worker))
    functions.append(ScopeFunction(desk))
    watch = desk.pages.find(PartsWatch)
    if watch is not None and machine.kind == "lathe":
        functions.append(ToolLifeFunction(desk, watch))
    functions.append(LampsAndSound(desk, machine, sounds))
    if machine.language == Dialect.SINUMERIK:
        functions.append(RParameters(desk, persistence, worker))
    elsewhere = {name for extra in extras().values() for name in extra.own_functions}
    functions = [each for each in functions if each.name not in elsewhere]
    added = [
        pair
        for extra in extras().values()
        for pair in extra.special_functions(desk, machine, persistence, worker)
    ]
    return SpecialFunctions(insert_after(functions, lambda function: function.name, added), worker)
