"""Real processes of the control, with the screen's end in the process of the test."""

from __future__ import annotations

import os
import resource
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from app.compose.control.control_client import (
    ControlClient,
    ControlEventHandlers,
    RemoteStationControls,
    find_running_control,
)
from app.compose.control.control_start import list_socket_paths, start_control
from app.compose.control.process_rights_check import READING_PRIORITY, REAL_TIME_PRIORITY
from app.compose.control.unattended_notes import NOTE_FILE_NAME
from app.compose.machine.machine_files import load_named_machine
from app.compose.program_proving import create_line_prover
from app.compose.runs.receipt import EventReceipt
from app.compose.stored_offsets import NO_OFFSETS
from app.desk.data_folder import HOME_VARIABLE
from app.desk.programs.prepared_line import ProveLine
from core.executor.commands import (
    CycleStart,
    EnableDrives,
    LoadJob,
    PrepareCycleStart,
    ReplaceStartClearances,
    SetSwitch,
    StartClearance,
)
from core.executor.job import Proof
from core.executor.snapshot import LogEvent, MachineState, StartAction
from core.machine.machine_model import Machine
from tests.control.bench import LONG, job_of, one_button, until
from tests.killed.bench import until as until_long

pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
MACHINE = one_button()


class Desk:
    """A screen without a window."""

    def __init__(self, client: ControlClient) -> None:
        self.client = client
        self.events = list[LogEvent]()
        client.start_threads(ControlEventHandlers(self.hear, lambda _: None, lambda _: None))

    def hear(self, event: LogEvent, receipt: EventReceipt | None) -> None:
        self.events.append(event)
        if receipt is not None:
            receipt.confirm_storage()

    @property
    def state(self) -> MachineState:
        return self.client.snapshot.state

    def see(self) -> bool:
        """A frame."""
        self.client.report_screen_alive(self.client.snapshot)
        return True

    def until(self, *states: MachineState) -> None:
        """Look until it is in one of these states."""
        until_long(lambda: self.see() and self.state in states, lambda: self.client.snapshot)

    def run(self) -> None:
        """A program that takes its time."""
        job = job_of(LONG, MACHINE)
        self.client.post_command(EnableDrives())
        self.until(MachineState.IDLE)
        self.client.post_command(LoadJob(job, Proof(job.digest, ())))
        until(lambda: self.client.snapshot.program == "part.nc")
        shot = self.client.snapshot
        self.client.post_command(
            ReplaceStartClearances((StartClearance(job.digest, shot.demand, shot.begun),))
        )
        self.client.post_command(CycleStart())
        self.until(MachineState.RUN)

    def enter(self, text: str, prove_line: ProveLine) -> None:
        """Run an MDI line, and wait until a snapshot shows the state that it has left in force."""
        before = self.client.snapshot
        job, proved = prove_line(text, before, lambda _share: None)
        assert not proved.diagnostics
        began = self.client.clock.now()
        until(lambda: self.client.clock.now() > began + 0.4)  # a start right after another is its bounce
        clearance = StartClearance(job.digest, before.demand, before.begun)
        self.client.post_command(PrepareCycleStart(StartAction.MDI_LINE, job, proved.proof, clearance))
        self.client.post_command(CycleStart())
        until_long(
            lambda: self.see() and self.client.snapshot.kept != before.kept, lambda: self.client.snapshot
        )
        self.until(MachineState.IDLE)

    def vanish(self) -> None:
        """As a killed screen does."""
        self.client.disconnect(end_control=False)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(HOME_VARIABLE, str(tmp_path))
    return tmp_path


@contextmanager
def desk(folder: Path, machine: Machine = MACHINE) -> Iterator[tuple[Desk, subprocess.Popen[bytes]]]:
    """A control and its first screen; at the end nothing is left of them."""
    started = start_control(machine, folder)
    process = started.process
    assert process is not None
    made = Desk(ControlClient(started, folder))
    try:
        yield made, process
        made.client.stop_and_close()
        until_long(lambda: process.poll() is not None, lambda: process.pid)
    finally:
        process.kill()
        process.wait()


def found(folder: Path, place: int = 0) -> ControlClient:
    """The control that a lost screen has left."""
    path = list_socket_paths(folder)[place]
    clients: list[ControlClient] = []

    def look() -> bool:
        client = find_running_control(MACHINE, folder, path)
        clients.extend([client] if client is not None else [])
        return bool(clients)

    until_long(look, path.exists)
    return clients[0]


def test_closing_leaves_no_process_or_socket(folder: Path) -> None:
    before = sockets()
    with desk(folder) as (screen, process):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
        assert (folder / "control.sock").is_socket()
        assert (folder / "control.sock").stat().st_mode & 0o177 == 0
    assert process.returncode == 0
    assert not (folder / "control.sock").exists()
    assert not {thread.name for thread in threading.enumerate()} & {"control-events", "control-posts"}
    assert not [event for event in screen.events if event.alarm is not None]
    assert sockets() == before


def test_screen_gets_snapshots_during_and_after_sinumerik_mdi_lines(folder: Path) -> None:
    """The second line needs the R parameter of the first, and moves Z by 4 mm."""
    machine = load_named_machine("sinumerik-modulo")
    prove_line = create_line_prover(machine, lambda: NO_OFFSETS)
    with desk(folder, machine) as (screen, _):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
        screen.enter("R1=4", prove_line)
        before = screen.client.snapshot.actual
        screen.enter("G91 G0 Z=-R1", prove_line)
        assert screen.client.snapshot.actual[1] == pytest.approx(before[1] - 4.0, abs=0.01)
        screen.enter("G4 F0.1", prove_line)
        after = screen.client.snapshot.t
        until(lambda: screen.client.snapshot.t > after)


def test_terminated_control_raises_an_alarm_on_its_screen(folder: Path) -> None:
    with desk(folder) as (screen, process):
        screen.run()
        process.send_signal(signal.SIGTERM)
        screen.until(MachineState.FAULT)
        assert screen.events[-1].alarm is not None
        assert screen.events[-1].alarm.code == "control-silent"
        assert process.wait(30.0) == 0
    assert not (folder / "control.sock").exists()


def test_killed_control_raises_an_alarm_and_next_start_finds_no_control(folder: Path) -> None:
    with desk(folder) as (screen, process):
        process.kill()
        screen.until(MachineState.FAULT)
    assert (folder / "control.sock").is_socket()
    path = list_socket_paths(folder)[0]
    assert find_running_control(MACHINE, folder, path) is None
    with desk(folder) as (screen, process):
        until(lambda: _listens(path))


def test_control_resumes_after_being_suspended(folder: Path) -> None:
    with desk(folder) as (screen, process):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
        process.send_signal(signal.SIGSTOP)
        RemoteStationControls(screen.client.operate_station).press_left()
        RemoteStationControls(screen.client.operate_station).press_right()
        screen.client.post_command(CycleStart())
        for _ in range(3000):  # more than the socket holds: nobody waits
            screen.client.post_command(SetSwitch("optional_stop", False))
        began = screen.client.clock.now()
        until(lambda: screen.client.clock.now() > began + 3.0)
        process.send_signal(signal.SIGCONT)
        screen.client.post_command(SetSwitch("single_block", True))
        until_long(lambda: screen.client.snapshot.single_block, lambda: screen.client.snapshot)
        assert screen.state is MachineState.IDLE
        assert [event.kind for event in screen.events].count("refused") == 1  # the start that came late


def test_new_screen_joins_the_control_of_a_lost_screen(folder: Path) -> None:
    with desk(folder) as (screen, process):
        screen.run()
        screen.vanish()
        until_long((folder / NOTE_FILE_NAME).exists, lambda: "")
        client = found(folder)
        second = Desk(client)
        second.until(MachineState.HOLD)
        assert client.hello_message.interrupted_job is not None
        assert not (folder / NOTE_FILE_NAME).exists()
        second.client.stop_and_close()
        assert process.wait(30.0) == 0
        assert second.state is not MachineState.FAULT


def test_second_start_gets_its_own_control_while_a_screen_is_connected(folder: Path) -> None:
    with desk(folder) as (first, _):
        path = list_socket_paths(folder)[0]
        until(lambda: _listens(path))
        for _ in range(5):  # none of them is left in the queue
            assert find_running_control(MACHINE, folder, path) is None
        with desk(folder) as (second, _):
            second.client.post_command(EnableDrives())
            second.until(MachineState.IDLE)
            assert first.state is not MachineState.IDLE
        assert path.is_socket()  # of the first
        first.client.post_command(EnableDrives())
        first.until(MachineState.IDLE)


def test_second_control_of_a_folder_uses_its_own_socket(folder: Path) -> None:
    with desk(folder), desk(folder) as (second, process):
        second.client.post_command(EnableDrives())
        second.until(MachineState.IDLE)
        second.vanish()
        paths = list_socket_paths(folder)
        assert find_running_control(MACHINE, folder, paths[0]) is None  # it has its screen
        client = found(folder, 1)
        assert client.snapshot.state is MachineState.IDLE
        again = Desk(client)
        again.client.stop_and_close()
        assert process.wait(30.0) == 0
        assert not paths[1].exists()
        assert paths[0].is_socket()


def test_next_control_uses_the_slot_of_a_killed_control(folder: Path) -> None:
    path = list_socket_paths(folder)[0]
    started = start_control(MACHINE, folder)
    ControlClient(started, folder)
    until(lambda: _listens(path))
    started.kill_process()
    assert path.is_socket()  # left by the killed control
    assert not _listens(path)
    with desk(folder):
        until(lambda: _listens(path))
        assert not list_socket_paths(folder)[1].exists()


def test_only_the_reading_thread_has_the_lowest_priority(folder: Path) -> None:
    with desk(folder) as (screen, process):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
        if os.sched_getscheduler(process.pid) != os.SCHED_RR:
            pytest.skip("the system grants no real-time priority")
        threads = [int(path.name) for path in Path(f"/proc/{process.pid}/task").iterdir()]
        priorities = [os.sched_getparam(thread).sched_priority for thread in threads]
        assert priorities.count(READING_PRIORITY) == 1
        assert set(priorities) <= {READING_PRIORITY, REAL_TIME_PRIORITY, 0}  # 0: threads of numpy
        assert os.sched_getparam(process.pid).sched_priority == REAL_TIME_PRIORITY


def test_two_folders_have_two_controls(folder: Path) -> None:
    with desk(folder / "one") as (first, _), desk(folder / "two") as (second, _):
        first.client.post_command(EnableDrives())
        first.until(MachineState.IDLE)
        assert second.state is not MachineState.IDLE
        assert (folder / "one" / "control.sock").is_socket()
        assert (folder / "two" / "control.sock").is_socket()


def test_control_runs_in_a_folder_where_its_socket_cannot_be_created(folder: Path) -> None:
    (folder / "control.sock").mkdir()
    with desk(folder) as (screen, _):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
    assert (folder / "control.sock").is_dir()


def test_control_runs_in_a_folder_with_too_long_socket_path(folder: Path) -> None:
    long = folder / ("long" * 30)
    assert list_socket_paths(long) == []
    with desk(long) as (screen, _):
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)


def test_control_runs_without_a_writable_disk(folder: Path) -> None:
    (folder / "file").write_text("")
    with desk(folder / "file" / "home") as (screen, _):  # no folder can be made there
        screen.client.post_command(EnableDrives())
        screen.until(MachineState.IDLE)
        assert screen.client.hello_message.disk_error


def test_control_closed_immediately_after_start_leaves_no_socket(folder: Path) -> None:
    started = start_control(MACHINE, folder)
    started.kill_process()
    assert started.process is not None
    assert started.process.returncode is not None
    assert not (folder / "control.sock").exists()


def test_control_whose_first_screen_disconnected_can_be_joined_and_closed(folder: Path) -> None:
    started = start_control(MACHINE, folder)
    started.connection.close()
    assert started.process is not None
    client = found(folder)
    client.disconnect(end_control=True)
    assert started.process.wait(30.0) == 0


def test_control_does_not_inherit_terminal_or_open_files(folder: Path) -> None:
    with desk(folder) as (_, process):
        files = Path(f"/proc/{process.pid}/fd")
        assert os.readlink(files / "1") == "/dev/null"
        assert os.readlink(files / "0").startswith("pipe:")
        assert os.getsid(process.pid) == process.pid  # Ctrl-C is for the screen
        soft, _hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        assert len(list(files.iterdir())) < min(soft, 40)


def sockets() -> int:
    """Open sockets of this process."""
    found = 0
    for file in Path("/proc/self/fd").iterdir():
        with suppress(OSError):  # of the listing itself
            found += os.readlink(file).startswith("socket:")
    return found


def _listens(path: Path) -> bool:
    with socket.socket(socket.AF_UNIX) as sock, suppress(OSError):
        sock.connect(str(path))
        return True
    return False
