"""A blade that plunges: its width, the corner that was touched off, how deep it reaches."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.shape import Filled
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Value, Values, number
from core.extras.shapes.shape_setting import Setting
from core.message import Message

FRONT, REAR, INSIDE = "FRONT", "REAR", "BORE"
LEFT, RIGHT = "LEFT", "RIGHT"
FREE = {False: 0.02, True: 0.5}
"""By metric: how far beside the diameter a blade stands."""


def _width(values: Values, setting: Setting) -> Value | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.width / setting.mm, 5) if shape is not None and shape.width else None


def _corner(values: Values, setting: Setting) -> Value | None:
    """The corner that was touched off, as the tool's sheet says; of an unknown tool the one at the chuck."""
    shape = setting.tool(number(values, "T"))
    return RIGHT if shape is not None and shape.direction[0] > 0 else LEFT


def side_of(filled: Filled) -> float:
    """-1: the tool works at X negative."""
    return -1.0 if filled.t("SIDE") == REAR else 1.0


BLADE_FIELD = Field("WIDE", "BLADE WIDTH", Kind.LENGTH, _width, marked=True)
CORNER_FIELD = Field("CORNER", "CORNER USED FOR TOUCH-OFF", Kind.CHOICE, _corner, (LEFT, RIGHT))


class Blade:
    """Where the tool is programmed so that one of its corners stands where it should.

    ``start``: the radius at which it comes.
    """

    def __init__(self, filled: Filled, code: Code, start: float = 0.0) -> None:
        self.wide = filled.n("WIDE")
        self.left = filled.t("CORNER") == LEFT
        self._side, self._code = side_of(filled), code
        self._r, self._z = start, math.inf

    def _at(self, r: float | None, z: float | None) -> None:
        self._r = self._r if r is None else r
        self._z = self._z if z is None else z

    def at(self, chuck: float) -> float:
        """Programmed Z that has the corner at the chuck there."""
        return chuck if self.left else chuck + self.wide

    def face(self, front: float) -> float:
        """Programmed Z that has the corner at the face there."""
        return self.at(front - self.wide)

    def over(self, z: float, r: float) -> None:
        """Along Z, as far out as it is, then to this radius; what is reached already is not written again."""
        if z != self._z:
            self.rapid(z=z)
        if r != self._r:
            self.rapid(r)

    def rapid(self, r: float | None = None, z: float | None = None) -> None:
        """A rapid to a radius on its side of the axis, and to a programmed Z."""
        self._at(r, z)
        self._code.rapid(None if r is None else self._side * r, z)

    def cut(self, r: float | None = None, z: float | None = None, feed: float = 0.0) -> None:
        """A cut to there."""
        self._at(r, z)
        self._code.cut(None if r is None else self._side * r, z, feed)

    def dwell(self, seconds: float) -> None:
        """Where it stands; of no seconds none."""
        self._code.dwell(seconds)


def reach(filled: Filled, setting: Setting, deep: float, word: str) -> Iterator[Refusal]:
    """The blade is long enough, and as wide as its sheet says."""
    shape, wide, name = setting.tool(filled.n("T")), filled.n("WIDE"), f"T{filled.n('T'):.0f}"
    if shape is None:
        return
    if shape.length and deep > shape.length / setting.mm + 1e-9:
        yield Refusal(
            word,
            Message(
                "Depth {depth} is more than the reach of {name}, which is {length}. Use a longer blade.",
                depth=f"{deep:.4g}",
                name=name,
                length=f"{shape.length / setting.mm:.4g}",
            ),
        )
    if shape.width and abs(shape.width / setting.mm - wide) > 0.001 / setting.mm * 25.4:
        yield Refusal(
            "WIDE",
            Message(
                "The blade width in the tool data of {name} is {width}: enter that width.",
                name=name,
                width=f"{shape.width / setting.mm:.4g}",
            ),
        )
