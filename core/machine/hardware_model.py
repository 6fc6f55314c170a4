"""What the machine is wired to, as its file describes it: pots, homing, and the tables of its drivers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

_Table = TypeVar("_Table")


@dataclass(frozen=True, slots=True)
class AnalogModel:
    """A pot or a counting wheel: ``low`` … ``high`` is what both ends mean; ``switch`` names its input.

    ``counts_per_click`` of the handwheel; negative: it turns the other way round.
    """

    name: str
    terminal: str
    low: float
    high: float
    switch: str = ""
    counts_per_click: int = 1


@dataclass(frozen=True, slots=True)
class HomeModel:
    """How a real drive looks for home: CiA 402 method, the slow speed, and where home lies from the mark."""

    method: int = 0  # 0: not said
    latch: float = 0.0  # mm/s
    offset: float = 0.0  # mm


@dataclass(frozen=True, slots=True)
class Hardware:
    """Everything about wires."""

    feeder: bool = False  # the drivers run in a process of their own
    spindle_driver: str = "sim"  # sim, cia402, vfd or grblhal
    tables: Mapping[str, object] = field(default_factory=dict)  # of the drivers, by path
    analog: Mapping[str, AnalogModel] = field(default_factory=dict)
    homes: Mapping[str, HomeModel] = field(default_factory=dict)  # by axis
    refresh: Mapping[str, float] = field(
        default_factory=dict
    )  # output → s after which it falls if not renewed

    def table(self, kind: type[_Table]) -> _Table | None:
        """What a driver has made of its table; None where the file has no such table."""
        return next((each for each in self.tables.values() if isinstance(each, kind)), None)
