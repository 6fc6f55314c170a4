"""G75 and G78: moves, what counts in the contour, and what is refused. Figures in inches, by hand."""

from __future__ import annotations

from math import sqrt

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.interpreter.programs import INCH, Pass, body, passed, setup
from tests.texts import text

SHAFT = ("X.2Z0", "Z-.5", "X.4")
"""Cylinder of radius .2 to Z-.5, shoulder out to .4."""


def cycle(result: Pass, line: int = 4) -> list[tuple[str, str]]:
    """(text, kind) of the moves of a line."""
    return [(block.text, str(block.kind)) for block in result.moves if block.line == line]


def rough(*contour: str, start: str = "X.4Z.1", code: str = "G75I.1U.02F4") -> Pass:
    return passed(body(start, code, *contour, "RF"))


def test_g75_roughs_shaft_move_by_move() -> None:
    """Offset radius .22, shoulder offset Z-.48: depth .18 in two passes of .09, then along the contour."""
    result = rough(*SHAFT)
    assert result.errors == []
    assert cycle(result) == [
        ("X.31", "feed"), ("Z-.48", "feed"), ("G00X.33", "rapid"), ("G00Z.1", "rapid"),
        ("X.22", "feed"), ("Z-.48", "feed"), ("G00X.24", "rapid"), ("G00Z.1", "rapid"),
        ("X.22", "feed"), ("Z0", "feed"), ("Z-.48", "feed"), ("X.4", "feed"),
        ("G00Z.1", "rapid"),
    ]  # fmt: skip
    assert result.warnings == []


def test_contour_in_subroutine_or_diameters_gives_same_moves() -> None:
    here = [b.text for b in rough(*SHAFT).moves]
    text = body("X.4Z.1", "G75I.1U.02F4P7") + "}7\n" + "\n".join(SHAFT) + "\nM99\n"
    assert [b.text for b in passed(text).moves] == here
    wide = passed(body("G72", "X.8Z.1", "G75I.1U.02F4", "X.4Z0", "Z-.5", "X.8", "RF"))
    assert [(b.x, b.z) for b in wide.moves] == [(b.x, b.z) for b in rough(*SHAFT).moves]


def test_g78_makes_one_pass_along_contour() -> None:
    result = rough(*SHAFT, code="G78U.02F4")
    assert cycle(result) == [
        ("G00X.24", "rapid"), ("X.22", "feed"), ("Z0", "feed"), ("Z-.48", "feed"), ("X.4", "feed"),
        ("G00Z.1", "rapid"),
    ]  # fmt: skip


def test_first_line_of_contour_may_have_x_only() -> None:
    result = rough("X.2", "Z-.5", "X.4", code="G78U.02F4")
    assert cycle(result)[1:3] == [("X.22", "feed"), ("Z-.48", "feed")]


def test_allowance_u_is_perpendicular_to_taper() -> None:
    """45 degrees from (.2, 0) to (.3, -.1), U .02: moved by .02/sqrt 2 in X and Z."""
    result = rough("X.2Z0", "X.3Z-.1", code="G78U.02F4")
    shift = 0.02 / sqrt(2)
    points = [(b.x / INCH, b.z / INCH) for b in result.moves if b.line == 4]
    assert any(point == pytest.approx((0.2 + shift, shift)) for point in points)
    assert any(point == pytest.approx((0.3 + shift, -0.1 + shift)) for point in points)


def test_corner_words_apply_in_contour() -> None:
    """C.1 between face and cylinder; the way round its two corners in arcs of radius U."""
    result = rough("X0Z0", "X.2C.1", "Z-.5", "X.4", start="X.4Z.1", code="G78U.02F4")
    assert result.errors == []
    arcs = [b for b in result.moves if b.kind is BlockKind.ARC]
    assert [(b.cx / INCH, b.cz / INCH) for b in arcs] == [
        pytest.approx((0.1, 0), abs=1e-9), pytest.approx((0.2, -0.1)),
    ]  # fmt: skip
    assert [(b.x / INCH, b.z / INCH) for b in arcs][1] == pytest.approx((0.22, -0.1))


def test_corner_radius_in_contour_is_offset_by_allowance() -> None:
    """R.05 in the inside corner at (.2, -.5): its offset has the radius .03 about (.25, -.45)."""
    result = rough("X.2Z0", "Z-.5R.05", "X.4", code="G78U.02F4")
    (fillet,) = [b for b in result.moves if b.kind is BlockKind.ARC]
    assert (fillet.cx / INCH, fillet.cz / INCH) == pytest.approx((0.25, -0.45))
    assert (fillet.x / INCH, fillet.z / INCH) == pytest.approx((0.25, -0.48))
    assert fillet.clockwise is False


def test_g91_in_contour_applies_until_contour_ends() -> None:
    result = rough("G91X-.2Z-.1", "Z-.5", "X.2", code="G78U.02F4")
    assert [(b.x, b.z) for b in result.moves] == [(b.x, b.z) for b in rough(*SHAFT, code="G78U.02F4").moves]
    assert result.warnings == [(4, 1, "cycle-modes")]
    assert result.moves[-1].modal.absolute is True


def test_g92_in_contour_applies_until_contour_ends() -> None:
    result = rough("X.2Z0", "G92X1.2Z1", "X1.2Z.5", "X1.4", code="G78U.02F4")
    assert result.ends == rough(*SHAFT, code="G78U.02F4").ends
    assert result.moves[-1].modal.preset_x == 0


def test_other_words_in_contour_are_ignored_with_one_warning() -> None:
    result = rough("X.2Z0F9", "Z-.5M08", "X.4S500", "T5", code="G78U.02F4")
    plain = rough(*SHAFT, code="G78U.02F4")
    assert cycle(result) == cycle(plain)
    assert [note for note in result.notes if note[2] == "cycle-ignored"] == [(5, 6, "cycle-ignored")]
    assert result.interpreter.modal_state.tool == 0
    assert result.interpreter.modal_state.rpm == 1000
    assert {b.rpm for b in result.moves} == {1000}


def test_contour_lines_produce_no_blocks_of_their_own() -> None:
    result = rough(*SHAFT)
    assert {block.line for block in result.blocks} == {1, 2, 3, 4, 9} - {1}


def test_bore_is_roughed_from_inside_outward() -> None:
    """Bore of radius .4 to Z-.5, then .3: from radius .25 outwards."""
    result = rough("X.4Z0", "Z-.5", "X.25", start="X.25Z.1")
    assert [text for text, _ in cycle(result)][:4] == ["X.315", "Z-.48", "G00X.295", "G00Z.1"]
    assert max(b.x for b in result.moves) == pytest.approx(0.38 * INCH)
    assert result.ends[-1] == (0.25, 0.1)


def test_roughing_from_back_mirrors_x() -> None:
    front = rough(*SHAFT)
    back = rough("X-.2Z0", "Z-.5", "X-.4", start="X-.4Z.1")
    assert back.ends == [(-x, z) for x, z in front.ends]


def test_contour_may_start_at_its_back_end() -> None:
    """The same area; the pass along the contour runs as the contour does, entered from above."""
    result = rough("X.4Z-.5", "X.2", "Z0", code="G78U.02F4")
    assert result.errors == []
    assert [b[0] for b in cycle(result)] == ["G00Z-.48", "X.22", "Z0", "Z.1", "G00X.4"]


GROOVE = ("X.3Z0", "Z-.2", "X.2", "Z-.5", "X.4")
"""Radius .3 to Z-.2, then .2 down to Z-.5."""


def test_tool_plunges_into_groove_with_warning() -> None:
    """Depth .22 to radius .21 in four passes of .055; at .265 and .21 only from Z-.21 on, by a plunge."""
    result = rough(*GROOVE, code="G75I.06U.01F4", start="X.43Z.1")
    assert result.errors == []
    assert result.warnings == [(4, 1, "cycle-plunge")]
    assert [text for text, _ in cycle(result)] == [
        "X.375", "Z-.49", "G00X.395", "G00Z.1",
        "X.32", "Z-.49", "G00X.34", "G00Z-.21",
        "X.265", "Z-.49", "G00X.285", "G00Z-.21",
        "X.21", "Z-.49", "G00X.34", "G00Z.1",
        "X.31", "Z0", "Z-.2", "G02X.3Z-.21R.01", "X.21", "Z-.49", "X.4",
        "G00Z.1", "G00X.43",
    ]  # fmt: skip


def test_inside_radius_smaller_than_allowance_becomes_sharp_corner() -> None:
    """A fillet of .01 with U .02: the offsets of its two lines meet."""
    result = rough("X.2Z0", "Z-.5R.01", "X.4", code="G78U.02F4")
    assert result.errors == []
    assert (0.22, -0.48) in result.ends


def test_roughing_cycle_uses_its_feed_and_feed_mode() -> None:
    result = rough(*SHAFT, code="G95G75I.1U.02F.003")
    cuts = [b for b in result.moves if b.line == 4 and b.kind is not BlockKind.RAPID]
    assert {(round(b.feed / INCH, 6), b.per_rev) for b in cuts} == {(0.003, True)}


def test_block_delete_of_cycle_skips_its_contour() -> None:
    text = body("X.4Z.1", "/G75I.1U.02F4", *SHAFT, "RF", "Z1")
    result = passed(text, setup(block_delete=True))
    assert result.ends == [(0.4, 0.1), (0.4, 1)]


def test_cycle_runs_in_loop_and_in_subroutine() -> None:
    once = len(cycle(rough(*SHAFT)))
    text = body("X.4Z.1", "LS3", "G75I.1U.02F4", *SHAFT, "RF", "LF")
    assert len(cycle(passed(text), 5)) == 3 * once
    text = body("X.4Z.1", "P1") + "}1\nG75I.1U.02F4\n" + "\n".join(SHAFT) + "\nRF\nM99\n"
    result = passed(text)
    assert result.errors == []
    assert len(cycle(result, 7)) == once


def test_contour_ends_on_edges_of_quadrant_are_accepted() -> None:
    """A at the start's Z, B at the start's X."""
    result = rough("X.2", "Z-.5", "X.4", start="X.4Z.1")
    assert result.errors == []
    assert result.ends[-1] == (0.4, 0.1)


def test_undercut_edge_causes_warning() -> None:
    result = rough("X.2Z0", "Z-.5", "X.3Z-.4", "X.4", code="G75I.1U.01F4")
    assert result.errors == []
    assert (4, 1, "cycle-undercut") in result.warnings


@pytest.mark.parametrize(
    ("lines", "error"),
    [
        (("G75U.02F4", *SHAFT, "RF"), (4, 1, "word-missing")),
        (("G75I0F4", *SHAFT, "RF"), (4, 4, "cycle-length")),
        (("G75I-.1F4", *SHAFT, "RF"), (4, 4, "cycle-length")),
        (("G75I.1U-.02F4", *SHAFT, "RF"), (4, 7, "cycle-length")),
        (("G75I.1U.02", *SHAFT, "RF"), (4, 1, "feed-missing")),
        (("G78U.02", *SHAFT, "RF"), (4, 1, "feed-missing")),
        (("G75I.1K.1F4", *SHAFT, "RF"), (4, 7, "word-unused")),
        (("G75I.1D1F4", *SHAFT, "RF"), (4, 7, "word-unused")),
        (("G78I.1F4", *SHAFT, "RF"), (4, 4, "word-unused")),
        (("G75I.1F4", *SHAFT), (4, 1, "contour-open")),
        (("G78U.1F4", *SHAFT), (4, 1, "contour-open")),
        (("RF",), (4, 1, "rf-alone")),
        (("G75I.1F4P1", *SHAFT, "RF"), (8, 1, "rf-alone")),
        (("G75I.1F4P9",), (4, 9, "subroutine-missing")),
        (("G75I.1F4P",), (4, 9, "word-missing")),
        (("G75I.1F4", "RF"), (4, 1, "cycle-contour-empty")),
        (("G75I.1F4", "X.2Z0", "RF"), (4, 1, "cycle-contour-empty")),
        (("G75I.1F4", "X.2Z0", "Z-.5", "X.5", "RF"), (4, 1, "cycle-quadrant")),
        (("G75I.1F4", "X.2Z.2", "Z-.5", "RF"), (4, 1, "cycle-quadrant")),
        (("G75I.1F4", "X.4Z0", "Z-.5", "RF"), (4, 1, "cycle-nothing")),
        (("G75I.1F4", "X.2Z.1", "X.3", "RF"), (4, 1, "cycle-nothing")),
        (("G75I.1U.02F4", "X.2Z.1", "X.39", "Z-.5", "RF"), (4, 1, "cycle-start-near")),
        (("G75I.1F4", "X.2Z0", "LS2", "Z-.5", "LF", "X.4", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "G81Z-.5", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "Z-.5R.1C.1", "X.4", "RF"), (6, 8, "corner-both")),
        (("G75I.1F4", "X.2Z0", "R.1", "X.4", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "CA90", "X.4", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "(~PLXC)", "(END)", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "X,4", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "M98P1", "X.4", "RF"), (6, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "G42", "Z-.5", "X.4", "RF"), (6, 1, "cycle-nose-comp")),
        (("G75I.1F4", "X.2Z0R.1", "Z-.5", "X.4", "RF"), (5, 6, "cycle-contour-line")),
        (("G75I.1F4", "G02X.2Z0R1", "Z-.5", "X.4", "RF"), (5, 1, "cycle-contour-line")),
        (("G75I.1F4", "X.2Z0", "Z-.5R.6", "X.4", "RF"), (6, 5, "corner-too-large")),
        (("G75I.1F4", "X.2Z0", "Z-.5R.1", "RF"), (6, 5, "corner-next")),
        (("G75I.1F4", "X.2Z0", "Z-.5C.1", "G02X.4Z-.7R.2", "RF"), (6, 5, "corner-next")),
        (("G75I.1F4", "X.2Z0", "Z-.5C-.1", "X.4", "RF"), (6, 5, "corner-size")),
        (("G75I.1F4", "X.2Z0", "G02X.4Z-.7R.1", "RF"), (6, 11, "arc-radius")),
        (("G75I.1U.02F4", "X.2Z0", "Z-.3", "X.3", "X.2", "Z-.5", "X.4", "RF"), (4, 7, "cycle-no-way")),
        (("G75I.1F4", *SHAFT, "/RF"), (8, 2, "block-delete-flow")),
    ],
    ids=lambda value: " ".join(value) if isinstance(value[0], str) else value[2],
)
def test_invalid_roughing_cycle_is_rejected(lines: tuple[str, ...], error: tuple[int, int, str]) -> None:
    result = passed(body("X.4Z.1", *lines))
    assert error in result.errors
    assert all(block.line < 4 for block in result.moves)


def test_hint_of_immediately_falling_contour_explains_its_start() -> None:
    """From .4 at Z0 to .2 at Z-.5; .4 at Z0 reached up the face from .2 is roughed."""
    fall = ("X.4Z0", "X.2Z-.5", "Z-.6", "RF")
    result = passed(body("X.5Z.1", "G75I.05U.01F4", *fall))
    (refused,) = [each for each in result.interpreter.diagnostics if each.code == "cycle-start-near"]
    assert refused.hint == text("findings.begins-deeper")
    assert not passed(body("X.5Z.1", "G75I.05U.01F4", "X.2Z0", "X.4", *fall[1:])).errors


def test_contour_start_under_later_line_is_rejected_without_allowance() -> None:
    """X.3 at Z-.2 lies under the line at X.45 from Z-.4 back to Z-.1: the way down to it goes through."""
    lip = ("X.3Z-.2", "X.2Z-.3", "Z-.4", "X.45", "Z-.1", "X.4Z0", "RF")
    found = passed(body("X.5Z.1", "G75I.05F4", *lip)).errors
    assert [code for *_, code in found] == ["cycle-start-near"]


def test_feed_per_rev_with_stopped_spindle_is_rejected() -> None:
    result = passed(body("M05", "X.4Z.1", "G95G75I.1F.003", *SHAFT, "RF"))
    assert result.errors == [(5, 0, "spindle-stopped")]
    assert all(block.line < 5 for block in result.blocks)


def test_unreadable_cycle_line_causes_no_error_at_rf() -> None:
    result = passed(body("X.4Z.1", "G75I,1F4", *SHAFT, "RF"))
    assert [error for error in result.errors if error[0] != 4] == []


def test_cycle_with_too_many_passes_is_rejected() -> None:
    teeth = [f"X{0.2 + 0.0005 * (k % 2):.4f}Z{-0.001 * k:.3f}" for k in range(400)]
    result = passed(body("X.4Z.1", "G75I.0003F4", *teeth, "RF"))
    assert result.errors == [(4, 4, "cycle-passes")]


def test_lines_after_rejected_cycle_are_checked_from_cycle_start() -> None:
    result = passed(body("X.4Z.1", "G75F4", *SHAFT, "RF", "G81Z-.1F4"))
    assert result.errors == [(4, 1, "word-missing")]
