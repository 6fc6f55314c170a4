"""kill -9 of the screen, of its control, and of both: what stops, what is kept; the next start works."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

import resources
from app.compose.runs.journal import Journal
from core.alarms import CATALOG
from core.records.record import ScopeRecord
from core.records.ring_file import CURRENT_RING_NAME, PREVIOUS_RING_NAME, read_ring_file
from core.store.production.part_cycles import read_cycles
from core.store.store import Store
from tests.killed.bench import Process, process, until
from tests.late_computer import tell
from tests.texts import opening, text

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
PROGRAM = "G90G94\nM03S600\nM08\nG01X.2Z-.2F20\nX0.Z0.\nM30\n"  # 2 s of motion a part
OPERATOR = "tests.killed.operator"
_LATE = opening("executor.control-trip"), CATALOG["low-queue"].text.upper()


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    """The simulated lathe with its drivers in the driver host, and a program of which many parts are made."""
    machine, program = tmp_path / "lathe.toml", tmp_path / "part.nc"
    text = resources.read_machine_file("gt75.toml")
    machine.write_text(text.replace("[machine]\n", "[machine]\nfeeder = true\n", 1))
    program.write_text(PROGRAM)
    return str(machine), str(program)


def cutting(desk: Process, parts: int) -> None:
    """At work on the part after so many."""

    def so() -> bool:
        if desk.says("state", "FEED HOLD"):  # nobody here asks for one
            held = str(desk.lines[-1]["prompt"])
            if held.startswith(_LATE):
                tell("late")
            pytest.fail(held)
        return desk.says("state", "RUNNING") and int(str(desk.lines[-1]["parts"])) >= parts

    until(so, lambda: desk.lines[-3:])


def parts_in(record: ScopeRecord) -> int:
    """How often X went out to .2 in and came back, in what the scope has recorded at 1 ms."""
    out = record.values_by_channel["X demand"] > 5.0
    moving = np.diff(record.times_s)[out[1:] & out[:-1]]
    assert record.sampling_rate_hz == 1000.0
    assert moving == pytest.approx(0.001, abs=1e-6)
    return int(np.count_nonzero(out[:-1] & ~out[1:]))


def kept_parts(home: Path) -> int:
    """The part count on the disk, while the desk runs."""
    with Store.open(home, read_only=True) as store:
        return store.runs.read_part_count("part.nc")


def between_start_and_end(home: Path) -> bool:
    """Whether a part has been counted and the next is under way, both as the disk has it."""
    with Store.open(home, read_only=True) as store:
        return store.runs.read_part_count("part.nc") >= 1 and [
            run.outcome for run in store.runs.read_run_records()
        ] == [""]


def test_killed_screen_and_control_preserve_entries_and_leave_no_process(
    files: tuple[str, str], tmp_path: Path
) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *files) as desk:
        cutting(desk, 1)
        assert desk.host()
        until(lambda: between_start_and_end(home), lambda: desk.lines[-3:])  # written behind the screen
        made = kept_parts(home)
        desk.kill_all()
        until(lambda: not desk.family(), lambda: "the driver host has not ended")
    assert parts_in(read_ring_file(home / "records" / CURRENT_RING_NAME)) >= made
    with Store.open(home) as store:
        assert store.offsets.tool_offsets.read_rows()[9].offset == (-0.5 * 25.4, -3.25 * 25.4)
        assert store.runs.read_part_count("part.nc") >= made
        assert store.programs.load_version("part.nc") == PROGRAM.encode()
        assert {"load", "part"} <= {event.kind for event in store.events.read_events()}
        (run,) = store.runs.read_run_records()
        assert (run.program, run.outcome, run.started is not None) == ("part.nc", "", True)
        counted = store.runs.read_part_count("part.nc")
    with process(home, OPERATOR, *files) as again:
        cutting(again, 1)
        assert again.lines[-1]["alarms"] == []
        again.kill_all()
        assert (
            parts_in(read_ring_file(home / "records" / PREVIOUS_RING_NAME)) >= made
        )  # of the control before
        until(lambda: not again.family(), lambda: "the driver host has not ended")
    with Store.open(home, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") > counted
        told = [event.text for event in store.events.read_events() if event.kind == "warning"]
        assert text("shopfloor.ended-in-run", program="part.nc") in told


def test_unfinished_run_is_reported_at_next_start(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.runs.record_run_start("cut.nc")
        store.runs.record_run_start("whole.nc")
        store.runs.record_run_end("whole.nc", "COMPLETE")
        store.runs.add_parts("counted.nc")
    journal = Journal(tmp_path)
    ended = {run.program: run.outcome for run in journal.require_store().runs.read_run_records()}
    journal.close()
    assert ended == {"cut.nc": "CUT OFF", "whole.nc": "COMPLETE", "counted.nc": ""}


def test_killed_driver_host_stops_program_with_alarm(files: tuple[str, str], tmp_path: Path) -> None:
    with process(tmp_path / "home", OPERATOR, *files) as desk:
        cutting(desk, 0)
        os.kill(desk.host(), signal.SIGKILL)
        until(lambda: desk.says("state", "ALARM"), lambda: desk.lines[-3:])
        assert CATALOG["feeder-gone"].text.upper() in str(desk.lines[-1]["alarms"])
        # The screen goes on: offsets and editor stay at hand.
        until(lambda: desk.family() == {desk.popen.pid, desk.control()}, desk.family)


def test_killed_screen_puts_program_in_feed_hold_and_reconnects(
    files: tuple[str, str], tmp_path: Path
) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *files) as desk:
        cutting(desk, 1)
        control, made = desk.control(), int(str(desk.lines[-1]["parts"]))
        desk.kill()
        with process(home, OPERATOR, *files, "--again") as again:
            until(lambda: again.says("state", "FEED HOLD"), lambda: again.lines[-3:])
            assert again.control() == control
            until(lambda: again.says("state", "RUNNING"), lambda: again.lines[-3:])
            cutting(again, made + 2)
            again.popen.terminate()
            until(lambda: not again.family(), again.family)
    with Store.open(home, read_only=True) as store:
        kinds = [event.kind for event in store.events.read_events()]
        assert kinds.count("stop") == 1  # the feed hold by the control
        assert kinds.count("part") == store.runs.read_part_count("part.nc") >= made + 1
        assert [run.outcome for run in store.runs.read_run_records()] != ["CUT OFF"]


def test_cycle_of_each_part_is_stored_once_when_screen_is_killed(
    files: tuple[str, str], tmp_path: Path
) -> None:
    """The control finishes the part in which the screen is killed; the next screen stores its cycle."""
    home, machine = tmp_path / "home", Path(files[0])
    machine.write_text(machine.read_text().replace("[machine]\n", '[machine]\nscreen_lost = "continue"\n', 1))
    with process(home, OPERATOR, *files) as desk:
        cutting(desk, 1)
        control, made = desk.control(), int(str(desk.lines[-1]["parts"]))
        desk.kill()
        with process(home, OPERATOR, *files, "--again") as again:
            cutting(again, made + 1)
            assert again.control() == control
            again.popen.terminate()
            until(lambda: not again.family(), again.family)
    with Store.open(home, read_only=True) as store:
        counted = store.runs.read_part_count("part.nc")
        with store.read() as connection:
            rows = read_cycles(connection, None, 100)
    assert counted >= made + 1
    assert [row.part for row in rows if row.outcome == "COMPLETE"] == list(range(1, counted + 1))
    assert all(row.ended is not None for row in rows[:-1])


def test_killed_control_raises_alarm_and_screen_continues(files: tuple[str, str], tmp_path: Path) -> None:
    with process(tmp_path / "home", OPERATOR, *files) as desk:
        cutting(desk, 0)
        os.kill(desk.control(), signal.SIGKILL)
        until(lambda: desk.says("state", "ALARM"), lambda: desk.lines[-3:])
        assert CATALOG["control-silent"].text.upper() in str(desk.lines[-1]["alarms"])
        until(lambda: desk.family() == {desk.popen.pid}, desk.family)  # its driver host stops what is left


def test_reset_restarts_killed_control_from_window(files: tuple[str, str], tmp_path: Path) -> None:
    home = tmp_path / "home"
    with process(home, OPERATOR, *files, "--reset") as desk:
        cutting(desk, 1)
        killed, host = desk.control(), desk.host()
        os.kill(killed, signal.SIGKILL)
        until(lambda: desk.says("state", "ALARM"), lambda: desk.lines[-3:])
        until(lambda: desk.says("state", "DRIVES OFF"), lambda: desk.lines[-3:])
        assert desk.lines[-1]["parts"] == 0  # of this control
        assert {killed, host}.isdisjoint({desk.control(), desk.host()})
        cutting(desk, 1)
        desk.popen.terminate()
        until(lambda: not desk.family(), desk.family)
    with Store.open(home, read_only=True) as store:
        kinds = [event.kind for event in store.events.read_events()]
        assert kinds.count("part") == store.runs.read_part_count("part.nc") >= 2


def test_control_shuts_down_in_order_when_killed_screen_stays_away(tmp_path: Path) -> None:
    machine, program = tmp_path / "lathe.toml", tmp_path / "part.nc"
    machine.write_text(resources.read_machine_file("gt75.toml"))
    program.write_text(PROGRAM)
    home = tmp_path / "home"
    with process(home, OPERATOR, str(machine), str(program), "--idle") as desk:
        until(lambda: desk.says("state", "READY"), lambda: desk.lines[-3:])
        assert desk.control()
        desk.kill()
        until(lambda: not desk.family(), desk.family)
    assert not (home / "control.sock").exists()
