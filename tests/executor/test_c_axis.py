"""The worked examples of the C axis and of plane switching, run on the simulated machine as proved."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, FeedHold, LoadJob, Reset, SetFeedOverride, SetSwitch
from core.executor.job import Proof, make_job
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig

pytestmark = pytest.mark.long

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"
NAMES = (
    "caxis-cross-drill",
    "caxis-slot-lead",
    "plane-xc-oval",
    "plane-xc-rectangle",
    "plane-xc-six-flats",
    "plane-zc-figure-eight",
    "plane-zc-j-slot",
    "plane-zc-square-circle",
)


def run(rig: Rig, name: str, text: str) -> None:
    """Prove, start, and come to the end that was proved in the time that was proved."""
    source = ProgramSource(name, text)
    setup = create_power_up_setup(
        rig.machine, tool_offsets={n: ToolOffset() for n in range(1, 33)}, secondary_offsets={}
    )
    report = prove(source, setup, rig.machine)
    assert report.errors == ()
    rig.ready()
    job = make_job(source, setup)
    rig.post(LoadJob(job, Proof(job.digest, (), tool_numbers=report.tool_numbers)), CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=300)
    assert rig.shot.alarms == ()
    assert rig.shot.underruns == 0
    assert rig.shot.demand == pytest.approx(report.machine_final_position, abs=1e-6)
    assert rig.shot.last_cycle == pytest.approx(report.program_times.cycle_time_s, rel=0.05, abs=0.06)


@pytest.mark.parametrize("name", NAMES)
def test_program_runs_as_proved(name: str) -> None:
    path = FOLDER / f"{name}.nc"
    if not path.exists():
        pytest.skip("the worked examples are not here")
    run(Rig(), name, path.read_text(encoding="utf-8"))


def test_c_axis_does_not_turn_until_the_spindle_is_stopped() -> None:
    rig = Rig()
    moving: list[Snapshot] = []
    rig.watch.append(lambda shot: moving.append(shot) if shot.demand[2] else None)
    run(rig, "STOP", "G90G94F300\nM03S2000\nG04F3\nM19\nC90\nG04F1\nM30\n")
    assert moving
    assert all(abs(shot.rpm_actual) < rig.machine.spindle.stop_below for shot in moving)


def test_spindle_override_does_not_affect_feed_by_c_axis() -> None:
    """Neither the pot nor the switch of the spindle: the slide follows C, which the feed override scales."""
    rig = Rig()
    rig.sim.machine.set_spindle_pot(0.5)
    rig.sim.machine.set_spindle_auto(False)
    run(rig, "POT", "G90G94F300\nT1\nX1Z1\nM19\nG95F.1\nC360Z.9S20\nM30\n")


def test_a_part_after_six_flats_begins_at_zero_again_without_unwinding() -> None:
    rig = Rig()
    run(rig, "TURN", "G90G94F300\nM19\nC-400\nG04F1\nM30\n")
    assert rig.shot.demand[2] == pytest.approx(-400.0)
    rig.run(0.3)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60)
    # M19 turns 40 degrees to -360, which counts as 0; C-400 then ends at -760.
    assert rig.shot.demand[2] == pytest.approx(-760.0)


FLAT = "G90G94F300\nM19\nX-.5Z0F100\n(~PLXC)\n(X.3Y-.3F20)\n(Y.3)\n(X-.3)\n(END)\nX-.6\nM30\n"
INCH = 25.4


def off_the_flat(shot: Snapshot) -> float:
    """How far the tool lies beside the line X = .3 in on the part, mm."""
    x, _, c = shot.demand
    return abs(-x * math.cos(math.radians(c)) - 0.3 * INCH)


def on_the_flat(shot: Snapshot) -> bool:
    return shot.line == 6


def test_hold_in_face_milling_plane_stays_on_the_flat_and_resumes() -> None:
    rig = Rig()
    worst: list[float] = []
    rig.watch.append(lambda shot: worst.append(off_the_flat(shot)) if on_the_flat(shot) else None)
    rig.start(FLAT)
    rig.until_true(on_the_flat)
    rig.run(0.3)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.line == 6
    rig.run(0.5)
    rig.post(SetFeedOverride(1.5), CycleStart())
    rig.until_true(lambda shot: shot.line != 6)
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert max(worst[:-2]) < 0.00005 * INCH
    assert rig.shot.demand == pytest.approx((-0.6 * INCH, 0.0, -135.0), abs=1e-6)


def test_single_block_stops_at_every_milled_corner() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", on=True))
    rig.start(FLAT)
    stops = []
    for _ in range(20):
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
        if rig.state is MachineState.IDLE:
            break
        stops.append((rig.shot.line, round(rig.shot.demand[2], 3)))
        rig.run(0.4)
        rig.post(CycleStart())
    assert stops == [(2, 0.0), (3, 0.0), (5, 45.0), (6, -45.0), (7, -135.0), (9, -135.0)]


def test_program_restarts_after_reset_in_face_milling_plane() -> None:
    rig = Rig()
    rig.start(FLAT)
    rig.until_true(on_the_flat)
    rig.run(0.2)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    turned = rig.shot.demand[2]
    assert -45.0 < turned < 45.0
    rig.run(0.4)
    rig.confirm()
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[2] == pytest.approx(-135.0)


def test_flat_with_a_corner_outside_x_travel_raises_travel_alarm() -> None:
    """X at the entry lies inside, a corner of the figure does not."""
    rig = Rig()
    source = ProgramSource("FAR", "G90G94F300M27\nM19\nX-3.9Z0\n(~PLXC)\n(Y2F20)\n(END)\nM30\n")
    setup = create_power_up_setup(rig.machine, tool_offsets={}, secondary_offsets={})
    assert [(d.line, d.code) for d in prove(source, setup, rig.machine).errors] == [(5, "soft-limit")]
    rig.start(source.text)
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "travel"


def test_c_axis_never_turns_if_the_spindle_does_not_stop() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S1000\nG04F2\nM19\nC90\nG04F1\nM30\n")
    rig.run(1.0)
    rig.sim.machine.spindle_ignores_stop()
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "ignores-stop"
    assert rig.shot.demand[2] == 0.0
