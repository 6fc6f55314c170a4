"""A drawing: lines and arcs by layer, in the unit of its file; and why one cannot be used.

Between processes it goes as numbers and JSON, never as code.
"""

from __future__ import annotations

import itertools
import json
import math
import struct
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from core.geometry.lines_and_arcs import Arc, Element, Line, Point
from core.message import CodedError, Message

MOST_BYTES = 16 * 1024 * 1024
MOST_ELEMENTS = 50_000
_NEAREST = 0.002  # mm between a curve and the arcs that are taken for it
_OF_UNKNOWN = 0.0002  # the same in units of a drawing that does not say its unit: .005 mm if it is the inch
_FARTHEST = 1e8  # units: beyond it what is a thousandth of a unit is no longer told apart
_NONE = 1e-9


class DrawingError(CodedError, ValueError):
    """A drawing that no contour can be taken from: one sentence with the cause and what to do."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """An element with its layer; points are (y, x), so x goes along Z. ``centre``: it is a centre line."""

    element: Element
    layer: str = ""
    centre: bool = False


@dataclass(frozen=True, slots=True)
class Drawing:
    """``unit`` is mm of one unit of the drawing, 0 where its file does not say.

    ``left_out`` counts by kind what is no line, such as texts and dimensions.
    """

    name: str
    drawn: tuple[Drawn, ...]
    unit: float = 0.0
    left_out: Mapping[str, int] = field(default_factory=dict)

    @property
    def layers(self) -> tuple[str, ...]:
        """Those that something is drawn on, the fullest first."""
        count: dict[str, int] = {}
        for each in self.drawn:
            count[each.layer] = count.get(each.layer, 0) + 1
        return tuple(sorted(count, key=lambda layer: (-count[layer], layer)))

    def on(self, layer: str) -> tuple[Drawn, ...]:
        """What is drawn on a layer; empty: on all."""
        return tuple(each for each in self.drawn if not layer or each.layer == layer)


def nearest(unit: float) -> float:
    """How near arcs come to a curve, in units of the drawing."""
    return _NEAREST / unit if unit else _OF_UNKNOWN


def line(a: Point, b: Point) -> Iterator[Element]:
    """A line from (x, y) to (x, y) of the drawing; one of no length is none.

    A point that is not a number gives a line as well, which ``within_limits`` refuses.
    """
    if not math.dist(a, b) <= _NONE:
        yield Line((a[1], a[0]), (b[1], b[0]))


def arc(centre: Point, radius: float, start: float, sweep: float) -> Iterator[Element]:
    """An arc about (x, y), radians counter-clockwise from x, in pieces of less than half a turn."""
    if radius <= _NONE or abs(sweep) < 1e-9:
        return
    count = math.ceil(abs(sweep) / (0.95 * math.pi))
    ends = [start + sweep * k / count for k in range(count + 1)]
    points = [(centre[1] + radius * math.sin(a), centre[0] + radius * math.cos(a)) for a in ends]
    for a, b in itertools.pairwise(points):
        yield Arc(a, b, (centre[1], centre[0]), clockwise=sweep > 0.0)


def bulged(a: Point, b: Point, bulge: float) -> Iterator[Element]:
    """A line, or the arc of a polyline: ``bulge`` is the tangent of a quarter of its angle."""
    if abs(bulge) < 1e-9:
        yield from line(a, b)
        return
    chord = math.dist(a, b)
    if chord <= _NONE:
        return
    sweep = 4.0 * math.atan(bulge)
    radius = chord / 2.0 / abs(math.sin(sweep / 2.0))
    off = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = (a[0] + b[0]) / 2.0 - (b[1] - a[1]) * off, (a[1] + b[1]) / 2.0 + (b[0] - a[0]) * off
    yield from arc(centre, radius, math.atan2(a[1] - centre[1], a[0] - centre[0]), sweep)


def within_limits(found: Iterable[Drawn], name: str) -> Iterator[Drawn]:
    """The same, until there are too many. Raises DrawingError."""
    for count, each in enumerate(found):
        if count >= MOST_ELEMENTS:
            raise DrawingError(
                Message(
                    "{name} has more than {most_elements} lines: save only the layer with the contour.",
                    name=name,
                    most_elements=MOST_ELEMENTS,
                ),
                "too-many-lines",
            )
        values = [v for p in (each.element.start, each.element.end) for v in p]
        if not all(map(math.isfinite, values)):
            raise DrawingError(
                Message(
                    "{name} has a point whose coordinate is not a number: save the drawing again.", name=name
                ),
                "not-a-number",
            )
        if max(map(abs, values)) > _FARTHEST:
            raise DrawingError(
                Message(
                    "{name} has a point too far from the drawing origin: move the contour to the origin.",
                    name=name,
                ),
                "too-far-from-zero",
            )
        yield each


_HEAD = struct.Struct("<I")  # bytes of the JSON that follows
_ROW = struct.Struct("<2I6d")  # layer, kind, start, end, center
_LINE, _CLOCKWISE, _COUNTER = range(3)
_CENTER_LINE = 4  # added to the kind


def drawing_data(drawing: Drawing) -> bytes:
    """Return the bytes of a drawing."""
    layers = list(dict.fromkeys(each.layer for each in drawing.drawn))
    number = {layer: at for at, layer in enumerate(layers)}
    rows = b"".join(_row(each, number[each.layer]) for each in drawing.drawn)
    head = {"name": drawing.name, "unit": drawing.unit, "left_out": dict(drawing.left_out), "layers": layers}
    return _with_head(head) + rows


def error_data(error: DrawingError) -> bytes:
    """Return the bytes of an error, in the place of a drawing."""
    return _with_head({"error": str(error), "code": error.code})


def _with_head(head: dict[str, object]) -> bytes:
    text = json.dumps(head).encode()
    return _HEAD.pack(len(text)) + text


def _row(each: Drawn, layer: int) -> bytes:
    element, center_line = each.element, _CENTER_LINE if each.centre else 0
    if isinstance(element, Line):
        return _ROW.pack(layer, _LINE + center_line, *element.start, *element.end, 0.0, 0.0)
    kind = _CLOCKWISE if element.clockwise else _COUNTER
    return _ROW.pack(layer, kind + center_line, *element.start, *element.end, *element.centre)


def drawing_of(data: bytes) -> Drawing:
    """Return the drawing of these bytes.

    Raises DrawingError if they hold one, and ValueError, LookupError, TypeError or struct.error for bytes
    that are cut off.
    """
    (length,) = _HEAD.unpack_from(data)
    head = json.loads(data[_HEAD.size : _HEAD.size + length])
    if "error" in head:
        raise DrawingError(head["error"], head["code"])
    rows = memoryview(data)[_HEAD.size + length :]
    return Drawing(head["name"], tuple(_drawn(rows, head["layers"])), head["unit"], head["left_out"])


def _drawn(rows: memoryview, layers: list[str]) -> Iterator[Drawn]:
    for layer, kind, x0, y0, x1, y1, cx, cy in _ROW.iter_unpack(rows):
        shape = kind & ~_CENTER_LINE
        element: Element = Line((x0, y0), (x1, y1))
        if shape != _LINE:
            element = Arc((x0, y0), (x1, y1), (cx, cy), clockwise=shape == _CLOCKWISE)
        yield Drawn(element, layers[layer], bool(kind & _CENTER_LINE))
