"""G41, G42 and G40: the path beside the contour, and what is refused. Inches."""

from __future__ import annotations

from itertools import pairwise
from math import sqrt

import pytest

from core.geometry.contour_offset import GOUGE_CHECK_ELEMENT_COUNT
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared.actions import Dwell, ProgramStop
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from tests.interpreter.programs import INCH, Pass, body, lines, passed, setup

D = {1: (-0.015, -0.015, 0.015), 2: (0, 0, 0.02), 3: (0, 0, -0.02), 4: (0.001, 0.002)}
FACING = ("X0Z.05F9", "G41", "X0Z0D2")  # lines 3 to 5; the nose is .02
SHAFT = (*FACING, "X.2", "Z-.3", "X.3", "Z1", "G40")


def given() -> InterpreterSetup:
    return setup(secondary=D)


def run(*program: str) -> Pass:
    return passed(body(*program), given())


def way(result: Pass) -> list[tuple[str, float, float]]:
    assert result.errors == []
    return [(str(b.kind), round(b.x / INCH, 5), round(b.z / INCH, 5)) for b in result.moves]


def test_shaft_is_compensated_from_face() -> None:
    result = run(*SHAFT)
    assert way(result) == [
        ("feed", 0, 0.05),
        ("feed", 0, 0.02),
        ("feed", 0.2, 0.02),
        ("arc", 0.22, 0),
        ("feed", 0.22, -0.28),
        ("feed", 0.3, -0.28),
        ("feed", 0.3, 1),
    ]
    assert [b.text for b in result.moves] == [
        "X0Z.05F9", "X0Z.02D2", "X.2", "G02X.22Z0R.02", "Z-.28", "X.3", "Z1",
    ]  # fmt: skip
    assert [b.line for b in result.moves] == [3, 5, 6, 6, 7, 8, 9]
    assert result.warnings == []


def test_shaft_is_compensated_from_back() -> None:
    result = run("X.4Z-.3F9", "G42", "X.3D2", "X.2", "Z0", "X0", "Z.5", "G40")
    assert way(result)[1:] == [
        ("feed", 0.3, -0.28),
        ("feed", 0.22, -0.28),
        ("feed", 0.22, 0),
        ("arc", 0.2, 0.02),
        ("feed", 0, 0.02),
        ("feed", 0, 0.5),
    ]
    assert not result.moves[4].clockwise


def test_bore_is_compensated() -> None:
    # On the way in the material lies at the left, towards X+, so the nose is at the right.
    result = run("X.3Z.1F9", "G42", "X.3Z0D2", "Z-.3", "X.2", "Z-.5", "X.1", "G40")
    assert way(result)[1:] == [
        ("feed", 0.28, 0),
        ("feed", 0.28, -0.28),
        ("feed", 0.2, -0.28),
        ("arc", 0.18, -0.3),
        ("feed", 0.18, -0.5),
        ("feed", 0.1, -0.5),
    ]


def test_diameter_and_radius_mode_give_same_compensated_path() -> None:
    doubled = ("G72", "X0Z.05F9", "G41", "X0Z0D2", "X.4", "Z-.3", "X.6", "Z1", "G40")
    assert way(run(*doubled)) == way(run(*SHAFT))


def test_incremental_and_absolute_mode_give_same_compensated_path() -> None:
    by_distance = ("X0Z.05F9", "G91", "G41", "X0Z-.05D2", "X.2", "Z-.3", "X.1", "Z1.3", "G40")
    result = run(*by_distance)
    assert way(result) == way(run(*SHAFT))
    assert [b.text for b in result.moves][2:5] == ["X.2", "G02X.02Z-.02R.02", "Z-.28"]


def test_modal_words_between_moves_do_not_affect_compensation() -> None:
    mixed = (
        "X0Z.05F9",
        "G41",
        "G72",
        "X0Z0D2",
        "G73",
        "G91",
        "X.2",
        "G90",
        "G72",
        "Z-.3",
        "X.6",
        "Z1",
        "G40",
    )
    assert way(run(*mixed)) == way(run(*SHAFT))


def test_x_and_z_of_secondary_offset_are_added_to_path() -> None:
    moved = [(x, z) for _, x, z in way(run("X0Z.05F9", "G41", "X0Z0D1", *SHAFT[3:]))]
    assert moved[1:] == [(-0.015, 0), (0.185, 0), (0.2, -0.015), (0.2, -0.3), (0.285, -0.3), (0.285, 0.985)]


def test_compensated_moves_retain_their_feeds_and_rapids() -> None:
    result = run(*FACING, "X.2F5", "Z-.3F7", "X.3", "G00Z1", "G40")
    told = [(str(b.kind), round(b.feed * 60 / INCH, 6)) for b in result.moves]
    assert told[2:] == [("feed", 5), ("arc", 5), ("feed", 7), ("feed", 7), ("rapid", 300)]


def test_actions_and_dwells_are_at_points_of_compensated_path() -> None:
    result = run(*FACING, "M08", "X.2M09", "M00(LOOK)", "Z-.3", "G04F1", "X.3", "Z1M09", "G40")
    still = [(b.line, round(b.x / INCH, 5), round(b.z / INCH, 5)) for b in result.blocks if not b.moves][1:-1]
    assert still == [(6, 0, 0.02), (7, 0.22, 0), (8, 0.22, 0), (10, 0.22, -0.28), (12, 0.3, 1)]
    assert ProgramStop(optional=False, message="LOOK") in result.actions
    assert Dwell(1.0) in result.actions
    for before, after in pairwise(result.blocks):
        assert (after.x0, after.z0) == (before.x, before.z)
    assert [block.n for block in result.blocks] == list(range(1, len(result.blocks) + 1))


def test_zero_length_move_does_not_change_compensated_path() -> None:
    result = run(*FACING, "X.2", "X.2", "Z-.3", "X.3", "Z1", "G40")
    assert way(result) == [*way(run(*SHAFT))[:4], ("feed", 0.22, 0), *way(run(*SHAFT))[4:]]


def test_compensated_blocks_carry_compensation_state() -> None:
    result = run(*SHAFT)
    assert [b.modal.compensation_code for b in result.moves] == [40, 41, 41, 41, 41, 41, 41]
    assert result.interpreter.modal_state.compensation_code == 40
    assert not any("G4" in b.text for b in result.blocks)


def test_arcs_remain_arcs_under_compensation() -> None:
    result = run(*FACING, "X.1", "G02X.2Z-.1R.1", "Z-.3", "G03X.25Z-.35R.05", "X.4", "Z1", "G40")
    assert way(result)[2:] == [
        ("feed", 0.1, 0.02),
        ("arc", 0.22, -0.1),
        ("feed", 0.22, -0.3),
        ("arc", 0.25, -0.33),
        ("feed", 0.4, -0.33),
        ("feed", 0.4, 1),
    ]
    assert [b.text for b in result.moves if b.kind is BlockKind.ARC] == [
        "G02X.22Z-.1R.12",
        "G03X.25Z-.33R.03",
    ]
    assert (result.moves[3].cx / INCH, result.moves[3].cz / INCH) == pytest.approx((0.1, -0.1))


def test_line_into_concave_arc_ends_at_offset_intersection() -> None:
    # Along a cylinder of .2 into a ball of radius .2 about (.2, -.5): the offsets are x .22 and radius .22.
    result = run(*FACING, "X.2", "Z-.3", "G02X.4Z-.5I.2K-.5", "Z-.7", "X.6", "Z1", "G40")
    assert way(result)[4] == ("feed", 0.22, round(-0.5 + sqrt(0.22**2 - 0.02**2), 5))


def test_corner_words_are_applied_before_compensation() -> None:
    cut = run(*FACING, "X.2C.05", "Z-.3R.05", "X.4", "Z1", "G40")
    written = run(*FACING, "X.15", "X.2Z-.05", "Z-.25", "G03X.25Z-.3R.05", "X.4", "Z1", "G40")
    assert way(cut) == way(written)
    assert [b.line for b in cut.moves] == [3, 5, 6, 6, 6, 6, 7, 7, 8, 9]


def test_corner_before_and_at_approach_move() -> None:
    result = run("X0Z.2F9", "Z.1C.03", "G42", "X.1Z.1D2", "Z0", "X.3", "Z-1", "G40")
    assert [b.line for b in result.moves[:4]] == [3, 4, 4, 6]
    assert (result.moves[2].x / INCH, result.moves[2].z / INCH) == pytest.approx((0.03, 0.1))
    assert result.errors == []


def test_tool_change_ends_compensation() -> None:
    result = run(*FACING, "X.2", "Z-.3", "X.3", "Z1", "T2", "X1Z1", "X0", "M08")
    assert way(result)[:7] == way(run(*SHAFT))
    assert way(result)[7:] == [("feed", 1, 1), ("feed", 0, 1)]


def test_compensation_restarts_directly_after_g40() -> None:
    result = run(*SHAFT, "G42", "X.3Z.5D2", "X.2", "Z.8", "G40")
    assert [(x, z) for _, x, z in way(result)[7:]] == [(0.3, 0.52), (0.2, 0.52), (0.2, 0.8)]


def test_tool_change_before_approach_cancels_compensation() -> None:
    result = run("X1Z1F9", "G41", "T2", "X0Z0", "X.5C.03", "Z-1")
    assert way(result)[1:] == [("feed", 0, 0), ("feed", 0.47, 0), ("feed", 0.5, -0.03), ("feed", 0.5, -1)]


def test_repeated_offset_number_does_not_change_path() -> None:
    assert way(run(*FACING, "X.2D2", "Z-.3D2", "X.3", "Z1D2", "G40")) == way(run(*SHAFT))


CUT = ("X0Z.05F9", "G41", "X0Z-.05D1", "X.1", "G02X.2Z-.15R.1M08", "Z-.3C.03", "X.3R.03F7", "Z-.5", "X.6")
WIDE = ("X0Z.05F9", "G41", "X0Z-.05D1", "X.2", "G02X.4Z-.15R.1M08", "Z-.3C.03", "X.6R.03F7", "Z-.5", "X1.2")
STEPS = ("X0Z.05F9", "G41", "X0Z-.1D1", "X.2", "Z-.25M08", "X.1Z-.1", "Z-.3C.03", "X.3R.03F7", "Z-.4", "X.5")


@pytest.mark.parametrize(
    ("mode", "source", "nose"),
    [("G90", CUT, 0.015), ("G91", STEPS, 0.015), ("G90G72", WIDE, 0.015), ("G90G71", CUT, 0.015 / INCH)],
    ids=["coordinates", "distances", "diameters", "millimetres"],
)
def test_generated_lines_reproduce_compensated_path(mode: str, source: tuple[str, ...], nose: float) -> None:
    offsets = setup(secondary={1: (-nose, -nose, nose)})
    head = f"{mode}G94F300"
    first = passed(lines(head, "M03S1000", *source, "G00Z3", "G40", "M30"), offsets)
    assert first.errors == []
    again = passed(lines(head, *(block.text for block in first.blocks)), offsets)
    assert again.errors == []
    assert [(b.kind, b.feed, b.per_rev, b.clockwise) for b in again.blocks] == [
        (b.kind, b.feed, b.per_rev, b.clockwise) for b in first.blocks
    ]
    for a, b in zip(first.blocks, again.blocks, strict=True):
        assert (a.x, a.z) == pytest.approx((b.x, b.z), abs=0.001)  # last places add up under G91


def test_g40_without_compensation_has_no_effect() -> None:
    assert way(run("G40", "X1F9", "G90G40", "Z1")) == [("feed", 1, 0), ("feed", 1, 1)]


def test_compensation_on_and_off_without_move_has_no_effect() -> None:
    assert way(run("X1F9", "G41", "M08", "G40", "Z1")) == [("feed", 1, 0), ("feed", 1, 1)]


def test_zero_nose_radius_follows_contour_with_warning() -> None:
    result = run("X0Z.05F9", "G41", "X0Z0D4", *SHAFT[3:])
    assert result.warnings == [(5, 0, "comp-no-radius")]
    assert [(x, z) for _, x, z in way(result)][1:] == [
        (0.001, 0.002), (0.201, 0.002), (0.201, -0.298), (0.301, -0.298), (0.301, 1.002),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("program", "warning"),
    [
        (("X0Z.039F9", *SHAFT[1:]), (5, 0, "comp-approach-near")),
        ((*SHAFT[:5], "X.3", "Z-.261", "G40"), (9, 0, "comp-departure-near")),
    ],
)
def test_rapid_close_to_part_causes_warning(program: tuple[str, ...], warning: tuple[int, int, str]) -> None:
    result = run(*program)
    assert (result.errors, result.warnings) == ([], [warning])


@pytest.mark.parametrize("program", [
    ("X0Z.04F9", *SHAFT[1:]),
    (*SHAFT[:5], "X.3", "Z-.26", "G40"),
    (*FACING, "X.2", "G03X.221Z-.021R.021", "X.4", "Z1", "G40"),
    (*FACING, "X.2", "Z-.1", "X.15", "Z-.141", "X.2", "Z-.3", "X.3", "Z1", "G40"),
])  # fmt: skip
def test_contour_close_to_limit_of_compensation_is_accepted(program: tuple[str, ...]) -> None:
    result = run(*program)
    assert (result.errors, result.warnings) == ([], [])


SUB = ("M30", "}1", "X1", "M99")
REFUSED: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    # where the codes may stand
    (("G41X1",), (3, 1, "not-alone")),
    (("G41D2",), (3, 1, "not-alone")),
    (("M08G42",), (3, 1, "not-alone")),
    (("G90G41",), (3, 1, "not-alone")),
    ((*SHAFT[:-1], "G40X1"), (10, 1, "not-alone")),
    (("G41", "G42"), (4, 1, "comp-on")),
    (("G42", "G41"), (4, 1, "comp-on")),
    (("G41", "G41"), (4, 1, "comp-on")),
    (SHAFT[:-1], (10, 1, "comp-open")),
    (("G42",), (4, 1, "comp-open")),
    (("M98P1", "M30", "}1", "G41", "M99"), (6, 1, "comp-subroutine")),
    ((*FACING, "M98P1", *SUB), (6, 1, "comp-subroutine")),
    ((*FACING, "P1", *SUB), (6, 1, "comp-subroutine")),
    ((*FACING, "M97I1C1P1", *SUB), (6, 1, "comp-subroutine")),
    # what may not stand under them
    ((*FACING, "G81Z-1F.01"), (6, 1, "comp-with")),
    ((*FACING, "G83Z-1K.1F.01"), (6, 1, "comp-with")),
    ((*FACING, "G74X1Z-1I.1U0F.01"), (6, 1, "comp-with")),
    ((*FACING, "G33X1Z-1I.1K.05"), (6, 1, "comp-with")),
    ((*FACING, "G92X0Z0"), (6, 1, "comp-with")),
    ((*FACING, "M19"), (6, 1, "comp-with")),
    ((*FACING, "CA90"), (6, 1, "comp-with")),
    ((*FACING, "(~PLXC)", "(END)"), (6, 1, "comp-with")),
    ((*FACING, "X.2D1"), (6, 4, "comp-d")),
    ((*FACING, "D0", "X.2"), (6, 1, "comp-d")),
    # the approach
    (("X0Z.05F9", "G41", "X0Z0", "X.2"), (5, 0, "comp-approach")),
    (("X0Z.05F9D2", "G41", "X0Z0", "X.2"), (5, 0, "comp-approach")),
    (("X0Z.05F9", "G41", "D2", "X0Z0", "X.2"), (6, 0, "comp-approach")),
    (("X0Z.05F9", "G41", "X0Z0D0", "X.2"), (5, 0, "comp-approach")),
    (("X0Z.05F9", "G41", "G02X.1Z-.05R.1D2"), (5, 0, "comp-approach")),
    (("X0Z.05F9", "G41", "X0Z0D3", "X.2"), (5, 0, "comp-radius")),
    (("X0Z.019F9", *SHAFT[1:]), (5, 0, "comp-approach-short")),
    (("X0Z.05F9", "G41", "Z.05D2", "X.2", "Z1", "G40"), (5, 0, "comp-approach-short")),
    (("X-.05Z.01F9", "G41", "X-.2Z0D2", *SHAFT[3:]), (5, 0, "comp-approach-near")),
    (("X.25Z-.5F9", "G41", "X0Z0D2", *SHAFT[3:]), (5, 0, "comp-gouge")),
    # the departure
    ((*FACING, "G40"), (5, 0, "comp-empty")),
    ((*FACING, "X.2", "G40"), (6, 0, "comp-empty")),
    ((*SHAFT[:5], "X.3", "Z-.281", "G40"), (9, 0, "comp-departure-short")),
    ((*SHAFT[:5], "X.3", "X.25Z-.29", "G40"), (9, 0, "comp-departure-near")),
    ((*SHAFT[:5], "X.3", "X.1Z.2", "G40"), (9, 0, "comp-gouge")),
    ((*SHAFT[:5], "X.3", "G03X.5Z-.1R.2", "G40"), (9, 0, "comp-departure")),
    ((*SHAFT[:5], "X.3C.1", "G40", "Z1"), (8, 4, "corner-next")),
    ((*SHAFT[:5], "X.3", "Z1", "Z1", "G40"), (10, 0, "comp-departure-short")),
    # the contour
    ((*FACING, "X.2", "G03X.22Z-.02R.02", "X.4", "Z1", "G40"), (7, 0, "comp-gouge")),
    ((*FACING, "X.2", "G03X.21Z-.01R.01", "X.4", "Z1", "G40"), (7, 0, "comp-gouge")),
    ((*FACING, "X.2", "Z-.1", "X.15", "Z-.139", "X.2", "Z-.3", "X.3", "Z1", "G40"), (9, 0, "comp-gouge")),
    ((*FACING, "X.2", "Z-.1", "X.21Z-.11", "Z-.115", "X.3", "Z1", "G40"), (9, 0, "comp-gouge")),
    ((*FACING, "X.2", "X.1", "Z1", "G40"), (7, 0, "comp-gouge")),
    ((*FACING, "X.2", "Z-.3R.019", "X.4", "Z1", "G40"), (7, 0, "comp-gouge")),
]


@pytest.mark.parametrize(("program", "error"), REFUSED, ids=[" ".join(program) for program, _ in REFUSED])
def test_impossible_compensation_is_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    result = run(*program)
    assert error in result.errors
    assert all(block.line < error[0] for block in result.moves)


def test_error_inside_contour_discards_buffered_moves() -> None:
    result = run(*FACING, "X.2", "Z-.3", "G05", "X.3", "Z1", "G40", "X2")
    assert [error[2] for error in result.errors] == ["g-unknown"]
    assert [b.line for b in result.moves] == [3]


def test_contour_with_unreadable_line_is_not_checked_further() -> None:
    assert [error[2] for error in run(*FACING, "X.2", "X.1ZO", *SHAFT[4:]).errors] == ["letter-o"]
    assert [error[2] for error in run("X0Z0F9", "X.5C.1", "X.1ZO", "X.9").errors] == ["letter-o"]


def test_invalid_departure_is_found_before_contour_runs() -> None:
    result = run(*SHAFT[:5], "X.3", "Z-.281", "G40")
    assert result.errors == [(9, 0, "comp-departure-short")]
    assert [b.line for b in result.moves] == [3]


def test_gouge_message_states_nose_radius() -> None:
    found = run(*FACING, "X.2", "G03X.21Z-.01R.01", "X.4", "Z1", "G40").interpreter.diagnostics
    assert found[0].message.startswith("G41 with a nose radius of 0.02000 in cannot compensate this move: ")


def test_long_contour_is_not_buffered_completely() -> None:
    loop = ("LS2000", "G91", "Z-.05", "X.03", "LF", "G90")
    text = lines("G90G94F300", "M03S1000", *FACING, "X.2", *loop, "X61F300", "Z200", "G40", "M30")
    interpreter = Interpreter(read_program(ProgramSource("LONG", text)), given())
    most = count = 0
    for block in interpreter.generate_blocks():
        count = block.n
        contour = interpreter._modifier._nose._contour
        most = max(most, len(contour._held) if contour is not None else 0)
    assert not interpreter.has_errors
    assert count > 6000
    assert 64 < most < 2 * GOUGE_CHECK_ELEMENT_COUNT
