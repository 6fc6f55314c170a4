"""What a shape has to know of the program around it and of the machine: modes, rapid, material, tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.language.source import Dialect
from core.part.tool_shape import ToolShape

_NEAR = {False: 0.1, True: 2.5}  # by metric: how near a rapid comes to the part
CLEAR = {False: 1.0, True: 25.0}  # by metric: Z where tools change, where nobody has said it


@dataclass(frozen=True, slots=True)
class Shop:
    """What the machine and its tool store say: rpm, live tool, tools by T (mm)."""

    max_rpm: float = 3500.0
    power: float = 1500.0  # W at the highest speed; where the machine file does not state it, a small drive
    slide_accel: float = 0.0  # mm/s²; 0: not known
    c_rpm: float = 200.0
    live: tuple[int, int] = (15, 16)  # M codes of the live tool: on, off
    live_output: bool = True  # SINUMERIK: an output turns the live tool as spindle 2
    third_axis: str = "C"  # what SINUMERIK programs call C; empty: there is none
    spindle_is_c: bool = True  # C is a second use of the spindle: it taps without a holder that gives
    chuck: tuple[int, int] | None = None  # SINUMERIK: M codes that open and close it
    travel: tuple[float, float] = (0.0, 0.0)  # mm, of X as a radius and of Z; 0: not known
    tools: Mapping[int, ToolShape] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Setting:
    """Lengths in the unit of the program. ``change_z`` is Z where tools change, 0 where nobody has said it,
    ``bar`` the bar's diameter.

    ``called``: the shape stands in a subroutine, ``used`` are the tools before it,
    ``free_sub`` the first number that no subroutine of the program has, or no labelled contour of SINUMERIK.
    """

    metric: bool = False
    diameter: bool = True
    change_z: float = 0.0
    bar: float = 0.0
    material: str = ""
    called: bool = False
    used: frozenset[int] = frozenset()
    free_sub: int = 1
    shop: Shop = field(default_factory=Shop)
    dialect: Dialect = Dialect.OMNITURN

    @property
    def near(self) -> float:
        """How near a rapid comes to the part."""
        return _NEAR[self.metric]

    @property
    def clear(self) -> float:
        """Z where tools change."""
        return self.change_z or CLEAR[self.metric]

    @property
    def mm(self) -> float:
        """mm of one unit of the program."""
        return 1.0 if self.metric else 25.4

    def tool(self, number: float) -> ToolShape | None:
        """The shape of a tool, where its sheet states one."""
        return self.shop.tools.get(int(number))
