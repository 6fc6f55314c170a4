"""What ``turndesk machine peer`` does: the other end of a bus that has no hardware on it."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterable
from types import FrameType
from typing import TYPE_CHECKING

from app.cli.errors import EXIT_OK, CommandError
from app.compose.machine import read_machine
from core.ports import DriverError

if TYPE_CHECKING:
    from core.machine.model import Machine


def play(file: str) -> int:
    """Answers on the bus of ``file`` until Ctrl-C or SIGTERM. Raises CommandError."""
    machine = read_machine(file)
    player = {"canopen": _drives, "grblhal": _controller}.get(machine.backend)
    if player is None:
        why = f"machine.backend is {machine.backend}: nothing to be a peer of; canopen and grblhal have one"
        raise CommandError(f"{file}: {why}")
    ended = False

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal ended
        ended = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    try:
        player(machine, lambda: not ended)
    except DriverError as error:
        raise CommandError(str(error)) from error
    return EXIT_OK


def _drives(machine: Machine, going: Callable[[], bool]) -> None:
    from app.compose.peer import play_peers

    bus = machine.hardware.canopen
    assert bus is not None  # a rule of the machine file
    if bus.interface == "virtual":
        raise DriverError(
            "interface virtual lives within one process, which plays its drives itself; take udp_multicast"
        )
    play_peers(machine, going, _say, _typed())


def _typed() -> Callable[[], Iterable[str]]:
    """Lines of the standard input, where there is one."""
    from app.compose.peer_hands import Typed

    try:
        return Typed(sys.stdin.fileno()).lines
    except (OSError, ValueError, AttributeError):
        return tuple


def _controller(machine: Machine, going: Callable[[], bool]) -> None:
    from app.compose.grblhal import play_grblhal

    play_grblhal(
        machine, going, lambda where: _say(f"simulated grblHAL of {machine.name} on {where}; end: Ctrl-C")
    )


def _say(what: str) -> None:
    sys.stdout.write(f"{what}\n")
    sys.stdout.flush()
