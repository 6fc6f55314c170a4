"""Codes of inserts and holders (ISO 1832, ISO 5608, ISO 5609) for given dimensions.

The functions are the reverse of ``insert_codes``. A dimension that no code of the standard contains has no
code; it is never rounded to the nearest size.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from core.part.insert_codes import (
    CLEARANCE_ANGLES,
    CORNER_ANGLES,
    CORNER_RADII,
    MM_PER_INCH,
    THICKNESSES,
    list_metric_circle_sizes,
    make_insert,
    parse_holder,
)

_SIZE_TOLERANCE_MM = 0.06  # libraries round edge lengths to 0.1 mm; the sizes are at least 0.7 mm apart
_TOLERANCE_MM = 0.02  # of corner radii and thicknesses, which are at least 0.1 mm apart
_ANGLE_TOLERANCE_DEG = 0.1
_SIXTEENTH_MM = MM_PER_INCH / 16.0


class InsertSizes(NamedTuple):
    """Properties of an insert, in mm and degrees.

    ``shape``, ``tolerance_class`` and ``insert_type`` are the first, third and fourth letter of the ISO
    1832 code. ``size`` is the inscribed circle or, if ``is_edge_length`` is True, the length of the cutting
    edge.
    """

    shape: str
    clearance_angle: float
    tolerance_class: str
    insert_type: str
    size: float
    is_edge_length: bool
    thickness: float
    nose_radius: float


class HolderSizes(NamedTuple):
    """Properties of a holder: the letters of ISO 5608, and the shank in mm.

    ``clamping`` is X if it is unknown. A boring bar is round, and ``shank_width_mm`` is its diameter.
    """

    clamping: str
    insert_shape: str
    style: str
    clearance_letter: str
    hand: str
    shank_height_mm: float
    shank_width_mm: float
    is_boring_bar: bool


def find_clearance_letter(angle_deg: float) -> str:
    """Return the letter of ISO 1832 for a clearance angle, or an empty string if there is no letter."""
    return next((k for k, v in CLEARANCE_ANGLES.items() if abs(v - angle_deg) <= _ANGLE_TOLERANCE_DEG), "")


def format_insert_code(sizes: InsertSizes) -> str:
    """Return the ISO 1832 code of an insert, or an empty string if a property has no code.

    The corner digits of a round insert are 00.
    """
    clearance = find_clearance_letter(sizes.clearance_angle)
    if sizes.shape not in CORNER_ANGLES or not clearance:
        return ""
    if len(sizes.tolerance_class) != 1 or len(sizes.insert_type) != 1:
        return ""
    size = _find_size_digits(sizes)
    thickness = _find_nearest(THICKNESSES, sizes.thickness)
    corner = "00" if sizes.shape == "R" else _find_nearest(CORNER_RADII, sizes.nose_radius)
    if not size or not thickness or not corner:
        return ""
    return f"{sizes.shape}{clearance}{sizes.tolerance_class}{sizes.insert_type}{size}{thickness}{corner}"


def _find_size_digits(sizes: InsertSizes) -> str:
    circles = list_metric_circle_sizes(sizes.shape)
    if not sizes.is_edge_length or sizes.shape == "R":
        return _find_nearest(circles, sizes.size, _SIZE_TOLERANCE_MM)
    edges = {
        digits: make_insert(sizes.shape, circle, 0.0).edge_lengths[0] for digits, circle in circles.items()
    }
    return _find_nearest(edges, sizes.size, _SIZE_TOLERANCE_MM)


def _find_nearest(table: Mapping[str, float], value: float, tolerance: float = _TOLERANCE_MM) -> str:
    """Return the key with the nearest value, or an empty string if no value is within tolerance."""
    key = min(table, key=lambda each: abs(table[each] - value))
    return key if abs(table[key] - value) <= tolerance else ""


def format_holder_code(holder: HolderSizes, insert_code: str) -> str:
    """Return the ISO code of a holder.

    If the holder has no code, return the size of its shank, or an empty string if the size is unknown.
    ``insert_code`` is the ISO code of the insert, whose size is part of most codes; it may be empty.
    """
    return next((code for code in _list_codes(holder, insert_code) if parse_holder(code)), "")


def _list_codes(holder: HolderSizes, insert_code: str) -> Iterator[str]:
    head = f"{holder.insert_shape}{holder.style}{holder.clearance_letter}{holder.hand}"
    edge = insert_code[4:6]
    eighths = _count_eighths(holder.insert_shape, edge)
    width, height = holder.shank_width_mm, holder.shank_height_mm or holder.shank_width_mm
    if len(head) == 4 and holder.is_boring_bar:
        if edge and _is_whole(width):
            yield f"S{round(width):02d}-{holder.clamping}{head}{edge}"
        if eighths and _is_whole(width / _SIXTEENTH_MM):
            yield f"S{round(width / _SIXTEENTH_MM):02d}-{holder.clamping}{head}{eighths}"
    elif len(head) == 4:
        if _is_whole(width) and _is_whole(height):
            yield f"{holder.clamping}{head}{round(height):02d}{round(width):02d}"
        if eighths and _is_whole(width / _SIXTEENTH_MM):
            yield f"{holder.clamping}{head}-{round(width / _SIXTEENTH_MM):02d}{eighths}"
    if width and not holder.is_boring_bar:
        yield f"{height:g}x{width:g} mm"


def _is_whole(value: float) -> bool:
    return 1.0 <= value < 99.5 and abs(value - round(value)) <= 0.01


def _count_eighths(shape: str, edge: str) -> int:
    """Return the inscribed circle in eighths of an inch for an edge length code, or 0 if unknown."""
    if shape not in CORNER_ANGLES:
        return 0
    eighths = list_metric_circle_sizes(shape).get(edge, 0.0) / MM_PER_INCH * 8.0
    return round(eighths) if _is_whole(eighths) and eighths < 9.5 else 0
