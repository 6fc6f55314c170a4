"""B2 and B4: a short proof from a cold process, the first setpoint, a usable window, the program drawn.

Run with ``python -m tests.benchmarks.bench_start``; it needs no display. Figures are processor time: what a
process has used when that is reached and it ends at once. Others on the machine stretch it little, and its
ratio to a bare interpreter, run by turns with it, hardly at all.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from tests.benchmarks.bench_prove import program as turned_part
from tests.benchmarks.installed import installed
from tests.benchmarks.processor_time import BARE, QT, ROUNDS, Cost, compared

TURNDESK = (sys.executable, "-m", "app.cli.main")
SAMPLES = Path(__file__).parents[2] / "resources" / "programs"

WINDOW = """
import gc, os, sys
gc.set_threshold(200_000)  # as the command does
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from app.screen import screen_startup as screen
from app.compose.stored_offsets import make_offsets_reader
from app.compose.screen_desk import build_desk
program, offsets, until = sys.argv[1:]
desks = []
def build():
    desks.append(build_desk(None, make_offsets_reader(offsets)))
    return desks[0]
def look():
    window = next(iter(QApplication.topLevelWidgets()), None)
    if desks and window is not None and window.isVisible():
        if until == "usable" or desks[0].program_loader.loaded.picture is not None:
            os._exit(0)
    QTimer.singleShot(2, look)
QTimer.singleShot(0, look)
app = screen._application("dark")
screen.run_screen(program=program, build=build)
"""

HEADLESS = """
import gc, os, sys
gc.set_threshold(200_000)  # as the command does
from pathlib import Path
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from app.compose.stored_offsets import make_offsets_reader
from app.compose.backends.simulated_backend import create_simulation
from core.executor.commands import CycleStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Proof, make_job
from core.language.source import load_source
from drivers.wakeups import ManualClock
machine = read_machine(None)
tools, secondary, *_ = make_offsets_reader(sys.argv[2])()
clock = ManualClock()
ports = create_simulation(machine, clock).ports
executor = Executor(machine, ports, lambda event: None)
setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets=secondary)
job = make_job(load_source(Path(sys.argv[1])), setup)
executor.tick()
executor.post(EnableDrives())
executor.tick()
executor.post(LoadJob(job, Proof(job.digest, ())))
executor.post(CycleStart())
while ports.axes.horizon() <= clock.now():
    executor.tick()
    clock.advance(0.01)
os._exit(0)
"""


def compared_starts(home: Path, rounds: int = ROUNDS) -> dict[str, Cost]:
    """What each start costs, beside a bare interpreter and one that has loaded Qt; ``home`` has the store."""
    program, offsets = str(SAMPLES / "bushing.nc"), str(SAMPLES / "offsets.toml")
    short = home / "short.nc"
    short.write_text(turned_part(200))
    commands = {
        "bare interpreter": BARE,
        "import numpy": [sys.executable, "-c", "import numpy"],
        "import PySide6.QtWidgets": QT,
        "turndesk --help": [*TURNDESK, "--help"],
        "turndesk --version": [*TURNDESK, "--version"],
        "prove 200 blocks": [*TURNDESK, "prove", str(short), "--offsets", offsets],
        "headless, to the first setpoint": [sys.executable, "-c", HEADLESS, program, offsets],
        "window usable": [sys.executable, "-c", WINDOW, program, offsets, "usable"],
        "window, program proved and drawn": [sys.executable, "-c", WINDOW, program, offsets, "drawn"],
    }
    around = installed(home, QT_QPA_PLATFORM="offscreen", OPENBLAS_NUM_THREADS="1")
    return compared(commands, around, rounds)


def table(costs: dict[str, Cost]) -> list[tuple[str, str, str, str]]:
    """Name, seconds, and how many times a bare interpreter and the import of Qt that is."""
    bare, qt = costs["bare interpreter"].seconds, costs["import PySide6.QtWidgets"].seconds
    return [
        (name, f"{cost.seconds:.3f}", f"{cost.seconds / bare:.1f}", f"{cost.seconds / qt:.1f}")
        for name, cost in costs.items()
    ]


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as home:
        rows = table(compared_starts(Path(home)))
    head = ("processor time of a process", "s", "x bare", "x Qt")
    for name, *figures in (head, *rows):
        sys.stdout.write(f"{name:34s}" + "".join(f"{each:>9s}" for each in figures) + "\n")


if __name__ == "__main__":
    main()
