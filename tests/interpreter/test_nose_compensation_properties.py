"""Random contours through the whole interpreter: the nose keeps its distance. Inches in the programs."""

from __future__ import annotations

from itertools import pairwise
from math import cos, dist, sin

import pytest
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st

from core.geometry.lines_and_arcs import Element, Point, compute_distance_to_point, find_arc_center
from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.geometry.contours import sampled
from tests.interpreter.programs import INCH, Pass, lines, passed, setup

pytestmark = pytest.mark.long

_STEP = st.tuples(
    st.floats(0.02, 0.6),  # length, in
    st.floats(-2.0, 2.0),  # turn before it
    st.sampled_from(["line", "line", "R", "C", "02", "03"]),
    st.floats(0.55, 6.0),  # radius over length of an arc; share of the length that a corner takes
)
_STEPS = st.lists(_STEP, min_size=1, max_size=8)
ALLOWED = {"comp-gouge", "corner-too-large", "corner-next", "arc-radius", "arc-no-chord"}
ALLOWED |= {f"comp-{what}-{why}" for what in ("approach", "departure") for why in ("short", "near")}


def number(value: float) -> str:
    return f"{value:.4f}"


class Writer:
    """A program of a contour, in diameters or radii."""

    def __init__(self, *, diameter: bool) -> None:
        self._diameter = diameter
        self.at = (3.0, 0.0)
        self.heading = -1.5
        self.lines: list[str] = []

    def words(self, point: Point) -> str:
        return f"X{number(point[0] * 2 if self._diameter else point[0])}Z{number(point[1])}"

    def beside(self, side: float, off: float) -> Point:
        """A point to the left (side 1) of the place, square to the way."""
        return self.at[0] - side * off * cos(self.heading), self.at[1] + side * off * sin(self.heading)

    def step(self, length: float, turned: float, kind: str, share: float) -> None:
        self.heading += turned
        end = (
            round(self.at[0] + length * sin(self.heading), 4),
            round(self.at[1] + length * cos(self.heading), 4),
        )
        if kind in {"02", "03"}:
            centre = find_arc_center(self.at, end, share * length, is_clockwise=kind == "02")
            i, k = centre[0] - self.at[0] * self._diameter, centre[1] - self.at[1] * self._diameter
            self.lines.append(f"G{kind}{self.words(end)}I{number(i)}K{number(k)}")
        else:
            corner = "" if kind == "line" else f"{kind}{number(length * share / 12)}"
            self.lines.append(self.words(end) + corner)
        self.at = end


def program(steps: list[tuple[float, float, str, float]], *, left: bool, nose: float, diameter: bool) -> str:
    writer = Writer(diameter=diameter)
    side = 1 if left else -1
    writer.heading += steps[0][1]
    start = writer.words(writer.beside(side, 3 * nose))
    approach = writer.words(writer.at)
    writer.heading -= steps[0][1]
    for step, after in zip(steps, [*(kind for _, _, kind, _ in steps[1:]), "02"], strict=True):
        straight = after in {"02", "03"} and step[2] in {"R", "C"}  # a corner needs a line after it
        writer.step(*step[:2], "line" if straight else step[2], step[3])
    if steps[-1][2] in {"02", "03"}:  # the way back has to be square to a line
        writer.step(0.1, 0.3, "line", 1.0)
    departure = writer.words(writer.beside(side, 3 * nose))
    mode, code = "G72" if diameter else "G73", "G41" if left else "G42"
    head = f"G90{mode}G94F300"
    return lines(head, f"{start}F9", code, f"{approach}D1", *writer.lines, departure, "G40", "M30")


def contour_of(text: str) -> list[Element]:
    """The contour as programmed: the same program without compensation, approach and departure apart."""
    plain = text.replace("G41\n", "").replace("G42\n", "").replace("G40\n", "").replace("D1\n", "\n")
    blocks = passed(plain).moves
    return [make_element(block) for block in blocks[2:-1] if length(block) > 1e-6]


def length(block: Block) -> float:
    return dist((block.x0, block.z0), (block.x, block.z))


def path_of(result: Pass) -> list[Element]:
    return [make_element(block) for block in result.moves[2:-1] if length(block) > 1e-6]


@settings(max_examples=250, deadline=None)
@given(_STEPS, st.booleans(), st.sampled_from([0.004, 0.0155, 0.03125]), st.booleans())
def test_nose_does_not_cut_into_contour(
    steps: list[tuple[float, float, str, float]], left: bool, nose: float, diameter: bool
) -> None:
    text = program(steps, left=left, nose=nose, diameter=diameter)
    result = passed(text, setup(secondary={1: (0, 0, nose)}))
    if result.errors:
        event("refused " + result.errors[0][2])
        assert {error[2] for error in result.errors} <= ALLOWED
        return
    event("compensated")
    contour = contour_of(text)
    radius = nose * INCH
    for piece in path_of(result):
        for point in sampled(piece, 21):
            assert (
                radius - 0.002
                <= min(compute_distance_to_point(element, point) for element in contour)
                <= radius + 0.001
            )
    for before, after in pairwise(result.blocks):
        assert dist((before.x, before.z), (after.x0, after.z0)) < 1e-9


@settings(max_examples=100, deadline=None)
@given(_STEPS, st.booleans(), st.floats(-0.05, 0.05).map(lambda v: round(v, 4)))
def test_secondary_offset_shifts_whole_path(
    steps: list[tuple[float, float, str, float]], left: bool, moved: float
) -> None:
    text = program(steps, left=left, nose=0.0155, diameter=False)
    still = passed(text, setup(secondary={1: (0, 0, 0.0155)}))
    result = passed(text, setup(secondary={1: (moved, -moved, 0.0155)}))
    assume(not still.errors and not result.errors)
    assert len(result.moves) == len(still.moves)
    for a, b in zip(result.moves[1:], still.moves[1:], strict=True):
        assert (a.x / INCH - moved, a.z / INCH + moved) == pytest.approx((b.x / INCH, b.z / INCH), abs=1e-9)


_PLACE = st.sampled_from(["0", ".1", ".2", ".3", "-.1", "-.2", "1", ".35"])
_END = st.sampled_from(["", "", "", "C.02", "R.02", "F9", "M08", "D1", "D2", "R.1", "C.3", "M00"])
_LINE = (
    st.builds("X{}Z{}{}".format, _PLACE, _PLACE, _END)
    | st.builds("X{}{}".format, _PLACE, _END)
    | st.builds("Z{}{}".format, _PLACE, _END)
    | st.builds("G02X{}Z{}R.3".format, _PLACE, _PLACE)
    | st.sampled_from(
        ["G90", "G91", "G72", "G73", "G00", "G94F20", "M09", "G04F1", "T1", "G92X0Z0", "LS2", "LF"]
    )
)
_STRETCH = st.builds(
    lambda start, code, lead, inner, end: [start, code, lead, *inner, end, "G40"],
    st.sampled_from(["X0Z.2", "X.5Z.5", "X1Z-1"]),
    st.sampled_from(["G41", "G42"]),
    st.sampled_from(["X0Z0D1", "X.3Z0D1", "X.2Z.1D2", "X.2Z.1"]),
    st.lists(_LINE, max_size=8),
    st.sampled_from(["X2Z2", "X-2Z-2", "X2Z-2", "Z3"]),
)


@settings(max_examples=500, deadline=None)
@given(st.lists(_LINE.map(lambda line: [line]) | _STRETCH, max_size=6))
def test_blocks_are_continuous_for_any_program(parts: list[list[str]]) -> None:
    text = lines("G90G94F300", "M03S500", "F20", *(line for part in parts for line in part), "M30")
    offsets = {1: (-0.01, -0.01, 0.01), 2: (0.0, 0.0, 0.002)}
    result = passed(text, setup(secondary=offsets))
    event("refused" if result.errors else "run")
    assert [block.n for block in result.blocks] == list(range(1, len(result.blocks) + 1))
    for before, after in pairwise(result.blocks):
        assert after.x0 + after.offset_x == pytest.approx(before.mx, abs=1e-6)
        assert after.z0 + after.offset_z == pytest.approx(before.mz, abs=1e-6)
    for block in result.blocks:
        if block.kind is BlockKind.ARC:
            radii = [dist(end, (block.cx, block.cz)) for end in ((block.x0, block.z0), (block.x, block.z))]
            assert radii[0] == pytest.approx(radii[1], abs=0.013)  # what the language allows
    if not result.errors:
        assert not result.interpreter._state.contour.is_buffering
        lost = {number for number, line in enumerate(text.splitlines(), 1) if line[0] in "XZ"}
        assert lost <= {block.line for block in result.blocks}
