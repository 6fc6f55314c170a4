"""Threads laid out in time: each pass begins at the index of the spindle as it is foretold."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.program_timeline import MotionSpan, Timeline, iter_timed_blocks
from core.proving.prove_program import prove
from core.proving.setpoint_trace import iter_setpoints
from core.proving.spindle_forecast import SpindleForecast

MACHINE = load_machine()
HEAD = "G90G94F300G73\nM03S600\nT1\nX.3Z.2\nX.25\n"
MULTI = "".join(f"Z{z}\nG33X.24Z-.5I.01K.15\n" for z in (".2", ".25", ".3"))


def timeline(text: str) -> Timeline:
    setup = create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    return Timeline.from_program(ProgramSource("T", text), setup, MACHINE)


def test_thread_pass_duration_matches_its_revolutions() -> None:
    laid = timeline(HEAD + "G33X.25Z-.8I.01K.1\nM30\n".replace("X.25Z", "X.249Z"))
    times = [t1 - t0 for block, t0, t1 in iter_timed_blocks(laid) if block.kind is BlockKind.THREAD]
    # ten turns of .1 s, and half a ramp of 25.4 mm/s at 3048 mm/s² at each end
    assert times == [pytest.approx(1.0 + 25.4 / 3048, abs=2e-3)] * len(times)
    assert len(times) == 2


@pytest.mark.parametrize("rpm", [600, 730])
def test_starts_a_third_of_the_lead_apart_make_helices_120_degrees_apart(rpm: int) -> None:
    laid = timeline(HEAD.replace("600", str(rpm)) + MULTI + "M30\n")
    crossed: list[tuple[int, float]] = []
    before: tuple[float, float, int] | None = None
    for rows in iter_setpoints(laid, 0.001):
        for z, degrees, line in zip(
            rows.positions[:, 1], rows.spindle_angles_deg, rows.line_numbers, strict=True
        ):
            fed = before and line == before[2] and 0.0 < before[0] - z < 2.2 * 25.4 * 0.15 * rpm / 60 * 0.001
            if before and fed and before[0] > 0.0 >= z and before[0] - z < 0.08:
                share = before[0] / (before[0] - z)
                crossed.append((line, (before[1] + share * (degrees - before[1])) % 360.0))
            before = z, degrees, line
    first = dict(reversed(crossed))
    angles = [first[line] for line in sorted(first)]
    assert len(angles) == 3
    assert [(angle - angles[0]) % 360 for angle in angles] == pytest.approx([0.0, 120.0, 240.0], abs=0.2)
    for line, angle in crossed:
        assert angle == pytest.approx(first[line], abs=0.2)  # every pass of a start in the same groove


def test_thread_start_wait_is_at_most_one_revolution() -> None:
    laid = timeline(HEAD + "G33X.24Z-.5I.01K.05PC\nM30\n")
    waits, rests = [], []
    for span in laid.iter_spans():
        if not isinstance(span, MotionSpan):
            rests.append(span.end_time_s - span.start_time_s)
        elif span.blocks[0].kind is BlockKind.THREAD:
            waits.append(rests[-1])  # behind the settling and the commit
    assert len(waits) == 4
    assert all(0.0 <= wait <= 0.1 for wait in waits)
    assert len({round(wait, 4) for wait in waits}) > 1


def test_revolutions_are_integral_of_spindle_speed() -> None:
    spindle = SpindleForecast(MACHINE)
    spindle.command_speed(0.0, 600.0)  # from .08 on 1500 rpm/s: .4 s and 2 turns
    assert spindle.calculate_revolutions_at(0.08) == 0.0
    assert spindle.calculate_revolutions_at(0.48) == pytest.approx(2.0)
    assert spindle.calculate_revolutions_at(1.48) == pytest.approx(12.0)
    spindle.command_speed(
        2.0, -300.0
    )  # .8 turns at speed, then 600 rpm down at 2500 rpm/s, 300 up at 1500 rpm/s
    assert spindle.calculate_revolutions_at(3.0) == pytest.approx(
        17.2 + 0.8 + 5.0 * 0.24 - 2.5 * 0.2 - 5.0 * (1.0 - 0.08 - 0.44)
    )


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (HEAD + "M05\nG33X.24Z-.5I.01K.05\nM30\n", "spindle-stopped"),
        (HEAD + "G33X.24Z-7I.01K.05\nM30\n", "soft-limit"),
        (HEAD + "G33X.24Z-.5I.01F.05\nM30\n", "thread-lead-missing"),
    ],
)
def test_proof_rejects_invalid_threads(text: str, code: str) -> None:
    report = prove(
        ProgramSource("T", text),
        create_power_up_setup(MACHINE, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
        MACHINE,
    )
    assert code in {found.code for found in report.errors}
