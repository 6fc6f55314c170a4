"""Gauge on a serial port. A thread receives readings in Digimatic format or as plain numbers."""

from __future__ import annotations

import queue
import re
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from app.compose.backends.serial_ports import open_serial_port
from app.desk.translation import tr
from app.extras.quality.gauge_table import GaugeModel
from core.message import CodedError, Message
from core.ports import DriverError
from drivers.serial_line import LineSettings, SerialTransport

MAX_LINE_LENGTH = 60  # characters; a longer line without an end is not from a gauge
_DIGIMATIC = re.compile(r"\d{2}A([+-]\d{1,8}(?:\.\d{1,8})?)")
_PLAIN = re.compile(r"([+-]?(?:\d{1,6}(?:[.,]\d{0,7})?|[.,]\d{1,7}))\s*(mm|in|inch|\"|)", re.IGNORECASE)
_UNITS = {"mm": "mm", "in": "in", "inch": "in", '"': "in", "": ""}
# Error codes of a Mitutoyo interface.
_ERRORS = {
    "911": ("the gauge is not connected or is switched off", "no-gauge"),
    "912": ("the gauge sent unreadable data", "unreadable"),
}


class GaugeError(CodedError, ValueError):
    """Error raised if a received line does not contain a reading."""


@dataclass(frozen=True, slots=True)
class GaugeReading:
    """Reading of a gauge.

    ``unit`` is mm or in, or an empty string if the received line contains no unit.
    """

    value: float
    unit: str = ""


def parse_reading(line: str) -> GaugeReading:
    """Return the gauge reading in a received line.

    Raises GaugeError if the line does not contain a reading.
    """
    text = line.strip()
    if text in _ERRORS:
        raise GaugeError(*_ERRORS[text])
    digimatic = _DIGIMATIC.fullmatch(text)
    if digimatic:
        return GaugeReading(float(digimatic.group(1)))
    plain = _PLAIN.fullmatch(text)
    if plain is None:
        raise GaugeError(f"it has sent {text[:24]!r}, which is no reading", "not-a-reading")
    return GaugeReading(float(plain.group(1).replace(",", ".")), _UNITS[plain.group(2).lower()])


class LineSplitter:
    """Buffer that splits received bytes into lines at CR or LF."""

    def __init__(self) -> None:
        self._text = ""

    def split_lines(self, data: bytes) -> list[str]:
        """Add received bytes, and return the lines that they complete.

        An incomplete line is buffered, but it is returned as it is if it is too long.
        """
        self._text += data.decode("ascii", "replace")
        *whole, self._text = re.split(r"[\r\n]+", self._text)
        if len(self._text) > MAX_LINE_LENGTH:
            whole.append(self._text)
            self._text = ""
        return [line for line in whole if line.strip()]


class Gauge(Protocol):
    """Interface of a gauge.

    No method blocks.
    """

    @property
    def is_receiving(self) -> bool:
        """Return whether TurnDesk is receiving data from the gauge."""
        ...

    @property
    def name(self) -> str:
        """Return the name of the gauge from the machine file, which is stored with the readings."""
        ...

    @property
    def default_unit(self) -> str:
        """Return the unit of received lines that contain no unit, mm or in."""
        ...

    @property
    def status_text(self) -> str:
        """Return the reception status as text: on or off, and the number or age of the readings."""
        ...

    def toggle_receiving(self) -> str:
        """Start or stop receiving data.

        Returns an empty string, or the reason if receiving is not possible.
        """
        ...

    def fetch_readings(self) -> Sequence[GaugeReading | str]:
        """Return the readings and error messages that have arrived since the last call."""
        ...

    def close(self) -> None:
        """Stop receiving, so that the serial port can be closed."""
        ...


class NoGauge:
    """Implementation of ``Gauge`` for a machine without a gauge in its machine file."""

    is_receiving = False
    name = ""
    default_unit = "mm"

    @property
    def status_text(self) -> str:
        """Return a text that explains how to configure a gauge."""
        return tr("No gauge is configured: enter its serial port under [gauge] in the machine file.")

    def toggle_receiving(self) -> str:
        """Return the reason why TurnDesk cannot receive readings."""
        return tr("NO GAUGE IN THE MACHINE FILE. ADD [gauge] port = …")

    def fetch_readings(self) -> Sequence[GaugeReading | str]:
        """Return an empty tuple because no gauge is connected."""
        return ()

    def close(self) -> None:
        """Do nothing because no port is open."""


RECEIVE_TIMEOUT_S = 0.1  # seconds of one receive call
SILENCE_LIMIT_S = 300.0  # seconds without a line before the status text mentions it
PortOpener = Callable[[LineSettings], SerialTransport]


class SerialGauge:
    """Implementation of ``Gauge`` for a serial port. A thread opens and closes the port."""

    def __init__(
        self,
        settings: GaugeModel,
        open_port: PortOpener = open_serial_port,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._model, self._open_wire, self._clock = settings, open_port, clock
        self._heard: queue.SimpleQueue[GaugeReading | str] = queue.SimpleQueue()
        self._ending = threading.Event()
        self._thread: threading.Thread | None = None
        self._last = 0.0  # time of the last line, or of the start
        self._count = 0

    @property
    def is_receiving(self) -> bool:
        """Return whether TurnDesk is receiving data from the gauge."""
        return self._thread is not None and self._thread.is_alive() and not self._ending.is_set()

    @property
    def name(self) -> str:
        """Return the name of the gauge from the machine file."""
        return self._model.name

    @property
    def default_unit(self) -> str:
        """Return the unit of received lines that contain no unit, mm or in."""
        return self._model.unit

    @property
    def status_text(self) -> str:
        """Return the reception status as text: on or off, and whether readings arrive."""
        if not self.is_receiving:
            return tr("Not listening to the gauge. Press F5 to start.")
        silent = self._clock() - self._last
        if silent > SILENCE_LIMIT_S:
            return tr(
                Message(
                    "No reading from the gauge for {minutes} min. Check its switch and cable.",
                    minutes=int(silent / 60.0),
                )
            )
        return tr(Message("Listening to the gauge: {count} readings.", count=self._count))

    def toggle_receiving(self) -> str:
        """Start or stop receiving data, and return an empty string because this is always possible."""
        if self.is_receiving:
            self.close()
            return ""
        self._ending = threading.Event()
        self._last, self._count = self._clock(), 0
        self._thread = threading.Thread(target=self._listen, args=(self._ending,), name="gauge", daemon=True)
        self._thread.start()
        return ""

    def fetch_readings(self) -> Sequence[GaugeReading | str]:
        """Return the readings and error messages that have arrived since the last call."""
        found = []
        while not self._heard.empty():
            found.append(self._heard.get())
        return found

    def close(self) -> None:
        """Stop receiving data.

        The thread then closes the port.
        """
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
            reader = LineSplitter()
            wire.discard_input()
            while not ending.is_set():
                for line in reader.split_lines(wire.receive(RECEIVE_TIMEOUT_S)):
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
            self._heard.put(parse_reading(line))
            self._count += 1
        except ValueError as error:
            self._heard.put(tr(Message("GAUGE: {why}. MEASURE AGAIN", why=error)))
