"""Starts the feeder, and is it: ``python -m app.compose.feeder_process FD ZERO``, machine on stdin."""

from __future__ import annotations

import gc
import pickle
import socket
import subprocess
import sys
from dataclasses import replace

from app.compose.backend_entry import backend_of
from app.compose.inverter_backend import has_inverter, with_inverter
from core.machine.machine_model import Machine
from core.ports import Clock, DriverError
from drivers.clocks import RealClock
from drivers.feeder.feeder_client import Line, Link, cleared
from drivers.feeder.feeder_links import SocketLink
from drivers.feeder.feeder_loop import keep_memory, real_time, serve
from drivers.feeder.feeder_messages import NOTHING, Inbox, Message, packed, text
from drivers.feeder.feeder_server import Driven
from drivers.reopening import Opening


def driven(machine: Machine, clock: Clock) -> Driven:
    """What the machine file's backend and its spindle are driven by. Raises DriverError."""
    make = backend_of(machine).driven
    if make is None:
        raise DriverError(f"{machine.source}: the feeder has no backend {machine.backend}")
    inner = make(machine, clock)
    if not has_inverter(machine):
        return inner
    ports, close = with_inverter(machine, inner.ports, clock, inner.close)
    return replace(inner, ports=ports, close=close)


_START = 20.0  # s for the first answer: the process has to start and to configure every drive
_END = 10.0


class FeederProcess:
    """A feeder in its own process, and the line to it."""

    def __init__(self, machine: Machine, clock: RealClock) -> None:
        self._machine, self._clock = machine, clock
        self.line = Line(self._begin(), clock, self._again)

    def _again(self) -> Opening[Link]:
        """Another process, once the one before has ended: two would be two masters on one bus."""

        def begun() -> Link:
            self.close()
            return cleared(self._begin())

        return Opening(begun)

    def _begin(self) -> Link:
        """Raises DriverError with what it says of its drivers."""
        machine, clock = self._machine, self._clock
        ours, theirs = socket.socketpair()
        with theirs:
            command = [
                sys.executable,
                "-m",
                "app.compose.feeder_process",
                str(theirs.fileno()),
                repr(clock.zero),
            ]
            # A session of its own: Ctrl-C is for the control, which then ends the feeder in good order.
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, pass_fds=(theirs.fileno(),), start_new_session=True
            )
        assert self.process.stdin is not None
        with self.process.stdin as pipe:
            pipe.write(pickle.dumps(machine))
        self._link = SocketLink(ours)
        ready = self._first(ours)
        if why := text(ready.head, "error"):
            self.close()
            raise DriverError(why, "feeder-gone")
        return self._link

    def close(self) -> None:
        """The feeder stops what is left and ends."""
        self._link.close()
        try:
            self.process.wait(_END)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def _first(self, sock: socket.socket) -> Message:
        """The feeder's own first word: it is ready, or why not."""
        inbox = Inbox()
        sock.settimeout(_START)
        try:
            while data := sock.recv(1 << 16):
                for message in inbox.feed(data):
                    return message
        except TimeoutError:
            return Message({"error": "the feeder's process does not come up"}, NOTHING)
        return Message(
            {"error": "the feeder's process has ended at its start; see its message above"}, NOTHING
        )


def main(arguments: list[str]) -> int:
    """The process: connect, say so, serve until the control has gone."""
    sock = socket.socket(fileno=int(arguments[0]))
    clock: Clock = RealClock(float(arguments[1]))
    machine = pickle.load(sys.stdin.buffer)  # of our own parent, over a pipe that nobody else has
    warnings = real_time()
    locked = keep_memory()
    try:
        machine_driven = driven(machine, clock)
    except DriverError as error:
        sock.sendall(packed(Message({"error": str(error)}, NOTHING)))
        return 1
    if machine_driven.wake() is None:
        locked = keep_memory()
    else:  # a tenth of a second without a setpoint is more than drives wait for one
        gc.freeze()
    warnings += locked
    sock.sendall(packed(Message({"ready": True}, NOTHING)))
    serve(sock, machine_driven, warnings, machine.hardware.refresh)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
