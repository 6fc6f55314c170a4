"""A process that has imported the desk once and forks for every story: the import takes a second each time.

``ForkServer`` is the end of whoever starts stories; ``python -m tests.stories.fork_server NUMBER`` the other,
with the descriptor of its line. A forked process is one like any other: with its own standard streams and
environment, killed and ended like any other, and it ends with Python's own shutdown.
"""

from __future__ import annotations

import gc
import json
import os
import select
import signal
import socket
import subprocess
import sys
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import closing
from importlib import import_module
from typing import Any, BinaryIO

_PRELOADED = (
    "app.compose.screen_desk",
    "app.compose.backends.simulated_backend",
    "app.compose.stored_offsets",
    "app.screen.display",
    "app.screen.screen_startup",
    "core.proving.part_history",
    "tests.stories.eyes",
)
_LONGEST = 1 << 17  # bytes of a message


class Forked:
    """A process that was forked elsewhere, with what ``subprocess.Popen`` has of it."""

    def __init__(self, pid: int, stdin: BinaryIO, stdout: BinaryIO, end: int) -> None:
        self.pid, self.stdin, self.stdout, self._end = pid, stdin, stdout, end
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """The exit status once it has ended; minus the signal that killed it."""
        if self.returncode is None and select.select([self._end], [], [], 0)[0]:
            self.wait()
        return self.returncode

    def wait(self) -> int:
        """Wait for the end, and its status."""
        if self.returncode is None:
            self.returncode = int(os.read(self._end, 16) or -signal.SIGKILL)
            os.close(self._end)
        return self.returncode


class ForkServer:
    """Starts a process for each story."""

    def __init__(self) -> None:
        self._line, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with closing(theirs):
            words = [sys.executable, "-m", "tests.stories.fork_server", str(theirs.fileno())]
            self._process = subprocess.Popen(words, pass_fds=(theirs.fileno(),))

    def begins(self, arguments: Sequence[str], environment: Mapping[str, str], errors: BinaryIO) -> Forked:
        """``tests.stories.eyes`` with these arguments and pipes to talk to it; ``errors`` is a file."""
        (read, stdin), (stdout, write), (end, told) = os.pipe(), os.pipe(), os.pipe()
        asked = json.dumps({"arguments": list(arguments), "environment": dict(environment)}).encode()
        socket.send_fds(self._line, [asked], [read, write, errors.fileno(), told])
        for each in (read, write, told):
            os.close(each)
        pid = int(self._line.recv(_LONGEST) or 0)
        assert pid, f"no process for stories: {self._process.poll()}"
        return Forked(pid, os.fdopen(stdin, "wb"), os.fdopen(stdout, "rb"), end)

    def close(self) -> None:
        """It ends; what it has forked does not."""
        self._line.close()
        self._process.wait()


class _Children:
    """What was forked and has not ended: how each ends is told on a descriptor of its own."""

    def __init__(self) -> None:
        self._told: dict[int, int] = {}
        signal.signal(signal.SIGCHLD, self._ended)

    def fork(self, told: int) -> int:
        """As ``os.fork``. A child has nothing of the others."""
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGCHLD})
        pid = os.fork()
        if pid:
            self._told[pid] = told
        else:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            for each in (told, *self._told.values()):
                os.close(each)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGCHLD})
        return pid

    def _ended(self, *_signal: object) -> None:
        while self._told:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if not pid:
                return
            told = self._told.pop(pid)
            try:
                os.write(told, str(os.waitstatus_to_exitcode(status)).encode())
            except BrokenPipeError:
                pass  # nobody waits for it any more
            finally:
                os.close(told)


def _preload() -> None:
    import_module("app.cli.main").build_parser()
    for name in _PRELOADED:
        import_module(name)
    table = import_module("app.screen.page_table")
    deque(table.create_qt_classes(), maxlen=0)
    for page in table.ALL_PAGES:
        table.import_page_classes(page)
    gc.freeze()  # a collection would copy what all of them share


def _asked(line: socket.socket) -> tuple[dict[str, Any], list[int]] | None:
    told, streams, _, _ = socket.recv_fds(line, _LONGEST, 4)
    return (json.loads(told), streams) if told else None


def serve(line: socket.socket) -> bool:
    """Fork for each that asks. True in a process that was forked, False when nobody asks any more."""
    _preload()
    children = _Children()
    while asked := _asked(line):
        what, (*streams, told) = asked
        pid = children.fork(told)
        if not pid:
            line.close()
            _becomes(what, streams)
            return True
        for each in streams:
            os.close(each)
        line.send(str(pid).encode())
    return False


def _becomes(what: dict[str, Any], streams: Sequence[int]) -> None:
    for number, each in enumerate(streams):
        os.dup2(each, number)
        os.close(each)
    # Those of before may be files, which Python asks where they stand; these are pipes.
    sys.stdout, sys.stderr = (open(number, "w", closefd=False) for number in (1, 2))  # noqa: SIM115
    os.environ.clear()
    os.environ.update(what["environment"])
    sys.argv[1:] = what["arguments"]


if __name__ == "__main__":
    if serve(socket.socket(fileno=int(sys.argv[1]))):
        sys.exit(import_module("tests.stories.eyes").main())
