"""B5: a program streamed through the driver host's process for minutes, while other processes want the
processors.

Run with ``python -m tests.benchmarks.bench_stream [MINUTES [HOGS]]``: 10 minutes beside 4 busy processes.
"""

from __future__ import annotations

import dataclasses
import subprocess
import sys
import time

import numpy as np

from app.compose.backends.connection import connect_machine
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from core.executor.commands import Command, CycleStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Proof, make_job
from core.executor.snapshot import LogEvent, MachineState
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from drivers.wakeups import RealClock
from tests.benchmarks.bench_hold import TICK, chords

HOG = "while True: sum(range(1000))"
CHORDS = 2_000_000  # over half an hour of motion


def hogs(count: int) -> list[subprocess.Popen[bytes]]:
    """So many processes that never rest."""
    return [subprocess.Popen([sys.executable, "-c", HOG]) for _ in range(count)]


def stream(minutes: float) -> tuple[list[float], int, list[LogEvent]]:
    """How late each tick of the executor came, s; underruns; what was said."""
    base = read_machine(None)
    machine = dataclasses.replace(base, hardware=dataclasses.replace(base.hardware, uses_driver_host=True))
    clock, said, late = RealClock(), list[LogEvent](), list[float]()
    job = make_job(
        ProgramSource("bench", chords(CHORDS)),
        create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
    )
    job.shared_program.start_pass(job.setup)  # as its proof would have read it
    connected = connect_machine(machine, clock)
    executor = Executor(machine, connected.ports, said.append)
    said += [LogEvent(clock.now(), "warning", warning) for warning in connected.ports.warnings]
    todo: list[Command] = [EnableDrives(), LoadJob(job, Proof(job.digest, ())), CycleStart()]
    due = end = clock.now()
    end += 60.0 * minutes
    while (now := clock.now()) < end and executor.snapshot.state is not MachineState.FAULT:
        late.append(now - due)
        executor.run_tick()
        if todo:
            executor.post(todo.pop(0))
        due = max(due + TICK, clock.now())
        clock.sleep_until(due)
    underruns = executor.snapshot.underruns
    executor.shut_down()
    connected.close()
    return late, underruns, said


def main(arguments: list[str]) -> None:
    """Print the figures."""
    minutes = float(arguments[0]) if arguments else 10.0
    busy = hogs(int(arguments[1]) if len(arguments) > 1 else 4)
    begun = time.monotonic()
    try:
        late, underruns, said = stream(minutes)
    finally:
        for hog in busy:
            hog.kill()
            hog.wait()
    p50, p99, most = np.percentile(late, (50, 99, 100)) * 1000
    sys.stdout.write(
        f"{len(late)} ticks in {time.monotonic() - begun:.0f} s beside {len(busy)} busy processes\n"
    )
    sys.stdout.write(
        f"ticks of the executor late by {p50:.2f} ms median, {p99:.1f} p99, {most:.1f} at most\n"
    )
    sys.stdout.write(f"underruns: {underruns}\n")
    for kind in ("warning", "alarm", "starved"):
        of_it = [event for event in said if event.kind == kind]
        if of_it:
            sys.stdout.write(
                f"{kind}: {len(of_it)}, the last after {of_it[-1].time_s:.0f} s: {of_it[-1].text}\n"
            )


if __name__ == "__main__":
    main(sys.argv[1:])
