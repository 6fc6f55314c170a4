"""Interfaces of a serial transfer. The implementation is provided from outside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

from app.programs.copy_rename_delete import checked_name, same_name_in
from app.programs.whole_file import FileError, write_new
from core.machine.desk_tables import DncModel
from core.message import Message

T_co = TypeVar("T_co", covariant=True)


class TransferProgress(Protocol):
    """Progress of a transfer. ``total`` is 0 while unknown.

    ``what`` names the reason for waiting: held, dc1, sender, frame, noise or empty. ``heard`` is the data
    received while the first % of a program is expected.
    """

    @property
    def done(self) -> int: ...

    @property
    def total(self) -> int: ...

    @property
    def lines(self) -> int: ...

    @property
    def what(self) -> str: ...

    @property
    def heard(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Received:
    """Complete received program that was proved but not stored yet.

    ``name`` is the file name from the program, with an extension. ``digest`` is the SHA-256 of ``text``.
    ``seven`` means that it arrived with 7 data bits although 8 are set. ``findings`` are the errors of the
    proof.
    """

    text: bytes
    name: str
    lines: int
    digest: str
    seven: bool
    skipped: int
    findings: tuple[str, ...]
    cycle: float


class Transfer(Protocol[T_co]):
    """Transfer over the serial line.

    ``run`` blocks and is called on a worker. All other members are callable from any thread.
    """

    @property
    def reach(self) -> TransferProgress: ...

    def cancel(self) -> None:
        """Cancel the transfer. ``run`` then raises an error, and nothing is stored."""
        ...

    def run(self) -> T_co:
        """Execute the transfer. Raises DriverError or FileError with a message for the operator."""
        ...


class SerialPorts(Protocol):
    """Serial ports and transfers over them."""

    def ports(self) -> Sequence[tuple[str, str]]:
        """Return device and description of each port. Raises DriverError."""
        ...

    def send(self, settings: DncModel, path: Path) -> Transfer[int]:
        """Return a transfer that sends a program. Its ``run`` returns the number of bytes."""
        ...

    def receive(self, settings: DncModel) -> Transfer[Received]:
        """Return a transfer that receives a program. Its ``run`` returns the program."""
        ...


# --- Storing a received program; existing files are never changed. ---------------------------------------


def store_new(received: Received, folder: Path, name: str) -> Path:
    """Store a received program as a new file and return its path.

    ``name`` gets the extension of the received program if it has none. Raises FileError if the name is
    invalid or exists, or if the disk rejects the file.
    """
    name = checked_name(name, Path(received.name))
    if other := same_name_in(folder, name):
        raise FileError(Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=other))
    write_new(folder / name, received.text)
    return folder / name


def free_name(folder: Path, name: str) -> str:
    """Return ``name``, or the first unused name of ``name-2``, ``name-3`` and so on."""
    base = Path(name)
    tried, number = name, 1
    while same_name_in(folder, tried):
        number += 1
        tried = f"{base.stem}-{number}{base.suffix}"
    return tried
