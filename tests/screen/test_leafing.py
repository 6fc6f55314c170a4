"""Lists that are longer than their place, by a finger and by the wheel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.programs.program_folder import ProgramFolders
from app.desk.status.machine_status import StatusTone
from app.editor.editor_parts_view import FindingList
from app.editor.live_proof import ProofFindings
from app.offsets.cell_table_view import CellPanel
from app.offsets.mill_tools import MillToolTable
from app.offsets.offsets_view import ChangeHistoryList
from app.programs.file_prompt_view import FilePrompt
from app.screen.color_palettes import DARK_PALETTE
from app.screen.main_menu import _MenuTiles
from app.screen.page_table import list_menu_entries
from app.screen.panel import Panel
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.table_panel import TablePanel
from app.screen.window_layout import FINGERTIP_PX
from app.special.special_view import FunctionListPanel
from core.language.diagnostics import Diagnostic, Severity
from core.store.store_rows import FIELDS_BY_KIND
from tests.texts import text as wording

if TYPE_CHECKING:
    from app.offsets.cell_table import CellTable
    from app.special.special_functions import SpecialFunctionsModel

MANY = 30
SMALL = 6.4  # pixels of the unit at 1024x600


def sheet_of(count: int, marked: int = 0) -> TableContent:
    return TableContent(
        "PROGRAMS", ("NAME",), (1.0,), tuple(TableRow((f"row {n}",)) for n in range(count)), marked
    )


@pytest.fixture
def above(qtbot: QtBot) -> QWidget:
    made = QWidget()
    qtbot.addWidget(made)
    made.resize(600, 320)
    return made


def sheet_panel(above: QWidget, sheet: TableContent, touch: Callable[[int], None]) -> TablePanel:
    """The table as it is drawn at 1024x600."""
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), touch, above)
    panel.resize(500, 300)
    panel.show_table(sheet)
    panel.grab()
    return panel


def leaf_keys(panel: Panel) -> list[QRectF]:
    """The two keys, up before down: the places whose press takes how many rows further."""
    panel.grab()
    found = {}
    for box, press, *_ in panel._places:
        if isinstance(press, partial) and press.func.__name__.endswith("_by"):
            found[press.args[0] > 0] = box
    return [found[False], found[True]]


def press(panel: Panel, box: QRectF) -> None:
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    panel.grab()


def turn_wheel(panel: Panel, notches: int) -> None:
    at, none = QPointF(50, 100), QPoint(0, 0)
    wheel = QWheelEvent(
        at, at, none, QPoint(0, -120 * notches), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    panel.wheelEvent(wheel)
    panel.grab()


def chosen_rows(panel: Panel, look_at: Callable[[], int], keys: list[QRectF]) -> set[int]:
    """What a finger comes to that goes down every row, leafs, and does it again to the end."""
    found: set[int] = set()
    for _ in range(MANY):
        panel.grab()
        before = len(found)
        for box, *_ in list(panel._places):
            if box not in keys:
                press(panel, box)
                found.add(look_at())
        if len(found) == before:
            return found
        press(panel, keys[1])
    return found


def test_every_table_row_is_reached_by_touch(above: QWidget) -> None:
    touched: list[int] = []
    panel = sheet_panel(above, sheet_of(MANY), touched.append)
    assert panel.rows < MANY
    assert chosen_rows(panel, lambda: touched[-1], leaf_keys(panel)) == set(range(MANY))


def test_every_requested_program_is_reached_by_touch(above: QWidget, tmp_path: Path) -> None:
    for number in range(MANY):
        (tmp_path / f"p{number:02}.nc").write_text("M30\n")
    taken: list[str] = []

    def choose(name: str) -> bool:
        taken.append(Path(name).name)
        return False

    panel = FilePrompt(
        ScreenTheme(DARK_PALETTE, SMALL), ProgramFolders((tmp_path,)), choose, lambda: None, above
    )
    panel.resize(500, 300)
    panel.show_prompt()
    panel.grab()
    keys = leaf_keys(panel)

    def look() -> int:
        panel.is_not_found = False
        panel.grab()
        return int(taken[-1][1:3])

    assert chosen_rows(panel, look, keys) == set(range(MANY))


@pytest.mark.parametrize("marked", [0, 3])
def test_mouse_wheel_scrolls_without_moving_mark(above: QWidget, marked: int) -> None:
    panel = sheet_panel(above, sheet_of(MANY, marked), lambda _row: None)
    turn_wheel(panel, 100)
    assert panel.first_row == MANY - panel.rows
    turn_wheel(panel, -100)
    assert panel.first_row == 0


def test_key_that_moves_mark_scrolls_it_into_view(above: QWidget) -> None:
    panel = sheet_panel(above, sheet_of(MANY, 2), lambda _row: None)
    turn_wheel(panel, 100)
    panel.show_table(sheet_of(MANY, 3))
    panel.grab()
    assert panel.first_row == 3


def test_opened_letter_pad_does_not_hide_mark(above: QWidget) -> None:
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(500, 300)
    panel.show_table(sheet_of(MANY, 4))
    panel.grab()
    assert panel.first_row == 0
    panel.resize(500, 180)
    panel.grab()
    assert panel.first_row <= 4 < panel.first_row + panel.rows


def test_table_that_fits_has_no_scroll_keys(above: QWidget) -> None:
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(500, 300)
    panel.show_table(sheet_of(3))
    panel.grab()
    assert len(panel._places) == 3
    turn_wheel(panel, 5)
    assert panel.first_row == 0


def test_findings_and_offset_changes_have_scroll_keys(above: QWidget) -> None:
    """There were no keys: the third finding, and the fifth change, were the mouse wheel's alone."""
    findings = FindingList(ScreenTheme(DARK_PALETTE, SMALL), lambda _found: None, above)
    findings.resize(374, 106)  # as at 1024x600
    found = tuple(Diagnostic(n, 1, Severity.ERROR, "unknown", f"finding {n}") for n in range(1, 6))
    findings.show_findings(ProofFindings(diagnostics=found), 1)
    press(findings, leaf_keys(findings)[1])
    assert findings.first_row == findings.rows
    history = ChangeHistoryList(ScreenTheme(DARK_PALETTE, SMALL), above)
    history.resize(500, 220)
    history.history_entries = tuple(("now", f"D{n}", "X", "why") for n in range(MANY))
    press(history, leaf_keys(history)[1])
    assert history.first_row == history.rows


def test_scroll_keys_are_touch_sized(above: QWidget) -> None:
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(500, 300)
    panel.show_table(sheet_of(MANY))
    for box in leaf_keys(panel):
        assert min(box.width(), box.height()) >= FINGERTIP_PX
        assert panel.find_full_area().contains(box)


@pytest.mark.parametrize("wide", [300, 500])
def test_scroll_keys_do_not_cover_rows(above: QWidget, wide: int) -> None:
    """Below the rows of a narrow table, as that of the analyses at 1024x600, beside those of a wide one."""
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(wide, 300)
    panel.show_table(replace(sheet_of(MANY), notes=("one", "two")))
    keys = leaf_keys(panel)
    rows = [box for box, *_ in panel._places if box not in keys]
    assert len(rows) == panel.rows > 1
    assert not [row for row in rows for key in keys if row.intersects(key)]
    assert all(panel.find_full_area().contains(key) for key in keys)


@pytest.mark.parametrize(("count", "high", "fits"), [(8, 80.0, 15), (20, 60.4, 20), (60, 43.0, 28)])
def test_row_height_fills_large_screen_within_limits(
    above: QWidget, count: int, high: float, fits: int
) -> None:
    """96 dots an inch: 9 mm are 34 pixels, a fingertip 43; four units of 20 are 80, and 15 rows of them fit.

    Of 1340 pixels 4 units are the frame's and 2.6 the head's: 1208 are left.
    """
    panel = TablePanel(ScreenTheme(DARK_PALETTE, 20.0), lambda _row: None, above)
    panel.resize(1400, 1340)
    panel.show_table(sheet_of(count))
    panel.grab()
    assert panel._high * 20.0 == pytest.approx(high, abs=1e-3)
    assert panel.rows == fits


def test_scroll_keys_are_side_by_side_in_low_panel(above: QWidget) -> None:
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(500, 110)
    panel.show_table(sheet_of(MANY))
    panel.grab()
    first, second = (box for box, *_ in panel._places[:2])
    assert first.y() == second.y()
    assert first.right() < second.x()
    assert min(first.height(), second.height()) >= FINGERTIP_PX
    press(panel, second)
    assert panel.first_row == 1 == panel.rows


@pytest.mark.parametrize(("high", "rows", "notes"), [(145, 1, 0), (176, 1, 2), (110, 0, 0)])
def test_question_does_not_cover_rows(above: QWidget, high: int, rows: int, notes: int) -> None:
    """145 pixels are what drawn letters leave to a table of the special functions at 1024x600."""
    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _row: None, above)
    panel.resize(640, high)
    panel.show_table(replace(sheet_of(MANY), entry_prompt=wording("screen.whose-name"), notes=("one", "two")))
    drawn: dict[str, QRectF] = {}
    write = ThemedPainter.draw_text_line

    def writing(painter: ThemedPainter, rect: QRectF, text: str, *rest: Any, **more: Any) -> None:
        drawn[text] = QRectF(rect)
        write(painter, rect, text, *rest, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ThemedPainter, "draw_text_line", writing)
        panel.grab()
    assert sum(text.startswith("row ") for text in drawn) == rows == panel.rows
    assert sum(text in {"one", "two"} for text in drawn) == notes
    for text, box in drawn.items():
        assert text == wording("screen.whose-name") or not box.intersects(
            drawn[wording("screen.whose-name")]
        ), text


def test_every_mill_tool_is_reached_by_touch(above: QWidget) -> None:
    """Ten rows of 16 pixels stood there, and what was below them came by the arrows alone."""
    chosen: list[int] = []
    table = SimpleNamespace(
        title="TOOL TABLE", words=("L", "R"), kind=MillToolTable.kind, numbers=tuple(range(1, MANY + 1)),
        columns=("length", "radius"), choose=lambda row, _column: chosen.append(row),
        tone_at=lambda *_: StatusTone.OFF, value_at=lambda *_: "1.0", field_of=lambda _: "",
    )  # fmt: skip
    panel = CellPanel(ScreenTheme(DARK_PALETTE, SMALL), cast("CellTable", table), above)
    panel.resize(500, 300)
    assert chosen_rows(panel, lambda: chosen[-1], leaf_keys(panel)) == set(range(MANY))
    assert all(box.height() >= FINGERTIP_PX for box, *_ in panel._places)


@pytest.mark.parametrize(("wide", "shown"), [(788, 12), (605, 10), (350, 5)])
def test_mill_tool_cells_are_touch_sized_next_to_pad(above: QWidget, wide: int, shown: int) -> None:
    """With twelve columns at 1024x600 that of the teeth had 25 pixels beside the pad."""
    names = (*FIELDS_BY_KIND[MillToolTable.kind], "used")
    chosen: list[int] = []
    table = SimpleNamespace(
        title="TOOL TABLE", words=names, kind=MillToolTable.kind, numbers=(1, 2),
        columns=names, choose=lambda _row, column: chosen.append(column),
        tone_at=lambda *_: StatusTone.OFF, value_at=lambda *_: "1.0", field_of=lambda _: "",
    )  # fmt: skip
    panel = CellPanel(ScreenTheme(DARK_PALETTE, SMALL), cast("CellTable", table), above)
    panel.resize(wide, 150)
    for column in range(len(names)):
        panel.selected_cell = (0, column)
        panel.grab()
        chosen.clear()
        for _box, press, *_ in panel._places:
            press()
        assert column in chosen
        assert len(chosen) == 2 * len(set(chosen)) >= 2 * shown
        assert sorted(set(chosen)) == list(range(min(chosen), max(chosen) + 1))
        assert all(box.width() >= FINGERTIP_PX for box, *_ in panel._places)
    assert len(names) == 12


def test_main_menu_tiles_are_touch_sized(above: QWidget) -> None:
    entries = list_menu_entries("omniturn")
    panel = _MenuTiles(ScreenTheme(DARK_PALETTE, SMALL), lambda _key: None, entries, above)
    panel.resize(858, 360)  # as at 1024x600
    panel.grab()
    assert len(panel._places) == len(entries)
    assert all(box.height() >= FINGERTIP_PX for box, *_ in panel._places)


def test_every_special_function_is_reached_by_touch(above: QWidget) -> None:
    """Their rows had 42 pixels."""
    entered: list[int] = []
    functions = [SimpleNamespace(name=f"FUNCTION {n}", use="what it does") for n in range(MANY)]
    model = SimpleNamespace(functions=functions, at=0, inside=False)
    panel = FunctionListPanel(
        ScreenTheme(DARK_PALETTE, SMALL), cast("SpecialFunctionsModel", model), entered.append, above
    )
    panel.resize(218, 360)  # as at 1024x600
    assert chosen_rows(panel, lambda: entered[-1], leaf_keys(panel)) == set(range(MANY))
    assert all(box.height() >= FINGERTIP_PX for box, *_ in panel._places)
