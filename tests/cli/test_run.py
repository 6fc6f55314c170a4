"""``turndesk run --headless``: the real executor and drivers, ending where the proof ends; refusals."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from tests.cli.conftest import Turndesk

KEYS = {"state", "final", "elapsed_s", "alarms", "underruns", "max_following_error", "events"}
HEAD = "G90G94F300\nM03S2000\nT1\n"


@pytest.fixture
def part(tmp_path: Path) -> Callable[[str], Path]:
    def write(text: str) -> Path:
        path = tmp_path / "part.nc"
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize("name", ["arc-ik-radius", "tapping", "workshift-dry-run"])
def test_headless_run_matches_proved_end_position_and_time(
    turndesk: Turndesk, example: Callable[[str], Path], offsets: Path, name: str
) -> None:
    (proof,) = turndesk("prove", example(name), "--offsets", offsets, "--json").lines
    told = turndesk("run", example(name), "--headless", "--offsets", offsets, "--json")
    assert told.status == 0
    run = told.lines[-1]
    assert set(run) >= KEYS
    assert (run["state"], run["alarms"], run["underruns"]) == ("complete", [], 0)
    assert run["final"] == pytest.approx(proof["final"], abs=1e-6)
    assert run["elapsed_s"] == pytest.approx(proof["cycle_time_s"], rel=0.02)
    assert 0 < run["max_following_error"] < 0.04
    kinds = [json.loads(line)["kind"] for line in Path(run["events"]).read_text().splitlines()]
    assert kinds.index("start") < kinds.index("end")


def test_headless_run_presses_cycle_start_at_m00_and_reports_it(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path]
) -> None:
    path = part(HEAD + "X.5Z.1\nM00(TURN THE PART)\nZ.2\nM30\n")
    told = turndesk("run", path, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0
    assert "TURN THE PART" in told.err
    assert told.err.count("TURN THE PART") == 1  # one press of Cycle Start, told once


@pytest.mark.parametrize("options", [(), ("--optional-stop",)])
def test_optional_stop_stops_only_with_its_option(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path], options: tuple[str, ...]
) -> None:
    path = part(HEAD + "X.5Z.1\nM01(LOOK)\nZ.2\nM30\n")
    told = turndesk("run", path, "--headless", "--offsets", offsets, *options)
    assert told.status == 0
    assert ("LOOK" in told.err) is bool(options)


def test_block_delete_skips_the_line(turndesk: Turndesk, offsets: Path, part: Callable[[str], Path]) -> None:
    path = part(HEAD + "X.5Z.1\n/Z.5\nM30\n")
    ends = [
        turndesk("run", path, "--headless", "--offsets", offsets, "--json", *options).lines[-1]["final"]["z"]
        for options in ((), ("--block-delete",))
    ]
    assert ends == pytest.approx([0.5, 0.1])


def test_input_selects_the_program_branch(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(HEAD + "X.5Z.1\nM97I10C1P2\nM30\n}2\nZ.7\nM99\n")
    inputs = tmp_path / "inputs.toml"
    inputs.write_text("[inputs]\n10 = true\n")
    told = turndesk("run", path, "--headless", "--offsets", offsets, "--inputs", inputs, "--json")
    assert told.lines[-1]["final"]["z"] == pytest.approx(0.7)


def test_wait_for_an_input_that_never_changes_times_out(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path]
) -> None:
    path = part(HEAD + "X.5Z.1\nM92\nZ.2\nM30\n")  # waits until TB2-5 is closed; nobody closes it
    told = turndesk("run", path, "--headless", "--offsets", offsets, "--json")
    assert told.status == 1
    assert told.lines[-1]["state"] == "waiting"
    assert "TB2-5" in told.err
    assert "--inputs" in told.err


def test_program_with_errors_does_not_start(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path]
) -> None:
    told = turndesk("run", part(HEAD + "X.5Z.1\nZ9\nM30\n"), "--headless", "--offsets", offsets, "--json")
    assert told.status == 1
    assert told.lines[-1]["state"] == "refused"
    assert "soft-limit" in told.err


def test_program_with_a_tool_without_offset_is_refused(
    turndesk: Turndesk, part: Callable[[str], Path]
) -> None:
    told = turndesk("run", part(HEAD + "X.5Z.1\nM30\n"), "--headless", "--json")
    assert told.status == 1
    assert told.lines[-1]["state"] == "refused"
    assert "T1" in told.err.splitlines()[-1]


def test_run_without_headless_asks_for_headless(turndesk: Turndesk, part: Callable[[str], Path]) -> None:
    told = turndesk("run", part(HEAD + "M30\n"))
    assert told.status == 2
    assert "--headless" in told.err


def test_input_missing_on_the_machine_is_rejected_before_motion(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, part: Callable[[str], Path]
) -> None:
    inputs = tmp_path / "inputs.toml"
    inputs.write_text('[inputs]\n"TB25" = true\n')
    told = turndesk("run", part(HEAD + "X1Z1\nM30\n"), "--headless", "--offsets", offsets, "--inputs", inputs)
    assert (told.status, told.out) == (2, "")
    assert (told.code, "TB2-5" in told.err) == ("unknown-key", True)
    assert told.err.count("\n") == 1


# --- an interrupted job, where the metal is real ------------------------------------------------------------


@pytest.fixture
def metal(monkeypatch: pytest.MonkeyPatch) -> None:
    """The slides are simulated all the same."""
    monkeypatch.setattr("app.compose.runs.headless_run.is_simulated", lambda _machine: False)


@pytest.mark.usefixtures("metal")
def test_interrupted_job_bars_next_run_without_anew_option(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path], home: Path
) -> None:
    waits = part(HEAD + "X.5Z.1\nM92\nZ.2\nM30\n")
    told = turndesk("run", waits, "--headless", "--offsets", offsets)
    assert told.status != 0
    with closing(Journal(home)) as journal:
        assert journal.left is not None
        assert (journal.left.program, journal.left.tool) == ("part.nc", 1)
    good = part(HEAD + "X.5Z.1\nM30\n")
    told = turndesk("run", good, "--headless", "--offsets", offsets)
    assert told.status == 2
    assert told.code == "job-interrupted"
    assert "part.nc" in told.err
    assert "T1" in told.err
    told = turndesk("run", good, "--headless", "--offsets", offsets, "--anew")
    assert told.status == 0
    with closing(Journal(home)) as journal:
        assert journal.left is None
        assert "started again from the command line" in journal.events("", {"cleared"}, 9)[0].text


def test_anew_option_is_rejected_if_no_job_is_interrupted(
    turndesk: Turndesk, offsets: Path, part: Callable[[str], Path]
) -> None:
    path = part(HEAD + "X.5Z.1\nM30\n")
    told = turndesk("run", path, "--headless", "--offsets", offsets, "--anew")
    assert told.status == 2
    assert told.code == "nothing-interrupted"
