"""The pendant beside the machine's own station: its thread, what its events mean, and ``core.ports``.

The thread finds the device, reads it, and finds it again when it was unplugged. The pendant adds stops, holds
and counts. A press that comes late moves nothing: it has to be let go and pressed again. A release always
counts.
"""

from __future__ import annotations

import contextlib
import dataclasses
import select
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from app.extras.pendant.driver.input_devices import AxisRange, EventSource, InputEvent, Packet, Packets
from app.extras.pendant.driver.pendant_table import ABS, KEY, REL, Control
from core.ports import DigitalIO, DriverError, Station, StationState

_LISTEN = 0.05  # s that one look at the device lasts
_AGAIN = 0.5  # s between two looks for one that is away
_SILENT = 0.3  # s without a look of its thread after which nothing counts as held
ENDS = 1.0  # s that closing waits for the thread


@dataclass(frozen=True, slots=True)
class PendantState:
    """``inputs`` by the names of the machine file; ``away`` says why it is not read."""

    inputs: Mapping[str, bool]
    counts: int
    away: str
    broke: float  # when it was last lost, or had lost something


class Pendant:
    """``find`` opens the nodes of the device and raises DriverError where it cannot; ``now`` is the clock of
    their events. ``run`` is for a thread of its own, ``look`` for a test that has none.
    """

    def __init__(
        self,
        bound: Mapping[str, Control],
        stops: frozenset[str],
        wheel: Control | None,
        find: Callable[[], Sequence[EventSource]],
        now: Callable[[], float],
        *,
        place: bool = False,
        ring: Callable[[], None] = lambda: None,
    ) -> None:
        """``ring`` is called when something has changed."""
        self._ring = ring
        self._buttons = PendantButtons(bound, stops, wheel, place)
        self._find, self.now = find, now
        self._lock = threading.Lock()
        self._nodes: dict[EventSource, Packets] = {}
        self._away = "the search for the pendant has not started yet"
        self._broke = -1e9
        self._looked = 0.0
        self._ending = threading.Event()
        self._thread: threading.Thread | None = None

    def state(self) -> PendantState:
        """As it is now; from any thread."""
        with self._lock:
            buttons = self._buttons
            away = self._away
            if self._nodes and self.now() - self._looked > _SILENT:
                away = "the software thread that reads the pendant has stopped"
            held = {name: not away and name in buttons.down for name in buttons.bound}
            return PendantState(held, buttons.counts, away, self._broke)

    # --- its thread -----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Look for it once, so that whoever asks next is told; then go on in a thread."""
        self.look(0.0)
        self._thread = threading.Thread(target=self._run, name="pendant", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Let the device go."""
        self._ending.set()
        if self._thread is not None:
            self._thread.join(ENDS)
        self._drop("TurnDesk has stopped reading the pendant")

    def _run(self) -> None:
        while not self._ending.is_set():
            self.look(_LISTEN)
            if not self._nodes:
                self._ending.wait(_AGAIN)

    def look(self, seconds: float) -> None:
        """Take what comes within so long; where the device is away, look for it."""
        self._looked = self.now()
        if not self._nodes:
            self._open()
            return
        try:
            for node in select.select(list(self._nodes), (), (), seconds)[0]:
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
            self._nodes = {node: Packets() for node in nodes}
            self._buttons.begin(keys, ranges)
            self._away = ""
        self._ring()

    def _take(self, node: EventSource) -> None:
        data = node.read()
        if not data:
            raise OSError("the device was disconnected and returned no data")
        for packet in self._nodes[node].feed(data):
            again = _pressed(list(self._nodes)) if packet.lost else None
            with self._lock:
                if again is None:
                    self._buttons.take(packet, self.now())
                else:
                    self._buttons.begin(*again)
                    self._broke = self.now()
        self._ring()

    def _drop(self, why: str) -> None:
        nodes, self._nodes = self._nodes, {}
        with self._lock:
            self._buttons.gone()
            self._away, self._broke = why, self.now()
        self._ring()
        for node in nodes:
            with contextlib.suppress(OSError):
                node.close()


def _pressed(nodes: Sequence[EventSource]) -> tuple[set[int], dict[int, AxisRange]]:
    """What is down on all of them now. Raises OSError."""
    keys: set[int] = set()
    ranges: dict[int, AxisRange] = {}
    for node in nodes:
        keys |= node.keys()
        ranges |= node.ranges()
    return keys, ranges


# --- The ports.


_TOLD = 0.3  # s for which something that happened once is told: a control that looks every tick has seen it
LOST = "pendant events were lost; the handwheel may have turned farther than TurnDesk counted"


class PendantStation:
    """``core.ports.Station``. Where the pendant carries a stop it must be there: no cycle runs without it.

    Where it does not, pulling it out holds once. Nothing here can start anything.
    """

    def __init__(self, station: Station, pendant: Pendant, *, stops: bool, wheel: bool) -> None:
        self._station, self._pendant = station, pendant
        self._stops, self._wheel = stops, wheel

    @property
    def away(self) -> str:
        """Why the pendant is not read; empty when it is."""
        return self._pendant.state().away

    def snapshot(self) -> StationState:
        """The station now."""
        state, pendant = self._station.snapshot(), self._pendant.state()
        just = self._pendant.now() - pendant.broke < _TOLD
        lost = pendant.away if pendant.away and (self._stops or just) else ""
        return dataclasses.replace(
            state,
            hold=state.hold or pendant.inputs.get("hold", False),
            handwheel=state.handwheel + pendant.counts,
            trouble=state.trouble or lost,
            wheel_trouble=state.wheel_trouble or (self._of_wheel(pendant, just=just) if self._wheel else ""),
        )

    @staticmethod
    def _of_wheel(pendant: PendantState, *, just: bool) -> str:
        return pendant.away or (LOST if just else "")


class PendantIO:
    """``core.ports.DigitalIO``: the buttons of the pendant are inputs as any other."""

    def __init__(self, io: DigitalIO, pendant: Pendant) -> None:
        self._io, self._pendant = io, pendant

    def inputs(self) -> Mapping[str, bool]:
        """Those of the machine and those of the pendant."""
        return {**self._io.inputs(), **self._pendant.state().inputs}

    def outputs(self) -> Mapping[str, bool]:
        """A pendant has none."""
        return self._io.outputs()

    def write(self, name: str, on: bool) -> None:
        """Raises DriverError as the machine's."""
        self._io.write(name, on)

    def safe(self) -> None:
        """Every output to its safe state."""
        self._io.safe()


LATE = 0.1  # s from the kernel to here; what is older was done to a machine that looked different
# --- What its events mean: buttons that are held, clicks that are counted, and what must not count.


_PRESSED, _FREE = 0.6, 0.3  # of the way to the end of an axis: down from the first on, up at the second
_PLACES = 256  # of a dial that tells its place; the kernel swallows its 0: a click that comes with the next
_REPEAT = 2  # value of a key that repeats by itself


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
