"""Faces, circular slots, the older cycles 210 to 215: what is gone over, how far the tool's edge reaches."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.elementary_blocks import Kind
from tests.klartext.running import Ran, run
from tests.klartext.test_pocket_cycles import Points, cuts, left_standing, rounded, way

R = 3.0
TOOL = f"TOOL DEF 5 L+0 R+{R:g}\nTOOL CALL 5 Z S2000 F500\nL X+50 Y+50 Z+60 R0 FMAX M3\n"


def told(parameters: str) -> dict[str, float]:
    """Parameters of a cycle as they are told: Q200=2 Q201=-10."""
    return {name: float(value) for name, value in (each.split("=") for each in parameters.split())}


FACE = told(
    "Q218=50 Q219=31 Q227=2 Q386=-3 Q202=2 Q369=0.5 Q370=1.6"
    " Q207=500 Q385=250 Q253=750 Q200=2 Q357=1 Q204=20 Q389=0"
)
OLD = told("Q200=2 Q201=-10 Q206=150 Q202=5 Q207=500 Q203=0 Q204=50 Q216=50 Q217=50")
SURFACE = "Q225=0 Q226=5 Q227=-2 Q228=100 Q229=15 Q230=5 Q231=15 Q232=125 Q233=25 Q234=15 Q235=125 Q236=25"
SLOT = "Q215=0 Q219=12 Q368=0 Q375=60 Q367=0 Q216=50 Q217=50 Q376=0 Q248=90 Q378=0 Q377=1 Q207=500 Q351=1"
LEVELS = " Q201=-7 Q202=3 Q369=0 Q206=150 Q338=0 Q200=2 Q203=0 Q204=50 Q366=1 Q385=250"
OF: dict[int, dict[str, float]] = {
    210: OLD | told("Q218=40 Q219=12 Q224=0 Q215=0 Q338=0"),
    211: OLD | told("Q244=60 Q219=12 Q245=0 Q248=90 Q215=0 Q338=0"),
    212: OLD | told("Q218=80 Q219=60 Q220=5 Q221=0"),
    213: OLD | told("Q218=40 Q219=30 Q220=2 Q221=0"),
    214: OLD | told("Q222=79 Q223=80"),
    215: OLD | told("Q222=81 Q223=80"),
    230: told("Q225=10 Q226=12 Q227=2.5 Q218=80 Q219=60 Q240=7 Q206=150 Q207=500 Q209=200 Q200=2"),
    231: told(SURFACE + " Q240=40 Q207=500"),
    232: FACE | told("Q225=10 Q226=12"),
    233: FACE | told("Q215=0 Q350=1 Q367=-1"),
    254: told(SLOT + LEVELS),
}


def milled(number: int, **q: float) -> Ran:
    asked = OF[number] | {name.upper(): value for name, value in q.items()}
    lines = "".join(f" ~\n  {name}={value:+g}" for name, value in asked.items())
    return run(f"CYCL DEF {number} NAME{lines}\nCYCL CALL", tool=TOOL)


def rectangle(x: float, y: float, length: float, width: float) -> Points:
    u, v = np.meshgrid(np.linspace(x, x + length, 41), np.linspace(y, y + width, 29))
    return np.stack([u.ravel(), v.ravel()], axis=1)


@pytest.mark.parametrize("strategy", [0, 1, 2, 3, 4])
@pytest.mark.parametrize("overlap", [0.5, 1.6, 1.99])
@pytest.mark.long
def test_every_spot_of_a_face_is_gone_over_at_every_depth(strategy: int, overlap: float) -> None:
    """From Z2 to Z-2.5 in even infeeds of 2 at most (3 of 1.5), the last half millimetre at Q385."""
    ran = milled(233 if strategy > 2 else 232, q389=strategy, q370=overlap)
    points = cuts(ran)
    x, y = (50.0, 50.0) if strategy > 2 else (10.0, 12.0)
    for z in (0.5, -1.0, -2.5, -3.0):
        level = points[np.abs(points[:, 2] - z) < 1e-6][:, :2]
        assert left_standing(level, rectangle(x, y, 50, 31)) <= R + 1e-3 + 0.01
        assert level[:, 1].max() <= y + 31 - R + 1e-9  # the last row ends with the face
    assert {round(block.feed * 60) for block in ran.blocks if block.kind is Kind.FEED} == {250, 500, 750}


@pytest.mark.parametrize("strategy", [0, 1, 2, 3])
def test_a_face_is_come_to_from_outside_and_no_rapid_is_in_it(strategy: int) -> None:
    for block in milled(232 if strategy < 3 else 233, q389=strategy).blocks:
        spots = way(block)
        if block.kind is Kind.RAPID and block.moves and np.ptp(spots[:, :2], axis=0).max() > 1e-9:
            assert spots[:, 2].min() >= 4.0 - 1e-9
        if block.kind is Kind.FEED and spots[-1, 2] < spots[0, 2] - 1e-9:
            x = 10.0 if strategy < 3 else 50.0
            assert spots[:, 0].max() <= x - R - 1.0 + 1e-9


def test_sides_may_be_signed_and_rows_along_the_second_axis() -> None:
    points = cuts(milled(233, q218=-50, q219=-31, q350=2, q367=-1, q389=0))
    level = points[np.abs(points[:, 2] + 3.0) < 1e-6][:, :2]
    assert left_standing(level, rectangle(0.0, 19.0, 50, 31)) <= R + 0.02
    middle = cuts(milled(233, q367=0))
    level = middle[np.abs(middle[:, 2] + 3.0) < 1e-6][:, :2]
    assert left_standing(level, rectangle(25.0, 34.5, 50, 31)) <= R + 0.02


def test_multipass_rows_stand_evenly_from_edge_to_edge() -> None:
    """7 rows over 60 mm: 10 mm from each other, out of the face by the radius at both ends."""
    rows = [
        block for block in milled(230).blocks if block.kind is Kind.FEED and round(block.feed * 60) == 500
    ]
    ends = [way(block)[-1] for block in rows]
    assert [end[1] for end in ends] == pytest.approx([12, 22, 32, 42, 52, 62, 72])
    assert [end[0] for end in ends] == pytest.approx([90 + R, 10 - R] * 3 + [90 + R])
    assert {end[2] for end in ends} == {2.5}


def test_a_ruled_surface_runs_between_its_two_lines() -> None:
    rows = [
        block for block in milled(231).blocks if block.kind is Kind.FEED and np.ptp(way(block)[:, 0]) > 1e-6
    ]
    assert len(rows) == 39  # the fortieth ends where it begins: P3 is P4
    assert way(rows[0])[0] == pytest.approx([0, 5, -2])
    assert way(rows[0])[-1] == pytest.approx([100, 15, 5])


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
def test_a_circular_slot_is_cleared_and_no_more(number: int, plunge: int) -> None:
    points = cuts(milled(number, q366=plunge))
    bottom = -7.0 if number == 254 else -10.0
    deep = points[points[:, 2] < -1e-9][:, :2]
    assert in_slot(deep).max() <= -R + 2e-3
    floor = points[points[:, 2] < bottom + 1e-6][:, :2]
    spots = rectangle(40.0, 40.0, 50, 50)
    assert left_standing(floor, spots[in_slot(spots) <= 0.0]) <= R + 0.05


def test_circular_slots_stand_by_the_tool_or_by_their_centre_and_repeat() -> None:
    """The tool at X50 Y50 is the left end at 0 degrees: the circle's centre lies at X20."""
    deep = cuts(milled(254, q367=1))
    deep = deep[deep[:, 2] < -1e-9][:, :2] + (30.0, 0.0)
    assert in_slot(deep).max() <= -R + 2e-3
    twice = cuts(milled(254, q377=2, q378=180))
    low = twice[twice[:, 2] < -1e-9][:, :2]
    assert low[:, 0].min() == pytest.approx(50 - 30 - 6 + R, abs=2e-3)
    assert low[:, 0].max() == pytest.approx(50 + 30 + 6 - R, abs=2e-3)


def test_allowances_of_a_circular_slot_are_taken_at_the_finishing_feed() -> None:
    rough = cuts(milled(254, q215=1, q368=0.4, q369=0.3))
    assert in_slot(rough[rough[:, 2] < -1e-9][:, :2]).max() == pytest.approx(-R - 0.4, abs=2e-3)
    assert rough[:, 2].min() == pytest.approx(-6.7)
    both = milled(254, q368=0.4, q369=0.3)
    points = cuts(both)
    assert in_slot(points[points[:, 2] < -1e-9][:, :2]).max() == pytest.approx(-R, abs=2e-3)
    assert points[:, 2].min() == pytest.approx(-7.0)
    assert 250 in {round(block.feed * 60) for block in both.blocks if block.kind is Kind.PLANE_ARC}


def test_older_pockets_and_studs_are_gone_round_at_their_walls() -> None:
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
    (cut,) = [block for block in ran.blocks if block.kind is Kind.FEED]
    assert way(cut)[-1, 2] == pytest.approx(-25.0)
    assert (cut.feed, cut.per_rev, cut.coupled) == (pytest.approx(1.0), True, True)
    assert cut.rpm == 2000.0
    assert ran.state.modal.spindle == 0
    assert "tapping-uncoupled" in ran.warned


@pytest.mark.parametrize(
    ("number", "q", "names"),
    [
        (230, {"q240": 1}, "Q240"),
        (230, {"q207": 99999}, "rapid"),
        (231, {"q240": 0}, "Q240"),
        (232, {"q386": 5}, "Q386"),
        (232, {"q389": 7}, "Q389"),
        (232, {"q370": 2}, "Q370"),
        (233, {"q347": 1}, "limit"),
        (233, {"q367": 8}, "Q367"),
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
def test_refused(number: int, q: dict[str, float], names: str) -> None:
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
def test_back_boring_is_refused_however_it_is_called_because_nothing_orients_the_spindle(call: str) -> None:
    """Its bar goes into the hole beside the centre: with the edge at any other angle it meets the wall."""
    lines = "".join(f" ~\n  {name}={value:+g}" for name, value in BACK.items())
    ran = run(f"CYCL DEF 204 BACK BORING{lines}\n{call}", tool=TOOL)
    assert ran.codes == ["Input value incorrect"]
    assert "cannot be oriented" in ran.errors[0].message
    assert min(block.swivel.end[2] for block in ran.blocks if block.swivel) >= 0.0


def test_boring_that_frees_its_edge_aside_says_that_nothing_turns_it_there() -> None:
    hole = (
        "CYCL DEF 202 BORING ~\n Q200=2 ~\n Q201=-9 ~\n Q206=99 ~\n Q214={} ~\n Q203=0 ~\n Q204=9\nCYCL CALL"
    )
    assert "spindle-not-oriented" in run(hole.format(1), tool=TOOL).warned
    assert "spindle-not-oriented" not in run(hole.format(0), tool=TOOL).warned
