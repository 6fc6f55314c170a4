"""A program proved with other offsets while the old one runs: what is posted, shown, told and dropped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.desk.programs.program_loading import LoadingPhase, LoadingSteps
from app.desk.programs.program_renewal import RunningRenewal
from core.executor.commands import ChangeOffsets
from core.executor.job import Job
from core.executor.snapshot import MachineState, Snapshot
from tests.desk.test_program_loading import BAD, LIMIT, Bench


class Shop(Bench):
    """Every renewal has another digest; the offsets cannot be read when ``broken``."""

    def __init__(self) -> None:
        super().__init__()
        self.renewals = 0
        self.broken = False
        self.session.loading_steps = LoadingSteps(self.read, self.make, self.prove, self.draw, self.renewed)
        self.renewing = RunningRenewal(self.session)
        self.session.start_loading(Path("part.nc"))
        self.settled()
        self.posted.clear()
        self.proving.clear()

    def renewed(self, job: Job) -> Job:
        if self.broken:
            raise OSError(5, "Input/output error")
        self.renewals += 1
        return replace(job, digest=f"renewed {self.renewals}")

    def running(self, digest: str) -> Snapshot:
        """The executor goes by this job."""
        return Snapshot(state=MachineState.RUN, job=digest)


@pytest.fixture
def shop() -> Iterator[Shop]:
    shop = Shop()
    yield shop
    shop.go_on.set()
    shop.session.close()


def test_changed_offsets_are_announced_before_the_new_proof(shop: Shop) -> None:
    shop.go_on.clear()
    assert shop.renewing.begin_renewal()
    assert shop.posted == [ChangeOffsets()]
    shop.go_on.set()
    shop.renewing.worker.wait_for_results(LIMIT)
    ready = shop.posted[1]
    assert isinstance(ready, ChangeOffsets)
    assert ready.job is not None
    assert ready.proof is not None
    assert (ready.job.digest, ready.proof.digest) == ("renewed 1", "renewed 1")


def test_screen_shows_the_old_job_until_the_executor_uses_the_new_one(shop: Shop) -> None:
    before = shop.session.loaded_program
    shop.renewing.begin_renewal()
    shop.renewing.worker.wait_for_results(LIMIT)
    assert not shop.renewing.is_in_use(shop.running("digest of part.nc"))
    assert shop.session.loaded_program is before
    assert shop.renewing.is_in_use(shop.running("renewed 1"))
    now = shop.session.loaded_program
    assert now.job is not None
    assert (now.job.digest, now.phase, now.path) == ("renewed 1", LoadingPhase.READY, before.path)
    assert now.picture is not None


def test_later_offset_change_replaces_the_pending_one(shop: Shop) -> None:
    shop.go_on.clear()
    shop.renewing.begin_renewal()
    assert shop.proving.wait(LIMIT)
    shop.renewing.begin_renewal()
    shop.go_on.set()
    shop.renewing.worker.wait_for_results(LIMIT)
    jobs = [
        command.job.digest for command in shop.posted if isinstance(command, ChangeOffsets) and command.job
    ]
    assert jobs == ["renewed 2"]
    assert shop.renewing.poll_error() == ""


def test_loading_a_program_cancels_the_pending_renewal(shop: Shop) -> None:
    shop.go_on.clear()
    shop.renewing.begin_renewal()
    assert shop.proving.wait(LIMIT)
    shop.session.start_loading(Path("other.nc"))
    shop.go_on.set()
    shop.renewing.worker.wait_for_results(LIMIT)
    assert shop.settled().name == "other.nc"
    assert not shop.renewing.is_in_use(shop.running("renewed 1"))
    assert shop.renewing.poll_error() == ""
    assert [command for command in shop.posted if isinstance(command, ChangeOffsets)] == [ChangeOffsets()]


def test_errors_of_new_offsets_are_reported_once_while_the_part_runs(shop: Shop) -> None:
    shop.found = (BAD,)
    shop.renewing.begin_renewal()
    shop.renewing.worker.wait_for_results(LIMIT)
    assert shop.renewing.poll_error() == BAD.message
    assert shop.renewing.poll_error() == ""
    assert shop.renewing.is_in_use(shop.running("renewed 1"))
    assert shop.session.loaded_program.phase is LoadingPhase.REFUSED


def test_unreadable_offsets_are_reported_to_the_executor(shop: Shop) -> None:
    shop.broken = True
    shop.renewing.begin_renewal()
    shop.renewing.worker.wait_for_results(LIMIT)
    assert shop.renewing.poll_error() == "Input/output error"
    assert shop.posted[-1] == ChangeOffsets(failure_reason="Input/output error")
    assert shop.renewing.poll_error() == ""


def test_renewal_without_a_program_does_nothing() -> None:
    bench = Bench()
    assert not RunningRenewal(bench.session).begin_renewal()
    assert bench.posted == []
    bench.session.close()
