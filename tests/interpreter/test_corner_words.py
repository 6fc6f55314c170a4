"""C and R on straight moves: what is cut where lines meet, and what is refused. Inches."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt, tan

import pytest

from core.interpreter.shared.actions import CoolantSwitch
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.interpreter.programs import INCH, Pass, body, lines, passed, setup
from tests.texts import text


@dataclass(frozen=True)
class Cut:
    """A move as the operator sees it."""

    line: int
    text: str
    x: float
    z: float


def cuts(result: Pass) -> list[Cut]:
    assert result.errors == []
    return [Cut(b.line, b.text, round(b.x / INCH, 5), round(b.z / INCH, 5)) for b in result.moves]


HEAD = "X.2Z0F9"


def test_chamfer_size_is_per_side_in_radius_mode() -> None:
    assert cuts(passed(body(HEAD, "X.5C.03", "Z-.4"))) == [
        Cut(3, "X.2Z0F9", 0.2, 0),
        Cut(4, "X.47", 0.47, 0),
        Cut(4, "X.5Z-.03", 0.5, -0.03),
        Cut(5, "Z-.4", 0.5, -0.4),
    ]


def test_chamfer_size_is_per_side_in_diameter_mode() -> None:
    assert cuts(passed(body("G72", HEAD, "X.5C.03", "Z-.4")))[1:] == [
        Cut(5, "X.44", 0.22, 0),
        Cut(5, "X.5Z-.03", 0.25, -0.03),
        Cut(6, "Z-.4", 0.25, -0.4),
    ]


def test_corner_radius_in_diameter_mode() -> None:
    result = passed(body("G72", "X.2Z-.35F9", "X.5R.025", "Z-.45"))
    assert cuts(result)[1:] == [
        Cut(5, "X.45", 0.225, -0.35),
        Cut(5, "G02X.5Z-.375R.025", 0.25, -0.375),
        Cut(6, "Z-.45", 0.25, -0.45),
    ]
    arc = result.moves[2]
    assert (arc.kind, arc.clockwise) == (BlockKind.ARC, True)
    assert (arc.cx / INCH, arc.cz / INCH) == pytest.approx((0.225, -0.375))


def test_corner_radius_direction_follows_turn_of_contour() -> None:
    result = passed(body("X.5Z0F9", "Z-.4R.1", "X.9"))
    assert cuts(result)[1:] == [
        Cut(4, "Z-.3", 0.5, -0.3),
        Cut(4, "G03X.6Z-.4R.1", 0.6, -0.4),
        Cut(5, "X.9", 0.9, -0.4),
    ]


def test_corner_words_in_incremental_mode() -> None:
    result = passed(body(HEAD, "G91", "X.3C.03", "Z-.4", "X.1"))
    assert cuts(result)[1:] == [
        Cut(5, "X.27", 0.47, 0),
        Cut(5, "X.03Z-.03", 0.5, -0.03),
        Cut(6, "Z-.37", 0.5, -0.4),  # what is left of the way of .4
        Cut(7, "X.1", 0.6, -0.4),
    ]


def test_corner_radius_in_metric_mode() -> None:
    result = passed(body("G71", "X10Z0F200", "X20R2.5", "Z-10"))
    assert [cut.text for cut in cuts(result)] == ["X10Z0F200", "X17.5", "G02X20Z-2.5R2.5", "Z-10"]


def test_corner_radius_between_lines_at_45_degrees() -> None:
    back = 0.1 * tan(0.39269908169872414)  # half of 45 degrees
    result = cuts(passed(body("X.5Z0F9", "Z-.5R.1", "X1Z-1")))
    assert (result[1].x, result[1].z) == pytest.approx((0.5, -0.5 + back), abs=6e-6)
    end = 0.5 + back / sqrt(2), -0.5 - back / sqrt(2)
    assert (result[2].x, result[2].z) == pytest.approx(end, abs=6e-6)


def test_consecutive_corners_share_their_line() -> None:
    result = cuts(passed(body(HEAD, "X.5C.1", "Z-.3R.2", "X.9")))
    assert [(cut.line, cut.x, cut.z) for cut in result[1:]] == [
        (4, 0.4, 0), (4, 0.5, -0.1), (5, 0.5, -0.1), (5, 0.7, -0.3), (6, 0.9, -0.3),
    ]  # fmt: skip


def test_modal_words_between_moves_do_not_affect_corner() -> None:
    result = cuts(passed(body(HEAD, "X.5C.03", "G72", "G91", "(NOTE)", "S900", "G94F5", "Z-.4")))
    assert [(cut.line, cut.text) for cut in result[1:]] == [(4, "X.47"), (4, "X.5Z-.03"), (10, "Z-.37")]


def test_an_action_between_the_moves_happens_after_the_corner() -> None:
    result = passed(body(HEAD, "X.5C.03M09", "Z-.4M08"))
    told = [(b.line, b.kind, round(b.x / INCH, 5), round(b.z / INCH, 5)) for b in result.blocks[2:-1]]
    assert told == [
        (4, BlockKind.FEED, 0.47, 0),
        (4, BlockKind.FEED, 0.5, -0.03),
        (4, BlockKind.ACTION, 0.5, -0.03),
        (5, BlockKind.ACTION, 0.5, -0.03),
        (5, BlockKind.FEED, 0.5, -0.4),
    ]
    assert result.actions[1:3] == [CoolantSwitch(on=False), CoolantSwitch(on=True)]


def test_rapids_and_feeds_at_corner_are_preserved() -> None:
    result = passed(body("F9", "G00X.5Z0", "Z-.3C.05", "G01X.9", "G00Z0"))
    assert [(b.kind, b.text) for b in result.moves] == [
        (BlockKind.RAPID, "G00X.5Z0"),
        (BlockKind.RAPID, "Z-.25"),
        (BlockKind.RAPID, "X.55Z-.3"),
        (BlockKind.FEED, "G01X.9"),
        (BlockKind.RAPID, "G00Z0"),
    ]


def test_corner_is_correct_when_offset_changes_at_corner() -> None:
    given = setup(secondary={4: (-0.01, 0)})
    result = cuts(passed(body("X.1Z0F9", "X.2C.02", "Z-.75D4", "X.4D0"), given))
    assert [(cut.x, cut.z) for cut in result] == [
        (0.1, 0),
        (0.18, 0),
        (0.19973, -0.02),  # .02 down a way of .75 that goes in by .01
        (0.19, -0.75),
        (0.4, -0.75),
    ]


def test_corner_continues_into_subroutine() -> None:
    text = lines("G90G94F300", HEAD, "X.5C.03", "M98P1", "M30", "}1", "Z-.4", "M99")
    assert [cut.line for cut in cuts(passed(text))] == [2, 3, 3, 7]


def test_corner_continues_across_end_of_loop() -> None:
    text = lines("G90G94F300", HEAD, "LS2", "G91", "X.3C.03", "Z-.4", "LF", "M30")
    assert [cut.line for cut in cuts(passed(text))] == [2, 5, 5, 6, 5, 5, 6]


def test_blocks_are_numbered_without_gap_when_corners_add_blocks() -> None:
    result = passed(body(HEAD, "X.5C.03", "Z-.4C.02", "X.9", "X1", "X1.1"))
    assert [block.n for block in result.blocks] == list(range(1, 11))
    assert result.interpreter._state.blocks == 10


def test_css_speed_follows_end_point_shortened_by_corner() -> None:
    result = passed(body("G96S300", "G77S3000", "X.5Z0F9", "X1R.1", "Z-1"))
    cut = next(block for block in result.moves if block.line == 6)
    assert cut.x / INCH == pytest.approx(0.9)
    assert cut.rpm == pytest.approx(300 * 12 / (2 * 3.141592653589793 * 0.9))


def test_corner_between_collinear_lines_is_ignored_with_warning() -> None:
    result = passed(body(HEAD, "X.5C.03", "X.9"))
    assert result.warnings == [(4, 4, "corner-straight")]
    assert [cut.text for cut in cuts(result)] == [HEAD, "X.5C.03", "X.9"]


def test_corner_may_use_whole_length_of_line() -> None:
    result = passed(body(HEAD, "X.5C.3", "Z-.3"))
    assert result.errors == []
    assert result.ends == [(0.2, 0), (0.2, 0), (0.5, -0.3), (0.5, -0.3)]


REFUSED: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    (("X.5C.03",), (4, 4, "corner-next")),
    (("X.5R.03", "M08", "G91"), (4, 4, "corner-next")),
    (("X.5R.03", "T2", "X1Z1"), (4, 4, "corner-next")),
    (("X.5R.03", "G92X0", "X1Z1"), (4, 4, "corner-next")),
    (("X.5R.03", "M97I1C1P1", "Z-1", "M30", "}1", "M99"), (4, 4, "corner-next")),
    (("X.5C.03", "G02X.6Z-.1R.1"), (4, 4, "corner-next")),
    (("X.5R.03", "G03X.6Z.1R.1"), (4, 4, "corner-next")),
    (("X.5C.03", "G81Z-1F.01"), (4, 4, "corner-next")),
    (("X.5C.03", "G74X0Z-1I.1U0F.01"), (4, 4, "corner-next")),
    (("X.5C.03", "G33X.4Z-1I.01K.05"), (4, 4, "corner-next")),
    (("X.5C.03", "M05", "M19", "CA90Z-1"), (4, 4, "corner-next")),
    (("X.5C.03", "X.2"), (4, 4, "corner-next")),
    (("X.5R.03", "X.3"), (4, 4, "corner-next")),
    (("X.5C.31", "Z-.4"), (4, 4, "corner-too-large")),
    (("X.5R.31", "Z-.4"), (4, 4, "corner-too-large")),
    (("X.5C.2", "Z-.19"), (4, 4, "corner-too-large")),
    (("X.5C.2", "Z-.3C.11", "X.9"), (5, 5, "corner-too-large")),
    (("X.5C.2", "Z-.3R.11", "X.9"), (5, 5, "corner-too-large")),
    (("X.2C.01", "Z-.3"), (4, 4, "corner-too-large")),
    (("X.5C.01", "X.5", "Z-.3"), (4, 4, "corner-too-large")),
    (("X.5C0", "Z-.3"), (4, 4, "corner-size")),
    (("X.5C-.01", "Z-.3"), (4, 4, "corner-size")),
    (("X.5R0", "Z-.3"), (4, 4, "corner-size")),
    (("X.5R-.01", "Z-.3"), (4, 4, "corner-size")),
    (("X.5C.01R.01", "Z-.3"), (4, 4, "corner-both")),
    (("R.01", "Z-.3"), (4, 1, "corner-without-move")),
    (("S900R.01", "Z-.3"), (4, 5, "corner-without-move")),
    (("G04F1R.1",), (4, 6, "word-unused")),
    (("G10X1R.1",), (4, 6, "word-unused")),
    (("G02X.5Z-.3R.3C.1",), (4, 14, "word-unused")),
]


@pytest.mark.parametrize(("program", "error"), REFUSED, ids=[" ".join(program) for program, _ in REFUSED])
def test_invalid_corner_word_is_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    result = passed(body(HEAD, *program))
    assert error in result.errors
    assert all(block.line < error[0] for block in result.moves)


def test_corner_impossible_message_states_remaining_line_length() -> None:
    found = passed(body(HEAD, "X.5C.2", "Z-.3C.11", "X.9")).interpreter.diagnostics
    assert [each.message for each in found] == [
        text(
            "findings.corner-impossible",
            letter="C",
            why=text("findings.corner-too-large", needed="0.11000 in", line=5, left="0.10000 in"),
        )
    ]


def kinds(blocks: list[Block]) -> list[str]:
    return [str(block.kind) for block in blocks]


def test_r_word_on_arc_is_arc_radius_not_corner() -> None:
    result = passed(body(HEAD, "G02X.5Z-.3R.3", "Z-.5"))
    assert kinds(result.moves) == ["feed", "arc", "feed"]
    assert result.errors == []
