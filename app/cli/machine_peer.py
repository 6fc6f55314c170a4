"""What ``turndesk machine peer`` does: the other end of a bus that has no hardware on it."""

from __future__ import annotations

import signal
import sys
from types import FrameType

from app.cli.errors import EXIT_OK, CommandError
from app.compose.machine import read_machine
from app.compose.peer import play_peers
from core.ports import DriverError


def play(file: str) -> int:
    """Answers on the bus of ``file`` until Ctrl-C or SIGTERM. Raises CommandError."""
    machine = read_machine(file)
    if machine.hardware.canopen is None:
        raise CommandError(f"{file}: there is no [canopen] table; a peer answers on a CAN bus")
    bus, ended = machine.hardware.canopen, False

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal ended
        ended = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    sys.stdout.write(f"simulated drives of {machine.name} on {bus.interface} {bus.channel}; end: Ctrl-C\n")
    sys.stdout.flush()
    try:
        play_peers(machine, lambda: not ended)
    except DriverError as error:
        raise CommandError(str(error)) from error
    return EXIT_OK
