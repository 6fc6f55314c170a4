"""Filtered signals of the operator station, and outputs together with their commanded states."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from core.machine.hardware_model import LAMP_NAMES
from core.machine.machine_model import OutputModel
from core.message import Message
from core.ports import DigitalIO, StationState

_SILENCE_TIMEOUT_S = (
    0.3  # s without data, after which the last value is used and a running cycle stops in feed hold
)
_JUMP_THRESHOLD = 0.2  # fraction of the range within 0.1 s that only a bad pot wiper can cause
_STABLE_TIME_S = 0.3  # s for which an increased value must be stable
_NOISY_JUMPS = 3  # jumps within 1 s after which a pot counts as faulty
_DEBOUNCE_S = 0.3  # s within which a second start counts as the same press
_MAX_ABSENCE_S = 0.3  # s between two readings; a press during a longer gap is too old to start a motion
_SETTLING_TIME_S = 0.5  # s for which a driver may still report the state before a write


class StationSignals(NamedTuple):
    """The filtered requests of the operator station in one tick."""

    is_estop_pressed: bool
    is_start_requested: bool  # both palm buttons, in this tick only
    is_hold_requested: bool  # while the hold button is pressed
    feed_override: float
    spindle: float
    is_spindle_in_auto: bool
    station_fault: str  # why the cycle must stop in feed hold; empty without a fault
    handwheel_count: int = 0  # counts of the handwheel
    was_spindle_switch_turned_on: bool = False  # the spindle switch was turned from OFF to AUTO in this tick
    connection_lost_reason: str = ""  # sentence about a missing part of the station, which causes a feed hold
    handwheel_fault: str = ""  # why handwheel and jog buttons are ignored
    spindle_load: float | None = None  # per cent
    # both palm buttons were pressed between two late readings, so the start is ignored
    was_late_start_detected: bool = False


class OverridePotFilter:
    """Filter for the readings of one override potentiometer.

    A decrease takes effect at once. A sudden increase takes effect only after the value has become stable.
    """

    def __init__(self) -> None:
        self.value = 1.0
        self._recent: deque[tuple[float, float]] = deque()  # readings of the last 0.1 s
        self._rising: tuple[float, float] | None = None
        self._jumps: deque[float] = deque()

    @property
    def is_noisy(self) -> bool:
        """Return whether the reading jumps too often to be caused by an operator."""
        return len(self._jumps) >= _NOISY_JUMPS

    def filter_reading(self, raw_value: float, now: float) -> float:
        """Return the filtered value for a raw reading at time ``now``."""
        self._count_jumps(raw_value, now)
        if raw_value <= self.value or self._slow(raw_value):
            self.value, self._rising = raw_value, None
        elif self._rising is None or abs(raw_value - self._rising[0]) > 0.05:
            self._rising = (raw_value, now)
        elif now - self._rising[1] >= _STABLE_TIME_S:
            self.value, self._rising = raw_value, None
        return self.value

    def _slow(self, raw: float) -> bool:
        return self._rising is None and raw - self.value <= _JUMP_THRESHOLD

    def _count_jumps(self, raw: float, now: float) -> None:
        while self._recent and self._recent[0][0] < now - 0.1:
            self._recent.popleft()
        if any(abs(raw - old) > _JUMP_THRESHOLD for _, old in self._recent):
            self._jumps.append(now)
            self._recent.clear()
        self._recent.append((now, raw))
        while self._jumps and self._jumps[0] < now - 1.0:
            self._jumps.popleft()


class StationSignalConverter:
    """Converter of raw operator station states to filtered requests."""

    def __init__(self) -> None:
        self._feed = OverridePotFilter()
        self._spindle = OverridePotFilter()
        self._started = True  # A start signal that is on at power-up does not count as a press.
        self._last_start = -1e9
        self._auto = True  # position of the spindle switch in the last message of the station
        self._spoke = -1e9  # time of the last message of the station

    def process_state(self, state: StationState, now: float) -> StationSignals:
        """Return the requests of the station for one reading at time ``now``."""
        silent = not (state.age <= _SILENCE_TIMEOUT_S and math.isfinite(state.feed_pot + state.spindle_pot))
        if not silent:
            self._feed.filter_reading(state.feed_pot, now)
            self._spindle.filter_reading(state.spindle_pot, now)
        live = not silent and now - self._spoke <= _MAX_ABSENCE_S
        pressed = state.start and not self._started and not silent
        edge = live and pressed
        turned = live and state.spindle_auto and not self._auto
        self._started = state.start
        if not silent:
            self._auto, self._spoke = state.spindle_auto, now
        noisy = self._feed.is_noisy or self._spindle.is_noisy
        fault_text = (
            "NO RESPONSE FROM OPERATOR STATION" if silent else "OVERRIDE SIGNAL UNSTABLE" if noisy else ""
        )
        return StationSignals(
            is_estop_pressed=state.estop,
            is_start_requested=edge and self.accept_start_press(now),
            is_hold_requested=state.hold,
            feed_override=self._feed.value,
            spindle=self._spindle.value,
            is_spindle_in_auto=self._auto,
            station_fault=fault_text,
            handwheel_count=state.handwheel,
            was_spindle_switch_turned_on=turned,
            connection_lost_reason=state.trouble,
            handwheel_fault=state.wheel_trouble,
            spindle_load=state.spindle_load,
            was_late_start_detected=pressed and not live,
        )

    def accept_start_press(self, now: float) -> bool:
        """Return whether a start signal is a new key press, not contact bounce.

        The time of a new key press is recorded.
        """
        fresh = now - self._last_start >= _DEBOUNCE_S
        if fresh:
            self._last_start = now
        return fresh


class OutputMismatch(NamedTuple):
    """An output whose actual state differs from its commanded state."""

    output_name: str
    is_commanded_on: bool

    @property
    def description(self) -> str:
        """Return a text for the operator that describes the change of the output."""
        name = self.output_name.upper()
        return (
            Message("{name} TURNED OFF", name=name)
            if self.is_commanded_on
            else Message("{name} TURNED ON", name=name)
        )


class CommandedOutputs:
    """Outputs that the executor writes, with their commanded states.

    The class implements ``core.ports.DigitalIO``.
    """

    def __init__(self, io: DigitalIO, models: Mapping[str, OutputModel]) -> None:
        self._io = io
        self._models = models
        self._lamps = (
            frozenset(LAMP_NAMES) & models.keys()
        )  # lamps are switched by the control, not by programs
        self._wanted = dict(self.get_outputs())
        # time of the last write of each output; some drivers report it late
        self._written: dict[str, float] = {}

    def inputs(self) -> Mapping[str, bool]:
        """Return the states of all inputs by name."""
        return self._io.inputs()

    def get_outputs(self) -> Mapping[str, bool]:
        """Return the actual states of the outputs by name, without the lamps of the signal tower."""
        outputs = self._io.get_outputs()
        return (
            {name: on for name, on in outputs.items() if name not in self._lamps} if self._lamps else outputs
        )

    def get_all_outputs(self) -> Mapping[str, bool]:
        """Return the actual states of all outputs by name, including the lamps."""
        return self._io.get_outputs()

    def write(self, name: str, is_on: bool) -> None:
        """Switch one output.

        If DriverError is raised, the commanded state of the output remains unchanged.
        """
        self._io.write(name, is_on)
        self._wanted[name] = is_on
        self._written[name] = self._now

    def switch_to_safe_state(self) -> None:
        """Switch every output to its safe state."""
        self._io.switch_to_safe_state()
        for model in self._models.values():
            if model.safe_state is not None and model.name not in self._lamps:
                self._wanted[model.name], self._written[model.name] = model.safe_state, self._now

    def set_write_time(self, now: float) -> None:
        """Set the time that is recorded for the outputs that are written from now on.

        The function is called at the beginning of each tick.
        """
        self._now = now

    def mark_outputs_switched_off(self, names: Sequence[str]) -> None:
        """Mark outputs as switched off by another device, even if they were written a moment ago."""
        for name in names:
            self._written.pop(name, None)

    def find_mismatches(self) -> list[OutputMismatch]:
        """Return the outputs that are not in their commanded state.

        An output is returned only after the permitted delay has passed.
        """
        actual = self._io.get_outputs()
        return [
            OutputMismatch(name, wanted)
            for name, wanted in self._wanted.items()
            if actual.get(name, wanted) is not wanted
            and self._now - self._written.get(name, -1e9) > _SETTLING_TIME_S
        ]

    def accept_actual_states(self) -> list[OutputMismatch]:
        """Adopt the actual states as commanded states; return the outputs that differed.

        The function is called when no program runs.
        """
        changed = self.find_mismatches()
        for each in changed:
            self._wanted[each.output_name] = not each.is_commanded_on
        return changed

    _now = 0.0
