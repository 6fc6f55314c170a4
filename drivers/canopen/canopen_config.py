"""Configuration of the devices on the bus, which the app fills from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import CIA402_PROFILE, DriveProfile
from drivers.setpoint_queue import AxisProperties


@dataclass(frozen=True, slots=True)
class AxisConfig(AxisProperties):
    """One axis; without a ``node`` it has no drive and only counts."""

    node: CanNode | None = None
    profile: DriveProfile = CIA402_PROFILE
    counts_per_rev: int = 0  # Counts per revolution for velocities in rpm; 0: counts/s.
    home_method: int = 0
    home_latch_speed: float = 0.0
    home_offset: float = 0.0

    def velocity(self, speed: float) -> float:
        """Convert a speed in mm/s or degrees/s into the drive's unit, counts/s or rpm."""
        counts = speed / self.count
        return counts * 60.0 / self.counts_per_rev if self.counts_per_rev else counts

    def acceleration(self, accel: float) -> int:
        """Convert an acceleration into the drive's unit, counts/s² or rpm/s, at least 1.

        The argument is in mm/s² or degrees/s².
        """
        counts = accel / self.count
        return max(round(counts * 60.0 / self.counts_per_rev if self.profile.uses_rpm else counts), 1)


@dataclass(frozen=True, slots=True)
class SpindleConfig:
    """Spindle drive in profile velocity mode, in rpm and rpm/s; ``is_c_axis``: the drive also positions C.

    Without counts per revolution, its node does not provide an angle.
    """

    node: CanNode
    rpm_max: float
    accel: float
    decel: float
    is_c_axis: bool = False


@dataclass(frozen=True, slots=True)
class EncoderConfig:
    """Encoder on the spindle; without a ``node``, it is the second encoder input of the drive ``name``."""

    name: str
    node: CanNode | None
    index: int
    subindex: int
    counts_per_rev: int  # Negative: counts down with M03.
    rpm_max: float


@dataclass(frozen=True, slots=True)
class OutputConfig:
    """Output with its safe state; None leaves the output unchanged."""

    terminal: CanTerminal
    safe_state: bool | None = False


@dataclass(frozen=True, slots=True)
class PotConfig:
    """Analog input, whose zero and full scale mean ``low_value`` and ``high_value``; ``switch_input`` names
    its input.
    """

    terminal: CanTerminal
    low_value: float = 0.0
    high_value: float = 1.0
    switch_input: str = ""


@dataclass(frozen=True, slots=True)
class CanopenConfig:
    """Configuration of the complete machine on the bus."""

    bus: CanopenTable
    axes: tuple[AxisConfig, ...]
    spindle: SpindleConfig | None = None
    encoder: EncoderConfig | None = None  # For a spindle that another device drives.
    modules: tuple[CanNode, ...] = ()
    outputs: Mapping[str, OutputConfig] = field(default_factory=dict)
    inputs: Mapping[str, CanTerminal] = field(default_factory=dict)
    pots: Mapping[str, PotConfig] = field(default_factory=dict)
    commit_time_s: float = 0.14
