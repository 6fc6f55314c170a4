"""Holds and resets of a running program: ours, those of the pins, and those of buttons at the controller."""

from __future__ import annotations

import pytest

from core.executor.commands import FeedHold, Reset, SetFeedOverride
from core.executor.snapshot import MachineState
from tests.drivers.grblhal.bench import GrblBench, quirky
from tests.drivers.grblhal.test_run import LONG
from tests.texts import text


def test_feed_hold_stops_and_cycle_start_resumes() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(FeedHold())
    assert bench.until(MachineState.HOLD) < 0.3
    at = bench.peer.motion.position
    bench.run(3.0)
    assert bench.peer.motion.position == at
    assert bench.state is MachineState.HOLD
    bench.press()
    assert bench.state is MachineState.RUN
    bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((25.4, -50.8))


def test_reset_from_hold_retains_position_and_modes() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(FeedHold())
    bench.until(MachineState.HOLD)
    at = bench.peer.motion.position
    bench.post(Reset())
    bench.until(MachineState.IDLE)
    bench.run(0.5)
    assert bench.peer.motion.position == at
    assert bench.peer.program.modes.plane == "G18"
    assert bench.peer.programmed_rpm == 0.0
    bench.start("G90G94F300\nX.3Z.3\nM30\n")
    bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((7.62, 7.62))


def test_reset_in_motion_brakes_and_starts_nothing() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(Reset())
    bench.until(MachineState.IDLE, limit=3.0)
    assert not bench.shot.alarms
    bench.run(0.5)
    bench.wire.sent.clear()
    bench.run(2.0)
    assert bench.wire.lines() == []
    assert not bench.peer.motion.block_queue


def test_hold_that_does_not_end_causes_a_reset_and_a_lost_position() -> None:
    bench = GrblBench(quirks=quirky(hold_broken=True))
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(SetFeedOverride(0.1))
    bench.run(0.5)
    bench.wire.sent.clear()
    bench.post(Reset())
    bench.until(MachineState.FAULT, limit=8.0)
    sent = bytes(bench.wire.sent)
    assert sent.index(0x82) < sent.index(0x18)
    assert "ALARM:3" in bench.alarms()
    assert not all(bench.shot.homed)


def test_zero_override_stops_and_a_higher_override_resumes() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(SetFeedOverride(0.0))
    bench.until(MachineState.WAIT, limit=1.0)
    assert bench.shot.waiting_for == text("executor.feed-override-0")
    at = bench.peer.motion.position
    bench.run(1.0)
    assert bench.peer.motion.position == at
    bench.post(SetFeedOverride(0.5))
    bench.until(MachineState.RUN, limit=1.0)
    bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((25.4, -50.8))


def test_hold_and_start_pins_of_the_controller_act() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.peer.active_pins = "H"
    bench.until(MachineState.HOLD, limit=0.5)
    bench.press()
    assert bench.state is MachineState.HOLD
    bench.peer.active_pins = ""
    bench.run(0.5)
    bench.peer.active_pins = "S"
    bench.until(MachineState.RUN, limit=0.5)
    bench.peer.active_pins = ""
    bench.until(MachineState.IDLE)
    assert bench.shot.parts == 1


def test_hold_triggered_at_the_controller_holds_the_cycle() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.peer.receive_bytes(b"\x82")  # a button at the controller, pressed between two reports
    bench.until(MachineState.HOLD, limit=0.5)
    assert bench.shot.waiting_for == text("executor.controller-holds")
    bench.run(1.0)
    assert bench.state is MachineState.HOLD
    bench.press()
    bench.until(MachineState.IDLE)
    assert bench.shot.parts == 1


def test_cycle_start_at_the_controller_does_not_end_a_hold_of_turndesk() -> None:
    """Its own cycle start moves the slides at once; the screen says FEED HOLD, so they stand again."""
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    bench.post(FeedHold())
    bench.until(MachineState.HOLD)
    bench.peer.receive_bytes(b"\x81")
    bench.run(1.0)
    assert bench.state is MachineState.HOLD
    assert bench.peer.state_name == "Hold:0"
    bench.press()
    bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((25.4, -50.8))
