"""Reset replaces a control that was killed or hangs: real processes, without a window."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from app.compose.control import control_client, live_control
from app.compose.control.control_client import ControlClient, ControlEventHandlers
from app.compose.control.control_start import start_control
from app.compose.control.live_control import LiveControl
from app.compose.control.process_handle import ProcessHandle
from app.desk.data_folder import HOME_VARIABLE
from app.desk.stop_keys.stop_records import StopKeyPress, StopKind
from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    LoadJob,
    ReplaceStartClearances,
    Reset,
    SetSwitch,
    StartClearance,
)
from core.executor.job import Job, Proof
from core.executor.snapshot import InterruptedJob, LogEvent, MachineState
from core.machine.machine_model import Machine
from tests.control.bench import LONG, job_of, one_button
from tests.killed.bench import until

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
MACHINE = one_button()


@dataclass
class Desk:
    """A screen without a window, and what its control has said."""

    live: LiveControl
    events: list[LogEvent] = field(default_factory=list)
    notes: list[InterruptedJob | None] = field(default_factory=list)
    said: list[str] = field(default_factory=list)

    def begin(self) -> None:
        heard = ControlEventHandlers(
            lambda event, _: self.events.append(event), self.notes.append, lambda _: None
        )
        self.live.start_threads(heard, self.said.append)

    @property
    def process(self) -> int:
        return self.live.client.hello_message.process_id

    @property
    def alarms(self) -> list[str]:
        return [event.alarm.code for event in self.events if event.alarm is not None]

    def until(self, *states: MachineState) -> None:
        self.wait(lambda: self.live.snapshot.state in states)

    def wait(self, ready: Callable[[], bool]) -> None:
        def look() -> bool:
            self.live.report_screen_alive(self.live.snapshot)
            return ready()

        until(look, lambda: (self.live.snapshot, self.said))

    def post(self, *commands: Command) -> None:
        for command in commands:
            self.live.post_command(command)

    def run(self) -> Job:
        job = job_of(LONG, MACHINE)
        self.post(EnableDrives())
        self.until(MachineState.IDLE)
        self.post(LoadJob(job, Proof(job.digest, ())))
        self.wait(lambda: self.live.snapshot.program == "part.nc")
        shot = self.live.snapshot
        self.post(
            ReplaceStartClearances((StartClearance(job.digest, shot.demand, shot.begun),)), CycleStart()
        )
        self.until(MachineState.RUN)
        self.wait(lambda: bool(self.notes))
        return job


@contextmanager
def desk(folder: Path, machine: Machine = MACHINE) -> Iterator[Desk]:
    made = Desk(LiveControl(ControlClient(start_control(machine, folder), folder), machine, folder))
    seen = [made.live.client]
    try:
        made.begin()
        yield made
    finally:
        seen.append(made.live.client)
        with suppress(ProcessLookupError):
            os.kill(made.process, signal.SIGCONT)
        made.live.close()
        assert all(client.handle.wait_for_end(0.0) or client.control_process is not None for client in seen)
        assert all(
            client.control_process is None or client.control_process.poll() is not None for client in seen
        )


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """An operator who waits less long for a control that hangs."""
    monkeypatch.setattr(live_control, "SCREEN_CONTROL_TIMEOUT_S", 1.0)
    monkeypatch.setattr(live_control, "END_TIMEOUT_S", 0.5)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(HOME_VARIABLE, str(tmp_path))
    return tmp_path


def test_reset_restarts_a_killed_control_with_its_program_and_no_motion(folder: Path) -> None:
    with desk(folder) as screen:
        job = screen.run()
        screen.post(SetSwitch("optional_stop", True))
        screen.wait(lambda: screen.live.snapshot.optional_stop)
        killed, time = screen.process, screen.live.snapshot.t
        os.kill(killed, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        assert screen.alarms == ["control-silent"]
        screen.post(Reset())
        screen.wait(lambda: screen.process != killed and screen.live.snapshot.job == job.digest)
        shot = screen.live.snapshot
        assert shot.state is MachineState.DISABLED
        assert shot.optional_stop
        assert shot.interrupted is not None
        assert shot.rpm_command == 0.0
        assert shot.t > time  # the same clock
        screen.post(EnableDrives())
        screen.until(MachineState.IDLE)
        assert [event.kind for event in screen.events].count("start") == 1


def test_rights_of_the_control_are_logged_at_the_start_and_after_reset(folder: Path) -> None:
    with desk(folder) as screen:

        def logged() -> list[str]:
            return [event.text for event in screen.events if event.kind == "rights"]

        first = logged()
        assert len(first) == len(screen.live.client.hello_message.process_rights) >= 2
        killed = screen.process
        os.kill(killed, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        screen.post(Reset())
        screen.wait(lambda: not screen.live.is_restarting and screen.process != killed)
        assert logged() == first * 2  # the same account has the same rights
        assert "notice" not in [event.kind for event in screen.events]  # it is simulated


def test_reset_replaces_a_hanging_control(folder: Path) -> None:
    with desk(folder) as screen:
        screen.run()
        hanging = screen.process
        os.kill(hanging, signal.SIGSTOP)
        screen.wait(lambda: screen.live.client.silence_duration_s > 0.5)
        screen.live.restart()
        screen.live.restart()  # pressed twice
        screen.wait(lambda: screen.process != hanging and screen.live.snapshot.program == "part.nc")
        with pytest.raises(ProcessLookupError):
            os.kill(hanging, 0)
        assert screen.alarms == ["control-silent"]
        assert screen.live.snapshot.state is MachineState.DISABLED


def test_control_that_responds_again_is_not_replaced(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_control, "SCREEN_CONTROL_TIMEOUT_S", 600.0)
    with desk(folder) as screen:
        screen.run()
        process = screen.process
        os.kill(process, signal.SIGSTOP)
        screen.live.restart()
        screen.wait(lambda: len(screen.said) == 1)
        os.kill(process, signal.SIGCONT)
        screen.wait(lambda: len(screen.said) == 2)
        assert screen.process == process
        screen.post(Reset())
        screen.until(MachineState.IDLE, MachineState.HOLD)
        assert "control-silent" not in screen.alarms


def test_failed_control_restart_can_be_repeated(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with desk(folder) as screen:
        killed = screen.process
        os.kill(killed, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        with monkeypatch.context() as patch:
            patch.setattr(sys, "executable", "/bin/false")
            screen.post(Reset())
            screen.wait(lambda: len(screen.said) == 2)
        assert screen.live.snapshot.state is MachineState.FAULT
        screen.wait(lambda: not screen.live.is_restarting)
        screen.post(Reset())
        screen.until(MachineState.DISABLED)
        assert screen.process != killed


def test_no_control_is_started_after_the_screen_is_closed(folder: Path) -> None:
    with desk(folder) as screen:
        os.kill(screen.process, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        screen.live.close()
        screen.post(Reset())
        assert not screen.live.is_restarting


def test_control_is_not_restarted_while_the_old_process_is_alive(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with desk(folder) as screen:
        process = screen.process
        monkeypatch.setattr(screen.live.client.handle, "kill_process", lambda _seconds: False)
        os.kill(process, signal.SIGSTOP)
        screen.wait(lambda: screen.live.client.silence_duration_s > 1.0)
        screen.live.restart()
        screen.wait(lambda: not screen.live.is_restarting)
        assert screen.process == process
        assert len(screen.said) == 2


def test_the_estop_and_the_stop_keys_act_on_the_new_control(folder: Path) -> None:
    with desk(folder) as screen:
        line = screen.live.open_stop_socket()
        assert line is not None
        assert screen.live.hands is not None
        screen.live.hands.press_estop()
        screen.until(MachineState.ESTOP)
        killed = screen.process
        os.kill(killed, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        screen.post(Reset())
        screen.wait(lambda: screen.process != killed)
        screen.until(MachineState.ESTOP)  # still pressed
        screen.live.hands.release_estop()
        screen.until(MachineState.DISABLED)
        line.send(StopKeyPress(StopKind.ESTOP, 1).to_bytes())
        screen.until(MachineState.ESTOP)
        line.close()


def test_driver_host_of_a_killed_control_ends_before_a_new_one_starts(folder: Path) -> None:
    machine = replace(MACHINE, hardware=replace(MACHINE.hardware, uses_driver_host=True))
    with desk(folder, machine) as screen:
        screen.run()
        killed = screen.process
        (host,) = children(killed)
        os.kill(host, signal.SIGSTOP)
        os.kill(killed, signal.SIGKILL)
        screen.until(MachineState.FAULT)
        screen.post(Reset())
        screen.wait(lambda: len(screen.said) == 1)
        ended = ProcessHandle(host)
        screen.wait(lambda: any(is_at_place(pid) for pid in children(os.getpid())))
        (new,) = (pid for pid in children(os.getpid()) if is_at_place(pid))
        assert not children(new)  # it waits for the driver host
        assert not ended.wait_for_end(0.0)
        os.kill(host, signal.SIGCONT)
        screen.wait(lambda: bool(children(new)))
        assert ended.wait_for_end(0.0)
        screen.until(MachineState.DISABLED)
        assert screen.process == new
        ended.close()


def test_closing_the_screen_ends_a_control_that_is_still_starting(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_control, "KILL_TIMEOUT_S", 1.0)
    machine = replace(MACHINE, hardware=replace(MACHINE.hardware, uses_driver_host=True))
    with desk(folder, machine) as screen:
        (host,) = children(screen.process)
        os.kill(host, signal.SIGSTOP)
        try:
            os.kill(screen.process, signal.SIGKILL)
            screen.until(MachineState.FAULT)
            screen.post(Reset())
            screen.wait(lambda: any(is_at_place(pid) for pid in children(os.getpid())))
            (new,) = (ProcessHandle(pid) for pid in children(os.getpid()) if is_at_place(pid))
            screen.live.close()  # while the new control waits for the driver host
            assert new.wait_for_end(0.0)
            assert not screen.live.is_restarting
            assert len(screen.said) == 1  # no failed start is reported
            new.close()
        finally:
            os.kill(host, signal.SIGCONT)


def is_at_place(pid: int) -> bool:
    """Whether the process owns a place in the data folder."""
    with suppress(OSError):
        return any(os.readlink(path).endswith("control.lock") for path in Path(f"/proc/{pid}/fd").iterdir())
    return False


def children(pid: int) -> list[int]:
    """The child processes of all threads of a process."""
    found = list[int]()
    for path in Path(f"/proc/{pid}/task").glob("*/children"):
        found += map(int, path.read_text().split())
    return found


def test_control_joined_from_another_screen_can_be_restarted(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = start_control(MACHINE, folder)
    first = ControlClient(started, folder)
    assert started.process is not None
    path = folder / "control.sock"
    until(path.is_socket, lambda: "")
    first.disconnect(end_control=False)
    found: list[ControlClient] = []

    def look() -> bool:
        client = control_client.find_running_control(MACHINE, folder, path)
        found.extend([client] if client is not None else [])
        return bool(found)

    until(look, lambda: "")
    screen = Desk(LiveControl(found[0], MACHINE, folder))
    screen.begin()
    os.kill(screen.process, signal.SIGSTOP)
    screen.wait(lambda: screen.live.client.silence_duration_s > 1.0)
    screen.live.restart()
    hanging = started.process.pid
    screen.wait(lambda: screen.process != hanging)
    assert started.process.wait(30.0) == -signal.SIGKILL
    screen.until(MachineState.DISABLED)
    screen.live.close()
