"""Faults of machine and host: each with its reaction, and within its time."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import Command, CycleStart, EnableDrives, FeedHold, HomeAxes, Reset, SetSwitch
from core.executor.safety.watchdog import ExecutorThread
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.actions import ColletSwitch, Dwell, SpindleRun
from core.machine.machine_model import Machine
from core.ports import ALL_UNKNOWN_PARTS, StationState
from drivers.wakeups import RealClock
from tests.executor.made import Maker
from tests.executor.rig import FINE, INCH, Rig, unhomed_machine
from tests.texts import text

pytestmark = pytest.mark.long

LONG = "G90G94F300\nX3Z-4\nX0Z0\nX3Z-4\nX0Z0\nM30\n"
BUSY = "G90G94F300\nM03S1000\nM08\nM25\nX1\nG01F20Z-1\nG02X1.5Z-1.5I1.5K-1\nG04F1\nM13\nM12\nX0Z0\nM30\n"


def alarm(rig: Rig, code: str, limit: float = 20.0) -> float:
    """Run into an alarm and check what every alarm means."""
    took = rig.until(MachineState.FAULT, limit=limit)
    assert rig.shot.alarms[0].code == code
    assert rig.shot.rpm_command == 0.0
    assert not {"coolant", "catcher", "live1"} & rig.shot.outputs
    assert rig.said("alarm")
    rig.run(0.2)
    stood = rig.shot.demand
    rig.run(2.0)
    assert rig.shot.demand == stood
    assert rig.state is MachineState.FAULT
    return took


def test_estop_after_station_poll_is_not_reported_as_power_loss(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F20Z-2\nM30\n")
    rig.run(1.0)
    station = rig.sim.ports.station
    look = station.read_state

    def pressed_behind() -> StationState:
        seen = look()
        rig.sim.machine.press_estop()
        return seen

    monkeypatch.setattr(station, "read_state", pressed_behind)
    rig.tick()
    monkeypatch.undo()
    rig.run(1.0)
    assert rig.state is MachineState.ESTOP
    assert rig.shot.alarms == ()
    assert rig.said("alarm") == []


# --- host ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stall", [0.5, 5.0])
def test_stalled_host_leaves_the_axes_on_the_path_without_a_fault(stall: float) -> None:
    rig = Rig()
    text = "G90G94F300\nG01F300\n" + "X3Z-4\nX0Z0\n" * 10 + "M30\n"
    rig.start(text)
    rig.run(0.5)
    began = rig.clock.now()
    off = 0.0
    while rig.clock.now() < began + stall:  # the axes go on, nobody ticks
        rig.clock.advance(0.005)
        x, z, _ = rig.sim.ports.axes.sample().demand
        off = max(off, abs(4 * x + 3 * z) / 5)
    rig.run(0.1)
    assert off < 0.005
    assert rig.shot.alarms == ()
    assert any(re.search(r"[0-9.]+ s$", said) for said in rig.said("starved"))
    if stall > 2:
        assert rig.state is MachineState.HOLD
        assert rig.shot.stop is not None
        assert rig.shot.stop.code == "low-queue"
        assert rig.shot.underruns == 1
        rig.run(1.0)
        assert rig.state is MachineState.HOLD
        rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.shot.demand[:2] == pytest.approx((0.0, 0.0), abs=1e-6)


def test_stalled_host_in_one_long_move_also_stops() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F5Z-5\nM30\n")
    rig.run(1.0)
    rig.clock.advance(10.0)
    at = rig.sim.ports.axes.sample()
    assert not at.moving
    # 1.25 s queued and a little braking: nowhere near the 5 in of the block
    assert -at.actual[1] < 5 * INCH / 60 * 3.0
    rig.run(0.1)
    assert rig.state is MachineState.HOLD
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, limit=90)
    assert rig.shot.demand[1] == pytest.approx(-5 * INCH)


STEPS = "G90G94F300\nG01F60\nZ-.2\nX.2\nZ-3\nM30\n"  # an inch a second: .2 s, .2 s, 2.8 s


def test_late_host_shows_the_block_in_which_the_axes_stopped() -> None:
    """Not the one that was played when it was last there: line, way to go and path would be of another."""
    rig = Rig()
    rig.start(STEPS)
    rig.until_true(lambda shot: shot.line == 3)
    rig.clock.advance(10.0)
    assert not rig.sim.ports.axes.sample().moving
    rig.run(0.1)
    assert rig.state is MachineState.HOLD
    assert rig.shot.underruns == 1
    x, z, _ = rig.shot.actual
    assert x == pytest.approx(0.2 * INCH, abs=0.001)
    assert z < -0.3 * INCH  # so it is the last way that they have begun
    assert (rig.shot.line, rig.shot.block_text) == (5, "Z-3")
    assert rig.shot.block_end[:2] == pytest.approx((0.2 * INCH, -3 * INCH))
    assert [event.line_number for event in rig.events if event.kind == "stop"][-1:] == [5]
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


@pytest.mark.parametrize(
    ("pressed", "state"), [(FeedHold(), MachineState.HOLD), (Reset(), MachineState.IDLE)]
)
def test_stop_pressed_while_the_host_was_away_shows_the_stopped_block(
    pressed: Command, state: MachineState
) -> None:
    rig = Rig()
    rig.start(STEPS)
    rig.until_true(lambda shot: shot.line == 3)
    rig.clock.advance(10.0)
    rig.post(pressed)
    rig.until(state)
    assert rig.shot.line == (5 if state is MachineState.HOLD else 0)
    left = rig.notes[-1]  # what SEARCHTO is offered with, after a power cut too
    assert left is not None
    assert left.line == 5


def test_late_host_after_a_hold_shows_the_stopped_block() -> None:
    rig = Rig(every=FINE)
    rig.start("G90G94F300\nG01F200\nZ-1.2\nX1.2Z-2.4\nM30\n")
    rig.until_true(lambda shot: shot.line == 3 and shot.actual[1] < -1.17 * INCH)
    rig.post(FeedHold())
    assert (rig.state, rig.shot.line) == (MachineState.STOPPING, 3)
    rig.clock.advance(10.0)
    rig.tick()
    assert rig.state is MachineState.HOLD
    assert rig.shot.actual[0] > 0.01 * INCH
    assert rig.shot.line == 4


class BrokenError(Exception):
    """Something nobody thought of."""


def test_an_exception_in_the_worker_stops_the_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    rig.start(BUSY)
    rig.run(3.0)
    assert rig.shot.rpm_actual > 900

    def burst() -> None:
        raise BrokenError("at the worst moment")

    monkeypatch.setattr(rig.executor, "_go_on", burst)
    alarm(rig, "internal")
    assert "BrokenError: at the worst moment" in rig.shot.alarms[0].detail
    assert "BrokenError" not in rig.shot.alarms[0].cause  # that is for the log
    assert not rig.sim.ports.axes.sample().enabled


def test_dead_driver_raises_an_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    rig.start(LONG)
    rig.run(0.5)

    def dead() -> None:
        raise BrokenError("cable")

    monkeypatch.setattr(rig.sim.ports.axes, "sample", dead)
    rig.tick()
    assert rig.state is MachineState.FAULT
    assert rig.shot.alarms[0].code == "internal"


def test_executor_thread_ticks_and_turns_everything_off_at_exit() -> None:
    rig = Rig()
    clock = RealClock()
    thread = ExecutorThread(rig.executor, clock, tick=0.001)
    rig.executor.post(EnableDrives())
    thread.start()
    while rig.executor.snapshot.state is not MachineState.IDLE:
        clock.sleep_until(clock.now() + 0.001)
    assert thread.is_alive
    thread.close()
    assert not thread.is_alive
    assert rig.executor.snapshot.state is MachineState.DISABLED


# --- axes ---------------------------------------------------------------------------------------------------


def test_jammed_axis_stops_the_machine() -> None:
    rig = Rig()
    rig.start(LONG)
    rig.run(0.4)
    rig.sim.machine.jam("X")
    # window .08 in at 3 in/s in X, 20 ms, one tick
    assert alarm(rig, "following") < 0.0267 + 0.02 + 0.03
    assert rig.shot.alarms[0].cause.startswith("X: ")
    assert not rig.sim.ports.axes.sample().enabled
    rig.sim.machine.jam("X", False)
    rig.post(Reset())
    assert rig.state is MachineState.DISABLED
    rig.run(1.0)
    assert rig.state is MachineState.DISABLED
    rig.post(EnableDrives())
    assert rig.state is MachineState.IDLE
    assert rig.shot.block == 0


def test_frozen_encoder_and_drive_fault_stop_the_machine() -> None:
    breaks: tuple[tuple[Callable[[Rig], None], str], ...] = (
        (lambda rig: rig.sim.machine.encoder_stuck("Z"), "following"),
        (lambda rig: rig.sim.machine.drive_fault("Z", "overcurrent"), "axis"),
    )
    for break_it, code in breaks:
        rig = Rig()
        rig.start(LONG)
        rig.run(0.4)
        break_it(rig)
        alarm(rig, code)
        assert rig.shot.alarms[0].cause.startswith("Z: ")


def test_reset_does_not_clear_a_fault_that_stays() -> None:
    rig = Rig()
    rig.start(LONG)
    rig.run(0.4)
    rig.sim.machine.jam("X")
    alarm(rig, "following")
    rig.post(Reset())
    rig.post(EnableDrives())
    rig.load("G90G94F300\nG01F30X-3\nM30\n")
    rig.run(0.4)
    rig.confirm()
    rig.post(CycleStart())
    alarm(rig, "encoder-still")  # a rapid would trip the drive in the same tick


# --- spindle and collet -------------------------------------------------------------------------------------


def test_spindle_that_does_not_reach_speed_raises_an_alarm() -> None:
    rig = Rig()
    rig.sim.machine.spindle_bog(0.6)
    rig.start("G90G94F300\nM03S1000\nX1\nG01F10Z-1\nM30\n")
    assert alarm(rig, "at-speed") == pytest.approx(5.4, abs=0.3)
    assert rig.shot.actual[1] == 0.0


@pytest.mark.parametrize("code", ["G95F.005", "G94F5"])
def test_bogged_spindle_holds_the_feed_and_resume_waits_for_speed(code: str) -> None:
    rig = Rig()
    rig.start(f"G90G94F300\nM03S1000\nG01{code}Z-1\nM30\n")
    rig.run(3.0)
    rig.sim.machine.spindle_bog(0.4)
    rig.run(1.5)
    assert rig.state is MachineState.HOLD
    assert rig.shot.waiting_for == text("executor.below-half-speed")
    at = rig.shot.actual
    rig.post(CycleStart())
    rig.until(MachineState.HOLD, limit=rig.machine.spindle.timeout_s + 1.0)
    assert rig.shot.waiting_for == text("executor.not-at-speed")
    assert rig.shot.actual == at
    rig.sim.machine.spindle_bog(1.0)
    rig.run(2.0)
    rig.post(CycleStart())
    assert rig.state is MachineState.RUN


def test_raising_spindle_override_in_feed_per_minute_cut_causes_no_hold() -> None:
    """A drive that runs up as fast as it can obeys: only one that does not is a fault."""
    rig = Rig()
    rig.sim.machine.set_spindle_pot(0.1)
    rig.start("G90G94F300\nM03S3000\nG01F1Z-1\nM30\n")
    rig.until_true(lambda shot: shot.actual[1] < -0.1)
    rig.sim.machine.set_spindle_pot(1.0)
    rig.until_true(lambda shot: shot.rpm_actual > 2900.0)
    assert rig.state is MachineState.RUN


def test_spindle_drive_fault_raises_an_alarm() -> None:
    rig = Rig()
    rig.start(BUSY)
    rig.run(3.0)
    rig.sim.machine.spindle_fault("overvoltage")
    alarm(rig, "spindle")
    assert rig.shot.alarms[0].cause == "overvoltage"


def test_spindle_that_ignores_stop_raises_an_alarm() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S2000\nG04F3\nM05\nG04F9\nM30\n")
    rig.run(3.0)
    rig.sim.machine.spindle_ignores_stop()
    rig.until_true(lambda shot: shot.rpm_command == 0.0)
    assert alarm(rig, "ignores-stop") < 1.2
    assert "E-STOP" in rig.shot.alarms[0].remedy


def test_spindle_switch_stops_the_spindle_and_retains_the_command() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S1000\nG04F20\nM30\n")
    rig.run(2.0)
    rig.sim.machine.set_spindle_auto(False)
    rig.run(2.0)
    assert rig.shot.rpm_actual == 0.0
    assert not rig.shot.spindle_auto
    assert (rig.state, rig.shot.waiting_for) == (MachineState.HOLD, text("executor.spindle-switch-off"))
    rig.sim.machine.set_spindle_auto(True)
    rig.run(2.0)
    assert rig.shot.rpm_actual == 0.0
    rig.post(CycleStart())
    rig.run(2.0)
    assert rig.shot.rpm_actual == 1000.0


def test_spindle_start_with_switch_off_causes_a_hold_and_no_alarm() -> None:
    rig = Rig()
    rig.sim.machine.set_spindle_auto(False)
    rig.start("G90G94F300\nM03S1000\nG01F10Z-1\nM30\n")
    rig.run(20.0)
    assert rig.state is MachineState.HOLD
    assert rig.shot.waiting_for == text("executor.spindle-switch-off")
    assert rig.shot.actual[1] == 0.0
    rig.sim.machine.set_spindle_auto(True)
    rig.run(2.0)
    assert rig.shot.rpm_actual == 0.0
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.actual[1] < -0.1)


def test_spindle_start_with_the_collet_open_is_refused() -> None:
    rig = Rig()
    rig.sim.machine.collet_sensor_stuck()
    rig.sim.machine.set_input("collet_closed", False)
    rig.start("G90G94F300\nM03S1000\nG04F1\nM30\n")
    alarm(rig, "collet-open")
    assert rig.sim.machine.get_spindle_rpm() == 0.0


def test_unclamping_at_speed_is_rejected_if_the_machine_file_forbids_it() -> None:
    rig = Rig(strict_machine())
    rig.start("G90G94F300\nM03S1000\nG04F3\nM05\nM13\nM12\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == text("executor.spindle-stop-wait"))
    assert "collet" in rig.shot.outputs
    assert rig.shot.rpm_actual > 300
    rig.until_true(lambda shot: "collet" not in shot.outputs)
    assert rig.shot.rpm_actual < 5
    rig.until(MachineState.IDLE)


def test_unclamping_at_speed_raises_alarm_if_the_machine_file_says_so() -> None:
    rig = Rig(strict_machine())
    maker = Maker()
    maker.rpm = 300.0
    rig.made = maker.act(SpindleRun(300.0)).act(Dwell(2.0)).act(ColletSwitch(closed=False)).end()
    rig.start("G90\nM30\n")
    alarm(rig, "unclamp")
    assert "collet" in rig.shot.outputs


def strict_machine() -> Machine:
    machine = load_machine()
    locks = dataclasses.replace(machine.interlocks, unclamp_while_turning=False)
    return dataclasses.replace(machine, interlocks=locks)


def test_collet_that_does_not_respond_raises_an_alarm() -> None:
    rig = Rig()
    rig.sim.machine.collet_sensor_stuck()
    rig.start("G90G94F300\nM13\nX1\nM30\n")
    assert alarm(rig, "collet") == pytest.approx(2.25, abs=0.1)
    assert rig.shot.actual[0] == 0.0


def test_collet_that_opens_unexpectedly_raises_an_alarm() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S1000\nG04F9\nM30\n")
    rig.run(2.0)
    rig.sim.machine.collet_sensor_stuck()
    rig.sim.machine.set_input("collet_closed", False)
    assert alarm(rig, "collet-lost") < 0.7


# --- threads ------------------------------------------------------------------------------------------------

PASS_X = (11.9, 11.7, 11.55, 11.45)
OUT_X = 14.0


def threading(rig: Rig, passes: tuple[float, ...] = PASS_X) -> None:
    """Passes of lead 1.27 mm at 600 rpm from z 5 to z -25, then straight out, and back."""
    maker = Maker()
    maker.rpm = 600.0
    maker.act(SpindleRun(600.0)).rapid(OUT_X, 5.0)
    for x in passes:
        maker.rapid(x, 5.0).thread(x, -25.0, 1.27).rapid(OUT_X, -25.0).rapid(OUT_X, 5.0)
    rig.made = maker.end()
    rig.start("G90\nM30\n")


def in_thread(rig: Rig) -> None:
    rig.until_true(lambda shot: shot.block_text == "thread" and shot.actual[1] < -5.0, limit=30)


def test_thread_passes_start_at_the_same_spindle_angle() -> None:
    rig = Rig()
    threading(rig)
    seen: list[float] = []
    before = [0.0, 0.0]

    def look(shot: Snapshot) -> None:
        z, turns = shot.demand[1], rig.sim.ports.spindle.read_angle()
        assert turns is not None
        if shot.block_text == "thread" and before[0] > 0.0 >= z:
            share = before[0] / (before[0] - z)
            seen.append((before[1] + share * (turns[1] - before[1])) % 1.0)
        before[:] = [z, turns[1]]

    rig.watch.append(look)
    rig.until(MachineState.IDLE)
    assert len(seen) == len(PASS_X)
    assert max(seen) - min(seen) < 0.01  # of a turn: 13 µm of lead


def test_thread_pass_maintains_its_lead_under_feed_override() -> None:
    rig = Rig()
    rig.sim.machine.set_feed_pot(0.5)
    rig.run(1.0)
    threading(rig, (11.9,))
    in_thread(rig)
    assert rig.shot.velocity == pytest.approx(1.27 * 10, rel=0.02)


@pytest.mark.parametrize("how", ["button", "override"])
def test_hold_in_a_thread_acts_after_the_pull_out(how: str) -> None:
    rig = Rig()
    threading(rig)
    in_thread(rig)
    if how == "button":
        rig.post(FeedHold())
        assert rig.state is MachineState.STOPPING
        rig.until(MachineState.HOLD)
    else:
        rig.sim.machine.set_feed_pot(0.0)
        rig.until(MachineState.WAIT)
    assert rig.shot.demand[:2] == pytest.approx((OUT_X, -25.0))
    rig.run(1.0)
    rig.sim.machine.set_feed_pot(1.0)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_single_block_does_not_stop_in_the_groove() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    threading(rig, (11.9,))
    stops = []
    for _ in range(5):
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        stops.append(rig.shot.demand[:2])
        rig.run(0.4)
        rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert stops == [
        pytest.approx(stop) for stop in [(0.0, 0.0), (OUT_X, 5.0), (11.9, 5.0), (OUT_X, -25.0), (OUT_X, 5.0)]
    ]


@pytest.mark.parametrize("kill", ["bog", "trip"])
def test_spindle_loss_in_a_thread_retracts_and_skips_remaining_passes(kill: str) -> None:
    rig = Rig()
    threading(rig)
    in_thread(rig)
    inside = rig.shot.block
    if kill == "bog":
        rig.sim.machine.spindle_bog(0.3)
    else:
        rig.sim.machine.set_spindle_auto(False)
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "thread-lost"
    assert rig.shot.alarms[0].line == inside
    rig.run(0.3)
    assert rig.shot.demand[0] == pytest.approx(OUT_X)
    assert -25.0 < rig.shot.demand[1] < -5.0
    assert rig.shot.rpm_command == 0.0
    stood = rig.shot.demand
    rig.run(3.0)
    assert rig.shot.demand == stood


def test_thread_without_an_encoder_raises_an_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    monkeypatch.setattr(rig.sim.ports.spindle, "read_angle", lambda: None)
    threading(rig)
    alarm(rig, "thread-no-encoder")
    assert rig.shot.demand[:2] == pytest.approx((11.9, 5.0))


# --- station ------------------------------------------------------------------------------------------------


def test_silent_station_retains_overrides_and_holds() -> None:
    rig = Rig(every=FINE)
    rig.start("G90G94F300\nG01F30Z-5\nM30\n")
    rig.run(1.0)
    rig.sim.machine.set_feed_pot(0.8)
    rig.run(0.5)
    rig.sim.machine.station_silent()
    rig.run(0.29)
    assert rig.state is MachineState.RUN
    rig.until(MachineState.HOLD, limit=0.3)
    assert rig.shot.feed_override == pytest.approx(0.8)
    assert rig.shot.waiting_for == text("executor.station-silent")


def test_jumping_override_never_speeds_up_and_holds() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F30Z-5\nM30\n")
    rig.run(1.0)
    fastest = []
    rig.watch.append(lambda shot: fastest.append(shot.velocity))
    rig.sim.machine.pot_noise(0.5)
    rig.until(MachineState.HOLD, limit=1.0)
    assert rig.shot.waiting_for == text("executor.pot-jumps")
    assert max(fastest) <= 30 * INCH / 60 * 1.2 + 0.2


def test_override_that_jumps_up_is_accepted_only_once_stable() -> None:
    rig = Rig()
    rig.sim.machine.set_feed_pot(0.2)
    rig.run(0.5)
    rig.sim.machine.set_feed_pot(1.2)
    rig.run(0.25)
    assert rig.shot.feed_override == pytest.approx(0.2)
    rig.run(0.2)
    assert rig.shot.feed_override == pytest.approx(1.2)
    rig.sim.machine.set_feed_pot(0.1)
    rig.tick()
    assert rig.shot.feed_override == pytest.approx(0.1)


# --- E-stop -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("after", [0.02, 0.05, 0.31, 0.7, 1.3, 2.0, 3.3, 4.9, 6.2, 7.7, 8.5, 9.05, 9.4])
def test_estop_works_at_any_moment(after: float) -> None:
    rig = Rig()
    rig.start(BUSY)
    rig.run(after)
    rig.sim.machine.press_estop()
    rig.tick()
    assert rig.state is MachineState.ESTOP
    assert not {"coolant", "catcher"} & rig.shot.outputs
    rig.run(0.3)
    assert not rig.sim.ports.axes.sample().enabled
    assert not rig.sim.ports.axes.sample().moving
    rig.run(4.0)
    assert rig.sim.machine.get_spindle_rpm() == 0.0
    stood = rig.sim.machine.get_true_positions()
    rig.sim.machine.release_estop()
    rig.run(2.0)
    assert rig.state is MachineState.DISABLED
    rig.post(EnableDrives())
    rig.run(2.0)
    assert rig.state is MachineState.IDLE
    assert rig.sim.machine.get_true_positions() == pytest.approx(stood, abs=0.01)
    assert rig.sim.machine.get_spindle_rpm() == 0.0
    assert rig.shot.parts == 0
    assert not {"coolant", "catcher"} & rig.shot.outputs
    rig.post(CycleStart())
    assert rig.shot.line in {0, 1, 2}


def test_estop_clears_the_home_of_incremental_axes() -> None:
    rig = Rig(unhomed_machine())
    rig.ready()
    rig.post(HomeAxes())
    rig.until(MachineState.IDLE)
    assert rig.shot.homed == (True, True, True)
    rig.sim.machine.press_estop()
    rig.run(0.5)
    assert rig.shot.homed == (True, False, True)


def test_drives_stay_off_while_the_machine_is_silent() -> None:
    it = Rig()
    heard = it.executor._ports
    it.executor._ports = dataclasses.replace(heard, unknown=lambda: ALL_UNKNOWN_PARTS)
    it.run(0.1)
    it.post(EnableDrives())
    assert it.state is MachineState.DISABLED
    assert text("executor.machine-not-said") in it.events[-1].text
    it.executor._ports = heard
    it.run(0.1)
    it.post(EnableDrives())
    assert it.state is MachineState.IDLE
