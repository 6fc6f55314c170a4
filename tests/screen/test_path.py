"""The path view: which way is up, what zooming keeps, what is drawn where."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF, QSizeF
from PySide6.QtGui import QColor, QImage, QPainter

from app.path.path_layers_view import PIXELS, SMOOTH_TO, Ink, Layers, polygon
from app.path.path_marks_view import (
    Button,
    button_columns,
    columns_wide,
    draw_buttons,
    inside_room,
    visible_part,
)
from app.path.path_picture import Picture
from app.path.path_projection import (
    Ends,
    Projection,
    clipped,
    fitted,
    runs,
    scale_length,
    stepped,
    travelled,
)
from app.path.polyline import Polyline, Stroke
from app.screen.look import DARK, Look
from app.screen.window_layout import FINGER
from tests.screen.colours import apart

FRAME = Projection(z=0.0, x=0.0, scale=10.0, width=400, height=200)


def picture(points: list[tuple[float, float, Stroke]], first: list[int]) -> Picture:
    """A picture of (z, x, stroke) points and where blocks end."""
    z, x, stroke = (np.array(column) for column in zip(*points, strict=True))
    blocks = len(first) - 1
    return Picture(
        z=z.astype(float),
        x=x.astype(float),
        stroke=stroke.astype(np.uint8),
        first=np.array(first),
        ends=np.arange(blocks + 1.0),
        chord=np.ones(blocks),
        bounds=(float(z.min()), float(z.max()), float(x.min()), float(x.max())),
    )


SHAFT = picture(
    [(5, 8, Stroke.JUMP), (5, 4, Stroke.RAPID), (-10, 4, Stroke.TURN), (-10, 8, Stroke.TURN)], [0, 2, 3, 4]
)


def test_x_goes_down_and_z_goes_right() -> None:
    assert FRAME.down(4.0) > FRAME.down(0.0)
    assert FRAME.across(4.0) > FRAME.across(0.0)
    assert (FRAME.across(0.0), FRAME.down(0.0)) == (200, 100)


def test_fitting_shows_both_sides_of_the_centre_line() -> None:
    frame = fitted((-10.0, 5.0, 0.0, 8.0), 400, 200, 10)
    assert frame.down(8.0) <= 190
    assert frame.down(-8.0) >= 10
    assert frame.across(-10.0) >= 10
    assert frame.across(5.0) <= 390


def test_fitting_nothing_still_gives_a_frame() -> None:
    assert fitted((0.0, 0.0, 0.0, 0.0), 400, 200, 10).scale > 0


def test_zooming_keeps_what_is_under_the_pointer() -> None:
    near = FRAME.zoomed(3.0, 300.0, 40.0)
    assert near.across(10.0) == pytest.approx(300.0)  # z = 10 was at column 300
    assert near.down(-6.0) == pytest.approx(40.0)
    assert near.scale == pytest.approx(30.0)


def test_zooming_has_ends() -> None:
    assert FRAME.zoomed(1e9, 0, 0).scale == 5000.0
    assert FRAME.zoomed(1e-9, 0, 0).scale == 0.02


def test_neighbouring_strokes_of_a_kind_are_one_run() -> None:
    found = list(runs(SHAFT, FRAME, 0, 4))
    assert [run.stroke for run in found] == [Stroke.RAPID, Stroke.TURN]
    assert found[1].columns.tolist() == [250, 100, 100]
    assert found[1].rows.tolist() == [140, 140, 180]


def test_slices_join_without_a_gap() -> None:
    assert [run.columns.tolist() for run in runs(SHAFT, FRAME, 2, 3)] == [[250, 100]]


def test_a_jump_is_not_drawn() -> None:
    jumps = picture(
        [(0, 1, Stroke.JUMP), (1, 1, Stroke.TURN), (5, 5, Stroke.JUMP), (6, 5, Stroke.TURN)], [0, 2, 4]
    )
    assert [run.columns.tolist() for run in runs(jumps, FRAME, 0, 4)] == [[200, 210], [250, 260]]


def test_what_falls_on_one_pixel_is_thinned_out_and_the_ends_stay() -> None:
    z = np.linspace(0, 10, 100_001)
    dense = picture([(float(k), 1.0, Stroke.TURN if k else Stroke.JUMP) for k in z], [0, 100_001])
    (run,) = runs(dense, FRAME, 0, 100_001)
    assert len(run.columns) < 500
    assert run.columns[-1] == 300


def test_what_lies_beyond_an_edge_is_left_out() -> None:
    assert list(runs(SHAFT, FRAME.moved(5000, 0), 0, 4)) == []


def test_polygon_holds_the_points() -> None:
    shape = polygon(np.array([1.0, 2.5]), np.array([3.0, 4.0]))
    assert [(point.x(), point.y()) for point in shape.toList()] == [(1.0, 3.0), (2.5, 4.0)]


def test_travelled_ends_at_the_tip() -> None:
    run = travelled(SHAFT, FRAME, 2, -4.0, 4.0)
    assert run is not None
    assert (run.columns.tolist(), run.rows.tolist()) == ([250, 160], [140, 140])
    assert travelled(SHAFT, FRAME, 0, 0, 0) is None
    assert travelled(SHAFT, FRAME, 4, 0, 0) is None


@pytest.mark.parametrize(
    ("most", "metric", "shown"),
    [(25.4, False, "1 in"), (60.0, False, "2 in"), (9.9, True, "5 mm"), (0.13, True, "0.1 mm")],
)
def test_scale_bar_is_a_round_length_that_fits(most: float, metric: bool, shown: str) -> None:
    length, text = scale_length(most, metric)
    assert text == shown
    assert length <= most * 1.0001


def colour(image: QImage, z: float, x: float) -> str:
    """The palette's colour that a pixel is nearest to: smoothing mixes it with the ground."""
    pixel = image.pixelColor(round(float(FRAME.across(z))), round(float(FRAME.down(x))))
    candidates = (DARK.panel, DARK.todo, DARK.done, DARK.rapid, DARK.ghost)
    return min(candidates, key=lambda name: apart(pixel, QColor(name)))


def drawn(layers: Layers) -> QImage:
    while layers.advance():
        pass
    return layers.image


def test_done_is_drawn_over_to_come_and_a_new_cycle_starts_again() -> None:
    layers = Layers(Look(DARK, 12.0), SHAFT, FRAME)
    assert colour(drawn(layers), -2.0, 4.0) == DARK.todo
    layers.want(2)
    assert colour(drawn(layers), -2.0, 4.0) == DARK.done
    assert colour(layers.image, -10.0, 6.0) == DARK.todo
    layers.want(0)
    assert colour(drawn(layers), -2.0, 4.0) == DARK.todo


def test_the_far_side_shows_what_is_turned_and_no_rapid() -> None:
    image = drawn(Layers(Look(DARK, 12.0), SHAFT, FRAME))
    assert colour(image, -2.0, -4.0) == DARK.ghost
    assert colour(image, 5.0, -6.0) == DARK.panel


def zigzag(blocks: int) -> Picture:
    """More strokes than are drawn smoothly: cuts and rapids by turns, along X = 4 and back along X = 6."""
    made = [(0.0, 4.0, Stroke.JUMP)]
    for k in range(blocks):
        z = -10 * (k + 1) / blocks
        made.append((z, 4.0, Stroke.TURN) if k % 2 else (z, 6.0, Stroke.RAPID))
    return picture(made, list(range(1, blocks + 2)))


def test_many_strokes_are_drawn_too() -> None:
    many = zigzag(2 * SMOOTH_TO)
    layers = Layers(Look(DARK, 12.0), many, FRAME)
    seen = {colour(drawn(layers), -5.0, x) for x in np.linspace(4.2, 5.8, 33)}
    assert seen <= {DARK.todo, DARK.rapid}
    assert colour(layers.image, -5.0, -5.0) == DARK.ghost
    layers.want(many.blocks)
    assert DARK.done in {colour(drawn(layers), z, 5.0) for z in np.linspace(-9, -1, 60)}


def test_long_strokes_are_drawn_few_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    there_and_back = [(-30.0 * (k % 2), 4.0, Stroke.TURN) for k in range(2 * SMOOTH_TO)]
    path = picture(there_and_back, list(range(1, len(there_and_back) + 1)))
    parts: list[tuple[int, int]] = []
    draw = Layers._draw_pixels

    def counted(layers: Layers, image: QImage, whole: Polyline, part: tuple[int, int], ink: Ink) -> None:
        parts.append(part)
        draw(layers, image, whole, part, ink)

    monkeypatch.setattr(Layers, "_draw_pixels", counted)
    drawn(Layers(Look(DARK, 12.0), path, FRAME))
    edges = [0, *(end for _, end in parts)]
    assert parts == list(pairwise(edges)), "each point once, in its order"
    assert edges[-1] == len(there_and_back)
    assert all((end - begin) * 300 < PIXELS + 2 * 300 for begin, end in parts), "30 mm are 300 pixels"


def test_lines_are_cut_at_the_edges_of_the_image() -> None:
    ends = Ends(
        c0=np.array([-50.0, 5.0, 0.0, 30.0]),
        r0=np.array([5.0, -9.0, 20.0, 5.0]),
        c1=np.array([50.0, 5.0, 0.0, 40.0]),
        r1=np.array([5.0, 90.0, 30.0, 5.0]),
    )
    cut, inside = clipped(ends, right=10, bottom=8)
    assert inside.tolist() == [True, True, False, False]
    assert (cut.c0.tolist(), cut.c1.tolist()) == ([0.0, 5.0], [10.0, 5.0])
    assert (cut.r0.tolist(), cut.r1.tolist()) == ([5.0, 0.0], [5.0, 8.0])


def test_a_line_has_no_holes() -> None:
    column, row, which = stepped(Ends(*(np.array([v]) for v in (0.0, 0.0, 7.0, 3.0))))
    assert column.tolist() == list(range(8))
    assert row.tolist() == [0, 0, 1, 1, 2, 2, 3, 3]
    assert set(which.tolist()) == {0}


def test_a_point_is_one_pixel() -> None:
    column, row, _which = stepped(Ends(*(np.array([v]) for v in (2.2, 3.4, 2.2, 3.4))))
    assert (column.tolist(), row.tolist()) == ([2], [3])


@pytest.mark.parametrize("high", [100.0, 150.0, 240.0])
def test_all_buttons_fit_a_finger_in_a_low_view(high: float) -> None:
    """Under the part its time line takes height: VIEW alone leads back to the path, and has to stay."""
    look, room = Look(DARK, 6.4), QRectF(1.0, 8.0, 372.0, high)
    image, boxes = QImage(374, 260, QImage.Format.Format_RGB32), list[QRectF]()
    painter = QPainter(image)
    buttons = [Button(sign, lambda: None) for sign in ("+", "−", "VIEW", "FIT", "MEAS")]
    draw_buttons(painter, look, room, buttons, lambda box, _press: boxes.append(box))
    painter.end()
    assert len(boxes) == len(buttons)
    for box in boxes:
        assert min(box.width(), box.height()) >= FINGER - 1
        assert room.contains(box)
        assert box.x() >= room.right() - columns_wide(button_columns(look, room, 5), look) - look.u
    assert not any(one.intersects(other) for one, other in combinations(boxes, 2))


PANE = QSizeF(400.0, 200.0)


def test_a_leg_is_cut_at_the_edge_of_the_pane() -> None:
    cut = visible_part(QPointF(900.0, 100.0), QPointF(300.0, 100.0), PANE)
    assert cut == (QPointF(400.0, 100.0), QPointF(300.0, 100.0))
    assert visible_part(QPointF(10.0, 20.0), QPointF(30.0, 40.0), PANE) == (QPointF(10, 20), QPointF(30, 40))
    assert visible_part(QPointF(900.0, 100.0), QPointF(500.0, 100.0), PANE) is None


def test_a_label_moves_into_the_pane() -> None:
    room = QRectF(0.0, 0.0, 400.0, 200.0)
    assert inside_room(QRectF(390.0, -5.0, 40.0, 20.0), room) == QRectF(360.0, 0.0, 40.0, 20.0)
    assert inside_room(QRectF(50.0, 50.0, 40.0, 20.0), room) == QRectF(50.0, 50.0, 40.0, 20.0)
