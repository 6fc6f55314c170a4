"""The cycles G70 to G72 of LinuxCNC, calculated by hand, and contours that are rejected."""

from __future__ import annotations

import pytest

from tests.extras.convert.sources import lines_after, refused

STEP = "O100 SUB\nG0 X1\nG1 Z-.5\nX2\nO100 ENDSUB\n"


def test_g71_roughs_in_steps_of_i_and_follows_the_contour() -> None:
    # From X2. to X1. at .25 per side: X2, X1.5, and then the contour. The passes end at the shoulder Z-.5 and
    # retract by .1 at 45 degrees.
    assert lines_after(f"{STEP}G71 Q100 X2 Z.1 D0 I.25 R.1", "linuxcnc") == [
        "G95F.01Z-.5", "G00X2.2Z-.4", "Z0", "X2Z.1",
        "X1.5", "G95F.01Z-.5", "G00X1.7Z-.4", "Z0", "X1.5Z.1",
        "X1", "G95F.01Z-.5", "X2",
    ]  # fmt: skip


def test_g70_finishes_from_distance_d_to_distance_e() -> None:
    # The distances are (.02 - 0) / 2 = .01 and 0 per side. At the inner corner, the lines meet.
    assert lines_after(f"{STEP}G70 Q100 X2 Z.1 D.02 E0 P2", "linuxcnc") == [
        "X1.02", "G95F.01Z-.49", "X2", "G00Z.1", "X1", "G95F.01Z-.5", "X2",
    ]  # fmt: skip


def test_outer_corner_becomes_an_arc_at_a_distance() -> None:
    # From X1. a shoulder at Z-.5 to X1.5, then along Z; .05 outside, the corner has the radius .05.
    contour = "O100 SUB\nG0 X1\nG1 Z-.5\nX1.5\nZ-1\nX2\nO100 ENDSUB\n"
    assert lines_after(f"{contour}G70 Q100 X2 Z.1 D.05 E.05", "linuxcnc") == [
        "X1.1", "G95F.01Z-.45", "X1.5", "G02X1.6Z-.5I0K-.05", "Z-.95", "X2",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (f"{STEP}G71", (6, 1, "cycle-word")),
        (f"{STEP}G71 Q7", (6, 5, "subprogram")),
        (f"{STEP}G71 Q100 I0", (6, 10, "cycle-positive")),
        (f"{STEP}G71 Q100 D-.1", (6, 10, "cycle-positive")),
        (f"{STEP}G71 Q100 I.0001", (6, 1, "too-many-passes")),
        (f"{STEP}G71 Q100 U.1", (6, 10, "code-unknown")),
        (f"{STEP}G71.2 Q100", (6, 1, "code-unknown")),
        (f"{STEP}G91\nG71 Q100", (7, 1, "cycle-incremental")),
        (f"{STEP}G17\nG71 Q100", (7, 1, "plane")),
        (f"{STEP}G41\nG71 Q100", (7, 1, "comp-cycle")),
        (f"{STEP}G71 Q100 X.5", (6, 1, "cycle-start")),
        (f"{STEP}G71 Q100 D.6", (6, 10, "cycle-offset")),
        (f"{STEP}G71 Q100\nX3", (7, 1, "motion-missing")),
        (f"{STEP}G70 Q100 P0", (6, 10, "cycle-positive")),
        (f"{STEP.replace('X2', 'X2 A.1')}G71 Q100", (4, 4, "code-unknown")),
        (f"{STEP.replace('X2', 'G2 X2 Z-1')}G71 Q100", (4, 1, "arc-centre")),
        (f"{STEP.replace('X2', 'G2 X2 Z-1 I.1')}G71 Q100", (4, 1, "arc-radius")),
        (f"{STEP.replace('X2', 'G2 X2 Z-1 R.1')}G71 Q100", (4, 11, "arc-too-small")),
        (f"{STEP.replace('X2', 'X2 Z-.3')}G71 Q100", (6, 1, "cycle-undercut")),
        (f"{STEP.replace('X2', 'X.8 Z-.7')}G71 Q100", (6, 1, "cycle-undercut")),
        ("O100 SUB\nO100 ENDSUB\nG71 Q100", (3, 1, "cycle-empty")),
    ],
)
def test_contour_that_cannot_be_converted_is_rejected(text: str, found: tuple[int, int, str]) -> None:
    assert refused(text, "linuxcnc") == found
