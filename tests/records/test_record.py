"""Records of the scope: channels by name, and a stretch cut out of one."""

from __future__ import annotations

import numpy as np

from core.records.record import Channel, ScopeRecord, list_machine_channels


def test_rotary_axis_channel_is_in_degrees_and_input_channel_is_logic() -> None:
    channels = list_machine_channels({"X": False, "C": True}, ("COLLET",), ())
    assert Channel("X following error", "mm") in channels
    assert Channel("C actual", "deg") in channels
    assert Channel("input COLLET", "", True) in channels


def test_selected_interval_has_its_own_limits_and_start_time() -> None:
    times = np.arange(5.0, dtype=np.float64) * 0.25 + 100.0
    record = ScopeRecord((Channel("queue", "s"),), times, {"queue": np.arange(5.0)}, 1_000.0, 4.0)
    cut = record.select_time_range(100.25, 100.75)
    assert cut.values_by_channel["queue"].tolist() == [1.0, 2.0, 3.0]
    assert cut.start_time_utc_s == 1_000.25


def test_selected_interval_without_samples_is_empty() -> None:
    record = ScopeRecord((Channel("queue", "s"),), np.array([1.0]), {"queue": np.array([0.2])}, 5.0, 1.0)
    assert record.select_time_range(2.0, 3.0).times_s.size == 0
