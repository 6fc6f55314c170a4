"""Shift report in the list of special functions (F10).

The operator selects a shift, sees its results and saves the report.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.status.formats import format_duration
from app.desk.translation import tr
from app.extras.quality.shift_page import make_shift_html, make_summary_rows, make_title
from app.extras.quality.shift_results import (
    SHIFT_HOURS_SETTING,
    ShiftResults,
    calculate_shift_results,
    find_shift,
    get_shift_hours,
)
from app.production.parts_watch import ProductionMonitor
from app.programs.atomic_files import FileOperationError, copy_to_medium, flush_folder
from app.programs.removable_media import UsbStick, list_usb_sticks
from app.special.backup_and_restore import BackupLocation
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store import Store

_OLDEST = 366  # maximum number of shifts back


class ShiftReportFunction(SpecialFunction):
    """Special function for the shift report.

    A worker calculates the report when the function opens, and then once per minute.
    """

    name = "SHIFT REPORT"
    use = "parts, times, stops and alarms, for printing"

    def __init__(self, desk: Desk, machine_name: str, worker: LatestRequestWorker, csv_folder: Path) -> None:
        super().__init__(desk)
        self.machine_name, self.worker, self.report_folder = machine_name, worker, csv_folder
        self.shifts_back = 0
        self.results: ShiftResults | None = None
        self.error_text = ""
        self.save_locations: tuple[BackupLocation, ...] = ()
        self._asked: tuple[int, int] | None = None  # shift and minute of the last request

    @property
    def row_count(self) -> int:
        """Return the number of listed save locations, or 0 while the results are shown."""
        return len(self.save_locations)

    def _store(self) -> Store | None:
        watch = self.desk.page_registry.find_model(ProductionMonitor)
        return watch.production_records.store if watch is not None else None

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of the main results, or the list of save locations while that list is open."""
        self._make()
        if self.save_locations:
            return self._sheet_of_places()
        found = self.results
        if found is None:
            why = self.error_text or tr("Creating the report …")
            return TableContent("SHIFT REPORT", ("", ""), (0.4, 0.6), (), notes=(why,))
        rows = tuple(TableRow(each) for each in _rows(found))
        notes = (make_title(found, ""), *found.notes[:2])
        return TableContent(
            "SHIFT REPORT", ("", ""), (0.36, 0.64), rows, notes=notes, untranslated_columns=frozenset({0, 1})
        )

    def _sheet_of_places(self) -> TableContent:
        rows = tuple(TableRow((place.label, str(place.path))) for place in self.save_locations)
        notes = ("Enter saves the report as HTML in the selected location.",)
        title, heads = "SHIFT REPORT  ·  SAVE TO:", ("PLACE", "FOLDER")
        return TableContent(
            title, heads, (0.35, 0.65), rows, self.marked, notes=notes, untranslated_columns=frozenset({0, 1})
        )

    def _make(self) -> None:
        wanted = (self.shifts_back, int(datetime.now().timestamp() // 60))
        store = self._store()
        if store is None:
            self.error_text = tr("JOBS CANNOT BE SAVED: NO DATA STORE")
        elif wanted != self._asked:
            self._asked = wanted
            self.worker.enqueue_work(
                partial(_calculate, store, self.desk, self.shifts_back), self._take, self._failed
            )

    def _take(self, found: ShiftResults) -> None:
        self.results, self.error_text = found, ""

    def _failed(self, why: str) -> None:
        self.results, self.error_text = None, why

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that select a shift and save the report."""
        if self.save_locations:
            return {"F4": FunctionKey("REFRESH", self.reload_locations)}
        return {
            "F2": FunctionKey("EARLIER", partial(self._go, 1)),
            "F3": FunctionKey("LATER", partial(self._go, -1)),
            "F6": FunctionKey("WRITE", self.reload_locations),
        }

    def _go(self, by: int) -> None:
        back = max(0, min(_OLDEST, self.shifts_back + by))
        if back == self.shifts_back:
            self.desk.show_success("THIS IS THE LATEST SHIFT" if by < 0 else "NO EARLIER SHIFT IS AVAILABLE")
        else:
            self.desk.clear_prompt_line()
            self.shifts_back, self.results = back, None

    def on_open(self) -> None:
        """Show the current shift when the function opens."""
        self.shifts_back, self._asked, self.save_locations = 0, None, ()

    def on_close(self) -> None:
        """Close the list of save locations when the function closes."""
        self.save_locations = ()

    def handle_escape(self) -> bool:
        """Close the list of save locations, and return whether the list was open."""
        shut, self.save_locations = bool(self.save_locations), ()
        return shut

    def reload_locations(self) -> None:
        """Start listing the locations to which the report can be saved.

        The list appears in a later frame.
        """
        self.desk.clear_prompt_line()
        if self.results is None:
            self.desk.say("REPORT IS NOT READY YET. WAIT A MOMENT")
        else:
            self.worker.enqueue_work(
                lambda: _places(self.report_folder, list_usb_sticks()),
                self._places_found,
                self.desk.show_refusal,
            )

    def _places_found(self, places: tuple[BackupLocation, ...]) -> None:
        self.save_locations, self.marked = places, 0

    def activate_selected_row(self) -> bool:
        """Save the report to the selected location, and return whether a location was selected."""
        if not self.save_locations or self.results is None:
            return False
        place = self.save_locations[min(self.marked, len(self.save_locations) - 1)]
        metric = self.desk.read_snapshot().modal.metric
        work = partial(_write, self.results, self.machine_name, place.path, metric=metric)
        self.worker.enqueue_work(work, self._done, self.desk.show_refusal)
        self.save_locations = ()
        return True

    def _done(self, name: str) -> None:
        self.desk.show_success(
            tr(Message("{name} SAVED. IF YOU USED A USB STICK, YOU CAN REMOVE IT NOW", name=name))
        )

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.save_locations:
            return "ENTER: SAVE REPORT HERE   F4: RESCAN FOR USB STICKS"
        return "F2, F3: OTHER SHIFT   F6: SAVE REPORT AS HTML   ESC: BACK"


def _rows(results: ShiftResults) -> list[tuple[str, str]]:
    """Return the rows of the main results, followed by one row for each program and each stop reason."""
    rows = make_summary_rows(results)
    for each in results.program_results:
        mean = f", {sum(each.cycle_times_s) / len(each.cycle_times_s):.1f} s" if each.cycle_times_s else ""
        rows.append((each.program_name, f"{each.part_count} {tr('PARTS')}{mean}"))
    rows += [
        (tr(each.reason), f"{each.times} ×, {format_duration(each.seconds)}") for each in results.stop_reasons
    ]
    return rows


def _calculate(store: Store, desk: Desk, back: int) -> ShiftResults:
    """Calculate the results of a shift on the worker.

    Raises StoreError if the data cannot be read.
    """
    now = datetime.now().astimezone()
    watch = desk.page_registry.find_model(ProductionMonitor)
    assert watch is not None
    store.write(lambda _connection: None).exception()  # waits until all earlier changes are stored
    shift = find_shift(get_shift_hours(store.settings.read_setting(SHIFT_HOURS_SETTING)), now, back)
    return calculate_shift_results(store, shift, now.timestamp(), watch.production_records.tool_table_kind)


def _places(folder: Path, plugged: Sequence[UsbStick]) -> tuple[BackupLocation, ...]:
    return (
        *(BackupLocation(stick.label, stick.path) for stick in plugged),
        BackupLocation(tr("THIS CONTROL"), folder),
    )


def _write(results: ShiftResults, machine: str, folder: Path, *, metric: bool) -> str:
    """Write the report atomically and return its file name.

    This function runs on the worker. Raises FileOperationError if the file cannot be written.
    """
    made = datetime.now().strftime("%Y-%m-%d %H:%M")
    name = f"shift-{datetime.fromtimestamp(results.shift.start_s).strftime('%Y-%m-%d-%H%M')}.html"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileOperationError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=folder, cause=error.strerror)
        ) from error
    copy_to_medium(
        folder / name,
        make_shift_html(results, machine, made, is_metric=metric).encode("utf-8", "backslashreplace"),
    )
    flush_folder(folder)
    return name
