"""Parts of drawings: the proved part has the radii that the drawing's figures come to, by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.extras.drawings.profile_trial import TrialStock, run_profile_trial
from core.extras.drawings.drawing_placement import ContourSide, FaceEnd, ZeroPosition
from core.extras.drawings.profile_description import is_nose_fillet
from core.extras.shapes.contour import resolve_contour_points
from core.language.source import Dialect
from tests.extras.drawings.hand import BLADE, SLIM, chain, dxf, profile_of, program, radii, text_of
from tests.extras.shapes.hand import machine
from tests.sinumerik.lathe import LINEAR
from tests.texts import text

NEAR = 0.01  # mm of a radius: columns of .008 and what the profile of a part is fitted to
QUARTER = math.tan(math.radians(90.0) / 4.0)
SHAFT = (
    (0, 0), (0, 9), (-1, 10), (-10, 10), (-10, 8), (-13, 8), (-13, 10), (-18, 10), (-20, 12),
    (-30, 12, -QUARTER), (-32, 14), (-32, 18, QUARTER), (-34, 20), (-50, 20), (-50, 0),
)  # fmt: skip


def shaft(z: float) -> float:
    """Chamfer, cylinder, groove, taper of 45 degrees, fillet of 2, shoulder with a radius of 2."""
    steps: tuple[tuple[float, Callable[[], float]], ...] = (
        (-1.0, lambda: 9.0 - z),
        (-10.0, lambda: 10.0),
        (-13.0, lambda: 8.0),
        (-18.0, lambda: 10.0),
        (-20.0, lambda: 10.0 + (-18.0 - z)),
        (-30.0, lambda: 12.0),
        (-32.0, lambda: 14.0 - math.sqrt(4.0 - (z + 30.0) ** 2)),
        (-34.0, lambda: 18.0 + math.sqrt(4.0 - (z + 34.0) ** 2)),
    )
    return next((r() for end, r in steps if z >= end), 20.0)


SEEN = (
    -0.1, -0.5, -0.9, -2, -9.9, -10.1, -11.5, -12.9, -13.1, -17.5, -18.7, -19.5, -20.5, -29, -30.5, -31,
    -31.5, -32.1, -32.5, -33, -33.9, -34.5, -49.9,
)  # fmt: skip


@pytest.mark.parametrize("metric", [True, False])
def test_shaft_of_lines_and_arcs_matches_the_drawing(tmp_path: Path, metric: bool) -> None:
    """Faced, roughed, finished beside the nose, grooved: to the figures of the drawing."""
    chosen = profile_of(dxf(tmp_path / "shaft.dxf", chain(*SHAFT)))
    made = program(chosen, metric=metric, STOCK=1.0 if metric else 0.04)
    found = radii(made, "bar:41mm:120mm+1.016mm", SEEN)
    assert found == pytest.approx([shaft(z) for z in SEEN], abs=NEAR)


def test_generated_program_has_comments_drawing_values_and_nose_offset(tmp_path: Path) -> None:
    """Each piece by its comment, figures as the drawing has them, the nose to the left of the way."""
    made = program(profile_of(dxf(tmp_path / "shaft.dxf", chain(*SHAFT))), STOCK=1.0)
    lines = text_of(made).splitlines()
    assert [line.partition("(")[2].split()[0] for line in lines if "(" in line] == [
        "HEAD", "FACE", "TURN", "GROOVE",
    ]  # fmt: skip
    finish = lines[lines.index("G41") : lines.index("G40")]
    assert finish == [
        "G41", "Z0D1", "X20Z-1", "Z-18", "X24Z-20", "Z-30", "G03X28Z-32R2", "X36", "G02X40Z-34R2", "Z-50.5",
        "X42", "G00Z25",
    ]  # fmt: skip
    assert made.nose_offset is not None
    assert (made.nose_offset.x, made.nose_offset.z, made.nose_offset.nose_radius) == (-0.4, -0.4, 0.4)
    assert not made.uncut_ranges


def test_ball_end_of_an_inch_half_section_matches_the_drawing(tmp_path: Path) -> None:
    """r = sqrt(R^2 - (z + R)^2) from the axis to a shaft; drawn above its axis, which is its lowest line."""
    up = [(5.0, 2.0), (3.0, 2.0), (3.0, 2.25), (4.75, 2.25, -QUARTER), (5.0, 2.0)]
    chosen = profile_of(dxf(tmp_path / "ball.dxf", chain(*up), unit=1))
    made = program(chosen, {1: SLIM}, metric=False)
    at = [-0.01, -0.5, -2.0, -4.0, -6.0, -7.0, -20.0, -50.0]
    r = 6.35
    expected = [math.sqrt(r * r - (z + r) ** 2) if z > -r else r for z in at]
    assert radii(made, "bar:.5625:3", at, {1: SLIM}) == pytest.approx(expected, abs=NEAR)


def test_ellipse_is_converted_to_arcs(tmp_path: Path) -> None:
    """A nose of half axes 20 and 8: r = 8 sqrt(1 - ((z + 20) / 20)^2)."""

    def draw(space: object) -> None:
        space.add_ellipse((-20, 0), (20, 0), 0.4, 0.0, math.pi / 2)  # type: ignore[attr-defined]
        space.add_line((-20, 8), (-30, 8))  # type: ignore[attr-defined]

    made = program(profile_of(dxf(tmp_path / "nose.dxf", draw)), {1: SLIM})
    at = [-0.2, -1.0, -3.0, -7.0, -12.0, -19.0, -25.0]
    expected = [8.0 * math.sqrt(1.0 - ((z + 20.0) / 20.0) ** 2) if z > -20 else 8.0 for z in at]
    assert radii(made, "bar:18mm:80mm", at, {1: SLIM}) == pytest.approx(expected, abs=NEAR)


def test_stepped_bore_matches_the_drawing(tmp_path: Path) -> None:
    """A section drawn closed: the bore of 24 with a chamfer of 1, and of 16 behind it."""
    ring = [(0, 13), (0, 20), (-40, 20), (-40, 8), (-15, 8), (-15, 12), (-1, 12), (0, 13)]
    path = dxf(tmp_path / "ring.dxf", chain(*ring))
    made = program(profile_of(path, side=ContourSide.INSIDE, axis="Y 0"), HOLE=14.0)
    at = [-0.2, -0.8, -1.5, -14.0, -15.5, -39.0]
    found = radii(made, "tube:45mm:14mm:60mm", at, inside=True)
    assert found == pytest.approx([12.8, 12.2, 12.0, 12.0, 8.0, 8.0], abs=NEAR)
    assert "G42" in made.lines


def test_part_with_its_face_at_the_left_matches_the_drawing(tmp_path: Path) -> None:
    """Drawn with its face to the left, 5 mm from the origin: Z of the face is -5, or shifted."""
    path = dxf(tmp_path / "left.dxf", chain((5, 0), (5, 4), (15, 4), (15, 6), (25, 6), (25, 0)))
    chosen = profile_of(path, front=FaceEnd.LEFT, zero=ZeroPosition.ORIGIN)
    assert (chosen.front_z_mm, chosen.back_z_mm) == (-5.0, -25.0)
    made = program(profile_of(path, front=FaceEnd.LEFT, zero=ZeroPosition.ORIGIN, shift=5.0))
    found = radii(made, "bar:14mm:80mm", [-1.0, -9.5, -10.1, -19.0])
    assert found == pytest.approx([4.0, 4.0, 6.0, 6.0], abs=NEAR)


def test_part_with_a_vertical_axis_matches_the_drawing(tmp_path: Path) -> None:
    path = dxf(tmp_path / "up.dxf", chain((0, 0), (-4, 0), (-4, -10), (-6, -10), (-6, -20), (0, -20)))
    made = program(profile_of(path, axis="X 0"))
    assert radii(made, "bar:14mm:80mm", [-1.0, -9.5, -10.1, -19.0]) == pytest.approx([4, 4, 6, 6], abs=NEAR)


def test_full_view_with_shoulder_edges_and_title_block_is_traced(tmp_path: Path) -> None:
    """Both halves, edges of shoulders across the part, a frame about it all: the outer side is walked."""

    def draw(space: object) -> None:
        for s in (1, -1):
            chain((0, 0), (0, s * 4), (-10, s * 4), (-10, s * 6), (-20, s * 6), (-20, 0))(space)
        space.add_line((-10, -4), (-10, 4))  # type: ignore[attr-defined]
        space.add_line((5, 0), (-25, 0), dxfattribs={"linetype": "CENTER"})  # type: ignore[attr-defined]
        space.add_lwpolyline(  # type: ignore[attr-defined]
            [(-60, -40), (60, -40), (60, 40), (-60, 40)], close=True, dxfattribs={"layer": "FRAME"}
        )

    made = program(profile_of(dxf(tmp_path / "view.dxf", draw)))
    assert radii(made, "bar:14mm:80mm", [-1.0, -9.5, -10.1, -19.0]) == pytest.approx([4, 4, 6, 6], abs=NEAR)


def test_gaps_are_closed_and_reported(tmp_path: Path) -> None:
    def draw(space: object) -> None:
        for a, b in (((0, 4), (-10, 4)), ((-10.008, 4), (-10, 6)), ((-10, 6.006), (-20, 6))):
            space.add_line(a, b)  # type: ignore[attr-defined]

    chosen = profile_of(dxf(tmp_path / "gaps.dxf", draw), axis="Y 0")
    assert 0.005 < chosen.widest_closed_gap_mm < 0.01
    assert len(chosen.elements) == 3


def test_metric_drawing_is_converted_to_an_inch_program(tmp_path: Path) -> None:
    """25.4 mm long, 12.7 across: .5 and -1. in the program."""
    chosen = profile_of(dxf(tmp_path / "one.dxf", chain((0, 0), (0, 6.35), (-25.4, 6.35), (-25.4, 0))))
    lines = program(chosen, metric=False, PAST=0.0, COMP=0.0).lines
    assert "X.5Z0" in lines
    assert "Z-1" in lines


# --- grooves and falls


def groove(*inner: tuple[float, ...]) -> tuple[tuple[float, ...], ...]:
    return ((0, 0), (0, 10), (-8, 10), *inner, (-30, 10), (-30, 0))


def test_groove_chamfers_are_cut_with_the_groove(tmp_path: Path) -> None:
    """45 degrees of .5 at both edges."""
    path = dxf(
        tmp_path / "g.dxf", chain(*groove((-8.5, 9.5), (-8.5, 7), (-12.5, 7), (-12.5, 9.5), (-13, 10)))
    )
    made = program(profile_of(path))
    at = [-7.9, -8.2, -8.6, -10.0, -12.4, -12.8, -13.1]
    assert radii(made, "bar:20.5mm:80mm", at) == pytest.approx([10, 9.8, 7, 7, 7, 9.8, 10], abs=NEAR)
    assert not made.uncut_ranges


def test_v_groove_is_cut_as_deep_as_the_blade_fits(tmp_path: Path) -> None:
    """60 degrees, 2 deep: the blade of 1 goes down to where the V is 1 wide, not deeper."""
    half = 2.0 * math.tan(math.radians(30.0))
    path = dxf(tmp_path / "v.dxf", chain(*groove((-8 - half, 8), (-8 - 2 * half, 10))))
    chosen = profile_of(path)
    tools = {1: SLIM, 5: BLADE.__class__(BLADE.kind, tip=3, width=1.0, length=8.0)}
    made = program(chosen, tools)
    depth = 2.0 - 0.5 / math.tan(math.radians(30.0))
    (bottom,) = radii(made, "bar:20.5mm:80mm", [-8 - half], tools)
    assert bottom == pytest.approx(10.0 - depth, abs=NEAR)


def test_shallow_fall_is_turned_and_steep_fall_limited_by_tool_clearance(tmp_path: Path) -> None:
    """20 degrees behind an insert that clears 32 is turned; 60 degrees is left at 30."""
    drop = 5.0 * math.tan(math.radians(20.0))
    made = program(
        profile_of(
            dxf(
                tmp_path / "s.dxf",
                chain((0, 0), (0, 10), (-8, 10), (-13, 10 - drop), (-30, 10 - drop), (-30, 0)),
            )
        )
    )
    found = radii(made, "bar:20.5mm:80mm", [-7.9, -10.5, -13.5, -29.0])
    assert found == pytest.approx([10, 10 - drop / 2, 10 - drop, 10 - drop], abs=NEAR)
    drop = 2.0 * math.tan(math.radians(60.0))
    made = program(
        profile_of(
            dxf(
                tmp_path / "t.dxf",
                chain((0, 0), (0, 10), (-8, 10), (-10, 10 - drop), (-30, 10 - drop), (-30, 0)),
            )
        )
    )
    assert [each.reason for each in made.uncut_ranges] == [text("shapes.falls-too-steeply")]
    slope = math.tan(math.radians(30.0))
    at = [-9.0, -10.0, -12.0]
    assert radii(made, "bar:20.5mm:80mm", at) == pytest.approx([10 + (z + 8) * slope for z in at], abs=0.02)


@pytest.mark.parametrize("dialect", [Dialect.OMNITURN, Dialect.SINUMERIK])
@pytest.mark.parametrize(
    "behind", [((-20, 4), (-30, 4), (-30, 0)), ((-20, 4), (-30, 4), (-30, 10), (-40, 10), (-40, 0))]
)
def test_cone_falling_from_the_face_is_roughed_along_the_face(
    tmp_path: Path, behind: tuple[tuple[float, float], ...], dialect: Dialect
) -> None:
    """20 mm at the face, 8 mm at Z-20: G75 and CYCLE95 begin at the lowest X, so nothing crosses the cone."""
    chosen = profile_of(dxf(tmp_path / "cone.dxf", chain((0, 0), (0, 10), *behind)))
    made = program(chosen, {1: SLIM}, dialect=dialect)
    lathe = machine() if dialect is Dialect.OMNITURN else LINEAR
    trial = run_profile_trial(
        text_of(made), chosen, TrialStock(21.0, 0.5), made.nose_offset, lathe, {1: SLIM}, dialect=dialect
    )
    assert not trial.errors
    assert trial.comparison is not None
    assert not [each for each in trial.comparison.deviations if not is_nose_fillet(each, made.nose_radius_mm)]
    assert trial.comparison.worst_deviation_mm < 0.02
    contour = resolve_contour_points(made.shapes[-1][0].contour_points)
    assert contour[:3] == [(0.0, 4.0), (0.0, 10.0), (-20.0, 4.0)]


def test_undercut_contour_is_never_cut_too_deep(tmp_path: Path) -> None:
    """A dovetail: no tool from outside gets under its wall, which is cut upright."""
    path = dxf(tmp_path / "d.dxf", chain(*groove((-6, 7), (-16, 7), (-14, 10))))
    made = program(profile_of(path))
    assert any(each.reason == text("shapes.contour-undercut") for each in made.uncut_ranges)
    at = np.linspace(-29.0, -0.5, 200)
    assert (radii(made, "bar:20.5mm:80mm", at) > 6.99).all()
