"""What every part of the executor has at hand in a tick: machine, ports, spindle, switches, event log."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, field

from core.alarms import Code
from core.executor.lateness import Lateness
from core.executor.raised_alarm import Attempt, log_line, make_alarm
from core.executor.signals import CommandedOutputs, StationSignals
from core.executor.snapshot import Alarm, Event
from core.executor.spindle_control import SpindleControl
from core.machine.machine_model import Machine
from core.machine.station_rules import ENABLE
from core.ports import AxisSample, FloatArray, MachinePorts, Unknown

_log = logging.getLogger(__name__)
_QUIET = StationSignals(estop=False, start=False, hold=False, feed=1.0, spindle=1.0, auto=True, trouble="")
_LEAST = 0.005  # of the feed: a smaller change of a pot is no change


@dataclass(slots=True)
class Switches:
    """The lit words that an operator turns."""

    single_block: bool = False
    optional_stop: bool = False
    cycle_repeat: bool = False
    no_count: bool = False  # what runs is no part: a dry run


@dataclass(slots=True)
class MachineContext:
    """What all parts of the executor look at in one tick; written by the executor's thread alone."""

    machine: Machine
    ports: MachinePorts
    on_event: Callable[[Event], None]
    spindle: SpindleControl
    now: float
    sample: AxisSample
    inputs: dict[str, bool]
    outputs: CommandedOutputs  # the same as ``ports.io``
    signals: StationSignals = _QUIET
    unknown: frozenset[Unknown] = frozenset()  # of what nothing is heard
    switches: Switches = field(default_factory=Switches)
    soft_override: float = 1.0
    lamp_test: float = 0.0  # until when all lamps of the tower are on
    line: int = 0  # of the block being executed, for the log
    stop: Alarm | None = None  # why the machine stands, where no alarm says it
    lateness: Lateness = field(init=False)
    _noted: Code | None = None  # the last that went into the log
    _borne: float | None = None  # by the spindle's drive, per cent, as its samples said last

    def __post_init__(self) -> None:
        self.lateness = Lateness(self.machine.timing.lookahead)

    @property
    def spindle_load(self) -> float | None:
        """Per cent: of the machine's own input, else as the driver samples it; None where nobody tells."""
        return self._borne if self.signals.spindle_load is None else self.signals.spindle_load

    def note_load(self, samples: FloatArray | None) -> None:
        """The newest that the driver's samples tell, (n, 5 + 3 axes); ``core.ports.SampleSource``."""
        if samples is not None and len(samples):
            load = float(samples[-1, -2])
            self._borne = load if math.isfinite(load) else None

    @property
    def feed_override(self) -> float:
        """Pot times key, 0…1.5 of the programmed feed; steps of half a per cent."""
        fraction = min(self.signals.feed * self.soft_override, 1.5)
        return round(fraction / _LEAST) * _LEAST

    def log(self, kind: str, text: str) -> None:
        """Put something into the log."""
        self.log_event(Event(self.now, kind, text, self.line))

    def show_stop(self, code: Code, detail: str = "") -> None:
        """A hold, a stop or the E-stop: it is shown until something goes on, and it goes into the log.

        Of blocks that are stepped through one by one the first alone: they would push all else out of it.
        """
        if code == "single-block" == self._noted:
            self.stop = make_alarm(code, detail, self.line, self.now)
        else:
            self.stop = self.log_stop(code, detail)

    def log_stop(self, code: Code, detail: str = "") -> Alarm:
        """A stop that is over at once: it only goes into the log."""
        stop = make_alarm(code, detail, self.line, self.now)
        self._noted = code
        kind = "estop" if code == "estop" else "stop"
        self.log_event(Event(self.now, kind, log_line(stop), self.line, stop))
        return stop

    def log_event(self, event: Event) -> None:
        """Hand an event to who keeps the log; that it cannot be kept stops nothing."""
        with Attempt() as trial:
            self.on_event(event)
        if trial.error is not None:
            _log.error("an event was lost: %s", event, exc_info=trial.error)

    def terminal(self, name: str) -> bool:
        """Whether an input is on, by the name or terminal that a program uses."""
        if name in self.inputs:
            return self.inputs[name]
        for model in self.machine.inputs.values():
            if model.terminal == name:
                return self.inputs.get(model.name, False)
        return False

    def button(self, name: str) -> bool:
        """Whether a button that holds a motion is down, and the enabling switch where there is one."""
        return self.inputs.get(name, False) and self.inputs.get(ENABLE, True)

    def in_position(self) -> bool:
        """All slides are where they were sent."""
        pairs = zip(self.machine.axes, self.sample.following_error, strict=True)
        return not self.sample.moving and all(abs(error) <= axis.in_position for axis, error in pairs)
