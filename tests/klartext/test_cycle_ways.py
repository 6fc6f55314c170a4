"""Ways of older cycles, taps and departures, point by point."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.klartext.klartext_faults import INPUT_VALUE_INCORRECT
from tests.klartext.running import Ran, run
from tests.klartext.test_klartext_cycles import ran_of

OVERLAP, DIAMETER = 0.7, 8.0  # of the tool of these programs, whose radius is 4


def turned(ran: Ran) -> list[float]:
    """What the spindle is told, rpm."""
    return [block.action.rpm for block in ran.blocks if isinstance(block.action, SpindleRun)]


def ends(blocks: list[Block]) -> list[tuple[float, float, float]]:
    return [
        (round(x, 6), round(y, 6), round(z, 6))
        for x, y, z in (block.swivel.end[:3] for block in blocks if block.swivel is not None)
    ]


FLOATING = (
    "CYCL DEF 2.0 T\nCYCL DEF 2.1 SET UP2\nCYCL DEF 2.2 DEPTH-8\nCYCL DEF 2.3 DWELL0\nCYCL DEF 2.4 F800\n"
)
RIGID = "CYCL DEF 17.0 T\nCYCL DEF 17.1 SET UP2\nCYCL DEF 17.2 DEPTH-8\nCYCL DEF 17.3 PITCH{}1.75\n"


@pytest.mark.parametrize(
    ("before", "cycle", "told"),
    [
        ("M3", FLOATING, [1000.0, -1000.0, 1000.0]),  # 2 turns as it is told, round at the bottom, and back
        ("M4", FLOATING, [-1000.0, 1000.0, -1000.0]),
        ("M3", RIGID.format("+"), [1000.0, -1000.0, 1000.0]),
        ("M4", RIGID.format("+"), [-1000.0, 1000.0, -1000.0]),
        ("M3", RIGID.format("-"), [1000.0, -1000.0, 1000.0]),  # a left-hand thread is begun to the left
        ("M4", RIGID.format("-"), [-1000.0, 1000.0, -1000.0]),
    ],
)
def test_spindle_direction_into_and_out_of_thread(before: str, cycle: str, told: list[float]) -> None:
    """17 by the sign of its pitch whatever turned before; behind the cycle that is in force again."""
    ran = run(f"L X+0 Y+0 Z+50 R0 FMAX {before}\n{cycle}L Z+2 FMAX M99", tool="TOOL CALL 1 Z S1000 F500\n")
    assert ran.codes == []
    assert turned(ran) == told
    down, up = (block for block in ran.blocks if block.follows_spindle)
    if cycle is not FLOATING:
        assert math.copysign(1.0, down.rpm) == (-1.0 if "PITCH-" in cycle else 1.0)
    assert down.rpm == -up.rpm


@pytest.mark.parametrize(
    ("step", "back", "heights", "turns"),
    [
        (0, 0, [-5.0, 17.0], 1),
        (8, 0, [7.0, 17.0, -1.0, 17.0, -5.0, 17.0], 3),
        (8, 1, [7.0, 8.0, -1.0, 0.0, -5.0, 17.0], 3),
        (20, 1, [-5.0, 17.0], 1),
    ],
)
def test_a_tap_breaks_its_chips_by_depth_on_any_surface(
    step: float, back: float, heights: list[float], turns: int
) -> None:
    """Q203 +15 and Q201 -20: to -5, and out to the clearance of 2 over the surface, or back by Q256."""
    ran = ran_of(
        f"CYCL DEF 209 T Q200=2 Q201=-20 Q239=+1 Q203=+15 Q204=30 Q257={step} Q256={back} Q336=+0\n"
        "L X+10 R0 FMAX M99"
    )
    assert ran.codes == []
    assert [z for _, _, z in ends([block for block in ran.blocks if block.follows_spindle])] == heights
    assert turned(ran) == [1000.0, *[-1000.0, 1000.0] * turns]


def test_pocket_is_milled_in_rectangles_from_center_outward() -> None:
    """40 by 20 with a radius of 4: ways of 32 by 12 round it, none further from the next than the overlap."""
    ran = ran_of(
        "CYCL DEF 4.0 P\nCYCL DEF 4.1 SET UP2\nCYCL DEF 4.2 DEPTH-6\nCYCL DEF 4.3 PECKG 3 F100\n"
        "CYCL DEF 4.4 X40\nCYCL DEF 4.5 Y20\nCYCL DEF 4.6 F300 DR+\nL Z+2 FMAX M99"
    )
    assert ran.codes == []
    for level in (-3.0, -6.0):
        way = [(x - 10.0, y - 20.0) for x, y, z in ends(ran.blocks) if z == level]
        assert way[0] == (0.0, 0.0)
        rings = [way[at : at + 5] for at in range(1, len(way) - 4, 5)]
        for ring in rings:
            assert ring[0] == ring[-1]
            assert all(a[0] == b[0] or a[1] == b[1] for a, b in pairwise(ring))
            assert {(abs(x), abs(y)) for x, y in ring} == {(abs(ring[0][0]), abs(ring[0][1]))}
            assert len(set(ring)) == 4
        assert {(abs(x), abs(y)) for x, y in rings[-1]} == {(16.0, 6.0)}
        widths = [0.0, *(abs(ring[0][1]) for ring in rings)]
        assert max(b - a for a, b in pairwise(widths)) <= OVERLAP * DIAMETER


SLOT = (
    "CYCL DEF 3.0 SLOT MILLING\nCYCL DEF 3.1 SET UP2\nCYCL DEF 3.2 DEPTH-6\nCYCL DEF 3.3 PECKG3 F100\n"
    "CYCL DEF 3.4 X{}\nCYCL DEF 3.5 Y+{}\nCYCL DEF 3.6 F300\nL Z+2 FMAX M99"
)


@pytest.mark.parametrize("width", [20, 8])
def test_a_slot_is_as_long_as_its_first_side(width: int) -> None:
    ran = ran_of(SLOT.format("+40", width))
    assert ran.codes == []
    assert {x - 10.0 for x, _, z in ends(ran.blocks) if z == -6.0} == {0.0, 40.0}


@pytest.mark.parametrize("width", [20, 8])
@pytest.mark.parametrize("length", ["+0", "-0"])
def test_a_slot_without_a_length_is_refused(length: str, width: int) -> None:
    ran = ran_of(SLOT.format(length, width))
    assert ran.codes == [INPUT_VALUE_INCORRECT]
    assert all(z >= 2.0 for _, _, z in ends(ran.blocks))


def test_circular_pocket_uses_fewest_rings_within_overlap() -> None:
    """R 20 less 4: to 16 in the fewest circles that are no further apart than the overlap, three."""
    ran = ran_of(
        "CYCL DEF 5.0 CIRCLE\nCYCL DEF 5.1 SET UP 2\nCYCL DEF 5.2 DEPTH -6\nCYCL DEF 5.3 PECKG 3 F100\n"
        "CYCL DEF 5.4 RADIUS 20\nCYCL DEF 5.5 F300 DR-\nL Z+2 FMAX M99"
    )
    assert ran.codes == []
    circles = [block.length / (2.0 * math.pi) for block in ran.blocks if block.kind is BlockKind.PLANE_ARC]
    assert circles == pytest.approx([16.0 / 3.0, 32.0 / 3.0, 16.0] * 2)


@pytest.mark.parametrize("lift", ["", "L Z+5\n"])
def test_departure_is_tangent_to_last_move_in_plane(lift: str) -> None:
    """Up Y with the tool of 4 at its left: straight on to Y 40, also where Z has moved behind it."""
    ran = run(
        f"L X+0 Y+0 Z+10 R0 FMAX M3\nL X+10 Y+10 RL F200\nL Y+30\n{lift}DEP LT LEN10\n",
        tool="TOOL DEF 5 L+0 R+4\nTOOL CALL 5 Z S1000 F500\n",
    )
    assert ran.codes == []
    assert [(x, y) for x, y, _ in ends(ran.blocks)][-2:] == [(6.0, 40.0)] * 2
