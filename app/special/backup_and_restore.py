"""Backup and restore of all stored data: offsets, versions, counts, settings and the log."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.daily_backup import BACKUP_SUFFIX
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.persistence import Persistence
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.programs.atomic_files import FileOperationError
from app.programs.removable_media import UsbStick, list_usb_sticks
from app.special.special_functions import SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.file_replacement import sync_all_files
from core.message import Message
from core.store.backup import BackupCheckResult

_TERMINAL_HINT = "Close TurnDesk, then run in a terminal: turndesk store restore FILE"
RESTORE_REFUSAL = "PROGRAM RUNNING. WAIT UNTIL IT ENDS, THEN RESTORE"


@dataclass(frozen=True, slots=True)
class BackupLocation:
    """Folder for backups, or one backup in a folder."""

    label: str
    path: Path
    is_backup: bool = False
    size_bytes: int = 0
    backup_time_text: str = ""


class BackupFunction(SpecialFunction):
    """Special function (F10) for backup and restore.

    Enter on a folder makes a backup, and Enter on a backup restores it.
    """

    name = "BACKUP AND RESTORE"
    use = "offsets, versions, settings, log"

    def __init__(
        self,
        desk: Desk,
        persistence: Persistence,
        worker: LatestRequestWorker,
        csv_folder: Path,
        list_media: Callable[[], Sequence[UsbStick]] = list_usb_sticks,
        daily_folder: Path | None = None,
    ) -> None:
        """Create the special function.

        ``daily_folder`` is the folder of the daily backups, or None if they are in ``csv_folder``.
        """
        super().__init__(desk)
        self.persistence, self.worker, self.backup_folder, self.list_media = (
            persistence,
            worker,
            csv_folder,
            list_media,
        )
        self.daily_folder = daily_folder
        self.listed_locations: tuple[BackupLocation, ...] = ()
        self.check_results: dict[BackupLocation, BackupCheckResult] = {}
        self.check_error = ""  # reason why backups cannot be checked: the present data is unreadable
        self.task_text = ""
        self.on_restored: Callable[[], None] = lambda: None

    @property
    def row_count(self) -> int:
        """Return the number of listed folders and backups."""
        return len(self.listed_locations)

    def on_open(self) -> None:
        """List the folders and backups."""
        self.reload_locations()

    def reload_locations(self) -> None:
        """List the folders and backups again.

        The result is shown in a later frame.
        """
        self.worker.enqueue_work(
            lambda: _list_places(self.backup_folder, self.list_media(), self.daily_folder),
            self._found,
            self._failed,
        )

    def _found(self, places: tuple[BackupLocation, ...]) -> None:
        self.listed_locations = places
        self.marked = min(self.marked, max(0, len(places) - 1))
        self.check_results, self.check_error = {}, ""
        for place in places:
            if place.is_backup:
                self.worker.enqueue_work(partial(self._check_place, place), self._judge, self._not_judged)

    def _check_place(self, place: BackupLocation) -> tuple[BackupLocation, BackupCheckResult]:
        """Check a backup on the worker, and return it with the result of the check.

        Raise StoreError on failure.
        """
        return place, self.persistence.check_backup(place.path)

    def _judge(self, found: tuple[BackupLocation, BackupCheckResult]) -> None:
        place, verdict = found
        if place in self.listed_locations:
            self.check_results[place] = verdict

    def _not_judged(self, why: str) -> None:
        self.check_error = why

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of folders, each followed by its backups."""
        rows = tuple(
            TableRow(
                (
                    place.label if not place.is_backup else f"     {place.label}",
                    self._does(place),
                    Message("{size} KB", size=f"{place.size_bytes / 1024:.0f}") if place.is_backup else "",
                    place.backup_time_text,
                ),
                None if place.is_backup else True,
                StatusTone.WAIT,
            )
            for place in self.listed_locations
        )
        return TableContent(
            "BACKUP AND RESTORE",
            ("PLACE", "ACTION ON ENTER", "SIZE", "WHEN"),
            (0.36, 0.29, 0.13, 0.22),
            rows,
            self.marked,
            notes=(self.task_text,) if self.task_text else self._make_notes(),
            untranslated_columns=frozenset({0, 2, 3}),
        )

    def _does(self, place: BackupLocation) -> str:
        if not place.is_backup:
            return "BACK UP HERE"
        verdict = self.check_results.get(place)
        if verdict is None:
            return "NOT CHECKED" if self.check_error else "CHECKING …"
        return "CANNOT RESTORE: BACKUP DAMAGED" if verdict.first_problem else "RESTORE (BACKUP IS INTACT)"

    def _make_notes(self) -> tuple[str, ...]:
        """Return the notes about the selected backup.

        The notes describe the damage to the backup or the effect of a restore.
        """
        kept = (
            "When a backup is restored, a copy of the replaced data is saved in the same folder "
            "as the new data."
        )
        place = self.listed_locations[self.marked] if self.listed_locations else None
        verdict = self.check_results.get(place) if place is not None else None
        if verdict is None:
            return (self.check_error, tr(_TERMINAL_HINT)) if self.check_error else (kept,)
        if verdict.first_problem:
            return (verdict.first_problem, kept)
        what = _describe_differences(verdict)
        differs = Message("Differences from the current data: {what}.", what=what)
        return (tr(differs if what else "The backup and the current data are the same."), kept)

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key F4, which searches for removable media again."""
        return {"F4": FunctionKey("REFRESH", self.reload_locations)}

    def activate_selected_row(self) -> bool:
        """Make a backup in the selected folder, or restore the selected backup."""
        if self.task_text:
            self.desk.say("STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE")
        elif self.listed_locations:
            place = self.listed_locations[self.marked]
            (self._restore if place.is_backup else self._backup)(place)
        return True

    def _backup(self, place: BackupLocation) -> None:
        if self.desk.is_refused(ProtectedChange.BACKUPS):
            return
        name = f"{datetime.now().strftime('%Y-%m-%d-%H%M%S')}{BACKUP_SUFFIX}"
        target = place.path / name
        self.task_text = "Backing up …"
        self.desk.clear_prompt_line()

        def make_backup() -> str:
            try:
                place.path.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise FileOperationError(
                    Message("{target} CANNOT BE WRITTEN: {cause}", target=place.path, cause=error.strerror)
                ) from error
            self.persistence.backup(target)
            sync_all_files()
            return name

        self.worker.enqueue_work(make_backup, partial(self._backed_up, place), self._failed)

    def _backed_up(self, place: BackupLocation, name: str) -> None:
        self.task_text = ""
        own = place.path in {self.backup_folder, self.daily_folder}
        done = (
            "BACKUP {name} IS COMPLETE" if own else "BACKUP {name} IS COMPLETE. YOU CAN REMOVE THE USB STICK"
        )
        self.desk.show_success(tr(Message(done, name=name)))
        self.reload_locations()

    def _restore(self, place: BackupLocation) -> None:
        if self.check_error:
            self.desk.show_refusal(tr(_TERMINAL_HINT))
            return
        if self.desk.is_refused(ProtectedChange.RESTORE):
            return
        verdict = self.check_results.get(place)
        if verdict is None or verdict.first_problem:
            why = (
                verdict.first_problem
                if verdict is not None
                else tr("THE BACKUP IS STILL BEING CHECKED: WAIT")
            )
            self.desk.show_refusal(why)
            return
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            self.desk.say(RESTORE_REFUSAL)
            return
        asked = tr("Y: RESTORE {name} OVER ALL CURRENT DATA (DIFFERENCES: {what})   N: CANCEL")
        what = _describe_differences(verdict) or tr("NONE")
        self.desk.ask_operator(
            tr(Message(asked, name=place.label, what=what)), lambda: self._restore_now(place)
        )

    def _restore_now(self, place: BackupLocation) -> None:
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            self.desk.say(RESTORE_REFUSAL)
            return
        self.task_text = "Restoring …"
        self.desk.storage_state.begin_restore()
        self.worker.enqueue_work(lambda: self.persistence.restore(place.path), self._done, self._failed)

    def _done(self, kept: Path | None) -> None:
        self.task_text = ""
        self.desk.storage_state.end_restore()
        where = kept.name if kept else "—"
        self.persistence.log_change(
            Message("restored; previous data saved as {place}", place=where)
        )  # The signed-in user is still known.
        self.on_restored()
        said = tr(Message("RESTORED. PREVIOUS DATA SAVED AS {name}", name=where))
        self.desk.show_success(said)
        self.reload_locations()

    def _failed(self, why: str) -> None:
        self.task_text = ""
        self.desk.storage_state.end_restore()
        self.desk.show_refusal(why)

    def prompt_text(self) -> str:
        """Return the prompt that names the keys for backup, restore and finding media."""
        return "ENTER OR TAP: BACK UP OR RESTORE   F4: LOOK FOR USB STICKS"


def _describe_differences(verdict: BackupCheckResult) -> str:
    """Return, as text, how many rows of each table a restore would change.

    The text is empty if a restore would not change anything.
    """
    difference_texts = [f"{tr(name)} {count}" for name, count in verdict.difference_counts]
    if verdict.has_older_version:
        difference_texts.append(tr("other data was not compared because the backup is from an older version"))
    return ", ".join(difference_texts)


def _list_places(folder: Path, media: Sequence[UsbStick], daily: Path | None) -> tuple[BackupLocation, ...]:
    """Return the control's folders and the removable media, each with its backups, newest first."""
    found: list[BackupLocation] = []
    kept = [(tr("THIS CONTROL"), folder), *([(tr("DAILY BACKUPS"), daily)] if daily is not None else [])]
    for label, path in (*kept, *((stick.label, stick.path) for stick in media)):
        found.append(BackupLocation(label, path))
        backups = sorted(path.glob(f"*{BACKUP_SUFFIX}"), key=lambda file: file.name, reverse=True)
        found += [_backup_of(file) for file in backups if not file.name.startswith(".")]
    return tuple(found)


def _backup_of(file: Path) -> BackupLocation:
    status = file.stat()
    at = datetime.fromtimestamp(status.st_mtime).strftime("%Y-%m-%d %H:%M")
    return BackupLocation(file.name.removesuffix(BACKUP_SUFFIX), file, True, status.st_size, at)
