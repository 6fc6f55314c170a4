"""The worked examples of the cycles: the figures of their table."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.source import load_source
from tests.interpreter.programs import INCH, Pass, in_feed, passed
from tests.interpreter.roughing import Bar, contour_of, nearest

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the worked examples are not at hand")


def example(name: str) -> Pass:
    result = passed(load_source(FOLDER / f"{name}.nc").text)
    assert result.errors == []
    return result


def on_line(result: Pass, line: int) -> list[Block]:
    return [block for block in result.moves if block.line == line]


def pecks(result: Pass, line: int) -> list[float]:
    return [round(b.z / INCH, 5) for b in on_line(result, line) if b.kind is BlockKind.FEED]


def test_g81_drills_at_feed_and_retracts_in_rapid() -> None:
    way_in, way_out = on_line(example("drill-g81"), 6)
    assert (str(way_in.kind), way_in.z / INCH, in_feed(way_in)) == ("feed", pytest.approx(-0.1), 0.005)
    assert (str(way_out.kind), way_out.z / INCH) == ("rapid", pytest.approx(0.01))


def test_g83_peck_feeds_match_the_example() -> None:
    result = example("drill-peck-g83")
    assert pecks(result, 6) == [-0.09, -0.19, -0.29, -0.39, -0.49, -0.5]
    rapids = [b for b in on_line(result, 6) if b.kind is BlockKind.RAPID]
    assert [round(b.z / INCH, 5) for b in rapids] == [
        0.5, -0.04, 0.5, -0.14, 0.5, -0.24, 0.5, -0.34, 0.5, -0.44, 0.5, 0.01,
    ]  # fmt: skip
    assert {round(in_feed(b), 6) for b in rapids} == {300}
    assert {round(in_feed(b), 6) for b in on_line(result, 6) if b.kind is BlockKind.FEED} == {0.003}


def test_second_drill_pecks_from_the_depth_of_the_first() -> None:
    result = example("drill-peck-two-drills")
    assert pecks(result, 6) == [-0.19, -0.39, -0.5]
    assert pecks(result, 11) == [-0.5, -0.6, -0.7, -0.8]
    assert on_line(result, 11)[0].z0 / INCH == pytest.approx(-0.4)


def test_loop_shifts_each_ring() -> None:
    result = example("loop-rings")
    assert pecks(result, 8) == [-0.2, -0.5, -0.8, -1]
    drilled = on_line(result, 8)
    assert [round(b.z / INCH, 5) for b in drilled if b.kind is BlockKind.RAPID] == [
        0.1,
        0,
        0.1,
        -0.3,
        0.1,
        -0.6,
        0.1,
    ]
    rings = [b for b in on_line(result, 22) if b.kind is BlockKind.FEED]
    assert [round((b.mz - b.z) / INCH, 5) for b in rings] == [round(-0.15 * k, 5) for k in range(6)]


def test_g74_box_roughing_matches_the_example() -> None:
    result = example("rough-box-g74")
    moves = on_line(result, 7)
    passes = [b for b in moves if b.kind is BlockKind.FEED and b.z != b.z0]
    assert [round(b.x / INCH, 5) for b in passes] == [0.4585, 0.392, 0.3255, 0.259, 0.1925]
    assert {round(b.z / INCH, 5) for b in passes} == {-0.747}
    for block in moves:
        if block.kind is BlockKind.RAPID and block.z0 < 0 and block.z == block.z0:
            assert (block.x - block.x0) / INCH == pytest.approx(0.02)
    assert (round(moves[-1].x / INCH, 5), round(moves[-1].z / INCH, 5)) == (0.525, 0.1)


def contour(name: str) -> list[Element]:
    """The contour of an example, run as moves of its own."""
    lines = load_source(FOLDER / f"{name}.nc").text.splitlines()
    text = [line for line in lines if not line.startswith(("G75", "RF"))]
    first = lines.index(next(line for line in lines if line.startswith("G75")))
    last = lines.index("RF") - 1
    return contour_of([b for b in passed("\n".join(text) + "\n").moves if first + 1 < b.line <= last])


@pytest.mark.parametrize(
    ("name", "start", "x"),
    [("rough-contour-g75-diameter", (0.4, 0.1), -1), ("rough-contour-g75-internal", (0.2, 0.1), 1)],
)
def test_contour_roughing_never_cuts_too_deep(name: str, start: tuple[float, float], x: int) -> None:
    result = example(name)
    line = next(block.line for block in result.moves if block.text and block.line > 5)
    moves = on_line(result, line)
    assert nearest(moves, contour(name), 0.05) >= (0.02 - 0.0001) * INCH
    bar = Bar((start[0] * INCH, start[1] * INCH), x, -1, 1.08 * INCH, 500)
    for block in moves:
        assert bar.cuts(block) <= (0.0001 if block.kind is BlockKind.RAPID else 0.0501) * INCH
    assert (round(moves[-1].x / INCH, 5), round(moves[-1].z / INCH, 5)) == start


def test_the_contour_in_a_subroutine_gives_the_same_motions() -> None:
    here, there = example("rough-contour-g75-diameter"), example("rough-contour-g75-sub")
    assert [(b.kind, b.x, b.z, b.cx, b.cz) for b in here.moves] == [
        (b.kind, b.x, b.z, b.cx, b.cz) for b in there.moves
    ]
    assert here.warnings == there.warnings == [(7, 1, "cycle-plunge")]


def test_roughing_and_finishing_use_two_tools() -> None:
    result = example("rough-finish-g75-g78-two-tools")
    finish = contour_of([block for block in result.moves if block.line > 22])
    assert nearest(on_line(result, 7), finish, 0.05) == pytest.approx(0.04 * INCH, abs=0.002)
    assert nearest(on_line(result, 13), finish, 0.05) == pytest.approx(0.01 * INCH, abs=0.002)
    lines = [block.line for block in result.moves]
    assert list(dict.fromkeys(lines[lines.index(22) :])) == [*range(22, 30), 18, 19]
