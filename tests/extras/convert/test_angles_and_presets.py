"""Angles of straight moves, cancelled presets, and the position variables of LinuxCNC."""

from __future__ import annotations

import pytest

from tests.extras.convert.sources import lines_after, refused

# The tool is at X2. Z.1 before each body.


@pytest.mark.parametrize(
    ("body", "made"),
    [
        ("G01X2.2A45.", ["G95F.01X2.2Z.2"]),  # .1 per side at 45 degrees is .1 in Z
        ("G01Z-.9A135.", ["G95F.01X4Z-.9"]),  # 1 in Z toward Z- is 1 per side outward
        ("G01Z-.4,A180.", ["G95F.01Z-.4"]),
        ("G01X1.,A270.", ["G95F.01X1"]),
        ("G01U.2A-135.", ["G95F.01X2.2Z.2"]),  # the line is the same in both directions
    ],
)
def test_angle_gives_the_other_coordinate(body: str, made: list[str]) -> None:
    assert lines_after(body) == made


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("G01A45.", (1, 4, "angle-word")),
        ("G01X3.Z-1.A45.", (1, 11, "angle-word")),
        ("G01X3.A0", (1, 7, "angle-word")),
        ("G01Z-1.A90.", (1, 8, "angle-word")),
        ("G00X3.A45.", (1, 7, "c-axis")),
    ],
)
def test_angle_without_an_end_point_is_rejected(body: str, found: tuple[int, int, str]) -> None:
    assert refused(body) == found


def test_cancelled_preset_restores_the_position() -> None:
    # At Z.1, G92 Z0 shifts by .1. After the move to Z-.5, the tool is at Z-.4 without the preset.
    made = lines_after("G92Z0\nG1Z-.5\nG92.1\nG1Z0", "linuxcnc")
    assert made == ["G92X2Z0", "G95F.01Z-.5", "G92X2Z-.4", "Z0"]


def test_preset_with_an_unknown_shift_cannot_be_cancelled() -> None:
    assert refused("T2M6\nG92X1Z0\nG92.1\nG1Z0", "linuxcnc") == (3, 1, "preset-cancelled")
    assert refused("G92X1Z0\nT2M6\nG0X2Z1\nG92.1\nG1Z0", "linuxcnc")[2] == "preset-cancelled"


def test_position_variables_follow_the_moves() -> None:
    assert lines_after("G1X[#<_x>-.5]\nG8\nX[#<_x>-.25]\nZ[#5422-1]", "linuxcnc") == [
        "G95F.01X1.5", "X1", "Z-.9",
    ]  # fmt: skip
    assert refused("T2M6\nG0X[#<_x>]", "linuxcnc") == (2, 5, "variable")
