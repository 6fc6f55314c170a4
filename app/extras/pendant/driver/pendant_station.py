"""Pendant of the operator station: reader thread, buttons, and implementations of ``core.ports``.

The thread finds and reads the device, and searches for it again after it was unplugged. The pendant adds
stops, feed hold and handwheel counts to the operator station. A press that arrives late has no effect until
the button is released and pressed again. A release always has an effect.
"""

from __future__ import annotations

import contextlib
import dataclasses
import select
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from app.extras.pendant.driver.input_devices import (
    AxisRange,
    EventPacket,
    EventSource,
    InputEvent,
    PacketParser,
)
from app.extras.pendant.driver.pendant_table import ABS, KEY, REL, PendantControl
from core.ports import DigitalIO, DriverError, OperatorStation, StationState

_LISTEN = 0.05  # seconds of one read of the device
_AGAIN = 0.5  # seconds between two searches for a missing device
_SILENT = 0.3  # seconds without a read by the thread after which no button counts as pressed
CLOSE_TIMEOUT_S = 1.0  # seconds that closing waits for the thread


@dataclass(frozen=True, slots=True)
class PendantState:
    """State of the pendant at one point in time.

    ``input_states`` are by input name in the machine file. ``missing_reason`` is the reason why TurnDesk
    cannot read the pendant, or an empty string.
    """

    input_states: Mapping[str, bool]
    wheel_counts: int
    missing_reason: str
    last_lost_time_s: float  # time at which the device or events were last lost


class PendantReader:
    """Reader of a pendant.

    ``open_device`` opens the nodes of the device, or raises DriverError. ``read_clock`` reads the clock of
    the event time stamps. ``start`` reads the device in a separate thread. A test can call
    ``process_events`` without a thread.
    """

    def __init__(
        self,
        control_by_name: Mapping[str, PendantControl],
        stop_inputs: frozenset[str],
        wheel: PendantControl | None,
        open_device: Callable[[], Sequence[EventSource]],
        read_clock: Callable[[], float],
        *,
        has_absolute_wheel: bool = False,
        report_change: Callable[[], None] = lambda: None,
    ) -> None:
        """Create the reader.

        ``report_change`` is called after each change.
        """
        self._ring = report_change
        self._buttons = PendantButtons(control_by_name, stop_inputs, wheel, has_absolute_wheel)
        self._find, self.read_clock = open_device, read_clock
        self._lock = threading.Lock()
        self._nodes: dict[EventSource, PacketParser] = {}
        self._away = "the search for the pendant has not started yet"
        self._broke = -1e9
        self._looked = 0.0
        self._ending = threading.Event()
        self._thread: threading.Thread | None = None

    def get_state(self) -> PendantState:
        """Return the current state of the pendant.

        This method can be called from any thread.
        """
        with self._lock:
            buttons = self._buttons
            away = self._away
            if self._nodes and self.read_clock() - self._looked > _SILENT:
                away = "the software thread that reads the pendant has stopped"
            held = {
                name: not away and name in buttons.pressed_button_names for name in buttons.controls_by_name
            }
            return PendantState(held, buttons.wheel_counts, away, self._broke)

    # --- thread ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Search for the device once, so that its state is known, and then start the thread."""
        self.process_events(0.0)
        self._thread = threading.Thread(target=self._run, name="pendant", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop the thread and close the device."""
        self._ending.set()
        if self._thread is not None:
            self._thread.join(CLOSE_TIMEOUT_S)
        self._drop("TurnDesk has stopped reading the pendant")

    def _run(self) -> None:
        while not self._ending.is_set():
            self.process_events(_LISTEN)
            if not self._nodes:
                self._ending.wait(_AGAIN)

    def process_events(self, timeout_s: float) -> None:
        """Wait for events and process them. If the device is missing, search for it instead.

        ``timeout_s`` is the maximum waiting time in seconds.
        """
        self._looked = self.read_clock()
        if not self._nodes:
            self._open()
            return
        try:
            for node in select.select(list(self._nodes), (), (), timeout_s)[0]:
                self._take(node)
        except (OSError, ValueError):
            self._drop("the pendant was unplugged: plug it in again")

    def _open(self) -> None:
        try:
            nodes = self._find()
        except DriverError as error:
            with self._lock:
                self._away = str(error)
            return
        try:
            keys, ranges = _pressed(nodes)
        except OSError:
            for node in nodes:
                node.close()
            return
        with self._lock:
            self._nodes = {node: PacketParser() for node in nodes}
            self._buttons.set_initial_state(keys, ranges)
            self._away = ""
        self._ring()

    def _take(self, node: EventSource) -> None:
        data = node.read()
        if not data:
            raise OSError("the device was disconnected and returned no data")
        for packet in self._nodes[node].parse(data):
            again = _pressed(list(self._nodes)) if packet.has_lost_events else None
            with self._lock:
                if again is None:
                    self._buttons.apply_packet(packet, self.read_clock())
                else:
                    self._buttons.set_initial_state(*again)
                    self._broke = self.read_clock()
        self._ring()

    def _drop(self, why: str) -> None:
        nodes, self._nodes = self._nodes, {}
        with self._lock:
            self._buttons.release_all_buttons()
            self._away, self._broke = why, self.read_clock()
        self._ring()
        for node in nodes:
            with contextlib.suppress(OSError):
                node.close()


def _pressed(nodes: Sequence[EventSource]) -> tuple[set[int], dict[int, AxisRange]]:
    """Return the pressed keys and the axis ranges of all nodes.

    Raises OSError if the device is disconnected.
    """
    keys: set[int] = set()
    ranges: dict[int, AxisRange] = {}
    for node in nodes:
        keys |= node.read_pressed_keys()
        ranges |= node.read_axis_ranges()
    return keys, ranges


# --- Ports. ---


_TOLD = 0.3  # seconds for which a single event is reported, so that a control that polls each tick detects it
LOST_EVENTS_MESSAGE = "pendant events were lost; the handwheel may have turned farther than TurnDesk counted"


class PendantStation:
    """Implementation of ``core.ports.OperatorStation`` for an operator station with a pendant.

    If the pendant has a stop button, no cycle can run while the pendant is missing. Without a stop button,
    unplugging the pendant causes one feed hold. The pendant cannot start motion.
    """

    def __init__(
        self, station: OperatorStation, pendant: PendantReader, *, has_stops: bool, has_wheel: bool
    ) -> None:
        self._station, self._pendant = station, pendant
        self._stops, self._wheel = has_stops, has_wheel

    @property
    def missing_reason(self) -> str:
        """Return the reason why TurnDesk cannot read the pendant, or an empty string if it can."""
        return self._pendant.get_state().missing_reason

    def read_state(self) -> StationState:
        """Return the state of the station, including the pendant."""
        state, pendant = self._station.read_state(), self._pendant.get_state()
        just = self._pendant.read_clock() - pendant.last_lost_time_s < _TOLD
        lost = pendant.missing_reason if pendant.missing_reason and (self._stops or just) else ""
        return dataclasses.replace(
            state,
            hold=state.hold or pendant.input_states.get("hold", False),
            handwheel=state.handwheel + pendant.wheel_counts,
            trouble=state.trouble or lost,
            wheel_trouble=state.wheel_trouble or (self._of_wheel(pendant, just=just) if self._wheel else ""),
        )

    @staticmethod
    def _of_wheel(pendant: PendantState, *, just: bool) -> str:
        return pendant.missing_reason or (LOST_EVENTS_MESSAGE if just else "")


class PendantIO:
    """Implementation of ``core.ports.DigitalIO`` that adds the buttons of the pendant as inputs."""

    def __init__(self, io: DigitalIO, pendant: PendantReader) -> None:
        self._io, self._pendant = io, pendant

    def inputs(self) -> Mapping[str, bool]:
        """Return the inputs of the machine and of the pendant."""
        return {**self._io.inputs(), **self._pendant.get_state().input_states}

    def get_outputs(self) -> Mapping[str, bool]:
        """Return the outputs of the machine.

        A pendant has no outputs.
        """
        return self._io.get_outputs()

    def write(self, name: str, is_on: bool) -> None:
        """Write an output of the machine.

        Raises DriverError if the output cannot be written.
        """
        self._io.write(name, is_on)

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state."""
        self._io.switch_to_safe_state()


MAX_EVENT_AGE_S = (
    0.1  # seconds from the kernel to this code; older presses belong to an earlier state of the machine
)
# --- Meaning of events: pressed buttons, counted detents, and ignored events. ---------------------


_PRESSED, _FREE = 0.6, 0.3  # ratios to the end of an axis: pressed from the first, released below the second
_PLACES = 256  # positions of a dial; the kernel omits position 0, so that detent is counted with the next one
_REPEAT = 2  # value of an automatic key repeat


@dataclass(slots=True)
class PendantButtons:
    """Buttons and handwheel of the pendant.

    - ``control_by_name`` maps names of the machine file to controls.
    - ``stop_inputs`` are the inputs whose presses take effect even if they arrive late.
    - ``pressed_button_names`` are the pressed buttons, and ``wheel_counts`` is the handwheel count.
    - ``has_absolute_wheel`` means that the wheel reports positions instead of steps.
    """

    controls_by_name: Mapping[str, PendantControl]
    stop_input_names: frozenset[str]
    wheel_control: PendantControl | None = None
    has_absolute_wheel: bool = False
    wheel_counts: int = 0
    pressed_button_names: set[str] = field(default_factory=set)
    ineffective_button_names: set[str] = field(
        default_factory=set
    )  # pressed, but without effect until they are released
    axis_ranges: dict[int, AxisRange] = field(default_factory=dict)
    _at: int | None = None  # position of a wheel that reports positions

    def set_initial_state(self, keys: Iterable[int], ranges: Mapping[int, AxisRange]) -> None:
        """Set the current state of the buttons and axes after the device was opened.

        Buttons that are already pressed have no effect, except stop buttons.
        """
        self.axis_ranges = dict(ranges)
        pressed, self._at = set(keys), None
        held = {name for name, control in self.controls_by_name.items() if self._held(control, pressed)}
        self.pressed_button_names = held & self.stop_input_names
        self.ineffective_button_names = held - self.stop_input_names
        if (
            self.wheel_control is not None
            and self.wheel_control.event_kind == ABS
            and self.wheel_control.event_code in self.axis_ranges
        ):
            self._at = self.axis_ranges[self.wheel_control.event_code].value

    def release_all_buttons(self) -> None:
        """Release all buttons and discard the wheel position, because the device is disconnected."""
        self.pressed_button_names.clear()
        self.ineffective_button_names.clear()
        self._at = None

    def apply_packet(self, packet: EventPacket, now_s: float) -> None:
        """Apply the events of a packet to the buttons and the handwheel.

        ``now_s`` is the current time in seconds on the clock of the event time stamps.
        """
        for event in packet.events:
            late = now_s - event.time_s > MAX_EVENT_AGE_S
            if (
                self.wheel_control is not None
                and (event.event_kind, event.event_code) == self.wheel_control[:2]
            ):
                self._turn(event, late)
            for name, control in self.controls_by_name.items():
                if (event.event_kind, event.event_code) == control[:2]:
                    self._press(name, control, event, late)

    def _press(self, name: str, control: PendantControl, event: InputEvent, late: bool) -> None:
        if control.event_kind == KEY:
            if event.value == _REPEAT:
                return
            pressed = event.value != 0
        else:
            self._keep(event)
            share = self._share(control)
            pressed = share >= _PRESSED or (
                share > _FREE and name in self.pressed_button_names | self.ineffective_button_names
            )
        if not pressed:
            self.pressed_button_names.discard(name)
            self.ineffective_button_names.discard(name)
        elif name in self.stop_input_names or not late:
            if name not in self.ineffective_button_names:
                self.pressed_button_names.add(name)
        elif name not in self.pressed_button_names:
            self.ineffective_button_names.add(name)

    def _turn(self, event: InputEvent, late: bool) -> None:
        if event.event_kind == REL and not self.has_absolute_wheel:
            self.wheel_counts += 0 if late else event.value
            return
        if event.event_kind == ABS:
            self._keep(event)
        reach = self.axis_ranges.get(event.event_code) if event.event_kind == ABS else None
        size = reach.maximum - reach.minimum + 1 if reach is not None else _PLACES
        last, self._at = self._at, event.value
        if last is not None and not late and size > 1:
            self.wheel_counts += (event.value - last + size // 2) % size - size // 2

    def _keep(self, event: InputEvent) -> None:
        reach = self.axis_ranges.get(event.event_code)
        if reach is not None:
            self.axis_ranges[event.event_code] = reach._replace(value=event.value)

    def _held(self, control: PendantControl, keys: set[int]) -> bool:
        if control.event_kind == KEY:
            return control.event_code in keys
        return self._share(control) > _FREE

    def _share(self, control: PendantControl) -> float:
        """Return the deflection of an axis toward a control, as a fraction of half the axis range.

        The result is negative if the axis is deflected away from the control.
        """
        reach = self.axis_ranges.get(control.event_code)
        if reach is None or reach.maximum <= reach.minimum:
            return 0.0
        middle, half = (reach.maximum + reach.minimum) / 2.0, (reach.maximum - reach.minimum) / 2.0
        return control.axis_end * (reach.value - middle) / half
