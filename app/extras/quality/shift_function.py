"""Shift report in the list of special functions (F10): results, selection of the shift, and saving."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.status.formats import duration
from app.desk.translation import tr
from app.extras.quality.shift_figures import SETTING, ShiftFigures, hours_of, shift_figures, shift_of
from app.extras.quality.shift_page import facts, shift_html, title_of
from app.production.parts_watch import PartsWatch
from app.programs.removable_media import Stick, sticks
from app.programs.whole_file import FileError, settle, write_out
from app.special.backup_and_restore import Place
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store import Store

_OLDEST = 366  # maximum number of shifts back


class ShiftReport(SpecialFunction):
    """Special function for the shift report, updated on a worker when it opens and every minute."""

    name = "SHIFT REPORT"
    use = "parts, times, stops and alarms, for printing"

    def __init__(self, desk: Desk, machine: str, worker: Latest, folder: Path) -> None:
        super().__init__(desk)
        self.machine, self.worker, self.folder = machine, worker, folder
        self.back = 0
        self.found: ShiftFigures | None = None
        self.trouble = ""
        self.places: tuple[Place, ...] = ()
        self._asked: tuple[int, int] | None = None  # shift and minute of the last request

    @property
    def count(self) -> int:
        """Number of places for saving, while they are listed."""
        return len(self.places)

    def _store(self) -> Store | None:
        watch = self.desk.pages.find(PartsWatch)
        return watch.book.store if watch is not None else None

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of the main results or of the places."""
        self._make()
        if self.places:
            return self._sheet_of_places()
        found = self.found
        if found is None:
            why = self.trouble or tr("Creating the report …")
            return Sheet("SHIFT REPORT", ("", ""), (0.4, 0.6), (), notes=(why,))
        rows = tuple(Row(each) for each in _rows(found))
        notes = (title_of(found, ""), *found.notes[:2])
        return Sheet("SHIFT REPORT", ("", ""), (0.36, 0.64), rows, notes=notes, raw=frozenset({0, 1}))

    def _sheet_of_places(self) -> Sheet:
        rows = tuple(Row((place.label, str(place.path))) for place in self.places)
        notes = ("Enter saves the report as HTML in the selected location.",)
        title, heads = "SHIFT REPORT  ·  SAVE TO:", ("PLACE", "FOLDER")
        return Sheet(title, heads, (0.35, 0.65), rows, self.marked, notes=notes, raw=frozenset({0, 1}))

    def _make(self) -> None:
        wanted = (self.back, int(datetime.now().timestamp() // 60))
        store = self._store()
        if store is None:
            self.trouble = tr("JOBS CANNOT BE SAVED: NO DATA STORE")
        elif wanted != self._asked:
            self._asked = wanted
            self.worker.queue(partial(_made, store, self.desk, self.back), self._take, self._failed)

    def _take(self, found: ShiftFigures) -> None:
        self.found, self.trouble = found, ""

    def _failed(self, why: str) -> None:
        self.found, self.trouble = None, why

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for the selection of a shift and for saving."""
        if self.places:
            return {"F4": Key("REFRESH", self.look)}
        return {
            "F2": Key("EARLIER", partial(self._go, 1)),
            "F3": Key("LATER", partial(self._go, -1)),
            "F6": Key("WRITE", self.look),
        }

    def _go(self, by: int) -> None:
        back = max(0, min(_OLDEST, self.back + by))
        if back == self.back:
            self.desk.done("THIS IS THE LATEST SHIFT" if by < 0 else "NO EARLIER SHIFT IS AVAILABLE")
        else:
            self.desk.clear()
            self.back, self.found = back, None

    def opened(self) -> None:
        """Show the present shift when the function opens."""
        self.back, self._asked, self.places = 0, None, ()

    def left(self) -> None:
        """Close the list of places when the function closes."""
        self.places = ()

    def escape(self) -> bool:
        """Close the list of places. Return False if it was not open."""
        shut, self.places = bool(self.places), ()
        return shut

    def look(self) -> None:
        """List the places for saving. The result arrives in a later frame."""
        self.desk.clear()
        if self.found is None:
            self.desk.say("REPORT IS NOT READY YET. WAIT A MOMENT")
        else:
            self.worker.queue(lambda: _places(self.folder, sticks()), self._places_found, self.desk.refuse)

    def _places_found(self, places: tuple[Place, ...]) -> None:
        self.places, self.marked = places, 0

    def act(self) -> bool:
        """Save the report to the selected place."""
        if not self.places or self.found is None:
            return False
        place = self.places[min(self.marked, len(self.places) - 1)]
        metric = self.desk.snapshot().modal.metric
        work = partial(_write, self.found, self.machine, place.path, metric=metric)
        self.worker.queue(work, self._done, self.desk.refuse)
        self.places = ()
        return True

    def _done(self, name: str) -> None:
        self.desk.done(tr(Message("{name} SAVED. IF YOU USED A USB STICK, YOU CAN REMOVE IT NOW", name=name)))

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.places:
            return "ENTER: SAVE REPORT HERE   F4: RESCAN FOR USB STICKS"
        return "F2, F3: OTHER SHIFT   F6: SAVE REPORT AS HTML   ESC: BACK"


def _rows(found: ShiftFigures) -> list[tuple[str, str]]:
    """Return the main results, then one row per program and per reason."""
    rows = facts(found)
    for each in found.programs:
        mean = f", {sum(each.times) / len(each.times):.1f} s" if each.times else ""
        rows.append((each.program, f"{each.parts} {tr('PARTS')}{mean}"))
    rows += [(tr(each.reason), f"{each.times} ×, {duration(each.seconds)}") for each in found.stood]
    return rows


def _made(store: Store, desk: Desk, back: int) -> ShiftFigures:
    """Calculate the results on the worker. Raises StoreError."""
    now = datetime.now().astimezone()
    watch = desk.pages.find(PartsWatch)
    assert watch is not None
    store.write(lambda _connection: None).exception()  # waits until all earlier changes are stored
    shift = shift_of(hours_of(store.settings.read_setting(SETTING)), now, back)
    return shift_figures(store, shift, now.timestamp(), watch.book.tools)


def _places(folder: Path, plugged: Sequence[Stick]) -> tuple[Place, ...]:
    return (*(Place(stick.label, stick.path) for stick in plugged), Place(tr("THIS CONTROL"), folder))


def _write(found: ShiftFigures, machine: str, folder: Path, *, metric: bool) -> str:
    """Write the report atomically on the worker and return its file name. Raises FileError."""
    made = datetime.now().strftime("%Y-%m-%d %H:%M")
    name = f"shift-{datetime.fromtimestamp(found.shift.start).strftime('%Y-%m-%d-%H%M')}.html"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=folder, cause=error.strerror)
        ) from error
    write_out(
        folder / name, shift_html(found, machine, made, metric=metric).encode("utf-8", "backslashreplace")
    )
    settle(folder)
    return name
