"""Acceptance tests that are rules of the executor: each on every driver, with its bound."""

from __future__ import annotations

import math
import re

import pytest

from core.executor.commands import CycleStart, EnableDrives, Jog, LoadJob, Reset
from core.executor.job import Proof, make_job
from core.executor.snapshot import MachineState
from core.language.source import ProgramSource
from tests.drivers.contract.conftest import need
from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import STILL, TICK
from tests.drivers.contract.test_cycle import PART, off_line
from tests.drivers.contract.test_stopped import cutting
from tests.texts import pattern, text

AMAX = 3000.0  # mm/s², the least of all drivers here


def on(control: Control) -> set[str]:
    """The outputs that are."""
    return {name for name, state in control.world.outputs().items() if state}


@pytest.mark.parametrize("stall", [0.5, 5.0])
def test_stalled_host_leaves_the_axes_on_their_path(control: Control, stall: float) -> None:
    cutting(control)
    off, way, before = 0.0, 0.0, control.world.place()
    for _ in range(round(stall / TICK)):
        control.rig.alone(TICK)
        off = max(off, off_line(control.world.place()))
        way, before = way + math.dist(control.world.place(), before), control.world.place()
    assert off < 0.005
    assert way < 127.0 * 1.3  # of what it has, and nothing more
    control.tick()
    assert any(re.search(r"[0-9.]+ s$", said) for said in control.said("starved"))
    assert control.shot.alarms == ()
    control.run(1.0)
    assert (control.state is MachineState.HOLD) is (stall > 1.0)  # setpoints or blocks for a second are ahead
    if control.state is MachineState.HOLD:
        control.press()
    control.until(MachineState.IDLE)
    assert control.shot.alarms == ()
    # Where a driver host has made the machine safe meanwhile, somebody has to look at the part.
    disturbed = any(re.match(pattern("executor.cycle-disturbed"), said) for said in control.said("uncounted"))
    assert (control.shot.ends, control.shot.parts) == (1, 0 if disturbed else 1)
    assert not disturbed or stall > 1.0
    assert control.world.place() == pytest.approx((0.0, 0.0), abs=0.003)


def test_jog_that_is_not_renewed_ends_with_its_lease(control: Control) -> None:
    speed, lease = 30.0, 0.2
    control.ready()
    control.run(0.5)
    for _ in range(15):
        control.post(Jog("X", speed, lease))
        control.run(0.03)
    last, at = control.clock.now() - 0.03, control.world.place()[0]
    assert control.state is MachineState.JOG
    control.rest(lease + 0.1)
    late = control.rig.runs_on
    assert control.clock.now() - last <= lease + 0.1 + late
    assert control.world.place()[0] - at <= (lease + late) * speed + speed * speed / (2 * AMAX) + STILL
    control.until(MachineState.IDLE, limit=0.5)
    assert control.shot.alarms == ()


def test_following_error_of_one_axis_brakes_all_axes(control: Control) -> None:
    if "following error" not in control.rig.faults:
        pytest.skip("its drives are none of this control's: their error is an alarm of the controller")
    cutting(control)
    struck, speed = control.clock.now(), 127.0
    control.rig.acts()["following error"]()
    window, patience = 2.032, 0.02
    control.until(MachineState.FAULT, limit=0.2)
    control.rest(0.2)
    # a tick in which it happens and one in which it is seen; the other axis brakes by its ramp
    assert control.clock.now() - struck <= window / speed + patience + 0.03 + speed / AMAX + 2 * TICK
    assert "X" in control.shot.alarms[0].cause
    assert not control.rig.ports.axes.sample().enabled
    assert not control.shot.powered


def test_estop_at_any_time_switches_all_off_and_release_starts_nothing(control: Control) -> None:
    for after in (0.3, 1.0, 2.0):
        control.start(PART)
        control.run(after)
        control.world.press_estop()
        control.until(MachineState.ESTOP, limit=0.3)
        control.rest(0.2)
        control.until_true(lambda _: control.world.rpm() == 0.0, 5.0)
        assert on(control) <= {"collet", *control.rig.kept_in_estop}
        assert not control.rig.ports.axes.sample().enabled
        stood = control.world.place()
        control.world.release_estop()
        control.run(1.0)
        control.post(CycleStart())
        control.press()
        assert control.state in {MachineState.DISABLED, MachineState.FAULT}
        control.post(Reset())
        control.until(MachineState.DISABLED, limit=3.0)
        control.post(EnableDrives())
        control.until(MachineState.IDLE, limit=0.5)
        control.run(0.5)
        assert on(control) <= {"collet"}
        assert control.world.place() == pytest.approx(stood, abs=0.01)
        assert control.world.rpm() == 0.0
        assert control.shot.parts == 0


def test_silent_station_retains_its_pots_and_causes_hold(control: Control) -> None:
    need(control.rig, "station")
    control.start("G90G94F300\nG01F30Z-5\nM30\n")
    control.run(1.0)
    control.world.set_feed_pot(0.8)
    control.run(0.5)
    control.world.silence_station()
    control.run(0.27)
    assert control.state is MachineState.RUN
    control.until(MachineState.HOLD, limit=0.3)
    assert control.shot.feed_override == pytest.approx(0.8)
    assert control.shot.waiting_for == text("executor.station-silent")


def test_two_start_signals_within_a_bounce_start_one_cycle(control: Control) -> None:
    control.ready()
    control.load("G90G94F300\nX.01\nM30\n")
    control.run(0.5)
    control.world.press_start()
    control.run(0.12)
    control.world.press_start()
    control.run(1.5)
    assert control.said("start") == ["PART"]
    assert control.shot.parts == 1


def test_program_changed_since_its_proof_is_refused(control: Control) -> None:
    control.ready()
    job = control.load("G90G94F300\nX1\nM30\n")
    other = make_job(ProgramSource("PART", "G90G94F300\nX2\nM30\n"), job.setup)
    control.post(LoadJob(other, Proof(job.digest, ())))
    control.press()
    assert control.state is MachineState.IDLE
    assert text("executor.other-proof") in control.shot.start_refusal_reason
    assert control.nothing_moves()
