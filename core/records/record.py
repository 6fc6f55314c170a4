"""A scope record: samples of a period of time, derived quantities, and errors of record files.

Channels have descriptive names, such as ``X demand``, ``X actual``, ``X following error`` (mm, or degrees
for rotary axes), ``spindle command``, ``spindle speed`` (rpm) and ``feed override``.
``list_machine_channels`` lists all channels.
"""

from __future__ import annotations

import errno
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.input_file import BYTES_PER_MB, TooLargeError
from core.message import CodedError, Message

FloatArray = npt.NDArray[np.float64]
_LATEST = 250_000_000_000.0  # s since 1970, in the year 9892, near the end of Python's calendar
# Channels of each axis, named by the axis letter followed by these words.
AXIS_CHANNELS = (("demand", ""), ("actual", ""), ("following error", ""), ("load", "%"))
_FULL = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG})
MAX_RECORD_BYTES = 512 * BYTES_PER_MB
"""Maximum size of a record in bytes, packed or unpacked. Five minutes at 1 kHz need 50 MB."""

DEFAULT_VELOCITY_SPAN_S = 0.008  # s
ACCELERATION_SPAN_S = 0.032  # s
RIPPLE_SPAN_S = 0.5  # s, the span of the mean speed from which ripple is calculated


class InconsistentRecordError(ValueError):
    """Error raised if the contents of a record file are inconsistent, with the cause as its text."""


class Channel(NamedTuple):
    """A recorded quantity with its name and internal unit.

    ``logic`` means that the values are 0 (off) and 1 (on).
    """

    name: str
    unit: str
    logic: bool = False


# Channels of the whole machine.
MACHINE_CHANNELS = (
    Channel("spindle command", "rpm"),
    Channel("spindle speed", "rpm"),  # measured
    Channel("spindle turns", "turns"),  # revolutions counted by the encoder since power-up
    Channel("spindle load", "%"),
    Channel("feed override", ""),
    Channel("spindle override", ""),
    Channel("queue", "s"),  # duration of the motion that the driver buffers
    Channel("lateness", "s"),  # delay of the control's tick
    Channel("line", ""),  # source line that is executed, or 0
    Channel("block", ""),  # elementary block that is executed, or 0
    # index of the control's state in ``about["states"]``, whose entries are separated by "|"
    Channel("state", ""),
)


def list_machine_channels(
    axes: Mapping[str, bool], inputs: tuple[str, ...], outputs: tuple[str, ...]
) -> tuple[Channel, ...]:
    """Return all channels that are recorded for a machine.

    ``axes`` maps each axis letter to whether the axis is rotary.
    """
    of_axes = [
        Channel(f"{letter} {name}", unit or ("deg" if rotary else "mm"))
        for letter, rotary in axes.items()
        for name, unit in AXIS_CHANNELS
    ]
    logic = [Channel(Message("input {name}", name=name), "", True) for name in inputs]
    logic += [Channel(Message("output {name}", name=name), "", True) for name in outputs]
    return (*of_axes, *MACHINE_CHANNELS, *logic)


@dataclass(frozen=True, slots=True)
class ScopeRecord:
    """Samples of a period of time; values that a driver does not report are NaN.

    - ``times_s`` (n,) are seconds of the monotonic clock in ascending order.
    - ``values_by_channel`` has an array (n,) for each channel name.
    - ``start_time_utc_s`` is the time of the first sample in seconds since 1970.
    - ``sampling_rate_hz`` is the driver's sampling rate in samples per second.

    A sample of a control channel, such as the feed override, has the value at the last tick of the control.
    """

    channels: tuple[Channel, ...]
    times_s: FloatArray
    values_by_channel: Mapping[str, FloatArray]
    start_time_utc_s: float
    sampling_rate_hz: float
    about: Mapping[str, str] = field(default_factory=dict)  # machine, program and alarm as text

    def select_time_range(self, start_time_s: float, end_time_s: float) -> ScopeRecord:
        """Return the samples between two times, inclusive.

        ``start_time_s`` and ``end_time_s`` are in seconds of the monotonic clock.
        """
        first, last = np.searchsorted(self.times_s, (start_time_s, np.nextafter(end_time_s, np.inf)))
        cut = slice(int(first), int(last))
        started = self.start_time_utc_s + (
            float(self.times_s[first]) - float(self.times_s[0]) if first < last else 0.0
        )
        columns = {name: column[cut] for name, column in self.values_by_channel.items()}
        return ScopeRecord(
            self.channels, self.times_s[cut], columns, started, self.sampling_rate_hz, self.about
        )


def _is_unicode(text: str) -> bool:
    """Return whether a string is valid Unicode, so that it can be displayed and exported.

    JSON can contain unpaired surrogates, which cannot be exported.
    """
    return not any("\ud800" <= sign <= "\udfff" for sign in text)


def check_record(record: ScopeRecord) -> ScopeRecord:
    """Check a record from a file and return it with infinite values replaced by NaN.

    Raises InconsistentRecordError if the record is inconsistent.
    """
    if not 0.0 <= record.start_time_utc_s <= _LATEST:
        raise InconsistentRecordError(
            Message(
                "the start time of the scope record, {started} s after January 1, 1970, is not valid",
                started=f"{record.start_time_utc_s:g}",
            )
        )
    if not 0.0 <= record.sampling_rate_hz < np.inf:
        raise InconsistentRecordError(
            Message(
                "the sampling rate of {rate} samples per second is not valid",
                rate=f"{record.sampling_rate_hz:g}",
            )
        )
    if not all(text.isprintable() for channel in record.channels for text in channel[:2]):
        raise InconsistentRecordError("a channel name is not text")
    if not all(_is_unicode(text) for each in record.about.items() for text in each):
        raise InconsistentRecordError("the description in the file is not text")
    if not np.isfinite(record.times_s).all() or (np.diff(record.times_s) < 0.0).any():
        raise InconsistentRecordError("the sample times do not increase")
    known = {
        name: np.where(np.isinf(column), np.nan, column) if np.isinf(column).any() else column
        for name, column in record.values_by_channel.items()
    }
    return replace(record, values_by_channel=known)


class RecordError(CodedError):
    """Error raised if a record file cannot be used; the text names the file, the reason and a remedy."""


class AnalysisError(CodedError):
    """Error raised if a record lacks data that an analysis needs.

    The text names the missing data and a remedy.
    """


def make_damage_error(path: Path, error: Exception) -> RecordError:
    """Return a RecordError for a file with damaged contents."""
    if isinstance(error, InconsistentRecordError):
        return RecordError(
            Message("{path} is damaged ({error}); open another scope record", path=path, error=error),
            "damaged",
        )
    return RecordError(Message("{path} is damaged; open another scope record", path=path), "damaged")


def why(path: Path, error: OSError) -> RecordError:
    """Return a RecordError with the cause of an OSError of the file ``path``."""
    if isinstance(error, TooLargeError):
        return RecordError(
            Message(
                "{path}: {cause}, so the file is not a scope record; check the file name",
                path=path,
                cause=error.strerror,
            ),
            "too-large",
        )
    if error.errno in _FULL:
        return RecordError(Message("{path}: the disk is full; free up disk space", path=path), "disk-full")
    if isinstance(error, FileNotFoundError):
        return RecordError(Message("{path}: file not found", path=path), "not-found")
    return RecordError(Message("{path}: {cause}", path=path, cause=error.strerror or error), "unusable")


def calculate_velocity(
    times: FloatArray, position: FloatArray, span_s: float = DEFAULT_VELOCITY_SPAN_S
) -> FloatArray:
    """Return the mean velocity over ``span_s`` seconds, in units per second.

    The span is at least two sample intervals. The result is exact for constant acceleration. The amplitude
    of a sine of ω rad/s is multiplied by sin(ω·span/2)/(ω·span/2). The values of the first and the last
    half span are NaN.
    """
    k = _half(times, span_s)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        position_change, took = position[2 * k :] - position[: -2 * k], times[2 * k :] - times[: -2 * k]
        found[k:-k] = position_change / took
    return found


def calculate_acceleration(
    times: FloatArray, position: FloatArray, span_s: float = ACCELERATION_SPAN_S
) -> FloatArray:
    """Return the mean acceleration over ``span_s`` seconds, in units per second squared.

    The result is the change of the mean velocity from the first to the second half of the span. With h =
    span/2 and evenly spaced samples, it is (p(t+h) − 2p(t) + p(t−h))/h². It is exact for constant
    acceleration. The amplitude of a sine is multiplied by (sin(ωh/2)/(ωh/2))². The values of the first and
    the last half span are NaN.
    """
    k = _half(times, span_s)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        ahead, first_half_s = times[2 * k :] - times[k:-k], times[k:-k] - times[: -2 * k]
        after = (position[2 * k :] - position[k:-k]) / ahead
        before = (position[k:-k] - position[: -2 * k]) / first_half_s
        found[k:-k] = 2.0 * (after - before) / (ahead + first_half_s)
    return found


def calculate_speed_ripple(times: FloatArray, speed: FloatArray, span_s: float = RIPPLE_SPAN_S) -> FloatArray:
    """Return the speed ripple: the speed minus its mean over ``span_s`` seconds.

    If the span contains a whole number of ripple periods, the mean contains no ripple. The values in the
    first and the last half span are NaN.
    """
    k = _half(times, span_s)
    found = np.full(len(times), np.nan)
    known = np.isfinite(speed)
    if len(times) > 2 * k:
        total = np.concatenate([[0.0], np.cumsum(np.where(known, speed, 0.0))])
        count = np.concatenate([[0], np.cumsum(known)])
        n = count[2 * k + 1 :] - count[: -2 * k - 1]
        mean = (total[2 * k + 1 :] - total[: -2 * k - 1]) / np.maximum(n, 1)
        found[k:-k] = np.where(n == 2 * k + 1, speed[k:-k] - mean, np.nan)
    return found


def _half(times: FloatArray, span: float) -> int:
    """Return the number of samples in half the span, at least 1.

    The number is calculated from the median sample interval.
    """
    if len(times) < 2:
        return 1
    step = float(np.median(np.diff(times)))
    return max(1, round(0.5 * span / step)) if step > 0.0 else 1
