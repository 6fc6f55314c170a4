"""B9 and the feed-hold figure: hold at 300 in/min in one move, and with a million blocks loaded and running.

Run with ``python -m tests.benchmarks.bench_hold``.
"""

from __future__ import annotations

import math
import random
import statistics
import sys
import time

from app.compose.backends.simulated_backend import create_simulation
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from core.executor.commands import CycleStart, EnableDrives, FeedHold, LoadJob
from core.executor.executor import Executor
from core.executor.job import Proof, make_job
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from drivers.wakeups import ManualClock

TICK = 0.01
PRESSES = 20
LONG = "G90G94F300\nT1\nX0Z0\nX3Z-4\nX0Z0\nM30\n"


def chords(count: int) -> str:
    """A wave of chords of .001 in, to and fro along Z."""
    lines = ["G90G94F300\nT1\nX1Z0"]
    for k in range(count):
        z = abs(k % 8000 - 4000) * 0.001
        lines.append(f"X{1 + 0.2 * math.sin(z * 3):.5f}Z{-z:.4f}")
    return "\n".join(lines) + "\nM30\n"


class Machine:
    """An executor on the simulated lathe, stepped by hand."""

    def __init__(self, text: str) -> None:
        self.machine = read_machine(None)
        self.clock = ManualClock()
        self.ports = create_simulation(self.machine, self.clock).ports
        self.executor = Executor(self.machine, self.ports, lambda _: None)
        setup = create_power_up_setup(self.machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
        self.job = make_job(ProgramSource("bench", text), setup)
        self.tick()
        self.executor.post(EnableDrives())
        self.tick()
        self.executor.post(LoadJob(self.job, Proof(self.job.digest, ())))
        self.executor.post(CycleStart())
        self.tick()

    def tick(self) -> float:
        """One tick; the seconds it took."""
        begun = time.perf_counter()
        self.executor.run_tick()
        took = time.perf_counter() - begun
        self.clock.advance(TICK)
        return took

    def hold(self) -> tuple[float, float]:
        """Press hold; (machine seconds until rest, mm/s at the first moment that can still be changed)."""
        t = self.clock.now()
        (_, before) = self.ports.axes.demand_at(t + self.machine.timing.commit_time_s)
        self.executor.post(FeedHold())
        self.tick()
        rest = self.ports.axes.horizon()
        while self.executor.snapshot.state is not MachineState.HOLD:
            self.tick()
        return rest - t, math.hypot(before[0], before[1])


def main() -> None:
    """Print the tables."""
    chance = random.Random(1)
    _one_move(chance)
    _million(chance)


def _one_move(chance: random.Random) -> None:
    times, off = [], []
    for _ in range(PRESSES):
        machine = Machine(LONG)
        while not 0.5 < machine.clock.now() < 9 or machine.executor.snapshot.line < 4:
            machine.tick()
        for _ in range(chance.randrange(40)):
            machine.tick()
        took, speed = machine.hold()
        allowed = machine.machine.timing.commit_time_s + speed / machine.machine.axes[0].max_acceleration
        times.append(took - allowed)
        x, z, _ = machine.executor.snapshot.demand
        off.append(abs(4 * x + 3 * z) / 5)  # distance from the line through (0, 0) and (3, -4)
    sys.stdout.write(
        f"hold in one move at 300 in/min: at most {max(times) * 1000:+.1f} ms against commit + v/a, "
        f"{max(off) / 25.4:.7f} in off the path\n"
    )


def _million(chance: random.Random) -> None:
    machine = Machine(chords(1_000_000))
    ticks, times = [], []
    for _ in range(PRESSES):
        ticks += [machine.tick() for _ in range(50 + chance.randrange(50))]
        times.append(machine.hold()[0])
        machine.executor.post(CycleStart())
    ticks.sort()
    sys.stdout.write(
        f"hold with 1 000 000 blocks running: at rest after {statistics.median(times) * 1000:.0f} ms "
        f"(median), {max(times) * 1000:.0f} ms at most\n"
        f"a tick of the executor: {statistics.median(ticks) * 1000:.2f} ms median, "
        f"{ticks[int(len(ticks) * 0.99)] * 1000:.1f} ms p99, {ticks[-1] * 1000:.1f} ms at most\n"
    )


if __name__ == "__main__":
    main()
