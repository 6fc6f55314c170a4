"""Wires that break while everything moves, at the ports: it is told in time, and nothing starts by itself."""

from __future__ import annotations

import pytest

from core.faults import get_fault_code
from core.ports import DriverError
from tests.drivers.contract.conftest import Broken
from tests.drivers.contract.rig import NINE, Rig
from tests.drivers.contract.rigs import RIGS, make

FULL = "full queue"  # is a load and no fault: test_setpoints, test_program
MISSING = [
    (name, what)
    for name, kind in RIGS.items()
    for what in NINE
    if what not in {*kind.faults, *kind.harmless, FULL}
]


@pytest.mark.parametrize(("name", "what"), MISSING, ids="-".join)
def test_fault_without_a_trial_has_a_stated_reason(name: str, what: str) -> None:
    """A skip with its reason for each of the nine that a driver has no trial of; without one it fails."""
    assert what in RIGS[name].missing, f"{name} neither has a trial of {what!r} nor says why not"
    pytest.skip(f"{name}: {RIGS[name].missing[what]}")


@pytest.mark.parametrize("name", RIGS)
def test_every_fault_of_a_driver_can_be_simulated(name: str) -> None:
    kind, rig = RIGS[name], make(name)
    assert set(rig.acts()) == {*kind.faults, *kind.harmless}
    assert not {*kind.faults, *kind.harmless} & set(kind.missing)
    rig.close()


def costs_no_time(rig: Rig) -> None:
    """On this clock whoever waits moves it."""
    now, ports = rig.clock.now(), rig.ports
    for look in (ports.axes.sample, ports.station.read_state, ports.io.inputs, ports.io.get_outputs):
        look()
    for ask in (ports.spindle.speed, ports.spindle.read_angle, ports.spindle.read_fault):
        ask()
    if ports.blocks is not None:
        ports.blocks.state()
    assert rig.clock.now() == now


def takes_no_orders(rig: Rig) -> None:
    """Power for what is broken is refused."""
    axes = rig.ports.axes
    if not axes.sample().fault:
        with pytest.raises(DriverError):
            rig.ports.spindle.set_speed(300.0)
        return
    assert not axes.sample().enabled
    with pytest.raises(DriverError):
        axes.enable(True)
    with pytest.raises(DriverError):
        rig.go(10.0, 0.1)


def test_fault_is_reported_in_time_and_only_clearing_allows_power(broken: Broken) -> None:
    (rig, fault), axes = broken, broken[0].ports.axes
    rig.ports.spindle.set_speed(600.0)
    rig.under_way()
    rig.acts()[fault]()
    rig.until(lambda: rig.told != "", rig.faults[fault].told)
    assert get_fault_code(rig.told, "axis") == rig.faults[fault].code
    assert rig.faults[fault].names in rig.told
    rig.run(0.1)
    assert rig.ports.unknown() == rig.faults[fault].unknown
    costs_no_time(rig)
    rig.run(0.8)
    costs_no_time(rig)
    takes_no_orders(rig)
    rig.mend()
    rig.run(rig.heals)
    takes_no_orders(rig)
    tripped = axes.sample().fault != ""
    axes.clear_fault()
    rig.until(lambda: rig.told == "", 2.0)
    rig.run(0.5)
    assert rig.told == ""
    rig.until(lambda: not rig.ports.unknown(), 2.0)
    assert axes.sample().enabled is not tripped
    assert rig.stands()
    axes.enable(True)
    rig.run(0.3)
    end = rig.go(-30.0, 0.2)
    rig.until(lambda: abs(rig.world.place()[0] - end) < 0.01, 2.0)
    assert rig.told == ""


def test_harmless_disturbance_does_not_affect_the_move(disturbed: Broken) -> None:
    rig, what = disturbed
    end = rig.under_way()
    rig.ports.spindle.set_speed(600.0)
    rig.acts()[what]()
    rig.run(1.5)
    assert rig.told == ""
    assert rig.ports.axes.sample().enabled
    assert rig.world.place()[0] == pytest.approx(end, abs=0.003)
    assert rig.world.rpm() == pytest.approx(600.0, abs=1.0)
