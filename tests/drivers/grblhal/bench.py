"""An executor on the controller's simulator, on a clock that the test moves."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import resources
from app.compose.backends.grblhal_backend import create_grblhal_config
from app.compose.machine.machine_files import parse_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof
from core.executor.commands import Command, ConfirmStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Job, make_job
from core.executor.snapshot import LogEvent, MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from drivers.grblhal.grblhal_machine import GrblMachine
from drivers.grblhal.grblhal_transport import TransportLostError
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.simulators.grblhal_settings import SimulatorBehavior
from drivers.wakeups import ManualClock

TICK = 0.01
SHIPPED = resources.read_machine_file("gt75-grblhal.toml")


def grbl_machine(*changes: tuple[str, str]) -> Machine:
    """The shipped machine."""
    text = SHIPPED
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return parse_machine(text, "bench.toml")


class LoopWire:
    """The firmware in the same process; ``sent`` is every byte of the host."""

    def __init__(self, firmware: GrblFirmware) -> None:
        self.firmware = firmware
        self.sent = bytearray()
        self.cut = False

    def read(self) -> bytes:
        if self.cut:
            raise TransportLostError("the cable is out")
        return self.firmware.pop_output()

    def write(self, data: bytes) -> None:
        if self.cut:
            raise TransportLostError("the cable is out")
        self.sent += data
        self.firmware.receive_bytes(data)

    def close(self) -> None:
        """Nothing to let go."""

    def lines(self) -> list[str]:
        """Whole lines of the host, without real-time bytes and without asking for inputs."""
        plain = bytes(b for b in self.sent if b < 0x80 and b not in {0x18, 0x19})
        return [line for line in plain.decode("ascii").split("\n") if line and not line.startswith("M66")]


class GrblBench:
    """Drive it with ``post``, ``run`` and the hands of ``on_screen_station``."""

    def __init__(self, machine: Machine | None = None, quirks: SimulatorBehavior | None = None) -> None:
        self.model = machine or grbl_machine()
        self.clock = ManualClock()
        self.peer = GrblFirmware(self.clock, quirks)
        self.wire = LoopWire(self.peer)
        self.machine = GrblMachine(create_grblhal_config(self.model), self.clock, self.wire)
        self.events: list[LogEvent] = []
        self.executor = Executor(self.model, self.machine.ports, self.events.append)
        self.wire.sent.clear()

    @property
    def shot(self) -> Snapshot:
        return self.executor.snapshot

    @property
    def state(self) -> MachineState:
        return self.executor.snapshot.state

    def post(self, *commands: Command) -> None:
        for command in commands:
            self.executor.post(command)
        self.tick()

    def tick(self, dt: float = TICK) -> None:
        self.clock.advance(dt)
        self.executor.run_tick()

    def run(self, seconds: float) -> None:
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.tick()

    def alone(self, seconds: float) -> None:
        """Let time pass for the driver without an executor."""
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.clock.advance(TICK)
            self.machine.run_cycle()

    def until(self, *states: MachineState, limit: float = 60.0) -> float:
        return self.until_true(lambda shot: shot.state in states, limit)

    def until_true(self, condition: Callable[[Snapshot], bool], limit: float = 60.0) -> float:
        began = self.clock.now()
        while not condition(self.shot):
            assert self.clock.now() - began < limit, f"not within {limit} s: {self.shot}\n{self.events[-5:]}"
            self.tick()
        return self.clock.now() - began

    def ready(self) -> None:
        self.post(EnableDrives())
        assert self.state is MachineState.IDLE, self.shot

    def load(self, text: str) -> Job:
        """With the proof that proving gives, which tells what the program needs."""
        setup = create_power_up_setup(
            self.model, tool_offsets={1: ToolOffset(0.0, 0.0)}, secondary_offsets={}
        )
        job = make_job(ProgramSource("PART", text), setup)
        proof = create_proof(job, prove(job.source, job.setup, self.model))
        assert not proof.errors, proof.errors
        self.post(LoadJob(job, proof))
        return job

    def press(self) -> None:
        """Both palms."""
        panel = self.machine.on_screen_station
        panel.press_left()
        panel.press_right()
        self.tick()
        panel.release_left()
        panel.release_right()
        self.run(0.2)

    def start(self, text: str) -> None:
        """Drives on, program loaded, both palms."""
        if self.state is MachineState.DISABLED:
            self.ready()
        self.run(0.4)
        self.load(text)
        if self.shot.interrupted is not None:  # read, and meant all the same
            self.post(ConfirmStart(self.shot.interrupted.at))
            self.run(0.9)  # a start counts when it was meant before the hands came down
        self.press()

    def said(self, kind: str) -> list[str]:
        return [event.text for event in self.events if event.kind == kind]

    def alarms(self) -> str:
        return "; ".join(f"{alarm.code}: {alarm.detail or alarm.cause}" for alarm in self.shot.alarms)


def quirky(**changes: Any) -> SimulatorBehavior:
    return dataclasses.replace(SimulatorBehavior(), **changes)
