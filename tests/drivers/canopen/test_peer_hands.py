"""Words typed at simulated drives: what they do, and what is not understood."""

from __future__ import annotations

import os

import pytest

from app.compose.backends.simulated_devices import HELP_TEXT, LineReader, execute_command
from tests.drivers.canopen.bench import CanBench
from tests.texts import opening, text


def test_simulated_station_actions_reach_the_control(bench: CanBench) -> None:
    assert execute_command("estop", bench.peers) == "estop: done"
    bench.run(0.1)
    assert bench.machine.io.read_state().estop
    assert execute_command("release", bench.peers) == "release: done"
    assert execute_command("feed 50", bench.peers) == "feed 50: done"
    assert execute_command("auto off", bench.peers) == "auto off: done"
    assert execute_command("input TB2-5 on", bench.peers) == "input TB2-5 on: done"
    bench.run(0.2)
    state = bench.machine.io.read_state()
    assert not state.estop
    assert not state.spindle_auto
    assert state.feed_pot == pytest.approx(0.5, abs=0.01)
    assert bench.machine.io.inputs()["TB2-5"]


def test_both_palm_buttons_give_one_start(bench: CanBench) -> None:
    seen = []
    assert execute_command("start", bench.peers) == "start: done"
    for _ in range(60):
        bench.tick()
        seen.append(bench.machine.io.read_state().start)
    assert True in seen
    assert not seen[-1]


def test_disconnected_cable_silences_every_node(bench: CanBench) -> None:
    assert execute_command("cable off", bench.peers) == "cable off: done"
    bench.run(0.5)
    assert bench.machine.axes.sample().fault


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("dance", text("drivers.unknown-command", line="dance", help=HELP_TEXT)),
        ("feed", opening("drivers.unknown-command", line="feed")),
        ("feed fast", opening("drivers.unknown-command", line="feed fast")),
        ("auto maybe", opening("drivers.unknown-command", line="auto maybe")),
        ("start now", opening("drivers.unknown-command", line="start now")),
        ("input 77 on", "77"),
        ("jam Q on", text("drivers.no-drive", axis="Q", drives="X, Z")),
    ],
)
def test_unknown_command_is_reported_and_changes_nothing(bench: CanBench, line: str, told: str) -> None:
    assert told in execute_command(line, bench.peers)
    bench.run(0.1)
    assert not bench.machine.axes.sample().fault


def test_lines_are_read_whole_and_end_of_input_is_not_an_error() -> None:
    theirs, ours = os.pipe()
    typed = LineReader(theirs)
    assert list(typed.read_lines()) == []
    os.write(ours, b"sta")
    assert list(typed.read_lines()) == []
    os.write(ours, b"rt\n\n hold \n")
    assert list(typed.read_lines()) == ["start", "hold"]
    os.close(ours)
    assert list(typed.read_lines()) == []
    assert list(typed.read_lines()) == []
    os.close(theirs)
