"""Single parts of the executor whose figures follow with a pencil, asked without a program."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest

from core.executor.commands import (
    Command,
    ConfirmStart,
    EnableDrives,
    ForceOutput,
    HomeAxes,
    Jog,
    PreventNextPart,
    SetFeedOverride,
    SetSpindleLimit,
    SetSwitch,
)
from core.executor.hand_motion.drive_test import AxisTestLimits, DriveTestMotion, Shape
from core.executor.hand_motion.jog_ramps import plan_jog_ramps
from core.executor.hand_motion.touch_off import Homing
from core.executor.machine_context import MachineContext
from core.executor.program_motion.spindle_angle import SpindleAnglePredictor
from core.executor.program_motion.standstill import make_spindle_speed_wait
from core.executor.program_motion.thread_path import ThreadPath
from core.executor.raised_alarm import AlarmError
from core.executor.snapshot import MachineState
from core.executor.spindle_control import SpindleRequest
from core.executor.spindle_orientation import OrientationControl
from core.faults import SPINDLE_TURNS
from core.ports import AxisSample, DriverError, StopMode
from tests.coded import raises_code
from tests.executor.played_controller import context_of
from tests.executor.rig import Rig
from tests.executor.test_thread_curve import LIMITS, OUT, place, thread
from tests.texts import text

# --- what is asked for and not done -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        (EnableDrives(), text("executor.no-drives-on", state="READY")),
        (SetSwitch("no such", True), text("executor.no-switch", switch="'no such'")),
        (SetFeedOverride(1.51), text("executor.feed-override-range", value="1.51")),
        (SetFeedOverride(-0.01), text("executor.feed-override-range", value="-0.01")),
        (SetSpindleLimit(0.0), text("executor.spindle-limit-range", rpm=0, limit=3500)),
        (SetSpindleLimit(1e5), text("executor.spindle-limit-range", rpm=100000, limit=3500)),
        (ConfirmStart("12:00"), text("executor.no-interrupted-job")),
        (HomeAxes("Q"), text("executor.homing", why=text("executor.no-home-axis", axis="Q"))),
        (ForceOutput("no such", True), text("executor.no-output", output="no such")),
    ],
)
def test_invalid_command_is_rejected_with_a_reason_and_changes_nothing(asked: Command, why: str) -> None:
    rig = Rig()
    rig.ready()
    before = rig.shot
    rig.post(asked)
    (told,) = rig.said("refused")
    assert why in told
    assert rig.state is MachineState.IDLE
    for name in ("demand", "outputs", "feed_override", "spindle_override", "modal"):
        assert getattr(rig.shot, name) == getattr(before, name)


def test_active_alarm_prevents_enabling_drives_and_jogging() -> None:
    rig = Rig()
    rig.sim.machine.press_estop()
    rig.run(0.1)
    rig.post(Jog("X", 1.0, 0.2))
    assert rig.said("refused")[-1] == text("executor.no-jog", state="E-STOP")
    rig.post(EnableDrives())
    assert "drives" in rig.said("refused")[-1]
    assert not rig.sim.ports.axes.sample().enabled


def test_next_part_block_is_reported_once_when_set_and_when_cleared() -> None:
    rig = Rig()
    for why in ("the insert is worn", "the insert is worn", "", ""):
        rig.post(PreventNextPart(why))
    assert rig.said("switch") == [
        text("executor.no-other-part", why="the insert is worn"),
        text("executor.parts-may-go-on"),
    ]


# --- drive tests --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("frequency", "waves", "pieces"), [(2.0, 5, 40), (20.0, 16, 25), (90.0, 72, 12)])
def test_sine_wave_has_12_to_40_pieces_of_at_least_2_ms(frequency: float, waves: int, pieces: int) -> None:
    """20 Hz: a wave takes 50 ms. Five waves at least, and .8 s."""
    path = DriveTestMotion("X", Shape.SINE, 0.1, frequencies_hz=(frequency,))
    ramps = path.make_ramps(
        AxisTestLimits(max_speed_mm_s=42.3, max_acceleration_mm_s2=3048.0, sample_rate_hz=1000.0)
    )
    assert len(ramps) == waves * pieces + 1  # and the rest behind it
    assert [dt for dt, _, _ in ramps[:-1]] == pytest.approx([1.0 / frequency / pieces] * waves * pieces)


# --- jog ----------------------------------------------------------------------------------------------------


def played(ramps: list[tuple[float, float, float]]) -> tuple[float, float]:
    """Seconds and mm of ramps of (time, first speed, acceleration)."""
    return sum(dt for dt, _, _ in ramps), sum((v + 0.5 * a * dt) * dt for dt, v, a in ramps)


@pytest.mark.parametrize(
    ("v0", "v1", "time", "way", "seconds", "mm"),
    [
        (0.0, 20.0, 1.0, math.inf, 1.2, 20.0),  # .2 s up (2 mm), .8 s on (16), .2 s down (2)
        (0.0, 20.0, 0.1, math.inf, 0.2, 1.0),  # 10 mm/s are reached in .1 s
        (0.0, 20.0, 0.0, math.inf, 0.0, 0.0),
        (0.0, -20.0, 1.0, math.inf, 1.2, -20.0),
        (20.0, 0.0, 1.0, math.inf, 0.2, 2.0),
        (20.0, 10.0, 1.0, math.inf, 1.1, 11.0),  # .1 s to 10 (1.5), .9 s (9), .1 s (.5)
        (0.0, 20.0, 9.0, 8.0, 0.6, 8.0),  # 4 mm of ramps, 4 mm on
        (0.0, 20.0, 9.0, 1.0, 0.2, 1.0),  # top sqrt(100·1) = 10
        (10.0, -20.0, 1.1, math.inf, 1.3, -19.5),  # .1 s to rest (.5), then as the first
    ],
)
def test_jog_ramps_are_limited_by_time_and_distance(
    v0: float, v1: float, time: float, way: float, seconds: float, mm: float
) -> None:
    """At 100 mm/s²."""
    assert played(plan_jog_ramps(v0, v1, 100.0, time, way)) == pytest.approx((seconds, mm))


# --- threads ------------------------------------------------------------------------------------------------


def test_thread_chain_starts_at_its_first_position_and_lead() -> None:
    """Half a turn more lead each turn: 3 mm in two turns are 1.5 on average, 1 at the begin."""
    growing = thread(1, 0.0, -3.0, 1.5, growth=0.5, x0=4.0)
    path = ThreadPath.from_blocks([growing, thread(2, -3.0, -7.0, 2.0), OUT], LIMITS)
    assert (path.start_x, path.start_z, path.lead_mm) == pytest.approx((4.0, 0.0, 1.0))


def test_thread_joints_closer_than_a_revolution_are_followed() -> None:
    """Half a turn of lead 1, .75 of lead 2, half of lead 4: each joint within a turn of both ends."""
    chain = [thread(1, 0.0, -0.5, 1.0), thread(2, -0.5, -2.0, 2.0), thread(3, -2.0, -4.0, 4.0)]
    way, left = ThreadPath.from_blocks([*chain, OUT], LIMITS).plan_remaining_pass(0.0, 0.0, 1.0, [])
    for t, z in ((0.25, -0.25), (0.75, -1.0), (1.0, -1.5), (1.5, -3.0)):
        assert place(way, t) == pytest.approx((5.0, z), abs=1e-6)
    assert left == pytest.approx(1.75, abs=0.002)


# --- the spindle --------------------------------------------------------------------------------------------


def test_angle_predictor_reproduces_a_cubic() -> None:
    """Turns t³ + 2t² + 3t: at .3 s .027 + .18 + .9, and 3t² + 4t + 3 turns a second there."""
    angle = SpindleAnglePredictor()
    for n in range(21):
        t = 0.01 * n
        angle.add_reading((t, t**3 + 2.0 * t * t + 3.0 * t))
    turns, speed = angle.predict_angle(0.21) or (math.nan, math.nan)
    assert turns == pytest.approx(0.21**3 + 2.0 * 0.21**2 + 3.0 * 0.21, abs=1e-9)
    assert speed == pytest.approx(3.0 * 0.21**2 + 4.0 * 0.21 + 3.0, abs=1e-6)


@pytest.mark.parametrize("rpm", [60.0, 137.0, 600.0, 3000.0])
def test_prediction_45_ms_ahead_is_within_three_encoder_steps(rpm: float) -> None:
    """Each reading is off by half a step at most; a polynomial of a higher degree makes five of it."""
    for phase in range(7):
        angle, first = SpindleAnglePredictor(), 0.13 * phase / 4096.0
        for n in range(60):
            t = 0.01 * n
            angle.add_reading((t, round((rpm / 60.0 * t + first) * 4096.0) / 4096.0))
            told = angle.predict_angle(t + 0.045)
            if n > 30 and told is not None:
                assert abs(told[0] - rpm / 60.0 * (t + 0.045) - first) < 3.0 / 4096.0


@dataclass
class _Port:
    """A spindle's drive that turns as it is told."""

    told: list[float] = field(default_factory=list)

    def set_speed(self, rpm: float) -> None:
        self.told.append(rpm)

    def start_coasting(self) -> None:
        self.told.append(0.0)

    def speed(self) -> float:
        return self.told[-1] if self.told else 0.0

    def read_angle(self) -> None:
        """It has no encoder."""

    def read_fault(self) -> str:
        return ""


def test_spindle_command_is_sent_once_and_again_when_permitted_again() -> None:
    """A drive may have dropped it; told at each tick it would be a wire full of the same word."""
    context, port = context_of(None), _Port()
    spindle = context.spindle
    spindle._port = port
    spindle.request_speed(SpindleRequest(600.0))
    for n in range(5):
        spindle.update(0.01 * n, 10.0)
    assert port.told == [600.0]
    spindle.permit_start()
    for n in range(5, 10):
        spindle.update(0.01 * n, 10.0)
    assert port.told == [600.0, 600.0]


def test_speed_wait_label_names_what_holds_the_spindle_back() -> None:
    """The operator where it is he, by what he can change; else only that it is waited for."""
    context = context_of(None)
    context.spindle.request_speed(SpindleRequest(600.0))
    wait = make_spindle_speed_wait(context)
    assert wait.make_label() == text("executor.at-speed")
    context.spindle.override = 0.0
    assert wait.make_label() == text("executor.spindle-override-0")


def test_at_speed_timeout_starts_when_the_operator_permits_rotation() -> None:
    """A minute with the pot at 0 is no alarm; then the timeout of the machine file counts whole."""
    context = context_of(None)
    context.spindle.request_speed(SpindleRequest(600.0))
    context.spindle.override = 0.0
    wait = make_spindle_speed_wait(context)
    for second in range(60):
        context.now = float(second)
        assert not wait.is_over(context.now)
    context.spindle.override = 1.0
    context.now = 59.0 + context.machine.spindle.timeout_s - 0.1
    assert not wait.is_over(context.now)
    context.now += 0.2
    with pytest.raises(AlarmError) as told:
        wait.is_over(context.now)
    assert told.value.code == "at-speed"


@dataclass
class _Held:
    """A drive that brings the spindle to angles."""

    there: bool = False
    told: list[object] = field(default_factory=list)
    refusal: DriverError | None = None

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        if self.refusal is not None:
            raise self.refusal
        self.told.append((angle, direction))

    def release_spindle(self) -> None:
        self.told.append("release")

    def is_oriented(self) -> bool:
        return self.there


def test_oriented_angle_is_reported_from_arrival_until_release() -> None:
    port = _Held()
    held = OrientationControl(port, 100.0)
    assert (held.angle_deg, held.is_moving, held.max_rpm) == (None, False, 0.0)
    held.release_spindle()
    assert port.told == []
    assert not held.request_angle(90.0, 1)
    assert (held.angle_deg, held.is_moving, held.max_rpm) == (None, True, 100.0)
    port.there = True
    assert held.request_angle(90.0, 1)
    assert (held.angle_deg, held.is_moving) == (90.0, False)
    port.there = False
    assert not held.request_angle(90.0, -1)  # the same angle from the other side is another
    assert held.angle_deg is None
    held.release_spindle()
    assert (held.angle_deg, held.is_moving, held.max_rpm) == (None, False, 0.0)
    assert port.told == [(90.0, 1), (90.0, -1), "release"]


def test_angle_is_requested_again_until_the_drive_considers_the_spindle_stopped() -> None:
    port = _Held(there=True)
    port.refusal = DriverError("the spindle is turning", "spindle-off", reason=SPINDLE_TURNS)
    held = OrientationControl(port, 100.0)
    assert not held.request_angle(90.0, 0)
    assert (held.angle_deg, held.is_moving, held.max_rpm) == (None, False, 0.0)
    port.refusal = DriverError("the E-stop chain is open", "spindle-off")
    with raises_code(DriverError, "spindle-off", "E-stop"):
        held.request_angle(90.0, 0)
    port.refusal = None
    assert held.request_angle(90.0, 0)
    assert port.told == [(90.0, 0)]


def test_lost_orientation_raises_one_alarm() -> None:
    port = _Held(there=True)
    held = OrientationControl(port, 100.0)
    held.request_angle(45.0, 0)
    held.check_angle()
    port.there = False
    with raises_code(AlarmError, "spindle-orient", text("executor.not-held-at", angle=45)):
        held.check_angle()
    held.check_angle()
    with raises_code(AlarmError, "spindle-orient", text("executor.nothing-orients")):
        OrientationControl(None, 100.0).request_angle(0.0, 0)


# --- homing -------------------------------------------------------------------------------------------------


LOST, FOUND = (False, False, True), (True, True, True)  # of X, Z and C


@dataclass
class _Asked:
    """What the homing asks of the axes."""

    homed: list[str] = field(default_factory=list)
    stopped: list[StopMode] = field(default_factory=list)


def homing(monkeypatch: pytest.MonkeyPatch) -> tuple[Homing, MachineContext, _Asked]:
    """Of the shipped lathe, X and Z lost."""
    context, asked = context_of(None), _Asked()
    monkeypatch.setattr(context.ports.axes, "home", asked.homed.append)
    monkeypatch.setattr(context.ports.axes, "stop", asked.stopped.append)
    context.axis_sample = sample(context, LOST)
    return Homing(context), context, asked


def sample(context: MachineContext, homed: tuple[bool, ...], *, moving: bool = False) -> AxisSample:
    """What the axes say of themselves."""
    return context.axis_sample._replace(homed=homed, moving=moving)


def test_next_axis_homes_after_the_previous_one_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    order, context, asked = homing(monkeypatch)
    assert order.start_homing("") == ""
    assert not order.home_next_axis()
    first = asked.homed[0]
    for n in range(5):
        context.now, context.axis_sample = 0.01 * n, sample(context, LOST, moving=True)
        assert not order.home_next_axis()
    found = {"X": (True, False, True), "Z": (False, True, True)}[first]
    context.now, context.axis_sample = 0.06, sample(context, found, moving=True)
    assert not order.home_next_axis()
    assert len(asked.homed) == 1  # found, and still braking
    context.now, context.axis_sample = 0.07, sample(context, found)
    assert not order.home_next_axis()
    assert sorted(asked.homed) == ["X", "Z"]
    context.now, context.axis_sample = 0.08, sample(context, FOUND, moving=True)
    assert not order.home_next_axis()
    context.axis_sample = sample(context, FOUND)
    assert order.home_next_axis()


def test_homing_requires_a_lost_existing_axis_and_stops_on_cancel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    order, context, asked = homing(monkeypatch)
    assert order.start_homing("Q") == text("executor.no-home-axis", axis="Q")
    context.axis_sample = sample(context, FOUND)
    assert order.start_homing("") == text("executor.all-homed")
    context.axis_sample = sample(context, LOST)
    order.start_homing("X")
    order.home_next_axis()
    order.stop()
    assert (asked.homed, asked.stopped) == (["X"], [StopMode.RAMP_HOLD])
    context.axis_sample = sample(context, (True, False, True))
    assert order.home_next_axis()
    assert asked.homed == ["X"]


# --- outputs ------------------------------------------------------------------------------------------------


def test_commanded_outputs_port_reads_the_driver_inputs() -> None:
    context = context_of(None)
    assert dict(context.commanded_outputs.inputs()) == dict(context.ports.io.inputs())
    assert context.commanded_outputs.inputs()
