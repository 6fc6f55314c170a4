"""``turndesk jobs``: the queue from the command line, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.extras.jobs.jobs_command import JOBS_OUTPUT
from core.access.access_table import AccessLevel
from core.store import user_records
from core.store.production import job_queue
from core.store.store import Store
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole


@pytest.fixture
def programs(home: Path) -> Path:
    folder = home / "programs"
    folder.mkdir(parents=True)
    for name in ("cap.nc", "ring.nc"):
        (folder / name).write_text("G90G94F10\nT1\nX1Z1\nM30\n")
    return folder


@pytest.mark.usefixtures("programs")
def test_jobs_are_added_listed_moved_removed_and_cleared(turndesk: Turndesk, home: Path) -> None:
    assert turndesk("jobs", "list").out.startswith("no job waits; 'turndesk jobs add PROGRAM PARTS'")
    assert turndesk("jobs", "add", "cap", 50, "--note", "order 7").out == "cap.nc, 50 parts, is job 1\n"
    assert turndesk("jobs", "add", "RING.NC", 2).status == 0
    assert turndesk("jobs", "add", "pin", 3).out == "pin.nc, 3 parts, is job 3\n"  # a sample
    assert turndesk("jobs", "move", 2, 1).out == "ring.nc is job 1\n"
    with Store.open(home) as store:
        job = store.jobs.read_jobs()[0].id
        store.write(lambda c: job_queue.activate_job(c, job)).result()
        store.runs.add_parts("ring.nc", 2).result()
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
    ("argv", "code", "value"),
    [
        (("add", "gone.nc", 3), "not-a-program", "gone.nc"),
        (("add", "/etc/hostname", 3), "not-a-program", "/etc/hostname"),
        (("add", "cap", 0), "part-count", "9999999"),
        (("add", "cap", 3, "--note", "x" * 81), "invalid-note", "80"),
        (("move", 1, 1), "unknown-job", "1"),
        (("remove", 0), "unknown-job", "turndesk jobs list"),
    ],
)
@pytest.mark.usefixtures("programs")
def test_invalid_commands_are_rejected(
    turndesk: Turndesk, argv: tuple[object, ...], code: str, value: str
) -> None:
    told = turndesk("jobs", *argv)
    assert (told.status, told.code) == (2, code)
    assert value in told.err
    assert told.err.count("\n") == 1


@pytest.mark.usefixtures("programs")
def test_queue_changes_are_rejected_while_turndesk_runs(turndesk: Turndesk, home: Path) -> None:
    with Store.open(home):
        told = turndesk("jobs", "add", "cap", 5)
        assert (told.status, told.code) == (2, "in-use")
        assert turndesk("jobs", "list").status == 0


@pytest.mark.usefixtures("programs")
def test_job_changes_are_logged_with_the_user_name(
    turndesk: Turndesk, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("getpass.getuser", lambda: "shop")
    monkeypatch.delenv("SSH_CONNECTION", raising=False)
    with Store.open(home) as store:
        ann = user_records.UserRow("ANN", AccessLevel.SERVICE, b"salt", b"hash")
        store.write(lambda c: user_records.save_user(c, ann)).result(60)
    assert turndesk("jobs", "add", "cap", 20).status == 0
    with Store.open(home) as store:
        assert [(row.text, row.who) for row in store.events.read_events("jobs")] == [
            ("jobs: cap.nc, 20 parts, is job 1", "shop")
        ]


def test_the_list_has_the_declared_keys(turndesk: Turndesk, home: Path) -> None:
    assert turndesk("jobs", "add", "pin.nc", "5").status == 0
    declared_alone([whole(turndesk("jobs", "list", "--json"))], JOBS_OUTPUT.keys)
