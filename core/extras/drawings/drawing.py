"""Drawing as lines and arcs by layer, with its errors, its work limit and its binary encoding."""

from __future__ import annotations

import itertools
import json
import math
import struct
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field

from core.geometry.lines_and_arcs import Arc, Element, Line, Point
from core.message import CodedError, Message

MAX_DRAWING_BYTES = 16 * 1024 * 1024
MAX_ELEMENTS = 50_000
_NEAREST = 0.002  # mm, largest distance between a curve and the arcs that replace it
# the same in drawing units if the unit is not specified; 0.005 mm if the unit is the inch
_OF_UNKNOWN = 0.0002
_FARTHEST = 1e8  # units; for larger coordinates a thousandth of a unit cannot be resolved
_NONE = 1e-9


class DrawingError(CodedError, ValueError):
    """An error raised if no contour can be extracted from a drawing.

    The text states the cause and a remedy.
    """


@dataclass(frozen=True, slots=True)
class DrawnElement:
    """An element of a drawing with its layer. Points are (y, x), where x is along Z."""

    element: Element
    layer: str = ""
    is_center_line: bool = False


@dataclass(frozen=True, slots=True)
class Drawing:
    """A drawing as lines and arcs.

    ``unit_mm`` is the size of one drawing unit in mm, or 0 if the file does not specify it.
    ``omitted_object_counts`` contains the number of omitted objects, such as texts and dimensions, by kind.
    """

    name: str
    elements: tuple[DrawnElement, ...]
    unit_mm: float = 0.0
    omitted_object_counts: Mapping[str, int] = field(default_factory=dict)

    @property
    def layers(self) -> tuple[str, ...]:
        """Return the names of the layers with elements, in descending order of the number of elements."""
        count: dict[str, int] = {}
        for each in self.elements:
            count[each.layer] = count.get(each.layer, 0) + 1
        return tuple(sorted(count, key=lambda layer: (-count[layer], layer)))

    def select_layer(self, layer: str) -> tuple[DrawnElement, ...]:
        """Return the elements on a layer, or all elements if ``layer`` is empty."""
        return tuple(each for each in self.elements if not layer or each.layer == layer)


def calculate_arc_tolerance(unit: float) -> float:
    """Return the largest permitted distance between a curve and the arcs that replace it.

    The distance is in drawing units.
    """
    return _NEAREST / unit if unit else _OF_UNKNOWN


def make_line(start: Point, end: Point) -> Iterator[Element]:
    """Yield the line between two points (x, y) of the drawing, unless its length is zero.

    A line with a coordinate that is not a number is also yielded; ``check_elements`` rejects it.
    """
    if not math.dist(start, end) <= _NONE:
        yield Line((start[1], start[0]), (end[1], end[0]))


def make_arc(center: Point, radius: float, start_angle: float, sweep_angle: float) -> Iterator[Element]:
    """Yield an arc around ``center`` (x, y) in pieces of less than half a revolution.

    Angles are in radians, counterclockwise from x.
    """
    if radius <= _NONE or abs(sweep_angle) < 1e-9:
        return
    count = math.ceil(abs(sweep_angle) / (0.95 * math.pi))
    x, y = center
    ends = [start_angle + sweep_angle * k / count for k in range(count + 1)]
    points = [(y + radius * math.sin(a), x + radius * math.cos(a)) for a in ends]
    for a, b in itertools.pairwise(points):
        yield Arc(a, b, (y, x), sweep_angle > 0.0)


def make_bulged_segment(start: Point, end: Point, bulge: float) -> Iterator[Element]:
    """Yield a line or an arc of a polyline.

    ``bulge`` is the tangent of a quarter of the angle of the arc, or 0 for a line.
    """
    if abs(bulge) < 1e-9:
        yield from make_line(start, end)
        return
    chord = math.dist(start, end)
    if chord <= _NONE:
        return
    sweep = 4.0 * math.atan(bulge)
    radius = chord / 2.0 / abs(math.sin(sweep / 2.0))
    off = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = (
        (start[0] + end[0]) / 2.0 - (end[1] - start[1]) * off,
        (start[1] + end[1]) / 2.0 + (end[0] - start[0]) * off,
    )
    yield from make_arc(centre, radius, math.atan2(start[1] - centre[1], start[0] - centre[0]), sweep)


def check_elements(elements: Iterable[DrawnElement], name: str) -> Iterator[DrawnElement]:
    """Yield the elements unchanged.

    Raises DrawingError if there are too many elements or if a coordinate is invalid.
    """
    for count, each in enumerate(elements):
        if count >= MAX_ELEMENTS:
            raise DrawingError(
                Message(
                    "{name} has more than {most_elements} lines: save only the layer with the contour.",
                    name=name,
                    most_elements=MAX_ELEMENTS,
                ),
                "too-many-lines",
            )
        (a, b), (c, d) = each.element.start, each.element.end
        if abs(a) <= _FARTHEST and abs(b) <= _FARTHEST and abs(c) <= _FARTHEST and abs(d) <= _FARTHEST:
            yield each
            continue
        if not all(map(math.isfinite, (a, b, c, d))):
            raise DrawingError(
                Message(
                    "{name} has a point whose coordinate is not a number: save the drawing again.", name=name
                ),
                "not-a-number",
            )
        raise DrawingError(
            Message(
                "{name} has a point too far from the drawing origin: move the contour to the origin.",
                name=name,
            ),
            "too-far-from-zero",
        )


_HEAD = struct.Struct("<I")  # length in bytes of the JSON that follows
_ROW = struct.Struct("<2I6d")  # =
_LINE, _CLOCKWISE, _COUNTER = range(3)
_CENTER_LINE = 4  # added to the kind


def encode_drawing(drawing: Drawing) -> bytes:
    """Return a drawing encoded as bytes."""
    layers = list(dict.fromkeys(each.layer for each in drawing.elements))
    number = {layer: at for at, layer in enumerate(layers)}
    rows = b"".join(_row(each, number[each.layer]) for each in drawing.elements)
    head = {
        "name": drawing.name,
        "unit": drawing.unit_mm,
        "left_out": dict(drawing.omitted_object_counts),
        "layers": layers,
    }
    return _with_head(head) + rows


def encode_error(error: DrawingError) -> bytes:
    """Return an error encoded as bytes, for output in place of a drawing."""
    return _with_head({"error": str(error), "code": error.code})


def _with_head(head: dict[str, object]) -> bytes:
    text = json.dumps(head).encode()
    return _HEAD.pack(len(text)) + text


def _row(each: DrawnElement, layer: int) -> bytes:
    element, center_line = each.element, _CENTER_LINE if each.is_center_line else 0
    if isinstance(element, Line):
        return _ROW.pack(layer, _LINE + center_line, *element.start, *element.end, 0.0, 0.0)
    kind = _CLOCKWISE if element.clockwise else _COUNTER
    return _ROW.pack(layer, kind + center_line, *element.start, *element.end, *element.center)


def decode_drawing(data: bytes) -> Drawing:
    """Return the drawing that is encoded in these bytes.

    Raises DrawingError if the bytes contain an error, and ValueError, LookupError, TypeError or
    struct.error if they are incomplete.
    """
    (length,) = _HEAD.unpack_from(data)
    head = json.loads(data[_HEAD.size : _HEAD.size + length])
    if "error" in head:
        raise DrawingError(head["error"], head["code"])
    rows = memoryview(data)[_HEAD.size + length :]
    return Drawing(head["name"], tuple(_drawn(rows, head["layers"])), head["unit"], head["left_out"])


def _drawn(rows: memoryview, layers: list[str]) -> Iterator[DrawnElement]:
    for layer, kind, x0, y0, x1, y1, cx, cy in _ROW.iter_unpack(rows):
        shape = kind & ~_CENTER_LINE
        element: Element = Line((x0, y0), (x1, y1))
        if shape != _LINE:
            element = Arc((x0, y0), (x1, y1), (cx, cy), clockwise=shape == _CLOCKWISE)
        yield DrawnElement(element, layers[layer], bool(kind & _CENTER_LINE))


MAX_READING_TIME_S = 30.0  # s of processor time for one program from a drawing


@dataclass(frozen=True, slots=True)
class _Limit:
    start_time_s: float
    limit_s: float
    report_elapsed_time: Callable[[float], None]


_limit: ContextVar[_Limit | None] = ContextVar("drawing_work", default=None)


@contextmanager
def limit_processor_time(
    report_time: Callable[[float], None], limit_s: float = MAX_READING_TIME_S
) -> Iterator[None]:
    """Limit the processor time of this thread in the ``with`` block to ``limit_s`` seconds.

    ``report_time`` is called with the processor time used so far, in seconds.
    """
    token = _limit.set(_Limit(time.thread_time(), limit_s, report_time))
    try:
        yield
    finally:
        _limit.reset(token)


def check_processor_time() -> None:
    """Check the limit of processor time. Loops over elements must call this function.

    Raises DrawingError if the limit is exceeded, or the exception that ``report_time`` raises.
    """
    limit = _limit.get()
    if limit is None:
        return
    spent = time.thread_time() - limit.start_time_s
    limit.report_elapsed_time(spent)
    if spent > limit.limit_s:
        words = "the drawing has too many parallel lines. Save only the contour of the part."
        raise DrawingError(words, "too-slow")
