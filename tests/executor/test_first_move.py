"""No start without a verdict on its first move: for this job, this position and the part as it is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest

from core.executor.commands import (
    FIRST_MOVE_CROSSES,
    START_UNCHECKED,
    TOOL_IN_PART,
    CycleStart,
    JogByStep,
    PrepareCycleStart,
    ReplaceStartClearances,
    SetSwitch,
    StartClearance,
)
from core.executor.job import Job
from core.executor.snapshot import MachineState, StartAction
from tests.executor.lines import TOOLS
from tests.executor.rig import Rig
from tests.executor.test_restart import PART

END = "G90G94F300\nT1\nX1Z.2\nM30\n"
WHY = "the first move takes T1 through the part"


@dataclass
class Checked(Rig):
    """A rig whose control demands a verdict."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.executor._control.status.requires_start_clearance = True

    def clear(self, loaded: Job, code: str = "", warned: str = "", **changes: object) -> None:
        shot = self.shot
        why = WHY if code else ""
        found = StartClearance(loaded.digest, shot.demand, shot.begun, code, why, warned)
        self.post(ReplaceStartClearances((replace(found, **changes),)))  # type: ignore[arg-type]

    def starts(self) -> bool:
        self.run(0.4)
        self.post(CycleStart())
        return self.state is not MachineState.IDLE


def loaded() -> tuple[Checked, Job]:
    rig = Checked()
    rig.ready()
    return rig, rig.load(PART, TOOLS)


def test_start_requires_a_clearance_verdict() -> None:
    rig, job = loaded()
    assert not rig.starts()
    assert rig.shot.start_code == START_UNCHECKED
    rig.clear(job)
    assert (rig.shot.start_refusal_reason, rig.shot.start_code) == ("", "")
    assert rig.starts()


@pytest.mark.parametrize("code", [TOOL_IN_PART, FIRST_MOVE_CROSSES])
def test_start_refusal_has_a_code_and_a_message(code: str) -> None:
    rig, job = loaded()
    rig.clear(job, code)
    assert not rig.starts()
    assert (rig.shot.start_code, rig.shot.start_refusal_reason) == (code, WHY)


def test_verdict_for_another_position_is_ignored() -> None:
    rig, job = loaded()
    rig.clear(job)
    rig.post(JogByStep("X", -0.5, 5.0))
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    assert not rig.starts()
    assert rig.shot.start_code == START_UNCHECKED
    rig.clear(job)
    assert rig.starts()


def test_verdict_for_another_job_or_another_run_is_ignored() -> None:
    rig, job = loaded()
    rig.clear(job, job="another")
    assert not rig.starts()
    rig.clear(job, begun=rig.shot.begun + 1)
    assert not rig.starts()
    assert rig.shot.start_code == START_UNCHECKED


def test_verdict_computed_before_a_run_is_ignored_after_it() -> None:
    rig = Checked()
    rig.ready()
    job = rig.load(END, TOOLS)
    rig.clear(job)
    early = rig.executor._control.status.start_clearances
    assert rig.starts()
    rig.until(MachineState.IDLE)
    rig.post(ReplaceStartClearances(tuple(replace(each, at=rig.shot.demand) for each in early)))
    assert not rig.starts()
    assert rig.shot.start_code == START_UNCHECKED


def test_assumptions_are_announced_before_the_start() -> None:
    rig, job = loaded()
    rig.clear(job, warned="LOOK")
    assert any("LOOK" in each for each in rig.shot.announced)
    assert rig.starts()


def prepares(rig: Checked, job: Job, clearance: StartClearance | None) -> None:
    proof = rig.executor._control.status.proof
    rig.post(PrepareCycleStart(StartAction.MDI_LINE, job, proof, clearance))


def test_program_verdict_does_not_apply_to_an_mdi_line() -> None:
    rig, job = loaded()
    prepares(rig, job, None)
    rig.clear(job)
    assert not rig.starts()
    assert rig.shot.start_code == START_UNCHECKED


def test_mdi_line_starts_when_prepared_with_its_verdict() -> None:
    rig, job = loaded()
    prepares(rig, job, StartClearance(job.digest, rig.shot.demand, rig.shot.begun))
    assert rig.starts()


def test_mdi_line_with_crossing_first_move_is_rejected_until_replaced() -> None:
    rig, job = loaded()
    rig.clear(job)
    prepares(rig, job, StartClearance(job.digest, rig.shot.demand, rig.shot.begun, FIRST_MOVE_CROSSES, WHY))
    assert not rig.starts()
    assert (rig.shot.start_code, rig.shot.start_refusal_reason) == (FIRST_MOVE_CROSSES, WHY)
    rig.post(PrepareCycleStart(StartAction.PROGRAM))
    assert (rig.shot.start_code, rig.shot.start_refusal_reason) == ("", "")
    assert rig.starts()


def test_cycle_repeat_does_not_begin_a_move_that_crosses_the_part() -> None:
    rig = Checked()
    rig.ready()
    job = rig.load(END, TOOLS)
    shot = rig.shot
    end = (TOOLS[1].x + 25.4, TOOLS[1].z + 0.2 * 25.4, shot.demand[2])
    here = StartClearance(job.digest, shot.demand, shot.begun)
    rig.post(
        ReplaceStartClearances(
            (here, replace(here, at=end, code=FIRST_MOVE_CROSSES, why=WHY, is_for_repeat=True))
        )
    )
    rig.post(SetSwitch("cycle_repeat", True))
    assert rig.starts()
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert any(WHY in each for each in rig.said("refused"))
