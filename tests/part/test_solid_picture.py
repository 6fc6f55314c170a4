"""The solid picture: what is seen where, by areas and places worked out from the part, not from pictures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.part.milled_part import MilledPart
from core.part.picture.clamping_bodies import BodyMaterial, RoundBody
from core.part.picture.part_scene import ImageArray, PartColors, PartScene
from core.part.picture.picture_edges import soften_steps
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView, fit_view, make_coarse_view
from core.part.picture.surface_points import Solid, make_milled_solid, make_turned_solid
from core.part.polar_field import make_field_from_section

WIDTH, HEIGHT = 420, 300
RED = ((-1e9, 1e9),)


def turned(*steps: tuple[float, float], bore: float = 0.0, deep: float = 0.0) -> Solid:
    """A shaft of ``steps`` (length, radius) from Z0 backwards, bored ``deep`` from its face."""
    parts = [(round(length / 0.01), radius) for length, radius in steps]
    high = np.concatenate([np.full(count, radius) for count, radius in parts[::-1]])
    edges = np.linspace(-0.01 * len(high), 0.0, len(high) + 1)
    low = np.where(0.5 * (edges[1:] + edges[:-1]) > -deep, bore, 0.0)
    return make_turned_solid(edges, low[None], high[None])


def milled(length: float = 20.0, radius: float = 10.0) -> MilledPart:
    count = round(length / 0.01)
    edges = np.linspace(-length, 0.0, count + 1)
    return MilledPart(make_field_from_section(edges, np.zeros((1, count)), np.full((1, count), radius)))


def draw(solid: Solid, view: SolidView, hits: tuple[tuple[float, float], ...] = ()) -> ImageArray:
    return SolidPicture().draw_picture(solid, view, WIDTH, HEIGHT, hit_z_spans=hits)


def red(image: ImageArray) -> np.ndarray:
    """Where it is painted red; glints are paler."""
    return ((image >> 16) & 255) > 1.3 * ((image >> 8) & 255)


def orange(image: ImageArray) -> np.ndarray:
    """Where a cut face is: its green lies between, twice its blue nearly."""
    r, g, b = (((image >> shift) & 255).astype(int) for shift in (16, 8, 0))
    return (r > 1.4 * g) & (r < 2.0 * g) & (g > 1.6 * b)


# --- places and areas


@pytest.mark.parametrize("azimuth", [0.0, 25.0, -25.0, 60.0, -80.0, 89.0])
def test_cylinder_outline_has_its_size(azimuth: float) -> None:
    image = draw(turned((30.0, 8.0)), SolidView(azimuth_deg=azimuth, pixels_per_mm=7.0, center_z_mm=-15.0))
    cos, sin = math.cos(math.radians(azimuth)), abs(math.sin(math.radians(azimuth)))
    area = 30.0 * 16.0 * cos + math.pi * 64.0 * sin
    assert np.count_nonzero(image) == pytest.approx(area * 49.0, rel=0.02)
    rows, columns = np.nonzero(image)
    assert np.ptp(rows) + 1 == pytest.approx(16.0 * 7.0, abs=2)
    assert np.ptp(columns) + 1 == pytest.approx((30.0 * cos + 16.0 * sin) * 7.0, abs=2)


@pytest.mark.parametrize(
    ("azimuth", "least", "most"),
    [(40.0, 0.98, 1.02), (0.0, 0.98, 1.02), (-40.0, 0.60, 0.80)],
)
def test_flange_and_pin_hide_each_other_by_view(azimuth: float, least: float, most: float) -> None:
    """From its face the flange is seen whole; from behind half as thick a pin stands before its middle.

    That takes half the strip of 10 mm across its ellipse, and half the pin's own ellipse: 80 of 278 mm².
    """
    solid = turned((5.0, 10.0), (15.0, 5.0))
    image = draw(
        solid, SolidView(azimuth_deg=azimuth, pixels_per_mm=9.0, center_z_mm=-10.0), hits=((-5.0, 1.0),)
    )
    cos, sin = math.cos(math.radians(azimuth)), abs(math.sin(math.radians(azimuth)))
    flange = (5.0 * 20.0 * cos + math.pi * 100.0 * sin) * 81.0
    assert least * flange < np.count_nonzero(red(image)) < most * flange


def test_half_section_shows_cut_area() -> None:
    solid = turned((20.0, 9.0), (10.0, 6.0), bore=4.0, deep=12.0)
    image = draw(
        solid,
        SolidView(azimuth_deg=0.0, pixels_per_mm=9.0, center_z_mm=-15.0, cut_out_range_deg=(-90.0, 90.0)),
    )
    area = 2.0 * (20.0 * 9.0 + 10.0 * 6.0 - 12.0 * 4.0)
    assert np.count_nonzero(orange(image)) == pytest.approx(area * 81.0, rel=0.02)


def test_picture_without_section_shows_no_cut_faces() -> None:
    image = draw(turned((20.0, 9.0), bore=4.0, deep=12.0), SolidView(pixels_per_mm=9.0, center_z_mm=-10.0))
    assert not orange(image).any()
    assert not red(image).any()


def test_bore_is_visible_only_from_its_open_end() -> None:
    solid = turned((20.0, 9.0), bore=5.0, deep=12.0)
    bore = PartColors(outside=0x0000FF, bore=0x00FF00)

    def green(azimuth: float) -> int:
        view = SolidView(azimuth_deg=azimuth, pixels_per_mm=9.0, center_z_mm=-10.0)
        image = SolidPicture(bore).draw_picture(solid, view, WIDTH, HEIGHT)
        return int(np.count_nonzero(((image >> 8) & 255) > (image & 255)))

    # Of the mouth's ellipse the bottom of the bore takes a part: it is 12 deep and 10 wide.
    mouth = math.pi * 25.0 * math.sin(math.radians(30.0)) * 81.0
    assert 0.8 * mouth < green(30.0) < 1.05 * mouth
    assert green(-30.0) == 0
    assert green(0.0) == 0


# --- turned by hand and by C


def hole_at(angle: float, end: float = 2.0) -> Solid:
    part = milled()
    part.mill_radial_path(np.array([[12.0, -10.0, angle], [end, -10.0, angle]]), 2.0)
    return make_milled_solid(part.field)


@pytest.mark.parametrize(
    ("angle", "tilt", "roll", "place"),
    [
        (180.0, 0.0, 0.0, "middle"),  # lathe X+ looks at the operator
        (90.0, 90.0, 0.0, "middle"),  # from above the part's Y
        (0.0, 90.0, 0.0, "top"),  # and lathe X- is the upper edge, as in the path view
        (0.0, 0.0, 180.0, "middle"),  # C turns X to where the operator stands
        (90.0, 0.0, 90.0, "middle"),
        (90.0, 0.0, 0.0, "top"),
        (0.0, 0.0, 0.0, "hidden"),
    ],
)
def test_hole_position_follows_c_rotation_and_tilt(
    angle: float, tilt: float, roll: float, place: str
) -> None:
    view = SolidView(azimuth_deg=0.0, tilt_deg=tilt, roll_deg=roll, pixels_per_mm=12.0, center_z_mm=-10.0)
    plain = draw(make_milled_solid(milled().field), view)
    blind, through = draw(hole_at(angle), view), draw(hole_at(angle, -12.0), view)
    gone = (plain != 0) & (blind == 0)
    assert bool(through[HEIGHT // 2, WIDTH // 2] == 0) is (place != "top")
    assert bool(np.count_nonzero(gone) > 20) is (place == "top")
    assert bool(np.count_nonzero(plain != blind) == 0) is (place == "hidden")
    if place == "top":
        assert np.nonzero(gone)[0].max() < HEIGHT // 2


@pytest.mark.parametrize("azimuth", [0.0, 35.0, -50.0])
@pytest.mark.parametrize("roll", [0.0, 77.0])
def test_projected_point_matches_picture(azimuth: float, roll: float) -> None:
    """The middle of a blind hole that looks at the viewer as far as it can."""
    view = SolidView(azimuth_deg=azimuth, tilt_deg=20.0, roll_deg=roll, pixels_per_mm=11.0, center_z_mm=-9.0)
    angle = 180.0 - 20.0 - roll
    plain, drilled = (draw(solid, view) for solid in (make_milled_solid(milled().field), hole_at(angle)))
    rows, columns = np.nonzero(plain != drilled)
    rim = view.project_to_screen(np.array([[10.0, -10.0, angle]]), WIDTH, HEIGHT)[0]
    near = np.abs(columns - rim[0]) < 40.0  # The rim of the end face is also drawn slightly differently.
    rows, columns = rows[near], columns[near]
    assert rows.mean() == pytest.approx(rim[1], abs=2.0)
    assert columns.mean() == pytest.approx(rim[0], abs=8.0)


def test_unmilled_field_looks_like_turned_part() -> None:
    view = SolidView(azimuth_deg=30.0, pixels_per_mm=9.0, center_z_mm=-10.0)
    one, other = draw(turned((20.0, 10.0)), view), draw(make_milled_solid(milled().field), view)
    assert np.count_nonzero((one == 0) != (other == 0)) < 0.006 * np.count_nonzero(one)
    both = (one != 0) & (other != 0)
    level = [((image[both] >> 8) & 255).astype(int) for image in (one, other)]
    assert np.percentile(np.abs(level[0] - level[1]), 99) <= 4


def test_flat_is_lit_evenly_and_the_round_is_not() -> None:
    part = milled()
    part.mill_radial_path(np.array([[8.0, 5.0, 160.0], [8.0, -30.0, 160.0]]), 7.0)
    image = draw(
        make_milled_solid(part.field),
        SolidView(azimuth_deg=0.0, tilt_deg=20.0, pixels_per_mm=11.0, center_z_mm=-10.0),
    )
    rows = ((image[:, WIDTH // 2] >> 8) & 255).astype(int)
    middle = HEIGHT // 2
    assert np.ptp(rows[middle - 55 : middle + 55]) <= 3  # the flat is 12 wide: 66 pixels on either side
    assert np.ptp(rows[middle + 75 : middle + 105]) > 10


# --- what is not there


def test_part_outside_picture_leaves_background() -> None:
    view = SolidView(pixels_per_mm=10.0, center_z_mm=200.0)
    assert not draw(turned((20.0, 5.0)), view).any()
    ground = SolidPicture(PartColors(background=0xFF102030)).draw_picture(
        turned((20.0, 5.0)), view, WIDTH, HEIGHT
    )
    assert np.all(ground == 0xFF102030)


def test_part_larger_than_the_picture_fills_it() -> None:
    image = draw(turned((60.0, 30.0)), SolidView(azimuth_deg=0.0, pixels_per_mm=40.0, center_z_mm=-30.0))
    assert np.count_nonzero(image) == WIDTH * HEIGHT


def test_collisions_are_red_only_at_their_positions() -> None:
    solid, view = turned((20.0, 5.0)), SolidView(azimuth_deg=0.0, pixels_per_mm=10.0, center_z_mm=-10.0)
    image = draw(solid, view, hits=((-12.0, -8.0),))
    columns = np.flatnonzero(red(image).any(axis=0))
    assert columns[0] == pytest.approx(WIDTH / 2 - 20, abs=2)
    assert columns[-1] == pytest.approx(WIDTH / 2 + 20, abs=2)
    assert red(draw(solid, view, RED))[image != 0].mean() > 0.9


def test_picture_changes_with_part_version() -> None:
    part, picture = milled(), SolidPicture()
    view = SolidView(azimuth_deg=30.0, pixels_per_mm=9.0, center_z_mm=-10.0)
    before = picture.draw_picture(
        make_milled_solid(part.field), view, WIDTH, HEIGHT, version=part.field.change_count
    )
    part.mill_axial_path(np.array([[0.0, 0.0, -4.0]]), 6.0)
    after = picture.draw_picture(
        make_milled_solid(part.field), view, WIDTH, HEIGHT, version=part.field.change_count
    )
    assert np.count_nonzero(before != after) > 1000


@pytest.mark.parametrize("azimuth", [0.0, 30.0, 90.0])
def test_fitted_part_is_within_picture(azimuth: float) -> None:
    scale, centre = fit_view(-40.0, 2.0, 9.0, WIDTH, HEIGHT, azimuth)
    image = draw(
        turned((42.0, 9.0)), SolidView(azimuth_deg=azimuth, pixels_per_mm=scale, center_z_mm=centre - 2.0)
    )
    rows, columns = np.nonzero(image)
    assert rows.min() > 0
    assert rows.max() < HEIGHT - 1
    assert columns.min() > 0
    assert columns.max() < WIDTH - 1
    assert max(np.ptp(rows) / HEIGHT, np.ptp(columns) / WIDTH) > 0.9


@pytest.mark.parametrize("pixel_size", [2, 3])
def test_coarse_picture_shows_the_part_at_the_same_place(pixel_size: int) -> None:
    view = SolidView(azimuth_deg=30.0, pixels_per_mm=9.0, center_z_mm=-10.0, offset_px=(8.0, -5.0))
    coarse_view, width, height = make_coarse_view(view, 421, 301, pixel_size)
    picture, solid = SolidPicture(), hole_at(150.0)
    fine, coarse = (
        picture.draw_picture(solid, *seen) for seen in ((view, 421, 301), (coarse_view, width, height))
    )
    assert coarse.shape == (-(-301 // pixel_size), -(-421 // pixel_size))
    larger = coarse.repeat(pixel_size, axis=0).repeat(pixel_size, axis=1)[:301, :421]
    assert np.count_nonzero((fine != 0) != (larger != 0)) < 0.01 * pixel_size * np.count_nonzero(fine)
    for found in (np.nonzero(fine), np.nonzero(larger)):
        # The middle of the part is at Z-10, so it is displaced only by the offset.
        assert found[0].mean() == pytest.approx(150.0 - 5.0, abs=1.0)
        assert found[1].mean() == pytest.approx(210.0 + 8.0, abs=1.0)


def transparencies(image: ImageArray) -> set[int]:
    return set(np.unique(image >> 24).tolist())


def test_outline_of_fine_picture_has_intermediate_steps() -> None:
    """A cone whose outline crosses the pixels: 4 samples give the opacities 64, 128 and 191."""
    count = 500
    edges = np.linspace(-20.0, 0.0, count + 1)
    cone = make_turned_solid(edges, np.zeros((1, count)), np.linspace(9.0, 3.0, count)[None])
    view = SolidView(azimuth_deg=0.0, pixels_per_mm=9.0, center_z_mm=-10.0)
    first, mean, fine = (each.image for each in SolidPicture().refine_picture(cone, view, WIDTH, HEIGHT))
    one_sample = SolidPicture().draw_picture(cone, view, WIDTH, HEIGHT)
    assert transparencies(one_sample) == {0, 255}
    assert not transparencies(first) <= {0, 255}
    assert transparencies(mean) == {0, 128, 255}
    assert transparencies(fine) == {0, 64, 128, 191, 255}
    assert fine[HEIGHT // 2, WIDTH // 2] >> 24 == 255


def test_corner_of_profile_is_drawn_as_dark_edge() -> None:
    """A chamfer of 45°: its corners are at Z-8 and Z-4, and the cone between them is evenly bright."""
    count = 2000
    edges = np.linspace(-20.0, 0.0, count + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    radii = np.clip(np.where(middles < -4.0, 9.0 - (middles + 8.0), 5.0), 5.0, 9.0)
    image = draw(
        make_turned_solid(edges, np.zeros((1, count)), radii[None]),
        SolidView(azimuth_deg=0.0, tilt_deg=0.0, pixels_per_mm=12.0, center_z_mm=-10.0),
    )
    light = ((image[HEIGHT // 2] >> 8) & 255).astype(int)
    for z, is_edge in ((-8.0, True), (-4.0, True), (-12.0, False), (-6.0, False), (-2.0, False)):
        column = round(WIDTH / 2 + 12.0 * (z + 10.0))
        near, darkest = light[column - 6], light[column - 3 : column + 3].min()
        assert bool(darkest < 0.8 * near) is is_edge


def test_cylinder_without_corners_has_no_edges_inside_its_outline() -> None:
    image = draw(turned((20.0, 9.0)), SolidView(azimuth_deg=0.0, pixels_per_mm=9.0, center_z_mm=-10.0))
    light = ((image[:, WIDTH // 2] >> 8) & 255).astype(int)
    inside = light[HEIGHT // 2 - 76 : HEIGHT // 2 + 76]  # the radius is 81 pixels
    assert np.abs(np.diff(inside)).max() <= 8


def test_softened_step_has_mean_of_neighbors() -> None:
    """A pixel weighs 4 of 8, and each of its neighbors 1: 255 next to one of 0 becomes 223."""
    image = np.full((6, 6), 0xFFFFFFFF, np.uint32)
    image[:, :3] = 0xFF000000
    softened = soften_steps(image) & 255
    assert softened[2].tolist() == [0, 0, 32, 223, 255, 255]
    assert softened[0].tolist() == [0, 0, 0, 255, 255, 255]  # the border of the picture is unchanged


def test_even_picture_is_not_softened() -> None:
    gradient = np.broadcast_to(np.arange(0, 96, 16, dtype=np.uint32) * 0x010101 + 0xFF000000, (6, 6)).copy()
    np.testing.assert_array_equal(soften_steps(gradient), gradient)


@pytest.mark.parametrize(("azimuth", "tilt"), [(0.0, 0.0), (30.0, 35.0), (-40.0, 10.0)])
def test_surface_point_of_pixel_has_its_z_and_radius(azimuth: float, tilt: float) -> None:
    """On the side of a cylinder of 18 mm, at the point closest to the viewer of Z-12 and Z-6."""
    view = SolidView(azimuth_deg=azimuth, tilt_deg=tilt, pixels_per_mm=9.0, center_z_mm=-10.0)
    *_, drawn = SolidPicture().refine_picture(turned((20.0, 9.0)), view, WIDTH, HEIGHT)
    for z in (-12.0, -6.0):
        x, y = view.project_to_screen(np.array([[9.0, z, 180.0 - tilt]]), WIDTH, HEIGHT)[0]
        found = drawn.find_surface_point(view, int(x), int(y))
        assert found == pytest.approx((z, 9.0), abs=0.15)


@pytest.mark.parametrize(("column", "row"), [(0, 0), (-1, 10), (10, -1), (WIDTH, 10), (10, HEIGHT)])
def test_pixel_without_part_has_no_surface_point(column: int, row: int) -> None:
    view = SolidView(azimuth_deg=0.0, pixels_per_mm=9.0, center_z_mm=-10.0)
    *_, drawn = SolidPicture().refine_picture(turned((20.0, 9.0)), view, WIDTH, HEIGHT)
    assert drawn.find_surface_point(view, column, row) is None


def test_hidden_part_has_no_surface_point() -> None:
    view = SolidView(azimuth_deg=0.0, pixels_per_mm=9.0, center_z_mm=-10.0)
    scene = PartScene((RoundBody(-12.0, -8.0, 12.0, 12.0, BodyMaterial.CHUCK),))
    *_, drawn = SolidPicture().refine_picture(turned((20.0, 9.0)), view, WIDTH, HEIGHT, scene=scene)
    assert drawn.find_surface_point(view, WIDTH // 2, HEIGHT // 2) is None
    assert drawn.find_surface_point(view, WIDTH // 2 + 60, HEIGHT // 2) is not None


def test_canceled_picture_raises_the_error_of_the_check() -> None:
    calls: list[None] = []

    def cancel_at_second_call() -> None:
        calls.append(None)
        if len(calls) == 2:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        SolidPicture().draw_picture(
            turned((20.0, 9.0)), SolidView(), WIDTH, HEIGHT, check_canceled=cancel_at_second_call
        )
    assert len(calls) == 2


def test_step_between_faces_that_are_lit_alike_has_an_edge() -> None:
    """An island on the face: seen from nearly in front its far rim stands before a floor as light."""
    part = milled()
    turn = np.linspace(0.0, 2.0 * math.pi, 200)
    part.mill_axial_path(np.column_stack([7.5 * np.cos(turn), 7.5 * np.sin(turn), np.full(200, -4.0)]), 2.5)
    view = SolidView(azimuth_deg=60.0, tilt_deg=0.0, pixels_per_mm=12.0, center_z_mm=-4.0)
    image = draw(make_milled_solid(part.field), view)
    # At phi 180 on the rim of the island, and 3 pixels within and beyond it.
    column = round(
        WIDTH / 2 + 12.0 * (4.0 * math.cos(math.radians(60.0)) + 5.0 * math.sin(math.radians(60.0)))
    )
    light = ((image[HEIGHT // 2, column - 5 : column + 6] >> 8) & 255).astype(int)
    assert abs(light[0] - light[-1]) <= 2
    assert light.min() < 0.8 * light[0]
