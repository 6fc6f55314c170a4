"""Services of the operator screen: supervised threads, status file, backup and shop network."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from app.compose.optional_features import extras
from app.compose.runs.journal import Journal
from app.desk.daily_backup import DailyBackup
from app.desk.data_folder import BACKUPS_FOLDER_NAME, find_data_folder
from app.desk.desk import Desk
from app.desk.programs.program_folder import ProgramFileMonitor
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.shopfloor.machine_reading import UNKNOWN_READING, MachineReader
from app.shopfloor.status_file import STATUS_FILE_NAME, StatusFileUpdater, StatusFileWriter, make_status
from core.closing_steps import ClosingStep
from core.executor.safety.watchdog import WATCHDOG_THREAD_NAME
from core.executor.snapshot import LogEvent, Snapshot
from core.machine.machine_model import Machine
from core.machine.serial_and_backup_tables import BackupTable
from core.message import Message
from core.store.backup import find_store_problems as backup_problems
from core.store.store_rows import get_utc_now_text

# Threads other than the executor, with the function that is lost when they end.
SUPERVISED_THREAD_TEXTS = {
    "store-writer": "STORAGE OF OFFSETS AND COUNTS",
    "daily-backup": "DAILY BACKUP",
    "status": "STATUS.JSON",
    "program-file": "PROGRAM FILE MONITOR",
    "inverter": "INVERTER CONNECTION",
    "recorder": "SCOPE RECORDER",
    WATCHDOG_THREAD_NAME: "CONTROL WATCHDOG",
    "commands": "OPERATION OF THE CONTROL",
    **{name: what for extra in extras().values() for name, what in extra.supervised_threads.items()},
}


def report_ended_thread(report_warning: Callable[[str], None], name: str) -> None:
    """Report that a supervised thread has ended. The machine continues to run.

    The function is called in the watchdog's thread.
    """
    text = tr(
        Message("{what} STOPPED. SAVE THE LOG, THEN RESTART TURNDESK", what=tr(SUPERVISED_THREAD_TEXTS[name]))
    )
    report_warning(text)


class DeskServices:
    """Services of the operator screen: the program file monitor, status file, daily backup and features.

    Errors are reported on the prompt line and in the event log. No status file is written if another
    TurnDesk process uses the data folder.
    """

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._steps = list[ClosingStep]()

    def start(self, desk: Desk) -> None:
        """Start the services of this screen."""
        journal = self._journal

        def tell(why: str) -> None:
            desk.say(tr(Message("NO SHOP-FLOOR DATA: {why}", why=why)))
            journal.hear(LogEvent(desk.read_snapshot().t, "warning", why))

        assert desk.machine.machine is not None
        if not journal.write_error or journal.waiting:
            self._add(_start_status_file(desk.machine.machine, desk.read_snapshot, find_data_folder()))
            self._add(_start_daily_backup(desk, desk.machine.machine, journal))
        for extra in extras().values():
            self._add(extra.start_services(desk, journal, tell))
        file = ProgramFileMonitor(lambda: desk.program_loader.loaded_program)
        desk.storage_state.set_file_readers(
            lambda: file.difference_text, file.request_check, lambda: file.can_reload
        )
        self._steps.append(ClosingStep("program-file", file.close))
        file.start()

    def list_closing_steps(self) -> tuple[ClosingStep, ...]:
        """Return the steps that close the services that have started."""
        return tuple(self._steps)

    def _add(self, close: Callable[[], None] | None) -> None:
        if close is not None:
            self._steps.append(ClosingStep(f"shop-floor-{len(self._steps) + 1}", close))


def _start_status_file(
    machine: Machine, snapshot: Callable[[], Snapshot], folder: Path
) -> Callable[[], None]:
    """Start updating the status file in this folder, and return the function that ends the updates."""
    reader = MachineReader(machine, time.monotonic)
    keeper = StatusFileUpdater(
        StatusFileWriter(folder / STATUS_FILE_NAME, get_utc_now_text),
        lambda: make_status(machine.name, reader.make_reading(snapshot())),
        make_status(machine.name, UNKNOWN_READING),
    )
    keeper.start()
    return keeper.close


def _start_daily_backup(desk: Desk, machine: Machine, journal: Journal) -> Callable[[], None]:
    """Start regular checks whether a backup is due, and return the function that ends the checks.

    Errors are shown and logged.
    """

    def report_error(why: str) -> None:
        text = tr(Message("NO DAILY BACKUP: {why}", why=why))
        desk.say(text)
        journal.hear(LogEvent(desk.read_snapshot().t, "warning", text))

    def is_idle() -> bool:
        return desk.read_snapshot().state not in ACTIVE_STATES

    def report_same_disk() -> None:
        text = tr(
            "DAILY BACKUPS: {folder} IS ON THE SAME DISK AS THE DATA. CHECK THAT THE BACKUP DISK IS MOUNTED"
        )
        journal.hear(LogEvent(desk.read_snapshot().t, "warning", tr(Message(text, folder=folder))))

    table = machine.hardware.find_driver_table(BackupTable) or BackupTable()
    folder = Path(table.folder) if table.folder else find_data_folder() / BACKUPS_FOLDER_NAME
    daily = DailyBackup(folder, table.keep, journal.backup, backup_problems, is_idle, report_error)
    if table.folder:
        daily.data_folder, daily.report_same_disk = find_data_folder(), report_same_disk
    daily.start()
    return daily.close
