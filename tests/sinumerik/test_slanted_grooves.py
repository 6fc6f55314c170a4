"""CYCLE93 with flanks at an angle: where the corners of the groove are, reckoned by hand."""

from __future__ import annotations

from dataclasses import replace
from math import radians, tan

import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Severity
from tests.sinumerik.lathe import good, run, setup

HEAD = "S900 M3 G95 F0.1 T3 D1\nG0 X44 Z0\n"
WIDTH = 3.0
RUN = 5.0 * tan(radians(10.0))
"""10 degrees over 5 mm of depth: 0.882 mm."""


def grooving() -> InterpreterSetup:
    """T3 with D1 its right corner and D2 the left one, 3 mm from it."""
    return replace(setup(), tools={3: ToolOffset(), 200_003: ToolOffset(0.0, WIDTH)})


def cuts(call: str) -> list[Block]:
    """The feeds of a groove."""
    return [b for b in good(HEAD + call, grooving()) if b.line == 3 and b.kind is BlockKind.FEED]


def slants(blocks: list[Block]) -> list[tuple[float, float, float, float]]:
    """The slanted cuts: radius and Z of the right corner, from and to."""
    return [(b.x0, b.z0, b.x, b.z) for b in blocks if b.x != b.x0 and b.z != b.z0]


def test_both_flanks_slope_outward_from_groove_bottom() -> None:
    """From -10 at radius 20 to -10.882 at 15; the bottom ends at -18.882, the top at -19.763."""
    right, left = slants(cuts("CYCLE93(40,-10,8,5,,10,10,,,,,,,2,0.5,5)"))
    assert right == pytest.approx((20.0, -10.0, 15.0, -10.0 - RUN))
    assert left == pytest.approx((20.0, -18.0 - 2 * RUN + WIDTH, 15.0, -18.0 - RUN + WIDTH))


def test_first_angle_is_that_of_the_starting_side() -> None:
    """VARI 1 begins at the left: ANG1 is the left flank, and the right one is square."""
    (left,) = slants(cuts("CYCLE93(40,-20,8,5,,10,,,,,,,,2,0.5,1)"))
    assert left == pytest.approx((20.0, -20.0 + WIDTH, 15.0, -20.0 + RUN + WIDTH))
    (right,) = slants(cuts("CYCLE93(40,-20,8,5,,,10,,,,,,,2,0.5,1)"))
    assert right == pytest.approx((20.0, -12.0 + RUN, 15.0, -12.0))


def test_bore_is_grooved_outward() -> None:
    (right,) = slants(cuts("CYCLE93(60,-10,8,5,,10,,,,,,,,2,0.5,7)"))
    assert right == pytest.approx((30.0, -10.0, 35.0, -10.0 - RUN))


@pytest.mark.parametrize(("first", "second"), [(10, 10), (0, 45), (60, 20), (80, 80)])
def test_no_cut_crosses_a_flank(first: float, second: float) -> None:
    """At each depth both corners of the tool stay between the flanks, and roughing leaves 0.1 beside them."""
    call = f"CYCLE93(40,-30,8,5,,{first},{second},,,,,0.1,0.1,2,0.5,5)"
    high, low = -30.0 - 5 * tan(radians(first)), -38.0 - 5 * tan(radians(first))
    for block in cuts(call):
        for x, z in ((block.x0, block.z0), (block.x, block.z)):
            up = min(max(x, 15.0), 20.0) - 15.0
            assert z <= high + up * tan(radians(first)) + 1e-9
            assert z - WIDTH >= low - up * tan(radians(second)) - 1e-9


def test_a_wide_flank_is_roughed_in_steps() -> None:
    """60 degrees over 5 mm are 8.66 mm along Z: 4 plunges of at most 0.95 tool widths under each flank."""
    blocks = cuts("CYCLE93(40,-30,8,5,,60,60,,,,,,,,,5)")
    plunges = {(round(b.x, 3), round(b.z, 3)) for b in blocks if b.z == b.z0 and b.x < 20.0}
    assert len({x for x, _ in plunges}) == 5  # the bottom, and 1 to 4 mm above it
    assert {x for x, _ in plunges} == {15.0, 16.0, 17.0, 18.0, 19.0}


def test_tool_missing_from_table_is_assumed_standard_with_warning() -> None:
    """The machine starts nothing with it; what it would do is shown, with a warning."""
    passed = run(HEAD + "CYCLE93(40,-20,5,6,0,10,10,0,0,0,0,0.1,0.1,2,0.5,5)")
    assert {(each.code, each.severity) for each in passed.found} == {
        ("tool-offset-missing", Severity.WARNING),
        ("tool-width", Severity.WARNING),
    }
    assert min(b.x for b in passed.moves) == pytest.approx(14.0)
