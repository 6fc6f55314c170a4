"""What has been said about stock, tools and clamping before a program is proved on metal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.part.clamping import Clamping
from core.part.stock import Point, Stock
from core.part.stock_spec import StockSpec
from core.part.tool_shape import ToolShape
from core.part.turned_part import STEP
from core.proving.thread_checks import UNKNOWN, Drives
from core.proving.tip_moves import Place


@dataclass(frozen=True, slots=True)
class PartSetting:
    """What has been said about stock, tools (by T) and clamping; nose radii, mm, come from the offsets."""

    stock: Stock | StockSpec | None = None
    shapes: Mapping[int, ToolShape] = field(default_factory=dict)
    nose_radii: Mapping[int, float] = field(default_factory=dict)
    clamping: Clamping | None = None
    gang: Mapping[int, Point] = field(default_factory=dict)  # Z and X of the tools that ride one plate
    tips: Mapping[int, Place] = field(default_factory=dict)  # as ``Steps`` has them
    drives: Drives = UNKNOWN
    live_codes: bool = False  # the machine has M codes that switch live tools
    step: float = STEP  # width of a column of the part, mm
    silenced: Mapping[str, str] = field(default_factory=dict)  # why, by check
    travel: tuple[Point, Point] | None = None  # of X and of Z, from home, mm

    @property
    def may_refuse(self) -> bool:
        """Whether enough is said for an error of the part to rest on nothing that is assumed."""
        return self.stock is not None or self.clamping is not None
