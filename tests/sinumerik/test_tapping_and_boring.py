"""CYCLE84, CYCLE840, CYCLE86 to 88, G331 and G332: turns of the spindle by hand, and refusals."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.interpreter.shared.actions import ProgramStop, SpindleLock, SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from tests.sinumerik.lathe import run, setup

LIVE = load_shipped_machine("sinumerik-live")
HOLE = "S300 M3 G94 F100 G17\nG0 X0 Z5\n"


def around() -> InterpreterSetup:
    return replace(setup(LIVE, start=(0.0, 5.0, 0.0)), tools={})


def blocks(text: str) -> list[Block]:
    passed = run(HOLE + text, around())
    assert list(passed.errors) == []
    return [block for block in passed.blocks if block.line > 2]


def error(text: str) -> tuple[str, str]:
    (found,) = run(HOLE + text, around()).errors
    return found.code, f"{found.message} {found.hint}"


def test_rigid_tap_rotates_with_its_feed() -> None:
    into, out = [b for b in blocks("CYCLE84(5,0,2,-13,,,3,,1.5,0,200,300)") if b.c != b.c0]
    # 15 mm by 1.5 are ten turns; 1.5 mm a turn at 200 and at 300 rpm.
    assert (into.z, into.c - into.c0, into.feed) == (-13, pytest.approx(3600.0), pytest.approx(5.0))
    assert (out.z, out.c - out.c0, out.feed) == (2, pytest.approx(-3600.0), pytest.approx(7.5))
    assert (into.kind, into.per_rev, into.modal.c_locked) == (BlockKind.FEED, False, True)
    after = blocks("CYCLE84(5,0,2,-13,,,3,,1.5,0,200,300)")[-1]
    assert (after.action, after.modal.spindle) == (SpindleRun(300.0), 1)


def test_left_hand_tap_by_size_pecks_and_starts_at_an_angle() -> None:
    turned = [b for b in blocks("CYCLE84(5,0,2,-10,,,5,-6,,90,100,,,,,2,4)") if b.c != b.c0]
    assert (turned[0].kind, turned[0].c) == (BlockKind.FEED, pytest.approx(90.0))  # POSS, before it goes in
    # M6 has a lead of 1: 4 of 12 mm, out, 8, out, 12, out; the left-hand tap turns against C+.
    assert [(b.z, round(b.c - b.c0)) for b in turned[1:]] == [
        (-2, -1440), (2, 1440), (-6, -2880), (2, 2880), (-10, -4320), (2, 4320)
    ]  # fmt: skip


def test_spindle_reverses_with_compensating_chuck() -> None:
    made = blocks("CYCLE840(5,0,2,-12,,0,0,3,0,,1.25)")
    fed = [b for b in made if b.kind is BlockKind.FEED]
    assert [(b.z, b.feed) for b in fed] == [
        (-12, pytest.approx(6.25)),
        (2, pytest.approx(6.25)),
    ]  # 300 · 1.25
    turned = [b.action for b in made if isinstance(b.action, SpindleRun)]
    assert turned == [SpindleRun(-300.0), SpindleRun(300.0)]
    assert [b.modal.spindle for b in fed] == [1, -1]
    by_turn = [b for b in blocks("G95\nCYCLE840(5,0,2,-12,,0,0,5,0,,1.25)") if b.kind is BlockKind.FEED]
    assert [(b.feed, b.per_rev) for b in by_turn] == [(1.25, True)] * 2
    by_feed = [b for b in blocks("G94 F300\nCYCLE840(5,0,2,-12,,0,0,3,1,,1.25)") if b.kind is BlockKind.FEED]
    assert [b.feed for b in by_feed] == [pytest.approx(5.0)] * 2  # ENC 1: 300 mm/min, whatever PIT says


def test_g331_and_g332_tap_and_retract_with_spindle_rotation() -> None:
    into, out = [b for b in blocks("SPOS=0\nG331 Z-10 K0.5 S120\nG332 Z5") if b.c != b.c0]
    assert (into.c - into.c0, into.feed) == (pytest.approx(30 * 360.0), pytest.approx(1.0))
    assert (out.z, out.c - out.c0) == (5, pytest.approx(-30 * 360.0))


def test_cycle86_bores_and_retracts_with_edge_lifted() -> None:
    made = blocks("CYCLE86(5,0,2,-20,,0,3,-1,0,0.5,45)")
    assert [(b.x, b.z) for b in made if b.kind in {BlockKind.RAPID, BlockKind.FEED}] == [
        (0, 2), (0, -20), (0, -20), (-1, -19.5), (-1, 5), (0, 5)
    ]  # fmt: skip
    assert any(isinstance(b.action, SpindleLock) for b in made)
    assert made[-1].modal.spindle == 0


@pytest.mark.parametrize("call", ["CYCLE87(5,0,2,-20,,3)", "CYCLE88(5,0,2,-20,,0,3)"])
def test_boring_cycle_stops_for_the_operator(call: str) -> None:
    actions = [b.action for b in blocks(call) if b.action is not None]
    assert actions == [SpindleStop(waits_for_standstill=True), ProgramStop(optional=False)]


@pytest.mark.parametrize(
    ("text", "code", "part"),
    [
        ("CYCLE84(5,0,2,-12,,,5,,,0,100)", "61001", "PIT"),
        ("CYCLE84(5,0,2,-12,,,5,7,,0,100)", "61001", "MPIT"),
        ("CYCLE84(5,0,2,-12,,,6,,1,0,100)", "cycle-parameter", "SDAC"),
        ("CYCLE84(5,0,2,-12,,,5,,1,400,100)", "cycle-parameter", "POSS"),
        ("CYCLE84(5,0,2,12,,,5,,1,0,100)", "61101", "DP"),
        ("CYCLE840(5,0,2,-12,,0,3,3,0,,1)", "cycle-parameter", "SDR"),
        ("M5\nCYCLE840(5,0,2,-12,,0,0,3,0,,1)", "61102", "M3"),
        ("CYCLE840(5,0,2,-12,,0,0,3,0)", "61001", "PIT"),
        ("CYCLE840(5,0,2,-12,,0,0,3,11)", "61001", "PIT"),
        ("CYCLE840(5,0,2,-12,,0,0,3,2,,1)", "cycle-parameter", "ENC"),
        ("CYCLE86(5,0,2,-12,,0,5)", "61102", "SDIR"),
        ("CYCLE86(5,0,2,-12,,0,3,0,2)", "not-in-subset", "RPO"),
        ("CYCLE86(5,0,2,-12,,0,3,0,0,-1)", "cycle-parameter", "RPAP"),
        ("CYCLE87(5,0,2,-12,,1)", "61102", "SDIR"),
        ("G331 Z-5 K1", "spindle-position", "SPOS=0"),
        ("SPOS=0\nG331 Z-5", "thread-lead-missing", "K"),
        ("SPOS=0\nG331 X3 Z-5 K1", "word-unused", "only along Z"),
    ],
)
def test_invalid_tapping_and_boring_calls_are_rejected(text: str, code: str, part: str) -> None:
    found, said = error(text)
    assert found == code
    assert part in said


def test_tapping_speed_beyond_c_limit_is_reported() -> None:
    passed = run(HOLE + "CYCLE84(5,0,2,-13,,,5,,1.5,0,900)", around())
    assert [each.code for each in passed.found] == ["tap-speed"]
    assert [b.feed for b in passed.blocks if b.c != b.c0] == [pytest.approx(10.0)] * 2  # 400 rpm by 1.5
