"""A thread pass under every slope of the spindle: followed to its end, or drawn out of the metal and told.

The operator turns the pot, the cut loads the motor, it stalls, is switched off, comes back: at any place
of a pass, at any speed and lead, on a driver with a gear and on one without.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from core.executor.commands import CycleStart, FeedHold
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.ports import DriverError
from drivers.wakeups import ManualClock
from tests.executor.rig import INCH, CreepingClock, Rig
from tests.texts import pattern, text

pytestmark = pytest.mark.long

TOOLS = {4: ToolOffset()}
V, A = 127.0, 3048.0  # of the shipped lathe
START, DEPTH, FIRST = 0.237, 0.231, 0.025  # in; two passes
OUT = START + 3 * FIRST  # in, where X is drawn out to
FORMS: dict[str, tuple[str, float | None]] = {  # a pass, and where X is drawn out to where that is one place
    "P": (f"G33X{DEPTH}Z-.7I{FIRST}K%gP", OUT),
    "straight": (f"G33X{DEPTH}Z-.7I{FIRST}K%g", OUT),
    "taper": (f"G33X{DEPTH}Z-.7I{FIRST}K%gA.02P", None),
    "bore": (f"G33X{START + 0.006}Z-.7I{FIRST}K%gP", START - 3 * FIRST),
}


@dataclass
class Slides:
    """Setpoints of X and Z at every tick: what they ask of the slides, and how they follow the spindle."""

    rig: Rig
    lead: float  # in
    rows: list[tuple[float, float, float, float, float, float]] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.rig.watch.append(self._look)

    def _look(self, shot: Snapshot) -> None:
        now, sim = self.rig.clock.now(), self.rig.sim
        (x, z, _), (vx, vz, _) = sim.ports.axes.demand_at(now)
        self.rows.append((now, x, z, vx, vz, sim.machine.spindle_turns()))
        self.texts.append(shot.block_text)

    def demand_sane(self) -> None:
        """No jump, no speed and no acceleration beyond what the slides have."""
        t, p, v = (np.array(self.rows)[:, part] for part in (0, slice(1, 3), slice(3, 5)))
        dt = np.diff(t)[:, None]
        assert np.abs(v).max() <= 1.001 * V
        assert (np.abs(np.diff(v, axis=0)) <= 1.3 * A * dt + 1.01 * A * 0.001).all()
        off = np.diff(p, axis=0) - 0.5 * (v[1:] + v[:-1]) * dt
        assert (np.abs(off) <= 0.25 * 1.4 * A * dt**2 + 0.002).all()

    def lead_errors(self) -> list[float]:
        """Of each pass, how much its thread is off between Z.2 and Z-.55, in."""
        table, inside = np.array(self.rows), [text.startswith("G33") for text in self.texts]
        z, turns, vz = table[:, 2] / INCH, np.abs(table[:, 5]), table[:, 4]
        cut = np.array(inside) & (z < 0.1) & (z > -0.55) & (vz < 0.0)
        passes = np.split(np.flatnonzero(cut), np.flatnonzero(np.diff(np.flatnonzero(cut)) > 1) + 1)
        return [float(np.ptp(z[one] / self.lead + turns[one])) * self.lead for one in passes if len(one) > 3]


def begun(
    rpm: int,
    lead: float,
    form: str,
    pot: float = 1.0,
    *,
    gear: bool = True,
    clock_kind: type[ManualClock] = ManualClock,
) -> tuple[Rig, Slides]:
    """A rig under way to the thread."""
    rig = Rig(gear=gear, clock_kind=clock_kind)
    rig.sim.machine.set_spindle_pot(pot)
    slides = Slides(rig, lead)
    coarse = f"G35F2\nG92X{START}Z.5\n" if lead > 0.2 else ""
    word = FORMS[form][0] % lead
    rig.start(f"G90G94F300G73\nM03S{rpm}\nT4\nX.3Z.5\nX{START}\n{coarse}{word}\nM30\n", TOOLS)
    return rig, slides


def at_z(z: float) -> Callable[[Snapshot], bool]:
    return lambda shot: shot.block_text.startswith("G33") and shot.demand[1] < z * INCH


def down_and_up(rig: Rig, to: float) -> None:
    rig.sim.machine.set_spindle_pot(to)
    rig.run(0.3)
    rig.sim.machine.set_spindle_pot(1.0)


def load_and_back(rig: Rig, _: float) -> None:
    rig.sim.machine.spindle_bog(0.55)
    rig.run(0.25)
    rig.sim.machine.spindle_bog(1.0)


SLOPES: dict[str, Callable[[Rig, float], None]] = {
    "pot": lambda rig, to: rig.sim.machine.set_spindle_pot(to),
    "pot at 0": lambda rig, _: rig.sim.machine.set_spindle_pot(0.0),
    "load": lambda rig, to: rig.sim.machine.spindle_bog(to),
    "stall": lambda rig, _: rig.sim.machine.spindle_bog(0.0),
    "switch off": lambda rig, _: rig.sim.machine.set_spindle_auto(False),
    "down and up": down_and_up,
    "load and back": load_and_back,
    "up": lambda rig, _: rig.sim.machine.set_spindle_pot(1.0),
}
_PAIRS = [(60, 0.2), (150, 0.4), (300, 0.1), (300, 0.4), (600, 0.05), (600, 0.2), (1200, 0.1), (2500, 0.05)]


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    pair=st.sampled_from(_PAIRS),
    form=st.sampled_from(sorted(FORMS)),
    slope=st.sampled_from(sorted(SLOPES)),
    to=st.sampled_from([0.95, 0.8, 0.5, 0.45, 0.3]),
    z=st.sampled_from([0.49, 0.4, 0.1, -0.2, -0.6, -0.68, -0.699]),
    gear=st.booleans(),
    clock=st.sampled_from(["step", "step", "fine", "creeping"]),
)
@example(pair=(300, 0.1), form="P", slope="pot", to=0.5, z=-0.2, gear=True, clock="step")
@example(pair=(300, 0.1), form="straight", slope="up", to=0.3, z=0.1, gear=True, clock="creeping")
def test_thread_pass_is_completed_or_retracted(
    pair: tuple[int, float], form: str, slope: str, to: float, z: float, gear: bool, clock: str
) -> None:
    kind = CreepingClock if clock == "creeping" else ManualClock
    rig, slides = begun(*pair, form, to if slope == "up" else 1.0, gear=gear, clock_kind=kind)
    if clock == "fine":
        rig.every = 0.0025
    rig.until_true(at_z(z), limit=100.0)
    SLOPES[slope](rig, to)
    rig.until(MachineState.IDLE, MachineState.FAULT, MachineState.HOLD, limit=200.0)
    rig.run(0.2)
    slides.demand_sane()
    codes = [alarm.code for alarm in rig.shot.alarms]
    assert codes in ([], ["thread-lost"]) or (codes == ["at-speed"] and slope == "load")
    out = FORMS[form][1]
    if codes == ["thread-lost"] and out is not None:
        assert rig.shot.demand[0] == pytest.approx(out * INCH, abs=1e-4)
    if rig.state is MachineState.HOLD:  # behind the pass, or before it
        assert slope in {"switch off", "pot at 0", "stall", "load"}
        assert out is None or rig.shot.demand[0] == pytest.approx(out * INCH, abs=1e-4) or _clear(rig)
    if not codes and gear and not rig.said("thread"):
        assert max(slides.lead_errors(), default=0.0) < 0.0002


def _clear(rig: Rig) -> bool:
    """At the start of the next pass, in the air."""
    return bool(rig.shot.demand[1] == pytest.approx(0.5 * INCH, abs=1e-3))


# --- by hand ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gear", [True, False], ids=["gear", "time"])
@pytest.mark.parametrize("z", [0.49, 0.1, -0.3, -0.65])
def test_raised_override_is_not_a_lost_spindle(z: float, gear: bool) -> None:
    """From 40 to 100 % the command is at once more than twice what is measured."""
    rig, _ = begun(300, 0.1, "P", 0.4, gear=gear)
    rig.until_true(at_z(z))
    rig.sim.machine.set_spindle_pot(1.0)
    rig.until(MachineState.IDLE, MachineState.FAULT, MachineState.HOLD)
    assert (rig.shot.alarms, rig.shot.parts) == ((), 1)


@pytest.mark.parametrize("gear", [True, False], ids=["gear", "time"])
def test_drive_turning_in_the_wrong_direction_is_a_lost_spindle(gear: bool) -> None:
    rig, _ = begun(300, 0.1, "P", gear=gear)
    rig.until_true(at_z(-0.2))
    rig.sim.ports.spindle.set_speed(-300.0)  # an inverter gone mad: nobody asked for it
    rig.until(MachineState.FAULT)
    rig.run(0.5)
    assert rig.shot.alarms[0].code == "thread-lost"
    assert rig.shot.demand[0] == pytest.approx(OUT * INCH, abs=1e-4)


@pytest.mark.parametrize("gear", [True, False], ids=["gear", "time"])
def test_tool_leaves_the_thread_along_x_and_never_deeper(gear: bool) -> None:
    rig, slides = begun(600, 0.2, "P", gear=gear)
    rig.until_true(at_z(-0.3))
    began = len(slides.rows)
    rig.sim.machine.set_spindle_auto(False)
    rig.until(MachineState.FAULT)
    x, z = (np.array(slides.rows[began:])[:, part] for part in (1, 2))
    leaving = np.flatnonzero(x > x[0] + 1e-6)[0]
    assert (x >= x[0] - 1e-6).all()
    assert np.ptp(z[leaving:]) < 1e-6
    assert x[-1] == pytest.approx(OUT * INCH, abs=1e-4)


def test_thread_alarm_reports_the_cause_and_the_thread() -> None:
    rig, slides = begun(300, 0.1, "P")
    rig.until_true(at_z(-0.3))
    rig.sim.machine.set_spindle_auto(False)
    rig.until(MachineState.FAULT)
    left = slides.rows[-1][2] / INCH
    assert rig.shot.alarms[0].cause == (
        text("executor.left-thread", why=text("executor.switch-off-refused"), z=f"{left:.4f}")
    )


def test_spindle_loss_in_the_pull_out_reports_the_thread_as_cut() -> None:
    rig, _ = begun(300, 0.1, "P")
    rig.until_true(lambda shot: shot.block_text.endswith("P"))
    rig.sim.machine.spindle_bog(0.1)
    rig.until(MachineState.FAULT)
    assert re.fullmatch(pattern("executor.thread-cut"), rig.shot.alarms[0].cause)


@pytest.mark.parametrize("gear", [True, False], ids=["gear", "time"])
def test_pass_waiting_for_its_index_is_canceled_and_repeated(gear: bool) -> None:
    """Switched OFF before anything has moved: a hold, and the pass begins at another index."""
    rig, slides = begun(60, 0.2, "P", gear=gear)
    rig.until_true(lambda shot: shot.block_text.startswith("G33"))
    stood = rig.shot.demand
    rig.sim.machine.set_spindle_auto(False)
    rig.until(MachineState.HOLD, MachineState.FAULT, limit=0.5)
    rig.run(3.0)
    assert rig.shot.alarms == ()
    assert rig.shot.demand == pytest.approx(stood)
    rig.sim.machine.set_spindle_auto(True)
    for _ in range(40):
        if rig.state is MachineState.HOLD:
            rig.run(1.0)
            rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=300.0)
    assert (rig.shot.alarms, rig.shot.parts) == ((), 1)
    assert max(slides.lead_errors()) < 0.0002


def test_a_stall_is_seen_while_the_command_still_rises() -> None:
    """Facing under G96 asks for more at every tick; a motor that stalls then is a lost spindle too."""
    rig = Rig()
    rig.start("G90G94F300G73\nG96S300\nM03\nT4\nX1Z0\nG95F.004X.2\nM30\n", TOOLS)
    rig.until_true(lambda shot: shot.demand[0] < 0.9 * INCH and shot.block_text.startswith("G95"))
    rig.sim.machine.spindle_bog(0.2)
    rig.until(MachineState.HOLD, MachineState.FAULT, limit=3.0)
    assert rig.shot.demand[0] > 0.6 * INCH


def test_hold_at_the_start_of_a_pass_acts_at_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """The driver foresees the first motion, the control does not yet: no alarm, the pass is made."""
    rig, _ = begun(300, 0.1, "P")
    rig.until_true(lambda shot: shot.block_text.startswith("G33"))

    def refused(_: object) -> None:
        raise DriverError("the slides follow the spindle", "broken-path")

    with monkeypatch.context() as begins:
        begins.setattr(rig.sim.ports.axes, "splice", refused)
        rig.post(FeedHold())
    rig.until(MachineState.HOLD, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[0] == pytest.approx(OUT * INCH, abs=1e-4)


def test_spindle_in_reverse_at_full_speed_is_lost() -> None:
    rig, _ = begun(300, 0.1, "P")
    rig.until_true(at_z(0.1))
    spindle = rig.executor._context.spindle
    assert not spindle.is_speed_lost
    spindle.measured_rpm = -spindle.measured_rpm
    assert spindle.is_speed_lost
