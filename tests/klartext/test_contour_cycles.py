"""SL cycles: what is cleared, what is left standing and what is not touched, measured by closed formulas."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.language.klartext.named_files import find_called_programs
from core.language.source import ProgramSource
from tests.klartext.running import Ran, run, run_source, whole
from tests.klartext.test_pocket_cycles import Points, cuts, left_standing, rounded, way

R = 4.0
TOOL = f"TOOL DEF 5 L+0 R+{R:g}\nTOOL CALL 5 Z S2000 F500\nL X+10 Y+20 Z+60 R0 FMAX M3\n"
DATA = {1: -7, 2: 1, 3: 0, 4: 0, 5: 1, 6: 2, 7: 40, 8: 0.2, 9: 1}
OF: dict[int, dict[int, float]] = {
    21: {10: -3, 11: 100, 13: 5},
    22: {10: -3, 11: 100, 12: 400, 18: 0, 19: 200, 208: 99999},
    23: {11: 100, 12: 300, 208: 99999},
    24: {9: 1, 10: -7, 11: 100, 12: 300, 14: 0},
    25: {10: -3, 11: 100, 12: 400, 15: 1},
}
# A pocket of 60 by 40 with corners of R6 about X30 Y20, clockwise with RR, and a round island of R8 in it.
POCKET = "L X+0 Y+20 RR\nL Y+40\nRND R6\nL X+60\nRND R6\nL Y+0\nRND R6\nL X+0\nRND R6\nL Y+20"
ISLAND = "L X+38 Y+20 RL\nCC X+30 Y+20\nC X+38 Y+20 DR-"


def told(number: int, q: dict[int, float]) -> str:
    return f"CYCL DEF {number} NAME" + "".join(f" ~\n Q{each}={value:+g} ;WHAT" for each, value in q.items())


def program(cycles: tuple[int, ...], contours: tuple[str, ...], **q: float) -> str:
    named = " /".join(str(at) for at in range(1, len(contours) + 1))
    changed = {int(name[1:]): value for name, value in q.items()}
    lines = [
        f"CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL{named}",
        told(20, DATA | {each: value for each, value in changed.items() if each in DATA}),
    ]
    for number in cycles:
        lines += [
            told(number, OF[number] | {e: v for e, v in changed.items() if e in OF[number]}),
            "CYCL CALL",
        ]
    subprograms = "\n".join(f"LBL {at}\n{each}\nLBL 0" for at, each in enumerate(contours, start=1))
    return "\n".join(lines) + f"\nM30\n{subprograms}"


def milled(cycles: tuple[int, ...] | int, *contours: str, **q: float) -> Ran:
    numbers = cycles if isinstance(cycles, tuple) else (cycles,)
    return run(program(numbers, contours or (POCKET, ISLAND), **q), tool=TOOL)


def no_rapid_in_the_part(ran: Ran) -> None:
    """Below the surface a rapid goes up or down alone, and down no deeper than the set-up clearance."""
    for block in ran.blocks:
        if block.kind is BlockKind.RAPID and block.moves:
            spots = way(block)
            assert spots[:, 2].min() >= 3.0 - 1e-9 or (
                np.ptp(spots[:, :2], axis=0).max() < 1e-9 and spots[-1, 2] > spots[0, 2]
            )


def spots_of(width: float, height: float, pitch: float = 1.3) -> Points:
    x, y = np.meshgrid(np.arange(0.0, width + 1e-9, pitch), np.arange(0.0, height + 1e-9, pitch))
    return np.stack([x.ravel(), y.ravel()], axis=1)


@pytest.mark.parametrize("overlap", [0.7, 1, 1.9])
@pytest.mark.parametrize("reciprocation", [0, 200])
@pytest.mark.long
def test_a_pocket_is_roughed_out_round_its_island(overlap: float, reciprocation: float) -> None:
    ran = milled(22, q2=overlap, q19=reciprocation)
    points = cuts(ran)
    deep = points[points[:, 2] < 1.0 - 1e-9][:, :2]
    assert rounded(deep - (30.0, 20.0), 30, 20, 6).max() == pytest.approx(-R, abs=1e-3)
    assert np.hypot(*(deep - (30.0, 20.0)).T).min() == pytest.approx(8.0 + R, abs=1e-3)
    assert points[:, 2].min() == pytest.approx(-6.0)
    spots = spots_of(60, 40)
    inside = (rounded(spots - (30.0, 20.0), 30, 20, 6) <= 0.0) & (np.hypot(*(spots - (30.0, 20.0)).T) >= 8.0)
    for z in (-2.0, -5.0, -6.0):
        level = points[np.abs(points[:, 2] - z) < 1e-6][:, :2]
        assert left_standing(level, spots[inside]) <= R + 0.05
    no_rapid_in_the_part(ran)


def test_allowances_remain_on_walls_floor_and_island_until_finishing() -> None:
    rough = cuts(milled(22, q3=0.5, q4=0.3))
    deep = rough[rough[:, 2] < 1.0 - 1e-9][:, :2] - (30.0, 20.0)
    assert rounded(deep, 30, 20, 6).max() == pytest.approx(-R - 0.5, abs=1e-3)
    assert np.hypot(*deep.T).min() == pytest.approx(8.5 + R, abs=1e-3)
    assert rough[:, 2].min() == pytest.approx(-5.7)
    last = cuts(milled((23, 24), q3=0.5, q4=0.3))
    deep = last[last[:, 2] < -6.0 + 1e-6][:, :2] - (30.0, 20.0)
    assert rounded(deep, 30, 20, 6).max() == pytest.approx(-R, abs=1e-3)
    assert np.hypot(*deep.T).min() == pytest.approx(8.0 + R, abs=1e-3)
    walls = cuts(milled(24, q14=0.2))[:, :2] - (30.0, 20.0)
    assert np.hypot(*walls.T).min() == pytest.approx(8.2 + R, abs=1e-3)


def test_wall_approach_and_departure_are_tangent_arcs() -> None:
    """A point of the wall that is gone over first is come to along it, not square to it."""
    ran = milled(24, POCKET)
    arcs = [block for block in ran.blocks if block.kind is BlockKind.PLANE_ARC]
    first, last = way(arcs[0]), way(arcs[-1])
    assert rounded(first[-1:, :2] - (30.0, 20.0), 30, 20, 6)[0] == pytest.approx(-R, abs=1e-6)
    assert rounded(first[:1, :2] - (30.0, 20.0), 30, 20, 6)[0] == pytest.approx(-2 * R, abs=1e-6)
    assert rounded(last[-1:, :2] - (30.0, 20.0), 30, 20, 6)[0] == pytest.approx(-2 * R, abs=1e-6)
    assert last[0, :2] == pytest.approx(first[-1, :2])


def test_pilot_holes_are_at_plunge_points() -> None:
    """With Q19 0 the tool goes straight down into the holes of cycle 21, and into no other place."""
    holes = [block for block in milled(21).blocks if block.kind is BlockKind.FEED]
    rough = milled(22, q19=0)
    down = [block for block in rough.blocks if block.kind is BlockKind.FEED
            and np.ptp(way(block)[:, :2], axis=0).max() < 1e-9 and block.length > 1e-6]  # fmt: skip
    assert down
    there = {(round(w[0], 5), round(w[1], 5)) for block in holes for w in way(block)[-1:]}
    assert {(round(w[0], 5), round(w[1], 5)) for block in down for w in way(block)[-1:]} == there
    assert min(way(block)[-1, 2] for block in holes) == pytest.approx(-6.0)


CIRCLE = "L X{0:+g} Y+50 {1}\nCC X{2:+g} Y+50\nC X{0:+g} Y+50 DR-"
A_OUT, A_IN = CIRCLE.format(10, "RR", 35), CIRCLE.format(60, "RR", 35)
B, B_ISLAND = CIRCLE.format(90, "RR", 65), CIRCLE.format(40, "RL", 65)


def from_two(points: Points) -> tuple[Points, Points]:
    """How far points are from the middles of the two circles of R25 at X35 and X65."""
    return np.hypot(*(points - (35.0, 50.0)).T), np.hypot(*(points - (65.0, 50.0)).T)


def test_overlapping_pockets_are_one_pocket() -> None:
    points = cuts(milled(22, A_OUT, B))
    floor = points[points[:, 2] < -6.0 + 1e-6][:, :2]
    turn = np.linspace(0.0, 2.0 * np.pi, 72)
    edge = floor[::7, None, :] + R * np.stack([np.cos(turn), np.sin(turn)], axis=1)  # what the tool touches
    assert np.minimum(*from_two(edge.reshape(-1, 2))).max() <= 25.0 + 2e-3
    spots = spots_of(100, 100)
    inside = np.minimum(*from_two(spots)) <= 25.0
    assert left_standing(floor, spots[inside]) <= R + 0.05


def test_pocket_is_intersection_when_first_starts_inside_second() -> None:
    points = cuts(milled(22, A_IN, B))
    floor = points[points[:, 2] < -6.0 + 1e-6][:, :2]
    assert np.maximum(*from_two(floor)).max() == pytest.approx(25.0 - R, abs=1e-3)
    spots = spots_of(100, 100, 0.7)
    inside = np.maximum(*from_two(spots)) <= 25.0 - R
    assert left_standing(floor, spots[inside]) <= R + 0.05


def test_island_is_removed_from_overlapping_pocket() -> None:
    points = cuts(milled(22, A_OUT, B_ISLAND))
    floor = points[points[:, 2] < -6.0 + 1e-6][:, :2]
    a, b = from_two(floor)
    assert a.max() <= 25.0 - R + 1e-3
    assert b.min() >= 25.0 + R - 1e-3


def test_tool_crosses_narrow_gap_above_part() -> None:
    """Two rooms of 20 by 20 with a gate of 6 mm between them, through which a tool of R4 does not go."""
    rooms = ("L X+0 Y+0 RL\nL X+20\nL Y+7\nL X+30\nL Y+0\nL X+50\nL Y+20\nL X+30\nL Y+13\nL X+20\nL Y+20\n"
             "L X+0\nL Y+0")  # fmt: skip
    ran = milled(22, rooms)
    deep = cuts(ran)
    deep = deep[deep[:, 2] < 1.0 - 1e-9]
    reach = np.sqrt(R**2 - 3.0**2)  # between the corners of the gate, 3 mm above and below its middle
    gate = (deep[:, 0] > 20.0 - reach + 1e-3) & (deep[:, 0] < 30.0 + reach - 1e-3)
    assert not gate.any()
    assert deep[:, 0].max() == pytest.approx(46.0)
    no_rapid_in_the_part(ran)


def test_climb_milling_has_the_wall_on_its_right() -> None:
    for q9, sense in ((1, 1), (-1, -1)):
        arcs = [block for block in milled(24, CIRCLE.format(10, "RR", 35), q9=q9).blocks
                if block.kind is BlockKind.PLANE_ARC]  # fmt: skip
        path = way(max(arcs, key=lambda block: block.length))[:, :2] - (35.0, 50.0)
        (x0, y0), (x1, y1) = path[:2]
        assert np.sign(x0 * y1 - y0 * x1) == sense


def test_contour_train_cuts_open_contour_in_levels() -> None:
    line = "L X+0 Y+0 RL\nL X+40\nL Y+30"
    points = cuts(milled(25, line, q3=0.5))
    deep = points[points[:, 2] < -6.0 + 1e-6]
    assert deep[0, :2] == pytest.approx([0.0, R + 0.5])
    assert deep[-1, :2] == pytest.approx([40.0 - R - 0.5, 30.0])
    assert {round(z, 6) for z in points[:, 2]} >= {-2.0, -5.0, -6.0}
    back = cuts(milled(25, line, q3=0.5, q15=-1))
    assert back[-1, :2] == pytest.approx([0.0, R + 0.5])
    to_and_fro = milled(25, line, q15=0)
    ups = [block for block in to_and_fro.blocks if block.kind is BlockKind.RAPID and block.length > 1e-6]
    assert sum(way(block)[-1, 2] > way(block)[0, 2] for block in ups) == 1  # out once, at the end


def test_contour_def_defines_pocket_and_island() -> None:
    """The same area without RL and RR; a shift in force moves it whole."""
    text = program((22,), (POCKET.replace(" RR", ""), ISLAND.replace(" RL", "")))
    named = text.replace("CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1 /2",
                         "CONTOUR DEF P1 = LBL 1 I2 = LBL 2")  # fmt: skip
    assert np.allclose(cuts(run(named, tool=TOOL)), cuts(milled(22)))


def test_contour_def_reads_contours_from_other_programs() -> None:
    files = tuple(
        ProgramSource(f"{name}.H", f"BEGIN PGM {name} MM\n{contour}\nEND PGM {name} MM\n")
        for name, contour in (("POCKET", POCKET), ("ISLE", ISLAND))
    )
    cycles = f"{told(20, DATA)}\n{told(22, OF[22])}\nCYCL CALL\nM30"
    text = whole(f'{TOOL}CONTOUR DEF P1 = "POCKET" I2 = "ISLE.H"\n{cycles}')
    assert set(find_called_programs(ProgramSource("T.H", text))) == {"POCKET.H", "ISLE.H"}
    assert np.allclose(cuts(run_source(ProgramSource("T.H", text, subprograms=files))), cuts(milled(22)))
    assert run_source(ProgramSource("T.H", text)).codes == ["Program not found"]


def test_contour_uses_parameter_values_at_call() -> None:
    text = program((22,), (POCKET.replace("X+60", "X+Q50"),))
    points = cuts(run("Q50 = 40\n" + text, tool=TOOL))
    assert points[:, 0].max() == pytest.approx(40.0 - R)


@pytest.mark.parametrize(
    ("cycle", "contours", "q", "code", "names"),
    [
        (22, (POCKET,), {"q1": 5}, "Input value incorrect", "positive (upward)"),
        (22, (POCKET,), {"q2": 2.5}, "Input value incorrect", "Q2"),
        (
            22,
            ("L X+0 Y+0 RR\nL Y+7\nL X+60\nL Y+0\nL X+0",),
            {},
            "Input value incorrect",
            "does not fit anywhere",
        ),
        (22, (POCKET.replace("RR", ""),), {}, "Cycle incomplete", "No machining side"),
        (22, (POCKET.replace("\nL Y+20", "\nL Y+19"),), {}, "Input value incorrect", "from its start"),
        (22, (POCKET.replace("RR", "RL"),), {}, "Input value incorrect", "pocket"),
        (22, (POCKET,), {"q12": 99999}, "Input value incorrect", "rapid"),
        (22, ("APPR LT X+0 Y+0 LEN3 RR\nL Y+7",), {}, "Not supported", "APPR"),
        (
            22,
            ("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30\n" + POCKET,),
            {},
            "Not supported",
            "CYCL DEF 10",
        ),
        (21, (POCKET,), {"q13": 7}, "Input value incorrect", "Q13"),
        (
            24,
            ("L X+0 Y+0 RR\nL Y+7\nL X+60\nL Y+0\nL X+0",),
            {},
            "Input value incorrect",
            "does not fit anywhere",
        ),
        (25, ("L X+0 Y+0 RL\nL X+40\nL Y+3\nL X+0",), {}, "Input value incorrect", "contour"),
    ],
)
def test_invalid_contour_is_rejected(
    cycle: int, contours: tuple[str, ...], q: dict[str, float], code: str, names: str
) -> None:
    ran = milled(cycle, *contours, **q)
    assert set(ran.codes) == {code}
    assert names in ran.errors[0].message


def test_a_cycle_without_its_contour_is_refused() -> None:
    ran = run(told(20, DATA) + "\n" + told(22, OF[22]) + "\nCYCL CALL", tool=TOOL)
    assert ran.codes == ["Cycle incomplete"]
    ran = run(program((22,), (POCKET,)).replace("LBL 1\n", "LBL 9\n"), tool=TOOL)
    assert ran.codes == ["Label not found"]


def test_a_cylinder_surface_is_refused_by_name() -> None:
    ran = run("CYCL DEF 27 CYLINDER SURFACE ~\n Q1=-5\nCYCL CALL", tool=TOOL)
    assert "cylinder surface" in ran.errors[0].message


def test_contour_starting_at_tool_position_retains_its_first_side() -> None:
    square = "L X+10 Y+20 RL\nL X+50\nL Y+50\nL X+10\nL Y+20"
    points = cuts(milled(22, square))
    deep = points[points[:, 2] < -6.0 + 1e-6]
    assert deep[:, :2].min(axis=0) == pytest.approx([10.0 + R, 20.0 + R])
    assert deep[:, :2].max(axis=0) == pytest.approx([50.0 - R, 50.0 - R])
