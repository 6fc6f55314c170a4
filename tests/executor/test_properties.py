"""Whatever is asked, whenever: the demand is continuous and within its limits, and the queue ends at rest."""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    FeedHold,
    HomeAxes,
    Jog,
    Reset,
    SetFeedOverride,
    SetSpindleLimit,
    SetSwitch,
    StopJog,
)
from core.executor.snapshot import MachineState
from tests.executor.rig import INCH, Rig

pytestmark = pytest.mark.long

PART = """G90G94F300
M03S2000
X1Z-.5
G01F60Z-1
G02X1.5Z-1.5I1.5K-1
G95F.01X2Z-1.8
G94F100
G03X1.2Z-1.9R.9
M08
X1.1Z-1
X1.05Z-1.01
X1Z-1
G04F.2
M13
M12
M01
X0Z0
M30
"""

COMMANDS = st.one_of(
    st.just(CycleStart()),
    st.just(FeedHold()),
    st.just(Reset()),
    st.just(EnableDrives()),
    st.just(StopJog()),
    st.just(HomeAxes()),
    st.builds(SetFeedOverride, st.sampled_from([0.0, 0.07, 0.5, 1.0, 1.5])),
    st.builds(SetSwitch, st.sampled_from(["single_block", "optional_stop", "cycle_repeat"]), st.booleans()),
    st.builds(
        Jog, st.sampled_from("XZC"), st.sampled_from([-50.0, -1.0, 3.0, 50.0]), st.sampled_from([0.05, 0.3])
    ),
    st.builds(SetSpindleLimit, st.sampled_from([None, 900.0])),
)
HANDS = st.sampled_from(
    [
        "press_start",
        "press_hold",
        "release_hold",
        "press_estop",
        "release_estop",
    ]
)
STEPS = st.lists(st.tuples(st.floats(0.0, 1.2), st.one_of(COMMANDS, HANDS)), min_size=3, max_size=14)


class Observer:
    """Looks at the queue every 2 ms of machine time."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        axes = rig.machine.axes
        self.vmax = [axis.max_speed for axis in axes]
        self.amax = [axis.max_acceleration for axis in axes]
        self.before: tuple[float, tuple[float, ...], tuple[float, ...]] | None = None

    def look(self) -> None:
        sink = self.rig.sim.ports.axes
        now = self.rig.clock.now()
        p, v = sink.demand_at(now)
        for i, axis in enumerate(self.rig.machine.axes):
            assert abs(v[i]) <= axis.max_speed * 1.0001
            if axis.travel is not None:
                assert axis.travel[0] - 0.01 <= p[i] <= axis.travel[1] + 0.01
        if self.before is not None:
            self._continuous(now, p, v)
        self.before = now, p, v
        assert sink.demand_at(sink.horizon() + 1e-6)[1] == (0.0, 0.0, 0.0)

    def _continuous(self, now: float, p: tuple[float, ...], v: tuple[float, ...]) -> None:
        assert self.before is not None
        then, p0, v0 = self.before
        dt = now - then
        for i in range(3):
            if not self.rig.sim.ports.axes.sample().enabled:
                continue
            assert abs(p[i] - p0[i]) <= self.vmax[i] * dt + 0.0021
            # a corner may change the velocity at once by amax * 1 ms, and two splices may meet it
            assert abs(v[i] - v0[i]) <= self.amax[i] * (dt + 0.003) * math.sqrt(2) + 0.1


@pytest.mark.parametrize("base", [0, 1])
@settings(max_examples=12, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(steps=STEPS)
def test_random_commands_never_cause_a_program_alarm(
    base: int, steps: list[tuple[float, Command | str]]
) -> None:
    rig = Rig()
    rig.ready()
    rig.load(PART)
    if base:
        rig.post(CycleStart())
    observer = Observer(rig)
    for wait, step in steps:
        for _ in range(int(wait / 0.01)):
            for _ in range(4):
                rig.clock.advance(0.002)
                observer.look()
            rig.tick(0.002)
            observer.look()
        if isinstance(step, str):
            getattr(rig.sim.machine, step)()
        else:
            rig.executor.post(step)
    assert "internal" not in {alarm.code for alarm in rig.shot.alarms}
    assert "driver" not in {alarm.code for alarm in rig.shot.alarms}
    assert "program" not in {alarm.code for alarm in rig.shot.alarms}
    estop(rig)


def estop(rig: Rig) -> None:
    """Wherever it got to: E-stop ends it, and release starts nothing."""
    rig.sim.machine.press_estop()
    rig.run(0.3)
    assert rig.state is MachineState.ESTOP
    rig.sim.machine.release_estop()
    rig.run(4.0)
    assert rig.state is MachineState.DISABLED
    assert rig.sim.machine.get_spindle_rpm() == 0.0
    assert not rig.sim.ports.axes.sample().moving
    assert rig.shot.outputs <= {"collet"}


@settings(max_examples=15, deadline=None, derandomize=True)
@given(
    holds=st.lists(st.floats(0.0, 0.9), min_size=1, max_size=6),
    overrides=st.lists(st.sampled_from([0.1, 0.4, 1.0, 1.5]), min_size=1, max_size=6),
)
def test_stops_and_overrides_do_not_change_the_end_position(
    holds: list[float], overrides: list[float]
) -> None:
    rig = Rig()
    rig.start("G90G94F300\nX1Z-.5\nG01F150Z-1\nG02X1.5Z-1.5I1.5K-1\nX2Z-1.8\nX2.1Z-1.7\nM08\nZ-1\nM30\n")
    for wait, fraction in zip(holds, overrides, strict=False):
        rig.run(wait)
        rig.post(SetFeedOverride(fraction), FeedHold())
        rig.until(MachineState.HOLD, MachineState.IDLE, limit=5.0)
        if rig.state is MachineState.HOLD:
            rig.run(0.35)
            rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.shot.alarms == ()
    assert rig.shot.demand == pytest.approx((2.1 * INCH, -1.0 * INCH, 0.0), abs=1e-6)
