"""A record of the scope: samples of a stretch of time, derived figures, and what is wrong with one.

Channels are named by what they are: ``X demand`` ``X actual`` ``X following error`` (mm, degrees of rotary
axes), ``spindle command`` ``spindle speed`` (rpm), ``feed override`` and so on; ``channels_of`` says all.
"""

from __future__ import annotations

import errno
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.input_file import MB, TooLargeError
from core.message import CodedError, Message

FloatArray = npt.NDArray[np.float64]
_LATEST = 250_000_000_000.0  # s since 1970, in the year 9892: calendars end soon after
# Of each axis, behind its letter.
AXIS_CHANNELS = (("demand", ""), ("actual", ""), ("following error", ""), ("load", "%"))
_FULL = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG})
MOST_BYTES = 512 * MB
"""The most that a record may have, packed or unpacked; five minutes at 1 kHz have 50 MB."""

VELOCITY_SPAN = 0.008  # s
ACCELERATION_SPAN = 0.032  # s
RIPPLE_SPAN = 0.5  # s: ripple is the speed less its mean over this


class UnsoundError(ValueError):
    """What a file says does not fit together; the text is the cause."""


class Channel(NamedTuple):
    """A figure that is recorded: its name, and its unit inside. ``logic``: it is on (1) or off (0)."""

    name: str
    unit: str
    logic: bool = False


# Of the machine as a whole.
MACHINE_CHANNELS = (
    Channel("spindle command", "rpm"),
    Channel("spindle speed", "rpm"),  # measured
    Channel("spindle turns", "turns"),  # counted by the encoder since power-up
    Channel("spindle load", "%"),
    Channel("feed override", ""),
    Channel("spindle override", ""),
    Channel("queue", "s"),  # of motion that the driver holds
    Channel("lateness", "s"),  # of the control's tick
    Channel("line", ""),  # source line that is executed, 0 none
    Channel("block", ""),  # elementary block that is executed, 0 none
    Channel("state", ""),  # of the control, counted in ``about["states"]``, which are divided by bars
)


def channels_of(
    axes: Mapping[str, bool], inputs: tuple[str, ...], outputs: tuple[str, ...]
) -> tuple[Channel, ...]:
    """Everything that is recorded of a machine. ``axes`` by letter: whether it is rotary."""
    of_axes = [
        Channel(f"{letter} {name}", unit or ("deg" if rotary else "mm"))
        for letter, rotary in axes.items()
        for name, unit in AXIS_CHANNELS
    ]
    logic = [Channel(Message("input {name}", name=name), "", True) for name in inputs]
    logic += [Channel(Message("output {name}", name=name), "", True) for name in outputs]
    return (*of_axes, *MACHINE_CHANNELS, *logic)


@dataclass(frozen=True, slots=True)
class Record:
    """Samples between two instants. What a driver does not tell is not a number (nan).

    ``times`` (n,) are seconds of the monotonic clock, rising; ``columns`` (n,) each, by the channel's name.
    ``started`` is the time of day of the first sample, seconds since 1970. ``rate`` is the samples a second
    that the driver itself gives; the control's own figures between its ticks stand as they were at the last.
    """

    channels: tuple[Channel, ...]
    times: FloatArray
    columns: Mapping[str, FloatArray]
    started: float
    rate: float
    about: Mapping[str, str] = field(default_factory=dict)  # machine, program, alarm: in words

    def between(self, begin: float, end: float) -> Record:
        """The samples from ``begin`` up to and with ``end``, seconds of the monotonic clock."""
        first, last = np.searchsorted(self.times, (begin, np.nextafter(end, np.inf)))
        cut = slice(int(first), int(last))
        started = self.started + (float(self.times[first]) - float(self.times[0]) if first < last else 0.0)
        columns = {name: column[cut] for name, column in self.columns.items()}
        return Record(self.channels, self.times[cut], columns, started, self.rate, self.about)


def _is_unicode(text: str) -> bool:
    """Return whether a text can be shown and exported: JSON may hold half a character."""
    return not any("\ud800" <= sign <= "\udfff" for sign in text)


def checked_record(record: Record) -> Record:
    """Return a record from a file, with infinite values as unknown. Raises UnsoundError."""
    if not 0.0 <= record.started <= _LATEST:
        raise UnsoundError(
            Message(
                "the start time of the scope record, {started} s after January 1, 1970, is not valid",
                started=f"{record.started:g}",
            )
        )
    if not 0.0 <= record.rate < np.inf:
        raise UnsoundError(
            Message("the sampling rate of {rate} samples per second is not valid", rate=f"{record.rate:g}")
        )
    if not all(text.isprintable() for channel in record.channels for text in channel[:2]):
        raise UnsoundError("a channel name is not text")
    if not all(_is_unicode(text) for each in record.about.items() for text in each):
        raise UnsoundError("the description in the file is not text")
    if not np.isfinite(record.times).all() or (np.diff(record.times) < 0.0).any():
        raise UnsoundError("the sample times do not increase")
    known = {
        name: np.where(np.isinf(column), np.nan, column) if np.isinf(column).any() else column
        for name, column in record.columns.items()
    }
    return replace(record, columns=known)


class RecordError(CodedError):
    """``str()`` is the sentence for whoever asked: what, where, what to do."""


class AnalysisError(CodedError):
    """``str()`` is the sentence: what the record lacks, and what to do."""


def damage(path: Path, error: Exception) -> RecordError:
    """Return the error for a file whose content is not as it was written."""
    if isinstance(error, UnsoundError):
        return RecordError(
            Message("{path} is damaged ({error}); open another scope record", path=path, error=error),
            "damaged",
        )
    return RecordError(Message("{path} is damaged; open another scope record", path=path), "damaged")


def why(path: Path, error: OSError) -> RecordError:
    """The same as a sentence."""
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


def velocity(times: FloatArray, position: FloatArray, span: float = VELOCITY_SPAN) -> FloatArray:
    """Way over time across ``span`` s, or two samples where they lie farther apart; units a second.

    Exact where the acceleration is constant. A sine of ω rad/s comes out smaller by sin(ω·span/2)/(ω·span/2).
    """
    k = _half(times, span)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        way, took = position[2 * k :] - position[: -2 * k], times[2 * k :] - times[: -2 * k]
        found[k:-k] = way / took
    return found


def acceleration(times: FloatArray, position: FloatArray, span: float = ACCELERATION_SPAN) -> FloatArray:
    """Change of the mean velocity from the first to the second half of ``span`` s; units a second squared.

    With h = span/2 it is (p(t+h) − 2p(t) + p(t−h))/h² of even samples: exact where the acceleration is
    constant, and smaller by (sin(ωh/2)/(ωh/2))² of a sine.
    """
    k = _half(times, span)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        ahead, behind = times[2 * k :] - times[k:-k], times[k:-k] - times[: -2 * k]
        after = (position[2 * k :] - position[k:-k]) / ahead
        before = (position[k:-k] - position[: -2 * k]) / behind
        found[k:-k] = 2.0 * (after - before) / (ahead + behind)
    return found


def ripple(times: FloatArray, speed: FloatArray, span: float = RIPPLE_SPAN) -> FloatArray:
    """Speed less its mean over ``span`` s. Ripple of which whole waves fit into it cancels in the mean."""
    k = _half(times, span)
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
    """Samples in half the span, one at least; of the commonest distance of samples."""
    if len(times) < 2:
        return 1
    step = float(np.median(np.diff(times)))
    return max(1, round(0.5 * span / step)) if step > 0.0 else 1
