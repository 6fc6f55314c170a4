"""The whole product with a screen that stands still for a while: SIGSTOP, and SIGCONT later."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import cast

import pytest

import resources
from app.desk.status.prompt_line import RESTART_CONTROL
from core.store.store import Store
from drivers.wakeups import RealClock
from tests.killed.bench import Process, process, until

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
PROGRAM = "G90G94\nM03S600\nM08\nG01X.2Z-.2F6\nX0.Z0.\nM30\n"  # 6 s of motion a part
OPERATOR = "tests.killed.operator"
FROZEN = 5.0  # s; the control waits for 3


def started(tmp_path: Path, lost: str) -> tuple[str, str]:
    """The files of a simulated lathe with this ``screen_lost``, and of a program of many parts."""
    machine, program = tmp_path / "lathe.toml", tmp_path / "part.nc"
    text = resources.read_machine_file("gt75.toml")
    machine.write_text(text.replace("[machine]\n", f'[machine]\nscreen_lost = "{lost}"\n', 1))
    program.write_text(PROGRAM)
    return str(machine), str(program)


def parts(desk: Process) -> int:
    """Made so far, by its last word."""
    desk.listen()
    return int(str(desk.lines[-1]["parts"]))


def freeze(desk: Process) -> int:
    """Have the screen stand still in a cut; returns how many parts were made before it."""
    until(lambda: desk.says("state", "RUNNING"), lambda: desk.lines[-3:])
    made = parts(desk)
    desk.popen.send_signal(signal.SIGSTOP)
    clock = RealClock()
    until(lambda: clock.now() > FROZEN, lambda: "")
    desk.popen.send_signal(signal.SIGCONT)
    return made


def test_frozen_screen_causes_feed_hold_and_reconnects(tmp_path: Path) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *started(tmp_path, "hold")) as desk:
        made = freeze(desk)
        until(lambda: desk.says("state", "FEED HOLD"), lambda: desk.lines[-3:])
        assert parts(desk) <= made
        desk.popen.terminate()
        until(lambda: not desk.family(), desk.family)
    with Store.open(home, read_only=True) as store:
        assert [event.kind for event in store.events.read_events()].count("stop") == 1


def test_frozen_screen_lets_parts_continue_with_continue_setting(tmp_path: Path) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *started(tmp_path, "continue")) as desk:
        made = freeze(desk)
        until(lambda: parts(desk) >= made + 2, lambda: desk.lines[-3:])
        desk.popen.terminate()
        until(lambda: not desk.family(), desk.family)
    with Store.open(home, read_only=True) as store:
        kinds = [event.kind for event in store.events.read_events()]
        assert "stop" not in kinds
        assert kinds.count("part") == store.runs.read_part_count("part.nc") >= made + 2


def is_silent(desk: Process) -> bool:
    """Whether the screen says that the control is silent."""
    desk.listen()
    return str(desk.lines[-1]["prompt"]).startswith(RESTART_CONTROL)


def test_frozen_control_holds_and_reconnects(tmp_path: Path) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *started(tmp_path, "hold")) as desk:
        until(
            lambda: desk.says("state", "RUNNING") and desk.lines[-1]["x"] != 0,  # in the cut
            lambda: desk.lines[-3:],
        )
        control = desk.control()
        os.kill(control, signal.SIGSTOP)
        until(lambda: is_silent(desk), lambda: desk.lines[-3:])
        clock = RealClock()
        until(lambda: clock.now() > FROZEN, lambda: "")  # no queue is longer than 3.25 s
        os.kill(control, signal.SIGCONT)
        until(lambda: desk.says("state", "FEED HOLD"), lambda: desk.lines[-3:])
        clock = RealClock()
        until(lambda: clock.now() > 0.5, lambda: "")
        assert desk.says("state", "FEED HOLD"), desk.lines[-3:]
        places = [line["held_at"] for line in desk.lines if line["held_at"]]
        assert places == places[:1] * len(places)  # at rest
        x, z = cast("list[float]", places[0])
        assert abs(x + z) < 0.02  # both blocks of the program lie on X = -Z
        assert 0.0 < x < 0.2 * 25.4
        assert desk.control() == control
        desk.popen.terminate()
        until(lambda: not desk.family(), desk.family)
