"""Transfer of programs over a serial line: sending files, and receiving and checking programs."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from app.compose.backends.serial_ports import list_serial_ports, open_serial_port
from app.desk.command_errors import CommandError
from app.desk.programs.program_loading import LoadingSteps
from app.programs.atomic_files import FileOperationError
from app.transfer.line_transfer import ReceivedProgram
from core.input_file import read_input_bytes
from core.language.source import MAX_FILE_BYTES, ProgramSource, SourceError, load_source
from core.machine.serial_and_backup_tables import SerialLineModel
from core.message import Message
from core.ports import Clock, DriverError
from drivers.serial_line import LineSettings
from drivers.transfer.program_framing import ReceivedText, TransferSettings, encode_program
from drivers.transfer.transfer_session import ReceiveTransfer, SendTransfer, TransferState
from drivers.wakeups import RealClock

# Usual settings of a serial line; the operator chooses the port.
DEFAULT_SETTINGS = SerialLineModel("", 9600, 8, "N", 1, "xonxoff", "%", "\r\n")
# Returns the errors and the cycle time in s. Raises CommandError if the offsets cannot be read.
CheckProgram = Callable[[ProgramSource], tuple[tuple[str, ...], float]]


class SerialPortLines:
    """Implementation of ``app.transfer.line_transfer.Lines``.

    ``check_program`` proves received programs. ``file_suffix`` is the suffix of the files in which they are
    saved.
    """

    def __init__(
        self, check_program: CheckProgram, file_suffix: str = ".nc", clock: Clock | None = None
    ) -> None:
        self._check, self._ending, self._clock = check_program, file_suffix, clock or RealClock()

    def list_ports(self) -> Sequence[tuple[str, str]]:
        """Return the device and the description of each serial port of this computer."""
        return list_serial_ports()

    def make_send_transfer(self, settings: SerialLineModel, path: Path) -> FileSendTransfer:
        """Return a transfer that sends the program in a file."""
        return FileSendTransfer(make_transfer_settings(settings), path, self._clock)

    def make_receive_transfer(self, settings: SerialLineModel) -> ProgramReceiveTransfer:
        """Return a transfer that receives a program."""
        return ProgramReceiveTransfer(
            make_transfer_settings(settings), self._clock, self._check, self._ending
        )


class _LineTransfer:
    """A transfer over a serial line, which can be canceled before the worker opens the line."""

    def __init__(self) -> None:
        self._inner: SendTransfer | ReceiveTransfer | None = None
        self._cancelled = False

    @property
    def progress(self) -> TransferState:
        """Return the progress of the transfer."""
        return self._inner.progress if self._inner is not None else TransferState()

    def cancel(self) -> None:
        """Cancel the transfer, or prevent its start."""
        self._cancelled = True
        if self._inner is not None:
            self._inner.cancel()

    def _begin(self, inner: SendTransfer | ReceiveTransfer) -> None:
        self._inner = inner
        if self._cancelled:
            inner.cancel()


class FileSendTransfer(_LineTransfer):
    """Transfer that sends a program file. The result is the number of bytes sent."""

    def __init__(self, settings: TransferSettings, path: Path, clock: Clock) -> None:
        super().__init__()
        self._settings, self._path, self._clock = settings, path, clock

    def run_transfer(self) -> int:
        """Read and send the file, and return the number of bytes sent, including markers and tape codes.

        Raises FileOperationError if the file cannot be read. Raises DriverError if its text cannot be sent,
        or if the transfer fails or is canceled.
        """
        try:
            text = read_input_bytes(self._path, MAX_FILE_BYTES)
        except OSError as error:
            raise FileOperationError(
                Message("{path} CANNOT BE READ: {cause}", path=self._path.name, cause=error.strerror)
            ) from error
        data = encode_program(text, self._settings)
        wire = open_serial_port(self._settings.sending_settings)
        inner = SendTransfer(wire, self._clock, self._settings, data)
        self._begin(inner)
        return inner.send_program()


class ProgramReceiveTransfer(_LineTransfer):
    """Transfer that receives and proves a program."""

    def __init__(
        self, settings: TransferSettings, clock: Clock, check_program: CheckProgram, file_suffix: str
    ) -> None:
        super().__init__()
        self._settings, self._clock, self._check, self._ending = settings, clock, check_program, file_suffix

    def run_transfer(self) -> ReceivedProgram:
        """Receive a program and prove it, without saving any data.

        If the program cannot be proved, for example because stored offsets cannot be read, the result
        contains the reason as a finding. Raises DriverError if the transfer fails or is canceled, or if the
        received data is not a program.
        """
        inner = ReceiveTransfer(
            open_serial_port(self._settings.receiving_settings, count_damaged=True),
            self._clock,
            self._settings,
        )
        self._begin(inner)
        return self._looked_at(inner.receive_program())

    def _looked_at(self, program: ReceivedText) -> ReceivedProgram:
        name = program.program_name or "RECEIVED"
        name = name if Path(name).suffix else name + self._ending
        source = _create_source(program.program_bytes, name)
        try:
            findings, cycle = self._check(source)
        except CommandError as error:  # The offsets are damaged; the program must not be lost for that.
            findings, cycle = (str(error),), 0.0
        return ReceivedProgram(
            program_bytes=source.text.encode("utf-8"),
            file_name=name,
            line_count=program.line_count,
            sha256=program.sha256,
            is_seven_bit=program.is_seven_bit,
            skipped_byte_count=program.skipped_byte_count,
            finding_texts=findings,
            cycle_time_s=cycle,
        )


def make_transfer_settings(model: SerialLineModel) -> TransferSettings:
    """Return the settings of the serial line and of the data format."""
    line = LineSettings(model.port, model.baud, model.bits, model.parity, model.stop, model.flow)
    return TransferSettings(line, model.wrap, model.eol, model.dc_codes, model.wait, model.leader)


def create_program_checker(loading_steps: LoadingSteps) -> CheckProgram:
    """Return a function that proves a program on this machine with the current offsets."""

    def prove_source(source: ProgramSource) -> tuple[tuple[str, ...], float]:
        proved = loading_steps.prove_job(loading_steps.make_job(source, False), lambda _count: None)
        return proved.proof.errors, proved.proof.cycle_time_s

    return prove_source


def _create_source(text: bytes, name: str) -> ProgramSource:
    """Return the received text as a program, decoded like a program file.

    Raises DriverError if the text is not a program.
    """
    with tempfile.TemporaryDirectory(prefix="turndesk-") as folder:
        path = Path(folder) / name
        path.write_bytes(text)
        try:
            return load_source(path)
        except SourceError as error:
            raise DriverError("the received data is not a program: {error}", error=error) from error
