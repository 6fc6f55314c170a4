"""The state of a part at one time in a program, and copies from which a simulation can continue.

The state contains the section, the tool and the collisions. All arrays are independent, so another thread
may store them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.language.diagnostics import Diagnostic
from core.part.picture.solid_bodies import SymmetryAxis
from core.part.polar_field import FieldCopy, RemovedMaterial, make_compact_copy, restore_field
from core.part.stock import Clamping, Stock
from core.part.swept_edge import FloatArray, Point
from core.part.turned_part import Cut, TurnedPart
from core.proving.checks.part_checks import is_serious_finding
from core.proving.milling import MillingState
from core.proving.part_simulation import PartSimulation
from core.proving.tip_moves import LiveToolStep, ProgramStep

_TOUCH = 1e-6  # mm
_SAMPLE_COUNT = 40  # points along a hit in chuck or tailstock
_CLAMPING_CHECKS = frozenset({"into-chuck", "into-tailstock"})
# For other findings, the material that a block removes is the intended cut.
_MATERIAL_CHECKS = frozenset(
    {"rapid-into-stock", "feed-into-holder", "holder-into-stock", "through-part", "neighbour-tool"}
)
MaterialRadii = tuple[FloatArray, FloatArray]
"""Lowest and highest radius of the layers of each column, in mm."""
_COPY_INTERVAL = 16  # initial number of blocks between two copies
_MAX_COPIES = 96
_MAX_BYTES = 96e6  # bytes of all copies


class SectionHalf(NamedTuple):
    """One half of the section of a part.

    ``column_edges`` (columns + 1,) are Z, ascending. The material extends from ``inner_radii`` to
    ``outer_radii`` (layers, columns), as radii in mm.
    """

    column_edges: FloatArray
    inner_radii: FloatArray
    outer_radii: FloatArray


class MaterialHit(NamedTuple):
    """The material that a tool hits because of a program fault.

    ``finding`` is the diagnostic. At each of ``z_positions`` (n,), the hit extends from ``inner_radii`` to
    ``outer_radii``, with a width along Z of ``column_width_mm``.
    """

    finding: Diagnostic
    z_positions: FloatArray
    inner_radii: FloatArray
    outer_radii: FloatArray
    column_width_mm: float


class PlacedTool(NamedTuple):
    """A tool at its position, with its control point and its outlines (k, 2) of Z and r in mm.

    ``is_assumed`` means that the shape of the tool is not specified, so its body is a typical one.
    ``symmetry_axis`` is the axis about which the tool is round.
    """

    tool_number: int
    control_point: Point
    cutting_outlines: tuple[FloatArray, ...]
    body_outlines: tuple[FloatArray, ...]
    is_assumed: bool
    symmetry_axis: SymmetryAxis = SymmetryAxis.NONE


class PartState(NamedTuple):
    """The part after ``block_count`` blocks and the fraction ``next_block_fraction`` of the next block.

    ``x_plus_half`` is the half of the section at X+, and ``x_minus_half`` is the opposite half; None means
    no material. ``material_hits`` and ``findings`` include everything up to this time. ``tip_range`` is the
    range of the tip in Z and r.
    """

    block_count: int
    next_block_fraction: float
    line_number: int
    x_plus_half: SectionHalf | None
    x_minus_half: SectionHalf | None
    stock: Stock | None
    tool: PlacedTool | None
    material_hits: tuple[MaterialHit, ...]
    findings: tuple[Diagnostic, ...]
    parted_piece_count: int
    clamping: Clamping | None = None
    is_collet_open: bool = False
    tip_range: tuple[Point, Point] | None = None
    c_angle_deg: float = 0.0  # present or last angle of an engaged C axis, degrees


def copy_material(part: TurnedPart | None) -> MaterialRadii | None:
    """Return a copy of the current material, for a later comparison."""
    return None if part is None else (part.inner_radii.copy(), part.outer_radii.copy())


def find_material_hit(
    finding: Diagnostic,
    step: ProgramStep,
    simulation: PartSimulation,
    previous_material: MaterialRadii | None,
) -> MaterialHit | None:
    """Return the material that the last block hit, or None if ``finding`` does not report a hit."""
    if not is_serious_finding(finding):
        return None
    if finding.check_name in _CLAMPING_CHECKS:
        met = simulation.findings.clamping_cuts.get((finding.check_name, finding.line))
        return _clamping_hit(finding, met, simulation.findings.clamping, simulation.initial_stock)
    if finding.check_name not in _MATERIAL_CHECKS:
        return None
    if isinstance(step, LiveToolStep):
        return _milled_hit(finding, simulation.last_milled_material)
    if previous_material is None or simulation.part is None:
        return None
    return _removed_material_hit(finding, previous_material, simulation.part)


def _clamping_hit(
    finding: Diagnostic, cut: Cut | None, clamping: Clamping | None, stock: Stock | None
) -> MaterialHit | None:
    """Return the collision of a tool with the chuck, collet or tailstock.

    The collision extends from the outside of this body to the depth of the cut.
    """
    if cut is None or clamping is None or stock is None:
        return None
    body = (
        clamping.tailstock_solid
        if finding.check_name == "into-tailstock"
        else clamping.make_chuck_for_stock(stock)
    )
    if body is None:
        return None
    low, high = (
        max(min(cut.back_z_mm, cut.front_z_mm), body.back_z_mm),
        min(max(cut.back_z_mm, cut.front_z_mm), body.front_z_mm),
    )
    z = np.linspace(low, high, _SAMPLE_COUNT)
    outside = body.find_outside_radii(z)
    return MaterialHit(
        finding, z, np.maximum(outside - cut.depth_mm, 0.0), outside, (high - low) / (_SAMPLE_COUNT - 1)
    )


def _removed_material_hit(
    finding: Diagnostic, previous_material: MaterialRadii, part: TurnedPart
) -> MaterialHit | None:
    """Return the radius range of removed material in each column, or None if none was removed."""
    layers = len(previous_material[0])
    low, high = part.inner_radii[:layers], part.outer_radii[:layers]
    was = previous_material[1] > previous_material[0]
    above = was & (previous_material[1] - high > _TOUCH)
    below = was & (low - previous_material[0] > _TOUCH)
    touched = (above | below).any(axis=0)
    if not touched.any():
        return None
    least = np.minimum(
        np.where(above, np.maximum(high, previous_material[0]), np.inf).min(axis=0),
        np.where(below, previous_material[0], np.inf).min(axis=0),
    )
    most = np.maximum(
        np.where(above, previous_material[1], 0.0).max(axis=0),
        np.where(below, np.minimum(low, previous_material[1]), 0.0).max(axis=0),
    )
    z = part.columns.column_centers[touched]
    return MaterialHit(finding, z, least[touched], most[touched], part.columns.step_mm)


def _milled_hit(finding: Diagnostic, removed: RemovedMaterial) -> MaterialHit | None:
    """Return the material that a live tool has hit."""
    if not removed:
        return None
    middle, low, high = (
        np.array([each])
        for each in (
            0.5 * (removed.back_z_mm + removed.front_z_mm),
            removed.min_radius_mm,
            removed.max_radius_mm,
        )
    )
    return MaterialHit(finding, middle, low, high, removed.front_z_mm - removed.back_z_mm)


class PartCopies:
    """Copies of the part, each stored by the number of completed program steps.

    If there are too many copies, every second copy is dropped. Copies of a milled part share the columns
    that did not change between them.
    """

    def __init__(self) -> None:
        self._copies: dict[int, tuple[PartSimulation, FieldCopy | None, float]] = {}
        self._every = _COPY_INTERVAL

    def find_last_copy(self, step_count: int) -> int:
        """Return the step count of the last copy at or before ``step_count`` steps."""
        return max(each for each in self._copies if each <= step_count)

    def copy(self, step_count: int) -> PartSimulation:
        """Return a copy of the part from which work can continue."""
        kept, field, even_with = self._copies[step_count]
        making = kept.copy()
        if field is not None and making.part is not None:
            making.milling = MillingState.from_field(making.part, restore_field(field), even_with)
        return making

    def store_copy_if_due(self, step_count: int, simulation: PartSimulation) -> None:
        """Store a copy at every multiple of the copy interval that has no copy yet."""
        if step_count % self._every == 0 and step_count not in self._copies:
            self.store_copy(step_count, simulation)

    def store_copy(self, step_count: int, simulation: PartSimulation) -> None:
        """Store a copy of the part in its state after ``step_count`` steps."""
        milling = simulation.milling
        field, even_with = None, 0.0
        if milling is not None:
            near = self._copies.get(max((each for each in self._copies if each < step_count), default=-1))
            field = make_compact_copy(milling.updated_field, near[1] if near is not None else None)
            even_with = milling.last_update_volume_mm3
        simulation.milling = None
        self._copies[step_count] = simulation.copy(), field, even_with
        simulation.milling = milling
        while len(self._copies) > _MAX_COPIES or (self._total_bytes > _MAX_BYTES and len(self._copies) > 2):
            self._every *= 2
            for each in [each for each in self._copies if each % self._every]:
                del self._copies[each]

    @property
    def _total_bytes(self) -> int:
        """Return the memory of all copies in bytes, counting shared columns once."""
        columns = {
            id(column): column.nbytes
            for _, field, _ in self._copies.values()
            if field is not None
            for column in field.radii_by_column.values()
        }
        return sum(columns.values()) + sum(making.nbytes for making, _, _ in self._copies.values())
