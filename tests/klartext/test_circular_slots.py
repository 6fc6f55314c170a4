"""Circular slots, the older cycles 210 to 215: what is gone over, how far the tool's edge reaches."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.klartext.running import Ran, run
from tests.klartext.test_pocket_cycles import Points, cuts, left_standing, rounded, way

R = 3.0
TOOL = f"TOOL DEF 5 L+0 R+{R:g}\nTOOL CALL 5 Z S2000 F500\nL X+50 Y+50 Z+60 R0 FMAX M3\n"


def told(parameters: str) -> dict[str, float]:
    """Parameters of a cycle as they are told: Q200=2 Q201=-10."""
    return {name: float(value) for name, value in (each.split("=") for each in parameters.split())}


OLD = told("Q200=2 Q201=-10 Q206=150 Q202=5 Q207=500 Q203=0 Q204=50 Q216=50 Q217=50")
SLOT = "Q215=0 Q219=12 Q368=0 Q375=60 Q367=0 Q216=50 Q217=50 Q376=0 Q248=90 Q378=0 Q377=1 Q207=500 Q351=1"
LEVELS = " Q201=-7 Q202=3 Q369=0 Q206=150 Q338=0 Q200=2 Q203=0 Q204=50 Q366=1 Q385=250"
OF: dict[int, dict[str, float]] = {
    210: OLD | told("Q218=40 Q219=12 Q224=0 Q215=0 Q338=0"),
    211: OLD | told("Q244=60 Q219=12 Q245=0 Q248=90 Q215=0 Q338=0"),
    212: OLD | told("Q218=80 Q219=60 Q220=5 Q221=0"),
    213: OLD | told("Q218=40 Q219=30 Q220=2 Q221=0"),
    214: OLD | told("Q222=79 Q223=80"),
    215: OLD | told("Q222=81 Q223=80"),
    254: told(SLOT + LEVELS),
}


def milled(number: int, **q: float) -> Ran:
    asked = OF[number] | {name.upper(): value for name, value in q.items()}
    lines = "".join(f" ~\n  {name}={value:+g}" for name, value in asked.items())
    return run(f"CYCL DEF {number} NAME{lines}\nCYCL CALL", tool=TOOL)


def rectangle(x: float, y: float, length: float, width: float) -> Points:
    u, v = np.meshgrid(np.linspace(x, x + length, 41), np.linspace(y, y + width, 29))
    return np.stack([u.ravel(), v.ravel()], axis=1)


def in_slot(points: Points) -> Points:
    """How far points lie outside the slot of 12 mm on R30 about X50 Y50, from 0 to 90 degrees."""
    here = points - (50.0, 50.0)
    angle = np.arctan2(here[:, 1], here[:, 0])
    on_arc = (angle >= 0.0) & (angle <= np.pi / 2)
    ends = np.minimum(np.hypot(*(here - (30.0, 0.0)).T), np.hypot(*(here - (0.0, 30.0)).T))
    outside: Points = np.where(on_arc, np.abs(np.hypot(*here.T) - 30.0), ends) - 6.0
    return outside


@pytest.mark.parametrize("number", [254, 211])
@pytest.mark.parametrize("plunge", [0, 1])
def test_circular_slot_is_cleared_without_overcut(number: int, plunge: int) -> None:
    points = cuts(milled(number, q366=plunge))
    bottom = -7.0 if number == 254 else -10.0
    deep = points[points[:, 2] < -1e-9][:, :2]
    assert in_slot(deep).max() <= -R + 2e-3
    floor = points[points[:, 2] < bottom + 1e-6][:, :2]
    spots = rectangle(40.0, 40.0, 50, 50)
    assert left_standing(floor, spots[in_slot(spots) <= 0.0]) <= R + 0.05


def test_circular_slot_positions_and_repeats() -> None:
    """The tool at X50 Y50 is the left end at 0 degrees: the circle's centre lies at X20."""
    deep = cuts(milled(254, q367=1))
    deep = deep[deep[:, 2] < -1e-9][:, :2] + (30.0, 0.0)
    assert in_slot(deep).max() <= -R + 2e-3
    twice = cuts(milled(254, q377=2, q378=180))
    low = twice[twice[:, 2] < -1e-9][:, :2]
    assert low[:, 0].min() == pytest.approx(50 - 30 - 6 + R, abs=2e-3)
    assert low[:, 0].max() == pytest.approx(50 + 30 + 6 - R, abs=2e-3)


def test_circular_slot_allowances_are_removed_at_finishing_feed() -> None:
    rough = cuts(milled(254, q215=1, q368=0.4, q369=0.3))
    assert in_slot(rough[rough[:, 2] < -1e-9][:, :2]).max() == pytest.approx(-R - 0.4, abs=2e-3)
    assert rough[:, 2].min() == pytest.approx(-6.7)
    both = milled(254, q368=0.4, q369=0.3)
    points = cuts(both)
    assert in_slot(points[points[:, 2] < -1e-9][:, :2]).max() == pytest.approx(-R, abs=2e-3)
    assert points[:, 2].min() == pytest.approx(-7.0)
    assert 250 in {round(block.feed * 60) for block in both.blocks if block.kind is BlockKind.PLANE_ARC}


def test_older_pocket_and_stud_cycles_finish_their_walls() -> None:
    """The tool's centre: 80 by 60 about X50 Y50 less R, 40 by 30 plus R, circles of R40 less and plus R."""
    floor = {number: cuts(milled(number)) for number in (210, 212, 213, 214, 215)}
    deep = {number: points[points[:, 2] < -10.0 + 1e-6][:, :2] - (50, 50) for number, points in floor.items()}
    assert rounded(deep[210], 20, 6, 6).max() == pytest.approx(-R, abs=1e-6)
    assert rounded(deep[212], 40, 30, 5).max() == pytest.approx(-R, abs=1e-6)
    assert rounded(deep[213], 20, 15, 2).min() == pytest.approx(R, abs=1e-6)
    assert np.hypot(*deep[214].T).max() == pytest.approx(40 - R)
    assert np.hypot(*deep[215].T).min() == pytest.approx(40 + R)
    assert {-5.0, -10.0} <= {round(z, 6) for z in floor[212][:, 2]}


def test_thread_cutting_starts_and_stops_the_spindle_itself() -> None:
    cycle = "CYCL DEF 18.0 THREAD CUTTING\nCYCL DEF 18.1 DEPTH -20\nCYCL DEF 18.2 PITCH +1\nCYCL CALL"
    ran = run("L Z-5 R0 FMAX M5\n" + cycle, tool=TOOL)
    assert ran.codes == []
    (cut,) = [block for block in ran.blocks if block.kind is BlockKind.FEED]
    assert way(cut)[-1, 2] == pytest.approx(-25.0)
    assert (cut.feed, cut.per_rev, cut.follows_spindle) == (pytest.approx(1.0), True, True)
    assert cut.rpm == 2000.0
    assert ran.state.modal.spindle == 0
    assert "tapping-uncoupled" in ran.warned


@pytest.mark.parametrize(
    ("number", "q", "names"),
    [
        (254, {"q219": 70}, "slot"),
        (254, {"q219": 5}, "does not fit anywhere"),
        (254, {"q248": 350}, "ends of the slot overlap"),
        (254, {"q367": 5}, "Q367"),
        (254, {"q370": 3}, "Q370"),
        (254, {"q377": 0}, "Q377"),
        (210, {"q219": 5}, "wider than the pocket"),
        (212, {"q201": 5}, "positive (upward)"),
        (213, {"q207": 99999}, "Q207"),
    ],
)
def test_invalid_cycle_value_is_rejected(number: int, q: dict[str, float], names: str) -> None:
    ran = milled(number, **q)
    assert ran.codes == ["Input value incorrect"]
    assert names in ran.errors[0].message


BACK = told("Q200=2 Q249=5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 Q255=0 Q203=0 Q204=50 Q214=1 Q336=0")


@pytest.mark.parametrize(
    "call",
    [
        "CYCL CALL",
        "L X+10 Y+20 R0 FMAX M99",
        "CYCL CALL POS X+10 Y+20 Z+0 FMAX",
        "PATTERN DEF POS1 (X+10 Y+20 Z+0)\nCYCL CALL PAT FMAX",
        "CYCL DEF 220 POLAR ~\n Q216=0 ~\n Q217=0 ~\n Q244=80 ~\n Q245=0 ~\n Q246=360 ~\n Q241=6 ~\n Q301=1",
        "CYCL DEF 221 ROWS ~\n Q225=0 ~\n Q226=0 ~\n Q237=9 ~\n Q238=9 ~\n Q242=2 ~\n Q243=1 ~\n Q224=0",
    ],
)
def test_back_boring_is_rejected_without_oriented_spindle(call: str) -> None:
    """Its bar goes into the hole beside the centre: with the edge at any other angle it meets the wall."""
    lines = "".join(f" ~\n  {name}={value:+g}" for name, value in BACK.items())
    ran = run(f"CYCL DEF 204 BACK BORING{lines}\n{call}", tool=TOOL)
    assert ran.codes == ["Input value incorrect"]
    assert "cannot be oriented" in ran.errors[0].message
    assert min(block.swivel.end[2] for block in ran.blocks if block.swivel) >= 0.0


def test_boring_with_retract_from_wall_warns_without_oriented_spindle() -> None:
    hole = (
        "CYCL DEF 202 BORING ~\n Q200=2 ~\n Q201=-9 ~\n Q206=99 ~\n Q214={} ~\n Q203=0 ~\n Q204=9\nCYCL CALL"
    )
    assert "spindle-not-oriented" in run(hole.format(1), tool=TOOL).warned
    assert "spindle-not-oriented" not in run(hole.format(0), tool=TOOL).warned
