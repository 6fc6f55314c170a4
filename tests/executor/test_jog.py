"""Jog is a lease, and homing comes first where an axis only counts."""

from __future__ import annotations

import math

import pytest

from core.executor.commands import (
    Command,
    CycleStart,
    DeselectHandwheel,
    EnableDrives,
    FeedHold,
    HomeAxes,
    Jog,
    JogByStep,
    Reset,
    StopJog,
)
from core.executor.snapshot import MachineState
from tests.executor.rig import INCH, TICK, Rig, unhomed_machine
from tests.texts import text

AMAX = 120 * INCH
FAST = 100 * INCH / 60  # manual rapid


def ready() -> Rig:
    rig = Rig()
    rig.ready()
    return rig


@pytest.mark.parametrize("lease", [0.05, 0.2, 0.25])
@pytest.mark.parametrize("speed", [1.0, 20.0, FAST])
def test_jog_ends_when_its_lease_is_not_renewed(lease: float, speed: float) -> None:
    rig = ready()
    rig.executor.post(Jog("Z", -speed, lease))
    rig.executor.run_tick()
    began = rig.clock.now()
    rig.until(MachineState.IDLE)
    assert rig.clock.now() - began < lease + 0.1
    run = -rig.shot.demand[1]
    assert 0 < run <= lease * speed + speed * speed / (2 * AMAX) + 1e-9


def test_jog_ends_when_the_host_dies() -> None:
    rig = ready()
    rig.post(Jog("X", FAST, 0.2))
    rig.clock.advance(5.0)
    sample = rig.sim.ports.axes.sample()
    assert not sample.moving
    assert sample.actual[0] <= 0.2 * FAST + FAST * FAST / (2 * AMAX) + 0.002
    rig.tick()
    assert rig.shot.alarms == ()
    rig.tick()
    assert rig.state is MachineState.IDLE


def test_renewed_jog_continues_at_constant_speed() -> None:
    rig = ready()
    rig.post(Jog("X", 10.0, 0.2))
    rig.run(0.1)
    speeds = []
    for _ in range(10):
        rig.post(Jog("X", 10.0, 0.2))
        rig.run(0.1)
        speeds.append(rig.shot.velocity)
    assert speeds == pytest.approx([10.0] * 10, rel=0.02)
    rig.post(StopJog())
    stood = rig.shot.demand[0]
    assert rig.until(MachineState.IDLE) < 0.05
    assert rig.shot.demand[0] - stood < 10.0 * 0.04


def test_reversing_passes_through_standstill() -> None:
    rig = ready()
    rig.post(Jog("X", 40.0, 0.2))
    rig.run(0.15)
    rig.post(Jog("X", -40.0, 0.2))
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()


@pytest.mark.parametrize(
    ("axis", "speed", "limit"), [("X", FAST, 4.0), ("X", -FAST, -4.0), ("Z", 500.0, 6.0)]
)
def test_soft_limits_end_a_jog(axis: str, speed: float, limit: float) -> None:
    rig = ready()
    index = "XZ".index(axis)
    for _ in range(600):
        rig.executor.post(Jog(axis, speed, 0.2))
        rig.tick()
    assert rig.state is MachineState.IDLE
    assert rig.shot.alarms == ()
    assert abs(rig.shot.demand[index] - limit * INCH) < 0.011
    assert abs(rig.shot.demand[index]) < abs(limit) * INCH
    rig.post(Jog(axis, -speed, 0.2))
    rig.until(MachineState.IDLE)
    assert abs(rig.shot.demand[index]) < abs(limit) * INCH - 1.0


def test_jog_is_never_faster_than_the_manual_rapid() -> None:
    rig = ready()
    fastest = []
    rig.watch.append(lambda shot: fastest.append(shot.velocity))
    rig.post(Jog("Z", 500.0, 1.0))
    rig.until(MachineState.IDLE)
    assert max(fastest) == pytest.approx(FAST, rel=0.04)  # the slide swings a little over its setpoint


@pytest.mark.parametrize(
    ("jog", "why"),
    [
        (Jog("B", 1.0, 0.2), text("executor.no-jog-axis", axis="B")),
        (Jog("X", 1.0, 0.0), text("executor.jog-lease")),
        (Jog("X", 1.0, -1.0), text("executor.jog-lease")),
        (Jog("X", math.nan, 0.2), text("executor.jog-lease")),
        (Jog("X", 1.0, math.inf), text("executor.jog-lease")),
    ],
)
def test_invalid_jogs_are_rejected(jog: Jog, why: str) -> None:
    rig = ready()
    rig.post(jog)
    rig.run(0.5)
    assert why in rig.said("refused")[0]
    assert rig.shot.demand == (0.0, 0.0, 0.0)


def test_jog_lease_is_limited_to_one_second() -> None:
    rig = ready()
    rig.post(Jog("X", 1.0, 3600.0))
    assert rig.until(MachineState.IDLE) < 1.2


def test_jog_with_the_drives_off_or_a_cycle_running_is_refused() -> None:
    rig = Rig()
    rig.post(Jog("X", 1.0, 0.2))
    assert "DRIVES OFF" in rig.said("refused")[0]
    rig.start("G90G94F300\nG01F60Z-1\nM00\nM30\n")
    rig.run(0.2)
    rig.post(Jog("X", 10.0, 0.2))
    assert "RUNNING" in rig.said("refused")[1]
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(Jog("X", 10.0, 0.2))
    rig.run(0.5)
    assert "PROGRAM STOP" in rig.said("refused")[2]
    assert rig.shot.demand[0] == 0.0


def test_another_axis_ends_the_jog() -> None:
    rig = ready()
    rig.post(Jog("X", 10.0, 1.0))
    rig.run(0.2)
    rig.post(Jog("Z", 10.0, 1.0))
    assert rig.until(MachineState.IDLE) < 0.1
    assert rig.shot.demand[1] == 0.0
    assert text("executor.being-jogged", axis="X") in rig.said("refused")[0]


@pytest.mark.parametrize("stopper", [FeedHold(), Reset(), StopJog()])
def test_every_stop_command_ends_a_jog(stopper: FeedHold | Reset | StopJog) -> None:
    rig = ready()
    rig.post(Jog("X", 10.0, 1.0))
    rig.run(0.2)
    rig.post(stopper)
    assert rig.until(MachineState.IDLE) < 0.03 + 10.0 / AMAX + 2 * TICK + 0.001


def test_jog_is_rejected_while_the_hold_button_is_pressed() -> None:
    rig = ready()
    rig.sim.machine.press_hold()
    rig.run(0.05)
    rig.post(Jog("X", 10.0, 0.2))
    assert text("executor.hold-pressed") in rig.said("refused")[0]
    assert rig.state is MachineState.IDLE


def test_cycle_start_while_jogging_is_refused() -> None:
    rig = ready()
    rig.load("G90G94F300\nX1\nM30\n")
    rig.run(0.4)
    rig.post(Jog("X", 1.0, 1.0))
    rig.post(CycleStart())
    assert rig.state is MachineState.JOG
    assert rig.shot.start_refusal_reason == text("executor.machine-jogged")


def test_estop_ends_a_jog() -> None:
    rig = ready()
    rig.post(Jog("X", FAST, 1.0))
    rig.run(0.2)
    rig.sim.machine.press_estop()
    rig.tick()
    assert rig.state is MachineState.ESTOP
    rig.run(0.3)
    assert not rig.sim.ports.axes.sample().moving


def test_unhomed_axis_jogs_slowly_and_can_be_homed() -> None:
    rig = Rig(unhomed_machine())
    rig.ready()
    fastest = []
    rig.watch.append(lambda shot: fastest.append(shot.velocity))
    rig.post(Jog("Z", FAST, 0.5))
    rig.until(MachineState.IDLE)
    assert max(fastest) == pytest.approx(0.1 * FAST, rel=0.05)
    rig.post(HomeAxes())
    assert rig.state is MachineState.HOMING
    rig.until(MachineState.IDLE)
    assert rig.shot.homed == (True, True, True)
    assert rig.shot.actual[1] == pytest.approx(0.0, abs=0.002)


def test_invalid_homing_commands_are_rejected() -> None:
    rig = Rig(unhomed_machine())
    rig.post(HomeAxes())
    assert rig.state is MachineState.DISABLED
    rig.post(EnableDrives(), HomeAxes("B"))
    rig.post(HomeAxes("X"))
    assert rig.state is MachineState.IDLE
    why = (
        text("executor.state", state="DRIVES OFF"),
        text("executor.no-home-axis", axis="B"),
        text("executor.all-homed"),
    )
    assert rig.said("refused") == [text("executor.homing", why=each) for each in why]


def test_hold_ends_homing() -> None:
    rig = Rig(unhomed_machine())
    rig.ready()
    rig.post(Jog("Z", -FAST, 0.9))
    rig.until(MachineState.IDLE)
    rig.post(HomeAxes())
    rig.run(0.1)
    rig.post(FeedHold())
    assert rig.state is MachineState.IDLE
    rig.run(0.5)
    assert not rig.shot.homed[1]
    assert not rig.sim.ports.axes.sample().moving


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_axis_beyond_its_travel_jogs_only_back_inside(side: float) -> None:
    rig = Rig()
    edge = next(axis.travel[side > 0] for axis in rig.machine.axes if axis.name == "X" and axis.travel)
    rig.sim.machine.push("X", edge + side * 5.0)  # by hand, the drives off
    rig.run(0.1)
    rig.ready()
    rig.post(Jog("X", side * 20.0, 0.3))
    rig.run(1.0)
    assert rig.sim.machine.get_true_positions()[0] == pytest.approx(edge + side * 5.0, abs=0.01)
    assert not rig.shot.alarms
    for _ in range(3):
        rig.post(JogByStep("X", -side * 2.5, 20.0))
        rig.run(1.0)
    assert not rig.shot.alarms
    assert rig.sim.machine.get_true_positions()[0] == pytest.approx(edge - side * 2.5, abs=0.01)


@pytest.mark.parametrize("release", [StopJog(), DeselectHandwheel()], ids=["jog", "wheel"])
@pytest.mark.parametrize("stop", ["estop", "fault", "mistake"])
def test_late_jog_release_in_a_cut_has_no_effect(stop: str, release: Command) -> None:
    """The jog was ended by the stop, and its release was lost until a program cuts."""
    rig = ready()
    rig.post(Jog("X", FAST, 1.0))
    rig.run(0.1)
    match stop:
        case "estop":
            rig.sim.machine.press_estop()
            rig.run(0.5)
            rig.sim.machine.release_estop()
        case "fault":
            rig.sim.machine.spindle_fault("overvoltage")
            rig.run(0.5)
            rig.sim.machine.spindle_fault("")
        case _:
            rig.executor.handle_failure(ValueError("a mistake"))
    rig.run(1.0)
    for _ in range(2):
        rig.post(Reset())
        rig.run(0.5)
    if rig.state is MachineState.DISABLED:
        rig.ready()
    rig.start("G90G94F300\nX1Z1\nG01X.5Z-1F30\nM30\n")
    rig.until_true(lambda shot: shot.state is MachineState.RUN and not shot.rapid and shot.velocity > 1.0)
    for _ in range(3):
        rig.post(release)
        rig.run(0.1)
    assert rig.state is MachineState.RUN
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
