"""G75 and G78 on random contours: never nearer than U, never deeper than I, back to the start."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, dist

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.interpreter.programs import Pass, passed, setup
from tests.interpreter.roughing import Bar, contour_of, nearest

pytestmark = pytest.mark.long

_STEP = st.tuples(
    st.floats(0.5, 8.0),  # way
    st.floats(1.0, 12.0),  # depth at its end
    st.sampled_from(["line", "line", "wall", "left", "right"]),
    st.floats(0.55, 3.0),  # radius over the chord
)
STEPS = st.lists(_STEP, min_size=1, max_size=7)
FALLING = STEPS.map(
    lambda steps: [(w, 12.0 - 11.0 * k / len(steps), "line", r) for k, (w, _, _, r) in enumerate(steps)]
)
Side = tuple[float, int, int, bool]
SIDES = st.tuples(
    st.sampled_from([20.0, -20.0]), st.sampled_from([1, -1]), st.sampled_from([1, -1]), st.booleans()
)
"""X of the start, whether X grows towards the contour and whether Z does, whether it is written backwards."""

REFUSALS = {"cycle-no-way", "cycle-start-near", "cycle-nothing"}


def program(steps: list[tuple[float, float, str, float]], side: Side, cycle: str) -> str:
    """A contour between depth 14, way 2 and its other end, in millimetres, written from either end.

    The start stands at depth 0, way 0, which is Z3.
    """
    x0, x, z, backwards = side
    points, arcs = [(14.0, 2.0)], list[tuple[str, float]]()
    for way, depth, kind, radius in steps:
        end = round(depth, 3), round(points[-1][1] + (0 if kind == "wall" else way), 3)
        if dist(points[-1], end) >= 0.1:
            arcs.append((kind, ceil(radius * dist(points[-1], end) * 1000) / 1000))
            points.append(end)
    if backwards:
        points, arcs = points[::-1], arcs[::-1]
    lines = [_words(side, points[0])]
    for end, (kind, size) in zip(points[1:], arcs, strict=True):
        if kind in {"left", "right"}:
            clockwise = ((kind == "right") == (x * z > 0)) != backwards
            lines.append(f"G0{2 if clockwise else 3}{_words(side, end)}R{size:.3f}")
        else:
            lines.append(_words(side, end))
    head = ["G90G71G94F7000", "M03S1000", f"X{x0}Z3", f"{cycle}F100P1", "P1", "M30", "}1"]
    return "\n".join([*head, *lines, "M99", ""])


def _words(side: Side, point: tuple[float, float]) -> str:
    x0, x, z, _ = side
    return f"X{x0 + x * point[0]:.3f}Z{3 + z * point[1]:.3f}"


def run(text: str, side: Side) -> tuple[Pass, list[Block]]:
    result = passed(text, setup(start=(side[0] / 25.4, 3 / 25.4)))
    codes = {code for _, _, code in result.errors}
    assert codes <= REFUSALS
    assume(not codes)
    cycle = [block for block in result.moves if block.line == 4]
    assert cycle
    return result, cycle


def check(steps: list[tuple[float, float, str, float]], side: Side, cut: float, left: float) -> None:
    result, cycle = run(program(steps, side, f"G75I{cut}U{left}"), side)
    contour = contour_of([block for block in result.moves if block.line > 8])
    assert nearest(cycle, contour) >= left - 0.002
    assert (cycle[-1].x, cycle[-1].z) == pytest.approx((side[0], 3))
    assert all((b.x0, b.z0) == (a.x, a.z) for a, b in pairwise(cycle))
    if any(code == "cycle-undercut" for _, _, code in result.warnings):
        return
    way = max(abs(block.z - 3) for block in cycle)
    bar = Bar((side[0], 3), side[1], side[2], way)
    for block in cycle:
        depth = bar.cuts(block)
        assert depth <= (0.002 if block.kind is BlockKind.RAPID else cut + 0.002)


@settings(max_examples=100, deadline=None)
@given(FALLING, SIDES, st.sampled_from([0.3, 1.0, 2.5]), st.sampled_from([0.0, 0.2, 0.8]))
def test_roughing_of_any_falling_contour_is_valid(
    steps: list[tuple[float, float, str, float]], side: Side, cut: float, left: float
) -> None:
    check(steps, side, cut, left)


@settings(max_examples=150, deadline=None)
@given(STEPS, SIDES, st.sampled_from([0.5, 1.0, 2.5]), st.sampled_from([0.0, 0.2, 0.8, 1.5]))
def test_roughing_of_any_rising_and_falling_contour_is_valid(
    steps: list[tuple[float, float, str, float]], side: Side, cut: float, left: float
) -> None:
    check(steps, side, cut, left)


@settings(max_examples=60, deadline=None)
@given(STEPS, SIDES, st.sampled_from([0.0, 0.2, 0.8]))
def test_g78_makes_one_pass_along_any_contour(
    steps: list[tuple[float, float, str, float]], side: Side, left: float
) -> None:
    result, cycle = run(program(steps, side, f"G78U{left}"), side)
    contour = contour_of([block for block in result.moves if block.line > 8])
    assert nearest(cycle, contour) >= left - 0.002
    assert (cycle[-1].x, cycle[-1].z) == pytest.approx((side[0], 3))
    # Everything along the way is cut: no rapid but to the contour and from it.
    kinds = [block.kind is BlockKind.RAPID for block in cycle]
    first, last = kinds.index(False), len(kinds) - 1 - kinds[::-1].index(False)
    assert not any(kinds[first : last + 1])
