"""Tour in a separate process: after its end and after kill -9, the operator's data is as before."""

from __future__ import annotations

import json
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from app.compose.demo_store import open_demo_data_folder
from app.compose.runs.journal import Journal
from app.extras.tour.tour_setup import is_first_start
from tests.extras.tour.contents import read_contents
from tests.killed.bench import Process, process, until

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The data folder of a demo that was never used."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    return open_demo_data_folder(None)


def find_tour_folder(folder: Path) -> Path | None:
    return next(folder.glob(".tour.*"), None)


def is_running(folder: Path) -> bool:
    """Return whether the status file of the tour reports a cycle."""
    with suppress(OSError, ValueError, TypeError):
        status = (find_tour_folder(folder) or folder) / "status.json"
        return bool(json.loads(status.read_text())["execution"] == "ACTIVE")
    return False


def start_and_wait(tour: Process, folder: Path) -> None:
    until(lambda: is_running(folder), lambda: [*folder.iterdir(), tour.popen.poll()])


def test_ended_tour_leaves_only_the_mark_that_it_was_shown(folder: Path) -> None:
    before = read_contents(folder)
    with process(folder, "app.cli.main", "tour") as tour:
        start_and_wait(tour, folder)
        os.kill(tour.popen.pid, signal.SIGTERM)
        assert tour.popen.wait(60) == 0
    assert read_contents(folder) == before
    assert not is_first_start(folder)


def test_killed_tour_leaves_no_interrupted_job_and_begins_again_at_the_next_start(folder: Path) -> None:
    before = read_contents(folder)
    with process(folder, "app.cli.main", "tour") as tour:
        start_and_wait(tour, folder)
        left = find_tour_folder(folder)
        assert left is not None
        tour.kill()
        tour.home = left  # the control of the tour, which waits for another screen, is ended at last
    assert is_first_start(folder)
    assert not left.exists()
    assert read_contents(folder) == before
    journal = Journal.open_default()
    assert journal.left is None
    journal.close()
