"""The pendant's thread: finds the device, reads it, and finds it again when it was unplugged."""

from __future__ import annotations

import contextlib
import select
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from app.extras.pendant.driver.input_codes import Control
from app.extras.pendant.driver.input_devices import EventSource
from app.extras.pendant.driver.input_events import Packets
from app.extras.pendant.driver.pendant_buttons import AxisRange, PendantButtons
from core.ports import DriverError

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
