"""Journal of the operator screen.

The journal saves events, part counts and executed program versions in the store.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Collection, Mapping
from contextlib import closing
from pathlib import Path

from app.compose.control.unattended_notes import pop_interruption_note, pop_unconfirmed_events
from app.compose.runs.receipt import EventReceipt
from app.desk.data_folder import find_data_folder
from app.desk.persistence import NullRunRecords, Persistence
from app.offsets.offset_book import OffsetBook, OffsetRows, read_store_rows
from app.production.cycle_recorder import CycleRecorder
from app.production.parts_book import ProductionRecords
from app.programs.run_history import mark_interrupted_runs
from core.executor.snapshot import (
    InterruptedJob,
    LogEvent,
    Snapshot,
    convert_interrupted_job_to_json,
    parse_interrupted_job,
)
from core.language.source import ProgramSource
from core.message import Message
from core.store import backup, store_connection
from core.store.backup import BackupCheckResult, check_backup
from core.store.damaged_rows import TABLES_USED_BY_PROGRAMS
from core.store.production.run_records import RunRecords
from core.store.store import Store
from core.store.store_access import PendingEntries
from core.store.store_errors import StoreError
from core.store.store_file import STORE_FILE_NAME, has_store
from core.store.store_rows import (
    EventOrigin,
    EventRow,
    OffsetKind,
    ProgramVersionRow,
    ToolOffsetRow,
    get_utc_now_text,
)
from core.store.user_records import UserList

_log = logging.getLogger(__name__)
MAX_BUFFERED_EVENTS = 10_000  # events buffered while no store is open
INTERRUPTED_JOB_KEY = "under_way"  # key of the setting with the job that a power failure would interrupt
STORE_CLOSED_TEXT = "the data store is closed"
RETRY_INTERVAL_S = 5.0  # s between two attempts to open a store


def _do_nothing() -> None:
    """Do nothing. This function is the default callback for a store that opens late."""


class Journal(Persistence):
    """Connection of the operator screen to the store.

    A separate thread writes, so that callers do not wait.

    The machine also works if the store cannot be opened. Events are then buffered in memory. If the cause
    is temporary, such as a full disk, the store is opened as soon as possible.
    """

    def __init__(self, folder: Path, *, control_running: bool = False) -> None:
        """Open the store.

        ``control_running`` means that the control is still running, and therefore no job was interrupted.
        """
        self._folder, self._goes_on = folder, control_running
        self.who: Callable[[], str] = str  # returns the name of the user who is logged in
        self._lock = threading.Lock()  # locked briefly while the store or events are exchanged
        self._held: deque[tuple[LogEvent, EventReceipt | None]] | None = (
            None  # events buffered during a restore or without a store
        )
        self._books: list[OffsetBook | ProductionRecords] = []
        self._store: Store | None = None
        self._program = ""
        self._write_error = ""
        self._recorder = CycleRecorder()  # of a control in this process; a control process has its own
        self._noted: InterruptedJob | None = None  # job that a power failure would interrupt
        self._has_noted = False  # whether this control has noted a job since
        self._last_origin: EventOrigin | None = None  # of the last event that an earlier screen has stored
        self._unread = True  # whether the data of the last control has still to be read
        self._closing = threading.Event()
        # thread that opens a store that was unavailable at the start or after a restore
        self._opener: threading.Thread | None = None
        self.left: InterruptedJob | None = None  # job that the last control has left interrupted
        self.is_interruption_logged = True  # true unless the last control ran without a screen
        self.damage: tuple[str, ...] = ()  # messages about damaged data
        self._tell_late: Callable[[], None] = _do_nothing
        self._late = False  # whether the store was opened after the start
        try:
            self._store = self._open()
        except StoreError as error:
            self._write_error = str(error)
            self._held = deque(maxlen=MAX_BUFFERED_EVENTS)
            if error.is_temporary:
                self._start_opener()

    def _open(self) -> Store:
        """Open the store, and on the first call read the data that the last control has left there.

        Raises StoreError on failure. The store is then closed, because its lock would block later attempts.
        """
        store = Store.open(self._folder)
        try:
            if self._unread:
                self._read_interrupted(store)
        except StoreError:
            store.close()
            raise
        return store

    def _read_interrupted(self, store: Store) -> None:
        """Read damage reports, the interrupted job, and the records of program runs without an end time.

        Raises StoreError on failure.
        """
        self.damage = (*store.repair_messages, *store.find_damaged_rows())
        self._last_origin = store.runs.read_last_origin()
        left = None
        if not self._goes_on:
            mark_interrupted_runs(store.runs)
            left = self._take_interrupted(store)
        with self._lock:
            self._unread = False
            if not self._has_noted:
                self.left = self._noted = left

    def _take_interrupted(self, store: Store) -> InterruptedJob | None:
        """Store the events of a control that ran without a screen, and return its interrupted job."""
        program, events = pop_unconfirmed_events(self._folder)
        for row, origin, production_rows in events:
            if not self.has_stored_event(origin):
                part_of = Path(program).name if row.kind == "part" else ""
                store.runs.record_event(row, part_of, origin, production_rows)
        known, left = pop_interruption_note(self._folder)
        if not known:
            return parse_interrupted_job(store.settings.read_setting(INTERRUPTED_JOB_KEY))
        self.is_interruption_logged = False
        store.settings.save_setting(
            INTERRUPTED_JOB_KEY, None if left is None else convert_interrupted_job_to_json(left)
        )
        return left

    @classmethod
    def open_default(cls, *, control_running: bool = False) -> Journal:
        """Return the journal of the data folder."""
        return cls(find_data_folder(), control_running=control_running)

    @property
    def write_error(self) -> str:
        """Return why the store is not open or why its last write failed, or else an empty string."""
        return self._write_error or (self._store.write_error if self._store else "")

    @property
    def held(self) -> str:
        """Return a description of the entries that wait in memory, or an empty string if none wait."""
        store, held = self._store, self._held
        if store is not None:
            return store.pending_entries.description if store.pending_entries is not None else ""
        if not held:
            return ""
        parts = sum(event.kind == "part" for event, _ in tuple(held))
        return PendingEntries("", event_count=len(held), part_count=parts).description

    def note(self, job: InterruptedJob | None) -> None:
        """Save the running job, which a power failure would interrupt, or None if no job is running."""
        with self._lock:
            self._noted, self._has_noted = job, True
        self._post_noted()

    def _post_noted(self) -> None:
        value = convert_interrupted_job_to_json(self._noted) if self._noted is not None else None
        self._post(lambda store: store.settings.save_setting(INTERRUPTED_JOB_KEY, value))

    def book(self) -> OffsetBook:
        """Return the offset book, through which the screen displays and changes the stored offsets."""
        store = self._store
        book = OffsetBook(
            store, "" if store else Message("OFFSETS CANNOT BE SAVED: {problem}", problem=self.write_error)
        )
        rows = self._read_other_rows() if store is None else None
        if rows is not None:
            book.replace_rows(rows)
        book.has_read_failed = store is None and rows is None and has_store(self._folder)
        self._attach_book(book, store)
        return book

    def _read_other_rows(self) -> OffsetRows | None:
        """Return the offsets of a store that is open in another process, or None if they cannot be read."""
        if not has_store(self._folder):
            return None
        try:
            with Store.open(self._folder, read_only=True) as store:
                return None if store.find_damaged_rows(TABLES_USED_BY_PROGRAMS) else read_store_rows(store)
        except StoreError:
            return None

    def create_parts_book(self, tool_kind: OffsetKind = OffsetKind.TOOL) -> ProductionRecords:
        """Return the production records of the store: measured parts and tool lives.

        ``tool_kind`` is the tool table of this machine.
        """
        store = self._store
        book = ProductionRecords(store, "" if store else self.write_error, tool_kind)
        self._attach_book(book, store)
        return book

    def _attach_book(self, book: OffsetBook | ProductionRecords, store: Store | None) -> None:
        """Register a book, so that its store is replaced whenever the journal's store is replaced.

        The journal's store may also be replaced while the book is being created.
        """
        self._books.append(book)
        if self._store is not store:
            book.switch_store(self._store, self._write_error)

    def hear(self, event: LogEvent, receipt: EventReceipt | None = None) -> None:
        """Save an event. For a completed part, also increase the part count of its program.

        The receipt is confirmed when the event is on the disk. An event that waits in memory is confirmed
        together with the next event that is written to the disk.
        """
        with self._lock:
            if event.kind == "load":
                self._program = event.text
            if self._held is not None:
                self._held.append((event, receipt))
            elif self._store is not None:
                self._write(self._store, event, receipt)

    def has_stored_event(self, origin: EventOrigin) -> bool:
        """Return whether a previous screen process has already stored the event with this origin."""
        last = self._last_origin
        return last is not None and origin.control_id == last.control_id and origin.number <= last.number

    def resume_recording(self, snapshot: Snapshot) -> None:
        """Count the parts of the program of a control that ran without this process.

        Call this method before the control's events arrive.
        """
        with self._lock:
            self._program = snapshot.program

    def _write(self, store: Store, event: LogEvent, receipt: EventReceipt | None) -> None:
        if receipt is not None and self.has_stored_event(receipt.origin):  # the store was opened late
            receipt.confirm_storage()
            return
        row = EventRow(get_utc_now_text(), event.kind, event.text, event.line_number, event.record_name)
        part_of = Path(self._program).name if event.kind == "part" and self._program else ""
        if receipt is None:
            store.runs.record_event(row, part_of, production_rows=self._recorder.hear(event))
            return
        stored = store.runs.record_event(row, part_of, receipt.origin, receipt.production_rows)
        stored.add_done_callback(lambda done: receipt.confirm_storage() if done.exception() is None else None)

    def keep(self, source: ProgramSource) -> None:
        """Save the program text that will be proved and run, as a version of its program."""
        if self._store is not None:
            name = Path(source.name).name
            self._store.programs.save_loaded_version(
                name, source.text.encode("utf-8", "surrogateescape"), "loaded to run"
            )

    def versions(self, name: str) -> tuple[ProgramVersionRow, ...]:
        """Return all versions of a program, newest first. Raises StoreError if they cannot be read.

        Do not call this method in the screen's thread.
        """
        return self.require_store().programs.list_versions(name)

    def read_version_text(self, name: str, version: int) -> bytes:
        """Return the text of a saved version.

        Raises StoreError if it cannot be read. Do not call this method in the screen's thread.
        """
        return self.require_store().programs.load_version(name, version)

    def save_version(self, name: str, text: bytes, reason: str) -> int:
        """Save a version, wait until it is on the disk, and return its number.

        Raises StoreError if saving fails. Do not call this method in the screen's thread.
        """
        return self.require_store().programs.save_version(name, text, reason, author=self.who()).result()

    def read_setting(self, key: str) -> object:
        """Return a setting, or None if the setting does not exist or no store is open."""
        store = self._store
        return store.settings.read_setting(key) if store else None

    def save_setting(self, key: str, value: object) -> None:
        """Save a setting without waiting for the disk."""
        self._post(lambda store: store.settings.save_setting(key, value))

    def save_settings(self, values: Mapping[str, object]) -> None:
        """Save settings and wait until they are on the disk.

        Raises StoreError if saving fails. Do not call this method in the screen's thread.
        """
        store = self.require_store()
        for written in [store.settings.save_setting(key, value) for key, value in values.items()]:
            written.result()

    def log_change(self, text: str, user_name: str = "") -> None:
        """Log a data change under the name of the user, if a user is signed in."""
        now = self.who()
        if now:
            self._post(lambda store: store.events.log_event("change", text, author=user_name or now))

    def log_access(self, text: str, user_name: str) -> None:
        """Log an access event. Without a store, the event is written to the error log."""
        if self._store is None:
            _log.warning("access: %s (%s)", text, user_name)
        self._post(lambda store: store.events.log_event("access", text, author=user_name))

    @property
    def runs(self) -> RunRecords | NullRunRecords:
        """Return the run records of the open store, or an empty substitute if no store is open."""
        store = self._store
        return store.runs if store is not None else NullRunRecords(self._write_error or STORE_CLOSED_TEXT)

    def people(self) -> UserList:
        """Return the users, even while another process has the store open for writing.

        Raises StoreError if the users cannot be read.
        """
        store = self._store
        if store is not None:
            return store.people.read_users()
        with Store.open(self._folder, read_only=True) as other:
            return other.people.read_users()

    def events(self, search: str, kinds: Collection[str], limit: int) -> tuple[EventRow, ...]:
        """Return the latest events, with the newest event first.

        The result has at most ``limit`` events. Raises StoreError if no store is open or it cannot be read.
        """
        return self.require_store().events.read_events(search, limit, kinds)

    def read_last_run_tools(self, program: str) -> tuple[str, dict[int, ToolOffsetRow]]:
        """Return the UTC start time of the program's last run, and the tool offsets at that time.

        The result is empty if the program has not run. Raises StoreError if the store cannot be read. Call
        this method in a worker thread.
        """
        store = self.require_store()
        started = next((row.started for row in store.runs.read_run_records() if row.program == program), None)
        return (
            (started, store.offsets.tool_offsets.read_rows_at(started)) if started is not None else ("", {})
        )

    def rename_program(self, old_name: str, new_name: str) -> None:
        """Rename a program with its versions, counts and records.

        The method waits until the change is on the disk.
        """
        store = self._store
        if store is not None:
            store.programs.rename_program(old_name, new_name).result()

    def backup(self, target: Path) -> None:
        """Copy the store to ``target``, even while it is being written. Raises StoreError on failure."""
        self.require_store()
        backup.back_up_store(self._folder, target)

    def check_backup(self, source: Path) -> BackupCheckResult:
        """Check a backup against the store, and return the result.

        The result also reports a damaged or unreadable backup. Raises StoreError if no store is open or it
        cannot be read.
        """
        self.require_store()
        with closing(
            store_connection.connect_store(self._folder / STORE_FILE_NAME, is_read_only=True)
        ) as now:
            return check_backup(now, source)

    def restore(self, source: Path) -> Path | None:
        """Replace the store with a backup, and add the events that occurred during the restore.

        Raises StoreError if no store is open, which changes nothing, or if the restore fails. The store is
        opened again after a successful or a failed restore. If it cannot be opened, ``write_error``
        contains the reason. After a temporary error, the journal retries.
        """
        with self._lock:
            store, self._store = self.require_store(), None
            self._held = deque(maxlen=MAX_BUFFERED_EVENTS)
        store.close()
        try:
            return backup.restore_store(self._folder, source)
        finally:
            self._reopen()

    def _reopen(self) -> None:
        """Reopen the store and write the buffered events, or retry later after a temporary error.

        The interrupted job of this machine is retained. The interrupted job of a backup is ignored.
        """
        late = self._unread
        try:
            store = self._open()
        except StoreError as error:
            self._write_error = str(error)
            rows = self._read_other_rows()
            for book in self._books:
                if isinstance(book, OffsetBook):
                    book.switch_store(None, self._write_error, rows)
                else:
                    book.switch_store(None, self._write_error)
            if error.is_temporary:
                self._start_opener()
            return
        with self._lock:
            held, self._held, self._store = self._held or (), None, store
            for event, receipt in held:
                self._write(store, event, receipt)
        self._write_error = ""
        self._post_noted()
        for book in self._books:
            book.switch_store(store, "")
        if late:
            self._late = True
            self._tell_late()

    def set_late_open_callback(self, callback: Callable[[], None]) -> None:
        """Set the function to call when a store that was unavailable at startup has been read.

        The function is called in a different thread, or immediately if the late store was already read.
        ``left`` and ``damage`` are known when the function is called.
        """
        self._tell_late = callback
        if self._late:
            callback()

    @property
    def waiting(self) -> bool:
        """Return whether a temporary error prevented opening the store, so that the journal will retry."""
        return self._store is None and self._is_retrying()

    def _is_retrying(self) -> bool:
        return self._opener is not None and self._opener.is_alive()

    def _start_opener(self) -> None:
        """Start the thread that retries opening the store, unless it is already running."""
        if not self._is_retrying():
            self._opener = threading.Thread(target=self._retry_open, name="store-opener", daemon=True)
            self._opener.start()

    def _retry_open(self) -> None:
        """Retry opening the store until it succeeds, for example after disk space has been freed."""
        while not self._closing.wait(RETRY_INTERVAL_S):
            self._reopen()
            if self._store is not None:
                return

    def _post(self, write: Callable[[Store], object]) -> None:
        store = self._store
        if store is not None:
            write(store)

    def require_store(self) -> Store:
        """Return the open store. After a restore, this is a different object than before.

        Raises StoreError if no store is open.
        """
        store = self._store
        if store is None:
            raise StoreError(self._write_error or STORE_CLOSED_TEXT)
        return store

    def close(self) -> str:
        """Write the queued entries, close the store, and return a description of the lost entries."""
        self._closing.set()
        if self._store is None:
            return self.held
        self._store.close()
        lost = self.held
        self._store = None
        return lost
