"""The ring's file: the last minutes of samples on the disk, which outlive the process that writes them.

It has its whole size from the beginning, so a disk that becomes full later does not end it. It is written,
not mapped: a disk that fails is an error here, where a mapped page would end the process. Rows are counted
once they are there; those of a writer that ended in between are not read.
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from core.file_lock import lock
from core.input_file import failures_as, open_input
from core.message import Message
from core.records.record import (
    MOST_BYTES,
    FloatArray,
    Record,
    RecordError,
    UnsoundError,
    checked_record,
    damage,
    why,
)
from core.records.record_ring import Recorded, Ring, Rows, record_of, sound

_MAGIC = b"TurnDesk ring\n"
_VERSION = 1
_START = struct.Struct("<14sHII")  # magic, version, bytes of the description, bytes of the whole head
_COUNTS = struct.Struct("<QQ")  # rows begun, rows whole: of the samples, then of the ticks
_PAGE = 4096
_CHUNK = 1 << 20


def _head(recorded: Recorded, ring: Ring) -> bytes:
    told = {
        "axes": dict(recorded.axes),
        "inputs": recorded.inputs,
        "outputs": recorded.outputs,
        "rate": recorded.rate,
        "began": recorded.began,
        "machine": recorded.machine,
        "states": recorded.states,
        "lasts": recorded.lasts,
        "rooms": [ring.samples.room, ring.ticks.room],
    }
    text = json.dumps(told).encode()
    size = -(-(_START.size + len(text) + 2 * _COUNTS.size) // _PAGE) * _PAGE
    head = _START.pack(_MAGIC, _VERSION, len(text), size) + text
    return head + bytes(size - len(head))


class RingFile:
    """The ring on the disk, in full size from the beginning. One process writes it: it has a lock.

    Raises RecordError when it cannot be had; ``write`` raises it, too.
    """

    def __init__(self, path: Path, ring: Ring) -> None:
        self.path, self._ring = path, ring
        head = _head(ring.recorded, ring)
        self._head = len(head)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
        except OSError as error:
            raise why(path, error) from error
        try:
            _lock(self._file, path)
            os.ftruncate(self._file, 0)  # behind the lock: it is ours
            _allocate(self._file, len(head) + ring.samples.data.nbytes + ring.ticks.data.nbytes)
            _write(self._file, head, 0)
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._file, 0)
            os.close(self._file)
            raise why(path, error) from error
        except RecordError:
            os.close(self._file)
            raise

    def write(self, rows: Rows, parts: list[tuple[int, FloatArray]]) -> None:
        """Rows that have gone into the ring; counted once they are there."""
        first = rows is self._ring.samples
        start = self._head if first else self._head + self._ring.samples.data.nbytes
        counts = self._head - (2 if first else 1) * _COUNTS.size
        line = rows.data.shape[1] * 8
        before = rows.whole - sum(len(part) for _, part in parts)
        try:
            _write(self._file, _COUNTS.pack(rows.whole, before), counts)
            for slot, part in parts:
                _write(self._file, np.ascontiguousarray(part, dtype="<f8").tobytes(), start + slot * line)
            _write(self._file, _COUNTS.pack(rows.whole, rows.whole), counts)
        except OSError as error:
            raise why(self.path, error) from error

    def close(self) -> None:
        """Let it go; what is written stays."""
        os.close(self._file)


def _lock(file: int, path: Path) -> None:
    """Raises RecordError while another process has it."""
    try:
        lock(file)
    except OSError as error:
        raise RecordError(
            Message("{path} is being written by another TurnDesk process", path=path), "in-use"
        ) from error


def _allocate(file: int, size: int) -> None:
    """All of it now: a disk that becomes full later does not end the record."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
        return
    for start in range(0, size, _CHUNK):
        _write(file, bytes(min(_CHUNK, size - start)), start)


def _write(file: int, data: bytes, at: int) -> None:
    view = memoryview(data)
    while view:
        if hasattr(os, "pwrite"):
            done = os.pwrite(file, view, at)
        else:
            os.lseek(file, at, os.SEEK_SET)
            done = os.write(file, view)
        view, at = view[done:], at + done


NOW, LAST = "now.ring", "before.ring"  # of the screen: of this start, and of the one before
RUN = "run.ring"  # of the last run without a screen


def new_ring(folder: Path, name: str, ring: Ring) -> RingFile:
    """The file of this start; the screen's last one stays beside it. Raises RecordError."""
    with suppress(OSError):
        if name == NOW and _free(folder / NOW):
            (folder / NOW).replace(folder / LAST)
    return RingFile(folder / name, ring)


def _free(path: Path) -> bool:
    """Whether no other process writes it. Raises OSError."""
    file = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
    try:
        _lock(file, path)
    except RecordError:
        return False
    finally:
        os.close(file)
    return True


# --- Reading it, also while it is written ---------------------------------------------------------------


def is_ring(path: Path) -> bool:
    """Whether a file begins as a ring does."""
    try:
        with open_input(path) as file:
            return file.read(len(_MAGIC)) == _MAGIC
    except OSError:
        return False


@dataclass(frozen=True, slots=True)
class _Found:
    """A ring's file: what it says of itself."""

    recorded: Recorded
    rooms: tuple[int, int]
    head: int


def read_ring(path: Path, begin: float = -np.inf, end: float = np.inf) -> Record:
    """The record of a ring's file, also of one that is being written. Raises RecordError."""
    with failures_as(partial(damage, path)):
        return checked_record(_read_ring(path, begin, end))


def _read_ring(path: Path, begin: float, end: float) -> Record:
    try:
        with open_input(path, MOST_BYTES) as file:
            data = file.read(_START.size)
            found = _described(path, data, file.read)
            file.seek(found.head - 2 * _COUNTS.size)
            counts = list(_COUNTS.iter_unpack(file.read(2 * _COUNTS.size)))
            rings = list(_rings(path, found, file.read))
            file.seek(found.head - 2 * _COUNTS.size)
            now = list(_COUNTS.iter_unpack(file.read(2 * _COUNTS.size)))
    except OSError as error:
        raise why(path, error) from error
    samples, ticks = (
        _unrolled(data, whole, begun) for data, (_, whole), (begun, _) in zip(rings, counts, now, strict=True)
    )
    times = samples[:, 0]
    return record_of(found.recorded, samples[(times >= begin) & (times <= end)], ticks)


def _described(path: Path, start: bytes, read: Callable[[int], bytes]) -> _Found:
    if len(start) < _START.size or not start.startswith(_MAGIC):
        raise RecordError(
            Message("{path} is not a TurnDesk record; choose a file in the records folder", path=path),
            "not-a-record",
        )
    _, version, length, head = _START.unpack(start)
    if version > _VERSION:
        raise RecordError(
            Message(
                "{path} has file version {version}, which this TurnDesk cannot read; "
                "open it with a newer TurnDesk",
                path=path,
                version=version,
            ),
            "newer-version",
        )
    if not _START.size + length + 2 * _COUNTS.size <= head <= MOST_BYTES:
        raise UnsoundError("the file header has an invalid length")
    try:
        told = json.loads(read(length))
        recorded = Recorded(
            {str(name): bool(rotary) for name, rotary in told["axes"].items()},
            tuple(map(str, told["inputs"])),
            tuple(map(str, told["outputs"])),
            float(told["rate"]),
            float(told["began"]),
            str(told["machine"]),
            tuple(map(str, told["states"])),
            float(told["lasts"]),
        )
        samples, ticks = (int(room) for room in told["rooms"])
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise RecordError(
            Message("{path} is damaged at the start and cannot be read", path=path), "damaged"
        ) from error
    return _Found(recorded, (samples, ticks), head)


def _rings(path: Path, found: _Found, read: Callable[[int], bytes]) -> Iterator[FloatArray]:
    widths = (found.recorded.sample_width, found.recorded.tick_width)
    for room, width in zip(found.rooms, widths, strict=True):
        size = room * (width + 1) * 8
        if not 0 < size <= MOST_BYTES:
            raise UnsoundError(Message("the row count in the file header, {room}, is not valid", room=room))
        data = read(size)
        if len(data) != size:
            raise RecordError(
                Message(
                    "{path} is incomplete, with {data_count} of {size} bytes; it cannot be read",
                    path=path,
                    data_count=len(data),
                    size=size,
                ),
                "cut-off",
            )
        yield np.frombuffer(data, dtype="<f8").reshape(room, width + 1)


def _unrolled(data: FloatArray, whole: int, begun: int) -> FloatArray:
    """Rows in their order; without those that have been begun since, or were when the writer ended."""
    room = len(data)
    first = max(0, whole - room)
    at = first % room
    rows = np.concatenate((data[at:], data[:at]))[: whole - first]
    lost = max(0, begun - room - first)
    return sound(rows[lost:], first + lost)
