"""Drills as they are sold: inch by number, letter and fraction, metric by tenths; the one for a hole."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

_NUMBERS = (
    *(2280, 2210, 2130, 2090, 2055, 2040, 2010, 1990, 1960, 1935, 1910, 1890, 1850, 1820, 1800, 1770),
    *(1730, 1695, 1660, 1610, 1590, 1570, 1540, 1520, 1495, 1470, 1440, 1405, 1360, 1285, 1200, 1160),
    *(1130, 1110, 1100, 1065, 1040, 1015, 995, 980, 960, 935, 890, 860, 820, 810, 785, 760, 730, 700),
    *(670, 635, 595, 550, 520, 465, 430, 420, 410, 400),
)  # from #1, in 1/10000 in
_LETTERS = (
    *(234, 238, 242, 246, 250, 257, 261, 266, 272, 277, 281, 290, 295),
    *(302, 316, 323, 332, 339, 348, 358, 368, 377, 386, 397, 404, 413),
)  # from A, in 1/1000 in
_INCH = {f"#{n}": size / 10_000 for n, size in enumerate(_NUMBERS, 1)}
_INCH |= {chr(ord("A") + n): size / 1000 for n, size in enumerate(_LETTERS)}
_INCH |= {str(Fraction(n, 64)): n / 64 for n in range(3, 97)}
_OVER = 0.025  # mm: as much over the middle a metric drill may be, whose steps are wide


def _metric() -> Iterator[float]:
    """Tenths up to 14 mm, quarters up to 50."""
    yield from (n / 10 for n in range(10, 140))
    yield from (n / 4 for n in range(56, 201))


def drill_for(least: float, most: float, *, metric: bool) -> tuple[str, float] | None:
    """Name and size of the drill for a hole between these, mm or inches; None where none is sold.

    The largest that is not over the middle, since drills cut wide; else the next above it.
    """
    sold = {f"{size:g}": size for size in _metric()} if metric else _INCH
    fits = sorted((size, name) for name, size in sold.items() if least <= size <= most)
    middle = (least + most) / 2.0 + (_OVER if metric else 0.0)
    below = [each for each in fits if each[0] <= middle]
    chosen = below[-1] if below else fits[0] if fits else None
    return None if chosen is None else (chosen[1], chosen[0])
