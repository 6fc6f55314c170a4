"""Positions beyond the 32-bit counter of a drive: one alarm, and the axes stop."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from core.faults import get_fault_code
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen.drive_set import PvtRecordQueue
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine, cyclic
from tests.drivers.machines import ramp

ZERO = (0.0, 0.0, 0.0)
# One count of the shipped machine is 0.00127 mm, so 2³¹ counts are 2 727 304 mm.
BEYOND, WITHIN = 2_728_000.0, 2_727_000.0


@pytest.mark.parametrize(
    "make",
    [
        can_machine,
        lambda: can_machine(('mode = "pvt"', 'mode = "pp"')),
        lambda: cyclic("csp"),
        lambda: cyclic("ip"),
    ],
    ids=["pvt", "pp", "csp", "ip"],
)
@pytest.mark.parametrize("place", [BEYOND, -BEYOND])
def test_path_beyond_the_counter_of_a_drive_is_a_fault_with_the_range(
    make: Callable[[], Machine], place: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = CanBench(make())
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.15, ZERO, 60.0, 0.5))
    monkeypatch.setattr(axes.queue, "get_commanded_state", lambda _t: ((0.0, place, 0.0), ZERO))
    for _ in range(100):
        bench.tick(0.002)
    fault = axes.sample().fault
    assert get_fault_code(fault, "axis") == "drive-limits"
    assert fault.startswith("Z: ")
    assert "±2727304.2" in fault
    assert not axes.sample().enabled
    bench.close()


@pytest.mark.parametrize("place", [BEYOND, -BEYOND, math.inf, math.nan])
def test_position_beyond_the_counter_is_not_converted(place: float) -> None:
    bench = CanBench()
    config = bench.machine.axes.drives.axes[0].config
    with raises_code(DriverError, "drive-limits", "X: ") as told:
        config.convert_position(place)
    assert told.value.reason == "counter-range"
    assert config.convert_position(WITHIN) == round(WITHIN / 0.00127)
    assert config.convert_position(-1.27) == -1000
    bench.close()


def test_record_with_a_speed_beyond_the_queue_names_the_axis_and_the_speed() -> None:
    """2²³ rpm at 4000 counts are 33 554 432 000 counts a minute, 710 235 mm/s."""
    bench = CanBench()
    axis = bench.machine.axes.drives.axes[0]
    sent: list[bytes] = []
    queue = axis.record_queue
    assert queue is not None
    queue = PvtRecordQueue(axis.config, queue.drive_queue, axis.drive.setup, sent.append)
    with raises_code(DriverError, "drive-limits", "X: ", "711000.0") as told:
        queue.send_record(10, 711_000.0, 1.27)
    assert told.value.reason == "record-range"
    assert sent == []
    queue.send_record(10, 709_000.0, 1.27)
    assert [len(record) for record in sent] == [8]
    bench.close()
