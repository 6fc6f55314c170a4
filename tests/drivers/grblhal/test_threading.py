"""Threads on the controller: at their lead whatever the overrides are, and along their own way."""

from __future__ import annotations

import math

import pytest

from core.block_ports import ArcOperation
from core.executor.commands import FeedHold, Reset, SetFeedOverride
from core.executor.snapshot import MachineState
from drivers.grblhal.grblhal_codes import format_block
from tests.drivers.grblhal.bench import GrblBench, quirky
from tests.drivers.grblhal.test_faults import THREAD, clear

TAPERED = THREAD.replace("K.05", "K.05A.07")


def test_thread_is_cut_by_the_controller() -> None:
    bench = GrblBench()
    bench.start(THREAD)
    bench.until(MachineState.IDLE)
    threads = [line for line in bench.wire.lines() if "G33" in line]
    assert len(threads) >= 2
    assert all(line.endswith("Z-12.7K1.27") for line in threads)
    assert bench.peer.motion.position[1] == pytest.approx(25.4)
    assert "G95" not in "".join(bench.wire.lines())
    assert not bench.said("alarm")


def test_missing_index_in_a_thread_raises_an_alarm_after_a_wait() -> None:
    bench = GrblBench(quirks=quirky(index_missing=True))
    bench.start(THREAD)
    bench.until(MachineState.FAULT, limit=20.0)
    assert "ALARM:14" in bench.alarms()
    clear(bench)
    assert bench.state is MachineState.IDLE  # the block that stood in the planner is gone
    assert not bench.peer.motion.block_queue
    bench.run(2.0)
    assert bench.state is MachineState.IDLE


def test_without_an_encoder_threads_are_refused_before_the_start() -> None:
    bench = GrblBench(quirks=quirky(encoder=False))
    bench.start(THREAD)
    assert bench.state is MachineState.IDLE
    assert "threads" in bench.shot.start_refusal_reason


def test_thread_pass_runs_at_full_override_which_is_restored_afterwards() -> None:
    """The firmware's override slows a synchronised pass, which then lags behind its lead."""
    bench = GrblBench()
    bench.start(THREAD)
    bench.post(SetFeedOverride(0.5))
    bench.until_true(lambda _: any("G33" in line for line in bench.wire.lines()))
    assert bench.peer.feed_percent == 100
    while bench.peer.motion.block_queue and bench.peer.motion.block_queue[0].is_thread:
        bench.tick()
        assert bench.peer.feed_percent == 100
    bench.until_true(lambda shot: shot.state is MachineState.IDLE or bench.peer.feed_percent == 50)
    bench.until(MachineState.IDLE)
    bench.run(3.0)
    assert bench.peer.feed_percent == 50
    assert bench.peer.motion.position[1] == pytest.approx(25.4)
    assert not bench.said("alarm")


def test_lead_of_a_tapered_thread_is_measured_along_the_taper() -> None:
    """The controller counts K along the way: .07 in X on .7 in Z make it longer by the root of 1.01."""
    bench = GrblBench()
    bench.start(TAPERED)
    bench.until(MachineState.IDLE)
    threads = [line for line in bench.wire.lines() if "G33" in line]
    assert len(threads) >= 2
    for line in threads:
        assert float(line.partition("K")[2]) == pytest.approx(1.27 * math.sqrt(1.01), abs=1e-5)


def test_a_hold_waits_for_the_end_of_the_pass() -> None:
    """The firmware would hold in the middle of it, and the thread be gone."""
    bench = GrblBench()
    bench.start(THREAD)
    bench.until_true(lambda _: bench.peer.motion.is_moving and bench.peer.motion.block_queue[0].is_thread)
    bench.post(FeedHold())
    while bench.peer.motion.block_queue and bench.peer.motion.block_queue[0].is_thread:
        assert 0x82 not in bench.wire.sent
        bench.tick()
    bench.until(MachineState.HOLD, limit=5.0)
    bench.press()
    bench.until(MachineState.IDLE)
    assert bench.peer.abrupt_stop_count == 0


def test_reset_in_a_thread_pass_brakes_and_retains_the_position() -> None:
    bench = GrblBench()
    bench.start(THREAD)
    bench.until_true(lambda _: bench.peer.motion.is_moving and bench.peer.motion.block_queue[0].is_thread)
    bench.post(Reset())
    bench.until(MachineState.IDLE, limit=5.0)
    assert bench.peer.abrupt_stop_count == 0
    assert all(bench.shot.homed[:2])
    assert not bench.shot.alarms


def test_very_short_arc_is_sent_as_a_line() -> None:
    """Its angle would round to nothing over there, which is a whole circle."""
    x = 10.0 * math.sin(1e-4)
    z = 10.0 * math.cos(1e-4)
    assert (
        format_block(ArcOperation(0.0, 10.0, x, z, 0.0, 0.0, True, 1.0), 1, 127.0, 1.0) == "N1G1X0.001Z10F60"
    )
    whole = format_block(ArcOperation(0.0, 10.0, 0.0, 10.0, 0.0, 0.0, True, 1.0), 1, 127.0, 1.0)
    assert whole == "N1G3X0Z10I0K-10F60"
    nearly = format_block(ArcOperation(0.0, 10.0, -x, z, 0.0, 0.0, True, 1.0), 1, 127.0, 1.0)
    assert nearly.startswith("N1G3")
