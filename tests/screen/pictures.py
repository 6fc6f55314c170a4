"""Pictures of the pages, made without a display: ``python -m tests.screen.pictures OUT``.

A sample program stands ready and then runs on the simulated lathe, on a clock that this script moves.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.optional_features import insert_items_after
from app.compose.program_proving import get_samples_folder
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_offsets_file
from app.desk.desk import Desk
from app.editor.editor_view import EditorPage
from app.offsets.offset_book import OffsetBook
from app.screen import page_table
from app.screen.color_palettes import PALETTES
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.access.access_table import AccessLevel
from core.executor.snapshot import MachineState
from core.store.production import job_queue, measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.user_records import UserRow
from drivers.wakeups import ManualClock
from tests.extras.modules import of_extras
from tests.offset_store import use_store

SIZES = ((1024, 600), (1920, 1080), (3840, 2160))
THEMES = ("dark", "light")
PROGRAM = "bushing"
AT_LINE = 26  # where the run is caught: finishing the outside
CORRECTIONS = (
    (1, -0.0005, 0.0, "X -.001"),
    (3, 0.001, -0.002, "X .002 Z -.002"),
    (1, -0.00125, 0.0, "X -.0015"),
)
AT_Z = -0.3 * 25.4
MILL, TILTED = "ac-table-mill", "roof"
TILTED_BLOCK = 29  # the way back along the rear slope
TICK = 0.01
HEARD = 0.5  # seconds in which the executor obeys whatever was posted, and warnings are read
LOADING = 60.0  # seconds after which loading has failed


class Stage:
    """One desk on the simulated lathe, moved by hand."""

    def __init__(self, journal: Journal | None = None, machine: str | None = None) -> None:
        self.clock = ManualClock()
        self.desk, self._executor = create_desk_and_executor(
            machine, lambda: read_offsets_file(get_samples_folder() / "offsets.toml"), self.clock, journal
        )
        self._folder = TemporaryDirectory()
        book = journal.book() if journal is not None else OffsetBook(Store.open(Path(self._folder.name)))
        if book.store is None:
            raise OSError(book.lock_reason)
        self.store = book.store
        self._fill(self.store)
        use_store(self.desk, self.store)
        self.desk.station_controls.clock = self.clock.now
        self.desk.clock.format_local_time = lambda: "09:41:07"

    def _fill(self, store: Store) -> None:
        """The offsets of the samples and some corrections."""
        for number, tool in read_offsets_file(get_samples_folder() / "offsets.toml").tool_offsets.items():
            store.offsets.tool_offsets.change_row(
                number, "touched off", {"x": tool.x, "z": tool.z, "nose_radius": tool.nose_radius}
            )
        sheet = {"kind": "turning", "insert": "CNMG432", "holder": "MCLNR-124B"}
        store.offsets.tool_offsets.change_row(1, "set", {"quadrant": 3})
        store.offsets.tool_shapes.change_row(1, "entered", sheet)
        for number, x, z, why in CORRECTIONS:
            store.offsets.secondary_offsets.change_row(number, why, {"x": x * 25.4, "z": z * 25.4}).result()
        _fill_parts(store)

    def close(self) -> None:
        """End the threads, forget the folder."""
        self.desk.close()
        self.store.close()
        self._folder.cleanup()

    def tick(self, until: Callable[[], bool], most: float = 120.0) -> None:
        """Let the machine go on until something is so."""
        end = self.clock.now() + most
        while not until():
            if self.clock.now() > end:
                state = self.desk.read_snapshot().state.value
                raise TimeoutError(f"not so after {most:g} s: {state}: {self.desk.prompt_notice}")
            self._executor.run_tick()
            self.clock.sleep_until(self.clock.now() + TICK)

    def make_ready(self, program: str = PROGRAM) -> None:
        """Load a program, prove it and switch the drives on."""
        desk = self.desk
        desk.program_choice.load_by_name(program)
        loaded = desk.program_loader.wait_until_loaded(LOADING)
        if loaded.blocking_errors:
            raise ValueError(f"{program} does not prove: {loaded.blocking_errors[0].message}")
        self.tick(lambda: desk.read_snapshot().state is MachineState.DISABLED)
        desk.enable_drives()
        self.tick(lambda: desk.read_snapshot().state is MachineState.IDLE)
        self.checks_start()

    def hears(self) -> None:
        """The executor obeys what was posted."""
        heard = self.clock.now() + HEARD
        self.tick(lambda: self.clock.now() > heard)

    def start(self) -> None:
        """Load, drives on, both palms."""
        self.make_ready()
        self.press_start()

    def checks_start(self) -> None:
        """What was posted is obeyed, and the first move of the next start is checked."""
        desk = self.desk
        self.hears()
        desk.update()
        if desk.start_watch is not None:
            desk.start_watch.worker.wait_for_results(LOADING)

    def press_start(self) -> None:
        """Both palms, until something happens."""
        desk = self.desk
        desk.update()  # what was changed since is read anew first
        desk.program_loader.wait_until_loaded(LOADING)
        self.checks_start()
        desk.station_controls.palm("left", is_down=True)
        desk.station_controls.palm("right", is_down=True)
        self.tick(lambda: desk.read_snapshot().state is not MachineState.IDLE, 5.0)
        desk.station_controls.release_all_buttons()


SIZES_MEASURED = (
    0,
    1,
    -1,
    2,
    0,
    1,
    2,
    1,
    3,
    2,
    3,
    4,
    3,
    5,
    4,
    5,
    6,
    5,
    7,
    6,
)  # ten thousandths off, a diameter
STOPS = (("BETWEEN CYCLES", 900.0), ("FEED HOLD", 95.0), ("PROGRAM STOP (M00)", 410.0), ("E-STOP", 240.0))

JOBS = ((f"{PROGRAM}.nc", 50, "order 4711, brass"), ("grooves.nc", 60, "order 4712"), ("knob.nc", 12, ""))


def _fill_parts(store: Store) -> None:
    """Twenty parts whose diameter grows as the insert wears, three stops, two lives."""
    name = f"{PROGRAM}.nc"
    rows = (
        FeatureRow(0, name, "OUTSIDE", "diameter", 22.225, -0.0254, 0.0254, "tool", 1, 1, 5, 1),
        FeatureRow(0, name, "LENGTH", "length", 19.05, -0.0508, 0.0508, "tool", 1, -1, 10, 1),
    )
    features = [store.write(partial(measured_parts.save_feature, row=row)).result() for row in rows]
    for part, off in enumerate(SIZES_MEASURED, start=1):
        at = f"2026-03-02T08:{part:02d}:00.000Z"
        made = CycleRow(f"{part}", name, part, at, at, 41.0 + off % 3, "COMPLETE")
        store.write(partial(part_cycles.save_cycle, row=made)).result()
        size = 22.225 + off * 0.00254
        reading = ReadingRow(0, features[0], part, size, "in", at, "gauge", "micrometer")
        store.write(partial(measured_parts.add_reading, row=reading)).result()
    for number, (reason, seconds) in enumerate(STOPS):
        row = ProductionStopRow(f"{number}", "", name, f"2026-03-02T09:{number:02d}:00.000Z", seconds, reason)
        store.write(partial(part_cycles.save_stop, row=row)).result()
    for life in (ToolLifeRow(1, 200, 0.0, 0.9, True), ToolLifeRow(3, 0, 1800.0)):
        store.write(partial(tool_lives.save_tool_life_limits, row=life)).result()
    store.write(lambda c: tool_lives.save_insert_use(c, 1, 184, 4020.0)).result()
    store.write(lambda c: tool_lives.save_insert_use(c, 3, 61, 732.0)).result()
    for program, wanted, note in JOBS:
        store.write(partial(job_queue.add_job, program=program, parts_to_make=wanted, note=note)).result()
    store.write(lambda c: job_queue.activate_job(c, 1)).result()
    store.runs.add_parts(name, len(SIZES_MEASURED)).result()


def main(argv: list[str] | None = None) -> int:
    """Write the pictures; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.screen.pictures", description=__doc__)
    parser.add_argument("out", metavar="OUT", type=Path, help="folder for the PNG files")
    parser.add_argument("--guide", action="store_true", help="the small dark ones of the guide only")
    parser.add_argument("--language", default="en", choices=("en", "es"), help="of the screen; default en")
    args = parser.parse_args(argv)
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    args.out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        os.environ["TURNDESK_HOME"] = folder
        sizes, themes = SIZES[:1] if args.guide else SIZES, THEMES[: 1 if args.guide else 2]
        for path in _pictures(args.out, Looks(sizes, themes, args.language)):
            shown = path.replace(path.with_name(f"{path.name.split('-dark')[0]}.png")) if args.guide else path
            sys.stdout.write(f"{shown}\n")
    return 0


class Looks(NamedTuple):
    """In which sizes, themes and language of the screen each scene is pictured."""

    sizes: tuple[tuple[int, int], ...]
    themes: tuple[str, ...]
    language: str


def _pictures(out: Path, looks: Looks) -> Iterator[Path]:
    """First what a standing machine shows, then what a running one does."""
    _app = QApplication.instance() or QApplication(sys.argv[:1])
    journal = Journal.open_default()
    stage = Stage(journal)
    stage.make_ready()
    with TemporaryDirectory(prefix="shop-") as folder:
        for each in of_extras("pictures"):
            each.prepare(stage.desk, journal, Path(folder))
        yield from taken(stage.desk, out, False, looks, heard=stage.hears)
    stage.press_start()
    stage.tick(lambda: stage.desk.read_snapshot().line >= AT_LINE)
    stage.tick(lambda: _z(stage.desk) <= AT_Z)
    yield from taken(stage.desk, out, True, looks)
    stage.close()
    journal.close()
    yield from _of_the_mill(out, looks)
    yield from _of_levels(out, looks)


def _of_the_mill(out: Path, looks: Looks) -> Iterator[Path]:
    """A tilted program, standing and caught in a cut of its second slope."""
    stage = Stage(machine=MILL)
    stage.make_ready(TILTED)
    yield from taken(stage.desk, out, False, looks, mill=True)
    stage.desk.window_state.set_page_properties(
        can_start=True
    )  # the editor was in front, and has handed its program over again
    stage.desk.program_loader.wait_until_loaded(LOADING)
    stage.press_start()
    stage.tick(lambda: stage.desk.read_snapshot().block >= TILTED_BLOCK)
    yield from taken(stage.desk, out, True, looks, mill=True)
    stage.close()


def _of_levels(out: Path, looks: Looks) -> Iterator[Path]:
    """Signing in, where people have been entered."""
    with TemporaryDirectory() as home:
        os.environ["TURNDESK_HOME"] = home
        journal = Journal.open_default()
        stage = Stage(journal)
        for name, level in (("ANNA", AccessLevel.SERVICE), ("BEN", AccessLevel.SETUP)):
            person = UserRow(name, level, b"-", b"-")  # nobody has to sign in
            journal.require_store().people.save_user(person).result()
        stage.desk.user_access.reload()
        stage.make_ready()
        yield from taken(stage.desk, out, False, looks, levels=True)
        stage.close()
        journal.close()


def _z(desk: Desk) -> float:
    snapshot = desk.read_snapshot()
    return snapshot.actual[1] - snapshot.offset[1]


# --- what is pictured ---------------------------------------------------------------------------------


SETTLE = 1.5  # seconds for workers to read, prove and draw


@dataclass(frozen=True, slots=True)
class Scene:
    """``keys`` with a space between them; a word that begins with ``"`` is typed letter by letter."""

    name: str
    keys: str = ""
    running: bool = False
    language: str = ""  # that of all others, unless another is told
    mill: bool = False  # the tilted sample on the mill with an A-C table
    line: int = 0  # where the editor's cursor is put
    levels: bool = False  # people have been entered


# One line for each picture.
_OWN_SCENES = (
    Scene("menu", "F1"),
    Scene("file", "F2"),
    Scene("programs", "F1 F6"),
    Scene("export", "F1 F6 F9"),
    Scene("editor", "F3"),
    Scene("mdi", 'F1 F4 "G90G94F10X.9Z.1'),
    Scene("jog", "F1 F5"),
    Scene("touch-off", 'F1 F5 T "1 Enter X "1.002'),
    Scene("by-hand", 'F1 F5 T "1 Enter C X B 1 "800 Enter'),
    Scene("searchto", 'F6 "20 Enter'),
    Scene("tools", "F8"),
    Scene("shape", "F8 F8"),
    Scene("seccmp", 'F9 "1 Enter "-.002+.0005'),
    Scene("history", "F9 F5"),
    Scene("zero", "F1 G"),
    Scene("readings", "F1 W 2"),
    Scene("charts", "F1 W 3"),
    Scene("life", "F1 W 4"),
    Scene("trends", "F1 W 5 Enter Down Down"),
    Scene("jobs", "Shift+F6 Down"),
    Scene("speed", 'F10 1 Enter "1500'),
    Scene("parts", "F10 2 Enter"),
    Scene("outputs", "F10 3 Enter Down"),
    Scene("inputs", "F10 3 Enter F4"),
    Scene("drives", "F10 4 Enter"),
    Scene("log", "F10 5 Enter"),
    Scene("backup", "F10 6 Enter"),
    Scene("screen", "F10 7 Enter"),
    Scene("lamps", f"F10 {'Up ' * 15}{'Down ' * 14}Enter"),  # from where the list stands
    Scene("automatic", running=True),
    Scene("spanish", running=True, language="es"),
    Scene("levels", f'F10 {"Down " * 15}Enter Down Enter "12', levels=True),
    Scene("mill-editor", "F3", mill=True, line=18),
    Scene("mill", running=True, mill=True),
)
SCENES = insert_items_after(
    _OWN_SCENES,
    lambda scene: scene.name,
    [(Scene(name, keys), after) for each in of_extras("pictures") for name, keys, after in each.SCENES],
)


def taken(
    desk: Desk,
    out: Path,
    running: bool,
    looks: Looks,
    *,
    mill: bool = False,
    levels: bool = False,
    heard: Callable[[], None] = lambda: None,
) -> Iterator[Path]:
    """The scenes of a machine that runs or stands, at every size and in every theme.

    ``heard`` lets the executor obey what the keys have posted.
    """
    load_fonts()
    for theme in looks.themes:
        style_application(PALETTES[theme])
        for width, height in looks.sizes:
            for scene in SCENES:
                if (scene.running, scene.mill, scene.levels) != (running, mill, levels):
                    continue
                desk.settings_store.choose("theme", theme)
                desk.settings_store.choose("language", scene.language or looks.language)
                window = MainWindow(ScreenTheme(PALETTES[theme]))
                window.resize(width, height)
                window.show_model(desk)
                path = out / f"{scene.name}-{theme}-{width}x{height}.png"
                press(window, scene.keys)
                heard()
                _to_line(window, scene.line)
                _grab(window, path)
                _leave(window)
                yield path


def _leave(window: MainWindow) -> None:
    """As an operator leaves a page: nothing stays half done on the desk."""
    if window.frame is not None:
        window.frame.desk.clear_prompt_line()
        window.frame.open_page(page_table.AUTOMATIC)
    window.close_silently()


def press(window: MainWindow, keys: str) -> None:
    """Each key to the page as text first, then as what it does anywhere; one of two words has a _."""
    for word in keys.split():
        for key in word[1:] if word.startswith('"') else [word]:
            _settle(window, 0.2)
            frame = window.frame
            if frame is not None and not frame.current_page.handle_key(key):
                window.press_key(key.replace("_", " "))


def _to_line(window: MainWindow, line: int) -> None:
    """And until the optional features have shown what they work out."""
    page = window.frame.current_page if window.frame is not None else None
    for each in of_extras("pictures"):
        each.settle(page, partial(_settle, window, SETTLE))
    if line and isinstance(page, EditorPage):
        _settle(window, SETTLE)
        page.move_cursor_to(line)


def _settle(window: MainWindow, seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QApplication.processEvents()
        window.refresh()
        time.sleep(0.01)


def _grab(window: MainWindow, path: Path) -> None:
    window.show()
    _settle(window, SETTLE)
    if not lean(window.grab().toImage()).save(str(path), "PNG", 1):  # type: ignore[call-overload]
        raise OSError(f"{path} cannot be written")


def lean(image: QImage) -> QImage:
    """The same with its 256 most frequent colours: a third of the file, and no difference to be seen."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    pixels = np.frombuffer(image.constBits(), dtype=np.uint32)
    colours, counts = np.unique(pixels, return_counts=True)
    table = [int(colour) for colour in colours[np.argsort(-counts)][:256]]
    flat = Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither
    return image.convertToFormat(QImage.Format.Format_Indexed8, table, flat)


if __name__ == "__main__":
    sys.exit(main())
