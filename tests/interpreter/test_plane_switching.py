"""Plane switching in programs: frames, the centre, what may stand there and what is refused."""

from __future__ import annotations

from math import atan2, degrees, hypot, pi

import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.interpreter.programs import INCH, Pass, lines, passed, setup

LATHE = ("G90G94F300", "M19", "X-.5Z-.1F5")


def face(*each: str, head: tuple[str, ...] = LATHE) -> Pass:
    """Statements of (~PLXC), the first on line 5, with the tool at X-.5 Z-.1."""
    return passed(lines(*head, "(~PLXC)", *each, "(END)", "M30"))


def side(*each: str) -> Pass:
    """Statements of (~PLZC), the first on line 5."""
    return passed(lines(*LATHE, "(~PLZC)", *each, "(END)", "M30"))


def milled(result: Pass) -> list[Block]:
    return result.moves[1:]


def stand(block: Block) -> tuple[float, float, float]:
    """x, z in inches and C at the end of a block."""
    return block.x / INCH, block.z / INCH, block.c


def test_face_plane_moves_map_to_x_and_c() -> None:
    up, deeper = milled(face("(X0Y.4)", "(Z-.2F2)"))
    assert stand(up) == pytest.approx((-0.4, -0.1, -90.0))
    assert up.kind is BlockKind.PLANE_LINE
    assert up.feed == pytest.approx(5 * INCH / 60)
    assert stand(deeper) == pytest.approx((-0.4, -0.2, -90.0))
    assert deeper.feed == pytest.approx(2 * INCH / 60)
    assert up.text == "(X0Y.4)"


def test_x_in_face_plane_is_not_diameter_under_g72() -> None:
    result = face("(X.3Y.4)", head=("G90G94G72F300", "M19", "X-1.Z-.1F5"))
    assert stand(milled(result)[0]) == pytest.approx((-0.5, -0.1, -degrees(atan2(0.4, 0.3))))


def test_face_plane_in_metric_mode() -> None:
    result = passed(lines("G90G94G71F3000", "M19", "X-12Z-1F100", "(~PLXC)", "(X0Y8)", "(END)", "M30"))
    (move,) = milled(result)
    assert (move.x, move.c) == pytest.approx((-8.0, -90.0))


def test_plane_words_ignore_case_and_spaces() -> None:
    result = passed(lines(*LATHE, " ( ~plxc ) ", "( x .3 y0 f 4 )", "  (end)", "M30"))
    assert result.errors == []
    assert stand(milled(result)[0]) == pytest.approx((-0.3, -0.1, 0.0))


def test_h_word_sets_tool_height_above_center() -> None:
    """H .3: the tool stands at (.5, .3) and goes to (0, .5): machine x -.4."""
    (move,) = milled(face("(H.3)", "(X0Y.5)"))
    assert move.plane is not None
    assert move.plane.start == pytest.approx((0.5 * INCH, 0.3 * INCH, -0.1 * INCH))
    # C: the tool's own angle at .5 is asin(.3/.5) = 36.87, at the start atan2(.3, .5) = 30.96
    assert stand(move) == pytest.approx((-0.4, -0.1, degrees(atan2(3, 4)) - 90.0))


def test_side_plane_moves_map_to_x_z_and_c() -> None:
    in_, across, along = milled(side("(Z.8)", "(Y.2)", "(X.1)"))
    assert stand(in_) == pytest.approx((-0.4, -0.1, 0.0))
    turned = -360.0 * 0.2 / (pi * 1.0)  # D is the mill's Z at the entry: 1 in
    assert stand(across) == pytest.approx((-0.4, -0.1, turned))
    assert stand(along) == pytest.approx((-0.4, -0.2, turned))


def test_d_word_scales_y_in_side_plane() -> None:
    move = milled(side("(D.8)", "(Y.2)"))[-1]
    assert move.c == pytest.approx(-360.0 * 0.2 / (pi * 0.8))


def test_arc_code_applies_to_one_plane_line() -> None:
    result = side("(Y.1)", "(G02X.1Y.2I.1J.1)", "(X.2Y.2)")
    assert [b.kind for b in milled(result)] == [
        BlockKind.PLANE_LINE,
        BlockKind.PLANE_ARC,
        BlockKind.PLANE_LINE,
    ]
    assert milled(result)[1].clockwise


def test_next_plane_starts_at_c_where_last_plane_ended() -> None:
    result = passed(
        lines(*LATHE, "(~PLXC)", "(X0Y.5)", "(END)", "X-.6", "(~PLXC)", "(X0Y.6)", "(END)", "X-.7", "M30")
    )
    assert result.errors == []
    assert [round(b.c, 9) for b in result.moves] == [0.0, -90.0, -90.0, -180.0, -180.0]
    assert result.blocks[-2].modal.mill is None


def test_modal_state_includes_plane_position_between_moves() -> None:
    first = milled(face("(X.3Y.4)", "(X0)"))[0]
    assert first.modal.mill is not None
    assert (first.modal.mill.x, first.modal.mill.y) == pytest.approx((0.3 * INCH, 0.4 * INCH))


def test_secondary_offset_is_added_in_plane() -> None:
    given = setup(secondary={1: (0.01, 0.02)})
    (move,) = passed(
        lines("G90G94F300", "M19", "X-.5Z0D1", "(~PLXC)", "(X.3F5)", "(END)", "M30"), given
    ).moves[1:]
    assert stand(move) == pytest.approx((-0.29, 0.02, 0.0))


# --- through the axis ---------------------------------------------------------------------------------------


def test_line_through_axis_turns_c_by_180_degrees() -> None:
    result = face("(X-.3Y0)")
    assert [(b.kind, round(b.x / INCH, 9), round(b.c, 9)) for b in milled(result)] == [
        (BlockKind.PLANE_LINE, 0.0, 0.0),
        (BlockKind.ROTATE, 0.0, -180.0),
        (BlockKind.PLANE_LINE, -0.3, -180.0),
    ]
    assert result.warnings == [(5, 1, "plane-centre")]
    assert "180" in result.interpreter.diagnostics[-1].message


def test_line_to_axis_and_out_in_another_direction_turns_c() -> None:
    result = face("(X0Y0)", "(X0Y.4)")
    assert [(b.kind, round(b.c, 9)) for b in milled(result)] == [
        (BlockKind.PLANE_LINE, 0.0),
        (BlockKind.ROTATE, -90.0),
        (BlockKind.PLANE_LINE, -90.0),
    ]
    assert result.warnings == [(6, 1, "plane-centre")]


def test_arc_through_axis_turns_c() -> None:
    """From (.4, 0) round (.2, 0) counter-clockwise: into the centre from above, out of it downwards."""
    result = face("(X.4)", "(G03X.4Y0I.2J0)")
    assert [(b.kind, round(b.x / INCH, 6), round(b.c, 6)) for b in milled(result)] == [
        (BlockKind.PLANE_LINE, -0.4, 0.0),
        (BlockKind.PLANE_ARC, 0.0, -90.0),
        (BlockKind.ROTATE, 0.0, -270.0),
        (BlockKind.PLANE_ARC, -0.4, -360.0),
    ]


def test_line_past_axis_causes_no_warning() -> None:
    result = face("(Y.01)", "(X-.3)")
    assert result.warnings == []
    last = milled(result)[-1]
    assert last.c == pytest.approx(-degrees(atan2(0.01, -0.3)))
    assert last.x / INCH == pytest.approx(-hypot(0.3, 0.01))


# --- refusals -----------------------------------------------------------------------------------------------

FACE: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    # what may not stand there at all
    (("X1",), (5, 1, "plane-line")),
    (("X1Z1",), (5, 1, "plane-line")),
    (("M05",), (5, 1, "plane-line")),
    (("LS2",), (5, 1, "plane-line")),
    (("/(X.4)",), (5, 1, "plane-line")),
    (("(X.4) safe",), (5, 1, "plane-line")),
    (("(X.4)(Y.1)",), (5, 1, "plane-line")),
    (("(X.4",), (5, 1, "plane-line")),
    (("(~PLZC)",), (5, 2, "plane-word")),
    (("(a comment)",), (5, 2, "plane-word")),
    (("()",), (5, 1, "plane-word")),
    (("(G01X.4)",), (5, 2, "plane-word")),
    (("(G2X.4I0J0)",), (5, 2, "plane-word")),
    (("(X.4G91)",), (5, 5, "plane-word")),
    (("(K.4)",), (5, 2, "plane-word")),
    (("(S500)",), (5, 2, "plane-word")),
    (("(X)",), (5, 2, "plane-word")),
    (("(X.4,Y.1)",), (5, 5, "plane-word")),
    (("(X.4X.5)",), (5, 5, "word-twice")),
    (("(X99999)",), (5, 2, "out-of-range")),
    # what does not fit together
    (("(X.4I.1)",), (5, 5, "word-unused")),
    (("(G02X.4I.1)",), (5, 2, "arc-coordinate-missing")),
    (("(G02X.4Z1I.1J0)",), (5, 8, "word-unused")),
    (("(H.1X.4)",), (5, 2, "not-alone")),
    (("(X.4)", "(H.1)"), (6, 2, "plane-h-late")),
    (("(F5)", "(H.1)"), (6, 2, "plane-h-late")),
    (("(H.1)", "(H.1)"), (6, 2, "plane-h-late")),
    (("(D1)",), (5, 2, "plane-word")),
    (("(F301)",), (5, 2, "feed-range")),
    (("(X.4F.00001)",), (5, 5, "feed-range")),
    (("(G02X0Y.5I.1J0)",), (5, 2, "arc-radius")),
    (("(G02X.5Y0I.5J0)",), (5, 2, "arc-radius")),
    # out of the tool's reach
    (("(H.2)", "(X.1Y.1)"), (6, 1, "plane-reach")),
    (("(H.2)", "(X-.5Y.19)"), (6, 1, "plane-reach")),
    (("(H-.2)", "(X.5Y.1)", "(X-.5)"), (7, 1, "plane-reach")),
    (("(H.2)", "(G02X.1I.3J.2)"), (6, 1, "plane-reach")),
]


@pytest.mark.parametrize(("program", "error"), FACE, ids=[" ".join(program) for program, _ in FACE])
def test_invalid_face_plane_statement_is_rejected(
    program: tuple[str, ...], error: tuple[int, int, str]
) -> None:
    assert error in face(*program).errors


SIDE: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    (("(H.1)",), (5, 2, "plane-word")),
    (("(Y.1)", "(D.8)"), (6, 2, "plane-d-late")),
    (("(D0)",), (5, 2, "plane-diameter")),
    (("(D-1)",), (5, 2, "plane-diameter")),
    (("(Z-.1)",), (5, 2, "plane-side")),
]


@pytest.mark.parametrize(("program", "error"), SIDE, ids=[" ".join(program) for program, _ in SIDE])
def test_invalid_side_plane_statement_is_rejected(
    program: tuple[str, ...], error: tuple[int, int, str]
) -> None:
    assert error in side(*program).errors


ENTRY: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    (("X-.5Z0", "(~PLXC)", "(END)"), (3, 1, "c-unlocked")),
    (("M19", "X.5Z0", "(~PLXC)", "(END)"), (4, 1, "plane-side")),
    (("M19", "X0Z0", "(~PLZC)", "(END)"), (4, 1, "plane-side")),
    (("M19", "X-.5", "G95F.1", "(~PLZC)", "(END)"), (5, 1, "plane-feed-mode")),
    (("M19", "X-.5Z0", "T1", "(~PLZC)", "(END)"), (5, 1, "tool-first-move")),
    (("M19", "X-.5Z0G00", "(~PLXC)", "(X.4)", "(END)"), (5, 1, "feed-missing")),
    (("M19", "X-.5Z0(~PLXC)"), (3, 7, "plane-entry")),
    (("M19", "X-.5Z0", "(~PLCX)", "(X.4)", "(END)"), (4, 1, "plane-entry")),
    (("M19", "X-.5Z0", "(~PLXC)", "(X.4)"), (6, 1, "plane-open")),
]


@pytest.mark.parametrize(("program", "error"), ENTRY, ids=[" ".join(program) for program, _ in ENTRY])
def test_invalid_plane_entry_is_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    assert error in passed(lines("G90G94F300", *program, "M30")).errors


def test_plane_open_at_end_of_file_is_rejected() -> None:
    result = passed(lines(*LATHE, "(~PLXC)", "(X.4)"))
    assert (4, 1, "plane-open") in result.errors


def test_no_block_follows_rejected_plane_statement() -> None:
    result = face("(X.4)", "(K1)", "(X.3)")
    assert [b.text for b in result.moves] == ["X-.5Z-.1F5", "(X.4)"]


def test_end_outside_of_a_plane_is_a_comment() -> None:
    assert passed(lines("G90G94F300", "X1(END)", "M30")).errors == []
