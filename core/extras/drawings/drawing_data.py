"""A drawing as bytes, and back: between processes it goes as numbers and JSON, never as code."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator

from core.extras.drawings.drawing import Drawing, DrawingError, Drawn
from core.geometry.lines_and_arcs import Arc, Element, Line

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
