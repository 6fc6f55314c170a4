"""Programs that must not run: each with the line, the column and the code of its error."""

from __future__ import annotations

import pytest

from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared.job_setup import ControlLimits
from core.language.source import ProgramSource
from tests.interpreter.programs import body, lines, passed, setup

END = "M30"
SUB = ("M30", "}1", "X1", "M99")

# In these the first line given is line 3 of the program, after a head with feed 300 and the spindle at 1000.
IN_BODY: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    # what may stand on one line
    (("M08M03",), (3, 4, "two-m-codes")),
    (("G02G03X1",), (3, 4, "two-one-shots")),
    (("G92G10X1",), (3, 4, "two-one-shots")),
    (("G04F1G02X1R1",), (3, 6, "two-one-shots")),
    (("G90G91X1",), (3, 4, "modal-conflict")),
    (("G94X1G95",), (3, 6, "modal-conflict")),
    (("G00G01X1",), (3, 4, "modal-conflict")),
    (("G70G71",), (3, 4, "modal-conflict")),
    (("G72G73",), (3, 4, "modal-conflict")),
    (("G96G97S5",), (3, 4, "modal-conflict")),
    (("X1Z1X2",), (3, 5, "word-twice")),
    (("G76S1G77S2",), (3, 9, "word-twice")),
    (("X1I.5",), (3, 3, "word-unused")),
    (("G04X1F2",), (3, 1, "other-control")),
    (("X1U1",), (3, 3, "word-unused")),
    (("X1A.1",), (3, 3, "word-unused")),
    (("X1L3",), (3, 3, "word-unused")),
    (("O",), (3, 1, "letter-o")),
    # unknown codes
    (("G05X1",), (3, 1, "g-unknown")),
    (("X1G28",), (3, 3, "g-unknown")),
    (("M77",), (3, 1, "m-unknown")),
    (("X1M06",), (3, 3, "m-unknown")),
    # feeds
    (("G95X1",), (3, 0, "feed-missing")),
    (("G95F.003", "G94X1"), (4, 0, "feed-missing")),
    (("X1F301",), (3, 3, "feed-range")),
    (("X1F.00004",), (3, 3, "feed-range")),
    (("G95F.21X1",), (3, 4, "feed-range")),
    (("G95F.00004X1",), (3, 4, "feed-range")),
    (("G71F7621X1",), (3, 4, "feed-range")),
    (("S3500", "G95F.1X1"), (4, 0, "feed-over-speed")),
    (("G01X1",), (3, 1, "no-cut-feed")),
    (("G00X1F5",), (3, 1, "rapid-and-feed")),
    (("G00G94X1",), (3, 1, "rapid-and-feed")),
    (("M05", "G95F.003X1"), (4, 0, "spindle-stopped")),
    (("M05", "G96S200", "F5X1"), (5, 0, "spindle-stopped")),
    (("G96", "F5X1"), (4, 0, "surface-speed-missing")),
    # dwell
    (("G04",), (3, 1, "word-missing")),
    (("G04F.05",), (3, 4, "dwell-range")),
    # arcs
    (("G02X1",), (3, 1, "arc-centre-missing")),
    (("G02X1R1I1",), (3, 8, "arc-both")),
    (("G02X1R1K1",), (3, 8, "arc-both")),
    (("G02X1Z1R-2",), (3, 8, "arc-r-sign")),
    (("G02X1Z1R0",), (3, 8, "arc-r-sign")),
    (("X1Z1", "G02X1Z1R1"), (4, 8, "arc-no-chord")),
    (("X0Z0F9", "G02X1Z0R.4997"), (4, 8, "arc-radius")),
    (("X0Z0F9", "G02X1Z0I.6K0"), (4, 1, "arc-radius")),
    (("X.1Z0F9", "G02X.2506Z-.15I.1K-.15"), (4, 1, "arc-radius")),
    (("X1Z1", "G02X2I1"), (4, 6, "arc-coordinate-missing")),
    (("X1Z1", "G02X2K1"), (4, 6, "arc-coordinate-missing")),
    (("X1Z1", "G72G91", "G02X.1Z-.1R.1"), (5, 1, "arc-mode")),
    (("X1Z1", "G72G91G03X.1I.1"), (4, 7, "arc-mode")),
    (("G72X1Z1", "G02X1Z1I0K0"), (4, 1, "arc-no-radius")),
    # tools and frames
    (("T1", "X1"), (4, 0, "tool-first-move")),
    (("T1", "X1Z1", "X2Z2", "T1", "X1"), (7, 0, "tool-first-move")),
    (("T1Z1",), (3, 0, "tool-first-move")),
    (("T1", "G02X1R1"), (4, 0, "tool-first-move")),
    (("T1", "G10X0Z0", "Z1"), (5, 0, "tool-first-move")),
    (("G10",), (3, 1, "word-missing")),
    (("G92S500",), (3, 1, "other-control")),
    # spindle
    (("S3501",), (3, 1, "speed-range")),
    (("S-5",), (3, 1, "speed-sign")),
    (("G96S99999",), (3, 4, "speed-range")),
    (("G76",), (3, 0, "word-missing")),
    (("G77S-1",), (3, 4, "word-missing")),
    (("G77S500", "G76S600"), (4, 4, "speed-limits")),
    (("M05", "M13", "M03"), (5, 1, "collet-open")),
    (("M05", "S0", "M04"), (5, 1, "speed-missing")),
    # loops
    (("LS2", "X1"), (3, 1, "loop-open")),
    (("X1", "LF"), (4, 1, "loop-unopened")),
    (("LS2X1", "LF"), (3, 4, "not-alone")),
    (("LS2", "X1LF"), (4, 1, "not-alone")),
    (("/LS2", "X1", "LF"), (3, 2, "block-delete-flow")),
    # calls
    (("M98P1",), (3, 4, "subroutine-missing")),
    (("P3",), (3, 1, "subroutine-missing")),
    (("M95",), (3, 1, "subroutine-missing")),
    (("M97I1C1P4",), (3, 8, "subroutine-missing")),
    (("M98",), (3, 1, "word-missing")),
    (("M98P1X1", *SUB), (3, 6, "not-alone")),
    (("M97I1P1", *SUB), (3, 1, "word-missing")),
    (("M97I1C2P1", *SUB), (3, 6, "condition")),
    (("M97I1.5C1P1", *SUB), (3, 4, "input-number")),
    (("M99",), (3, 1, "m99-outside")),
    # codes that cannot run yet
    # corners and nose compensation, more of them in files of their own
    (("G41",), (4, 1, "comp-open")),
    (("X1Z1C.1",), (3, 5, "corner-next")),
    (("X1Z1R.1",), (3, 5, "corner-next")),
    (("G75I.05",), (3, 1, "contour-open")),
    (("G33X1Z1K.05PCO",), (3, 1, "thread-depth")),
    (("G35F2",), (3, 1, "coarse-preset")),
    (("CA90",), (3, 1, "c-unlocked")),
    (("RF",), (3, 1, "rf-alone")),
    (("(~PLXC)", "(x1y2)", "(END)"), (3, 1, "c-unlocked")),
]


@pytest.mark.parametrize(("program", "error"), IN_BODY, ids=[" ".join(program) for program, _ in IN_BODY])
def test_invalid_program_is_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    result = passed(body(*program))
    assert error in result.errors
    assert all(block.line < error[0] or not block.moves for block in result.blocks if block.line <= error[0])
    assert result.interpreter.has_errors


@pytest.mark.parametrize("program", [
    ("X0Z0F9", "G02X1Z0I.5K0"),
    ("X0Z0F9", "G02X1Z0R.4998"),
    ("X.1Z0F9", "G02X.25Z-.1494I.1K-.15"),
    ("S3000", "G95F.1X1"),
    ("X1F300", "X2F.001"),
    ("G95F.2X1",),
    ("T1", "G92X0", "Z1"),
    ("G90G90X1",),
])  # fmt: skip
def test_valid_program_close_to_invalid_one_is_accepted(program: tuple[str, ...]) -> None:
    assert passed(body(*program)).errors == []


WHOLE: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    (("X1", END), (1, 1, "first-line")),
    (("G94F300", "G90", END), (1, 1, "first-line")),
    (("LS2", "G90X1", "LF", END), (1, 1, "first-line")),
    (("G90F300", "X1"), (2, 0, "no-end")),
    (("G90F300", "/M30"), (2, 0, "no-end")),
    (("G90F300", "}1", "X1", "M99", END), (1, 0, "no-end")),
    (("G90F300", END, "X1"), (3, 1, "after-end")),
    (("G90F300", END, "T1"), (3, 1, "after-end")),
    (("G90F300", *SUB, "X2"), (6, 1, "after-end")),
    (("G90F300", *SUB, "}1", "M99"), (6, 1, "subroutine-twice")),
    (("G90F300", END, "}1", "X1"), (3, 1, "subroutine-open")),
    (("G90F300", END, "}1", "X1", "}2", "M99"), (5, 1, "subroutine-open")),
    (("G90F300", END, "}1", "LS2", "X1", "M99"), (4, 1, "loop-open")),
    (("G90F300", "LS2", END, "}1", "LF", "M99"), (2, 1, "loop-open")),
    (("G90F300", "M98P1", END, "}1", "M98P1", "M99"), (5, 4, "recursion")),
    (("G90F300", "P1", END, "}1", "P2", "M99", "}2", "P1", "M99"), (8, 1, "recursion")),
    (("G90F301", END), (1, 4, "feed-range")),
    (("G90F.1", "X1", "M03", END), (3, 1, "speed-missing")),
]


@pytest.mark.parametrize(("program", "error"), WHOLE, ids=[" ".join(program) for program, _ in WHOLE])
def test_program_is_rejected_as_whole(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    result = passed(lines(*program))
    assert error in result.errors


def test_an_empty_program_is_refused() -> None:
    assert (0, 0, "file-empty") in passed("").errors


def test_unclamping_while_turning_can_be_refused() -> None:
    strict = setup(limits=ControlLimits(can_unclamp_while_turning=False))
    assert passed(body("M13"), strict).errors == [(3, 1, "unclamp-turning")]
    assert passed(body("M05", "M13"), strict).errors == []


def test_no_block_follows_an_error_and_all_errors_are_reported() -> None:
    result = passed(body("X1", "X2F999", "X3", "S9000", "G02X1", "X4"))
    assert [block.line for block in result.moves] == [3]
    assert result.errors == [(4, 3, "feed-range"), (6, 1, "speed-range"), (7, 1, "arc-centre-missing")]


def test_run_gets_no_blocks_after_first_error() -> None:
    program = passed(body("X1", "X2F999", "S9000")).program
    from_run = list(Interpreter(program, setup()).generate_blocks(stops_at_first_error=True))
    assert [block.line for block in from_run] == [2, 3]


def test_stopped_spindle_is_reported_once_per_stop() -> None:
    result = passed(body("M05", "G95F.003X1", "X2", "X3", "M03", "X4", "M05", "X5"))
    assert result.errors == [(4, 0, "spindle-stopped"), (10, 0, "spindle-stopped")]


def test_lines_after_error_are_checked_from_intended_end_point() -> None:
    result = passed(body("X.1Z0F999", "G02X.25Z-.15I.1K-.15"))
    assert result.errors == [(3, 6, "feed-range")]


def test_error_list_is_limited_to_100() -> None:
    result = passed(body(*["X1F999"] * 500))
    assert len(result.errors) == 100


def test_warnings_do_not_displace_errors() -> None:
    result = passed(body("F.05", *["X9", "X0"] * 150, "S9000"))
    assert result.errors == [(304, 1, "speed-range")]
    assert len(result.warnings) == 100


def test_repeated_warning_counts_as_one_finding() -> None:
    result = passed(body(*["X.00001"] * 300, "F.05X9"))
    assert [(d.line, d.code, d.occurrence_count) for d in result.interpreter.diagnostics] == [
        (3, "finer-than-step", 300),
        (303, "feed-low", 1),
    ]


@pytest.mark.parametrize(
    "body",
    [
        ("LS0", "X1", "LF"),
        ("LS2,5", "X1", "LF"),
        ("LS2", "X1", "LF3"),
        ("LS0", "X1"),
        ("P1", END, "}1", "X1", "M99", "}1", "X2", "M99"),
    ],
)
def test_mistake_is_reported_without_consequential_errors(body: tuple[str, ...]) -> None:
    text = "\n".join(("G90F300", *body, *(() if END in body else (END,))))
    found = [d.code for d in read_program(ProgramSource("A", text)).diagnostics if d.severity == "error"]
    assert len(found) == 1, found
