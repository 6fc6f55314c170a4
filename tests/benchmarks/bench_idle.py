"""The real window at rest: processor time and wake-ups, whole and by thread, and how soon a key acts.

``python -m tests.benchmarks.bench_idle [--seconds 60] [NAME …]``: a window of 1920×1080 under an X server of
its own; NAME is one of ``off``, ``ready``, ``keys``, ``scope``, ``minimised``, ``feeder``, ``canopen``. Told
are per mille of a core by ``/proc/PID/stat`` (user and system, threads by ``schedstat``), and by thread how
often a second it was woken; the drives that a bench plays in a process of their own are not counted. The
shares are kept for docs/speed.md.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

import resources
from tests.benchmarks.footprint import keep_result
from tests.stories.x11 import Server, server

SIZE = (1920, 1080)
CASES = ("off", "ready", "keys", "scope", "minimised", "feeder", "canopen")
ARRIVES, SETTLES, RESTS, PEER = 20.0, 6.0, 3.5, 3.0  # s
ROLLS = 12.0  # s; the window of the scope, until nothing of what was before rolls in it
PRESSES = 30
LEAST = 0.0001  # of a core
HAS_DRIVER_HOST = "[machine]\nfeeder = true\n"
PICTURES = os.environ.get("BENCH_PICTURES", "")
_TICKS = os.sysconf("SC_CLK_TCK")


# --- the desk, in a process of its own ------------------------------------------------------------------


def desk(words: list[str]) -> int:
    """The screen as it is; its threads are named for whoever looks from outside, and setpoints are told."""
    from app.cli.main import run_console  # noqa: PLC0415  the parent needs none of it
    from drivers.simulators.plant import SimulatedPlant  # noqa: PLC0415

    begin, splice = threading.Thread.run, SimulatedPlant.splice_segments

    def named(thread: threading.Thread) -> None:
        Path(f"/proc/self/task/{threading.get_native_id()}/comm").write_text(thread.name[:15])
        begin(thread)

    def told(plant: SimulatedPlant, segments: Any) -> None:
        say(f"{time.monotonic()!r}\n")
        splice(plant, segments)

    sys.argv = ["turndesk", *words]
    with (
        mock.patch.object(threading.Thread, "run", named),
        mock.patch.object(SimulatedPlant, "splice_segments", told),
    ):
        return run_console()


class Used(NamedTuple):
    """Of a thread, or of a process, so far."""

    name: str
    seconds: float
    woken: int


def threads_of(pid: int) -> dict[int, Used]:
    """Every thread of a process, by its number."""
    found = {}
    for task in Path(f"/proc/{pid}/task").iterdir():
        with suppress(OSError):
            nanoseconds = int((task / "schedstat").read_text().split()[0])
            status = (task / "status").read_text().split()
            woken = int(status[status.index("voluntary_ctxt_switches:") + 1])
            found[int(task.name)] = Used((task / "comm").read_text().strip(), nanoseconds * 1e-9, woken)
    return found


def time_of(pid: int) -> float:
    """Seconds of user and system time of a process."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def children(pid: int) -> list[int]:
    """Processes that it has started: the driver host."""
    return [
        int(child)
        for task in Path(f"/proc/{pid}/task").iterdir()
        for child in (task / "children").read_text().split()
    ]


# --- measuring --------------------------------------------------------------------------------------------


class Bench:
    """A desk that is measured; ``words`` are those of its command line."""

    def __init__(self, stage: Server, home: Path, *words: str) -> None:
        self.stage, self._home = stage, home
        self.shares: dict[str, float] = {}
        self.popen = subprocess.Popen(
            [sys.executable, "-m", __spec__.name, "--desk", *words],
            env=stage.environment | {"TURNDESK_HOME": str(home)},
            stdout=subprocess.PIPE,
            text=True,
        )
        self._spliced: queue.SimpleQueue[float] = queue.SimpleQueue()
        threading.Thread(target=self._read, daemon=True).start()
        time.sleep(ARRIVES)
        self.window = stage.run("xdotool", "getactivewindow").strip()

    def _read(self) -> None:
        assert self.popen.stdout is not None
        for line in self.popen.stdout:
            self._spliced.put(float(line))

    def keys(self, *names: str) -> None:
        """One after the other, pressed as a finger does."""
        for name in names:
            self.stage.down(name)
            time.sleep(0.05)
            self.stage.up(name)
            time.sleep(1.0)

    def minimise(self) -> None:
        """Into the task bar."""
        self.stage.run("xdotool", "windowminimize", self.window)

    def measure(self, name: str, seconds: float) -> None:
        """A block of the table."""
        time.sleep(SETTLES)
        pids = [self.popen.pid, *children(self.popen.pid)]
        if PICTURES:
            self.stage.picture(Path(PICTURES) / f"{name}.png")
        begun, before = time.monotonic(), {pid: (time_of(pid), threads_of(pid)) for pid in pids}
        time.sleep(seconds)
        took = time.monotonic() - begun
        whole = sum(time_of(pid) - before[pid][0] for pid in pids) / took
        state = json.loads((self._home / "status.json").read_text())["execution"]
        say(f"{f'{name} ({state})':34s}{1000 * whole:7.1f}\n")
        self.shares[name] = round(1000.0 * whole, 1)
        for pid in pids:
            _threads(before[pid][1], threads_of(pid), took, "feeder: " if pid != pids[0] else "")

    def press(self, key: str) -> float:
        """A held key, and seconds until the first setpoint that comes of it is queued."""
        while not self._spliced.empty():
            self._spliced.get()
        begun = time.monotonic()
        self.stage.down(key)
        try:
            return self._spliced.get(timeout=5.0) - begun
        finally:
            self.stage.up(key)

    def close(self) -> None:
        """The window is shut."""
        self.popen.terminate()
        self.popen.wait(30)


def _threads(before: dict[int, Used], after: dict[int, Used], took: float, whose: str) -> None:
    rows = []
    for number, now in after.items():
        was = before.get(number, Used("", 0.0, 0))
        rows.append(((now.seconds - was.seconds) / took, (now.woken - was.woken) / took, now.name))
    for share, woken, name in sorted(rows, reverse=True):
        if share > LEAST or woken > 100 * LEAST:
            say(f"    {whose + name:30s}{1000 * share:7.1f}{woken:9.1f}\n")


def say(text: str) -> None:
    """Part of the table."""
    sys.stdout.write(text)
    sys.stdout.flush()


# --- what is measured -------------------------------------------------------------------------------------


def simulated(
    stage: Server, folder: Path, names: set[str], seconds: float, machine: str = ""
) -> dict[str, float]:
    """On the lathe that is shipped, or on this machine file: per mille of a core by what the desk does."""
    bench = Bench(stage, folder, *(("--machine", machine) if machine else ()))
    if "off" in names:
        bench.measure("servo off", seconds)
    bench.keys("d")
    if names & {"ready", "feeder", "canopen"}:
        bench.measure("servo on", seconds)
    if "keys" in names:
        latency(bench)
    if "scope" in names:
        bench.stage.down("Shift_L")
        bench.keys("F10")
        bench.stage.up("Shift_L")
        time.sleep(ROLLS)
        bench.measure("scope shown", seconds)
    if "minimised" in names:
        bench.minimise()
        bench.measure("minimised", seconds)
    bench.close()
    return bench.shares


def latency(bench: Bench) -> None:
    """A jog key of a desk at rest, to and fro, pressed at any time of its beat."""
    chance = random.Random(1)
    bench.keys("F1", "F5")
    took = []
    for number in range(PRESSES):
        time.sleep(RESTS + chance.random() * 0.1)
        took.append(1000 * bench.press(("Left", "Right")[number % 2]))
    say(f"{'key down to setpoint queued, ms':34s}{statistics.median(took):7.1f}{max(took):9.1f} at most\n")


def in_host(stage: Server, folder: Path, shipped: str, seconds: float, name: str) -> dict[str, float]:
    """A shipped machine whose drivers are a process of their own; its far end is played beside it."""
    machine = folder / shipped
    text = resources.read_machine_file(shipped)
    machine.write_text(text if "\nfeeder = true" in text else text.replace("[machine]\n", HAS_DRIVER_HOST, 1))
    peer = None
    if name == "canopen":
        words = [sys.executable, "-m", "app.cli.main", "machine", "peer", str(machine)]
        peer = subprocess.Popen(words, stdin=subprocess.PIPE)
        time.sleep(PEER)
    say(f"{shipped} through the feeder\n")
    shares = simulated(stage, folder, {"off", name}, seconds, str(machine))
    if peer is not None:
        peer.terminate()
        peer.wait(30)
    return shares


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=CASES, metavar="NAME", help=", ".join(CASES))
    parser.add_argument("--seconds", type=float, default=60.0)
    wanted = parser.parse_args()
    names = set(wanted.names)
    shares: dict[str, dict[str, float]] = {}
    say(f"{'per mille of a core, wake-ups/s':34s}{os.getloadavg()[0]:7.1f} load\n")
    with tempfile.TemporaryDirectory() as folder, server(Path(folder) / "x", SIZE) as stage:
        for name in ("sim", "feeder", "canopen"):
            (Path(folder) / name).mkdir()
        if names - {"feeder", "canopen"}:
            shares["simulated lathe"] = simulated(stage, Path(folder) / "sim", names, wanted.seconds)
        for name, shipped in (("feeder", "gt75.toml"), ("canopen", "gt75-bench.toml")):
            if name in names:
                within = in_host(stage, Path(folder) / name, shipped, wanted.seconds, name)
                shares[f"{shipped} through the feeder"] = within
    say(f"{keep_result('idle', {'seconds': wanted.seconds, 'rows': shares})}\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--desk"]:
        sys.exit(desk(sys.argv[2:]))
    main()
