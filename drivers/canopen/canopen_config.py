"""What hangs on the bus: filled by the app from the machine file, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import CIA402, DriveProfile
from drivers.setpoint_queue import AxisFigures


@dataclass(frozen=True, slots=True)
class AxisConfig(AxisFigures):
    """One axis. Without a ``node`` it has no drive, and only counts."""

    node: CanNode | None = None
    profile: DriveProfile = CIA402
    counts_per_rev: int = 0  # the drive's velocities are rpm of so many counts; 0: counts/s
    home_method: int = 0
    home_latch: float = 0.0
    home_offset: float = 0.0

    def velocity(self, speed: float) -> float:
        """A speed, mm/s or degrees/s, in the drive's unit: counts/s, or rpm."""
        counts = speed / self.count
        return counts * 60.0 / self.counts_per_rev if self.counts_per_rev else counts

    def acceleration(self, accel: float) -> int:
        """An acceleration, mm/s² or degrees/s², in the drive's unit: counts/s², or rpm/s; at least one."""
        counts = accel / self.count
        return max(round(counts * 60.0 / self.counts_per_rev if self.profile.rpm else counts), 1)


@dataclass(frozen=True, slots=True)
class SpindleConfig:
    """A drive in profile velocity mode; rpm and rpm/s. ``is_c``: it positions C too.

    Without counts a turn its node tells no angle.
    """

    node: CanNode
    rpm_max: float
    accel: float
    decel: float
    is_c: bool = False


@dataclass(frozen=True, slots=True)
class EncoderConfig:
    """An encoder on the spindle. Without a ``node``: the second input of the drive that ``name`` says."""

    name: str
    node: CanNode | None
    index: int
    sub: int
    counts_per_rev: int  # negative: it counts down with M03
    rpm_max: float


@dataclass(frozen=True, slots=True)
class OutputConfig:
    """An output: ``safe`` None keeps its state."""

    terminal: CanTerminal
    safe: bool | None = False


@dataclass(frozen=True, slots=True)
class PotConfig:
    """An analog input: ``low`` … ``high`` is what 0 and full scale mean; ``switch`` is its input's name."""

    terminal: CanTerminal
    low: float = 0.0
    high: float = 1.0
    switch: str = ""


@dataclass(frozen=True, slots=True)
class CanopenConfig:
    """The whole machine on the bus."""

    bus: CanopenTable
    axes: tuple[AxisConfig, ...]
    spindle: SpindleConfig | None = None
    encoder: EncoderConfig | None = None  # beside a spindle that somebody else turns
    modules: tuple[CanNode, ...] = ()
    outputs: Mapping[str, OutputConfig] = field(default_factory=dict)
    inputs: Mapping[str, CanTerminal] = field(default_factory=dict)
    pots: Mapping[str, PotConfig] = field(default_factory=dict)
    commit: float = 0.14
