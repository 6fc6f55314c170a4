"""B4: from the start of a process to a usable window, to the program drawn, and to the first setpoint.

Run with ``python -m tests.benchmarks.bench_start``; it needs no display.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.benchmarks.installed import installed

RUNS = 7
SAMPLES = Path(__file__).parents[2] / "resources" / "programs"

WINDOW = """
import os, sys, time
begun = float(sys.argv[1])
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from app.screen import run_screen as screen
from app.compose.stored_offsets import chosen_offsets
from app.compose.screen_desk import build_desk
desks, usable = [], []
def build():
    desks.append(build_desk(None, chosen_offsets(sys.argv[3])))
    return desks[0]
def look():
    window = next(iter(QApplication.topLevelWidgets()), None)
    if desks and window is not None and window.isVisible():
        if not usable:
            usable.append(time.time() - begun)
        if desks[0].session.now.picture is not None:
            sys.stdout.write(f"{usable[0]} {time.time() - begun}")
            QApplication.exit(0)
            return
    QTimer.singleShot(2, look)
QTimer.singleShot(0, look)
app = screen._application("dark")
screen.run_screen(program=sys.argv[2], build=build)
"""

HEADLESS = """
import sys, time
begun = float(sys.argv[1])
from pathlib import Path
from app.compose.machine_setup import read_machine, setup_for
from app.compose.stored_offsets import chosen_offsets
from app.compose.simulated_backend import simulated
from app.desk.run_without_screen import HeadlessRun
from core.executor.commands import CycleStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Proof, make_job
from core.language.source import load_source
from drivers.clocks import StepClock
machine = read_machine(None)
tools, secondary, *_ = chosen_offsets(sys.argv[3])()
clock = StepClock()
ports = simulated(machine, clock).ports
executor = Executor(machine, ports, lambda event: None)
job = make_job(load_source(Path(sys.argv[2])), setup_for(machine, tools=tools, secondary=secondary))
executor.tick()
executor.post(EnableDrives())
executor.tick()
executor.post(LoadJob(job, Proof(job.digest, ())))
executor.post(CycleStart())
while ports.axes.horizon() <= clock.now():
    executor.tick()
    clock.advance(0.01)
sys.stdout.write(str(time.time() - begun))
"""


def timed(script: str) -> list[list[float]]:
    """The numbers that each run of a script prints: seconds since its process was started."""
    with tempfile.TemporaryDirectory() as home:
        around = installed(Path(home), QT_QPA_PLATFORM="offscreen")
        rows = []
        for _ in range(RUNS + 1):
            command = [sys.executable, "-c", script, str(time.time())]
            command += [str(SAMPLES / "bushing.nc"), str(SAMPLES / "offsets.toml")]
            done = subprocess.run(command, env=around, check=True, capture_output=True, text=True)
            rows.append([float(number) for number in done.stdout.split()])
        return rows[1:]


def main() -> None:
    """Print the table."""
    window = timed(WINDOW)
    rows = [
        ("usable window", [row[0] for row in window]),
        ("program proved and drawn", [row[1] for row in window]),
        ("headless, to the first setpoint", [row[0] for row in timed(HEADLESS)]),
    ]
    sys.stdout.write(f"{'from the start of the process':34s} {'median':>9s} {'least':>9s} {'most':>9s}\n")
    for name, values in rows:
        figures = (statistics.median(values), min(values), max(values))
        sys.stdout.write(f"{name:34s}" + "".join(f" {value:7.2f} s" for value in figures) + "\n")


if __name__ == "__main__":
    main()
