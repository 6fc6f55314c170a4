"""Messages between processes on stream and packet sockets, and the rule for a silent process."""

from __future__ import annotations

import socket
import struct
from array import array
from collections.abc import Iterator

import pytest

from drivers.process_messages import MessageSocket, decode_message, encode_message
from drivers.silence import SilenceStop, SilenceTimer, StopSteps

Pair = tuple[MessageSocket, socket.socket]


@pytest.fixture(params=[socket.SOCK_STREAM, socket.SOCK_SEQPACKET], ids=["stream", "packets"])
def pair(request: pytest.FixtureRequest) -> Iterator[Pair]:
    """A message socket and the plain socket of the other process."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, request.param)
    with ours, theirs:
        yield MessageSocket(ours), theirs


def test_messages_arrive_in_order_and_then_the_end(pair: Pair) -> None:
    ours, theirs = pair
    assert list(ours.receive()) == []
    assert not ours.wait(0.0)
    theirs.sendall(encode_message({"do": "beat"}))
    theirs.sendall(encode_message({"n": 2}, array("d", [1.5, -2.0]).tobytes()))
    theirs.close()
    assert ours.wait(0.0)
    received = ours.receive()
    assert [next(received), next(received)] == [
        ({"do": "beat"}, array("d")),
        ({"n": 2}, array("d", [1.5, -2.0])),
    ]
    with pytest.raises(EOFError):
        next(received)


@pytest.mark.parametrize("has_ended", [False, True])
def test_messages_left_from_an_earlier_call_are_delivered_first(pair: Pair, has_ended: bool) -> None:
    ours, theirs = pair
    theirs.sendall(encode_message({"n": 1}) + encode_message({"n": 2}) + encode_message({"n": 3}))
    assert next(ours.receive())[0] == {"n": 1}  # the caller takes only one message
    assert ours.wait(0.0)
    if has_ended:
        theirs.close()
    received = ours.receive()
    assert [next(received)[0], next(received)[0]] == [{"n": 2}, {"n": 3}]
    assert ours.wait(0.0) == has_ended
    with pytest.raises(EOFError if has_ended else StopIteration):
        next(received)


def test_damaged_message_left_from_an_earlier_call_is_rejected(pair: Pair) -> None:
    ours, theirs = pair
    theirs.sendall(encode_message({"n": 1}) + struct.pack("<II", 0, 3))
    assert next(ours.receive())[0] == {"n": 1}
    with pytest.raises(ValueError, match="lengths"):
        list(ours.receive())


def test_a_sent_message_has_its_two_lengths(pair: Pair) -> None:
    """The head {"a":1} has 7 bytes, one double has 8 bytes."""
    ours, theirs = pair
    ours.send(encode_message({"a": 1}, struct.pack("<d", 0.5)))
    assert theirs.recv(100) == b'\x07\x00\x00\x00\x08\x00\x00\x00{"a":1}' + struct.pack("<d", 0.5)


def test_a_process_that_does_not_read_is_an_error(pair: Pair) -> None:
    ours, _ = pair
    message = encode_message({"do": "x" * 10_000})
    with pytest.raises(BlockingIOError):
        list(map(ours.send, [message] * 10_000))  # more than the buffer of the socket
    with pytest.raises(TimeoutError):
        ours.send(message, 0.01)


def test_a_closed_socket_is_an_error(pair: Pair) -> None:
    ours, _ = pair
    ours.disconnect()
    with pytest.raises(EOFError):
        list(ours.receive())
    ours.close()
    assert ours.fileno() == -1
    with pytest.raises(OSError, match="Bad file descriptor"):
        ours.wait(0.0)


@pytest.mark.parametrize(
    "data",
    [
        b"\x02\x00\x00",
        b"\x02\x00\x00\x00\x00\x00\x00\x00{",
        b"\x02\x00\x00\x00\x00\x00\x00\x00{} ",
        b"\x02\x00\x00\x00\x04\x00\x00\x00{}1234",
        b"\x02\x00\x00\x00\x00\x00\x00\x00[]",
        b"\x02\x00\x00\x00\x00\x00\x00\x00{]",
        b"\xff\xff\xff\xff\x00\x00\x00\x00{}",
    ],
)
def test_a_packet_that_is_not_exactly_one_message_is_rejected(data: bytes) -> None:
    with pytest.raises(ValueError, match=r"[a-z]"):
        decode_message(data)
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours, theirs:
        theirs.send(data)
        with pytest.raises(ValueError, match=r"[a-z]"):
            list(MessageSocket(ours).receive())


# --- silence ----------------------------------------------------------------------------------------------


def test_silence_counts_until_the_next_message() -> None:
    timer = SilenceTimer(0.25, now=10.0)
    assert not timer.check(10.2)
    assert timer.measure(10.25) == pytest.approx(0.25)
    assert timer.check(10.3)
    timer.hear(10.3)
    assert not timer.check(10.5)


def test_a_delay_of_the_waiting_process_counts_as_one_step() -> None:
    """Three checks, of which one is 5 s late: 0.05 s + 0.05 s + 0.04 s."""
    timer = SilenceTimer(0.13, max_step_s=0.05)
    assert not timer.check(5.0)
    assert not timer.check(5.05)
    assert timer.measure(60.0) == pytest.approx(0.15)
    assert timer.check(5.09)


class Machine:
    """A machine that notes the steps of its stop."""

    def __init__(self) -> None:
        self.at_rest, self.stopped = False, False
        self.steps: list[str] = []
        note = self.steps.append
        self.stop = SilenceStop(
            0.5,
            0.0,
            StopSteps(
                lambda: self.at_rest,
                lambda: note("brake"),
                lambda: note("off"),
                lambda: note("power"),
                lambda: self.stopped,
            ),
        )


def test_silent_control_switches_off_once_at_rest() -> None:
    machine = Machine()
    machine.stop.advance(0.5, has_ended=False)
    assert machine.steps == []
    machine.stop.advance(0.6, has_ended=False)
    assert (machine.steps, machine.stop.has_switched_off) == (["brake"], False)
    machine.at_rest = True
    for time in (1.0, 2.0):
        machine.stop.advance(time, has_ended=False)
    assert machine.steps == ["brake", "off"]
    assert machine.stop.has_switched_off
    assert not machine.stop.is_done
    machine.stop.hear(2.5)
    machine.stop.advance(2.5, has_ended=False)
    assert not machine.stop.has_switched_off
    machine.stop.advance(3.1, has_ended=False)
    assert machine.steps == ["brake", "off", "off"]


@pytest.mark.parametrize(("spindle_stops_at", "done_at"), [(3.0, 3.0), (99.0, 9.5)])
def test_ended_control_waits_for_the_spindle_but_not_for_ever(
    spindle_stops_at: float, done_at: float
) -> None:
    """At most 8 s after the switch-off at 1.0 s; the stop is advanced every 0.5 s."""
    machine = Machine()
    machine.at_rest = True
    time = 1.0
    while not machine.stop.is_done:
        machine.stopped = time >= spindle_stops_at
        machine.stop.advance(time, has_ended=True)
        time += 0.5
    assert time - 0.5 == done_at
    assert machine.steps[:2] == ["off", "power"]
    assert machine.steps.count("off") == 1


def test_ended_control_with_moving_axes_is_not_done() -> None:
    machine = Machine()
    machine.stopped = True
    for time in (1.0, 100.0):
        machine.stop.advance(time, has_ended=True)
    assert not machine.stop.is_done
    assert machine.steps == ["brake", "brake"]
