"""Hands at a simulated machine that runs in another process: words typed where it plays."""

from __future__ import annotations

import contextlib
import os
import select
import signal
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from core.ports import DriverError

if TYPE_CHECKING:
    from drivers.canopen.peer.machine import Peers
    from drivers.simulated import SimMachine

HELP = (
    "start (both palms), hold, estop, release, auto on|off, feed 0…150, spindle 0…100, input NAME on|off,"
    " jam AXIS on|off, cable on|off"
)
_CHUNK = 4096


class Typed:
    """Whole lines from a descriptor, without ever waiting for one."""

    def __init__(self, source: int) -> None:
        self._source = source
        self._open = True
        self._text = b""
        # In the background of a shell a read would stop this process; so it fails, and that is the end.
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)

    def lines(self) -> Iterator[str]:
        """What has been typed since."""
        if self._open and select.select([self._source], [], [], 0)[0]:
            data = b""
            with contextlib.suppress(OSError):
                data = os.read(self._source, _CHUNK)
            self._open = bool(data)
            self._text += data
        while b"\n" in self._text:
            line, _, self._text = self._text.partition(b"\n")
            if words := line.decode(errors="replace").strip():
                yield words


def obey(line: str, peers: Peers) -> str:
    """Do what one line says; what was done or why not, in words."""
    name, *values = line.split()
    try:
        act = _ACTS[name]
        act(peers, *values)
    except (KeyError, TypeError, ValueError):
        return f"{line}: not understood; known: {HELP}"
    except DriverError as error:
        return f"{line}: {error}"
    return f"{line}: done"


def _start(peers: Peers) -> None:
    hands = peers.machine
    hands.press_left()
    hands.press_right()
    hands.release_left()
    hands.release_right()


def _hold(peers: Peers) -> None:
    peers.machine.press_hold()
    peers.machine.release_hold()


def _on(word: str) -> bool:
    return {"on": True, "off": False}[word]


def _percent(word: str) -> float:
    return float(word) / 100.0


def _hand(act: Callable[[SimMachine, str], None]) -> Callable[[Peers, str], None]:
    return lambda peers, word: act(peers.machine, word)


def _jam(peers: Peers, axis: str, word: str) -> None:
    if axis not in peers.plant.drives:
        raise DriverError(f"no drive is called {axis}: {', '.join(peers.plant.drives)}")
    peers.machine.jam(axis, _on(word))


_ACTS: dict[str, Callable[..., None]] = {
    "start": _start,
    "hold": _hold,
    "estop": lambda peers: peers.machine.press_estop(),
    "release": lambda peers: peers.machine.release_estop(),
    "auto": _hand(lambda hands, word: hands.set_spindle_auto(_on(word))),
    "feed": _hand(lambda hands, word: hands.set_feed_pot(_percent(word))),
    "spindle": _hand(lambda hands, word: hands.set_spindle_pot(_percent(word))),
    "input": lambda peers, name, word: peers.machine.set_input(name, _on(word)),
    "jam": _jam,
    "cable": lambda peers, word: peers.cable(out=not _on(word)),
}
