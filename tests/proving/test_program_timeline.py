"""An ideal machine: times by feeds and limits of speed alone, for every language; no waits, no ramps."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, ProgramSource
from core.proving.program_timeline import Timeline, iter_timed_blocks
from core.proving.prove_program import prove

MACHINE = load_machine()
HEAD = "G90G94F300G73\nM03S600\nT1\nX.3Z.2\nX.25\n"


def laid(
    text: str, dialect: Dialect = Dialect.OMNITURN, *, ideal: bool = True
) -> list[tuple[BlockKind, float]]:
    setup = create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    timeline = Timeline.from_program(ProgramSource("T", text, dialect), setup, MACHINE, is_ideal=ideal)
    found = [(block.kind, t1 - t0) for block, t0, t1 in iter_timed_blocks(timeline)]
    assert not timeline.has_errors, timeline.diagnostics
    return found


def test_move_time_is_length_over_feed() -> None:
    """.1 in of radius and .1 in of Z at 300 in/min, then 2 in at .01 in/rev and 600 rpm: 20 s."""
    times = [t for kind, t in laid(HEAD + "G95F.01\nZ-1.8\nM30\n") if kind is BlockKind.FEED]
    assert times[-1] == pytest.approx(20.0, abs=1e-6)


def test_corners_and_spindle_waits_have_zero_time_on_ideal_machine() -> None:
    """Eight sides of 1 in at 60 in/min are 8 s, however sharp; the spindle is at speed at once."""
    side = "Z-.8\nX.125\nZ.2\nX.25\n"
    text = HEAD + "G94F60\n" + side * 2 + "M30\n"
    report = prove(
        ProgramSource("T", text),
        create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
        MACHINE,
        is_ideal=True,
    )
    assert report.program_times.wait_time_s == 0.0
    assert report.program_times.cutting_time_s == pytest.approx(2 * (1.0 + 0.125 + 1.0 + 0.125), abs=1e-6)


def test_thread_does_not_wait_for_index_on_ideal_machine() -> None:
    """Ten turns of .1 s a pass, and nothing before it."""
    found = laid(HEAD + "G33X.249Z-.8I.01K.1\nM30\n")
    assert [t for kind, t in found if kind is BlockKind.THREAD] == pytest.approx([1.0, 1.0], abs=1e-6)


def test_real_machine_needs_more_time() -> None:
    text = HEAD + "G94F60\nZ-.8\nX.125\nM30\n"
    assert sum(t for _, t in laid(text, ideal=False)) > sum(t for _, t in laid(text))
