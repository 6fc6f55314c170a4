"""Offsets changed while parts run: taken at the next part, proved before anything moves, or a stop."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.executor.commands import ChangeOffsets, CycleStart, FeedHold, LoadJob, Reset, SetSwitch
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from tests.executor.lines import mdi
from tests.executor.rig import INCH, Rig
from tests.texts import text

TOOLS = {1: ToolOffset(-12.7, -50.8)}
PART = "G90G94F300G73\nT1\nX1Z.1\nX.5Z.1D3\nZ-.3\nD0X1Z.1\nM30\n"
DEPTH = -12.7 + 0.5 * INCH  # machine X of the cut with D3 at nought, by hand


def running(rig: Rig, *, repeat: bool = True, text: str = PART) -> Job:
    """The first part is being cut."""
    rig.ready()
    job = rig.load(text, TOOLS)
    rig.post(SetSwitch("cycle_repeat", repeat), CycleStart())
    rig.until_true(lambda shot: shot.line == 5)
    return job


def corrected(job: Job, x: float) -> Job:
    """The same program with D3 X at so many mm, a radius."""
    return make_job(job.source, replace(job.setup, secondary={3: SecondaryOffset(x=x)}))


def good(job: Job) -> Proof:
    return Proof(job.digest, ())


def depth(rig: Rig) -> float:
    """Machine X while line 5 of the next part is cut, mm."""
    rig.until_true(lambda shot: shot.line != 5)
    rig.until_true(lambda shot: shot.line == 5)
    return rig.shot.demand[0]


def test_new_offset_applies_to_the_next_part_not_the_current_one() -> None:
    rig = Rig()
    job = running(rig)
    assert rig.shot.demand[0] == pytest.approx(DEPTH, abs=1e-6)
    new = corrected(job, -0.00254)  # -.0002 on the diameter is a tenth of a thousandth on the slide
    rig.post(ChangeOffsets(), ChangeOffsets(new, good(new)))
    rig.run(0.05)
    assert rig.shot.demand[0] == pytest.approx(DEPTH, abs=1e-6)
    assert depth(rig) == pytest.approx(DEPTH - 0.00254, abs=1e-6)
    assert depth(rig) == pytest.approx(DEPTH - 0.00254, abs=1e-6)
    assert rig.shot.cycle_repeat
    assert rig.shot.parts == 2
    assert MachineState.WAIT.value not in rig.said("state")


def test_next_part_waits_for_its_proof() -> None:
    """M30 has come before the proof: everything stands until it is there."""
    rig = Rig()
    job = running(rig)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    assert rig.shot.waiting_for == text("executor.proof-wait")
    assert rig.shot.parts == 1
    assert not rig.shot.counts
    stood = rig.shot.demand
    rig.run(5.0)
    assert rig.shot.demand == stood
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, good(new)))
    rig.until(MachineState.RUN)
    rig.until_true(lambda shot: shot.line == 5)
    assert rig.shot.demand[0] == pytest.approx(DEPTH - 0.0254, abs=1e-6)
    assert rig.shot.cycle_elapsed < 1.0  # the wait is not a part's time


def test_a_program_that_fails_its_proof_is_not_repeated() -> None:
    rig = Rig()
    job = running(rig)
    new = corrected(job, 99.0)
    rig.post(ChangeOffsets(new, Proof(new.digest, ("line 4: X leaves its travel",))))
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.said("refused") == [
        text("executor.no-repeat", why=text("executor.program-errors", errors="line 4: X leaves its travel"))
    ]
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason.startswith(text("executor.program-errors", errors="line 4"))


def test_proof_with_other_offsets_is_rejected() -> None:
    rig = Rig()
    job = running(rig)
    rig.post(ChangeOffsets(corrected(job, -0.1), good(job)))
    rig.until(MachineState.IDLE)
    assert text("executor.other-proof") in rig.said("refused")[0]


def test_unprovable_program_stops_with_the_reason() -> None:
    rig = Rig()
    running(rig)
    rig.post(ChangeOffsets(), ChangeOffsets(failure_reason="the offsets cannot be read"))
    rig.until(MachineState.IDLE)
    assert rig.said("refused") == [text("executor.no-repeat", why="the offsets cannot be read")]
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.not-proved")


def test_second_offset_change_replaces_the_first() -> None:
    """The first one has failed its proof; the operator takes it back before the part ends."""
    rig = Rig()
    job = running(rig)
    bad, mended = corrected(job, 99.0), corrected(job, 0.0127)
    rig.post(
        ChangeOffsets(bad, Proof(bad.digest, ("too far",))),
        ChangeOffsets(),
        ChangeOffsets(mended, good(mended)),
    )
    assert depth(rig) == pytest.approx(DEPTH + 0.0127, abs=1e-6)
    assert rig.said("refused") == []


def test_offset_change_cannot_replace_the_running_program() -> None:
    rig = Rig()
    job = running(rig)
    other = make_job(ProgramSource("PART", PART.replace("X.5", "X.1")), job.setup)
    rig.post(ChangeOffsets(other, good(other)))
    assert rig.said("refused") == [text("executor.other-program-runs")]
    assert depth(rig) == pytest.approx(DEPTH, abs=1e-6)


@pytest.mark.parametrize("end", ["M30", "M02"])
def test_next_start_uses_the_new_offset_without_cycle_repeat(end: str) -> None:
    rig = Rig()
    job = running(rig, repeat=False, text=PART.replace("M30", end))
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, good(new)))
    rig.until(MachineState.IDLE)
    assert rig.shot.program == "PART"
    assert not rig.shot.needs_proof
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.line == 5)
    assert rig.shot.demand[0] == pytest.approx(DEPTH - 0.0254, abs=1e-6)


@pytest.mark.parametrize("how", ["reset", "estop"])
def test_nothing_starts_while_announced_offsets_are_unproved(how: str) -> None:
    """Announced and not yet proved: neither the old job nor an unproved one may begin."""
    rig = Rig()
    job = running(rig)
    rig.post(ChangeOffsets())
    if how == "reset":
        rig.post(Reset())
        rig.until(MachineState.IDLE)
    else:
        rig.sim.machine.press_estop()
        rig.until(MachineState.ESTOP)
        rig.sim.machine.release_estop()
        rig.until(MachineState.DISABLED)
        rig.ready()
    assert rig.shot.needs_proof
    assert rig.shot.interrupted_line == 5
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, good(new)))
    rig.run(0.4)
    rig.confirm()
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.line == 5)
    assert rig.shot.demand[0] == pytest.approx(DEPTH - 0.0254, abs=1e-6)


def test_hold_reset_and_repeat_switch_work_between_parts() -> None:
    rig = Rig()
    job = running(rig)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    rig.post(FeedHold())
    assert rig.state is MachineState.HOLD
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, good(new)))
    rig.run(1.0)
    assert rig.state is MachineState.HOLD  # nothing begins behind a hand that holds
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.line == 5)
    assert rig.shot.demand[0] == pytest.approx(DEPTH - 0.0254, abs=1e-6)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 2
    assert rig.shot.interrupted_line == 0


def test_reset_between_parts_records_no_interrupted_line() -> None:
    rig = Rig()
    running(rig)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert (rig.shot.parts, rig.shot.interrupted_line) == (1, 0)


def test_m31_ends_the_repeat_with_pending_offsets() -> None:
    rig = Rig()
    job = running(rig, text=PART.replace("M30", "M31\nM30"))
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, good(new)))
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_offset_change_at_rest_applies_immediately_and_in_mdi() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(PART, TOOLS)
    mdi(rig, "G90T1X1Z.1G94F300")
    moved = make_job(job.source, replace(job.setup, tools={1: ToolOffset(-12.6, -50.8)}))
    rig.post(ChangeOffsets(moved, good(moved)))
    assert rig.shot.modal.tool_offset_x == -12.6
    assert rig.said("refused") == []


def test_loading_another_program_discards_pending_offsets() -> None:
    rig = Rig()
    job = running(rig, repeat=False)
    rig.until(MachineState.IDLE)
    other = make_job(ProgramSource("OTHER", "G90G94F300\nX.5\nX0\nM30\n"), job.setup)
    rig.post(ChangeOffsets(), LoadJob(other, good(other)), SetSwitch("cycle_repeat", True))
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.parts == 3)
    assert rig.shot.program == "OTHER"
