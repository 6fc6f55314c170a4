"""The door for files from outside: regular files of a stated size, one error for any failure; TOML.

A reader takes its bytes from ``input_bytes``, which raises nothing but OSError, and parses them within
``failures_as``, which turns whatever the parser raises into the reader's own error.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BufferedReader
from pathlib import Path

from core.message import CodedError, Message

MB = 1024 * 1024
# A pipe without a writer would keep whoever opens it; a terminal is not to become the one of this process.
_FLAGS = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)


class NotAFileError(OSError):
    """The name is that of a folder, a device, a pipe or a socket."""


class TooLargeError(OSError):
    """The file has more bytes than any of its kind."""


def open_input(path: Path, most: int | None = None) -> BufferedReader:
    """Open a regular file of at most ``most`` bytes without waiting for it. Raises OSError alone.

    Without ``most`` the file may have any size: the caller reads a part of it.
    """
    try:
        file = open(path, "rb", opener=lambda name, flags: os.open(name, flags | _FLAGS))  # noqa: SIM115
    except IsADirectoryError as error:
        raise NotAFileError(errno.EINVAL, "this path is a folder, not a file", str(path)) from error
    except ValueError as error:  # a zero byte in the name
        raise OSError(errno.EINVAL, "a file cannot have this name", str(path)) from error
    try:
        _check(path, os.fstat(file.fileno()), most)
    except BaseException:
        file.close()
        raise
    return file


def _check(path: Path, status: os.stat_result, most: int | None) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise NotAFileError(errno.EINVAL, "this path is a device or a pipe, not a file", str(path))
    if most is not None and status.st_size > most:
        raise _too_large(path, most)


def input_bytes(path: Path, most: int) -> bytes:
    """Return what a regular file of at most ``most`` bytes holds. Raises OSError alone."""
    with open_input(path, most) as file:
        data = file.read(most + 1)
    if len(data) > most:  # another process is still writing it, or its file system does not know its size
        raise _too_large(path, most)
    return data


def input_text(path: Path, most: int, encoding: str = "utf-8") -> str:
    """Return the text of such a file with ``\\n`` as its line ends. Raises OSError, UnicodeDecodeError."""
    return input_bytes(path, most).decode(encoding).replace("\r\n", "\n")


def _too_large(path: Path, most: int) -> TooLargeError:
    return TooLargeError(
        errno.EINVAL, Message("the file is larger than {most_bytes} MB", most_bytes=most // MB), str(path)
    )


@contextmanager
def failures_as(refusal: Callable[[Exception], Exception]) -> Iterator[None]:
    """Raise ``refusal(error)`` instead of any error of a parser; errors with a code are sentences already."""
    try:
        yield
    except CodedError:
        raise
    except Exception as error:
        raise refusal(error) from error


def toml_tables(text: str) -> dict[str, object]:
    """Return the tables of a TOML text. Raises ValueError alone, with the cause and, if known, the place."""
    import tomllib  # noqa: PLC0415  few of those who open files read TOML

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise ValueError("brackets are nested too deeply; remove the inner ones") from error
    except ValueError as error:  # Python's own words for an integer that it does not convert
        raise ValueError("a whole number has too many digits; shorten it") from error
