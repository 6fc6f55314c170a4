"""``turndesk jobs``: the queue from the command line, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from core.store import job_queue
from core.store.store import Store
from tests.cli.conftest import Turndesk


@pytest.fixture
def programs(home: Path) -> Path:
    folder = home / "programs"
    folder.mkdir(parents=True)
    for name in ("cap.nc", "ring.nc"):
        (folder / name).write_text("G90G94F10\nT1\nX1Z1\nM30\n")
    return folder


@pytest.mark.usefixtures("programs")
def test_added_listed_moved_removed_cleared(turndesk: Turndesk, home: Path) -> None:
    assert turndesk("jobs", "list").out.startswith("no job waits; 'turndesk jobs add PROGRAM PARTS'")
    assert turndesk("jobs", "add", "cap", 50, "--note", "order 7").out == "cap.nc, 50 parts, is job 1\n"
    assert turndesk("jobs", "add", "RING.NC", 2).status == 0
    assert turndesk("jobs", "add", "pin", 3).out == "pin.nc, 3 parts, is job 3\n"  # a sample
    assert turndesk("jobs", "move", 2, 1).out == "ring.nc is job 1\n"
    with Store.open(home) as store:
        job = store.jobs()[0].id
        store.write(lambda c: job_queue.begin(c, job)).result()
        store.correct_parts("ring.nc", 2).result()
    assert turndesk("jobs", "list").out == (
        "  1  ring.nc  2 of 2 parts  done\n"
        "  2  cap.nc  0 of 50 parts  waiting  order 7\n"
        "  3  pin.nc  0 of 3 parts  waiting\n"
    )
    told = json.loads(turndesk("jobs", "list", "--json").out)["jobs"]
    assert told[0] == {
        "place": 1, "program": "ring.nc", "parts": 2, "made": 2, "left": 0, "state": "done", "note": "",
        "added": told[0]["added"],
    }  # fmt: skip
    assert turndesk("jobs", "remove", 3).out == "pin.nc is taken out, 0 of 3 parts made\n"
    assert turndesk("jobs", "clear").out == "1 job taken out\n"
    assert [each["program"] for each in json.loads(turndesk("jobs", "list", "--json").out)["jobs"]] == [
        "cap.nc"
    ]
    assert turndesk("jobs", "clear", "--all").out == "1 job taken out\n"


@pytest.mark.parametrize(
    ("argv", "why"),
    [
        (("add", "gone.nc", 3), "gone.nc is not among the programs of "),
        (("add", "/etc/hostname", 3), "put it there first"),
        (("add", "cap", 0), "a job has 1 to 9999999 parts, not 0"),
        (("add", "cap", 3, "--note", "x" * 81), "80 letters at most"),
        (("move", 1, 1), "there is no job 1: the queue is empty"),
        (("remove", 0), "'turndesk jobs list' numbers them"),
    ],
)
@pytest.mark.usefixtures("programs")
def test_refusals(turndesk: Turndesk, argv: tuple[object, ...], why: str) -> None:
    told = turndesk("jobs", *argv)
    assert told.status == 2
    assert why in told.err
    assert told.err.count("\n") == 1


@pytest.mark.usefixtures("programs")
def test_a_desk_that_runs_has_the_queue_to_itself(turndesk: Turndesk, home: Path) -> None:
    with Store.open(home):
        told = turndesk("jobs", "add", "cap", 5)
        assert told.status == 2
        assert "in use by another TurnDesk" in told.err
        assert turndesk("jobs", "list").status == 0
