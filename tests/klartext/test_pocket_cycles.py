"""Pockets, slots and studs: what is cleared and what is left standing, measured on a grid of points."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from core.geometry.working_plane import HelixMove
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.klartext.running import Ran, run

R = 4.0
TOOL = f"TOOL DEF 5 L+0 R+{R:g}\nTOOL CALL 5 Z S2000 F500\nL X+10 Y+20 Z+60 R0 FMAX M3\n"
COMMON = {
    "Q207": 400, "Q206": 150, "Q351": 1, "Q201": -7, "Q202": 3, "Q203": 1, "Q204": 30, "Q200": 2,
    "Q370": 1, "Q366": 1, "Q369": 0, "Q338": 0, "Q368": 0, "Q367": 0, "Q215": 0, "Q385": 250,
}  # fmt: skip
CYCLES: dict[int, dict[str, float]] = {
    251: {"Q218": 60, "Q219": 36, "Q220": 6, "Q224": 0},
    252: {"Q223": 50},
    253: {"Q218": 40, "Q219": 12, "Q374": 0},
    256: {"Q218": 40, "Q219": 30, "Q220": 5, "Q224": 0, "Q424": 52, "Q425": 46},
    257: {"Q223": 40, "Q222": 55, "Q376": 0},
}
Points = npt.NDArray[np.float64]


def milled(number: int, **q: float) -> Ran:
    told = COMMON | CYCLES[number] | {name.upper(): value for name, value in q.items()}
    lines = "".join(f" ~\n  {name}={value:+g} ;WHAT" for name, value in told.items())
    return run(f"CYCL DEF {number} NAME{lines}\nCYCL CALL", tool=TOOL)


def way(block: Block) -> Points:
    """Points of the tip a tenth of a millimetre apart, in the program's coordinates."""
    assert block.swivel is not None
    share = np.linspace(0.0, 1.0, max(2, math.ceil(block.length / 0.1)))
    if block.travel is not None and isinstance(block.travel.curved_move, HelixMove):
        return block.travel.curved_move.compute_workpiece_points(
            block.travel.curved_move.compute_machine_positions(share)
        )
    start, end = np.array(block.swivel.start), np.array(block.swivel.end)
    straight: Points = start + share[:, None] * (end - start)
    return straight


def cuts(ran: Ran) -> Points:
    assert ran.codes == []
    feeds = [way(block) for block in ran.blocks if block.kind in {BlockKind.FEED, BlockKind.PLANE_ARC}]
    return np.concatenate(feeds)


def rounded(points: Points, a: float, b: float, r: float) -> Points:
    """How far points lie outside a rectangle with round corners; negative inside."""
    beyond = np.abs(points) - (a - r, b - r)
    outside: Points = np.hypot(*np.maximum(beyond, 0.0).T) + np.minimum(beyond.max(axis=1), 0.0) - r
    return outside


def left_standing(path: Points, spots: Points) -> float:
    """The largest distance of a spot from the path, mm."""
    nearest = [np.hypot(*(path - spot).T).min() for spot in spots]
    return float(max(nearest))


def grid(a: float, b: float, r: float, pitch: float = 1.7) -> Points:
    u, v = np.meshgrid(np.arange(-a, a + 1e-9, pitch), np.arange(-b, b + 1e-9, pitch))
    spots = np.stack([u.ravel(), v.ravel()], axis=1)
    return spots[rounded(spots, a, b, r) <= 0.0]


@pytest.mark.parametrize(("number", "a", "b", "r"), [(251, 30, 18, 6), (252, 25, 25, 25), (253, 20, 6, 6)])
@pytest.mark.parametrize("plunge", [0, 1, 2])
def test_pocket_is_cleared_without_overcut(number: int, a: float, b: float, r: float, plunge: int) -> None:
    """The tip's way stays R inside the walls, ends on the floor, and passes every spot within R."""
    points = cuts(milled(number, q366=plunge))
    here = points[:, :2] - (10.0, 20.0)
    deep = points[:, 2] < 1.0 - 1e-9
    assert rounded(here[deep], a, b, r).max() == pytest.approx(-R, abs=1e-6)
    assert points[:, 2].min() == pytest.approx(-6.0)
    floor = here[points[:, 2] < -6.0 + 1e-6]
    assert left_standing(floor, grid(a, b, r)) <= R + 0.05


def test_q367_and_q224_set_pocket_position_and_rotation() -> None:
    """The tool at the lower left corner, the pocket turned by 90 degrees: it lies to the left and above."""
    points = cuts(milled(251, q367=1, q224=90))
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    assert low == pytest.approx([10 - 36 + R, 20 + R])
    assert high == pytest.approx([10 - R, 20 + 60 - R])


def test_slot_starts_at_its_left_end() -> None:
    points = cuts(milled(253, q367=1))
    assert points[:, 0].min() == pytest.approx(10 + R)
    assert points[:, 0].max() == pytest.approx(10 + 40 - R)


def test_slot_of_tool_width_is_cut_once_per_level() -> None:
    points = cuts(milled(253, q219=8, q366=0))
    assert np.ptp(points[:, 1]) == pytest.approx(0.0, abs=1e-9)
    assert sorted({round(z, 6) for z in points[:, 2] if z < 1.0} & {-2.0, -5.0, -6.0}) == [-6.0, -5.0, -2.0]


def test_allowances_remain_after_clearing_and_finishing_removes_them() -> None:
    rough = cuts(milled(251, q215=1, q368=0.5, q369=0.3))
    assert rounded(rough[:, :2] - (10, 20), 30, 18, 6).max() == pytest.approx(-R - 0.5, abs=1e-6)
    assert rough[:, 2].min() == pytest.approx(-5.7)
    whole = milled(251, q215=0, q368=0.5, q369=0.3)
    points = cuts(whole)
    assert rounded(points[:, :2] - (10, 20), 30, 18, 6).max() == pytest.approx(-R, abs=1e-6)
    assert points[:, 2].min() == pytest.approx(-6.0)
    assert {round(block.feed * 60) for block in whole.blocks if block.kind is BlockKind.PLANE_ARC} == {
        250,
        400,
    }


def test_climb_milling_is_ccw_in_pocket_and_cw_around_stud() -> None:
    for number, q351, sense in ((252, 1, 1), (252, -1, -1), (257, 1, -1), (257, -1, 1)):
        ran = milled(number, q351=q351, q366=0)
        assert ran.codes == []
        arcs = [block for block in ran.blocks if block.kind is BlockKind.PLANE_ARC]
        path = way(max(arcs, key=lambda block: block.length))[:, :2] - (10.0, 20.0)
        (x0, y0), (x1, y1) = path[:2]
        assert np.sign(x0 * y1 - y0 * x1) == sense


@pytest.mark.parametrize(("number", "a", "b", "r"), [(256, 20, 15, 5), (257, 20, 20, 20)])
def test_stud_remains_and_its_blank_is_cleared(number: int, a: float, b: float, r: float) -> None:
    ran = milled(number)
    points = cuts(ran)
    here = points[:, :2] - (10.0, 20.0)
    low = points[:, 2] < 1.0
    assert rounded(here[low], a, b, r).min() == pytest.approx(R, abs=1e-6)
    floor = here[points[:, 2] < -6.0 + 1e-6]
    wide, high = (26.0, 23.0) if number == 256 else (27.5, 27.5)
    blank = grid(wide, high, 0.01 if number == 256 else wide)
    outside = blank[rounded(blank, a, b, r) >= 0.0]
    assert left_standing(floor, outside) <= R + 0.05
    for block in ran.blocks:  # no rapid goes aside below the surface
        if block.kind is BlockKind.RAPID and block.moves:
            spots = way(block)
            assert np.ptp(spots[:, :2], axis=0).max() == 0.0 or spots[:, 2].min() >= 1.0


@pytest.mark.parametrize(
    ("number", "q", "names"),
    [
        (251, {"q219": 6}, "wider"),
        (253, {"q218": 10}, "wider than it is long"),
        (251, {"q367": 7}, "Q367"),
        (252, {"q201": 5}, "positive (upward)"),
        (252, {"q370": 0}, "Q370"),
        (252, {"q207": 0}, "Q207"),
        (253, {"q218": 8, "q219": 8, "q366": 1}, "not enough room"),
        (256, {"q424": 30, "q425": 20}, "blank"),
    ],
)
def test_invalid_pocket_cycle_is_rejected(number: int, q: dict[str, float], names: str) -> None:
    ran = milled(number, **q)
    assert ran.codes == ["Input value incorrect"]
    assert names in ran.errors[0].message


def test_rapid_feed_in_pocket_cycle_is_rejected() -> None:
    ran = run(
        "CYCL DEF 252 POCKET ~\n Q207=MAX ~\n Q206=9 ~\n Q223=30 ~\n Q201=-5 ~\n Q200=2\nCYCL CALL", tool=TOOL
    )
    assert "rapid" in ran.errors[0].message
