"""CYCLE92: down at two feeds and two speeds, and what its parameters refuse."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from tests.sinumerik.lathe import refused, run, setup

LIVE = load_shipped_machine("sinumerik-live")
TOOLS = replace(setup(), tools={1: ToolOffset(quadrant=3)})
START = "S900 M3 G95 F0.1\nT1 D1\nG0 X50 Z-30\n"


def test_parting_uses_two_feeds_and_two_speeds() -> None:
    """From 1 mm beside the diameter of 40 to that of 10, then on at half the feed, 0.5 beyond the axis."""
    passed = run(START + "CYCLE92(40,-30,10,-1,,1,,,,0.1,0.05,500)", TOOLS)
    assert passed.found == []
    moves = [(b.kind, b.x, b.feed, b.rpm) for b in passed.moves if b.line == 4]
    assert moves[1:3] == [(BlockKind.FEED, 5.0, 0.1, 900.0), (BlockKind.FEED, -0.5, 0.05, 500.0)]
    assert (moves[0][1], moves[3][1]) == (21.0, 21.0)


def test_parting_uses_surface_speed_with_speed_limit() -> None:
    """120 m/min at most 2000 rpm: at 42 mm 909.457 rpm; behind the cycle S900 again."""
    passed = run(START + "CYCLE92(40,-30,10,-1,,1,120,2000,3,0.1,0.05,500)", TOOLS)
    ran = [b.action for b in passed.blocks if isinstance(b.action, SpindleRun)]
    assert [each.surface_speed for each in ran] == [None, pytest.approx(2000.0), None, None]
    assert (ran[2].rpm, ran[3].rpm) == (500.0, 900.0)
    begun = next(b for b in passed.moves if b.line == 4 and b.kind is BlockKind.FEED)
    assert begun.css == pytest.approx(2000.0)
    assert begun.modal.max_css_rpm == 2000.0


def test_surface_speed_is_in_feet_where_g96_uses_feet() -> None:
    """300 ft/min are 1524 mm/s, as G96 S300 behind it says; 300 m/min would be 5000."""
    text = "G700\nS900 M3 G95 F0.003\nT1 D1\nG0 X2 Z-1\nCYCLE92(1.5,-1,0.5,-0.04,,0.04,300,2000,3)\nG96 S300"
    passed = run(text, TOOLS)
    ran = [b.action.surface_speed for b in passed.blocks if isinstance(b.action, SpindleRun)]
    assert ran == [None, pytest.approx(1524.0), None, pytest.approx(1524.0)]


def test_spindle_started_by_cycle_is_known_to_turn() -> None:
    """Nothing was in force before: what goes on turning at 500 rpm is not told as a spindle that stands."""
    passed = run("T1 D1\nG0 X50 Z-30\nCYCLE92(40,-30,10,-1,,1,800,,3,0.1,0.05,500)\nG0 Z0", TOOLS)
    assert passed.found == []
    assert [b.action.rpm for b in passed.blocks if isinstance(b.action, SpindleRun)] == [800.0, 500.0]
    assert (passed.moves[-1].rpm, passed.moves[-1].modal.spindle) == (500.0, 1)


def test_start_below_part_diameter_retracts_first() -> None:
    passed = run("S900 M3 G95 F0.1\nT1 D1\nG0 X36 Z2\nCYCLE92(40,-30,0,0)", TOOLS)
    assert [(b.x, b.z) for b in passed.moves if b.line == 4][:2] == [(21.0, 2.0), (21.0, -30.0)]


@pytest.mark.parametrize(
    ("call", "code"),
    [
        ("CYCLE92(40,-30,50,-1)", "61604"),
        ("CYCLE92(40,-30,10,12)", "61604"),
        ("CYCLE92(40,-30,10)", "cycle-parameter"),
        ("CYCLE92(40,-30,10,-1,0.2)", "not-in-subset"),
        ("CYCLE92(40,-30,10,-1,,1,,,,,,,,1)", "not-in-subset"),
        ("CYCLE92(40,-30,10,20,,1,,,,,,,,,,,11)", "not-in-subset"),
        ("CYCLE92(40,-30,10,-1,,1,9000)", "cycle-parameter"),
        ("CYCLE92(40,-30,10,-1,,1,500,,5)", "cycle-parameter"),
        ("M5\nCYCLE92(40,-30,10,-1)", "61102"),
    ],
)
def test_invalid_parting_calls_are_rejected(call: str, code: str) -> None:
    assert refused(START + call, TOOLS).code == code


def test_parting_with_live_tool_feed_starts_nothing_while_the_tool_is_stopped() -> None:
    """SETMS(2) with G95 needs the live tool. S1000 and M3 of _SV1 and _SDAC once started before the error."""
    around = replace(setup(LIVE), tools={1: ToolOffset(quadrant=3)})
    text = f"{START}SETMS(2)\nG95 F0.1\nCYCLE92(40,-30,10,-1,,1,1000,,3,0.1,0.05,500)"
    passed = run(text, around)
    assert [each.code for each in passed.errors] == ["g95-spindle-stopped"]
    assert [block for block in passed.blocks if block.line == 6] == []
    assert passed.blocks[-1].modal.rpm == 900.0


def test_parting_without_feed_is_rejected() -> None:
    assert refused("S900 M3 G95\nT1 D1\nCYCLE92(40,-30,10,-1)", TOOLS).code == "61003"
