"""The helices of the threads on a turned part.

The model of a turned part has a groove for each revolution of a thread. For the picture of the part, these
grooves are turned into a helix: at each polar angle, the profile is displaced by a share of the lead.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.elementary_blocks import BlockKind
from core.part.picture.surface_points import Solid
from core.part.polar_field import make_field_from_section
from core.part.ray_cuts import FloatArray
from core.proving.tip_moves import ProgramStep, TipMove

_COLUMNS, _RAYS = 1800, 360
_SAME_LEAD_MM = 1e-4


class ThreadZone(NamedTuple):
    """A range of Z with a thread.

    ``radius_mm`` is the radius of the tip in the last pass. ``lead_mm`` is positive for a right-hand thread.
    """

    back_z_mm: float
    front_z_mm: float
    radius_mm: float
    lead_mm: float


def find_thread_zones(steps: Iterable[ProgramStep]) -> list[ThreadZone]:
    """Return the zones of the threads that the steps cut; the passes of one thread are one zone.

    A thread is right-handed if it is cut toward the chuck with the spindle forward.
    """
    zones: list[ThreadZone] = []
    for step in steps:
        if not isinstance(step, TipMove) or step.block_kind is not BlockKind.THREAD:
            continue
        start, end = step.points[0], step.points[-1]
        if not step.feed_per_rev_mm or start[0] == end[0]:
            continue
        hand = 1.0 if (start[0] > end[0]) is (step.rpm >= 0.0) else -1.0
        zone = ThreadZone(
            min(start[0], end[0]),
            max(start[0], end[0]),
            0.5 * abs(start[1] + end[1]),
            hand * step.feed_per_rev_mm,
        )
        last = zones[-1] if zones else None
        if last is not None and _is_same_thread(last, zone):
            zone = zone._replace(
                back_z_mm=min(zone.back_z_mm, last.back_z_mm),
                front_z_mm=max(zone.front_z_mm, last.front_z_mm),
            )
            zones[-1] = zone
        else:
            zones.append(zone)
    return zones


def _is_same_thread(one: ThreadZone, other: ThreadZone) -> bool:
    overlaps = one.back_z_mm < other.front_z_mm and other.back_z_mm < one.front_z_mm
    return overlaps and abs(one.lead_mm - other.lead_mm) < _SAME_LEAD_MM


def make_threaded_solid(
    column_edges: FloatArray, inner_radii: FloatArray, outer_radii: FloatArray, zones: Iterable[ThreadZone]
) -> Solid:
    """Return the solid of a half section with helices in place of the grooves of its threads.

    ``inner_radii`` and ``outer_radii`` (layers, columns) are the radii between ``column_edges``.
    """
    field = make_field_from_section(column_edges, inner_radii, outer_radii, _COLUMNS, _RAYS)
    angles = np.arange(_RAYS) / _RAYS
    for zone in zones:
        columns = field.find_columns_between(zone.back_z_mm, zone.front_z_mm)
        z = field.column_centers[columns]
        if len(z) < 2:
            continue
        middle = len(z) // 2
        inner, outer = field.inner_radii[0, columns, 0], field.outer_radii[0, columns, 0]
        is_outside = abs(outer[middle] - zone.radius_mm) <= abs(inner[middle] - zone.radius_mm)
        profile, radii = (outer, field.outer_radii) if is_outside else (inner, field.inner_radii)
        place = z[:, None] - zone.lead_mm * angles
        place += abs(zone.lead_mm) * ((place < z[0]).astype(float) - (place > z[-1]))
        radii[0, columns] = np.interp(place, z, profile)
    return Solid(field.column_edges, field.inner_radii, field.outer_radii)
