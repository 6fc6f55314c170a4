"""Wires that break while everything moves: all slides stop, the reason is told, nothing starts by itself."""

from __future__ import annotations

import pytest

from core.ports import DriverError
from tests.drivers.contract.moves import start
from tests.drivers.contract.rigs import Rig

WITHIN = 0.45  # s: three heartbeats of 100 ms and a stop from 120 mm/s


def test_a_broken_wire_stops_every_slide_and_is_told(broken: tuple[Rig, str]) -> None:
    moving, fault = broken
    axes = moving.ports.axes
    moving.faults[fault]()
    moving.until(lambda: axes.sample().fault != "", WITHIN)
    moving.run(1.0)
    before = moving.sim.true_position()
    moving.run(0.3)
    assert moving.sim.true_position() == before
    assert not axes.sample().enabled
    with pytest.raises(DriverError):
        axes.splice(start(moving, 10.0, 0.1))
    with pytest.raises(DriverError):
        axes.enable(True)


def test_once_mended_only_a_clear_word_brings_power_back(broken: tuple[Rig, str]) -> None:
    moving, fault = broken
    axes = moving.ports.axes
    moving.faults[fault]()
    moving.run(1.5)
    moving.mend()
    moving.run(0.5)
    assert axes.sample().fault != ""
    assert not axes.sample().enabled
    if fault in moving.final:
        with pytest.raises(DriverError):
            axes.clear_fault()
        return
    axes.clear_fault()
    moving.run(0.3)
    assert axes.sample().fault == ""
    assert not axes.sample().enabled  # clearing a fault never gives power
    axes.enable(True)
    moving.run(0.3)
    before = moving.sim.true_position()[0]
    axes.splice(start(moving, -30.0, 0.2))
    moving.run(1.0)
    assert axes.sample().fault == ""
    assert moving.sim.true_position()[0] == pytest.approx(before - 30.0 * 0.21, abs=0.01)
