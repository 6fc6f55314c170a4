"""Arcs in Y and Z, and in Z and X, by hand: where posts lead a mill to a contour and off it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.klartext.running import Ran, run
from tests.klartext.test_path_functions import end, on_the_way

HALF = math.sqrt(0.5)


def arcs(text: str, start: str = "L X+1 Y+2 Z+3 FMAX M3") -> Ran:
    ran = run(f"{start}\n{text}")
    assert ran.codes == []
    return ran


@pytest.mark.parametrize(
    ("text", "middle", "stop", "length"),
    [
        # From the right of a pole in Y and Z down; Y to the right, Z up.
        ("CC Y+0 Z+3\nCP IPA-90 DR- F100", (1, 2 * HALF, 3 - 2 * HALF), (1, 0, 1), math.pi),
        ("CC Y+0 Z+3\nC Y+0 Z+1 DR- F100", (1, 2 * HALF, 3 - 2 * HALF), (1, 0, 1), math.pi),
        ("CC Y+0 Z+3\nC Y+0 Z+1 DR+ F100", (1, -2 * HALF, 3 + 2 * HALF), (1, 0, 1), 3 * math.pi),
        ("CC Z+3 Y+0\nCP PA+90 DR+ F100", (1, 2 * HALF, 3 + 2 * HALF), (1, 0, 5), math.pi),
        # Z and X: Z to the right, X up; from above a pole at X-3 to its right.
        ("CC X-3 Z+3\nCP IPA-90 DR- F100", (-3 + 4 * HALF, 2, 3 + 4 * HALF), (-3, 2, 7), 2 * math.pi),
        ("CC X-3 Z+3\nC X-3 Z+7 DR- F100", (-3 + 4 * HALF, 2, 3 + 4 * HALF), (-3, 2, 7), 2 * math.pi),
        # A helix along the third axis.
        ("CC Y+0 Z+3\nCP IPA-180 IX+6 DR- F100", (4, 0, 1), (7, -2, 3), math.hypot(2 * math.pi, 6)),
    ],
)
def test_arc_in_vertical_plane_has_its_end_and_length(
    text: str, middle: tuple[float, ...], stop: tuple[float, ...], length: float
) -> None:
    block = next(block for block in arcs(text).blocks if block.kind is BlockKind.PLANE_ARC)
    assert np.allclose(on_the_way(block, 3)[1], middle)
    assert end(block) == pytest.approx(stop)
    assert block.length == pytest.approx(length)


def test_vertical_arc_is_mirrored_rotated_and_scaled() -> None:
    """Mirrored in X, then turned by 90 degrees: X' is -Y; half as large."""
    told = "TRANS MIRROR AXIS X\nTRANS ROTATION ROT+90\nTRANS SCALE SCL0.5\nCC X-3 Z+3\nCP IPA-90 DR- F100"
    ran = run(f"L X+0 Y+0 Z+0 FMAX M3\n{told.replace('CC', 'L X+1 Y+2 Z+3 FMAX{0}CC').format(chr(10))}")
    assert ran.codes == []
    block = next(block for block in ran.blocks if block.kind is BlockKind.PLANE_ARC)
    x, y, z = -3 + 4 * HALF, 2.0, 3 + 4 * HALF
    assert np.allclose(on_the_way(block, 3)[1], (-y / 2, -x / 2, z / 2))
    assert end(block) == pytest.approx((-1.0, 1.5, 3.5))


def test_vertical_arc_in_tilted_plane_is_followed_by_axes() -> None:
    """A 90: the plane's Z is the workpiece's -Y; the slides go the arc as it stands in the plane."""
    tilted = arcs("PLANE AXIAL A+90 TURN FMAX\nL X+1 Y+2 Z+3 FMAX\nCC Y+0 Z+3\nCP IPA-90 DR- F100")
    block = next(block for block in tilted.blocks if block.kind is BlockKind.PLANE_ARC)
    before = tilted.blocks[tilted.blocks.index(block) - 1]
    moved = np.subtract(
        [tilted.axes(block)[name] for name in "XYZ"], [tilted.axes(before)[name] for name in "XYZ"]
    )
    assert np.allclose(moved, (0.0, -2.0, -2.0))


def test_polar_point_is_in_plane_of_its_pole() -> None:
    ran = arcs("CC Y+0 Z+0\nLP PR+10 PA+30 F100")
    assert end(ran.blocks[-2]) == pytest.approx((1.0, 10 * math.cos(math.radians(30)), 5.0))


def test_pole_with_one_axis_stays_in_its_plane() -> None:
    ran = arcs("CC Y+0 Z+3\nCC Y+0\nCP IPA-90 DR- F100")
    assert end(ran.blocks[-2]) == pytest.approx((1.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("L X+5 RL F100\nCC Y+0 Z+3\nCP IPA-90 DR-\nL R0 X+9", "Radius compensation not permitted here"),
        ("CC Y+0 Z+3\nCP IPA-90 DR- RL F100", "Radius compensation not permitted here"),
        ("CC Y+0 Z+3\nCP IPA-90 DR- F100\nRND R1\nL X+9", "Rounding not possible"),
        ("CC Y+0 Z+3\nCP IPA-90 DR- F100\nCT X+9 Y+9", "Path function not possible here"),
        ("CC Y+0 Z+3\nC Y+0 Z+1.5 DR- F100", "Circle end point incorrect"),
        ("CC Y+2 Z+3\nCP IPA+90 DR+ F100", "Circle end point incorrect"),
    ],
)
def test_invalid_vertical_arc_is_rejected(text: str, code: str) -> None:
    assert run(f"L X+1 Y+2 Z+3 FMAX M3\n{text}").codes[:1] == [code]
