"""What goes wrong on the wire and in the controller: stopped, told once, and nothing goes on by itself."""

from __future__ import annotations

import pytest

from core.executor.commands import EnableDrives, HomeAxes, Reset, SetFeedOverride
from core.executor.snapshot import MachineState
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky
from tests.drivers.grblhal.test_run import LONG
from tests.texts import shows

UNHOMED = (
    (
        "absolute = true                 # false",
        "home = { order = 2, speed = 60 }\nabsolute = false  # false",
    ),
    ("absolute = true\n\n[axis.C]", "absolute = false\nhome = { order = 1, speed = 60 }\n\n[axis.C]"),
)
THREAD = "G90G94F300\nM03S600\nX.5Z.2\nX.25\nG33X.2Z-.5I.025K.05\nG00Z1\nM30\n"


def cutting(bench: GrblBench) -> GrblBench:
    """In the long feed of ``LONG``."""
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(0.5)
    return bench


def clear(bench: GrblBench) -> None:
    """Reset, and drives on again."""
    bench.until_true(lambda _: not bench.machine.axes.sample().moving, 5.0)
    bench.post(Reset())
    bench.run(1.0)
    bench.post(EnableDrives())
    bench.run(0.1)


def test_controller_reset_ends_the_cycle_and_retains_the_x_mode() -> None:
    bench = cutting(GrblBench())
    bench.peer.reset()
    bench.until(MachineState.FAULT, limit=1.0)
    assert "reset" in bench.alarms()
    at = bench.peer.motion.position
    done = list(bench.peer.program.executed_lines)
    bench.run(2.0)
    assert bench.peer.motion.position == at
    assert bench.peer.program.executed_lines == done
    bench.post(Reset())
    bench.run(1.5)
    assert bench.peer.alarm_number == 0
    assert bench.peer.program.modes.plane == "G18"
    assert bench.shot.demand[0] == pytest.approx(at[0], abs=0.001)  # radius, not diameter
    assert bench.state is MachineState.DISABLED
    assert not all(bench.shot.homed)  # it was reset while it moved: ALARM:3


def test_persistent_error_is_reported_once_and_later_lines_do_not_run() -> None:
    bench = cutting(GrblBench())
    done = len(bench.peer.program.executed_lines)
    bench.peer.program.last_error = 33  # as a line that it refuses leaves it
    bench.until(MachineState.FAULT, limit=1.0)
    assert len(bench.shot.alarms) == 1
    assert "error:33" in bench.alarms()
    bench.run(1.0)
    assert len(bench.peer.program.executed_lines) <= done + 1
    assert len([text for text in bench.said("alarm") if "error:33" in text]) == 1
    assert not bench.peer.motion.block_queue


@pytest.mark.parametrize("damage", [b"o", b"k", b"o*", b"okok", b"\xffk"])
def test_damaged_reply_stops_motion_and_does_not_change_the_position(damage: bytes) -> None:
    bench = cutting(GrblBench())
    bench.peer.behavior.garbled_replies.append(damage)
    bench.until(MachineState.FAULT, limit=1.0)
    assert shows(bench.alarms(), "drivers.grblhal-interference")
    bench.until_true(lambda _: not bench.peer.motion.is_moving, 1.0)
    bench.run(1.0)
    assert bench.shot.actual[:2] == pytest.approx(bench.peer.motion.position, abs=0.001)
    assert not bench.peer.motion.block_queue


def test_missing_reply_raises_an_alarm() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nX.5Z.2\nM30\n")
    bench.until(MachineState.IDLE)
    bench.run(0.4)
    bench.peer.behavior.garbled_replies.append(b"")
    bench.start("G90G94F300\nX.3Z.2\nM30\n")
    bench.until(MachineState.FAULT, limit=5.0)
    (alarm,) = bench.shot.alarms
    assert alarm.code == "controller-silent"
    assert "'N2G0X7.62Z5.08'" in alarm.detail


def test_jump_in_the_reported_position_is_rejected() -> None:
    bench = cutting(GrblBench())
    before = bench.shot.actual[0]
    bench.peer.send_text("<Run|MPos:-18542.000,0.000,0.000|FS:0,0,0>\r\n")
    bench.until(MachineState.FAULT, limit=1.0)
    assert bench.shot.actual[0] == pytest.approx(before, abs=1.0)


def test_controller_that_was_delayed_recovers_without_an_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its own computer held it up for a quarter of a second; what it reports then is confirmed at once."""
    bench = GrblBench()
    bench.start("G90G94F300\nX3Z-3\nX0Z0\nX3Z-3\nX0Z0\nM30\n")
    bench.until_true(lambda shot: shot.velocity > 125.0)
    for _ in range(4):
        with monkeypatch.context() as held_up:
            held_up.setattr(bench.peer, "advance", lambda: None)
            bench.run(0.25)
        bench.run(0.2)
    bench.until(MachineState.IDLE)
    assert bench.shot.alarms == ()


def test_silent_controller_is_reported() -> None:
    bench = cutting(GrblBench())
    bench.peer.behavior.sends_nothing = True
    took = bench.until(MachineState.FAULT, limit=3.0)
    assert took < 1.4
    assert [alarm.code for alarm in bench.shot.alarms] == ["controller-silent"]


def test_controller_without_its_host_runs_only_its_queued_blocks() -> None:
    bench = cutting(GrblBench())
    z = bench.peer.motion.position[1]
    bench.wire.cut = True
    bench.clock.advance(10.0)  # nobody ticks any more
    bench.peer.advance()
    assert not bench.peer.motion.block_queue
    assert abs(bench.peer.motion.position[1] - z) < 12.7 * 0.9  # of 50 mm that the block still had


def test_estop_at_the_controller_stops_all_and_is_cleared() -> None:
    bench = cutting(GrblBench())
    bench.peer.active_pins = "E"
    bench.peer.raise_alarm(10)
    bench.until(MachineState.ESTOP, limit=1.0)
    bench.run(1.0)
    assert bench.shot.rpm_command == 0.0
    bench.peer.active_pins = ""
    bench.run(1.0)
    assert bench.state is not MachineState.RUN
    bench.post(Reset())
    bench.run(2.0)
    assert bench.state is MachineState.DISABLED
    assert bench.peer.alarm_number == 0
    assert bench.peer.programmed_rpm == 0.0


@pytest.mark.parametrize("alarm", [10, 17])
def test_alarm_in_motion_loses_the_position(alarm: int) -> None:
    """The firmware says ALARM:3 for a reset in motion, and of E-stop and motor fault nothing of the place."""
    bench = cutting(GrblBench())
    bench.peer.raise_alarm(alarm)
    bench.until(MachineState.FAULT, limit=1.0)
    clear(bench)
    assert not any(bench.shot.homed[:2])
    bench.load(LONG)
    bench.press()
    assert "homed" in bench.shot.start_refusal_reason
    for axis in "XZ":
        bench.post(HomeAxes(axis))
        bench.until(MachineState.IDLE)
    assert all(bench.shot.homed[:2])


@pytest.mark.parametrize("alarm", [10, 17])
def test_alarm_at_rest_retains_the_position(alarm: int) -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nX.5\nM30\n")
    bench.until(MachineState.IDLE)
    bench.peer.raise_alarm(alarm)
    bench.until(MachineState.FAULT, limit=1.0)
    clear(bench)
    assert all(bench.shot.homed[:2])


def test_output_switched_off_by_estop_is_not_reported_as_disturbed() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nM08\nG01X1F30\nM30\n")
    bench.until_true(lambda shot: shot.line == 3)
    bench.run(1.5)
    bench.peer.active_pins = "E"
    bench.peer.output_states["flood"] = False
    bench.peer.raise_alarm(10)
    bench.until(MachineState.ESTOP, limit=1.0)
    assert not bench.said("disturbed")
    assert not bench.said("stop")


def test_feed_per_rev_with_a_stopped_spindle_waits_in_planner_until_reset() -> None:
    """The simulator's own habit, and that the recovery gets rid of it."""
    bench = GrblBench()
    bench.ready()
    bench.peer.receive_bytes(b"G95\nG1X5F.1\n")
    bench.clock.advance(0.3)  # before anybody looks
    bench.peer.advance()
    assert bench.peer.alarm_number == 14
    assert bench.peer.motion.block_queue
    bench.until(MachineState.FAULT, limit=1.0)
    clear(bench)
    assert bench.peer.alarm_number == 0
    assert not bench.peer.motion.block_queue
    assert bench.peer.program.modes.feed_mode == "G94"


def test_controller_that_requires_homing_is_homed_axis_by_axis() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED), quirky(homing=True))
    bench.ready()
    bench.run(0.5)
    bench.load("G90G94F300\nX.3\nM30\n")
    bench.press()
    assert "homed" in bench.shot.start_refusal_reason
    bench.post(HomeAxes())
    bench.until(MachineState.IDLE, limit=10.0)
    assert all(bench.shot.homed)
    assert [line for line in bench.wire.lines() if line.startswith("$H")] == ["$HZ", "$HX"]
    assert bench.peer.program.modes.plane == "G18"
    bench.run(0.4)
    bench.press()
    bench.until(MachineState.RUN, limit=1.0)
    bench.until(MachineState.IDLE)
    assert bench.shot.parts == 1


def test_homing_that_the_controller_does_not_support_is_reported() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED))
    bench.ready()
    bench.run(0.5)
    bench.machine.axes.home("X")
    bench.until(MachineState.FAULT, limit=2.0)
    assert "$22" in bench.alarms()
    assert "method 37" in bench.alarms()
    assert not bench.shot.homed[0]


def test_override_that_the_controller_ignores_is_an_alarm() -> None:
    bench = GrblBench(quirks=quirky(stubborn=True))
    bench.start("G90G94F300\nX.5Z.2\nG01Z-2F10\nM30\n")
    bench.until_true(lambda shot: shot.line == 3)
    bench.post(SetFeedOverride(0.5))
    bench.until(MachineState.FAULT, limit=13.0)
    assert "override" in bench.alarms()


def test_endless_line_is_reported_as_interference() -> None:
    bench = cutting(GrblBench())
    bench.peer.send_text("x" * 1500)
    bench.until(MachineState.FAULT, limit=1.0)
    assert shows(bench.alarms(), "drivers.grblhal-interference")
