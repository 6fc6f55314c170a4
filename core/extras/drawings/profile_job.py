"""A program made from a drawing: proposed fields, remaining material and required offsets."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from core.extras.drawings.drawing_view import Profile, Side
from core.extras.drawings.part_against_drawing import Comparison, Deviation
from core.extras.drawings.profile_program import ProfileProgram, greatest_diameter, nose_of
from core.extras.shapes.lines.code_lines import plain
from core.extras.shapes.shape_fields import Value, Values
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind, ToolShape

_CLOSED = 1e-4  # mm; narrower gaps are not reported


def in_words(
    made: ProfileProgram, comparison: Comparison | None, profile: Profile, *, metric: bool
) -> Iterator[str]:
    """Yield sentences that describe the program and its differences from the drawing.

    Lengths are in the unit of the program.
    """
    mm, unit = (1.0, "mm") if metric else (25.4, "in")
    places = 3 if metric else 4
    if made.nose is not None:
        n = made.nose
        x, z, r = (plain(v / mm, places + 1) for v in (2.0 * n.x, n.z, n.r))
        if n.quadrant:
            edge = f"T{made.tool:.0f} D{n.number}"
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
                number=n.number,
                x=x,
                z=z,
                radius=r,
                unit=unit,
            )
    elif not made.nose_radius:
        yield (
            Message(
                "the tool data of T{tool} has no nose radius, so the contour is not compensated",
                tool=f"{made.tool:.0f}",
            )
        )
    if profile.closed > _CLOSED:
        yield Message(
            "gaps up to {closed} {unit} were closed", closed=plain(profile.closed / mm, places), unit=unit
        )
    for each in made.left:
        yield Message(
            "Z {front} to {back} is not cut: {why}",
            front=plain(each.front / mm, places),
            back=plain(each.back / mm, places),
            why=each.why,
        )
    if comparison is None:
        yield ("proving did not produce a simulated part, so a comparison with the drawing was not possible")
        return
    for found in comparison.found:
        yield _deviation(found, made.nose_radius, mm, unit, places)
    within = plain(max(comparison.worst, 0.001) / mm, places)
    template = (
        ("except at the listed deviations, the simulated part matches the drawing to within {within} {unit}")
        if comparison.found
        else "the simulated part matches the drawing to within {within} {unit}"
    )
    yield Message(template, within=within, unit=unit)


def _deviation(found: Deviation, nose: float, mm: float, unit: str, places: int) -> str:
    deep = plain(abs(found.most) / mm, places)
    if is_corner(found, nose):
        at = plain(found.back / mm, places)
        return Message(
            "{depth} {unit} of stock remains in the corner at Z {position} because of the tool nose radius",
            depth=deep,
            unit=unit,
            position=at,
        )
    template = (
        "{depth} {unit} of stock remains (measured on the radius) from Z {front} to Z {back}"
        if found.most > 0.0
        else "{depth} {unit} too much is cut (measured on the radius) from Z {front} to Z {back}"
    )
    front, back = (plain(z / mm, places) for z in (found.front, found.back))
    return Message(template, depth=deep, unit=unit, front=front, back=back)


def is_corner(found: Deviation, nose: float) -> bool:
    """Return whether a deviation is only the material that the tool nose leaves in a square corner."""
    return 0.0 < found.most <= nose and found.front - found.back <= nose


def in_json(made: ProfileProgram, comparison: Comparison | None, profile: Profile) -> dict[str, Any]:
    """Return the description of the program and its deviations for JSON, in mm."""
    return {
        "side": str(profile.side),
        "closed_gap_mm": round(profile.closed, 5),
        **_nose_in_json(made),
        "left": [{"back_mm": each.back, "front_mm": each.front, "why": each.why} for each in made.left],
        "worst_mm": None if comparison is None else round(comparison.worst, 5),
        "deviations": []
        if comparison is None
        else [
            {"back_mm": round(d.back, 4), "front_mm": round(d.front, 4), "most_mm": round(d.most, 4)}
            for d in comparison.found
        ],
    }


def _nose_in_json(made: ProfileProgram) -> dict[str, Any]:
    """Return the offset that G41 requires, as a secondary offset or a cutting edge."""
    nose = made.nose
    if nose is not None and nose.quadrant:
        edge = {"tool": int(made.tool), "edge": nose.number, "r": nose.r, "quadrant": nose.quadrant}
        return {"secondary_offset": None, "cutting_edge": edge}
    if nose is None:
        return {"secondary_offset": None}
    return {"secondary_offset": {"number": nose.number, "x": round(nose.x, 6), "z": nose.z, "r": nose.r}}


_BAR = {True: 1.0, False: 0.0625}  # bar diameters come in these steps, by metric
_FACE = {True: 0.5, False: 0.02}
_SKIN = 0.2  # mm of diameter, smallest amount to be cut from a bar
_EDGE = 1.0  # first cutting edge of a tool in SINUMERIK


def proposed_fields(
    profile: Profile,
    given: Values,
    shapes: Mapping[int, ToolShape],
    *,
    metric: bool,
    dialect: Dialect = Dialect.OMNITURN,
) -> dict[str, Value]:
    """Return the fields for ``profile_program``: the given values, with proposals for the others."""
    inside = profile.side is Side.INSIDE
    fields: dict[str, Value] = {"UNIT": "METRIC" if metric else "INCH", **given}
    bar = fields.setdefault("BAR", proposed_bar(profile, metric=metric))
    if not inside:
        fields["FROM"] = bar
        fields.setdefault("STOCK", _FACE[metric])
    kind = ToolKind.BORING if inside else ToolKind.TURNING
    free = next(n for n in range(1, len(shapes) + 2) if n not in shapes)
    fields.setdefault("T", float(first_tool(shapes, kind, inside=inside) or free))
    blade = first_tool(shapes, ToolKind.GROOVING, inside=inside)
    if blade:
        fields.setdefault("BLADE", float(blade))
    tool = shapes.get(int(float(fields["T"])))
    number = float(fields["T"]) if dialect is Dialect.OMNITURN else _EDGE
    fields.setdefault("COMP", number if nose_of(tool) else 0.0)
    return {word: float(value) if not isinstance(value, str) else value for word, value in fields.items()}


def proposed_bar(profile: Profile, *, metric: bool) -> float:
    """Return the smallest standard bar diameter that contains the contour, in the program's unit."""
    across = greatest_diameter(profile) * (1.5 if profile.side is Side.INSIDE else 1.0) + _SKIN
    step = _BAR[metric]
    return round(step * math.ceil(across / (1.0 if metric else 25.4) / step - 1e-6), 4)


def first_tool(shapes: Mapping[int, ToolShape], kind: ToolKind, *, inside: bool) -> int:
    """Return the first tool of a kind according to the tool data, or 0."""
    fits = (n for n, each in sorted(shapes.items()) if each.kind is kind and each.internal is inside)
    return next((n for n in fits if not shapes[n].behind), 0)
