"""What is proposed for a program from a drawing: bar, tools, depth of a pass, nose compensation."""

from __future__ import annotations

import math
from collections.abc import Mapping

from core.extras.drawings.drawing_view import Profile, Side
from core.extras.drawings.profile_program import greatest_diameter, nose_of
from core.extras.shapes.shape_fields import Value, Values
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape

_BAR = {True: 1.0, False: 0.0625}  # by metric: bars come in these steps
_FACE = {True: 0.5, False: 0.02}
_SKIN = 0.2  # mm of a diameter that is taken off a bar at least
_EDGE = 1.0  # the cutting edge that a tool of SINUMERIK has first


def proposed_fields(
    profile: Profile,
    given: Values,
    shapes: Mapping[int, ToolShape],
    *,
    metric: bool,
    dialect: Dialect = Dialect.OMNITURN,
) -> dict[str, Value]:
    """The fields of ``profile_program``: what is given, and what is proposed for the rest."""
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
    """The next bar, in the unit of the program, that the contour lies in."""
    across = greatest_diameter(profile) * (1.5 if profile.side is Side.INSIDE else 1.0) + _SKIN
    step = _BAR[metric]
    return round(step * math.ceil(across / (1.0 if metric else 25.4) / step - 1e-6), 4)


def first_tool(shapes: Mapping[int, ToolShape], kind: ToolKind, *, inside: bool) -> int:
    """The first tool of a kind by the sheets; 0: none."""
    fits = (n for n, each in sorted(shapes.items()) if each.kind is kind and each.internal is inside)
    return next((n for n in fits if not shapes[n].behind), 0)
