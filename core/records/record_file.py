"""Record files of the scope: saving, opening and CSV export.

A file is an npz archive with one column for each channel, the times, and the description as JSON.
"""

from __future__ import annotations

import io
import json
import math
import warnings
import zipfile
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path

import numpy as np

from core.file_replacement import replace_atomically
from core.input_file import BYTES_PER_MB, convert_exceptions, read_input_bytes
from core.message import Message
from core.records.record import (
    MAX_RECORD_BYTES,
    Channel,
    FloatArray,
    InconsistentRecordError,
    RecordError,
    ScopeRecord,
    check_record,
    make_damage_error,
    why,
)
from core.records.ring_file import is_ring_file, read_ring_file

RECORD_SUFFIX = ".scope"
_VERSION = 1
_ABOUT = "about"
_UNKNOWN = 255  # the unknown value of a logic channel, stored as a byte like 0 and 1
_ROWS = 2000  # CSV rows written at a time


def save_record(record: ScopeRecord, path: Path) -> None:
    """Write a record file completely or not at all.

    Raises RecordError if the file cannot be written.
    """
    header = {
        "version": _VERSION,
        "started": record.start_time_utc_s,
        "rate": record.sampling_rate_hz,
        "about": dict(record.about),
        "channels": [list(channel) for channel in record.channels],
    }
    columns = {f"column{i}": _packed(record, channel) for i, channel in enumerate(record.channels)}
    columns |= {"times": record.times_s, _ABOUT: np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)}
    unfinished = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with unfinished.open("wb") as file:
            np.savez_compressed(file, **columns)  # type: ignore[arg-type]  # its stubs take one for an option
        replace_atomically(unfinished, path)
    except OSError as error:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
        raise why(path, error) from error


def _packed(record: ScopeRecord, channel: Channel) -> np.ndarray[tuple[int, ...], np.dtype[np.generic]]:
    column = record.values_by_channel[channel.name]
    if not channel.logic:
        return column
    return np.where(np.isnan(column), _UNKNOWN, column).astype(np.uint8)


def open_record(path: Path) -> ScopeRecord:
    """Return the record in a record file, or all samples in a ring file.

    Raises RecordError if the file cannot be read or is damaged.
    """
    if is_ring_file(path):
        return read_ring_file(path)
    try:
        data = read_input_bytes(path, MAX_RECORD_BYTES)
    except OSError as error:
        raise why(path, error) from error
    with convert_exceptions(partial(make_damage_error, path)):
        return check_record(_read(path, io.BytesIO(data)))


def _read(path: Path, data: io.BytesIO) -> ScopeRecord:
    if not zipfile.is_zipfile(data):
        part = data.getvalue()[:2] == b"PK"
        raise RecordError(
            Message("{path} is incomplete and cannot be read", path=path)
            if part
            else (
                Message(
                    "{path} is not a scope record; choose a file in the records folder that ends in "
                    "{ending} or .ring",
                    path=path,
                    ending=RECORD_SUFFIX,
                )
            ),
            "cut-off" if part else "not-a-record",
        )
    _check_size(data)
    data.seek(0)
    with warnings.catch_warnings(), np.load(data, allow_pickle=False) as archive:
        warnings.simplefilter("error")  # numpy warns about arrays that it did not write
        if _ABOUT not in archive.files:
            raise RecordError(
                Message(
                    "{path} is not a scope record; choose a file that ends in {ending}",
                    path=path,
                    ending=RECORD_SUFFIX,
                ),
                "not-a-record",
            )
        header = json.loads(archive[_ABOUT].tobytes())
        version = header["version"]
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
        return _record(header, lambda name: archive[name])


def _check_size(data: io.BytesIO) -> None:
    """Check that an archive is not far larger than any record, before it is unpacked.

    Raises InconsistentRecordError if the archive is too large.
    """
    with zipfile.ZipFile(data) as archive:
        size = sum(each.file_size for each in archive.infolist())
    if size > MAX_RECORD_BYTES:
        raise InconsistentRecordError(
            Message(
                "the uncompressed file is larger than {limit_mb} MB",
                limit_mb=MAX_RECORD_BYTES // BYTES_PER_MB,
            )
        )


def _record(header: dict[str, object], column: Callable[[str], object]) -> ScopeRecord:
    """Return the record with the given description and columns.

    Raises InconsistentRecordError if they are inconsistent, and ValueError, KeyError or TypeError if they
    are malformed.
    """
    channels, about = header["channels"], header["about"]
    if not isinstance(channels, list) or not isinstance(about, dict):
        raise InconsistentRecordError("the description in the file has an unknown format")
    made = tuple(Channel(str(name), str(unit), bool(logic)) for name, unit, logic in channels)
    times = np.asarray(column("times"), dtype=np.float64)
    columns: dict[str, FloatArray] = {}
    for i, channel in enumerate(made):
        found = np.asarray(column(f"column{i}"), dtype=np.float64)
        if found.shape != times.shape or times.ndim != 1:
            raise InconsistentRecordError(
                Message(
                    "channel {channel} has {size} samples instead of {size2}",
                    channel=channel.name,
                    size=found.size,
                    size2=times.size,
                )
            )
        columns[channel.name] = np.where(found == _UNKNOWN, np.nan, found) if channel.logic else found
    started, rate = header["started"], header["rate"]
    if not isinstance(started, int | float) or not isinstance(rate, int | float):
        raise InconsistentRecordError("the start time of the record is missing")
    words = {str(name): str(text) for name, text in about.items()}
    return ScopeRecord(made, times, columns, float(started), float(rate), words)


def write_csv_lines(record: ScopeRecord, write: Callable[[str], object]) -> None:
    """Write a record as CSV lines.

    Times are in seconds from the start of the record, and unknown values are empty fields.
    """
    names = [
        Message("{item} [{unit}]", item=each.name, unit=each.unit) if each.unit else each.name
        for each in record.channels
    ]
    write(",".join(["t [s]", *(name.replace(",", " ") for name in names)]) + "\n")
    columns = [record.values_by_channel[each.name] for each in record.channels]
    logic = [each.logic for each in record.channels]
    for at in range(0, len(record.times_s), _ROWS):
        part = [[f"{t:.6f}" for t in (record.times_s[at : at + _ROWS] - record.times_s[0]).tolist()]]
        part += [
            _texts(column[at : at + _ROWS], whole=whole) for column, whole in zip(columns, logic, strict=True)
        ]
        write("".join(",".join(row) + "\n" for row in zip(*part, strict=True)))


def save_csv(record: ScopeRecord, path: Path) -> None:
    """Write a record to a CSV file completely or not at all.

    Raises RecordError if the file cannot be written.
    """
    unfinished = path.with_name(path.name + ".part")
    try:
        with unfinished.open("w", encoding="utf-8", newline="") as file:
            write_csv_lines(record, file.write)
        replace_atomically(unfinished, path)
    except OSError as error:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
        raise why(path, error) from error


def _texts(column: FloatArray, *, whole: bool) -> list[str]:
    """Return the numbers of a CSV column as strings, either as integers or with all digits.

    Unknown values become empty strings.
    """
    if whole:
        return ["" if math.isnan(value) else str(int(value)) for value in column.tolist()]
    return ["" if math.isnan(value) else repr(value) for value in column.tolist()]
