"""A machine behind HAL as its driver needs it: filled by the app from the machine file, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from core.ports import PROBE
from drivers.hal.hal_table import NEEDS, HalAxisPins, HalSpindlePins, HalTable
from drivers.setpoint_queue import AxisFigures


@dataclass(frozen=True, slots=True)
class HalAxis(AxisFigures):
    """One axis. Without ``pins`` it only counts."""

    pins: HalAxisPins | None = None
    home_method: int = 0
    home_latch: float = 0.0  # mm/s
    home_offset: float = 0.0
    is_spindle: bool = False  # C on the spindle's own drive

    @property
    def switch(self) -> str:
        """The pin that homing looks for, by its key; empty: none."""
        needs = NEEDS.get(self.home_method, ()) if not self.absolute and self.pins is not None else ()
        return next((key for key in needs if key != "index_enable"), "")


@dataclass(frozen=True, slots=True)
class HalSpindle:
    """The spindle, rpm and rpm/s. ``turned``: HAL turns it, else an inverter does."""

    pins: HalSpindlePins
    rpm_max: float
    accel: float
    decel: float
    encoder: bool
    turned: bool = True


@dataclass(frozen=True, slots=True)
class HalOutput:
    """An output's pin: ``safe`` None keeps its state. ``lamp``: of the signal tower, which tells of an open
    E-stop chain and is safe only while the bridge is silent.
    """

    pin: str
    safe: bool | None = False
    lamp: bool = False


@dataclass(frozen=True, slots=True)
class HalInput:
    """An input's pin."""

    pin: str
    active_low: bool = False


@dataclass(frozen=True, slots=True)
class HalPot:
    """A pot's pin (0…1), or that of a wheel that counts; ``switch`` is its input's name."""

    pin: str
    low: float = 0.0
    high: float = 1.0
    switch: str = ""


@dataclass(frozen=True, slots=True)
class HalConfig:
    """The whole machine. Times in seconds; ``file`` is the path of the table's HAL file."""

    table: HalTable
    file: Path
    commit: float
    axes: tuple[HalAxis, ...]
    spindle: HalSpindle
    outputs: Mapping[str, HalOutput] = field(default_factory=dict)
    inputs: Mapping[str, HalInput] = field(default_factory=dict)
    pots: Mapping[str, HalPot] = field(default_factory=dict)

    @property
    def probe(self) -> HalInput | None:
        """The input of a probe or tool setter, which is sampled with the slides."""
        return self.inputs.get(PROBE)

    @property
    def driven(self) -> tuple[HalAxis, ...]:
        """The axes that have pins."""
        return tuple(axis for axis in self.axes if axis.pins is not None)
