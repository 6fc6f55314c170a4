"""CSP from the feeder: how late SYNC goes out, idle and under load, with and without real-time priority.

Run with ``python -m tests.benchmarks.bench_csp [SECONDS]``. Three processes as they are shipped: this one is
the control and sends X to and fro, the feeder owns the bus, the peers are EPOS4 drives and terminals; the bus
is UDP multicast, whose frames cost several times what SocketCAN's do. Load is a process for each core that
only counts.
"""

from __future__ import annotations

import contextlib
import gc
import json
import multiprocessing
import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import resources
from app.compose.feeder_process import driven
from app.compose.machine_files import load_machine
from core.ports import DriverError, MachinePorts
from drivers.canopen.cyclic_mode import SyncSchedule
from drivers.clocks import RealClock
from drivers.feeder.feeder_client import Line, feeder_ports
from drivers.feeder.feeder_links import SocketLink
from drivers.feeder.feeder_loop import keep_memory, real_time, serve
from drivers.feeder.feeder_messages import NOTHING, Inbox, Message, packed
from drivers.setpoint_queue import straight

SECONDS = 10.0
GROUP = "239.74.163.2"
SPEED, WAY, ACCEL = 100.0, 40.0, 3000.0  # mm/s, mm, mm/s²


def machine_file(folder: Path, sync_ms: int) -> Path:
    """The shipped EPOS4 lathe on a bus between processes."""
    text = resources.machine_file("gt75-epos4.toml")
    port = 20000 + os.getpid() % 20000 + sync_ms
    for old, new in (
        ('interface = "socketcan"', 'interface = "udp_multicast"'),
        ('channel = "can0"', f'channel = "{GROUP}:{port}"'),
        ("sync_ms = 2 ", f"sync_ms = {sync_ms} "),
        ("heartbeat_ms = 100 ", "heartbeat_ms = 500 "),
        ("absolute = false", "absolute = true"),
    ):
        assert old in text, old
        text = text.replace(old, new)
    path = folder / f"csp{sync_ms}.toml"
    path.write_text(text)
    return path


def feeder(arguments: list[str]) -> None:
    """The feeder's process; what came late goes to a file."""
    descriptor, zero, file, fifo, out = arguments
    late: list[float] = []
    sent = SyncSchedule.sent

    def noted(schedule: SyncSchedule, now: float) -> float:
        late.append(now - schedule.due)
        return sent(schedule, now)

    SyncSchedule.sent = noted  # type: ignore[method-assign]
    if fifo == "fifo":
        real_time()
    keep_memory()
    owned = driven(load_machine(Path(file)), RealClock(float(zero)))
    gc.freeze()
    late.clear()
    sock = socket.socket(fileno=int(descriptor))
    sock.sendall(packed(Message({"ready": True}, NOTHING)))
    serve(sock, owned, [])
    Path(out).write_text(json.dumps(late))


def count_for_ever() -> None:
    """A core's work."""
    while True:
        pass


@contextlib.contextmanager
def load(processes: int) -> Iterator[None]:
    """So many of them, at normal priority."""
    busy = [multiprocessing.Process(target=count_for_ever, daemon=True) for _ in range(processes)]
    for each in busy:
        each.start()
    yield
    for each in busy:
        each.terminate()


def to_and_fro(ports: MachinePorts, seconds: float) -> str:
    """X goes and comes until the time is over; the fault that ended it, if one did."""
    axes = ports.axes
    axes.enable(True)
    end, to = time.monotonic() + seconds, WAY
    while time.monotonic() < end:
        sample = axes.sample()
        if sample.fault:
            return sample.fault
        if not sample.moving and axes.horizon() <= axes.now():
            rest = axes.demand_at(axes.horizon())[0]
            start = axes.now() + axes.commit + 0.02
            axes.splice(straight(start, rest, 0, to=to, speed=SPEED, accel=ACCEL))
            to = WAY - to
        time.sleep(0.01)
    return ""


def measured(folder: Path, sync_ms: int, seconds: float, busy: int, *, fifo: bool) -> str:
    """One row of the table."""
    file, out = machine_file(folder, sync_ms), folder / "late.json"
    out.unlink(missing_ok=True)
    peers = subprocess.Popen(
        [sys.executable, "-m", "app.cli.main", "machine", "peer", str(file)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
    )
    assert peers.stdout is not None
    peers.stdout.readline()
    ours, theirs = socket.socketpair()
    clock = RealClock()
    words = [str(theirs.fileno()), repr(clock.zero), str(file), "fifo" if fifo else "normal", str(out)]
    command = [sys.executable, "-m", "tests.benchmarks.bench_csp", "--feeder", *words]
    child = subprocess.Popen(command, pass_fds=(theirs.fileno(),))
    theirs.close()
    ours.settimeout(60.0)
    inbox = Inbox()
    while not list(inbox.feed(ours.recv(1 << 16))):
        pass
    try:
        ports = feeder_ports(Line(SocketLink(ours), clock))
        with load(busy):
            fault = to_and_fro(ports, seconds)
    except DriverError as error:
        fault = str(error)
    ours.close()
    with contextlib.suppress(subprocess.TimeoutExpired):
        child.wait(40.0)
    for each in (child, peers):
        each.kill()
        each.wait()
    how = f"| {sync_ms} | {busy} | {'yes' if fifo else 'no'} |"
    if not out.exists():
        return f"{how} – | – | – | – | {fault} |"
    late = 1000.0 * np.array(json.loads(out.read_text()))
    p50, p99, most = np.percentile(late, 50), np.percentile(late, 99), late.max()
    return f"{how} {p50:.2f} | {p99:.2f} | {most:.1f} | {len(late)} | {fault or 'none'} |"


def main(arguments: list[str]) -> None:
    """Print the table as it comes."""
    seconds = float(arguments[0]) if arguments else SECONDS
    cores = os.cpu_count() or 1
    sys.stdout.write("| sync_ms | busy processes | SCHED_FIFO | p50 ms | p99 ms | max ms | SYNCs | fault |\n")
    sys.stdout.write("|---|---|---|---|---|---|---|---|\n")
    with tempfile.TemporaryDirectory() as folder:
        for sync_ms in (4, 2):
            for busy in (0, cores):
                for fifo in (True, False):
                    row = measured(Path(folder), sync_ms, seconds, busy, fifo=fifo)
                    sys.stdout.write(f"{row}\n")
                    sys.stdout.flush()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--feeder"]:
        feeder(sys.argv[2:])
    else:
        main(sys.argv[1:])
