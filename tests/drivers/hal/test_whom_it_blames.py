"""A computer that stood still as a whole has heard nothing meanwhile: nobody is silent for that."""

from __future__ import annotations

import socket
from collections.abc import Iterator, Sequence
from types import SimpleNamespace

import pytest

from core.faults import get_fault_code
from core.ports import DriverError
from drivers import process_messages
from drivers.driver_host import host_connection
from drivers.driver_host.host_connection import SocketLink
from drivers.driver_host.host_messages import NO_NUMBERS, Message
from drivers.hal.bridge.packets import BridgeConfig, PacketHead
from drivers.hal.hal_link import HalLink
from drivers.wakeups import ManualClock
from tests.coded import raises_code

ROUND = 0.005  # s


class Bridge:
    """Tells what it is asked to, and takes everything."""

    warnings: tuple[str, ...] = ()
    has_shut_down = True
    silent = False

    def receive_packets(self) -> Iterator[tuple[PacketHead, Sequence[float]]]:
        if not self.silent:
            yield {"n": 0}, ()

    def send_packet(self, data: bytes) -> None:
        pass

    def stop_bridge(self) -> None:
        pass

    def close(self) -> None:
        pass


@pytest.fixture
def bridge() -> Bridge:
    return Bridge()


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


@pytest.fixture
def link(bridge: Bridge, clock: ManualClock) -> HalLink:
    made = HalLink(lambda: bridge, clock, BridgeConfig((), 0.001, 0.1))
    made.connect()
    return made


def rounds(link: HalLink, clock: ManualClock, seconds: float) -> None:
    for _ in range(round(seconds / ROUND)):
        clock.advance(ROUND)
        link.process_packets()


def test_bridge_that_alone_is_silent_is_reported(link: HalLink, bridge: Bridge, clock: ManualClock) -> None:
    bridge.silent = True
    rounds(link, clock, 0.14)
    assert not link.failure_reason
    rounds(link, clock, 0.03)
    assert get_fault_code(link.failure_reason, "driver") == "hal-silent"
    assert " 0.1" in link.failure_reason


def test_bridge_is_not_blamed_for_a_pause_of_the_whole_computer(
    link: HalLink, bridge: Bridge, clock: ManualClock
) -> None:
    bridge.silent = True
    for _ in range(2):
        clock.advance(0.4)
        link.process_packets()
    assert not link.failure_reason
    rounds(link, clock, 0.1)
    assert link.failure_reason  # it has had its time


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """How long each look for an answer takes, s: none comes."""
    took, now = [0.0], [0.0]

    def nothing(files: object, _w: object, _x: object, _left: float) -> tuple[list[object], ...]:
        now[0] += took.pop(0) if len(took) > 1 else took[0]
        return [], [], []

    monkeypatch.setattr(process_messages, "select", SimpleNamespace(select=nothing))
    monkeypatch.setattr(host_connection, "time", SimpleNamespace(monotonic=lambda: now[0]))
    return took


def test_driver_host_is_silent_after_enough_polls_not_after_one_long_one(looks: list[float]) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        looks[:] = [0.6, 0.6, 0.6, *[0.05] * 7, 1e9]
        with raises_code(DriverError, "feeder-silent"):
            SocketLink(ours).send_request(Message({"do": "look"}, NO_NUMBERS))
        assert looks == [1e9]  # three pauses and seven looks are half a second of listening
