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

from app.path.measuring import Point, PointKind
from app.path.path_aspects import Aspect, DrawnLeg, Tip
from app.path.path_marks_view import leg_labels
from app.path.path_picture import Picture, PictureBuilder
from app.path.path_view import PathView
from app.screen.look import DARK, Look
from core.executor.snapshot import State
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.elementary_blocks import Kind as BlockKind
from core.interpreter.shared.modal_state import Modal
from tests.path.made import turned
from tests.screen.colours import apart
from tests.screen.hands import LIMIT, Hands

Key = Qt.Key
SHIFT = Qt.KeyboardModifier.ShiftModifier
METRIC = Modal(spindle=1, metric=True)
FOUND: list[int] = []  # blocks whose lines were touched
SHAFT = [(10.0, 2.0), (5.0, 0.0), (5.0, -20.0), (8.0, -20.0)]  # (x, z)


def picture(corners: list[tuple[float, float]], *more: Block) -> Picture:
    sketch = PictureBuilder()
    pairs = list(itertools.pairwise(corners))
    for n, ((x0, z0), (x, z)) in enumerate(pairs, 1):
        kind = BlockKind.RAPID if n == 1 else BlockKind.FEED
        sketch.add(Block(n, n, kind, "", x0, z0, 0, x, z, 0, 0, 0, METRIC), float(n))
    for number, block in enumerate(more, len(pairs) + 1):
        sketch.add(block, float(number))
    return sketch.picture()


def slot() -> Picture:
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
    made = PathView(Look(DARK, 12.0), picked=FOUND.append)
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
        view.advance()
    return view.grab().toImage()


def on_widget(view: PathView, z: float, x: float, pane: int = 0) -> QPoint:
    it = view.panes[pane]
    return (it.room.topLeft() + it.spot(z, x)).toPoint()


def press(view: PathView, *keys: Key) -> None:
    for key in keys:
        QTest.keyClick(view, key)


def test_measuring_by_keys_alone(view: PathView) -> None:
    view.measure()
    ruler = view.ruler
    assert ruler is not None
    ruler.cursor = Point(0.0, 5.0, PointKind.END)
    press(view, Key.Key_Return, Key.Key_Left)
    assert ruler.cursor == Point(-20.0, 5.0, PointKind.END)
    press(view, Key.Key_Down, Key.Key_Return)
    assert (ruler.first, ruler.second) == (Point(0, 5, PointKind.END), Point(-20, 8, PointKind.END))
    rows = dict(ruler.rows(view.in_mm))
    assert (rows["ΔX Ø"], rows["ΔX R"], rows["ΔZ"]) == ("6.0000", "3.0000", "−20.0000")
    press(view, Key.Key_Backspace)
    assert ruler.first is None


def test_tab_goes_along_the_path(view: PathView) -> None:
    view.measure()
    assert view.ruler is not None
    view.ruler.cursor = Point(2.0, 10.0, PointKind.END)
    press(view, Key.Key_Tab, Key.Key_Tab)
    assert view.ruler.cursor[:2] == (-20.0, 5.0)
    QTest.keyClick(view, Key.Key_Tab, SHIFT)
    assert view.ruler.cursor[:2] == (0.0, 5.0)


def test_shift_creeps_by_a_pixel_and_catches_nothing(view: PathView) -> None:
    view.measure()
    assert view.ruler is not None
    view.ruler.cursor = Point(0.0, 5.0, PointKind.END)
    QTest.keyClick(view, Key.Key_Right, SHIFT)
    assert view.ruler.cursor.kind is PointKind.FREE
    assert view.ruler.cursor.z == pytest.approx(view.panes[0].pixel)


def test_the_pointer_catches_a_corner_and_holds_it(view: PathView) -> None:
    view.measure()
    for z, x in ((0.0, 5.0), (-20.0, 5.0)):
        QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, z, x) + QPoint(4, -3))
    assert view.ruler is not None
    assert (view.ruler.first, view.ruler.second) == (Point(0, 5, PointKind.END), Point(-20, 5, PointKind.END))


def test_the_cross_stays_in_sight(view: PathView) -> None:
    view.zoom(12)
    view.measure()
    assert view.ruler is not None
    for _ in range(4):
        press(view, Key.Key_Tab)
        pane = view.panes[0]
        z0, z1, x0, x1 = pane.sight()
        assert z0 < view.ruler.cursor.z < z1
        assert x0 < view.ruler.cursor.x < x1


def test_another_program_ends_measuring(view: PathView) -> None:
    view.measure()
    view.show_picture(picture(SHAFT))
    assert view.ruler is None


def test_nothing_to_measure_without_a_program(view: PathView) -> None:
    view.show_picture(None)
    view.measure()
    assert view.ruler is None


def test_a_touched_line_names_its_block_and_a_drag_does_not(view: PathView) -> None:
    found = FOUND
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, -9.0, 5.0))
    assert found == [2]
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=on_widget(view, -9.0, -9.0))
    assert found == [2]  # nothing is drawn there
    before = view.view
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
    assert view.view != before


def fingers(view: PathView, device: QPointingDevice, act: str, *places: tuple[int, int]) -> None:
    """Put fingers down, move them, or lift them."""
    with_all = QTest.touchEvent(view, device, False)
    for number, place in enumerate(places):
        getattr(with_all, act)(number, QPoint(*place), view)
    with_all.commit()


def test_two_fingers_spread_the_picture_and_touch_nothing(view: PathView) -> None:
    device = QTest.createTouchDevice()
    before = view.view
    assert before is not None
    fingers(view, device, "press", (380, 250), (420, 250))
    for far in (10, 20, 30, 40):
        fingers(view, device, "move", (380 - far, 250), (420 + far, 250))
    fingers(view, device, "release", (340, 250), (460, 250))
    assert view.view is not None
    assert view.view.scale == pytest.approx(3 * before.scale)  # from 40 pixels to 120
    assert FOUND == []


def test_one_finger_drags_and_touches(view: PathView) -> None:
    device = QTest.createTouchDevice()
    at = on_widget(view, -9.0, 5.0)
    fingers(view, device, "press", (at.x(), at.y()))
    fingers(view, device, "release", (at.x(), at.y()))
    assert FOUND == [2]
    before = view.view
    assert before is not None
    fingers(view, device, "press", (at.x(), at.y()))
    for far in (20, 40):
        fingers(view, device, "move", (at.x() + far, at.y()))
    fingers(view, device, "release", (at.x() + 40, at.y()))
    assert FOUND == [2]
    assert view.view == before.moved(40, 0)


def test_face_and_side_come_with_a_program_that_has_them(view: PathView) -> None:
    assert [pane.aspect for pane in view.panes] == [Aspect.PATH]
    view.next_view()
    assert [pane.aspect for pane in view.panes] == [Aspect.PATH]
    view.show_picture(slot())
    seen = []
    for _ in range(6):
        seen.append(tuple(pane.aspect.value for pane in view.panes))
        settle(view)
        view.next_view()
    assert seen == [("PATH", "FACE"), ("PATH", "SIDE"), ("FACE",), ("SIDE",), ("PATH",), ("PATH", "FACE")]


def test_the_tip_goes_round_on_the_face_and_along_the_side(view: PathView) -> None:
    view.show_picture(slot())
    view.show_tip(Tip(4, -5.0, -5.0, c=90.0))
    path, face = view.panes
    tip = Tip(4, -5.0, -5.0, c=90.0)
    assert path.place_of(tip) == (-5.0, -5.0)
    assert face.place_of(tip) == pytest.approx((0.0, 5.0), abs=1e-9)
    view.next_view()
    _path, side = view.panes
    assert side.place_of(tip) == pytest.approx((-5.0, -90 * side.polyline.round))
    assert side.place_of(Tip(4, 1.0, 2.0)) == pytest.approx((-5.0, -90 * side.polyline.round))  # C is let go


def test_measuring_on_the_face(view: PathView) -> None:
    view.show_picture(slot())
    view.measure()
    assert view.ruler is not None
    assert view.ruler.pane.aspect is Aspect.FACE
    assert [name for name, _figure in view.ruler.rows(True)] == ["X", "Y", "R"]


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


def test_before_and_after_are_both_there(view: PathView) -> None:
    wider = picture([(12.0, 2.0), (7.0, 0.0), (7.0, -20.0), (9.0, -20.0)])
    view.show_compared(picture(SHAFT), wider)
    image = settle(view)
    assert view.comparing
    assert drawn_in(DARK.accent, image, view, [(-3.0, 7.0), (-3.5, 7.0)])
    assert drawn_in(DARK.mark, image, view, [(-3.0 - k / 10, 5.0) for k in range(12)])
    assert not drawn_in(DARK.tip, image, view, [(0.0, 0.0)])  # no tool stands in a comparison


def test_zooming_a_comparison_goes_to_the_farthest_change(view: PathView) -> None:
    view.show_compared(picture(SHAFT), picture([(10.0, 2.0), (5.0, 0.0), (5.0, -20.0), (8.004, -20.003)]))
    apart = view.panes[0].apart
    assert apart is not None
    assert apart.distance == pytest.approx(0.005)
    view.zoom(20)
    z0, z1, x0, x1 = view.panes[0].sight()
    assert z0 < -20.003 < z1
    assert x0 < 8.004 < x1
    settle(view)


def test_no_tool_is_drawn_where_nobody_tells_it(view: PathView) -> None:
    assert not drawn_in(DARK.tip, settle(view), view, [(0.0, 0.0)])
    view.show_tip(Tip(0, 0.0, 0.0))
    assert drawn_in(DARK.tip, settle(view), view, [(0.0, 0.0)])


def test_both_pictures_fit_into_a_comparison(view: PathView) -> None:
    view.show_compared(picture([(40.0, 2.0), (40.0, -60.0)]), picture(SHAFT))
    z0, z1, x0, x1 = view.panes[0].sight()
    assert z0 < -60
    assert z1 > 2
    assert x0 < -40
    assert x1 > 40


def test_a_comparison_ends_with_the_next_picture(view: PathView) -> None:
    view.show_compared(picture(SHAFT), picture(SHAFT))
    view.show_picture(picture(SHAFT))
    assert not view.comparing
    view.show_compared(None, picture(SHAFT))
    assert not view.comparing


def test_the_way_back_is_seen_whole_unless_one_looks_elsewhere(view: PathView) -> None:
    view.shows_whole_approach = True
    before = view.view
    view.show_approach(
        [DrawnLeg(60.0, 40.0), DrawnLeg(60.0, 8.0, label="1 X"), DrawnLeg(-5.0, 8.0, label="2 Z")]
    )
    _z0, z1, _x0, x1 = view.panes[0].sight()
    assert z1 > 60
    assert x1 > 40
    view.show_approach(None)
    assert view.view == before
    view.zoom(2)
    near = view.view
    view.show_approach([DrawnLeg(60.0, 40.0), DrawnLeg(60.0, 8.0)])
    assert view.view == near
    view.fit()
    assert view.panes[0].sight()[1] > 60


def test_the_way_back_is_drawn_and_taken_away(view: PathView) -> None:
    legs = [
        DrawnLeg(10.0, 12.0),
        DrawnLeg(10.0, 8.0, label="1 X"),
        DrawnLeg(-5.0, 8.0, rapid=False, label="2 Z"),
    ]
    view.fit()
    view.zoom(-3)
    plain = settle(view)
    view.show_approach(legs)
    image = settle(view)
    # beside the label, on the solid leg
    assert drawn_in(DARK.lit, image, view, [(-3.0, 8.0)])
    assert not drawn_in(DARK.lit, plain, view, [(-3.0, 8.0)])
    view.show_approach(None)
    assert settle(view) == plain


def test_legs_that_lie_on_each_other_have_one_label(view: PathView) -> None:
    """A short way beside a long one: no number hides another."""
    spots = [QPointF(300.0, 50.0), QPointF(100.0, 50.0), QPointF(104.0, 52.0), QPointF(98.0, 49.0)]
    one, rest = leg_labels(view.look, spots, ["1 X", "2 Z", "3 X", "4 XZ"])
    assert (one[1], rest[1]) == ("1 X", "2–4")
    assert rest[0].center() == spots[1]
    assert not one[0].intersects(rest[0])
    assert [text for _, text in leg_labels(view.look, spots[:3], ["1 X", "", "3 X"])] == ["1 X", "3 X"]


def test_keys_on_the_automatic_page(hands: Hands) -> None:
    hands.load("bushing")
    path = hands.page.path
    hands.sees(lambda: path.view is not None)
    hands.key(Key.Key_M)
    assert path.ruler is not None
    before = path.ruler.cursor
    hands.key(Key.Key_Left)
    hands.key(Key.Key_Return)
    assert path.ruler.first is not None
    assert path.ruler.cursor != before
    hands.key(Key.Key_Escape)
    assert path.ruler is None
    assert hands.window.hasFocus()


def test_while_measuring_the_machine_s_keys_are_the_machine_s(hands: Hands) -> None:
    hands.load("bushing")
    hands.sees(lambda: hands.page.path.view is not None)
    hands.both_palms()
    hands.sees_state(State.RUN)
    hands.key(Key.Key_M)
    assert hands.page.path.ruler is not None
    hands.key(Key.Key_Escape)  # something moves: the safe thing first
    hands.sees_state(State.HOLD)
    assert hands.page.path.ruler is not None
    hands.key(Key.Key_S)
    assert hands.desk.snapshot().single_block
    hands.key(Key.Key_M)
    assert hands.page.path.ruler is None
