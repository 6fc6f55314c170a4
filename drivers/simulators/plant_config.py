"""What the simulated machine is made of: filled by the app from the machine file, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.setpoint_queue import AxisFigures
from drivers.simulated.simulated_table import PlannedFault


@dataclass(frozen=True, slots=True)
class SimAxis(AxisFigures):
    """One servo axis."""

    power_up: float = 0.0  # where the slide stands from home when power comes on
    bandwidth: float = 40.0  # Hz, of the position loop
    feed_forward: float = 0.9  # of the velocity: what is missing shows as following error
    reserve: float = 1.3  # the servo can accelerate this much harder than amax
    own_drive: bool = False  # of C: it can be positioned while the spindle turns


@dataclass(frozen=True, slots=True)
class SimSpindle:
    """AC spindle behind a frequency inverter; rpm and rpm/s, seconds."""

    rpm_max: float = 3500.0
    accel: float = 1500.0
    decel: float = 2500.0
    coast: float = 600.0
    latency: float = 0.08
    ppr: int = 1024
    orients: bool = False  # its drive stops it at an angle, to which it turns at
    orient_rpm: float = 60.0


@dataclass(frozen=True, slots=True)
class SimOutput:
    """One output: its state at power-up and what ``safe`` makes of it (None: keeps)."""

    safe: bool | None = False
    initial: bool = False


@dataclass(frozen=True, slots=True)
class SimCollet:
    """Collet with its switch; ``output`` on is clamped. Times seconds, ``spread`` a fraction of them."""

    output: str = "collet"
    closed_input: str = "collet_closed"
    open_time: float = 0.25
    close_time: float = 0.30
    spread: float = 0.2


@dataclass(frozen=True, slots=True)
class SimSetter:
    """A tool setter: the middle of its stylus from part zero, its size across, mm.

    ``tips``: X and Z at which the slides stand when a tip is on part zero, of each tool on the plate.
    """

    x: float
    z: float
    width: float
    tips: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class SimConfig:
    """The whole simulated machine."""

    axes: tuple[SimAxis, ...]
    spindle: SimSpindle = field(default_factory=SimSpindle)
    collet: SimCollet = field(default_factory=SimCollet)
    outputs: Mapping[str, SimOutput] = field(default_factory=dict)
    inputs: tuple[str, ...] = ()
    commit: float = 0.03
    step: float = 0.001  # of the servo model
    seed: int = 1
    faults: tuple[PlannedFault, ...] = ()
    setter: SimSetter | None = None
    measures_load: bool = False  # an input tells the spindle's load
    palms: float = 0.5  # seconds within which both palms must go down
    start_pulse: float = 0.1  # how long the two-hand relay holds its output at least
