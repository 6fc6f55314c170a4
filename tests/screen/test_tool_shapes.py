"""The page of a tool's shape: by keys, by fingers alone, in both sizes and languages, and what it draws."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.offsets.tool_offsets_view import ToolShapePage, ToolShapePanel
from app.screen import page_table
from app.screen.entry_panel import NumberPad
from app.screen.panel import Panel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import MachineState
from core.store.store import Store
from core.store.store_rows import ToolShapeRow
from tests.offset_store import use_store
from tests.screen.hands import Hands, Key
from tests.screen.yes import yes
from tests.texts import begins, text

LIMIT = 60.0


@pytest.fixture
def store(hands: Hands, tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "home") as store:
        store.offsets.tool_offsets.change_row(
            1, "set", {"x": -12.7, "z": -76.2, "nose_radius": 0.79375, "quadrant": 3}
        )
        store.offsets.tool_shapes.change_row(1, "set", {"kind": "turning", "insert": "CNMG432"})
        store.offsets.tool_offsets.change_row(2, "set", {"x": 25.4, "z": -50.8}).result(LIMIT)
        use_store(hands.desk, store)
        yield store


def opened(hands: Hands, number: int = 1) -> ToolShapePage:
    """F8, down to the tool, F8."""
    hands.key(Key.Key_F8)
    for _ in range(number - 1):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_F8)
    page = hands.frame.current_page
    assert isinstance(page, ToolShapePage)
    assert hands.frame.title_line.page_title == page_table.SHAPE
    return page


def touch(hands: Hands, panel: Panel, place: int) -> None:
    """A finger in the middle of a place, which is large enough for one; then what is shown now."""
    hands.window.grab()
    box, *_ = panel._places[place]
    assert isinstance(panel, NumberPad) or min(box.width(), box.height()) >= FINGERTIP_PX
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=QPoint(*map(int, box.center().toTuple())))
    hands.window.grab()


def colours(hands: Hands, table: ToolShapePanel) -> set[str]:
    """What colours the right half, the picture, has."""
    image = table.grab().toImage()
    wide, high = image.width(), image.height()
    return {image.pixelColor(x, y).name() for x in range(wide * 2 // 3, wide) for y in range(high)}


def test_shape_page_opens_for_tool_under_cursor_and_returns(hands: Hands, store: Store) -> None:
    page = opened(hands, 2)
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == "T2  KIND?")
    hands.key(Key.Key_F8)
    assert hands.frame.title_line.page_title == page_table.TOOLS
    hands.key(Key.Key_F8)
    assert page.model.tool_number == 2
    hands.key(Key.Key_Escape)
    assert hands.frame.title_line.page_title == page_table.TOOLS
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is hands.page


def test_new_shape_is_entered_by_keyboard_only(hands: Hands, store: Store) -> None:
    page = opened(hands, 2)
    hands.key(Key.Key_Right)
    hands.key(Key.Key_Return)
    hands.sees(lambda: 2 in page.model.offset_book.tool_shapes)
    hands.sees(lambda: hands.prompt() == text("screen.saved", names="T2"))
    for _ in range(4):
        hands.key(Key.Key_Down)
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == "T2  INSERT?")
    hands.key(Key.Key_Return)
    hands.type("DCMT 11T304")
    hands.key(Key.Key_Return)
    hands.sees(
        lambda: store.offsets.tool_shapes.read_rows()[2] == ToolShapeRow("turning", insert="DCMT 11T304")
    )


def test_letters_in_open_text_field_are_not_commands(hands: Hands, store: Store) -> None:
    """H holds, E stops, C and D mean something too: here they are letters."""
    page = opened(hands)
    for _ in range(5):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.machine.posted.clear()
    hands.type("the old one")
    assert page.model.text == "the old one".upper() or page.model.text == "the old one"
    assert hands.machine.posted == []
    hands.key(Key.Key_Escape)
    assert (page.model.text, hands.frame.current_page) == ("", page)
    assert store.offsets.tool_shapes.read_rows()[1].holder == ""


def test_drill_shape_is_entered_by_touch_only(hands: Hands, store: Store) -> None:
    page = opened(hands, 2)
    enter, point, two, five = 19, 13, 9, 5  # places on the pad, row by row
    for _ in range(6):
        touch(hands, page.content_panel, 0)
    assert page.model.entered_text == "DRILL"
    touch(hands, page.number_pad, enter)
    hands.sees(lambda: page.model.shape_row == ToolShapeRow("drill") and not page.model.offset_book.is_saving)
    hands.sees(lambda: len(page.model.field_names) == 7)
    touch(hands, page.content_panel, 2)
    for key in (point, two, five, enter):
        touch(hands, page.number_pad, key)
    hands.sees(lambda: store.offsets.tool_shapes.read_rows()[2].diameter == pytest.approx(6.35))


def test_every_field_is_touch_sized(hands: Hands, store: Store) -> None:
    store.offsets.tool_shapes.change_row(1, "set", {"kind": "threading"}).result(LIMIT)
    hands.desk.offset_book.read_store()
    page = opened(hands)
    for place in reversed(range(1, len(page.model.field_names))):
        touch(hands, page.content_panel, place)
        assert page.model.field_index == place


@pytest.mark.parametrize("size", [(1024, 600), (1920, 1080)])
def test_outline_and_control_point_are_drawn(hands: Hands, store: Store, size: tuple[int, int]) -> None:
    hands.window.resize(*size)
    page = opened(hands)
    hands.window.grab()
    look = hands.window.theme
    drawn = colours(hands, page.content_panel)
    assert {look.get_color(name).name() for name in ("accent", "ghost", "tip")} <= drawn
    hands.key(Key.Key_PageDown)
    hands.sees(lambda: page.model.tool_number == 2)
    hands.window.refresh()
    assert look.get_color("ghost").name() not in colours(hands, page.content_panel)


def test_invalid_shape_is_reported_and_not_drawn(hands: Hands, store: Store) -> None:
    store.offsets.tool_shapes.change_row(1, "set", {"kind": "drill"}).result(LIMIT)
    hands.desk.offset_book.read_store()
    page = opened(hands)
    hands.sees(lambda: hands.prompt().startswith(f"T1: {text('screen.tip-not-round', tip=3)}"))
    hands.window.refresh()
    assert hands.window.theme.get_color("ghost").name() not in colours(hands, page.content_panel)
    assert hands.window.theme.get_color("alarm").name() in colours(hands, page.content_panel)


def test_f3_asks_before_deleting_shape(hands: Hands, store: Store) -> None:
    page = opened(hands)
    hands.key(Key.Key_F3)
    assert hands.prompt() == text("screen.forget-shape", number=1)
    hands.key(Key.Key_Escape)
    assert 1 in store.offsets.tool_shapes.read_rows()
    hands.key(Key.Key_F3)
    yes(hands.window)
    hands.sees(lambda: page.model.shape_row is None)
    hands.key(Key.Key_F4)
    yes(hands.window)
    hands.sees(lambda: page.model.shape_row == ToolShapeRow("turning", insert="CNMG432"))


def test_history_shows_changed_fields(hands: Hands, store: Store) -> None:
    store.offsets.tool_shapes.change_row(1, "sharper", {"insert": "CNMG431"}).result(LIMIT)
    page = opened(hands)
    hands.key(Key.Key_F5)
    hands.sees(page.history_list.isVisible)
    assert [entry[2] for entry in page.history_list.history_entries] == [
        "INSERT CNMG432 → CNMG431",
        "not set  →  TURNING  RIGHT HAND  INSERT CNMG432",
    ]


def test_shape_cannot_be_changed_while_program_runs(hands: Hands, store: Store) -> None:
    opened(hands)
    hands.machine.now = replace(hands.machine.now, state=MachineState.RUN)
    hands.sees(lambda: begins(hands.prompt(), "screen.program-runs-wear-only"))
    hands.key(Key.Key_Right)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_F4)
    assert len(store.offsets.tool_shapes.read_history()) == 1


def test_change_without_store_shows_reason(hands: Hands) -> None:
    opened(hands)
    hands.key(Key.Key_Right)
    hands.key(Key.Key_Return)
    hands.sees(lambda: hands.prompt() == text("screen.no-offsets-kept"))


def test_rejection_is_shown_in_spanish(hands: Hands, store: Store) -> None:
    hands.desk.settings_store.choose("language", "es")
    page = opened(hands)
    for _ in range(4):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Delete)
    hands.type("CNXG 432")
    hands.key(Key.Key_Return)
    told = hands.frame.prompt_line.main_text
    assert "CNXG 432" in told
    assert page.model.text == "CNXG 432"
