"""A lathe behind a real halrun: driver host and bridge in processes of their own, the executor here."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from app.compose.backends.connection import connect_machine
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof
from core.executor.commands import Command, ConfirmStart, CycleStart, EnableDrives, LoadJob, Reset
from core.executor.executor import TICK_PAUSE_S, Executor
from core.executor.job import make_job
from core.executor.snapshot import LogEvent, MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from drivers.wakeups import RealClock
from tests.drivers.hal.halrun import as_halrun
from tests.late_computer import LATE, OF_SILENCE, tell, told_late

PATIENCE = 60.0  # s of a loaded computer
STALL = 0.05  # s of a tick of TICK
AFTER_STALL = 3.0  # s for which threads of HAL without real-time priority catch up, each by itself
OF_STALLS = {
    "following",
    "encoder-still",
    "moved-unasked",
    "spindle-off",
} | OF_SILENCE  # what that looks like
IN_VAIN = 6.0  # s of waiting behind a stop by a late computer, for tests of that
HOME = "TURNDESK_HOME"


def halcmd(*words: str) -> str:
    """What it answers; empty when HAL is down."""
    command = [*as_halrun(), "halcmd", *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd="/").stdout.strip()


def pin(name: str) -> float | None:
    """A pin's value, None when HAL is down."""
    said = halcmd("getp", name)
    return {"TRUE": 1.0, "FALSE": 0.0, "": None}[said] if said in {"TRUE", "FALSE", ""} else float(said)


class LiveLathe:
    """The executor on a machine file; ``halcmd`` is the hand at its switches and the eye on its slides."""

    def __init__(self, file: Path) -> None:
        self.home = file.parent / "home"
        self.machine = load_machine(file)
        self.clock = RealClock()
        self.events: list[LogEvent] = []
        self.stalled_at = -AFTER_STALL  # s, when a tick has last taken too long
        self.connected = connect_machine(self.machine, self.clock)
        self.executor = Executor(self.machine, self.connected.ports, self._note)
        self.tick()

    def _note(self, event: LogEvent) -> None:
        """What stops the machine by itself is told to the test, in the order in which it came."""
        self.events.append(event)
        code = event.alarm.code if event.alarm is not None else ""
        if event.kind == "alarm" or code in LATE | OF_STALLS:
            stalled = code in OF_STALLS and self.clock.now() < self.stalled_at + AFTER_STALL
            tell("late" if stalled else code)

    @property
    def shot(self) -> Snapshot:
        return self.executor.snapshot

    @property
    def codes(self) -> list[str]:
        return [alarm.code for alarm in self.shot.alarms]

    def tick(self) -> None:
        """One tick of the executor, in its time."""
        began = self.clock.now()
        self.executor.run_tick()
        self.clock.sleep_until(began + TICK_PAUSE_S)
        if self.clock.now() - began > STALL:
            self.stalled_at = self.clock.now()

    def post(self, *commands: Command) -> None:
        for command in commands:
            self.executor.post(command)
        self.tick()

    def until(self, ready: Callable[[Snapshot], bool]) -> float:
        """Tick until it is so; how long that took."""
        began = self.clock.now()
        while not ready(self.shot):
            patience = IN_VAIN if told_late() else PATIENCE
            assert self.clock.now() - began < patience, (self.shot, self.events[-6:])
            self.tick()
        return self.clock.now() - began

    def state(self, *states: MachineState) -> float:
        return self.until(lambda shot: shot.state in states)

    def ready(self) -> None:
        """Alarms acknowledged, drives on, whatever was before."""
        began = self.clock.now()
        while self.shot.state is not MachineState.IDLE:
            assert self.clock.now() < began + PATIENCE, (self.shot, self.events[-6:])
            if self.shot.state is MachineState.FAULT:
                self.post(Reset())
            elif self.shot.state is MachineState.DISABLED and not self.shot.unknown:
                self.post(EnableDrives())
            self.tick()

    def start(self, text: str) -> None:
        """A program, proved, and Cycle Start."""
        setup = create_power_up_setup(
            self.machine, tool_offsets={1: ToolOffset(0.0, 0.0)}, secondary_offsets={}
        )
        job = make_job(ProgramSource("PART", text), setup)
        proof = create_proof(job, prove(job.source, job.setup, self.machine))
        assert not proof.errors, proof.errors
        self.post(LoadJob(job, proof))
        if self.shot.interrupted is not None:  # read, and meant all the same
            self.post(ConfirmStart(self.shot.interrupted.at))
            looked = self.clock.now() + 0.9
            self.until(lambda _: self.clock.now() > looked)
        self.post(CycleStart())
        assert not self.shot.start_refusal_reason, self.shot.start_refusal_reason

    def run(self, text: str) -> None:
        """A program to its end."""
        ends = self.shot.ends
        self.start(text)
        self.until(lambda shot: shot.ends > ends or bool(shot.alarms))
        assert not self.shot.alarms, self.shot.alarms

    # --- HAL itself ---------------------------------------------------------------------------------------

    def set(self, name: str, value: float) -> None:
        """A signal of the machine's HAL file: a hand at a switch."""
        halcmd("sets", name, str(value))

    def pin(self, name: str) -> float | None:
        """A pin's value, None when HAL is down."""
        return pin(name)

    def is_on(self, name: str) -> bool:
        """Whether a signal is on."""
        return halcmd("gets", name) == "TRUE"

    def close(self) -> None:
        self.executor.shut_down()
        self.connected.close()

    # --- processes ----------------------------------------------------------------------------------------

    def kill(self, word: str, how: signal.Signals = signal.SIGKILL) -> None:
        """The one of its processes that has this word at the end of one of its arguments; what is just being
        begun still has those of who begins it."""
        self.until(lambda _: len(self.processes(word)) == 1)
        (pid,) = self.processes(word)
        os.kill(pid, how)

    def processes(self, word: str) -> list[int]:
        """Those of its live processes; whatever it has started inherits the folder in its environment."""
        mark = f"{HOME}={self.home}".encode()
        return [pid for pid, words in _alive(mark) if any(each.endswith(word) for each in words)]


def _alive(mark: bytes) -> Iterator[tuple[int, list[str]]]:
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended meanwhile
            state = (folder / "stat").read_text().rpartition(")")[2].split()[0]
            if state != "Z" and mark in (folder / "environ").read_bytes().split(b"\0"):
                yield int(folder.name), (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")


@contextmanager
def live(file: Path) -> Iterator[LiveLathe]:
    """Connected, with a folder of its own beside the machine file; closed at the end."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(HOME, str(file.parent / "home"))
        lathe = LiveLathe(file)
        try:
            yield lathe
        finally:
            lathe.close()
