"""CHF, CHR and RND between straight moves; C ends with the block that names them."""

from __future__ import annotations

from itertools import pairwise
from math import asin, cos, dist, pi, sin, sqrt

import pytest

from core.geometry.lines_and_arcs import compute_arc_length
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.sinumerik.lathe import good, refused, run, setup

AT = setup(start=(10.0, 0.0, 0.0))


def corner(words: str) -> list[Block]:
    """Along Z to -20, then out along X to radius 30: a corner of 90 degrees; C turns 90 on the first way."""
    return good(f"G1 Z-20 C90 F100 {words}\nX60", AT)


def way(block: Block) -> float:
    return dist((block.x0, block.z0), (block.x, block.z))


def test_chamfer_is_given_by_its_length() -> None:
    first, cut, last = corner("CHF=4")
    assert way(cut) == pytest.approx(4)
    assert (first.x, first.z) == pytest.approx((10, -20 + 4 / sqrt(2)))
    assert (last.x0, last.z0) == pytest.approx((10 + 4 / sqrt(2), -20))


def test_chamfer_is_given_by_its_leg() -> None:
    first, cut, last = corner("CHR=4")
    assert (first.z, last.x0) == pytest.approx((-16, 14))
    assert way(cut) == pytest.approx(4 * sqrt(2))


def test_chamfer_at_obtuse_corner_is_given_by_its_length() -> None:
    """A turn of 45 degrees: legs of 3 / (2 cos 22.5°) leave a chamfer of 3."""
    _, cut, _ = good("G1 Z-20 F100 CHF=3\nX60 Z-40", AT)
    assert way(cut) == pytest.approx(3)


def test_speed_after_corner_does_not_apply_to_move_before_it() -> None:
    """G96 S200 at a radius of 10 is 3183 rpm, though S100 is read before the move can be cut."""
    cut = good("G96 S200 M4 F.2\nG1 X20 Z-20 RND=4\nS100\nX60", AT)[0]
    assert cut.rpm == pytest.approx(-200e3 / (pi * 20.0))


def test_rounding_is_tangent_to_both_lines() -> None:
    first, arc, last = corner("RND=4")
    assert arc.kind is BlockKind.ARC
    assert (first.z, last.x0) == pytest.approx((-16, 14))
    ends = (arc.x0, arc.z0), (arc.x, arc.z)
    assert compute_arc_length(*ends, (arc.cx, arc.cz), is_clockwise=arc.clockwise) == pytest.approx(
        4 * pi / 2
    )


@pytest.mark.parametrize("words", ["CHF=4", "CHR=4", "RND=4"])
def test_c_motion_ends_with_the_programmed_block(words: str) -> None:
    first, cut, last = corner(words)
    assert (first.c0, first.c) == (0, 90)
    assert (cut.c0, cut.c) == (90, 90)
    assert (last.c0, last.c) == (90, 90)


def test_next_block_after_chamfer_has_its_own_c_motion() -> None:
    first, cut, last = good("G1 Z-20 C90 F100 CHR=4\nX60 C=IC(30)", AT)
    assert [b.c - b.c0 for b in (first, cut, last)] == pytest.approx([90, 0, 30])


def test_consecutive_blocks_have_no_gap() -> None:
    text = "G1 Z-20 F100 RND=3\nX60 CHF=2\nTRANS Z-5 C20\nZ-40 C=IC(9) CHR=1\nS100 M3\nX80 RND=1\nG0 Z5"
    blocks = run(text, AT).moves
    assert run(text, AT).found == []
    for before, after in pairwise(blocks):
        assert (after.x0 + after.offset_x, after.z0 + after.offset_z) == pytest.approx((before.mx, before.mz))
        assert after.c0 + after.modal.offset_c == pytest.approx(before.mc)
    assert [b.n for b in run(text, AT).blocks] == list(range(1, len(run(text, AT).blocks) + 1))


def test_collinear_lines_have_no_corner() -> None:
    passed = run("G1 Z-20 F100 CHF=4\nZ-30", AT)
    assert [each.code for each in passed.found] == ["corner-straight"]
    assert not passed.errors
    assert len(passed.moves) == 2


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G1 Z-20 F100 CHF=4", "corner-next"),
        ("G1 Z-20 F100 CHF=4\nM30", "corner-next"),
        ("G1 Z-20 F100 CHF=4\nC=IC(5)", "corner-next"),
        ("G1 Z-20 F100 RND=60\nG3 X40 Z-30 CR=10", "corner-next"),
        ("G0 Z-20 CHF=4\nX60", "corner-next"),
        ("F100 G3 X40 Z-10 CR=10 CHR=15\nG1 X60", "corner-too-large"),
        ("F100 G3 X40 Z-10 CR=10 CHF=30\nG1 X60", "corner-next"),
        ("G1 Z-20 F100 RND=25\nX60", "corner-too-large"),
        ("G1 Z-20 F100 RND=4\nX22", "corner-too-large"),
        ("G1 Z-20 F100 RND=4 CHF=1\nX22", "corner-both"),
        ("G1 Z-20 F100 RND=0\nX22", "not-positive"),
        ("G1 Z-20 F100 RND=-1\nX22", "12080"),
        ("G1 Z-20 F100 RND=1\nZ0", "corner-next"),
    ],
)
def test_invalid_corners_are_rejected(text: str, code: str) -> None:
    assert refused(text, AT).code == code


def test_rounding_is_inserted_at_an_arc() -> None:
    """From the cylinder of radius 10 out into a quarter of 10: r 2, and C ends with the first block."""
    text = "G1 Z-20 C90 F100 RND=2\nG3 X40 Z-30 CR=10 C=IC(30)\nG1 Z-40"
    first, arc, quarter, last = good(text, AT)
    assert (arc.kind, quarter.kind) == (BlockKind.ARC, BlockKind.ARC)
    assert dist((arc.x0, arc.z0), (arc.cx, arc.cz)) == pytest.approx(2.0)
    assert dist((quarter.x0, quarter.z0), (quarter.cx, quarter.cz)) == pytest.approx(10.0)
    assert [b.c - b.c0 for b in (first, arc, quarter, last)] == pytest.approx([90, 0, 30, 0])
    for before, after in pairwise((first, arc, quarter, last)):
        assert (before.x, before.z) == pytest.approx((after.x0, after.z0))


def test_rounding_after_arc_follows_change_of_offsets() -> None:
    text = "F100 G3 X30 Z-5 CR=5 RND=1\nTRANS Z-3 X2\nG1 X50 Z-2"
    quarter, arc, last = good(text, AT)
    assert quarter.kind is arc.kind is BlockKind.ARC
    assert (arc.mx, arc.mz) == pytest.approx((last.x0 + 2, last.z0 - 3))
    assert (last.mx, last.mz) == pytest.approx((27, -5))


def test_chamfer_between_cylinder_and_ball_matches_calculation() -> None:
    """Along Z to the pole side of a quarter of 10: the leg is 3 along the line and a chord of 3 on the arc.

    The quarter runs from (10, -20) to (20, -30) about (10, -30), and the chord spans 2 asin(.15) of it.
    """
    first, cut, quarter, _ = good("G1 Z-20 C90 F100 CHR=3\nG3 X40 Z-30 CR=10 C=IC(30)\nG1 Z-40", AT)
    angle = 2 * asin(0.15)
    assert (first.x, first.z) == pytest.approx((10, -17))
    assert (quarter.x0, quarter.z0) == pytest.approx((10 + 10 * sin(angle), -30 + 10 * cos(angle)))
    assert (cut.x, cut.z) == pytest.approx((quarter.x0, quarter.z0))
    assert cut.kind is BlockKind.FEED
    assert quarter.kind is BlockKind.ARC
    assert (quarter.cx, quarter.cz) == pytest.approx((10, -30))
    assert [b.c - b.c0 for b in (first, cut, quarter)] == pytest.approx([90, 0, 30])


@pytest.mark.parametrize("length", [0.5, 2.0, 5.0])
def test_chamfer_at_arc_has_length_chf_and_equal_legs(length: float) -> None:
    first, cut, quarter, _ = good(f"G1 Z-20 F100 CHF={length}\nG3 X40 Z-30 CR=10\nG1 Z-40", AT)
    assert way(cut) == pytest.approx(length, abs=1e-9)
    assert dist((quarter.x0, quarter.z0), (10, -20)) == pytest.approx(-20 * -1 + first.z, abs=1e-9)


def test_chamfer_between_two_arcs_follows_change_of_offsets() -> None:
    text = "F100 G3 X40 Z-10 CR=10 CHR=2\nTRANS Z-3 X2\nG3 X56 Z-17 CR=10"
    one, cut, other = good(text, AT)
    assert one.kind is other.kind is BlockKind.ARC
    assert cut.kind is BlockKind.FEED
    assert dist((one.mx, one.mz), (20, -10)) == pytest.approx(2)
    assert dist((other.mx - other.x + other.x0, other.mz - other.z + other.z0), (20, -10)) == pytest.approx(2)


def test_tangent_arc_has_no_corner() -> None:
    passed = run("G1 Z-20 F100 CHF=1\nG2 X40 Z-30 CR=10", AT)
    assert [each.code for each in passed.found] == ["corner-straight"]
