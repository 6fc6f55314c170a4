"""The pages of the main window: names, the keys that open them, what they are for, and what makes each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtWidgets import QWidget

from app.screen.page_base import Host, Page

MENU, AUTOMATIC, EDITOR, MDI, JOG = "MAIN MENU", "AUTOMATIC", "EDITOR", "MDI", "JOG"
SEARCHTO = "SEARCHTO"
TOOLS, SECCMP, SPECIAL = "TOOL OFFSETS", "SECONDARY OFFSETS", "SPECIAL FUNCTIONS"
PROGRAMS, ZERO = "PROGRAMS", "ZERO OFFSETS"


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the main menu: the key there, the label of that key, the page and its use."""

    key: str
    label: str
    name: str
    use: str


ENTRIES = (
    Entry("F2", "AUTO", AUTOMATIC, "run programs"),
    Entry("F3", "EDIT", EDITOR, "write and prove programs"),
    Entry("F4", "MDI", MDI, "one line at a time"),
    Entry("F5", "JOG", JOG, "move by hand, touch tools off"),
    Entry("F6", "LIST", PROGRAMS, "list, preview, copy, import and export"),
    Entry("F8", "TOOLS", TOOLS, "T1…T32: position and nose radius"),
    Entry("F9", "SECCMP", SECCMP, "D1…D32: corrections of wear and size"),
    Entry("G", "ZERO", ZERO, "G54…G59: where SINUMERIK programs have their zero"),
    Entry("F10", "SPECIAL", SPECIAL, "speed limit, parts, inputs and outputs, log, backup"),
)

# --- Which pages there are: each by its name, imported and made when it is first opened.


MakePage = Callable[[Host, QWidget], Page]


def _menu(host: Host, parent: QWidget) -> Page:
    from app.screen.main_menu import MenuPage

    return MenuPage(host, parent)


def _seccmp(host: Host, parent: QWidget) -> Page:
    from app.offsets.secondary_offsets_view import SeccmpPage

    return SeccmpPage(host, parent)


def _tools(host: Host, parent: QWidget) -> Page:
    from app.offsets.tool_offsets_view import ToolsPage

    return ToolsPage(host, parent)


def _zero(host: Host, parent: QWidget) -> Page:
    from app.offsets.zero_offsets_view import ZeroPage

    return ZeroPage(host, parent)


def _editor(host: Host, parent: QWidget) -> Page:
    from app.editor.editor_view import EditorPage

    editor = host.desk.editor
    if editor is None:
        raise RuntimeError("the desk was put together without an editor")
    return EditorPage(host, editor, parent)


def _programs(host: Host, parent: QWidget) -> Page:
    from app.programs.programs_view import FilesPage

    model = host.desk.files
    if model is None:
        raise RuntimeError("the desk was put together without a list of programs")
    return FilesPage(host, model, parent)


def _special(host: Host, parent: QWidget) -> Page:
    from app.special.special_view import SpecialPage

    model = host.desk.special
    if model is None:
        raise RuntimeError("the desk was put together without special functions")
    return SpecialPage(host, model, parent)


def _mdi(host: Host, parent: QWidget) -> Page:
    from app.mdi.mdi_view import MdiPage

    model = host.desk.mdi
    if model is None:
        raise RuntimeError("the desk was put together without MDI")
    return MdiPage(host, model, parent)


def _jog(host: Host, parent: QWidget) -> Page:
    from app.jog.jog_view import JogPage

    if host.desk.lathe is None:
        raise RuntimeError("the desk was put together without a machine to move by hand")
    return JogPage(host, host.desk.lathe, parent)


def _searchto(host: Host, parent: QWidget) -> Page:
    from app.searchto.searchto_view import SearchtoPage

    model = host.desk.searchto
    if model is None:
        raise RuntimeError("the desk was put together without SEARCHTO")
    return SearchtoPage(host, model, parent)


MAKERS: Mapping[str, MakePage] = {
    MENU: _menu,
    EDITOR: _editor,
    MDI: _mdi,
    JOG: _jog,
    PROGRAMS: _programs,
    SPECIAL: _special,
    SEARCHTO: _searchto,
    SECCMP: _seccmp,
    TOOLS: _tools,
    ZERO: _zero,
}
