"""The manual's worked examples as cleaned: the figures of their table, block by block."""

from __future__ import annotations

from math import pi, sqrt
from pathlib import Path

import pytest

from core.interpreter.shared.actions import Dwell, SpindleRun
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.source import load_source
from tests.interpreter.programs import INCH, Pass, in_feed, passed, setup

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"
SAID = {"m-unknown", "c-too-little"}  # outputs that the test's machine lacks; the example of an error
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the worked examples are not at hand")


def example(name: str, secondary: dict[int, tuple[float, ...]] | None = None) -> Pass:
    result = passed(load_source(FOLDER / f"{name}.nc").text, setup(secondary=secondary))
    assert result.errors == []
    assert result.warnings == []
    return result


def point(block: Block) -> tuple[str, float, float, float, float]:
    return (
        str(block.kind),
        round(block.x / INCH, 9),
        round(block.z / INCH, 9),
        round(in_feed(block), 9),
        block.rpm,
    )


def centre(block: Block) -> tuple[float, float]:
    return block.cx / INCH, block.cz / INCH


def on_line(result: Pass, line: int) -> Block:
    (block,) = (block for block in result.moves if block.line == line)
    return block


def test_diameter_and_radius_programs_move_alike() -> None:
    diameter, radius = example("linear-diameter"), example("linear-radius")
    assert [point(block) for block in diameter.moves] == [point(block) for block in radius.moves]
    assert diameter.feeds == [
        *[("rapid", 300)] * 2,
        *[("feed", 0.003)] * 6,
        ("rapid", 300),
    ]
    assert diameter.ends == [
        (0, 1), (0, 0.1), (0, 0), (0.25, 0), (0.25, -0.5), (0.35, -0.5), (0.35, -1.1), (0.5, -1.1), (0.5, 1),
    ]  # fmt: skip


def test_g00_switches_to_rapid_and_g01_back_to_feed() -> None:
    result = example("rapid-g00-g01")
    assert [(block.text, *feed) for block, feed in zip(result.moves, result.feeds, strict=True)][3:] == [
        ("X.5", "feed", 0.003),
        ("G00Z.05", "rapid", 300),
        ("X0", "rapid", 300),
        ("G01Z0", "feed", 0.003),
        ("X.5", "feed", 0.003),
        ("G00Z1", "rapid", 300),
    ]


@pytest.mark.parametrize(
    ("name", "line", "end", "middle", "clockwise"),
    [
        ("arc-r-radius-convex", 9, (0.25, -0.15), (0.1, -0.15), True),
        ("arc-r-diameter-barrel", 10, (0.2, -0.5), (0.2 - sqrt(0.635**2 - 0.15**2), -0.35), True),
        ("arc-ik-radius", 6, (0.25, -0.15), (0.1, -0.15), True),
        ("arc-ik-diameter", 7, (0.25, -0.15), (0.1, -0.15), True),
        ("arc-ik-diameter", 14, (0.2, -0.4), (0.2, -0.3), False),
    ],
)
def test_arcs_match_manual_examples(
    name: str, line: int, end: tuple[float, float], middle: tuple[float, float], clockwise: bool
) -> None:
    arc = on_line(example(name), line)
    assert arc.kind is BlockKind.ARC
    assert arc.clockwise is clockwise
    assert (arc.x / INCH, arc.z / INCH) == pytest.approx(end)
    assert centre(arc) == pytest.approx(middle, abs=1e-9)


def test_barrel_arc_bulges_outward() -> None:
    arc = on_line(example("arc-r-diameter-barrel"), 10)
    assert centre(arc)[0] == pytest.approx(-0.41703, abs=5e-6)
    assert centre(arc)[0] + 0.635 == pytest.approx(0.21797, abs=5e-6)


def test_dry_run_work_shift_is_three_inches() -> None:
    result = example("workshift-dry-run")
    assert all(block.mz - block.z == pytest.approx(3 * INCH) for block in result.moves)
    assert all(block.mx == pytest.approx(block.x) for block in result.moves)
    assert result.interpreter.modal_state.shift_z == 0
    assert result.blocks[-1].mz == pytest.approx(result.blocks[-1].z)


def test_work_shift_loop_makes_three_parts_from_bar() -> None:
    result = example("workshift-bar-loop")
    loop = [block for block in result.moves if block.line >= 11]
    parts = [loop[i : i + len(loop) // 3] for i in range(0, len(loop), len(loop) // 3)]
    assert len(parts) == 3
    for k, part in enumerate(parts):
        assert [block.line for block in part] == [block.line for block in parts[0]]
        assert all(block.mz - block.z == pytest.approx(-0.35 * k * INCH, abs=1e-9) for block in part)
        assert all(block.mx == pytest.approx(block.x, abs=1e-9) for block in part)


def test_secondary_offset_corrects_taper() -> None:
    result = example("secondary-taper", {4: (-0.0005, 0)})
    assert result.ends[4:6] == [(0.1245, -0.75), (0.2, -0.75)]
    assert on_line(result, 8).x0 == pytest.approx(0.125 * INCH)


def test_each_of_three_bores_has_its_own_offset() -> None:
    plain = example("secondary-three-bores").ends
    for number, lines in ((1, (6, 7)), (2, (8, 9)), (3, (10, 13))):
        moved = example("secondary-three-bores", {number: (0.001, 0)})
        for block, before in zip(moved.moves, plain, strict=True):
            inside = lines[0] <= block.line <= lines[1]
            assert block.x / INCH == pytest.approx(before[0] + (0.001 if inside else 0))


def test_loop_cuts_sixteen_notches() -> None:
    result = example("loop-notches")
    cuts = [block for block in result.moves if block.kind is BlockKind.FEED]
    assert [round(block.z / INCH, 5) for block in cuts] == [round(-0.035 - 0.085 * k, 5) for k in range(16)]
    assert {round(block.x / INCH, 5) for block in cuts} == {0.15}
    assert [action for action in result.actions if isinstance(action, Dwell)] == [Dwell(0.5)] * 16
    assert result.moves[-1].modal.absolute is True
    assert result.ends[-1] == (0.25, 1)


def test_tapping_reverses_spindle_during_retract() -> None:
    result = example("tapping")
    way_in, way_out = (block for block in result.moves if block.kind is BlockKind.FEED)
    assert (in_feed(way_in), way_in.rpm, way_in.z / INCH) == pytest.approx((0.05, 1000, -0.4))
    assert (in_feed(way_out), way_out.rpm, way_out.z / INCH) == pytest.approx((0.05, -1000, 0.1))
    assert SpindleRun(-1000) in result.actions


def test_facing_at_constant_surface_speed_is_limited_by_g77() -> None:
    result = example("css-facing")
    at = {block.line: block for block in result.blocks}
    assert at[5].rpm == pytest.approx(250 * 12 / (2 * pi * 0.25))
    assert round(at[5].rpm) == 1910
    assert at[9].rpm == 2500  # on the centre, held by G77
    assert max(block.rpm for block in result.blocks) == 2500
    assert at[12].rpm == 2000
    assert at[12].action == SpindleRun(2000)
    assert [block.line for block in result.moves if block.css is not None] == [8, 9, 10]


NOSE: dict[int, tuple[float, ...]] = {1: (-0.015, -0.015, 0.015)}  # X -.03 as a diameter, Z -.015, R .015


def test_contour_corners_are_compensated() -> None:
    source = load_source(FOLDER / "corners-with-g41.nc").text.replace("G41\n", "").replace("G40\n", "")
    result = passed(source)
    assert (result.errors, result.warnings) == ([], [])
    assert result.ends[3:-1] == [
        (0.105, 0), (0.135, -0.03), (0.135, -0.32), (0.165, -0.35), (0.225, -0.35), (0.25, -0.375),
        (0.25, -0.45), (0.27, -0.45),
    ]  # fmt: skip
    (arc,) = (block for block in result.moves if block.kind is BlockKind.ARC)
    assert arc.clockwise
    assert centre(arc) == pytest.approx((0.225, -0.375))
    # Compensated, the path is .015 off each straight, less .015 to the left and below for the tip.
    moved = example("corners-with-g41", NOSE)
    assert {(0.135, -0.045), (0.21, -0.35), (0.25, -0.39), (0.25, -0.45), (0.255, -0.45)} <= set(moved.ends)


def test_nose_compensation_matches_manual_example() -> None:
    result = example("nose-comp-g41", NOSE)
    path = [(str(block.kind), *end) for block, end in zip(result.moves, result.ends, strict=True)]
    assert path[2:] == [
        ("feed", -0.015, 0),
        ("feed", 0.205, 0),
        ("arc", 0.21561, -0.00439),
        ("feed", 0.24561, -0.03439),
        ("arc", 0.25, -0.045),
        ("feed", 0.25, -0.3),
        ("feed", 0.255, -0.3),
        ("rapid", 0.255, 1.985),
    ]
    arcs = [block for block in result.moves if block.kind is BlockKind.ARC]
    assert [centre(arc) for arc in arcs] == [
        pytest.approx((0.205, -0.015)),
        pytest.approx((0.235, -0.045)),
    ]  # the corners (.22, 0) and (.25, -.03), moved by D
    assert not any(code in block.text for block in result.blocks for code in ("G40", "G41", "G42"))


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.nc")), ids=lambda path: path.stem)
def test_manual_examples_have_only_expected_errors(path: Path) -> None:
    errors = [error for error in passed(load_source(path).text).errors if error[2] not in SAID]
    assert errors == []
