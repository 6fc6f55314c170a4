"""Curves whose points coincide: they are read in a bounded number of steps, and the contour stays whole."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from core.extras.drawings import spline_spans
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.reader_tools import CurvePoint, fit_arcs
from core.geometry.lines_and_arcs import Point
from tests.extras.drawings.hand import dxf, profile_of

CASES = Path(__file__).parents[3].parent / "shared" / "cases" / "drawings"
NEAR = 0.002


class Counted:
    """A curve that counts how often it is evaluated, and fails where that never ends."""

    def __init__(self, at: Any, way: Any) -> None:
        self.at, self.way, self.count = at, way, 0

    def __call__(self, u: float) -> CurvePoint:
        self.count += 1
        assert self.count < 2000, "evaluated too often"
        return CurvePoint(self.at(u), self.way(u))


def still(_u: float) -> Point:
    return (3.0, 4.0)


def nowhere(_u: float) -> Point:
    return (0.0, 0.0)


def shiver(u: float) -> Point:
    return (3.0 + 0.4 * NEAR * math.sin(50.0 * u), 4.0)


def spin(u: float) -> Point:
    return (math.cos(50.0 * u), math.sin(50.0 * u))


@pytest.mark.parametrize("at", [still, shiver])
@pytest.mark.parametrize("way", [nowhere, spin])
def test_zero_length_curve_is_fitted_without_subdivision(at: Any, way: Any) -> None:
    """Halving to the deepest level would evaluate 2**14 pieces."""
    curve = Counted(at, way)
    found = list(fit_arcs(curve, NEAR))
    assert sum(each.length for each in found) <= 3 * NEAR
    assert curve.count < 30


def test_closed_curve_is_fitted_at_full_length() -> None:
    """A circle of radius 5 begins and ends at the same point: 2 pi 5 = 31.416 long."""
    turn = 2.0 * math.pi
    curve = Counted(
        lambda u: (5.0 * math.cos(turn * u), 5.0 * math.sin(turn * u)),
        lambda u: (-math.sin(turn * u), math.cos(turn * u)),
    )
    assert sum(each.length for each in fit_arcs(curve, NEAR)) == pytest.approx(31.416, abs=0.01)


def shaft(space: Any, *middle: tuple[float, float], times: int = 60) -> None:
    """A shaft of radius 6 and 10; the step is a spline with ``times`` coincident control points."""
    points = [(-20, 6, 0), (-24, 6, 0), *((x, y, 0) for x, y in middle for _ in range(times)), (-30, 10, 0)]
    space.add_line((0, 0), (0, 6))
    space.add_line((0, 6), (-20, 6))
    space.add_open_spline(points, degree=3)
    space.add_line((-30, 10), (-40, 10))
    space.add_line((-40, 10), (-40, 0))


def counting(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    count = [0]
    curve_of = spline_spans.make_span_curve

    def counted(*args: Any) -> Any:
        curve = curve_of(*args)

        def place(u: float) -> CurvePoint:
            count[0] += 1
            assert count[0] < 20_000, "evaluated too often"
            return curve(u)

        return place

    monkeypatch.setattr(spline_spans, "make_span_curve", counted)
    return count


@pytest.mark.parametrize("middle", [((-30.0, 10.0),), ((-27.0, 8.0),), ((-26.0, 7.0), (-28.0, 9.0))])
def test_a_spline_with_coincident_points_is_part_of_the_contour(
    middle: tuple[tuple[float, float], ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    count = counting(monkeypatch)
    chosen = profile_of(dxf(tmp_path / "x.dxf", lambda space: shaft(space, *middle)))
    assert (chosen.front_z_mm - chosen.back_z_mm, chosen.elements[-1].end[0]) == pytest.approx(
        (40.0, 10.0), abs=1e-3
    )
    assert count[0] < 5_000


def test_sample_drawing_with_a_zero_length_spline_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    path = CASES / "zero-length-spline.dxf"
    if not path.is_file():
        pytest.skip(f"no {path}")
    count = counting(monkeypatch)
    assert len(read_drawing(path).elements) == 20
    assert count[0] < 2_000
