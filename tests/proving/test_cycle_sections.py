"""Cycles whose path sections are planned together give what they give when each is planned alone."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, ProgramSource
from core.motion.section_plans import SectionPlan
from core.motion.window_planner import PlannedChunk, WindowPlanner
from core.proving import program_timeline
from core.proving.program_timeline import MotionSpan, Timeline
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove
from tests.motion.test_section_plans import list_values

MACHINE = load_machine()
SETUP = create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={})
Values = list[object]


@st.composite
def threads(draw: st.DrawFn) -> str:
    """Draw a program with one to three threads, some of which the interpreter or the planner refuses."""
    metric, diameter = draw(st.booleans()), draw(st.booleans())
    lines = [f"G90G94F300{'G71' if metric else 'G70'}{'G72' if diameter else 'G73'}", "M03S400", "T1"]
    if metric:
        lines[0] = lines[0].replace("F300", "F7000")
    unit = 25.4 if metric else 1.0
    for _ in range(draw(st.integers(1, 3))):
        x, z = draw(st.integers(6, 12)) / 20.0 * unit, draw(st.integers(1, 6)) / 10.0 * unit
        depth = draw(st.integers(1, 60)) / 1000.0 * unit * draw(st.sampled_from([1, 1, 1, -1]))
        words = {
            "X": x - depth,
            "Z": z - draw(st.integers(1, 25)) / 10.0 * unit,
            "I": draw(st.integers(4, 40)) / 2000.0 * unit,
            "K": draw(st.integers(4, 199)) / 1000.0 * unit,
        }
        if draw(st.booleans()):
            words["C"] = draw(st.integers(0, 30))
        if draw(st.booleans()):
            words["A"] = draw(st.integers(-30, 30)) / 1000.0 * unit
        pull_out = draw(st.sampled_from(["", "", "P", "O"]))
        lines += [f"X{x:.4f}Z{z:.4f}", "G33" + "".join(f"{k}{v:.4f}" for k, v in words.items()) + pull_out]
        lines += draw(st.sampled_from([[], ["G04F.5"], ["M08"], ["G96S100"], ["G04F.1", "M03S900"]]))
    return "\n".join([*lines, f"G00X{0.7 * unit:.4f}", "M30", ""])


def read_spans(text: str, dialect: Dialect = Dialect.OMNITURN) -> tuple[Values, ProofReport]:
    """Return all numbers of the spans of a program, and its proof."""
    source = ProgramSource("T", text, dialect)
    timeline = Timeline.from_program(source, SETUP, MACHINE)
    found: Values = []
    for span in timeline.iter_spans():
        if isinstance(span, MotionSpan):
            found += list_values(span.planned_chunk.profile)
            found.append(
                (
                    span.start_time_s,
                    span.planned_chunk.start_time_s,
                    span.planned_chunk.block_numbers.tolist(),
                )
            )
            found += [span.planned_chunk.block_starts_s.tolist(), span.planned_chunk.block_ends_s.tolist()]
            found.append([(block.n, block.line, block.text) for block in span.blocks])
        else:
            found.append((span.start_time_s, span.end_time_s, span.block and span.block.n))
    found.append(timeline.diagnostics)
    return found, prove(source, SETUP, MACHINE)


def compare(monkeypatch: pytest.MonkeyPatch, text: str, dialect: Dialect = Dialect.OMNITURN) -> int:
    """Compare both ways of planning, and return the number of sections that were planned together."""
    together: list[SectionPlan] = []
    with monkeypatch.context() as patch:
        accept = WindowPlanner.accept_section

        def count_and_accept(planner: WindowPlanner, plan: SectionPlan) -> PlannedChunk:
            together.append(plan)
            return accept(planner, plan)

        patch.setattr(WindowPlanner, "accept_section", count_and_accept)
        spans, report = read_spans(text, dialect)
    count = len(together) // 2
    with monkeypatch.context() as patch:
        patch.setattr(program_timeline, "_MAX_BLOCKS_AHEAD", 0)
        assert read_spans(text, dialect) == (spans, report)
    return count


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(threads())
def test_threads_planned_together_equal_threads_planned_alone(text: str) -> None:
    with pytest.MonkeyPatch.context() as patch:
        compare(patch, text)


HEAD = "G90G94F300G72\nM03S500\nT1\nX1Z.2\n"


@pytest.mark.parametrize("words", ["", "C29", "A.02", "A-.02C15", "P", "PA.02C"])
def test_passes_of_a_thread_are_planned_together(monkeypatch: pytest.MonkeyPatch, words: str) -> None:
    """After k passes, the depth is .01 in·(√k - 1): 0.05 in of radius below the start take 36 passes.

    The first section is planned alone, and so is the last section, because the next line may continue it.
    """
    text = f"{HEAD}G33X.9Z-.5I.02K.05{words}\nG00X1.2\nM30\n"
    assert compare(monkeypatch, text) >= 60 - 26 * ("P" in words)


def test_sections_of_a_long_cycle_are_read_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The thread takes (0.05/0.00185 + 1)² passes, more than 256 blocks at once."""
    assert compare(monkeypatch, f"{HEAD}G33X.95Z-.5I.0037K.05\nM30\n") > 256


def test_starts_of_a_metric_thread_on_another_control(monkeypatch: pytest.MonkeyPatch) -> None:
    cycle = "CYCLE97(3,,0,-20,40,40,4,2,1.84,0.05,30,0,6,1,3,2)"
    text = f"G90 G18 G71\nT1 D1\nG97 S500 M3\nG0 X50 Z10\n{cycle}\nM30\n"
    assert compare(monkeypatch, text, Dialect.SINUMERIK) > 10


HOLE = "G90 G17 G71\nT1 D1\nG97 S500 M3\nG95 F0.1\nG0 X0 Z10\n"


@pytest.mark.parametrize(
    ("cycle", "together"),
    [
        ("CYCLE83(5,0,2,-40,,-5,,2,1,0.5,1,1)", 30),
        ("CYCLE83(5,0,2,-40,,-5,,2,0,0,1,0)", 0),  # without a dwell, all pecks are one section
        ("CYCLE82(5,0,2,-5,,1)", 0),  # two sections with a dwell between them
    ],
)
def test_pecks_between_dwells_are_planned_together(
    monkeypatch: pytest.MonkeyPatch, cycle: str, together: int
) -> None:
    """Pecks of 5, 3 and then 2 mm are 18 pecks for 40 mm; each has a section in and a section out."""
    count = compare(monkeypatch, f"{HOLE}{cycle}\nM30\n", Dialect.SINUMERIK)
    assert (count >= together) if together else (count == 0)


@pytest.mark.parametrize(
    "text",
    [
        f"{HEAD}G96S300\nG33X.9Z-.5I.02K.05\nM30\n",
        f"{HEAD}G33X.9Z.2I.02K.05\nM30\n",
        f"{HEAD}G33X.9Z-.5I.02K.05\nG33X-.9Z-.5I.02K.05\nM30\n",
        "G90G94F300G72\nT1\nX1Z.2\nG33X.9Z-.5I.02K.05\nM30\n",
    ],
    ids=["surface speed", "no length", "second thread beyond the axis", "spindle stopped"],
)
def test_refused_threads_give_the_same_findings(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    compare(monkeypatch, text)
    assert read_spans(text)[1].errors


def test_pass_that_the_planner_refuses_is_refused_at_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """A planner that reports no plan for any section leaves the error to the section of the block."""
    monkeypatch.setattr(WindowPlanner, "plan_sections_ahead", lambda _, sections: [None] * len(sections))
    text = f"{HEAD}G33X.9Z-.5I.02K.05\nM30\n"
    refused, report = read_spans(text)
    monkeypatch.undo()
    assert read_spans(text) == (refused, report)
