"""B2 and the 100 000-block figure: proving from a cold process and warm.

Run with ``python -m tests.benchmarks.bench_prove``.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from app.compose.machine import read_machine, setup_for
from core.interpreter.setup import ToolOffset
from core.language.source import Source
from core.proving.prove import prove

RUNS = 7
HEAD = "G90G94F300G72\nM03S2000\nT1\nX1Z.1\nG95F.003\n"


def program(moves: int) -> str:
    """A turned part of this many cutting moves: steps down in Z, in and out in X."""
    body = "".join(f"X{0.5 + k % 7 * 0.01:.4f}Z{-0.0001 * k:.4f}\n" for k in range(moves))
    return f"{HEAD}{body}G00X1\nZ1\nM30\n"


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
    setup = setup_for(machine, tools={1: ToolOffset()}, secondary={})
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder) / "small.nc"
        small.write_text(program(200))
        offsets = Path(folder) / "offsets.toml"
        offsets.write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
        command = [sys.executable, "-m", "app.cli.main", "prove", str(small), "--offsets", str(offsets)]
        rows = [
            ("bare interpreter", median_of(lambda: subprocess.run([sys.executable, "-c", ""], check=True))),
            (
                "prove 200 blocks, cold process",
                median_of(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL)),
            ),
        ]
    for moves in (200, 10_000, 100_000):
        source = Source("bench", program(moves))
        rows.append((f"prove {moves:,} blocks, warm", median_of(lambda s=source: prove(s, setup, machine))))  # type: ignore[misc]
    for name, seconds in rows:
        sys.stdout.write(f"{name:34s} {seconds * 1000:10.1f} ms\n")


if __name__ == "__main__":
    main()
