"""Measuring in the path view by keys and by pointer, other panes, two pictures compared, a way back."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPointingDevice
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.path.measuring import SnapPoint, SnapPointKind
from app.path.path_aspects import ApproachLeg, PathViewKind, TipPosition
from app.path.path_marks_view import make_leg_labels
from app.path.path_picture import PictureBuilder, ProgramPicture
from app.path.path_view import PathView
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from core.executor.snapshot import MachineState
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from tests.path.made import turned
from tests.screen.colours import apart
from tests.screen.hands import LIMIT, Hands

Key = Qt.Key
SHIFT = Qt.KeyboardModifier.ShiftModifier
METRIC = ModalState(spindle=1, metric=True)
FOUND: list[int] = []  # blocks whose lines were touched
SHAFT = [(10.0, 2.0), (5.0, 0.0), (5.0, -20.0), (8.0, -20.0)]  # (x, z)


def picture(corners: list[tuple[float, float]], *more: Block) -> ProgramPicture:
    sketch = PictureBuilder()
    pairs = list(itertools.pairwise(corners))
    for n, ((x0, z0), (x, z)) in enumerate(pairs, 1):
        kind = BlockKind.RAPID if n == 1 else BlockKind.FEED
        sketch.add_block(Block(n, n, kind, "", x0, z0, 0, x, z, 0, 0, 0, METRIC), float(n))
    for number, block in enumerate(more, len(pairs) + 1):
        sketch.add_block(block, float(number))
    return sketch.build_picture()


def slot() -> ProgramPicture:
    """A shaft with a slot round it and a flat before it."""
    return picture(
        SHAFT,
        turned(4, BlockKind.FEED, (-5, -2, 0), (-5, -8, 90)),
        turned(5, BlockKind.FEED, (-5, -8, 90), (-3, -8, 180)),
    )


@pytest.fixture
def view(qtbot: QtBot) -> Iterator[PathView]:
    """A path view of its own, with a program."""
    FOUND.clear()
    made = PathView(ScreenTheme(DARK_PALETTE, 12.0), on_picked=FOUND.append)
    made.resize(800, 500)
    with qtbot.waitExposed(made, timeout=LIMIT):
        made.show()
    made.activateWindow()
    made.show_picture(picture(SHAFT))
    settle(made)
    yield made
    made.hide()
    made.deleteLater()


def settle(view: PathView) -> QImage:
    for _ in range(20):
        view.continue_drawing()
    return view.grab().toImage()


def on_widget(view: PathView, z: float, x: float, pane: int = 0) -> QPoint:
    it = view.panes[pane]
    return (it.area.topLeft() + it.map_to_pane(z, x)).toPoint()


def press(view: PathView, *keys: Key) -> None:
    for key in keys:
        QTest.keyClick(view, key)


def test_path_is_measured_by_keyboard_only(view: PathView) -> None:
    view.switch_measuring()
    ruler = view.measurement
    assert ruler is not None
    ruler.cursor = SnapPoint(0.0, 5.0, SnapPointKind.END)
    press(view, Key.Key_Return, Key.Key_Left)
    assert ruler.cursor == SnapPoint(-20.0, 5.0, SnapPointKind.END)
    press(view, Key.Key_Down, Key.Key_Return)
    assert (ruler.first_point, ruler.second_point) == (
        SnapPoint(0, 5, SnapPointKind.END),
        SnapPoint(-20, 8, SnapPointKind.END),
    )
    rows = dict(ruler.make_value_rows(view.is_metric))
    assert (rows["ΔX Ø"], rows["ΔX R"], rows["ΔZ"]) == ("6.0000", "3.0000", "−20.0000")
    press(view, Key.Key_Backspace)
    assert ruler.first_point is None


def test_tab_moves_cross_along_path(view: PathView) -> None:
    view.switch_measuring()
    assert view.measurement is not None
    view.measurement.cursor = SnapPoint(2.0, 10.0, SnapPointKind.END)
    press(view, Key.Key_Tab, Key.Key_Tab)
    assert view.measurement.cursor[:2] == (-20.0, 5.0)
    QTest.keyClick(view, Key.Key_Tab, SHIFT)
    assert view.measurement.cursor[:2] == (0.0, 5.0)


def test_shift_moves_cross_by_one_pixel_without_snapping(view: PathView) -> None:
    view.switch_measuring()
    assert view.measurement is not None
    view.measurement.cursor = SnapPoint(0.0, 5.0, SnapPointKind.END)
    QTest.keyClick(view, Key.Key_Right, SHIFT)
    assert view.measurement.cursor.kind is SnapPointKind.FREE
    assert view.measurement.cursor.z == pytest.approx(view.panes[0].pixel_size_mm)


def test_pointer_snaps_to_corner(view: PathView) -> None:
    view.switch_measuring()
    for z, x in ((0.0, 5.0), (-20.0, 5.0)):
        QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, z, x) + QPoint(4, -3))
    assert view.measurement is not None
    assert (view.measurement.first_point, view.measurement.second_point) == (
        SnapPoint(0, 5, SnapPointKind.END),
        SnapPoint(-20, 5, SnapPointKind.END),
    )


def test_cross_remains_visible_after_zoom(view: PathView) -> None:
    view.zoom_view(12)
    view.switch_measuring()
    assert view.measurement is not None
    for _ in range(4):
        press(view, Key.Key_Tab)
        pane = view.panes[0]
        z0, z1, x0, x1 = pane.find_visible_area()
        assert z0 < view.measurement.cursor.z < z1
        assert x0 < view.measurement.cursor.x < x1


def test_another_program_ends_measuring(view: PathView) -> None:
    view.switch_measuring()
    view.show_picture(picture(SHAFT))
    assert view.measurement is None


def test_measuring_does_not_start_without_program(view: PathView) -> None:
    view.show_picture(None)
    view.switch_measuring()
    assert view.measurement is None


def test_a_touched_line_names_its_block_and_a_drag_does_not(view: PathView) -> None:
    found = FOUND
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, -9.0, 5.0))
    assert found == [2]
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, -9.0, -9.0))
    assert found == [2]  # nothing is drawn there
    before = view.first_projection
    at = QPointF(on_widget(view, -9.0, 5.0))
    for kind, to in (
        (QEvent.Type.MouseButtonPress, at),
        (QEvent.Type.MouseMove, at + QPointF(60, 0)),
        (QEvent.Type.MouseButtonRelease, at + QPointF(60, 0)),
    ):
        button = Qt.MouseButton.LeftButton
        event = QMouseEvent(kind, to, to, button, button, Qt.KeyboardModifier.NoModifier)
        QApplication.sendEvent(view, event)
    assert found == [2]
    assert view.first_projection != before


def fingers(view: PathView, device: QPointingDevice, act: str, *places: tuple[int, int]) -> None:
    """Put fingers down, move them, or lift them."""
    with_all = QTest.touchEvent(view, device, False)
    for number, place in enumerate(places):
        getattr(with_all, act)(number, QPoint(*place), view)
    with_all.commit()


def test_two_finger_spread_zooms_and_selects_nothing(view: PathView) -> None:
    device = QTest.createTouchDevice()
    before = view.first_projection
    assert before is not None
    fingers(view, device, "press", (380, 250), (420, 250))
    for far in (10, 20, 30, 40):
        fingers(view, device, "move", (380 - far, 250), (420 + far, 250))
    fingers(view, device, "release", (340, 250), (460, 250))
    assert view.first_projection is not None
    assert view.first_projection.pixels_per_mm == pytest.approx(
        3 * before.pixels_per_mm
    )  # from 40 pixels to 120
    assert FOUND == []


def test_single_touch_drags_view_and_selects_line(view: PathView) -> None:
    device = QTest.createTouchDevice()
    at = on_widget(view, -9.0, 5.0)
    fingers(view, device, "press", (at.x(), at.y()))
    fingers(view, device, "release", (at.x(), at.y()))
    assert FOUND == [2]
    before = view.first_projection
    assert before is not None
    fingers(view, device, "press", (at.x(), at.y()))
    for far in (20, 40):
        fingers(view, device, "move", (at.x() + far, at.y()))
    fingers(view, device, "release", (at.x() + 40, at.y()))
    assert FOUND == [2]
    assert view.first_projection == before.shift(40, 0)


def test_face_and_side_views_appear_for_programs_that_use_them(view: PathView) -> None:
    assert [pane.aspect for pane in view.panes] == [PathViewKind.PATH]
    view.select_next_view()
    assert [pane.aspect for pane in view.panes] == [PathViewKind.PATH]
    view.show_picture(slot())
    seen = []
    for _ in range(6):
        seen.append(tuple(pane.aspect.value for pane in view.panes))
        settle(view)
        view.select_next_view()
    assert seen == [("PATH", "FACE"), ("PATH", "SIDE"), ("FACE",), ("SIDE",), ("PATH",), ("PATH", "FACE")]


def test_tip_is_projected_to_face_and_side_views(view: PathView) -> None:
    view.show_picture(slot())
    view.show_tool_tip(TipPosition(4, -5.0, -5.0, c=90.0))
    path, face = view.panes
    tip = TipPosition(4, -5.0, -5.0, c=90.0)
    assert path.find_tip_position(tip) == (-5.0, -5.0)
    assert face.find_tip_position(tip) == pytest.approx((0.0, 5.0), abs=1e-9)
    view.select_next_view()
    _path, side = view.panes
    assert side.find_tip_position(tip) == pytest.approx((-5.0, -90 * side.polyline.mm_per_degree))
    assert side.find_tip_position(TipPosition(4, 1.0, 2.0)) == pytest.approx(
        (-5.0, -90 * side.polyline.mm_per_degree)
    )  # C is let go


def test_measuring_on_face_shows_x_y_and_r(view: PathView) -> None:
    view.show_picture(slot())
    view.switch_measuring()
    assert view.measurement is not None
    assert view.measurement.pane.aspect is PathViewKind.FACE
    assert [name for name, _figure in view.measurement.make_value_rows(True)] == ["X", "Y", "R"]


def drawn_in(colour: str, image: QImage, view: PathView, spots: list[tuple[float, float]]) -> bool:
    """Whether there is a pixel of about that colour near some points of the first pane."""
    wanted = QColor(colour)
    for z, x in spots:
        at = on_widget(view, z, x)
        for step in range(49):
            seen = image.pixelColor(at.x() + step % 7 - 3, at.y() + step // 7 - 3)
            if apart(seen, wanted) < 90:  # smoothing mixes them
                return True
    return False


def test_comparison_draws_path_before_and_after(view: PathView) -> None:
    wider = picture([(12.0, 2.0), (7.0, 0.0), (7.0, -20.0), (9.0, -20.0)])
    view.show_comparison(picture(SHAFT), wider)
    image = settle(view)
    assert view.is_comparing
    assert drawn_in(DARK_PALETTE.accent, image, view, [(-3.0, 7.0), (-3.5, 7.0)])
    assert drawn_in(DARK_PALETTE.mark, image, view, [(-3.0 - k / 10, 5.0) for k in range(12)])
    assert not drawn_in(DARK_PALETTE.tip, image, view, [(0.0, 0.0)])  # no tool stands in a comparison


def test_zoom_in_comparison_centers_on_farthest_change(view: PathView) -> None:
    view.show_comparison(picture(SHAFT), picture([(10.0, 2.0), (5.0, 0.0), (5.0, -20.0), (8.004, -20.003)]))
    apart = view.panes[0].largest_distance
    assert apart is not None
    assert apart.distance_mm == pytest.approx(0.005)
    view.zoom_view(20)
    z0, z1, x0, x1 = view.panes[0].find_visible_area()
    assert z0 < -20.003 < z1
    assert x0 < 8.004 < x1
    settle(view)


def test_tool_is_drawn_only_if_tip_position_is_known(view: PathView) -> None:
    assert not drawn_in(DARK_PALETTE.tip, settle(view), view, [(0.0, 0.0)])
    view.show_tool_tip(TipPosition(0, 0.0, 0.0))
    assert drawn_in(DARK_PALETTE.tip, settle(view), view, [(0.0, 0.0)])


def test_comparison_fits_both_pictures(view: PathView) -> None:
    view.show_comparison(picture([(40.0, 2.0), (40.0, -60.0)]), picture(SHAFT))
    z0, z1, x0, x1 = view.panes[0].find_visible_area()
    assert z0 < -60
    assert z1 > 2
    assert x0 < -40
    assert x1 > 40


def test_next_picture_ends_comparison(view: PathView) -> None:
    view.show_comparison(picture(SHAFT), picture(SHAFT))
    view.show_picture(picture(SHAFT))
    assert not view.is_comparing
    view.show_comparison(None, picture(SHAFT))
    assert not view.is_comparing


def test_whole_approach_is_visible_unless_view_was_moved(view: PathView) -> None:
    view.shows_whole_approach = True
    before = view.first_projection
    view.show_approach(
        [ApproachLeg(60.0, 40.0), ApproachLeg(60.0, 8.0, label="1 X"), ApproachLeg(-5.0, 8.0, label="2 Z")]
    )
    _z0, z1, _x0, x1 = view.panes[0].find_visible_area()
    assert z1 > 60
    assert x1 > 40
    view.show_approach(None)
    assert view.first_projection == before
    view.zoom_view(2)
    near = view.first_projection
    view.show_approach([ApproachLeg(60.0, 40.0), ApproachLeg(60.0, 8.0)])
    assert view.first_projection == near
    view.fit_all_panes()
    assert view.panes[0].find_visible_area()[1] > 60


def test_approach_is_drawn_and_removed(view: PathView) -> None:
    legs = [
        ApproachLeg(10.0, 12.0),
        ApproachLeg(10.0, 8.0, label="1 X"),
        ApproachLeg(-5.0, 8.0, is_rapid=False, label="2 Z"),
    ]
    view.fit_all_panes()
    view.zoom_view(-3)
    plain = settle(view)
    view.show_approach(legs)
    image = settle(view)
    # beside the label, on the solid leg
    assert drawn_in(DARK_PALETTE.lit, image, view, [(-3.0, 8.0)])
    assert not drawn_in(DARK_PALETTE.lit, plain, view, [(-3.0, 8.0)])
    view.show_approach(None)
    assert settle(view) == plain


def test_overlapping_approach_legs_have_one_label(view: PathView) -> None:
    """A short way beside a long one: no number hides another."""
    spots = [QPointF(300.0, 50.0), QPointF(100.0, 50.0), QPointF(104.0, 52.0), QPointF(98.0, 49.0)]
    one, rest = make_leg_labels(view.theme, spots, ["1 X", "2 Z", "3 X", "4 XZ"])
    assert (one[1], rest[1]) == ("1 X", "2–4")
    assert rest[0].center() == spots[1]
    assert not one[0].intersects(rest[0])
    assert [text for _, text in make_leg_labels(view.theme, spots[:3], ["1 X", "", "3 X"])] == ["1 X", "3 X"]


def test_measuring_keys_work_on_automatic_page(hands: Hands) -> None:
    hands.load("bushing")
    path = hands.page.path_view
    hands.sees(lambda: path.first_projection is not None)
    hands.key(Key.Key_M)
    assert path.measurement is not None
    before = path.measurement.cursor
    hands.key(Key.Key_Left)
    hands.key(Key.Key_Return)
    assert path.measurement.first_point is not None
    assert path.measurement.cursor != before
    hands.key(Key.Key_Escape)
    assert path.measurement is None
    assert hands.window.hasFocus()


def test_machine_keys_remain_active_while_measuring(hands: Hands) -> None:
    hands.load("bushing")
    hands.sees(lambda: hands.page.path_view.first_projection is not None)
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    hands.key(Key.Key_M)
    assert hands.page.path_view.measurement is not None
    hands.key(Key.Key_Escape)  # something moves: the safe thing first
    hands.sees_state(MachineState.HOLD)
    assert hands.page.path_view.measurement is not None
    hands.key(Key.Key_S)
    assert hands.desk.read_snapshot().single_block
    hands.key(Key.Key_M)
    assert hands.page.path_view.measurement is None
