"""What a transfer over the serial line is to the desk; who carries it out is told from outside."""

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
    """How far it has come. ``total`` 0: nobody knows; ``what`` it waits for: held, dc1, sender, frame, noise.

    ``heard``: what came in its place while a program's first % is waited for.
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
    """A whole program that has come in and was looked at; it is not stored yet.

    ``name``: the file name under which it was proved: as it calls itself, with an ending. ``digest``: SHA-256
    of ``text``. ``seven``: it came in seven bits although eight are set. ``findings``: errors of the proof.
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
    """One transfer. ``run`` takes its time and is called on a worker; all else by anybody."""

    @property
    def reach(self) -> TransferProgress: ...

    def cancel(self) -> None:
        """Give it up: ``run`` ends with a sentence, and nothing is kept."""
        ...

    def run(self) -> T_co:
        """Carry it out. Raises DriverError or FileError with a sentence."""
        ...


class SerialPorts(Protocol):
    """The serial ports, and transfers over them."""

    def ports(self) -> Sequence[tuple[str, str]]:
        """Device and what it is. Raises DriverError."""
        ...

    def send(self, settings: DncModel, path: Path) -> Transfer[int]:
        """A program out; ``run`` answers how many bytes went."""
        ...

    def receive(self, settings: DncModel) -> Transfer[Received]:
        """A program in; ``run`` answers what came."""
        ...


# --- a received program becomes a new file; nothing that is there is ever touched ------------------------


def store_new(received: Received, folder: Path, name: str) -> Path:
    """The new file; ``name`` gets the ending of what was proved where it has none.

    Raises FileError: the name is none, or is taken, or the disk does not take it.
    """
    name = checked_name(name, Path(received.name))
    if other := same_name_in(folder, name):
        raise FileError(Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=other))
    write_new(folder / name, received.text)
    return folder / name


def free_name(folder: Path, name: str) -> str:
    """``name``, or the first of ``name-2``, ``name-3`` … that is not taken."""
    base = Path(name)
    tried, number = name, 1
    while same_name_in(folder, tried):
        number += 1
        tried = f"{base.stem}-{number}{base.suffix}"
    return tried
