"""The part of a program on the desk: after its proof, what waits for it, and what is only announced."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.part_prover import NO_STOCK, NOT_MADE
from app.compose.program_proving import create_loading_steps
from app.compose.stored_offsets import Offsets
from app.desk.background_work import ProgressCallback
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase, PartProof, ProgramLoader
from app.desk.programs.program_renewal import RunningRenewal
from app.desk.status.prompt_line import find_announcements, find_remedy
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart
from app.path.path_picture import ProgramPicture
from core.executor.commands import ChangeOffsets, Command, LoadJob, SupplyJobProof
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.language.diagnostics import Severity
from core.machine.machine_model import ClampingModel, Machine
from core.part.tool_shape import ToolKind, ToolShape
from core.proving import part_history
from tests.texts import begins, pattern
from tests.texts import text as wording

LIMIT = 60.0
SHAFT = "G90G94F100\nM03S1500\nT1\nX.6Z.05\nX.4\nG95F.008Z-.5\nX.45Z-.6\nX.55\nG94F100Z.05\nM30\n"
SLIP = SHAFT.replace("M30", "X.3\nG00Z-.3\nX.55\nM30")  # the G00 of line 11 goes into metal
TURNING = ToolShape(ToolKind.TURNING, tip=3, insert="DCMT11T304")
BAR = StoredPart(stock_text="bar:1.0+.02")
TOOLS = {1: ToolOffset(-12.7, -50.8)}


class Desk:
    """Loads real programs as the desk does; what it posts is kept."""

    def __init__(
        self, kept: StoredPart, shapes: Mapping[int, ToolShape], folder: Path, machine: Machine | None = None
    ) -> None:
        self.folder, self.posted = folder, list[Command]()
        steps = create_loading_steps(
            machine or load_machine(None),
            lambda: Offsets(TOOLS, {}, {}),
            read_shapes=lambda: shapes,
            read_stored_part=lambda program: kept if program == "part.nc" else EMPTY_STORED_PART,
        )
        self.session = ProgramLoader(steps, self.posted.append)

    def load(self, text: str) -> LoadedProgram:
        (self.folder / "part.nc").write_text(text)
        self.session.start_loading(self.folder / "part.nc")
        return self.session.wait_until_loaded(LIMIT)

    @property
    def kinds(self) -> list[type[Command]]:
        return [type(command) for command in self.posted]


Make = Callable[..., Desk]


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Make]:
    made: list[Desk] = []

    def make(
        kept: StoredPart | None = None,
        shapes: Mapping[int, ToolShape] | None = None,
        machine: Machine | None = None,
    ) -> Desk:
        made.append(Desk(kept or StoredPart(), shapes or {}, tmp_path, machine))
        return made[-1]

    yield make
    for each in made:
        each.session.close()


def part_of(loaded: LoadedProgram) -> PartProof:
    assert loaded.part_proof is not None
    return loaded.part_proof


def test_valid_program_has_no_findings_and_is_posted_once(desk: Make) -> None:
    bench = desk()
    loaded = bench.load(SHAFT)
    assert (loaded.phase, loaded.diagnostics, part_of(loaded).warning_texts) == (LoadingPhase.READY, (), ())
    assert bench.kinds == [LoadJob, SupplyJobProof]


def test_finding_based_on_assumed_stock_is_a_warning(desk: Make) -> None:
    bench = desk()
    loaded = bench.load(SLIP)
    (found,) = loaded.diagnostics
    assert (found.line, found.check_name, found.severity) == (11, "rapid-into-stock", Severity.WARNING)
    assert found.assumptions == ("stock",)  # the tip of any tool is in the material
    assert found.hint.endswith("Assumed: stock.")
    assert wording("desk.left-on") in found.hint
    assert found.block_number > 0
    assert loaded.phase is LoadingPhase.READY
    assert bench.kinds == [LoadJob, SupplyJobProof, SupplyJobProof]
    first, last = (command.proof for command in bench.posted if isinstance(command, SupplyJobProof))
    assert first.warnings == ()  # it may be started before its part is known
    assert (last.errors, last.warnings) == ((), ("LINE 11: RAPID-INTO-STOCK",))


def test_rapid_into_specified_stock_with_assumed_tool_is_an_error(desk: Make) -> None:
    bench = desk(BAR)
    loaded = bench.load(SLIP)
    assert [(d.assumptions, d.severity) for d in loaded.diagnostics] == [((), Severity.ERROR)]
    assert bench.kinds == [LoadJob, SupplyJobProof]  # it has waited for the part
    assert loaded.phase is LoadingPhase.REFUSED


def test_rapid_into_specified_stock_with_specified_tool_refuses_the_start(desk: Make) -> None:
    bench = desk(BAR, {1: TURNING})
    loaded = bench.load(SLIP)
    assert loaded.phase is LoadingPhase.REFUSED
    assert [(d.line, d.assumptions) for d in loaded.blocking_errors] == [(11, ())]
    (given,) = (command.proof for command in bench.posted if isinstance(command, SupplyJobProof))
    assert len(given.errors) == 1
    assert "rapid-into-stock" in given.errors[0]
    assert desk(BAR, {1: TURNING}).load(SHAFT).phase is LoadingPhase.READY


def test_proof_waits_for_the_part_check_if_that_may_refuse_the_start(desk: Make) -> None:
    for kept, given in ((BAR, [LoadJob]), (StoredPart(), [LoadJob, SupplyJobProof])):
        bench = desk(kept, {1: TURNING})
        making, go_on = threading.Event(), threading.Event()
        real = bench.session.loading_steps.prove_part

        def held(
            picture: ProgramPicture,
            watch: ProgressCallback,
            made: threading.Event = making,
            let: threading.Event = go_on,
            then: Callable[[ProgramPicture, ProgressCallback], PartProof | None] = real,
        ) -> PartProof | None:
            made.set()
            assert let.wait(LIMIT)
            return then(picture, watch)

        bench.session.loading_steps = replace(bench.session.loading_steps, prove_part=held)
        (bench.folder / "part.nc").write_text(SLIP)
        bench.session.start_loading(bench.folder / "part.nc")
        assert making.wait(LIMIT)
        assert bench.kinds == given
        assert bench.session.loaded_program.is_busy is (kept is BAR)
        assert bench.session.loaded_program.picture is not None  # what there is, is shown
        go_on.set()
        bench.session.wait_until_loaded(LIMIT)


def test_disabled_check_is_a_note_with_its_reason(desk: Make) -> None:
    silenced = replace(BAR, silenced_checks={"rapid-into-stock": "the bar is drilled before"})
    loaded = desk(silenced, {1: TURNING}).load(SLIP)
    (found,) = loaded.diagnostics
    assert (found.severity, found.downgrade_reason) == (Severity.NOTE, "the bar is drilled before")
    assert found.hint == wording("desk.silenced", why="the bar is drilled before")
    assert loaded.phase is LoadingPhase.READY
    assert part_of(loaded).warning_texts == ()


def test_chuck_overspeed_error_needs_no_stock(desk: Make) -> None:
    machine = replace(load_machine(None), clamping=ClampingModel(max_rpm=1200.0))
    bench = desk(machine=machine)
    loaded = bench.load(SHAFT)
    assert loaded.phase is LoadingPhase.REFUSED
    assert {(d.check_name, d.assumptions) for d in loaded.blocking_errors} == {("spindle-overspeed", ())}
    assert bench.kinds == [LoadJob, SupplyJobProof]


@pytest.mark.parametrize("stock", ["rod", "profile:gone.csv", "after:gone.nc"])
def test_unusable_stock_is_reported_before_the_start(desk: Make, stock: str) -> None:
    loaded = desk(StoredPart(stock_text=stock)).load(SHAFT)
    (found,) = loaded.diagnostics
    assert (found.line, found.code, found.severity) == (0, NO_STOCK, Severity.WARNING)
    assert part_of(loaded).warning_texts == (wording("desk.not-as-specified"),)
    assert loaded.phase is LoadingPhase.READY


def test_stock_may_be_the_part_left_by_another_program(desk: Make, tmp_path: Path) -> None:
    (tmp_path / "before.nc").write_text(SHAFT)
    loaded = desk(StoredPart(stock_text=f"after:{tmp_path / 'before.nc'}")).load(SHAFT)
    report = part_of(loaded).report
    assert report is not None
    assert report.removed_volume_mm3 == pytest.approx(0.0, abs=1.0)  # mm³: it is made already
    assert desk(StoredPart()).load(SHAFT).part_proof != loaded.part_proof


def test_failed_part_proof_does_not_prevent_loading(
    desk: Make, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(*_given: object) -> None:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("core.proving.part_proof.PartProof.make_report", broken)
    loaded = desk(BAR).load(SHAFT)
    assert [d.code for d in loaded.diagnostics] == [NOT_MADE]
    assert loaded.phase is LoadingPhase.READY
    assert part_of(loaded).warning_texts
    assert [each.exc_info[0] for each in caplog.records if each.exc_info] == [ZeroDivisionError]


def test_program_too_long_for_the_part_model_is_reported_and_loaded(
    desk: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(part_history, "MAX_MOVES", 5)
    bench = desk(BAR, {1: TURNING})
    loaded = bench.load(SLIP)
    assert begins(part_of(loaded).error_text, "desk.too-many-blocks", count=12, most=5)
    assert loaded.picture is not None
    assert loaded.picture.no_part == part_of(loaded).error_text
    assert loaded.phase is LoadingPhase.READY
    assert bench.kinds == [LoadJob, SupplyJobProof]


# --- under a running program --------------------------------------------------------------------------


@pytest.mark.parametrize(("kept", "errors"), [(BAR, 1), (StoredPart(), 0)])
def test_changed_offsets_apply_together_with_the_new_part_check(
    desk: Make, kept: StoredPart, errors: int
) -> None:
    bench = desk(kept, {1: TURNING})
    bench.load(SLIP)
    bench.posted.clear()
    renewing = RunningRenewal(bench.session)
    assert renewing.begin_renewal()
    renewing.worker.wait_for_results(LIMIT)
    (renewed,) = (c for c in bench.posted if isinstance(c, ChangeOffsets) and c.job is not None)
    assert renewed.job is not None
    assert renewed.proof is not None
    assert len(renewed.proof.errors) == errors
    assert renewing.is_in_use(Snapshot(state=MachineState.IDLE, job=renewed.job.digest))
    given = [c.proof.warnings for c in bench.posted if isinstance(c, SupplyJobProof)]
    assert given == [("LINE 11: RAPID-INTO-STOCK",)] * (1 - errors)
    assert renewing.is_in_use(Snapshot(state=MachineState.IDLE, job=renewed.job.digest))
    assert len([c for c in bench.posted if isinstance(c, SupplyJobProof)]) == 1 - errors


# --- on the prompt line -------------------------------------------------------------------------------


def test_part_warning_is_announced_where_cycles_are_started() -> None:
    starts = wording("screen.spindle-starts", rpm=900, direction="FORWARD")
    shot = Snapshot(announced=("WARNING: LINE 11: RAPID-INTO-STOCK", starts))
    assert find_announcements(shot) == ("WARNING: LINE 11: RAPID-INTO-STOCK", starts)
    assert find_announcements(shot, can_start_here=False) == (starts,)


def test_part_warning_is_shown_with_its_remedy(desk: Make) -> None:
    loaded = desk().load(SLIP)
    words = find_remedy(loaded, "WARNING: LINE 11: RAPID-INTO-STOCK · TO START: PRESS BOTH PALM BUTTONS")
    assert find_remedy(loaded, wording("search.start-restart", start="CYCLE START")) == words
    assert find_remedy(loaded, "NO CUT YET, SPINDLE STOPPED. PRESS B TO START IT") == ""
    assert begins(words, "screen.line-what", line=11, what=pattern("desk.rapid-into-stock"))
    assert wording("desk.left-on") in words
