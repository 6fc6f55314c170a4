"""From the text to the path and back: what a line draws is marked, what is touched names its line."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from tests.screen.editor.writer import Writer
from tests.texts import begins, shows, text

Key = Qt.Key
CTRL = Qt.KeyboardModifier.ControlModifier
# Lines 5 and 6 cut; line 6 is a taper of 1 in along Z that grows by .5 in radius.
PART = "G90G94G72F100\nM03S1000\nT1\nX.5Z.1\nF5Z-1\nX1.5Z-2\nM05\nF200X3\nM30"


@pytest.fixture
def drawn(writer: Writer) -> Writer:
    """In front of a program that is proved and drawn."""
    writer.new("looked")
    writer.write(PART)
    page = writer.editor
    writer.sees(lambda: writer.proved() and page.path_view.has_path)
    assert page.path_view.picture is page.editor.live_proof.current_findings.picture
    return writer


def inch(z: float, diameter: float) -> tuple[float, float]:
    return z * 25.4, diameter * 12.7


def touch(writer: Writer, z: float, diameter: float) -> None:
    """A finger on the path."""
    path = writer.editor.path_view
    pane = path.panes[0]
    at = (pane.area.topLeft() + pane.map_to_pane(*inch(z, diameter))).toPoint()
    QTest.mouseClick(path, Qt.MouseButton.LeftButton, pos=at + QPoint(1, 2))


def test_touch_on_path_moves_cursor_to_its_line(drawn: Writer) -> None:
    touch(drawn, -0.5, 0.5)
    assert drawn.editor.text_field.cursor_line == 5
    touch(drawn, -1.5, 1.0)
    assert drawn.editor.text_field.cursor_line == 6
    assert drawn.editor.text_field.hasFocus()


def test_touch_on_empty_area_does_not_move_cursor(drawn: Writer) -> None:
    line = drawn.editor.text_field.cursor_line
    touch(drawn, -1.0, -1.4)
    assert drawn.editor.text_field.cursor_line == line


def test_path_of_cursor_line_is_highlighted(drawn: Writer) -> None:
    drawn.editor.move_cursor_to(6)
    picture = drawn.editor.path_view.picture
    assert picture is not None
    drawn.sees(
        lambda: drawn.editor.path_view.tip_position.active_block_number == picture.find_block_for_line(6)
    )
    ((start, end),) = drawn.editor.path_view.panes[0].marked_point_ranges
    points = [(picture.z[k], picture.x[k]) for k in range(start - 1, end)]
    assert points == [pytest.approx(inch(-1, 0.5)), pytest.approx(inch(-2, 1.5))]


def test_line_without_moves_highlights_nothing(drawn: Writer) -> None:
    drawn.editor.move_cursor_to(2)
    drawn.sees(
        lambda: not any(len(range(*part)) for part in drawn.editor.path_view.panes[0].marked_point_ranges)
    )


def test_a_taper_is_measured_by_keys(drawn: Writer) -> None:
    drawn.key(Key.Key_M, CTRL)
    path = drawn.editor.path_view
    assert path.measurement is not None
    assert path.hasFocus()
    while path.measurement.cursor[:2] != pytest.approx(inch(-1, 0.5)):
        drawn.key(Key.Key_Tab)
    drawn.key(Key.Key_Return)
    drawn.key(Key.Key_Tab)
    rows = dict(path.measurement.make_value_rows(path.is_metric))
    assert rows["ΔX Ø"] == "1.00000"
    assert rows["ΔX R"] == "0.50000"
    assert rows["ΔZ"] == "−1.00000"
    assert rows["DISTANCE"] == "1.11803"  # the root of 1.25
    assert rows["ANGLE TO Z"] == "26.57°"  # its tangent is a half
    drawn.sees(lambda: drawn.prompt().startswith(text("editor.next-point")))


def test_f3_moves_cursor_to_line_at_cross(drawn: Writer) -> None:
    drawn.editor.move_cursor_to(1)
    drawn.key(Key.Key_M, CTRL)
    path = drawn.editor.path_view
    assert path.measurement is not None
    while path.measurement.cursor[:2] != pytest.approx(inch(-2, 1.5)):
        drawn.key(Key.Key_Tab)
    drawn.key(Key.Key_F3)
    assert drawn.editor.text_field.cursor_line == 6
    assert drawn.editor.text_field.hasFocus()
    assert path.measurement is None


def test_cross_off_path_leads_to_no_line(drawn: Writer) -> None:
    drawn.key(Key.Key_M, CTRL)
    ruler = drawn.editor.path_view.measurement
    assert ruler is not None
    for _ in range(40):
        QTest.keyClick(drawn.editor.path_view, Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    drawn.key(Key.Key_F3)
    drawn.sees(lambda: begins(drawn.prompt(), "editor.cross-on-no-line"))


def test_esc_returns_from_path_view_to_text(drawn: Writer) -> None:
    drawn.key(Key.Key_M, CTRL)
    before = drawn.text()
    drawn.type("xz")  # no letter writes while one looks
    drawn.key(Key.Key_Escape)
    assert drawn.editor.text_field.hasFocus()
    assert drawn.editor.path_view.measurement is None
    assert drawn.text() == before


def test_zoom_keys_work_in_path_view(drawn: Writer) -> None:
    drawn.key(Key.Key_M, CTRL)
    before = drawn.editor.path_view.first_projection
    drawn.key(Key.Key_Z)
    nearer = drawn.editor.path_view.first_projection
    assert before is not None
    assert nearer is not None
    assert nearer.pixels_per_mm > before.pixels_per_mm
    drawn.key(Key.Key_Right, CTRL)
    assert drawn.editor.path_view.first_projection != nearer
    drawn.key(Key.Key_F5)
    assert drawn.editor.path_view.first_projection == before


def test_path_view_without_path_shows_message(writer: Writer) -> None:
    writer.new("empty")
    writer.key(Key.Key_M, CTRL)
    writer.sees(lambda: shows(writer.prompt(), "editor.no-path-yet"))
    assert writer.editor.path_view.measurement is None
