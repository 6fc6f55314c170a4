"""Frames that no device should send: dropped, told, never a crash; too many, and the bus is not trusted."""

from __future__ import annotations

import can
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.faults import get_fault_code
from tests.drivers.canopen.bench import CanBench
from tests.drivers.machines import ramp


def stray(bench: CanBench, cob: int, data: bytes, **how: bool) -> None:
    """One frame from nobody."""
    frame = can.Message(arbitration_id=cob, data=data, is_extended_id=how.pop("extended", False), **how)
    assert bench.peers.network.bus is not None
    bench.peers.network.bus.send(frame)


@pytest.mark.parametrize(
    ("cob", "data"),
    [
        (0x081, b"\x01"),  # an EMCY of one byte
        (0x701, b""),  # a heartbeat without a state
        (0x181, b"\x27\x02"),  # answers too short
        (0x282, b"\x00" * 3),
        (0x582, b"\x43"),  # an SDO answer that nobody asked for, and too short
    ],
)
def test_one_malformed_frame_is_dropped_and_three_are_a_fault(
    bench: CanBench, cob: int, data: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 60.0, 0.6))
    bench.run(0.3)
    stray(bench, cob, data)
    bench.run(0.05)
    assert axes.sample().fault == ""
    assert f"{cob:03X}" in caplog.text
    stray(bench, cob, data)
    stray(bench, cob, data)
    bench.run(0.5)
    fault = axes.sample().fault
    assert get_fault_code(fault, "driver") == "bus"
    assert f"{cob:03X}" in fault
    assert bench.peers.plant.servos[0].v == 0.0
    axes.clear_fault()  # opens the bus anew
    assert axes.sample().fault == ""


def test_frames_of_other_protocols_are_ignored(bench: CanBench) -> None:
    stray(bench, 0x18FF0102, b"\x01\x02", extended=True)
    stray(bench, 0x181, b"", is_remote_frame=True)
    stray(bench, 0x7E5, b"\x04\x00")  # LSS
    bench.run(0.1)
    assert bench.machine.axes.sample().fault == ""
    assert bench.machine.bus.garbled_frame_count == 0


@settings(max_examples=5, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 0x7FF), st.binary(max_size=8)), min_size=1, max_size=20))
def test_random_frames_raise_no_exception_and_any_fault_stops_all(
    frames: list[tuple[int, bytes]],
) -> None:
    bench = CanBench()
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 60.0, 0.3))
    bench.run(0.2)
    for cob, data in frames:
        stray(bench, cob, data)
        bench.tick()
    bench.run(1.0)
    sample = axes.sample()
    if sample.fault:
        assert not sample.enabled
    before = bench.peers.machine.get_true_positions()
    bench.run(0.1)
    assert bench.peers.machine.get_true_positions() == before
    bench.close()


def test_bus_off_error_frame_stops_everything(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    assert bench.peers.network.bus is not None
    bench.peers.network.bus.send(can.Message(arbitration_id=0x04, is_error_frame=True))  # a warning only
    bench.run(0.05)
    assert axes.sample().fault == ""
    bench.peers.network.bus.send(can.Message(arbitration_id=0x40, is_error_frame=True))
    bench.run(0.05)
    assert axes.sample().fault.startswith("bus-off")
    assert not axes.sample().enabled
