"""Ring buffer of the scope with the samples of the last minutes, in memory.

One thread writes and any thread reads without a lock. The ring has two buffers: samples at the driver's rate,
and quantities of the control at each tick. A row is written before it is counted, and it ends with its
number, so a partly written row is never used.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from core.records.record import Channel, FloatArray, Record, channels_of

_BITS = 48  # logic channels in one value, which a float represents exactly
_BEFORE = 0.5  # s, the longest time for which a tick's values apply without a new row
LASTS = 300.0  # s of samples in the ring
TICKS = 100.0  # ticks of the control per second

# Values of a tick's row after the time. The inputs and outputs follow as bits.
TICK_FIGURES = (
    "spindle command",
    "spindle speed",
    "spindle turns",
    "feed override",
    "spindle override",
    "queue",
    "lateness",
    "line",
    "block",
    "state",
)
# Values of spindle and queue that drivers report, after those of the axes. The tick's value is used if the
# driver reports none.
SAMPLE_FIGURES = ("spindle speed", "spindle turns", "spindle load", "queue")


@dataclass(frozen=True, slots=True)
class Recorded:
    """Layout of a ring: the machine's channels, the sampling rate and the duration.

    ``axes`` maps each letter to whether the axis is rotary. ``began`` is the time of the clock's zero, in
    seconds since 1970. ``states`` are the texts of the values of the channel ``state``. ``lasts`` is in
    seconds.
    """

    axes: Mapping[str, bool]
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    rate: float = TICKS
    began: float = 0.0
    machine: str = ""
    states: tuple[str, ...] = ()
    lasts: float = LASTS

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels of a record from this ring."""
        return channels_of(self.axes, self.inputs, self.outputs)

    @property
    def sample_width(self) -> int:
        """Number of values in a driver's sample.

        The values are the time, the demand, actual and load of all axes, and SAMPLE_FIGURES.
        """
        return 1 + 3 * len(self.axes) + len(SAMPLE_FIGURES)

    @property
    def tick_width(self) -> int:
        """Number of values in a tick: the time, TICK_FIGURES, and the inputs and outputs as bits."""
        return 1 + len(TICK_FIGURES) + _words(self.inputs) + _words(self.outputs)

    @property
    def rooms(self) -> tuple[int, int]:
        """Numbers of samples and of ticks that the ring can store."""
        return max(2, round(self.lasts * self.rate)), max(2, round(self.lasts * TICKS))

    @property
    def ring_bytes(self) -> int:
        """Size of the ring in memory, in bytes."""
        samples, ticks = self.rooms
        return bytes_of(samples, self.sample_width) + bytes_of(ticks, self.tick_width)

    @property
    def about(self) -> dict[str, str]:
        """Machine and states as text, for the description of a record."""
        return {"machine": self.machine, "states": "|".join(self.states)}


def _words(names: Collection[str]) -> int:
    return -(-len(names) // _BITS)


def bits_of(names: tuple[str, ...], on: Collection[str]) -> list[float]:
    """Return logic channels as bits, 48 in each value. ``on`` has the names of those that are on."""
    words = [0] * _words(names)
    for i, name in enumerate(names):
        if name in on:
            words[i // _BITS] |= 1 << (i % _BITS)
    return [float(word) for word in words]


# =


class Rows:
    """Ring buffer of rows of one kind; one thread writes, and any thread reads without a lock.

    Column 0 is the time. ``memory`` has ``bytes_of(room, width)`` bytes and can be shared with another
    process.
    """

    def __init__(self, room: int, width: int, memory: memoryview | None = None) -> None:
        self.room = room
        figures = np.zeros(bytes_of(room, width) // 8) if memory is None else np.frombuffer(memory)
        self._counts = figures[:2].view(np.int64)
        self.data: FloatArray = figures[2:].reshape(room, width + 1)  # the last column is the row's number

    @property
    def begun(self) -> int:
        """Number of rows whose writing has started."""
        return int(self._counts[0])

    @begun.setter
    def begun(self, count: int) -> None:
        self._counts[0] = count

    @property
    def whole(self) -> int:
        """Number of rows that are completely written."""
        return int(self._counts[1])

    @whole.setter
    def whole(self, count: int) -> None:
        self._counts[1] = count

    def write(self, rows: FloatArray) -> list[tuple[int, FloatArray]]:
        """Append rows and return the changed slots with their contents, for the file."""
        rows = rows[-self.room :]
        first, end = self.whole, self.whole + len(rows)
        numbered = np.column_stack((rows, np.arange(first, end, dtype=np.float64)))
        self.begun = end
        at = first % self.room
        parts = [(at, numbered[: self.room - at])]
        if len(numbered) > self.room - at:
            parts.append((0, numbered[self.room - at :]))
        for slot, part in parts:
            self.data[slot : slot + len(part)] = part
        self.whole = end
        return parts

    def between(self, begin: float, end: float) -> FloatArray:
        """Return a copy of the rows from ``begin`` to ``end`` inclusive.

        Rows that are being written are omitted.
        """
        whole = self.whole
        low = max(0, self.begun - self.room)
        first = self._search(low, whole, lambda t: t >= begin)
        last = self._search(first, whole, lambda t: t > end)
        at, count = first % self.room, last - first
        rows = np.concatenate((self.data[at : at + count], self.data[: max(0, at + count - self.room)]))
        lost = max(0, self.begun - self.room - first)  # overwritten while reading
        return sound(rows[lost:], first + lost)

    def _search(self, low: int, high: int, reached: Callable[[float], bool]) -> int:
        while low < high:
            middle = (low + high) // 2
            if reached(float(self.data[middle % self.room, 0])):
                high = middle
            else:
                low = middle + 1
        return low

    @property
    def last(self) -> float:
        """Time of the newest row; minus infinity if there are no rows."""
        return float(self.data[(self.whole - 1) % self.room, 0]) if self.whole else -np.inf

    @property
    def first(self) -> float:
        """Time of the oldest row that is still available; infinity if there are no rows."""
        return float(self.data[max(0, self.begun - self.room) % self.room, 0]) if self.whole else np.inf


def bytes_of(room: int, width: int) -> int:
    """Return the size in bytes of a ``Rows`` buffer with this number of rows and columns."""
    return 8 * (2 + room * (width + 1))


def sound(rows: FloatArray, first: int) -> FloatArray:
    """Return the valid rows without their numbers: numbered from ``first`` on, with ascending times."""
    if not len(rows):
        return rows[:, :-1]
    times = rows[:, 0]
    good = rows[:, -1] == np.arange(first, first + len(rows))
    good[1:] &= times[1:] > np.maximum.accumulate(np.where(good, times, -np.inf))[:-1]
    return rows[good, :-1]


# --- Both buffers combined ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Ring:
    """Samples and ticks of the last minutes. Any thread may call ``latest`` and ``between``."""

    recorded: Recorded
    samples: Rows
    ticks: Rows

    @classmethod
    def of(cls, recorded: Recorded, memory: memoryview | None = None) -> Ring:
        """Return the ring in ``memory``, which has ``recorded.ring_bytes`` bytes, or a new, empty ring."""
        room, ticks = recorded.rooms
        cut = bytes_of(room, recorded.sample_width)
        return cls(
            recorded,
            Rows(room, recorded.sample_width, memory[:cut] if memory is not None else None),
            Rows(ticks, recorded.tick_width, memory[cut:] if memory is not None else None),
        )

    def latest(self, since: float, names: Collection[str] | None = None) -> Record:
        """Return the samples after ``since``, in seconds of the clock.

        ``names`` selects channels; None selects all.
        """
        return self.between(np.nextafter(since, np.inf), np.inf, names)

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """Return the samples from ``begin`` to ``end`` inclusive.

        ``names`` selects channels; None selects all.
        """
        return record_of(
            self.recorded,
            self.samples.between(begin, end),
            self.ticks.between(begin - _BEFORE, end),
            names,
        )


def record_of(
    recorded: Recorded, samples: FloatArray, ticks: FloatArray, names: Collection[str] | None = None
) -> Record:
    """Return a record made from samples and ticks. A tick's values apply until the next tick."""
    times = samples[:, 0].copy()
    seen = np.searchsorted(ticks[:, 0], times, side="right") - 1
    source = _Source(recorded, samples, ticks, seen)
    wanted = [each for each in recorded.channels if names is None or each.name in names]
    columns = {each.name: source.column(each.name) for each in wanted}
    started = recorded.began + (float(times[0]) if len(times) else 0.0)
    return Record(tuple(wanted), times, columns, started, recorded.rate, recorded.about)


class _Source:
    """Access to the values of each channel in the rows."""

    def __init__(self, recorded: Recorded, samples: FloatArray, ticks: FloatArray, seen: object) -> None:
        self._recorded, self._samples, self._ticks, self._seen = recorded, samples, ticks, np.asarray(seen)

    def column(self, name: str) -> FloatArray:
        """Return the values of one channel at the times of the samples."""
        recorded, axes = self._recorded, list(self._recorded.axes)
        letter, _, what = name.partition(" ")
        if letter in axes and what in {"demand", "actual", "following error", "load"}:
            return self._of_axis(axes.index(letter), len(axes), what)
        if letter in {"input", "output"}:
            names = recorded.inputs if letter == "input" else recorded.outputs
            first = 1 + len(TICK_FIGURES) + (0 if letter == "input" else _words(recorded.inputs))
            return self._bit(first, names.index(what))
        return self._of_machine(name, 1 + 3 * len(axes))

    def _of_axis(self, index: int, axes: int, what: str) -> FloatArray:
        demand, actual = self._samples[:, 1 + index], self._samples[:, 1 + axes + index]
        if what == "following error":
            return np.asarray(demand - actual)
        if what == "load":
            return self._samples[:, 1 + 2 * axes + index].copy()
        return (demand if what == "demand" else actual).copy()

    def _of_machine(self, name: str, behind: int) -> FloatArray:
        if name == "lateness":
            return self._worst(1 + TICK_FIGURES.index(name))
        told = np.full(len(self._samples), np.nan)
        if name in SAMPLE_FIGURES:
            told = self._samples[:, behind + SAMPLE_FIGURES.index(name)].copy()
        if name in TICK_FIGURES:
            missing = np.isnan(told)
            told[missing] = self._held(1 + TICK_FIGURES.index(name))[missing]
        return told

    def _bit(self, first: int, index: int) -> FloatArray:
        word = self._held(first + index // _BITS)
        known = ~np.isnan(word)
        bits = np.full(len(word), np.nan)
        bits[known] = (word[known].astype(np.int64) >> (index % _BITS)) & 1
        return bits

    def _worst(self, column: int) -> FloatArray:
        """Return the largest value of the ticks since the previous sample.

        At standstill there are fewer samples than ticks.
        """
        held = self._held(column)
        known = np.flatnonzero(self._seen >= 0)
        if not len(known):
            return held
        last = self._seen[known]
        first = np.minimum(np.concatenate((last[:1], last[:-1] + 1)), last[-1])
        worst = np.maximum.reduceat(self._ticks[: last[-1] + 1, column], first)
        held[known] = np.where(first <= last, worst, held[known])
        return held

    def _held(self, column: int) -> FloatArray:
        """Return the value of the latest tick at each sample; NaN before the first tick."""
        if not len(self._ticks):
            return np.full(len(self._seen), np.nan)
        figures = self._ticks[np.maximum(self._seen, 0), column]
        return np.where(self._seen >= 0, figures, np.nan)
