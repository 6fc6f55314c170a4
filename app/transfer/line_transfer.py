"""Interfaces for the transfer of programs over a serial line.

The caller supplies the implementation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

from app.programs.atomic_files import FileOperationError, write_new_file
from app.programs.program_commands import add_missing_extension, find_matching_file_name
from core.machine.serial_and_backup_tables import SerialLineModel
from core.message import Message

T_co = TypeVar("T_co", covariant=True)


class TransferProgress(Protocol):
    """Progress of a serial transfer.

    ``wait_reason`` is empty while the transfer is not waiting.
    """

    @property
    def transferred_byte_count(self) -> int:
        """Return the number of bytes that have been transferred."""
        ...

    @property
    def total_byte_count(self) -> int:
        """Return the size of the transfer in bytes, or 0 while the size is unknown."""
        ...

    @property
    def transferred_line_count(self) -> int:
        """Return the number of lines that have been transferred."""
        ...

    @property
    def wait_reason(self) -> str:
        """Return the reason for waiting, or an empty string if the transfer is not waiting.

        The reason is ``held``, ``dc1``, ``sender``, ``frame`` or ``noise``.
        """
        ...

    @property
    def leading_text(self) -> str:
        """Return the data that was received before the first % character of a program."""
        ...


@dataclass(frozen=True, slots=True)
class ReceivedProgram:
    """Completely received program that has been proved but not yet stored.

    ``name`` is the file name from the program, with an extension. ``sha256`` is the SHA-256 hash of
    ``program_bytes``. ``is_seven_bit`` means that the data had 7 data bits although the port is set to 8.
    ``finding_texts`` are the errors of the proof, or the reason why the program could not be proved.
    """

    program_bytes: bytes
    file_name: str
    line_count: int
    sha256: str
    is_seven_bit: bool
    skipped_byte_count: int
    finding_texts: tuple[str, ...]
    cycle_time_s: float


class SerialLineTransfer(Protocol[T_co]):
    """Transfer over the serial line.

    ``run_transfer`` blocks and is called on a worker. All other members can be called from any thread.
    """

    @property
    def progress(self) -> TransferProgress:
        """Return the progress of the transfer, which any thread can read."""
        ...

    def cancel(self) -> None:
        """Cancel the transfer.

        ``run_transfer`` then raises an error, and nothing is stored.
        """
        ...

    def run_transfer(self) -> T_co:
        """Execute the transfer.

        Raise DriverError or FileOperationError with a message for the operator on failure.
        """
        ...


class SerialPorts(Protocol):
    """Access to the serial ports, and factory of transfers over them."""

    def list_ports(self) -> Sequence[tuple[str, str]]:
        """Return the device name and the description of each serial port.

        Raise DriverError if the ports cannot be listed.
        """
        ...

    def make_send_transfer(self, settings: SerialLineModel, path: Path) -> SerialLineTransfer[int]:
        """Return a transfer that sends a program.

        Its ``run_transfer`` returns the number of bytes sent.
        """
        ...

    def make_receive_transfer(self, settings: SerialLineModel) -> SerialLineTransfer[ReceivedProgram]:
        """Return a transfer that receives a program.

        Its ``run_transfer`` returns the received program.
        """
        ...


# --- Storing a received program; existing files are never changed. ---------------------------------------


def store_received_program(received: ReceivedProgram, folder: Path, name: str) -> Path:
    """Store a received program as a new file, and return its path.

    If ``name`` lacks an extension for programs, the extension of the received program is added. Raise
    FileOperationError if the name is invalid or already exists, or if the file cannot be written.
    """
    name = add_missing_extension(name, Path(received.file_name))
    if other := find_matching_file_name(folder, name):
        raise FileOperationError(Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=other))
    write_new_file(folder / name, received.program_bytes)
    return folder / name


def find_unused_name(folder: Path, name: str) -> str:
    """Return ``name``, or the first unused name in the series ``name-2``, ``name-3`` and so on."""
    base = Path(name)
    tried, number = name, 1
    while find_matching_file_name(folder, tried):
        number += 1
        tried = f"{base.stem}-{number}{base.suffix}"
    return tried
