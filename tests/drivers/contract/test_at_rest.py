"""On every driver that tells where its slides are: jammed, pushed, run away, an encoder that stands."""

from __future__ import annotations

import math

import pytest

from core.executor.commands import EnableDrives, FeedHold, Reset
from core.executor.snapshot import MachineState
from tests.drivers.contract.conftest import need
from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import STILL

CUT = "G90G94F300\nX.1\nG01F20Z-2\nM30\n"
OURS = {"standstill", "following", "encoder-still", "axis"}


def off(control: Control, limit: float) -> float:
    """Run until the drives have no power; how long it took."""
    began = control.clock.now()
    while control.rig.ports.axes.sample().enabled:
        assert control.clock.now() - began < limit, control.shot
        control.tick()
    assert control.shot.alarms[0].code in OURS
    assert "Z" in control.shot.alarms[0].cause
    return control.clock.now() - began


@pytest.mark.parametrize("held", [False, True], ids=["ready", "hold"])
def test_axis_forced_away_at_rest_loses_power(control: Control, held: bool) -> None:
    need(control.rig, "slides")
    control.start(CUT) if held else control.ready()
    if held:
        control.until_true(lambda _: control.world.place()[1] < -5.0)
        control.post(FeedHold())
        control.until(MachineState.HOLD, limit=1.0)
    control.run(0.5)
    control.rig.slides.jam("Z")
    control.rig.slides.push("Z", 0.5)
    place = control.world.place()
    assert off(control, 0.4) < 0.4
    control.run(0.1)  # until a drive on a bus has heard it
    control.rig.slides.jam("Z", False)
    control.run(0.5)
    assert math.dist(control.world.place(), place) < STILL  # and does not leap back when it comes free
    control.post(Reset())
    control.until(MachineState.DISABLED, limit=1.0)
    control.post(EnableDrives())
    control.until(MachineState.IDLE, limit=1.0)
    control.run(0.5)
    assert math.dist(control.world.place(), place) < 0.005


@pytest.mark.parametrize(("speed", "most"), [(2.0, 1.0), (20.0, 4.0)])
def test_runaway_drive_at_rest_is_stopped(control: Control, speed: float, most: float) -> None:
    need(control.rig, "slides")
    control.ready()
    control.run(0.5)
    place = control.world.place()[1]
    control.rig.slides.runaway("Z", speed)
    off(control, 0.6)
    control.rig.slides.runaway("Z", 0.0)
    control.run(0.5)
    assert abs(control.world.place()[1] - place) < most


def test_encoder_that_stops_counting_in_a_cut_stops_the_axis(control: Control) -> None:
    need(control.rig, "slides")
    control.start(CUT)
    control.until_true(lambda _: control.world.place()[1] < -5.0)
    place = control.world.place()[1]
    control.rig.slides.encoder_stuck("Z")
    off(control, 0.4)
    control.run(1.0)
    assert abs(control.world.place()[1] - place) < 25.0  # a drive brakes for its time, whatever it does
