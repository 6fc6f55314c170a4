"""Cycles by hand: every way of the tool, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.geometry.rotary_axes import DatumPreset
from core.interpreter.shared.actions import Dwell, ProgramStop, SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import MillTool, ToolOffset
from tests.klartext.running import Ran, run
from tests.klartext.table import ORIGIN

TOOL = "TOOL DEF 5 L+0 R+4\nTOOL CALL 5 Z S1000 F500\n"
HERE = "L X+10 Y+20 Z+50 R0 FMAX M3\n"
COMMON = "Q200=2\nQ203=1\nQ204=30\nQ206=150\nQ211=0\nQ210=0\nQ202=5\n"


def ran_of(text: str) -> Ran:
    return run(HERE + text, tool=TOOL)


def told(text: str) -> list[str]:
    """Each block behind the first move: F or R (rapid) with Z, or what else it does."""
    ran = ran_of(text)
    assert ran.codes == []
    return [_shown(block) for block in ran.blocks[:-1] if block.line > 4]


def _shown(block: Block) -> str:
    match block.action:
        case Dwell(seconds=seconds):
            return f"rest {seconds:g}"
        case SpindleRun(rpm=rpm):
            return f"turn {rpm:g}"
        case SpindleStop(waits_for_standstill=waits_for_standstill):
            return "stands" if waits_for_standstill else "stop"
        case ProgramStop(message=message):
            return message
        case None:
            assert block.swivel is not None
            letter = {BlockKind.RAPID: "R", BlockKind.FEED: "F", BlockKind.PLANE_ARC: "A"}[block.kind]
            return f"{letter} {round(block.swivel.end[2], 6):g}"
        case _:
            return "other"


def cycle(number: int, **q: float) -> str:
    lines = " ~\n".join(f"  Q{name[1:]}={value:+g} ;WHAT" for name, value in q.items())
    return f"{COMMON}CYCL DEF {number} NAME ~\n{lines}\nCYCL CALL M3\n"


def test_drilling_200_uses_three_infeeds() -> None:
    """Surface 1, clearance 2: to 3; infeeds of 5 to 11 deep are 4, -1 ... from 1 down: -4, -9, -10."""
    assert told(cycle(200, q201=-11)) == [
        "turn 1000", "R 3", "F -4", "R 3", "R -2", "F -9", "R 3", "R -7", "F -10", "R 31",
    ]  # fmt: skip


def test_drilling_200_dwells_at_top_and_bottom() -> None:
    assert told(cycle(200, q201=-11, q202=20, q211=1.5)) == ["turn 1000", "R 3", "F -10", "rest 1.5", "R 31"]
    assert told(cycle(200, q201=-6, q210=0.5))[3:6] == ["R 3", "rest 0.5", "R -2"]


def test_zero_depth_only_moves_to_clearance() -> None:
    assert told(cycle(200, q201=0)) == ["turn 1000", "R 3"]


def test_reaming_retracts_at_its_feed() -> None:
    assert told(cycle(201, q201=-8, q208=300)) == ["turn 1000", "R 3", "F -7", "F 3", "R 31"]


def test_boring_stops_spindle_and_retracts_from_wall() -> None:
    found = told(cycle(202, q201=-8, q214=1, q208=0))
    assert found == [
        "turn 1000",
        "R 3",
        "F -7",
        "stands",
        "TURN THE CUTTING EDGE TOWARD X+",
        "F -7",
        "R 31",
        "R 31",
        "turn 1000",
    ]


def test_boring_without_retract_from_wall_needs_no_operator() -> None:
    found = told(cycle(202, q201=-8, q214=0, q208=0))
    assert found == ["turn 1000", "R 3", "F -7", "stands", "R 31", "turn 1000"]


@pytest.mark.parametrize(
    ("direction", "aside"), [(1, (-0.2, 0.0)), (2, (0.0, -0.2)), (3, (0.2, 0.0)), (4, (0.0, 0.2))]
)
def test_boring_retracts_from_wall_in_direction_of_q214(direction: int, aside: tuple[float, float]) -> None:
    """1 and 2 are the negative main and secondary axis, 3 and 4 the positive ones; out beside the centre."""
    blocks = ran_of(cycle(202, q201=-8, q214=direction, q208=0)).blocks
    ends = [block.swivel.end for block in blocks if block.line > 4 and block.moves and block.swivel]
    beside = (10.0 + aside[0], 20.0 + aside[1])
    assert ends[2] == pytest.approx((*beside, -7.0))
    assert ends[3] == pytest.approx((*beside, 31.0))
    assert ends[4] == pytest.approx((10.0, 20.0, 31.0))


def test_universal_drilling_breaks_chips_and_reduces_infeed() -> None:
    """Infeeds 5, 4, 3 from the surface at 1, a chip break of .2 behind each but every second."""
    assert told(cycle(203, q201=-12, q212=1, q205=1, q213=1, q256=0.2, q208=0)) == [
        "turn 1000", "R 3", "F -4", "R -3.8", "F -8", "R 3", "R -6", "F -11", "R 31",
    ]  # fmt: skip


def test_deep_drilling_stops_above_last_depth() -> None:
    assert told(cycle(205, q201=-10, q258=0.5, q259=1.5, q253=750)) == [
        "turn 1000", "R 3", "F -4", "R 3", "R -3", "F -9", "R 31",
    ]  # fmt: skip


@pytest.mark.parametrize(("number", "more"), [(203, {"q213": 1}), (205, {})])
def test_default_distances_of_pecks_are_0_2_mm_in_an_inch_program(
    number: int, more: dict[str, float]
) -> None:
    """Surface 1 in, infeed 5 in: the tool is at -4 in = -101.6 mm; Q256, Q258 and Q259 are 0.2 mm."""
    ran = run(HERE + cycle(number, q201=-8, q208=0, **more), tool=TOOL, unit="INCH")
    assert ran.codes == []
    rapids = [_height(block) for block in ran.blocks if block.kind is BlockKind.RAPID]
    assert pytest.approx(-101.4) in rapids
    assert min(rapids) == pytest.approx(-101.4)


def _height(block: Block) -> float:
    assert block.swivel is not None
    return block.swivel.end[2]


def test_rejected_cycle_in_pattern_does_not_change_q203() -> None:
    """Cycle 200 without Q201 is rejected at the first point, which is 5 mm below the surface Q203=1."""
    ran = ran_of(
        f"{COMMON}CYCL DEF 200 NAME ~\n  Q200=+2 ;WHAT\n"
        "PATTERN DEF POS1 (X+0 Y+0 Z-5) POS2 (X+9 Y+0 Z+0)\nCYCL CALL PAT FMAX"
    )
    assert ran.codes == ["Cycle incomplete"]
    assert ran.state.q_values[203] == 1.0


def test_tapping_reverses_spindle() -> None:
    assert told(cycle(206, q201=-8)) == ["turn 1000", "R 3", "F -7", "turn -1000", "F 3", "turn 1000", "R 31"]
    ran = ran_of(cycle(207, q201=-8, q239=1.25))
    taps = [block for block in ran.blocks if block.kind is BlockKind.FEED]
    assert {(block.feed, block.per_rev, block.follows_spindle) for block in taps} == {(1.25, True, True)}


@pytest.mark.parametrize(
    ("text", "unit", "lead"),
    [
        (cycle(206, q201=-8, q206=1500), "MM", 1.5),  # F1500 at S1000
        (cycle(207, q201=-8, q239=-0.05), "INCH", 1.27),
        (cycle(209, q201=-8, q239=2, q257=5), "MM", 2.0),
        ("CYCL DEF 2.0 T\nCYCL DEF 2.1 SET UP2\nCYCL DEF 2.2 DEPTH-8\nCYCL DEF 2.3 DWELL0\n"
         "CYCL DEF 2.4 F800\nL Z+2 FMAX M99", "MM", 0.8),
        ("CYCL DEF 17.0 T\nCYCL DEF 17.1 SET UP2\nCYCL DEF 17.2 DEPTH-8\nCYCL DEF 17.3 PITCH+1.75\n"
         "L Z+2 FMAX M99", "MM", 1.75),
    ],
)  # fmt: skip
def test_tapping_feed_follows_lead_and_spindle(text: str, unit: str, lead: float) -> None:
    ran = run("L X+0 Y+0 Z+50 R0 FMAX M3\n" + text, unit=unit, tool="TOOL CALL 1 Z S1000 F500\n")
    assert ran.codes == []
    taps = [block for block in ran.blocks if block.follows_spindle]
    assert len(taps) >= 2
    assert {block.kind for block in taps} == {BlockKind.FEED}
    assert [block.feed for block in taps] == pytest.approx([lead] * len(taps))


def test_lead_above_max_z_feed_is_rejected() -> None:
    """A plan that held Z back would break the tap: 30 mm at S1000 are 500 mm/s."""
    ran = ran_of(cycle(207, q201=-8, q239=30))
    assert ran.codes == ["Input value incorrect"]
    assert "requires a Z feed rate above the maximum" in ran.errors[0].message


def test_tapping_breaks_chips() -> None:
    assert told(cycle(209, q201=-8, q239=1, q257=5, q256=0)) == [
        "turn 1000", "R 3", "F -4", "turn -1000", "F 3", "turn 1000",
        "F -7", "turn -1000", "F 3", "turn 1000", "R 31",
    ]  # fmt: skip


def test_bore_milling_is_helix_of_tool_center() -> None:
    """A tool of R 4 in a hole of 20 goes round on R 6; 13 mm down from 3 at 4 a turn, and once more."""
    ran = ran_of(cycle(208, q201=-11, q334=4, q335=20))
    assert ran.codes == []
    arcs = [block for block in ran.blocks if block.kind is BlockKind.PLANE_ARC]
    assert [round(block.swivel.end[2], 6) for block in arcs if block.swivel] == [
        -1.0,
        -5.0,
        -9.0,
        -10.0,
        -10.0,
    ]
    assert arcs[0].length == pytest.approx(math.hypot(12 * math.pi, 4.0))
    assert arcs[-1].length == pytest.approx(12 * math.pi)


def test_m99_calls_once_and_m89_until_m99() -> None:
    define = f"{COMMON}CYCL DEF 240 CENTRE ~\n Q343=+0 ;SELECT ~\n Q201=-1 ;DEPTH\n"
    ran = ran_of(f"{define}L X+0 FMAX M89\nL X+10 FMAX\nL X+20 FMAX M99\nL X+30 FMAX")
    assert ran.codes == []
    cut = [block.swivel.end[0] for block in ran.blocks if block.kind is BlockKind.FEED and block.swivel]
    assert cut == pytest.approx([0.0, 10.0, 20.0])


def test_pattern_on_circle() -> None:
    define = cycle(240, q343=0, q201=-1).replace("CYCL CALL M3\n", "")
    circle = "CYCL DEF 220 POLAR ~\n Q216=+50 ~\n Q217=+40 ~\n Q244=+20 ~\n Q245=+0 ~\n Q246=+360 ~\n"
    ran = ran_of(f"{define}{circle} Q247=+0 ~\n Q241=+4 ~\n Q301=+1")
    assert ran.codes == []
    cut = [block.swivel.end[:2] for block in ran.blocks if block.kind is BlockKind.FEED and block.swivel]
    assert cut == [pytest.approx(each) for each in ((60, 40), (50, 50), (40, 40), (50, 30))]


def test_pattern_in_rows_alternates_direction() -> None:
    define = cycle(240, q343=0, q201=-1).replace("CYCL CALL M3\n", "")
    rows = "CYCL DEF 221 ROWS ~\n Q225=+5 ~\n Q226=+6 ~\n Q237=+10 ~\n Q238=+20 ~\n"
    ran = ran_of(f"{define}{rows} Q242=+2 ~\n Q243=+2 ~\n Q224=+0")
    cut = [block.swivel.end[:2] for block in ran.blocks if block.kind is BlockKind.FEED and block.swivel]
    assert cut == [pytest.approx(each) for each in ((5, 6), (15, 6), (15, 26), (5, 26))]


def test_cycle_1_pecking_starts_at_tool_position() -> None:
    """Called 2 above the surface: to 10 deep in infeeds of 6, rapid to .6 before the chips."""
    text = (
        "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG 6\n"
        "CYCL DEF 1.4 DWELL 0.5\nCYCL DEF 1.5 F80\nL Z+2 FMAX M99"
    )
    assert told(text) == ["R 2", "F -6", "R 2", "R -5.4", "F -10", "rest 0.5", "R 2"]


def test_cycle_5_circular_pocket_stays_within_radius() -> None:
    text = (
        "CYCL DEF 5.0 CIRCLE\nCYCL DEF 5.1 SET UP 2\nCYCL DEF 5.2 DEPTH -6\nCYCL DEF 5.3 PECKG 3 F100\n"
        "CYCL DEF 5.4 RADIUS 20\nCYCL DEF 5.5 F300 DR-\nL Z+2 FMAX M99"
    )
    ran = ran_of(text)
    assert ran.codes == []
    arcs = [block for block in ran.blocks if block.kind is BlockKind.PLANE_ARC]
    assert max(block.length for block in arcs) == pytest.approx(2 * math.pi * 16.0)
    assert {round(block.swivel.end[2], 6) for block in arcs if block.swivel} == {-3.0, -6.0}


def test_cycle_9_dwells_and_cycle_19_tilts() -> None:
    ran = ran_of(
        "CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 V.ZEIT 1.5\nCYCL DEF 19.0 PLANE\nCYCL DEF 19.1 A+45 B+0 C+0"
    )
    assert ran.codes == []
    assert [block.action for block in ran.blocks if isinstance(block.action, Dwell)] == [Dwell(1.5)]
    assert ran.state.q_values[120] == pytest.approx(45.0)
    assert ran.state.position_by_axis["A"] == 0.0


DRILL = f"{COMMON}CYCL DEF 240 CENTRE ~\n Q343=+0 ~\n Q201=-1\n"


def test_cycl_call_pos_positions_above_point_before_plunging() -> None:
    """From 50 up the place is reached at 50; from below the clearance of 3 the tool goes up first."""
    ran = ran_of(f"{DRILL}CYCL CALL POS X+30 Y+40 Z+0 F2000\nL Z-5 FMAX\nCYCL CALL POS X+0 Y+0 Z+0")
    assert ran.codes == []
    at = [(b.kind, b.swivel.end) for b in ran.blocks if b.moves and b.line > 4 and b.swivel is not None]
    first, low, second = at[0], at[4], at[5:7]
    assert first == (BlockKind.FEED, pytest.approx((30.0, 40.0, 50.0)))
    assert low[1] == pytest.approx((30.0, 40.0, -5.0))
    assert [place for _, place in second] == [pytest.approx((30, 40, 3)), pytest.approx((0, 0, 3))]


def test_new_cycle_clears_program_named_by_cycle_12() -> None:
    ran = ran_of(f"CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM HOLE\n{DRILL}L X+0 FMAX M99")
    assert ran.codes == []
    called = ran_of("CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM HOLE\nCYCL CALL")
    assert called.codes == ["Program not found"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (cycle(207, q201=-8, q239=1.25), "tapping-uncoupled"),
        ("CYCL DEF 247 PRESET ~\n Q339=+2", "preset"),
    ],
)
def test_difference_from_original_control_causes_warning(text: str, code: str) -> None:
    assert ran_of(text).warned == [code]


@pytest.mark.parametrize("text", ["CYCL DEF 32.0 TOLERANCE", "CYCL DEF 13.0 ORIENTATION", "M97", "M120 LA5"])
def test_ignored_block_is_reported(text: str) -> None:
    ran = ran_of(f"{text}\n{text}")
    assert [each.code for each in ran.diagnostics] == ["unheeded"]


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        (f"{DRILL}CYCL CALL POS X+0 Y+0 Z-2", "Input value incorrect", "Q203"),
        ("CYCL CALL POS X+0 Y+0", "Cycle incomplete", "No machining cycle"),
        (cycle(200, q201=5), "Input value incorrect", "positive (upward)"),
        (cycle(200, q202=2), "Cycle incomplete", "Q201"),
        (cycle(200, q201=-5, q206=0), "Input value incorrect", "Q206"),
        (cycle(202, q201=-5, q214=5), "Input value incorrect", "Q214"),
        (cycle(207, q201=-5, q239=0), "Input value incorrect", "pitch"),
        (cycle(208, q201=-5, q334=1, q335=6), "Input value incorrect", "hole"),
        (cycle(240, q343=1, q344=-4), "Input value incorrect", "point"),
        (cycle(200, q201=-1000, q202=0.01), "Input value incorrect", "too many"),
        ("CYCL DEF 220 POLAR", "Cycle incomplete", "220 needs a preceding machining cycle"),
        (f"{DRILL}CYCL CALL PAT", "Cycle incomplete", "PATTERN DEF"),
        ("PATTERN DEF POS1 (X+1 Y+1)\nCYCL CALL PAT", "Cycle incomplete", "CYCL DEF"),
        ("PATTERN DEF", "Syntax error", "no points"),
        ("PATTERN DEF POS1 (X+1)", "Syntax error", "POS needs Y"),
        ("PATTERN DEF POS1 (X+1 Y+1", "Syntax error", "Unexpected word in POS"),
        ("PATTERN DEF POS1 (X+1 X+2 Y+1)", "Syntax error", "X is programmed twice"),
        ("PATTERN DEF STAR1 (X+1 Y+2)", "Syntax error", "POS1"),
        ("PATTERN DEF ROW1 (X+1 Y+2 D+1 NUM0)", "Input value incorrect", "0 is not a valid number of points"),
        (
            "PATTERN DEF ROW1 (X+1 Y+2 D+1 NUM2.5)",
            "Input value incorrect",
            "2.5 is not a valid number of points",
        ),
        (cycle(241, q201=-5, q253=9, q426=7), "Input value incorrect", "Q426"),
        (cycle(241, q201=-5, q253=9, q429=7), "Input value incorrect", "M7"),
        ("CYCL DEF 30.0 3D DATA", "Not supported", "CYCL DEF 30"),
        ("CYCL DEF", "Syntax error", "needs a cycle number"),
        ("CYCL DEF 1.0 PECKING\nL Z+2 FMAX M99", "Cycle incomplete", "1."),
        ("L Z+2 FMAX M99", "Cycle incomplete", "No machining cycle"),
        ("M5\n" + cycle(206, q201=-5).replace(" M3", ""), "Wrong rpm", "spindle"),
    ],
)
def test_invalid_cycle_is_rejected(text: str, code: str, names: str) -> None:
    ran = ran_of(text)
    assert ran.codes[:1] == [code]
    assert names in ran.errors[0].message + ran.errors[0].hint


@pytest.mark.parametrize(("text", "column"), [("M99", 1), ("L Z+2 FMAX M99", 1), ("CYCL CALL", 1)])
def test_call_without_cycle_is_reported_at_start_of_block(text: str, column: int) -> None:
    (error, *_) = ran_of(text).errors
    assert "No machining cycle" in error.message + error.hint
    assert error.column == column


def test_single_lip_drilling_enters_slowly() -> None:
    """Surface 1, start 5 below: at 50 rpm to 2 above it, coolant, 800 rpm to the bottom, out at 50 rpm."""
    speeds = {"q426": 4, "q427": 50, "q428": 800, "q429": 8, "q430": 9}
    assert told(cycle(241, q201=-11, q379=5, q253=750, q208=400, **speeds)) == [
        "turn 1000", "R 3", "turn -50", "F -2", "turn -800", "other", "F -10", "other",
        "turn -50", "F 3", "R 31", "turn 1000",
    ]  # fmt: skip


# --- patterns of points ----------------------------------------------------------------------------------

CENTRE = "CYCL DEF 240 C ~\n Q343=+0 ~\n Q201=-1 ~\n Q200=2 ~\n Q206=100 ~\n Q203=+1 ~\n Q204=30"


def bottoms(pattern: str) -> list[tuple[float, ...]]:
    """Where the holes of CYCL CALL PAT end."""
    ran = ran_of(f"{CENTRE}\nPATTERN DEF {pattern}\nCYCL CALL PAT FMAX M8")
    assert ran.codes == []
    feeds = [block.swivel.end for block in ran.blocks if block.kind is BlockKind.FEED and block.swivel]
    return [tuple(round(at, 4) + 0.0 for at in end) for end in feeds]


@pytest.mark.parametrize(
    ("pattern", "wanted"),
    [
        ("POS1 (X+25 Y+33.5 Z+0) ~\n POS2 (X+50 Y+75 Z-2)", [(25, 33.5, 0), (50, 75, -2)]),
        ("ROW1 (X+10 Y+20 D+8 NUM3 ROT+90 Z+0)", [(10, 20, 0), (10, 28, 0), (10, 36, 0)]),
        (
            "PAT1 (X+0 Y+0 DX+10 DY+5 NUMX3 NUMY2 ROT+0 ROTX+0 ROTY+0 Z+0)",
            [(0, 0, 0), (10, 0, 0), (20, 0, 0), (20, 5, 0), (10, 5, 0), (0, 5, 0)],
        ),
        (
            "FRAME1 (X+0 Y+0 DX+10 DY+5 NUMX3 NUMY3 ROT+90)",
            [
                (0, 0, 0),
                (0, 10, 0),
                (0, 20, 0),
                (-5, 20, 0),
                (-5, 0, 0),
                (-10, 0, 0),
                (-10, 10, 0),
                (-10, 20, 0),
            ],
        ),
        ("CIRC1 (X+10 Y+0 D+20 START+90 NUM4 Z+0)", [(10, 10, 0), (0, 0, 0), (10, -10, 0), (20, 0, 0)]),
        ("PITCHCIRC1 (X+0 Y+0 D+20 START+0 STEP+30 NUM2 Z+0)", [(10, 0, 0), (8.6603, 5, 0)]),
    ],
)
def test_pattern_def_gives_its_points(pattern: str, wanted: list[tuple[float, ...]]) -> None:
    assert bottoms(pattern) == wanted


def test_pattern_moves_at_safe_height_and_restores_q203() -> None:
    ran = ran_of(f"{CENTRE}\nPATTERN DEF POS1 (X+0 Y+0 Z-5) POS2 (X+9 Y+0 Z+0)\nCYCL CALL PAT FMAX")
    aside = [block for block in ran.blocks if block.swivel and block.swivel.start[:2] != block.swivel.end[:2]]
    assert [block.swivel.end[2] for block in aside if block.swivel] == pytest.approx([50.0, 50.0, 31.0])
    assert ran.state.q_values[203] == pytest.approx(1.0)


# --- presets, tools of the table -------------------------------------------------------------------------

PRESETS = {0: DatumPreset(ORIGIN), 3: DatumPreset((100.0, 50.0, -300.0), 90.0)}
SET = "CYCL DEF 247 DATUM SETTING ~\n  Q339={} ;DATUM NUMBER\n"


def test_preset_of_table_shifts_and_rotates_workpiece() -> None:
    """Turned by 90 degrees, X+10 Y+2 of the workpiece are 2 back along X and 10 along Y of the machine."""
    ran = run(f"{SET.format('+3')}L X+10 Y+2 Z+5 FMAX", presets=PRESETS)
    assert ran.codes == []
    assert ran.warned == []
    assert [ran.axes(ran.blocks[-2])[name] for name in "XYZ"] == pytest.approx([98.0, 60.0, -295.0])


def test_preset_cancels_datum_shift_and_preset_zero_returns() -> None:
    ran = run(
        f"{SET.format('+3')}TRANS DATUM AXIS X+7\n{SET.format('+0')}L X+0 Y+0 Z+0 FMAX", presets=PRESETS
    )
    assert [ran.axes(ran.blocks[-2])[name] for name in "XYZ"] == pytest.approx(list(ORIGIN))


def test_plane_is_relative_to_active_preset() -> None:
    """SPA+45 of a workpiece turned by 90 degrees: the table turns by C 90 first."""
    plane = "PLANE SPATIAL SPA+45 SPB+0 SPC+0 STAY SYM+"
    ran = run(f"{SET.format('+3')}{plane}", presets=PRESETS)
    assert (ran.state.q_values[120], ran.state.q_values[122]) == pytest.approx((45.0, 90.0))


def test_preset_c_zero_shifts_c_and_leaves_other_axes_unchanged() -> None:
    """C carries the part: with its zero at 30 all slides go where they went, and C 30 further."""
    text = (
        "L X+10 Y+2 Z+5 C+15 FMAX\nPLANE SPATIAL SPA+20 SPB+10 SPC+5 MOVE FMAX\nL X+3 Y+4 Z+5 FMAX\n"
        "L A+0 C+0 FMAX\nPLANE RESET TURN FMAX\nPLANE AXIAL A+10 C+50 TURN FMAX\nL X+1 Y+1 Z+1 FMAX\n"
        "L Z-5 C+10 FMAX M91\nL IC-20 FMAX"
    )
    spot = DatumPreset((100.0, 50.0, -300.0), 12.0)
    for zero in (30.0, -75.0):
        turned = DatumPreset(spot.origin, spot.rotation_deg, (("C", zero),))
        plain, other = (run(SET.format("+3") + text, presets={0: spot, 3: each}) for each in (spot, turned))
        assert plain.codes == other.codes == []
        assert [other.state.q_values[q] for q in (120, 122)] == pytest.approx(
            [plain.state.q_values[q] for q in (120, 122)]
        )
        for one, two in zip(plain.blocks, other.blocks, strict=True):
            a, b = plain.axes(one), other.axes(two)
            assert [b[name] for name in "XYZA"] == pytest.approx([a[name] for name in "XYZA"], abs=1e-9)
            if one.line and one.text.endswith("M91"):
                assert b["C"] == pytest.approx(10.0)
                break
            if one.line > 4:
                assert math.remainder(b["C"] - a["C"] - zero, 360.0) == pytest.approx(0.0, abs=1e-9)


def test_a_preset_that_is_not_in_the_table_is_refused() -> None:
    ran = run(SET.format("+4"), presets=PRESETS)
    assert ran.codes == ["Input value incorrect"]
    assert "Preset 4" in ran.errors[0].message
    turned = run(f"PLANE SPATIAL SPA+45 SPB+0 SPC+0 STAY\n{SET.format('+3')}", presets=PRESETS)
    assert turned.codes == ["Contradictory entry"]


def test_a_tool_is_called_by_its_name_in_the_table() -> None:
    around: dict[str, Any] = {"tools": {7: ToolOffset(z=80.0)}, "tool_names": {"MILL_D10": 7}}
    ran = run('TOOL CALL "Mill_D10" Z S1000\nL X+0 Y+0 Z+0 FMAX', tool="", **around)
    assert ran.codes == []
    assert ran.state.modal.tool == 7
    assert ran.axes(ran.blocks[-2])["Z"] == pytest.approx(ORIGIN[2] + 80.0)
    assert run('TOOL CALL "MILL_D12" Z S1000', tool="", **around).codes == ["Tool not defined"]


def test_centering_by_diameter_uses_point_angle_of_table() -> None:
    """A point of 90 degrees makes 8 mm at a depth of 4."""
    q = "CYCL DEF 240 C ~\n Q200=2 ~\n Q343=+1 ~\n Q201=-1 ~\n Q344=-8 ~\n Q206=100 ~\n Q203=+1 ~\n Q204=9"
    ran = run(f"L Z+50 R0 FMAX M3\n{q}\nCYCL CALL", mill_tools={1: MillTool(point_angle_deg=90.0)})
    assert min(block.swivel.end[2] for block in ran.blocks if block.swivel) == pytest.approx(-3.0)
    assert run(f"L Z+50 R0 FMAX M3\n{q}\nCYCL CALL").codes == ["Input value incorrect"]


TAP = "CYCL DEF 207 RIGID TAPPING Q200=2 Q201=-8 Q239={pitch} Q203=+0 Q204=30\nL X+10 R0 FMAX M99"


@pytest.mark.parametrize(
    ("before", "pitch", "speeds"),
    [
        ("", "+1", [1000.0, -1000.0, 0.0]),  # the cycle starts the spindle, and it ends at rest
        ("M3\n", "+1", [1000.0, -1000.0, 1000.0]),
        ("M3\n", "-1", [1000.0, -1000.0, 1000.0]),  # out of a left-hand thread it turns as M3
        ("M4\n", "-1", [-1000.0, 1000.0, -1000.0]),
    ],
)
def test_rigid_tap_pitch_sign_sets_spindle_direction(before: str, pitch: str, speeds: list[float]) -> None:
    ran = run(before + TAP.format(pitch=pitch), tool="TOOL CALL 1 Z S1000\n")
    assert not ran.errors
    turned = [block.action for block in ran.blocks if isinstance(block.action, SpindleRun | SpindleStop)]
    found = [each.rpm if isinstance(each, SpindleRun) else 0.0 for each in turned]
    assert found == speeds


def test_a_rigid_tap_without_a_speed_is_refused() -> None:
    assert run(TAP.format(pitch="+1"), tool="TOOL CALL 1 Z\n").codes == ["Wrong rpm"]
