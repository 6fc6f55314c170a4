"""The screen's models of a mill: figures in the working plane, lamps, and the 3-D view in pixels."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import load_shipped_machine
from app.desk.status.machine_status import make_machine_status
from app.desk.status.readouts import Lamp, ReadoutKind, make_lamps
from app.path.path_picture import build_picture
from app.working_plane.plane_drawing import VIEW_ASPECTS, Camera, SceneDrawing, draw_scene, make_camera
from app.working_plane.plane_instant import (
    SceneInstant,
    describe_plane,
    make_instant_after_line,
    make_instant_from_snapshot,
    make_view_title,
)
from app.working_plane.plane_scene import MillScene, MoveStyle
from core.executor.snapshot import Snapshot
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import ModalState
from tests.klartext.chamfers import AXIAL
from tests.klartext.running import run, run_file
from tests.klartext.table import AC

WIDE, HIGH = 600.0, 400.0
NAMES = ("X", "Y", "Z", "A", "C")


def scene_of(text: str) -> tuple[MillScene, list[Block]]:
    blocks = run_file(text).blocks
    scene = build_picture(((block, 0.0, 1.0) for block in blocks), lambda _count: None).mill_scene
    assert scene is not None
    return scene, blocks


@pytest.fixture(scope="module")
def chamfers() -> tuple[MillScene, list[Block]]:
    return scene_of(AXIAL)


def snapshot_at(block: Block, **more: object) -> Snapshot:
    """The machine at the end of a block."""
    assert block.travel is not None
    at = block.travel.end
    made = Snapshot(
        axes=NAMES, demand=at, actual=at, following_error=(0.0,) * 5, homed=(True,) * 5,
        block_end=at, swivel=block.swivel, block=block.n, modal=ModalState(metric=True),
    )  # fmt: skip
    return dataclasses.replace(made, **more)  # type: ignore[arg-type]


def cut_of(blocks: list[Block], number: int) -> Block:
    """The long cut of a chamfer."""
    return [block for block in blocks if block.kind == "feed"][2 * number - 1]


def values(snapshot: Snapshot, readout: ReadoutKind) -> list[str]:
    view = make_machine_status(snapshot, readout, has_c_axis=False)
    return [axis.value for axis in view.position.axes]


def test_readout_is_in_working_plane(chamfers: tuple[MillScene, list[Block]]) -> None:
    cut = cut_of(chamfers[1], 2)
    snapshot = snapshot_at(cut)
    view = make_machine_status(snapshot, ReadoutKind.POSITION, has_c_axis=False).position
    assert [axis.name for axis in view.axes] == list(NAMES)
    assert values(snapshot, ReadoutKind.POSITION) == ["115.0000", "−7.0710", "0.0000", "45.000", "90.000"]
    assert view.x_label.startswith("TILTED PLANE FROM LINE")
    assert all(axis.diameter_mark == "" for axis in view.axes)


def test_readout_from_home_is_in_machine_coordinates(chamfers: tuple[MillScene, list[Block]]) -> None:
    snapshot = snapshot_at(cut_of(chamfers[1], 1))
    assert values(snapshot, ReadoutKind.HOME) == ["345.0000", "278.2843", "−352.2183", "45.000", "0.000"]
    assert make_machine_status(snapshot, ReadoutKind.HOME, has_c_axis=False).position.x_label == "MACHINE"


def test_distance_to_go_is_along_axes_of_plane(chamfers: tuple[MillScene, list[Block]]) -> None:
    """30 mm before the end of chamfer 2, whose X' runs along X of the machine while C stands at 90."""
    cut = cut_of(chamfers[1], 2)
    assert cut.travel is not None
    x, *rest = cut.travel.end
    snapshot = snapshot_at(cut, actual=(x - 30.0, *rest))
    assert values(snapshot, ReadoutKind.TO_GO) == ["30.0000", "0.0000", "0.0000", "0.000", "0.000"]


def test_c_readout_is_below_360_degrees(chamfers: tuple[MillScene, list[Block]]) -> None:
    snapshot = snapshot_at(chamfers[1][-1])
    assert snapshot.actual[4] == pytest.approx(360.0)
    assert values(snapshot, ReadoutKind.POSITION)[4] == "0.000"
    assert (
        make_machine_status(snapshot, ReadoutKind.POSITION, has_c_axis=False).position.x_label == "WORKPIECE"
    )


def test_lamps_show_tilted_plane_and_rotated_table(chamfers: tuple[MillScene, list[Block]]) -> None:
    tilted = {lamp.label: lamp.is_lit for lamp in make_lamps(snapshot_at(cut_of(chamfers[1], 1)))}
    assert (tilted["TILTED PLANE"], tilted["TABLE ROTATED"]) == (True, True)
    home = {lamp.label: lamp.is_lit for lamp in make_lamps(snapshot_at(chamfers[1][-1]))}
    assert (home["TILTED PLANE"], home["TABLE ROTATED"]) == (False, False)
    assert "COLLET OPEN" not in home


def test_lamp_shows_rotated_head_on_machine_without_rotary_table() -> None:
    """By the machine file: before a program has run it told of a table."""
    fork, table = load_shipped_machine("fork-head-mill"), load_shipped_machine("ac-table-mill")
    kinematics = build_kinematics(fork)
    assert kinematics is not None
    ran = run("L A+20 R0 FMAX\nL A+0 R0 FMAX", kinematics)
    turned, home = (block for block in ran.blocks if block.moves)
    assert Lamp("HEAD ROTATED", is_lit=True) in make_lamps(
        snapshot_at(turned), is_table_rotary=fork.has_rotary_table
    )
    idle = snapshot_at(home, swivel=None)
    assert Lamp("HEAD ROTATED", is_lit=False) in make_lamps(idle, is_table_rotary=fork.has_rotary_table)
    assert Lamp("TABLE ROTATED", is_lit=False) in make_lamps(idle, is_table_rotary=table.has_rotary_table)


@pytest.mark.parametrize(("machine", "title"), [
    ("fork-head-mill", "HEAD AND PLANE"), ("ac-table-mill", "TABLE AND PLANE"),
    ("head-table-mill", "HEAD, TABLE AND PLANE"),
])  # fmt: skip
def test_view_title_names_rotary_part(machine: str, title: str) -> None:
    kinematics = build_kinematics(load_shipped_machine(machine))
    assert kinematics is not None
    assert make_view_title(kinematics) == title


# --- the scene -------------------------------------------------------------------------------------------


def test_finished_cuts_are_stored_on_workpiece(chamfers: tuple[MillScene, list[Block]]) -> None:
    scene, blocks = chamfers
    ends = scene.tip_points[scene.move_styles == MoveStyle.CUT]
    assert len(ends) == 8
    assert ends[1] == pytest.approx((115.0, 5.0, -5.0), abs=1e-4)
    assert ends[3] == pytest.approx((95.0, 115.0, -5.0), abs=1e-4)
    assert scene.blank_corners == ((0.0, 0.0, -40.0), (100.0, 100.0, 0.0))
    number = cut_of(blocks, 1).n
    assert scene.count_finished_points(number) - scene.count_finished_points(number - 1) == 1


def test_line_instant_has_plane_of_its_line(chamfers: tuple[MillScene, list[Block]]) -> None:
    scene, _ = chamfers
    first, *_ = sorted(scene.plane_line_numbers)
    here = make_instant_after_line(scene, first)
    assert here.axis_positions["A"] == 45.0
    assert describe_plane(here.plane_position) == (
        f"TILTED PLANE FROM LINE {first}:  A+45.000  C+0.000   Z' 0.000  −0.707  0.707"
    )
    assert (
        make_instant_after_line(scene, first + 1).plane_position is here.plane_position
    )  # a line without a block: the one before it
    assert make_instant_after_line(scene, 0).plane_position is None
    assert describe_plane(None) == ""


def test_plane_with_stay_shows_table_at_target_angles() -> None:
    ran = run("PLANE AXIAL A+30 C+20 STAY")
    scene = build_picture(((block, 0.0, 1.0) for block in ran.blocks), lambda _count: None).mill_scene
    assert scene is not None
    here = make_instant_after_line(scene, 3)
    assert (here.axis_positions["A"], here.axis_positions["C"]) == (30.0, 20.0)


def test_programs_without_planes_have_no_scene() -> None:
    assert build_picture((), lambda _count: None).mill_scene is None


# --- the figure ------------------------------------------------------------------------------------------


def drawn(scene: MillScene, instant: SceneInstant, aspect: str = "3-D") -> tuple[SceneDrawing, Camera]:
    number = [each.name for each in VIEW_ASPECTS].index(aspect)
    camera = dataclasses.replace(make_camera(scene), view_direction_index=number)
    return draw_scene(scene, instant, camera, WIDE, HIGH), camera


@pytest.mark.parametrize("chamfer", [1, 2, 3, 4])
def test_plane_z_is_vertical_in_machine_view(chamfers: tuple[MillScene, list[Block]], chamfer: int) -> None:
    """Seen from the front and from the right alike: the table has turned the plane towards the tool."""
    scene, blocks = chamfers
    instant = make_instant_from_snapshot(scene, snapshot_at(cut_of(blocks, chamfer)))
    for aspect in ("FRONT", "RIGHT"):
        made, _ = drawn(scene, instant, aspect)
        z = next(stroke for stroke in made.strokes if stroke.color_role == "z")
        foot, tip = z.points
        assert tip[0] == pytest.approx(foot[0], abs=1e-6)
        assert tip[1] < foot[1]  # up on the screen


@pytest.mark.parametrize("aspect", [each.name for each in VIEW_ASPECTS])
def test_tool_is_drawn_at_end_of_finished_path(chamfers: tuple[MillScene, list[Block]], aspect: str) -> None:
    scene, blocks = chamfers
    cut = cut_of(blocks, 2)
    assert cut.swivel is not None
    made, camera = drawn(scene, make_instant_from_snapshot(scene, snapshot_at(cut)), aspect)
    tip = camera.project_points(np.array([cut.swivel.machine_position]), WIDE, HIGH)[0, :2]
    ends = [stroke.points[-1] for stroke in made.strokes if stroke.color_role == "done"]
    assert min(np.linalg.norm(end - tip) for end in ends) < 1e-6
    tool = np.vstack([face.points for face in made.faces if face.color_role == "tool"])
    low, high = tool.min(axis=0) - 1e-6, tool.max(axis=0) + 1e-6
    assert (low <= tip).all()
    assert (tip <= high).all()


def test_table_rotation_changes_its_drawing(chamfers: tuple[MillScene, list[Block]]) -> None:
    """From the front at A0 the disc is seen edge on; tilted to the rear it has a height, from above."""
    scene, blocks = chamfers
    level, _ = drawn(scene, SceneInstant(dict.fromkeys(NAMES, 0.0), None), "FRONT")
    tilted, _ = drawn(scene, make_instant_from_snapshot(scene, snapshot_at(cut_of(blocks, 1))), "FRONT")
    heights = [
        np.ptp(next(face for face in made.faces if face.color_role.startswith("table")).points[:, 1])
        for made in (level, tilted)
    ]
    assert heights[0] == pytest.approx(0.0, abs=1e-9)
    assert heights[1] > 100.0


def test_everything_on_table_is_in_view(
    chamfers: tuple[MillScene, list[Block]],
) -> None:
    scene, blocks = chamfers
    for chamfer in range(1, 5):
        made, _ = drawn(scene, make_instant_from_snapshot(scene, snapshot_at(cut_of(blocks, chamfer))))
        for face in made.faces:
            if face.color_role.startswith(("table", "blank")):
                assert (face.points >= -20.0).all()
                assert (face.points <= (WIDE + 20.0, HIGH + 20.0)).all()


def test_small_blank_at_edge_is_drawn_on_top_of_table() -> None:
    """Its own middle lies behind the middle of the table, and is drawn upon it all the same."""
    small = (
        "BEGIN PGM S MM\nBLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+40 Y+40 Z+0\n"
        "TOOL CALL 1 Z S900\nL X+0 Y+0 Z+5 R0 FMAX\nEND PGM S MM\n"
    )
    scene, _blocks = scene_of(small)
    roles = [face.color_role for face in drawn(scene, make_instant_after_line(scene, 5))[0].faces]
    assert roles[0] == "table"
    assert {"blank", "blank-top"} <= set(roles[1:])


def test_tilted_head_does_not_move_workpiece_in_view(chamfers: tuple[MillScene, list[Block]]) -> None:
    head = load_shipped_machine("head-table-mill")
    chain = build_kinematics(head)
    assert chain is not None
    scene = dataclasses.replace(chamfers[0], kinematics=chain)
    upright, leaning = (
        drawn(scene, SceneInstant({"X": 500.0, "Y": 300.0, "Z": -400.0, "B": b, "C": 0.0}, None))[0]
        for b in (0.0, 35.0)
    )

    def shapes(figure: SceneDrawing, *roles: str) -> list[list[list[float]]]:
        return [face.points.tolist() for face in figure.faces if face.color_role in roles]

    assert shapes(upright, "table", "blank", "blank-top") == shapes(leaning, "table", "blank", "blank-top")
    assert shapes(upright, "tool") != shapes(leaning, "tool")
    lines = [
        [each.points.tolist() for each in figure.strokes if each.color_role == "axis"]
        for figure in (upright, leaning)
    ]
    assert len(lines[0]) == 1
    assert lines[0] == lines[1]  # C, the line of the table


def test_camera_can_be_rotated_moved_and_zoomed(chamfers: tuple[MillScene, list[Block]]) -> None:
    camera = make_camera(chamfers[0])
    names = [camera.view_direction.name]
    for _ in range(3):
        camera = camera.with_next_view_direction()
        names.append(camera.view_direction.name)
    assert names == ["3-D", "FRONT", "RIGHT", "TOP"]
    assert camera.with_next_view_direction().view_direction.name == "3-D"
    moved = camera.with_zoom(3).with_pan(1, -1)
    assert moved.zoom_factor > 1.0
    assert moved.with_full_view() == dataclasses.replace(camera, zoom_factor=1.0)
    assert camera.with_zoom(1000).zoom_factor == 40.0


def test_top_view_shows_machine_directions() -> None:
    camera = Camera((0.0, 0.0, 0.0), 100.0, [each.name for each in VIEW_ASPECTS].index("TOP"))
    right, back = camera.project_points(np.array([(50.0, 0.0, 0.0), (0.0, 50.0, 7.0)]), 200.0, 200.0)
    assert right[:2] == pytest.approx((150.0, 100.0))
    assert back[:2] == pytest.approx((100.0, 50.0))  # Y away from the operator is up


def test_long_path_is_drawn_with_fewer_points() -> None:
    scene, _ = scene_of(AXIAL)
    many = np.tile(scene.tip_points, (3000, 1))
    long = dataclasses.replace(
        scene,
        tip_points=many,
        move_styles=np.tile(scene.move_styles, 3000),
        block_numbers=np.arange(len(many)),
    )
    made, _ = drawn(long, SceneInstant(dict.fromkeys(NAMES, 0.0), None))
    assert sum(len(stroke.points) for stroke in made.strokes) < 3 * 10_000
    assert AC.axis_names == NAMES


@pytest.mark.parametrize(("feed", "shown"), [("F1200", ("1200.0", "°/min")), ("FMAX", ("RAPID", ""))])
def test_swivel_feed_is_shown_in_degrees(feed: str, shown: tuple[str, str]) -> None:
    (block,) = run(f"PLANE AXIAL A+30 TURN {feed}").planes
    snapshot = snapshot_at(
        block, feed=block.feed, rapid=block.rapid, turns=block.has_angular_feed and not block.rapid
    )
    made = make_machine_status(snapshot, ReadoutKind.POSITION, has_c_axis=False).feed
    assert (made.programmed_value, made.programmed_unit) == shown


def test_mill_program_draws_nothing_in_lathe_picture(chamfers: tuple[MillScene, list[Block]]) -> None:
    picture = build_picture(
        ((block, 0.0, float(n)) for n, block in enumerate(chamfers[1])), lambda _count: None
    )
    assert len(picture.z) == 0
    cut = cut_of(chamfers[1], 2)
    assert picture.chord[cut.n - 1] == pytest.approx(130.0)  # chamfer 2 runs along X of the machine
