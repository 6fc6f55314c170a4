"""Threads that are computed: entry angles, leads, speeds that are known."""

from __future__ import annotations

import numpy as np
import pytest

from core.extras.analyses.thread_passes import ThreadAnalysis, analyze_thread, calculate_max_threading_rpm
from core.records.record import AnalysisError
from tests.coded import raises_code

RATE, RPM, LEAD = 1000.0, 1200.0, 1.5


def cut(
    *,
    entries: tuple[float, ...] = (0.0, 0.0, 0.0),
    leads: tuple[float, ...] = (),
    drop: float = 0.0,
    ripple: float = 0.0,
    way: float = -1.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Passes of 15 turns over the same way, entries in degrees; 20 turns a second."""
    leads = leads or tuple(LEAD for _ in entries)
    t = np.arange(int(2.0 * RATE * len(entries))) / RATE
    turns = RPM / 60.0 * t
    speed = RPM + ripple * np.sin(2.0 * np.pi * turns)
    along, depth = np.full(len(t), 5.0), np.full(len(t), 12.0)
    for n, (entry, lead) in enumerate(zip(entries, leads, strict=True)):
        begin = 40 * n + 5 + entry / 360.0  # whole turns apart, so that angles are those that are put in
        inside = (turns >= begin) & (turns < begin + 15.0)
        along[inside] = 5.0 + way * lead * (turns[inside] - begin)
        depth[inside] = 10.0 - 0.2 * n
        speed[inside] -= drop
        back = (turns >= begin + 15.0) & (turns < begin + 16.0)
        along[back] = 5.0 + way * lead * 15.0 * (1.0 - (turns[back] - begin - 15.0))
    return turns, along, depth, speed


def found(**how: object) -> ThreadAnalysis:
    return analyze_thread(*cut(**how))  # type: ignore[arg-type]


def test_passes_in_one_groove_have_no_deviation() -> None:
    thread = found()
    assert len(thread.passes) == 3
    assert thread.reference_lead_mm == pytest.approx(-LEAD, rel=1e-6)
    assert thread.entry_spread_deg == pytest.approx(0.0, abs=0.01)
    assert [each.depth_mm for each in thread.passes] == pytest.approx([10.0, 9.8, 9.6])
    assert all(np.abs(each.deviations_mm).max() < 1e-6 for each in thread.passes)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_pass_with_another_entry_angle_is_measured(way: float) -> None:
    thread = found(entries=(0.0, 0.0, 12.0), way=way)
    assert [each.entry_angle_deg for each in thread.passes] == pytest.approx([0.0, 0.0, 12.0], abs=0.05)
    assert np.mean(thread.passes[2].deviations_mm) == pytest.approx(-way * LEAD * 12.0 / 360.0, abs=1e-4)


def test_entry_angle_before_the_first_is_negative() -> None:
    assert found(entries=(0.0, -5.0)).passes[1].entry_angle_deg == pytest.approx(-5.0, abs=0.05)


def test_lead_error_is_measured() -> None:
    thread = analyze_thread(*cut(leads=(LEAD, LEAD, 1.503)), lead=-LEAD)
    assert thread.passes[2].lead_mm == pytest.approx(-1.503, abs=1e-5)
    assert thread.max_lead_error_mm == pytest.approx(-0.003, abs=1e-5)
    assert abs(thread.passes[2].deviations_mm[-1]) == pytest.approx(
        0.003 * 15.0, rel=0.05
    )  # half a turn at both ends is left out


def test_spindle_speed_drop_in_the_cut_is_measured() -> None:
    thread = found(drop=30.0)
    assert [each.min_speed_rpm for each in thread.passes] == pytest.approx([RPM - 30.0] * 3)
    assert [each.speed_drop_rpm for each in thread.passes] == pytest.approx([30.0] * 3, abs=5.0)


def test_speed_ripple_is_measured() -> None:
    assert [each.speed_ripple_rpm for each in found(ripple=4.0).passes] == pytest.approx([8.0] * 3, abs=0.1)


def test_pass_with_a_jolt_counts_as_one_pass() -> None:
    turns, along, depth, speed = cut()
    jolt = (turns > 12.0) & (turns < 12.2)
    along[jolt] += 0.05 * LEAD * np.sin(2.0 * np.pi * (turns[jolt] - 12.0) / 0.2)
    thread = analyze_thread(turns, along, depth, speed)
    assert len(thread.passes) == 3
    assert [np.ptp(each.spindle_revolutions) for each in thread.passes] == pytest.approx([14.0] * 3, abs=0.3)


def test_maximum_thread_rpm_follows_from_the_axis_speed() -> None:
    assert calculate_max_threading_rpm(-1.5, 42.0) == pytest.approx(1680.0)  # 42 mm/s are 28 leads a second


def test_constant_feed_is_one_pass_and_its_lead_is_reported() -> None:
    turns = np.arange(4000.0, dtype=np.float64) * 0.02
    thread = analyze_thread(turns, -0.2 * turns, np.zeros(4000), np.full(4000, RPM))
    assert len(thread.passes) == 1
    assert thread.reference_lead_mm == pytest.approx(-0.2)


@pytest.mark.parametrize(
    ("turns", "code"),
    [
        (np.arange(50) * 0.02, "too-few-samples"),
        (np.full(500, np.nan), "no-encoder"),
        (np.zeros(500), "spindle-stopped"),
        (np.arange(500) * 0.02, "no-pass"),
    ],
)
def test_invalid_thread_is_rejected(turns: np.ndarray, code: str) -> None:
    n = len(turns)
    with raises_code(AnalysisError, code):
        analyze_thread(turns, np.zeros(n), np.zeros(n), np.zeros(n))


def test_another_lead_is_not_accepted() -> None:
    with raises_code(AnalysisError, "no-pass"):
        analyze_thread(*cut(), lead=2.0)
