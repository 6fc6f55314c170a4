"""Straight moves: distances, diameters, units, steps, and what a block says of itself."""

from __future__ import annotations

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.interpreter.programs import INCH, body, lines, passed, setup


@pytest.mark.parametrize(
    ("program", "ends"),
    [
        (("X1Z2", "X.5", "Z-.25"), [(1, 2), (0.5, 2), (0.5, -0.25)]),
        (("X1Z2", "G91", "X.5", "Z-.25", "X-.1Z.1"), [(1, 2), (1.5, 2), (1.5, 1.75), (1.4, 1.85)]),
        (("X1Z2", "G91X.5", "G90X.5"), [(1, 2), (1.5, 2), (0.5, 2)]),
        (("G72", "X1Z2", "X.5"), [(0.5, 2), (0.25, 2)]),
        (("G72X1Z2", "G73X.5"), [(0.5, 2), (0.5, 2)]),
        (("G72X1Z2", "G91X.5Z.5"), [(0.5, 2), (0.75, 2.5)]),
        (("G71X25.4Z50.8", "G70X1"), [(1, 2), (1, 2)]),
        (("G71G72", "X25.4Z-2.54"), [(0.5, -0.1)]),
        (("Z1X2",), [(2, 1)]),
        (("x1z2", "x-.5"), [(1, 2), (-0.5, 2)]),
        (("X+1.Z 0", "Z . 5"), [(1, 0), (1, 0.5)]),
    ],
)
def test_moves_end_at_programmed_points(program: tuple[str, ...], ends: list[tuple[float, float]]) -> None:
    result = passed(body(*program))
    assert result.errors == []
    assert result.ends == ends


def test_move_starts_at_end_of_previous_move() -> None:
    moves = passed(body("X1Z2", "G91X.5", "G90Z0", "G72X1")).moves
    assert [(b.x0, b.z0) for b in moves[1:]] == [(b.x, b.z) for b in moves[:-1]]


def test_the_first_move_starts_at_the_machine_point() -> None:
    first = passed(body("Z1"), setup(start=(2.0, 3.0))).moves[0]
    assert (first.x0, first.z0, first.x, first.z) == pytest.approx((2 * INCH, 3 * INCH, 2 * INCH, INCH))


def test_blocks_have_number_line_and_text() -> None:
    blocks = passed(lines("G90G94F300", "M03 S1000", "X1 z1(go)", "G00X2Z1.00001", "M30")).blocks
    assert [(b.n, b.line, b.text) for b in blocks] == [
        (1, 2, "M03S1000"),
        (2, 3, "X1z1"),
        (3, 4, "G00X2Z1.00001"),
        (4, 5, "M30"),
    ]


@pytest.mark.parametrize(
    ("line", "texts"),
    [
        ("M03S900X1Z1F5", ["M03S900", "X1Z1F5"]),
        ("X1T1Z1D2M08", ["T1D2", "M08", "X1Z1"]),
        ("T1D2", ["T1D2"]),
        ("G97S500", ["G97S500"]),
        ("T2M03S500", ["T2", "M03S500"]),
        ("T2G92X1Z1", ["T2", "G92X1Z1"]),
        ("G01X1F20M05", ["G01X1F20", "M05"]),
        ("M08G04F2", ["M08", "G04F2"]),
    ],
)
def test_each_block_of_a_line_has_its_part_of_the_text(line: str, texts: list[str]) -> None:
    assert [b.text for b in passed(body(line)).blocks[1:-1]] == texts


def test_the_modal_state_is_shared_until_a_word_changes_it() -> None:
    moves = passed(body("X1Z1", "X2", "F20X3", "X4")).moves
    assert moves[0].modal is moves[1].modal
    assert moves[2].modal is moves[3].modal
    assert moves[1].modal is not moves[2].modal
    assert moves[2].modal.feed == pytest.approx(20 * INCH / 60)


@pytest.mark.parametrize(
    ("program", "end", "warning"),
    [
        (("X.00005Z0",), (0.00005, 0), None),
        (("X.12345Z0",), (0.12345, 0), None),
        (("X.12343Z0",), (0.12345, 0), (3, 1, "finer-than-step")),
        (("X1Z.00002",), (1, 0), (3, 3, "finer-than-step")),
        (("G72X.0001Z0",), (0.00005, 0), None),
        (("G72X.00015Z0",), (0.0001, 0), (3, 4, "finer-than-step")),
        (("X0Z1.123456",), (0, 1.12345), (3, 3, "finer-than-step")),
        (("G71", "X1.2345Z0"), (round(1.2345 / INCH, 5), 0), None),
        (("G71", "X1.23456Z0"), (round(1.2346 / INCH, 5), 0), (4, 1, "finer-than-step")),
    ],
)
def test_words_finer_than_resolution_are_rounded_with_warning(
    program: tuple[str, ...], end: tuple[float, float], warning: tuple[int, int, str] | None
) -> None:
    result = passed(body(*program))
    assert result.ends == [pytest.approx(end, abs=1e-9)]
    assert result.warnings == ([] if warning is None else [warning])


def test_word_finer_than_resolution_is_reported_once_in_loop() -> None:
    result = passed(body("LS3", "X.00001Z.00001", "X1", "LF"))
    assert result.warnings == [(4, 1, "finer-than-step")]
    assert [found.occurrence_count for found in result.interpreter.diagnostics] == [2]


def test_rounding_message_uses_program_units() -> None:
    (found,) = passed(body("G72X.00013Z0")).interpreter.diagnostics
    assert "X.00013" in found.message
    assert ".0001 in" in found.message


def test_move_to_current_position_is_zero_length_block() -> None:
    move = passed(body("X0Z0")).moves[0]
    assert (move.x0, move.z0, move.x, move.z, move.kind) == (0, 0, 0, 0, BlockKind.RAPID)


def test_dwell_is_a_block_and_its_f_is_not_a_feed() -> None:
    result = passed(body("F20X1", "G04F.5", "X2"))
    assert [b.kind for b in result.blocks[1:4]] == [BlockKind.FEED, BlockKind.DWELL, BlockKind.FEED]
    assert result.feeds == [("feed", 20), ("feed", 20)]
