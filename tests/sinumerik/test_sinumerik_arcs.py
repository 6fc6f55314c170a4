"""G2 and G3: centre, radius, opening angle; seen with X up G2 turns clockwise."""

from __future__ import annotations

from math import dist, pi

import pytest

from core.geometry.lines_and_arcs import compute_arc_length
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.sinumerik.lathe import good, refused, setup


def arc(text: str, start: tuple[float, float] = (10.0, 0.0)) -> Block:
    (block,) = good(f"F100 {text}", setup(start=(*start, 0.0)))
    assert block.kind is BlockKind.ARC
    return block


def centre(block: Block) -> tuple[float, float]:
    return block.cx, block.cz


def length(block: Block) -> float:
    return compute_arc_length(
        (block.x0, block.z0), (block.x, block.z), centre(block), is_clockwise=block.clockwise
    )


QUARTERS = [  # a ball of radius 10 from its tip, as every book of turning has it: out along X+ and Z-
    "G3 X20 Z-10 CR=10",
    "G3 X20 Z-10 I0 K-10",
    "G3 X20 Z-10 K-10",
    "G3 X20 Z-10 I=AC(0) K=AC(-10)",
    "G3 X20 Z-10 AR=90",
    "G3 K-10 AR=90",
    "G91 G3 X20 Z-10 CR=10",
    "DIAMOF G3 X10 Z-10 I=AC(0) K-10",
    "G3 X=IC(20) Z=AC(-10) CR=10",
]


@pytest.mark.parametrize("text", QUARTERS)
def test_same_quarter_arc_can_be_programmed_in_several_forms(text: str) -> None:
    block = arc(text, (0.0, 0.0))
    assert (block.x, block.z) == pytest.approx((10, -10))
    assert centre(block) == pytest.approx((0, -10), abs=1e-9)
    assert length(block) == pytest.approx(10 * pi / 2)
    assert block.clockwise  # with X down, as blocks are seen


def test_opposite_direction_is_g2() -> None:
    block = arc("G2 X20 Z-10 CR=10", (0.0, 0.0))
    assert centre(block) == pytest.approx((10, 0), abs=1e-9)
    assert not block.clockwise


def test_negative_radius_gives_the_longer_arc() -> None:
    block = arc("G3 X20 Z-10 CR=-10", (0.0, 0.0))
    assert length(block) == pytest.approx(10 * pi * 1.5)
    assert dist(centre(block), (block.x, block.z)) == pytest.approx(10)


@pytest.mark.parametrize("angle", [30.0, 90.0, 179.0, 181.0, 270.0, 300.0])
@pytest.mark.parametrize("code", [2, 3])
def test_opening_angle_defines_arc(angle: float, code: int) -> None:
    block = arc(f"G{code} X26 Z-7 AR={angle}")
    radius = dist(centre(block), (block.x, block.z))
    assert dist(centre(block), (block.x0, block.z0)) == pytest.approx(radius)
    assert length(block) == pytest.approx(radius * angle / 180 * pi)


@pytest.mark.parametrize("angle", [30.0, 200.0])
@pytest.mark.parametrize("code", [2, 3])
def test_opening_angle_and_center_define_arc(angle: float, code: int) -> None:
    block = arc(f"G{code} I3 K-4 AR={angle} C=IC(20)")
    assert dist(centre(block), (block.x, block.z)) == pytest.approx(5)
    assert length(block) == pytest.approx(5 * angle / 180 * pi)
    assert block.c == pytest.approx(20)


def test_full_circle_has_full_circumference() -> None:
    assert length(arc("G3 I5 K0")) == pytest.approx(10 * pi)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G3 X40 Z-10", "arc-centre-missing"),
        ("G3 X40 Z-10 AR=0", "arc-angle"),
        ("G3 X40 Z-10 AR=360", "arc-angle"),
        ("G3 X40 Z-10 CR=5", "arc-radius"),
        ("G3 X40 Z-10 CR=15 I3", "arc-both"),
        ("G3 X40 Z-10 CR=15 AR=30", "arc-both"),
        ("G3 X40 Z-10 AR=30 I2", "arc-both"),
        ("G3 X20 Z0 CR=15", "arc-no-chord"),
        ("G3 AR=30", "arc-centre-missing"),
        ("G3 X40 Z-10 I7 K0", "14040"),
        ("G3 X40 Z-10 I0 K0", "arc-radius"),
        ("G3 C90", "arc-centre-missing"),
    ],
)
def test_invalid_arcs_are_rejected(text: str, code: str) -> None:
    error = refused(f"N20 F100 {text}", setup(start=(10.0, 0.0, 0.0)))
    assert error.code == code
    assert "block N20" in error.message


def test_offsets_move_center_with_the_arc() -> None:
    (block,) = good("F100\nTRANS X5 Z7\nG3 X20 Z-10 K=AC(-10) I=AC(0)", setup(start=(5.0, 7.0, 0.0)))
    assert centre(block) == pytest.approx((0, -10))
    assert (block.mx, block.mz) == pytest.approx((15, -3))
