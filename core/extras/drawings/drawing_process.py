"""Reader of drawings in a separate process, with limited time and memory for safety."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from core.extras.drawings.drawing import Drawing, DrawingError, decode_drawing
from core.input_file import convert_exceptions
from core.message import Message
from core.process_environment import make_module_environment

_CHILD = "core.extras.drawings.drawing_child"
_LOOK = 0.1  # s between two checks whether the drawing is still needed

CancelCheck = Callable[[float], None]
"""Function that receives the reading time so far, in seconds.

Any exception that it raises ends the process.
"""


@dataclass(frozen=True, slots=True)
class ReadingLimits:
    """Limits for reading one drawing.

    ``memory_bytes`` is the size of the address space in bytes; ``processor_time_s`` and ``timeout_s`` are
    in seconds. Memory and processor time are limited only on Linux. The largest DXF, of 16 MB, takes 4 s
    and 240 MB.
    """

    memory_bytes: int = 1024**3
    processor_time_s: int = 60
    timeout_s: float = 120.0


DEFAULT_LIMITS = ReadingLimits()


def read_drawing_in_process(
    path: Path, check_canceled: CancelCheck = lambda _seconds: None, limits: ReadingLimits = DEFAULT_LIMITS
) -> Drawing:
    """Return the lines and arcs of a drawing, read in a separate process.

    ``check_canceled`` is called repeatedly with the elapsed seconds. Raises DrawingError if reading fails,
    or the exception that ``check_canceled`` raises.
    """
    begun = time.monotonic()
    words = [str(path.absolute()), str(limits.memory_bytes), str(limits.processor_time_s)]
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", _CHILD, *words],  # -P: the current folder is not trusted
            env=make_module_environment(OPENBLAS_NUM_THREADS="1"),
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
            while (data := _read_output(process)) is None:
                seconds = time.monotonic() - begun
                check_canceled(seconds)
                if seconds > limits.timeout_s:
                    raise _too_long(path, limits.timeout_s)
        finally:
            process.kill()
            process.wait()
    if process.returncode:
        raise _ended(path, process.returncode, limits)
    with convert_exceptions(lambda _error: _ended(path, 1, limits)):
        return decode_drawing(data)


def _read_output(process: subprocess.Popen[bytes]) -> bytes | None:
    """Return the output of the process if it has ended, or None while it is running."""
    try:
        return process.communicate(timeout=_LOOK)[0]
    except subprocess.TimeoutExpired:
        return None


def _ended(path: Path, status: int, limits: ReadingLimits) -> DrawingError:
    """Return the error that reports that the process has ended without a result."""
    if -status == getattr(signal, "SIGXCPU", 0):
        return _too_long(path, limits.processor_time_s)
    most = limits.memory_bytes // 1024**2
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
