"""The operator station as the control believes it, and outputs as they were commanded."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from core.machine.hardware_model import LAMPS
from core.machine.machine_model import OutputModel
from core.message import Message
from core.ports import DigitalIO, StationState

_SILENT = 0.3  # s without a word: the last value is held, a running cycle too
_JUMP = 0.2  # of the range within a tenth of a second: a wiper, not a hand
_STAND = 0.3  # s that a risen pot must stand before it is believed
_NOISY = 3  # jumps within a second that make a pot unbelievable
_DEBOUNCE = 0.3  # s in which a second start is the same press
_AWAY = 0.3  # s between two looks: what was pressed or turned in a longer one is old, and starts nothing
_TELLS = 0.5  # s in which an output that was written may still be told as it was before


class StationSignals(NamedTuple):
    """What the station asks for in this tick."""

    estop: bool
    start: bool  # both palms, this moment
    hold: bool  # while the button is down
    feed: float
    spindle: float
    auto: bool
    trouble: str  # why the cycle must be held, empty when all is well
    wheel: int = 0  # what the handwheel has counted
    turned_on: bool = False  # the spindle switch was turned from OFF to AUTO, this moment
    lost: str = ""  # what of the station is gone, so that the cycle must be held: a sentence
    wheel_trouble: str = ""  # why handwheel and jog buttons are not believed
    spindle_load: float | None = None  # per cent
    late_start: bool = False  # both palms, but while nobody looked: it starts nothing


class OverridePot:
    """One pot. A fall is obeyed at once, since it only slows; a sudden rise must stand to be believed."""

    def __init__(self) -> None:
        self.value = 1.0
        self._recent: deque[tuple[float, float]] = deque()  # what was read within a tenth of a second
        self._rising: tuple[float, float] | None = None
        self._jumps: deque[float] = deque()

    @property
    def noisy(self) -> bool:
        """Jumps too often to be a hand."""
        return len(self._jumps) >= _NOISY

    def read(self, raw: float, now: float) -> float:
        """The value to use."""
        self._count_jumps(raw, now)
        if raw <= self.value or self._slow(raw):
            self.value, self._rising = raw, None
        elif self._rising is None or abs(raw - self._rising[0]) > 0.05:
            self._rising = (raw, now)
        elif now - self._rising[1] >= _STAND:
            self.value, self._rising = raw, None
        return self.value

    def _slow(self, raw: float) -> bool:
        return self._rising is None and raw - self.value <= _JUMP

    def _count_jumps(self, raw: float, now: float) -> None:
        while self._recent and self._recent[0][0] < now - 0.1:
            self._recent.popleft()
        if any(abs(raw - old) > _JUMP for _, old in self._recent):
            self._jumps.append(now)
            self._recent.clear()
        self._recent.append((now, raw))
        while self._jumps and self._jumps[0] < now - 1.0:
            self._jumps.popleft()


class StationWatch:
    """Turns states of the station into what has to be done."""

    def __init__(self) -> None:
        self._feed = OverridePot()
        self._spindle = OverridePot()
        self._started = True  # a start that is on when the control begins to look is no press
        self._last_start = -1e9
        self._auto = True  # where the spindle switch stood when the station last spoke
        self._spoke = -1e9  # when it last spoke

    def read(self, state: StationState, now: float) -> StationSignals:
        """One look at the station."""
        silent = not (state.age <= _SILENT and math.isfinite(state.feed_pot + state.spindle_pot))
        if not silent:
            self._feed.read(state.feed_pot, now)
            self._spindle.read(state.spindle_pot, now)
        live = not silent and now - self._spoke <= _AWAY
        pressed = state.start and not self._started and not silent
        edge = live and pressed
        turned = live and state.spindle_auto and not self._auto
        self._started = state.start
        if not silent:
            self._auto, self._spoke = state.spindle_auto, now
        noisy = self._feed.noisy or self._spindle.noisy
        trouble = (
            "NO RESPONSE FROM OPERATOR STATION" if silent else "OVERRIDE SIGNAL UNSTABLE" if noisy else ""
        )
        return StationSignals(
            estop=state.estop,
            start=edge and self.may_start(now),
            hold=state.hold,
            feed=self._feed.value,
            spindle=self._spindle.value,
            auto=self._auto,
            trouble=trouble,
            wheel=state.handwheel,
            turned_on=turned,
            lost=state.trouble,
            wheel_trouble=state.wheel_trouble,
            spindle_load=state.spindle_load,
            late_start=pressed and not live,
        )

    def may_start(self, now: float) -> bool:
        """Whether this start is a new one and no bounce of the last; remembers it."""
        fresh = now - self._last_start >= _DEBOUNCE
        if fresh:
            self._last_start = now
        return fresh


class Differing(NamedTuple):
    """An output that is not what it was commanded to be."""

    name: str
    wanted: bool

    @property
    def words(self) -> str:
        """What has become of it, as the operator reads it."""
        name = self.name.upper()
        return (
            Message("{name} TURNED OFF", name=name) if self.wanted else Message("{name} TURNED ON", name=name)
        )


class CommandedOutputs:
    """``core.ports.DigitalIO``: every output that the executor writes goes through here and is remembered."""

    def __init__(self, io: DigitalIO, models: Mapping[str, OutputModel]) -> None:
        self._io = io
        self._models = models
        self._lamps = frozenset(LAMPS) & models.keys()  # the control's own: no program commands them
        self._wanted = dict(self.outputs())
        self._written: dict[str, float] = {}  # when each was written last, told late by some drivers

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name."""
        return self._io.inputs()

    def outputs(self) -> Mapping[str, bool]:
        """The outputs as they are, by name, but for the lamps of the signal tower."""
        outputs = self._io.outputs()
        return (
            {name: on for name, on in outputs.items() if name not in self._lamps} if self._lamps else outputs
        )

    def everything(self) -> Mapping[str, bool]:
        """The same with the lamps."""
        return self._io.outputs()

    def write(self, name: str, on: bool) -> None:
        """Switch one output. Raises DriverError, and then it was not commanded."""
        self._io.write(name, on)
        self._wanted[name] = on
        self._written[name] = self._now

    def safe(self) -> None:
        """Every output to its safe state."""
        self._io.safe()
        for model in self._models.values():
            if model.safe is not None and model.name not in self._lamps:
                self._wanted[model.name], self._written[model.name] = model.safe, self._now

    def look(self, now: float) -> None:
        """Called first in a tick, with the time by which writes are remembered."""
        self._now = now

    def fell(self, names: Sequence[str]) -> None:
        """These are known to have been switched off by somebody else, however lately they were written."""
        for name in names:
            self._written.pop(name, None)

    def differing(self) -> list[Differing]:
        """The outputs that are not as they were commanded, and ought to be by now."""
        actual = self._io.outputs()
        return [
            Differing(name, wanted)
            for name, wanted in self._wanted.items()
            if actual.get(name, wanted) is not wanted and self._now - self._written.get(name, -1e9) > _TELLS
        ]

    def accept(self) -> list[Differing]:
        """No program is under way: outputs count as they are now. Returns those that have changed."""
        changed = self.differing()
        for each in changed:
            self._wanted[each.name] = not each.wanted
        return changed

    _now = 0.0
