"""Configuration of the devices on the CAN bus, as read from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.ports import DriverError
from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import CIA402_PROFILE, DriveProfile
from drivers.setpoint_queue import AxisProperties

MAX_SIGNED_32_BIT = 2**31 - 1  # Maximum of a signed 32-bit number.


@dataclass(frozen=True, slots=True)
class AxisConfig(AxisProperties):
    """Configuration of one axis.

    An axis without a ``node`` has no drive; the control only tracks its commanded position.
    """

    node: CanNode | None = None
    profile: DriveProfile = CIA402_PROFILE
    counts_per_rev: int = 0  # Counts per revolution for velocities in rpm; 0: counts/s.
    home_method: int = 0
    home_latch_speed: float = 0.0
    home_offset: float = 0.0

    def convert_position(self, position: float) -> int:
        """Convert a position in mm or degrees into counts of the drive.

        Raises DriverError if the position is outside the range of the drive's signed 32-bit counter.
        """
        counts = position / self.count
        if not abs(counts) <= MAX_SIGNED_32_BIT:  # also a position that is not a number
            raise DriverError(
                "{axis}: position {position} is outside ±{limit}, the range of the drive's position counter; "
                "check the position in the program, and the resolution of the axis in the machine file",
                "drive-limits",
                reason="counter-range",
                axis=self.name,
                position=f"{position:.1f}",
                limit=f"{MAX_SIGNED_32_BIT * self.count:.1f}",
            )
        return round(counts)

    def convert_to_drive_speed(self, speed: float) -> float:
        """Convert a speed in mm/s or degrees/s into the unit of the drive, counts/s or rpm."""
        counts = speed / self.count
        return counts * 60.0 / self.counts_per_rev if self.counts_per_rev else counts

    def convert_to_drive_acceleration(self, accel: float) -> int:
        """Convert an acceleration in mm/s² or degrees/s² into the unit of the drive, counts/s² or rpm/s.

        The result is at least 1.
        """
        counts = accel / self.count
        return max(round(counts * 60.0 / self.counts_per_rev if self.profile.uses_rpm else counts), 1)


@dataclass(frozen=True, slots=True)
class SpindleConfig:
    """Spindle drive in profile velocity mode, with speeds in rpm and accelerations in rpm/s.

    If ``is_c_axis`` is true, the drive also positions the C axis. If the counts per revolution of the node
    are not specified, the drive does not provide an angle.
    """

    node: CanNode
    max_rpm: float
    acceleration_rpm_per_s: float
    deceleration_rpm_per_s: float
    is_c_axis: bool = False


@dataclass(frozen=True, slots=True)
class EncoderConfig:
    """Encoder on the spindle.

    If ``node`` is None, the encoder is connected to the second encoder input of the drive ``name``.
    """

    name: str
    node: CanNode | None
    index: int
    object_subindex: int
    counts_per_rev: int  # Negative: counts down with M03.
    max_rpm: float


@dataclass(frozen=True, slots=True)
class OutputConfig:
    """Output and its safe state.

    If the safe state is None, the output does not change when the machine enters the safe state.
    """

    terminal: CanTerminal
    safe_state: bool | None = False


@dataclass(frozen=True, slots=True)
class PotConfig:
    """Potentiometer at an analog input.

    ``low_value`` is its value at zero, and ``high_value`` is its value at full scale. ``switch_input`` is
    the name of the input that enables it.
    """

    terminal: CanTerminal
    low_value: float = 0.0
    high_value: float = 1.0
    switch_input: str = ""


@dataclass(frozen=True, slots=True)
class CanopenConfig:
    """Configuration of the complete machine on the bus."""

    bus_settings: CanopenTable
    axes: tuple[AxisConfig, ...]
    spindle: SpindleConfig | None = None
    encoder: EncoderConfig | None = None  # For a spindle that another device drives.
    io_modules: tuple[CanNode, ...] = ()
    outputs: Mapping[str, OutputConfig] = field(default_factory=dict)
    inputs: Mapping[str, CanTerminal] = field(default_factory=dict)
    pots: Mapping[str, PotConfig] = field(default_factory=dict)
    commit_time_s: float = 0.14
