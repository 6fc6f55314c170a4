"""Services of the operator screen: supervised threads, status file, daily backup and shop network."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from app.compose.extra import extras
from app.compose.runs.journal import Journal
from app.desk.daily_backup import DailyBackup
from app.desk.data_folder import BACKUPS, data_folder
from app.desk.desk import Desk
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.shopfloor.floor_reading import UNKNOWN, FloorReader
from app.shopfloor.status_file import NAME, StatusFile, StatusKeeper, status_of
from core.executor.safety.watchdog import WATCHDOG
from core.executor.snapshot import Event, Snapshot
from core.machine.desk_tables import BackupTable
from core.machine.machine_model import Machine
from core.message import Message
from core.store.backup import problems as backup_problems
from core.store.store_rows import utc_now

# Threads other than the executor, with the function that is lost when they end.
SUPERVISED = {
    "store-writer": "STORAGE OF OFFSETS AND COUNTS",
    "daily-backup": "DAILY BACKUP",
    "status": "STATUS.JSON",
    "program-file": "PROGRAM FILE MONITOR",
    "inverter": "INVERTER CONNECTION",
    "recorder": "SCOPE RECORDER",
    WATCHDOG: "CONTROL WATCHDOG",
    "commands": "OPERATION OF THE CONTROL",
    **{name: what for extra in extras().values() for name, what in extra.threads.items()},
}


def report_ended_thread(desk: Desk, journal: Journal, name: str) -> None:
    """Report that a supervised thread has ended. Called in the watchdog's thread; the machine continues."""
    text = tr(Message("{what} STOPPED. SAVE THE LOG, THEN RESTART TURNDESK", what=tr(SUPERVISED[name])))
    desk.say(text)
    journal.hear(Event(desk.snapshot().t, "warning", text))


def start_services(desk: Desk, journal: Journal) -> list[Callable[[], None]]:
    """Start the status file, the daily backup, and the services of optional features; return close functions.

    Errors are reported on the prompt line and in the event log. No status file is written if another TurnDesk
    uses the data folder.
    """

    def tell(why: str) -> None:
        desk.say(tr(Message("NO SHOP-FLOOR DATA: {why}", why=why)))
        journal.hear(Event(desk.snapshot().t, "warning", why))

    assert desk.machine.model is not None
    open_ones = list[Callable[[], None]]()
    if not journal.trouble or journal.waiting:
        open_ones.append(_keep_status(desk.machine.model, desk.snapshot, data_folder()))
        open_ones.append(_daily_backup(desk, desk.machine.model, journal))
    started = [extra.start(desk, journal, tell) for extra in extras().values()]
    open_ones += [close for close in started if close is not None]
    return open_ones


def _keep_status(machine: Machine, snapshot: Callable[[], Snapshot], folder: Path) -> Callable[[], None]:
    """Start updating the status file in this folder; return the function that ends it."""
    reader = FloorReader(machine, time.monotonic)
    keeper = StatusKeeper(
        StatusFile(folder / NAME, utc_now),
        lambda: status_of(machine.name, reader.look(snapshot())),
        status_of(machine.name, UNKNOWN),
    )
    keeper.start()
    return keeper.close


def _daily_backup(desk: Desk, machine: Machine, journal: Journal) -> Callable[[], None]:
    """Start checking regularly whether a backup is due; errors are shown and logged."""

    def tell(why: str) -> None:
        text = tr(Message("NO DAILY BACKUP: {why}", why=why))
        desk.say(text)
        journal.hear(Event(desk.snapshot().t, "warning", text))

    def still() -> bool:
        return desk.snapshot().state not in UNDER_WAY

    def same_disk() -> None:
        text = tr(
            "DAILY BACKUPS: {folder} IS ON THE SAME DISK AS THE DATA. CHECK THAT THE BACKUP DISK IS MOUNTED"
        )
        journal.hear(Event(desk.snapshot().t, "warning", tr(Message(text, folder=folder))))

    table = machine.hardware.table(BackupTable) or BackupTable()
    folder = Path(table.folder) if table.folder else data_folder() / BACKUPS
    daily = DailyBackup(folder, table.keep, journal.backup, backup_problems, still, tell)
    if table.folder:
        daily.apart, daily.hint = data_folder(), same_disk
    daily.start()
    return daily.close
