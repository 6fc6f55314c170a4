"""Backup and restore of all stored data: offsets, versions, counts, settings and log."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.daily_backup import ENDING
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.persistence import Persistence
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.programs.removable_media import Stick, sticks
from app.programs.whole_file import FileError
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.file_placing import all_to_disk
from core.message import Message
from core.store.backup import Verdict

_IN_TERMINAL = "Close TurnDesk, then run in a terminal: turndesk store restore FILE"
BARRED = "PROGRAM RUNNING. WAIT UNTIL IT ENDS, THEN RESTORE"


@dataclass(frozen=True, slots=True)
class Place:
    """Folder for backups, or one backup in a folder."""

    label: str
    path: Path
    backup: bool = False
    size: int = 0
    at: str = ""


class BackupAndRestore(SpecialFunction):
    """Special function for backups: Enter on a folder makes a backup, and Enter on a backup restores it."""

    name = "BACKUP AND RESTORE"
    use = "offsets, versions, settings, log"

    def __init__(
        self,
        desk: Desk,
        persistence: Persistence,
        worker: Latest,
        folder: Path,
        plugged: Callable[[], Sequence[Stick]] = sticks,
        daily: Path | None = None,
    ) -> None:
        """Create the function.

        ``daily`` is the folder of daily backups if it differs from ``folder``.
        """
        super().__init__(desk)
        self.persistence, self.worker, self.folder, self.plugged = persistence, worker, folder, plugged
        self.daily = daily
        self.places: tuple[Place, ...] = ()
        self.verdicts: dict[Place, Verdict] = {}
        self.unchecked = ""  # reason why backups cannot be checked: the present data is unreadable
        self.busy = ""
        self.restored: Callable[[], None] = lambda: None

    @property
    def count(self) -> int:
        """Number of listed folders and backups."""
        return len(self.places)

    def opened(self) -> None:
        """List the folders and backups."""
        self.look()

    def look(self) -> None:
        """List folders and backups again. The result arrives in a later frame."""
        self.worker.queue(lambda: _places(self.folder, self.plugged(), self.daily), self._found, self._failed)

    def _found(self, places: tuple[Place, ...]) -> None:
        self.places = places
        self.marked = min(self.marked, max(0, len(places) - 1))
        self.verdicts, self.unchecked = {}, ""
        for place in places:
            if place.backup:
                self.worker.queue(partial(self._judged, place), self._judge, self._not_judged)

    def _judged(self, place: Place) -> tuple[Place, Verdict]:
        """Check a backup on the worker. Raises StoreError."""
        return place, self.persistence.judge(place.path)

    def _judge(self, found: tuple[Place, Verdict]) -> None:
        place, verdict = found
        if place in self.places:
            self.verdicts[place] = verdict

    def _not_judged(self, why: str) -> None:
        self.unchecked = why

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of folders, each followed by its backups."""
        rows = tuple(
            Row(
                (
                    place.label if not place.backup else f"     {place.label}",
                    self._does(place),
                    Message("{size} KB", size=f"{place.size / 1024:.0f}") if place.backup else "",
                    place.at,
                ),
                None if place.backup else True,
                Tone.WAIT,
            )
            for place in self.places
        )
        return Sheet(
            "BACKUP AND RESTORE",
            ("PLACE", "ACTION ON ENTER", "SIZE", "WHEN"),
            (0.36, 0.29, 0.13, 0.22),
            rows,
            self.marked,
            notes=(self.busy,) if self.busy else self._notes(),
            raw=frozenset({0, 2, 3}),
        )

    def _does(self, place: Place) -> str:
        if not place.backup:
            return "BACK UP HERE"
        verdict = self.verdicts.get(place)
        if verdict is None:
            return "NOT CHECKED" if self.unchecked else "CHECKING …"
        return "CANNOT RESTORE: BACKUP DAMAGED" if verdict.problem else "RESTORE (BACKUP IS INTACT)"

    def _notes(self) -> tuple[str, ...]:
        """Return the notes about the selected backup: its damage, or the effect of a restore."""
        kept = (
            "When a backup is restored, a copy of the replaced data is saved in the same folder "
            "as the new data."
        )
        place = self.places[self.marked] if self.places else None
        verdict = self.verdicts.get(place) if place is not None else None
        if verdict is None:
            return (self.unchecked, tr(_IN_TERMINAL)) if self.unchecked else (kept,)
        if verdict.problem:
            return (verdict.problem, kept)
        what = _differences(verdict)
        differs = Message("Differences from the current data: {what}.", what=what)
        return (tr(differs if what else "The backup and the current data are the same."), kept)

    def keys(self) -> Mapping[str, Key]:
        """Return F4, which looks for media again."""
        return {"F4": Key("REFRESH", self.look)}

    def act(self) -> bool:
        """Make or restore the selected backup."""
        if self.busy:
            self.desk.say("STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE")
        elif self.places:
            place = self.places[self.marked]
            (self._restore if place.backup else self._backup)(place)
        return True

    def _backup(self, place: Place) -> None:
        if self.desk.refused(Act.BACKUPS):
            return
        name = f"{datetime.now().strftime('%Y-%m-%d-%H%M%S')}{ENDING}"
        target = place.path / name
        self.busy = "Backing up …"
        self.desk.clear()

        def work() -> str:
            try:
                place.path.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise FileError(
                    Message("{target} CANNOT BE WRITTEN: {cause}", target=place.path, cause=error.strerror)
                ) from error
            self.persistence.backup(target)
            all_to_disk()
            return name

        self.worker.queue(work, partial(self._backed_up, place), self._failed)

    def _backed_up(self, place: Place, name: str) -> None:
        self.busy = ""
        own = place.path in {self.folder, self.daily}
        done = (
            "BACKUP {name} IS COMPLETE" if own else "BACKUP {name} IS COMPLETE. YOU CAN REMOVE THE USB STICK"
        )
        self.desk.done(tr(Message(done, name=name)))
        self.look()

    def _restore(self, place: Place) -> None:
        if self.unchecked:
            self.desk.refuse(tr(_IN_TERMINAL))
            return
        if self.desk.refused(Act.RESTORE):
            return
        verdict = self.verdicts.get(place)
        if verdict is None or verdict.problem:
            why = verdict.problem if verdict is not None else tr("THE BACKUP IS STILL BEING CHECKED: WAIT")
            self.desk.refuse(why)
            return
        if self.desk.snapshot().state in UNDER_WAY:
            self.desk.say(BARRED)
            return
        asked = tr("Y: RESTORE {name} OVER ALL CURRENT DATA (DIFFERENCES: {what})   N: CANCEL")
        what = _differences(verdict) or tr("NONE")
        self.desk.ask(tr(Message(asked, name=place.label, what=what)), lambda: self._restore_now(place))

    def _restore_now(self, place: Place) -> None:
        if self.desk.snapshot().state in UNDER_WAY:
            self.desk.say(BARRED)
            return
        self.busy = "Restoring …"
        self.desk.storage.begin_restore()
        self.worker.queue(lambda: self.persistence.restore(place.path), self._done, self._failed)

    def _done(self, kept: Path | None) -> None:
        self.busy = ""
        self.desk.storage.end_restore()
        where = kept.name if kept else "—"
        self.persistence.note_change(
            Message("restored; previous data saved as {place}", place=where)
        )  # The signed-in user is still known.
        self.restored()
        said = tr(Message("RESTORED. PREVIOUS DATA SAVED AS {name}", name=where))
        self.desk.done(said)
        self.look()

    def _failed(self, why: str) -> None:
        self.busy = ""
        self.desk.storage.end_restore()
        self.desk.refuse(why)

    def prompt(self) -> str:
        """Return the prompt about Enter."""
        return "ENTER OR TAP: BACK UP OR RESTORE   F4: LOOK FOR USB STICKS"


def _differences(verdict: Verdict) -> str:
    """Return the number of rows per table that a restore would change, as text; empty for no change."""
    told = [f"{tr(name)} {count}" for name, count in verdict.differs]
    if verdict.older:
        told.append(tr("other data was not compared because the backup is from an older version"))
    return ", ".join(told)


def _places(folder: Path, plugged: Sequence[Stick], daily: Path | None) -> tuple[Place, ...]:
    """Return the control's folder and the media, each followed by its backups, newest first."""
    found: list[Place] = []
    kept = [(tr("THIS CONTROL"), folder), *([(tr("DAILY BACKUPS"), daily)] if daily is not None else [])]
    for label, path in (*kept, *((stick.label, stick.path) for stick in plugged)):
        found.append(Place(label, path))
        backups = sorted(path.glob(f"*{ENDING}"), key=lambda file: file.name, reverse=True)
        found += [_backup_of(file) for file in backups if not file.name.startswith(".")]
    return tuple(found)


def _backup_of(file: Path) -> Place:
    status = file.stat()
    at = datetime.fromtimestamp(status.st_mtime).strftime("%Y-%m-%d %H:%M")
    return Place(file.name.removesuffix(ENDING), file, True, status.st_size, at)
