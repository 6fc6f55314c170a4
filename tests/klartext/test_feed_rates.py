"""Feeds per revolution and per tooth (FU, FZ, M136), and M103: mm/s reckoned by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import MillTool
from tests.klartext.running import Ran, run

CUTTER = {1: MillTool(radius=5.0, tooth_count=4)}
START = "TOOL CALL 1 Z S1200\nL X+0 Y+0 Z+0 R0 FMAX M3\n"


def feeds(text: str, **setup: Any) -> list[float]:
    ran = run(START + text, mill_tools=CUTTER, **setup)
    assert ran.codes == []
    return [block.feed for block in ran.blocks if block.kind in {BlockKind.FEED, BlockKind.PLANE_ARC}]


@pytest.mark.parametrize(
    ("text", "per_second"),
    [
        ("L X+10 FU0.1", [2.0]),  # 0.1 mm x 1200 / 60 s
        ("L X+10 FZ0.05", [4.0]),  # 0.05 mm x 4 x 1200 / 60 s
        ("L X+10 FU0.1\nL X+20", [2.0, 2.0]),
        ("L X+10 FU0.1\nL X+20 F600", [2.0, 10.0]),
        ("L X+10 FU0.1\nTOOL CALL S600\nL X+20", [2.0, 1.0]),  # the speed counts, not the feed of before
        ("TOOL CALL 1 Z S1200 FZ0.05\nL X+10 F AUTO M3", [4.0]),
        ("TOOL CALL 1 Z S600 FU0.2\nL X+10 M3", [2.0]),
        ("M136\nL X+10 F0.25\nM137\nL X+20 F600", [5.0, 10.0]),
        ("L X+10 F0.25 M136\nL X+20", [5.0, 5.0]),
        ("CC X+0 Y+10\nC X+10 Y+10 DR+ FU0.1", [2.0]),
        ("Q5 = 0.1\nL X+10 FUQ5", [2.0]),
    ],
)
def test_feed_per_revolution_and_per_tooth(text: str, per_second: list[float]) -> None:
    assert feeds(text) == pytest.approx(per_second)


def test_in_inch_programs_fu_is_inches() -> None:
    assert feeds("L X+1 FU0.01", unit="INCH") == pytest.approx([0.01 * 25.4 * 20.0])


def test_cycle_uses_feed_per_revolution_of_tool_call() -> None:
    """F AUTO of drilling: 0.1 mm x 1200 / 60 s."""
    drill = "CYCL DEF 200 DRILLING Q200=+2 Q201=-5 Q206=FAUTO Q202=+5 Q210=+0 Q203=+0 Q204=+50 Q211=+0"
    ran = run(f"TOOL CALL 1 Z S1200 FU0.1\nL X+0 Y+0 Z+10 R0 FMAX M3\n{drill}\nCYCL CALL")
    assert ran.codes == []
    assert {round(block.feed, 9) for block in ran.blocks if block.kind is BlockKind.FEED} == {2.0}


@pytest.mark.parametrize(
    ("text", "per_second"),
    [
        ("L Z-10 F600", [2.0]),  # straight down: a fifth
        ("L X+10 F600", [10.0]),  # nothing goes down
        ("L Z+10 F600", [10.0]),
        ("L X+30 Z-40 F600", [2.0 * 50.0 / 40.0]),  # Z keeps its 2 mm/s: 50 mm of way for 40 mm down
        ("L X+40 Z-1 F600", [10.0]),  # so flat that Z stays below anyhow
        ("L Z-10 F600\nM103\nL Z-20", [2.0, 10.0]),
        ("L Z-10 F600\nL X+5", [2.0, 10.0]),  # F in force is as programmed
        ("L Z-900 F600 M91", [2.0]),
        ("CC X+0 Y+10\nCP IPA+360 IZ-20 DR+ F600", [2.0 * math.hypot(20.0 * math.pi, 20.0) / 20.0]),
    ],
)
def test_m103_reduces_feed_by_share_of_z(text: str, per_second: list[float]) -> None:
    assert feeds(f"M103 F20\n{text}") == pytest.approx(per_second)


def refused(text: str, **setup: Any) -> Ran:
    ran = run(START + text, mill_tools=CUTTER, **setup)
    assert len([block for block in ran.blocks if block.kind is BlockKind.FEED]) == 0
    return ran


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        ("M5\nL X+10 FU0.1", "Wrong rpm", "the spindle is stopped"),
        ("L X+10 FU100", "Input value incorrect", "120000"),
        ("L X+10 FU0", "Input value incorrect", "above zero"),
        ("L X+10 FU", "Syntax error", "FU"),
        ("TOOL CALL 1 Z SU100", "Syntax error", "TOOL CALL"),
        ("TOOL CALL 2 Z S1200\nL X+10 FZ0.1 M3", "Input value incorrect", "tool 2"),
        ("M136\nL X+10", "Feed rate is missing", "No feed"),
        ("TOOL CALL S1200 F500\nM136\nL X+10", "Feed rate is missing", "No feed"),
        ("M136\nL X+10 F500", "Input value incorrect", "M136 500"),
        ("M136\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL CALL", "Not supported", "M136"),
        ("M103 F0\nL Z-5 F100", "Input value incorrect", "M103"),
        ("M103 F120\nL Z-5 F100", "Input value incorrect", "M103"),
        ("M103 F AUTO", "Syntax error", "its factor"),
        ("M103 FQ5", "Not supported", "M103"),
        ("M128 FU0.1", "Syntax error", "M128"),
    ],
)
def test_invalid_feed_is_rejected(text: str, code: str, names: str) -> None:
    ran = refused(text)
    assert code in ran.codes
    assert any(names in each.message for each in ran.diagnostics)


def test_m136_is_refused_in_inch_programs() -> None:
    assert refused("M136", unit="INCH").codes == ["Not supported"]


def test_warning_says_spindle_override_does_not_change_feed() -> None:
    ran = run(f"{START}L X+10 FU0.1\nL X+20")
    assert [each.code for each in ran.diagnostics] == ["feed-by-programmed-speed"]


def test_codes_that_cancel_unsupported_functions_are_accepted() -> None:
    assert run("M102\nM117\nM145\nM141\nM105\nL X+1 FMAX").codes == []


def test_m116_sets_rotary_feed_in_mm_at_tool_tip() -> None:
    """C turns about X300 Y252 of the machine, X70 Y42 of the workpiece: at X130 the tip is 60 mm off."""
    at = "L X+130 Y+42 Z+0 R0 FMAX\n"
    degrees_per_second = 600.0 / 60.0 / math.radians(60.0)
    assert run(f"{at}M116\nL C+30 F600").blocks[-1 - 1].feed == pytest.approx(degrees_per_second, rel=1e-6)
    assert run(f"{at}M116\nM117\nL C+30 F600").blocks[-2].feed == pytest.approx(10.0)
    assert run("L X+70 Y+42 FMAX\nM116\nL C+30 F600").blocks[-2].feed == pytest.approx(10.0)  # on its line


def test_m101_warns_that_no_replacement_tool_is_used() -> None:
    ran = run("M101\nL X+1 FMAX")
    assert (ran.codes, ran.warned) == ([], ["no-replacement-tool"])
