"""What long jobs cost: a CAM program with its part, threads of many passes, splines of 0.2 and 1.3 MB.

Run with ``python -m tests.benchmarks.bench_long_jobs``. Figures are processor time of whole processes, beside
a bare interpreter run by turns with them.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from ezdxf.filemanagement import new

from tests.benchmarks.bench_start import TURNDESK
from tests.benchmarks.footprint import keep_result
from tests.benchmarks.installed import installed
from tests.benchmarks.processor_time import BARE, Cost, compared

ROUNDS = 3
NO_JOB = "bare interpreter"
PASSES, CUTS = 20, 3000
TOOL = """
[tool.1]
x = -2.9
z = 0.0
kind = "turning"
hand = "right"
insert = "CNMG432"
tip = 3
"""
HEAD = "G90G94F300G72\nM03S{rpm}\nT1\n"


def cam(passes: int = PASSES, cuts: int = CUTS) -> str:
    """A contour that rises towards the chuck, in passes of short lines, each deeper than the one before."""
    lines = [HEAD.format(rpm=2000) + "X1.3Z.1\nG95F.004\n"]
    for number in range(passes):
        lines.append("G00Z.05\nG01")
        left = 0.36 * (1.0 - (number + 1) / passes)
        for k in range(cuts):
            share = k / cuts
            radius = 0.4 + 0.2 * share + 0.02 * math.sin(9.0 * share)
            x = min(2.0 * radius + left, 1.22)
            lines.append(f"X{x:.4f}Z{0.03 - 1.5 * share:.4f}\n")
        lines.append("G00X1.3\n")
    return "".join([*lines, "Z.1\nM30\n"])


def threads() -> str:
    """Three threads, 2282 passes together: many times what a thread takes."""
    cycles = "".join(f"G33X.95Z-.5I{first}K.05\n" for first in (".00185", ".00185", ".00195"))
    return f"{HEAD.format(rpm=500)}X1Z.2\n{cycles}G00X1.2\nM30\n"


def drawing(path: Path, points: int) -> Path:
    """A part whose outside is one spline with so many control points."""
    document = new("R2000")
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    places = [(-60.0 * k / points, 10.0 + 2.0 * math.sin(20.0 * k / points)) for k in range(points + 1)]
    space.add_open_spline([(x, y, 0.0) for x, y in places], degree=3)
    space.add_line((0.0, 0.0), places[0])
    space.add_line(places[-1], (-60.0, 0.0))
    document.saveas(path)
    return path


def jobs(home: Path) -> dict[str, Sequence[str]]:
    """The commands by their names; their files are put into ``home``."""
    tools = home / "tools.toml"
    tools.write_text(TOOL)
    files = {"cam": cam(), "threads": threads()}
    for name, text in files.items():
        (home / f"{name}.nc").write_text(text)
    given = ("--offsets", str(tools), "--tools", str(tools), "--stock", "bar:1.2:4")
    commands: dict[str, Sequence[str]] = {
        NO_JOB: BARE,
        f"prove {PASSES * CUTS:,} lines with the part": [*TURNDESK, "prove", str(home / "cam.nc"), *given],
        "prove 2,282 thread passes with the part": [*TURNDESK, "prove", str(home / "threads.nc"), *given],
    }
    for points in (2_400, 24_000):
        file = drawing(home / f"{points}.dxf", points)
        name = f"profile --list, spline of {points:,} points, {file.stat().st_size / 1e6:.1f} MB"
        commands[name] = [*TURNDESK, "profile", str(file), "--list"]
    return commands


def _keep(costs: Mapping[str, Cost]) -> None:
    """Store the result for ``docs/speed.md``."""
    rows = {
        name: (round(cost.seconds, 3), round(cost.memory)) for name, cost in costs.items() if name != NO_JOB
    }
    keep_result("long_jobs", {"bare, s": costs[NO_JOB].seconds, "rows": rows})


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        costs = compared(jobs(home), installed(home, OPENBLAS_NUM_THREADS="1"), ROUNDS)
    _keep(costs)
    sys.stdout.write(f"{'processor time of a process':48s}{'s':>9s}{'x bare':>9s}{'MiB':>9s}\n")
    bare = costs[NO_JOB].seconds
    for name, cost in costs.items():
        sys.stdout.write(f"{name:48s}{cost.seconds:9.3f}{cost.seconds / bare:9.0f}{cost.memory:9.0f}\n")


if __name__ == "__main__":
    main()
