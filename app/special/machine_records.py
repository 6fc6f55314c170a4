"""Special functions for the event log and for accepting changes to the machine file."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow, following
from app.desk.persistence import Persistence
from app.desk.status.alarm_log import parse_alarm
from app.desk.status.formats import format_local_time
from app.desk.status.machine_file_changes import MachineFileChanges
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import translate_cause
from app.desk.translation import mark_untranslated, tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message, join_messages
from core.store.store_rows import EventRow

MAX_EVENTS = 500
RELOAD_INTERVAL_S = 1.0  # seconds between two updates of the open log
EVENT_FILTERS: Mapping[str, frozenset[str]] = {
    "ALL": frozenset(),
    "ALARMS": frozenset({"alarm", "estop", "starved", "notice"}),
    "RUNS": frozenset({"load", "start", "end", "part", "uncounted", "stop"}),
    "OPERATOR": frozenset({"switch", "override", "refused", "force", "offsets", "change", "access"}),
}


class EventLogFunction(SpecialFunction):
    """Special function for the event log, with the newest event first.

    F5 filters the events. The search also finds events that are too old for the list.
    """

    name = "EVENT LOG"
    use = "event history with times and a search function"

    def __init__(self, desk: Desk, persistence: Persistence, worker: LatestRequestWorker) -> None:
        super().__init__(desk)
        self.persistence, self.worker = persistence, worker
        self.search_text = ""
        self.filter_name = "ALL"
        self.found_events: tuple[EventRow, ...] = ()
        self.error_text = ""
        self._rows: tuple[TableRow, ...] = ()
        self._next = 0.0

    @property
    def row_count(self) -> int:
        """Return the number of events that match the search."""
        return len(self.found_events)

    def on_open(self) -> None:
        """Select the first row and query the events immediately."""
        self._next = 0.0
        self.marked = 0

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of events, which is updated every second while the log is open."""
        now = self.desk.clock.read_seconds()
        if now >= self._next and not self.worker.is_busy:
            self._next = now + RELOAD_INTERVAL_S
            self.query_events()
        found = (
            Message("{count} EVENTS", count=self.row_count)
            if self.row_count < MAX_EVENTS
            else Message("THE LAST {value} EVENTS", value=MAX_EVENTS)
        )
        title = Message("EVENT LOG  ·  {filter}  ·  {value}", filter=self.filter_name, value=found)
        return TableContent(
            join_messages("  ·  ", filter(None, (title, mark_untranslated(self.search_text)))),
            ("WHEN", "KIND", "DESCRIPTION", "LINE"),
            (0.25, 0.13, 0.54, 0.08),
            self._rows,
            self.marked,
            notes=(self.error_text,) if self.error_text else (),
            untranslated_columns=frozenset({0}),
            numeric_columns=frozenset({3}),
        )

    def query_events(self) -> None:
        """Query the store for the events that match the search text and the filter.

        The result arrives in a later frame. Only the result of the latest query is used.
        """
        search, kinds = self.search_text, EVENT_FILTERS[self.filter_name]
        self.worker.request_work(
            lambda _: tuple(self.persistence.events(search, kinds, MAX_EVENTS)), self._found, self._failed
        )

    def _found(self, events: tuple[EventRow, ...]) -> None:
        self.error_text = ""
        if events != self.found_events:
            self.found_events = events
            self._rows = tuple(make_event_row(event) for event in events)
            self.marked = min(self.marked, max(0, len(events) - 1))

    def _failed(self, why: str) -> None:
        self.error_text = why

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key for the filter."""
        return {"F5": FunctionKey("FILTER", self._filter)}

    def _filter(self) -> None:
        self.filter_name = following(EVENT_FILTERS, self.filter_name)
        self.marked = 0
        self.query_events()

    def find_row_search(self) -> Callable[[str], None]:
        """Return the function that searches all stored events."""
        return self.search_events

    def search_events(self, text: str) -> None:
        """List only the events that contain a text, or all events if the text is empty."""
        self.search_text = text
        self.query_events()

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.search_text:
            return tr("CTRL+F: SEARCH   F5: FILTER   ESC: SHOW ALL EVENTS")
        return tr("CTRL+F: SEARCH   F5: FILTER   PAGE UP/DOWN: SCROLL   ESC: BACK")

    def handle_escape(self) -> bool:
        """Show all events, or return False if no search limits the list."""
        was_limited = bool(self.search_text)
        if was_limited:
            self.search_events("")
        return was_limited

    def on_close(self) -> None:
        """Clear the search when the function closes."""
        self.search_text = ""


def make_event_row(event: EventRow) -> TableRow:
    """Return the table row of an event, with time, kind, translated text and program line."""
    at = format_local_time(event.at)
    line = str(event.line) if event.line else ""
    alarm = event.kind == "alarm"
    stop = parse_alarm(event)
    said = tr(event.text) if stop is None else f"{stop.number} {tr(stop.text)}: {tr(translate_cause(stop))}"
    text = Message("{text} ({who})", text=said, who=event.who) if event.who else said
    return TableRow((at, event.kind, text, line), True if alarm else None, StatusTone.ALARM)


_OFF_STATES = frozenset({MachineState.DISABLED, MachineState.ESTOP, MachineState.FAULT})


class MachineFileFunction(SpecialFunction):
    """Special function with which the operator accepts a changed machine file.

    F2 accepts the changes after the operator confirms, and enables the drives.
    """

    name = "MACHINE FILE"
    use = "changes in the machine file since the file was last accepted"

    def __init__(self, desk: Desk, changes: MachineFileChanges) -> None:
        super().__init__(desk)
        self.changes = changes

    @property
    def row_count(self) -> int:
        """Return the number of machine file entries that have changed."""
        return len(self.changes.changes)

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of changed machine file entries, with name, old value and new value."""
        rows = tuple(TableRow(tuple(change), None, StatusTone.WAIT) for change in self.changes.changes)
        note = (
            tr("Press F2 to accept; the drives stay off until then.")
            if rows
            else tr("No changes since the machine file was accepted.")
        )
        return TableContent(
            Message("MACHINE FILE  ·  {source}", source=self.changes.file_path),
            ("KEY", "WAS", "IS"),
            (0.44, 0.28, 0.28),
            rows,
            self.marked if rows else -1,
            notes=(note,),
            untranslated_columns=frozenset({0, 1, 2}),
        )

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key F2 if there are changes to accept."""
        return {"F2": FunctionKey("ACCEPT", self._accept)} if self.changes.changes else {}

    def _accept(self) -> None:
        if self.desk.is_refused(ProtectedChange.MACHINE_FILE):
            return
        if self.desk.read_snapshot().state not in _OFF_STATES:
            self.desk.say(tr("TURN DRIVES OFF BEFORE ACCEPTING THE CHANGED MACHINE FILE"))
        else:
            question = tr("PRESS Y TO ACCEPT THE MACHINE FILE AS IT IS NOW, N TO CANCEL")
            self.desk.ask_operator(question, self._accepted)

    def _accepted(self) -> None:
        self.changes.accept_changes()
        self.marked = 0
        self.desk.show_success(tr("ACCEPTED: THE DRIVES CAN BE SWITCHED ON"))

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.changes.changes:
            return tr("ARROWS: SCROLL THE CHANGES   F2: ACCEPT ALL   ESC: BACK")
        return super().prompt_text()
