"""Packets of the bridge that are invalid: one fault, and the bridge is stopped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest

from core.faults import get_fault_code
from drivers.hal.bridge.packets import (
    BridgeConfig,
    PacketHead,
    number,
    pack_packet,
    unpack_packet,
)
from drivers.hal.hal_link import HalLink
from drivers.wakeups import ManualClock
from tests.drivers.hal.test_whom_it_blames import Bridge


def of_length(length: int, data: bytes) -> bytes:
    return length.to_bytes(4, "little") + data


INVALID = {
    "nothing": b"",
    "no whole length": b"\x05\0\0",
    "an array": of_length(5, b"[1,2]"),
    "null": of_length(4, b"null"),
    "a string": of_length(4, b'"do"'),
    "no JSON": of_length(4, b"nope"),
    "no UTF-8": of_length(2, b"\xff\xfe"),
    "a head cut off": of_length(9, b'{"n":1'),
    "a deep head": of_length(100_000, b"[" * 100_000),
    "half a number": of_length(2, b"{}1234567"),
}


@pytest.mark.parametrize("data", INVALID.values(), ids=INVALID)
def test_invalid_packet_is_a_value_error(data: bytes) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        unpack_packet(data)


def test_packet_is_unpacked_as_it_was_packed() -> None:
    head, numbers = unpack_packet(pack_packet({"do": "splice", "n": 3}, (1.5, -2.0)))
    assert (head, list(numbers)) == ({"do": "splice", "n": 3}, [1.5, -2.0])


@pytest.mark.parametrize("data", INVALID.values(), ids=INVALID)
def test_invalid_packet_of_the_bridge_is_a_fault_and_stops_the_bridge(data: bytes) -> None:
    class Odd(Bridge):
        stops = 0
        is_odd = False

        def receive_packets(self) -> Iterator[tuple[PacketHead, Sequence[float]]]:
            yield unpack_packet(data if self.is_odd else pack_packet({"n": 0}))

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
