"""The gauge of a machine file: a thread listens to its serial line and reads Digimatic or plain values."""

from __future__ import annotations

import queue
import re
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from app.compose.backends.serial_ports import open_wire
from app.desk.translation import tr
from app.extras.quality.gauge_table import GaugeModel
from core.message import CodedError, Message
from core.ports import DriverError
from drivers.serial_line import LineSettings, Wire

LONGEST = 60  # characters of a line; more without an end is no gauge
_DIGIMATIC = re.compile(r"\d{2}A([+-]\d{1,8}(?:\.\d{1,8})?)")
_PLAIN = re.compile(r"([+-]?(?:\d{1,6}(?:[.,]\d{0,7})?|[.,]\d{1,7}))\s*(mm|in|inch|\"|)", re.IGNORECASE)
_UNITS = {"mm": "mm", "in": "in", "inch": "in", '"': "in", "": ""}
# What an interface of Mitutoyo answers instead of a value.
_ERRORS = {
    "911": ("the gauge is not connected or is switched off", "no-gauge"),
    "912": ("the gauge sent unreadable data", "unreadable"),
}


class GaugeError(CodedError, ValueError):
    """A line of a gauge that is not a reading."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A value as it was sent; ``unit`` mm or in, empty where the line does not say it."""

    value: float
    unit: str = ""


def reading_of(line: str) -> Reading:
    """The value of one line. Raises GaugeError for anything else."""
    text = line.strip()
    if text in _ERRORS:
        raise GaugeError(*_ERRORS[text])
    digimatic = _DIGIMATIC.fullmatch(text)
    if digimatic:
        return Reading(float(digimatic.group(1)))
    plain = _PLAIN.fullmatch(text)
    if plain is None:
        raise GaugeError(f"it has sent {text[:24]!r}, which is no reading", "not-a-reading")
    return Reading(float(plain.group(1).replace(",", ".")), _UNITS[plain.group(2).lower()])


class LineReader:
    """Bytes as they come, cut into lines at CR or LF."""

    def __init__(self) -> None:
        self._text = ""

    def lines(self, data: bytes) -> list[str]:
        """Whole lines; what is unfinished waits, and goes where it is longer than any line."""
        self._text += data.decode("ascii", "replace")
        *whole, self._text = re.split(r"[\r\n]+", self._text)
        if len(self._text) > LONGEST:
            whole.append(self._text)
            self._text = ""
        return [line for line in whole if line.strip()]


class Gauge(Protocol):
    """A gauge on a serial line. Nothing here waits."""

    @property
    def open(self) -> bool:
        """Whether its line is listened to."""
        ...

    @property
    def name(self) -> str:
        """As the machine file calls it, kept with its readings."""
        ...

    @property
    def unit(self) -> str:
        """Of lines that do not say it, mm or in."""
        ...

    @property
    def words(self) -> str:
        """Whether it is listened to, and when it was heard last."""
        ...

    def turn(self) -> str:
        """Listen, or no more; why not, empty when it does."""
        ...

    def received(self) -> Sequence[Reading | str]:
        """What has come since the last look: readings, and sentences of what is wrong."""
        ...

    def close(self) -> None: ...


class NoGauge:
    """A machine whose file names no gauge."""

    open = False
    name = ""
    unit = "mm"

    @property
    def words(self) -> str:
        """How a gauge would be wired."""
        return tr("No gauge is configured: enter its serial port under [gauge] in the machine file.")

    def turn(self) -> str:
        """There is none."""
        return tr("NO GAUGE IN THE MACHINE FILE. ADD [gauge] port = …")

    def received(self) -> Sequence[Reading | str]:
        """Nothing ever comes."""
        return ()

    def close(self) -> None:
        """Nothing is open."""


LISTEN = 0.1  # s that one look at the line lasts
SILENT = 300.0  # s without a line after which the note says so
Open = Callable[[LineSettings], Wire]


class GaugeWire:
    """``app.extras.quality.gauge_wire.Gauge``. The line is opened and closed on its own thread."""

    def __init__(
        self, model: GaugeModel, wire: Open = open_wire, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._model, self._open_wire, self._clock = model, wire, clock
        self._heard: queue.SimpleQueue[Reading | str] = queue.SimpleQueue()
        self._ending = threading.Event()
        self._thread: threading.Thread | None = None
        self._last = 0.0  # when a line came, or listening began
        self._count = 0

    @property
    def open(self) -> bool:
        """Whether its line is listened to."""
        return self._thread is not None and self._thread.is_alive() and not self._ending.is_set()

    @property
    def name(self) -> str:
        """As the machine file calls it."""
        return self._model.name

    @property
    def unit(self) -> str:
        """Of lines that do not say theirs."""
        return self._model.unit

    @property
    def words(self) -> str:
        """Whether it is listened to, and whether it speaks."""
        if not self.open:
            return tr("Not listening to the gauge. Press F5 to start.")
        silent = self._clock() - self._last
        if silent > SILENT:
            return tr(
                Message(
                    "No reading from the gauge for {minutes} min. Check its switch and cable.",
                    minutes=int(silent / 60.0),
                )
            )
        return tr(Message("Listening to the gauge: {count} readings.", count=self._count))

    def turn(self) -> str:
        """Listen, or no more."""
        if self.open:
            self.close()
            return ""
        self._ending = threading.Event()
        self._last, self._count = self._clock(), 0
        self._thread = threading.Thread(target=self._listen, args=(self._ending,), name="gauge", daemon=True)
        self._thread.start()
        return ""

    def received(self) -> Sequence[Reading | str]:
        """What has come since the last look."""
        found = []
        while not self._heard.empty():
            found.append(self._heard.get())
        return found

    def close(self) -> None:
        """Listen no more; the thread closes the line."""
        self._ending.set()

    def _listen(self, ending: threading.Event) -> None:
        model = self._model
        settings = LineSettings(model.port, model.baud, model.bits, model.parity, model.stop)
        try:
            wire = self._open_wire(settings)
        except DriverError as error:
            self._tell(error)
            return
        try:
            reader = LineReader()
            wire.discard()
            while not ending.is_set():
                for line in reader.lines(wire.receive(LISTEN)):
                    self._take(line)
        except DriverError as error:
            self._tell(error)
        finally:
            wire.close()

    def _tell(self, error: DriverError) -> None:
        self._heard.put(tr(Message("GAUGE: {why}. F5: LISTEN AGAIN", why=error)))

    def _take(self, line: str) -> None:
        self._last = self._clock()
        try:
            self._heard.put(reading_of(line))
            self._count += 1
        except ValueError as error:
            self._heard.put(tr(Message("GAUGE: {why}. MEASURE AGAIN", why=error)))
