"""Reader of SVG drawings with paths, lines, polylines, rectangles, circles and transforms.

In the result, Y points upward.
"""

from __future__ import annotations

import io
import itertools
import math
import re
from collections import Counter
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element as Element_

from core.extras.drawings.drawing import (
    Drawing,
    DrawingError,
    DrawnElement,
    calculate_arc_tolerance,
    check_elements,
    make_arc,
    make_line,
)
from core.extras.drawings.reader_tools import BlockContent, CurvePoint, check_block_expansion, fit_arcs
from core.geometry.lines_and_arcs import Element, Point
from core.message import Message

_PIXELS = 96.0  # pixels per inch in CSS
_ROOT = re.compile(rb"<svg\b[^>]*>", re.IGNORECASE | re.DOTALL)
_SIZE = re.compile(rb"\swidth\s*=\s*[\"']\s*[\d.]+(?:[eE][-+]?\d+)?\s*(mm|cm|in|pt|pc|Q)\s*[\"']")
_DIMENSIONS = frozenset(
    {
        "d",
        "points",
        "x",
        "y",
        "x1",
        "y1",
        "x2",
        "y2",
        "cx",
        "cy",
        "r",
        "rx",
        "ry",
        "width",
        "height",
        "transform",
    }
)
_NO_NUMBER = re.compile(r"(?<![a-z])(nan|inf|infinity)(?![a-z])", re.IGNORECASE)
_HREF = "{http://www.w3.org/1999/xlink}href"
_INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}label"


def read_svg(name: str, data: bytes) -> Drawing:
    """Return the drawing of an SVG text.

    The size of the drawing unit is known only if the width in the file has a unit. Raises DrawingError,
    ParseError or an error of svgelements if the text is invalid.
    """
    left_out: Counter[str] = Counter()
    shapes = _shapes(name, data)
    unit = 25.4 / _PIXELS if _has_unit(data) else 0.0
    drawn = tuple(check_elements(_drawn(shapes, calculate_arc_tolerance(unit), left_out, name), name))
    if not drawn:
        what = ", ".join(sorted(left_out)) or "nothing"
        raise DrawingError(
            Message(
                "{name} does not contain any paths or lines, only {what}: draw the contour as a path.",
                name=name,
                what=what[:80],
            ),
            "nothing-drawn",
        )
    return Drawing(name, drawn, unit, dict(left_out))


def _has_unit(data: bytes) -> bool:
    root = _ROOT.search(data[:65536])
    return root is not None and _SIZE.search(root[0]) is not None


def _shapes(name: str, data: bytes) -> Any:
    from svgelements import SVG

    if b"<!ENTITY" in data:
        raise DrawingError(
            Message("{name} defines XML entities, which are not supported: save it as plain SVG.", name=name),
            "own-entities",
        )
    _check_elements(name, data)
    root = SVG.parse(io.BytesIO(data), reify=True, ppi=_PIXELS)
    if not isinstance(root, SVG):
        words = Message(
            "{name} is not an SVG file, because its first element is in another namespace: save "
            "the drawing again.",
            name=name,
        )
        raise DrawingError(words, "damaged")
    return root


def _check_elements(name: str, text: bytes) -> None:
    """Reject dimensions that are not numbers, and reused groups (``<use>``) with too many elements.

    Raises DrawingError if an element is rejected, or ParseError if the XML is invalid.
    """
    root = ElementTree.fromstring(text)
    by_id: dict[str, list[Element_]] = {}
    count = 0
    for each in root.iter():
        count += 1
        _check_numbers(name, each)
        by_id.setdefault(f"#{each.get('id')}", []).append(each)

    def get_block_content(element: Element_) -> BlockContent:
        used = element.get("href") or element.get(_HREF) or ""
        targets = by_id.get(used, []) if str(element.tag).endswith("use") else []
        return BlockContent(1, [(1, each) for each in (*element, *targets)])

    check_block_expansion(name, root, get_block_content, remaining_count=count)


def _check_numbers(name: str, element: Element_) -> None:
    """Raise DrawingError if a dimension is not a number; svgelements would silently omit the element."""
    for dimension in _DIMENSIONS.intersection(element.keys()):
        if _NO_NUMBER.search(element.get(dimension, "")):
            kind = str(element.tag).rpartition("}")[2]
            words = Message(
                "{name}: {dimension} of <{kind}> is not a number. Draw that element again.",
                name=name,
                dimension=dimension,
                kind=kind,
            )
            raise DrawingError(words, "no-number")


def _drawn(root: Any, near: float, left_out: Counter[str], name: str) -> Iterator[DrawnElement]:
    from svgelements import Close, Group, Move, Shape, SVGElement
    from svgelements import Path as Outline

    for each in root.elements():
        if not isinstance(each, Shape):
            if not isinstance(each, Group) and type(each) is not SVGElement:
                left_out[type(each).__name__.lower()] += 1
            continue  # an editor's window settings, which draw nothing
        values = each.values
        if values.get("visibility") == "hidden" or values.get("display") == "none":
            continue
        layer = str(values.get(_INKSCAPE) or values.get("class") or values.get("id") or "")
        centre = bool(values.get("stroke-dasharray")) and values.get("stroke-dasharray") != "none"
        for segment in Outline(each):
            if not isinstance(segment, Move | Close) and segment.start is None:
                raise DrawingError(
                    Message(
                        "{name} has a path that does not begin with M: save the drawing again.", name=name
                    ),
                    "path-without-start",
                )
            for element in _segment(segment, near):
                yield DrawnElement(element, layer, centre)


def _segment(each: Any, near: float) -> Iterator[Element]:
    from svgelements import Arc, Close, CubicBezier, Line, QuadraticBezier

    if isinstance(each, Line | Close):
        if each.start is not None and each.end is not None:
            yield from make_line(_up(each.start), _up(each.end))
    elif isinstance(each, Arc) and each.is_circular():
        centre, a = _up(each.center), _up(each.start)
        start = math.atan2(a[1] - centre[1], a[0] - centre[0])
        yield from make_arc(centre, float(each.rx), start, -float(each.sweep))
    elif isinstance(each, Arc):
        yield from fit_arcs(_make_ellipse_curve(each), near, max(1, math.ceil(abs(each.sweep) / 1.6)))
    elif isinstance(each, CubicBezier | QuadraticBezier):
        yield from fit_arcs(_of_bezier(each), near, 2)


def _up(point: Any) -> Point:
    return float(point.x), -float(point.y)


def _make_ellipse_curve(element: Any) -> Any:
    """Return an elliptic arc as a curve, with tangent directions calculated from differences.

    The differences are accurate enough to place the junction of two arcs.
    """
    begin, step = element.get_start_t(), 1e-6

    def compute_position(u: float) -> Point:
        return _up(element.point_at_t(begin + element.sweep * u))

    def compute_curve_point(u: float) -> CurvePoint:
        a, b = compute_position(u - step), compute_position(u + step)
        return CurvePoint(compute_position(u), (b[0] - a[0], b[1] - a[1]))

    return compute_curve_point


def _of_bezier(each: Any) -> Any:
    points = [_up(p) for p in each]

    def compute_curve_point(u: float) -> CurvePoint:
        held = min(max(u, 1e-6), 1.0 - 1e-6)
        return CurvePoint(_bezier(points, u), _slope(points, held))

    return compute_curve_point


def _bezier(points: list[Point], u: float) -> Point:
    while len(points) > 1:
        points = [(a[0] + (b[0] - a[0]) * u, a[1] + (b[1] - a[1]) * u) for a, b in itertools.pairwise(points)]
    return points[0]


def _slope(points: list[Point], u: float) -> Point:
    """Return the direction of a Bézier curve at ``u``, calculated from the differences of its points."""
    return _bezier([(b[0] - a[0], b[1] - a[1]) for a, b in itertools.pairwise(points)], u)
