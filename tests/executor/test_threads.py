"""Threads on the simulated lathe: lead and entry angle on a wandering spindle, holds, losses, stalls.

On a driver that follows the spindle by itself, and on one that gets setpoints in time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from core.executor.commands import CycleStart, FeedHold, Reset
from core.executor.program_motion.spindle_angle import SpindleAnglePredictor
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.motion.axis_limits import FloatArray
from tests.executor.rig import FINE, INCH, CreepingClock, Rig
from tests.texts import text

pytestmark = pytest.mark.long

TOOLS = {4: ToolOffset()}
LEAD = 0.05  # in
HEAD = "G90G94F300G73\nM03S600\nT4\nX.3Z.2\nX.237\n"
# √k - 1 = 1: four passes
EXTERNAL = HEAD + "G33X.212Z-1.2I.025K.05P\nG00Z1\nM30\n"
STRAIGHT_OUT = HEAD + "G33X.212Z-1.2I.025K.05\nG00Z1\nM30\n"
RETRACT = (0.237 + 3 * 0.025) * INCH


@dataclass
class Recorder:
    """At every tick of a thread: which block, setpoint and true place of Z, turns of the spindle."""

    rig: Rig
    lead: float = LEAD
    rows: dict[int, list[tuple[float, float, float]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rig.watch.append(self._look)

    def _look(self, shot: Snapshot) -> None:
        if shot.block_text.startswith("G33") and not shot.block_text.endswith("P"):
            machine = self.rig.sim.machine
            (_, z, _), _ = self.rig.sim.ports.axes.demand_at(self.rig.clock.now())
            row = z / INCH, machine.get_true_positions()[1] / INCH, machine.spindle_turns()
            self.rows.setdefault(shot.block, []).append(row)

    def phases(self, column: int) -> list[FloatArray]:
        """Of each pass, on the inch from z 0 to z -1: (z, turns that the helix is off) in rows."""
        found = []
        for rows in self.rows.values():
            table = np.array(rows)
            z = table[:, column]
            part = table[(z <= 0.0) & (z >= -1.0)]
            found.append(np.stack([part[:, column], part[:, column] / self.lead + abs(part[:, 2])], axis=1))
        return found


def lead_errors(phases: list[FloatArray], lead: float = LEAD) -> list[float]:
    """Of each pass, how much of an inch the thread is longer or shorter anywhere within its inch."""
    return [float(np.ptp(each[:, 1])) * lead for each in phases]


def entries(phases: list[FloatArray]) -> FloatArray:
    """How far the angle at which each pass enters the work is from their mean, degrees."""
    angles = np.array([each[0, 1] % 1.0 for each in phases]) * 360.0
    spread = (angles - angles[0] + 180.0) % 360.0 - 180.0
    off: FloatArray = np.abs(spread - spread.mean())
    return off


@pytest.fixture(params=[True, False], ids=["gear", "time"])
def gear(request: pytest.FixtureRequest) -> bool:
    """Whether the driver has a gear."""
    return bool(request.param)


@pytest.mark.parametrize(
    ("period", "clock"), [(1.0, "step"), (2.0, "step"), (3.0, "step"), (2.0, "creeping")]
)
def test_lead_and_entry_are_accurate_with_a_wandering_spindle(period: float, clock: str, gear: bool) -> None:
    rig = Rig(clock_kind=CreepingClock, gear=gear) if clock == "creeping" else Rig(gear=gear)
    rig.sim.machine.spindle_wander(0.02, period)
    recorder = Recorder(rig)
    rig.start(EXTERNAL, TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert len(recorder.rows) == 4
    # Setpoints, and where the slide truly is: known on a grid of 1 ms only, which a creeping clock leaves.
    for column in (0, 1) if clock == "step" else (0,):
        phases = recorder.phases(column)
        assert max(lead_errors(phases)) < 0.0002
        assert entries(phases).max() < 0.2
    assert rig.said("thread") == []


@pytest.mark.parametrize(
    ("lead", "rpm", "period"),
    [
        (0.02, 1200, 0.25),
        (0.01, 3000, 0.25),
        (0.1, 100, 0.25),
        (0.05, 600, 0.25),
        (0.05, 600, 0.5),
        (0.05, 3000, 0.25),
        (0.1, 2500, 0.25),
        (0.2, 1400, 0.25),
        (0.4, 300, 0.25),
        (0.4, 300, 2.0),
        (0.4, 700, 0.25),
        (0.4, 700, 1.0),
    ],
)
def test_electronic_gear_follows_fast_speed_swings_and_coarse_leads(
    lead: float, rpm: int, period: float
) -> None:
    rig = Rig()
    rig.sim.machine.spindle_wander(0.02, period)
    recorder = Recorder(rig, lead)
    coarse = "G35F2\nG92X.237Z.6\n" if lead > 0.2 else ""
    head = f"G90G94F300G73\nM03S{rpm}\nT4\nX.3Z.6\nX.237\n{coarse}"
    first = min(0.025, lead)  # four passes: (depth / first + 1)² = 4
    end_x = 0.237 - first
    end = -0.2 if lead * rpm < 60.0 else -1.2  # in: several swings of the speed, two at the least
    rig.start(f"{head}G33X{end_x:.4f}Z{end}I{first}K{lead}P\nM30\n", TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=300)
    assert rig.shot.alarms == ()
    assert len(recorder.rows) == 4
    for column in (0, 1):
        phases = recorder.phases(column)
        assert max(lead_errors(phases, lead)) < 0.0002
        assert entries(phases).max() < 0.2
    assert rig.said("thread") == []


def test_axis_accelerating_to_a_coarse_lead_is_not_out_of_step() -> None:
    """It lags behind the spindle by half of its run-up, which lies before the thread."""
    rig = Rig(gear=False)
    rig.start(EXTERNAL.replace("K.05", "K.16").replace("Z-1.2", "Z-.4"), TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert rig.said("thread") == []


def test_lead_error_without_following_would_exceed_the_limit() -> None:
    """The wander alone, at the commanded speed, is thirty times what the test above allows."""
    swing = 0.02 * 10.0 * 2.0 / (2.0 * math.pi)  # turns, of 10 a second, in a period of 2 s
    assert 2 * swing * LEAD > 30 * 0.0002


def test_passes_at_other_speeds_enter_at_the_same_angle(gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig)
    rig.start(EXTERNAL, TOOLS)
    for pot in (1.0, 0.8, 0.6):
        rig.until_true(lambda shot: shot.block_text.endswith("P"))
        rig.sim.machine.set_spindle_pot(pot)
        rig.until_true(lambda shot: shot.block_text.startswith("G00"))
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.parts == 1
    assert entries(recorder.phases(0)).max() < 0.2


def test_thread_with_a_reversed_spindle_is_accurate(gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig)
    rig.start(EXTERNAL.replace("M03", "M04"), TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert max(lead_errors(recorder.phases(0))) < 0.0001
    assert entries(recorder.phases(0)).max() < 0.2


def test_pull_out_stays_synchronized(gear: bool) -> None:
    rig = Rig(gear=gear)
    seen: list[tuple[float, float, float]] = []

    def look(shot: Snapshot) -> None:
        if shot.block_text.endswith("P"):
            now = rig.clock.now()
            (x, z, _), (_, vz, _) = rig.sim.ports.axes.demand_at(now)
            if vz < -12.0:  # not yet braking
                seen.append((x, z, rig.sim.machine.spindle_turns()))

    rig.watch.append(look)
    rig.start(HEAD + "G33X.237Z-.5I.025K.05PO\nM30\n".replace("X.237", "X.2"), TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    (x0, z0, turns0), (x1, z1, turns1) = seen[0], seen[-1]
    assert x1 - x0 > 1.0
    assert (z0 - z1) / (turns1 - turns0) == pytest.approx(LEAD * INCH, rel=2e-3)
    # at 45 degrees, behind X by the ramp from rest: v²/2a = 12.7²/6096
    assert x1 - x0 == pytest.approx(z0 - z1, abs=0.03)


def test_thread_ends_at_the_programmed_position(gear: bool) -> None:
    rig = Rig(gear=gear)
    rig.start(HEAD + "G33X.2Z-.5I.025K.05PO\nM00\nM30\n", TOOLS)
    ends: list[tuple[float, ...]] = []
    rig.watch.append(lambda shot: ends.append(shot.demand[:2]) if shot.block_text.endswith("P") else None)
    rig.until(MachineState.PROGRAM_STOP, MachineState.FAULT)
    out = 0.312 - 0.2
    assert ends[-1] == pytest.approx((0.312 * INCH, (-0.5 - out) * INCH), abs=1e-6)
    assert rig.shot.demand[:2] == pytest.approx((0.237 * INCH, 0.2 * INCH), abs=1e-6)


def in_thread(rig: Rig, z: float = -0.2) -> None:
    rig.until_true(lambda shot: shot.block_text.startswith("G33") and shot.demand[1] < z * INCH)


@pytest.mark.parametrize(("program", "z"), [(EXTERNAL, -1.2 - 0.075), (STRAIGHT_OUT, -1.2)])
def test_hold_in_a_pass_acts_at_its_end(program: str, z: float, gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig)
    rig.start(program, TOOLS)
    in_thread(rig)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.demand[:2] == pytest.approx((RETRACT, z * INCH), abs=1e-4)
    rig.run(1.0)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.parts == 1
    assert entries(recorder.phases(0)).max() < 0.2


@pytest.mark.parametrize(
    ("program", "z"),
    [(EXTERNAL, -0.2), (STRAIGHT_OUT, -0.2), (EXTERNAL, -1.19)],
    ids=["P", "straight", "pull-out"],
)
def test_lost_spindle_never_moves_the_tool_deeper(program: str, z: float, gear: bool) -> None:
    rig = Rig(gear=gear, every=FINE)
    rig.start(program, TOOLS)
    in_thread(rig, z)
    depth = rig.shot.demand[0]
    deepest = [depth]
    rig.watch.append(lambda shot: deepest.append(min(deepest[-1], shot.demand[0])))
    rig.sim.machine.spindle_bog(0.2)
    rig.until(MachineState.FAULT)
    rig.run(0.5)
    assert rig.shot.alarms[0].code == "thread-lost"
    assert rig.shot.demand[0] == pytest.approx(RETRACT, abs=1e-4)
    assert deepest[-1] > depth - 1e-6
    assert rig.shot.rpm_command == 0.0


@pytest.mark.parametrize("z", [-0.2, -1.19], ids=["thread", "pull-out"])
def test_lost_thread_is_retracted_only_once(gear: bool, z: float) -> None:
    """While the tool is on its way out the spindle stays lost: nothing is begun anew by that."""
    rig = Rig(gear=gear, every=FINE)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig, z)
    rig.sim.machine.spindle_bog(0.2)
    rig.until(MachineState.FAULT)
    assert rig.said("thread").count(text("executor.spindle-lost")) == 1


def test_pass_waiting_for_the_index_does_not_start_after_hold(gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig, 0.2)
    rig.start(EXTERNAL.replace("S600", "S60").replace("K.05", "K.2"), TOOLS)  # a turn takes a second
    rig.until_true(lambda shot: shot.block_text.startswith("G33"))
    stood = rig.shot.demand
    rig.post(FeedHold())
    rig.until(MachineState.HOLD, limit=0.2)
    rig.run(3.0)
    assert rig.shot.demand == pytest.approx(stood)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=300)
    assert rig.shot.parts == 1
    assert entries(recorder.phases(0)).max() < 0.2


def test_thread_at_maximum_axis_speed_is_reported_without_an_alarm(gear: bool) -> None:
    """300 in/min and a spindle that runs 2 % fast: the slide falls behind, and that is told."""
    rig = Rig(gear=gear)
    rig.sim.machine.spindle_wander(0.02, 2.0)
    rig.start(HEAD.replace("S600", "S2000").replace("Z.2", "Z.5") + "G33X.212Z-2.I.025K.15P\nM30\n", TOOLS)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    assert rig.said("thread")


def test_pass_completes_when_the_encoder_fails(monkeypatch: pytest.MonkeyPatch, gear: bool) -> None:
    rig = Rig(gear=gear)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig)
    monkeypatch.setattr(rig.sim.ports.spindle, "read_angle", lambda: None)
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "thread-no-encoder"
    assert rig.shot.demand[1] == pytest.approx(0.2 * INCH)  # the next pass did not begin


def test_reset_in_a_pass_stops_along_the_thread(gear: bool) -> None:
    rig = Rig(gear=gear)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig)
    before = rig.shot.demand
    rig.post(Reset())
    rig.run(1.0)
    assert rig.state in {MachineState.IDLE, MachineState.DISABLED}
    assert rig.shot.demand[0] == pytest.approx(before[0], abs=1e-6)
    assert -2.0 < rig.shot.demand[1] - before[1] < 0.0


def test_pass_completes_while_the_host_is_away(gear: bool) -> None:
    rig = Rig(gear=gear)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig)
    rig.tick(6.0)  # the pass takes less
    assert rig.shot.demand[:2] == pytest.approx((RETRACT, (-1.2 - 0.075) * INCH), abs=1e-4)
    assert rig.shot.alarms == ()


def test_braked_spindle_in_a_pass_is_followed_and_reported(gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig)
    rig.sim.machine.set_spindle_pot(0.7)
    rig.until_true(lambda shot: shot.block_text.endswith("P"))
    assert len(rig.said("thread")) == (0 if gear else 1)
    last = recorder.phases(0)[0][-5:, 1]
    first = recorder.phases(0)[0][0, 1]
    assert np.abs(last - first).max() < 0.002  # of a turn: in step again


def test_feed_override_does_not_touch_a_pass(gear: bool) -> None:
    rig = Rig(gear=gear)
    recorder = Recorder(rig)
    rig.start(EXTERNAL, TOOLS)
    in_thread(rig)
    rig.sim.machine.set_feed_pot(0.2)
    rig.until_true(lambda shot: shot.block_text.endswith("P"))
    assert lead_errors(recorder.phases(0))[0] < 0.0001


# --- the spindle's angle ------------------------------------------------------------------------------------


def test_constant_spindle_speed_is_predicted_exactly() -> None:
    turns = SpindleAnglePredictor()
    for i in range(20):
        turns.add_reading((0.01 * i, -3.0 - 0.1 * i))
    assert turns.predict_angle(0.5) == pytest.approx((-8.0, -10.0))


def test_too_few_readings_give_no_prediction() -> None:
    turns = SpindleAnglePredictor()
    assert turns.predict_angle(0.0) is None
    for i in range(30):
        turns.add_reading((1.0, 5.0 + i))  # the same moment again says nothing
    assert turns.predict_angle(1.0) is None
    for i in range(30):
        turns.add_reading((1.0 + 0.01 * i, 5.0 + 0.1 * i))
    assert turns.predict_angle(1.0) is not None
    turns.add_reading(None)
    assert turns.predict_angle(2.0) is None


def test_oscillating_speed_is_predicted_within_a_fifth_of_a_degree() -> None:
    turns, worst = SpindleAnglePredictor(), 0.0

    def truth(t: float) -> float:
        return 10.0 * (t - 0.02 / math.pi * math.cos(math.pi * t))  # 600 rpm, 2 % in 2 s

    for i in range(400):
        t = 0.01 * i
        turns.add_reading((t, round(truth(t) * 4096) / 4096))
        found = turns.predict_angle(t + 0.045)
        if found is not None and i > 25:
            worst = max(worst, abs(found[0] - truth(t + 0.045)))
    assert worst * 360.0 < 0.2
