"""Journal of the operator screen: events, part counts and executed program versions, saved in the store."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Collection, Mapping
from contextlib import closing
from pathlib import Path

from app.compose.control.left_note import take_events, take_note
from app.compose.runs.receipt import Receipt
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
from core.store.store_rows import EventOrigin, EventRow, Kind, ToolRow, VersionRow, utc_now

_log = logging.getLogger(__name__)
HELD = 10_000  # events buffered while no store is open
UNDER_WAY = "under_way"  # key of the setting with the job that a power failure would interrupt
CLOSED = "the data store is closed"
AGAIN = 5.0  # s between two attempts to open a store


def _nobody() -> None:
    """Do nothing, because no function waits for a store that opens late."""


class Journal(Persistence):
    """Access of the operator screen to the store; writes use the store's thread, so no caller waits.

    The machine also works if the store cannot be opened. Events are then buffered in memory. If the reason is
    temporary, such as a full disk, the store is opened as soon as possible.
    """

    def __init__(self, folder: Path, *, goes_on: bool = False) -> None:
        """Open the store. ``goes_on`` means that the control is still running, so no job was interrupted."""
        self._folder, self._goes_on = folder, goes_on
        self.who: Callable[[], str] = str  # returns the name of the user who is logged in
        self._lock = threading.Lock()  # locked briefly while the store or events are exchanged
        self._held: deque[tuple[Event, Receipt | None]] | None = (
            None  # events buffered during a restore or without a store
        )
        self._books: list[OffsetBook | PartsBook] = []
        self._store: Store | None = None
        self._program = ""
        self._trouble = ""
        self._recorder = CycleRecorder()
        self._noted: InterruptedJob | None = None  # job that a power failure would interrupt
        self._has_noted = False  # whether this control has noted a job since
        self._last_origin: EventOrigin | None = None  # of the last event that an earlier screen has stored
        self._unread = True  # whether the data of the last control has still to be read
        self._closing = threading.Event()
        # thread that opens a store that was unavailable at the start
        self._opener: threading.Thread | None = None
        self.left: InterruptedJob | None = None  # job that the last control has left interrupted
        self.left_is_logged = True  # true unless the last control ran without a screen
        self.damage: tuple[str, ...] = ()  # messages about damaged data
        self._tell_late: Callable[[], None] = _nobody
        self._late = False  # whether the store was opened after the start
        try:
            self._store = self._open()
        except StoreError as error:
            self._trouble = str(error)
            self._held = deque(maxlen=HELD)
            if error.passing:
                self._opener = threading.Thread(target=self._try_again, name="store-opener", daemon=True)
                self._opener.start()

    def _open(self) -> Store:
        """Open the store and read, once, the data that the last control has left.

        Raises StoreError and then releases the store, because its lock would prevent later attempts.
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
        """Read damage, runs without an end and the interrupted job. Raises StoreError."""
        self.damage = (*store.repaired, *store.find_damaged_rows())
        self._last_origin = store.runs.read_last_origin()
        left = None
        if not self._goes_on:
            note_cut_off_runs(store.runs)
            left = self._what_was_left(store)
        with self._lock:
            self._unread = False
            if not self._has_noted:
                self.left = self._noted = left

    def _what_was_left(self, store: Store) -> InterruptedJob | None:
        """Store the events of a control without a screen; return its interrupted job."""
        program, rows, origins = take_events(self._folder)
        for row, origin in zip(rows, origins, strict=True):
            if not self.has_stored(origin):
                store.runs.record_event(row, Path(program).name if row.kind == "part" else "", origin)
        known, left = take_note(self._folder)
        if not known:
            return of_plain(store.settings.read_setting(UNDER_WAY))
        self.left_is_logged = False
        store.settings.save_setting(UNDER_WAY, None if left is None else plain(left))
        return left

    @classmethod
    def at_home(cls, *, goes_on: bool = False) -> Journal:
        """Return the journal of the data folder."""
        return cls(data_folder(), goes_on=goes_on)

    @property
    def trouble(self) -> str:
        """Reason why nothing is saved or why the last write failed; empty if the last write succeeded."""
        return self._trouble or (self._store.trouble if self._store else "")

    @property
    def held(self) -> str:
        """Description of the entries that wait in memory; empty if there are none."""
        store, held = self._store, self._held
        if store is not None:
            return store.backlog.words if store.backlog is not None else ""
        if not held:
            return ""
        parts = sum(event.kind == "part" for event, _ in tuple(held))
        return Backlog("", events=len(held), parts=parts).words

    def note(self, what: InterruptedJob | None) -> None:
        """Save the job that a power failure would interrupt now, or None."""
        with self._lock:
            self._noted, self._has_noted = what, True
        self._post_noted()

    def _post_noted(self) -> None:
        value = plain(self._noted) if self._noted is not None else None
        self._post(lambda store: store.settings.save_setting(UNDER_WAY, value))

    def book(self) -> OffsetBook:
        """Return the offsets of the store for the screen to show and change."""
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
        """Return measured parts and tool lives of the store; ``tools`` is the tool table of this machine."""
        store = self._store
        book = PartsBook(store, "" if store else self.trouble, tools)
        self._know(book, store)
        return book

    def _know(self, book: OffsetBook | PartsBook, store: Store | None) -> None:
        """Register a book that must follow changes of the store, including one during its creation."""
        self._books.append(book)
        if self._store is not store:
            book.reopen(self._store, self._trouble)

    def hear(self, event: Event, receipt: Receipt | None = None) -> None:
        """Save an event; a finished part is counted for its program.

        The receipt is confirmed when the event is on the disk. An event that waits in memory is confirmed
        together with the next event that the disk accepts.
        """
        with self._lock:
            if event.kind == "load":
                self._program = event.text
            if self._held is not None:
                self._held.append((event, receipt))
            elif self._store is not None:
                self._write(self._store, event, receipt)

    def has_stored(self, origin: EventOrigin) -> bool:
        """Return whether an earlier screen has stored the event with this origin."""
        last = self._last_origin
        return last is not None and origin.control == last.control and origin.number <= last.number

    def go_on(self, snapshot: Snapshot) -> None:
        """Continue with a control that ran without this process, before its events are received."""
        with self._lock:
            self._program = snapshot.program
            if snapshot.state in CYCLE and self._store is not None:
                self._recorder.go_on(snapshot.program, snapshot.t, self._store.cycles)

    def _write(self, store: Store, event: Event, receipt: Receipt | None) -> None:
        if receipt is not None and self.has_stored(receipt.origin):  # the store was opened late
            receipt.confirm()
            return
        self._recorder.hear(event, store.cycles)
        row = EventRow(utc_now(), event.kind, event.text, event.line, event.record)
        part_of = Path(self._program).name if event.kind == "part" and self._program else ""
        if receipt is None:
            store.runs.record_event(row, part_of)
            return
        stored = store.runs.record_event(row, part_of, receipt.origin)
        stored.add_done_callback(lambda done: receipt.confirm() if done.exception() is None else None)

    def keep(self, source: Source) -> None:
        """Save the text that is about to be proved and run as a version of its program."""
        if self._store is not None:
            name = Path(source.name).name
            self._store.programs.keep_loaded_version(
                name, source.text.encode("utf-8", "surrogateescape"), "loaded to run"
            )

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        """Return every version of a program, newest first.

        Raises StoreError. Do not call in the screen's thread.
        """
        return self.opened().programs.list_versions(name)

    def text_of(self, name: str, version: int) -> bytes:
        """Return the text of a saved version. Raises StoreError. Do not call it in the screen's thread."""
        return self.opened().programs.load_version(name, version)

    def save_version(self, name: str, text: bytes, why: str) -> int:
        """Save a version and return its number when it is on the disk.

        Raises StoreError. Do not call it in the screen's thread.
        """
        return self.opened().programs.save_version(name, text, why, who=self.who()).result()

    def read_setting(self, key: str) -> object:
        """Return a setting; None if it is not set or no store is open."""
        store = self._store
        return store.settings.read_setting(key) if store else None

    def save_setting(self, key: str, value: object) -> None:
        """Save a setting without waiting."""
        self._post(lambda store: store.settings.save_setting(key, value))

    def keep_settings(self, values: Mapping[str, object]) -> None:
        """Save settings and wait until they are on the disk.

        Raises StoreError. Do not call it in the screen's thread.
        """
        store = self.opened()
        for written in [store.settings.save_setting(key, value) for key, value in values.items()]:
            written.result()

    def note_change(self, text: str, who: str = "") -> None:
        """Log a change, if users log in."""
        now = self.who()
        if now:
            self._post(lambda store: store.events.log_event("change", text, who=who or now))

    def note_access(self, text: str, who: str) -> None:
        """Log an access event; without a store it goes to the error log."""
        if self._store is None:
            _log.warning("access: %s (%s)", text, who)
        self._post(lambda store: store.events.log_event("access", text, who=who))

    @property
    def runs(self) -> RunRecords | NoRunRecords:
        """Run records of the open store."""
        store = self._store
        return store.runs if store is not None else NoRunRecords(self._trouble or CLOSED)

    def people(self) -> People:
        """Return the users, also from a store that another process writes. Raises StoreError."""
        store = self._store
        if store is not None:
            return store.people.read_people()
        with Store.open(self._folder, read_only=True) as other:
            return other.people.read_people()

    def events(self, search: str, kinds: Collection[str], limit: int) -> tuple[EventRow, ...]:
        """Return the latest events, newest first. Raises StoreError without a store."""
        return self.opened().events.read_events(search, limit, kinds)

    def tools_of_last_run(self, program: str) -> tuple[str, dict[int, ToolRow]]:
        """Return the start time of the program's last run (UTC), and its tools at that time.

        Raises StoreError. Call it in a worker thread.
        """
        store = self.opened()
        started = next((row.started for row in store.runs.read_records() if row.program == program), None)
        return (started, store.offsets.tools.read_rows_at(started)) if started is not None else ("", {})

    def renamed(self, old: str, new: str) -> None:
        """Rename a program with its versions, counts and records; return when this is on the disk."""
        store = self._store
        if store is not None:
            store.programs.rename_program(old, new).result()

    def backup(self, target: Path) -> None:
        """Copy the store to ``target``, even while it is being written. Raises StoreError."""
        self.opened()
        backup.backup(self._folder, target)

    def judge(self, source: Path) -> Verdict:
        """Check a backup and compare it with the store. Raises StoreError."""
        self.opened()
        with closing(store_connection.connect(self._folder / FILE_NAME, read_only=True)) as now:
            return verdict(now, source)

    def restore(self, source: Path) -> Path | None:
        """Replace the store by a backup; write the events of the meantime to it. Raises StoreError.

        Afterwards a store is open in any case: the restored store, or the old one.
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
        """Reopen the store and write the buffered events.

        The interrupted job remains that of this machine and not that of a backup.
        """
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
            for event, receipt in held:
                self._write(store, event, receipt)
        self._trouble = ""
        self._post_noted()
        for book in self._books:
            book.reopen(store, "")
        if late:
            self._late = True
            self._tell_late()

    def when_late(self, tell: Callable[[], None]) -> None:
        """Set the function that is called when a store that was unavailable at the start has been read.

        The function runs in another thread, or immediately if the store has already been read late. ``left``
        and ``damage`` are then known.
        """
        self._tell_late = tell
        if self._late:
            tell()

    @property
    def waiting(self) -> bool:
        """Whether the store could not be opened for a temporary reason, so that opening is tried again."""
        return self._store is None and self._opener is not None

    def _try_again(self) -> None:
        """Try to open the store again until it is open, for example when the disk has space again."""
        while not self._closing.wait(AGAIN):
            self._open_again()
            if self._store is not None:
                return

    def _post(self, write: Callable[[Store], object]) -> None:
        store = self._store
        if store is not None:
            write(store)

    def opened(self) -> Store:
        """Return the store that is open now, which changes after a restore.

        Raises StoreError if no store is open.
        """
        store = self._store
        if store is None:
            raise StoreError(self._trouble or CLOSED)
        return store

    def close(self) -> str:
        """Write the queued entries and close the store; return a description of the lost entries."""
        self._closing.set()
        if self._store is None:
            return self.held
        self._store.close()
        lost = self.held
        self._store = None
        return lost
