"""Functions that read input files of limited size and parse TOML, with uniform errors.

A reader calls ``read_input_bytes``, which raises only OSError, and parses the data within
``convert_exceptions``, which converts all exceptions of the parser into the reader's own error.
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

BYTES_PER_MB = 1024 * 1024
_BYTES_PER_KB = 1024
# Opening a pipe without a writer must not block. A terminal must not become the process's controlling
# terminal.
_FLAGS = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)


class NotAFileError(OSError):
    """An error raised if the path is a folder, a device, a pipe or a socket."""


class TooLargeError(OSError):
    """An error raised if an input file is larger than the limit for its kind of file."""


def open_input_file(path: Path, max_bytes: int | None = None) -> BufferedReader:
    """Open a regular file without blocking, if it has at most ``max_bytes`` bytes.

    If ``max_bytes`` is None, the size is not limited, for callers that read only part of the file. Raises
    only OSError.
    """
    try:
        file = open(path, "rb", opener=lambda name, flags: os.open(name, flags | _FLAGS))  # noqa: SIM115
    except IsADirectoryError as error:
        raise NotAFileError(errno.EINVAL, "this path is a folder, not a file", str(path)) from error
    except ValueError as error:  # the name contains a zero byte
        raise OSError(errno.EINVAL, "a file cannot have this name", str(path)) from error
    try:
        _check(path, os.fstat(file.fileno()), max_bytes)
    except BaseException:
        file.close()
        raise
    return file


def _check(path: Path, status: os.stat_result, most: int | None) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise NotAFileError(errno.EINVAL, "this path is a device or a pipe, not a file", str(path))
    if most is not None and status.st_size > most:
        raise _too_large(path, most)


def read_input_bytes(path: Path, max_bytes: int) -> bytes:
    """Return the contents of a regular file of at most ``max_bytes`` bytes. Raises only OSError."""
    with open_input_file(path, max_bytes) as file:
        data = file.read(max_bytes + 1)
    # another process is still writing the file, or its file system does not report its size
    if len(data) > max_bytes:
        raise _too_large(path, max_bytes)
    return data


def read_input_text(path: Path, max_bytes: int, encoding: str = "utf-8") -> str:
    r"""Return the text of a regular file with ``\n`` as line ends. Raises OSError or UnicodeDecodeError."""
    return read_input_bytes(path, max_bytes).decode(encoding).replace("\r\n", "\n")


def _too_large(path: Path, most: int) -> TooLargeError:
    return TooLargeError(
        errno.EINVAL,
        Message("the file is larger than {limit}", limit=format_file_size(most)),
        str(path),
    )


def format_file_size(size_bytes: int) -> str:
    """Return a size with its unit, such as 16 MB or 64 KB."""
    for unit_bytes, unit in ((BYTES_PER_MB, "MB"), (_BYTES_PER_KB, "KB")):
        if size_bytes >= unit_bytes:
            return f"{size_bytes / unit_bytes:.4g} {unit}"
    return f"{size_bytes} bytes"


@contextmanager
def convert_exceptions(make_error: Callable[[Exception], Exception]) -> Iterator[None]:
    """Convert every parser exception except a ``CodedError`` into ``make_error(error)``."""
    try:
        yield
    except CodedError:
        raise
    except Exception as error:
        raise make_error(error) from error


def parse_toml(text: str) -> dict[str, object]:
    """Parse a TOML text and return its tables.

    Raises only ValueError, with the cause and, if known, the location.
    """
    import tomllib  # noqa: PLC0415  few of those who open files read TOML

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise ValueError("brackets are nested too deeply; remove the inner ones") from error
    except ValueError as error:  # Python rejects integers with too many digits
        raise ValueError("a whole number has too many digits; shorten it") from error
