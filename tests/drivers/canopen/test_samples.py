"""What the bus has sampled for the scope: one row a SYNC, as the drives answered it."""

from __future__ import annotations

import numpy as np
import pytest

from tests.drivers.canopen.bench import CanBench
from tests.drivers.machines import ramp


def test_each_sync_is_a_row_with_the_drives_positions(bench: CanBench) -> None:
    source = bench.machine.ports.samples
    assert source is not None
    assert source.rate == pytest.approx(1.0 / bench.machine.config.bus.sync)
    axes = bench.machine.axes
    axes.enable(True)
    source.take()
    width = 5 + 3 * len(axes.axes)
    begin = bench.clock.now() + axes.commit + 0.05
    axes.splice(ramp(begin, axes.sample().demand, 30.0, 0.5))  # type: ignore[arg-type]
    seen = []
    for _ in range(180):
        bench.tick()
        seen.append(axes.sample())
    rows = source.take()
    assert rows.shape[1] == width
    assert np.diff(rows[10:, 0]) == pytest.approx(bench.machine.config.bus.sync, abs=1e-6)
    by_time = {sample.t: sample for sample in seen}
    known = [row for row in rows if row[0] in by_time]
    assert len(known) > 50
    for row in known:
        assert tuple(row[1 : 1 + len(axes.axes)]) == by_time[row[0]].demand
        assert tuple(row[1 + len(axes.axes) : 1 + 2 * len(axes.axes)]) == by_time[row[0]].actual
    assert rows[:, 1].max() > 14.0
    assert np.isnan(rows[:, 1 + 2 * len(axes.axes) : 1 + 3 * len(axes.axes)]).all()  # no torque is mapped
