"""Configuration of the simulated machine, as read from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.setpoint_queue import AxisProperties
from drivers.simulated.simulated_table import PlannedFault


@dataclass(frozen=True, slots=True)
class SimAxis(AxisProperties):
    """Configuration of a simulated servo axis."""

    power_up_position: float = 0.0  # Position relative to home at power-up.
    bandwidth_hz: float = 40.0  # Bandwidth of the position loop in Hz.
    feed_forward_fraction: float = 0.9  # Fraction of the velocity; the rest appears as following error.
    acceleration_reserve_factor: float = 1.3  # Factor by which the servo can exceed amax.
    own_drive: bool = False  # C only: the axis can be positioned while the spindle turns.


@dataclass(frozen=True, slots=True)
class SimSpindle:
    """Configuration of a simulated AC spindle with a frequency inverter.

    Speeds are in rpm, ramps in rpm/s, and times in seconds.
    """

    max_rpm: float = 3500.0
    acceleration_rpm_per_s: float = 1500.0
    deceleration_rpm_per_s: float = 2500.0
    coast_deceleration_rpm_per_s: float = 600.0
    command_latency_s: float = 0.08
    pulses_per_rev: int = 1024
    can_orient: bool = False  # The drive can stop the spindle at an angle; it turns there at orientation_rpm.
    orientation_rpm: float = 60.0


@dataclass(frozen=True, slots=True)
class SimOutput:
    """Configuration of a simulated output: its state at power-up and its safe state.

    If the safe state is None, the output is not changed when the machine enters the safe state.
    """

    safe_state: bool | None = False
    power_up_state: bool = False


@dataclass(frozen=True, slots=True)
class SimCollet:
    """Configuration of a simulated collet and its switch; the output is on while the collet is clamped.

    Times are in seconds. ``time_variation_fraction`` is the random variation of the times as a fraction.
    """

    output_name: str = "collet"
    closed_input_name: str = "collet_closed"
    open_time_s: float = 0.25
    close_time_s: float = 0.30
    time_variation_fraction: float = 0.2


@dataclass(frozen=True, slots=True)
class SimToolSetter:
    """Configuration of a simulated tool setter, in mm.

    The stylus center is relative to part zero. ``tip_positions`` contains an (X, Z) pair for each tool on
    the tool plate: the axis positions at which its tip is at part zero.
    """

    x_mm: float
    z_mm: float
    stylus_width_mm: float
    tip_positions: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class SimConfig:
    """Configuration of the complete simulated machine."""

    axes: tuple[SimAxis, ...]
    spindle: SimSpindle = field(default_factory=SimSpindle)
    collet: SimCollet = field(default_factory=SimCollet)
    outputs: Mapping[str, SimOutput] = field(default_factory=dict)
    inputs: tuple[str, ...] = ()
    commit_time_s: float = 0.03
    model_step_s: float = 0.001  # Interval of the servo model in s.
    random_seed: int = 1
    planned_faults: tuple[PlannedFault, ...] = ()
    setter: SimToolSetter | None = None
    has_spindle_load_input: bool = False  # An input measures the spindle load.
    palm_window_s: float = 0.5  # Seconds within which both palm buttons must be pressed.
    min_start_pulse_s: float = 0.1  # Minimum pulse of the two-hand relay in s.
