"""Simulated drives and terminals on a real bus: for trying a machine file without hardware."""

from __future__ import annotations

import time
from collections.abc import Callable

from app.compose.canopen import canopen_peers
from core.machine.model import Machine
from drivers.feeder.loop import keep_memory, real_time
from drivers.simulated import StepClock

_ROUND = 0.001  # s
_STEP = 0.005  # s; a peer that was away catches up in such steps, frame by frame


def play_peers(machine: Machine, going: Callable[[], bool], ready: Callable[[], None]) -> None:
    """Answer on the machine file's bus while ``going``; ``ready`` is called once it is open.

    Raises DriverError when it cannot be opened.
    """
    clock, zero, epoch = StepClock(), time.monotonic(), time.time()
    peers = canopen_peers(machine, clock)
    keep_memory()
    real_time()  # drives are punctual; where this is refused the feeder has said so already
    peers.arrival = lambda stamp: stamp - epoch
    ready()
    try:
        while going():
            while (late := time.monotonic() - zero - clock.now()) > _STEP:
                clock.advance(_STEP)
                peers.pump()
            clock.advance(max(late, 0.0))
            peers.pump(_ROUND)
    finally:
        peers.close()
