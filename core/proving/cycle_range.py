"""The least and the greatest cycle time of all ways through a program."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from typing import NamedTuple

from core.proving.report import Range


class Fork(NamedTuple):
    """Where another way leaves one: blocks made before, the time there, and the other."""

    blocks: int
    t: float
    other: Way


@dataclass(slots=True, eq=False)
class Way:
    """A way in time, s from the start of the program. ``ends``: of its blocks from ``first`` + 1 on."""

    first: int = 0
    start: float = 0.0
    duration: float = 0.0  # when it is over, or has come to where another way has been
    ends: array[float] = field(default_factory=lambda: array("d"))
    forks: list[Fork] = field(default_factory=list)
    merged: tuple[Way, int] | None = None  # the other way, and the blocks made there before
    gone: bool = False
    failed: bool = False

    def at(self, blocks: int) -> float:
        """When so many blocks have been made."""
        made = blocks - self.first
        if made <= 0 or not self.ends:
            return self.start
        return self.ends[min(made, len(self.ends)) - 1]


_Node = tuple[Way, int]
"""A way right before one of its forks; behind the last one, up to its end."""


def cycle_range(first: Way) -> Range:
    """Least and greatest time from the start of the program to its end, of all ways that were gone."""
    known: dict[tuple[int, int], Range] = {}
    todo: list[_Node] = [(first, 0)]
    while todo:
        way, at = node = todo[-1]
        missing = [n for n, _ in _next(node) if (id(n[0]), n[1]) not in known]
        if missing:
            todo += missing
            continue
        todo.pop()
        ends = [(t + known[id(n[0]), n[1]][0], t + known[id(n[0]), n[1]][1]) for n, t in _next(node)]
        if at == len(way.forks) and way.merged is None:
            ends = [(way.duration - _time(node),) * 2]
        known[id(way), at] = (min(low for low, _ in ends), max(high for _, high in ends))
    low, high = known[id(first), 0]
    before = _time((first, 0))
    return before + low, before + high


def _time(node: _Node) -> float:
    way, at = node
    if at < len(way.forks):
        return way.forks[at].t
    return way.forks[-1].t if way.forks else way.start


def _next(node: _Node) -> list[tuple[_Node, float]]:
    """What comes from there, each with the seconds to it."""
    way, at = node
    if at < len(way.forks):
        here, other = way.forks[at].t, way.forks[at].other
        follows: list[tuple[_Node, float]] = [((way, at + 1), _time((way, at + 1)) - here)]
        if other.gone and not other.failed:
            follows.append(((other, 0), _time((other, 0)) - other.start))
        return follows
    if way.merged is None:
        return []
    there, blocks = way.merged
    fork = next((k for k, each in enumerate(there.forks) if each.blocks >= blocks), len(there.forks))
    node = there, fork
    return [(node, way.duration - _time((way, at)) + _time(node) - there.at(blocks))]
