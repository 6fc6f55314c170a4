"""Drawings of a report as inline SVG: part before and after, path, location of a finding, and tool."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from html import escape

from core.interpreter.shared.elementary_blocks import Kind
from core.part.insert_codes import InsertCodeError
from core.part.stock import Clamping, Stock
from core.part.tool_outline import ToolOutline, outline
from core.part.tool_shape import ToolShape
from core.part.turned_part import Piece
from core.proving.tip_moves import TipMove

Point = tuple[float, float]
"""Z and r, mm."""


@dataclass(slots=True)
class Drawing:
    """SVG drawing of a window in mm, at most ``width`` × ``highest`` pixels.

    ``low`` and ``high`` are the corners (z, radius) of the window.
    """

    low: Point
    high: Point
    width: float
    highest: float
    _parts: list[str] = field(default_factory=list)

    @property
    def scale(self) -> float:
        """Scale in pixels per millimeter."""
        wide, high = self.high[0] - self.low[0], self.high[1] - self.low[1]
        return min(self.width / wide, self.highest / high)

    def polygon(self, points: Iterable[Point], look: str) -> None:
        """Add a closed outline. ``look`` is a class of the page's style."""
        self._parts.append(f'<polygon class="{look}" points="{self._placed(points)}"/>')

    def polyline(self, points: Iterable[Point], look: str) -> None:
        """Add an open line."""
        self._parts.append(f'<polyline class="{look}" points="{self._placed(points)}"/>')

    def dot(self, point: Point, look: str) -> None:
        """Add a dot at a point."""
        x, y = self._place(point)
        self._parts.append(f'<circle class="{look}" cx="{x}" cy="{y}" r="3.5"/>')

    def axis(self) -> None:
        """Add the center line."""
        self.polyline([(self.low[0], 0.0), (self.high[0], 0.0)], "axis")

    def svg(self, title: str) -> str:
        """Return the SVG. ``title`` is the text alternative."""
        scale = self.scale
        wide, high = (self.high[0] - self.low[0]) * scale, (self.high[1] - self.low[1]) * scale
        return (
            f'<svg role="img" width="{wide:.0f}" height="{high:.0f}" viewBox="0 0 {wide:.1f} {high:.1f}">'
            f"<title>{escape(title)}</title>{''.join(self._parts)}</svg>"
        )

    def _placed(self, points: Iterable[Point]) -> str:
        placed: list[tuple[float, float]] = []
        for point in points:
            place = self._place(point)
            if not placed or placed[-1] != place:
                placed.append(place)
        return " ".join(f"{x:g},{y:g}" for x, y in placed)

    def _place(self, point: Point) -> tuple[float, float]:
        scale = self.scale
        return round((point[0] - self.low[0]) * scale, 1), round((self.high[1] - point[1]) * scale, 1)


def window(points: Sequence[Point], margin: float, least: float = 1.0) -> tuple[Point, Point]:
    """Return the window around points with a margin in mm, at least ``least`` wide and high."""
    zs, rs = [z for z, _ in points], [r for _, r in points]
    low, high = (min(zs) - margin, min(rs) - margin), (max(zs) + margin, max(rs) + margin)
    more = [max(least - (b - a), 0.0) / 2 for a, b in zip(low, high, strict=True)]
    return (low[0] - more[0], low[1] - more[1]), (high[0] + more[0], high[1] + more[1])


_WIDE, _HIGH = 900.0, 420.0  # pixels
_PLACE = 340.0
_TOOL = 110.0
_AROUND = 12.0  # maximum mm of material around a finding
_BEFORE_PART = 6.0  # mm of path drawn in front of and around the stock


Sides = tuple[Piece, Piece]


def section(stock: Stock, after: Piece | None, clamping: Clamping | None, sides: Sides | None = None) -> str:
    """Return the section of the stock and the finished part.

    ``sides`` are X+ and X- of a milled part.
    """
    drawing = _framed(stock, clamping)
    _chuck(drawing, clamping)
    _metal(drawing, stock.outside, stock.bore or None, "stock")
    _part(drawing, after, sides, "part")
    drawing.axis()
    return drawing.svg("Section: stock and finished part")


def path(
    stock: Stock, after: Piece | None, clamping: Clamping | None, moves: Sequence[TipMove],
    sides: Sides | None = None,
) -> str:  # fmt: skip
    """Return the drawing of the tool paths: cuts as solid lines, rapids as dashed lines."""
    drawing = _framed(stock, clamping)
    _chuck(drawing, clamping)
    _part(drawing, after, sides, "faint")
    drawing.axis()
    for points, look in _ways(moves):
        drawing.polyline(points, look)
    return drawing.svg("Tool paths")


def place(move: TipMove, metal: Piece, tool: ToolShape | None, clamping: Clamping | None) -> str:
    """Return the drawing of a finding: the material before the move, the move, and the tool at its end."""
    near = _bounded(move.points, metal.outside)
    drawing = Drawing(*window(near, 3.0, 8.0), width=_PLACE, highest=_PLACE)
    _chuck(drawing, clamping)
    _metal(drawing, metal.outside, metal.bore, "part")
    drawing.axis()
    lines = _outline(tool)
    z, r = move.points[-1]
    if lines is not None:
        for look, polygons in (("holder", lines.body), ("insert", lines.cutting)):
            for polygon in polygons:
                drawing.polygon([(z + dz, r + dr) for dz, dr in polygon.tolist()], look)
    drawing.polyline(move.points, "wrong")
    drawing.dot(move.points[-1], "wrong-end")
    return drawing.svg("Location of the finding")


def tool_picture(shape: ToolShape | None) -> str:
    """Return the outline of a tool around its control point, or an empty string if it is unknown."""
    lines = _outline(shape)
    if lines is None or not lines.cutting:
        return ""
    edge = [(z, r) for polygon in lines.cutting for z, r in polygon.tolist()]
    size = max(max(p[k] for p in edge) - min(p[k] for p in edge) for k in (0, 1))
    drawing = Drawing(*window([*edge, (0.0, 0.0)], 0.35 * size, 2.0), width=_TOOL, highest=_TOOL)
    for look, polygons in (("holder", lines.body), ("insert", lines.cutting)):
        for polygon in polygons:
            drawing.polygon([(z, r) for z, r in polygon.tolist()], look)
    drawing.dot((0.0, 0.0), "control")
    return drawing.svg("Tool outline")


def _outline(shape: ToolShape | None) -> ToolOutline | None:
    try:
        return outline(shape) if shape is not None else None
    except InsertCodeError:
        return None


def _framed(stock: Stock, clamping: Clamping | None) -> Drawing:
    around = [(stock.back, -stock.radius), (stock.front, stock.radius)]
    if clamping is not None and clamping.diameter:
        reach = max(clamping.diameter, clamping.jaw_diameter) / 2
        around += [(-clamping.stick_out - 5.0, -min(reach, 2 * stock.radius))]
        around += [(-clamping.stick_out, min(reach, 2 * stock.radius))]
    return Drawing(*window(around, _BEFORE_PART), width=_WIDE, highest=_HIGH)


def _chuck(drawing: Drawing, clamping: Clamping | None) -> None:
    if clamping is None:
        return
    if (tailstock := clamping.tailstock) is not None:
        drawing.polygon([*tailstock.outside, *((z, -r) for z, r in reversed(tailstock.outside))], "chuck")
    if not clamping.diameter:
        return
    upper = [*clamping.outline, (clamping.outline[-1][0], 0.0), (clamping.outline[0][0], 0.0)]
    drawing.polygon(upper, "chuck")
    drawing.polygon([(z, -r) for z, r in upper], "chuck")


def _part(drawing: Drawing, after: Piece | None, sides: Sides | None, look: str) -> None:
    if sides is not None:
        for piece, across in zip(sides, (1.0, -1.0), strict=True):
            _half(drawing, piece.outside, piece.bore, look, across)
    elif after is not None:
        _metal(drawing, after.outside, after.bore, look)


def _metal(drawing: Drawing, outside: Sequence[Point], bore: Sequence[Point] | None, look: str) -> None:
    """Draw both halves of a section."""
    for across in (1.0, -1.0):
        _half(drawing, outside, bore, look, across)


def _half(
    drawing: Drawing, outside: Sequence[Point], bore: Sequence[Point] | None, look: str, across: float
) -> None:
    if not outside:
        return
    ends = (outside[-1][0], 0.0), (outside[0][0], 0.0)
    inner = [*ends] if bore is None else list(reversed(bore))
    drawing.polygon([(z, r * across) for z, r in (*outside, *inner)], look)


def _ways(moves: Sequence[TipMove]) -> Iterator[tuple[list[Point], str]]:
    """Yield moves of the same style as one line each.

    The first move of the program is omitted.
    """
    points: list[Point] = []
    look = ""
    for move in moves[1:]:
        now = "thread" if move.kind is Kind.THREAD else "rapid" if move.quick else "cut"
        if now != look or (points and points[-1] != move.points[0]):
            if points:
                yield points, look
            points, look = [move.points[0]], now
        points.extend(move.points[1:])
    if points:
        yield points, look


def _bounded(points: Sequence[Point], outside: Sequence[Point]) -> list[Point]:
    """Return the points of a move, limited to the vicinity of the material."""
    if not outside:
        return list(points[-1:])
    back, front = outside[-1][0] - _AROUND, outside[0][0] + _AROUND
    high = max(r for _, r in outside) + _AROUND
    return [(min(max(z, back), front), min(max(r, -high), high)) for z, r in points]
