"""One forecast: proof, trace and what is shown of a program end at the same time, whoever looks."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset
from core.language.source import ProgramSource, load_source
from core.proving.program_timeline import Timeline, iter_timed_series
from core.proving.prove_program import prove
from core.proving.setpoint_trace import iter_setpoints
from tests.interpreter.programs import ALL_TOOLS
from tests.interpreter.test_golden import PROGRAMS, circumstances
from tests.screen.desks import SAMPLES
from tests.worked import FOLDER

pytestmark = pytest.mark.long

MACHINE = load_machine(None)
DT = 0.05
R = 0.015 * 25.4
NOSE = {n: SecondaryOffset(-R, -R, R) for n in (1, 2, 3, 4)}


def ends(source: ProgramSource, setup: InterpreterSetup) -> tuple[float, float, float]:
    """Cycle time of the proof, last time of the trace, and end of the timeline that is drawn."""
    shown = Timeline.from_program(source, setup, MACHINE)
    for _ in iter_timed_series(shown):
        pass
    last = 0.0
    for rows in iter_setpoints(Timeline.from_program(source, setup, MACHINE), DT):
        last = float(rows.times_s[-1]) if len(rows.times_s) else last
    return prove(source, setup, MACHINE).program_times.cycle_time_s, last, shown.time_s


def check(source: ProgramSource, setup: InterpreterSetup) -> None:
    proof, trace, shown = ends(source, setup)
    assert shown == pytest.approx(proof, abs=1e-6)
    assert proof - 1e-6 <= trace <= proof + DT + 1e-6


WORKED = sorted(FOLDER.glob("*.nc")) if FOLDER.exists() else []
GOLDEN = [
    path
    for path in sorted(PROGRAMS.glob("*.nc"))
    if not path.stem.startswith("refuse") and not path.stem.endswith(("_dia", "_mm_rad"))
]


@pytest.mark.skipif(not WORKED, reason="the worked examples are not at hand")
@pytest.mark.parametrize("path", WORKED, ids=lambda path: path.stem)
def test_forecasts_agree_for_worked_examples(path: Path) -> None:
    check(load_source(path), create_power_up_setup(MACHINE, tool_offsets=ALL_TOOLS, secondary_offsets=NOSE))


@pytest.mark.parametrize("path", sorted(SAMPLES.glob("*.nc")), ids=lambda path: path.stem)
def test_forecasts_agree_for_samples(path: Path) -> None:
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    check(load_source(path), create_power_up_setup(MACHINE, tool_offsets=tools, secondary_offsets=secondary))


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_forecasts_agree_for_golden_programs(path: Path) -> None:
    table = path.with_suffix(".expected").read_text("utf-8").splitlines()
    setup = circumstances([line[1:].split() for line in table if line.startswith("#")])
    check(load_source(path), setup)


def test_forecasts_agree_on_wait_for_speed_after_css() -> None:
    """G97 with another S behind a G96 move: the ramp begins at the speed that the move has led to."""
    css = ("G96S250", "G77S2500", "Z0", "G95F.002X0", "G94F300Z2", "G97", "S500")
    lines = ("G90G94F300", "M03S1500", "T1", "X.25Z.2", *css, "T2", "X0Z.2", "G95F.003Z-.5", "M30", "")
    source, setup = (
        ProgramSource("A", "\n".join(lines)),
        create_power_up_setup(MACHINE, tool_offsets=ALL_TOOLS, secondary_offsets={}),
    )
    proof, trace, _ = ends(source, setup)
    assert proof <= trace <= proof + DT
