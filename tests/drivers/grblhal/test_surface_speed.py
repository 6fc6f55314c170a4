"""Constant surface speed on the controller's own spindle: by the override of an S that has room both ways."""

from __future__ import annotations

import math
import re

import pytest

from core.executor.snapshot import MachineState
from tests.drivers.grblhal.bench import GrblBench, quirky
from tests.texts import pattern

# 300 ft/min are 1524 mm/s: at X 1 in (a radius) 573 rpm, at .5 in 1146; not over 2000.
FACE = "G90G94F300\nG77S2000\nM03S500\nX1Z.1\nG96S300\nG95F.004\nG01X.2\nG00X1.2\nG97S600\nM30\n"


def wanted(radius: float) -> float:
    """rpm by hand: v / (2π r), at most G77."""
    return min(60.0 * 300 * 304.8 / 60.0 / (2.0 * math.pi * radius), 2000.0)


def test_spindle_speed_follows_the_radius_without_stopping() -> None:
    bench = GrblBench()
    bench.start(FACE)
    bench.until_true(lambda shot: shot.line == 7)
    begun = [line for line in bench.wire.lines() if line.startswith("M3")]
    assert begun == ["M3S500", "M3S1000"]  # half of G77
    stood, off = 0, []
    while bench.peer.motion.position[0] > 5.1:
        bench.tick()
        stood += bench.peer.motion.speed == 0.0
        off.append(abs(bench.peer.spindle.speed) / wanted(bench.peer.motion.position[0]) - 1.0)
    assert len(off) > 300
    assert max(off[100:]) < 0.03
    assert min(off[100:]) > -0.15  # override steps are read back, and the motor has a ramp
    assert [line for line in bench.wire.lines() if line.startswith("M3")] == begun
    bench.until(MachineState.IDLE)
    assert not bench.alarms()


def test_cut_waits_for_the_required_surface_speed() -> None:
    bench = GrblBench()
    bench.start(FACE)
    bench.until_true(lambda _: bench.peer.motion.position[0] < 25.39 and bench.shot.line >= 7)
    assert abs(bench.peer.spindle.speed) == pytest.approx(wanted(25.4), rel=0.05)


def test_spindle_never_exceeds_programmed_maximum_even_at_100_percent() -> None:
    """A pendant puts the override back: 1000 rpm at most, which are less than G77."""
    bench = GrblBench()
    bench.start(FACE)
    bench.until_true(lambda shot: shot.line == 7)
    bench.run(1.0)
    bench.peer.receive_bytes(bytes([0x99]))
    fastest = 0.0
    for _ in range(200):
        bench.tick()
        fastest = max(fastest, abs(bench.peer.spindle.speed))
    assert fastest <= 1050.0
    assert not bench.alarms()


def test_feed_per_rev_uses_the_limited_spindle_speed() -> None:
    """.004 in a turn: at X .2 in 2000 rpm, 203.2 mm/min, and never more."""
    bench = GrblBench()
    bench.start(FACE)
    bench.until(MachineState.IDLE)
    feeds = [float(line.partition("F")[2]) for line in bench.wire.lines() if "G1" in line]
    assert max(feeds) == pytest.approx(2000 * 0.004 * 25.4)
    assert min(feeds) == pytest.approx(wanted(25.0) * 0.004 * 25.4, rel=0.03)


def test_constant_speed_after_surface_speed_is_set_by_s() -> None:
    bench = GrblBench()
    bench.start(FACE.replace("M30", "G01X1F.01\nM30"))
    bench.until(MachineState.IDLE)
    assert bench.wire.lines()[-1] == "M5"
    assert not bench.alarms()


def test_spindle_without_variable_speed_is_refused_before_the_start() -> None:
    bench = GrblBench(quirks=quirky(build="NML+"))
    bench.start(FACE)
    assert bench.state is MachineState.IDLE
    assert re.match(
        pattern("executor.controller-cannot", what="constant surface speed"), bench.shot.start_refusal_reason
    )


def test_speed_limited_by_the_controller_is_reported() -> None:
    """The firmware's simulator turns 1000 rpm whatever $30 was set to, until it is started anew."""
    bench = GrblBench()
    bench.ready()
    bench.peer.registers.store_setting(30, "1000")  # behind the driver's back: it has read 3500
    bench.start("G90G94F300\nM03S2000\nX.5\nG01F10X.45\nM30\n")
    bench.until(MachineState.FAULT, limit=10.0)
    (alarm,) = bench.shot.alarms
    assert alarm.code == "controller-refuses"
    for value in ("1000 rpm", "2000"):
        assert value in alarm.detail


def test_program_may_reach_but_not_exceed_the_speed_limit() -> None:
    """A program that stays below it is nobody's business."""
    bench = GrblBench(quirks=quirky(settings={30: 3500.0}))
    bench.start("G90G94F300\nM03S2000\nX.5\nG01F10X.45\nM30\n")
    bench.until(MachineState.IDLE)
    assert not bench.alarms()
