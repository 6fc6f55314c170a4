"""Contours that a turning tool follows in part: balls that fall, grooves behind flanges, nicks, open ends."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import ContourSide, find_axes
from core.extras.drawings.turning_contour import calculate_tool_angle_limits
from tests.extras.drawings.hand import BLADE, RIGHT, SLIM, chain, dxf, profile_of, program, radii

NEAR = 0.01  # mm of a radius


def test_ball_is_followed_down_to_the_slope_of_the_tool(tmp_path: Path) -> None:
    """A ball of 5 on a shaft of 12: on it down to the slope of the tool's edge, then straight along that."""

    def draw(space: Any) -> None:
        space.add_line((0, 6), (-10, 6))
        space.add_arc((-15, 6), 5, 0, 90)
        space.add_arc((-15, 6), 5, 90, 180)
        space.add_line((-20, 6), (-30, 6))

    a = calculate_tool_angle_limits(SLIM, ContourSide.OUTSIDE).max_falling_angle_rad - math.radians(2.0)
    made = program(profile_of(dxf(tmp_path / "ball.dxf", draw)), {1: SLIM})
    turn = -15.0 - 5.0 * math.sin(a)

    def r(z: float) -> float:
        if z > -10.0:
            return 6.0
        if z > turn:
            return 6.0 + math.sqrt(25.0 - (z + 15.0) ** 2)
        return max(6.0, 6.0 + 5.0 * math.cos(a) - (turn - z) * math.tan(a))

    at = [-5.0, -11.0, -14.0, -16.0, turn + 0.1, turn - 0.5, turn - 1.5, -24.0, -29.0]
    assert radii(made, "bar:23mm:80mm", at, {1: SLIM}) == pytest.approx([r(z) for z in at], abs=NEAR)
    assert [round(left.front_z_mm, 2) for left in made.uncut_ranges] == [round(turn, 2)]


@pytest.mark.parametrize(
    ("points", "first"),
    [
        (((0, 20), (-3, 24), (-6, 20), (-46, 20)), "Y 0"),
        (((0, 20), (0, 24), (-10, 24), (-10, 26), (-46, 26), (-46, 20), (0, 20)), "LOWEST LINE"),
    ],
)
def test_lowest_line_is_the_axis_only_if_it_closes_the_contour(
    tmp_path: Path, points: tuple[tuple[float, float], ...], first: str
) -> None:
    """A cylinder at the end of a side view is its lowest line, too, and no axis."""
    assert find_axes(read_drawing(dxf(tmp_path / "side.dxf", chain(*points))))[0].name == first


def test_groove_with_slanted_walls_after_a_flange_is_recognized(tmp_path: Path) -> None:
    """Flange of 24, cone to 16, groove of 10 from -15 to -22 with walls that lean by 1 in 3 and 2 in 3."""
    path = dxf(
        tmp_path / "flange.dxf",
        chain(
            (0, 0), (0, 12), (-5, 12), (-11, 8), (-15, 8), (-16, 5), (-20, 5), (-22, 8), (-30, 8), (-30, 0)
        ),
    )
    tools = {1: SLIM, 5: BLADE}
    made = program(profile_of(path), tools, BLADE=5.0)
    at = [-4.0, -8.0, -14.0, -15.5, -18.0, -21.0, -25.0]
    assert radii(made, "bar:25mm:80mm", at, tools) == pytest.approx(
        [12.0, 10.0, 8.0, 6.5, 5.0, 6.5, 8.0], abs=0.02
    )
    (groove,) = [one for one, _ in made.shapes if one.shape.name == "GROOVE"]
    assert (groove.get_number("OVER"), groove.get_number("FANGLE"), groove.get_number("CANGLE")) == (
        24.0,
        pytest.approx(18.435, abs=1e-3),
        pytest.approx(33.69, abs=1e-3),
    )


def test_fillet_smaller_than_the_nose_is_enlarged_to_fit_it(tmp_path: Path) -> None:
    """Fillet of .2 at a shoulder, nose of .4: G41 goes on, and the corner holds what a nose of .42 leaves."""
    quarter = math.tan(math.radians(90.0) / 4.0)
    points = ((0, 0), (0, 5), (-10, 5, -quarter), (-10.2, 5.2), (-10.2, 8), (-20, 8), (-20, 0))
    made = program(profile_of(dxf(tmp_path / "nick.dxf", chain(*points))), {1: RIGHT})
    assert "G41" in made.lines
    left = 5.42 - math.sqrt(0.42**2 - 0.32**2)  # at z -10.1, the centre lies at -9.78
    found = radii(made, "bar:17mm:80mm", [-5.0, -9.7, -10.1, -10.3, -19.0], {1: RIGHT})
    assert found == pytest.approx([5.0, 5.0, left, 8.0, 8.0], abs=NEAR)


def test_falling_contour_end_leaves_room_for_the_nose_to_exit(tmp_path: Path) -> None:
    """45 degrees down to the end: compensation lets go of both lines only behind the corner between them."""
    points = ((0, 0), (0, 8), (-10, 8), (-13, 5), (-13, 0))
    made = program(profile_of(dxf(tmp_path / "end.dxf", chain(*points))), {1: SLIM})
    assert radii(made, "bar:17mm:80mm", [-5.0, -11.0, -12.9], {1: SLIM}) == pytest.approx(
        [8.0, 7.0, 5.1], abs=NEAR
    )


def test_svg_editor_metadata_is_not_counted_as_omitted(tmp_path: Path) -> None:
    path = tmp_path / "notes.svg"
    head = (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:e="urn:e" width="9mm" height="9mm" viewBox="0 0 9 9">'
    )
    path.write_text(f'{head}<e:view zoom="3"/><metadata/><path d="M0 0H5"/><text>A</text></svg>')
    assert read_drawing(path).omitted_object_counts == {"text": 1}
