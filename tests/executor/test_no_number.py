"""Drivers that tell what is no number: no comparison trips on it, so it is looked for."""

from __future__ import annotations

import dataclasses
import math

import pytest

from core.executor.snapshot import MachineState
from core.ports import AxisSample, StationState
from tests.executor.rig import Rig
from tests.texts import text

CUT = "G90G94F300\nM03S600\nM08\nX.1\nG01F20Z-2\nM30\n"
ODD = pytest.mark.parametrize("odd", [math.nan, math.inf, -math.inf])


def cutting() -> Rig:
    rig = Rig()
    rig.start(CUT)
    rig.until_true(lambda shot: shot.actual[1] < -3.0)
    return rig


@ODD
@pytest.mark.parametrize("field", ["demand", "actual", "following_error"])
def test_nan_position_stops_the_machine(odd: float, field: str, monkeypatch: pytest.MonkeyPatch) -> None:
    rig = cutting()
    sample = rig.sim.ports.axes.sample

    def told() -> AxisSample:
        real = sample()
        x, _, *others = getattr(real, field)
        places = (x, odd, *others)
        match field:
            case "demand":
                return real._replace(demand=places)
            case "actual":
                return real._replace(actual=places)
        return real._replace(following_error=places)

    monkeypatch.setattr(rig.sim.ports.axes, "sample", told)
    rig.tick()
    assert rig.state is MachineState.FAULT
    assert text("executor.has-no-number", axis="Z") in rig.shot.alarms[0].cause
    monkeypatch.setattr(rig.sim.ports.axes, "sample", sample)
    rig.run(0.5)
    assert not rig.sim.ports.axes.sample().enabled


@ODD
def test_nan_spindle_speed_is_not_treated_as_stopped(odd: float, monkeypatch: pytest.MonkeyPatch) -> None:
    rig = cutting()
    monkeypatch.setattr(rig.sim.ports.spindle, "speed", lambda: odd)
    rig.tick()
    assert rig.state is MachineState.FAULT
    assert rig.shot.alarms[0].code == "spindle-encoder"
    assert rig.shot.rpm_actual == pytest.approx(600.0, rel=0.05)  # the last one: nobody opens a collet now
    rig.run(3.0)
    assert rig.sim.machine.get_spindle_rpm() == 0.0


@ODD
@pytest.mark.parametrize("field", ["feed_pot", "spindle_pot", "age"])
def test_nan_override_is_treated_as_a_silent_station(
    odd: float, field: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if field == "age" and odd < 0.0:
        pytest.skip("younger than now is young enough")
    rig = cutting()
    snapshot = rig.sim.ports.station.read_state

    def told() -> StationState:
        return dataclasses.replace(snapshot(), **{field: odd})  # type: ignore[arg-type]

    monkeypatch.setattr(rig.sim.ports.station, "read_state", told)
    rig.until(MachineState.HOLD, limit=0.5)
    assert rig.shot.waiting_for == text("executor.station-silent")
    assert rig.shot.feed_override == 1.0
    assert rig.shot.alarms == ()
