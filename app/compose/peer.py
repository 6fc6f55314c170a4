"""Simulated drives and terminals on a real bus: for trying a machine file without hardware."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from app.compose.canopen import canopen_peers
from app.compose.peer_hands import obey
from core.machine.model import Machine
from drivers.feeder.loop import keep_memory, real_time
from drivers.simulated import StepClock

_ROUND = 0.001  # s
_STEP = 0.005  # s; a peer that was away catches up in such steps, frame by frame


def play_peers(
    machine: Machine,
    going: Callable[[], bool],
    say: Callable[[str], None],
    typed: Callable[[], Iterable[str]] = tuple,
) -> None:
    """Answer on the machine file's bus while ``going``; ``say`` tells what it is and what was ``typed``.

    Raises DriverError when it cannot be opened.
    """
    bus = machine.hardware.canopen
    assert bus is not None  # a rule of the machine file
    clock, zero, epoch = StepClock(), time.monotonic(), time.time()
    peers = canopen_peers(machine, clock)
    keep_memory()
    real_time()  # drives are punctual; where this is refused the feeder has said so already
    peers.arrival = lambda stamp: stamp - epoch
    say(f"simulated drives of {machine.name} on {bus.interface} {bus.channel}; end: Ctrl-C")
    try:
        while going():
            while (late := time.monotonic() - zero - clock.now()) > _STEP:
                clock.advance(_STEP)
                peers.pump()
            clock.advance(max(late, 0.0))
            peers.pump(_ROUND)
            for line in typed():
                say(obey(line, peers))
    finally:
        peers.close()
