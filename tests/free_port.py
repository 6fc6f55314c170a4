"""A port of this computer on which nobody listens."""

from __future__ import annotations

import random
import socket

_BELOW = 32_768  # where the ports begin that a system gives to whoever asks for any
_FROM = 10_000


def free_port() -> int:
    """One that stays free until it is used: the system gives it to nobody else who asks for any port.

    Neither to who connects to it: a try at one of those may be answered by itself.
    """
    dice = random.SystemRandom()
    while True:
        port = dice.randrange(_FROM, _BELOW)
        with socket.socket() as tried:
            try:
                tried.bind(("127.0.0.1", port))
            except OSError:
                continue
        return port
