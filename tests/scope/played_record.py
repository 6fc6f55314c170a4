"""A record that is computed: samples of known curves at 1 kHz, live or in one piece."""

from __future__ import annotations

import threading
from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from core.executor.snapshot import MachineState
from core.records.record import Channel, FloatArray, ScopeRecord, list_machine_channels

RATE = 1000.0
STATES = tuple(state.value for state in MachineState)


def figures(times: FloatArray) -> dict[str, FloatArray]:
    """Axes that swing, a spindle that ripples: closed formulas of the time."""
    x, z = 10.0 + 5.0 * np.sin(times), -40.0 + 8.0 * np.cos(0.7 * times)
    error_x, error_z = 0.01 * np.cos(times), -0.012 * np.sin(0.7 * times)
    whole = np.ones_like(times)
    return {
        "X demand": x,
        "X actual": x - error_x,
        "X following error": error_x,
        "Z demand": z,
        "Z actual": z - error_z,
        "Z following error": error_z,
        "C demand": np.zeros_like(times),
        "C actual": np.zeros_like(times),
        "C following error": np.zeros_like(times),
        "spindle command": 1000.0 * whole,
        "spindle speed": 1000.0 + 4.0 * np.sin(2.0 * np.pi * 16.0 * times),
        "spindle turns": times * 1000.0 / 60.0,
        "feed override": whole,
        "spindle override": whole,
        "queue": 0.2 * whole,
        "lateness": 0.0005 * np.abs(np.sin(40.0 * times)),
        "line": np.floor(times) + 1.0,
        "block": np.floor(times) + 1.0,
        "state": STATES.index(MachineState.RUN.value) * whole,
        "input collet": (np.sin(times) > 0.0).astype(float),
        "output coolant": (np.cos(times) > 0.0).astype(float),
    }


CHANNELS: tuple[Channel, ...] = list_machine_channels(
    {"X": False, "Z": False, "C": True}, ("collet", "door"), ("coolant",)
)


def record_of(times: FloatArray, names: Collection[str] | None = None, **other: FloatArray) -> ScopeRecord:
    """A record at these times; ``other`` figures take the place of computed ones: names with _ for space."""
    named = {name.replace("_", " "): column for name, column in other.items()}
    known = figures(times) | named
    nothing = np.full(len(times), np.nan)
    of_mill = list_machine_channels({"Y": False}, (), ()) if "Y demand" in named else ()
    channels = (*CHANNELS, *(each for each in of_mill if each not in CHANNELS))
    wanted = [each for each in channels if names is None or each.name in names]
    columns = {each.name: known.get(each.name, nothing) for each in wanted}
    about = {"machine": "GT-75", "states": "|".join(STATES)}
    return ScopeRecord(tuple(wanted), times, columns, 1_700_000_000.0, RATE, about)


def seconds(begin: float, end: float) -> FloatArray:
    """Instants of the samples in between, at the rate."""
    return np.arange(np.ceil(begin * RATE - 1e-9), np.floor(end * RATE + 1e-9) + 1) / RATE


@dataclass
class PlayedSamples:
    """Live samples up to ``now``."""

    now: float = 100.0
    buffer_duration_s: float = 300.0
    channels: tuple[Channel, ...] = CHANNELS
    asked: list[tuple[float, float]] = field(default_factory=list)
    other: dict[str, FloatArray] = field(default_factory=dict)
    lets: threading.Event = field(
        default_factory=threading.Event
    )  # cleared: whoever works beside the screen waits
    waits: bool = False

    def __post_init__(self) -> None:
        self.lets.set()

    @property
    def newest_time_s(self) -> float:
        """The newest sample."""
        if threading.current_thread() is not threading.main_thread():
            self.waits = not self.lets.is_set()
            self.lets.wait()
        return float(np.floor(self.now * RATE + 1e-6) / RATE)

    def read_samples_between(
        self, start_s: float, end_s: float, channel_names: Collection[str] | None = None
    ) -> ScopeRecord:
        """As the recorder gives it."""
        self.asked.append((start_s, end_s))
        return record_of(
            seconds(max(start_s, 0.0, self.now - self.buffer_duration_s), min(end_s, self.newest_time_s)),
            channel_names,
        )
