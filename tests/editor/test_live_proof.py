"""Proving while one types: the latest text wins, and a mistake shows as a sentence."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest

from app.desk.background_work import ProgressCallback
from app.desk.programs.program_loading import ProvedJob
from app.editor.live_proof import LiveProof, ProofFindings, map_findings_by_line
from core.executor.job import Job, Proof
from core.language.diagnostics import Diagnostic, Severity
from tests.editor.shop import GOOD, workshop
from tests.texts import text


@pytest.fixture
def checker() -> Iterator[LiveProof]:
    checker = LiveProof(workshop())
    yield checker
    checker.close()


def settled(checker: LiveProof) -> ProofFindings:
    checker.worker.wait_for_results(60.0)
    return checker.current_findings


def test_a_good_program_is_proved_and_drawn(checker: LiveProof) -> None:
    number = checker.submit_text("a.nc", GOOD)
    found = settled(checker)
    assert (found.number, found.diagnostics, found.error_text) == (number, (), "")
    assert found.picture is not None
    assert found.cycle_time_s > 0


def test_error_is_reported_at_its_line(checker: LiveProof) -> None:
    checker.submit_text("a.nc", GOOD.replace("Z-.5", "Z-.5.5"))
    found = settled(checker)
    assert set(found.line_findings) == {5}
    assert found.line_findings[5].severity is Severity.ERROR
    assert found.error_count >= 1


def test_empty_text_reports_no_error(checker: LiveProof) -> None:
    number = checker.submit_text("a.nc", "")
    found = settled(checker)
    assert (found.number, found.error_text) == (number, "")


def test_only_latest_text_of_a_burst_is_proved() -> None:
    proved: list[str] = []
    real = workshop()

    def prove(job: Job, watch: ProgressCallback) -> ProvedJob:
        proved.append(job.source.text)
        return real.prove_job(job, watch)

    checker = LiveProof(replace(real, prove_job=prove))
    for n in range(30):
        checker.submit_text("a.nc", GOOD.replace("S1000", f"S{1000 + n}"))
    assert settled(checker).number == 30
    assert proved[-1] == GOOD.replace("S1000", "S1029")
    assert len(proved) < 30
    checker.close()


def test_running_proof_is_canceled_when_newer_text_arrives() -> None:
    running, tries = threading.Event(), []

    def prove(job: Job, watch: ProgressCallback) -> ProvedJob:
        tries.append(job.source.text)
        running.set()
        while job.source.text == "old":
            watch(1)
        return ProvedJob(Proof(job.digest, ()))

    checker = LiveProof(replace(workshop(), prove_job=prove))
    checker.submit_text("a.nc", "old")
    assert running.wait(60)
    checker.worker.read_time_s = lambda: time.monotonic() + 1000.0  # all patience is at its end
    checker.submit_text("a.nc", "M30\n")
    assert settled(checker).number == 2
    assert tries == ["old", "M30\n"]
    checker.close()


def test_close_stops_a_running_proof() -> None:
    running = threading.Event()

    def prove(_job: Job, watch: ProgressCallback) -> ProvedJob:
        running.set()
        while True:
            watch(1)

    checker = LiveProof(replace(workshop(), prove_job=prove))
    checker.submit_text("a.nc", GOOD)
    assert running.wait(60)
    checker.close()
    assert not [t for t in threading.enumerate() if t.name.startswith("editing-proof")]


def test_prover_failure_is_reported_and_next_text_is_proved() -> None:
    def make_job(source: object, block_delete: bool) -> Job:
        raise ValueError("the store is damaged")

    checker = LiveProof(replace(workshop(), make_job=make_job))
    checker.submit_text("a.nc", GOOD)
    assert settled(checker).error_text == text("editor.proving-failed", why="the store is damaged")
    checker.loading_steps = workshop()
    checker.submit_text("a.nc", GOOD)
    assert settled(checker).error_text == ""
    checker.close()


def test_most_severe_finding_of_a_line_is_shown() -> None:
    note = Diagnostic(3, 1, Severity.NOTE, "n", "note")
    error = Diagnostic(3, 5, Severity.ERROR, "e", "error")
    assert map_findings_by_line((note, error, replace(error, code="second"))) == {3: error}
