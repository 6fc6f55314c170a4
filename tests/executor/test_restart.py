"""A restart on the machine: the way there in lathe order, everything restored, nothing started unasked."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.program_proving import create_proof
from app.searchto.restart_plan import plan_retract
from app.searchto.searchto_model import RETRACT_TEXT
from core.executor.commands import CycleStart, FeedHold, LoadJob, PrepareCycleStart, Reset
from core.executor.control_status import Workpiece
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import MachineState, Snapshot, StartAction
from core.interpreter.restart.restart_approach import OperatorChoices
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.shared.checkpoint import StraightLeg
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.executor import lines
from tests.executor.lines import TOOLS, mdi
from tests.executor.rig import INCH, Rig
from tests.texts import text

pytestmark = pytest.mark.long

PART = (
    "G90G94F300G72\nT1\nX1.2Z.2\nM03S900\nM08\nX.8\nG95F.005Z-.2\nZ-.4\nG94F300X1.2\nZ.2\nM09\nM05\n"
    "X2Z2\nM30\n"
)


def restart_job(rig: Rig, line: int, choices: OperatorChoices | None = None, number: int = 0) -> Job:
    """As an operator would have it: the line can be begun at."""
    job = lines.restart_job(rig, line, choices, number)
    assert job is not None
    return job


def prepare(rig: Rig, job: Job) -> None:
    report = prove(job.source, job.setup, rig.machine)
    assert not report.errors, report.errors
    rig.post(PrepareCycleStart(StartAction.RESTART, job, create_proof(job, report)))
    rig.run(0.9)  # a start counts when it was meant before the hands came down


def restart(rig: Rig, line: int, choices: OperatorChoices | None = None) -> None:
    rig.run(0.4)
    prepare(rig, restart_job(rig, line, choices))
    rig.post(CycleStart())
    assert not rig.shot.start_refusal_reason, rig.shot.start_refusal_reason


def broken_off(rig: Rig, at_z: float = -0.3) -> None:
    """The part is begun, and the E-stop is hit in the middle of the cut."""
    rig.start(PART, TOOLS)
    rig.until_true(lambda shot: shot.line == 8 and shot.actual[1] < -50.8 + at_z * INCH)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()


def test_interrupted_line_is_offered_until_the_part_is_done() -> None:
    rig = Rig()
    broken_off(rig)
    assert rig.shot.interrupted_line == 8
    mdi(rig, "G90")
    assert rig.shot.interrupted_line == 8
    restart(rig, 8)
    assert rig.shot.interrupted_line == 0
    rig.until(MachineState.IDLE)
    assert rig.shot.interrupted_line == 0
    assert rig.shot.parts == 1


def test_part_is_completed_from_the_line_after_estop() -> None:
    rig = Rig()
    broken_off(rig)
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    restart(rig, 8)
    rig.until(MachineState.IDLE)
    way = [shot for shot in seen if shot.block_text in {"X", "Z"}]
    x = [round((shot.demand[0] + 12.7) / INCH, 4) for shot in way]
    z = [round((shot.demand[1] + 50.8) / INCH, 4) for shot in way]
    assert max(x) == pytest.approx(0.6, abs=1e-3)  # X1.2 is where the program stood off the part
    assert max(z) == pytest.approx(2.0, abs=1e-3)  # Z2 is the farthest out that the program goes
    out = next(i for i, value in enumerate(z) if value > z[0] + 0.01)
    assert x[out] == pytest.approx(0.6, abs=1e-3)  # X is off the part before Z goes
    assert way[-1].demand[1] == pytest.approx(-50.8 - 0.2 * INCH, abs=0.01)  # Z stands before X goes in
    cut = [shot for shot in seen if shot.line == 8 and shot.block_text == "Z-.4"]
    assert cut[0].modal.diameter
    assert cut[0].modal.per_rev
    assert all(shot.rpm_actual == pytest.approx(900, rel=0.06) for shot in cut)
    assert "coolant" in cut[0].outputs
    assert rig.shot.actual[:2] == pytest.approx((-12.7 + INCH, -50.8 + 2 * INCH), abs=0.01)


def test_feed_leg_into_the_part_waits_for_spindle_speed() -> None:
    rig = Rig()
    broken_off(rig)
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    restart(rig, 8)
    rig.until_true(lambda shot: shot.block_text == "Z-.4")
    fed = [shot for shot in seen if shot.block_text in {"X", "Z"} and not shot.rapid and shot.rpm_command]
    assert fed
    moving = [shot for shot in fed if shot.velocity > 0.5]
    assert all(shot.rpm_actual == pytest.approx(900, rel=0.06) for shot in moving)
    assert max(shot.velocity for shot in fed) <= 21.0 * INCH / 60


def test_unconfirmed_coolant_stays_off() -> None:
    rig = Rig()
    broken_off(rig)
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    restart(rig, 8, OperatorChoices(uses_coolant=False))
    rig.until(MachineState.IDLE)
    assert not any("coolant" in shot.outputs for shot in seen)


def test_mdi_spindle_is_stopped_if_the_restart_line_has_none() -> None:
    rig = Rig()
    broken_off(rig)
    mdi(rig, "M04S500", "M08")
    restart(rig, 13)
    rig.until_true(lambda shot: shot.line == 13 and shot.block_text == "Z")
    assert rig.shot.rpm_command == 0.0
    assert "coolant" not in rig.shot.outputs
    rig.until(MachineState.IDLE)


def test_a_program_is_repeated_from_its_first_line_after_a_restart() -> None:
    rig = Rig()
    broken_off(rig)
    rig.executor._context.switches.cycle_repeat = True
    restart(rig, 8)
    rig.until_true(lambda shot: shot.parts == 1)
    rig.until_true(lambda shot: shot.line == 3)
    rig.post(Reset())
    rig.until(MachineState.IDLE)


def test_start_after_a_restart_runs_the_whole_program() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 13)
    rig.until(MachineState.IDLE)
    assert rig.shot.starts is StartAction.PROGRAM
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.line == 3)


def refused(rig: Rig) -> str:
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    return rig.shot.start_refusal_reason


def test_restart_is_rejected_after_the_axes_have_moved() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    mdi(rig, "G91", "Z.01F50")
    prepare(rig, job)
    assert refused(rig) == text("executor.moved-since", remedy=text("executor.search-again"))


def test_restart_is_rejected_if_the_collet_state_differs() -> None:
    rig = Rig()
    broken_off(rig)
    mdi(rig, "M13")
    prepare(rig, restart_job(rig, 8))
    assert refused(rig) == text("executor.collet-must-close", line=8)


def test_restart_is_rejected_after_the_program_is_reloaded() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    rig.load(PART + "(OTHER)\n", TOOLS)
    prepare(rig, job)
    assert refused(rig) == text("executor.loaded-anew")


def test_loading_a_program_cancels_a_prepared_restart() -> None:
    rig = Rig()
    broken_off(rig)
    prepare(rig, restart_job(rig, 8))
    assert rig.shot.starts is StartAction.RESTART
    rig.load(PART, TOOLS)
    assert (rig.shot.starts, rig.shot.prepared_job_digest) == (StartAction.RESTART, "")
    assert refused(rig) == text("executor.no-restart")


@pytest.mark.parametrize(("seconds", "starts"), [(0.3, False), (0.9, True)])
def test_cycle_start_pressed_together_with_confirmation_is_rejected(seconds: float, starts: bool) -> None:
    """Both palms that came down with the key that has accepted the way there were not meant for it."""
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    rig.run(1.0)
    rig.post(
        PrepareCycleStart(
            StartAction.RESTART, job, create_proof(job, prove(job.source, job.setup, rig.machine))
        )
    )
    rig.run(seconds)
    rig.sim.machine.press_start()
    rig.run(0.1)
    assert (rig.state is not MachineState.IDLE) is starts
    assert (text("executor.meant-just-now") in rig.shot.start_refusal_reason) is not starts


def test_cycle_start_after_a_canceled_restart_reports_no_restart() -> None:
    """Nothing is meant by it: the palms that come right behind are told that a restart is not ready."""
    rig = Rig()
    broken_off(rig)
    rig.run(1.0)
    rig.post(PrepareCycleStart(StartAction.RESTART))
    rig.run(0.3)
    rig.sim.machine.press_start()
    rig.run(0.1)
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason == text("executor.no-restart")


def test_approach_beyond_the_travel_is_found_by_the_proof() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    begin = job.setup.begin
    assert begin is not None
    far = tuple(
        step._replace(z=500.0) if isinstance(step, StraightLeg) and step.z is not None else step
        for step in begin.approach_steps
    )
    setup = replace(job.setup, begin=begin._replace(approach_steps=far))
    report = prove(job.source, setup, rig.machine)
    assert any(each.code == "soft-limit" for each in report.errors)


def test_an_unproved_restart_does_not_start() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    rig.post(PrepareCycleStart(StartAction.RESTART, job))
    assert refused(rig) == text("executor.not-proved")
    rig.post(PrepareCycleStart(StartAction.RESTART, job, Proof("another", ())))
    assert refused(rig).startswith(text("executor.other-proof"))


def test_restart_is_not_prepared_while_a_program_runs() -> None:
    rig = Rig()
    rig.start(PART, TOOLS)
    job = rig.executor._control.status.job
    assert job is not None
    rig.post(PrepareCycleStart(StartAction.RESTART, job))
    assert text("executor.program-keeps-others-out") in rig.said("refused")[-1]
    rig.post(LoadJob(job))
    assert rig.shot.starts is StartAction.PROGRAM


def test_single_block_stops_on_each_approach_leg_and_resumes() -> None:
    rig = Rig()
    broken_off(rig)
    rig.executor._context.switches.single_block = True
    restart(rig, 4)  # so early that the way has more blocks than the program before it
    texts = []
    for _ in range(20):
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
        texts.append(rig.shot.block_text)
        if rig.shot.line == 6:
            break
        rig.run(0.4)
        rig.post(CycleStart())
        rig.run(0.1)
    assert texts[:5] == ["X", "Z", "Z", "Z", "M03S900"]  # off the part, along it, clear of it; down again
    assert texts[-1] == "X.8"


def test_restart_with_an_unset_tool_is_rejected() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    whole = rig.executor._control.status.job
    assert whole is not None
    bare = replace(whole, entered_tool_numbers=frozenset())
    rig.post(LoadJob(bare, Proof(bare.digest, (), tool_numbers=(1,))))
    prepare(rig, job)
    assert refused(rig) == text("executor.tool-offset-unset", tools="T1")


GROOVE = (
    "G90G94F300G72\nT1\nX.9Z.2\nM03S900\nLS3\nG91Z-.3\nG90G95F.002X.7\nG04F.3\nG94F300X.9\nLF\n"
    "Z.5\nM05\nM30\n"
)


def stopped_in_a_groove(rig: Rig, at_z: float = -0.4) -> None:
    """The second of three grooves, Z-.4, is half cut when the E-stop is hit."""
    rig.start(GROOVE, TOOLS)
    rig.until_true(
        lambda shot: (
            shot.line == 7
            and abs(shot.actual[1] + 50.8 - at_z * INCH) < 0.01
            and shot.actual[0] + 12.7 < 0.4 * INCH
        )
    )
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()


def way_out_alone(rig: Rig) -> None:
    """What F4 of SEARCHTO prepares."""
    rig.run(0.4)
    whole = rig.executor._control.status.job
    assert whole is not None
    cut = OmniturnRestartSearch(whole.source, whole.setup, lambda _count: None).cut_record
    out = plan_retract(cut, rig.shot, whole, OperatorChoices())
    assert not out.error_text, out.error_text
    setup = replace(whole.setup, start=rig.shot.demand, begin=out.start_state)
    job = make_job(ProgramSource("WAY OUT", RETRACT_TEXT), setup)
    report = prove(job.shared_program, job.setup, rig.machine)
    assert not report.errors, report.errors
    rig.post(PrepareCycleStart(StartAction.RETRACT, job, create_proof(job, report)))
    rig.post(CycleStart())
    assert not rig.shot.start_refusal_reason, rig.shot.start_refusal_reason


def test_restart_that_leaves_a_cut_incomplete_counts_no_part() -> None:
    rig = Rig()
    broken_off(rig)
    job = restart_job(rig, 8)
    begin, piece = job.setup.begin, Workpiece()
    assert begin is not None
    piece.start_run(job, begin.checkpoint.blocks)
    assert piece.not_counted_reason == ""
    skips = replace(job.setup, begin=begin._replace(skips_cuts=True))
    piece.start_run(replace(job, setup=skips), begin.checkpoint.blocks)
    assert piece.not_counted_reason == text("executor.left-out")


def test_retract_only_leaves_a_groove_along_x_and_starts_nothing() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    way_out_alone(rig)
    rig.until(MachineState.IDLE)
    rig.post(PrepareCycleStart(StartAction.RESTART))
    rig.tick()
    assert rig.shot.shows_diameter
    assert all(shot.shows_diameter for shot in seen)
    for shot in seen:
        x, z = (shot.actual[0] + 12.7) / INCH, (shot.actual[1] + 50.8) / INCH
        assert z == pytest.approx(-0.4, abs=2e-3) or x > 0.45 - 2e-3  # X.9 is where it came from
        assert shot.rpm_command == 0.0
    assert max(shot.velocity for shot in seen if shot.block_text == "X") <= 21.0 * INCH / 60
    assert (rig.shot.actual[1] + 50.8) / INCH == pytest.approx(0.5, abs=2e-3)
    assert rig.shot.interrupted_line == 7  # it is still to be finished


def test_feed_hold_in_a_retract_allows_requesting_the_remainder() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    way_out_alone(rig)
    rig.until_true(lambda shot: (shot.actual[0] + 12.7) / INCH > 0.41)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    held = rig.shot.actual[0]
    way_out_alone(rig)
    rig.until_true(lambda shot: shot.actual[0] > held + 0.1)
    rig.until(MachineState.IDLE)
    assert (rig.shot.actual[1] + 50.8) / INCH == pytest.approx(0.5, abs=2e-3)


def test_restart_in_a_loop_continues_in_the_interrupted_pass() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    restart(rig, 7)
    seen: list[float] = []
    rig.watch.append(
        lambda shot: (
            seen.append(round((shot.actual[1] + 50.8) / INCH, 2)) if shot.waiting_for == "DWELL" else None
        )
    )
    rig.until(MachineState.IDLE, limit=120.0)
    assert sorted(set(seen)) == [-0.7, -0.4]  # the first groove is not cut again
    assert rig.shot.parts == 1


def test_interrupted_turning_pass_retracts_along_the_pass() -> None:
    """Nothing tells whether the bar or a groove in its face stands around it."""
    rig = Rig()
    rig.start(PART.replace("G94F300X1.2\nZ.2", "X1.2\nG94F300Z.2"), TOOLS)
    rig.until_true(lambda shot: shot.line == 8 and shot.actual[1] < -50.8 - 0.3 * INCH)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()
    x = rig.shot.actual[0]
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    way_out_alone(rig)
    rig.until(MachineState.IDLE)
    assert all(shot.actual[0] == pytest.approx(x, abs=0.01) for shot in seen if shot.actual[1] < -50.8)


def test_restart_interrupted_on_retract_remembers_the_retract_path() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    restart(rig, 7)
    rig.until_true(lambda shot: (shot.actual[0] + 12.7) / INCH > 0.41)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()
    rig.run(0.5)
    z = rig.shot.actual[1]
    assert (rig.shot.actual[0] + 12.7) / INCH < 0.449
    assert rig.shot.interrupted_line == 7
    seen: list[Snapshot] = []
    rig.watch.append(seen.append)
    way_out_alone(rig)
    rig.until(MachineState.IDLE)
    low = [shot for shot in seen if (shot.actual[0] + 12.7) / INCH < 0.448]
    assert low
    assert all(shot.actual[1] == pytest.approx(z, abs=0.02) for shot in low)


def test_turning_pass_interrupted_again_on_retract_plans_a_retract() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 8)
    rig.until_true(lambda shot: (shot.actual[0] + 12.7) / INCH > 0.45)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()
    rig.run(0.5)
    whole = rig.executor._control.status.job
    assert whole is not None
    cut = OmniturnRestartSearch(whole.source, whole.setup, lambda _count: None).cut_record
    out = plan_retract(cut, rig.shot, whole, OperatorChoices())
    assert not out.error_text
    assert [leg.label for leg in out.drawn_legs] == ["", "1 X", "2 Z", "3 Z"]


def test_in_a_program_that_was_changed_since_no_block_tells_where_the_tool_stands() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    rig.load(GROOVE.replace("LS3", "LS2"), TOOLS)
    whole = rig.executor._control.status.job
    assert whole is not None
    assert rig.shot.interrupted_line == 7
    cut = OmniturnRestartSearch(whole.source, whole.setup, lambda _count: None).cut_record
    out = plan_retract(cut, rig.shot, whole, OperatorChoices())
    assert out.error_text == text("executor.how-tool-came", tool=1)
    assert not out.start_state.approach_steps


def test_retract_is_rejected_from_an_unproved_position() -> None:
    rig = Rig()
    stopped_in_a_groove(rig)
    rig.run(0.4)
    whole = rig.executor._control.status.job
    assert whole is not None
    cut = OmniturnRestartSearch(whole.source, whole.setup, lambda _count: None).cut_record
    out = plan_retract(cut, rig.shot, whole, OperatorChoices())
    job = make_job(
        ProgramSource("WAY OUT", RETRACT_TEXT),
        replace(whole.setup, start=rig.shot.demand, begin=out.start_state),
    )
    report = prove(job.shared_program, job.setup, rig.machine)
    mdi(rig, "G91", "X.01F5")
    rig.post(PrepareCycleStart(StartAction.MDI_LINE, job, create_proof(job, report)))
    assert refused(rig) == text("executor.moved-since", remedy=text("executor.ask-way-out-again"))
