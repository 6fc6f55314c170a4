"""What the bus has sampled for the scope: one row a SYNC, as the drives answered it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from core.ports import DriverError
from drivers.canopen.canopen_objects import ACTUAL_TORQUE
from drivers.canopen.canopen_setup import NodeSetup
from drivers.simulators.canopen_axis_drive import AxisDrive
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.machines import ramp


def test_each_sync_gives_a_sample_row_with_the_drive_positions(bench: CanBench) -> None:
    source = bench.machine.ports.samples
    assert source is not None
    assert source.sample_rate_hz == pytest.approx(1.0 / bench.machine.config.bus_settings.sync)
    axes = bench.machine.axes
    axes.enable(True)
    source.take_samples()
    width = 5 + 3 * len(axes.axes)
    begin = bench.clock.now() + axes.commit + 0.05
    axes.splice(ramp(begin, axes.sample().demand, 30.0, 0.5))
    seen = []
    for _ in range(180):
        bench.tick()
        seen.append(axes.sample())
    rows = source.take_samples()
    assert rows.shape[1] == width
    assert np.diff(rows[10:, 0]) == pytest.approx(bench.machine.config.bus_settings.sync, abs=1e-6)
    by_time = {sample.t: sample for sample in seen}
    known = [row for row in rows if row[0] in by_time]
    assert len(known) > 50
    for row in known:
        assert tuple(row[1 : 1 + len(axes.axes)]) == by_time[row[0]].demand
        assert tuple(row[1 + len(axes.axes) : 1 + 2 * len(axes.axes)]) == by_time[row[0]].actual
    assert rows[:, 1].max() > 14.0
    assert np.isnan(rows[:, 3 * len(axes.axes)]).all()  # C is the spindle, whose drive is none of an axis


def test_drive_torque_is_its_load_in_percent(bench: CanBench, monkeypatch: pytest.MonkeyPatch) -> None:
    """6077h counts per mille of the rated torque, signed."""
    read = AxisDrive.read
    monkeypatch.setattr(
        AxisDrive, "read", lambda self, index, sub: -345 if index == ACTUAL_TORQUE else read(self, index, sub)
    )
    source, axes = bench.machine.ports.samples, bench.machine.axes
    assert source is not None
    bench.run(0.2)
    assert list(source.take_samples()[-1, 1 + 2 * len(axes.axes) : 3 + 2 * len(axes.axes)]) == [-34.5, -34.5]


def test_drive_without_torque_mapping_reports_no_load_and_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    transmit = NodeSetup.map_sent_objects

    def no_fourth(
        self: NodeSetup, number: int, heard: Callable[..., None], *entries: tuple[int, int], every: int = 1
    ) -> None:
        if number == 4:
            raise DriverError("X: node 1, object 1A03:1: refused by the node", "drive-setup")
        transmit(self, number, heard, *entries, every=every)

    monkeypatch.setattr(NodeSetup, "map_sent_objects", no_fourth)
    bench = CanBench(can_machine())
    bench.machine.axes.enable(True)
    bench.run(0.2)
    assert bench.machine.axes.sample().fault == ""
    assert all(math.isnan(axis.drive.torque_percent) for axis in bench.machine.axes.drives.axes)
    bench.close()


def test_silent_drive_reports_no_load(bench: CanBench) -> None:
    bench.run(0.2)
    drive = bench.machine.axes.drives.axes[0].drive
    assert drive.torque_percent == 0.0
    drive.missing_reply_count = 10
    assert math.isnan(drive.torque_percent)
