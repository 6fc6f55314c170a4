"""Scene of a mill program: tool path and planes on the workpiece, collected once on a worker thread.

Points are in the workpiece system in mm, so that they turn with the table.
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
_CHORD = 6.0  # degrees of an arc per chord
_EMPTY: Corners = ((-20.0, -20.0, -20.0), (20.0, 20.0, 0.0))


class Ink(IntEnum):
    """Drawing style of the move to a point."""

    LIFTED = 0  # not drawn: a new line starts at this point
    RAPID = 1
    CUT = 2


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Points (n, 3) of the tip, with the ``ink`` (n,) of the move to each and the ``block`` (n,) number.

    ``by_line`` maps a source line to the plane after its first pass, and ``lines`` contains its sorted keys.
    ``corners`` are those of the blank, or a default if the program does not define one.
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
        """Return the plane after a source line, or after the nearest earlier line that makes a block."""
        at = bisect_right(self.lines, line)
        return self.by_line[self.lines[at - 1]] if at else None

    def done(self, block: int) -> int:
        """Return the number of points that are finished after a block, counted from 1."""
        return int(np.searchsorted(self.block, block, side="right"))


class SceneBuilder:
    """Collects blocks that contain a position in a working plane."""

    def __init__(self) -> None:
        self._points, self._ink, self._block = array("d"), array("b"), array("q")
        self._by_line: dict[int, Swivel] = {}
        self._planes: set[int] = set()
        self._last: Swivel | None = None

    def add(self, block: Block, swivel: Swivel) -> None:
        """Append a block with its position in the working plane."""
        self._last = swivel
        self._by_line.setdefault(block.line, swivel)
        if block.kind is Kind.PLANE:
            self._planes.add(block.line)
            self._by_line[block.line] = swivel  # The retract of the same line was added first.
            self._to(_on_part(swivel, swivel.end), Ink.LIFTED, block.n)
        elif block.moves:
            if not self._ink:
                self._to(_on_part(swivel, swivel.start), Ink.LIFTED, block.n)
            for point in _on_the_way(block, swivel):
                self._to(_on_part(swivel, point), Ink.RAPID if block.rapid else Ink.CUT, block.n)

    def scene(self) -> Scene | None:
        """Return the collected scene, or None if no block has a position in a plane."""
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
    """Return the points of a block in the working plane up to its end, with arcs as chords."""
    way = None if block.travel is None else block.travel.way
    if not isinstance(way, HelixMove):
        return [swivel.end]
    count = max(1, math.ceil(abs(math.degrees(way.arc.sweep)) / _CHORD))
    share = np.arange(1, count) / count
    between = [(x, y, z) for x, y, z in way.part(way.machine(share)).tolist()]
    return [*between, swivel.end]


def _on_part(swivel: Swivel, q: Vector) -> Vector:
    """Convert a point from the system of the working plane to that of the workpiece."""
    return plus(swivel.system.datum, applied(swivel.system.frame, q))
