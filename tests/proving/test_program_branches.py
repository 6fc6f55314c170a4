"""Conditional calls and block delete: what the program may do is proved, not only what it would do now."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.compose.machine.machine_files import load_machine, load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.interpreter.dialects import SharedProgram
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Severity
from core.language.source import ProgramSource, load_source
from core.proving import program_branches
from core.proving.checks.machine_checks import check_travel
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove
from tests.screen.desks import SAMPLES

pytestmark = pytest.mark.long

MACHINE = load_machine(None)
HEAD = ("G90G94F300", "T1", "X.5Z.1")


def circumstances(**inputs: bool) -> InterpreterSetup:
    """All tools on part zero; inputs by number, such as ``i10=True``."""
    states = {name.removeprefix("i"): on for name, on in inputs.items()}
    return create_power_up_setup(
        MACHINE, tool_offsets={1: ToolOffset(), 2: ToolOffset()}, secondary_offsets={}, input_states=states
    )


def proved(*lines: str, deleted: bool = False, **inputs: bool) -> ProofReport:
    setup = replace(circumstances(**inputs), block_delete=deleted)
    return prove(ProgramSource("A", "\n".join((*HEAD, *lines, ""))), setup, MACHINE)


def errors(report: ProofReport) -> list[tuple[int, str]]:
    return [(d.line, d.code) for d in report.errors]


BEYOND = "Z-9"  # the travel ends at -6
SUB = ("M30", "}1", BEYOND, "Z.1", "M99")


@pytest.mark.parametrize("call", ["M95", "M97I10C1P1", "M97I10C0P1"])
@pytest.mark.parametrize("on", [False, True])
def test_branch_beyond_travel_rejects_start_for_any_input_state(call: str, on: bool) -> None:
    report = proved(call, *SUB, **{"i10": on, "iTB2-9": on})
    assert errors(report) == [(7, "soft-limit")]


def test_the_branch_and_its_input_are_named() -> None:
    (found,) = proved("M97I10C1P1", *SUB).errors
    assert found.message.startswith("If input 10 is on at line 4: Z would move to -9.0000 in")
    (found,) = proved("M97I10C0P1", *SUB, i10=True).errors
    assert found.message.startswith("If input 10 is off at line 4: ")
    (found,) = proved("M95", *SUB).errors
    assert found.message.startswith("If input 7 is on at line 4: ")


def test_finding_of_currently_active_branch_has_no_condition() -> None:
    (found,) = proved("M97I10C1P1", *SUB, i10=True).errors
    assert found.message.startswith("Z would move to")


def test_state_left_by_branch_is_proved_in_following_lines() -> None:
    # the subroutine is harmless; the lines behind its call are not
    report = proved("M97I1C1P1", "G91Z-5", "G90", "M30", "}1", "Z-2", "M99")
    assert errors(report) == [(5, "soft-limit")]


def test_two_inputs_harmful_only_together_are_found() -> None:
    sub = ("G90", "M30", "}1", "G91Z-4", "M99")
    assert errors(proved("M97I1C1P1", "M97I2C1P1", *sub)) == [(9, "soft-limit")]
    (found,) = proved("M97I1C1P1", "M97I2C1P1", *sub).errors
    assert "If input 1 is on at line 4 and input 2 is on at line 5: " in found.message
    assert errors(proved("M97I1C1P1", *sub)) == []


def test_input_that_turns_on_in_later_loop_pass_is_proved() -> None:
    # each pass goes .5 in deeper; only late in the loop does the subroutine lead out
    report = proved("LS6", "G91Z-.5", "M97I3C1P1", "G90", "LF", "M30", "}1", "Z-3.5", "Z3.5", "M99")
    assert errors(report) == [(11, "soft-limit")]


def test_conditional_call_inside_subroutine_is_proved() -> None:
    report = proved("M98P1", "M30", "}1", "M97I4C0P2", "M99", "}2", "M97I5C1P3", "M99", "}3", BEYOND, "M99")
    assert errors(report) == [(13, "soft-limit")]


def test_branch_that_ends_job_is_proved() -> None:
    assert errors(proved("M95", "G91Z-5", "M30", "}1", "Z-5", "M30")) == []
    assert errors(proved("M95", "G91Z-5", "M30", "}1", "Z-5", "M99")) == [(5, "soft-limit")]


@pytest.mark.parametrize("deleted", [False, True])
def test_block_delete_is_proved_on_and_off(deleted: bool) -> None:
    """With the line the next one leaves the travel: an error where the switch stands so, else a warning."""
    report = proved("/Z-1", "G91Z-5.5", "Z1", "M30", deleted=deleted)
    assert errors(report) == ([] if deleted else [(5, "soft-limit")])
    (found,) = [each for each in report.diagnostics if each.code == "soft-limit"]
    assert found.message.startswith("With block delete off: Z would" if deleted else "Z would")


def test_block_delete_and_input_are_proved_together() -> None:
    report = proved("/Z-3", "M97I1C1P1", "M30", "}1", "G91Z-4", "G90", "M99", deleted=True)
    (found,) = [each for each in report.diagnostics if each.code == "soft-limit"]
    assert (found.severity, errors(report)) == (Severity.WARNING, [])
    assert found.message.startswith("With block delete off: If input 1 is on at line 5: Z would")


def test_block_delete_of_first_line_is_proved() -> None:
    report = prove(ProgramSource("A", "/G90G94F300\nG04F1\nM30\n"), circumstances(), MACHINE)
    assert [(d.line, d.severity) for d in report.diagnostics if d.code == "first-line"] == [
        (2, Severity.WARNING)
    ]
    given = replace(circumstances(), block_delete=True)
    report = prove(ProgramSource("A", "/G90G94F300\nG04F1\nM30\n"), given, MACHINE)
    assert errors(report) == [(2, "first-line")]


def test_slash_lines_in_klartext_and_sinumerik_are_proved_on_and_off() -> None:
    machine = load_machine(None)
    text = "N10 G18 G90 G54 G94 T1 D1\nN20 G0 X20 Z3\n/N30 G1 Z-900 F300\nN40 M30\n"
    report = prove(ProgramSource("a.mpf", text), replace(circumstances(), block_delete=True), machine)
    assert [(d.line, d.code, d.severity) for d in report.diagnostics if d.line == 3] == [
        (3, "soft-limit", Severity.WARNING)
    ]
    assert (3, "soft-limit") in errors(prove(ProgramSource("a.mpf", text), circumstances(), machine))


ENDS_BEFORE = """BEGIN PGM BD MM
TOOL CALL 1 Z S3000 F500
L X+10 R0 FMAX M3
/M30
LBL "CHECK"
FN 9: IF +Q1900 EQU +1 GOTO LBL "CHECK"
END PGM BD MM
"""


def test_start_depends_on_current_block_delete_switch() -> None:
    """With the switch on the program runs on into a parameter that nothing has set."""
    mill = load_shipped_machine("ac-table-mill")
    around = create_power_up_setup(mill, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    source = ProgramSource("bd.h", ENDS_BEFORE)
    assert prove(source, around, mill).errors == ()
    report = prove(source, replace(around, block_delete=True), mill)
    assert [(d.line, d.code) for d in report.errors] == [(6, "Q parameter not defined")]


def test_tool_of_other_block_delete_setting_does_not_prevent_start() -> None:
    report = proved("/T7", "/X.5Z.1", "M30", deleted=True)
    assert (report.missing_tool_numbers, report.tool_numbers) == ((), (1,))
    assert proved("/T7", "/X.5Z.1", "M30").missing_tool_numbers == (7,)


def test_tool_used_only_in_branch_is_required_before_start() -> None:
    report = proved("M97I1C1P1", "M30", "}1", "T7", "X.5Z.1", "M99")
    assert report.missing_tool_numbers == (7,)
    assert report.tool_numbers == (1, 7)


def test_the_checks_of_cutting_hold_in_branches() -> None:
    report = proved("M03S500", "M97I1C1P1", "G95F.004Z-.2", "M30", "}1", "M13", "M99")
    found = {(d.line, d.check_name, str(d.severity)) for d in report.diagnostics}
    assert (6, "collet-open", "error") in found  # the cut, after a subroutine that has left it open


def test_input_change_between_two_reads_is_a_warning() -> None:
    # if and else of one input: neither or both is possible only when it changes in between
    twice = ("M97I1C1P1", "M97I1C0P2", "G91Z-4", "G90", "M30", "}1", "Z3", "M99", "}2", "Z4", "M99")
    assert errors(proved(*twice)) == []
    lines = ("G91Z-4", "G90", "M97I1C1P1", "M97I1C0P2", "G91Z-4", "M30", "}1", "Z3", "M99", "}2", "Z4", "M99")
    found = [d for d in proved(*lines).diagnostics if d.code == "soft-limit"]
    assert [(str(d.severity), d.line) for d in found] == [("warning", 8)]


def test_cycle_time_range_covers_input_states() -> None:
    lines = ("LS4", "Z-1F20", "M97I1C1P1", "Z.1F300", "LF", "M30", "}1", "X1F10", "G04F2", "X.5", "M99")
    off, on = proved(*lines), proved(*lines, i1=True)
    assert off.program_times.cycle_time_s < on.program_times.cycle_time_s - 10
    for report in (off, on):
        assert report.branch_summary.cycle_time_range == pytest.approx(
            (off.program_times.cycle_time_s, on.program_times.cycle_time_s), abs=0.05
        )
        assert report.branch_summary.proved_count == 5


def test_cycle_time_range_covers_block_delete() -> None:
    lines = ("/G04F3", "G04F1", "M30")
    off, on = proved(*lines), proved(*lines, deleted=True)
    assert off.program_times.cycle_time_s == pytest.approx(on.program_times.cycle_time_s + 3)
    assert (
        off.branch_summary.cycle_time_range
        == on.branch_summary.cycle_time_range
        == (on.program_times.cycle_time_s, off.program_times.cycle_time_s)
    )


def test_program_without_inputs_is_proved_once() -> None:
    reading = SharedProgram(ProgramSource("A", "\n".join((*HEAD, "M98P1", *SUB))))
    assert program_branches.BranchProof(reading, circumstances(), MACHINE, ideal=False).root_pass is None
    report = proved("Z-1", "M30")
    assert (report.branch_summary.proved_count, report.branch_summary.unproved_count) == (1, 0)
    assert report.branch_summary.cycle_time_range == (report.program_times.cycle_time_s,) * 2


def many(count: int) -> tuple[str, ...]:
    """Calls whose outcomes leave the slide at as many places as there are sets of them."""
    calls = [line for k in range(count) for line in (f"M97I{k % 16 + 1}C1P{k + 1}", "G91X.0001", "G90")]
    subs = [line for k in range(count) for line in (f"}}{k + 1}", f"G91Z-{0.0001 * 2**k:.4f}", "G90", "M99")]
    return (*calls, "M30", *subs)


def test_unproved_branches_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    assert [d.code for d in proved(*many(5)).diagnostics] == []
    monkeypatch.setattr(program_branches, "MAX_BRANCHES", 3)
    report = proved(*many(5))
    (found,) = report.diagnostics
    assert (found.code, found.check_name, str(found.severity)) == (
        "unreached-branch",
        "unreached-branch",
        "warning",
    )
    assert "Branches not proved: input " in found.message
    assert report.branch_summary.proved_count == 3


def test_too_many_input_combinations_end_proof_with_one_finding() -> None:
    report = proved(*many(14))
    assert report.branch_summary.unproved_count > 0
    assert [d.code for d in report.diagnostics] == ["unreached-branch"]
    assert "Never proved" not in report.diagnostics[0].message  # every subroutine was


def test_a_loop_of_bar_work_with_many_passes_is_proved() -> None:
    sub = ("LF", "M30", "}1", "X.6Z.2", "X.5Z.1", "M99")
    report = proved("LS900", "Z-.1F50", "M97I1C1P1", "Z.1", *sub)
    assert errors(report) == []
    assert report.branch_summary.proved_count == program_branches.MAX_BRANCHES


def test_uncalled_subroutine_is_reported() -> None:
    report = proved("M98P1", "M30", "}1", "Z.2", "M99", "}2", BEYOND, "P3", "M99", "}3", "Z.3", "M99")
    notes = [(d.line, str(d.severity), d.code) for d in report.diagnostics]
    assert notes == [(9, "note", "unreached-branch"), (13, "note", "unreached-branch")]


def test_bar_feeder_sample_and_its_end_of_bar_branch_are_proved() -> None:
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    source = load_source(SAMPLES / "pinbar.nc")
    setup = create_power_up_setup(MACHINE, tool_offsets=tools, secondary_offsets=secondary)
    assert prove(source, setup, MACHINE).branch_summary.proved_count == 2
    worse = replace(source, text=source.text.replace("M31\n", "M31\nZ9.5\n"))
    (found,) = prove(worse, setup, MACHINE).errors
    assert (found.line, found.code) == (35, "soft-limit")
    assert found.message.startswith("If input 7 is on at line 31: Z would move to 6.3000 in")


# every set of answers, one after the other, against what the proof finds

STEP = st.sampled_from(["G91Z-1.2", "G91Z.9", "Z-1", "X.5", "/G91Z-.8", "G92Z0", "M98P3"])
CALL = st.sampled_from(["M97I1C1P1", "M97I2C0P2", "M95", "/M97I3C1P2"])
BODY = st.lists(STEP | CALL, min_size=1, max_size=5)
SHORT = st.lists(STEP, min_size=1, max_size=3)


def text_of(main: list[str], one: list[str], two: list[str], three: list[str]) -> str:
    subs = (("}1", *one, "M99"), ("}2", *two, "M99"), ("}3", *three, "M99"))
    return "\n".join((*HEAD, *(("LS2", *main[:2], "LF", *main[2:])), "M30", *sum(subs, ()), ""))


def in_turn(answers: Sequence[bool]) -> Callable[[str], bool]:
    """What the inputs say, whichever is asked."""
    said = iter(answers)
    return lambda _terminal: next(said)


def by_every_answer(text: str, questions: int) -> Iterator[int]:
    """The lines that leave the travel, with each set of answers to so many questions in turn."""
    reading = SharedProgram(ProgramSource("A", text))
    for deleted, answers in product((False, True), product((False, True), repeat=questions)):
        interpreter = reading.start_pass(replace(circumstances(), block_delete=deleted))
        assert isinstance(interpreter, Interpreter)
        state = interpreter._state
        state.setup = replace(state.setup, inputs=in_turn(answers))
        moves = [block for block in interpreter.generate_blocks() if block.moves]
        yield from (found.line for found in check_travel(moves, MACHINE))


@settings(max_examples=40, deadline=None)
@given(BODY, SHORT, SHORT, SHORT)
def test_proof_finds_exactly_errors_of_possible_input_states(
    main: list[str], one: list[str], two: list[str], three: list[str]
) -> None:
    text = text_of(main, one, two, three)
    questions = sum((1 + (at < 2)) * (each.lstrip("/")[:3] in {"M97", "M95"}) for at, each in enumerate(main))
    expected = set(by_every_answer(text, questions))
    report = prove(ProgramSource("A", text), circumstances(), MACHINE)
    assert {d.line for d in report.diagnostics if d.code == "soft-limit"} == expected
    assert report.branch_summary.unproved_count == 0
