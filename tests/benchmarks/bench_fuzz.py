"""Spoilt programs through the whole proof: ``python -m tests.benchmarks.bench_fuzz [MINUTES]``, else ten.

Prints what was tried and the slowest; a program that makes TurnDesk itself fail is printed whole and ends it.
"""

from __future__ import annotations

import random
import resource
import sys
import time

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from tests.interpreter.mutation import mutated

OFFSETS = {n: ToolOffset() for n in range(1, 9)}
MACHINES = {
    Dialect.OMNITURN: ("gt75", "fuzz"),
    Dialect.KLARTEXT: ("ac-table-mill", "fuzz.h"),
    Dialect.SINUMERIK: ("sinumerik-modulo", "fuzz.mpf"),
}
SECONDARY = {1: SecondaryOffset(-0.381, -0.381, 0.381), 3: SecondaryOffset(nose_radius=0.2)}


def main() -> None:
    """Fuzz each language for its share of the time."""
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    for dialect, (machine, name) in MACHINES.items():
        _fuzz(dialect, load_shipped_machine(machine), name, minutes * 60 / len(MACHINES))


def _fuzz(dialect: Dialect, machine: Machine, name: str, seconds: float) -> None:
    setup = create_power_up_setup(machine, tool_offsets=OFFSETS, secondary_offsets=SECONDARY)
    seed, end, slowest, accepted = 0, time.monotonic() + seconds, (0.0, 0), 0
    while time.monotonic() < end:
        seed += 1
        text = mutated(random.Random(seed), dialect)
        begun = time.perf_counter()
        try:
            report = prove(ProgramSource(name, text), setup, machine)
        except Exception:
            sys.stdout.write(f"{dialect}, seed {seed}:\n{text}\n")
            raise
        slowest = max(slowest, (time.perf_counter() - begun, seed))
        accepted += not report.errors
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    sys.stdout.write(
        f"{dialect}: {seed:,} programs, {accepted:,} of them good; slowest {slowest[0]:.2f} s "
        f"(seed {slowest[1]}); peak memory {peak} MiB\n"
    )


if __name__ == "__main__":
    main()
