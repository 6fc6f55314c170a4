"""Reading of a drawing in a separate process with limited time and memory, for safety."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from core.extras.drawings.drawing import Drawing, DrawingError, drawing_of
from core.input_file import failures_as
from core.message import Message
from core.own_process import module_environment

_CHILD = "core.extras.drawings.drawing_child"
_LOOK = 0.1  # s between two checks whether the drawing is still needed

GoOn = Callable[[float], None]
"""Called with the seconds that reading has taken; what it raises ends the process."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits for reading one drawing.

    ``memory`` is in bytes of address space; ``processor`` and ``clock`` are in seconds. Only Linux limits
    memory and processor time. The largest DXF of 16 MB takes 4 s and 240 MB.
    """

    memory: int = 1024**3
    processor: int = 60
    clock: float = 120.0


LIMITS = Limits()


def read_in_process(path: Path, go_on: GoOn = lambda _seconds: None, limits: Limits = LIMITS) -> Drawing:
    """Return the lines and arcs of a drawing. Raises DrawingError, or the exception that ``go_on`` raises."""
    begun = time.monotonic()
    words = [str(path.absolute()), str(limits.memory), str(limits.processor)]
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", _CHILD, *words],  # -P: the current folder is not trusted
            env=module_environment(OPENBLAS_NUM_THREADS="1"),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
    except (OSError, ValueError) as error:  # ValueError: the name contains a zero byte
        raise DrawingError(
            Message(
                "{path} cannot be read because the process that reads drawings cannot be started.",
                path=path.name,
            ),
            "unreadable",
        ) from error
    with process:
        try:
            while (data := _all_of(process)) is None:
                seconds = time.monotonic() - begun
                go_on(seconds)
                if seconds > limits.clock:
                    raise _too_long(path, limits.clock)
        finally:
            process.kill()
            process.wait()
    if process.returncode:
        raise _ended(path, process.returncode, limits)
    with failures_as(lambda _error: _ended(path, 1, limits)):
        return drawing_of(data)


def _all_of(process: subprocess.Popen[bytes]) -> bytes | None:
    """Return the output of the process when it has ended; None while it is running."""
    try:
        return process.communicate(timeout=_LOOK)[0]
    except subprocess.TimeoutExpired:
        return None


def _ended(path: Path, status: int, limits: Limits) -> DrawingError:
    """Return the error for a process that ended without a result."""
    if -status == getattr(signal, "SIGXCPU", 0):
        return _too_long(path, limits.processor)
    most = limits.memory // 1024**2
    words = Message(
        "{path} cannot be read with {maximum} MB of memory. Save only the contour of the part.",
        path=path.name,
        maximum=most,
    )
    return DrawingError(words, "out-of-memory")


def _too_long(path: Path, seconds: float) -> DrawingError:
    words = Message(
        "{path} takes more than {seconds} s to read. Save only the contour of the part.",
        path=path.name,
        seconds=f"{seconds:.0f}",
    )
    return DrawingError(words, "too-slow")
