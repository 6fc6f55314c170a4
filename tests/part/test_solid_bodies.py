"""Tools in the solid picture: where they are seen, and what hides them."""

from __future__ import annotations

import numpy as np
import pytest

from core.part.picture.part_scene import ImageArray, PartColors, PartScene
from core.part.picture.solid_bodies import SymmetryAxis, ToolBody
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView
from core.part.picture.surface_points import Solid, make_turned_solid

WIDTH, HEIGHT = 400, 300
GOLD, GREY = PartColors().insert, PartColors().holder
SIDE = SolidView(azimuth_deg=0.0, tilt_deg=0.0, pixels_per_mm=8.0, center_z_mm=-10.0)
ABOVE = SolidView(azimuth_deg=0.0, tilt_deg=90.0, pixels_per_mm=8.0, center_z_mm=-10.0)
SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 6.0], [0.0, 6.0]])


def shaft(radius: float = 5.0) -> Solid:
    count = 2000
    return make_turned_solid(
        np.linspace(-20.0, 0.0, count + 1), np.zeros((1, count)), np.full((1, count), radius)
    )


def at(z: float, x: float) -> np.ndarray:
    moved: np.ndarray = SQUARE + np.array([z, x])
    return moved


def drawn(view: SolidView, tool: ToolBody | None = None) -> ImageArray:
    return SolidPicture().draw_picture(shaft(), view, WIDTH, HEIGHT, scene=PartScene(tool=tool))


def like(image: ImageArray, colour: int) -> np.ndarray:
    """Which pixels are of this colour, whatever its light: red and blue stand to green as they do."""
    r, g, b = (((image >> off) & 255).astype(float) + 1e-9 for off in (16, 8, 0))
    red, green, blue = ((colour >> 16) & 255, (colour >> 8) & 255, colour & 255)
    near = (abs(r / g - red / green) < 0.03) & (abs(b / g - blue / green) < 0.06)
    return near & (image >> 24 > 0) & (g > 20)


def test_tool_is_drawn_from_above_at_its_position() -> None:
    """Four by six mm before the shaft: X+ is down."""
    found = like(drawn(ABOVE, ToolBody((at(-12.0, 5.0),), ())), GOLD)
    rows, columns = np.nonzero(found)
    assert len(rows) == pytest.approx(24.0 * 64.0, rel=0.03)
    assert (columns.min(), columns.max()) == pytest.approx((200 - 16, 200 + 15), abs=1)
    assert (rows.min(), rows.max()) == pytest.approx((150 + 40, 150 + 88), abs=1)


def test_tool_hides_shaft_from_side_and_shaft_hides_tool_from_rear() -> None:
    tool = ToolBody((at(-12.0, 5.0),), ())
    before = np.count_nonzero(like(drawn(SIDE, tool), GOLD))
    assert before == pytest.approx(4.0 * 4.0 * 64.0, rel=0.1)  # as thick as it is wide, below the rake face
    behind = SolidView(azimuth_deg=0.0, tilt_deg=180.0, pixels_per_mm=8.0, center_z_mm=-10.0)
    assert np.count_nonzero(like(drawn(behind, tool), GOLD)) == 0


def test_a_drill_is_round() -> None:
    """Seen from the side it is as high as it is wide; 6 mm thick, it stands 10 mm out of the face."""
    outline = np.array([[-5.0, -3.0], [10.0, -3.0], [10.0, 3.0], [-5.0, 3.0]])
    for view in (SIDE, ABOVE):
        rows, columns = np.nonzero(like(drawn(view, ToolBody((outline,), (), SymmetryAxis.Z)), GOLD))
        assert np.ptp(rows) + 1 == pytest.approx(48, abs=2)
        assert (columns.min(), columns.max()) == pytest.approx((200 + 80, 200 + 159), abs=2)


def test_assumed_holder_is_drawn_transparent() -> None:
    solid, ghost = (
        drawn(ABOVE, ToolBody((), (at(-12.0, 0.0),), is_body_assumed=ghost)) for ghost in (False, True)
    )
    bare = drawn(ABOVE)
    there = like(solid, GREY)
    assert there.any()
    assert (solid[there] != bare[there]).all()
    far = np.abs((ghost[there] & 255).astype(int) - (bare[there] & 255).astype(int)).max()
    assert 0 < far < np.abs((solid[there] & 255).astype(int) - (bare[there] & 255).astype(int)).max()


def test_distant_tool_does_not_change_picture() -> None:
    bare = drawn(SIDE)
    for z in (-500.0, 500.0):
        tool = ToolBody((at(z, 5.0),), (at(z, 11.0),))
        np.testing.assert_array_equal(drawn(SIDE, tool), bare)
    np.testing.assert_array_equal(drawn(SIDE, ToolBody((at(-12.0, 900.0),), ())), bare)
