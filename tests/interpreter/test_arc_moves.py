"""G02 and G03: centres worked out by hand, seen from above with X+ down and Z+ right."""

from __future__ import annotations

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.interpreter.programs import INCH, body, passed, setup

QUARTER = ("X.1Z0F20", "G02X.25Z-.15R.15")


@pytest.mark.parametrize(
    ("program", "centre", "clockwise"),
    [
        (QUARTER, (0.1, -0.15), True),
        (("X.1Z0F20", "G03X.25Z-.15R.15"), (0.25, 0), False),
        (("X.1Z0F20", "G02X.25Z-.15I.1K-.15"), (0.1, -0.15), True),
        (("G72X.2Z0F20", "G02X.5Z-.15I0K-.15"), (0.1, -0.15), True),
        (("G72X.2Z0F20", "G02X.5Z-.15K-.15"), (0.1, -0.15), True),  # I missing: 0
        (("X.1Z0F20", "G91G02X.15Z-.15K-.15"), (0.1, -0.15), True),
        (("G72X.2Z-.3F20", "G03X.4Z-.4I.1K0"), (0.2, -0.3), False),
        (("X.2Z-.2F20", "G02Z-.5R.635"), (-0.41703, -0.35), True),
        (("X0Z0F20", "G02X0Z0I1K0"), (1, 0), True),  # a full circle
        (("X0Z0F20", "G03I0K-.5"), (0, -0.5), False),
        (("X0Z0F20", "G02Z-1R.5"), (0, -0.5), True),  # 180 degrees
        (("X0Z0F20", "G02Z-1R.4998"), (0, -0.5), True),  # .0004 short of the chord
    ],
)
def test_arc_center_is_calculated(
    program: tuple[str, ...], centre: tuple[float, float], clockwise: bool
) -> None:
    result = passed(body(*program))
    assert result.errors == []
    arc = result.moves[-1]
    assert (arc.kind, arc.clockwise) == (BlockKind.ARC, clockwise)
    assert (arc.cx / INCH, arc.cz / INCH) == pytest.approx(centre, abs=6e-6)


def test_arc_end_stays_as_programmed_if_the_radii_differ_slightly() -> None:
    result = passed(body("X.1Z0F20", "G02X.2504Z-.15I.1K-.15"))
    assert result.errors == []
    assert result.ends[-1] == (0.2504, -0.15)
    assert (result.moves[-1].cx / INCH, result.moves[-1].cz / INCH) == pytest.approx((0.1, -0.15))


def test_arc_word_applies_to_one_block() -> None:
    result = passed(body(*QUARTER, "X.5Z-.3"))
    assert [block.kind for block in result.moves] == [BlockKind.FEED, BlockKind.ARC, BlockKind.FEED]


def test_constant_secondary_offset_shifts_the_center() -> None:
    program = ("X.1Z0D1F20", "G02X.25Z-.15I.1K-.15")
    result = passed(body(*program), setup(secondary={1: (-0.01, 0.02)}))
    arc = result.moves[-1]
    assert result.errors == []
    assert (arc.cx / INCH, arc.cz / INCH) == pytest.approx((0.09, -0.13))
    assert result.ends[-1] == (0.24, -0.13)


def test_arc_uses_feed_and_rapid_like_a_line() -> None:
    assert passed(body("G95F.003X.1Z0", "G02X.25Z-.15R.15")).feeds[-1] == ("arc", 0.003)
    assert passed(body("F20X.1Z0", "G00G02X.25Z-.15R.15")).feeds[-1] == ("arc", 300)


def test_slow_arc_warning_uses_its_length() -> None:
    # a full circle of radius 1 in is 6.28 in: 37.7 s at 10 in/min
    assert passed(body("X0Z0F10", "G02I1K0")).warnings == [(4, 0, "feed-low")]
    assert passed(body("X0Z0F10", "G02Z-1R.5")).warnings == []


def test_invalid_arc_message_shows_both_radii() -> None:
    (error,) = passed(body("X.1Z0F20", "G02X.3Z-.15I.1K-.15")).interpreter.diagnostics
    assert error.code == "arc-radius"
    assert "0.15000 in" in error.message
    assert "0.20000 in" in error.message


def test_invalid_metric_arc_message_shows_both_radii_in_millimeters() -> None:
    (error,) = passed(body("G71X10Z0F500", "G02X30Z-15I10K-15")).interpreter.diagnostics
    assert "15.0000 mm" in error.message
    assert "20.0000 mm" in error.message


@pytest.mark.parametrize(
    ("arc", "expected"),
    [
        ("G02X.25Z-.15I.1K-.15", []),  # 90 degrees
        ("G03X.25Z-.15I.1K-.15", [(4, 1, "arc-over-half")]),  # the other way: 270
        ("G02X.1Z-.3I.1K-.15", []),  # half a circle
        ("G02X.1Z0I.1K-.15", []),  # a whole one is meant
    ],
)
def test_arc_over_half_a_circle_raises_a_warning(arc: str, expected: list[tuple[int, int, str]]) -> None:
    result = passed(body("X.1Z0F20", arc))
    assert [each for each in result.warnings if each[2] == "arc-over-half"] == expected
