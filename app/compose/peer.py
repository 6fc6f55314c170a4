"""Simulated drives and terminals on a real bus: for trying a machine file without hardware."""

from __future__ import annotations

from collections.abc import Callable

from app.compose.canopen import canopen_peers
from core.machine.model import Machine
from drivers.simulated import RealClock

_ROUND = 0.001  # s


def play_peers(machine: Machine, going: Callable[[], bool]) -> None:
    """Answer on the machine file's bus while ``going``. Raises DriverError when it cannot be opened."""
    peers = canopen_peers(machine, RealClock())
    try:
        while going():
            peers.pump(_ROUND)
    finally:
        peers.close()
