"""A control and its screens in one process: real sockets between them, a simulated machine in real time."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from multiprocessing.connection import Pipe
from pathlib import Path
from typing import TypeVar

from app.compose.control.control_messages import (
    CommandMessage,
    EventMessage,
    EventStoredMessage,
    HelloMessage,
    ScreenAliveMessage,
    SnapshotMessage,
    StationAction,
)
from app.compose.control.control_server import ControlServer
from app.compose.control.descriptor_passing import SharedMemory, receive_descriptor
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import get_control_limits
from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    LoadJob,
    ReplaceStartClearances,
    StartClearance,
)
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from drivers.wakeups import RealClock

PATIENCE = 30.0  # s for what happens at once on a computer that is not busy
LONG = "G90G94\nM03S600\nG01X1.Z1.F10\nX0.Z0.\nM30\n"  # 12 s a part and more
SHORT = "G90G94\nG01X.01Z.01F30\nX0.Z0.\nM30\n"
M = TypeVar("M")


def until(ready: Callable[[], bool], what: Callable[[], object] = lambda: "") -> None:
    """Wait for it; ``what`` is shown when it does not come."""
    tick, clock = threading.Event(), RealClock()
    while not ready():
        assert clock.now() < PATIENCE, what()
        tick.wait(0.005)


def one_button(*, alone: bool = False) -> Machine:
    """The shipped lathe with one start button; ``alone``: a part is finished without a screen."""
    machine = load_machine()
    return replace(
        machine,
        interlocks=replace(machine.interlocks, two_hand_start=False),
        hardware=replace(machine.hardware, continues_without_screen=alone),
    )


def job_of(text: str, machine: Machine, **changes: object) -> Job:
    """The job of this program on this machine."""
    setup = InterpreterSetup(
        limits=get_control_limits(machine),
        last_rapid=machine.limits.manual_rapid,
        **changes,  # type: ignore[arg-type]
    )
    return make_job(ProgramSource("part.nc", text), setup)


class Screen:
    """The other end of a connection: it sends what a test wants, and reads when a test wants it."""

    def __init__(self, server: ControlServer, clock: RealClock) -> None:
        self._clock = clock
        self.end, theirs = Pipe()
        self.thread = threading.Thread(target=server.serve_screen, args=(theirs,), daemon=True)
        self.thread.start()

    def meet(self) -> HelloMessage:
        """Take the first message, and the memory that comes behind it."""
        assert self.end.poll(PATIENCE)
        hello = self.end.recv()
        assert isinstance(hello, HelloMessage), hello
        self.identity = hello.control_identity
        self.memory = SharedMemory(receive_descriptor(self.end))
        assert self.end.poll(PATIENCE)  # the first snapshot: it is connected
        return hello

    def post(self, command: Command, late: float = 0.0) -> None:
        """As a screen does it; ``late`` seconds ago."""
        self.end.send(CommandMessage(command, self.now - late))

    def hand(self, name: str, *values: object, late: float = 0.0) -> None:
        """What a hand does at the station on the screen."""
        self.end.send(StationAction(name, values, self.now - late))

    @property
    def now(self) -> float:
        """Seconds of the machine's clock."""
        return self._clock.now()

    def take(self, kind: type[M], wanted: Callable[[M], bool] = lambda _: True) -> M:
        """The next message of this kind of which ``wanted`` is true; others are passed over."""
        clock = RealClock()
        while clock.now() < PATIENCE:
            assert self.end.poll(PATIENCE), kind
            message = self.end.recv()
            if isinstance(message, kind) and wanted(message):
                return message
        raise AssertionError(kind)

    def events(self, kind: str) -> list[EventMessage]:
        """What has happened of this kind up to now and has not been read yet."""
        return [message for message in self.all_events() if message.event.kind == kind]

    def all_events(self) -> list[EventMessage]:
        """What has happened up to now and has not been read yet."""
        found, now, behind = list[EventMessage](), self.now, 0
        while behind < 2:  # the first of them may have been sent behind an older look at the events
            message = self.take(object)
            if isinstance(message, SnapshotMessage):
                behind += message.snapshot.t > now
            elif isinstance(message, EventMessage):
                found.append(message)
        return found

    def hear(self, message: EventMessage) -> None:
        """Say that the event is kept."""
        self.end.send(EventStoredMessage(message.event_number))

    def lose(self) -> None:
        """As a killed screen leaves it."""
        self.end.close()
        self.thread.join(PATIENCE)
        assert not self.thread.is_alive()


class Bench:
    """A control that ticks, and the screens that tests connect to it."""

    def __init__(self, folder: Path, machine: Machine) -> None:
        self.machine = machine
        self.clock = RealClock()
        self.server = ControlServer(machine, self.clock, folder, ())
        self.server.start()
        self._stack = ExitStack()

    def screen(self) -> Screen:
        """Another screen that connects."""
        screen = Screen(self.server, self.clock)
        self._stack.callback(screen.end.close)
        return screen

    @property
    def shot(self) -> Snapshot:
        return self.server.executor.snapshot

    def looks(self, times: int) -> None:
        """Look at the screen so many times, each some ticks after the other."""
        for _ in range(times):
            self.server.check_screen_response()
        ticks = self.server.executor.tick_count
        until(lambda: self.server.executor.tick_count > ticks + 2)

    def alive(self, screen: Screen) -> None:
        """The screen says that it is, and it is heard."""
        feed = 1.0 if self.shot.feed_override < 1.0 else 0.9
        screen.end.send(ScreenAliveMessage())
        screen.hand("set_feed_pot", feed)
        until(lambda: self.shot.feed_override == feed)

    def until(self, *states: MachineState) -> None:
        """Wait for one of these states."""
        until(lambda: self.shot.state in states, lambda: (self.shot.state, self.shot.start_refusal_reason))

    def run(self, screen: Screen, text: str = LONG) -> Job:
        """Drives on, program loaded and started."""
        job = job_of(text, self.machine)
        screen.post(EnableDrives())
        self.until(MachineState.IDLE)
        screen.post(LoadJob(job, Proof(job.digest, ())))
        until(lambda: self.shot.program == "part.nc")
        self.start(screen, job)
        self.until(MachineState.RUN, MachineState.WAIT)
        return job

    def start(self, screen: Screen, job: Job, late: float = 0.0) -> None:
        """Have the first move found clear, and ask for the start."""
        last = self.clock.now()
        until(lambda: self.clock.now() > last + 0.4)  # a start right behind the last one is its bounce
        shot = self.shot
        screen.post(ReplaceStartClearances((StartClearance(job.digest, shot.demand, shot.begun),)))
        screen.post(CycleStart(), late)

    def close(self) -> None:
        self._stack.close()
        self.server.closing_event.set()
        self.server.close()


@contextmanager
def control(folder: Path, machine: Machine | None = None) -> Iterator[Bench]:
    """A control on the shipped lathe with one start button."""
    bench = Bench(folder, machine or one_button())
    try:
        yield bench
    finally:
        bench.close()
