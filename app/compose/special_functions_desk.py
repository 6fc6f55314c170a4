"""Assembly of the list of special functions (F10)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.optional_features import extras, insert_items_after
from app.compose.program_transfer import DEFAULT_SETTINGS, SerialPortLines, create_program_checker
from app.desk.background_work import LatestRequestWorker
from app.desk.data_folder import BACKUPS_FOLDER_NAME, find_data_folder
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.production.parts_watch import ProductionMonitor
from app.scope.scope_function import ScopeFunction
from app.special.backup_and_restore import BackupFunction
from app.special.counter_functions import PartsCounterFunction, ToolLifeFunction
from app.special.inputs_outputs import DriveStatusFunction, SignalsFunction
from app.special.lamps_and_sound import EventSoundPlayer, LampsAndSoundFunction
from app.special.machine_records import EventLogFunction, MachineFileFunction
from app.special.operator_settings import RParametersFunction, ScreenSettingsFunction, SpindleLimitFunction
from app.special.setup_sheet_function import SetupSheetFunction
from app.special.special_functions import SpecialFunction, SpecialFunctionsModel
from app.transfer.serial_transfer import SerialTransferFunction
from core.language.source import Dialect, get_default_extension
from core.machine.machine_model import Machine
from core.machine.serial_and_backup_tables import BackupTable, SerialLineModel

MakeFunction = Callable[[Desk, Machine, Persistence, LatestRequestWorker], SpecialFunction]


def _backup(
    desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
) -> SpecialFunction:
    table = machine.hardware.find_driver_table(BackupTable)
    daily = Path(table.folder) if table is not None and table.folder else None
    backup = BackupFunction(
        desk, persistence, worker, find_data_folder() / BACKUPS_FOLDER_NAME, daily_folder=daily
    )

    def reload_restored_data() -> None:
        desk.settings_store.reload()
        desk.program_runs.part_counter.reload()
        desk.user_access.reload()

    backup.on_restored = reload_restored_data
    return backup


def _setup_sheet(
    desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
) -> SpecialFunction:
    return SetupSheetFunction(desk, machine, persistence, worker, find_data_folder() / "sheets")


def _create_transfer(
    desk: Desk, machine: Machine, persistence: Persistence, workshop: LoadingSteps, program_folder: Path
) -> SpecialFunction:
    """Return the special function that transfers programs over RS-232 and proves received programs.

    Its initial settings are from [dnc] of the machine file.
    """
    lines = SerialPortLines(
        create_program_checker(workshop), get_default_extension(Dialect(machine.mdi_language))
    )
    return SerialTransferFunction(
        desk,
        persistence,
        lines,
        machine.hardware.find_driver_table(SerialLineModel) or DEFAULT_SETTINGS,
        program_folder,
    )


# One line for each special function, in the order of the list. Functions without their hardware are not
# shown.
FUNCTION_ITEMS: tuple[MakeFunction, ...] = (
    lambda desk, machine, _keep, _worker: SpindleLimitFunction(desk, machine.spindle),
    lambda desk, _machine, _keep, _worker: PartsCounterFunction(desk),
    lambda desk, machine, _keep, _worker: SignalsFunction(desk, machine),
    lambda desk, machine, _keep, _worker: DriveStatusFunction(desk, machine),
    lambda desk, _machine, persistence, worker: EventLogFunction(desk, persistence, worker),
    _backup,
    lambda desk, _machine, _keep, _worker: ScreenSettingsFunction(desk),
    lambda desk, _machine, _keep, _worker: MachineFileFunction(desk, desk.changes),
)


def create_special_functions(
    desk: Desk,
    machine: Machine,
    persistence: Persistence,
    loading_steps: LoadingSteps,
    program_folder: Path,
    sounds: EventSoundPlayer,
) -> SpecialFunctionsModel:
    """Return the list of all special functions.

    ``loading_steps`` proves programs received over RS-232, and ``program_folder`` is the folder of the
    operator's programs.
    """
    worker = LatestRequestWorker("editing-special")
    functions = [make(desk, machine, persistence, worker) for make in FUNCTION_ITEMS]
    functions.append(_create_transfer(desk, machine, persistence, loading_steps, program_folder))
    functions.append(_setup_sheet(desk, machine, persistence, worker))
    functions.append(ScopeFunction(desk))
    watch = desk.page_registry.find_model(ProductionMonitor)
    if watch is not None and machine.kind == "lathe":
        functions.append(ToolLifeFunction(desk, watch))
    functions.append(LampsAndSoundFunction(desk, machine, sounds))
    if machine.mdi_language == Dialect.SINUMERIK:
        functions.append(RParametersFunction(desk, persistence, worker))
    elsewhere = {name for extra in extras().values() for name in extra.own_special_functions}
    functions = [each for each in functions if each.name not in elsewhere]
    added = [
        pair
        for extra in extras().values()
        for pair in extra.list_special_functions(desk, machine, persistence, worker)
    ]
    return SpecialFunctionsModel(insert_items_after(functions, lambda function: function.name, added), worker)
