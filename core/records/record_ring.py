"""The ring buffer of the scope in memory, with the samples of the last minutes.

One thread writes and any thread may read without a lock. The ring consists of two buffers: one for samples
at the driver's rate, and one for quantities of the control at each tick. A row is written before it is
counted, and it ends with its number, so a partly written row is never used.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from core.records.record import Channel, FloatArray, ScopeRecord, list_machine_channels

_BITS = 48  # logic channels in one value, which a float represents exactly
_BEFORE = 0.5  # s, the longest time for which a tick's values apply without a new row
RING_DURATION_S = 300.0  # s of samples in the ring
TICK_RATE_HZ = 100.0  # ticks of the control per second

# Values of a tick's row after the time. The inputs and outputs follow as bits.
TICK_CHANNELS = (
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
SAMPLE_CHANNELS = ("spindle speed", "spindle turns", "spindle load", "queue")


@dataclass(frozen=True, slots=True)
class RingLayout:
    """The layout of a scope ring buffer: the machine's channels, the sampling rate and the duration.

    ``is_rotary_by_axis`` maps each axis letter to whether the axis is rotary. ``clock_zero_utc_s`` is the
    time at which the monotonic clock was 0, in seconds since 1970. ``state_names`` are the texts of the
    values of the channel ``state``. ``duration_s`` is in seconds.
    """

    is_rotary_by_axis: Mapping[str, bool]
    input_names: tuple[str, ...] = ()
    output_names: tuple[str, ...] = ()
    sampling_rate_hz: float = TICK_RATE_HZ
    clock_zero_utc_s: float = 0.0
    machine_name: str = ""
    state_names: tuple[str, ...] = ()
    duration_s: float = RING_DURATION_S

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Return the channels of a record from this ring."""
        return list_machine_channels(self.is_rotary_by_axis, self.input_names, self.output_names)

    @property
    def sample_width(self) -> int:
        """Return the number of values in a driver sample.

        The values are the time, the demand, actual position and load of each axis, and SAMPLE_CHANNELS.
        """
        return 1 + 3 * len(self.is_rotary_by_axis) + len(SAMPLE_CHANNELS)

    @property
    def tick_width(self) -> int:
        """Return the number of values in a tick.

        The values are the time, TICK_CHANNELS, and the inputs and outputs as bits.
        """
        return 1 + len(TICK_CHANNELS) + _words(self.input_names) + _words(self.output_names)

    @property
    def row_capacities(self) -> tuple[int, int]:
        """Return the numbers of samples and of ticks that the ring can store."""
        return max(2, round(self.duration_s * self.sampling_rate_hz)), max(
            2, round(self.duration_s * TICK_RATE_HZ)
        )

    @property
    def size_bytes(self) -> int:
        """Return the size of the ring in memory, in bytes."""
        samples, ticks = self.row_capacities
        return calculate_buffer_size(samples, self.sample_width) + calculate_buffer_size(
            ticks, self.tick_width
        )

    @property
    def description(self) -> dict[str, str]:
        """Return the machine and the states as strings, for the description of a record."""
        return {"machine": self.machine_name, "states": "|".join(self.state_names)}


def _words(names: Collection[str]) -> int:
    return -(-len(names) // _BITS)


def pack_bits(names: tuple[str, ...], active_names: Collection[str]) -> list[float]:
    """Return the states of logic channels as bits, 48 in each value.

    ``active_names`` contains the names of the channels that are on.
    """
    words = [0] * _words(names)
    for i, name in enumerate(names):
        if name in active_names:
            words[i // _BITS] |= 1 << (i % _BITS)
    return [float(word) for word in words]


# =


class RowBuffer:
    """A ring buffer of rows of one kind.

    One thread writes, and any thread may read without a lock. Column 0 is the time. ``memory`` has
    ``calculate_buffer_size(capacity, width)`` bytes and can be shared with another process.
    """

    def __init__(self, capacity: int, width: int, memory: memoryview | None = None) -> None:
        self.capacity = capacity
        values = (
            np.zeros(calculate_buffer_size(capacity, width) // 8) if memory is None else np.frombuffer(memory)
        )
        self._counts = values[:2].view(np.int64)
        self.array: FloatArray = values[2:].reshape(
            capacity, width + 1
        )  # the last column is the row's number

    @property
    def started_row_count(self) -> int:
        """Return the number of rows whose writing has started."""
        return int(self._counts[0])

    @started_row_count.setter
    def started_row_count(self, count: int) -> None:
        self._counts[0] = count

    @property
    def completed_row_count(self) -> int:
        """Return the number of rows that have been written completely."""
        return int(self._counts[1])

    @completed_row_count.setter
    def completed_row_count(self, count: int) -> None:
        self._counts[1] = count

    def append_rows(self, rows: FloatArray) -> list[tuple[int, FloatArray]]:
        """Append rows, and return the changed rows of the buffer with their indices.

        The caller must write these rows to the ring file.
        """
        rows = rows[-self.capacity :]
        first, end = self.completed_row_count, self.completed_row_count + len(rows)
        numbered = np.column_stack((rows, np.arange(first, end, dtype=np.float64)))
        self.started_row_count = end
        at = first % self.capacity
        parts = [(at, numbered[: self.capacity - at])]
        if len(numbered) > self.capacity - at:
            parts.append((0, numbered[self.capacity - at :]))
        for slot, part in parts:
            self.array[slot : slot + len(part)] = part
        self.completed_row_count = end
        return parts

    def copy_rows_between(self, start_time_s: float, end_time_s: float) -> FloatArray:
        """Return a copy of the rows from ``start_time_s`` to ``end_time_s``, inclusive.

        Rows that are being written are omitted.
        """
        whole = self.completed_row_count
        low = max(0, self.started_row_count - self.capacity)
        first = self._search(low, whole, lambda t: t >= start_time_s)
        last = self._search(first, whole, lambda t: t > end_time_s)
        at, count = first % self.capacity, last - first
        rows = np.concatenate((self.array[at : at + count], self.array[: max(0, at + count - self.capacity)]))
        lost = max(0, self.started_row_count - self.capacity - first)  # overwritten while reading
        return select_valid_rows(rows[lost:], first + lost)

    def _search(self, low: int, high: int, reached: Callable[[float], bool]) -> int:
        while low < high:
            middle = (low + high) // 2
            if reached(float(self.array[middle % self.capacity, 0])):
                high = middle
            else:
                low = middle + 1
        return low

    @property
    def last_time_s(self) -> float:
        """Return the time of the newest row in seconds, or minus infinity without rows."""
        return (
            float(self.array[(self.completed_row_count - 1) % self.capacity, 0])
            if self.completed_row_count
            else -np.inf
        )

    @property
    def first_time_s(self) -> float:
        """Return the time of the oldest available row in seconds, or infinity without rows."""
        return (
            float(self.array[max(0, self.started_row_count - self.capacity) % self.capacity, 0])
            if self.completed_row_count
            else np.inf
        )


def calculate_buffer_size(capacity: int, width: int) -> int:
    """Return the size in bytes of the memory of a ``RowBuffer`` with this number of rows and columns."""
    return 8 * (2 + capacity * (width + 1))


def select_valid_rows(rows: FloatArray, first_number: int) -> FloatArray:
    """Return the valid rows without their row numbers.

    Valid rows are numbered consecutively from ``first_number`` and have ascending times.
    """
    if not len(rows):
        return rows[:, :-1]
    times = rows[:, 0]
    good = rows[:, -1] == np.arange(first_number, first_number + len(rows))
    good[1:] &= times[1:] > np.maximum.accumulate(np.where(good, times, -np.inf))[:-1]
    return rows[good, :-1]


# --- Both buffers combined ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ScopeRing:
    """The driver samples and control ticks of the last minutes.

    Any thread may call ``get_record_since`` and ``get_record_between``.
    """

    layout: RingLayout
    samples: RowBuffer
    ticks: RowBuffer

    @classmethod
    def from_layout(cls, layout: RingLayout, memory: memoryview | None = None) -> ScopeRing:
        """Return the ring in ``memory`` (``layout.size_bytes`` bytes), or an empty ring if it is None."""
        room, ticks = layout.row_capacities
        cut = calculate_buffer_size(room, layout.sample_width)
        return cls(
            layout,
            RowBuffer(room, layout.sample_width, memory[:cut] if memory is not None else None),
            RowBuffer(ticks, layout.tick_width, memory[cut:] if memory is not None else None),
        )

    def get_record_since(self, start_time_s: float, names: Collection[str] | None = None) -> ScopeRecord:
        """Return the samples after ``start_time_s``, in seconds of the clock.

        ``names`` selects channels; None selects all channels.
        """
        return self.get_record_between(np.nextafter(start_time_s, np.inf), np.inf, names)

    def get_record_between(
        self, start_time_s: float, end_time_s: float, names: Collection[str] | None = None
    ) -> ScopeRecord:
        """Return the samples from ``start_time_s`` to ``end_time_s``, inclusive, in seconds of the clock.

        ``names`` selects channels; None selects all channels.
        """
        return make_record(
            self.layout,
            self.samples.copy_rows_between(start_time_s, end_time_s),
            self.ticks.copy_rows_between(start_time_s - _BEFORE, end_time_s),
            names,
        )


def make_record(
    layout: RingLayout, samples: FloatArray, ticks: FloatArray, names: Collection[str] | None = None
) -> ScopeRecord:
    """Return a record that is made from samples and ticks.

    The values of a tick apply until the next tick.
    """
    times = samples[:, 0].copy()
    seen = np.searchsorted(ticks[:, 0], times, side="right") - 1
    source = _Source(layout, samples, ticks, seen)
    wanted = [each for each in layout.channels if names is None or each.name in names]
    columns = {each.name: source.get_channel_values(each.name) for each in wanted}
    started = layout.clock_zero_utc_s + (float(times[0]) if len(times) else 0.0)
    return ScopeRecord(tuple(wanted), times, columns, started, layout.sampling_rate_hz, layout.description)


class _Source:
    """An accessor for the values of each channel in the samples and ticks of a ring."""

    def __init__(self, layout: RingLayout, samples: FloatArray, ticks: FloatArray, seen: object) -> None:
        self._recorded, self._samples, self._ticks, self._seen = layout, samples, ticks, np.asarray(seen)

    def get_channel_values(self, name: str) -> FloatArray:
        """Return the values of one channel at the times of the samples."""
        recorded, axes = self._recorded, list(self._recorded.is_rotary_by_axis)
        letter, _, what = name.partition(" ")
        if letter in axes and what in {"demand", "actual", "following error", "load"}:
            return self._of_axis(axes.index(letter), len(axes), what)
        if letter in {"input", "output"}:
            names = recorded.input_names if letter == "input" else recorded.output_names
            first = 1 + len(TICK_CHANNELS) + (0 if letter == "input" else _words(recorded.input_names))
            return self._bit(first, names.index(what))
        return self._of_machine(name, 1 + 3 * len(axes))

    def _of_axis(self, index: int, axes: int, what: str) -> FloatArray:
        demand, actual = self._samples[:, 1 + index], self._samples[:, 1 + axes + index]
        if what == "following error":
            return np.asarray(demand - actual)
        if what == "load":
            return self._samples[:, 1 + 2 * axes + index].copy()
        return (demand if what == "demand" else actual).copy()

    def _of_machine(self, name: str, first_column: int) -> FloatArray:
        if name == "lateness":
            return self._worst(1 + TICK_CHANNELS.index(name))
        values = np.full(len(self._samples), np.nan)
        if name in SAMPLE_CHANNELS:
            values = self._samples[:, first_column + SAMPLE_CHANNELS.index(name)].copy()
        if name in TICK_CHANNELS:
            missing = np.isnan(values)
            values[missing] = self._select_tick_values(1 + TICK_CHANNELS.index(name))[missing]
        return values

    def _bit(self, first: int, index: int) -> FloatArray:
        word = self._select_tick_values(first + index // _BITS)
        known = ~np.isnan(word)
        bits = np.full(len(word), np.nan)
        bits[known] = (word[known].astype(np.int64) >> (index % _BITS)) & 1
        return bits

    def _worst(self, column: int) -> FloatArray:
        """Return, for each sample, the largest value of a tick column since the previous sample.

        Several ticks can occur between two samples, because fewer samples are taken at standstill.
        """
        held = self._select_tick_values(column)
        known = np.flatnonzero(self._seen >= 0)
        if not len(known):
            return held
        last = self._seen[known]
        first = np.minimum(np.concatenate((last[:1], last[:-1] + 1)), last[-1])
        worst = np.maximum.reduceat(self._ticks[: last[-1] + 1, column], first)
        held[known] = np.where(first <= last, worst, held[known])
        return held

    def _select_tick_values(self, column: int) -> FloatArray:
        """Return the value of the latest tick at each sample, or NaN before the first tick."""
        if not len(self._ticks):
            return np.full(len(self._seen), np.nan)
        values = self._ticks[np.maximum(self._seen, 0), column]
        return np.where(self._seen >= 0, values, np.nan)
