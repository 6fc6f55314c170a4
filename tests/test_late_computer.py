"""What is played again for a late computer, and what is not."""

from __future__ import annotations

import json
import threading
from pathlib import Path

import pytest

from tests.late_computer import TRIES, command_was_late, forget, played_again, stalls_told, tell, told_late


def told_by(home: Path, *events: tuple[str, str]) -> bool:
    log = home / "logs" / "run.jsonl"
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text("".join(json.dumps({"kind": kind, "text": text}) + "\n" for kind, text in events))
    return command_was_late(home)


@pytest.mark.parametrize(
    ("first", "late"),
    [("late", True), ("hal-silent", True), ("following", False), ("estop", False)],
)
def test_a_late_computer_counts_when_it_is_what_is_told_first(first: str, late: bool) -> None:
    tell(first)
    tell("late")
    assert told_late() is late


def test_whatever_is_late_each_time_ends(tmp_path: Path) -> None:
    played: list[int] = []
    played_again(lambda: played.append(1), lambda: told_by(tmp_path, ("alarm", "903 THE COMPUTER WAS")))
    assert len(played) == TRIES


def test_any_other_cause_is_not_played_again(tmp_path: Path) -> None:
    played: list[int] = []
    wrong = ("alarm", "102 FOLLOWING ERROR: X"), ("stop", "903 THE COMPUTER WAS TOO LATE")
    played_again(lambda: played.append(1), lambda: told_by(tmp_path, *wrong))
    assert len(played) == 1


def test_a_spindle_that_stops_is_the_computers_only_behind_a_silence(tmp_path: Path) -> None:
    stop = "stop", "225 SPINDLE HAS STOPPED: something"
    assert not told_by(tmp_path, stop)


def test_and_behind_one_it_is(tmp_path: Path) -> None:
    assert told_by(
        tmp_path, ("starved", "the control was away"), ("stop", "225 SPINDLE HAS STOPPED: something")
    )


def test_a_process_that_stood_still_is_told_and_one_that_did_not_is_not() -> None:
    forget()
    tick = threading.Event()
    with stalls_told(-1.0):  # whatever it took, it was longer
        while not told_late():
            tick.wait(0.001)
    forget()
    with stalls_told(1e9):
        tick.wait(0.1)
    assert not told_late()
