"""A folder of programs on all cores: how busy they are, and how long the second time takes.

Run with ``python -m tests.benchmarks.bench_folder [PROGRAMS]``.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.benchmarks.installed import installed

PROGRAMS, SEED = 2000, 14
_SUBREAPER = 36  # PR_SET_CHILD_SUBREAPER of prctl(2)
_OFFSETS = "".join(f"[tool.{n}]\nx = 0.0\nz = 0.0\nnose_radius = 0.0156\n" for n in range(1, 5))


class Spent(NamedTuple):
    """Seconds of a run by the clock, those that its processes computed, and those that all cores idled."""

    wall: float
    computed: float
    idle: float


def program(seed: int) -> str:
    """A turned part like those of a shop: faced, roughed, finished, drilled."""
    choose = random.Random(seed)
    outer = choose.randrange(300, 700) / 1000
    lines = [f"(PART {seed})", "G90G94F300", f"M03S{choose.randrange(8, 30) * 100}", "T1(TURN)"]
    lines += [f"X{outer + 0.05:.3f}Z.05", f"G95F.00{choose.randrange(3, 9)}Z0", "X-.02", "G94F300Z.05"]
    radius, z = outer, -choose.randrange(300, 1500) / 1000
    for _ in range(choose.randrange(4, 12)):
        radius -= 0.02
        z *= choose.uniform(0.8, 0.98)
        lines += [f"X{radius:.4f}", f"G95F.006Z{z:.4f}", f"X{radius + 0.025:.4f}", "G94F300Z.05"]
    lines += _contour(choose, radius - 0.01, z)
    if choose.random() < 0.5:
        lines += ["G94F300X2Z1", "T2(1/8 DRILL)", "X0Z.1", "G95F.003Z-.6", "G94F300Z1"]
    return "\n".join([*lines, "G94F300X2", "Z2", "M30", ""])


def _contour(choose: random.Random, radius: float, z: float) -> list[str]:
    """The last pass: cones and steps outwards along Z, and back out of the part."""
    steps = choose.randrange(4, 30)
    return [
        f"X{radius * 0.6:.4f}Z.05",
        "G95F.002Z0",
        *(f"X{radius * (0.6 + 0.4 * k / steps):.4f}Z{z * k / steps:.4f}" for k in range(1, steps + 1)),
        f"X{radius + 0.1:.4f}",
    ]


def write_programs(folder: Path, count: int, seed: int = SEED) -> None:
    """So many programs, the same for a seed."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(count):
        (folder / f"part{number:05d}.nc").write_text(program(seed * 1_000_000 + number))


def spent(command: Sequence[str], around: dict[str, str]) -> Spent:
    """What a run of a command takes; its workers are its children."""
    used, idle, start = _computed(), _idle(), time.perf_counter()
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, env=around, check=False)
    _wait_for_workers()
    if ended.returncode > 1:
        sys.exit(ended.returncode)
    return Spent(time.perf_counter() - start, _computed() - used, _idle() - idle)


def _adopt_workers() -> None:
    """Workers are forked by a process that outlives the command by a moment; only who waits for it is told
    what they have computed."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)


def _wait_for_workers() -> None:
    with contextlib.suppress(ChildProcessError):
        while True:
            os.wait()


def _computed() -> float:
    use = resource.getrusage(resource.RUSAGE_CHILDREN)
    return use.ru_utime + use.ru_stime


def _idle() -> float:
    """Seconds that the cores of this computer had nothing to do, together."""
    figures = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()
    return (int(figures[4]) + int(figures[5])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    """Print the table."""
    _adopt_workers()
    count = int(sys.argv[1]) if len(sys.argv) > 1 else PROGRAMS
    cores = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as home:
        folder, offsets = Path(home) / "parts", Path(home) / "offsets.toml"
        write_programs(folder, count)
        offsets.write_text(_OFFSETS)
        command = [sys.executable, "-m", "app.cli.main", "prove", str(folder), "--offsets", str(offsets)]
        around = installed(Path(home) / "home")
        spent([*command[:4], str(folder / "part00000.nc")], around)  # compiles the modules
        first, second = spent(command, around), spent(command, around)
    for name, run in (("first", first), ("second", second)):
        sys.stdout.write(
            f"{count:,} programs, {name:7s} {run.wall:8.2f} s, {run.computed / run.wall / cores:5.1%} of"
            f" {cores} cores computed by it, {run.idle / run.wall / cores:5.1%} of them idle\n"
        )
    sys.stdout.write(f"the second time takes {second.wall / first.wall:.1%} of the first\n")


if __name__ == "__main__":
    main()
