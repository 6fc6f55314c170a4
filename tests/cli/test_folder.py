"""``prove DIR``: which files count, what is kept, workers that are killed, and what is refused."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import subprocess
import sys
from concurrent.futures import BrokenExecutor, Executor, Future
from pathlib import Path
from typing import Any

import pytest

from app.cli.proofs.proof_cache import ProofCache, format_for_hash
from app.cli.proofs.proof_job import ProofJob
from app.cli.proofs.proof_pool import WORKER_KILLED_TEXT, LocalWorkers, WorkDistributor
from app.cli.proofs.proof_work import Proof
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from core.language.source import ProgramSource
from core.proving.program_tools import PartSettings
from tests.benchmarks.bench_folder import program
from tests.cli.conftest import Turndesk
from tests.texts import text as wording

GOOD = "G90G94F300\nM03S1000\nT1\nX.5Z.1\nG95F.004Z-.2\nG94F300Z1\nM30\n"
BAD = "G90G94F300\nQ3\nM30\n"


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    """Two sound programs and one with an error, one of them below, and two files that are none."""
    folder = tmp_path / "parts"
    (folder / "below" / ".git").mkdir(parents=True)
    (folder / "b.nc").write_text(GOOD)
    (folder / "A").write_text(GOOD.replace("-.2", "-.3"))
    (folder / "below" / "c.TAP").write_text(BAD)
    (folder / "part.pdf").write_text("a drawing")
    (folder / ".hidden.nc").write_text(BAD)
    (folder / "below" / ".git" / "head.nc").write_text(BAD)
    return folder


def names(lines: list[dict[str, Any]], folder: Path) -> list[str]:
    return [str(Path(line["file"]).relative_to(folder)) for line in lines]


def test_folder_json_has_one_line_per_program_in_name_order(
    turndesk: Turndesk, parts: Path, offsets: Path
) -> None:
    told = turndesk("prove", parts, "--offsets", offsets, "--json")
    assert names(told.lines, parts) == ["A", "b.nc", "below/c.TAP"]
    assert told.status == 1
    assert told.err == "turndesk: 2 other files skipped\n"
    one = turndesk("prove", parts / "b.nc", "--offsets", offsets, "--json")
    assert told.lines[1] == one.lines[0]


def test_folder_table_ends_with_totals_and_slowest_program(
    turndesk: Turndesk, parts: Path, offsets: Path
) -> None:
    rows = turndesk("prove", parts, "--offsets", offsets).out.splitlines()
    assert rows[0].split() == ["verdict", "errors", "warnings", "cycle", "s", "removed", "program"]
    assert rows[2].split()[0:3] == ["proved", "0", "0"]
    assert rows[3].split()[0:2] == ["errors", "1"]
    assert rows[4].strip().startswith("line 2: ")
    assert rows[5] == "3 programs: 2 proved, 1 with errors, 2 other files skipped"
    assert rows[6].startswith("slowest to prove: ")


def test_files_given_twice_are_proved_once(turndesk: Turndesk, parts: Path, offsets: Path) -> None:
    odd = parts / "part.pdf"
    odd.write_text(GOOD)
    told = turndesk("prove", odd, parts, parts / "b.nc", "--offsets", offsets, "--json", "--jobs", 1)
    assert names(told.lines, parts) == ["A", "b.nc", "below/c.TAP", "part.pdf"]


def test_unreadable_file_does_not_prevent_other_proofs(
    turndesk: Turndesk, parts: Path, offsets: Path
) -> None:
    (parts / "b.nc").write_bytes(b"\0\1\2")
    told = turndesk("prove", parts, "--offsets", offsets, "--json")
    assert (told.status, names(told.lines, parts)) == (2, ["A", "below/c.TAP"])
    assert "b.nc " in told.err
    assert "not proved" in turndesk("prove", parts, "--offsets", offsets).out


# --- what is kept


PAGE = 4096  # bytes, the least that a pipe holds


def kept(home: Path) -> list[Path]:
    return sorted(path for path in (home / "proofs").glob("??/*"))


def test_unchanged_folder_is_taken_from_the_proof_cache(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = turndesk("prove", parts, "--offsets", offsets, "--json")
    assert len(kept(home)) == 3
    monkeypatch.setattr(LocalWorkers, "start_workers", lambda *_: pytest.fail("a worker was started"))
    assert turndesk("prove", parts, "--offsets", offsets, "--json") == first


@pytest.mark.parametrize("more", [
    ("--machine", "sinumerik-linear"), ("--block-delete",), ("--strict",), ("--ideal",),
    ("--optional-stop",), ("--stock", "bar:2"), ("--offsets", "{other}"), ("--inputs", "{inputs}"),
])  # fmt: skip
def test_changed_input_of_a_proof_is_proved_again(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path, tmp_path: Path, more: tuple[str, ...]
) -> None:
    other, inputs = tmp_path / "other.toml", tmp_path / "inputs.toml"
    other.write_text("[tool.1]\nx = .01\nz = 0.0\n".replace("= .", "= 0."))
    inputs.write_text("[inputs]\n10 = true\n")
    given = () if "--offsets" in more else ("--offsets", offsets)
    turndesk("prove", parts, "--offsets", offsets, "--json")
    turndesk("prove", parts, *given, *(word.format(other=other, inputs=inputs) for word in more), "--json")
    assert len(kept(home)) == 6


def test_changed_program_is_proved_again_and_old_text_is_cached(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path
) -> None:
    for depth in ("-.2", "-.4", "-.2"):
        (parts / "b.nc").write_text(GOOD.replace("-.2", depth))
        turndesk("prove", parts, "--offsets", offsets, "--json")
    assert len(kept(home)) == 4


def test_no_cache_option_neither_stores_nor_reads_proofs(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path
) -> None:
    turndesk("prove", parts, "--offsets", offsets, "--json", "--no-cache")
    assert kept(home) == []


def test_damaged_cached_proof_is_replaced(turndesk: Turndesk, parts: Path, offsets: Path, home: Path) -> None:
    first = turndesk("prove", parts, "--offsets", offsets, "--json")
    for path, rest in zip(kept(home), (b"", b"rubbish", kept(home)[2].read_bytes()[:-20]), strict=True):
        path.write_bytes(rest)
    assert turndesk("prove", parts, "--offsets", offsets, "--json") == first


@pytest.fixture
def job() -> ProofJob:
    machine = read_machine(None)
    return ProofJob(
        machine, create_power_up_setup(machine, tool_offsets={}, secondary_offsets={}), PartSettings()
    )


def test_oldest_cached_proofs_are_deleted_above_size_limit(tmp_path: Path, job: ProofJob) -> None:
    cache = ProofCache(tmp_path, job, max_bytes=2000)
    keys = [cache.get_cache_key(ProgramSource(f"{n}.nc", GOOD)) for n in range(40)]
    for age, key in enumerate(keys):
        cache.save_proof(key, Proof({"file": os.urandom(40).hex(), "diagnostics": []}))
        os.utime(tmp_path / key[:2] / key[2:], (1000.0 - age, 1000.0 - age))
    aside = tmp_path / keys[0][:2] / "left.1.part"
    aside.write_text("half")
    os.utime(aside, (1.0, 1.0))
    cache.delete_oldest_proofs()
    sizes = [path.stat().st_size for path in tmp_path.glob("??/*")]
    assert 1000 < sum(sizes) <= 1600
    assert [cache.find_proof(key) is not None for key in (keys[0], keys[-1])] == [True, False]
    assert not aside.exists()


def test_full_disk_is_reported_once_and_proving_continues(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_self: Path, _data: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    told = turndesk("prove", parts, "--offsets", offsets, "--json")
    assert (told.status, len(told.lines)) == (1, 3)
    assert told.err.count("proofs cannot be stored") == 1
    assert "No space left" in told.err
    assert kept(home) == []


def test_value_without_a_stable_text_is_not_hashed() -> None:
    assert format_for_hash({"b": frozenset({2, 1}), "a": (0.1, None)}) == "{'a':[0.1,None],'b':<1,2>}"
    with pytest.raises(TypeError):
        format_for_hash(format_for_hash)


def test_stock_saved_with_a_program_applies_in_folder_proof(
    turndesk: Turndesk, parts: Path, offsets: Path, home: Path
) -> None:
    given = ("--offsets", offsets, "--json")
    before = turndesk("prove", parts, *given)
    alone = turndesk("prove", parts / "b.nc", *given, "--stock", "bar:1.25", "--keep-stock").lines[0]
    after = turndesk("prove", parts, *given)
    assert after.lines[1] == alone
    assert after.lines[1]["stock"]["given"] == "bar:1.25"
    assert [after.lines[k] for k in (0, 2)] == [before.lines[k] for k in (0, 2)]
    assert len(kept(home)) == 4
    told = turndesk("prove", parts, "--stock", "bar:2", "--keep-stock")
    assert (told.status, told.code) == (2, "keep-stock-of-many")


# --- workers that are killed


def killing(number: int) -> int:
    """The square of a number; 13 kills whoever reckons it."""
    if number == 13:
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number


def _submit(executor: Executor, number: int) -> Future[int]:
    return executor.submit(killing, number)


def test_task_that_kills_its_worker_twice_fails_and_others_finish() -> None:
    made = dict(WorkDistributor(LocalWorkers(2), _submit).iterate_results(iter(range(30))))
    assert isinstance(made.pop(13), BrokenExecutor)
    assert made == {n: n * n for n in range(30) if n != 13}


def test_killed_worker_does_not_lose_any_proof(tmp_path: Path, offsets: Path) -> None:
    """As ``kill -9`` by another hand, in the middle of a folder."""
    for number in range(40):
        (tmp_path / f"{number:02d}.nc").write_text(program(number))
    command = [sys.executable, "-m", "app.cli.main", "prove", str(tmp_path), "--json", "--no-cache",
               "--offsets", str(offsets)]  # fmt: skip
    around = {**os.environ, "TURNDESK_HOME": str(tmp_path / "home")}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=around, pipesize=PAGE) as proving:
        assert proving.stdout is not None
        lines = [proving.stdout.readline()]
        for worker in _workers(proving.pid)[:1]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(worker, signal.SIGKILL)
        lines += proving.stdout.readlines()
    assert [Path(json.loads(line)["file"]).stem for line in lines] == [f"{n:02d}" for n in range(40)]
    assert proving.returncode == 0


def _children(process: int) -> list[int]:
    """None of one that has ended meanwhile."""
    try:
        return [int(n) for n in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []


def _workers(process: int) -> list[int]:
    """The workers are children of the process that they are forked from."""
    return [worker for child in _children(process) for worker in _children(child)]


def test_ctrl_c_retains_finished_proofs_for_next_run(tmp_path: Path, offsets: Path) -> None:
    folder, home = tmp_path / "parts", tmp_path / "home"
    folder.mkdir()
    for number in range(60):
        (folder / f"{number:02d}.nc").write_text(program(number))
    command = [sys.executable, "-m", "app.cli.main", "prove", str(folder), "--json",
               "--offsets", str(offsets), "--report", str(tmp_path / "report.html")]  # fmt: skip
    around = {**os.environ, "TURNDESK_HOME": str(home)}
    # In the background of a shell Ctrl+C is ignored, and whoever is started inherits that. Its pipe holds a
    # few lines: it waits for the test to read, however late that comes, and is not through before Ctrl+C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=around,
        start_new_session=True, pipesize=PAGE,
    ) as proving:  # fmt: skip
        signal.signal(signal.SIGINT, before)
        assert proving.stdout is not None
        assert proving.stderr is not None
        proving.stdout.readline()
        os.killpg(proving.pid, signal.SIGINT)
        rest, said = proving.stdout.readlines(), proving.stderr.read()
    assert (proving.returncode, said) == (130, "turndesk: interrupted\n")
    assert len(kept(home)) >= len(rest) + 1
    assert len(kept(home)) < 60
    assert [each.name for each in tmp_path.iterdir() if "report" in each.name] == []


INTERRUPTED_WHILE_A_CLASS_IS_MADE = """\
import sys
from app.cli import alarms_command
from app.cli.main import main

def run(args):
    exec("raise KeyboardInterrupt")

alarms_command.run = run
sys.exit(main(["alarms"]))
"""


def test_ctrl_c_during_class_creation_exits_with_status_130(tmp_path: Path) -> None:
    (tmp_path / "interrupted.py").write_text(INTERRUPTED_WHILE_A_CLASS_IS_MADE)
    ended = subprocess.run(
        [sys.executable, "-m", "interrupted"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stderr) == (130, "turndesk: interrupted\n")


class Finalized:
    """Ctrl+C arrives while it is put away."""

    def __del__(self) -> None:
        raise KeyboardInterrupt


def test_keyboard_interrupt_dropped_by_python_still_ends_the_command(
    turndesk: Turndesk, parts: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(20):
        (parts / f"{number:02d}.nc").write_text(program(number))
    given: list[int] = []

    def interrupted(_executor: Executor, *_: object) -> Future[Proof]:
        given.append(1)
        Finalized()
        future: Future[Proof] = Future()
        future.set_exception(ZeroDivisionError("made for this test"))
        return future

    monkeypatch.setattr("concurrent.futures.ProcessPoolExecutor.submit", interrupted)
    hook = sys.unraisablehook
    told = turndesk("prove", parts, "--offsets", offsets, "--jobs=1")
    assert (told.status, told.err.splitlines()[-1]) == (130, "turndesk: interrupted")
    assert sys.unraisablehook is hook
    assert 0 < len(given) < 20


# --- what is refused


@pytest.mark.parametrize("number", ["0", "-1", "two", "1.5", "1000", ""])
def test_invalid_job_count_is_rejected(turndesk: Turndesk, parts: Path, number: str) -> None:
    told = turndesk("prove", parts, f"--jobs={number}")
    assert told.status == 2
    assert wording("cli.no-job-count", word=repr(number), most=256) in told.err
    assert told.err.count("\n") == 1


def test_empty_folder_and_missing_folder_are_reported(turndesk: Turndesk, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    told = turndesk("prove", tmp_path / "empty")
    assert (told.status, told.code) == (2, "no-programs")
    told = turndesk("prove", tmp_path / "nowhere", "--jobs", 1)
    assert (told.status, "nowhere" in told.err) == (2, True)


def test_no_cache_option_is_rejected_for_a_single_program(turndesk: Turndesk, parts: Path) -> None:
    told = turndesk("prove", parts / "b.nc", "--no-cache")
    assert (told.status, told.code) == (2, "no-cache")


def test_invalid_offsets_stop_folder_proof_before_it_starts(
    turndesk: Turndesk, parts: Path, tmp_path: Path
) -> None:
    broken = tmp_path / "broken.toml"
    broken.write_text("[tool.1]\nx = true\n")
    told = turndesk("prove", parts, "--offsets", broken)
    assert (told.status, told.code, told.out, told.err.count("\n")) == (2, "wrong-type", "", 1)


def test_internal_error_is_reported_with_its_program(
    turndesk: Turndesk, parts: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def faulty(_executor: Executor, *_: object) -> Future[Proof]:
        future: Future[Proof] = Future()
        future.set_exception(ZeroDivisionError("made for this test"))
        return future

    monkeypatch.setattr("concurrent.futures.ProcessPoolExecutor.submit", faulty)
    told = turndesk("prove", parts, "--offsets", offsets, "--json")
    assert told.status == 2
    assert told.err.count("internal error in TurnDesk (made for this test)") == 3
    assert WORKER_KILLED_TEXT not in told.err
