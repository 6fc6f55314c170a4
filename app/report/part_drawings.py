"""Drawings of a report as inline SVG: part before and after, path, place of a finding, and tool."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from html import escape

from core.interpreter.shared.elementary_blocks import BlockKind
from core.part.insert_codes import InsertCodeError
from core.part.stock import Clamping, Stock
from core.part.tool_outline import ToolOutline, make_tool_outline
from core.part.tool_shape import ToolShape
from core.part.turned_part import PartedPiece
from core.proving.tip_moves import TipMove

PointMm = tuple[float, float]
"""Point with Z and radius, in mm."""


@dataclass(slots=True)
class SvgDrawing:
    """SVG drawing of a rectangular region in mm, at most ``max_width_px`` × ``max_height_px`` pixels.

    ``lower_corner`` and ``upper_corner`` are the corners (z, radius) of the region.
    """

    lower_corner: PointMm
    upper_corner: PointMm
    max_width_px: float
    max_height_px: float
    _parts: list[str] = field(default_factory=list)

    @property
    def pixels_per_mm(self) -> float:
        """Return the scale in pixels per millimeter."""
        wide, high = self.upper_corner[0] - self.lower_corner[0], self.upper_corner[1] - self.lower_corner[1]
        return min(self.max_width_px / wide, self.max_height_px / high)

    def add_polygon(self, points: Iterable[PointMm], css_class: str) -> None:
        """Add a closed outline.

        ``css_class`` is a CSS class of the page.
        """
        self._parts.append(f'<polygon class="{css_class}" points="{self._placed(points)}"/>')

    def add_polyline(self, points: Iterable[PointMm], css_class: str) -> None:
        """Add an open line.

        ``css_class`` is a CSS class of the page.
        """
        self._parts.append(f'<polyline class="{css_class}" points="{self._placed(points)}"/>')

    def add_dot(self, point: PointMm, css_class: str) -> None:
        """Add a dot at a point.

        ``css_class`` is a CSS class of the page.
        """
        x, y = self._place(point)
        self._parts.append(f'<circle class="{css_class}" cx="{x}" cy="{y}" r="3.5"/>')

    def add_center_line(self) -> None:
        """Add the center line of the part."""
        self.add_polyline([(self.lower_corner[0], 0.0), (self.upper_corner[0], 0.0)], "axis")

    def make_svg(self, title: str) -> str:
        """Return the drawing as SVG.

        ``title`` is the alternative text.
        """
        scale = self.pixels_per_mm
        wide, high = (
            (self.upper_corner[0] - self.lower_corner[0]) * scale,
            (self.upper_corner[1] - self.lower_corner[1]) * scale,
        )
        return (
            f'<svg role="img" width="{wide:.0f}" height="{high:.0f}" viewBox="0 0 {wide:.1f} {high:.1f}">'
            f"<title>{escape(title)}</title>{''.join(self._parts)}</svg>"
        )

    def _placed(self, points: Iterable[PointMm]) -> str:
        placed: list[tuple[float, float]] = []
        for point in points:
            place = self._place(point)
            if not placed or placed[-1] != place:
                placed.append(place)
        return " ".join(f"{x:g},{y:g}" for x, y in placed)

    def _place(self, point: PointMm) -> tuple[float, float]:
        scale = self.pixels_per_mm
        return round((point[0] - self.lower_corner[0]) * scale, 1), round(
            (self.upper_corner[1] - point[1]) * scale, 1
        )


def find_drawing_window(
    points: Sequence[PointMm], margin_mm: float, min_size_mm: float = 1.0
) -> tuple[PointMm, PointMm]:
    """Return the corners of the region that contains the points and a margin in mm.

    The region is at least ``min_size_mm`` wide and high.
    """
    zs, rs = [z for z, _ in points], [r for _, r in points]
    low, high = (min(zs) - margin_mm, min(rs) - margin_mm), (max(zs) + margin_mm, max(rs) + margin_mm)
    more = [max(min_size_mm - (b - a), 0.0) / 2 for a, b in zip(low, high, strict=True)]
    return (low[0] - more[0], low[1] - more[1]), (high[0] + more[0], high[1] + more[1])


_WIDE, _HIGH = 900.0, 420.0  # pixels
_FINDING_WIDTH = 340.0
_TOOL_WIDTH = 110.0
_MAX_MARGIN_MM = 12.0  # maximum mm of material around a finding
_PATH_MARGIN_MM = 6.0  # mm of path drawn in front of and around the stock


MilledSides = tuple[PartedPiece, PartedPiece]


def draw_section(
    stock: Stock,
    finished_part: PartedPiece | None,
    clamping: Clamping | None,
    sides: MilledSides | None = None,
) -> str:
    """Return the drawing of the section of the stock and the finished part.

    ``sides`` are the X+ and X- sides of a milled part.
    """
    drawing = _framed(stock, clamping)
    _chuck(drawing, clamping)
    _draw_material(drawing, stock.outside_profile, stock.bore_profile or None, "stock")
    _part(drawing, finished_part, sides, "part")
    drawing.add_center_line()
    return drawing.make_svg("Section: stock and finished part")


def path(
    stock: Stock, after: PartedPiece | None, clamping: Clamping | None, moves: Sequence[TipMove],
    sides: MilledSides | None = None,
) -> str:  # fmt: skip
    """Return the drawing of the tool paths, with cuts as solid lines and rapids as dashed lines."""
    drawing = _framed(stock, clamping)
    _chuck(drawing, clamping)
    _part(drawing, after, sides, "faint")
    drawing.add_center_line()
    for points, look in _group_moves(moves):
        drawing.add_polyline(points, look)
    return drawing.make_svg("Tool paths")


def draw_finding(
    move: TipMove, material: PartedPiece, tool: ToolShape | None, clamping: Clamping | None
) -> str:
    """Return the drawing of a finding: material before the move, the move, and the tool at its end."""
    near = _find_bounds(move.points, material.outside_profile)
    drawing = SvgDrawing(
        *find_drawing_window(near, 3.0, 8.0), max_width_px=_FINDING_WIDTH, max_height_px=_FINDING_WIDTH
    )
    _chuck(drawing, clamping)
    _draw_material(drawing, material.outside_profile, material.bore_profile, "part")
    drawing.add_center_line()
    lines = _outline(tool)
    z, r = move.points[-1]
    if lines is not None:
        for look, polygons in (("holder", lines.body_outlines), ("insert", lines.cutting_outlines)):
            for polygon in polygons:
                drawing.add_polygon([(z + dz, r + dr) for dz, dr in polygon.tolist()], look)
    drawing.add_polyline(move.points, "wrong")
    drawing.add_dot(move.points[-1], "wrong-end")
    return drawing.make_svg("Location of the finding")


def draw_tool(shape: ToolShape | None) -> str:
    """Return the outline of a tool around its control point, or an empty string if the outline is unknown."""
    lines = _outline(shape)
    if lines is None or not lines.cutting_outlines:
        return ""
    edge = [(z, r) for polygon in lines.cutting_outlines for z, r in polygon.tolist()]
    size = max(max(p[k] for p in edge) - min(p[k] for p in edge) for k in (0, 1))
    drawing = SvgDrawing(
        *find_drawing_window([*edge, (0.0, 0.0)], 0.35 * size, 2.0),
        max_width_px=_TOOL_WIDTH,
        max_height_px=_TOOL_WIDTH,
    )
    for look, polygons in (("holder", lines.body_outlines), ("insert", lines.cutting_outlines)):
        for polygon in polygons:
            drawing.add_polygon([(z, r) for z, r in polygon.tolist()], look)
    drawing.add_dot((0.0, 0.0), "control")
    return drawing.make_svg("Tool outline")


def _outline(shape: ToolShape | None) -> ToolOutline | None:
    try:
        return make_tool_outline(shape) if shape is not None else None
    except InsertCodeError:
        return None


def _framed(stock: Stock, clamping: Clamping | None) -> SvgDrawing:
    around = [(stock.back_z_mm, -stock.max_radius_mm), (stock.front_z_mm, stock.max_radius_mm)]
    if clamping is not None and clamping.chuck_diameter:
        reach = max(clamping.chuck_diameter, clamping.jaw_diameter) / 2
        around += [(-clamping.stick_out - 5.0, -min(reach, 2 * stock.max_radius_mm))]
        around += [(-clamping.stick_out, min(reach, 2 * stock.max_radius_mm))]
    return SvgDrawing(*find_drawing_window(around, _PATH_MARGIN_MM), max_width_px=_WIDE, max_height_px=_HIGH)


def _chuck(drawing: SvgDrawing, clamping: Clamping | None) -> None:
    if clamping is None:
        return
    if (tailstock := clamping.tailstock_solid) is not None:
        drawing.add_polygon(
            [*tailstock.outside_profile, *((z, -r) for z, r in reversed(tailstock.outside_profile))], "chuck"
        )
    if not clamping.chuck_diameter:
        return
    upper = [
        *clamping.chuck_outline,
        (clamping.chuck_outline[-1][0], 0.0),
        (clamping.chuck_outline[0][0], 0.0),
    ]
    drawing.add_polygon(upper, "chuck")
    drawing.add_polygon([(z, -r) for z, r in upper], "chuck")


def _part(drawing: SvgDrawing, after: PartedPiece | None, sides: MilledSides | None, look: str) -> None:
    if sides is not None:
        for piece, across in zip(sides, (1.0, -1.0), strict=True):
            _half(drawing, piece.outside_profile, piece.bore_profile, look, across)
    elif after is not None:
        _draw_material(drawing, after.outside_profile, after.bore_profile, look)


def _draw_material(
    drawing: SvgDrawing, outside: Sequence[PointMm], bore: Sequence[PointMm] | None, css_class: str
) -> None:
    """Draw the material on both sides of the axis in a section."""
    for across in (1.0, -1.0):
        _half(drawing, outside, bore, css_class, across)


def _half(
    drawing: SvgDrawing, outside: Sequence[PointMm], bore: Sequence[PointMm] | None, look: str, across: float
) -> None:
    if not outside:
        return
    ends = (outside[-1][0], 0.0), (outside[0][0], 0.0)
    inner = [*ends] if bore is None else list(reversed(bore))
    drawing.add_polygon([(z, r * across) for z, r in (*outside, *inner)], look)


def _group_moves(moves: Sequence[TipMove]) -> Iterator[tuple[list[PointMm], str]]:
    """Yield one polyline for each group of consecutive moves with the same line style.

    The first move of the program is omitted.
    """
    points: list[PointMm] = []
    look = ""
    for move in moves[1:]:
        now = "thread" if move.block_kind is BlockKind.THREAD else "rapid" if move.is_fast else "cut"
        if now != look or (points and points[-1] != move.points[0]):
            if points:
                yield points, look
            points, look = [move.points[0]], now
        points.extend(move.points[1:])
    if points:
        yield points, look


def _find_bounds(points: Sequence[PointMm], outside: Sequence[PointMm]) -> list[PointMm]:
    """Return the points of a move, with points far from the material moved close to it."""
    if not outside:
        return list(points[-1:])
    back, front = outside[-1][0] - _MAX_MARGIN_MM, outside[0][0] + _MAX_MARGIN_MM
    high = max(r for _, r in outside) + _MAX_MARGIN_MM
    return [(min(max(z, back), front), min(max(r, -high), high)) for z, r in points]
