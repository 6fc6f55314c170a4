"""What the driver of an inverter must know: filled by the app from the machine file, frozen."""

from __future__ import annotations

from dataclasses import dataclass

FAMILIES = ("delta-vfdb", "hitachi-wj200", "huanyang")


@dataclass(frozen=True, slots=True)
class InverterConfig:
    """``hz_per_rpm`` of the spindle, with its belt; ``comm_loss`` the inverter's own time-out in s."""

    family: str
    unit: int
    hz_per_rpm: float
    rpm_max: float
    comm_loss: float
    character: float  # s that one character takes on the line
    disagree: float = 0.15  # fraction by which an encoder may differ from what the inverter gives
