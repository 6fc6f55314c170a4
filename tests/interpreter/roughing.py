"""What a roughing cycle does to a bar: how near it comes to its contour, and how deep each move cuts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from core.geometry.lines_and_arcs import Arc, Element, Line, Point, compute_distance_to_point, make_arc
from core.interpreter.shared.elementary_blocks import Block, BlockKind


def element_of(block: Block) -> Element:
    """The way of a block in the program's frame."""
    start, end = (block.x0, block.z0), (block.x, block.z)
    if block.kind is BlockKind.ARC:
        return make_arc(start, end, (block.cx, block.cz), is_clockwise=block.clockwise)
    return Line(start, end)


def contour_of(blocks: Iterable[Block]) -> list[Element]:
    """The elements of moves that have a length."""
    return [element for element in map(element_of, blocks) if element.length > 1e-6]


def along(element: Element, step: float) -> list[Point]:
    """Points of an element not more than ``step`` apart."""
    if element.length == 0:
        return [element.start]
    count = int(element.length / step) + 2
    inner = [element.get_point(element.length * k / count) for k in range(1, count)]
    return [element.start, *inner, element.end]


def nearest(blocks: Iterable[Block], contour: list[Element], step: float = 0.2) -> float:
    """The least distance between the moves and the contour, mm."""
    points = {point for block in blocks for point in along(element_of(block), step)}
    return min(compute_distance_to_point(element, point) for element in contour for point in points)


class Bar:
    """Material from the start's X on, in columns along Z from the start to ``way`` mm before it."""

    def __init__(self, start: Point, x: float, z: float, way: float, columns: int = 120) -> None:
        self._start, self._x, self._z = start, x, z
        self._ways = [way * (k + 0.5) / columns for k in range(columns)]
        self._cleared = [0.0] * columns

    def cuts(self, block: Block) -> float:
        """The greatest depth, along X, that a move takes off; the bar is less by it."""
        deepest = 0.0
        for k, depth in self._under(element_of(block)):
            deepest = max(deepest, depth - self._cleared[k])
            self._cleared[k] = max(self._cleared[k], depth)
        return deepest

    def _under(self, element: Element) -> Iterator[tuple[int, float]]:
        step = 0.02 if isinstance(element, Arc) else max(element.length, 0.02)
        points = [self._seen(point) for point in along(element, step)]
        for (u0, v0), (u1, v1) in pairwise(points):
            low, high = min(v0, v1), max(v0, v1)
            if high - low < 1e-9:
                continue
            for k, way in enumerate(self._ways):
                if low <= way <= high:
                    yield k, u0 + (u1 - u0) * (way - v0) / (v1 - v0)

    def _seen(self, point: Point) -> Point:
        return (point[0] - self._start[0]) * self._x, (point[1] - self._start[1]) * self._z
