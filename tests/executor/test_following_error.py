"""Jammed, pushed, run away, an encoder that no longer counts: at rest and in motion, within a stated way."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import CycleStart, EnableDrives, FeedHold, Jog, Reset, SetFeedOverride, SetSwitch
from core.executor.raised_alarm import AlarmError
from core.executor.safety.supervision import FollowingErrorMonitor
from core.executor.snapshot import MachineState
from core.ports import AxisSample
from tests.coded import raises_code
from tests.executor.rig import FINE, Rig
from tests.texts import text

pytestmark = pytest.mark.long

SLOW = "G90G94F300\nG01F2Z-4\nM30\n"  # .85 mm/s
FEED = "G90G94F300\nG01F20Z-4\nM30\n"  # 8.5 mm/s
RAPID = "G90G94F300\nX3Z-4\nX0Z0\nM30\n"


def ready(rig: Rig) -> None:
    rig.ready()
    rig.run(0.5)


def held(rig: Rig) -> None:
    rig.start(FEED)
    rig.run(1.0)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(0.5)


def waiting(rig: Rig) -> None:
    rig.start("G90G94F300\nX.5\nG04F9\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    rig.run(0.3)


def override_zero(rig: Rig) -> None:
    rig.start(FEED)
    rig.run(1.0)
    rig.post(SetFeedOverride(0.0))
    rig.until(MachineState.WAIT)
    rig.run(0.3)


def program_stop(rig: Rig) -> None:
    rig.start("G90G94F300\nX.5\nM00\nX1\nM30\n")
    rig.until(MachineState.PROGRAM_STOP)
    rig.run(0.3)


def block_end(rig: Rig) -> None:
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nX.5\nX1\nM30\n")
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    rig.run(0.3)


def alarm_stands(rig: Rig) -> None:
    """Powered, with an alarm that only stops."""
    rig.start("G90G94F300\nX.5\nX99\nM30\n")
    rig.until(MachineState.FAULT)
    assert rig.sim.ports.axes.sample().enabled
    rig.run(0.3)


AT_REST: dict[str, Callable[[Rig], None]] = {
    "ready": ready,
    "hold": held,
    "dwell": waiting,
    "override at 0": override_zero,
    "program stop": program_stop,
    "single block": block_end,
    "alarm": alarm_stands,
}


def way_until_off(rig: Rig, limit: float = 2.0) -> tuple[float, float]:
    """Seconds until the drives are off, and how far Z really went until it stood."""
    began, place = rig.clock.now(), rig.sim.machine.get_true_positions()[1]
    while rig.sim.ports.axes.sample().enabled:
        assert rig.clock.now() - began < limit, rig.shot
        rig.tick()
    took = rig.clock.now() - began
    rig.run(1.0)
    return took, abs(rig.sim.machine.get_true_positions()[1] - place)


@pytest.mark.parametrize("state", AT_REST)
@pytest.mark.parametrize(("speed", "most"), [(1.0, 0.6), (5.0, 1.4), (20.0, 3.0), (130.0, 12.0)])
def test_drive_runaway_at_rest_raises_a_fault(state: str, speed: float, most: float) -> None:
    rig = Rig()
    AT_REST[state](rig)
    rig.sim.machine.runaway("Z", speed)
    took, way = way_until_off(rig)
    assert way < most
    assert took < 0.5
    assert rig.state is MachineState.FAULT
    assert rig.shot.alarms[-1].code in {"standstill", "following", "axis"}


@pytest.mark.parametrize("state", AT_REST)
@pytest.mark.parametrize("off", [0.03, 0.15, 0.5, 1.9])
def test_axis_jammed_off_position_raises_a_standstill_alarm(state: str, off: float) -> None:
    rig = Rig()
    AT_REST[state](rig)
    rig.sim.machine.jam("Z")
    rig.sim.machine.push("Z", -off)
    took, way = way_until_off(rig)
    assert took < 0.3
    assert way == 0.0
    assert rig.shot.alarms[-1].code == "standstill"
    assert "Z" in rig.shot.alarms[-1].cause
    rig.sim.machine.jam("Z", False)
    rig.run(0.5)
    stood = rig.sim.machine.get_true_positions()[1]
    rig.post(Reset())
    rig.post(EnableDrives())
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    assert rig.sim.machine.get_true_positions()[1] == pytest.approx(
        stood, abs=0.002
    )  # and does not jump back


def test_jam_at_the_end_of_a_move_does_not_end_in_idle_off_position() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F100Z-1\nM30\n")
    rig.until_true(lambda shot: shot.demand[1] < -25.4 + 1.0)
    rig.sim.machine.jam("Z")
    rig.until(MachineState.FAULT, limit=1.0)
    rig.run(2.0)
    rig.post(Reset())
    rig.run(1.0)
    assert rig.state is MachineState.DISABLED
    assert abs(rig.shot.following_error[1]) < 0.01


@pytest.mark.parametrize(
    ("text", "most"), [(SLOW, 0.6), (FEED, 5.0), (RAPID, 20.0)], ids=["slow", "feed", "rapid"]
)
def test_encoder_freeze_in_motion_raises_a_fault(text: str, most: float) -> None:
    rig = Rig()
    rig.start(text)
    rig.until_true(lambda shot: shot.actual[1] < -0.5)
    rig.sim.machine.encoder_stuck("Z")
    way_until_off(rig)
    read = rig.shot.actual[1]
    assert abs(rig.sim.machine.get_true_positions()[1] - read) < most
    assert rig.shot.alarms[0].code in {"encoder-still", "following", "axis"}


@pytest.mark.parametrize("after", [0.0, 0.01, 0.02, 0.03, 0.04, 0.05])
@pytest.mark.parametrize("text", [FEED, "G90G94F300\nG01F60Z-4\nM30\n", RAPID])
def test_encoder_freeze_at_hold_start_raises_a_fault(text: str, after: float) -> None:
    rig = Rig(every=FINE)
    rig.start(text)
    rig.until_true(lambda shot: shot.actual[1] < -12.0)
    rig.executor.post(FeedHold())
    rig.run(after)
    rig.sim.machine.encoder_stuck("Z")
    place = rig.sim.machine.get_true_positions()[1]
    rig.run(10.0)
    way = abs(rig.sim.machine.get_true_positions()[1] - place)
    speed = 25.4 / 60.0 * {FEED: 20.0, RAPID: 240.0}.get(text, 60.0)
    assert way < 0.1 * speed + 10.0
    if abs(rig.shot.following_error[1]) > 0.004:
        assert rig.state is MachineState.FAULT


def test_slow_jog_into_a_jam_raises_encoder_still() -> None:
    rig = Rig()
    ready(rig)
    rig.sim.machine.jam("Z")
    while rig.state is not MachineState.FAULT:
        rig.post(Jog("Z", -0.5, 0.2))
        assert abs(rig.shot.demand[1]) < 0.15
    assert rig.shot.alarms[0].code == "encoder-still"


def codes(rig: Rig) -> list[str]:
    """Of the alarms that stand."""
    return [alarm.code for alarm in rig.shot.alarms]


def test_axis_pushed_with_drives_off_is_reported_but_not_in_estop() -> None:
    rig = Rig()
    ready(rig)
    rig.sim.machine.press_estop()
    rig.run(1.0)
    rig.sim.machine.push("Z", 3.0)
    rig.run(1.0)
    assert codes(rig) == []
    rig.sim.machine.release_estop()
    rig.run(1.0)
    assert rig.state is MachineState.DISABLED
    assert codes(rig) == []
    rig.sim.machine.push("Z", 0.15)
    rig.run(1.0)
    assert codes(rig) == []
    rig.sim.machine.push("Z", 0.1)
    rig.run(0.4)
    assert codes(rig) == ["moved-unasked"]
    assert text("executor.moved-by", axis="Z", distance="0.250 mm") in rig.shot.alarms[0].cause
    rig.post(Reset())
    rig.run(1.0)
    assert codes(rig) == []
    rig.post(EnableDrives())
    assert rig.state is MachineState.IDLE


def test_a_healthy_machine_is_left_alone() -> None:
    """Rapids, feeds, corners, holds, jogs, everything at the limits of speed and acceleration."""
    rig = Rig()
    steps = "".join(f"X{1 + 0.3 * (n % 2)}Z-{0.1 * n:.2f}\n" for n in range(1, 12))
    rig.start(
        f"G90G94F300\n{steps}G01F1Z-1.2\nF300\n{steps}G01X1.5Z-1.5F200\nG02X2Z-2I2K-1.5\nG00X0Z0\nM30\n"
    )
    for _ in range(200):
        rig.run(0.13)
        if rig.state is MachineState.RUN:
            rig.post(FeedHold())
            rig.until(MachineState.HOLD)
            rig.run(0.35)
            rig.post(CycleStart())
        assert rig.shot.alarms == ()
        if rig.shot.parts:
            break
    assert rig.shot.parts == 1


def test_following_error_limit_grows_with_speed_up_to_the_window() -> None:
    z = load_machine().axes[1]
    assert z.compute_max_following_error(0.0) == pytest.approx(0.2032)
    assert z.compute_max_following_error(-0.5 * z.max_speed) == pytest.approx(0.5 * (0.2032 + 2.032))
    assert z.compute_max_following_error(3.0 * z.max_speed) == pytest.approx(2.032)


def sample(t: float, demand: float, actual: float, *, enabled: bool = True) -> AxisSample:
    return AxisSample(
        t,
        (0.0, demand, 0.0),
        (0.0, actual, 0.0),
        (0.0, demand - actual, 0.0),
        enabled,
        (True,) * 3,
        False,
        "",
    )


def test_repeated_sample_adds_no_fault_time() -> None:
    """A wire that repeats its last answer, and a control that was away, make nothing last longer."""
    watch = FollowingErrorMonitor(load_machine().axes)
    watch.check_sample(sample(0.0, 0.0, 0.0), is_unpowered=False)
    watch.check_sample(sample(0.01, 0.0, 0.0), is_unpowered=False)
    for _ in range(100):
        watch.check_sample(sample(1.0, 0.0, 0.5), is_unpowered=False)
    watch.check_sample(sample(1.01, 0.0, 0.5), is_unpowered=False)
    with raises_code(AlarmError, "standstill", text("executor.off-setpoint", axis="Z", distance="0.500 mm")):
        watch.check_sample(sample(1.3, 0.0, 0.5), is_unpowered=False)
