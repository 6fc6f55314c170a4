"""Data that all parts of the executor share in a tick: machine, ports, spindle, switches and event log."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, field

from core.alarms import AlarmCode
from core.executor.raised_alarm import ErrorCatcher, format_log_line, make_alarm
from core.executor.snapshot import Alarm, LogEvent
from core.executor.spindle_control import SpindleControl
from core.executor.station_signals import CommandedOutputs, StationSignals
from core.executor.tick_lateness import TickLateness
from core.machine.machine_model import Machine
from core.machine.station_rules import HANDWHEEL_ENABLE_INPUT
from core.ports import AxisSample, FloatArray, MachinePorts, UnknownPart

_log = logging.getLogger(__name__)
_NEUTRAL_SIGNALS = StationSignals(
    is_estop_pressed=False,
    is_start_requested=False,
    is_hold_requested=False,
    feed_override=1.0,
    spindle=1.0,
    is_spindle_in_auto=True,
    station_fault="",
)
_OVERRIDE_STEP = 0.005  # smallest step of the feed override


@dataclass(slots=True)
class OperatorSwitches:
    """State of the operator's switches, such as single block. The screen shows them as lit labels."""

    single_block: bool = False
    optional_stop: bool = False
    cycle_repeat: bool = False
    no_count: bool = False  # dry run: the cycle does not count as a part


@dataclass(slots=True)
class MachineContext:
    """Data that all parts of the executor share in one tick. Only the executor's thread writes it."""

    machine: Machine
    ports: MachinePorts
    handle_event: Callable[[LogEvent], None]
    spindle: SpindleControl
    now: float
    axis_sample: AxisSample
    inputs: dict[str, bool]
    commanded_outputs: CommandedOutputs  # the same as ``ports.io``
    station_signals: StationSignals = _NEUTRAL_SIGNALS
    unknown_parts: frozenset[UnknownPart] = frozenset()  # items of which no data arrives
    switches: OperatorSwitches = field(default_factory=OperatorSwitches)
    screen_feed_override: float = 1.0
    lamp_test_end_s: float = 0.0  # time until which all lamps of the signal tower are on
    line_number: int = 0  # line of the block being executed, for the log
    stop: Alarm | None = None  # why the machine is stopped although no alarm is active
    tick_lateness: TickLateness = field(init=False)
    _noted: AlarmCode | None = None  # code of the last stop that was logged
    _borne: float | None = None  # spindle load of the latest driver sample, per cent

    def __post_init__(self) -> None:
        self.tick_lateness = TickLateness(self.machine.timing.lookahead_time_s)

    @property
    def spindle_load(self) -> float | None:
        """Return the spindle load in percent from the machine's input or the driver, or None if unknown."""
        return self._borne if self.station_signals.spindle_load is None else self.station_signals.spindle_load

    def record_spindle_load(self, samples: FloatArray | None) -> None:
        """Store the spindle load of the newest driver sample.

        ``samples`` has the shape (n, 5 + 3 axes). ``core.ports.SampleSource`` describes the columns.
        """
        if samples is not None and len(samples):
            load = float(samples[-1, -2])
            self._borne = load if math.isfinite(load) else None

    @property
    def feed_override(self) -> float:
        """Return the feed override, 0 to 1.5, in steps of 0.005.

        The override is the product of the potentiometer and the screen setting.
        """
        fraction = min(self.station_signals.feed_override * self.screen_feed_override, 1.5)
        return round(fraction / _OVERRIDE_STEP) * _OVERRIDE_STEP

    def log_text(self, kind: str, text: str) -> None:
        """Write an entry with the current time and program line to the event log."""
        self.log_event(LogEvent(self.now, kind, text, self.line_number))

    def show_stop(self, code: AlarmCode, detail: str = "") -> None:
        """Show a feed hold, a stop or the E-stop until motion resumes, and log it.

        Only the first of consecutive single-block stops is logged, so that the others do not displace
        earlier entries.
        """
        if code == "single-block" == self._noted:
            self.stop = make_alarm(code, detail, self.line_number, self.now)
        else:
            self.stop = self.log_stop(code, detail)

    def log_stop(self, code: AlarmCode, detail: str = "") -> Alarm:
        """Log a stop without displaying it, and return it as an alarm entry."""
        stop = make_alarm(code, detail, self.line_number, self.now)
        self._noted = code
        kind = "estop" if code == "estop" else "stop"
        self.log_event(LogEvent(self.now, kind, format_log_line(stop), self.line_number, stop))
        return stop

    def log_event(self, event: LogEvent) -> None:
        """Pass an event to the event log. A failure of the log is reported but has no other effect."""
        with ErrorCatcher() as trial:
            self.handle_event(event)
        if trial.error is not None:
            _log.error("an event was lost: %s", event, exc_info=trial.error)

    def is_input_on(self, name: str) -> bool:
        """Return whether an input is on.

        ``name`` is the name of the input or its terminal, as used in a program.
        """
        if name in self.inputs:
            return self.inputs[name]
        for model in self.machine.inputs.values():
            if model.terminal == name:
                return self.inputs.get(model.name, False)
        return False

    def is_button_pressed(self, name: str) -> bool:
        """Return whether a jog button is pressed.

        On a machine with an enabling switch, this switch must be pressed too.
        """
        return self.inputs.get(name, False) and self.inputs.get(HANDWHEEL_ENABLE_INPUT, True)

    def is_in_position(self) -> bool:
        """Return whether all axes are at rest and within their in-position windows."""
        pairs = zip(self.machine.axes, self.axis_sample.following_error, strict=True)
        return not self.axis_sample.moving and all(
            abs(error) <= axis.in_position_tolerance for axis, error in pairs
        )
