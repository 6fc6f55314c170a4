"""Chuck, jaws, bar and tailstock in the solid picture: places and areas worked out from their dimensions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.part.picture.body_picture import draw_bodies
from core.part.picture.clamping_bodies import (
    BlockBody,
    Body,
    BodyMaterial,
    RoundBody,
    find_clamping_back_z,
    make_clamping_bodies,
    make_stock_bodies,
)
from core.part.picture.part_scene import PartScene
from core.part.picture.point_projection import DEPTH_STEPS, FAR_DEPTH
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView
from core.part.picture.surface_points import make_turned_solid
from core.part.stock import Clamping, Stock, make_bar_stock

WIDTH, HEIGHT, SCALE = 400, 300, 8.0
SIDE = SolidView(azimuth_deg=0.0, tilt_deg=0.0, pixels_per_mm=SCALE, center_z_mm=-10.0)
BAR = make_bar_stock(10.0, 0.0, -20.0)


def materials(bodies: tuple[Body, ...], view: SolidView) -> np.ndarray:
    """The material at each pixel, or -1."""
    codes: np.ndarray = draw_bodies(bodies, view, WIDTH, HEIGHT).codes >> 8
    return codes


def column(z: float) -> int:
    return round(WIDTH / 2 + SCALE * (z + 10.0))


def height_at(image: np.ndarray, z: float, material: BodyMaterial) -> int:
    rows = np.flatnonzero(image[:, column(z)] == material)
    return int(np.ptp(rows)) + 1 if len(rows) else 0


def test_collet_has_its_face_and_both_diameters() -> None:
    """Its nose of 16 mm begins 15 mm behind part zero; the body of 24 mm begins 3 mm further back."""
    image = materials(make_clamping_bodies(Clamping(24.0, 15.0, 3.0, 16.0), BAR), SIDE)
    columns = np.flatnonzero((image == BodyMaterial.CHUCK).any(axis=0))
    assert columns.max() == pytest.approx(column(-15.0), abs=1)
    assert height_at(image, -16.0, BodyMaterial.CHUCK) == pytest.approx(16 * SCALE, abs=2)
    assert height_at(image, -19.0, BodyMaterial.CHUCK) == pytest.approx(24 * SCALE, abs=2)
    assert not (image == BodyMaterial.JAW).any()


def test_chuck_with_long_front_has_three_jaws() -> None:
    """From the face, the jaws are every 120 degrees; the first points up when the viewer is at the side."""
    bodies = make_clamping_bodies(Clamping(60.0, 15.0, 12.0, 50.0), BAR)
    jaws = [body for body in bodies if isinstance(body, BlockBody)]
    assert sorted({jaw.angle_deg % 360.0 for jaw in jaws}) == [90.0, 210.0, 330.0]
    assert {jaw.back_z_mm for jaw in jaws} == {-27.0, -21.0}
    assert max(jaw.front_z_mm for jaw in jaws) == -15.0
    assert max(jaw.outer_mm for jaw in jaws) == 25.0
    image = materials(bodies, SolidView(0.0, 0.0, 0.0, 4.0, -20.0))
    rows = np.flatnonzero(image[:, round(200 + 4.0 * (-24.0 + 20.0))] == BodyMaterial.JAW)
    assert rows.min() == pytest.approx(150 - 25 * 4, abs=1)  # the upper jaw
    # The lower jaws point 30 degrees below the horizontal; their lower corners are at
    # 25 sin 30 + 4.5 cos 30 = 16.4 mm, because they are 0.36 * 25 = 9 mm wide.
    assert rows.max() == pytest.approx(150 + 16.4 * 4, abs=2)


def test_unspecified_chuck_begins_at_the_back_of_the_stock() -> None:
    bodies = make_clamping_bodies(None, BAR)
    fronts = {
        material: max(b.front_z_mm for b in bodies if b.material is material)
        for material in (BodyMaterial.CHUCK, BodyMaterial.JAW, BodyMaterial.BAR)
    }
    assert fronts[BodyMaterial.JAW] == fronts[BodyMaterial.BAR] == -20.0
    assert fronts[BodyMaterial.CHUCK] == find_clamping_back_z(None, BAR) == -30.0
    assert make_clamping_bodies(Clamping(0.0, 0.0, max_rpm=3000.0), BAR) == bodies


def test_bar_connects_short_stock_with_chuck() -> None:
    clamping = Clamping(24.0, 40.0, 3.0, 16.0)
    image = materials(make_clamping_bodies(clamping, BAR), SIDE)
    assert height_at(image, -30.0, BodyMaterial.BAR) == pytest.approx(10 * SCALE, abs=2)
    assert height_at(image, -19.0, BodyMaterial.BAR) == 0
    long_stock = make_bar_stock(10.0, 0.0, -80.0)
    assert not (materials(make_clamping_bodies(clamping, long_stock), SIDE) == BodyMaterial.BAR).any()


def test_tailstock_center_is_a_cone() -> None:
    """60 degrees: 8 mm of quill begin 4 / tan 30 = 6.93 mm after the tip at Z-2."""
    held = Clamping(24.0, 40.0, quill_diameter=8.0, center_angle_deg=60.0, center_z_mm=-2.0)
    image = materials(make_clamping_bodies(held, BAR), SIDE)
    for z in (0.0, 2.0, 4.0):
        expected = 2.0 * (z + 2.0) * math.tan(math.radians(30.0)) * SCALE
        assert height_at(image, z, BodyMaterial.TAILSTOCK) == pytest.approx(expected, abs=2)
    assert height_at(image, 6.0, BodyMaterial.TAILSTOCK) == pytest.approx(8 * SCALE, abs=2)
    assert height_at(image, -3.0, BodyMaterial.TAILSTOCK) == 0


@pytest.mark.parametrize("azimuth", [0.0, 30.0, -60.0, 85.0])
def test_cylinder_outline_has_its_area(azimuth: float) -> None:
    body = RoundBody(-20.0, 0.0, 6.0, 6.0, BodyMaterial.BAR)
    view = SolidView(azimuth_deg=azimuth, pixels_per_mm=SCALE, center_z_mm=-10.0)
    cos, sin = math.cos(math.radians(azimuth)), abs(math.sin(math.radians(azimuth)))
    area = (20.0 * 12.0 * cos + math.pi * 36.0 * sin) * SCALE**2
    assert np.count_nonzero(materials((body,), view) >= 0) == pytest.approx(area, rel=0.01)


@pytest.mark.parametrize("angle", [0.0, 45.0, 90.0])
def test_block_outline_has_its_area(angle: float) -> None:
    """Seen from the side, a block 10 long, 4 wide and 5 high at an angle is 10 · (5 sin + 4 cos) mm²."""
    block = BlockBody(-15.0, -5.0, 3.0, 8.0, 4.0, angle)
    turn = math.radians(angle)
    area = 10.0 * (5.0 * math.sin(turn) + 4.0 * math.cos(turn)) * SCALE**2
    assert np.count_nonzero(materials((block,), SIDE) >= 0) == pytest.approx(area, rel=0.02)


def test_nearer_body_hides_the_other() -> None:
    """Toward the operator, at the polar angle 180 degrees, a block is in front of the bar."""
    bar = RoundBody(-20.0, 0.0, 5.0, 5.0, BodyMaterial.BAR)
    near, far = (BlockBody(-12.0, -8.0, 6.0, 9.0, 4.0, angle) for angle in (180.0, 0.0))
    for bodies in ((bar, near), (near, bar)):
        images = draw_bodies(bodies, SIDE, WIDTH, HEIGHT)
        assert images.codes[HEIGHT // 2, column(-10.0)] >> 8 == BodyMaterial.JAW
        depth = images.depth[HEIGHT // 2, column(-10.0)] / DEPTH_STEPS - FAR_DEPTH
        assert depth == pytest.approx(9.0 * SCALE, abs=0.1)
    assert materials((far, bar), SIDE)[HEIGHT // 2, column(-10.0)] == BodyMaterial.BAR


def test_body_outside_picture_is_not_drawn() -> None:
    for z in (-500.0, 500.0):
        bodies = (
            RoundBody(z, z + 5.0, 6.0, 6.0, BodyMaterial.BAR),
            BlockBody(z, z + 5.0, 3.0, 8.0, 4.0, 0.0),
        )
        assert not (materials(bodies, SIDE) >= 0).any()


def test_clamping_from_behind_does_not_hide_part() -> None:
    solid = make_turned_solid(np.linspace(-20.0, 0.0, 501), np.zeros((1, 500)), np.full((1, 500), 5.0))
    scene = PartScene(make_clamping_bodies(None, BAR))
    for azimuth, is_opaque in ((30.0, True), (-60.0, False)):
        view = SolidView(azimuth_deg=azimuth, pixels_per_mm=SCALE, center_z_mm=-20.0)
        image = SolidPicture().draw_picture(solid, view, WIDTH, HEIGHT, scene=scene)
        assert (set(np.unique(image >> 24).tolist()) <= {0, 255}) is is_opaque


def test_stock_is_transparent_and_as_large_as_uncut() -> None:
    """The stock of 10 × 20 mm covers a thinner part; its opacity is 30 percent of 255."""
    solid = make_turned_solid(np.linspace(-20.0, 0.0, 501), np.zeros((1, 500)), np.full((1, 500), 3.0))
    scene = PartScene(stock=make_stock_bodies(BAR))
    alpha = SolidPicture().draw_picture(solid, SIDE, WIDTH, HEIGHT, scene=scene) >> 24
    assert np.count_nonzero(alpha) == pytest.approx(20 * 10 * SCALE**2, rel=0.02)
    assert np.count_nonzero(alpha == 255) == pytest.approx(20 * 6 * SCALE**2, rel=0.02)
    assert set(np.unique(alpha).tolist()) == {0, 76, 255}


def test_step_of_stock_has_no_length() -> None:
    stepped = Stock("", ((-20.0, 5.0), (-10.0, 5.0), (-10.0, 3.0), (0.0, 3.0)))
    lengths = [body.front_z_mm - body.back_z_mm for body in make_stock_bodies(stepped)]
    assert lengths == [10.0, 10.0]
