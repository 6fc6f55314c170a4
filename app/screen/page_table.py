"""The table of all pages of the main window, and the loading of pages before they are first opened."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

from PySide6 import QtCore, QtGui, QtWidgets
from PySide6.QtWidgets import QWidget

from app.compose.extra import extras, insert_after
from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.page_description import LATHES, MILLS, PageEntry
from app.desk.programs.program_loading import Phase
from app.screen.page_base import Host, Page

MENU, AUTOMATIC, EDITOR, MDI, JOG = "MAIN MENU", "AUTOMATIC", "EDITOR", "MDI", "JOG"
SEARCHTO = "SEARCHTO"
TOOLS, SECCMP, SPECIAL = "TOOL OFFSETS", "SECONDARY OFFSETS", "SPECIAL FUNCTIONS"
ZERO, MILL_TOOLS, PRESETS = "ZERO OFFSETS", "TOOL TABLE", "PRESETS"
PROGRAMS, SHAPE, PART = "PROGRAMS", "TOOL SHAPE", "PART"
SCOPE, ANALYSES = "SCOPE", "ANALYSES"


_OMNITURN = frozenset({"omniturn"})
_PATH = (
    "app.path.path_pane_view.Panes",
    "app.path.path_marks_view.Button",
    "app.path.measuring_view.Measure",
    "app.path.part_pane_view.PartPane",
    "app.path.part_pane_view.SolidPane",
    "app.path.part_bar_view.PartBar",
    "app.path.path_projection.metal_of",
)
_PANELS = tuple(extra.editor_panel for extra in extras().values() if extra.editor_panel)


_OWN_PAGES = (
    PageEntry(
        AUTOMATIC,
        "app.automatic.automatic_view.AutomaticPage",
        "",
        "F2",
        "AUTO",
        "run programs",
        later=_PATH,
    ),
    PageEntry(
        EDITOR,
        "app.editor.editor_view.EditorPage",
        "app.editor.editor.Editor",
        "F3",
        "EDIT",
        "write and prove programs",
        later=_PANELS,
    ),
    PageEntry(
        MDI,
        "app.mdi.mdi_view.MdiPage",
        "app.mdi.mdi_model.MdiModel",
        "F4",
        "MDI",
        ("enter and run one line at a time"),
    ),
    PageEntry(JOG, "app.jog.jog_view.JogPage", "", "F5", "JOG", "jog: axes, steps, homing"),
    PageEntry(
        PROGRAMS,
        "app.programs.programs_view.ProgramsPage",
        "app.programs.program_list.ProgramList",
        "F6",
        "LIST",
        "list, preview, copy, import and export",
    ),
    PageEntry(
        TOOLS,
        "app.offsets.tool_offsets_view.ToolOffsetsPage",
        "",
        "F8",
        "TOOLS",
        "T1…T32: tool offset and nose radius",
        LATHES,
    ),
    PageEntry(
        MILL_TOOLS,
        "app.offsets.cell_table_view.MillToolsPage",
        "",
        "F8",
        "TOOLS",
        "L, R, R2, oversizes, teeth, tool life; touch off the tool length",
        MILLS,
    ),
    PageEntry(
        SECCMP,
        "app.offsets.secondary_offsets_view.SecondaryOffsetsPage",
        "",
        "F9",
        "SECCMP",
        "D1…D32: wear and size offsets",
        _OMNITURN,
    ),
    PageEntry(
        PRESETS,
        "app.offsets.cell_table_view.PresetsPage",
        "",
        "F9",
        "PRESETS",
        "workpiece position: X Y Z, rotary axes, basic rotation",
        MILLS,
    ),
    PageEntry(
        ZERO,
        "app.offsets.cell_table_view.ZeroOffsetsPage",
        "",
        "G",
        "ZERO",
        "G54…G59: zero offsets for SINUMERIK programs",
        LATHES,
    ),
    PageEntry(
        SPECIAL,
        "app.special.special_view.SpecialPage",
        "app.special.special_functions.SpecialFunctions",
        "F10",
        "SPECIAL",
        "speed limit, parts, inputs and outputs, log, backup",
    ),
    PageEntry(
        PART,
        "app.part.part_sheet_view.PartPage",
        "app.part.part_sheet.PartSheet",
        "B",
        "PART",
        "program findings, stock, checks turned off",
        LATHES,
    ),
    PageEntry(
        SCOPE,
        "app.scope.scope_view.ScopePage",
        "app.scope.scope_model.Scope",
        "Q",
        "SCOPE",
        "axis and spindle plots: following error, speed, load",
        later=("app.scope.scope_chart_view.ScopeChart",),
    ),
    PageEntry(SHAPE, "app.offsets.tool_offsets_view.ToolShapePage"),
    PageEntry(MENU, "app.screen.main_menu.MenuPage"),
    PageEntry(
        SEARCHTO, "app.searchto.searchto_view.SearchtoPage", "app.searchto.searchto_model.SearchtoModel"
    ),
)
PAGES = tuple(
    insert_after(
        _OWN_PAGES,
        lambda entry: entry.name,
        [(page, page.after) for extra in extras().values() for page in extra.pages],
    )
)
IN_MENU = tuple(entry for entry in PAGES if entry.key)


_INSTEAD = {
    "klartext": {TOOLS: MILL_TOOLS, SECCMP: PRESETS, ZERO: PRESETS},
    "sinumerik": {SECCMP: ZERO},
}


def page_on(language: str, name: str) -> str:
    """Return the page that a machine with this language opens in place of the page ``name``."""
    return _INSTEAD.get(language, {}).get(name, name)


def menu_of(language: str) -> tuple[PageEntry, ...]:
    """Return the entries of the main menu on a machine with this language."""
    return tuple(entry for entry in IN_MENU if language in entry.languages)


def menu_keys(language: str) -> dict[str, PageEntry]:
    """Return the menu keys with the pages that they open.

    A page that replaces another page also has the other page's key.
    """
    entries = menu_of(language)
    by_name = {entry.name: entry for entry in entries}
    absent = [entry for entry in IN_MENU if language not in entry.languages]
    instead = {
        entry.key: by_name[page_on(language, entry.name)]
        for entry in absent
        if page_on(language, entry.name) in by_name
    }
    return {**instead, **{entry.key: entry for entry in entries}}


_ENTRY_OF = {entry.name: entry for entry in PAGES}


def pages_of(language: str) -> tuple[PageEntry, ...]:
    """Return the pages of a machine with this language."""
    return tuple(entry for entry in PAGES if language in entry.languages)


def has_page(name: str) -> bool:
    """Return whether a page with this name exists. Pages of optional features may be missing."""
    return name in _ENTRY_OF


def load(entry: PageEntry) -> None:
    """Import the classes that a page needs. This runs on a worker, so that opening the page is fast."""
    for dotted in (entry.view, entry.model, *entry.later):
        if dotted:
            class_of(dotted)


def make_page(name: str, host: Host, parent: QWidget) -> Page:
    """Create the page with this name. Raises RuntimeError if its model is not attached."""
    entry = _ENTRY_OF[name]
    view = class_of(entry.view)
    page: Page = view(host, _model(entry, host), parent) if entry.model else view(host, parent)
    return page


def class_of(dotted: str) -> Any:
    """Import and return the class with this dotted name."""
    module, _, name = dotted.rpartition(".")
    return getattr(import_module(module), name)


def editor_panel(none: Any) -> Any:
    """Return the panel class that an optional feature adds to the editor, or ``none``."""
    return class_of(_PANELS[0]) if _PANELS else none


def _model(entry: PageEntry, host: Host) -> object:
    model = host.desk.pages.find(class_of(entry.model))
    if model is None:
        raise RuntimeError(f"the desk was put together without {entry.model}")
    return model


TYPES = 20  # PySide classes that are created in one slice.
APART = 0.05  # Minimum seconds between two slices, so that the frames between them are not delayed.
_LOADING = frozenset({Phase.READING, Phase.PROVING, Phase.DRAWING, Phase.PART})


def make_types() -> Iterator[bool]:
    """Create all PySide classes on Qt's thread, in slices, before a worker imports pyqtgraph.

    PySide creates a class at its first use. If two threads do this at the same time, the process can crash.
    Yields False after each slice of a few milliseconds.
    """
    for module in (QtCore, QtGui, QtWidgets):
        for slice_ in batched_names(dir(module)):
            for name in slice_:
                getattr(module, name, None)
            yield False


def batched_names(names: list[str]) -> Iterator[list[str]]:
    """Yield the names in lists of ``TYPES`` at most."""
    for first in range(0, len(names), TYPES):
        yield names[first : first + TYPES]


class PagesAhead:
    """Loads the pages in slices while TurnDesk is idle. It is closed with TurnDesk."""

    def __init__(self, desk: Desk, page_of: Callable[[str], Page]) -> None:
        self._desk, self._page_of = desk, page_of
        self._worker = Latest("editing-pages")
        self._slices = self._all()
        self._next = desk.clock.seconds() + APART
        self.done = False

    def step(self) -> None:
        """Execute the next slice if no program is being loaded; called once a frame."""
        now = self._desk.clock.seconds()
        if self.done or now < self._next or self._desk.session.now.phase in _LOADING:
            return
        self._next = now + APART
        self._worker.poll()
        if not self._worker.busy and next(self._slices, True):
            self.done = True
            gc.freeze()  # Exclude the modules from garbage collection, which stops every thread.

    def close(self) -> None:
        """Stop loading pages and end the worker."""
        self.done = True
        self._worker.close()

    def _all(self) -> Iterator[bool]:
        """Yield False after every slice: a page is imported, or a part of it is prepared."""
        yield from make_types()
        for entry in pages_of(self._desk.machine.language):
            found: list[None] = []
            self._worker.queue(partial(load, entry), found.append, lambda _why: None)
            yield False
            if found and entry.later and self._has_model(entry):
                page = self._page_of(entry.name)
                yield False
                while page.ahead():
                    yield False

    def _has_model(self, entry: PageEntry) -> bool:
        return not entry.model or self._desk.pages.find(class_of(entry.model)) is not None
