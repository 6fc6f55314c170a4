"""What a locked C axis lets the tool do to the part: seen on its face, and on its side unrolled.

Both views are fixed to the part as it stands at C 0, so that flats milled one after the other lie round it as
they do on the part, whatever C each of them was entered at.

Face: as a tool sees it that looks at the end of the part, the part's X to the right and Y up. The live tool
stands on the negative X side of the lathe (see ``core.geometry.virtual_mill``).
Side: Z+ to the right, as in the view from above. Seen from outside C then counts upwards.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from app.path.polyline import Floats, Polyline, PolylineBuilder, Stroke, bounds_of, mill_way, turn_pieces
from core.geometry.virtual_mill import Face, Side

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove, Spot
    from core.interpreter.shared.elementary_blocks import Block

STILL = 1e-9  # mm, degrees
LEAST = 1.0  # mm: the radius that a side is unrolled at when nothing tells one


def face_point(x: float, c: float, h: float = 0.0) -> tuple[float, float]:
    """Where on the face (to the right, downwards) a tip at lathe X, a radius, stands with C so far turned."""
    at = math.atan2(h, -x) - math.radians(c)
    rho = math.hypot(x, h)
    return rho * math.cos(at), -rho * math.sin(at)


class FaceBuilder:
    """Collects what is seen on the face."""

    def __init__(self, blocks: int) -> None:
        self.pencil = PolylineBuilder(blocks)
        self.wanted = False

    def mill(self, move: PlaneMove, frame: Face, way: list[Spot], stroke: int) -> None:
        """A move of plane switching, in the frame that stood at ``frame.c0`` when it was entered."""
        self.wanted = True
        turn = -math.radians(frame.heading)
        cos, sin = math.cos(turn), math.sin(turn)
        x, y, _ = move.start
        self.pencil.start(x * cos + y * sin, x * sin - y * cos)
        for x, y, _ in way:
            self.pencil.to(x * cos + y * sin, x * sin - y * cos, stroke)
        if move.centre is not None:
            x, y = move.centre
            self.pencil.centres.extend((x * cos + y * sin, x * sin - y * cos))

    def move(self, block: Block, x0: float, x1: float, stroke: int) -> None:
        """Any other move with C locked, from lathe X to lathe X."""
        self.wanted |= abs(block.c - block.c0) > STILL and abs(x1 - x0) > STILL
        self.pencil.start(*face_point(x0, block.c0))
        pieces = turn_pieces(block.c - block.c0)
        for k in range(1, pieces + 1):
            s = k / pieces
            c = block.c0 + (block.c - block.c0) * s
            self.pencil.to(*face_point(x0 + (x1 - x0) * s, c), stroke)

    def polyline(self) -> Polyline:
        """The polyline of what was collected."""
        z, x, stroke, first = self.pencil.arrays()
        low_z, high_z, low_x, high_x = bounds_of(z, x, stroke)
        reach = max(abs(low_z), abs(high_z), abs(low_x), abs(high_x))
        centres = np.array(self.pencil.centres).reshape(-1, 2)
        return Polyline(z, x, stroke, first, (-reach, reach, -reach, reach), centres=centres)


class SideBuilder:
    """Collects what is seen on the side; ``x`` is minus C in degrees until the radius is known."""

    def __init__(self, blocks: int) -> None:
        self.pencil = PolylineBuilder(blocks)
        self.wanted = False
        self._diameter = 0.0  # of the first plane; it is what the programmer has drawn on
        self._reach = 0.0

    def mill(self, move: PlaneMove, frame: Side, way: list[Spot], stroke: int, dz: float) -> None:
        """A move of plane switching; ``dz`` leads from program Z to the part's."""
        self.wanted = True
        self._diameter = self._diameter or frame.diameter
        degrees = 360.0 / (math.pi * frame.diameter)
        x, y, _ = move.start
        self.pencil.start(frame.z0 - x + dz, y * degrees - frame.c0)
        for x, y, _ in way:
            self.pencil.to(frame.z0 - x + dz, y * degrees - frame.c0, stroke)
        if move.centre is not None:
            x, y = move.centre
            self.pencil.centres.extend((frame.z0 - x + dz, y * degrees - frame.c0))

    def move(self, block: Block, x: float, dz: float, stroke: int) -> None:
        """Any other move with C locked, to lathe X."""
        self.wanted |= abs(block.c - block.c0) > STILL and abs(block.z - block.z0) > STILL
        if stroke != Stroke.RAPID:
            self._reach = max(self._reach, abs(x))
        self.pencil.start(block.z0 + dz, -block.c0)
        self.pencil.to(block.z + dz, -block.c, stroke)

    def polyline(self) -> Polyline:
        """What was collected, unrolled at the diameter of the first plane or at the greatest that is cut."""
        z, x, stroke, first = self.pencil.arrays()
        scale = math.pi * (self._diameter or 2 * max(self._reach, LEAST)) / 360.0
        centres = np.array(self.pencil.centres).reshape(-1, 2) * (1.0, scale)
        down: Floats = x * scale
        bounds = bounds_of(z, down, stroke)
        return Polyline(z, down, stroke, first, bounds, centres=centres, round=scale)


class FaceAndSideBuilder:
    """Both views of everything that is done with C locked; made at the first block that is."""

    def __init__(self, blocks: int) -> None:
        self._face, self._side = FaceBuilder(blocks), SideBuilder(blocks)

    def add(self, block: Block, stroke: int, way: list[Spot]) -> None:
        """One move with C locked; ``way`` are the mill's points behind its start, for a move in a plane."""
        modal, plane = block.modal, block.plane
        dz = block.offset_z - modal.base_z
        if plane is None:
            dx = block.offset_x - modal.base_x
            self._face.move(block, block.x0 + dx, block.x + dx, stroke)
            self._side.move(block, block.x + dx, dz, stroke)
        elif isinstance(plane.frame, Side):
            self._side.mill(plane, plane.frame, way, stroke, dz + modal.secondary_z)
        else:
            self._face.mill(plane, plane.frame, way, stroke)

    def end_block(self) -> None:
        """Every block ends, seen or not."""
        self._face.pencil.end_block()
        self._side.pencil.end_block()

    def polylines(self) -> tuple[Polyline | None, Polyline | None]:
        """Face and side, each where something is to be seen there. Where C only divides it is the face."""
        face, side = self._face, self._side
        divides = not side.wanted and len(face.pencil.z) > 0
        return (
            face.polyline() if face.wanted or divides else None,
            side.polyline() if side.wanted else None,
        )


def way_of(block: Block) -> list[Spot]:
    """The mill's points behind the start of a move in a plane."""
    return [] if block.plane is None else mill_way(block.plane, block.c - block.c0)
