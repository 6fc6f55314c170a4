"""The screen's models of a mill: figures in the working plane, lamps, and the 3-D view in pixels."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from app.compose.machine.kinematics_chain import kinematics_of
from app.compose.machine.machine_files import shipped_machine
from app.desk.status.machine_status import status_of
from app.desk.status.readouts import Lamp, Readout, lamps_of
from app.path.path_picture import picture_of
from app.working_plane.plane_drawing import ASPECTS, Camera, Figure, camera_for, figure
from app.working_plane.plane_instant import Instant, at_line, plane_words, running, title_of
from app.working_plane.plane_scene import Ink, Scene
from core.executor.snapshot import Snapshot
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import Modal
from tests.klartext.chamfers import AXIAL
from tests.klartext.running import run, run_file
from tests.klartext.table import AC

WIDE, HIGH = 600.0, 400.0
NAMES = ("X", "Y", "Z", "A", "C")


def scene_of(text: str) -> tuple[Scene, list[Block]]:
    blocks = run_file(text).blocks
    scene = picture_of(((block, 0.0, 1.0) for block in blocks), lambda _count: None).scene
    assert scene is not None
    return scene, blocks


@pytest.fixture(scope="module")
def chamfers() -> tuple[Scene, list[Block]]:
    return scene_of(AXIAL)


def snapshot_at(block: Block, **more: object) -> Snapshot:
    """The machine at the end of a block."""
    assert block.travel is not None
    at = block.travel.end
    made = Snapshot(
        axes=NAMES, demand=at, actual=at, following_error=(0.0,) * 5, homed=(True,) * 5,
        block_end=at, swivel=block.swivel, block=block.n, modal=Modal(metric=True),
    )  # fmt: skip
    return dataclasses.replace(made, **more)  # type: ignore[arg-type]


def cut_of(blocks: list[Block], number: int) -> Block:
    """The long cut of a chamfer."""
    return [block for block in blocks if block.kind == "feed"][2 * number - 1]


def values(snapshot: Snapshot, readout: Readout) -> list[str]:
    view = status_of(snapshot, readout, with_c=False)
    return [axis.value for axis in view.position.axes]


def test_figures_count_in_the_working_plane(chamfers: tuple[Scene, list[Block]]) -> None:
    cut = cut_of(chamfers[1], 2)
    snapshot = snapshot_at(cut)
    view = status_of(snapshot, Readout.POSITION, with_c=False).position
    assert [axis.name for axis in view.axes] == list(NAMES)
    assert values(snapshot, Readout.POSITION) == ["115.0000", "−7.0710", "0.0000", "45.000", "90.000"]
    assert view.x_words.startswith("TILTED PLANE FROM LINE")
    assert all(axis.mark == "" for axis in view.axes)


def test_figures_from_home_are_the_machines(chamfers: tuple[Scene, list[Block]]) -> None:
    snapshot = snapshot_at(cut_of(chamfers[1], 1))
    assert values(snapshot, Readout.HOME) == ["345.0000", "278.2843", "−352.2183", "45.000", "0.000"]
    assert status_of(snapshot, Readout.HOME, with_c=False).position.x_words == "MACHINE"


def test_what_is_left_counts_along_the_planes_axes(chamfers: tuple[Scene, list[Block]]) -> None:
    """30 mm before the end of chamfer 2, whose X' runs along X of the machine while C stands at 90."""
    cut = cut_of(chamfers[1], 2)
    assert cut.travel is not None
    x, *rest = cut.travel.end
    snapshot = snapshot_at(cut, actual=(x - 30.0, *rest))
    assert values(snapshot, Readout.TO_GO) == ["30.0000", "0.0000", "0.0000", "0.000", "0.000"]


def test_c_shows_less_than_a_turn(chamfers: tuple[Scene, list[Block]]) -> None:
    snapshot = snapshot_at(chamfers[1][-1])
    assert snapshot.actual[4] == pytest.approx(360.0)
    assert values(snapshot, Readout.POSITION)[4] == "0.000"
    assert status_of(snapshot, Readout.POSITION, with_c=False).position.x_words == "WORKPIECE"


def test_lamps_tell_of_plane_and_table(chamfers: tuple[Scene, list[Block]]) -> None:
    tilted = {lamp.word: lamp.lit for lamp in lamps_of(snapshot_at(cut_of(chamfers[1], 1)))}
    assert (tilted["TILTED PLANE"], tilted["TABLE ROTATED"]) == (True, True)
    home = {lamp.word: lamp.lit for lamp in lamps_of(snapshot_at(chamfers[1][-1]))}
    assert (home["TILTED PLANE"], home["TABLE ROTATED"]) == (False, False)
    assert "COLLET OPEN" not in home


def test_where_no_table_turns_the_lamp_tells_of_the_head() -> None:
    """By the machine file: before a program has run it told of a table."""
    fork, table = shipped_machine("fork-head-mill"), shipped_machine("ac-table-mill")
    kinematics = kinematics_of(fork)
    assert kinematics is not None
    ran = run("L A+20 R0 FMAX\nL A+0 R0 FMAX", kinematics)
    turned, home = (block for block in ran.blocks if block.moves)
    assert Lamp("HEAD ROTATED", lit=True) in lamps_of(snapshot_at(turned), table=fork.table_turns)
    idle = snapshot_at(home, swivel=None)
    assert Lamp("HEAD ROTATED", lit=False) in lamps_of(idle, table=fork.table_turns)
    assert Lamp("TABLE ROTATED", lit=False) in lamps_of(idle, table=table.table_turns)


@pytest.mark.parametrize(("machine", "title"), [
    ("fork-head-mill", "HEAD AND PLANE"), ("ac-table-mill", "TABLE AND PLANE"),
    ("head-table-mill", "HEAD, TABLE AND PLANE"),
])  # fmt: skip
def test_the_view_is_called_by_what_turns(machine: str, title: str) -> None:
    kinematics = kinematics_of(shipped_machine(machine))
    assert kinematics is not None
    assert title_of(kinematics) == title


# --- the scene -------------------------------------------------------------------------------------------


def test_cuts_are_kept_on_the_workpiece(chamfers: tuple[Scene, list[Block]]) -> None:
    scene, blocks = chamfers
    ends = scene.points[scene.ink == Ink.CUT]
    assert len(ends) == 8
    assert ends[1] == pytest.approx((115.0, 5.0, -5.0), abs=1e-4)
    assert ends[3] == pytest.approx((95.0, 115.0, -5.0), abs=1e-4)
    assert scene.corners == ((0.0, 0.0, -40.0), (100.0, 100.0, 0.0))
    number = cut_of(blocks, 1).n
    assert scene.done(number) - scene.done(number - 1) == 1


def test_the_plane_of_a_line(chamfers: tuple[Scene, list[Block]]) -> None:
    scene, _ = chamfers
    first, *_ = sorted(scene.planes)
    here = at_line(scene, first)
    assert here.axes["A"] == 45.0
    assert plane_words(here.swivel) == (
        f"TILTED PLANE FROM LINE {first}:  A+45.000  C+0.000   Z' 0.000  −0.707  0.707"
    )
    assert at_line(scene, first + 1).swivel is here.swivel  # a line without a block: the one before it
    assert at_line(scene, 0).swivel is None
    assert plane_words(None) == ""


def test_a_plane_that_stays_shows_the_table_where_it_is_meant() -> None:
    ran = run("PLANE AXIAL A+30 C+20 STAY")
    scene = picture_of(((block, 0.0, 1.0) for block in ran.blocks), lambda _count: None).scene
    assert scene is not None
    here = at_line(scene, 3)
    assert (here.axes["A"], here.axes["C"]) == (30.0, 20.0)


def test_programs_without_planes_have_no_scene() -> None:
    assert picture_of((), lambda _count: None).scene is None


# --- the figure ------------------------------------------------------------------------------------------


def drawn(scene: Scene, instant: Instant, aspect: str = "3-D") -> tuple[Figure, Camera]:
    number = [each.name for each in ASPECTS].index(aspect)
    camera = dataclasses.replace(camera_for(scene), aspect=number)
    return figure(scene, instant, camera, WIDE, HIGH), camera


@pytest.mark.parametrize("chamfer", [1, 2, 3, 4])
def test_z_of_the_plane_stands_upright_in_the_machine(
    chamfers: tuple[Scene, list[Block]], chamfer: int
) -> None:
    """Seen from the front and from the right alike: the table has turned the plane towards the tool."""
    scene, blocks = chamfers
    instant = running(scene, snapshot_at(cut_of(blocks, chamfer)))
    for aspect in ("FRONT", "RIGHT"):
        made, _ = drawn(scene, instant, aspect)
        z = next(stroke for stroke in made.strokes if stroke.role == "z")
        foot, tip = z.points
        assert tip[0] == pytest.approx(foot[0], abs=1e-6)
        assert tip[1] < foot[1]  # up on the screen


@pytest.mark.parametrize("aspect", [each.name for each in ASPECTS])
def test_the_tool_stands_at_the_end_of_what_is_done(chamfers: tuple[Scene, list[Block]], aspect: str) -> None:
    scene, blocks = chamfers
    cut = cut_of(blocks, 2)
    assert cut.swivel is not None
    made, camera = drawn(scene, running(scene, snapshot_at(cut)), aspect)
    tip = camera.seen(np.array([cut.swivel.slides]), WIDE, HIGH)[0, :2]
    ends = [stroke.points[-1] for stroke in made.strokes if stroke.role == "done"]
    assert min(np.linalg.norm(end - tip) for end in ends) < 1e-6
    tool = np.vstack([face.points for face in made.faces if face.role == "tool"])
    low, high = tool.min(axis=0) - 1e-6, tool.max(axis=0) + 1e-6
    assert (low <= tip).all()
    assert (tip <= high).all()


def test_the_table_turns_under_the_eye(chamfers: tuple[Scene, list[Block]]) -> None:
    """From the front at A0 the disc is seen edge on; tilted to the rear it has a height, from above."""
    scene, blocks = chamfers
    level, _ = drawn(scene, Instant(dict.fromkeys(NAMES, 0.0), None), "FRONT")
    tilted, _ = drawn(scene, running(scene, snapshot_at(cut_of(blocks, 1))), "FRONT")
    heights = [
        np.ptp(next(face for face in made.faces if face.role.startswith("table")).points[:, 1])
        for made in (level, tilted)
    ]
    assert heights[0] == pytest.approx(0.0, abs=1e-9)
    assert heights[1] > 100.0


def test_everything_that_stands_on_the_table_is_in_the_picture(chamfers: tuple[Scene, list[Block]]) -> None:
    scene, blocks = chamfers
    for chamfer in range(1, 5):
        made, _ = drawn(scene, running(scene, snapshot_at(cut_of(blocks, chamfer))))
        for face in made.faces:
            if face.role.startswith(("table", "blank")):
                assert (face.points >= -20.0).all()
                assert (face.points <= (WIDE + 20.0, HIGH + 20.0)).all()


def test_a_small_blank_at_the_far_rim_stands_on_the_table() -> None:
    """Its own middle lies behind the middle of the table, and is drawn upon it all the same."""
    small = (
        "BEGIN PGM S MM\nBLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+40 Y+40 Z+0\n"
        "TOOL CALL 1 Z S900\nL X+0 Y+0 Z+5 R0 FMAX\nEND PGM S MM\n"
    )
    scene, _blocks = scene_of(small)
    roles = [face.role for face in drawn(scene, at_line(scene, 5))[0].faces]
    assert roles[0] == "table"
    assert {"blank", "blank-top"} <= set(roles[1:])


def test_a_head_that_leans_leaves_the_workpiece_where_it_is(chamfers: tuple[Scene, list[Block]]) -> None:
    head = shipped_machine("head-table-mill")
    chain = kinematics_of(head)
    assert chain is not None
    scene = dataclasses.replace(chamfers[0], kinematics=chain)
    upright, leaning = (
        drawn(scene, Instant({"X": 500.0, "Y": 300.0, "Z": -400.0, "B": b, "C": 0.0}, None))[0]
        for b in (0.0, 35.0)
    )

    def shapes(figure: Figure, *roles: str) -> list[list[list[float]]]:
        return [face.points.tolist() for face in figure.faces if face.role in roles]

    assert shapes(upright, "table", "blank", "blank-top") == shapes(leaning, "table", "blank", "blank-top")
    assert shapes(upright, "tool") != shapes(leaning, "tool")
    lines = [
        [each.points.tolist() for each in figure.strokes if each.role == "axis"]
        for figure in (upright, leaning)
    ]
    assert len(lines[0]) == 1
    assert lines[0] == lines[1]  # C, the line of the table


def test_looking_around(chamfers: tuple[Scene, list[Block]]) -> None:
    camera = camera_for(chamfers[0])
    names = [camera.shown.name]
    for _ in range(3):
        camera = camera.following()
        names.append(camera.shown.name)
    assert names == ["3-D", "FRONT", "RIGHT", "TOP"]
    assert camera.following().shown.name == "3-D"
    moved = camera.zoomed(3).panned(1, -1)
    assert moved.nearness > 1.0
    assert moved.fitted() == dataclasses.replace(camera, nearness=1.0)
    assert camera.zoomed(1000).nearness == 40.0


def test_the_top_view_shows_the_machine_as_it_stands() -> None:
    camera = Camera((0.0, 0.0, 0.0), 100.0, [each.name for each in ASPECTS].index("TOP"))
    right, back = camera.seen(np.array([(50.0, 0.0, 0.0), (0.0, 50.0, 7.0)]), 200.0, 200.0)
    assert right[:2] == pytest.approx((150.0, 100.0))
    assert back[:2] == pytest.approx((100.0, 50.0))  # Y away from the operator is up


def test_a_long_path_is_thinned_out() -> None:
    scene, _ = scene_of(AXIAL)
    many = np.tile(scene.points, (3000, 1))
    long = dataclasses.replace(
        scene,
        points=many,
        ink=np.tile(scene.ink, 3000),
        block=np.arange(len(many)),
    )
    made, _ = drawn(long, Instant(dict.fromkeys(NAMES, 0.0), None))
    assert sum(len(stroke.points) for stroke in made.strokes) < 3 * 10_000
    assert AC.names == NAMES


@pytest.mark.parametrize(("feed", "shown"), [("F1200", ("1200.0", "°/min")), ("FMAX", ("RAPID", ""))])
def test_the_feed_of_a_swivel_is_degrees(feed: str, shown: tuple[str, str]) -> None:
    (block,) = run(f"PLANE AXIAL A+30 TURN {feed}").planes
    snapshot = snapshot_at(block, feed=block.feed, rapid=block.rapid, turns=block.swivels and not block.rapid)
    made = status_of(snapshot, Readout.POSITION, with_c=False).feed
    assert (made.value, made.unit) == shown


def test_a_mills_program_draws_nothing_on_a_lathes_picture(chamfers: tuple[Scene, list[Block]]) -> None:
    picture = picture_of(((block, 0.0, float(n)) for n, block in enumerate(chamfers[1])), lambda _count: None)
    assert len(picture.z) == 0
    cut = cut_of(chamfers[1], 2)
    assert picture.chord[cut.n - 1] == pytest.approx(130.0)  # chamfer 2 runs along X of the machine
