"""Drawing of a touch-off against positions worked out by hand: part, touched surface, old and new tool.

The tip of a tool with a quadrant is on its edge, so the touched surface has the entered size. If the control
point is not on the edge, the surface is nearer by the distance to the edge: 4 mm for a drill of 8 mm, 1.5 mm
for the middle of a blade of 3 mm, and 0.8 mm for the center of a nose of this radius.
"""

from __future__ import annotations

import numpy as np
import pytest

from app.jog.touch_off_scene import (
    ToolAtPart,
    TouchedSurface,
    TouchOffScene,
    assume_working_side,
    find_working_side,
    make_touch_off_scene,
)
from core.part.insert_codes import InsertCodeError
from core.part.tool_shape import ToolHand, ToolKind, ToolShape

TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.8, insert="CNMG120408", holder="20x20")
BAR = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.4, diameter=12.0)
DRILL = ToolShape(ToolKind.DRILL, diameter=8.0)
NEAR = pytest.approx


def blade(tip: int) -> ToolShape:
    return ToolShape(ToolKind.PARTING, tip=tip, width=3.0)


def turned(tip: int, *, rear: bool = False, hand: ToolHand = ToolHand.RIGHT) -> ToolShape:
    return ToolShape(ToolKind.TURNING, hand, tip=tip, nose_radius=0.8, insert="CNMG120408", rear=rear)


def tool_range(scene: TouchOffScene, axis: int, tip: tuple[float, float] | None) -> tuple[float, float]:
    """Lowest and highest Z (axis 0) or X (axis 1) of the cutting edges with the tip at a point."""
    assert tip is not None
    values = np.concatenate(scene.tool_outline.cutting_outlines)[:, axis] + tip[axis]
    return float(values.min()), float(values.max())


def part_radii(scene: TouchOffScene) -> set[float]:
    return {round(abs(x), 6) for each in scene.part_outlines for _z, x in each}


def diameter(shape: ToolShape, new: float | None, old: float | None = None, **more: bool) -> TouchOffScene:
    """The scene of a diameter, with X as a radius; the side is the one on which the tool works."""
    side, internal = find_working_side(shape, old, new)
    return make_touch_off_scene(ToolAtPart(shape, side, internal, True, new, old, **more))


def face(shape: ToolShape, new: float | None, old: float | None = None, **more: bool) -> TouchOffScene:
    side, internal = find_working_side(shape, None)
    return make_touch_off_scene(ToolAtPart(shape, side, internal, False, new, old, **more))


@pytest.mark.parametrize(
    ("shape", "side"),
    [
        (turned(3), 1),
        (turned(4, hand=ToolHand.LEFT), 1),
        (turned(8, hand=ToolHand.NEUTRAL), 1),
        (turned(2, rear=True), -1),
        (turned(1, rear=True, hand=ToolHand.LEFT), -1),
        (turned(6, rear=True, hand=ToolHand.NEUTRAL), -1),
    ],
)
def test_outside_tool_touches_measured_diameter_on_its_side(shape: ToolShape, side: int) -> None:
    """Ø 25, and the old offset is .1 mm larger on the radius."""
    scene = diameter(shape, 12.5 * side, 12.6 * side)
    assert scene.surface is TouchedSurface.OUTSIDE_DIAMETER
    assert part_radii(scene) == {12.5}
    assert scene.touched_edge is not None
    assert [x for _z, x in scene.touched_edge] == [NEAR(12.5 * side)] * 2
    assert [x for _z, x in scene.dimension] == [NEAR(-12.5 * side), NEAR(12.5 * side)]  # the whole diameter
    low, high = tool_range(scene, 1, scene.new_tip)
    assert (low if side > 0 else high) == NEAR(12.5 * side, abs=1e-3)
    low, high = tool_range(scene, 1, scene.old_tip)
    assert (low if side > 0 else high) == NEAR(12.6 * side, abs=1e-3)


@pytest.mark.parametrize(
    ("tip", "side", "hand"), [(2, 1, ToolHand.RIGHT), (1, 1, ToolHand.LEFT), (3, -1, ToolHand.RIGHT)]
)
def test_boring_bar_touches_bore_from_inside(tip: int, side: int, hand: ToolHand) -> None:
    scene = diameter(ToolShape(ToolKind.BORING, hand, tip=tip, diameter=12.0, rear=side < 0), 15.0 * side)
    assert scene.surface is TouchedSurface.BORE
    assert min(part_radii(scene)) == NEAR(15.0)
    assert len(scene.part_outlines) == 2  # a tube, in section
    low, high = tool_range(scene, 1, scene.new_tip)
    assert (high if side > 0 else low) == NEAR(15.0 * side, abs=1e-3)


def test_drill_on_center_touches_no_diameter() -> None:
    scene = diameter(DRILL, 0.0)
    assert scene.surface is TouchedSurface.CENTERLINE
    assert scene.touched_edge is None
    assert tool_range(scene, 1, scene.new_tip) == (NEAR(-4.0), NEAR(4.0))


def test_drill_at_outside_diameter_touches_with_its_flank() -> None:
    """The entered 28 is the bar of 20 and the drill of 8 mm."""
    scene = diameter(DRILL, 14.0)
    assert part_radii(scene) == {10.0}
    assert scene.dimension[1][1] == NEAR(14.0)


@pytest.mark.parametrize(
    ("tip", "where", "edges"),
    [(3, -20.0, (-20.0, -17.0)), (4, -20.0, (-23.0, -20.0)), (8, -21.5, (-21.5, -18.5))],
)
def test_cutoff_blade_touches_face_with_the_corner_of_its_quadrant(
    tip: int, where: float, edges: tuple[float, float]
) -> None:
    scene = face(blade(tip), -20.0, -20.2)
    assert scene.surface is TouchedSurface.FACE
    assert scene.touched_edge is not None
    assert [z for z, _x in scene.touched_edge] == [NEAR(where)] * 2
    assert tool_range(scene, 0, scene.new_tip) == (NEAR(edges[0]), NEAR(edges[1]))
    assert scene.dimension[1][0] == NEAR(-20.0)
    material = [z for each in scene.part_outlines for z, x in each if abs(x) == max(part_radii(scene))]
    assert (min(material) == NEAR(where)) is (tip == 4)  # the part is on the right of its shoulder
    assert (max(material) == NEAR(where)) is (tip != 4)


def test_drill_touches_face_with_its_point_on_the_axis() -> None:
    scene = face(DRILL, 1.5)
    assert scene.new_tip == (1.5, 0.0)
    assert tool_range(scene, 0, scene.new_tip)[0] == NEAR(1.5)
    assert scene.touched_edge is not None
    assert scene.touched_edge[0] == (1.5, -scene.touched_edge[1][1])


def test_nose_center_is_one_radius_from_touched_diameter() -> None:
    assert part_radii(diameter(turned(9), 10.0)) == {9.2}


@pytest.mark.parametrize(
    ("tip", "hand", "is_left_larger"), [(3, ToolHand.RIGHT, True), (4, ToolHand.LEFT, False)]
)
def test_skim_cut_leaves_a_step_at_the_tip(tip: int, hand: ToolHand, is_left_larger: bool) -> None:
    scene = diameter(turned(tip, hand=hand), 12.5, is_skim_cut=True)
    (outline,) = scene.part_outlines
    left, right = outline[0][1], outline[3][1]
    assert (left > right) is is_left_larger
    assert min(left, right) == 12.5
    assert outline[1][0] == outline[2][0] == 0.0  # the step
    assert scene.touched_edge is not None
    assert all(z >= 0.0 for z, _x in scene.touched_edge) is is_left_larger


def test_skim_cut_of_bore_leaves_smaller_bore_in_front_of_the_tip() -> None:
    radii = part_radii(diameter(BAR, 15.0, is_skim_cut=True))
    assert 15.0 in radii
    assert min(radii) < 15.0


def test_skim_cut_of_face_leaves_material_inside_the_tip() -> None:
    scene = face(turned(3), -2.0, is_skim_cut=True)
    assert max(z for each in scene.part_outlines for z, _x in each) > -2.0
    assert scene.touched_edge is not None
    assert scene.new_tip is not None
    assert scene.touched_edge[0] == (-2.0, NEAR(scene.new_tip[1]))


# --- wrong sides and missing values --------------------------------------------------------------------


def contains(scene: TouchOffScene, z: float, x: float) -> bool:
    low_z, high_z, low_x, high_x = scene.visible_area
    return low_z <= z <= high_z and low_x <= x <= high_x


def test_wrong_sign_shows_the_tool_on_the_other_side_of_the_touched_diameter() -> None:
    scene = diameter(turned(3), -12.5, 12.5)
    assert scene.touched_edge is not None
    assert scene.touched_edge[0][1] == NEAR(12.5)  # where the tool works
    assert scene.new_tip == (0.0, -12.5)
    assert tool_range(scene, 1, scene.new_tip)[1] > -12.5  # into the part
    assert contains(scene, 0.0, -12.5)
    assert contains(scene, 0.0, 12.5)


def test_radius_typed_as_diameter_shows_old_tool_at_twice_the_radius() -> None:
    scene = diameter(turned(3), 6.25, 12.5)
    assert part_radii(scene) == {6.25}
    assert scene.old_tip == (0.0, 12.5)
    assert contains(scene, 0.0, 12.5)


@pytest.mark.parametrize(
    ("shape", "side"),
    [
        (ToolShape(ToolKind.BORING, tip=3, diameter=12.0), -1),  # points to the axis only from X-
        (turned(2), -1),
        (turned(3), 1),
        (BAR, 1),
        (DRILL, 1),
    ],
)
def test_quadrant_decides_on_which_side_a_stored_shape_works(shape: ToolShape, side: int) -> None:
    assert find_working_side(shape, 10.0)[0] == side


@pytest.mark.parametrize(
    ("tip", "old", "new", "side", "internal"),
    [
        (2, 10.0, 10.1, 1, True),
        (2, -10.0, -10.1, -1, False),
        (2, -10.0, 10.0, 1, True),
        (3, 10.0, 10.1, 1, False),
        (3, -10.0, -10.1, -1, True),
        (3, -10.0, 10.0, 1, False),  # the old sign was wrong
        (3, 10.0, -10.0, 1, False),  # the new sign is wrong
        (3, -0.127, None, 1, False),  # a face that was cut .010 in past the center
        (8, -0.127, None, 1, False),
        (6, -10.0, None, -1, False),
        (3, 0.0, 0.0, 1, False),
        (0, None, None, 1, False),
        (0, -10.0, None, -1, False),
        (0, None, -10.0, -1, False),
        (0, -10.0, 10.0, 1, False),
    ],
)
def test_old_sign_alone_makes_no_boring_bar_of_a_tool_without_shape(
    tip: int, old: float | None, new: float | None, side: int, internal: bool
) -> None:
    assert assume_working_side(tip, old, new) == (side, internal)


@pytest.mark.parametrize(
    ("tip", "old", "new", "side"),
    [
        (0, -10.0, 10.0, -1),
        (0, None, -10.0, -1),
        (0, 0.0, -10.0, -1),  # from the centerline
        (7, 10.0, -10.0, 1),
        (8, -10.0, None, -1),
        (6, 10.0, 10.0, -1),  # points to X+, so the part is there
        (0, None, None, 1),
    ],
)
def test_rotating_tool_stays_on_its_side(tip: int, old: float | None, new: float | None, side: int) -> None:
    assert find_working_side(ToolShape(ToolKind.DRILL, tip=tip, diameter=8.0), old, new) == (side, False)


def test_drill_at_negative_x_touches_with_its_upper_flank() -> None:
    """The entered -28 is the bar of 20 and the drill of 8 mm, at X-."""
    scene = diameter(DRILL, -14.0, -14.1)
    assert scene.surface is TouchedSurface.OUTSIDE_DIAMETER
    assert scene.touched_edge is not None
    assert [x for _z, x in scene.touched_edge] == [NEAR(-10.0)] * 2
    assert tool_range(scene, 1, scene.new_tip) == (NEAR(-18.0), NEAR(-10.0))


@pytest.mark.parametrize(
    ("x", "surface"),
    [
        (1.27, TouchedSurface.NONE),  # Ø .1 in, and the drill has a radius of 4 mm
        (-3.9, TouchedSurface.NONE),
        (0.02, TouchedSurface.NONE),
        (0.009, TouchedSurface.CENTERLINE),
        (-0.009, TouchedSurface.CENTERLINE),
    ],
)
def test_only_a_tool_at_the_centerline_is_on_center(x: float, surface: TouchedSurface) -> None:
    assert diameter(DRILL, x).surface is surface


def test_boring_bar_with_the_tip_of_an_outside_tool_is_shown_with_its_touched_line() -> None:
    """Quadrant 3 is for a bar at X-, so the touched line is there."""
    scene = diameter(ToolShape(ToolKind.BORING, tip=3, diameter=12.0), 7.6, 7.6)
    assert scene.touched_edge is not None
    assert scene.touched_edge[0][1] == NEAR(-7.6)
    assert contains(scene, 0.0, -7.6)


def test_boring_bar_at_negative_diameter_leaves_its_bore_edge() -> None:
    scene = diameter(BAR, -15.0, 15.0)
    assert scene.touched_edge is not None
    assert scene.touched_edge[0][1] == NEAR(15.0)
    assert tool_range(scene, 1, scene.new_tip)[1] == NEAR(-15.0, abs=1e-3)


def test_without_entry_the_part_has_the_size_of_the_old_offset() -> None:
    scene = diameter(turned(3), None, 12.5)
    assert scene.new_tip is None
    assert scene.old_tip == (0.0, 12.5)
    assert part_radii(scene) == {12.5}


def test_new_tool_without_entry_is_an_example_on_its_side() -> None:
    scene = diameter(turned(2, rear=True), None)
    assert scene.old_tip is None
    assert scene.new_tip is not None
    assert scene.new_tip[1] < 0.0


def test_invalid_insert_code_is_rejected() -> None:
    with pytest.raises(InsertCodeError):
        diameter(ToolShape(insert="?"), 10.0)


@pytest.mark.parametrize("position", [0.0, 1e-9, 900.0, -900.0])
def test_visible_area_is_never_empty(position: float) -> None:
    for scene in (
        diameter(turned(3), position, 0.0),
        face(blade(4), position, 0.0),
        diameter(DRILL, position),
    ):
        low_z, high_z, low_x, high_x = scene.visible_area
        assert high_z - low_z > 1.0
        assert high_x - low_x > 1.0
