"""Contour as a table of points, and its conversion to program lines.

A row contains X, Z, a chamfer or radius, and an arc.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from core.extras.shapes.shape_fields import FieldError, ProgramSettings
from core.language.source import Dialect
from core.message import Message

_WORD = re.compile(r"(G02|G03|[XZCR])(-?\d*\.?\d*)")
_LINE = re.compile(r"(?:G02|G03)?(?:[XZCR]-?(?:\d+\.?\d*|\.\d+))+")
_S_LINE = re.compile(r"(?:G[123](?!\d))?(?:(?:[XZF]|CHR=|RND=|CR=)-?(?:\d+\.?\d*|\.\d+))+")
_S_WORD = re.compile(r"(X|Z|CHR=|RND=|CR=)(-?\d+\.?\d*|-?\.\d+)")
_OFF = 0.0005  # in; difference between a chord and two radii that the control accepts
POINT_TOLERANCE = 1e-9

Point = tuple[float, float]  # (Z, radius)


@dataclass(frozen=True, slots=True)
class ContourPoint:
    """A point of a contour.

    ``x`` is a diameter, or None if X is unchanged. ``arc`` is the radius of the arc that leads to the
    point, positive for G02 and negative for G03. ``chamfer`` or ``radius`` is the size of the corner
    between the lines that meet at the point.
    """

    x: float | None = None
    z: float | None = None
    chamfer: float = 0.0
    radius: float = 0.0
    arc: float = 0.0

    @property
    def empty(self) -> bool:
        """Return whether the row has no values."""
        return self == ContourPoint()


def make_point_label(number: int) -> str:
    """Return the name of a table row for error messages. Row numbers start at 1."""
    return f"#{number}"


def resolve_contour_points(rows: Iterable[ContourPoint]) -> list[Point]:
    """Return the points of the rows as (z, r). Missing values are copied from the previous row."""
    x = z = 0.0
    found = []
    for row in rows:
        x = x if row.x is None else row.x / 2.0
        z = z if row.z is None else row.z
        found.append((z, x))
    return found


def read_contour(lines: Iterable[str], settings: ProgramSettings) -> tuple[ContourPoint, ...] | None:
    """Return the table rows from which these lines were made, or None if a line has other content."""
    if settings.dialect is Dialect.SINUMERIK:
        return _read_sinumerik(lines, settings)
    rows = []
    scale = 1.0 if settings.diameter else 2.0
    for line in lines:
        if not _LINE.fullmatch(line):
            return None
        words = {letter: float(value or 0.0) for letter, value in _WORD.findall(line)}
        x, z, r = words.get("X"), words.get("Z"), words.get("R", 0.0)
        x = None if x is None else x * scale
        arc = r if "G02" in words else -r if "G03" in words else 0.0
        rows.append(ContourPoint(x, z, words.get("C", 0.0), 0.0 if arc else r, arc))
    return tuple(rows)


def _read_sinumerik(lines: Iterable[str], settings: ProgramSettings) -> tuple[ContourPoint, ...] | None:
    """Return the table rows of SINUMERIK lines, or None if a line has other content.

    With X drawn upward, G3 is a convex arc.
    """
    rows = []
    scale = 1.0 if settings.diameter else 2.0
    for line in lines:
        if not _S_LINE.fullmatch(line):
            return None
        words = {letter: float(value) for letter, value in _S_WORD.findall(line)}
        x, r = words.get("X"), words.get("CR=", 0.0)
        arc = r if line.startswith("G3") else -r if line.startswith("G2") else 0.0
        x = None if x is None else x * scale
        rows.append(ContourPoint(x, words.get("Z"), words.get("CHR=", 0.0), words.get("RND=", 0.0), arc))
    return tuple(rows)


# --- Errors of a contour


def find_contour_errors(rows: Sequence[ContourPoint]) -> Iterator[FieldError]:
    """Yield the errors in a table of points, in row order."""
    if len(rows) < 2:
        yield FieldError(
            make_point_label(len(rows) + 1), "A contour needs at least two points: enter the next point."
        )
        return
    if rows[0].x is None or rows[0].z is None:
        yield FieldError(make_point_label(1), "The first point is the start of the contour: enter X and Z.")
        return
    there = resolve_contour_points(rows)
    for number, (row, begin, end) in enumerate(zip(rows[1:], there, there[1:], strict=False), 2):
        yield from _row(row, number, begin, end)
    for number, row in enumerate(rows[1:], 2):
        yield from _corner(rows, there, number, row)
    if any(r < -POINT_TOLERANCE for _, r in there):
        number = next(n for n, (_, r) in enumerate(there, 1) if r < -POINT_TOLERANCE)
        yield FieldError(
            make_point_label(number),
            Message(
                "Point {number} is past the spindle centerline: X is a diameter and must be 0 or more.",
                number=number,
            ),
        )


def _row(row: ContourPoint, number: int, begin: Point, end: Point) -> Iterator[FieldError]:
    chord = math.dist(begin, end)
    if chord < POINT_TOLERANCE:
        yield FieldError(
            make_point_label(number),
            Message("Point {number} is the same as the previous point: enter another X or Z.", number=number),
        )
    elif row.arc and chord > 2.0 * abs(row.arc) + _OFF:
        yield FieldError(
            make_point_label(number),
            Message(
                "The arc to point {number} spans {chord}, but with radius {arc} it can span only "
                "{arc2}: enter a larger radius.",
                number=number,
                chord=f"{chord:.4f}",
                arc=f"{abs(row.arc):g}",
                arc2=f"{2 * abs(row.arc):.4f}",
            ),
        )


def _corner(
    rows: Sequence[ContourPoint], there: Sequence[Point], number: int, row: ContourPoint
) -> Iterator[FieldError]:
    if row.chamfer < 0 or row.radius < 0:
        yield FieldError(
            make_point_label(number),
            Message(
                "The corner at point {number} has a size below 0: enter the correct size.", number=number
            ),
        )
    size = row.chamfer or row.radius
    if size <= 0:
        return
    if number == len(rows):
        yield FieldError(
            make_point_label(number),
            Message("The corner at point {number} needs a line after it: add a point.", number=number),
        )
    elif row.arc or rows[number].arc:
        yield FieldError(
            make_point_label(number),
            Message(
                "Point {number} has a chamfer or radius next to an arc. The control can cut a "
                "chamfer or radius only between two straight lines.",
                number=number,
            ),
        )
    else:
        back = _set_back(row, there[number - 2], there[number - 1], there[number])
        room = min(
            math.dist(there[number - 2], there[number - 1]), math.dist(*there[number - 1 : number + 1])
        )
        if back > room + POINT_TOLERANCE:
            yield FieldError(
                make_point_label(number),
                Message(
                    "The corner at point {number} needs {back} of line length, but the line is "
                    "only {room} long: make the corner smaller.",
                    number=number,
                    back=f"{back:.4f}",
                    room=f"{room:.4f}",
                ),
            )


def _set_back(row: ContourPoint, before: Point, here: Point, next_point: Point) -> float:
    """Return the length by which a corner (chamfer or radius) shortens each of its two lines."""
    if row.chamfer:
        return row.chamfer
    a, b = _direction(before, here), _direction(here, next_point)
    turn = abs(math.remainder(b - a, 2.0 * math.pi))
    return row.radius * math.tan(min(turn, math.pi - 1e-6) / 2.0)


def _direction(a: Point, b: Point) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


# --- Contour as a drawing


def make_outline(rows: Sequence[ContourPoint]) -> list[Point]:
    """Return the contour as a polyline.

    Corners are chamfered or rounded, and arcs are divided into chords.
    """
    there = resolve_contour_points(rows)
    if not there:
        return []
    drawn = [there[0]]
    for number in range(1, len(rows)):
        row, here = rows[number], there[number]
        size = row.chamfer or row.radius
        if row.arc:
            drawn += _arc(there[number - 1], here, row.arc)
        elif size > 0 and number + 1 < len(rows) and math.dist(there[number - 1], here) > POINT_TOLERANCE:
            drawn += _cut_corner(row, there[number - 1], here, there[number + 1])
        else:
            drawn.append(here)
    return drawn


def _along(a: Point, b: Point, far: float) -> Point:
    whole = math.dist(a, b) or 1.0
    return a[0] + (b[0] - a[0]) * far / whole, a[1] + (b[1] - a[1]) * far / whole


def _cut_corner(row: ContourPoint, before: Point, here: Point, next_point: Point) -> list[Point]:
    back = min(_set_back(row, before, here, next_point), math.dist(before, here), math.dist(here, next_point))
    a, b = _along(here, before, back), _along(here, next_point, back)
    if row.chamfer:
        return [a, b]
    return [_quadratic(a, here, b, k / 6) for k in range(7)]


def _quadratic(a: Point, corner: Point, b: Point, t: float) -> Point:
    """Return a point on a quadratic curve, which approximates a corner radius in the sketch."""
    u = 1.0 - t
    return (
        u * u * a[0] + 2 * u * t * corner[0] + t * t * b[0],
        u * u * a[1] + 2 * u * t * corner[1] + t * t * b[1],
    )


def _arc(a: Point, b: Point, radius: float) -> list[Point]:
    """Return the end points of the chords of an arc from ``a`` to ``b``.

    G02 is counterclockwise when X is drawn upward.
    """
    chord = math.dist(a, b)
    r = max(abs(radius), chord / 2.0)
    if chord < POINT_TOLERANCE:
        return [b]
    high = math.sqrt(max(r * r - chord * chord / 4.0, 0.0))
    middle = (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0
    side = 1.0 if radius > 0 else -1.0
    nz, nr = -(b[1] - a[1]) / chord, (b[0] - a[0]) / chord
    centre = middle[0] + side * high * nz, middle[1] + side * high * nr
    begin = math.atan2(a[1] - centre[1], a[0] - centre[0])
    turn = math.remainder(math.atan2(b[1] - centre[1], b[0] - centre[0]) - begin, 2.0 * math.pi)
    return [
        (centre[0] + r * math.cos(begin + turn * k / 12), centre[1] + r * math.sin(begin + turn * k / 12))
        for k in range(1, 13)
    ]
