"""G74: passes, what is left, all four quadrants, and what is refused. Figures in inches."""

from __future__ import annotations

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.interpreter.programs import INCH, body, passed


def cuts(*each: str) -> list[float]:
    """X of each pass along Z."""
    result = passed(body(*each))
    assert result.errors == []
    return [round(b.x / INCH, 5) for b in result.moves if b.kind is BlockKind.FEED and b.z != b.z0]


def test_g74_makes_one_pass_move_by_move() -> None:
    """S .5 .1, corner .45 -.2: one pass of .05, drawn back .02, home."""
    result = passed(body("X.5Z.1", "G74X.45Z-.2I.06F4"))
    assert [(b.text, str(b.kind)) for b in result.moves[1:]] == [
        ("X.45", "feed"), ("Z-.2", "feed"), ("G00X.47", "rapid"), ("G00Z.1", "rapid"), ("G00X.5", "rapid"),
    ]  # fmt: skip
    assert {b.line for b in result.moves[1:]} == {4}


def test_g74_passes_are_equal_and_do_not_exceed_i() -> None:
    """.1 in passes of .03 at most: four of .025."""
    assert cuts("X.5Z.1", "G74X.4Z-.2I.03F4") == [0.475, 0.45, 0.425, 0.4]


def test_whole_number_of_passes_leaves_no_extra_pass() -> None:
    assert cuts("X.5Z.1", "G74X.2Z-.2I.1F4") == [0.4, 0.3, 0.2]


def test_g74_allowance_u_is_per_side_in_x_only() -> None:
    result = passed(body("G72", "X1Z.1", "G74X.8Z-.2I.05U.02F4"))
    assert {round(b.x / INCH, 5) for b in result.moves if b.z == pytest.approx(-0.2 * INCH)} >= {0.46, 0.42}
    assert min(b.x for b in result.moves) == pytest.approx(0.42 * INCH)
    assert min(b.z for b in result.moves) == pytest.approx(-0.2 * INCH)


def test_g74_depth_i_is_per_side_in_diameter_mode() -> None:
    assert cuts("G72", "X1Z.1", "G74X.8Z-.2I.05F4") == [0.45, 0.4]


def test_g74_corner_is_incremental_under_g91() -> None:
    assert cuts("X.5Z.1", "G91G74X-.1Z-.3I.05F4") == [0.45, 0.4]
    assert cuts("G72", "X1Z.1", "G91G74X-.2Z-.3I.05F4") == [0.45, 0.4]


@pytest.mark.parametrize("x", [1, -1])
@pytest.mark.parametrize("outwards", [1, -1])
@pytest.mark.parametrize("z", [1, -1])
def test_g74_works_in_all_quadrants(x: int, outwards: int, z: int) -> None:
    """Outside and inside, from the front and the back, to both sides of Z."""
    corner = 0.5 + outwards * 0.1
    result = passed(body(f"X{x * 0.5}Z0", f"G74X{x * corner}Z{z * 0.3}I.05U.02F4"))
    assert result.errors == []
    passes = [b for b in result.moves if b.kind is BlockKind.FEED and b.z != b.z0]
    assert [b.x / INCH for b in passes] == pytest.approx([x * (0.5 + outwards * d) for d in (0.04, 0.08)])
    assert [b.z / INCH for b in passes] == pytest.approx([z * 0.3] * 2)
    backs = [b.x / INCH for b in result.moves[1:] if b.kind is BlockKind.RAPID and b.z == b.z0]
    assert backs == pytest.approx([x * (0.5 + outwards * d) for d in (0.02, 0.06)] + [x * 0.5])
    assert result.ends[-1] == (x * 0.5, 0)


def test_g74_return_is_lifted_off_the_cut() -> None:
    result = passed(body("X.5Z.1", "G74X.4Z-.2I.03F4"))
    level = 0.5
    for block in result.moves[1:]:
        if block.kind is BlockKind.FEED:
            level = block.x / INCH
        elif block.z != block.z0:
            assert block.x / INCH == pytest.approx(level + 0.02)


@pytest.mark.parametrize(
    ("cycle", "error"),
    [
        ("G74Z-.2I.05F4", (4, 1, "word-missing")),
        ("G74X.4I.05F4", (4, 1, "word-missing")),
        ("G74X.4Z-.2F4", (4, 1, "word-missing")),
        ("G74X.4Z-.2I0F4", (4, 11, "cycle-length")),
        ("G74X.4Z-.2I-.05F4", (4, 11, "cycle-length")),
        ("G74X.4Z-.2I.05U-.01F4", (4, 15, "cycle-length")),
        ("G74X.5Z-.2I.05F4", (4, 4, "cycle-nothing")),
        ("G74X.4Z.1I.05F4", (4, 7, "cycle-nothing")),
        ("G74X.4Z-.2I.05U.1F4", (4, 15, "cycle-nothing")),
        ("G74X.4Z-.2I.05", (4, 1, "feed-missing")),
        ("G74X.4Z-.2I.05K.1F4", (4, 15, "word-unused")),
        ("G74X-1Z-.2I.0001F4", (4, 11, "cycle-passes")),
    ],
)
def test_invalid_g74_is_rejected(cycle: str, error: tuple[int, int, str]) -> None:
    result = passed(body("X.5Z.1", cycle))
    assert result.errors[0] == error
    assert all(block.line < 4 for block in result.blocks)
