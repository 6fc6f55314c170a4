"""What lies between lines and the blocks handed out: corners still to cut, nose compensation in force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from core.interpreter.blocks import Block


class Corner(NamedTuple):
    """C or R of a straight move: what is made where it meets the next one. ``size`` in mm."""

    letter: str
    size: float
    column: int


class Mark(NamedTuple):
    """G41, G42 or G40 among the blocks. ``dx dz``: the secondary offset that the point reached has in it."""

    code: int
    line: int
    dx: float
    dz: float


Item = Block | Mark


@dataclass(slots=True)
class Shape:
    """Where a program stands between its lines and the blocks that are made of them."""

    active: bool = False  # blocks are held back, so each has to pass through the shaper
    corner: Corner | None = None  # of the move just made
    approach: int = 0  # line of a G41 or G42 whose approach is still to come
    d_line: int = 0  # last line that held a D
