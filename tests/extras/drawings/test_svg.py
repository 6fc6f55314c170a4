"""SVG drawings: paths, transforms and units; what is no drawing is refused in one sentence."""

from __future__ import annotations

import math
from pathlib import Path
from unittest.mock import Mock

import pytest

from core.extras.drawings import svg_reader
from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import (
    ContourSide,
    DrawingPlacement,
    extract_profile,
    find_contours,
    select_axis,
)
from core.extras.drawings.reader_tools import CurvePoint
from core.geometry.lines_and_arcs import Arc, Line
from tests.coded import raises_code
from tests.extras.drawings.hand import SLIM, profile_of, program, radii


def svg(path: Path, body: str, size: str = 'width="60mm" height="40mm" viewBox="0 0 60 40"') -> Path:
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{body}</svg>')
    return path


def test_path_of_lines_and_an_arc_matches_the_drawing(tmp_path: Path) -> None:
    """A shaft of 10 with a fillet of 2 to a shoulder of 20, moved by its group; Y points down in SVG."""
    path = svg(
        tmp_path / "a.svg",
        '<g transform="translate(50,20)"><path d="M0 0V-5H-10A2 2 0 0 1 -12 -7V-10H-25V0Z"/></g>',
    )
    chosen = profile_of(path)
    assert (chosen.front_z_mm, chosen.back_z_mm) == (0.0, pytest.approx(-25.0, abs=1e-4))
    at = [-1.0, -9.0, -11.0, -12.5, -24.0]
    expected = [5.0, 5.0, 7.0 - math.sqrt(4.0 - 1.0), 10.0, 10.0]
    assert radii(program(chosen, {1: SLIM}), "bar:21mm:80mm", at, {1: SLIM}) == pytest.approx(
        expected, abs=0.01
    )


def test_bezier_curve_is_converted_to_arcs(tmp_path: Path) -> None:
    """Every point of the arcs lies on the cubic B(t) of the four points, within .003 mm."""
    path = svg(tmp_path / "b.svg", '<path d="M50 15C40 15 40 10 30 10V20"/>')
    arcs = [each.element for each in read_drawing(path).elements if isinstance(each.element, Arc)]
    unit = read_drawing(path).unit_mm
    a, b, c, d = (50, 15), (40, 15), (40, 10), (30, 10)
    curve = [
        tuple(
            (1 - t) ** 3 * p + 3 * t * (1 - t) ** 2 * q + 3 * t * t * (1 - t) * r + t**3 * s
            for p, q, r, s in zip(a, b, c, d, strict=True)
        )
        for t in (k / 2000 for k in range(2001))
    ]
    assert 4 <= len(arcs) <= 40
    for arc in arcs:
        y, x = (v * unit for v in arc.get_point(arc.length / 3))
        assert (
            min(math.dist((x, -y), p) for p in curve) < 0.003 + 0.01
        )  # and half the step of the curve's points


def test_elliptical_arc_is_converted_to_arcs(tmp_path: Path) -> None:
    path = svg(tmp_path / "e.svg", '<path d="M50 20A20 8 0 0 0 30 12V20Z"/>')
    chosen = profile_of(path, axis="LOWEST LINE")
    at = [-1.0, -7.0, -19.0]
    expected = [8.0 * math.sqrt(1.0 - ((z + 20.0) / 20.0) ** 2) for z in at]
    assert radii(program(chosen, {1: SLIM}), "bar:18mm:80mm", at, {1: SLIM}) == pytest.approx(
        expected, abs=0.01
    )


def test_shapes_and_units_are_read(tmp_path: Path) -> None:
    drawn = read_drawing(
        svg(tmp_path / "c.svg", '<rect width="10" height="4"/><line x2="5"/><polyline points="0,0 1,1"/>')
    )
    assert sum(isinstance(each.element, Line) for each in drawn.elements) == 6
    assert drawn.unit_mm == pytest.approx(25.4 / 96)
    bare = read_drawing(svg(tmp_path / "d.svg", "<line x2='5'/>", 'viewBox="0 0 60 40"'))
    assert bare.unit_mm == 0.0


HEAD = "<svg xmlns='http://www.w3.org/2000/svg' width='40mm' height='20mm' viewBox='0 0 40 20'>"


@pytest.mark.parametrize(
    ("text", "code", "value"),
    [
        ("<svg xmlns='http://www.w3.org/2000/svg'><text>M8</text></svg>", "nothing-drawn", "x.svg"),
        ("<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0L1", "damaged", "x.svg"),
        ("no drawing at all", "damaged", "SVG"),
        (
            "<svg xmlns='http://www.w6.org/2000/svg'><path d='M0 0L1 5'/></svg>",
            "damaged",
            "namespace",
        ),
        (f"{HEAD}<rect x='1' y='1' width='5e24' height='2'/></svg>", "too-far-from-zero", "x.svg"),
        (f"{HEAD}<path d='M0 0 A5 50 0 0 0 {'5' * 50} 10 h10'/></svg>", "too-far-from-zero", "x.svg"),
        (f"{HEAD}<path d='T5 5 L0 0 A5 5 0 0 0 5 10'/></svg>", "path-without-start", "x.svg"),
        (f"{HEAD}<path d='L5 5 H20'/></svg>", "path-without-start", "x.svg"),
        ("<?xml version='1.0'?><!DOCTYPE s [<!ENTITY a 'b'>]><svg>&a;</svg>", "own-entities", "x.svg"),
    ],
)
def test_invalid_svg_is_rejected(tmp_path: Path, text: str, code: str, value: str) -> None:
    path = tmp_path / "x.svg"
    path.write_text(text)
    with raises_code(DrawingError, code, value):
        read_drawing(path)


def test_contour_bulging_past_its_ends_is_rejected(tmp_path: Path) -> None:
    """An arc of R 5 about 20, 5 from -30 to 60 degrees: its foremost point, at 25, is none of its ends."""
    path = tmp_path / "x.svg"
    path.write_text(f"{HEAD}<path d='M0 2.5 H24.330127 A5 5 0 0 1 22.5 9.330127 H0'/></svg>")
    drawing = read_drawing(path)
    view = DrawingPlacement(select_axis(drawing, ""), drawing.unit_mm or 1.0)
    (net,) = find_contours(drawing, view)
    with raises_code(DrawingError, "front-in-arc"):
        extract_profile(drawing, view, net, ContourSide.OUTSIDE)
    with raises_code(DrawingError, "no-bore"):
        extract_profile(drawing, view, net, ContourSide.INSIDE)


@pytest.mark.parametrize(
    "text",
    [
        '<circle cx="1e999" cy="4" r="2"/>',
        '<ellipse cx="4" cy="4" rx="1e999" ry="2"/>',
        '<g transform="translate(1e999)"><path d="M0 0C1 1 2 2 3 0A3 4 0 0 1 5 5"/></g>',
        '<polyline points="0,0 1e999,1"/>',
    ],
)
def test_infinite_values_are_rejected(tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before curves are halved again and again for it."""
    asked = Mock(wraps=CurvePoint)
    monkeypatch.setattr(svg_reader, "CurvePoint", asked)
    with pytest.raises(DrawingError) as raised:
        read_drawing(svg(tmp_path / "x.svg", f'<line x2="5"/>{text}'))
    assert raised.value.code in {"not-a-number", "damaged", "too-far-from-zero"}
    assert "x.svg" in str(raised.value)
    assert asked.call_count < 1000
