"""A run without a screen that nobody starts, or whose slides do not find home, is no complete run."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import pytest

from app.desk.headless_run import HeadlessRun, RunOutcome
from core.executor.commands import Command, EnableDrives, HomeAxes
from core.executor.job import Proof, make_job
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from drivers.wakeups import ManualClock

ESTOP = make_alarm("estop", "", 0, 0.0)


@dataclass
class Idle:
    """An executor that switches its drives on, homes where it can, and starts nothing."""

    homes: bool = True
    snapshot: Snapshot = field(default_factory=lambda: Snapshot(state=MachineState.DISABLED))
    posted: list[Command] = field(default_factory=list)

    def post(self, command: Command) -> None:
        self.posted.append(command)

    def run_tick(self) -> None:
        if any(isinstance(each, EnableDrives) for each in self.posted):
            self.snapshot = replace(self.snapshot, state=MachineState.IDLE)
        if any(isinstance(each, HomeAxes) for each in self.posted):
            done = self.homes
            self.snapshot = replace(
                self.snapshot, homed=(done,) * 3, state=MachineState.IDLE if done else MachineState.HOMING
            )


def outcome(executor: Idle, said: list[str]) -> RunOutcome:
    job = make_job(ProgramSource("part.nc", "G90G94F300\nM30\n"), InterpreterSetup())
    run = HeadlessRun(executor, ManualClock(), said.append, lambda _t: None, lambda: said.append("palms"))
    return run.run_job(job, Proof(job.digest, ()))


@dataclass
class Stopped(Idle):
    """An executor with a bus machine whose E-stop is pressed as soon as the drives are on."""

    released: bool = False

    def run_tick(self) -> None:
        super().run_tick()
        if self.snapshot.state is MachineState.IDLE:
            state = MachineState.DISABLED if self.released else MachineState.ESTOP
            self.snapshot = replace(self.snapshot, state=state, stop=ESTOP)


@pytest.mark.parametrize("released", [False, True])
def test_estop_ends_a_headless_run_as_an_alarm(released: bool) -> None:
    ended = outcome(Stopped(snapshot=Snapshot(state=MachineState.DISABLED), released=released), [])
    assert ended.final_state == "alarm"
    assert ended.failure_reason.startswith(ESTOP.text)


def test_headless_run_times_out_if_the_palm_buttons_are_not_pressed() -> None:
    said: list[str] = []
    ended = outcome(Idle(), said)
    assert said == ["homing X, Z, C", "palms"]
    assert ended.final_state == "waiting"
    assert "no Cycle Start received" in ended.failure_reason


def test_headless_run_is_not_complete_if_homing_does_not_finish() -> None:
    ended = outcome(Idle(homes=False), [])
    assert ended.final_state == "waiting"
    assert "homing did not finish" in ended.failure_reason
