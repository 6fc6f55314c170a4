"""Configuration of the grblHAL driver, as read from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from drivers.grblhal.grblhal_table import GrblhalTable


@dataclass(frozen=True, slots=True)
class GrblAxis:
    """One axis of the machine file, in mm and seconds.

    ``is_wired`` is true if the controller has the axis. If ``home_position_mm`` is a number, homing sets
    the current position to this value without motion. If it is None, the axis homes on a switch.
    """

    name: str
    max_velocity: float
    max_acceleration: float
    has_absolute_encoder: bool
    is_wired: bool
    home_position_mm: float | None = None


@dataclass(frozen=True, slots=True)
class GrblOutput:
    """Output with its terminal, which is "flood", "mist" or "out.N", and its safe state.

    If the safe state is None, the output is not changed when the machine enters the safe state.
    """

    terminal: str
    safe_state: bool | None


ESTOP, HARDWARE = "estop", "hardware"  # Terminal of an E-stop that only cuts the power and is not detected.


@dataclass(frozen=True, slots=True)
class GrblInput:
    """Input with its terminal; ``pn.E`` means the letter E in the pin field of a status report.

    The terminal "hardware", for the E-stop only, means that the controller does not report this input.
    """

    terminal: str
    is_active_low: bool


@dataclass(frozen=True, slots=True)
class GrblConfig:
    """Configuration of the controller with its axes, spindle and terminals.

    ``has_own_spindle`` is true if the controller drives the spindle. Otherwise an inverter drives the
    spindle, and the controller can at most measure the speed.
    """

    grblhal_table: GrblhalTable
    axes: tuple[GrblAxis, ...]
    max_rpm: float
    outputs: Mapping[str, GrblOutput]
    inputs: Mapping[str, GrblInput]
    has_own_spindle: bool = True
