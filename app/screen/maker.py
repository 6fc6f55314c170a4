"""Which pages there are: each by its name, imported and made when it is first opened."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtWidgets import QWidget

from app.desk.pages import EDITOR, JOG, MDI, MENU, PROGRAMS, SEARCHTO, SECCMP, SPECIAL, TOOLS, ZERO
from app.screen.pages import Host, Page

MakePage = Callable[[Host, QWidget], Page]


def _menu(host: Host, parent: QWidget) -> Page:
    from app.screen.menu import MenuPage

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
    from app.screen.mdi.page import MdiPage

    model = host.desk.mdi
    if model is None:
        raise RuntimeError("the desk was put together without MDI")
    return MdiPage(host, model, parent)


def _jog(host: Host, parent: QWidget) -> Page:
    from app.screen.jog.page import JogPage

    if host.desk.lathe is None:
        raise RuntimeError("the desk was put together without a machine to move by hand")
    return JogPage(host, host.desk.lathe, parent)


def _searchto(host: Host, parent: QWidget) -> Page:
    from app.screen.searchto.page import SearchPage

    model = host.desk.searchto
    if model is None:
        raise RuntimeError("the desk was put together without SEARCHTO")
    return SearchPage(host, model, parent)


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
