"""Shapes by keys and by fingers in the editor: written, proved while they are typed, opened again."""

from __future__ import annotations

from typing import Any

import pytest
from PySide6.QtCore import QEvent, QPoint, QRectF, Qt
from PySide6.QtGui import QImage, QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.editor.editor_modes import EditorMode
from app.extras.shapes import shapes_view
from app.extras.shapes.shapes_view import ShapeLinesPanel, ShapeRowsPanel, _Line
from app.screen.color_palettes import DARK_PALETTE
from app.screen.panel import Panel
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from tests.extras.shapes.screen.panel import shapes_of
from tests.screen.editor.writer import Writer
from tests.screen.hands import Key
from tests.texts import begins, shows
from tests.texts import text as wording

SHIFT = Qt.KeyboardModifier.ShiftModifier
ROWS = 2  # places before those of the rows, where not all of them fit: the keys that leaf


def opened(writer: Writer) -> Writer:
    """In front of the list of shapes of a new program."""
    writer.new("shaped")
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: writer.editor.mode is EditorMode.PANEL)
    return writer


def touch(writer: Writer, panel: Panel, place: int) -> None:
    writer.sees(lambda: len(panel._places) > place)
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=panel._places[place][0].center().toPoint())


def drilled(writer: Writer) -> Writer:
    """A head and a hole, written by forms."""
    opened(writer).type("n")
    writer.key(Key.Key_F2)
    writer.type("d.25")
    writer.key(Key.Key_Return)
    writer.type(".6")
    writer.key(Key.Key_F2)
    writer.sees(lambda: "G81Z-.6" in writer.text())
    return writer


def test_hole_is_written_and_can_be_undone_in_one_step(writer: Writer) -> None:
    drilled(writer)
    assert writer.text().splitlines()[-1] == "M30"
    writer.key(Key.Key_F10)
    assert writer.editor.mode is EditorMode.TEXT
    writer.key(Key.Key_F8)
    assert "G81" not in writer.text()
    assert writer.text().startswith("G90G94F300G72(HEAD")


def test_displayed_path_follows_every_key(writer: Writer) -> None:
    """Before anything is written: the text that is proved is the one that the form would make."""
    opened(writer).type("n")
    writer.key(Key.Key_F2)
    writer.type("d.25")
    writer.key(Key.Key_Return)
    writer.type(".6")

    def deepest() -> float:
        picture = writer.editor.editor.live_proof.current_findings.picture
        return min(picture.z, default=0.0) if picture is not None else 0.0

    writer.sees(lambda: abs(deepest() + 0.6 * 25.4) < 1e-6)
    writer.type("5")
    writer.sees(lambda: abs(deepest() + 0.65 * 25.4) < 1e-6)
    assert "G81" not in writer.text()
    writer.key(Key.Key_Escape)
    writer.key(Key.Key_Escape)
    writer.sees(lambda: writer.editor.mode is EditorMode.TEXT and not deepest())


def test_error_is_shown_and_the_text_is_unchanged(writer: Writer) -> None:
    opened(writer).type("n")
    writer.key(Key.Key_F2)
    before = writer.text()
    writer.type("d.25")
    writer.key(Key.Key_Return)
    writer.type("9")
    writer.key(Key.Key_Down)
    writer.key(Key.Key_Down)
    writer.type("0")
    writer.key(Key.Key_F2)
    assert shows(writer.editor.prompt_text(), "shapes.peck-too-deep")
    assert writer.text() == before


def test_shape_at_the_cursor_is_opened(writer: Writer) -> None:
    drilled(writer)
    writer.key(Key.Key_F10)
    writer.editor.move_cursor_to(5)
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: writer.editor.mode is EditorMode.PANEL)
    form = shapes_of(writer).model.form
    assert form is not None
    assert form.entered_texts["DEEP"] == ".6"


def test_manually_changed_lines_are_overwritten_only_on_request(writer: Writer) -> None:
    drilled(writer)
    writer.key(Key.Key_F10)
    writer.editor.move_cursor_to(6)
    writer.write("G04F2\n")
    changed = writer.text()
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: writer.editor.mode is EditorMode.PANEL)
    assert shows(writer.editor.prompt_text(), "shapes.line-changed-by-hand")
    writer.key(Key.Key_F2)
    assert writer.text() == changed
    assert shows(writer.editor.prompt_text(), "shapes.replaces-changed-lines")
    writer.key(Key.Key_F6)
    writer.sees(lambda: "G04F2" not in writer.text())


def test_shape_is_opened_filled_in_and_written_by_touch(writer: Writer) -> None:
    opened(writer)
    touch(writer, shapes_of(writer).rows_panel, ROWS)
    writer.sees(lambda: shapes_of(writer).model.form is not None)
    writer.key(Key.Key_F2)
    writer.sees(lambda: writer.text().startswith("G90"))
    writer.type("d")
    writer.sees(lambda: len(shapes_of(writer).rows_panel.displayed_rows) > 4)
    writer.key(Key.Key_F9)
    writer.sees(shapes_of(writer).number_pad.isVisible)
    touch(writer, shapes_of(writer).number_pad, 2)
    form = shapes_of(writer).model.form
    assert form is not None
    assert form.entered_texts == {"DIA": "9"}


def test_estop_key_works_in_the_shape_form(writer: Writer) -> None:
    opened(writer)
    press = QKeyEvent(QEvent.Type.KeyPress, Key.Key_ScrollLock, Qt.KeyboardModifier.NoModifier)
    stop = writer.window.keyboard_filter._find_stop(press)
    assert stop is not None
    stop(press=0)
    assert writer.desk.station_controls.is_estop_pressed
    assert shapes_of(writer).model.form is None


def test_unsupported_language_offers_no_shapes(writer: Writer) -> None:
    writer.new("other.h")
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: shows(writer.editor.prompt_text(), "shapes.no-shapes-in-language"))
    assert writer.editor.mode is EditorMode.TEXT
    writer.editor.show_text()
    assert [key.name for key in writer.editor.head_line.panel_keys] == ["Calculators"]


def test_rows_and_keys_are_large_enough_for_touch_at_1024x600(writer: Writer) -> None:
    writer.window.resize(1024, 600)
    opened(writer).type("n")
    view = shapes_of(writer)
    writer.key(Key.Key_F9)
    writer.sees(lambda: view.number_pad.isVisible() and len(view.number_pad._places) == 20)
    assert not view.sketch_panel.isVisible()  # under the keys there is no room for it
    for panel in (view.rows_panel, view.number_pad):
        panel.grab()
        for box, *_ in panel._places:
            assert min(box.width(), box.height()) >= FINGERTIP_PX - 1
            assert panel.find_full_area().contains(box)
    writer.key(Key.Key_F9)
    writer.sees(view.sketch_panel.isVisible)
    view.sketch_panel.grab()
    assert view.sketch_panel._places
    for box, *_ in view.sketch_panel._places:
        assert min(box.width(), box.height()) >= FINGERTIP_PX
        assert view.sketch_panel.find_full_area().contains(box)


def test_touch_targets_over_the_text_open_their_function(writer: Writer) -> None:
    writer.new("shaped")
    head = writer.editor.head_line
    head.grab()
    keyboard, shapes, sums = range(3)
    assert len({box.x() for box, *_ in head._places}) == len(head._places) == 3
    touch(writer, head, shapes)
    assert (writer.editor.mode, shapes_of(writer).model.is_listing_shapes) == (EditorMode.PANEL, True)
    shapes_of(writer).refresh()
    assert shapes_of(writer).rows_panel.heading.startswith("SHAPES")
    touch(writer, head, shapes)
    assert writer.editor.mode is EditorMode.TEXT
    touch(writer, head, sums)
    assert (writer.editor.mode, shapes_of(writer).model.is_listing_shapes) == (EditorMode.PANEL, False)
    shapes_of(writer).refresh()  # the list of before stood there, and another form was opened by a touch
    assert shapes_of(writer).rows_panel.heading == wording("shapes.calculators")
    assert "TRIANGLE" in shapes_of(writer).rows_panel.displayed_rows[0].label
    assert begins(shapes_of(writer).model.prompt_text(), "shapes.calculators-prompt")
    touch(writer, head, shapes)
    touch(writer, head, keyboard)
    assert writer.editor.is_keyboard_shown


def test_truncated_text_is_scrolled_by_touch(qtbot: QtBot) -> None:
    above = QWidget()
    qtbot.addWidget(above)
    panel = ShapeLinesPanel(ScreenTheme(DARK_PALETTE, 6.4), above)
    panel.resize(180, 110)
    panel.remarks = ("the nose leaves metal there " * 20,)

    def turned() -> QImage:
        QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=QPoint(60, 40))
        return panel.grab().toImage()

    first = panel.grab().toImage()
    pages = [turned() for _ in range(40)]
    assert pages[0] != first
    assert first in pages  # behind the last page stands the first
    panel.remarks = ("short",)
    assert panel.grab().toImage() == turned()


def test_shape_list_is_one_key_from_a_form(writer: Writer) -> None:
    """A finger has no Esc: from the form that the cursor opened, other shapes were behind the number pad."""
    drilled(writer)
    writer.key(Key.Key_F10)
    writer.editor.move_cursor_to(5)
    before = writer.text()
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: shapes_of(writer).model.form is not None)
    writer.type("9")
    assert writer.frame.key_bar.key_labels[7] == "LIST" or writer.editor.make_key_labels()[7] == "LIST"
    writer.key(Key.Key_F8)
    assert shapes_of(writer).model.is_list_shown
    assert writer.text() == before


def test_long_labels_wrap_to_two_lines_and_are_not_cut(qtbot: QtBot) -> None:
    above = QWidget()
    qtbot.addWidget(above)
    look = ScreenTheme(DARK_PALETTE, 6.4)
    look.is_caret_shown = True
    panel = ShapeRowsPanel(look, lambda _row, _column: None, above)
    panel.resize(260, 300)  # as at 1024x600
    drawn: list[str] = []
    write = ThemedPainter.draw_text_line

    def writing(painter: ThemedPainter, rect: QRectF, text: str, *rest: Any, **more: Any) -> None:
        drawn.append(text)
        write(painter, rect, text, *rest, **more)

    panel.displayed_rows = (_Line(wording("shapes.wall-leans"), "0"), _Line("TOOL", "1"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ThemedPainter, "draw_text_line", writing)
        panel.grab()
    assert wording("shapes.wall-leans") not in drawn
    first = next(n for n, text in enumerate(drawn) if text.startswith("SLOPE"))
    assert f"{drawn[first]} {drawn[first + 1]}" == wording("shapes.wall-leans")
    assert "TOOL" in drawn


def test_unset_and_choice_values_are_not_drawn_as_typed_text(qtbot: QtBot) -> None:
    """A question mark stood in the entry as if somebody had typed it, and a bar behind a choice."""
    above = QWidget()
    qtbot.addWidget(above)
    look = ScreenTheme(DARK_PALETTE, 6.4)
    look.is_caret_shown = True
    panel = ShapeRowsPanel(look, lambda _row, _column: None, above)
    panel.resize(260, 300)
    panel.is_entry_open = True

    def image(figure: str) -> QImage:
        panel.displayed_rows = (_Line("DIAMETER", figure),)
        return panel.grab().toImage()

    assert image("?") == image("")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shapes_view, "_TURN", "none")
        typed = image("◂ INCH ▸")
    panel.displayed_rows = ()
    assert image("◂ INCH ▸") != typed


def test_remarks_leave_no_half_visible_program_line(qtbot: QtBot) -> None:
    above = QWidget()
    qtbot.addWidget(above)
    panel = ShapeLinesPanel(ScreenTheme(DARK_PALETTE, 6.4), above)
    panel.resize(180, 110)
    panel.remarks = ("the nose leaves metal there " * 20,)
    without = panel.grab().toImage()
    panel.displayed_lines = ("T1", "M03S750")
    assert panel.grab().toImage() == without


def test_the_heading_counts_the_lines_of_the_text_that_is_proved(writer: Writer) -> None:
    drilled(writer)
    writer.sees(lambda: bool(shapes_of(writer).model.is_list_shown))
    count = len(shapes_of(writer).model.text.splitlines())
    writer.type("f.5")
    form = shapes_of(writer).model.form
    assert form is not None
    written = count + len(form.program_lines) + 1
    writer.sees(lambda: f" OF {written} " in writer.editor.head_line.heading.cursor_position)
