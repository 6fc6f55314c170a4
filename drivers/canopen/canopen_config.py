"""What hangs on the bus: filled by the app from the machine file, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.canopen.canopen_table import BusConfig

Objects = tuple[tuple[int, int, int], ...]  # index, sub-index, value: written at every start and read back


@dataclass(frozen=True, slots=True)
class AxisConfig:
    """One axis; mm and seconds, or degrees. ``node`` 0: an axis without a drive, which only counts."""

    name: str
    node: int
    count: float  # mm or degrees of one count of the drive
    vmax: float
    amax: float
    following_window: float
    following_time: float
    corner: float  # velocity that a corner may jump
    travel: tuple[float, float] | None = None
    absolute: bool = False
    home_method: int = 0
    home_speed: float = 0.0
    home_latch: float = 0.0
    home_offset: float = 0.0
    counts_per_rev: int = 0  # PVT velocities in rpm of so many counts; 0: in counts/s
    eds: str = ""
    objects: Objects = ()


@dataclass(frozen=True, slots=True)
class SpindleConfig:
    """A drive in profile velocity mode; rpm and rpm/s. ``counts_per_rev`` 0: it tells no angle.

    ``is_c``: it positions C too.
    """

    node: int
    rpm_max: float
    accel: float
    decel: float
    counts_per_rev: int = 0
    eds: str = ""
    objects: Objects = ()
    is_c: bool = False


@dataclass(frozen=True, slots=True)
class EncoderConfig:
    """An encoder on the spindle. ``node`` 0: the second input of the drive that ``name`` says."""

    name: str
    node: int
    index: int
    sub: int
    counts_per_rev: int  # negative: it counts down with M03
    rpm_max: float
    eds: str = ""
    objects: Objects = ()


@dataclass(frozen=True, slots=True)
class ModuleConfig:
    """One CiA 401 module."""

    name: str
    node: int
    eds: str = ""
    objects: Objects = ()


@dataclass(frozen=True, slots=True)
class Terminal:
    """One bit or word: ``node`` is the name of a module or an axis; ``bit`` -1: the whole word."""

    node: str
    index: int
    sub: int
    bit: int = -1
    active_low: bool = False


@dataclass(frozen=True, slots=True)
class OutputConfig:
    """An output: ``safe`` None keeps its state."""

    terminal: Terminal
    safe: bool | None = False


@dataclass(frozen=True, slots=True)
class PotConfig:
    """An analog input: ``low`` … ``high`` is what 0 and full scale mean; ``switch`` is its input's name."""

    terminal: Terminal
    low: float = 0.0
    high: float = 1.0
    switch: str = ""


@dataclass(frozen=True, slots=True)
class CanopenConfig:
    """The whole machine on the bus."""

    bus: BusConfig
    axes: tuple[AxisConfig, ...]
    spindle: SpindleConfig | None = None
    encoder: EncoderConfig | None = None  # beside a spindle that somebody else turns
    modules: tuple[ModuleConfig, ...] = ()
    outputs: Mapping[str, OutputConfig] = field(default_factory=dict)
    inputs: Mapping[str, Terminal] = field(default_factory=dict)
    pots: Mapping[str, PotConfig] = field(default_factory=dict)
    mode: str = "pvt"  # pvt, pp or csp
    commit: float = 0.14
    record: float = 0.02
