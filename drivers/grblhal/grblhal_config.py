"""What the driver must know of the machine: filled by the app from the machine file, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from drivers.grblhal.grblhal_table import GrblhalTable


@dataclass(frozen=True, slots=True)
class GrblAxis:
    """One axis of the machine file; mm and seconds. ``wired``: the controller has it.

    ``here``: homing takes where the axis stands for this many mm from home, and nothing moves; None: the
    controller looks for its switch.
    """

    name: str
    vmax: float
    amax: float
    absolute: bool
    wired: bool
    here: float | None = None


@dataclass(frozen=True, slots=True)
class GrblOutput:
    """Where an output is: ``flood``, ``mist`` or ``out.N``; its safe state, None to keep what it is."""

    terminal: str
    safe: bool | None


ESTOP, HARDWARE = "estop", "hardware"  # an E-stop that cuts the power by itself, and nobody tells


@dataclass(frozen=True, slots=True)
class GrblInput:
    """Where an input is: ``pn.E`` is the letter E of the status report's pins.

    ``hardware``, of the E-stop alone: the controller has no input for it.
    """

    terminal: str
    active_low: bool


@dataclass(frozen=True, slots=True)
class GrblConfig:
    """The controller and what hangs on it.

    ``own_spindle``: the controller turns it; else an inverter does, and the controller at most measures it.
    """

    table: GrblhalTable
    axes: tuple[GrblAxis, ...]
    rpm_max: float
    outputs: Mapping[str, GrblOutput]
    inputs: Mapping[str, GrblInput]
    own_spindle: bool = True
