"""A screen reader, and a test that knows only names, can work the desk."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtGui import QAccessible, QAccessibleInterface
from PySide6.QtWidgets import QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.translation import tr
from app.screen import accessible, page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.page_table import list_pages
from app.screen.panel import TouchControl, TouchPanel
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.table_panel import TablePanel
from app.screen.window.main_window import MainWindow
from core.executor.commands import SetSwitch
from tests.screen.accessible_tree import DESCRIPTION, NAME, named, press, tree
from tests.screen.day import begun
from tests.screen.hands import Hands
from tests.screen.test_mill import Mill

Role = QAccessible.Role


@pytest.fixture(autouse=True)
def installed() -> None:
    accessible.register_accessibility()


@pytest.fixture
def above(qtbot: QtBot) -> QWidget:
    made = QWidget()
    qtbot.addWidget(made)
    made.setWindowTitle("TurnDesk")
    made.show()
    return made


@pytest.fixture
def mill(qtbot: QtBot, tmp_path: Path) -> Iterator[Mill]:
    made = Mill(tmp_path)
    yield made
    made.close()


def without_name(window: MainWindow) -> list[str]:
    """Each page on which something has no name or no role."""
    assert window.frame is not None
    found = []
    for entry in list_pages(window.frame.desk.machine.program_language):
        window.frame.open_page(entry.name)
        window.refresh()
        found += [
            f"{entry.name}: {node.role().name} {node.object()} at {node.rect()}"
            for node in tree(window)
            if not node.text(NAME).strip() or node.role() is Role.NoRole
        ]
    return found


def test_every_lathe_page_element_has_accessible_name(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "bore.nc", "G90G94F10\nX.5Z.5\nM30\n") as day:
        assert without_name(day.window) == []


def test_every_mill_page_element_has_accessible_name(mill: Mill) -> None:
    assert without_name(mill.window) == []


def test_each_open_page_reports_its_own_name(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "bore.nc", "G90G94F10\nX.5Z.5\nM30\n") as day:
        frame = day.window.frame
        assert frame is not None
        for entry in list_pages(frame.desk.machine.program_language):
            frame.open_page(entry.name)
            day.window.refresh()
            page = frame.current_page
            assert QAccessible.queryAccessibleInterface(page).text(NAME) == tr(page.NAME)


def test_pages_open_by_accessible_names_of_keys(hands: Hands) -> None:
    press(named(hands.window, "F1  MENU"))
    assert hands.frame.current_page.NAME == page_table.MENU
    hands.window.refresh()
    press(named(hands.window, "F8  TOOL OFFSETS"))
    assert hands.frame.current_page.NAME == page_table.TOOLS


def test_lamp_reports_whether_it_is_lit(hands: Hands) -> None:
    lamp = named(hands.window, "S  SINGLE  BLOCK")
    assert (lamp.role(), lamp.state().checkable, lamp.state().checked) == (Role.CheckBox, True, False)
    press(lamp)
    assert SetSwitch("single_block", True) in hands.machine.posted


def test_list_reports_its_rows_and_marked_row(above: QWidget) -> None:
    chosen: list[int] = []
    panel = shown_sheet(above, chosen, 30)
    node = QAccessible.queryAccessibleInterface(panel)
    assert (node.role(), node.text(NAME), node.text(DESCRIPTION)) == (Role.List, "PROGRAMS", "NAME  SIZE")
    rows = [each for each in tree(panel) if each.role() is Role.ListItem]
    assert [each.text(NAME) for each in rows[:2]] == ["row 0  12", "row 1  12"]
    assert [each.state().selected for each in rows[:3]] == [False, True, False]
    press(rows[2])
    assert chosen == [2]
    press(named(panel, "NEXT ROWS"))
    panel.grab()
    assert panel.first_row == panel.rows
    assert rows[0].text(NAME) == f"row {panel.rows}  12"


def test_removed_row_has_no_name_and_cannot_be_pressed(above: QWidget) -> None:
    chosen: list[int] = []
    panel = shown_sheet(above, chosen, 3)
    last = [each for each in tree(panel) if each.role() is Role.ListItem][-1]
    shown_sheet(above, chosen, 1, panel)
    assert not last.isValid()
    assert (last.text(NAME), last.role(), last.state().invalid) == ("", Role.NoRole, True)
    press(last)
    assert chosen == []
    assert QAccessible.queryAccessibleInterface(panel).child(1) is None


def test_unavailable_key_is_disabled(hands: Hands) -> None:
    press(named(hands.window, "F1  MENU"))
    hands.frame.open_page(page_table.TOOLS)
    hands.window.refresh()
    undo, history = (named(hands.window, name).state().disabled for name in ("F4  UNDO", "F5  HISTORY"))
    assert (undo, history) == (True, False)


def test_control_that_acts_while_pressed_has_no_press_action(hands: Hands) -> None:
    hands.frame.open_page(page_table.JOG)
    hands.window.refresh()
    arrows = [
        node for node in tree(hands.window) if "  Z" in f"  {node.text(NAME)}" and node.rect().isValid()
    ]
    assert arrows
    hands.machine.posted.clear()
    for node in tree(hands.window):
        actions = node.actionInterface() if node.object() is None else None
        if actions is not None and not actions.actionNames():
            press(node)
    assert not hands.machine.posted
    sliders = [node.text(NAME) for node in tree(hands.window) if node.role() is Role.Slider]
    assert sliders == ["SPINDLE SPEED", "FEED RATE"]


def test_control_reports_press_and_release(above: QWidget) -> None:
    told: list[str] = []

    class One(TouchPanel):
        def draw(self, _painter: ThemedPainter) -> None:
            self.controls = [
                TouchControl(
                    self.find_full_area(), lambda _at: told.append("down"), None, self.up, name="HORN"
                )
            ]

        def up(self) -> None:
            told.append("up")

    panel = One(ScreenTheme(DARK_PALETTE), above)
    panel.show()
    press(named(panel, "HORN"))
    assert told == ["down", "up"]


def test_stock_widgets_retain_qt_accessibility(above: QWidget) -> None:
    edit, inner = QLineEdit(above), QWidget(above)
    assert QAccessible.queryAccessibleInterface(edit).role() is Role.EditableText
    assert QAccessible.queryAccessibleInterface(inner).text(NAME) == "TurnDesk"


def test_deleted_panel_invalidates_its_rows(above: QWidget) -> None:
    panel = shown_sheet(above, [], 3)
    rows = [each for each in tree(panel) if each.role() is Role.ListItem]
    panel.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    del panel
    gc.collect()
    assert not any(each.isValid() for each in rows)
    assert not rows[0].rect().isValid()
    assert rows[0].parent() is None


def shown_sheet(above: QWidget, chosen: list[int], count: int, panel: TablePanel | None = None) -> TablePanel:
    panel = panel or TablePanel(ScreenTheme(DARK_PALETTE, 6.4), chosen.append, above)
    panel.resize(500, 300)
    panel.show()
    rows = tuple(TableRow((f"row {number}", "12")) for number in range(count))
    panel.show_table(TableContent("PROGRAMS", ("NAME", "SIZE"), (0.6, 0.4), rows, 1))
    panel.grab()
    return panel


def test_row_has_only_action_interface(above: QWidget) -> None:
    """Qt takes what ``interface_cast`` returns for an address: None would be one."""
    row = next(each for each in tree(shown_sheet(above, [], 3)) if each.role() is Role.ListItem)
    assert QAccessibleInterface.valueInterface(row) is None
    assert QAccessibleInterface.textInterface(row) is None
    assert QAccessibleInterface.actionInterface(row).actionNames() == ["Press"]
