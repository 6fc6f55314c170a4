"""Unit and rapid rate outlive a job: a program that says none of its own has those of the job before it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import CycleStart, LoadJob, PrepareCycleStart, SetSwitch
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import MachineState
from core.interpreter.omniturn.setup.inherited_state import RAPID, UNITS, find_inherited_settings
from core.language.source import Dialect, ProgramSource
from tests.executor.lines import mdi
from tests.executor.rig import INCH, Rig
from tests.texts import text

NAMES_NONE = "G90G94F300\nX.1\nM30\n"


@pytest.mark.parametrize(
    ("first", "carries"),
    [
        ("G90G94F300", {UNITS}),
        ("G90G70G94F300(PART)", set()),
        ("(TITLE G71)\ng90 g72", {UNITS, RAPID}),
        ("G90G71G95F.01", {RAPID}),
        ("G90G71", {RAPID}),
    ],
)
def test_settings_missing_from_the_first_line_are_inherited(first: str, carries: set[str]) -> None:
    assert find_inherited_settings(ProgramSource("PART", f"{first}\nX1\nM30\n")) == carries


def test_other_dialects_inherit_no_settings() -> None:
    assert find_inherited_settings(ProgramSource("PART", "G90 X1\n", Dialect.SINUMERIK)) == frozenset()


def after_a_metric_job() -> Rig:
    rig = Rig()
    mdi(rig, "G71")
    assert rig.shot.modal.metric
    return rig


def load(rig: Rig, job: Job) -> None:
    rig.run(0.4)
    rig.post(LoadJob(job, Proof(job.digest, ())))
    rig.post(CycleStart())


def test_program_proved_in_inches_does_not_start_in_millimeters() -> None:
    rig = after_a_metric_job()
    job = rig.load(NAMES_NONE)
    load(rig, job)
    assert rig.shot.start_refusal_reason.startswith(text("executor.no-line"))  # MDI is still open
    rig.post(PrepareCycleStart())
    load(rig, job)
    assert rig.shot.start_refusal_reason == (
        text("executor.program-silent-on", change=text("executor.counts-in-mm"))
    )
    load(rig, make_job(job.source, replace(job.setup, metric=True)))
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(0.1, abs=0.006)


def test_program_that_specifies_its_unit_starts_after_any_unit() -> None:
    rig = Rig()
    rig.start("G90G71G94F300\nX1\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.modal.metric
    rig.start("G90G70G94F300\nX.1\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(0.1 * INCH, abs=0.006)


def test_repeat_is_rejected_if_the_unit_has_changed() -> None:
    rig = Rig()
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start("G90G94F300\nX.1\nG71\nX2\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.said("refused")[-1].startswith(text("executor.no-repeat", why=text("executor.counts-in-mm")))


@pytest.mark.parametrize(("inch", "metric"), [(True, False), (False, True)])
def test_power_up_unit_is_the_one_in_the_machine_file(inch: bool, metric: bool) -> None:
    rig = Rig(replace(load_machine(), is_inch=inch))
    assert rig.shot.modal.metric is metric


@pytest.mark.parametrize("unit", ["G70", "G71"])
def test_program_of_another_dialect_leaves_the_unit_unchanged(unit: str) -> None:
    rig = Rig()
    mdi(rig, unit)
    before = rig.shot.modal.metric
    rig.post(PrepareCycleStart())
    other = "G70" if before else "G71"
    source = ProgramSource("PART.MPF", f"{other} G0 X1\nG1 Z-.1 F100\nM30\n", Dialect.SINUMERIK)
    load(rig, make_job(source, replace(rig.load(NAMES_NONE).setup, metric=before)))
    rig.until_true(lambda shot: shot.line == 2)
    assert rig.shot.modal.metric is not before
    rig.until(MachineState.IDLE)
    assert rig.shot.modal.metric is before
