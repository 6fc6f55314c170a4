"""B1, B2 and B3: interpreting, proving from a cold process and warm, up to a million blocks and in loops.

Run with ``python -m tests.benchmarks.bench_prove``.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from pathlib import Path

from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.benchmarks.installed import installed

RUNS = 7
HEAD = "G90G94F300G72\nM03S2000\nT1\nX1Z.1\nG95F.003\n"


def cuts(moves: int) -> str:
    """Lines of so many cutting moves: steps down in Z, in and out in X."""
    return "".join(f"X{0.5 + k % 7 * 0.01:.4f}Z{-0.0001 * k:.4f}\n" for k in range(moves))


def program(moves: int) -> str:
    """A turned part of this many cutting moves."""
    return f"{HEAD}{cuts(moves)}G00X1\nZ1\nM30\n"


def feeds(moves: int) -> str:
    """The same with an F on each of them, never that of the line before."""
    lines = cuts(moves).splitlines()
    return (
        f"{HEAD}" + "".join(f"{line}F.00{3 + k % 5}\n" for k, line in enumerate(lines)) + "G00X1\nZ1\nM30\n"
    )


def loop(passes: int) -> str:
    """900 of them, gone through so often."""
    return f"{HEAD}X.5Z0\nLS{passes}\n{cuts(900)}LF\nG00X1\nZ1\nM30\n"


def interpreted(source: ProgramSource, setup: InterpreterSetup) -> None:
    """Go through all blocks, and do nothing with them."""
    deque(interpret_program(source, setup).generate_series(), maxlen=0)


def median_of(work: Callable[[], object]) -> float:
    """Median seconds of some runs after one that does not count."""
    work()
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def main() -> None:
    """Print the table."""
    machine = read_machine(None)
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder) / "small.nc"
        small.write_text(program(200))
        offsets = Path(folder) / "offsets.toml"
        offsets.write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
        command = [sys.executable, "-m", "app.cli.main", "prove", str(small), "--offsets", str(offsets)]
        around = installed(Path(folder))
        rows = [
            ("bare interpreter", median_of(lambda: subprocess.run([sys.executable, "-c", ""], check=True))),
            (
                "prove 200 blocks, cold process",
                median_of(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=around)),
            ),
        ]
    for moves in (200, 10_000, 100_000, 1_000_000):
        source = ProgramSource("bench", program(moves))
        rows.append((f"prove {moves:,} blocks, warm", median_of(partial(prove, source, setup, machine))))
    rows.append((f"interpret {moves:,} blocks", median_of(partial(interpreted, source, setup))))
    source = ProgramSource("bench", loop(2000))
    rows.append(("prove a loop of 1,800,000 blocks", median_of(partial(prove, source, setup, machine))))
    for name, seconds in rows:
        sys.stdout.write(f"{name:34s} {seconds * 1000:10.1f} ms\n")


if __name__ == "__main__":
    main()
