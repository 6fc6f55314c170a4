"""Program transfer over a serial line: sending files, and receiving programs that are checked."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from app.compose.backends.serial_ports import open_wire, serial_ports
from app.desk.programs.program_loading import LoadingSteps
from app.programs.whole_file import FileError
from app.transfer.line_transfer import Received
from core.input_file import input_bytes
from core.language.source import LARGEST_FILE, Source, SourceError, load_source
from core.machine.desk_tables import DncModel
from core.message import Message
from core.ports import Clock, DriverError
from drivers.serial_line import LineSettings
from drivers.transfer.program_framing import Program, TransferSettings, outgoing
from drivers.transfer.transfer_session import Reach, Receiving, Sending
from drivers.waiting import RealClock

# Usual settings of a serial line; the operator chooses the port.
PLAIN = DncModel("", 9600, 8, "N", 1, "xonxoff", "%", "\r\n")
Check = Callable[[Source], tuple[tuple[str, ...], float]]  # errors, cycle time in s


class SerialLines:
    """Implementation of ``app.transfer.line_transfer.Lines``.

    ``check`` proves received programs, and ``ending`` is the suffix of their files.
    """

    def __init__(self, check: Check, ending: str = ".nc", clock: Clock | None = None) -> None:
        self._check, self._ending, self._clock = check, ending, clock or RealClock()

    def ports(self) -> Sequence[tuple[str, str]]:
        """Return the serial ports of this computer."""
        return serial_ports()

    def send(self, settings: DncModel, path: Path) -> SendingFile:
        """Return the transfer that sends the program in a file."""
        return SendingFile(settings_of(settings), path, self._clock)

    def receive(self, settings: DncModel) -> ReceivingProgram:
        """Return the transfer that receives a program."""
        return ReceivingProgram(settings_of(settings), self._clock, self._check, self._ending)


class _Carried:
    """A transfer whose serial line the worker opens; it can be canceled before that."""

    def __init__(self) -> None:
        self._inner: Sending | Receiving | None = None
        self._cancelled = False

    @property
    def reach(self) -> Reach:
        """Progress of the transfer."""
        return self._inner.reach if self._inner is not None else Reach()

    def cancel(self) -> None:
        """Cancel the transfer."""
        self._cancelled = True
        if self._inner is not None:
            self._inner.cancel()

    def _begin(self, inner: Sending | Receiving) -> None:
        self._inner = inner
        if self._cancelled:
            inner.cancel()


class SendingFile(_Carried):
    """Transfer that sends a file; its result is the number returned by ``run``."""

    def __init__(self, settings: TransferSettings, path: Path, clock: Clock) -> None:
        super().__init__()
        self._settings, self._path, self._clock = settings, path, clock

    def run(self) -> int:
        """Read the file, open the line and send. Raises FileError or DriverError."""
        try:
            text = input_bytes(self._path, LARGEST_FILE)
        except OSError as error:
            raise FileError(
                Message("{path} CANNOT BE READ: {cause}", path=self._path.name, cause=error.strerror)
            ) from error
        data = outgoing(text, self._settings)
        wire = open_wire(self._settings.sending)
        inner = Sending(wire, self._clock, self._settings, data)
        self._begin(inner)
        return inner.run()


class ReceivingProgram(_Carried):
    """Transfer that receives a program."""

    def __init__(self, settings: TransferSettings, clock: Clock, check: Check, ending: str) -> None:
        super().__init__()
        self._settings, self._clock, self._check, self._ending = settings, clock, check, ending

    def run(self) -> Received:
        """Receive a program and prove it. Raises FileError or DriverError; nothing is then saved."""
        inner = Receiving(open_wire(self._settings.receiving, watch=True), self._clock, self._settings)
        self._begin(inner)
        return self._looked_at(inner.run())

    def _looked_at(self, program: Program) -> Received:
        name = program.name or "RECEIVED"
        name = name if Path(name).suffix else name + self._ending
        source = _read(program.text, name)
        findings, cycle = self._check(source)
        return Received(
            text=source.text.encode("utf-8"),
            name=name,
            lines=program.lines,
            digest=program.digest,
            seven=program.seven,
            skipped=program.skipped,
            findings=findings,
            cycle=cycle,
        )


def settings_of(model: DncModel) -> TransferSettings:
    """Return the settings of the serial line and the data frame."""
    line = LineSettings(model.port, model.baud, model.bits, model.parity, model.stop, model.flow)
    return TransferSettings(line, model.wrap, model.eol, model.dc_codes, model.wait, model.leader)


def proving(workshop: LoadingSteps) -> Check:
    """Return a check that proves a program on this machine with the present offsets."""

    def check(source: Source) -> tuple[tuple[str, ...], float]:
        proved = workshop.prove(workshop.make_job(source, False), lambda _count: None)
        return proved.proof.errors, proved.proof.cycle_time

    return check


def _read(text: bytes, name: str) -> Source:
    """Return the received text as a program file is read. Raises DriverError if the text is not a program."""
    with tempfile.TemporaryDirectory(prefix="turndesk-") as folder:
        path = Path(folder) / name
        path.write_bytes(text)
        try:
            return load_source(path)
        except SourceError as error:
            raise DriverError("the received data is not a program: {error}", error=error) from error
