"""What ``turndesk machine peer`` does: the other end of a bus that has no hardware on it."""

from __future__ import annotations

import signal
import sys
from types import FrameType

from app.cli.errors import EXIT_OK, CommandError
from app.compose.grblhal import play_grblhal
from app.compose.machine import read_machine
from app.compose.peer import play_peers
from core.ports import DriverError


def play(file: str) -> int:
    """Answers on the bus of ``file`` until Ctrl-C or SIGTERM. Raises CommandError."""
    machine = read_machine(file)
    bus, ended = machine.hardware.canopen, False
    if bus is None and machine.hardware.grblhal is None:
        raise CommandError(f"{file}: there is no [canopen] or [grblhal] table, so nothing to be a peer of")

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal ended
        ended = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)

    def say(what: str) -> None:
        sys.stdout.write(f"simulated {what}; end: Ctrl-C\n")
        sys.stdout.flush()

    try:
        if bus is None:
            play_grblhal(
                machine, lambda: not ended, lambda where: say(f"grblHAL of {machine.name} on {where}")
            )
        else:
            say(f"drives of {machine.name} on {bus.interface} {bus.channel}")
            play_peers(machine, lambda: not ended)
    except DriverError as error:
        raise CommandError(str(error)) from error
    return EXIT_OK
