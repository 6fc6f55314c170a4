"""How the time and memory of a proof grow with the program, from 1,000 to 1,000,000 lines.

Run with ``python -m tests.benchmarks.bench_growth``; ``docs/speed.md`` is written from its result. Times are
processor time of whole processes. They prove without the part, because ``turndesk prove`` calculates the part
of short programs only. LinuxCNC's ``rs274`` runs by turns with them where it is installed.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from tests.benchmarks.bench_prove import program
from tests.benchmarks.footprint import keep_result
from tests.benchmarks.installed import installed
from tests.benchmarks.processor_time import Cost, compared
from tests.benchmarks.speed_page import for_rs274

COUNTS = (1_000, 10_000, 100_000, 1_000_000)
ROUNDS = 3  # of the longest program; shorter ones more often
PROOF = """
import gc, sys
gc.set_threshold(200_000)  # as the command does
from pathlib import Path
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import load_source
from core.proving.prove_program import prove
machine = read_machine(None)
setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
prove(load_source(Path(sys.argv[1])), setup, machine)
"""


def commands(home: Path, count: int) -> Mapping[str, Sequence[str]]:
    """Return the commands for a program of ``count`` lines, by their names; the files are put in ``home``."""
    long = home / f"{count}.nc"
    long.write_text(program(count))
    found: dict[str, Sequence[str]] = {"prove": [sys.executable, "-c", PROOF, str(long)]}
    if peer := shutil.which("rs274"):
        found["rs274"] = [peer, "-g", str(for_rs274(long)), os.devnull]
    return found


def row(costs: Mapping[str, Cost]) -> dict[str, float]:
    """Return the figures of one program: seconds and MiB of the proof, and seconds of the peer."""
    own, peer = costs["prove"], costs.get("rs274")
    figures = {"prove, s": round(own.seconds, 3), "memory, MiB": round(own.memory)}
    return figures | ({"rs274, s": round(peer.seconds, 3)} if peer is not None else {})


def main() -> None:
    """Measure all programs, and store and print the result."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        for count in COUNTS:
            around = installed(home, OPENBLAS_NUM_THREADS="1")
            rounds = ROUNDS if count == max(COUNTS) else 3 * ROUNDS
            rows[str(count)] = row(compared(commands(home, count), around, rounds))
            sys.stdout.write(f"{count:>9,} {rows[str(count)]}\n")
    keep_result("growth", {"rows": rows})


if __name__ == "__main__":
    main()
