"""``prove --scheduler``: a real scheduler with two workers on loopback, one of them killed; and refusals."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from app.cli.proofs import proof_work
from app.cli.proofs.proof_work import VersionMismatchError, prove_pickled_program
from core.language.source import ProgramSource
from tests.benchmarks.bench_folder import program
from tests.cli.conftest import Turndesk, home, offsets, turndesk

__all__ = ["home", "offsets", "turndesk"]

with_distributed = pytest.mark.skipif(
    importlib.util.find_spec("distributed") is None,
    reason="dask.distributed is not installed (turndesk[scheduler])",
)
PROGRAMS = 40
_CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        print(cluster.scheduler_address, *(each.pid for each in cluster.workers.values()), flush=True)
        sys.stdin.read()
"""


class Cluster(NamedTuple):
    """A scheduler, and the processes of its workers."""

    address: str
    workers: list[int]


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    script = tmp_path / "cluster.py"
    script.write_text(_CLUSTER)
    with subprocess.Popen(
        [sys.executable, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=tmp_path
    ) as process:
        assert process.stdout is not None
        address, *workers = process.stdout.readline().split()
        yield Cluster(address.removeprefix("tcp://"), [int(each) for each in workers])
        process.communicate()


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    folder = tmp_path / "parts"
    folder.mkdir()
    for number in range(PROGRAMS):
        (folder / f"{number:02d}.nc").write_text(program(number))
    return folder


@pytest.mark.long
@with_distributed
def test_folder_is_proved_although_one_of_two_workers_is_killed(
    cluster: Cluster, parts: Path, offsets: Path, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "app.cli.main", "prove", str(parts), "--json", "--offsets", str(offsets)]
    around = {**os.environ, "TURNDESK_HOME": str(tmp_path / "home")}
    given = [*command, "--scheduler", cluster.address]
    with subprocess.Popen(given, stdout=subprocess.PIPE, text=True, env=around) as proving:
        assert proving.stdout is not None
        lines = [proving.stdout.readline()]
        os.kill(cluster.workers[0], signal.SIGKILL)
        lines += proving.stdout.readlines()
    assert proving.returncode == 0
    here = subprocess.run([*command, "--no-cache"], stdout=subprocess.PIPE, text=True, env=around, check=True)
    assert [json.loads(line) for line in lines] == [json.loads(line) for line in here.stdout.splitlines()]
    assert len(lines) == PROGRAMS


@with_distributed
def test_unreachable_scheduler_is_rejected(
    turndesk: Turndesk, parts: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.extras.scheduler.proof_scheduler._ANSWER", 0.2)
    told = turndesk("prove", parts, "--offsets", offsets, "--scheduler", "127.0.0.1:1")
    assert (told.status, told.code) == (2, "no-scheduler")


@pytest.mark.parametrize("address", ["here", "127.0.0.1", "127.0.0.1:", ":8786", "127.0.0.1:99999", "a b:1"])
def test_invalid_scheduler_address_is_rejected(
    turndesk: Turndesk, parts: Path, offsets: Path, address: str
) -> None:
    told = turndesk("prove", parts, "--offsets", offsets, f"--scheduler={address}")
    assert (told.status, told.code, told.err.count("\n")) == (2, "scheduler-address", 1)


def test_missing_dask_is_rejected_in_one_line(
    turndesk: Turndesk, parts: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    told = turndesk("prove", parts, "--offsets", offsets, "--scheduler", "127.0.0.1:8786")
    assert (told.status, told.code, told.err.count("\n")) == (2, "no-dask", 1)
    assert "turndesk[scheduler]" in told.err


def test_jobs_and_scheduler_options_are_mutually_exclusive(turndesk: Turndesk, parts: Path) -> None:
    told = turndesk("prove", parts, "--scheduler", "127.0.0.1:8786", "--jobs", 2)
    assert (told.status, told.code) == (2, "jobs-and-scheduler")


def test_worker_with_another_turndesk_version_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof_work, "get_code_hash", lambda: "another")
    with pytest.raises(VersionMismatchError):
        prove_pickled_program(b"", "ours", ProgramSource("a.nc", "M30\n"))
