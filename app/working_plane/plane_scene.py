"""Scene of a mill program, with the tool path and the working planes on the workpiece.

The scene is built once, on a worker thread. Points are in the workpiece system in mm, so that they rotate
with the table.
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

from core.geometry.rotation_frames import add_vectors, apply_matrix
from core.geometry.working_plane import HelixMove
from core.interpreter.shared.elementary_blocks import BlockKind

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics
    from core.geometry.rotation_frames import Vector
    from core.interpreter.shared.elementary_blocks import Block
    from core.interpreter.shared.working_plane import BlankCorners, PlanePosition

FloatArray = npt.NDArray[np.float64]
_CHORD_ANGLE_DEG = 6.0  # degrees of an arc per chord
_EMPTY: BlankCorners = ((-20.0, -20.0, -20.0), (20.0, 20.0, 0.0))


class MoveStyle(IntEnum):
    """Drawing style of the move that ends at a point of the tool path."""

    NO_LINE = 0  # not drawn: a new line starts at this point
    RAPID = 1
    CUT = 2


@dataclass(frozen=True, slots=True, eq=False)
class MillScene:
    """Tool path and working planes of a mill program.

    - ``tip_points`` (n, 3): points of the tool tip
    - ``move_styles`` and ``block_numbers`` (n,): style and block number of the move to each point
    - ``planes_by_line``: plane after the first execution of a source line; ``sorted_line_numbers`` are its
      keys
    - ``blank_corners``: corners of the blank, or default corners if the program does not define a blank
    """

    kinematics: Kinematics
    tip_points: FloatArray
    move_styles: npt.NDArray[np.int8]
    block_numbers: npt.NDArray[np.int64]
    blank_corners: BlankCorners
    planes_by_line: dict[int, PlanePosition] = field(default_factory=dict)
    sorted_line_numbers: tuple[int, ...] = ()
    plane_line_numbers: frozenset[int] = frozenset()  # lines of PLANE blocks

    def find_plane(self, line_number: int) -> PlanePosition | None:
        """Return the plane after a source line, or after the nearest earlier line that generates a block."""
        at = bisect_right(self.sorted_line_numbers, line_number)
        return self.planes_by_line[self.sorted_line_numbers[at - 1]] if at else None

    def count_finished_points(self, block_number: int) -> int:
        """Return the number of path points that have been reached at the end of a block.

        Blocks are counted from 1.
        """
        return int(np.searchsorted(self.block_numbers, block_number, side="right"))


class SceneBuilder:
    """Builder of a ``MillScene`` from the blocks that have a position in a working plane."""

    def __init__(self) -> None:
        self._points, self._ink, self._block = array("d"), array("b"), array("q")
        self._by_line: dict[int, PlanePosition] = {}
        self._planes: set[int] = set()
        self._last: PlanePosition | None = None

    def add_block(self, block: Block, swivel: PlanePosition) -> None:
        """Append a block that has a position in a working plane."""
        self._last = swivel
        self._by_line.setdefault(block.line, swivel)
        if block.kind is BlockKind.PLANE:
            self._planes.add(block.line)
            self._by_line[block.line] = swivel  # The retract of the same line was added first.
            self._to(_map_to_part(swivel, swivel.end), MoveStyle.NO_LINE, block.n)
        elif block.moves:
            if not self._ink:
                self._to(_map_to_part(swivel, swivel.start), MoveStyle.NO_LINE, block.n)
            for point in _find_path_points(block, swivel):
                self._to(
                    _map_to_part(swivel, point), MoveStyle.RAPID if block.rapid else MoveStyle.CUT, block.n
                )

    def build_scene(self) -> MillScene | None:
        """Return the collected scene, or None if no block has a position in a plane."""
        if self._last is None:
            return None
        return MillScene(
            kinematics=self._last.system.kinematics,
            tip_points=np.array(self._points).reshape(-1, 3),
            move_styles=np.array(self._ink, dtype=np.int8),
            block_numbers=np.array(self._block, dtype=np.int64),
            blank_corners=self._last.system.blank_corners or _EMPTY,
            planes_by_line=self._by_line,
            sorted_line_numbers=tuple(sorted(self._by_line)),
            plane_line_numbers=frozenset(self._planes),
        )

    def _to(self, point: Vector, ink: MoveStyle, block: int) -> None:
        self._points.extend(point)
        self._ink.append(ink)
        self._block.append(block)


def _find_path_points(block: Block, swivel: PlanePosition) -> list[Vector]:
    """Return the path points of a block in the coordinates of the working plane.

    Arcs are replaced by chords.
    """
    curve = None if block.travel is None else block.travel.curved_move
    if not isinstance(curve, HelixMove):
        return [swivel.end]
    count = max(1, math.ceil(abs(math.degrees(curve.arc.sweep_rad)) / _CHORD_ANGLE_DEG))
    share = np.arange(1, count) / count
    between = [
        (x, y, z)
        for x, y, z in curve.compute_workpiece_points(curve.compute_machine_positions(share)).tolist()
    ]
    return [*between, swivel.end]


def _map_to_part(swivel: PlanePosition, q: Vector) -> Vector:
    """Convert a point from the system of the working plane to the system of the workpiece."""
    return add_vectors(swivel.system.datum, apply_matrix(swivel.system.frame, q))
