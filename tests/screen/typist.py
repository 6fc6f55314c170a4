"""Types single keys where the platform sends them, and compares everything that can change before and after.

What a key posts to the control, does at the station or loads is recorded and not carried out, so that the
machine stays in its state. Everything else is carried out and compared: settings, the loaded program, the
store, and the files.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QKeyEvent

from app.desk.background_work import LatestRequestWorker
from app.desk.data_folder import find_data_folder
from app.desk.programs.program_loading import ProgramLoader
from app.editor.editor_model import EditorStage
from app.editor.editor_view import EditorPage
from app.screen import page_table
from core.executor.commands import (
    ChangeOffsets,
    Command,
    ConfirmStart,
    DeselectHandwheel,
    LoadJob,
    PrepareCycleStart,
    ReplaceStartClearances,
    SetPartCount,
    SetSwitch,
    SupplyJobProof,
    UseOffsetTables,
)
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from core.store.store import Store
from drivers.simulators.plant_controls import PlantControls
from tests.screen.day import Day

NONE, SHIFT, CTRL = (
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
)
STATION = ("press_estop", "release_estop", "press_hold", "set_spindle_auto", "press_left", "press_right")
QUIET = (
    ReplaceStartClearances,
    SupplyJobProof,
    LoadJob,
    SetPartCount,
    PrepareCycleStart,
    ChangeOffsets,
    UseOffsetTables,
    DeselectHandwheel,
)  # of pages and workers
UNCHANGING = frozenset({"events"})  # tables that only log


@dataclass(frozen=True, slots=True)
class Stroke:
    """A key with its modifiers, and the text that it writes."""

    name: str
    key: int
    text: str = ""
    modifiers: Qt.KeyboardModifier = NONE


@dataclass
class Typist:
    """Presses keys and reports the changes, each by a short name; ``done`` collects what is recorded."""

    day: Day
    recorded: bool = True  # nothing reaches the machine
    done: set[str] = field(default_factory=set)
    workers: list[LatestRequestWorker] = field(default_factory=list)
    changed: set[str] = field(default_factory=set)  # by the last key, each table and file by its name
    stored: int = 0  # writes of the store
    _dump: dict[str, int] = field(default_factory=dict)

    def press(self, stroke: Stroke) -> set[str]:
        """Press and release a key; return what changed."""
        self.done.clear()
        if self.recorded:
            pressed = stroke.name == "u" and self.day.shot.state is MachineState.ESTOP
            self.day.desk.station_controls.is_estop_pressed = pressed  # else it would be no other press
        before = self._all()
        for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            event = QKeyEvent(kind, stroke.key, stroke.modifiers, stroke.text)
            QCoreApplication.sendEvent(self.day.window.windowHandle(), event)
        self._workers_end()
        after = self._all()
        changed = {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
        self.changed = changed
        return self.done | _kinds(changed)

    def _workers_end(self) -> None:
        """Wait until everything that the key has asked for is done."""
        while self.workers:
            worker = self.workers.pop()
            if not worker.quiet_time_s:
                worker.wait_for_results(30.0)
        if self.day.desk.offset_book.is_saving:
            self.sees(lambda: not self.day.desk.offset_book.is_saving)

    def _all(self) -> dict[str, object]:
        """All that a key may change, by name."""
        desk = self.day.desk
        loaded, settings = desk.program_loader.loaded_program, desk.settings_store.current_settings
        told: dict[str, object] = {f"setting {each}": getattr(settings, each) for each in settings.__slots__}
        told |= {
            "feed_pot": desk.station_controls.feed_pot.wanted,
            "spindle_pot": desk.station_controls.spindle_pot.wanted,
            "counter": desk.program_runs.part_counter.part_count,
            "loaded program": (loaded.path, loaded.is_block_delete_on, loaded.source),
            "snapshot": self.day.shot,
        }
        return told | self._store() | _files(find_data_folder())

    def _store(self) -> dict[str, int]:
        """The tables of the store; read again only after somebody has written."""
        if self.stored or not self._dump:
            self.day.store.write(lambda _connection: None).result(60)
            self.stored = 0
            self._dump = tables(self.day.store)
        return self._dump

    # --- the pages -----------------------------------------------------------------------------------

    @property
    def face(self) -> tuple[object, ...]:
        """What the page shows of what its keys are for now."""
        page = self.day.frame.current_page
        mode = page.mode if isinstance(page, EditorPage) else page.prompt_text()
        return (
            page.NAME,
            self.day.frame.has_text_field(),
            page.make_key_labels(),
            mode,
            self.day.frame.alarm_list.isVisible(),
            self.day.frame.search_bar.is_open,
        )

    def opens(self, name: str) -> bool:
        """Open a page afresh; False where it does not open in this state."""
        frame = self.day.frame
        frame.search_bar.search.close()  # Esc; a page that closes the search discards the next keys
        self.clear()
        if isinstance(frame.current_page, EditorPage):
            self._leaves_editor(frame.current_page)
        elif frame.current_page.NAME != page_table.AUTOMATIC:
            for _ in range(9):
                if not frame.current_page.handle_escape():
                    break
            frame.open_page(page_table.AUTOMATIC)
        frame.alarm_list.close_list()
        frame.automatic_page.file_prompt.close_prompt()
        frame.automatic_page.path_view.switch_measuring(is_on=False)
        opened = frame.current_page.NAME == page_table.AUTOMATIC and frame.open_page(name)
        self._workers_end()
        self.day.window.refresh()
        if isinstance(frame.current_page, EditorPage):
            editor = frame.current_page.editor
            self.sees(lambda: editor.stage in {EditorStage.OPEN, EditorStage.OFFERED})
        return opened

    def clear(self) -> None:
        """Take answer and question back, also an answer that outlives keys."""
        page = self.day.frame.current_page
        if isinstance(page, EditorPage):
            page.editor.clear_message()
        self.day.desk.prompt_line.is_lasting_message = False
        self.day.desk.clear_prompt_line()

    def _leaves_editor(self, page: EditorPage) -> None:
        """Leave without saving what was typed."""

        def left() -> bool:
            editor = page.editor
            if editor.stage is EditorStage.OFFERED:
                editor.cancel_document_offer()
            elif editor.stage is EditorStage.NAMING:
                editor.cancel_naming()
            elif editor.stage is EditorStage.OPEN:
                page.discard_and_leave()
                page.confirm_question()
            return self.day.frame.current_page is not page

        self.sees(left)

    def sees(self, true: Callable[[], bool]) -> None:
        """Wait for a worker; the machine stays as it is."""

        def look() -> bool:
            self.day.window.refresh()
            return true()

        self.day.qtbot.waitUntil(look, timeout=60_000)


def _kinds(changed: set[str]) -> set[str]:
    """The changes by kind; what keeps a setting of the screen belongs to that setting."""
    if any(name.startswith("setting ") for name in changed):
        changed -= {"store settings", "store row_sums"}
    return {name.split()[0] if name.startswith(("store ", "file ")) else name for name in changed}


def tables(store: Store) -> dict[str, int]:
    """Each table of the store by name, with a hash of its rows."""
    with store.read() as connection:
        names = [row[0] for row in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {
            f"store {name}": hash(tuple(map(tuple, connection.execute(f'SELECT * FROM "{name}"'))))
            for name in names
            if name not in UNCHANGING
        }


def _files(folder: Path) -> dict[str, object]:
    """Every file of the operator with its time and size, without those of the store."""
    found: dict[str, object] = {}
    folders = [str(folder)]
    while folders:
        with os.scandir(folders.pop()) as entries:
            for entry in entries:
                if entry.is_dir():
                    folders += [entry.path] if "thumbnails" not in entry.name else []
                elif ".db" not in entry.name and "lock" not in entry.name:
                    about = entry.stat()
                    found[f"file {entry.name}"] = (about.st_mtime_ns, about.st_size)
    return found


def record(monkeypatch: pytest.MonkeyPatch, typists: list[Typist]) -> None:
    """Have everything recorded and not carried out from the moment on in which somebody types."""
    for kind, method, name in (
        (Executor, "post", "post"),
        (ProgramLoader, "start_loading", "load"),
        *((PlantControls, each, each) for each in STATION),
    ):
        monkeypatch.setattr(kind, method, _recorded(getattr(kind, method), name, typists))
    for name in ("write", "keep"):
        monkeypatch.setattr(Store, name, _counted(getattr(Store, name), typists))
    begin = LatestRequestWorker._begin

    def begun(self: LatestRequestWorker, *values: object, **more: object) -> None:
        if typists:
            typists[0].workers.append(self)
        begin(self, *values, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(LatestRequestWorker, "_begin", begun)


def _recorded(does: Callable[..., None], name: str, typists: list[Typist]) -> Callable[..., None]:
    def call(this: object, *values: object, **more: object) -> None:
        if not typists:
            does(this, *values, **more)
        elif not (isinstance(values[0] if values else None, QUIET) or _is_again(this, *values, **more)):
            typists[0].done.add(_named(name, *values))

    return call


def _is_again(loader: object, path: object = None, block_delete: object = False) -> bool:
    """Whether the same program is loaded in the same way: with offsets that were changed."""
    if not isinstance(loader, ProgramLoader):
        return False
    return (path, block_delete) == (loader.loaded_program.path, loader.loaded_program.is_block_delete_on)


def _named(name: str, *values: object) -> str:
    command = values[0] if values else None
    if isinstance(command, SetSwitch):
        return command.name
    if isinstance(command, ConfirmStart):
        return "ConfirmStart" if command.at else "ConfirmNothing"
    if isinstance(command, Command):
        return type(command).__name__
    return name


def _counted(does: Callable[..., object], typists: list[Typist]) -> Callable[..., object]:
    def call(this: object, *values: object) -> object:
        if typists:
            typists[0].stored += 1
        return does(this, *values)

    return call
