"""The serial lines of this computer for programs: what carries one is loaded when it is carried."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.serial_ports import serial_ports
from app.desk.program_loading import LoadingSteps
from core.language.source import Source
from core.machine.serial_table import DncModel
from core.ports import Clock
from drivers.clocks import RealClock

if TYPE_CHECKING:
    from app.compose.program_transfer import ReceivingProgram, SendingFile

# A line as most controls have it; the port is for the operator to choose.
PLAIN = DncModel("", 9600, 8, "N", 1, "xonxoff", "%", "\r\n")
Check = Callable[[Source], tuple[tuple[str, ...], float]]  # errors, cycle time in s


class SerialLines:
    """``app.transfer.line_transfer.Lines``. ``check`` looks at what has come in; ``ending`` of its file."""

    def __init__(self, check: Check, ending: str = ".nc", clock: Clock | None = None) -> None:
        self._check, self._ending, self._clock = check, ending, clock or RealClock()

    def ports(self) -> Sequence[tuple[str, str]]:
        """Those of this computer."""
        return serial_ports()

    def send(self, settings: DncModel, path: Path) -> SendingFile:
        """The program in a file."""
        from app.compose.program_transfer import SendingFile, settings_of

        return SendingFile(settings_of(settings), path, self._clock)

    def receive(self, settings: DncModel) -> ReceivingProgram:
        """Whatever program comes."""
        from app.compose.program_transfer import ReceivingProgram, settings_of

        return ReceivingProgram(settings_of(settings), self._clock, self._check, self._ending)


def proving(workshop: LoadingSteps) -> Check:
    """The check of the desk: its machine, its offsets of that moment."""

    def check(source: Source) -> tuple[tuple[str, ...], float]:
        proved = workshop.prove(workshop.make_job(source, False), lambda _count: None)
        return proved.proof.errors, proved.proof.cycle_time

    return check
