"""Table of all pages of the main window, and loading of the pages before they are first opened."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

from PySide6 import QtCore, QtGui, QtWidgets
from PySide6.QtWidgets import QWidget

from app.compose.optional_features import extras, insert_items_after
from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.page_description import LATHES, MILLS, PageDescription
from app.desk.programs.program_loading import LoadingPhase
from app.screen.page_base import Page, PageHost

MENU, AUTOMATIC, EDITOR, MDI, JOG = "MAIN MENU", "AUTOMATIC", "EDITOR", "MDI", "JOG"
SEARCHTO_PAGE = "SEARCHTO"
TOOLS, SECCMP, SPECIAL = "TOOL OFFSETS", "SECONDARY OFFSETS", "SPECIAL FUNCTIONS"
ZERO, MILL_TOOLS, PRESETS = "ZERO OFFSETS", "TOOL TABLE", "PRESETS"
PROGRAMS, SHAPE, PART = "PROGRAMS", "TOOL SHAPE", "PART"
SCOPE, ANALYSES = "SCOPE", "ANALYSES"


_OMNITURN = frozenset({"omniturn"})
_PATH_CLASSES = (
    "app.path.path_pane_view.PaneSet",
    "app.path.path_marks_view.ViewButton",
    "app.path.measuring_view.Measurement",
    "app.path.part_pane_view.PartPane",
    "app.path.solid_pane_view.SolidPane",
    "app.path.path_buttons_view.make_view_buttons",
    "app.path.part_bar_view.PartTimeline",
    "app.path.path_projection.project_section",
)
_PANELS = tuple(extra.editor_panel_class for extra in extras().values() if extra.editor_panel_class)


_OWN_PAGES = (
    PageDescription(
        AUTOMATIC,
        "app.automatic.automatic_view.AutomaticPage",
        "",
        "F2",
        "AUTO",
        "run programs",
        deferred_modules=_PATH_CLASSES,
    ),
    PageDescription(
        EDITOR,
        "app.editor.editor_view.EditorPage",
        "app.editor.editor_model.EditorModel",
        "F3",
        "EDIT",
        "write and prove programs",
        deferred_modules=_PANELS,
    ),
    PageDescription(
        MDI,
        "app.mdi.mdi_view.MdiPage",
        "app.mdi.mdi_model.MdiModel",
        "F4",
        "MDI",
        ("enter and run one line at a time"),
    ),
    PageDescription(JOG, "app.jog.jog_view.JogPage", "", "F5", "JOG", "jog: axes, steps, homing"),
    PageDescription(
        PROGRAMS,
        "app.programs.programs_view.ProgramsPage",
        "app.programs.program_list_model.ProgramListModel",
        "F6",
        "LIST",
        "list, preview, copy, import and export",
    ),
    PageDescription(
        TOOLS,
        "app.offsets.tool_offsets_view.ToolOffsetsPage",
        "",
        "F8",
        "TOOLS",
        "T1…T32: tool offset and nose radius",
        LATHES,
    ),
    PageDescription(
        MILL_TOOLS,
        "app.offsets.cell_table_view.MillToolsPage",
        "",
        "F8",
        "TOOLS",
        "L, R, R2, oversizes, teeth, tool life; touch off the tool length",
        MILLS,
    ),
    PageDescription(
        SECCMP,
        "app.offsets.secondary_offsets_view.SecondaryOffsetsPage",
        "",
        "F9",
        "SECCMP",
        "D1…D32: wear and size offsets",
        _OMNITURN,
    ),
    PageDescription(
        PRESETS,
        "app.offsets.cell_table_view.PresetsPage",
        "",
        "F9",
        "PRESETS",
        "workpiece position: X Y Z, rotary axes, basic rotation",
        MILLS,
    ),
    PageDescription(
        ZERO,
        "app.offsets.cell_table_view.ZeroOffsetsPage",
        "",
        "G",
        "ZERO",
        "G54…G59: zero offsets for SINUMERIK programs",
        LATHES,
    ),
    PageDescription(
        SPECIAL,
        "app.special.special_view.SpecialFunctionsPage",
        "app.special.special_functions.SpecialFunctionsModel",
        "F10",
        "SPECIAL",
        "speed limit, parts, inputs and outputs, log, backup",
    ),
    PageDescription(
        PART,
        "app.part.part_page_view.PartPage",
        "app.part.part_model.PartPageModel",
        "B",
        "PART",
        "program findings, stock, checks turned off",
        LATHES,
    ),
    PageDescription(
        SCOPE,
        "app.scope.scope_view.ScopePage",
        "app.scope.scope_model.ScopeModel",
        "Q",
        "SCOPE",
        "axis and spindle plots: following error, speed, load",
        deferred_modules=("app.scope.scope_chart_view.ScopeChart",),
    ),
    PageDescription(SHAPE, "app.offsets.tool_offsets_view.ToolShapePage"),
    PageDescription(MENU, "app.screen.main_menu.MenuPage"),
    PageDescription(
        SEARCHTO_PAGE, "app.searchto.searchto_view.RestartPage", "app.searchto.searchto_model.RestartModel"
    ),
)
ALL_PAGES = tuple(
    insert_items_after(
        _OWN_PAGES,
        lambda entry: entry.name,
        [(page, page.preceding_page) for extra in extras().values() for page in extra.page_descriptions],
    )
)
MENU_PAGES = tuple(entry for entry in ALL_PAGES if entry.key)


_REPLACED_PAGES = {
    "klartext": {TOOLS: MILL_TOOLS, SECCMP: PRESETS, ZERO: PRESETS},
    "sinumerik": {SECCMP: ZERO},
}


def find_replacement_page(language: str, name: str) -> str:
    """Return the name of the page that replaces the page ``name`` for a programming language.

    If no page replaces it, the result is ``name``.
    """
    return _REPLACED_PAGES.get(language, {}).get(name, name)


def list_menu_entries(language: str) -> tuple[PageDescription, ...]:
    """Return the entries of the main menu for a machine with the given programming language."""
    return tuple(entry for entry in MENU_PAGES if language in entry.program_languages)


def map_menu_keys(language: str) -> dict[str, PageDescription]:
    """Return a mapping from each menu key to the page that it opens.

    A page that replaces another page can also be opened with the key of the replaced page.
    """
    entries = list_menu_entries(language)
    by_name = {entry.name: entry for entry in entries}
    absent = [entry for entry in MENU_PAGES if language not in entry.program_languages]
    instead = {
        entry.key: by_name[find_replacement_page(language, entry.name)]
        for entry in absent
        if find_replacement_page(language, entry.name) in by_name
    }
    return {**instead, **{entry.key: entry for entry in entries}}


_ENTRIES_BY_NAME = {entry.name: entry for entry in ALL_PAGES}


def list_pages(language: str) -> tuple[PageDescription, ...]:
    """Return the pages for a machine with the given programming language."""
    return tuple(entry for entry in ALL_PAGES if language in entry.program_languages)


def has_page(name: str) -> bool:
    """Return whether a page with this name exists.

    Pages of optional features may be missing.
    """
    return name in _ENTRIES_BY_NAME


def import_page_classes(entry: PageDescription) -> None:
    """Import the classes of a page.

    This runs on a worker, so that the page later opens without delay.
    """
    for dotted in (entry.view_class, entry.model_class, *entry.deferred_modules):
        if dotted:
            import_class(dotted)


def make_page(name: str, host: PageHost, parent: QWidget) -> Page:
    """Create the page with this name.

    Raise RuntimeError if the model of the page does not exist yet.
    """
    entry = _ENTRIES_BY_NAME[name]
    view = import_class(entry.view_class)
    page: Page = view(host, _model(entry, host), parent) if entry.model_class else view(host, parent)
    return page


def import_class(dotted_name: str) -> Any:
    """Import the class with this dotted name, and return it."""
    module, _, name = dotted_name.rpartition(".")
    return getattr(import_module(module), name)


def find_editor_panel_class(default: Any) -> Any:
    """Return the editor panel class of an optional feature, or ``default`` if no feature has one."""
    return import_class(_PANELS[0]) if _PANELS else default


def _model(entry: PageDescription, host: PageHost) -> object:
    model = host.desk.page_registry.find_model(import_class(entry.model_class))
    if model is None:
        raise RuntimeError(f"the desk was put together without {entry.model_class}")
    return model


TYPES_PER_SLICE = 20  # PySide classes that are created in one slice.
MIN_SLICE_INTERVAL_S = (
    0.05  # Minimum seconds between two slices, so that the frames between them are not delayed.
)
_LOADING_PHASES = frozenset(
    {LoadingPhase.READING, LoadingPhase.PROVING, LoadingPhase.DRAWING, LoadingPhase.PROVING_PART}
)


def create_qt_classes() -> Iterator[bool]:
    """Create all PySide classes on Qt's thread, in slices, before a worker imports pyqtgraph.

    PySide creates a class when it is first used. If two threads do this at the same time, the process can
    crash. Yield False after each slice of a few milliseconds.
    """
    for module in (QtCore, QtGui, QtWidgets):
        for slice_ in split_into_batches(dir(module)):
            for name in slice_:
                getattr(module, name, None)
            yield False


def split_into_batches(names: list[str]) -> Iterator[list[str]]:
    """Yield the names in lists of at most ``TYPES_PER_SLICE`` names."""
    for first in range(0, len(names), TYPES_PER_SLICE):
        yield names[first : first + TYPES_PER_SLICE]


class PagePreloader:
    """Preloader that imports and prepares the pages in slices while TurnDesk is idle.

    It is closed together with TurnDesk.
    """

    def __init__(self, desk: Desk, find_page: Callable[[str], Page]) -> None:
        self._desk, self._page_of = desk, find_page
        self._worker = LatestRequestWorker("editing-pages")
        self._slices = self._load_all()
        self._next = desk.clock.read_seconds() + MIN_SLICE_INTERVAL_S
        self.is_done = False

    def continue_loading(self) -> None:
        """Execute the next slice if no program is being loaded.

        This is called once a frame.
        """
        now = self._desk.clock.read_seconds()
        if (
            self.is_done
            or now < self._next
            or self._desk.program_loader.loaded_program.phase in _LOADING_PHASES
        ):
            return
        self._next = now + MIN_SLICE_INTERVAL_S
        self._worker.deliver_results()
        if not self._worker.is_busy and next(self._slices, True):
            self.is_done = True
            gc.freeze()  # Exclude the modules from garbage collection, which stops every thread.

    def close(self) -> None:
        """Stop loading pages, and end the worker."""
        self.is_done = True
        self._worker.close()

    def _load_all(self) -> Iterator[bool]:
        """Import and prepare all pages in slices.

        Yield False after each slice. A slice either imports a page or prepares a part of it.
        """
        yield from create_qt_classes()
        for entry in list_pages(self._desk.machine.program_language):
            found: list[None] = []
            self._worker.enqueue_work(partial(import_page_classes, entry), found.append, lambda _why: None)
            yield False
            if found and entry.deferred_modules and self._has_model(entry):
                page = self._page_of(entry.name)
                yield False
                while page.continue_preparation():
                    yield False

    def _has_model(self, entry: PageDescription) -> bool:
        return (
            not entry.model_class
            or self._desk.page_registry.find_model(import_class(entry.model_class)) is not None
        )
