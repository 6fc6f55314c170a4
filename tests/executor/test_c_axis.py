"""The worked examples of the C axis and of plane switching, run on the simulated machine as proved."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine import setup_for
from core.executor.commands import CycleStart, LoadJob
from core.executor.job import Proof, make_job
from core.executor.snapshot import Snapshot, State
from core.interpreter.setup import ToolOffset
from core.language.source import Source
from core.proving.prove import prove
from tests.executor.rig import Rig

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
    source = Source(name, text)
    setup = setup_for(rig.machine, tools={n: ToolOffset() for n in range(1, 33)}, secondary={})
    report = prove(source, setup, rig.machine)
    if any(d.code == "not-yet" for d in report.errors):
        pytest.skip("holds a code that cannot run yet")
    assert report.errors == ()
    rig.ready()
    job = make_job(source, setup)
    rig.post(LoadJob(job, Proof(job.digest, (), tools=report.tools)), CycleStart())
    rig.until(State.IDLE, State.FAULT, limit=300)
    assert rig.shot.alarms == ()
    assert rig.shot.underruns == 0
    assert rig.shot.demand == pytest.approx(report.machine_final, abs=1e-6)
    assert rig.shot.last_cycle == pytest.approx(report.times.cycle, rel=0.05, abs=0.06)


@pytest.mark.parametrize("name", NAMES)
def test_runs_as_it_was_proved(name: str) -> None:
    path = FOLDER / f"{name}.nc"
    if not path.exists():
        pytest.skip("the worked examples are not here")
    run(Rig(), name, path.read_text(encoding="utf-8"))


def test_c_does_not_turn_before_the_spindle_stands() -> None:
    rig = Rig()
    moving: list[Snapshot] = []
    rig.watch.append(lambda shot: moving.append(shot) if shot.demand[2] else None)
    run(rig, "STOP", "G90G94F300\nM03S2000\nG04F3\nM19\nC90\nG04F1\nM30\n")
    assert moving
    assert all(abs(shot.rpm_actual) < rig.machine.spindle.stop_below for shot in moving)


def test_the_spindle_pot_leaves_a_slide_alone_that_c_feeds() -> None:
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
    rig.until(State.IDLE, State.FAULT, limit=60)
    # M19 turns 40 degrees to -360, which counts as 0; C-400 then ends at -760.
    assert rig.shot.demand[2] == pytest.approx(-760.0)
