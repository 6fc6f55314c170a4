"""A step is exactly its length; and the known accidents of hand moves, as the executor meets them."""

from __future__ import annotations

import dataclasses
import math
import re

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import (
    CycleStart,
    EnableDrives,
    FeedHold,
    HomeAxes,
    Jog,
    JogByStep,
    Reset,
    StopJog,
)
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from tests.executor.rig import INCH, TICK, Rig, unhomed_machine
from tests.texts import pattern, text

AMAX = 120 * INCH
SPEED = 20 * INCH / 60
FAST = 100 * INCH / 60


def ready(machine: Machine | None = None) -> Rig:
    rig = Rig(machine) if machine else Rig()
    rig.ready()
    return rig


def nothing_homed() -> Machine:
    """A lathe that only counts: Z is homed before X."""
    machine = load_machine()
    x, z, *rest = machine.axes
    x = dataclasses.replace(x, is_position_absolute=False, home_speed=20.0, home_order=2)
    z = dataclasses.replace(z, is_position_absolute=False, home_speed=20.0, home_order=1)
    return dataclasses.replace(machine, axes=(x, z, *rest))


# --- steps -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("inches", [0.1, 0.01, 0.001, 0.0001, 0.00005])
@pytest.mark.parametrize(("axis", "sign"), [("X", 1), ("X", -1), ("Z", 1), ("Z", -1)])
def test_a_step_is_exactly_its_length_and_ends_at_rest(axis: str, sign: int, inches: float) -> None:
    rig = ready()
    rig.post(JogByStep(axis, sign * inches * INCH, SPEED))
    rig.until(MachineState.IDLE)
    index = "XZ".index(axis)
    assert rig.shot.demand[index] == pytest.approx(sign * inches * INCH, abs=1e-9)
    assert rig.shot.demand[1 - index] == 0.0
    rig.run(0.2)
    assert not rig.sim.ports.axes.sample().moving
    assert rig.shot.actual[index] == pytest.approx(sign * inches * INCH, abs=0.00127)


def test_ten_steps_move_ten_lengths_in_the_expected_time() -> None:
    rig = ready()
    for _ in range(10):
        rig.post(JogByStep("Z", -0.001 * INCH, SPEED))
        rig.until(MachineState.IDLE)
    assert rig.shot.demand[1] == pytest.approx(-0.01 * INCH, abs=1e-9)
    rig.post(JogByStep("Z", 0.1 * INCH, SPEED))
    # way/v + v/a, and what is queued already
    assert rig.until(MachineState.IDLE) == pytest.approx(2.54 / SPEED + SPEED / AMAX + 0.03, abs=2 * TICK)


def test_c_steps_in_degrees() -> None:
    rig = ready()
    rig.post(JogByStep("C", 1.0, 90.0))
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[2] == pytest.approx(1.0, abs=1e-9)


def test_running_step_rejects_the_next_and_continues() -> None:
    rig = ready()
    rig.post(JogByStep("X", 2.54, SPEED))
    rig.run(0.1)
    rig.post(JogByStep("X", 2.54, SPEED))
    assert text("executor.step-not-over", axis="X") in rig.said("refused")[0]
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] == pytest.approx(2.54, abs=1e-9)


@pytest.mark.parametrize(
    ("step", "why"),
    [
        (JogByStep("B", 0.1, SPEED), pattern("executor.no-jog-axis", axis="B")),
        (JogByStep("X", 0.0, SPEED), pattern("executor.step-length", limit="2.54")),
        (JogByStep("X", 2.6, SPEED), pattern("executor.step-length", limit="2.54", length="2.6")),
        (JogByStep("X", math.nan, SPEED), pattern("executor.step-length", limit="2.54")),
        (JogByStep("X", math.inf, SPEED), pattern("executor.step-length", limit="2.54")),
        (JogByStep("X", 0.1, 0.0), pattern("executor.step-speed")),
        (JogByStep("X", 0.1, math.nan), pattern("executor.step-speed")),
    ],
)
def test_invalid_steps_are_rejected(step: JogByStep, why: str) -> None:
    rig = ready()
    rig.post(step)
    rig.run(0.3)
    assert re.search(why, rig.said("refused")[0])
    assert rig.shot.demand == (0.0, 0.0, 0.0)


def test_step_beyond_the_travel_is_rejected_entirely() -> None:
    rig = ready()
    for _ in range(600):
        rig.executor.post(Jog("X", FAST, 0.2))
        rig.tick()
    before = rig.shot.demand[0]
    rig.post(JogByStep("X", 0.0254, SPEED))
    assert rig.state is MachineState.IDLE
    assert rig.said("refused")[-1] == text(
        "executor.jog", why=text("executor.travel-end", axis="X", sign="+")
    )
    assert rig.shot.demand[0] == before
    rig.post(JogByStep("X", -0.0254, SPEED))
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] == pytest.approx(before - 0.0254, abs=1e-9)


def test_jog_at_the_travel_limit_is_reported() -> None:
    rig = ready()
    for _ in range(600):
        rig.executor.post(Jog("Z", -500.0, 0.2))
        rig.tick()
    assert set(rig.said("refused")) == {
        text("executor.jog", why=text("executor.travel-end", axis="Z", sign="−"))
    }


@pytest.mark.parametrize("stopper", [StopJog(), FeedHold(), Reset()])
def test_stopped_step_is_reported_as_cut_short(stopper: StopJog | FeedHold | Reset) -> None:
    rig = ready()
    rig.post(JogByStep("X", 2.54, SPEED))
    rig.run(0.1)
    rig.post(stopper)
    assert rig.until(MachineState.IDLE) < 0.03 + SPEED / AMAX + 2 * TICK + 0.001
    assert 0.0 < rig.shot.demand[0] < 2.5
    assert rig.said("refused") == [text("executor.step-cut-short", axis="X")]


def test_step_completes_when_the_host_dies() -> None:
    rig = ready()
    rig.post(JogByStep("X", 2.54, SPEED))
    rig.clock.advance(5.0)
    sample = rig.sim.ports.axes.sample()
    assert not sample.moving
    assert sample.demand[0] == pytest.approx(2.54, abs=1e-9)


# --- two things at once ------------------------------------------------------------------------------------


def test_step_during_a_jog_ends_both() -> None:
    rig = ready()
    rig.post(Jog("X", 10.0, 1.0))
    rig.run(0.1)
    rig.post(JogByStep("X", 0.1, SPEED))
    assert rig.until(MachineState.IDLE) < 0.1
    assert text("executor.moving", what="X") in rig.said("refused")[0]


def test_jog_during_a_step_ends_the_step() -> None:
    rig = ready()
    rig.post(JogByStep("X", 2.54, SPEED))
    rig.run(0.1)
    rig.post(Jog("Z", 10.0, 0.2))
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] < 2.5
    assert rig.shot.demand[1] == 0.0
    assert rig.said("refused") == [
        text("executor.jog", why=text("executor.on-step", axis="X")),
        text("executor.step-cut-short", axis="X"),
    ]


def test_another_axis_can_be_jogged_after_estop_in_a_jog() -> None:
    rig = ready()
    rig.post(Jog("X", 10.0, 1.0))
    rig.run(0.1)
    rig.sim.machine.press_estop()
    rig.run(0.5)
    rig.sim.machine.release_estop()
    rig.run(0.1)
    rig.post(EnableDrives())
    rig.post(Jog("Z", 10.0, 0.2))
    assert rig.state is MachineState.JOG
    assert rig.said("refused") == []


def test_a_late_step_is_refused() -> None:
    rig = ready()
    rig.executor.post(JogByStep("X", 0.1, SPEED))
    rig.clock.advance(0.6)
    rig.executor.run_tick()
    rig.run(0.2)
    assert rig.shot.demand[0] == 0.0
    assert text("executor.came-too-late", command="JogByStep") in rig.said("refused")[0]


@pytest.mark.parametrize("command", [Jog("X", 10.0, 0.2), JogByStep("X", 0.1, SPEED)])
def test_jog_step_is_rejected_while_a_program_runs(command: Jog | JogByStep) -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F60Z-1\nM00\nM30\n")
    rig.run(0.2)
    rig.post(command)
    assert rig.said("refused") == [text("executor.no-jog", state="RUNNING")]
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(command)
    rig.run(0.3)
    assert rig.shot.demand[0] == 0.0


def test_c_is_not_jogged_while_the_spindle_turns() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S500\nM02\n")
    rig.until(MachineState.IDLE)
    rig.run(0.5)
    assert rig.shot.rpm_actual > 100
    rig.post(Jog("C", 90.0, 0.2))
    assert rig.said("refused") == [text("executor.jog", why=text("executor.c-is-spindle"))]
    assert rig.shot.alarms == ()
    rig.post(JogByStep("X", 0.254, SPEED))  # touching off on a turning part
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] == pytest.approx(0.254, abs=1e-9)


# --- a machine that does not know where it is ---------------------------------------------------------------


def test_unhomed_machine_allows_slow_jogs_and_rejects_programs() -> None:
    rig = ready(nothing_homed())
    fastest: list[float] = []
    rig.watch.append(lambda shot: fastest.append(shot.velocity))
    rig.post(JogByStep("Z", 2.54, FAST))
    rig.until(MachineState.IDLE)
    assert max(fastest) == pytest.approx(0.1 * FAST, rel=0.05)
    rig.load("G90G94F300\nX1Z1\nM30\n")
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.not-homed", axes="X, Z")


def test_homing_follows_the_axis_order() -> None:
    rig = ready(nothing_homed())
    order: list[tuple[bool, ...]] = []
    rig.watch.append(lambda shot: order.append(tuple(shot.homed[:2])))
    rig.post(HomeAxes())
    rig.until(MachineState.IDLE)
    assert list(dict.fromkeys(order)) == [(False, False), (False, True), (True, True)]


def test_single_axis_can_be_homed() -> None:
    rig = ready(nothing_homed())
    rig.post(HomeAxes("X"))
    rig.until(MachineState.IDLE)
    assert rig.shot.homed[:2] == (True, False)


@pytest.mark.parametrize(
    "command", [Jog("Z", 5.0, 0.2), JogByStep("Z", 0.1, SPEED), HomeAxes(), CycleStart()]
)
def test_other_motion_is_rejected_while_homing(command: Jog | JogByStep | HomeAxes | CycleStart) -> None:
    rig = ready(unhomed_machine())
    rig.post(Jog("Z", -5.0, 0.9))
    rig.until(MachineState.IDLE)
    rig.post(HomeAxes())
    rig.run(0.05)
    rig.post(command)
    assert rig.state is MachineState.HOMING
    assert rig.said("refused")
