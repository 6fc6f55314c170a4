"""The polar field: what becomes of a half section, how columns divide, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.part.polar_field import PolarField, make_field_from_section, sort_intervals
from core.part.tool_polygons import PartError
from tests.coded import raises_code

ALL = slice(None)


def ring(columns: int = 10, rays: int = 36, most: int = 40) -> PolarField:
    """A tube of radii 2 and 5, 10 mm long."""
    shape = (1, columns, rays)
    return PolarField(np.linspace(-10.0, 0.0, columns + 1), np.full(shape, 2.0), np.full(shape, 5.0), most)


def take(
    field: PolarField, start: float, end: float, columns: slice | None = None, *, cut: bool = True
) -> float:
    there = columns or slice(0, len(field.column_centers))
    return field.find_removed_material(
        there, ALL, np.full((1, 1), start), np.full((1, 1), end), remove=cut
    ).volume_mm3


# --- from a half section


@pytest.mark.parametrize("columns", [8, 100, 900])
def test_cone_has_expected_volume_in_few_columns(columns: int) -> None:
    edges = np.linspace(-30.0, 0.0, 30_001)
    high = -0.4 * 0.5 * (edges[1:] + edges[:-1])
    field = make_field_from_section(edges, np.zeros((1, 30_000)), high[None], columns)
    assert len(field.column_centers) <= columns
    assert field.volume_mm3 == pytest.approx(math.pi * 144.0 * 30.0 / 3.0, rel=1e-6)


def test_shoulder_is_at_turned_position() -> None:
    edges = np.linspace(-20.0, 0.0, 2001)
    high = np.where(0.5 * (edges[1:] + edges[:-1]) > -7.33, 4.0, 9.0)
    field = make_field_from_section(edges, np.zeros((1, 2000)), high[None], 12)
    assert np.min(np.abs(field.column_edges + 7.33)) < 1e-9
    assert set(np.round(field.outer_radii[0, :, 0], 9)) == {4.0, 9.0}


def test_air_at_both_ends_has_no_columns() -> None:
    edges = np.linspace(-20.0, 5.0, 2501)
    z = 0.5 * (edges[1:] + edges[:-1])
    high = np.where((z < 0.0) & (z > -15.0), 6.0, 0.0)
    field = make_field_from_section(edges, np.zeros((1, 2500)), high[None])
    assert (field.column_edges[0], field.column_edges[-1]) == pytest.approx((-15.0, 0.0))


def test_layers_are_sorted_by_radius() -> None:
    low = np.array([[7.0, 0.0], [1.0, 3.0]])
    high = np.array([[9.0, 0.0], [2.0, 4.0]])
    low, high = sort_intervals(low, high)
    assert low.tolist() == [[1.0, 3.0], [7.0, 0.0]]
    assert high.tolist() == [[2.0, 4.0], [9.0, 0.0]]


# --- cuts


def test_ring_removed_from_middle_leaves_two_layers() -> None:
    field = ring()
    whole = field.volume_mm3
    assert take(field, 3.0, 4.0) == pytest.approx(math.pi * 7.0 * 10.0)
    assert field.volume_mm3 == pytest.approx(whole - math.pi * 7.0 * 10.0)
    assert field.inner_radii[:, 0, 0].tolist() == [2.0, 4.0]
    assert field.outer_radii[:, 0, 0].tolist() == [3.0, 5.0]


def test_query_does_not_remove_material() -> None:
    field = ring()
    assert take(field, 3.0, 4.0, cut=False) == pytest.approx(math.pi * 7.0 * 10.0)
    assert field.change_count == 0
    assert field.volume_mm3 == pytest.approx(math.pi * 21.0 * 10.0)


@pytest.mark.parametrize(("start", "end"), [(0.0, 2.0), (5.0, 9.0), (4.0, 3.0), (math.inf, math.inf)])
def test_cut_outside_material_or_with_reversed_bounds_removes_nothing(start: float, end: float) -> None:
    field = ring()
    assert take(field, start, end) == 0.0
    assert field.change_count == 0


def test_cut_reports_position_and_depth() -> None:
    field = ring()
    told = field.find_removed_material(slice(3, 6), ALL, np.full((3, 1), 4.5), np.full((3, 1), math.inf))
    assert (told.back_z_mm, told.front_z_mm, told.depth_mm) == pytest.approx((-7.0, -4.0, 0.5))


def test_copy_is_not_changed_by_later_cuts() -> None:
    field = ring()
    copy = field.copy()
    take(field, 0.0, 9.0)
    assert field.volume_mm3 == 0.0
    assert copy.volume_mm3 == pytest.approx(math.pi * 21.0 * 10.0)


# --- columns that divide


def test_dividing_columns_preserves_volume() -> None:
    field = ring()
    take(field, 4.0, 9.0, slice(2, 5))
    before = field.volume_mm3
    field.divide_columns(np.array([-9.3, -6.5, -6.45]))
    assert len(field.column_centers) == 13
    assert field.volume_mm3 == pytest.approx(before)


@pytest.mark.parametrize("place", [-10.0, 0.0, 3.0, -4.0, -4.001, -math.inf])
def test_column_is_not_divided_at_edge_or_outside_part(place: float) -> None:
    field = ring()
    field.divide_columns(np.array([place]))
    assert len(field.column_centers) == 10


def test_column_count_is_limited() -> None:
    field = ring(most=15)
    field.divide_columns(np.linspace(-9.9, -0.1, 500))
    assert len(field.column_centers) == 15
    field.divide_columns(np.array([-3.21]))
    assert len(field.column_centers) == 15


# --- what is refused


def test_section_without_material_is_rejected() -> None:
    with raises_code(PartError, "no-stock"):
        make_field_from_section(np.linspace(0.0, 1.0, 11), np.ones((1, 10)), np.ones((1, 10)))


@pytest.mark.parametrize(
    ("edges", "code"),
    [
        ([0.0, 1.0], "columns-and-edges"),
        ([0.0, 1.0, 2.0, 3.0], "columns-and-edges"),
        ([0.0, 2.0, 1.0], "edges-not-rising"),
        ([0.0, 0.0, 1.0], "edges-not-rising"),
    ],
)
def test_invalid_column_edges_are_rejected(edges: list[float], code: str) -> None:
    with raises_code(PartError, code):
        PolarField(np.array(edges), np.zeros((1, 2, 8)), np.ones((1, 2, 8)))


def test_layers_of_different_shape_are_rejected() -> None:
    with raises_code(PartError, "columns-and-edges"):
        PolarField(np.array([0.0, 1.0]), np.zeros((1, 1, 8)), np.ones((2, 1, 8)))
