"""Processes that are killed: who belongs to them, what they say, and that nothing of them stays."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from drivers.wakeups import RealClock

PATIENCE = 90.0  # s for what must happen at once on a computer that is not busy
Line = dict[str, object]


class Process:
    """A command of ours with a folder of its own; its lines of JSON, as they come."""

    def __init__(self, home: Path, module: str, *arguments: str) -> None:
        self.home = home
        self.lines: list[Line] = []
        environment = os.environ | {"TURNDESK_HOME": str(home), "QT_QPA_PLATFORM": "offscreen"}
        words = [sys.executable, "-m", module, *arguments]
        self.popen = subprocess.Popen(words, stdout=subprocess.PIPE, env=environment)

    def listen(self) -> None:
        """What it has said since."""
        out = self.popen.stdout
        assert out is not None
        while select.select([out], [], [], 0.0)[0] and (line := out.readline()):
            self.lines.append(json.loads(line))

    def says(self, key: str, value: object) -> bool:
        """Whether its last word has this in it."""
        self.listen()
        return bool(self.lines) and self.lines[-1].get(key) == value

    def kill(self) -> None:
        """As ``kill -9`` does it."""
        os.kill(self.popen.pid, signal.SIGKILL)
        self.popen.wait()

    def family(self) -> set[int]:
        """Every live process that was started with this folder: the command and its driver host."""
        mark = f"TURNDESK_HOME={self.home}".encode()
        return {pid for pid in _alive() if mark in _environment(pid)}

    def host(self) -> int:
        """Its driver host."""
        return self._one_of("driver_host_process")

    def control(self) -> int:
        """The process of its control."""
        return self._one_of("control_process")

    def kill_all(self) -> None:
        """As a computer that runs out of memory does it: the screen and its control, not the driver host."""
        os.kill(self.control(), signal.SIGKILL)
        self.kill()

    def _one_of(self, module: str) -> int:
        def found() -> set[int]:
            return {pid for pid in self.family() if any(module.encode() in word for word in _words(pid))}

        until(lambda: len(found()) == 1, self.family)
        (pid,) = found()
        return pid


@contextmanager
def process(home: Path, module: str, *arguments: str) -> Iterator[Process]:
    """Started; whatever is left of it at the end is killed."""
    made = Process(home, module, *arguments)
    try:
        yield made
    finally:
        for pid in made.family():
            with suppress(ProcessLookupError):  # a driver host without a control ends by itself
                os.kill(pid, signal.SIGKILL)
        made.popen.wait()
        assert made.popen.stdout is not None
        made.popen.stdout.close()


def until(ready: Callable[[], bool], what: Callable[[], object]) -> None:
    """Wait for it; ``what`` is shown when it does not come."""
    tick, clock = threading.Event(), RealClock()
    while not ready():
        assert clock.now() < PATIENCE, what()
        tick.wait(0.02)


def _alive() -> Iterator[int]:
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            if (entry / "stat").read_text().rpartition(")")[2].split()[0] != "Z":
                yield int(entry.name)
        except OSError:
            continue  # it has ended meanwhile


def _environment(pid: int) -> list[bytes]:
    return _strings(pid, "environ")


def _words(pid: int) -> list[bytes]:
    return _strings(pid, "cmdline")


def _strings(pid: int, name: str) -> list[bytes]:
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes().split(b"\0")
    except OSError:
        return []
