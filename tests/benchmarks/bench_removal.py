"""What removal costs: ``python -m tests.benchmarks.bench_removal``.

A thousand roughing moves along Z with a round nose of .8 mm in a bar of 60 by 102 mm, in columns of .01 mm:
taken off with all that the checks want to know, and taken off alone; beside it shapely, where it is
installed, by the difference of the section and the hull of each move. The areas that are left have to agree
within .01 %.
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from core.part.cutter import CutSide, Cutter
from core.part.stock import make_bar_stock
from core.part.swept_edge import FloatArray, Point, find_axis_facing_edge, sweep_edge
from core.part.turned_part import TurnedPart

MOVES, ROUNDS, STEP = 1000, 7, 0.01
RADIUS, FRONT, BACK = 30.0, 2.0, -100.0

Move = tuple[Point, Point]
Work = Callable[[list[Move]], float]


def nose() -> FloatArray:
    """An insert of 12 mm, its tip at 0, its nose in chords within .0005 mm."""
    radius = 0.8
    count = math.ceil(math.pi / 2 / (2 * math.acos(1 - 0.0005 / radius)))
    at = np.linspace(math.pi, 1.5 * math.pi, count + 1)
    return np.vstack(
        (
            np.column_stack((radius + radius * np.cos(at), radius + radius * np.sin(at))),
            [[12.0, 2.0], [12.0, 12.0], [1.5, 12.0]],
        )
    )


def moves() -> list[Move]:
    """From in front of the face to ever smaller diameters, each to another depth."""
    depths = -20.0 - 60.0 * np.random.default_rng(1).random(MOVES)
    radii = np.linspace(29.9, 10.0, MOVES)
    return [((5.0, r), (z, r)) for z, r in zip(depths.tolist(), radii.tolist(), strict=True)]


def checked(work: list[Move]) -> float:
    """As the proof does it; the area that is left, mm²."""
    part, cutter = (
        TurnedPart(make_bar_stock(2 * RADIUS, FRONT, BACK), STEP),
        Cutter([nose()], [], CutSide.OUTSIDE),
    )
    for start, end in work:
        cutter.cut_material(part, start, end)
    return float((part.outer_radii - part.inner_radii).sum()) * part.columns.step_mm


def alone(work: list[Move]) -> float:
    """The metal alone."""
    part, edge = TurnedPart(make_bar_stock(2 * RADIUS, FRONT, BACK), STEP), find_axis_facing_edge(nose())
    for start, end in work:
        first, reach = sweep_edge(edge, start, end, part.columns)
        high = part.outer_radii[0, first : first + len(reach)]
        np.minimum(high, reach, out=high)
    return float((part.outer_radii - part.inner_radii).sum()) * part.columns.step_mm


def by_shapely() -> Work:
    """The same by polygons. Raises ImportError where shapely is not installed."""
    shapely: Any = import_module("shapely")
    insert = nose()
    above = np.vstack((insert, [[0.0, 2 * RADIUS], [12.0, 2 * RADIUS]]))

    def work(todo: list[Move]) -> float:
        section = shapely.box(BACK, 0.0, FRONT, RADIUS)
        for start, end in todo:
            ends = np.vstack((above + np.array(start), above + np.array(end)))
            section = section.difference(shapely.MultiPoint(ends).convex_hull)
        return float(section.area)

    return work


def main() -> int:
    """Prints the table: A B A B, medians."""
    todo = moves()
    works: dict[str, Work] = {"checked": checked, "alone": alone}
    try:
        works["shapely"] = by_shapely()
    except ImportError:
        sys.stdout.write("shapely is not installed: no peer\n")
    spent: dict[str, list[float]] = {name: [] for name in works}
    areas: dict[str, float] = {}
    for _ in range(ROUNDS):
        for name, work in works.items():
            began = time.process_time()
            areas[name] = work(todo)
            spent[name].append(time.process_time() - began)
    for name, seconds in spent.items():
        rate = MOVES / statistics.median(seconds)
        off = areas[name] / areas["checked"] - 1.0
        sys.stdout.write(
            f"{name:10} {rate:9.0f} moves a cpu second   area {areas[name]:.3f} mm² ({off:+.4%})\n"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
