"""Random paths of mills: a point is metal or not by its distance from the tool at every instant.

The distances are asked of a dense series of places along the path in x, y and z; the removal knows no such
series. Points nearer to a surface than what its steps may leave are not asked.
"""

from __future__ import annotations

import numpy as np
import pytest

from core.part.milled_part import MilledPart
from core.part.polar_field import make_field_from_section
from core.part.ray_cuts import FloatArray

LENGTH, RADIUS, BORE = 20.0, 10.0, 2.0
NEAR = 0.02  # mm
PLACES = 4001


def tube() -> MilledPart:
    edges = np.linspace(-LENGTH, 0.0, 2001)
    return MilledPart(make_field_from_section(edges, np.full((1, 2000), BORE), np.full((1, 2000), RADIUS)))


def somewhere(part: MilledPart, random: np.random.Generator, count: int) -> tuple[FloatArray, np.ndarray]:
    """Points r, angle, z on the field's own rays and columns, and whether it has metal there."""
    field = part.field
    column, ray = random.integers(0, len(field.column_centers), count), random.integers(0, 720, count)
    r = random.uniform(BORE, RADIUS, count)
    within = (field.inner_radii[:, column, ray] < r) & (r < field.outer_radii[:, column, ray])
    metal = np.asarray(within.any(axis=0))
    return np.column_stack([r, field.ray_angles[ray], field.column_centers[column]]), metal


def along(path: FloatArray) -> FloatArray:
    """Places all along a path, its corners among them."""
    share = np.linspace(0.0, len(path) - 1.0, PLACES)
    return np.column_stack([np.interp(share, np.arange(len(path)), each) for each in path.T])


def depth_axial(points: FloatArray, path: FloatArray, radius: float, length: float) -> FloatArray:
    """How far each point lies within an end mill at the best of its places; negative: how far off it."""
    x, y = points[:, 0] * np.cos(points[:, 1]), points[:, 0] * np.sin(points[:, 1])
    best = np.full(len(points), -np.inf)
    for px, py, pz in along(path):
        above = points[:, 2] - pz
        best = np.maximum(
            best, np.minimum(radius - np.hypot(x - px, y - py), np.minimum(above, length - above))
        )
    return best


def depth_radial(points: FloatArray, path: FloatArray, radius: float, height: float) -> FloatArray:
    """The same for a mill on a radius, ``path`` r, z, degrees."""
    best = np.full(len(points), -np.inf)
    for end, z, degrees in along(path):
        turned = points[:, 1] - np.radians(degrees)
        u, w = points[:, 0] * np.sin(turned) - height, points[:, 0] * np.cos(turned)
        best = np.maximum(best, np.minimum(radius - np.hypot(u, points[:, 2] - z), w - end))
    return best


def check(metal: np.ndarray, depth: FloatArray) -> None:
    sure = np.abs(depth) > NEAR
    assert np.count_nonzero(sure) > 0.8 * len(depth)
    assert np.array_equal(metal[sure], depth[sure] < 0.0)


@pytest.mark.parametrize("seed", range(6))
def test_axial_mill_removes_points_within_its_path(seed: int) -> None:
    random, part = np.random.default_rng(seed), tube()
    path = np.column_stack([random.uniform(-12.0, 12.0, (4, 2)), random.uniform(-15.0, 1.0, 4)])
    radius, length = random.uniform(0.5, 4.0), random.choice([6.0, 100.0])
    before = part.field.volume_mm3
    told = part.mill_axial_path(path, radius, cutting_length=length)
    assert part.field.volume_mm3 == pytest.approx(before - told.volume_mm3, rel=1e-9)
    points, metal = somewhere(part, random, 1500)
    check(metal, depth_axial(points, path, radius, length))


@pytest.mark.parametrize("height", [0.0, 1.5])
@pytest.mark.parametrize("seed", range(6))
def test_radial_mill_removes_points_within_its_path(seed: int, height: float) -> None:
    random, part = np.random.default_rng(seed), tube()
    path = np.column_stack(
        [
            random.uniform(5.0, 9.5, 4),
            random.uniform(-18.0, -2.0, 4),
            np.cumsum(random.uniform(-90.0, 90.0, 4)),
        ]
    )
    path[2, 1:] = path[1, 1:]  # in r alone,
    path[1, [0, 2]] = path[0, [0, 2]]  # and in Z alone
    radius = random.uniform(0.8, 3.0)
    before = part.field.volume_mm3
    told = part.mill_radial_path(path, radius, axis_offset=height)
    assert part.field.volume_mm3 == pytest.approx(before - told.volume_mm3, rel=1e-9)
    points, metal = somewhere(part, random, 1500)
    check(metal, depth_radial(points, path, radius, height))


@pytest.mark.parametrize("seed", range(4))
def test_collision_check_agrees_with_material_removal(seed: int) -> None:
    random, part = np.random.default_rng(seed), tube()
    for _ in range(5):
        place = random.uniform(-14.0, 14.0, 2)
        axial = np.column_stack([place, place + random.uniform(-4.0, 4.0, 2)]).T
        path = np.column_stack([axial, random.uniform(-6.0, 3.0, 2)])
        meets = part.has_axial_collision(path, 1.5)
        assert bool(part.mill_axial_path(path, 1.5).depth_mm > 0.01) <= meets
        path = np.column_stack(
            [random.uniform(6.0, 13.0, 2), random.uniform(-25.0, 4.0, 2), random.uniform(0.0, 360.0, 2)]
        )
        meets = part.has_radial_collision(path, 1.5)
        assert bool(part.mill_radial_path(path, 1.5).depth_mm > 0.03) <= meets
        assert not part.has_radial_collision(path, 1.5)
