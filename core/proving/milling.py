"""Live tools on a turned part: their moves and the polar field from which they remove material."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.elementary_blocks import Block
from core.part.milled_part import MilledPart
from core.part.polar_field import PolarField, RemovedMaterial, make_field_from_section, sort_intervals
from core.part.ray_cuts import (
    FloatArray,
    make_axial_path,
    make_c_axis_path,
    make_plane_path,
    make_radial_path,
)
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import PartedPiece, TurnedPart
from core.proving.tip_moves import FAST_FEED_MM_S, MachineXZ

_CONES = frozenset({ToolKind.DRILL, ToolKind.CENTER_DRILL})
_DEEPER = 0.0254  # mm
_SLOPE_TOLERANCE_MM = 0.002  # mm of tolerance for a slope in a wider column


class MillMove(NamedTuple):
    """The move of a live tool in one elementary block.

    ``path`` (n, 3) is its axial or radial path, as for ``MilledPart``.
    """

    block_number: int
    line: int
    path: FloatArray
    is_axial: bool
    is_fast: bool


def make_mill_move(block: Block, part_zero: MachineXZ, shape: ToolShape) -> MillMove | None:
    """Return the move of a block in the part's frame, or None if the block does not move.

    ``part_zero`` is added to X and Z of the block.
    """
    turns_only = (block.x, block.z) == (block.x0, block.z0)  # the feed of the block is in degrees
    quick = block.rapid or (not block.per_rev and not turns_only and block.feed >= FAST_FEED_MM_S)
    dx, dz = part_zero
    if block.plane is not None:
        lift = dz + block.modal.secondary_offset_z
        axial = not block.plane.is_on_side_plane
        return MillMove(block.n, block.line, make_plane_path(block.plane, lift), axial, quick)
    ends = np.array(
        [[block.x0 + dx, block.z0 + dz, block.c0], [block.x + dx, block.z + dz, block.c]], dtype=np.float64
    )
    if np.array_equal(ends[0], ends[1]):
        return None
    axial = shape.direction[0] != 0
    if axial:
        return MillMove(block.n, block.line, make_axial_path(make_c_axis_path(ends[0], ends[1])), True, quick)
    far_side = float(ends[:, 0].mean()) > 0.0
    return MillMove(block.n, block.line, make_radial_path(ends, is_far_side=far_side), False, quick)


def trim_path_to_fractions(path: FloatArray, start_fraction: float, end_fraction: float) -> FloatArray:
    """Return the section of a path between two fractions, each from 0 to 1.

    The points of the path are treated as equally spaced.
    """
    at = np.linspace(0.0, 1.0, len(path))
    shares = np.concatenate(
        ([start_fraction], at[(at > start_fraction) & (at < end_fraction)], [end_fraction])
    )
    return np.column_stack([np.interp(shares, at, coordinates) for coordinates in path.T])


def calculate_point_height_mm(shape: ToolShape) -> float:
    """Return the height in mm of the point of a live drill, or 0 for a mill."""
    if shape.kind not in _CONES or not shape.point:
        return 0.0
    return float(shape.diameter / 2.0 / np.tan(np.radians(shape.point / 2.0)))


class MillingState:
    """A turned part, together with the polar field from which live tools remove material.

    Material that is turned off afterward is also removed from the field.
    """

    def __init__(self, part: TurnedPart) -> None:
        self._turned = part
        columns = part.columns
        edges: FloatArray = columns.first_z_mm + columns.step_mm * (
            np.arange(columns.column_count + 1, dtype=np.float64) - 0.5
        )
        self._part = MilledPart(make_field_from_section(edges, part.inner_radii, part.outer_radii))
        self._volume = part.volume_mm3  # volume of the turned part at the last update of the field

    @classmethod
    def from_field(cls, part: TurnedPart, field: PolarField, volume: float) -> MillingState:
        """Return the state with an existing field.

        ``volume`` is the volume in mm³ of the turned part at the last update of the field.
        """
        milling = cls.__new__(cls)
        milling._turned, milling._part, milling._volume = part, MilledPart(field), volume
        return milling

    @property
    def last_update_volume_mm3(self) -> float:
        """Return the volume in mm³ of the turned part at the last update of the field."""
        return self._volume

    @property
    def updated_field(self) -> PolarField:
        """Return the polar field after the turned cuts have been removed from it."""
        self._update_field()
        return self._part.field

    @property
    def nbytes(self) -> int:
        """Return the memory that the field uses, in bytes."""
        return self._part.field.inner_radii.nbytes + self._part.field.outer_radii.nbytes

    @property
    def remaining_volume_mm3(self) -> float:
        """Return the volume in mm³ of the material in the chuck."""
        return self.updated_field.volume_mm3

    def cut_material(self, move: MillMove, shape: ToolShape) -> RemovedMaterial:
        """Remove the material that a live tool sweeps, and return the removed material."""
        self._update_field()
        part, (radius, length, point) = self._part, _mill_sizes(shape)
        if move.is_axial:
            return part.mill_axial_path(move.path, radius, length, point)
        return part.mill_radial_path(move.path, radius, length, cone_height=point)

    def follows_face(self, move: MillMove, shape: ToolShape) -> bool:
        """Return whether a live tool moves along a face without cutting it.

        The result is True if the move cuts nothing, but would cut if it were .001 in deeper.
        """
        self._update_field()
        part, (radius, length, point) = self._part, _mill_sizes(shape)
        if move.is_axial:
            return part.has_axial_collision(move.path - [0.0, 0.0, _DEEPER], radius, length, point)
        return part.has_radial_collision(move.path - [_DEEPER, 0.0, 0.0], radius, length, point=point)

    def subtract_milled_volume(self, piece: PartedPiece) -> PartedPiece:
        """Return a piece that was just parted off, without the volume that live tools have removed."""
        if not piece.outside_profile:
            return piece
        field = self._part.field
        front, back = piece.outside_profile[0][0], piece.outside_profile[-1][0]
        there = (field.column_centers < front) & (field.column_centers > back)
        return piece._replace(volume_mm3=min(float(field.column_volumes[there].sum()), piece.volume_mm3))

    def make_section_halves(self) -> tuple[PartedPiece, PartedPiece]:
        """Return both halves of the section with C at 0: first X+, then X-."""
        field = self.updated_field
        rays = field.inner_radii.shape[2]  # =
        upper, lower = (
            _section_profiles(field.column_edges, field.inner_radii[:, :, ray], field.outer_radii[:, :, ray])
            for ray in (rays // 2, 0)
        )
        return upper, lower

    def _update_field(self) -> None:
        """Remove from the field the material that has been turned off since the last update."""
        turned = self._turned
        if turned.volume_mm3 == self._volume:
            return
        self._volume = turned.volume_mm3
        field = self._part.field
        at = np.clip(
            np.rint((field.column_centers - turned.columns.first_z_mm) / turned.columns.step_mm).astype(
                np.intp
            ),
            0,
            turned.columns.column_count - 1,
        )
        everywhere = slice(0, len(field.column_centers))
        for start, end in _iter_gaps(*sort_intervals(turned.inner_radii[:, at], turned.outer_radii[:, at])):
            field.find_removed_material(everywhere, slice(None), start[:, None], end[:, None])


def _section_profiles(edges: FloatArray, low: FloatArray, high: FloatArray) -> PartedPiece:
    """Return one half of a section as the profiles of a piece, without its volume."""
    there = high > low
    outer = np.max(np.where(there, high, 0.0), axis=0)
    inner = np.min(np.where(there, low, np.inf), axis=0)
    columns = np.flatnonzero(outer > 0.0)[::-1].tolist()
    outside, bore = (
        [(float(z), float(r[at])) for at in columns for z in (edges[at + 1], edges[at])]
        for r in (outer, inner)
    )
    return PartedPiece(0.0, outside, bore if any(r > 0.0 for _, r in bore) else None, None)


def _mill_sizes(shape: ToolShape) -> tuple[float, float, float]:
    """Return the radius, the cutting length and the height of the point of a mill."""
    return shape.diameter / 2.0, shape.length or math.inf, calculate_point_height_mm(shape)


def _iter_gaps(low: FloatArray, high: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the r ranges without material between sorted layers (layers, columns), inside first."""
    there = high > low
    begins = np.where(there, low - _SLOPE_TOLERANCE_MM, np.inf)
    ends = np.maximum.accumulate(np.where(there, high + _SLOPE_TOLERANCE_MM, 0.0), axis=0)
    yield np.zeros(low.shape[1]), begins[0]
    for layer in range(len(low)):
        outer = begins[layer + 1] if layer + 1 < len(low) else np.full(low.shape[1], np.inf)
        yield ends[layer], outer
