"""Chains of G33, G34, G35, SF and CYCLE98, CYCLE99: leads and starts by hand; the way that the slides go."""

from __future__ import annotations

from math import radians, sqrt, tan

import numpy as np
import pytest

from core.executor.program_motion.thread_curve import build_thread_curve
from core.executor.program_motion.thread_path import ThreadPath
from core.interpreter.shared.elementary_blocks import Block, BlockKind, SectionEndDetector
from core.motion.axis_limits import MotionLimits
from tests.sinumerik.lathe import good, refused, run

BEGIN = "S600 M3\nG0 X20 Z5\n"
LIMITS = MotionLimits(vmax=(100.0, 100.0, 100.0), amax=(3000.0, 3000.0, 3000.0))


def threads(text: str) -> list[Block]:
    return [block for block in good(BEGIN + text) if block.kind is BlockKind.THREAD]


def test_thread_chain_is_one_continuous_pass() -> None:
    blocks = [b for b in good(BEGIN + "G33 Z-10 K1\nX26 Z-20 K2\nZ-30 K2\nX40 Z-31 K2\nG0 Z5") if b.line > 2]
    assert [b.continues for b in blocks] == [False, True, True, False, False]
    ends, rests = SectionEndDetector(), []
    for block in blocks:
        rests.append(ends.needs_standstill_before(block))
        if rests[-1]:
            ends.record_standstill(block)
    assert rests == [True, False, False, False, True]


def test_g34_increases_and_g35_decreases_the_lead() -> None:
    (grown,) = threads("G34 Z-15 K1 F0.2")
    # lead² = 1 + 2 · 0.2 · 20 = 9: from 1 to 3 mm, in (3 - 1) / 0.2 = 10 turns over 20 mm.
    assert (grown.feed, grown.growth) == (pytest.approx(2.0), 0.2)
    shrunk, on = threads("G35 Z-15 K3 F0.2\nG33 Z-20")
    assert (shrunk.feed, shrunk.growth, on.feed) == (pytest.approx(2.0), -0.2, pytest.approx(1.0))


def test_position_under_growing_lead_matches_formula() -> None:
    (grown,) = threads("G34 Z-15 K1 F0.2")
    curve = build_thread_curve([grown], LIMITS)
    assert curve.length_mm == pytest.approx(10.0)  # turns, the first lead being 1
    for turns in np.linspace(0.0, 10.0, 101):
        assert curve.evaluate_curve(turns)[1] == pytest.approx(5.0 - turns - 0.1 * turns * turns, abs=2e-4)


def test_thread_chain_is_followed_within_axis_limits() -> None:
    chain = threads("G33 Z-10 K1\nX26 Z-20 K2")
    path = ThreadPath.from_blocks(chain, LIMITS)
    assert path.length_mm == pytest.approx(15.0 + 5.0)  # turns times 1 mm: 15, and 10 mm by 2
    speed = 10.0  # 10 turns a second
    segments, leaves = path.plan_remaining_pass(0.0, 0.0, speed, [])
    assert leaves == pytest.approx(2.0, abs=0.01)
    at = np.searchsorted(segments.start_times_s, 1.75, side="right") - 1
    u = 1.75 - segments.start_times_s[at]
    p = segments.positions[at] + segments.velocities[at] * u + 0.5 * segments.accelerations[at] * u * u
    # 17.5 turns: 2.5 of the second thread, 5 mm of Z and a quarter of 3 mm of X for each 10 of them.
    assert p[:2] == pytest.approx((10.0 + 3.0 * 0.5, -10.0 - 5.0), abs=1e-3)
    ends = segments.velocities + segments.accelerations * segments.durations_s[:, None]
    jumps = np.abs(segments.velocities[1:] - ends[:-1])[:, :2]
    assert jumps.max() <= 0.5 * 3000.0 * 0.01  # no step of speed beyond what a few milliseconds take
    assert segments.positions[0, 1] == pytest.approx(5.0)


def test_start_angle_moves_thread_start_back() -> None:
    back, cut = [b for b in good(BEGIN + "G33 Z-20 K2 SF=90") if b.line == 3]
    assert (back.kind, back.z, cut.z0, cut.z) == (BlockKind.RAPID, 5.5, 5.5, -20.0)
    back, cut = [b for b in good(BEGIN + "G34 Z-20 K2 F0.4 SF=180") if b.line == 3]
    # half a turn before the lead was 1.8: (2 + 1.8) / 2 · 0.5 = 0.95 mm further back.
    assert back.z == pytest.approx(5.95)
    assert cut.feed == pytest.approx((1.8 + sqrt(1.8**2 + 0.8 * 25.95)) / 2.0)
    taper, _ = [b for b in good(BEGIN + "G33 X30 Z-20 K2 SF=180") if b.line == 3]
    assert (taper.x, taper.z) == pytest.approx((10.0 - 5.0 / 25.0, 6.0))


def test_start_angle_of_360_degrees_has_no_effect() -> None:
    def ways(words: str) -> list[tuple[BlockKind, float, float]]:
        return [(b.kind, b.z0, b.z) for b in good(BEGIN + f"G33 Z-20 K2 {words}") if b.line == 3]

    assert ways("SF=360") == ways("SF=0") == ways("") == [(BlockKind.THREAD, 5.0, -20.0)]


def test_cycle98_cuts_along_crest_minus_thread_depth() -> None:
    made = good(BEGIN + "CYCLE98(0,30,-20,30,-40,36,-50,36,6,3,1,0,0,,1,0,1.5,2,3,1)")
    cut = [b for b in made if b.kind is BlockKind.THREAD]
    assert [(b.x0, b.z0, b.x, b.z, b.feed) for b in cut] == [
        (14.0, 6.0, 14.0, -20.0, 1.5), (14.0, -20.0, 17.0, -40.0, 2.0), (17.0, -40.0, 17.0, -53.0, 3.0)
    ]  # fmt: skip
    assert [b.continues for b in cut] == [False, True, True]


def test_cycle99_equals_cycle97_with_other_parameter_order() -> None:
    new = good(BEGIN + "CYCLE99(0,40,-20,40,4,2,0.92,0.05,30,0,4,1,1.5,300103,2)")
    old = good(BEGIN + "CYCLE97(1.5,,0,-20,40,40,4,2,0.92,0.05,30,0,4,1,3,2)")
    assert [(b.kind, b.x, b.z, b.feed) for b in new] == [(b.kind, b.x, b.z, b.feed) for b in old]


@pytest.mark.parametrize(
    ("flank", "kind", "sides"), [(30, 300103, "++++++"), (30, 300203, "+-+-+-"), (-30, 300103, "+-+-+-")]
)
def test_cycle99_infeeds_along_one_flank_or_alternately(flank: int, kind: int, sides: str) -> None:
    """Each pass begins beside Z4 by its depth under X20 times tan 30."""
    made = good(BEGIN + f"CYCLE99(0,40,-20,40,4,2,0.92,0.05,{flank},0,4,1,1.5,{kind},1)")
    cut = [b for b in made if b.kind is BlockKind.THREAD]
    slope = tan(radians(30.0))
    begins = [
        4.0 - (20.0 - b.x0) * (slope if side == "+" else -slope) for b, side in zip(cut, sides, strict=True)
    ]
    assert [b.z0 for b in cut] == pytest.approx(begins, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G34 Z-5 K1", "thread-lead-missing"),
        ("G35 Z-20 K1 F0.1", "thread-lead-missing"),
        ("G33 Z-5 K1\nX30 Z-6 K1\nZ-9 K1", "thread-chain"),
        ("G33 Z-5 K1\nZ0 K1", "thread-chain"),
        ("G33 Z-5 K1\nZ-9 SF=90", "word-unused"),
        ("G0 Z4 SF=90\nG33 Z-5 K1", "word-unused"),
        ("G33 SF=90\nZ-5 K1", "word-unused"),
        ("SF=90\nG33 Z-5 K1", "word-unused"),
        ("CYCLE98(0,30,-20,30,-10,36,-50,36,6,3,1,0,0,,1,0,1.5,2,3,1)", "cycle-parameter"),
        ("CYCLE98(0,30,-20,30,-40,36,-50,36,6,3,1,0,0,,1,0,1.5,0,3,1)", "61001"),
        ("CYCLE99(0,40,-20,40,4,2,0.92,0,0,0,4,1,1.5,100103)", "61002"),
        ("CYCLE99(0,40,-20,40,4,2,0.92,0,0,0,4,1,1.5,300103,1,,,,2)", "not-in-subset"),
    ],
)
def test_invalid_thread_chains_are_rejected(text: str, code: str) -> None:
    assert refused(BEGIN + text).code == code


def test_previous_feed_is_not_used_as_lead_change() -> None:
    passed = run(BEGIN + "G95 F0.3\nG34 Z-15 K1 F0.2\nG1 Z-20")
    assert passed.errors == []
    assert passed.moves[-1].feed == 0.3
