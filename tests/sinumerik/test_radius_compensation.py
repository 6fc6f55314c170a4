"""G40, G41, G42: by hand, and against a circle that is walked along the contour; and what is refused."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import cos, dist, hypot, pi, sin, sqrt

import pytest

from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from tests.sinumerik.lathe import good, refused, run, setup

R = 0.8


def with_tool(quadrant: int = 3, radius: float = R) -> InterpreterSetup:
    tools = {1: ToolOffset(0.0, 0.0, radius, quadrant, "FINISHER")}
    return replace(setup(), tools=tools, start=(50.0, 50.0, 0.0))


def ends(blocks: Sequence[Block]) -> list[tuple[float, float]]:
    return [(round(block.x, 6), round(block.z, 6)) for block in blocks]


STEP = "T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nX40\nG40 X60 Z5\n"


def test_cylinder_and_shoulder_match_hand_calculation() -> None:
    """Tip 3: the tip lies R below and R to the left of the centre.

    On the cylinder the centre runs at 10 + R, so the tip at 10; square to its start the centre has the Z of
    the start, so the tip R left of it. In the corner the centre is at Z -20 + R, the tip at -20.
    """
    _, approach, cylinder, face, away = good(STEP, with_tool())
    assert ends([approach]) == [(10.0, -R)]
    assert ends([cylinder, face]) == [(10.0, -20.0), (20.0 - R, -20.0)]
    assert ends([away]) == [(30.0, 5.0)]


def test_taper_matches_hand_calculation() -> None:
    """45 degrees: the tip is off the taper by R (1 - tan 22.5°) = R (2 - sqrt 2) along Z."""
    moves = good("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nX40 Z-10\nG40 X60 Z5\n", with_tool())
    taper = moves[2]
    assert taper.x - taper.x0 == pytest.approx(10.0)
    # the line of the tip against X = 10 - Z of the contour, along Z
    off = taper.z0 - (10.0 - taper.x0)
    assert off == pytest.approx(R * (sqrt(2.0) - 2.0))


def test_nose_center_is_programmed_with_tip_quadrant_9() -> None:
    _, approach, cylinder, _, _ = good(STEP, with_tool(9))
    assert ends([approach, cylinder]) == [(10.0 + R, 0.0), (10.0 + R, -20.0 + R)]


def test_g41_compensates_on_the_other_side() -> None:
    """In a bore: tip 2 lies R above and R left of the centre, which runs at 10 - R."""
    text = "T1 D1\nG0 X8 Z5\nG41 G1 X20 Z0 F200\nZ-20\nG40 X8 Z-15\n"
    _, approach, bore, _ = good(text, with_tool(2))
    assert ends([approach, bore]) == [(10.0, -R), (10.0, -20.0 - R)]


def test_each_move_runs_at_its_own_surface_speed() -> None:
    """G96 S200 on the cylinder of 20 is 3183 rpm, whatever comes behind it: another S, or the end."""
    head = "T1 D1\nG96 S200 M4 F.2\nG0 X60 Z5\nG42 G1 X20 Z0\nZ-20\n"
    slower = good(head + "X40\nS100\nX60\nG40 X80 Z5\n", with_tool())
    ended = good(head + "X40\nG40 M30\n", with_tool())
    for moves in (slower, ended):
        assert moves[2].rpm == pytest.approx(-200e3 / (pi * 20.0))
    assert slower[4].rpm == pytest.approx(-100e3 / (2.0 * pi * slower[4].x))


def test_contour_arc_matches_hand_calculation() -> None:
    """G3 from X20 Z0 to X40 Z-10 bulges outwards: its radius of 10 is 10 + R for the centre."""
    text = "T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nG3 X40 Z-10 CR=10\nG40 G1 X60 Z5\n"
    arc = good(text, with_tool())[2]
    assert hypot(arc.x - arc.cx, arc.z - arc.cz) == pytest.approx(10.0 + R)


def test_g450_rounds_outside_corner_with_an_arc() -> None:
    moves = good("T1 D1\nG450 G0 X10 Z5\nG42 G1 X20 Z0 F200\nX40\nZ-20\nG40 X80 Z-10\n", with_tool(9))
    kinds = [block.kind.value for block in moves]
    assert kinds == ["rapid", "feed", "feed", "arc", "feed", "feed"]
    assert hypot(moves[3].x - 20.0, moves[3].z) == pytest.approx(R)


def test_g451_moves_to_the_intersection() -> None:
    """The centre's lines Z = R and X = 20 + R meet at that corner."""
    moves = good("T1 D1\nG451 G0 X10 Z5\nG42 G1 X20 Z0 F200\nX40\nZ-20\nG40 X80 Z-10\n", with_tool(9))
    assert "arc" not in [block.kind.value for block in moves]
    assert (20.0 + R, R) in ends(moves)


def test_norm_rejects_approach_that_kont_makes_around_contour() -> None:
    """From behind the beginning of the contour, inside the bar, the straight way would cut it."""
    text = "T1 D1\n{} G0 X4 Z-10\nG42 G1 X20 Z0 F200\nZ-20\nG40 X60 Z5\n"
    error = refused(text.format("NORM"), with_tool(9))
    assert (error.code, error.line) == ("comp-gouge", 3)
    assert "KONT" in error.hint
    moves = good(text.format("KONT"), with_tool(9))
    straight, around = moves[1], moves[2]
    assert hypot(straight.x - 10.0, straight.z) == pytest.approx(R)  # it touches the circle about X20 Z0
    assert (straight.x - straight.x0) * (straight.x - 10.0) + (straight.z - straight.z0) * straight.z == (
        pytest.approx(0.0, abs=1e-9)
    )
    assert ends([around]) == [(10.0 + R, 0.0)]


def test_kont_also_departs_around_the_contour_end() -> None:
    text = "T1 D1\nKONT G0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG40 X4 Z-10\n"
    moves = good(text, with_tool(9))
    around, straight = moves[3], moves[4]
    assert around.kind.value == "arc"
    assert hypot(straight.x0 - 10.0, straight.z0 + 20.0) == pytest.approx(R)
    assert ends([straight]) == [(2.0, -10.0)]


@pytest.mark.parametrize("seed", range(40))
def test_the_nose_touches_random_contours_everywhere(seed: int) -> None:
    """A circle of R about the centre, sampled along the way: never nearer to the contour, never off it."""
    rng = random.Random(seed)
    quadrant, x, z = rng.choice([1, 2, 3, 4, 9]), 10.0, 0.0
    points = [(x, z)]
    for _ in range(rng.randint(2, 6)):
        angle = rng.uniform(0.05, 0.45) * pi
        length = rng.uniform(6.0, 12.0)
        points.append((points[-1][0] + length * sin(angle), points[-1][1] - length * cos(angle)))
    lines = "".join(f"X={2 * px!r} Z={pz!r}\n" for px, pz in points[1:])
    last = points[-1]
    text = f"T1 D1\nG0 X14 Z9\nG42 G1 X20 Z0 F200\n{lines}G40 X={2 * last[0] + 40!r} Z={last[1] + 5!r}\n"
    moves = good(text, with_tool(quadrant))[2:-1]
    across, along = {1: (1, 1), 2: (1, -1), 3: (-1, -1), 4: (-1, 1), 9: (0, 0)}[quadrant]
    for block in moves:
        element = make_element(block)
        for share in range(11):
            px, pz = element.get_point(element.length * share / 10)
            centre = px - across * R, pz - along * R
            nearest = min(_distance(a, b, centre) for a, b in pairwise(points))
            assert nearest == pytest.approx(R, abs=1e-6)


def _distance(a: tuple[float, float], b: tuple[float, float], p: tuple[float, float]) -> float:
    """Of a point from a stretch, worked out here and nowhere else."""
    dx, dz = b[0] - a[0], b[1] - a[1]
    share = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dz) / (dx * dx + dz * dz)))
    return dist((a[0] + share * dx, a[1] + share * dz), p)


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nM30", "comp-open", 5),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nG40 X60 Z5\nM30", "comp-empty", 3),
        ("T1 D1\nG0 X60 Z5\nG42\nG3 X80 Z0 CR=50 F100\nG1 Z-20\nG40 X60 Z5", "comp-approach", 4),
        ("G0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG40 X60 Z5", "comp-no-edge", 2),
        ("T1 D0\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG40 X60 Z5", "comp-no-edge", 3),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nG17\nZ-20\nG40 X60 Z5", "comp-plane", 4),
        ("T1 D1\nG17 G42 G1 X20 Z0 F200", "comp-plane", 2),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nT2\nZ-20\nG40 X60 Z5", "comp-with", 4),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nD0\nZ-20\nG40 X60 Z5", "comp-with", 4),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG41 X40\nG40 X60 Z5", "comp-with", 5),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20 C90\nG40 X60 Z5", "comp-with", 4),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nG53 Z-20\nZ-30\nG40 X60 Z5", None, 0),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nTRANS Z3\nZ-20\nG40 X60 Z5", "comp-with", 5),
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG40 G2 X60 Z5 CR=60", "comp-departure", 5),
        # a groove of 1 mm for a nose of 1.6 mm
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-5\nX16\nZ-6\nX20\nZ-20\nG40 X60 Z5", "comp-gouge", 6),
        # a fillet of R 0.5
        ("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20 RND=0.5\nX40\nG40 X60 Z5", "comp-gouge", 4),
    ],
)
def test_invalid_compensation_is_rejected(text: str, code: str | None, line: int) -> None:
    if code is None:
        assert run(text, with_tool()).errors == []  # without offsets in force G53 changes nothing
        return
    error = refused(text, with_tool())
    assert (error.code, error.line) == (code, line)
    assert error.hint


def test_nose_without_radius_or_quadrant_is_reported() -> None:
    assert [each.code for each in run(STEP, with_tool(3, 0.0)).found] == ["comp-no-radius"]
    assert [each.code for each in run(STEP, with_tool(0)).found] == ["comp-no-quadrant"]


def test_compensation_side_is_reversed_by_mirroring() -> None:
    """MIRROR Z: G41 along Z+ of the program is the same cut as G42 along Z-, seen in the machine."""
    text = "T1 D1\nMIRROR Z0\nG0 X60 Z-5\nG41 G1 X20 Z0 F200\nZ20\nX40\nG40 X60 Z-5\n"
    assert ends(good(text, with_tool())) == ends(good(STEP, with_tool()))


def test_actions_between_moves_run_at_the_compensated_position() -> None:
    text = "T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nM8\nZ-20\nG4 F1\nX40\nG40 X60 Z5\n"
    blocks = run(text, with_tool()).blocks
    at = [(block.x, block.z) for block in blocks if block.action is not None][1:]
    assert at == [pytest.approx((10.0, -R)), pytest.approx((10.0, -20.0))]


def test_g40_without_following_move_leaves_nose_at_contour_end() -> None:
    """The end of the program leaves the nose square to the end of the contour."""
    blocks = run("T1 D1\nG0 X60 Z5\nG42 G1 X20 Z0 F200\nZ-20\nG40\nM30\n", with_tool(9)).blocks
    assert (blocks[-1].x, blocks[-1].z) == pytest.approx((10.0 + R, -20.0))
