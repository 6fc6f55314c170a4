"""The line of the stop keys, from the screen's end to the control's."""

from __future__ import annotations

import queue
import socket
from collections.abc import Iterator
from multiprocessing.connection import Connection

import pytest

from app.compose.control.descriptor_passing import handle_stop_keys, receive_descriptor, send_descriptor
from app.desk.stop_keys.stop_records import StopKeyPress, StopKind

LIMIT = 20.0  # s


@pytest.fixture
def ends() -> Iterator[tuple[Connection, Connection]]:
    """The connection between a screen and its control."""
    ours, theirs = (Connection(each.detach()) for each in socket.socketpair())
    with ours, theirs:
        yield ours, theirs


def test_stop_records_are_executed_in_the_order_sent(ends: tuple[Connection, Connection]) -> None:
    screen, control = ends
    obeyed: queue.Queue[StopKeyPress] = queue.Queue()
    line, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with theirs:
        send_descriptor(screen, theirs.fileno())
    handle_stop_keys(receive_descriptor(control), obeyed.put)
    stops = [StopKeyPress(StopKind.HOLD, 1), StopKeyPress(StopKind.ESTOP, 2), StopKeyPress(StopKind.ESC, 3)]
    with line:
        for stop in stops:
            line.send(stop.to_bytes())
        assert [obeyed.get(timeout=LIMIT) for _ in stops] == stops


def test_record_of_another_version_is_skipped(ends: tuple[Connection, Connection]) -> None:
    screen, control = ends
    obeyed: queue.Queue[StopKeyPress] = queue.Queue()
    line, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with theirs:
        send_descriptor(screen, theirs.fileno())
    handle_stop_keys(receive_descriptor(control), obeyed.put)
    with line:
        line.send(b"what is this")
        line.send(StopKeyPress(StopKind.HOLD, 4).to_bytes())
        assert obeyed.get(timeout=LIMIT) == StopKeyPress(StopKind.HOLD, 4)


def test_message_without_a_file_descriptor_is_rejected(ends: tuple[Connection, Connection]) -> None:
    screen, control = ends
    screen.close()
    with pytest.raises(EOFError):
        receive_descriptor(control)
