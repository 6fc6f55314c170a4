"""Configuration of a machine on HAL, as created from the machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from core.ports import PROBE_INPUT
from drivers.hal.hal_table import REQUIRED_PINS_BY_HOMING_METHOD, HalAxisPins, HalSpindlePins, HalTable
from drivers.setpoint_queue import AxisProperties


@dataclass(frozen=True, slots=True)
class HalAxis(AxisProperties):
    """One axis of the machine.

    An axis without ``pins`` has no drive. Its position is the commanded position.
    """

    pins: HalAxisPins | None = None
    home_method: int = 0
    home_latch_speed: float = 0.0  # mm/s
    home_offset: float = 0.0
    is_spindle_c_axis: bool = False  # C uses the spindle drive.

    @property
    def switch_key(self) -> str:
        """Return the key of the switch pin that homing searches for, or an empty string."""
        needs = (
            REQUIRED_PINS_BY_HOMING_METHOD.get(self.home_method, ())
            if not self.absolute and self.pins is not None
            else ()
        )
        return next((key for key in needs if key != "index_enable"), "")


@dataclass(frozen=True, slots=True)
class HalSpindleConfig:
    """The configuration of the spindle, in rpm and rpm/s.

    ``is_driven_by_hal`` is True if HAL drives the spindle, and False if an inverter drives it.
    """

    pins: HalSpindlePins
    max_rpm: float
    acceleration_rpm_per_s: float
    deceleration_rpm_per_s: float
    has_encoder: bool
    is_driven_by_hal: bool = True


@dataclass(frozen=True, slots=True)
class HalOutput:
    """Output with its pin and its safe state, where None leaves the output unchanged.

    ``is_lamp`` marks a lamp of the signal tower. It indicates an open E-stop chain, so it is not switched
    to its safe state when the chain opens, but only when the bridge is silent.
    """

    pin_name: str
    safe_state: bool | None = False
    is_lamp: bool = False


@dataclass(frozen=True, slots=True)
class HalInput:
    """An input with its pin."""

    pin_name: str
    is_active_low: bool = False


@dataclass(frozen=True, slots=True)
class HalPot:
    """Potentiometer with its pin (0…1), or handwheel with its count pin.

    ``switch_input`` is the name of the input of the potentiometer's switch, which selects AUTO.
    """

    pin_name: str
    low_value: float = 0.0
    high_value: float = 1.0
    switch_input: str = ""


@dataclass(frozen=True, slots=True)
class HalConfig:
    """The configuration of the complete machine.

    Times are in seconds, and ``hal_file`` is the path of the HAL file.
    """

    hal_table: HalTable
    hal_file: Path
    commit_time_s: float
    axes: tuple[HalAxis, ...]
    spindle: HalSpindleConfig
    outputs: Mapping[str, HalOutput] = field(default_factory=dict)
    inputs: Mapping[str, HalInput] = field(default_factory=dict)
    pots: Mapping[str, HalPot] = field(default_factory=dict)

    @property
    def probe_input(self) -> HalInput | None:
        """Return the input of the probe or tool setter, or None if it is not configured.

        HAL samples this input together with the axis positions.
        """
        return self.inputs.get(PROBE_INPUT)

    @property
    def driven_axes(self) -> tuple[HalAxis, ...]:
        """Return the axes that have pins."""
        return tuple(axis for axis in self.axes if axis.pins is not None)
