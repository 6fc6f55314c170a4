"""Configuration of the simulated machine, which the app fills from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.setpoint_queue import AxisFigures
from drivers.simulated.simulated_table import PlannedFault


@dataclass(frozen=True, slots=True)
class SimAxis(AxisFigures):
    """Simulated servo axis."""

    power_up: float = 0.0  # Position relative to home at power-up.
    bandwidth: float = 40.0  # Bandwidth of the position loop in Hz.
    feed_forward: float = 0.9  # Fraction of the velocity; the rest appears as following error.
    reserve: float = 1.3  # Factor by which the servo can exceed amax.
    own_drive: bool = False  # C only: the axis can be positioned while the spindle turns.


@dataclass(frozen=True, slots=True)
class SimSpindle:
    """Simulated AC spindle with a frequency inverter: speeds in rpm, ramps in rpm/s, times in seconds."""

    rpm_max: float = 3500.0
    accel: float = 1500.0
    decel: float = 2500.0
    coast: float = 600.0
    latency: float = 0.08
    ppr: int = 1024
    orients: bool = False  # The drive can stop the spindle at an angle; it turns there at orient_rpm.
    orient_rpm: float = 60.0


@dataclass(frozen=True, slots=True)
class SimOutput:
    """Simulated output with its state at power-up and its safe state; None leaves the output unchanged."""

    safe: bool | None = False
    initial: bool = False


@dataclass(frozen=True, slots=True)
class SimCollet:
    """Simulated collet with its switch; the output is on while the collet is clamped.

    Times are in seconds. ``spread`` is the random variation of the times as a fraction.
    """

    output: str = "collet"
    closed_input: str = "collet_closed"
    open_time: float = 0.25
    close_time: float = 0.30
    spread: float = 0.2


@dataclass(frozen=True, slots=True)
class SimSetter:
    """Simulated tool setter: center of its stylus relative to part zero, and its width, in mm.

    ``tips`` has X and Z of the axes when the tip is at part zero, for each tool on the plate.
    """

    x: float
    z: float
    width: float
    tips: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class SimConfig:
    """Configuration of the complete simulated machine."""

    axes: tuple[SimAxis, ...]
    spindle: SimSpindle = field(default_factory=SimSpindle)
    collet: SimCollet = field(default_factory=SimCollet)
    outputs: Mapping[str, SimOutput] = field(default_factory=dict)
    inputs: tuple[str, ...] = ()
    commit: float = 0.03
    step: float = 0.001  # Interval of the servo model in s.
    seed: int = 1
    faults: tuple[PlannedFault, ...] = ()
    setter: SimSetter | None = None
    measures_load: bool = False  # An input measures the spindle load.
    palms: float = 0.5  # Seconds within which both palm buttons must be pressed.
    start_pulse: float = 0.1  # Minimum pulse of the two-hand relay in s.
