"""What a program does to the workpiece on a mill, collected once from its blocks on a worker thread.

Points are in the workpiece's system, so that they turn with the table; mm.
"""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.rotation_frames import applied, plus
from core.geometry.working_plane import HelixMove
from core.interpreter.shared.elementary_blocks import Kind

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics
    from core.geometry.rotation_frames import Vector
    from core.interpreter.shared.elementary_blocks import Block
    from core.interpreter.shared.working_plane import Corners, Swivel

FloatArray = npt.NDArray[np.float64]
_CHORD = 6.0  # degrees of an arc that are drawn as one line
_EMPTY: Corners = ((-20.0, -20.0, -20.0), (20.0, 20.0, 0.0))


class Ink(IntEnum):
    """How the way to a point is drawn."""

    LIFTED = 0  # not at all: a new way begins here
    RAPID = 1
    CUT = 2


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """``points`` (n, 3) of the tip, ``ink`` (n,) of the way to each, ``block`` (n,) the number it ends.

    ``by_line`` is the place behind the first pass through a source line, ``lines`` those that it holds, in
    order; ``corners`` of the blank, or a stand-in where the program names none.
    """

    kinematics: Kinematics
    points: FloatArray
    ink: npt.NDArray[np.int8]
    block: npt.NDArray[np.int64]
    corners: Corners
    by_line: dict[int, Swivel] = field(default_factory=dict)
    lines: tuple[int, ...] = ()
    planes: frozenset[int] = frozenset()  # lines of PLANE blocks

    def swivel_at(self, line: int) -> Swivel | None:
        """The place behind a source line, or behind the nearest one before it that makes a block."""
        at = bisect_right(self.lines, line)
        return self.by_line[self.lines[at - 1]] if at else None

    def done(self, block: int) -> int:
        """How many points lie behind once this block (from 1) is done."""
        return int(np.searchsorted(self.block, block, side="right"))


class SceneBuilder:
    """Collects blocks that tell where they stand in a working plane."""

    def __init__(self) -> None:
        self._points, self._ink, self._block = array("d"), array("b"), array("q")
        self._by_line: dict[int, Swivel] = {}
        self._planes: set[int] = set()
        self._last: Swivel | None = None

    def add(self, block: Block, swivel: Swivel) -> None:
        """Append a block with its place in the working plane."""
        self._last = swivel
        self._by_line.setdefault(block.line, swivel)
        if block.kind is Kind.PLANE:
            self._planes.add(block.line)
            self._by_line[block.line] = swivel  # its retract came first
            self._to(_on_part(swivel, swivel.end), Ink.LIFTED, block.n)
        elif block.moves:
            if not self._ink:
                self._to(_on_part(swivel, swivel.start), Ink.LIFTED, block.n)
            for point in _on_the_way(block, swivel):
                self._to(_on_part(swivel, point), Ink.RAPID if block.rapid else Ink.CUT, block.n)

    def scene(self) -> Scene | None:
        """What was collected; None where no block stood in a plane."""
        if self._last is None:
            return None
        return Scene(
            kinematics=self._last.system.kinematics,
            points=np.array(self._points).reshape(-1, 3),
            ink=np.array(self._ink, dtype=np.int8),
            block=np.array(self._block, dtype=np.int64),
            corners=self._last.system.blank or _EMPTY,
            by_line=self._by_line,
            lines=tuple(sorted(self._by_line)),
            planes=frozenset(self._planes),
        )

    def _to(self, point: Vector, ink: Ink, block: int) -> None:
        self._points.extend(point)
        self._ink.append(ink)
        self._block.append(block)


def _on_the_way(block: Block, swivel: Swivel) -> list[Vector]:
    """Points of the working plane up to the end of a block: of an arc as many as the eye asks for."""
    way = None if block.travel is None else block.travel.way
    if not isinstance(way, HelixMove):
        return [swivel.end]
    count = max(1, math.ceil(abs(math.degrees(way.arc.sweep)) / _CHORD))
    share = np.arange(1, count) / count
    between = [(x, y, z) for x, y, z in way.part(way.machine(share)).tolist()]
    return [*between, swivel.end]


def _on_part(swivel: Swivel, q: Vector) -> Vector:
    """A point of the working plane's system in the workpiece's."""
    return plus(swivel.system.datum, applied(swivel.system.frame, q))
