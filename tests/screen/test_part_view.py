"""The part view: what stands where in the section, its time line by fingers, and where there is no part."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.path.part_player import PartPlayer, SolidImageRequest
from app.path.path_aspects import PathViewKind, TipPosition
from app.path.path_buttons_view import make_view_buttons
from app.path.path_marks_view import make_part_title
from app.path.path_view import PathView
from app.path.solid_marks_view import find_dimension, find_exact_radius
from app.path.solid_pane_view import find_removed_half, find_removed_quarter
from app.screen.color_palettes import DARK_PALETTE, LIGHT_PALETTE
from app.screen.screen_theme import ScreenTheme
from core.part.stock import Clamping
from core.proving.part_instant import SectionHalf
from tests.path.test_part_player import RAPID, SHAFT, Clock, picture
from tests.screen.hands import LIMIT

INCH = 25.4
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def view(qtbot: QtBot) -> Iterator[PathView]:
    """A path view with a player of the part."""
    player = PartPlayer(read_time_s=Clock())
    made = PathView(ScreenTheme(DARK_PALETTE, 8.0), part_player=player)
    made.resize(800, 400)
    with qtbot.waitExposed(made, timeout=LIMIT):
        made.show()
    yield made
    made.hide()
    made.deleteLater()
    player.close()


def shown(view: PathView, program: str) -> QImage:
    """The part at the end of a program."""
    view.show_picture(picture(program))
    while not view.is_part_shown:
        view.select_next_view()
    return settled(view)


def settled(view: PathView) -> QImage:
    assert view.part_player is not None
    view.part_player.wait_for_result(60.0)
    view.continue_drawing()
    view.part_player.wait_for_result(60.0)
    view.continue_drawing()
    return view.grab().toImage()


def colour(view: PathView, image: QImage, z: float, x: float) -> set[str]:
    """The colours round a place of the section, inches."""
    pane = view.panes[0]
    at = (pane.area.topLeft() + pane.map_to_pane(z * INCH, x * INCH)).toPoint()
    return {QColor(image.pixel(at.x() + k, at.y() + j)).name() for k in range(-3, 4) for j in range(-3, 4)}


@pytest.mark.parametrize("x", [0.2, -0.2])
def test_material_is_drawn_on_both_sides_of_center_line(view: PathView, x: float) -> None:
    image = shown(view, SHAFT)
    assert DARK_PALETTE.key in colour(view, image, -0.2, x)  # hatched metal
    assert DARK_PALETTE.key in colour(view, image, -0.4, 2 * x * 0.9)
    assert DARK_PALETTE.key not in colour(view, image, -0.2, 1.8 * x)  # turned off
    assert DARK_PALETTE.key not in colour(view, image, 0.15, x)  # before the face


def test_material_is_drawn_in_light_theme(view: PathView) -> None:
    view.theme.set_palette(LIGHT_PALETTE)
    view.redraw()
    image = shown(view, SHAFT)
    assert LIGHT_PALETTE.key in colour(view, image, -0.2, 0.2)


@pytest.mark.parametrize("x", [0.35, -0.35])
def test_collision_of_rapid_is_drawn_red(view: PathView, x: float) -> None:
    image = shown(view, RAPID)
    assert DARK_PALETTE.alarm in colour(view, image, -0.2, x)
    assert DARK_PALETTE.alarm not in colour(view, shown(view, SHAFT), -0.2, x)


def test_touch_plays_steps_and_moves_along_timeline(view: PathView) -> None:
    shown(view, SHAFT)
    player = view.part_player
    assert player is not None
    words = {press.__name__: rect for rect, press, *_ in view._places if hasattr(press, "__name__")}
    QTest.mouseClick(view, LEFT, pos=words["toggle_playback"].center().toPoint())
    assert player.is_playing
    assert player.program_time_s == 0.0
    assert view._bar is not None
    track = view._bar._track
    middle = QPoint(round(track.center().x()), round(track.center().y()))
    QTest.mousePress(view, LEFT, pos=middle)
    assert not player.is_playing
    assert player.program_time_s == pytest.approx(player.duration_s / 2, rel=0.01)
    QTest.mouseMove(view, QPoint(round(track.right()), middle.y()))
    QTest.mouseRelease(view, LEFT, pos=QPoint(round(track.right()), middle.y()))
    assert player.program_time_s == pytest.approx(player.duration_s, rel=0.01)


def test_timeline_ignores_touch_while_it_follows_run(view: PathView) -> None:
    shown(view, SHAFT)
    player = view.part_player
    assert player is not None
    player.follows_run, before = True, player.program_time_s
    assert view._bar is not None
    track = view._bar._track
    QTest.mouseClick(view, LEFT, pos=track.center().toPoint())
    assert player.program_time_s == before


def test_tool_is_drawn_at_position_of_run(view: PathView) -> None:
    shown(view, SHAFT)
    assert view.picture is not None
    assert view.part_player is not None
    block = view.picture.find_block_for_line(6)
    view.show_tool_tip(TipPosition(block, -0.225 * INCH, 0.4 * INCH))
    settled(view)
    now = view.part_player.latest_result
    assert now is not None
    assert now.part_instant.tool is not None
    assert now.part_instant.tool.control_point == pytest.approx((-0.225 * INCH, 0.4 * INCH))


def test_zoom_pan_and_fit_work_as_in_path_view(view: PathView) -> None:
    shown(view, SHAFT)
    before = view.first_projection
    view.zoom_view(1)
    view.pan_view(1, 0)
    assert view.first_projection != before
    view.fit_all_panes()
    assert view.first_projection == before


def test_part_view_remains_for_another_program(view: PathView) -> None:
    shown(view, SHAFT)
    view.show_picture(picture(RAPID))
    assert view.is_part_shown
    assert DARK_PALETTE.alarm in colour(view, settled(view), -0.2, 0.35)


def test_only_path_view_exists_without_player(qtbot: QtBot) -> None:
    made = PathView(ScreenTheme(DARK_PALETTE, 8.0))
    qtbot.addWidget(made)
    made.show_picture(picture(SHAFT))
    made.select_next_view()
    assert [pane.aspect for pane in made.panes] == [PathViewKind.PATH]
    assert not made.has_several_views


def test_part_error_is_shown_in_pane_title(view: PathView, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_given: object) -> None:
        raise ValueError("no such tool")

    monkeypatch.setattr("core.proving.part_history.PartHistory.__init__", broken)
    shown(view, SHAFT)
    assert make_part_title(view.panes[0]) == "no such tool"


def test_without_a_program_nothing_is_played(view: PathView) -> None:
    view.show_picture(None)
    view.continue_drawing()
    view.select_next_view()
    assert not view.is_part_shown


@pytest.mark.parametrize("aspect", [PathViewKind.SECTION, PathViewKind.SOLID])
def test_measuring_continues_in_part_view(view: PathView, aspect: PathViewKind) -> None:
    shown(view, SHAFT)
    while view.panes[0].aspect is not aspect:
        view.select_next_view()
    view.switch_measuring(is_on=True)
    assert view.measurement is not None
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Tab, Qt.Key.Key_Return, Qt.Key.Key_Left):
        QTest.keyClick(view, key)
        settled(view)
    QTest.mouseClick(view, LEFT, pos=view.panes[0].area.center().toPoint())
    settled(view)
    assert view.panes[0].aspect is aspect


def test_part_is_not_calculated_while_it_is_not_visible(view: PathView) -> None:
    view.show_picture(picture(SHAFT))
    view.continue_drawing()
    assert view.part_player is not None
    assert not view.part_player.worker.is_busy
    assert view.part_player.latest_result is None


# --- in space -----------------------------------------------------------------------------------------


def solid(view: PathView, program: str) -> QImage:
    """The part in space at the end of a program."""
    shown(view, program)
    while view.panes[0].aspect is not PathViewKind.SOLID:
        view.select_next_view()
    return settled(view)


def drawn(view: PathView) -> int:
    """How many pixels of the picture are part."""
    assert view.part_player is not None
    now = view.part_player.latest_result
    assert now is not None
    assert now.picture is not None
    return int((now.picture.image >> 24 > 0).sum())


def test_solid_fills_its_pane_and_is_rotated_by_touch(view: PathView) -> None:
    before = solid(view, SHAFT)
    room = view.panes[0].area
    assert drawn(view) > 0.2 * room.height() ** 2
    middle = room.center().toPoint()
    QTest.mousePress(view, LEFT, pos=middle)
    for k in range(1, 11):
        QTest.mouseMove(view, middle + QPoint(6 * k, 3 * k))
    QTest.mouseRelease(view, LEFT, pos=middle + QPoint(60, 30))
    assert settled(view) != before


def test_pan_keys_rotate_solid_up_to_a_limit(view: PathView) -> None:
    solid(view, SHAFT)
    assert view.part_player is not None
    first = view.part_player._wanted.image_request
    view.pan_view(1, 0)
    turned = view.part_player._wanted.image_request
    assert first is not None
    assert turned is not None
    assert turned.view.azimuth_deg == first.view.azimuth_deg + 10.0
    for _ in range(40):
        view.pan_view(1, 0)
    steepest = view.part_player._wanted.image_request
    assert steepest is not None
    assert steepest.view.azimuth_deg == 85.0


def test_collision_of_rapid_is_red_in_3d_view(view: PathView) -> None:
    def reds(image: QImage) -> int:
        colours = (
            QColor(image.pixel(x, y)) for x in range(0, image.width(), 4) for y in range(0, image.height(), 4)
        )
        return sum(each.red() > 150 and each.green() < 90 for each in colours)

    assert reds(solid(view, RAPID)) > reds(solid(view, SHAFT)) + 20


def test_c_key_rotates_solid_while_pressed(view: PathView) -> None:
    solid(view, SHAFT)
    view.show_tool_tip(TipPosition(3, 0.0, 5.0, c=30.0))
    assert view.part_player is not None
    wanted = view.part_player._wanted.image_request
    assert wanted is not None
    assert wanted.view.roll_deg == 30.0


def test_no_solid_is_drawn_without_removed_material(view: PathView) -> None:
    shown(view, "G90G94F300\nM03S1500\nT1\nX2Z2\nM30\n")
    while view.panes[0].aspect is not PathViewKind.SOLID:
        view.select_next_view()
    settled(view)
    assert view.part_player is not None
    now = view.part_player.latest_result
    assert now is not None
    assert now.picture is None


def test_next_view_after_solid_is_open_solid_and_then_path(view: PathView) -> None:
    whole = solid(view, SHAFT)
    view.select_next_view()
    assert [pane.aspect for pane in view.panes] == [PathViewKind.OPEN_SOLID]
    assert settled(view) != whole
    view.select_next_view()
    assert [pane.aspect for pane in view.panes] == [PathViewKind.PATH]


@pytest.mark.parametrize("tilt", range(-180, 180, 15))
@pytest.mark.parametrize("angle", [0.0, 15.0, 90.0, 165.0])
def test_removed_half_is_on_viewer_side_of_section_plane(tilt: int, angle: float) -> None:
    first, last = find_removed_half(float(tilt), angle)
    assert last - first == 180.0
    assert -180.0 <= first < last <= 180.0
    assert (first - (angle - tilt)) % 180.0 == 0.0  # one edge is in the section plane
    assert first <= 0.0 <= last  # the viewer is at an angle of 0


def test_section_and_stock_are_switched_by_keys(view: PathView) -> None:
    solid(view, SHAFT)
    player = view.part_player
    assert player is not None

    def request() -> SolidImageRequest:
        wanted = player._wanted.image_request
        assert wanted is not None
        return wanted

    keys = view.make_part_key_actions()
    assert request().view.cut_out_range_deg is None
    keys["X"]()
    assert request().view.cut_out_range_deg == (-35.0, 145.0)  # the viewer looks from 35 degrees above
    keys["Shift+X"]()
    assert request().view.cut_out_range_deg == (-20.0, 160.0)
    keys["X"]()
    assert request().view.cut_out_range_deg is None
    keys["G"]()
    assert request().is_stock_shown
    keys["G"]()
    assert not request().is_stock_shown


@pytest.mark.parametrize("aspect", [PathViewKind.SECTION, PathViewKind.PATH])
def test_section_keys_do_nothing_in_flat_views(view: PathView, aspect: PathViewKind) -> None:
    shown(view, SHAFT)
    while view.panes[0].aspect is not aspect:
        view.select_next_view()
    assert not {"X", "Shift+X", "G"} & view.make_part_key_actions().keys()


def test_section_shows_cut_faces_and_stock_covers_part(view: PathView) -> None:
    whole = solid(view, SHAFT)
    keys = view.make_part_key_actions()
    keys["X"]()
    cut = settled(view)
    keys["X"]()
    keys["G"]()
    covered = settled(view)
    assert cut != whole
    assert covered not in (whole, cut)


@pytest.mark.parametrize("tilt", range(-180, 180, 15))
def test_removed_quarter_faces_the_viewer(tilt: int) -> None:
    first, last = find_removed_quarter(float(tilt))
    assert last - first == 90.0
    assert -180.0 <= first < last <= 180.0
    if abs(tilt) <= 90:
        assert -90.0 <= 0.5 * (first + last) <= 90.0
    assert -tilt in {first, last}  # the plane of turning, on the operator's side


def test_chuck_is_drawn_at_its_position(view: PathView) -> None:
    bare = picture(SHAFT)
    assert bare.part is not None
    held = replace(bare.part, part_settings=replace(bare.part.part_settings, clamping=Clamping(60.0, 8.0)))
    view.show_picture(replace(bare, part=held))
    while not view.is_part_shown:
        view.select_next_view()
    image = settled(view)
    assert view.part_player is not None
    assert view.part_player.latest_result is not None
    stock = view.part_player.latest_result.part_instant.stock
    assert stock is not None
    edge = -8.0 / INCH, (stock.max_radius_mm + 0.7) / INCH
    assert len(colour(view, image, *edge)) > 2  # a line, and hatching behind it
    assert colour(view, shown(view, SHAFT), *edge) == {DARK_PALETTE.panel}


# --- marks in space


def half(*columns: tuple[float, float]) -> SectionHalf:
    """A section with columns 1 mm wide from Z-10, each with an inner and an outer radius."""
    inner, outer = (np.array([each]) for each in zip(*columns, strict=True))
    return SectionHalf(np.arange(-10.0, -9.5 + len(columns)), inner, outer)


@pytest.mark.parametrize(
    ("z", "radius", "expected"),
    [
        (-9.5, 7.93, 8.0),  # the outside of the first column
        (-8.5, 6.05, 6.0),
        (-8.5, 2.04, 2.0),  # the bore
        (-8.5, 4.0, 4.0),  # between them, as on a face
        (-99.0, 7.95, 8.0),  # the nearest column
    ],
)
def test_dimension_is_that_of_the_model(view: PathView, z: float, radius: float, expected: float) -> None:
    shown(view, SHAFT)
    assert view.part_player is not None
    assert view.part_player.latest_result is not None
    part = view.part_player.latest_result.part_instant
    part = part._replace(x_plus_half=half((0.0, 8.0), (2.0, 6.0)))
    assert find_exact_radius(part, z, radius, 0.1) == expected
    assert find_exact_radius(part._replace(x_plus_half=None), z, radius, 0.1) == radius


def test_pointer_shows_dimension_of_part(view: PathView) -> None:
    """The radius of the shaft is .4 in at Z-.4."""
    solid(view, SHAFT)
    player, pane = view.part_player, view.panes[0]
    assert player is not None
    player.read_time_s.now += 1.0  # type: ignore[attr-defined]
    before = settled(view)
    result = player.latest_result
    assert result is not None
    assert result.view is not None
    size = round(pane.area.width()), round(pane.area.height())
    x, y = result.view.project_to_screen(np.array([[0.4 * INCH, -0.4 * INCH, 145.0]]), *size)[0]
    place = find_dimension(result, QPointF(x, y))
    assert place is not None
    assert place[1] / INCH == pytest.approx(0.4, abs=0.0002)
    assert place[0] / INCH == pytest.approx(-0.4, abs=0.01)
    assert find_dimension(result, QPointF(2.0, 2.0)) is None
    assert view.hasMouseTracking()
    QTest.mouseMove(view, (pane.area.topLeft() + QPointF(x, y)).toPoint())
    assert view.grab().toImage() != before


def test_pointer_shows_no_dimension_in_coarse_picture(view: PathView) -> None:
    solid(view, SHAFT)
    assert view.part_player is not None
    result = view.part_player.latest_result
    assert result is not None
    middle = QPointF(view.panes[0].area.width() / 2, view.panes[0].area.height() / 2)
    assert find_dimension(result._replace(pixel_size=2), middle) is None
    assert find_dimension(result._replace(picture=None), middle) is None


def test_mouse_is_not_tracked_in_flat_views(view: PathView) -> None:
    solid(view, SHAFT)
    view.select_next_view()
    view.select_next_view()
    assert view.panes[0].aspect is PathViewKind.PATH
    assert not view.hasMouseTracking()


@pytest.mark.parametrize(("height", "has_more"), [(400, True), (130, False)])
def test_low_view_has_no_buttons_that_cover_part(view: PathView, height: int, has_more: bool) -> None:
    solid(view, SHAFT)
    view.resize(800, height)
    symbols = {button.symbol for button in make_view_buttons(view)}
    assert ({"CUT", "∠", "BLANK"} <= symbols) is has_more
    assert {"+", "VIEW", "FIT"} <= symbols
    assert {"X", "Shift+X", "G"} <= view.make_part_key_actions().keys()
