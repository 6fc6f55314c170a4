"""Connections of the grblHAL simulator to the host through a pseudo terminal or a TCP port."""

from __future__ import annotations

import os
import select
import socket
import tty
from collections.abc import Callable

from core.ports import DriverError
from drivers.simulators.grblhal_firmware import GrblFirmware

_CYCLE_S = 0.002  # s


class PtyConnection:
    """Controller side of a pseudo terminal.

    The host opens ``device_name`` as a serial device.
    """

    def __init__(self) -> None:
        self._ours, self._theirs = os.openpty()
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        self.device_name = os.ttyname(self._theirs)

    def transfer_bytes(self, firmware: GrblFirmware, timeout_s: float = 0.0) -> None:
        """Transfer bytes in both directions, after waiting up to ``timeout_s`` seconds for input."""
        ready, _, _ = select.select([self._ours], [], [], timeout_s)
        if ready:
            firmware.receive_bytes(os.read(self._ours, 4096))
        data = firmware.pop_output()
        if data:
            os.write(self._ours, data)

    def close(self) -> None:
        """Close both sides of the pseudo terminal."""
        os.close(self._ours)
        os.close(self._theirs)


class TcpConnection:
    """Controller side of a TCP port that accepts one host at a time.

    The controller continues to run while no host is connected.
    """

    def __init__(self, host: str, port: int) -> None:
        try:
            self._listener = socket.create_server((host, port))
        except OSError as error:
            raise DriverError(
                "tcp://{host}:{port} cannot be opened: {error}", host=host, port=port, error=error
            ) from error
        self.device_name = "tcp://{}:{}".format(*self._listener.getsockname()[:2])
        self._host: socket.socket | None = None

    def transfer_bytes(self, firmware: GrblFirmware, timeout_s: float = 0.0) -> None:
        """Transfer bytes in both directions, after waiting up to ``timeout_s`` seconds for input."""
        ends = [self._listener] + ([self._host] if self._host else [])
        ready, _, _ = select.select(ends, [], [], timeout_s)
        if self._listener in ready:
            self._hang_up()
            self._host, _ = self._listener.accept()
        elif self._host is not None and self._host in ready:
            self._receive(firmware)
        data = firmware.pop_output()
        if data and self._host is not None:
            try:
                self._host.sendall(data)
            except OSError:
                self._hang_up()

    def close(self) -> None:
        """Close the connection to the host and the port."""
        self._hang_up()
        self._listener.close()

    def _receive(self, firmware: GrblFirmware) -> None:
        assert self._host is not None
        try:
            data = self._host.recv(4096)
        except OSError:
            data = b""
        if data:
            firmware.receive_bytes(data)
        else:
            self._hang_up()

    def _hang_up(self) -> None:
        if self._host is not None:
            self._host.close()
            self._host = None


def run_simulator(
    connection: PtyConnection | TcpConnection, firmware: GrblFirmware, should_continue: Callable[[], bool]
) -> None:
    """Run the simulator with its connection as long as ``should_continue`` returns true.

    Afterward, the connection is closed.
    """
    try:
        while should_continue():
            connection.transfer_bytes(firmware, _CYCLE_S)
    finally:
        connection.close()
