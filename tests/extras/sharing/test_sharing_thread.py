"""The thread that looks: how long a place has been silent, by a clock of the test's own."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest

import resources
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import NO_OFFSETS
from app.desk.data_folder import HOME_VARIABLE
from app.extras.sharing.sharing import ProgramSharing, SharingResult, SharingThread
from app.extras.sharing.sharing_setup import start_sharing
from core.executor.commands import (
    CycleStart,
    EnableDrives,
    LoadJob,
    ReplaceStartClearances,
    StartClearance,
)
from core.executor.job import Proof
from core.executor.snapshot import MachineState, Snapshot
from drivers.wakeups import ManualClock
from tests.control.bench import job_of


class Dead:
    """A place on a drive that answers when it is let, and the sharing that waits for it."""

    def __init__(self) -> None:
        self.asked, self.answers = threading.Event(), threading.Event()

    def synchronize(self, *, is_settled: bool) -> SharingResult:
        assert is_settled
        self.asked.set()
        assert self.answers.wait(60.0)
        return SharingResult()


def test_waiting_time_counts_until_a_hung_synchronization_ends() -> None:
    now, dead, heard = [100.0], Dead(), threading.Event()
    thread = SharingThread(cast("ProgramSharing", dead), 3600.0, lambda _shared: heard.set(), lambda: now[0])
    assert thread.get_waiting_time_s() == 0.0
    thread.start()
    assert dead.asked.wait(60.0)
    now[0] = 140.0
    assert thread.get_waiting_time_s() == 40.0
    dead.answers.set()
    assert heard.wait(60.0)
    assert thread.get_waiting_time_s() == 0.0
    thread.close()


CUT = "G90G94F300\nG01X.2Z-.2F20\nM30\n"


def test_a_part_is_completed_and_stored_while_the_share_hangs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(HOME_VARIABLE, str(tmp_path))
    path, dead, clock = tmp_path / "lathe.toml", Dead(), ManualClock()
    path.write_text(resources.read_machine_file("gt75.toml") + f'\n[sharing]\nfolder = "{tmp_path}"\n')
    monkeypatch.setattr(
        ProgramSharing, "synchronize", lambda _, is_settled: dead.synchronize(is_settled=is_settled)
    )
    journal = Journal.open_default()
    desk, executor = create_desk_and_executor(str(path), lambda: NO_OFFSETS, clock, journal)

    def until(ready: Callable[[Snapshot], bool]) -> None:
        end = clock.now() + 60.0
        while not ready(executor.snapshot):
            assert clock.now() < end, executor.snapshot
            clock.advance(0.02)
            executor.run_tick()
            desk.page_registry.notify_frame_watchers(executor.snapshot)

    stop_sharing = start_sharing(desk, journal)
    assert stop_sharing is not None
    assert dead.asked.wait(60.0)
    assert desk.machine.machine is not None
    job = job_of(CUT, desk.machine.machine)
    for command in (EnableDrives(), LoadJob(job, Proof(job.digest, ()))):
        executor.post(command)
    until(lambda shot: shot.state is MachineState.IDLE and shot.program == "part.nc")
    shot = executor.snapshot
    executor.post(ReplaceStartClearances((StartClearance(job.digest, shot.demand, shot.begun),)))
    executor.post(CycleStart())
    until(lambda shot: shot.parts == 1)
    journal.require_store().events.log_event("start", "after the part").result(60.0)
    assert "part" in [event.kind for event in journal.events("", (), 10)]
    assert not dead.answers.is_set()  # all of this while it hangs
    dead.answers.set()
    stop_sharing()
    desk.close()
    journal.close()
