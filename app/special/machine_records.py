"""Event log, newest first, and changes of the machine file since it was last accepted."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Entry, Key, Row, Sheet, following
from app.desk.persistence import Persistence
from app.desk.status.alarm_log import read_back
from app.desk.status.formats import local_time
from app.desk.status.machine_file_changes import FileChanges
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import cause_of
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store_rows import EventRow

SHOWN = 500
EVERY = 1.0  # seconds between two updates of the open log
FILTERS: Mapping[str, frozenset[str]] = {
    "ALL": frozenset(),
    "ALARMS": frozenset({"alarm", "estop", "starved"}),
    "RUNS": frozenset({"load", "start", "end", "part", "uncounted", "stop"}),
    "OPERATOR": frozenset({"switch", "override", "refused", "force", "offsets", "change", "access"}),
}


class LoggedEvents(SpecialFunction):
    """Special function for the event log: F4 searches, F5 filters.

    All letters belong to an active search.
    """

    name = "EVENT LOG"
    use = "event history with times and a search function"

    def __init__(self, desk: Desk, persistence: Persistence, worker: Latest) -> None:
        super().__init__(desk)
        self.persistence, self.worker = persistence, worker
        self.entry = Entry(words=True)
        self.searching = False
        self.filter = "ALL"
        self.events: tuple[EventRow, ...] = ()
        self.trouble = ""
        self._rows: tuple[Row, ...] = ()
        self._next = 0.0

    @property
    def count(self) -> int:
        """Number of events found."""
        return len(self.events)

    def opened(self) -> None:
        """Search immediately when the log opens."""
        self._next = 0.0
        self.marked = 0

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of events, updated every second while the log is open."""
        now = self.desk.clock.seconds()
        if now >= self._next and not self.worker.busy:
            self._next = now + EVERY
            self.look()
        found = (
            Message("{count} EVENTS", count=self.count)
            if self.count < SHOWN
            else Message("THE LAST {value} EVENTS", value=SHOWN)
        )
        return Sheet(
            Message("EVENT LOG  ·  {filter}  ·  {value}", filter=self.filter, value=found),
            ("WHEN", "KIND", "DESCRIPTION", "LINE"),
            (0.25, 0.13, 0.54, 0.08),
            self._rows,
            self.marked,
            question="SEARCH FOR?" if self.searching or self.entry.text else "",
            text=self.entry.text,
            notes=(self.trouble,) if self.trouble else (),
            raw=frozenset({0}),
            figures=frozenset({3}),
        )

    def look(self) -> None:
        """Query the store.

        The result arrives in a later frame, and only the last of several queries counts.
        """
        search, kinds = self.entry.text.strip(), FILTERS[self.filter]
        self.worker.ask(
            lambda _: tuple(self.persistence.events(search, kinds, SHOWN)), self._found, self._failed
        )

    def _found(self, events: tuple[EventRow, ...]) -> None:
        self.trouble = ""
        if events != self.events:
            self.events = events
            self._rows = tuple(event_row(event) for event in events)
            self.marked = min(self.marked, max(0, len(events) - 1))

    def _failed(self, why: str) -> None:
        self.trouble = why

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for search and filter."""
        return {"F4": Key("SEARCH", self._search), "F5": Key("FILTER", self._filter)}

    def _search(self) -> None:
        self.searching = True
        self.desk.clear()

    def _filter(self) -> None:
        self.filter = following(FILTERS, self.filter)
        self.marked = 0
        self.look()

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the search text."""
        return self.searching and self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Handle a key: letters edit the search text, and arrows scroll the log."""
        if self.moves(key):
            return True
        if not self.searching:
            return False
        if key == "Enter":
            self.searching = False
        elif self.entry.type(key):
            self.marked = 0
        else:
            return False
        self.look()
        return True

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.searching:
            return "TYPE THE SEARCH TEXT   ENTER: ACCEPT   ESC: CLEAR"
        return "F4: SEARCH   F5: FILTER   PAGE UP/DOWN: SCROLL   ESC: BACK"

    def escape(self) -> bool:
        """Clear the search. Return False without a search."""
        open_before = self.searching or bool(self.entry.text)
        if open_before:
            self.searching, self.entry.text, self.marked = False, "", 0
            self.look()
        return open_before

    def left(self) -> None:
        """Clear the search when the function closes."""
        self.searching, self.entry.text = False, ""


def event_row(event: EventRow) -> Row:
    """Return the row of an event: time, kind, translated text and program line."""
    at = local_time(event.at)
    line = str(event.line) if event.line else ""
    alarm = event.kind == "alarm"
    stop = read_back(event)
    said = tr(event.text) if stop is None else f"{stop.number} {tr(stop.text)}: {tr(cause_of(stop))}"
    text = Message("{text} ({who})", text=said, who=event.who) if event.who else said
    return Row((at, event.kind, text, line), True if alarm else None, Tone.ALARM)


_OFF = frozenset({State.DISABLED, State.ESTOP, State.FAULT})


class MachineFileAcceptance(SpecialFunction):
    """Special function to accept the machine file: F2 accepts after confirmation and enables the drives."""

    name = "MACHINE FILE"
    use = "changes in the machine file since the file was last accepted"

    def __init__(self, desk: Desk, changes: FileChanges) -> None:
        super().__init__(desk)
        self.changes = changes

    @property
    def count(self) -> int:
        """Number of changed keys of the file."""
        return len(self.changes.changes)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table with one row per changed key: key, old value, new value."""
        rows = tuple(Row(tuple(change), None, Tone.WAIT) for change in self.changes.changes)
        note = (
            tr("Press F2 to accept; the drives stay off until then.")
            if rows
            else tr("No changes since the machine file was accepted.")
        )
        return Sheet(
            Message("MACHINE FILE  ·  {source}", source=self.changes.source),
            ("KEY", "WAS", "IS"),
            (0.44, 0.28, 0.28),
            rows,
            self.marked if rows else -1,
            notes=(note,),
            raw=frozenset({0, 1, 2}),
        )

    def keys(self) -> Mapping[str, Key]:
        """Return F2 if there are changes to accept."""
        return {"F2": Key("ACCEPT", self._accept)} if self.changes.changes else {}

    def _accept(self) -> None:
        if self.desk.refused(Act.MACHINE_FILE):
            return
        if self.desk.snapshot().state not in _OFF:
            self.desk.say(tr("TURN DRIVES OFF BEFORE ACCEPTING THE CHANGED MACHINE FILE"))
        else:
            question = tr("PRESS Y TO ACCEPT THE MACHINE FILE AS IT IS NOW, N TO CANCEL")
            self.desk.ask(question, self._accepted)

    def _accepted(self) -> None:
        self.changes.accept()
        self.marked = 0
        self.desk.done(tr("ACCEPTED: THE DRIVES CAN BE SWITCHED ON"))

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.changes.changes:
            return tr("ARROWS: SCROLL THE CHANGES   F2: ACCEPT ALL   ESC: BACK")
        return super().prompt()
