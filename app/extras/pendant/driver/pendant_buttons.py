"""What a pendant's events mean: buttons that are held, clicks that are counted, and what must not count.

A press that comes late moves nothing: it has to be let go and pressed again. A release always counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from app.extras.pendant.driver.input_codes import ABS, KEY, REL, Control
from app.extras.pendant.driver.input_events import InputEvent, Packet

LATE = 0.1  # s from the kernel to here; what is older was done to a machine that looked different
_PRESSED, _FREE = 0.6, 0.3  # of the way to the end of an axis: down from the first on, up at the second
_PLACES = 256  # of a dial that tells its place; the kernel swallows its 0: a click that comes with the next
_REPEAT = 2  # value of a key that repeats by itself


class AxisRange(NamedTuple):
    """What an axis tells: from ``low`` to ``high``, ``value`` now."""

    low: int
    high: int
    value: int


@dataclass(slots=True)
class PendantButtons:
    """``bound``: what each name of the machine file is at; ``stops`` are names that count however late.

    ``down`` are names that are held, ``counts`` what the wheel has counted; ``place``: it tells where it
    stands instead of steps.
    """

    bound: Mapping[str, Control]
    stops: frozenset[str]
    wheel: Control | None = None
    place: bool = False
    counts: int = 0
    down: set[str] = field(default_factory=set)
    stale: set[str] = field(default_factory=set)  # down, and to be let go before they count
    ranges: dict[int, AxisRange] = field(default_factory=dict)
    _at: int | None = None  # of a wheel that tells its place

    def begin(self, keys: Iterable[int], ranges: Mapping[int, AxisRange]) -> None:
        """The device is there, or tells anew what is pressed: nothing of that was meant for us, but stops."""
        self.ranges = dict(ranges)
        pressed, self._at = set(keys), None
        held = {name for name, control in self.bound.items() if self._held(control, pressed)}
        self.down = held & self.stops
        self.stale = held - self.stops
        if self.wheel is not None and self.wheel.kind == ABS and self.wheel.code in self.ranges:
            self._at = self.ranges[self.wheel.code].value

    def gone(self) -> None:
        """The device is gone: nothing is held, and where its wheel stands is not known."""
        self.down.clear()
        self.stale.clear()
        self._at = None

    def take(self, packet: Packet, now: float) -> None:
        """What has come; ``now`` is by the clock of the events."""
        for event in packet.events:
            late = now - event.t > LATE
            if self.wheel is not None and (event.kind, event.code) == self.wheel[:2]:
                self._turn(event, late)
            for name, control in self.bound.items():
                if (event.kind, event.code) == control[:2]:
                    self._press(name, control, event, late)

    def _press(self, name: str, control: Control, event: InputEvent, late: bool) -> None:
        if control.kind == KEY:
            if event.value == _REPEAT:
                return
            pressed = event.value != 0
        else:
            self._keep(event)
            share = self._share(control)
            pressed = share >= _PRESSED or (share > _FREE and name in self.down | self.stale)
        if not pressed:
            self.down.discard(name)
            self.stale.discard(name)
        elif name in self.stops or not late:
            if name not in self.stale:
                self.down.add(name)
        elif name not in self.down:
            self.stale.add(name)

    def _turn(self, event: InputEvent, late: bool) -> None:
        if event.kind == REL and not self.place:
            self.counts += 0 if late else event.value
            return
        if event.kind == ABS:
            self._keep(event)
        reach = self.ranges.get(event.code) if event.kind == ABS else None
        size = reach.high - reach.low + 1 if reach is not None else _PLACES
        last, self._at = self._at, event.value
        if last is not None and not late and size > 1:
            self.counts += (event.value - last + size // 2) % size - size // 2

    def _keep(self, event: InputEvent) -> None:
        reach = self.ranges.get(event.code)
        if reach is not None:
            self.ranges[event.code] = reach._replace(value=event.value)

    def _held(self, control: Control, keys: set[int]) -> bool:
        if control.kind == KEY:
            return control.code in keys
        return self._share(control) > _FREE

    def _share(self, control: Control) -> float:
        """How far an axis is pushed this way, 0…1."""
        reach = self.ranges.get(control.code)
        if reach is None or reach.high <= reach.low:
            return 0.0
        middle, half = (reach.high + reach.low) / 2.0, (reach.high - reach.low) / 2.0
        return control.end * (reach.value - middle) / half
