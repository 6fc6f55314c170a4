"""Loading: what is posted and shown, and what a newer choice and a failure make of it."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.desk.background_work import ProgressCallback
from app.desk.programs.program_loading import (
    LoadedProgram,
    LoadingPhase,
    LoadingSteps,
    ProgramLoader,
    ProvedJob,
)
from app.desk.status.prompt_line import make_prompt, make_refusal_text
from app.path.path_picture import PictureBuilder, ProgramPicture
from core.executor.commands import Command, LoadJob, SupplyJobProof
from core.executor.job import Job, Proof
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource
from tests.texts import text as wording

LIMIT = 60.0  # seconds after which a test that waits for the worker has failed
BAD = Diagnostic(7, 1, Severity.ERROR, "arc-radius", "The arc's radius is too small.")


class Bench:
    """A workshop whose proving stops until the test lets it go on."""

    def __init__(self) -> None:
        self.posted: list[Command] = []
        self.proving = threading.Event()
        self.go_on = threading.Event()
        self.go_on.set()
        self.found: tuple[Diagnostic, ...] = ()
        self.session = ProgramLoader(
            LoadingSteps(self.read, self.make, self.prove, self.draw), self.posted.append
        )

    def read(self, path: Path) -> ProgramSource:
        if path.name == "gone.nc":
            raise FileNotFoundError(2, "No such file or directory", str(path))
        if path.name == "broken.nc":
            raise RuntimeError("the reader fell over")
        return ProgramSource(path.name, "G90\nM30\n")

    def make(self, source: ProgramSource, block_delete: bool) -> Job:
        return Job(
            source,
            InterpreterSetup(block_delete=block_delete),
            f"digest of {source.name}",
            SharedProgram(source),
        )

    def prove(self, job: Job, watch: ProgressCallback) -> ProvedJob:
        self.proving.set()
        assert self.go_on.wait(LIMIT)
        watch(1000)
        return ProvedJob(Proof(job.digest, tuple(d.message for d in self.found)), self.found)

    def draw(self, _job: Job, watch: ProgressCallback) -> ProgramPicture:
        watch(500)
        return PictureBuilder().build_picture()

    def settled(self) -> LoadedProgram:
        """The program on the desk once loading is over."""
        now = self.session.wait_until_loaded(LIMIT)
        assert not now.is_busy
        return now


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.go_on.set()
    bench.session.close()


def test_a_program_is_loaded_proved_and_drawn(bench: Bench) -> None:
    bench.session.start_loading(Path("part.nc"))
    loaded = bench.settled()
    assert loaded.phase is LoadingPhase.READY
    assert loaded.source is not None
    assert loaded.source.lines == ("G90", "M30")
    assert loaded.picture is not None
    assert [type(command) for command in bench.posted] == [LoadJob, SupplyJobProof]


def test_program_is_posted_without_a_proof_while_it_is_proved(bench: Bench) -> None:
    bench.go_on.clear()
    bench.session.start_loading(Path("part.nc"))
    assert bench.proving.wait(LIMIT)
    (load,) = bench.posted
    assert isinstance(load, LoadJob)
    assert load.proof is None
    assert bench.session.loaded_program.phase is LoadingPhase.PROVING


def test_newer_choice_replaces_a_load_in_progress(bench: Bench) -> None:
    bench.go_on.clear()
    bench.session.start_loading(Path("first.nc"))
    assert bench.proving.wait(LIMIT)
    bench.session.start_loading(Path("second.nc"))
    bench.go_on.set()
    loaded = bench.settled()
    assert loaded.name == "second.nc"
    proofs = [command.proof.digest for command in bench.posted if isinstance(command, SupplyJobProof)]
    assert proofs == ["digest of second.nc"]


def test_program_errors_refuse_the_start_and_name_the_line(bench: Bench) -> None:
    bench.found = (BAD, BAD)
    bench.session.start_loading(Path("part.nc"))
    loaded = bench.settled()
    assert loaded.phase is LoadingPhase.REFUSED
    assert make_refusal_text(loaded) == wording(
        "screen.will-not-run-at-line", line=7, why=f"{BAD.message} (1 MORE)"
    )


def test_tools_without_offsets_are_named_before_the_start() -> None:
    source = ProgramSource("part.nc", "G90")
    job = Job(source, InterpreterSetup(), "digest", SharedProgram(source), frozenset({1}))
    loaded = LoadedProgram(
        LoadingPhase.READY, Path("part.nc"), job=job, proof=Proof("digest", (), tool_numbers=(3, 1, 2))
    )
    text = make_prompt(Snapshot(state=MachineState.IDLE, program="part.nc"), loaded, "PRESS", "")
    assert text == wording("screen.no-offset-set", tools="T2, T3")


@pytest.mark.parametrize(
    ("name", "why"), [("gone.nc", "No such file or directory"), ("broken.nc", "the reader fell over")]
)
def test_program_that_cannot_be_loaded_shows_the_reason(bench: Bench, name: str, why: str) -> None:
    bench.session.start_loading(Path(name))
    loaded = bench.settled()
    assert loaded.phase is LoadingPhase.UNREADABLE
    assert bench.posted == []
    text = make_prompt(Snapshot(state=MachineState.IDLE), loaded, "", "")
    assert text == wording("screen.cannot-be-loaded", name=name, why=why)


def test_block_delete_is_part_of_the_job(bench: Bench) -> None:
    bench.session.start_loading(Path("part.nc"), block_delete=True)
    bench.settled()
    (load, _proof) = bench.posted
    assert isinstance(load, LoadJob)
    assert load.job.setup.block_delete


def test_closing_cancels_a_load_in_progress(bench: Bench) -> None:
    bench.go_on.clear()
    bench.session.start_loading(Path("part.nc"))
    assert bench.proving.wait(LIMIT)
    closing = threading.Thread(target=bench.session.close)
    closing.start()
    bench.go_on.set()
    closing.join(LIMIT)
    assert not closing.is_alive()
    assert len(bench.posted) <= 2
    assert bench.session.loaded_program.picture is None
