"""Packets of the bridge that are invalid: one fault, and the bridge is stopped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest

from core.faults import get_fault_code
from drivers.hal.bridge.packets import BridgeConfig, PacketHead, number, pack_packet
from drivers.hal.hal_link import HalLink
from drivers.process_messages import decode_message
from drivers.wakeups import ManualClock
from tests.drivers.hal.test_whom_it_blames import Bridge


def of_lengths(data: bytes, head: int | None = None, numbers: int = 0) -> bytes:
    head = len(data) - numbers if head is None else head
    return head.to_bytes(4, "little") + numbers.to_bytes(4, "little") + data


INVALID = {
    "nothing": b"",
    "no whole lengths": b"\x05\0\0\0\0",
    "an array": of_lengths(b"[1,2]"),
    "null": of_lengths(b"null"),
    "a string": of_lengths(b'"do"'),
    "no JSON": of_lengths(b"nope"),
    "no UTF-8": of_lengths(b"\xff\xfe"),
    "a head cut off": of_lengths(b'{"n":1', head=9),
    "a deep head": of_lengths(b"[" * 100_000),
    "half a number": of_lengths(b"{}1234567", numbers=7),
}


@pytest.mark.parametrize("data", INVALID.values(), ids=INVALID)
def test_invalid_packet_is_a_value_error(data: bytes) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        decode_message(data)


def test_packet_is_unpacked_as_it_was_packed() -> None:
    head, numbers = decode_message(pack_packet({"do": "splice", "n": 3}, (1.5, -2.0)))
    assert (head, list(numbers)) == ({"do": "splice", "n": 3}, [1.5, -2.0])


@pytest.mark.parametrize("data", INVALID.values(), ids=INVALID)
def test_invalid_packet_of_the_bridge_is_a_fault_and_stops_the_bridge(data: bytes) -> None:
    class Odd(Bridge):
        stops = 0
        is_odd = False

        def receive_packets(self) -> Iterator[tuple[PacketHead, Sequence[float]]]:
            yield decode_message(data if self.is_odd else pack_packet({"n": 0}))

        def stop_bridge(self) -> None:
            self.stops += 1

    bridge = Odd()
    link = HalLink(lambda: bridge, ManualClock(), BridgeConfig((), 0.001, 0.1))
    link.connect()
    bridge.is_odd = True
    link.process_packets()
    assert get_fault_code(link.failure, "driver") == "hal-silent"
    assert bridge.stops == 1
    assert link.last_report == {"n": 0}


@pytest.mark.parametrize(
    ("head", "found"),
    [({"n": 3}, 3.0), ({"n": 10**400}, 7.0), ({"n": "3"}, 7.0), ({"n": None}, 7.0), ({}, 7.0)],
)
def test_number_that_is_missing_or_too_large_is_the_default(head: PacketHead, found: float) -> None:
    assert number(head, "n", 7.0) == found
