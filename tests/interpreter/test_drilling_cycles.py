"""G81 and G83: depths, ways out, and what is refused. Figures in inches, worked out by hand."""

from __future__ import annotations

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.interpreter.programs import INCH, body, in_feed, passed, setup


def drilled(*each: str) -> list[tuple[str, float]]:
    """(kind, z) of each move after the one to the start point X0 Z.1, line 3."""
    result = passed(body("X0Z.1", *each))
    assert result.errors == []
    return [(str(b.kind), round(b.z / INCH, 5)) for b in result.moves if b.line > 3]


def test_g81_drills_hole_in_one_pass() -> None:
    result = passed(body("X0Z.1", "G95G81Z-.3F.004"))
    way_in, way_out = result.moves[1:]
    assert (way_in.kind, way_in.per_rev, in_feed(way_in), way_in.line) == (BlockKind.FEED, True, 0.004, 4)
    assert (way_out.kind, way_out.per_rev, in_feed(way_out)) == (BlockKind.RAPID, False, pytest.approx(300))
    assert [b.text for b in (way_in, way_out)] == ["Z-.3", "G00Z.1"]
    assert result.ends[1:] == [(0, -0.3), (0, 0.1)]


def test_g81_depth_is_incremental_under_g91() -> None:
    result = passed(body("X0Z.1", "G91G81Z-.3F4"))
    assert result.ends[1:] == [(0, -0.2), (0, 0.1)]
    assert [b.text for b in result.moves[1:]] == ["Z-.3", "G00Z.3"]


def test_x_word_of_drilling_cycle_positions_first() -> None:
    result = passed(body("G72", "X.5Z.1", "G81X.2Z-.3F4"))
    assert result.ends[1:] == [(0.1, 0.1), (0.1, -0.3), (0.1, 0.1)]
    assert [str(b.kind) for b in result.moves[1:]] == ["rapid", "feed", "rapid"]
    assert result.moves[1].text == "G00X.2"


def test_g83_pecks_use_default_retract_and_clearance() -> None:
    """Pecks of .25 from .1 to -.5: -.15, -.4, -.5; out to the start, back to .02 before the depth."""
    assert drilled("G83Z-.5K.25F4") == [
        ("feed", -0.15), ("rapid", 0.1), ("rapid", -0.13),
        ("feed", -0.4), ("rapid", 0.1), ("rapid", -0.38),
        ("feed", -0.5), ("rapid", 0.1),
    ]  # fmt: skip


def test_g83_rapids_at_200_unless_l_word_sets_rate() -> None:
    for word, rate in (("", 200), ("L150", 150)):
        result = passed(body("X0Z.1", f"G83Z-.1K.1F4{word}"))
        rapids = [in_feed(b) for b in result.moves[1:] if b.kind is BlockKind.RAPID]
        assert rapids == [pytest.approx(rate)] * len(rapids)


def test_g83_pecks_in_metric_mode() -> None:
    """Millimetres: 10 deep in pecks of 4, clearance .02 in = .508 mm, L in mm/min."""
    result = passed("G90G71G94F3000\nM03S1000\nX0Z1\nG83Z-9K4F100L1200\nM30\n")
    assert result.errors == []
    assert [round(b.z, 4) for b in result.moves[1:]] == [-3, 1, -2.492, -7, 1, -6.492, -9, 1]
    assert {round(b.feed * 60, 6) for b in result.moves[1:] if b.kind is BlockKind.RAPID} == {1200}


def test_g83_distances_under_g91_count_from_start() -> None:
    result = passed(body("X0Z.1", "G91G83Z-.3K.2R.4C.05F4"))
    assert [z for _, z in result.ends[1:]] == [-0.1, 0.5, -0.05, -0.2, 0.5, 0.1]


def test_peck_deeper_than_hole_drills_to_hole_depth() -> None:
    assert drilled("G83Z-.1K5F4") == [("feed", -0.1), ("rapid", 0.1)]


def test_whole_number_of_pecks_leaves_no_extra_peck() -> None:
    """.1 to -.2 in pecks of .1: three, although .3/.1 is a little more than 3 in binary."""
    assert [z for kind, z in drilled("G83Z-.2K.1F4") if kind == "feed"] == [0, -0.1, -0.2]


def test_clearance_beyond_retract_needs_no_return_rapid() -> None:
    assert drilled("G83Z-.5K.3C1F4") == [
        ("feed", -0.2), ("rapid", 0.1), ("feed", -0.5), ("rapid", 0.1),
    ]  # fmt: skip


def test_a_secondary_offset_moves_the_hole() -> None:
    result = passed(body("X0Z.1D1", "G81Z-.3F4"), setup(secondary={1: (0.0, -0.01)}))
    assert result.ends == [(0, 0.09), (0, -0.31), (0, 0.09)]
    assert result.moves[1].text == "Z-.3"


def test_feed_mode_of_drilling_cycle_remains_after_cycle() -> None:
    result = passed(body("X0Z.1", "G95G81Z-.3F.004", "Z-.05"))
    assert result.feeds[-1] == ("feed", 0.004)
    assert result.ends[-1] == (0, -0.05)


def test_the_coolant_of_the_line_starts_before_the_drill() -> None:
    result = passed(body("X0Z.1", "G81Z-.3F4M08"))
    assert [(b.text, b.moves) for b in result.blocks if b.line == 4] == [
        ("M08", False), ("Z-.3", True), ("G00Z.1", True),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("cycle", "error"),
    [
        ("G81F4", (4, 1, "word-missing")),
        ("G81Z.1F4", (4, 4, "cycle-depth")),
        ("G81Z.5F4", (4, 4, "cycle-depth")),
        ("G91G81Z.3F4", (4, 7, "cycle-depth")),
        ("G81Z-1", (4, 1, "feed-missing")),
        ("G00G81Z-1", (4, 4, "feed-missing")),
        ("G81Z-1K.1F4", (4, 7, "word-unused")),
        ("G81Z-1D1F4", (4, 7, "word-unused")),
        ("G83Z-1F4", (4, 1, "word-missing")),
        ("G83K.1F4", (4, 1, "word-missing")),
        ("G83Z-1K0F4", (4, 7, "cycle-length")),
        ("G83Z-1K-.1F4", (4, 7, "cycle-length")),
        ("G83Z.1K.1F4", (4, 4, "cycle-depth")),
        ("G83Z-1K.00005F4", (4, 7, "cycle-passes")),
        ("G83Z-1K.1C0F4", (4, 10, "cycle-length")),
        ("G83Z-1K.1C-.1F4", (4, 10, "cycle-length")),
        ("G83Z-1K.1R-.5F4", (4, 10, "cycle-retract")),
        ("G83Z-1K.1L0F4", (4, 10, "cycle-rate")),
        ("G83Z-1K.1L301F4", (4, 10, "cycle-rate")),
        ("G83Z-1K.1I.1F4", (4, 10, "word-unused")),
        ("G81G83Z-1F4", (4, 4, "two-one-shots")),
        ("G95G81Z-1", (4, 4, "feed-missing")),
    ],
)
def test_invalid_drilling_cycle_is_rejected(cycle: str, error: tuple[int, int, str]) -> None:
    result = passed(body("X0Z.1", cycle))
    assert result.errors[0] == error
    assert all(block.line < 4 for block in result.blocks)


def test_feed_per_rev_with_stopped_spindle_is_rejected() -> None:
    result = passed(body("M05", "X0Z.1", "G95G81Z-1F.004"))
    assert result.errors == [(5, 0, "spindle-stopped")]


def test_drilling_cycle_as_first_move_of_tool_is_rejected() -> None:
    result = passed(body("X0Z.1", "T2", "G81Z-1F4"))
    assert result.errors == [(5, 1, "tool-first-move")]


def test_lines_after_rejected_cycle_are_checked_from_cycle_start() -> None:
    result = passed(body("X0Z.1", "G83Z-1F4", "G91G81Z-.1F4"))
    assert result.errors == [(4, 1, "word-missing")]


@pytest.mark.parametrize(
    ("peck", "expected"),
    [("2", [(4, 8, "peck-depth")]), (".6", []), (".2", [])],  # from Z.1 to Z-.5 are .6
)
def test_peck_deeper_than_hole_causes_warning(peck: str, expected: list[tuple[int, int, str]]) -> None:
    assert passed(body("X0Z.1", f"G83Z-.5K{peck}F4")).warnings == expected
