"""Simulated machines for the tests of this room."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from core.ports import FloatArray, MotionSegments
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.simulators.plant_config import SimAxis, SimConfig, SimOutput, SimSpindle
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ManualClock

SLIDE = SimAxis(
    name="X",
    vmax=127.0,
    amax=3048.0,
    count=0.00127,
    following_window=2.032,
    following_time=0.02,
    travel=(-101.6, 101.6),
    corner=3.048,
)
CONFIG = SimConfig(
    axes=(
        SLIDE,
        dataclasses.replace(SLIDE, name="Z", travel=(-152.4, 152.4)),
        SimAxis("C", 1200.0, 3600.0, 0.02, 5.0, 0.02, corner=3.6),
    ),
    spindle=SimSpindle(),
    outputs={"collet": SimOutput(None, True), "coolant": SimOutput(), "catcher": SimOutput()},
    inputs=("collet_closed", "TB2-5"),
)


def simulation(config: SimConfig = CONFIG, powered: bool = True) -> tuple[Simulation, ManualClock]:
    """A machine on a clock of its own, drives on unless said otherwise."""
    clock = ManualClock()
    sim = build_simulation(config, clock)
    if powered:
        sim.ports.axes.enable(True)
    return sim, clock


def ramp(start: float, p: Sequence[float] | FloatArray, x_speed: float, cruise: float) -> MotionSegments:
    """X from rest at ``p`` to ``x_speed``, on for ``cruise`` seconds, back to rest; 3000 mm/s²."""
    up = abs(x_speed) / 3000.0
    a = 3000.0 if x_speed > 0 else -3000.0
    dt = np.array([up, cruise, up])
    x = p[0] + np.array([0.0, 0.5 * x_speed * up, 0.5 * x_speed * up + x_speed * cruise])
    column = np.zeros(3)
    return MotionSegments(
        start + np.array([0.0, up, up + cruise]),
        dt,
        np.column_stack([x, column + p[1], column + p[2]]),
        np.column_stack([[0.0, x_speed, x_speed], column, column]),
        np.column_stack([[a, 0.0, -a], column, column]),
    )


def play(sim: Simulation, clock: ManualClock, seconds: float, tick: float = 0.01) -> None:
    """Let time pass, looking at the axes every ``tick``."""
    end = clock.now() + seconds
    while clock.now() < end - 1e-9:
        clock.advance(tick)
        sim.ports.axes.sample()


__all__ = ["CONFIG", "SLIDE", "PlantControls", "play", "ramp", "simulation"]
