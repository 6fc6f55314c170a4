"""The scope's ring file, which preserves the samples of the last minutes on disk after a crash.

The file has its full size from the start, so a disk that becomes full later does not affect it. The file is
written instead of memory-mapped, because a failing disk then raises an error instead of ending the process.
Rows are counted after they are written. Rows that were being written when the process ended are not read.
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

from core.file_lock import lock_file
from core.input_file import convert_exceptions, open_input_file
from core.message import Message
from core.records.record import (
    MAX_RECORD_BYTES,
    FloatArray,
    InconsistentRecordError,
    RecordError,
    ScopeRecord,
    check_record,
    make_damage_error,
    why,
)
from core.records.record_ring import RingLayout, RowBuffer, ScopeRing, make_record, select_valid_rows

_MAGIC = b"TurnDesk ring\n"
_VERSION = 1
_START = struct.Struct("<14sHII")  # magic, version, size of the description, size of the header in bytes
# numbers of rows started and completed, for the samples and then for the ticks
_COUNTS = struct.Struct("<QQ")
_PAGE = 4096
_CHUNK = 1 << 20


def _head(recorded: RingLayout, ring: ScopeRing) -> bytes:
    description = {
        "axes": dict(recorded.is_rotary_by_axis),
        "inputs": recorded.input_names,
        "outputs": recorded.output_names,
        "rate": recorded.sampling_rate_hz,
        "began": recorded.clock_zero_utc_s,
        "machine": recorded.machine_name,
        "states": recorded.state_names,
        "lasts": recorded.duration_s,
        "rooms": [ring.samples.capacity, ring.ticks.capacity],
    }
    text = json.dumps(description).encode()
    size = -(-(_START.size + len(text) + 2 * _COUNTS.size) // _PAGE) * _PAGE
    head = _START.pack(_MAGIC, _VERSION, len(text), size) + text
    return head + bytes(size - len(head))


class RingFile:
    """The file of a ring on disk, created in full size and locked by the only process that writes it.

    The constructor and ``write_rows`` raise RecordError if the file cannot be written. The constructor also
    raises RecordError if another process has locked the file.
    """

    def __init__(self, path: Path, ring: ScopeRing) -> None:
        self.path, self._ring = path, ring
        head = _head(ring.layout, ring)
        self._head = len(head)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
        except OSError as error:
            raise why(path, error) from error
        try:
            _lock(self._file, path)
            os.ftruncate(self._file, 0)  # only after the lock, when no other process writes the file
            _allocate(self._file, len(head) + ring.samples.array.nbytes + ring.ticks.array.nbytes)
            _write(self._file, head, 0)
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._file, 0)
            os.close(self._file)
            raise why(path, error) from error
        except RecordError:
            os.close(self._file)
            raise

    def write_rows(self, rows: RowBuffer, parts: list[tuple[int, FloatArray]]) -> None:
        """Write rows that were appended to the ring, and then count them.

        Raises RecordError if the file cannot be written.
        """
        first = rows is self._ring.samples
        start = self._head if first else self._head + self._ring.samples.array.nbytes
        counts = self._head - (2 if first else 1) * _COUNTS.size
        line = rows.array.shape[1] * 8
        before = rows.completed_row_count - sum(len(part) for _, part in parts)
        try:
            _write(self._file, _COUNTS.pack(rows.completed_row_count, before), counts)
            for slot, part in parts:
                _write(self._file, np.ascontiguousarray(part, dtype="<f8").tobytes(), start + slot * line)
            _write(self._file, _COUNTS.pack(rows.completed_row_count, rows.completed_row_count), counts)
        except OSError as error:
            raise why(self.path, error) from error

    def close(self) -> None:
        """Close the file without deleting its contents."""
        os.close(self._file)


def _lock(file: int, path: Path) -> None:
    """Lock the file. Raises RecordError if another process has locked it."""
    try:
        lock_file(file)
    except OSError as error:
        raise RecordError(
            Message("{path} is being written by another TurnDesk process", path=path), "in-use"
        ) from error


def _allocate(file: int, size: int) -> None:
    """Allocate the full size of the file in advance.

    Recording can then continue even if the disk becomes full later.
    """
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


# files of the operator screen, for the present start and for the previous one
CURRENT_RING_NAME, PREVIOUS_RING_NAME = "now.ring", "before.ring"
RUN_RING_NAME = "run.ring"  # file of the last run without the operator screen


def create_ring_file(folder: Path, name: str, ring: ScopeRing) -> RingFile:
    """Create the ring file for this start of TurnDesk.

    The previous file of the operator screen is renamed to ``PREVIOUS_RING_NAME``, unless another process is
    writing it. Raises RecordError if the file cannot be created or another process has locked it.
    """
    with suppress(OSError):
        if name == CURRENT_RING_NAME and _free(folder / CURRENT_RING_NAME):
            (folder / CURRENT_RING_NAME).replace(folder / PREVIOUS_RING_NAME)
    return RingFile(folder / name, ring)


def _free(path: Path) -> bool:
    """Return whether a ring file is free, because no other process is writing it.

    Raises OSError if the file cannot be opened.
    """
    file = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
    try:
        _lock(file, path)
    except RecordError:
        return False
    finally:
        os.close(file)
    return True


# --- Reading the file, also while it is being written ---------------------------------------------------


def is_ring_file(path: Path) -> bool:
    """Return whether a file starts with the signature of a ring file.

    The result is False if the file cannot be read.
    """
    try:
        with open_input_file(path) as file:
            return file.read(len(_MAGIC)) == _MAGIC
    except OSError:
        return False


@dataclass(frozen=True, slots=True)
class _RingHeader:
    """The data in the header of a ring file that was opened for reading."""

    ring_layout: RingLayout
    row_capacities: tuple[int, int]
    header_size: int


def read_ring_file(path: Path, start_time_s: float = -np.inf, end_time_s: float = np.inf) -> ScopeRecord:
    """Return the record in a ring file, even while the file is being written.

    Raises RecordError if the file cannot be read or is damaged.
    """
    with convert_exceptions(partial(make_damage_error, path)):
        return check_record(_read_ring(path, start_time_s, end_time_s))


def _read_ring(path: Path, begin: float, end: float) -> ScopeRecord:
    try:
        with open_input_file(path, MAX_RECORD_BYTES) as file:
            data = file.read(_START.size)
            found = _described(path, data, file.read)
            file.seek(found.header_size - 2 * _COUNTS.size)
            counts = list(_COUNTS.iter_unpack(file.read(2 * _COUNTS.size)))
            rings = list(_rings(path, found, file.read))
            file.seek(found.header_size - 2 * _COUNTS.size)
            now = list(_COUNTS.iter_unpack(file.read(2 * _COUNTS.size)))
    except OSError as error:
        raise why(path, error) from error
    samples, ticks = (
        _unrolled(data, whole, begun) for data, (_, whole), (begun, _) in zip(rings, counts, now, strict=True)
    )
    times = samples[:, 0]
    return make_record(found.ring_layout, samples[(times >= begin) & (times <= end)], ticks)


def _described(path: Path, start: bytes, read: Callable[[int], bytes]) -> _RingHeader:
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
    if not _START.size + length + 2 * _COUNTS.size <= head <= MAX_RECORD_BYTES:
        raise InconsistentRecordError("the file header has an invalid length")
    try:
        description = json.loads(read(length))
        recorded = RingLayout(
            {str(name): bool(rotary) for name, rotary in description["axes"].items()},
            tuple(map(str, description["inputs"])),
            tuple(map(str, description["outputs"])),
            float(description["rate"]),
            float(description["began"]),
            str(description["machine"]),
            tuple(map(str, description["states"])),
            float(description["lasts"]),
        )
        samples, ticks = (int(room) for room in description["rooms"])
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise RecordError(
            Message("{path} is damaged at the start and cannot be read", path=path), "damaged"
        ) from error
    return _RingHeader(recorded, (samples, ticks), head)


def _rings(path: Path, found: _RingHeader, read: Callable[[int], bytes]) -> Iterator[FloatArray]:
    widths = (found.ring_layout.sample_width, found.ring_layout.tick_width)
    for room, width in zip(found.row_capacities, widths, strict=True):
        size = room * (width + 1) * 8
        if not 0 < size <= MAX_RECORD_BYTES:
            raise InconsistentRecordError(
                Message("the row count in the file header, {room}, is not valid", room=room)
            )
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
    """Return the complete rows of a ring buffer in chronological order.

    Rows that were being written during reading or at a crash are omitted.
    """
    room = len(data)
    first = max(0, whole - room)
    at = first % room
    rows = np.concatenate((data[at:], data[:at]))[: whole - first]
    lost = max(0, begun - room - first)
    return select_valid_rows(rows[lost:], first + lost)
