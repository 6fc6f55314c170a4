"""Words of older and newer controls: blocks of one axis, R+ and R-, LN, GLOBAL DEF, S(VC=), cycle 19."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.job_setup import MillTool
from tests.klartext.running import Ran, run

R4 = "TOOL DEF 5 L+0 R+4\nTOOL CALL 5 Z S2000 F500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"


def ran_of(text: str, **setup: Any) -> Ran:
    return run(text, tool=R4, **setup)


@pytest.mark.parametrize(
    ("block", "x"),
    [
        ("X+10 R0 F100", 10.0),
        ("IX+10 F100", 10.0),
        ("X+10 R+ F100", 14.0),  # longer by the radius
        ("X+10 R- F100", 6.0),
        ("X-10 R+ F100", -14.0),
        ("X-10 R- FMAX", -6.0),
        ("L X+10 R+ F100 M8", 14.0),
    ],
)
def test_single_axis_block_moves_its_axis(block: str, x: float) -> None:
    ran = ran_of(block)
    assert not ran.errors
    assert ran.state.programmed_position == pytest.approx((x, 0.0, 50.0))


def test_ln_moves_to_its_point_without_compensation() -> None:
    ran = ran_of("LN X+3 Y+4 Z+40 NX+0.6 NY+0 NZ+0.8 F100")
    assert not ran.errors
    assert ran.state.programmed_position == pytest.approx((3.0, 4.0, 40.0))


@pytest.mark.parametrize(
    ("text", "setup"),
    [
        ("TOOL CALL 5 Z S2000 F500 DR+0.1\nLN X+3 NX+0 NY+0 NZ+1", {}),
        ("TOOL CALL 5 Z S2000 F500 DR2:+0.1\nLN X+3 NX+0 NY+0 NZ+1", {}),
        ("TOOL CALL DR2+0.1\nLN X+3 NX+0 NY+0 NZ+1", {}),
        ("LN X+3 NX+0 NY+0 NZ+1", {"mill_tools": {5: MillTool(0.0, 4.0, delta_corner_radius=0.02)}}),
        ("LN X+3 NX+0 NY+0 NZ+1 RL", {}),
        ("LN X+3 NX+0 NY+0 NZ+1 TX+0 TY+0 TZ+1", {}),
    ],
)
def test_ln_is_rejected_when_its_normal_would_apply(text: str, setup: dict[str, object]) -> None:
    ran = ran_of(text, **setup)
    assert ran.codes == ["Not supported"]
    assert "LN" in ran.errors[0].message


def test_predef_uses_last_value_of_global_def() -> None:
    hole = "CYCL DEF 200 DRILLING Q200=PREDEF Q201=-8 Q206=+150 Q202=+8 Q203=+0\nCYCL CALL\n"
    ran = ran_of(f"GLOBAL DEF 100 GENERAL Q200=+3\nGLOBAL DEF 100 GENERAL Q200=+5\n{hole}")
    assert not ran.errors
    assert ran.state.programmed_position[2] == pytest.approx(5.0)
    assert ran_of(hole).codes == ["Cycle incomplete"]


def test_cutting_speed_sets_rpm_from_tool_radius() -> None:
    ran = ran_of("TOOL CALL 5 Z S(VC = 100) F300")
    assert ran.state.modal.rpm == pytest.approx(100_000.0 / (2.0 * math.pi * 4.0))
    assert ran_of("TOOL DEF 6 L+0 R+0\nTOOL CALL 6 Z S(VC=100)").codes == ["Wrong rpm"]


def test_function_dwell_dwells() -> None:
    rests = [
        each.action for each in ran_of("FUNCTION DWELL TIME1.5").blocks if isinstance(each.action, Dwell)
    ]
    assert rests == [Dwell(1.5)]


def test_is_defined_and_is_undefined_conditions_test_the_parameter() -> None:
    text = "Q1 = 1\nFN 9: IF Q{0} IS {1} GOTO LBL 1\nL X+7 F100\nLBL 1"
    jumped = {(q, word): ran_of(text.format(q, word)).state.programmed_position[0] < 1.0
              for q in (1, 2) for word in ("DEFINED", "UNDEFINED")}  # fmt: skip
    assert jumped == {(1, "DEFINED"): True, (1, "UNDEFINED"): False,
                      (2, "DEFINED"): False, (2, "UNDEFINED"): True}  # fmt: skip


def test_cycle_19_with_feed_positions_rotary_axes() -> None:
    """With F the control positions them; the point at the set-up clearance keeps its place."""
    turned = ran_of("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+30 C+0 F1000 SETUP50")
    assert not turned.errors
    assert turned.state.position_by_axis["A"] == pytest.approx(30.0)
    stays = ran_of("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+30 C+0")
    assert stays.state.position_by_axis["A"] == 0.0
    moved = ran_of("PLANE SPATIAL SPA+30 SPB+0 SPC+0 MOVE DIST50 F1000")
    assert turned.state.linear_position == pytest.approx(moved.state.linear_position)


@pytest.mark.parametrize(
    ("block", "code", "names"),
    [
        ("X+10 Y+10 F100", "Syntax error", "one axis"),
        ("L X+10 Y+10 R+", "Syntax error", "one axis"),
        ("L X+20 FT5", "Not supported", "Feed specified by travel time"),
        ("L X+20 FMAXT5", "Not supported", "Feed specified by travel time"),
        ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS REFPNT TIP-CENTER", "Not supported", "REFPNT"),
        ("FUNCTION FEED DWELL D-TIME1 F-TIME5", "Not supported", "FEED DWELL"),
        ('CYCL DEF 225 ENGRAVING QS500="A" Q513=+10', "Not supported", "225"),
        ("PRESET SELECT #1 KEEP TRANS", "Not supported", "KEEP TRANS"),
        ("FUNCTION DWELL REV5", "Not supported", "revolutions"),
        ("SQL BIND Q1", "Not supported", "SQL"),
    ],
)
def test_invalid_block_is_rejected(block: str, code: str, names: str) -> None:
    ran = ran_of(block)
    assert ran.codes == [code]
    assert names in ran.errors[0].message


@pytest.mark.parametrize(
    "block", ["M94 C", "L M94 A", 'WMAT "STEEL"', "FUNCTION DCM OFF", "FUNCTION COUNT RESET"]
)
def test_block_without_effect_is_reported_as_ignored(block: str) -> None:
    ran = ran_of(block)
    assert not ran.errors
    assert "unheeded" in [each.code for each in ran.diagnostics]
