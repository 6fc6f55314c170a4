"""What a locked C does to the part: on its face, on its side unrolled, and what the slides do meanwhile."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from app.path.path_picture import PictureBuilder, ProgramPicture, build_picture, map_to_face
from app.path.polyline import MAX_CHORD_ERROR_MM, Polyline, StrokeKind
from core.geometry.virtual_mill import FacePlane, PlaneMove, SidePlane
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import load_source
from core.proving.program_timeline import Timeline, iter_timed_blocks
from tests.path.made import LOCKED, turned

PROGRAMS = Path(__file__).parents[1] / "programs"


def drawn(*blocks: Block) -> ProgramPicture:
    sketch = PictureBuilder()
    for number, block in enumerate(blocks, 1):
        sketch.add_block(block, float(number))
    return sketch.build_picture()


def face_of(picture: ProgramPicture) -> Polyline:
    assert picture.face is not None
    return picture.face


def side_of(picture: ProgramPicture) -> Polyline:
    assert picture.side is not None
    return picture.side


@pytest.mark.parametrize(
    ("x", "c", "right", "down"),
    [(-5, 0, 5, 0), (-5, 90, 0, 5), (5, 0, -5, 0), (-5, -90, 0, -5), (0, 77, 0, 0)],
)
def test_point_on_face_is_mapped_from_x_and_c(x: float, c: float, right: float, down: float) -> None:
    # The tool stands at the left; the part's X points to it at C 0 and C turns the part under it.
    assert map_to_face(x, c) == pytest.approx((right, down), abs=1e-12)


def test_point_above_center_is_mapped_to_face() -> None:
    assert map_to_face(-4.0, 0.0, 3.0) == pytest.approx((4.0, -3.0))


def test_a_turning_program_has_neither_face_nor_side() -> None:
    block = Block(1, 1, BlockKind.FEED, "", 5, 0, 0, 5, -9, 0, 0, 0, ModalState(spindle=1))
    picture = drawn(block)
    assert picture.face is None
    assert picture.side is None


def test_indexing_is_drawn_only_on_face() -> None:
    picture = drawn(turned(1, BlockKind.ROTATE, (-5, 1, 0), (-5, 1, 90)))
    face = face_of(picture)
    assert (face.z[0], face.x[0]) == pytest.approx((5, 0))
    assert (face.z[-1], face.x[-1]) == pytest.approx((0, 5), abs=1e-9)
    assert np.hypot(face.z, face.x) == pytest.approx(np.full(len(face.z), 5.0))
    assert picture.side is None
    assert len(picture.z) == 0  # no slide moves


def test_moves_before_spindle_lock_are_not_counted_on_face() -> None:
    plain = Block(1, 1, BlockKind.FEED, "", 5, 0, 0, 5, -9, 0, 0, 0, ModalState(spindle=1))
    picture = drawn(plain, turned(2, BlockKind.ROTATE, (-5, 1, 0), (-5, 1, 4)))
    face = face_of(picture)
    assert [face.count_finished_points(n) for n in (0, 1, 2)] == [0, 0, 2]
    assert face.blocks == picture.blocks == 2


def test_flat_is_line_on_face_and_dip_in_x() -> None:
    # from (5, -3) to (5, 3): nearest to the axis in the middle, sqrt(34) from it at the ends
    way = PlaneMove(FacePlane(0.0), (5, -3, 0), (5, 3, 0), math.atan2(-3, 5))
    turn = math.degrees(math.atan2(3, 5))
    picture = drawn(
        turned(1, BlockKind.PLANE_LINE, (-math.sqrt(34), 0, turn), (-math.sqrt(34), 0, -turn), plane=way)
    )
    face = face_of(picture)
    assert face.z == pytest.approx(np.full(len(face.z), 5.0))
    assert (face.x[0], face.x[-1]) == (3, -3)  # Y is up
    assert picture.x[0] == pytest.approx(-math.sqrt(34))
    assert -5.05 < picture.x.max() <= -5.0
    assert picture.stroke[-1] == StrokeKind.MILL


def test_flat_in_plane_entered_at_90_degrees_is_rotated_on_part() -> None:
    way = PlaneMove(FacePlane(90.0), (5, -3, 0), (5, 3, 0), math.atan2(-3, 5))
    face = face_of(drawn(turned(1, BlockKind.PLANE_LINE, (-5.83, 0, 120), (-5.83, 0, 60), plane=way)))
    assert face.x == pytest.approx(np.full(len(face.x), 5.0))  # under the tool when C is at 90


def test_arc_on_face_stays_on_circle_and_has_its_center() -> None:
    way = PlaneMove(FacePlane(0.0), (6, 0, 0), (4, 2, 0), 0.0, (4.0, 0.0), clockwise=False)
    face = face_of(drawn(turned(1, BlockKind.PLANE_ARC, (-6, 0, 0), (-4.47, 0, -26.6), plane=way)))
    assert np.hypot(face.z - 4, face.x) == pytest.approx(np.full(len(face.z), 2.0))
    assert (face.x <= 1e-9).all()  # it bulges upwards
    chords = np.hypot(np.diff(face.z), np.diff(face.x))
    assert (2 - np.sqrt(4 - (chords / 2) ** 2)).max() <= MAX_CHORD_ERROR_MM * 1.001
    assert face.arc_centers.tolist() == [[4.0, 0.0]]


def test_the_side_is_unrolled_at_the_diameter_of_the_plane() -> None:
    # a quarter round a part of 20 mm is 5 pi; towards the spindle is to the left
    frame = SidePlane(10.0, -2.0, 20.0)
    way = PlaneMove(frame, (0, 0, 10), (3, 5 * math.pi, 10))
    picture = drawn(turned(1, BlockKind.PLANE_LINE, (-10, -2, 10), (-10, -5, -80), plane=way))
    side = side_of(picture)
    assert side.mm_per_degree == pytest.approx(math.pi * 20 / 360)
    assert side.z.tolist()[0] == -2
    assert (side.z[-1], -side.x[-1] / side.mm_per_degree) == pytest.approx((-5, -80))
    assert picture.face is None
    assert picture.x == pytest.approx(np.full(len(picture.x), -10.0))


def test_z_and_c_move_is_drawn_on_side_at_largest_diameter() -> None:
    side = side_of(drawn(turned(1, BlockKind.FEED, (-8, 0, 0), (-8, -4, 720))))
    assert side.mm_per_degree == pytest.approx(math.pi * 16 / 360)
    assert side.x[-1] == pytest.approx(-4 * math.pi * 8)  # two turns up


def test_secondary_offset_does_not_move_drawing() -> None:
    modal = LOCKED._replace(secondary_offset_x=0.5, secondary_offset_z=0.25)
    way = PlaneMove(FacePlane(0.0), (5, 0, -1), (5, 0, -2), 0.0)
    picture = drawn(
        turned(1, BlockKind.PLANE_LINE, (-4.5, -0.75, 0), (-4.5, -1.75, 0), plane=way, modal=modal)
    )
    assert (picture.x.tolist(), picture.z.tolist()) == ([-4.5, -4.5], [-0.75, -1.75])
    assert face_of(picture).z.tolist() == [5, 5]


@pytest.mark.parametrize("name", ["face_mill_flat", "face_mill_arc", "side_mill_slot"])
def test_drawing_matches_machine_transformation(name: str) -> None:
    # Every point of a view, put back through the frame's own kinematics, is where X, Z and C are.
    lathe = read_machine(None)
    setup = create_power_up_setup(lathe, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    blocks = list(
        iter_timed_blocks(Timeline.from_program(load_source(PROGRAMS / f"{name}.nc"), setup, lathe))
    )
    picture = build_picture(blocks, lambda _count: None)
    polyline = picture.side if name.startswith("side") else picture.face
    assert polyline is not None
    for number, (block, _start, _end) in enumerate(blocks):
        if block.plane is None:
            continue
        at = int(polyline.first[number + 1]) - 1
        if isinstance(block.plane.frame, SidePlane):
            found = (polyline.z[at], -polyline.x[at] / polyline.mm_per_degree)
            assert found == pytest.approx((block.z, block.c), abs=1e-9)
        else:
            spot = map_to_face(block.x, block.c, block.plane.frame.tool_height_mm)
            assert (polyline.z[at], polyline.x[at]) == pytest.approx(spot, abs=1e-9)
