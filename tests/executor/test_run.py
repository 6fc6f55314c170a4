"""A program runs from Cycle Start to its end: motion, actions, waits, stops, counts."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, FeedHold, Jog, SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.language.source import ProgramSource
from core.motion.axis_limits import MotionLimits
from core.motion.motion_plan import plan_motion
from tests.executor.rig import FINE, INCH, CreepingClock, Rig
from tests.motion.paths import build_path
from tests.texts import text

LINE = "G90G94F300\nG01F60Z-1\nX1\nM30\n"


def test_program_runs_to_the_end_and_counts_the_part() -> None:
    rig = Rig()
    rig.start(LINE)
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(1.0 * INCH, abs=0.006)
    assert rig.shot.actual[1] == pytest.approx(-1.0 * INCH, abs=0.006)
    assert rig.shot.parts == 1
    # two moves of 1 in at 60 in/min and a corner: 2 s and three ramps of v/a = 8.3 ms (corner 90 degrees)
    assert rig.shot.last_cycle == pytest.approx(2.0 + 2 * 0.0083 + 0.03, abs=0.06)
    assert rig.shot.alarms == ()
    assert rig.shot.underruns == 0


def test_displayed_block_is_the_one_in_motion() -> None:
    rig = Rig()
    rig.start(LINE)
    rig.until_true(lambda shot: shot.actual[1] < -0.5 * INCH)
    assert (rig.shot.line, rig.shot.block) == (2, 1)
    assert rig.shot.block_end == pytest.approx((0.0, -INCH, 0.0))
    assert rig.shot.feed == pytest.approx(60 * INCH / 60)
    assert rig.shot.velocity == pytest.approx(INCH, rel=0.02)
    assert not rig.shot.rapid
    rig.until_true(lambda shot: shot.actual[0] > 0.5 * INCH)
    assert (rig.shot.line, rig.shot.block) == (3, 2)


def test_feed_waits_for_the_spindle_and_rapids_do_not() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S3000\nX1\nG01F60Z-1\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == text("executor.at-speed"))
    assert rig.shot.actual[0] == pytest.approx(INCH, abs=0.006)
    assert rig.shot.rpm_actual < 1500
    rig.until_true(lambda shot: shot.actual[1] < -0.001)
    assert rig.shot.rpm_actual == pytest.approx(3000, rel=0.05)
    rig.until(MachineState.IDLE)
    assert rig.shot.rpm_command == 0.0


def test_dwell_and_collet_delays_last_the_configured_time() -> None:
    rig = Rig(every=FINE)
    rig.start("G90G94F300\nG04F1.5\nM13\nM12\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    assert rig.until_true(lambda shot: shot.waiting_for == "COLLET") == pytest.approx(1.5, abs=0.02)
    assert "collet" not in rig.shot.outputs
    # 0.25 s to open and 0.30 s to close, 20 % spread each
    assert rig.until(MachineState.IDLE) == pytest.approx(0.55, abs=0.13)
    assert "collet" in rig.shot.outputs


def test_wait_input_waits_for_its_terminal() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM92\nX1\nM30\n")
    rig.run(3.0)
    assert rig.state is MachineState.WAIT
    assert rig.shot.waiting_for == "TB2-5"
    assert rig.shot.actual[0] == 0.0
    rig.sim.machine.set_input("TB2-5", True)
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(INCH, abs=0.006)


@pytest.mark.parametrize("closed", [True, False])
def test_conditional_branch_reads_its_input_at_execution_time(closed: bool) -> None:
    rig = Rig()
    rig.start("G90G94F300\nG04F1\nM97I10C1P1\nZ-.5\nM30\n}1\nX1\nM99\n")
    rig.run(0.5)
    rig.sim.machine.set_input("10", closed)
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(INCH if closed else 0.0, abs=0.006)
    assert rig.shot.actual[1] == pytest.approx(-0.5 * INCH, abs=0.006)


def test_m00_stops_with_its_message_and_resumes() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S500\nM00(TURN THE PART)\nX1\nM30\n")
    rig.until(MachineState.PROGRAM_STOP)
    assert rig.shot.message == "TURN THE PART"
    rig.run(5.0)
    assert rig.state is MachineState.PROGRAM_STOP
    rig.post(CycleStart())
    assert rig.shot.message == ""
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


@pytest.mark.parametrize("on", [True, False])
def test_m01_stops_only_with_optional_stop(on: bool) -> None:
    rig = Rig()
    rig.post(SetSwitch("optional_stop", on))
    rig.start("G90G94F300\nM01(LOOK)\nX1\nM30\n")
    assert rig.until(MachineState.PROGRAM_STOP, MachineState.IDLE) < 1.0
    assert rig.state is (MachineState.PROGRAM_STOP if on else MachineState.IDLE)
    assert rig.shot.message == ("LOOK" if on else "")


def test_m30_switches_outputs_off_and_m02_leaves_them_on() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S500\nM08\nM25\nX.1\nM02\n")
    rig.until(MachineState.IDLE)
    assert {"coolant", "catcher"} <= rig.shot.outputs
    assert rig.shot.rpm_command == 500
    rig.start("G90G94F300\nX.2\nM30\n")
    rig.until(MachineState.IDLE)
    assert not {"coolant", "catcher"} & rig.shot.outputs
    assert rig.shot.rpm_command == 0
    assert "collet" in rig.shot.outputs
    assert rig.shot.parts == 2


def test_cycle_repeat_restarts_the_program_until_m31() -> None:
    rig = Rig()
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start("G90G94F300\nX.5\nX0\nM30\n")
    rig.until_true(lambda shot: shot.parts == 3)
    assert rig.state is MachineState.RUN
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 4
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start("G90G94F300\nX.5\nX0\nM31\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 5
    assert not rig.shot.cycle_repeat


def test_cycle_time_excludes_program_stops() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM00\nG04F1\nM30\n")
    rig.until(MachineState.PROGRAM_STOP)
    rig.run(30.0)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.last_cycle == pytest.approx(1.0, abs=0.05)


def test_css_speed_follows_the_radius() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG77S2500\nX1\nM03G96S250\nG01F30X.25\nM30\n")
    rig.until_true(lambda shot: shot.line == 5 and shot.actual[0] < 0.75 * INCH)
    # rpm = 250 ft/min * 12 / (2 pi r), r in inches
    radius = rig.shot.demand[0] / INCH
    assert rig.shot.rpm_command == pytest.approx(250 * 12 / (2 * 3.14159265 * radius), rel=0.01)
    rig.until_true(lambda shot: shot.actual[0] < 0.26 * INCH)
    assert rig.shot.rpm_command == pytest.approx(1910, rel=0.04)


def test_feed_per_rev_follows_the_spindle_override() -> None:
    rig = Rig()
    rig.sim.machine.set_spindle_pot(0.5)
    rig.start("G90G94F300\nM03S1000\nG95F.01Z-1\nM30\n")
    rig.until_true(lambda shot: shot.actual[1] < -0.3 * INCH)
    assert rig.shot.rpm_actual == pytest.approx(500, rel=0.01)
    # .01 in/rev at 500 rpm is 5 in/min
    assert rig.shot.velocity == pytest.approx(5 * INCH / 60, rel=0.05)


def test_long_program_of_short_moves_maintains_its_feed() -> None:
    rig = Rig()
    moves = "".join(f"Z-{0.002 * k:.4f}\n" for k in range(1, 1501))
    rig.start("G90G94F300\nG01F100\n" + moves + "M30\n")
    took = rig.until(MachineState.IDLE)
    assert took == pytest.approx(3.0 / 100 * 60, abs=0.15)  # 3 in at 100 in/min
    assert rig.shot.underruns == 0


def test_error_caused_by_a_live_input_stops_the_run() -> None:
    rig = Rig()
    rig.sim.machine.set_input("10", True)
    rig.start("G90G94F300\nX.5\nM97I10C1P1\nM30\n}1\nM97I10C1P1\nM99\n")
    rig.until(MachineState.FAULT)
    alarm = rig.shot.alarms[0]
    assert (alarm.code, alarm.line) == ("program", 6)
    assert rig.shot.actual[0] == pytest.approx(0.5 * INCH, abs=0.006)
    assert rig.shot.parts == 0


def test_a_block_beyond_the_travel_is_not_begun() -> None:
    rig = Rig()
    rig.start("G90G94F300\nX1\nX4.5\nM30\n")
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "travel"
    assert "X" in rig.shot.alarms[0].cause
    assert rig.shot.actual[0] <= INCH + 0.006


def test_feed_per_rev_with_a_stopped_spindle_moves_nothing() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG95F.01Z-1\nM30\n")
    rig.until(MachineState.FAULT)
    assert rig.shot.actual[1] == 0.0
    assert rig.shot.alarms[0].code in {"spindle-still", "program"}


def test_continuously_advancing_clock_does_not_affect_the_run() -> None:
    rig = Rig(clock_kind=CreepingClock)
    rig.start("G90G94F300\nM03S1000\nX1Z-1\nG01F100X2\nZ-2\nG04F.2\nX0Z0\nM30\n")
    for wait in (0.2, 1.5, 0.4):
        rig.run(wait)
        rig.post(FeedHold())
        rig.until(MachineState.HOLD, limit=1.0)
        rig.run(0.4)
        rig.post(SetFeedOverride(0.8), CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    assert rig.shot.demand[:2] == pytest.approx((0.0, 0.0), abs=1e-6)
    rig.post(Jog("X", 10.0, 0.2))
    rig.until(MachineState.IDLE, limit=1.0)


def test_piecewise_planned_run_equals_the_path_planned_at_once() -> None:
    """Planned piece by piece with a second of look-ahead, played as if planned at once."""
    zigzag = "".join(f"X{0.02 * k:.4f}Z-{0.01 * k + 0.1 * (k // 5 % 2):.4f}\n" for k in range(1, 150))
    text = f"G90G94F300\nG01F100\n{zigzag}G02X3.2Z-2R.4\nG01X3.5Z-1\nX0Z0\nX1\nX2Z-1\nM30\n"
    rig = Rig()
    setup = create_power_up_setup(rig.machine, tool_offsets={}, secondary_offsets={})
    blocks = Interpreter(read_program(ProgramSource("PART", text)), setup).generate_blocks()
    whole = plan_motion(
        build_path(
            [block for block in blocks if block.moves],
            MotionLimits.from_axes(rig.machine.axes, rig.machine.timing.setpoint_duration_s),
        )
    )
    rig.start(text)
    began = rig.clock.now() + rig.machine.timing.commit_time_s
    furthest = 0.0
    while rig.state is not MachineState.IDLE:
        rig.tick()
        there = rig.sim.ports.axes.demand_at(rig.clock.now())[0]
        wanted = whole.compute_positions(rig.clock.now() - began)[0]
        furthest = max(furthest, *(abs(a - b) for a, b in zip(there, wanted, strict=True)))
    assert rig.shot.parts == 1
    assert furthest < 1e-4


def test_next_block_text_differs_from_the_current_block() -> None:
    rig = Rig()
    rig.start("G90G94F300\nX1\nG04F1\nX0\nX1\nM30\n")
    rig.until_true(lambda shot: shot.line == 2 and shot.state is MachineState.RUN)
    assert rig.shot.next_block_text == "G04F1"
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    assert (rig.shot.block_text, rig.shot.next_block_text) == ("G04F1", "")  # read once the dwell is over
    rig.until_true(lambda shot: shot.line == 4)
    assert rig.shot.next_block_text == "X1"
