"""Thread milling: helix, sense, pitch, depth and feed as the manual's table says, measured on the way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.interpreter.elementary_blocks import Block, Kind
from tests.klartext.running import Ran, run
from tests.klartext.test_pocket_cycles import cuts, way

R = 3.0
TOOL = f"TOOL DEF 5 L+0 R+{R:g}\nTOOL CALL 5 Z S2000 F500\nL X+50 Y+40 Z+60 R0 FMAX M3\n"
MIDDLE = np.array([50.0, 40.0])
COMMON = {
    "Q335": 16,
    "Q239": 1.5,
    "Q201": -20,
    "Q253": 750,
    "Q351": 1,
    "Q200": 2,
    "Q203": 0,
    "Q204": 50,
    "Q207": 500,
}
OF: dict[int, dict[str, float]] = {
    262: {"Q355": 0},
    263: {"Q356": -20, "Q357": 0, "Q358": 0, "Q359": 0, "Q254": 150},
    264: {"Q356": -20, "Q202": 5, "Q258": 0.2, "Q257": 0, "Q256": 0.2, "Q358": 0, "Q359": 0, "Q206": 150},
    265: {"Q358": 0, "Q359": 0, "Q360": 0, "Q254": 150},
    267: {"Q355": 0, "Q358": 0, "Q359": 0, "Q254": 150},
}


def milled(number: int, **q: float) -> Ran:
    told = COMMON | OF[number] | {name.upper(): value for name, value in q.items()}
    lines = "".join(f" ~\n  {name}={value:+g}" for name, value in told.items())
    return run(f"CYCL DEF {number} NAME{lines}\nCYCL CALL", tool=TOOL)


def radii(block: Block) -> np.ndarray:
    found: np.ndarray = np.hypot(*(way(block)[:, :2] - MIDDLE).T)
    return found


def helices(ran: Ran, ring: float) -> list[Block]:
    """Blocks that go all the way round at this radius."""
    assert ran.codes == []
    arcs = [block for block in ran.blocks if block.kind is Kind.PLANE_ARC]
    return [block for block in arcs if np.abs(radii(block) - ring).max() < 1e-6]


def sense(block: Block) -> float:
    path = way(block)[:, :2] - MIDDLE
    (x0, y0), (x1, y1) = path[:2]
    return float(np.sign(x0 * y1 - y0 * x1))


def rise(block: Block) -> float:
    path = way(block)
    return float(path[-1, 2] - path[0, 2])


@pytest.mark.parametrize(
    ("pitch", "q351", "turn", "up"), [(1.5, 1, 1, 1), (-1.5, -1, -1, 1), (1.5, -1, -1, -1), (-1.5, 1, 1, -1)]
)
def test_hand_and_sense_say_which_way_the_tool_works(
    pitch: float, q351: float, turn: float, up: float
) -> None:
    (helix,) = helices(milled(262, q239=pitch, q351=q351), 8.0 - R)
    assert sense(helix) == turn
    assert rise(helix) == pytest.approx(up * 1.5)
    assert way(helix)[:, 2].min() == pytest.approx(-20.0)
    assert way(helix)[0, :2] == pytest.approx([55.0, 40.0])


def test_the_feed_is_that_of_the_cutting_edge() -> None:
    (inside,) = helices(milled(262), 5.0)
    assert inside.feed * 60.0 == pytest.approx(500.0 * 5.0 / 8.0)
    (outside,) = helices(milled(267), 11.0)
    assert outside.feed * 60.0 == pytest.approx(500.0 * 11.0 / 8.0)


def test_threads_per_step() -> None:
    """1: ceil(20 / 1.5) = 14 turns up from the depth; 3: ceil(20 / 4.5) = 5 turns, 4.5 mm from each other."""
    whole = helices(milled(262, q355=1), 5.0)
    assert len(whole) == 14
    assert way(whole[0])[0, 2] == pytest.approx(-20.0)
    assert way(whole[-1])[-1, 2] == pytest.approx(1.0)
    steps = helices(milled(262, q355=3, q351=-1), 5.0)
    assert [way(block)[-1, 2] for block in steps] == pytest.approx([-2.0, -6.5, -11.0, -15.5, -20.0])


@pytest.mark.parametrize("number", [262, 263, 264, 265])
def test_no_point_of_the_tool_leaves_an_inside_thread(number: int) -> None:
    """Not on the way to the helix either; above the surface it may stand where it likes."""
    points = cuts(milled(number))
    deep = points[points[:, 2] < 0.0]
    assert np.hypot(*(deep[:, :2] - MIDDLE).T).max() == pytest.approx(8.0 - R, abs=1e-6)


def test_the_ways_to_the_helix_follow_the_thread() -> None:
    """Wherever the tool is at the thread's diameter, its height is the helix's for that angle."""
    points = np.concatenate(
        [way(block) for block in milled(262, q355=1).blocks if block.kind is Kind.PLANE_ARC]
    )
    at_ring = points[np.hypot(*(points[:, :2] - MIDDLE).T) > 5.0 - 1e-3]
    angle = np.unwrap(np.arctan2(at_ring[:, 1] - 40.0, at_ring[:, 0] - 50.0))
    off = at_ring[:, 2] - (-20.0 + 1.5 * angle / (2.0 * math.pi))
    assert np.abs((off + 0.75) % 1.5 - 0.75).max() < 0.02


def test_an_outside_thread_runs_round_its_stud_and_comes_from_beside_it() -> None:
    ran = milled(267)
    (helix,) = helices(ran, 11.0)
    assert sense(helix) == -1.0
    assert rise(helix) == pytest.approx(-1.5)
    points = cuts(ran)
    assert np.hypot(*(points[points[:, 2] < 0.0][:, :2] - MIDDLE).T).min() >= 11.0 - 1e-6
    (other,) = helices(milled(267, q351=-1), 11.0)
    assert sense(other) == 1.0
    assert rise(other) == pytest.approx(1.5)
    for block in ran.blocks:  # no rapid beside the stud below its top
        if block.kind is Kind.RAPID and block.moves and np.ptp(way(block)[:, :2], axis=0).max() > 1e-9:
            assert way(block)[:, 2].min() >= 2.0 - 1e-9


def test_drilling_before_the_thread_and_countersinking_at_the_front() -> None:
    drilled = [
        way(block)[-1, 2] for block in milled(264).blocks if block.kind is Kind.FEED and rise(block) < -1.0
    ]
    assert drilled[:4] == pytest.approx([-5.0, -10.0, -15.0, -20.0])
    ran = milled(263, q358=-1, q359=2)
    rings = helices(ran, 2.0)
    assert [rise(block) for block in rings] == [0.0]
    assert way(rings[0])[0, 2] == pytest.approx(-1.0)
    assert rings[0].feed * 60.0 == pytest.approx(150.0)


def test_a_helical_thread_goes_down_whatever_its_hand() -> None:
    right, left = helices(milled(265, q201=-16), 5.0), helices(milled(265, q201=-16, q239=-1.5), 5.0)
    assert (len(right), len(left)) == (11, 11)  # ceil(16 / 1.5)
    assert way(right[0])[0, 2] == pytest.approx(0.5)
    assert way(right[-1])[-1, 2] == pytest.approx(-16.0)
    assert (sense(right[0]), sense(left[0])) == (-1.0, 1.0)


@pytest.mark.parametrize(
    ("number", "q", "names"),
    [
        (262, {"q335": 6}, "cannot mill a thread"),
        (262, {"q239": 0}, "Pitch Q239"),
        (262, {"q207": 99999}, "rapid"),
        (262, {"q201": 5}, "positive (upward)"),
        (262, {"q355": -1}, "Q355"),
        (263, {"q358": 1}, "Q358"),
        (264, {"q356": 5}, "Q356"),
        (267, {"q358": 1, "q359": 12}, "Q358"),
    ],
)
def test_refused(number: int, q: dict[str, float], names: str) -> None:
    ran = milled(number, **q)
    assert ran.codes == ["Input value incorrect"]
    assert names in ran.errors[0].message


def test_a_thread_of_no_depth_is_not_milled() -> None:
    assert helices(milled(262, q201=0), 5.0) == []
