"""The pages of the main window, one entry a page: name, view, model; key, label and use in the main menu."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from PySide6.QtWidgets import QWidget

from app.screen.page_base import Host, Page

MENU, AUTOMATIC, EDITOR, MDI, JOG = "MAIN MENU", "AUTOMATIC", "EDITOR", "MDI", "JOG"
SEARCHTO = "SEARCHTO"
TOOLS, SECCMP, SPECIAL = "TOOL OFFSETS", "SECONDARY OFFSETS", "SPECIAL FUNCTIONS"
PROGRAMS, ZERO, SHAPE, PART = "PROGRAMS", "ZERO OFFSETS", "TOOL SHAPE", "PART"
SCOPE, ANALYSES, DRIVE_TEST = "SCOPE", "ANALYSES", "DRIVE TEST"
MEASURED = "MEASURED PARTS"


@dataclass(frozen=True, slots=True)
class PageEntry:
    """One page. ``view`` and ``model`` are dotted names of classes: imported when the page is first opened.

    The model is the one that is attached to the desk; a view without one makes what it needs of the desk. A
    page without a key is not in the main menu.
    """

    name: str
    view: str
    model: str = ""
    key: str = ""
    label: str = ""
    use: str = ""


PAGES = (
    PageEntry(AUTOMATIC, "app.automatic.automatic_view.AutomaticPage", "", "F2", "AUTO", "run programs"),
    PageEntry(
        EDITOR,
        "app.editor.editor_view.EditorPage",
        "app.editor.editor.Editor",
        "F3",
        "EDIT",
        "write and prove programs",
    ),
    PageEntry(
        MDI, "app.mdi.mdi_view.MdiPage", "app.mdi.mdi_model.MdiModel", "F4", "MDI", "one line at a time"
    ),
    PageEntry(JOG, "app.jog.jog_view.JogPage", "", "F5", "JOG", "move by hand, touch tools off"),
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
        "T1…T32: position and nose radius",
    ),
    PageEntry(
        SECCMP,
        "app.offsets.secondary_offsets_view.SecondaryOffsetsPage",
        "",
        "F9",
        "SECCMP",
        "D1…D32: corrections of wear and size",
    ),
    PageEntry(
        ZERO,
        "app.offsets.zero_offsets_view.ZeroOffsetsPage",
        "",
        "G",
        "ZERO",
        "G54…G59: where SINUMERIK programs have their zero",
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
        "findings of the program, its stock, silenced checks",
    ),
    PageEntry(
        SCOPE,
        "app.scope.scope_view.ScopePage",
        "app.scope.scope_model.Scope",
        "Q",
        "SCOPE",
        "axes and spindle as curves: following error, speed, load",
    ),
    PageEntry(
        MEASURED,
        "app.quality.quality_view.MeasuredPartsPage",
        "app.quality.quality_functions.QualityFunctions",
        "W",
        "MEASURED",
        "readings, charts, wear, tool life, trends",
    ),
    PageEntry(ANALYSES, "app.scope.analyses_view.AnalysesPage", "app.scope.analyses.Analyses"),
    PageEntry(DRIVE_TEST, "app.jog.drive_test_view.DriveTestPage", "app.jog.drive_test_model.DriveTests"),
    PageEntry(SHAPE, "app.offsets.tool_shapes_view.ToolShapePage"),
    PageEntry(MENU, "app.screen.main_menu.MenuPage"),
    PageEntry(
        SEARCHTO, "app.searchto.searchto_view.SearchtoPage", "app.searchto.searchto_model.SearchtoModel"
    ),
)
IN_MENU = tuple(entry for entry in PAGES if entry.key)
_ENTRY_OF = {entry.name: entry for entry in PAGES}


def make_page(name: str, host: Host, parent: QWidget) -> Page:
    """The page of this name. Raises RuntimeError where the desk was put together without its model."""
    entry = _ENTRY_OF[name]
    view = class_of(entry.view)
    page: Page = view(host, _model(entry, host), parent) if entry.model else view(host, parent)
    return page


def class_of(dotted: str) -> Any:
    """The class of this dotted name, imported now."""
    module, _, name = dotted.rpartition(".")
    return getattr(import_module(module), name)


def _model(entry: PageEntry, host: Host) -> object:
    model = host.desk.attached(class_of(entry.model))
    if model is None:
        raise RuntimeError(f"the desk was put together without {entry.model}")
    return model
