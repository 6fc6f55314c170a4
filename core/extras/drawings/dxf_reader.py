"""Reader of DXF drawings.

It reads lines, arcs, polylines, splines and ellipses of the model space and of blocks.
"""

from __future__ import annotations

import logging
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from core.extras.drawings.drawing import (
    Drawing,
    DrawingError,
    DrawnElement,
    calculate_arc_tolerance,
    check_elements,
    make_arc,
    make_bulged_segment,
    make_line,
)
from core.extras.drawings.reader_tools import BlockContent, CurvePoint, check_block_expansion, fit_arcs
from core.geometry.lines_and_arcs import Element
from core.message import Message

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

_UNITS = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 8: 25.4e-6, 9: 0.0254, 13: 0.001, 14: 100.0}
"""Length of one drawing unit in mm, by the value of $INSUNITS."""
_CENTRE = ("CENT", "CENTRE", "AXIS", "MITTE", "MITTEL", "ACHS", "EJE", "AXE", "CHAIN", "DASHDOT", "ISO04")
_SOLID = {"3DFACE", "3DSOLID", "MESH", "BODY", "SURFACE", "REVOLVEDSURFACE", "EXTRUDEDSURFACE", "POLYMESH"}
_FLAT = 1e-6  # units; largest distance from the drawing plane
_DEEPEST = 16  # largest nesting depth of blocks

ElementReader = Callable[[Any, float], Iterator[Element]]
"""Function that returns the elements of an entity.

The second argument is the maximum deviation of the arcs from a curve.
"""


def read_dxf(path: Path, data: bytes) -> Drawing:
    """Return the drawing of a DXF file.

    Raises DrawingError if the drawing is rejected, and OSError, ValueError or an ezdxf error if the file
    cannot be read.
    """
    document = _document(path, data)
    unit = _UNITS.get(int(document.header.get("$INSUNITS", 0)), 0.0)
    left_out: Counter[str] = Counter()
    check_block_expansion(path.name, "", partial(_content, document))
    drawn = tuple(
        check_elements(_drawn(document, calculate_arc_tolerance(unit), left_out, path.name), path.name)
    )
    if not drawn:
        raise _nothing(path.name, left_out)
    return Drawing(path.name, drawn, unit, dict(left_out))


def _document(path: Path, data: bytes) -> Document:
    from ezdxf.filemanagement import readfile

    if data.startswith(b"AC10"):
        raise DrawingError(Message("{path} is a DWG drawing: save it as DXF.", path=path.name), "dwg")
    logging.getLogger("ezdxf").setLevel(logging.CRITICAL + 1)  # its messages mean nothing to an operator
    return readfile(path)


class _NotFlatError(ValueError):
    """An error raised for an entity that is not in the plane of the drawing."""


def _three_dimensional(name: str) -> DrawingError:
    text = Message(
        "{name} is three-dimensional: save a section or a view of the part in one plane.", name=name
    )
    return DrawingError(text, "three-dimensional")


def _nothing(name: str, left_out: Counter[str]) -> DrawingError:
    if any(kind in _SOLID for kind in left_out):
        return _three_dimensional(name)
    what = ", ".join(sorted(left_out)) if left_out else "nothing"
    text = Message(
        "{name} does not contain any lines or arcs in model space, only {what}: draw the contour with lines.",
        name=name,
        what=what[:80],
    )
    return DrawingError(text, "nothing-drawn")


def _content(document: Document, block: str) -> BlockContent:
    """Return the content of a block, or of the model space if ``block`` is an empty string.

    Entities directly in the model space are not included in its count.
    """
    entities: list[Any] = list(document.blocks.get(block) or ()) if block else list(document.modelspace())
    own = 1 + len(entities) if block else 0
    inserts = [each for each in entities if each.dxftype() == "INSERT"]
    return BlockContent(own, [(max(1, each.mcount), each.dxf.get("name", "?").lower()) for each in inserts])


def _drawn(document: Document, near: float, left_out: Counter[str], name: str) -> Iterator[DrawnElement]:
    hidden = {layer.dxf.name for layer in document.layers if layer.is_off() or layer.is_frozen()}
    centre_layers = {
        layer.dxf.name for layer in document.layers if _centre(layer.dxf.name, layer.dxf.linetype)
    }
    for entity in _expand_blocks(document.modelspace(), name, 0):
        read = _READERS.get(entity.dxftype())
        if read is None and not entity.dxf.is_supported("layer"):  # an unknown kind of entity
            left_out[entity.dxftype()] += 1
            continue
        layer = entity.dxf.get("layer", "0")
        if layer in hidden or entity.dxf.get("invisible", 0):
            continue
        if read is None:
            left_out[entity.dxftype()] += 1
            continue
        kind = entity.dxf.get("linetype", "BYLAYER")
        centre = _centre("", kind) or (kind.upper() == "BYLAYER" and layer in centre_layers)
        for element in _read(read, entity, near, name):
            yield DrawnElement(element, layer, centre)


def _read(read: ElementReader, entity: Any, near: float, name: str) -> Iterator[Element]:
    try:
        yield from read(entity, near)
    except (ValueError, ArithmeticError, AttributeError, IndexError) as error:
        if isinstance(error, _NotFlatError):
            raise _three_dimensional(name) from None
        what = Message(
            "the {kind} on layer {layer} of {name} is damaged: draw it again.",
            kind=entity.dxftype(),
            layer=entity.dxf.get("layer", "0"),
            name=name,
        )
        raise DrawingError(what, "damaged") from error


def _centre(layer: str, linetype: str) -> bool:
    """Return whether the name of a layer or line type identifies a center line."""
    return any(word in linetype.upper() or word in layer.upper() for word in _CENTRE)


def _expand_blocks(entities: Iterable[Any], name: str, depth: int) -> Iterator[Any]:
    """Yield the entities, with each block reference replaced by the block's entities.

    Dimensions and texts are not expanded. Raises DrawingError if blocks are nested too deeply.
    """
    if depth > _DEEPEST:
        raise DrawingError(
            Message(
                "{name} has blocks nested more than {deepest} levels deep: explode the blocks.",
                name=name,
                deepest=_DEEPEST,
            ),
            "nested-blocks",
        )
    for entity in entities:
        if entity.dxftype() != "INSERT":
            yield entity
        elif entity.mcount > 1:
            yield from _expand_blocks(entity.multi_insert(), name, depth + 1)
        else:
            yield from _expand_blocks(entity.virtual_entities(), name, depth + 1)


# --- Readers for the kinds of entities; points are (x, y)


def _facing(entity: Any) -> float:
    """Return 1 if an entity is drawn as seen from the front, or -1 if it is mirrored.

    Raises _NotFlatError if the entity is not in the plane of the drawing.
    """
    x, y, z = entity.dxf.get("extrusion", (0.0, 0.0, 1.0))
    if abs(x) > _FLAT or abs(y) > _FLAT:
        raise _NotFlatError
    return 1.0 if z > 0.0 else -1.0


def _line(entity: Any, _near: float) -> Iterator[Element]:
    a, b = entity.dxf.start, entity.dxf.end
    if abs(a.z - b.z) > _FLAT:
        raise _NotFlatError
    yield from make_line((a.x, a.y), (b.x, b.y))


def _arc(entity: Any, _near: float) -> Iterator[Element]:
    side, at = _facing(entity), entity.dxf.center
    begin = math.radians(entity.dxf.start_angle)
    sweep = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0) or 2.0 * math.pi
    start = begin if side > 0 else math.pi - begin
    yield from make_arc((side * at.x, at.y), entity.dxf.radius, start, side * sweep)


def _circle(entity: Any, _near: float) -> Iterator[Element]:
    at = entity.dxf.center
    yield from make_arc((_facing(entity) * at.x, at.y), entity.dxf.radius, 0.0, 2.0 * math.pi)


def _chain(points: list[tuple[float, float, float]], *, closed: bool, side: float) -> Iterator[Element]:
    pairs = list(zip(points, points[1:] + points[:1], strict=True))
    for (x, y, bulge), (x1, y1, _) in pairs if closed else pairs[:-1]:
        yield from make_bulged_segment((side * x, y), (side * x1, y1), side * bulge)


def _lwpolyline(entity: Any, _near: float) -> Iterator[Element]:
    points = [(float(x), float(y), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
    yield from _chain(points, closed=entity.closed, side=_facing(entity))


def _polyline(entity: Any, _near: float) -> Iterator[Element]:
    if not entity.is_2d_polyline and not entity.is_3d_polyline:
        raise _NotFlatError
    places = [each.dxf.location for each in entity.vertices if not each.dxf.flags & 16]
    if entity.is_3d_polyline and max(p.z for p in places) - min(p.z for p in places) > _FLAT:
        raise _NotFlatError
    bulges = [each.dxf.get("bulge", 0.0) for each in entity.vertices if not each.dxf.flags & 16]
    points = [(p.x, p.y, bulge) for p, bulge in zip(places, bulges, strict=True)]
    side = 1.0 if entity.is_3d_polyline else _facing(entity)
    yield from _chain(points, closed=entity.is_closed, side=side)


def _ellipse(entity: Any, near: float) -> Iterator[Element]:
    side, at, major = _facing(entity), entity.dxf.center, entity.dxf.major_axis
    ratio, begin = entity.dxf.ratio, entity.dxf.start_param
    minor = -major.y * ratio * side, major.x * ratio * side
    sweep = (entity.dxf.end_param - begin) % (2.0 * math.pi) or 2.0 * math.pi

    def compute_curve_point(u: float) -> CurvePoint:
        c, s = math.cos(begin + sweep * u), math.sin(begin + sweep * u)
        point = at.x + c * major.x + s * minor[0], at.y + c * major.y + s * minor[1]
        return CurvePoint(point, (c * minor[0] - s * major.x, c * minor[1] - s * major.y))

    yield from fit_arcs(compute_curve_point, near, max(1, math.ceil(sweep / (math.pi / 2.0) - 1e-9)))


def _spline(entity: Any, near: float) -> Iterator[Element]:
    from core.extras.drawings.spline_spans import fit_biarcs, make_span_curve, make_spans

    curve = entity.construction_tool()
    if max(p.z for p in curve.control_points) - min(p.z for p in curve.control_points) > _FLAT:
        raise _NotFlatError
    spans = make_spans(curve.control_points, curve.weights(), curve.knots(), curve.order - 1)
    for number, fit in enumerate(fit_biarcs(spans, near)):
        if fit is None:
            yield from fit_arcs(make_span_curve(spans, number), near)
        else:
            yield from make_bulged_segment(fit.start, fit.joint, fit.bulges[0])
            yield from make_bulged_segment(fit.joint, fit.end, fit.bulges[1])


_READERS: dict[str, ElementReader] = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "ELLIPSE": _ellipse,
    "SPLINE": _spline,
}
