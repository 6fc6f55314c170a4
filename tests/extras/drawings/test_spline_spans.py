"""Splines in spans: arcs near the curve, few evaluations of long splines, and knots that are refused."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from ezdxf.math import BSpline

from core.extras.drawings import spline_spans
from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.reader_tools import fit_arcs
from core.extras.drawings.spline_spans import fit_biarcs, make_span_curve, make_spans
from tests.extras.drawings.hand import dxf

NEAR = 0.002
WAVE = [(-0.1 * k, 10.0 + 2.0 * math.sin(0.02 * k)) for k in range(3000)]
WEIGHTS = [1.0 + 0.5 * (k % 3) for k in range(8)]


def spline(weights: list[float] | None) -> BSpline:
    points = [(-float(k), 6.0 + k % 3, 0.0) for k in range(8)]
    return BSpline(points, order=4, weights=weights)


@pytest.mark.parametrize("weights", [None, WEIGHTS])
def test_spline_span_matches_curve_and_tangent(weights: list[float] | None) -> None:
    curve = spline(weights)
    spans = make_spans(curve.control_points, curve.weights(), curve.knots(), 3)
    assert len(spans.parameter_lengths) == 5
    for number in range(5):
        place = make_span_curve(spans, number)
        for u in (0.0, 0.3, 1.0):
            t = (number + min(max(u, 1e-6), 1.0 - 1e-6)) / 5
            _, way = next(iter(curve.derivatives([t], 1)))
            assert place(u).point == pytest.approx(tuple(curve.point((number + u) / 5))[:2], abs=1e-9)
            assert place(u).tangent == pytest.approx((way.x, way.y), abs=1e-6)


@pytest.mark.parametrize("weights", [None, WEIGHTS])
@pytest.mark.parametrize("near", [0.002, 0.05, 0.5])
def test_batch_arc_fit_matches_the_fit_of_single_spans(weights: list[float] | None, near: float) -> None:
    curve = spline(weights)
    spans = make_spans(curve.control_points, curve.weights(), curve.knots(), 3)
    for number, fit in enumerate(fit_biarcs(spans, near)):
        alone = list(fit_arcs(make_span_curve(spans, number), near))
        assert (fit is not None) == (len(alone) == 2)
        if fit is not None:
            assert alone[0].end[::-1] == pytest.approx(fit.joint, abs=1e-9)
            assert alone[1].end[::-1] == pytest.approx(fit.end, abs=1e-9)


def test_a_long_spline_is_not_evaluated_span_by_span(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def evaluated(*_args: Any) -> Any:
        raise AssertionError

    monkeypatch.setattr(spline_spans, "make_span_curve", evaluated)
    file = dxf(tmp_path / "x.dxf", lambda space: space.add_open_spline(WAVE, degree=3))
    drawn = read_drawing(file).elements
    ends = [each.element.end[::-1] for each in drawn]
    assert 2997 <= len(drawn) <= 2 * 2997
    assert ends[-1] == pytest.approx(WAVE[-1], abs=1e-9)
    assert max(abs(y - 10.0 - 2.0 * math.sin(-0.2 * x)) for x, y in ends[10:-10]) < NEAR


def test_a_spline_that_a_knot_interrupts_is_refused(tmp_path: Path) -> None:
    def broken(space: Any) -> None:
        each = space.add_spline(degree=2)
        each.control_points = [(-k, 6 + k % 2, 0) for k in range(8)]
        each.knots = [0, 0, 0, 0.2, 0.3, 0.3, 0.3, 0.6, 1, 1, 1]

    with pytest.raises(DrawingError) as caught:
        read_drawing(dxf(tmp_path / "x.dxf", broken))
    assert caught.value.code == "damaged"


def test_repeated_knots_are_allowed_up_to_a_corner() -> None:
    knots = [0, 0, 0, 0.3, 0.3, 0.6, 1, 1, 1]
    spans = make_spans([(-float(k), 6.0 + k % 2) for k in range(6)], (), knots, 2)
    assert list(spans.parameter_lengths) == pytest.approx([0.3, 0.3, 0.4])
