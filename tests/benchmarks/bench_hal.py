"""LinuxCNC's HAL by its clocks: ``python -m tests.benchmarks.bench_hal [SECONDS] [BUSY]``, else 20 and 0.

A real halrun with the shipped simulated lathe and its bridge, the driver in this process, ``BUSY`` processes
beside that only compute. Printed each as median, 99 of 100 and most, ms: how late the bridge woke up (worst
of each report), how far the clock of the servo thread and this computer's are apart, how many setpoints lay
ready in the stream at least, and how often it ran dry.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

from app.compose.backends.hal_backend import create_hal_config
from app.compose.machine.machine_files import load_machine
from drivers.hal.bridge.packets import PacketHead, number
from drivers.hal.hal_machine import HalMachine
from drivers.hal.hal_session import HalSession
from drivers.wakeups import RealClock
from tests.drivers.hal.halrun import folder_with_halrun, one_session
from tests.drivers.hal.lathes import lathe

TICK = 0.005  # s


def main() -> None:
    """Run it."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    busy = [multiprocessing.Process(target=_compute, daemon=True) for _ in range(count)]
    for each in busy:
        each.start()
    sys.stdout.write(f"{len(busy)} busy processes, load {os.getloadavg()[0]:.1f} at the beginning\n")
    try:
        with tempfile.TemporaryDirectory() as name, one_session():
            folder = Path(name)
            folder.chmod(0o755)
            os.environ["PATH"] = f"{folder_with_halrun(folder / 'bin')}:{os.environ['PATH']}"
            _report(_heads(folder, seconds))
    finally:
        for each in busy:
            each.kill()


def _compute() -> None:
    while True:
        sum(range(100_000))


def _heads(folder: Path, seconds: float) -> list[PacketHead]:
    """What the bridge told, report by report."""
    config, clock = create_hal_config(load_machine(lathe(folder))), RealClock()
    machine = HalMachine(config, clock, lambda: HalSession(config, clock.origin_s))
    found: list[PacketHead] = []
    try:
        machine.axes.enable(True)
        end = clock.now() + seconds
        while clock.now() < end:
            machine.run_cycle()
            found.append(machine.bridge_link.last_report)
            clock.sleep_until(clock.now() + TICK)
    finally:
        machine.close()
    return found


def _report(heads: list[PacketHead]) -> None:
    for word, key, scale in (
        ("bridge late, ms", "late", 1e3),
        ("clocks apart, ms", "off_by", 1e3),
        ("least in the stream", "least", 1.0),
    ):
        values = np.abs([number(head, key) for head in heads if head.get(key) is not None]) * scale
        low, high, most = np.percentile(values, [50, 99, 100]) if len(values) else (0.0, 0.0, 0.0)
        sys.stdout.write(f"{word:20} {low:8.3f} {high:8.3f} {most:8.3f}\n")
    sys.stdout.write(f"ran dry {number(heads[-1], 'dry'):.0f} times in {len(heads)} reports\n")


if __name__ == "__main__":
    main()
