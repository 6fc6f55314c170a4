"""Jog by lease: silence is the stop, and nothing goes further than the lease."""

from __future__ import annotations

import pytest

from core.executor.commands import Jog, JogByStep, StopJog
from core.executor.snapshot import MachineState
from tests.drivers.grblhal.bench import GrblBench
from tests.texts import text

V, LEASE = 40.0, 0.2


def ready() -> GrblBench:
    bench = GrblBench()
    bench.ready()
    bench.run(0.5)
    return bench


def hold_key(bench: GrblBench, seconds: float) -> None:
    """Renewed four times a lease."""
    end = bench.clock.now() + seconds
    while bench.clock.now() < end - 1e-9:
        bench.post(Jog("X", V, LEASE))
        bench.run(0.04)


def test_jog_continues_while_it_is_renewed() -> None:
    bench = ready()
    hold_key(bench, 1.0)
    assert bench.state is MachineState.JOG
    assert bench.peer.motion.speed == pytest.approx(V, abs=1.0)
    assert bench.peer.motion.position[0] == pytest.approx(V * 1.0, abs=4.0)


def test_jog_stops_when_its_lease_expires() -> None:
    bench = ready()
    hold_key(bench, 1.0)
    at = bench.peer.motion.position[0]
    took = bench.until_true(lambda _: not bench.peer.motion.is_moving, 1.0)
    assert took <= LEASE + 0.1
    assert bench.peer.motion.position[0] - at <= V * LEASE + V * V / (2 * 3000.0) + 1e-6
    bench.until(MachineState.IDLE, limit=0.5)


def test_releasing_the_key_stops_the_jog_immediately() -> None:
    bench = ready()
    hold_key(bench, 0.5)
    at = bench.peer.motion.position[0]
    bench.post(StopJog())
    assert bench.until(MachineState.IDLE, limit=0.6) < 0.6
    assert bench.peer.motion.position[0] - at < V * 0.03 + V * V / (2 * 3000.0)
    assert 0x85 in bench.wire.sent
    assert not bench.shot.alarms


def let_go_on_a_slow_line() -> GrblBench:
    """A line of the jog is still unanswered: the modes are looked at, which takes half a second there."""
    bench = ready()
    bench.peer.behavior.drip = 0.012
    hold_key(bench, 1.2)
    while bench.machine.controller.line_sender.is_idle:
        hold_key(bench, 0.04)
    bench.post(StopJog())
    assert bench.machine.controller.is_script_running
    return bench


def jogs(bench: GrblBench) -> int:
    """How many have gone out."""
    return sum(line.startswith("$J") for line in bench.wire.lines())


def test_jog_key_pressed_again_waits_for_the_previous_jog() -> None:
    bench = let_go_on_a_slow_line()
    before = jogs(bench)
    hold_key(bench, 0.1)
    assert bench.state is MachineState.JOG
    assert jogs(bench) == before
    at = bench.peer.motion.position[0]
    hold_key(bench, 2.0)
    assert not bench.alarms()
    assert bench.peer.motion.position[0] > at + 0.5 * V


def test_jog_key_released_before_the_previous_jog_ends_moves_nothing() -> None:
    bench = let_go_on_a_slow_line()
    before = jogs(bench)
    hold_key(bench, 0.1)
    bench.post(StopJog())
    bench.until(MachineState.IDLE, limit=3.0)
    bench.run(1.0)
    assert jogs(bench) == before
    assert not bench.alarms()


def test_screen_lost_while_a_jog_key_waits_moves_nothing() -> None:
    bench = let_go_on_a_slow_line()
    before = jogs(bench)
    hold_key(bench, 0.05)
    bench.until(MachineState.IDLE, limit=3.0)
    assert jogs(bench) == before


def test_killed_host_stops_jogging_within_its_lease() -> None:
    bench = ready()
    hold_key(bench, 0.5)
    at = bench.peer.motion.position[0]
    bench.clock.advance(5.0)
    bench.peer.advance()
    assert not bench.peer.motion.is_moving
    assert bench.peer.motion.position[0] - at <= V * LEASE + V * V / (2 * 3000.0) + 1e-6


def test_a_jog_ends_at_the_end_of_the_travel() -> None:
    bench = ready()
    hold_key(bench, 4.0)  # the travel ends at 101.6 mm
    assert bench.peer.motion.position[0] == pytest.approx(101.6 - 0.01, abs=1e-4)
    assert any(text("executor.travel-end", axis="X", sign="+") in said for said in bench.said("refused"))


def test_jog_step_is_exact_and_rejected_in_motion() -> None:
    bench = ready()
    bench.post(JogByStep("Z", -0.254, 5.0))
    bench.post(JogByStep("Z", -0.254, 5.0))
    bench.until(MachineState.IDLE, limit=2.0)
    assert bench.peer.motion.position[1] == pytest.approx(-0.254, abs=1e-6)
    assert bench.said("refused")
    assert bench.wire.lines() == ["$J=G53G21G90Z-0.254F300"]


def test_many_small_steps_add_up() -> None:
    bench = ready()
    for _ in range(20):
        bench.post(JogByStep("X", 0.00127, 5.0))
        bench.until(MachineState.IDLE, limit=2.0)
        bench.run(0.05)
    assert bench.peer.motion.position[0] == pytest.approx(20 * 0.00127, abs=2e-5)


def test_a_program_cannot_be_started_in_a_jog() -> None:
    bench = ready()
    bench.load("G90G94F300\nX.3\nM30\n")
    hold_key(bench, 0.3)
    bench.press()
    assert "jogged" in bench.shot.start_refusal_reason or bench.state is MachineState.JOG
