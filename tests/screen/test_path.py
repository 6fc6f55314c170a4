"""The path view: which way is up, what zooming keeps, what is drawn where."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF, QSizeF
from PySide6.QtGui import QColor, QImage, QPainter
from pytestqt.qtbot import QtBot

from app.path.path_layers_view import MAX_SMOOTH_CHORDS, PIXELS_PER_SLICE, LineStyle, PathLayers, make_polygon
from app.path.path_marks_view import (
    ViewButton,
    clip_line,
    count_button_columns,
    draw_buttons,
    find_button_columns_width,
    move_box_inside,
)
from app.path.path_picture import ProgramPicture
from app.path.path_projection import (
    ChordEnds,
    Projection,
    clip_chords,
    find_scale_length,
    fit_mirrored_projection,
    project_block_progress,
    project_strokes,
    rasterize_chords,
)
from app.path.path_view import PathView
from app.path.polyline import Polyline, StrokeKind
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window_layout import FINGERTIP_PX
from tests.screen.colours import apart

FRAME = Projection(center_z=0.0, center_x=0.0, pixels_per_mm=10.0, width_px=400, height_px=200)


def picture(points: list[tuple[float, float, StrokeKind]], first: list[int]) -> ProgramPicture:
    """A picture of (z, x, stroke) points and where blocks end."""
    z, x, stroke = (np.array(column) for column in zip(*points, strict=True))
    blocks = len(first) - 1
    return ProgramPicture(
        z=z.astype(float),
        x=x.astype(float),
        stroke=stroke.astype(np.uint8),
        first=np.array(first),
        ends=np.arange(blocks + 1.0),
        chord=np.ones(blocks),
        bounds=(float(z.min()), float(z.max()), float(x.min()), float(x.max())),
    )


SHAFT = picture(
    [(5, 8, StrokeKind.JUMP), (5, 4, StrokeKind.RAPID), (-10, 4, StrokeKind.TURN), (-10, 8, StrokeKind.TURN)],
    [0, 2, 3, 4],
)


def test_x_points_down_and_z_points_right() -> None:
    assert FRAME.find_pixel_row(4.0) > FRAME.find_pixel_row(0.0)
    assert FRAME.find_pixel_column(4.0) > FRAME.find_pixel_column(0.0)
    assert (FRAME.find_pixel_column(0.0), FRAME.find_pixel_row(0.0)) == (200, 100)


def test_fit_shows_both_sides_of_center_line() -> None:
    frame = fit_mirrored_projection((-10.0, 5.0, 0.0, 8.0), 400, 200, 10)
    assert frame.find_pixel_row(8.0) <= 190
    assert frame.find_pixel_row(-8.0) >= 10
    assert frame.find_pixel_column(-10.0) >= 10
    assert frame.find_pixel_column(5.0) <= 390


def test_fit_of_empty_area_gives_valid_frame() -> None:
    assert fit_mirrored_projection((0.0, 0.0, 0.0, 0.0), 400, 200, 10).pixels_per_mm > 0


def test_zoom_leaves_point_under_pointer_in_place() -> None:
    near = FRAME.magnify(3.0, 300.0, 40.0)
    assert near.find_pixel_column(10.0) == pytest.approx(300.0)  # z = 10 was at column 300
    assert near.find_pixel_row(-6.0) == pytest.approx(40.0)
    assert near.pixels_per_mm == pytest.approx(30.0)


def test_zoom_is_limited() -> None:
    assert FRAME.magnify(1e9, 0, 0).pixels_per_mm == 5000.0
    assert FRAME.magnify(1e-9, 0, 0).pixels_per_mm == 0.02


def test_adjacent_strokes_of_same_kind_form_one_run() -> None:
    found = list(project_strokes(SHAFT, FRAME, 0, 4))
    assert [run.stroke_kind for run in found] == [StrokeKind.RAPID, StrokeKind.TURN]
    assert found[1].columns.tolist() == [250, 100, 100]
    assert found[1].rows.tolist() == [140, 140, 180]


def test_slices_join_without_a_gap() -> None:
    assert [run.columns.tolist() for run in project_strokes(SHAFT, FRAME, 2, 3)] == [[250, 100]]


def test_a_jump_is_not_drawn() -> None:
    jumps = picture(
        [(0, 1, StrokeKind.JUMP), (1, 1, StrokeKind.TURN), (5, 5, StrokeKind.JUMP), (6, 5, StrokeKind.TURN)],
        [0, 2, 4],
    )
    assert [run.columns.tolist() for run in project_strokes(jumps, FRAME, 0, 4)] == [
        [200, 210],
        [250, 260],
    ]


def test_points_on_same_pixel_are_thinned_and_end_points_remain() -> None:
    z = np.linspace(0, 10, 100_001)
    dense = picture([(float(k), 1.0, StrokeKind.TURN if k else StrokeKind.JUMP) for k in z], [0, 100_001])
    (run,) = project_strokes(dense, FRAME, 0, 100_001)
    assert len(run.columns) < 500
    assert run.columns[-1] == 300


def test_runs_outside_frame_are_left_out() -> None:
    assert list(project_strokes(SHAFT, FRAME.shift(5000, 0), 0, 4)) == []


def test_polygon_contains_the_points() -> None:
    shape = make_polygon(np.array([1.0, 2.5]), np.array([3.0, 4.0]))
    assert [(point.x(), point.y()) for point in shape.toList()] == [(1.0, 3.0), (2.5, 4.0)]


def test_progress_ends_at_tip() -> None:
    run = project_block_progress(SHAFT, FRAME, 2, -4.0, 4.0)
    assert run is not None
    assert (run.columns.tolist(), run.rows.tolist()) == ([250, 160], [140, 140])
    assert project_block_progress(SHAFT, FRAME, 0, 0, 0) is None
    assert project_block_progress(SHAFT, FRAME, 4, 0, 0) is None


@pytest.mark.parametrize(
    ("most", "metric", "shown"),
    [(25.4, False, "1 in"), (60.0, False, "2 in"), (9.9, True, "5 mm"), (0.13, True, "0.1 mm")],
)
def test_scale_bar_is_a_round_length_that_fits(most: float, metric: bool, shown: str) -> None:
    length, text = find_scale_length(most, metric)
    assert text == shown
    assert length <= most * 1.0001


def colour(image: QImage, z: float, x: float) -> str:
    """The palette's colour that a pixel is nearest to: smoothing mixes it with the ground."""
    pixel = image.pixelColor(round(float(FRAME.find_pixel_column(z))), round(float(FRAME.find_pixel_row(x))))
    candidates = (
        DARK_PALETTE.panel,
        DARK_PALETTE.todo,
        DARK_PALETTE.done,
        DARK_PALETTE.rapid,
        DARK_PALETTE.ghost,
    )
    return min(candidates, key=lambda name: apart(pixel, QColor(name)))


def drawn(layers: PathLayers) -> QImage:
    while layers.continue_drawing():
        pass
    return layers.image


def test_executed_path_covers_remaining_path_and_new_cycle_clears_it() -> None:
    layers = PathLayers(ScreenTheme(DARK_PALETTE, 12.0), SHAFT, FRAME)
    assert colour(drawn(layers), -2.0, 4.0) == DARK_PALETTE.todo
    layers.request_finished_blocks(2)
    assert colour(drawn(layers), -2.0, 4.0) == DARK_PALETTE.done
    assert colour(layers.image, -10.0, 6.0) == DARK_PALETTE.todo
    layers.request_finished_blocks(0)
    assert colour(drawn(layers), -2.0, 4.0) == DARK_PALETTE.todo


def test_far_side_shows_turning_moves_and_no_rapids() -> None:
    image = drawn(PathLayers(ScreenTheme(DARK_PALETTE, 12.0), SHAFT, FRAME))
    assert colour(image, -2.0, -4.0) == DARK_PALETTE.ghost
    assert colour(image, 5.0, -6.0) == DARK_PALETTE.panel


def zigzag(blocks: int) -> ProgramPicture:
    """More strokes than are drawn smoothly: cuts and rapids by turns, along X = 4 and back along X = 6."""
    made = [(0.0, 4.0, StrokeKind.JUMP)]
    for k in range(blocks):
        z = -10 * (k + 1) / blocks
        made.append((z, 4.0, StrokeKind.TURN) if k % 2 else (z, 6.0, StrokeKind.RAPID))
    return picture(made, list(range(1, blocks + 2)))


def test_path_with_many_strokes_is_drawn() -> None:
    many = zigzag(2 * MAX_SMOOTH_CHORDS)
    layers = PathLayers(ScreenTheme(DARK_PALETTE, 12.0), many, FRAME)
    seen = {colour(drawn(layers), -5.0, x) for x in np.linspace(4.2, 5.8, 33)}
    assert seen <= {DARK_PALETTE.todo, DARK_PALETTE.rapid}
    assert colour(layers.image, -5.0, -5.0) == DARK_PALETTE.ghost
    layers.request_finished_blocks(many.blocks)
    assert DARK_PALETTE.done in {colour(drawn(layers), z, 5.0) for z in np.linspace(-9, -1, 60)}


def test_long_strokes_are_drawn_in_small_slices(monkeypatch: pytest.MonkeyPatch) -> None:
    there_and_back = [(-30.0 * (k % 2), 4.0, StrokeKind.TURN) for k in range(2 * MAX_SMOOTH_CHORDS)]
    path = picture(there_and_back, list(range(1, len(there_and_back) + 1)))
    parts: list[tuple[int, int]] = []
    draw = PathLayers._draw_pixels

    def counted(
        layers: PathLayers, image: QImage, whole: Polyline, part: tuple[int, int], ink: LineStyle
    ) -> None:
        parts.append(part)
        draw(layers, image, whole, part, ink)

    monkeypatch.setattr(PathLayers, "_draw_pixels", counted)
    drawn(PathLayers(ScreenTheme(DARK_PALETTE, 12.0), path, FRAME))
    edges = [0, *(end for _, end in parts)]
    assert parts == list(pairwise(edges)), "each point once, in its order"
    assert edges[-1] == len(there_and_back)
    assert all((end - begin) * 300 < PIXELS_PER_SLICE + 2 * 300 for begin, end in parts), (
        "30 mm are 300 pixels"
    )


def test_lines_are_clipped_at_image_edges() -> None:
    ends = ChordEnds(
        start_columns=np.array([-50.0, 5.0, 0.0, 30.0]),
        start_rows=np.array([5.0, -9.0, 20.0, 5.0]),
        end_columns=np.array([50.0, 5.0, 0.0, 40.0]),
        end_rows=np.array([5.0, 90.0, 30.0, 5.0]),
    )
    cut, inside = clip_chords(ends, right=10, bottom=8)
    assert inside.tolist() == [True, True, False, False]
    assert (cut.start_columns.tolist(), cut.end_columns.tolist()) == ([0.0, 5.0], [10.0, 5.0])
    assert (cut.start_rows.tolist(), cut.end_rows.tolist()) == ([5.0, 0.0], [5.0, 8.0])


def test_rasterized_line_has_no_gaps() -> None:
    column, row, which = rasterize_chords(ChordEnds(*(np.array([v]) for v in (0.0, 0.0, 7.0, 3.0))))
    assert column.tolist() == list(range(8))
    assert row.tolist() == [0, 0, 1, 1, 2, 2, 3, 3]
    assert set(which.tolist()) == {0}


def test_rasterized_point_is_one_pixel() -> None:
    column, row, _which = rasterize_chords(ChordEnds(*(np.array([v]) for v in (2.2, 3.4, 2.2, 3.4))))
    assert (column.tolist(), row.tolist()) == ([2], [3])


@pytest.mark.parametrize("high", [100.0, 150.0, 240.0])
def test_all_buttons_are_touch_sized_in_low_view(high: float) -> None:
    """Under the part its time line takes height: VIEW alone leads back to the path, and has to stay."""
    look, room = ScreenTheme(DARK_PALETTE, 6.4), QRectF(1.0, 8.0, 372.0, high)
    image, boxes = QImage(374, 260, QImage.Format.Format_RGB32), list[QRectF]()
    painter = QPainter(image)
    buttons = [ViewButton(sign, lambda: None) for sign in ("+", "−", "VIEW", "FIT", "MEAS")]
    draw_buttons(painter, look, room, buttons, lambda box, _press: boxes.append(box))
    painter.end()
    assert len(boxes) == len(buttons)
    for box in boxes:
        assert min(box.width(), box.height()) >= FINGERTIP_PX - 1
        assert room.contains(box)
        assert (
            box.x()
            >= room.right()
            - find_button_columns_width(count_button_columns(look, room, 5), look)
            - look.unit_px
        )
    assert not any(one.intersects(other) for one, other in combinations(boxes, 2))


PANE = QSizeF(400.0, 200.0)


def test_leg_is_clipped_at_pane_edge() -> None:
    cut = clip_line(QPointF(900.0, 100.0), QPointF(300.0, 100.0), PANE)
    assert cut == (QPointF(400.0, 100.0), QPointF(300.0, 100.0))
    assert clip_line(QPointF(10.0, 20.0), QPointF(30.0, 40.0), PANE) == (QPointF(10, 20), QPointF(30, 40))
    assert clip_line(QPointF(900.0, 100.0), QPointF(500.0, 100.0), PANE) is None


def test_a_label_moves_into_the_pane() -> None:
    room = QRectF(0.0, 0.0, 400.0, 200.0)
    assert move_box_inside(QRectF(390.0, -5.0, 40.0, 20.0), room) == QRectF(360.0, 0.0, 40.0, 20.0)
    assert move_box_inside(QRectF(50.0, 50.0, 40.0, 20.0), room) == QRectF(50.0, 50.0, 40.0, 20.0)


def test_view_without_a_path_states_whether_a_program_is_loading(qtbot: QtBot) -> None:
    view = PathView(ScreenTheme(DARK_PALETTE))
    qtbot.addWidget(view)
    view.resize(500, 300)
    view.show()
    shown = {}
    for view.is_loading in (False, True):
        view.grab()
        shown[view.is_loading] = view.describe_content()
    assert "Load a program to see its path." in shown[False]
    assert "Loading the program." in shown[True]
