"""Functions for programs from drawings: field proposals, remaining material and required offsets."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.extras.drawings.part_comparison import DrawingComparison, PartDeviation
from core.extras.drawings.profile_program import ProfileProgram, find_max_diameter, find_nose_radius
from core.extras.shapes.lines.code_lines import format_short_number
from core.extras.shapes.shape_fields import FieldValue, FieldValues
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind, ToolShape

_CLOSED = 1e-4  # mm; narrower gaps are not reported


def describe_program(
    program: ProfileProgram, comparison: DrawingComparison | None, profile: ContourProfile, *, is_metric: bool
) -> Iterator[str]:
    """Yield sentences that describe the program and the differences of its part from the drawing.

    Lengths are in the unit of the program.
    """
    mm, unit = (1.0, "mm") if is_metric else (25.4, "in")
    places = 3 if is_metric else 4
    if program.nose_offset is not None:
        n = program.nose_offset
        x, z, r = (format_short_number(v / mm, places + 1) for v in (2.0 * n.x, n.z, n.nose_radius))
        if n.quadrant:
            edge = f"T{program.tool_number:.0f} D{n.offset_number}"
            yield Message(
                "{edge} must have nose radius {radius} {unit} and tip quadrant {quadrant}",
                edge=edge,
                radius=r,
                unit=unit,
                quadrant=n.quadrant,
            )
        else:
            yield Message(
                "secondary offset {number} must have X {x} (diameter), Z {z}, R {radius} {unit}",
                number=n.offset_number,
                x=x,
                z=z,
                radius=r,
                unit=unit,
            )
    elif not program.nose_radius_mm:
        yield (
            Message(
                "the tool data of T{tool} has no nose radius, so the contour is not compensated",
                tool=f"{program.tool_number:.0f}",
            )
        )
    if profile.widest_closed_gap_mm > _CLOSED:
        yield Message(
            "gaps up to {closed} {unit} were closed",
            closed=format_short_number(profile.widest_closed_gap_mm / mm, places),
            unit=unit,
        )
    for each in program.uncut_ranges:
        yield Message(
            "Z {front} to {back} is not cut: {why}",
            front=format_short_number(each.front_z_mm / mm, places),
            back=format_short_number(each.back_z_mm / mm, places),
            why=each.reason,
        )
    if comparison is None:
        yield ("proving did not produce a simulated part, so a comparison with the drawing was not possible")
        return
    for found in comparison.deviations:
        yield _deviation(found, program.nose_radius_mm, mm, unit, places)
    within = format_short_number(max(comparison.worst_deviation_mm, 0.001) / mm, places)
    template = (
        ("except at the listed deviations, the simulated part matches the drawing to within {within} {unit}")
        if comparison.deviations
        else "the simulated part matches the drawing to within {within} {unit}"
    )
    yield Message(template, within=within, unit=unit)


def _deviation(found: PartDeviation, nose: float, mm: float, unit: str, places: int) -> str:
    deep = format_short_number(abs(found.max_deviation_mm) / mm, places)
    if is_nose_fillet(found, nose):
        at = format_short_number(found.back_z_mm / mm, places)
        return Message(
            "{depth} {unit} of stock remains in the corner at Z {position} because of the tool nose radius",
            depth=deep,
            unit=unit,
            position=at,
        )
    template = (
        "{depth} {unit} of stock remains (measured on the radius) from Z {front} to Z {back}"
        if found.max_deviation_mm > 0.0
        else "{depth} {unit} too much is cut (measured on the radius) from Z {front} to Z {back}"
    )
    front, back = (format_short_number(z / mm, places) for z in (found.front_z_mm, found.back_z_mm))
    return Message(template, depth=deep, unit=unit, front=front, back=back)


def is_nose_fillet(deviation: PartDeviation, nose_radius: float) -> bool:
    """Return whether a deviation is only the material that the tool nose leaves in a square corner."""
    return (
        0.0 < deviation.max_deviation_mm <= nose_radius
        and deviation.front_z_mm - deviation.back_z_mm <= nose_radius
    )


def convert_to_json(
    program: ProfileProgram, comparison: DrawingComparison | None, profile: ContourProfile
) -> dict[str, Any]:
    """Return a JSON object that describes the program and its deviations, in mm."""
    return {
        "side": str(profile.side),
        "closed_gap_mm": round(profile.widest_closed_gap_mm, 5),
        **_convert_nose_to_json(program),
        "left": [
            {"back_mm": each.back_z_mm, "front_mm": each.front_z_mm, "why": each.reason}
            for each in program.uncut_ranges
        ],
        "worst_mm": None if comparison is None else round(comparison.worst_deviation_mm, 5),
        "deviations": []
        if comparison is None
        else [
            {
                "back_mm": round(d.back_z_mm, 4),
                "front_mm": round(d.front_z_mm, 4),
                "most_mm": round(d.max_deviation_mm, 4),
            }
            for d in comparison.deviations
        ],
    }


def _convert_nose_to_json(program: ProfileProgram) -> dict[str, Any]:
    """Return a JSON object with the nose offset that G41 and G42 require.

    It is a secondary offset or a cutting edge.
    """
    nose = program.nose_offset
    if nose is not None and nose.quadrant:
        edge = {
            "tool": int(program.tool_number),
            "edge": nose.offset_number,
            "r": nose.nose_radius,
            "quadrant": nose.quadrant,
        }
        return {"secondary_offset": None, "cutting_edge": edge}
    if nose is None:
        return {"secondary_offset": None}
    return {
        "secondary_offset": {
            "number": nose.offset_number,
            "x": round(nose.x, 6),
            "z": nose.z,
            "r": nose.nose_radius,
        }
    }


_BAR = {True: 1.0, False: 0.0625}  # bar diameters come in these steps, by metric
_FACE = {True: 0.5, False: 0.02}
_SKIN = 0.2  # mm of diameter, smallest amount to be cut from a bar
_EDGE = 1.0  # first cutting edge of a tool in SINUMERIK


def propose_program_fields(
    profile: ContourProfile,
    given_values: FieldValues,
    shapes: Mapping[int, ToolShape],
    *,
    is_metric: bool,
    dialect: Dialect = Dialect.OMNITURN,
) -> dict[str, FieldValue]:
    """Return the values of all fields for ``make_profile_program``.

    The result contains the given values, and proposals for all other fields.
    """
    inside = profile.side is ContourSide.INSIDE
    fields: dict[str, FieldValue] = {"UNIT": "METRIC" if is_metric else "INCH", **given_values}
    bar = fields.setdefault("BAR", propose_bar_diameter(profile, is_metric=is_metric))
    if not inside:
        fields["FROM"] = bar
        fields.setdefault("STOCK", _FACE[is_metric])
    kind = ToolKind.BORING if inside else ToolKind.TURNING
    free = next(n for n in range(1, len(shapes) + 2) if n not in shapes)
    fields.setdefault("T", float(find_first_tool_number(shapes, kind, is_inside=inside) or free))
    blade = find_first_tool_number(shapes, ToolKind.GROOVING, is_inside=inside)
    if blade:
        fields.setdefault("BLADE", float(blade))
    tool = shapes.get(int(float(fields["T"])))
    number = float(fields["T"]) if dialect is Dialect.OMNITURN else _EDGE
    fields.setdefault("COMP", number if find_nose_radius(tool) else 0.0)
    return {word: float(value) if not isinstance(value, str) else value for word, value in fields.items()}


def propose_bar_diameter(profile: ContourProfile, *, is_metric: bool) -> float:
    """Return the smallest standard bar diameter that contains the contour, in the program's unit."""
    across = find_max_diameter(profile) * (1.5 if profile.side is ContourSide.INSIDE else 1.0) + _SKIN
    step = _BAR[is_metric]
    return round(step * math.ceil(across / (1.0 if is_metric else 25.4) / step - 1e-6), 4)


def find_first_tool_number(shapes: Mapping[int, ToolShape], kind: ToolKind, *, is_inside: bool) -> int:
    """Return the number of the first tool of a kind in the tool data, or 0 if there is none."""
    fits = (n for n, each in sorted(shapes.items()) if each.kind is kind and each.internal is is_inside)
    return next((n for n in fits if not shapes[n].is_rear_tool), 0)
