"""The driver host with a setpoint each SYNC: how late SYNC goes out, under load or not, with SCHED_FIFO or
not.

``python -m tests.benchmarks.bench_driver_host [--seconds 10] [--sync 4 2 1] [--busy 0 6] [--fifo yes no]``.
Three processes as they are shipped: this one is the control and sends X to and fro in pieces of 2 ms, the
driver host owns the bus, EPOS4 drives and terminals are the far end. Its frames are those of SocketCAN,
packed and taken apart by python-can, on a socket pair: what a CAN interface and its driver take is not in it;
``--udp`` has them on UDP multicast instead, which costs several times that.

A *witness* on each core, above the driver host's priority, does nothing but wait for every second
millisecond: how late it is, the computer is by itself. ``own`` are SYNCs at times when no witness was more
than .2 ms late. A run that a fault has ended is followed by another until there are ``--seconds`` of each
kind, in ten runs at most; the rows are kept for docs/speed.md.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import itertools
import json
import multiprocessing
import os
import select
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from unittest import mock

import can
import numpy as np
from can.interfaces.socketcan.socketcan import build_can_frame, dissect_can_frame

import resources
from app.compose.backends.canopen_backend import create_simulated_devices
from app.compose.backends.driver_host_process import create_host_drivers
from app.compose.backends.simulated_devices import simulate_devices
from app.compose.machine.machine_files import load_machine
from core.ports import DriverError, FloatArray, MachinePorts, MotionSegments
from drivers.canopen.position_modes import CyclicSetpointFollower, SyncSchedule
from drivers.driver_host.host_connection import HostConnection, SocketLink
from drivers.driver_host.host_loop import (
    REAL_TIME_PRIORITY,
    lock_host_memory,
    request_real_time_scheduling,
    run_driver_host,
)
from drivers.driver_host.host_messages import NO_NUMBERS, Message, encode_message
from drivers.driver_host.host_ports import create_host_ports
from drivers.setpoint_queue import plan_axis_move
from drivers.wakeups import RealClock
from tests.benchmarks.footprint import keep_result

GROUP = "239.74.163.2"
SPEED, WAY, ACCEL = 100.0, 40.0, 3000.0  # mm/s, mm, mm/s²
PIECE = 0.002  # s
RUNS = 10
STOOD = 0.0002  # s by which a witness is late when the computer stands
_FRAME, _SFF, _RTR = 16, 0x7FF, 0x40000000


class FramePair(can.BusABC):
    """One end of a socket pair that carries ``struct can_frame``, read and written as SocketCAN's are."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(channel="pair")
        self._socket = socket.socket(fileno=descriptor)
        self._is_filtered = True

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if not select.select([self._socket], [], [], timeout)[0]:
            return None, True
        try:
            data, *_ = self._socket.recvmsg(_FRAME, 64)
        except OSError as error:
            raise can.CanOperationError(str(error)) from error
        if not data:
            raise can.CanOperationError("the other end has gone")
        number, length, _flags, carried = dissect_can_frame(data)
        return can.Message(
            timestamp=time.time(),
            arbitration_id=number & _SFF,
            is_extended_id=False,
            is_remote_frame=bool(number & _RTR),
            dlc=length,
            data=carried,
        ), True

    def send(self, msg: can.Message, timeout: float | None = None) -> None:  # noqa: ARG002
        """Raises CanOperationError."""
        try:
            self._socket.send(build_can_frame(msg))
        except OSError as error:
            raise can.CanOperationError(str(error)) from error

    def shutdown(self) -> None:
        """Closed."""
        super().shutdown()
        self._socket.close()


def on_pair(descriptor: int) -> None:
    """Whatever bus is opened in this process from now on is that end; -1: as the machine file says."""
    if descriptor >= 0:
        can.Bus = lambda **_: FramePair(descriptor)


def machine_file(folder: Path, sync_ms: int) -> Path:
    """The shipped EPOS4 lathe on a bus between processes."""
    text = resources.read_machine_file("gt75-epos4.toml")
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


# --- processes -------------------------------------------------------------------------------------------


def host(arguments: list[str]) -> None:
    """The driver host's process; what came late goes to a file."""
    descriptor, zero, file, fifo, out, bus = arguments
    on_pair(int(bus))
    late: list[tuple[float, float]] = []
    gaps: list[float] = []
    sent, waited = SyncSchedule.record_sync, CyclicSetpointFollower.delay_path

    def noted(schedule: SyncSchedule, now: float) -> float:
        late.append((schedule.due_time_s + float(zero), now - schedule.due_time_s))
        return sent(schedule, now)

    def missed(follower: CyclicSetpointFollower, away: float) -> None:
        before = follower.gap_count
        waited(follower, away)
        if follower.gap_count > before:
            gaps.append(away)

    if fifo == "yes":
        request_real_time_scheduling()
    lock_host_memory()
    owned = create_host_drivers(load_machine(Path(file)), RealClock(float(zero)))
    gc.freeze()
    late.clear()
    sock = socket.socket(fileno=int(descriptor))
    sock.sendall(encode_message(Message({"ready": True}, NO_NUMBERS)))
    begun, used = time.monotonic(), time.process_time()
    with (
        mock.patch.object(SyncSchedule, "record_sync", noted),
        mock.patch.object(CyclicSetpointFollower, "delay_path", missed),
    ):
        run_driver_host(sock, owned, [])
    share = (time.process_time() - used) / (time.monotonic() - begun)
    Path(out).write_text(json.dumps({"late": late, "gaps": gaps, "share": share}))


def say(text: str) -> None:
    """To whoever has started this process."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def far_end(arguments: list[str]) -> None:
    """Drives and terminals, until they are killed."""
    file, bus = arguments
    on_pair(int(bus))
    simulate_devices(load_machine(Path(file)), lambda: True, say, tuple, create_simulated_devices)


def witness(core: int, out: str) -> None:
    """How late a process is that only waits, until its input ends."""
    with contextlib.suppress(OSError):
        os.sched_setaffinity(0, {core})
    request_real_time_scheduling(REAL_TIME_PRIORITY + 10)
    lock_host_memory()
    say("ready")
    due, late = time.monotonic(), []
    while not select.select([sys.stdin], [], [], 0.0)[0]:
        for _ in range(100):
            due += 0.002
            left = due - time.monotonic()
            if left > 0.0:
                time.sleep(left)
            late.append((due, time.monotonic() - due))
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
    try:
        yield
    finally:
        for each in busy:
            each.terminate()


# --- measuring -------------------------------------------------------------------------------------------


def in_pieces(way: MotionSegments) -> MotionSegments:
    """The same way as a program of short blocks is planned: a piece each 2 ms."""
    rows: list[tuple[float, float, FloatArray, FloatArray, FloatArray]] = []
    for t, dt, p, v, a in zip(*way, strict=True):
        edges = np.linspace(0.0, dt, max(round(dt / PIECE), 1) + 1)
        for at, to in itertools.pairwise(edges):
            rows.append((t + at, to - at, p + (v + 0.5 * a * at) * at, v + a * at, a))
    return MotionSegments(*(np.array(column) for column in zip(*rows, strict=True)))


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
            start = axes.now() + axes.commit + 0.1
            try:
                axes.splice(in_pieces(plan_axis_move(start, rest, 0, target=to, speed=SPEED, accel=ACCEL)))
            except DriverError as error:
                if error.code != "late":  # this process has real-time priority no more than the control has
                    raise
            else:
                to = WAY - to
        time.sleep(0.01)
    return ""


def started(words: list[str], *descriptors: int, heard: bool = False) -> subprocess.Popen[bytes]:
    """This module in another process; ``heard``: once it has said its first line."""
    command = [sys.executable, "-m", "tests.benchmarks.bench_driver_host", *words]
    child = subprocess.Popen(
        command,
        pass_fds=[each for each in descriptors if each >= 0],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE if heard else None,
    )
    if heard:
        assert child.stdout is not None
        child.stdout.readline()
    return child


@contextlib.contextmanager
def witnesses(folder: Path) -> Iterator[list[Path]]:
    """One on each core; the files that they write at the end."""
    files = [folder / f"witness{core}.json" for core in range(os.cpu_count() or 1)]
    running = [started(["--witness", str(core), str(file)], heard=True) for core, file in enumerate(files)]
    try:
        yield files
    finally:
        for child in running:
            assert child.stdin is not None
            child.stdin.close()
            child.wait(30.0)


def measured(folder: Path, sync_ms: int, seconds: float, busy: int, *, fifo: bool, udp: bool) -> list[str]:
    """One row of the table, of a run that lasts so long or ends with a fault."""
    file, out = machine_file(folder, sync_ms), folder / "late.json"
    out.unlink(missing_ok=True)
    pair = None if udp else socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    before = os.getloadavg()[0]
    near, far = (-1, -1) if pair is None else (pair[0].fileno(), pair[1].fileno())
    peers = started(["--far-end", str(file), str(far)], far, heard=True)
    ours, theirs = socket.socketpair()
    clock = RealClock()
    how = "yes" if fifo else "no"
    words = [str(theirs.fileno()), repr(clock.origin_s), str(file), how, str(out), str(near)]
    child = started(["--driver-host", *words], theirs.fileno(), near)
    for each in (theirs, *(pair or ())):
        each.close()
    link = SocketLink(ours)
    link.wait_for_message(60.0)
    try:
        ports = create_host_ports(HostConnection(link, clock))
        with load(busy), witnesses(folder) as seen:
            fault = to_and_fro(ports, seconds)
    except DriverError as error:
        fault = str(error)
    ours.close()
    with contextlib.suppress(subprocess.TimeoutExpired):
        child.wait(40.0)
    for each in (child, peers):
        each.kill()
        each.wait()
    told = figures(json.loads(out.read_text()), seen) if out.exists() else ["–"] * 7
    return [str(sync_ms), str(busy), how, *told, f"{before:.0f}", fault or "none"]


def figures(told: dict[str, list[tuple[float, float]]], seen: list[Path]) -> list[str]:
    """The middle of a row: lateness of SYNC, of those that are ours alone, of the witnesses; ms."""
    late = np.array(told["late"])
    waits = np.concatenate([np.array(json.loads(file.read_text())).reshape(-1, 2) for file in seen])
    if not len(late) or not len(waits):
        return ["–", "–", "–", "–", "0", "–", "–"]
    stood = waits[waits[:, 1] > STOOD]
    ours = np.ones(len(late), bool)
    for due, away in stood:  # a SYNC due between the witness's time and a while after it went on
        ours &= (late[:, 0] < due - 0.002) | (late[:, 0] > due + away + 0.002)
    of = [1000.0 * each for each in (late[:, 1], late[ours, 1], waits[:, 1])]
    whole, own, alone = (f"{np.percentile(each, 99):.2f} / {each.max():.1f}" for each in of)
    gaps = len(told["gaps"])
    share = f"{100 * float(str(told['share'])):.0f}"
    return [f"{np.median(of[0]):.2f}", whole, own, alone, str(len(late)), str(gaps), share]


HEAD = (
    "sync_ms", "busy processes", "SCHED_FIFO", "median", "99 % / max", "own 99 % / max", "witness 99 % / max",
    "SYNCs", "gaps", "% of a core", "load", "fault",
)  # fmt: skip


def repeated(run: Callable[[float], list[str]], seconds: float) -> Iterator[list[str]]:
    """Rows of runs until they lasted so long together."""
    for _ in range(RUNS):
        begun = time.monotonic()
        row = run(seconds)
        yield row
        seconds -= time.monotonic() - begun
        if row[-1] == "none" or seconds <= 0.0:
            return


def main() -> None:
    """Print the table as it comes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--sync", type=int, nargs="+", default=[4, 2, 1])
    parser.add_argument("--busy", type=int, nargs="+", default=[0, 6])
    parser.add_argument("--fifo", nargs="+", choices=("yes", "no"), default=["yes", "no"])
    parser.add_argument("--udp", action="store_true")
    wanted = parser.parse_args()
    rows = []
    say(f"| {' | '.join(HEAD)} |\n{'|---' * len(HEAD)}|")
    with tempfile.TemporaryDirectory() as folder:
        for sync_ms, busy, fifo in itertools.product(wanted.sync, wanted.busy, wanted.fifo):
            run = partial(measured, Path(folder), sync_ms, busy=busy, fifo=fifo == "yes", udp=wanted.udp)
            for row in repeated(run, wanted.seconds):
                say(f"| {' | '.join(row)} |")
                rows.append(row)
    say(str(keep_result("feeder", {"seconds": wanted.seconds, "rows": rows})))


if __name__ == "__main__":
    roles: dict[str, Callable[[list[str]], None]] = {
        "--driver-host": host,
        "--far-end": far_end,
        "--witness": lambda a: witness(int(a[0]), a[1]),
    }
    role = roles.get(sys.argv[1] if len(sys.argv) > 1 else "")
    if role is not None:
        role(sys.argv[2:])
    else:
        main()
