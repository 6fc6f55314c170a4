"""What the run leaves behind: events, part counts and the program versions that ran, in the store."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Collection, Mapping
from contextlib import closing
from pathlib import Path

from app.compose.control.left_note import take_events, take_note
from app.desk.data_folder import data_folder
from app.desk.persistence import NoRunRecords, Persistence
from app.offsets.offset_book import OffsetBook, OffsetRows, rows_of_store
from app.production.cycle_recorder import CycleRecorder
from app.production.parts_book import PartsBook
from app.programs.run_history import note_cut_off_runs
from core.executor.snapshot import CYCLE, Event, InterruptedJob, Snapshot, of_plain, plain
from core.language.source import Source
from core.message import Message
from core.store import backup, store_connection
from core.store.backup import Verdict, verdict
from core.store.damaged_rows import OF_PROGRAMS
from core.store.people import People
from core.store.production.run_records import RunRecords
from core.store.store import Store
from core.store.store_access import Backlog
from core.store.store_errors import StoreError
from core.store.store_file import FILE_NAME, has_store
from core.store.store_rows import EventRow, Kind, ToolRow, VersionRow

_log = logging.getLogger(__name__)
HELD = 10_000  # events that are kept back while there is no store
UNDER_WAY = "under_way"  # setting: what a power cut would leave interrupted
CLOSED = "the data store is closed"
AGAIN = 5.0  # s between two tries to open a store


def _nobody() -> None:
    """Nobody waits for a store that comes late."""


class Journal(Persistence):
    """Writes by the store's own thread, so that neither executor nor screen ever waits for the disk.

    Without a store (``trouble`` says why) the machine runs all the same. What happens is held in memory, and
    where the reason is one that passes, as a full disk is, the store is opened as soon as it does.
    """

    def __init__(self, folder: Path, *, goes_on: bool = False) -> None:
        """``goes_on``: the control of the journal before is still running, so nothing was interrupted."""
        self._folder, self._goes_on = folder, goes_on
        self.who: Callable[[], str] = str  # has signed in, as the desk knows
        self._lock = threading.Lock()  # held for the blink in which stores or events change hands
        self._held: deque[Event] | None = None  # while a restore is under way
        self._books: list[OffsetBook | PartsBook] = []
        self._store: Store | None = None
        self._program = ""
        self._trouble = ""
        self._recorder = CycleRecorder()
        self._noted: InterruptedJob | None = None  # what a power cut would leave interrupted
        self._has_noted = False  # whether this control has begun or ended anything since
        self._unread = True  # whether what the last one has left is still to be read
        self._closing = threading.Event()
        self._opener: threading.Thread | None = None  # where there was no store at the start
        self.left: InterruptedJob | None = None  # what the last one has left
        self.left_is_logged = True  # as a rule: the control before had a screen to the end
        self.damage: tuple[str, ...] = ()  # what was not as it was saved, in sentences
        self._tell_late: Callable[[], None] = _nobody
        self._late = False  # whether the store came after the start
        try:
            self._store = self._open()
        except StoreError as error:
            self._trouble = str(error)
            self._held = deque(maxlen=HELD)
            if error.passing:
                self._opener = threading.Thread(target=self._try_again, name="store-opener", daemon=True)
                self._opener.start()

    def _open(self) -> Store:
        """The store, and once what the last control has left in it.

        Raises StoreError, and holds nothing then: the lock of a store that was opened and could not be read
        would refuse every later try.
        """
        store = Store.open(self._folder)
        try:
            if self._unread:
                self._read_what_was_left(store)
        except StoreError:
            store.close()
            raise
        return store

    def _read_what_was_left(self, store: Store) -> None:
        """Damage, runs that were cut off, the interrupted job. Raises StoreError."""
        self.damage = (*store.repaired, *store.find_damaged_rows())
        left = None
        if not self._goes_on:
            note_cut_off_runs(store.runs)
            left = self._what_was_left(store)
        with self._lock:
            self._unread = False
            if not self._has_noted:
                self.left = self._noted = left

    def _what_was_left(self, store: Store) -> InterruptedJob | None:
        """Keep what a control has told without a screen; returns the job that is interrupted."""
        program, rows = take_events(self._folder)
        if rows:
            store.events.log_events(rows)
        for _ in (row for row in rows if row.kind == "part"):
            store.runs.add_parts(Path(program).name)
        known, left = take_note(self._folder)
        if not known:
            return of_plain(store.settings.read_setting(UNDER_WAY))
        self.left_is_logged = False
        store.settings.save_setting(UNDER_WAY, None if left is None else plain(left))
        return left

    @classmethod
    def at_home(cls, *, goes_on: bool = False) -> Journal:
        """The journal of the product's folder."""
        return cls(data_folder(), goes_on=goes_on)

    @property
    def trouble(self) -> str:
        """Why nothing is kept, or why the last write failed; empty while all is well."""
        return self._trouble or (self._store.trouble if self._store else "")

    @property
    def held(self) -> str:
        """What is still to be written and waits in memory, in words; empty while nothing has to."""
        store, held = self._store, self._held
        if store is not None:
            return store.backlog.words if store.backlog is not None else ""
        if not held:
            return ""
        parts = sum(event.kind == "part" for event in tuple(held))
        return Backlog("", events=len(held), parts=parts).words

    def note(self, what: InterruptedJob | None) -> None:
        """Keep what a power cut would leave interrupted now; None: nothing."""
        with self._lock:
            self._noted, self._has_noted = what, True
        self._post_noted()

    def _post_noted(self) -> None:
        value = plain(self._noted) if self._noted is not None else None
        self._post(lambda store: store.settings.save_setting(UNDER_WAY, value))

    def book(self) -> OffsetBook:
        """The offsets of the store, for the screen to show and to change."""
        store = self._store
        book = OffsetBook(
            store, "" if store else Message("OFFSETS CANNOT BE SAVED: {problem}", problem=self.trouble)
        )
        rows = self._rows_of_other() if store is None else None
        if rows is not None:
            book.show(rows)
        book.unread = store is None and rows is None and has_store(self._folder)
        self._know(book, store)
        return book

    def _rows_of_other(self) -> OffsetRows | None:
        """Return the offsets of a store that another process writes; None if they cannot be read."""
        if not has_store(self._folder):
            return None
        try:
            with Store.open(self._folder, read_only=True) as store:
                return None if store.find_damaged_rows(OF_PROGRAMS) else rows_of_store(store)
        except StoreError:
            return None

    def parts_book(self, tools: Kind = Kind.TOOL) -> PartsBook:
        """Measured parts and tool lives of the store; ``tools``: the table of this machine."""
        store = self._store
        book = PartsBook(store, "" if store else self.trouble, tools)
        self._know(book, store)
        return book

    def _know(self, book: OffsetBook | PartsBook, store: Store | None) -> None:
        """It is told of another store; also of one that came while the book was made."""
        self._books.append(book)
        if self._store is not store:
            book.reopen(self._store, self._trouble)

    def hear(self, event: Event) -> None:
        """Keep an event; a finished part counts for the program that made it."""
        with self._lock:
            if event.kind == "load":
                self._program = event.text
            if self._held is not None:
                self._held.append(event)
            elif self._store is not None:
                self._write(self._store, event)

    def go_on(self, snapshot: Snapshot) -> None:
        """Take up a control that has gone on without this process, before its events are heard."""
        with self._lock:
            self._program = snapshot.program
            if snapshot.state in CYCLE and self._store is not None:
                self._recorder.go_on(snapshot.program, snapshot.t, self._store.cycles)

    def _write(self, store: Store, event: Event) -> None:
        store.events.log_event(event.kind, event.text, event.line, event.record)
        if event.kind == "part" and self._program:
            store.runs.add_parts(Path(self._program).name)
        self._recorder.hear(event, store.cycles)

    def keep(self, source: Source) -> None:
        """The text that is about to be proved and run becomes a version of its program."""
        if self._store is not None:
            name = Path(source.name).name
            self._store.programs.keep_loaded_version(
                name, source.text.encode("utf-8", "surrogateescape"), "loaded to run"
            )

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        """Every version of a program, newest first. Raises StoreError; not for the screen's thread."""
        return self.opened().programs.list_versions(name)

    def text_of(self, name: str, version: int) -> bytes:
        """A version as it was kept. Raises StoreError; not for the screen's thread."""
        return self.opened().programs.load_version(name, version)

    def save_version(self, name: str, text: bytes, why: str) -> int:
        """Another version; its number once it is kept. Raises StoreError; not for the screen's thread."""
        return self.opened().programs.save_version(name, text, why, who=self.who()).result()

    def read_setting(self, key: str) -> object:
        """A setting; None: not set, or nothing is kept."""
        store = self._store
        return store.settings.read_setting(key) if store else None

    def save_setting(self, key: str, value: object) -> None:
        """Post a setting."""
        self._post(lambda store: store.settings.save_setting(key, value))

    def keep_settings(self, values: Mapping[str, object]) -> None:
        """Settings that are on the disk when this is back. Raises StoreError; not for the screen's thread."""
        store = self.opened()
        for written in [store.settings.save_setting(key, value) for key, value in values.items()]:
            written.result()

    def note_change(self, text: str, who: str = "") -> None:
        """Post a line of the log, where people say who they are."""
        now = self.who()
        if now:
            self._post(lambda store: store.events.log_event("change", text, who=who or now))

    def note_access(self, text: str, who: str) -> None:
        """Post a line of the log; without a store it goes to the log of failures."""
        if self._store is None:
            _log.warning("access: %s (%s)", text, who)
        self._post(lambda store: store.events.log_event("access", text, who=who))

    @property
    def runs(self) -> RunRecords | NoRunRecords:
        """Return the run records of the store that is open now."""
        store = self._store
        return store.runs if store is not None else NoRunRecords(self._trouble or CLOSED)

    def people(self) -> People:
        """Who works at the machine, also by a store that another process writes. Raises StoreError."""
        store = self._store
        if store is not None:
            return store.people.read_people()
        with Store.open(self._folder, read_only=True) as other:
            return other.people.read_people()

    def events(self, search: str, kinds: Collection[str], limit: int) -> tuple[EventRow, ...]:
        """The log, newest first."""
        return self.opened().events.read_events(search, limit, kinds)

    def tools_of_last_run(self, program: str) -> tuple[str, dict[int, ToolRow]]:
        """When it was started last (UTC), and its tools as they were then; on a worker. Raises StoreError."""
        store = self.opened()
        started = next((row.started for row in store.runs.read_records() if row.program == program), None)
        return (started, store.offsets.tools.read_rows_at(started)) if started is not None else ("", {})

    def renamed(self, old: str, new: str) -> None:
        """Versions, count and record go with the program; back when that is on the disk."""
        store = self._store
        if store is not None:
            store.programs.rename_program(old, new).result()

    def backup(self, target: Path) -> None:
        """A copy of the store, also while it is written. Raises StoreError."""
        self.opened()
        backup.backup(self._folder, target)

    def judge(self, source: Path) -> Verdict:
        """Look through a backup and hold it against the store. Raises StoreError."""
        self.opened()
        with closing(store_connection.connect(self._folder / FILE_NAME, read_only=True)) as now:
            return verdict(now, source)

    def restore(self, source: Path) -> Path | None:
        """Put a backup in the store's place; events of the meantime are written to it. Raises StoreError.

        Whatever happens a store is open again afterwards: the restored one, or the one before.
        """
        with self._lock:
            store, self._store = self.opened(), None
            self._held = deque(maxlen=HELD)
        store.close()
        try:
            return backup.restore(self._folder, source)
        finally:
            self._open_again()

    def _open_again(self) -> None:
        """What happened meanwhile is written; what is interrupted is this machine's, not that of a backup."""
        late = self._unread
        try:
            store = self._open()
        except StoreError as error:
            self._trouble = str(error)
            rows = self._rows_of_other()
            for book in self._books:
                if isinstance(book, OffsetBook):
                    book.reopen(None, self._trouble, rows)
                else:
                    book.reopen(None, self._trouble)
            return
        with self._lock:
            held, self._held, self._store = self._held or (), None, store
            for event in held:
                self._write(store, event)
        self._trouble = ""
        self._post_noted()
        for book in self._books:
            book.reopen(store, "")
        if late:
            self._late = True
            self._tell_late()

    def when_late(self, tell: Callable[[], None]) -> None:
        """``tell`` is called, by another thread, once a store that was away at the start has been read.

        ``left`` and ``damage`` are known then. A store that is there already: at once.
        """
        self._tell_late = tell
        if self._late:
            tell()

    @property
    def waiting(self) -> bool:
        """Whether there is no store, for a reason that may pass, and it is tried again."""
        return self._store is None and self._opener is not None

    def _try_again(self) -> None:
        """A disk that was full at the start, or a file that was locked: some time it is not."""
        while not self._closing.wait(AGAIN):
            self._open_again()
            if self._store is not None:
                return

    def _post(self, write: Callable[[Store], object]) -> None:
        store = self._store
        if store is not None:
            write(store)

    def opened(self) -> Store:
        """The store of this moment: another after a restore. Raises StoreError while there is none."""
        store = self._store
        if store is None:
            raise StoreError(self._trouble or CLOSED)
        return store

    def close(self) -> str:
        """Write what is queued and give the store free; in words what could not be kept and is lost."""
        self._closing.set()
        if self._store is None:
            return self.held
        self._store.close()
        lost = self.held
        self._store = None
        return lost
