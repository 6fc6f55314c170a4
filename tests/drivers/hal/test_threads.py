"""A thread by the measured spindle, geared in HAL's servo thread: a real halrun, a spindle that wanders."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from core.records.record import FloatArray
from core.records.record_file import open_record
from tests.drivers.hal.lathes import PATIENT, WANDER, WANDER_HAL, lathe, run

LEAD = 1.27  # mm
THREAD = "G90G94F100\nT1\nM03S800\nX.25Z.2\nG33X.24Z-.3I.01K.05\nX.3\nZ.2\nM30\n"
_CUTS = 0.5  # mm behind the running up, and before the pull-out


def passes_of(z: FloatArray, turns: FloatArray) -> list[FloatArray]:
    """Of each pass what Z is off the spindle, mm, in the length of its thread."""
    cuts = (z < z.max() - 0.2 * 25.4 - _CUTS) & (z > z.min() + _CUTS) & (np.gradient(z) < -1e-3)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], cuts.astype(int), [0]))))
    parts = [
        slice(first, last) for first, last in pairwise(edges.tolist()) if cuts[first] and last - first > 300
    ]
    return [z[part] + LEAD * turns[part] for part in parts]


@pytest.mark.long
@pytest.mark.usefixtures("halrun")
@pytest.mark.real_time
def test_every_pass_has_the_lead_of_the_measured_spindle_and_the_same_start(tmp_path: Path) -> None:
    done = run(tmp_path, THREAD, lathe(tmp_path, (*PATIENT, *WANDER), WANDER_HAL))
    assert "complete" in done.stdout, done.stdout + done.stderr
    record = open_record(tmp_path / "home" / "records" / "run.ring")
    speed = record.values_by_channel["spindle speed"]
    assert np.nanmax(speed) == pytest.approx(816.0, abs=2.0)  # it did wander
    passes = passes_of(record.values_by_channel["Z demand"], record.values_by_channel["spindle turns"])
    assert len(passes) >= 2
    for off in passes:
        assert np.ptp(off) < 1e-6  # mm: reckoned from the reading of the same period
        index = off / LEAD
        assert np.abs(index - np.round(index)).max() < 1e-6
