"""Proving while one types: the latest text wins, and a mistake shows as a sentence."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest

from app.desk.background_work import Watch
from app.desk.programs.program_loading import Proved
from app.editor.live_proof import Findings, LiveProof, by_line
from core.executor.job import Job, Proof
from core.language.diagnostics import Diagnostic, Severity
from tests.editor.shop import GOOD, workshop
from tests.texts import text


@pytest.fixture
def checker() -> Iterator[LiveProof]:
    checker = LiveProof(workshop())
    yield checker
    checker.close()


def settled(checker: LiveProof) -> Findings:
    checker.worker.settle(60.0)
    return checker.now


def test_a_good_program_is_proved_and_drawn(checker: LiveProof) -> None:
    number = checker.submit("a.nc", GOOD)
    found = settled(checker)
    assert (found.number, found.diagnostics, found.trouble) == (number, (), "")
    assert found.picture is not None
    assert found.cycle_time > 0


def test_an_error_stands_at_its_line(checker: LiveProof) -> None:
    checker.submit("a.nc", GOOD.replace("Z-.5", "Z-.5.5"))
    found = settled(checker)
    assert set(found.by_line) == {5}
    assert found.by_line[5].severity is Severity.ERROR
    assert found.errors >= 1


def test_an_empty_text_is_no_trouble(checker: LiveProof) -> None:
    number = checker.submit("a.nc", "")
    found = settled(checker)
    assert (found.number, found.trouble) == (number, "")


def test_only_the_latest_of_a_burst_is_proved() -> None:
    proved: list[str] = []
    real = workshop()

    def prove(job: Job, watch: Watch) -> Proved:
        proved.append(job.source.text)
        return real.prove(job, watch)

    checker = LiveProof(replace(real, prove=prove))
    for n in range(30):
        checker.submit("a.nc", GOOD.replace("S1000", f"S{1000 + n}"))
    assert settled(checker).number == 30
    assert proved[-1] == GOOD.replace("S1000", "S1029")
    assert len(proved) < 30
    checker.close()


def test_a_long_proof_gives_way_to_a_newer_text() -> None:
    running, tries = threading.Event(), []

    def prove(job: Job, watch: Watch) -> Proved:
        tries.append(job.source.text)
        running.set()
        while job.source.text == "old":
            watch(1)
        return Proved(Proof(job.digest, ()))

    checker = LiveProof(replace(workshop(), prove=prove))
    checker.submit("a.nc", "old")
    assert running.wait(60)
    checker.worker.clock = lambda: time.monotonic() + 1000.0  # all patience is at its end
    checker.submit("a.nc", "M30\n")
    assert settled(checker).number == 2
    assert tries == ["old", "M30\n"]
    checker.close()


def test_closing_ends_a_proof_under_way() -> None:
    running = threading.Event()

    def prove(_job: Job, watch: Watch) -> Proved:
        running.set()
        while True:
            watch(1)

    checker = LiveProof(replace(workshop(), prove=prove))
    checker.submit("a.nc", GOOD)
    assert running.wait(60)
    checker.close()
    assert not [t for t in threading.enumerate() if t.name.startswith("editing-proof")]


def test_a_prover_that_fails_is_told_and_the_next_text_is_proved() -> None:
    def make_job(source: object, block_delete: bool) -> Job:
        raise ValueError("the store is damaged")

    checker = LiveProof(replace(workshop(), make_job=make_job))
    checker.submit("a.nc", GOOD)
    assert settled(checker).trouble == text("editor.proving-failed", why="the store is damaged")
    checker.workshop = workshop()
    checker.submit("a.nc", GOOD)
    assert settled(checker).trouble == ""
    checker.close()


def test_the_weightiest_of_a_line_is_shown() -> None:
    note = Diagnostic(3, 1, Severity.NOTE, "n", "note")
    error = Diagnostic(3, 5, Severity.ERROR, "e", "error")
    assert by_line((note, error, replace(error, code="second"))) == {3: error}
