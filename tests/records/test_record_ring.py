"""The ring of the scope: what stands in it, what has been written over, and what is half written."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from core.records.record import FloatArray, RecordError
from core.records.record_ring import RingLayout, RowBuffer, ScopeRing, pack_bits
from core.records.ring_file import (
    CURRENT_RING_NAME,
    PREVIOUS_RING_NAME,
    RingFile,
    create_ring_file,
    read_ring_file,
)
from tests.coded import raises_code

OUTPUTS = tuple(f"out{n}" for n in range(60))  # more than one figure has bits for
OF = RingLayout(
    {"X": False, "C": True}, ("estop", "guard"), OUTPUTS, 1000.0, 1_000_000.0, "LATHE", duration_s=1.0
)
NAN = float("nan")


def samples(first: int, count: int) -> FloatArray:
    """X demand is 2 t and its actual .01 behind; C stands at 90; spindle at 600 rpm, not loaded."""
    t = np.arange(first, first + count) * 0.001
    one = np.ones(count)
    axes = [2.0 * t, 90.0 * one, 2.0 * t - 0.01, 90.0 * one, 50.0 * one, NAN * one]
    return np.column_stack([t, *axes, 600.0 * one, 10.0 * t, NAN * one, NAN * one])


def tick(t: float, line: int, on: tuple[str, ...] = ()) -> list[float]:
    bits = [*pack_bits(OF.input_names, ()), *pack_bits(OF.output_names, on)]
    return [t, 600.0, 599.0, NAN, 1.0, 0.5, 0.25, 0.001, float(line), 7.0, 4.0, *bits]


def filled() -> ScopeRing:
    ring = ScopeRing.from_layout(OF)
    ring.samples.append_rows(samples(0, 500))
    ring.ticks.append_rows(np.array([tick(0.1, 3), tick(0.2, 4, ("out1", "out59"))]))
    return ring


def test_channel_has_driver_value_or_value_of_last_tick() -> None:
    record = filled().get_record_between(0.05, 0.25)
    assert record.times_s[[0, -1]] == pytest.approx([0.05, 0.25])
    assert record.start_time_utc_s == pytest.approx(1_000_000.05)
    columns = record.values_by_channel
    assert columns["X following error"] == pytest.approx(0.01)
    assert columns["spindle turns"] == pytest.approx(10.0 * record.times_s)
    line = columns["line"]
    assert np.isnan(line[record.times_s < 0.0999]).all()
    assert set(line[(record.times_s > 0.1001) & (record.times_s < 0.1999)]) == {3.0}
    assert set(line[record.times_s > 0.2001]) == {4.0}
    assert (columns["queue"][-1], columns["spindle speed"][-1]) == (0.25, 600.0)  # measured beats the tick's
    assert np.isnan(columns["C load"]).all()
    assert np.isnan(columns["spindle load"]).all()
    assert [columns[f"output out{n}"][-1] for n in (0, 1, 58, 59)] == [0.0, 1.0, 0.0, 1.0]


def test_a_late_tick_between_two_samples_is_not_lost() -> None:
    ring = ScopeRing.from_layout(OF)
    ring.samples.append_rows(samples(0, 400)[::100])  # at 0, .1, .2, .3
    late = {0.0: 0.001, 0.12: 0.05, 0.15: 0.002, 0.19: 0.003, 0.31: 0.9}
    ring.ticks.append_rows(np.array([[*tick(t, 1)[:7], worst, *tick(t, 1)[8:]] for t, worst in late.items()]))
    assert ring.get_record_between(0.0, 1.0).values_by_channel["lateness"].tolist() == [
        0.001,
        0.001,
        0.05,
        0.003,
    ]


def test_latest_record_has_only_new_samples_of_requested_channels() -> None:
    record = filled().get_record_since(0.497, ("X demand", "line"))
    assert record.times_s == pytest.approx([0.498, 0.499])
    assert set(record.values_by_channel) == {"X demand", "line"}
    assert filled().get_record_since(0.499).times_s.size == 0


@pytest.mark.parametrize("batch", [1, 7, 999, 1000, 2600])
def test_oldest_samples_are_overwritten(batch: int) -> None:
    ring = ScopeRing.from_layout(OF)
    everything = samples(0, 2600)
    for at in range(0, 2600, batch):
        ring.samples.append_rows(everything[at : at + batch])
    kept = ring.samples.copy_rows_between(-np.inf, np.inf)
    np.testing.assert_array_equal(kept, everything[-1000:])
    np.testing.assert_array_equal(ring.samples.copy_rows_between(2.0, 2.1), everything[2000:2101])


def test_rows_being_overwritten_are_not_read() -> None:
    rows = RowBuffer(100, 1)
    rows.append_rows(np.arange(100.0)[:, None])
    rows.started_row_count = 130  # a writer is at work on the thirty oldest
    assert rows.copy_rows_between(-1.0, 1000.0)[:, 0].tolist() == list(range(30, 100))


def test_rows_overwritten_during_copy_are_left_out() -> None:
    begun = iter((100, 130))  # before they are copied, and behind

    class Overtaken(RowBuffer):
        started_row_count = property(lambda _: next(begun), lambda _self, _value: None)

    rows = Overtaken(100, 1)
    rows.append_rows(np.arange(100.0)[:, None])
    assert rows.copy_rows_between(-1.0, 1000.0)[:, 0].tolist() == list(range(30, 100))


def test_a_torn_row_is_left_out() -> None:
    ring = filled()
    ring.samples.array[20, -1] = 19.0  # of another round
    ring.samples.array[30, 0] = 0.001  # its beginning is old
    times = ring.get_record_between(0.0, 0.05).times_s
    assert times.size == 49
    assert not {0.02, 0.03} & set(times.round(6).tolist())


# --- the file --------------------------------------------------------------------------------------------


def written(folder: Path, count: int = 1700) -> tuple[RingFile, ScopeRing]:
    ring = ScopeRing.from_layout(OF)
    file = create_ring_file(folder, CURRENT_RING_NAME, ring)
    everything = samples(0, count)
    for at in range(0, count, 300):
        file.write_rows(ring.samples, ring.samples.append_rows(everything[at : at + 300]))
    file.write_rows(ring.ticks, ring.ticks.append_rows(np.array([tick(0.1, 3), tick(1.2, 4, ("out59",))])))
    return file, ring


def test_reader_gets_same_samples_during_and_after_writing(tmp_path: Path) -> None:
    file, ring = written(tmp_path)
    wanted = ring.get_record_between(-np.inf, np.inf)
    for close in (file.close, lambda: None):
        found = read_ring_file(tmp_path / CURRENT_RING_NAME)
        np.testing.assert_array_equal(found.times_s, wanted.times_s)
        for name, column in wanted.values_by_channel.items():
            np.testing.assert_array_equal(found.values_by_channel[name], column, name)
        assert (found.channels, found.start_time_utc_s, found.sampling_rate_hz) == (
            wanted.channels,
            wanted.start_time_utc_s,
            1000.0,
        )
        assert found.about["machine"] == "LATHE"
        close()
    assert read_ring_file(tmp_path / CURRENT_RING_NAME, 1.0, 1.1).times_s == pytest.approx(
        np.arange(1000, 1101) * 0.001
    )


def test_file_has_full_size_before_first_sample_is_written(tmp_path: Path) -> None:
    ring = ScopeRing.from_layout(OF)
    file = create_ring_file(tmp_path, CURRENT_RING_NAME, ring)
    before = (tmp_path / CURRENT_RING_NAME).stat()
    assert before.st_blocks * 512 >= ring.samples.array.nbytes + ring.ticks.array.nbytes
    file.write_rows(ring.samples, ring.samples.append_rows(samples(0, 3000)))
    file.close()
    assert (tmp_path / CURRENT_RING_NAME).stat().st_size == before.st_size


def test_file_of_crashed_writer_has_all_counted_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, ring = written(tmp_path)
    real, calls = os.pwrite, []

    def ends(fd: int, data: memoryview, at: int) -> int:
        calls.append(at)
        if len(calls) == 2:  # told that it begins; now half of the rows
            real(fd, data[: len(data) // 2 - 20], at)
            raise OSError(errno.EIO, "killed here")
        return real(fd, data, at)

    parts = ring.samples.append_rows(samples(1700, 200))
    monkeypatch.setattr(os, "pwrite", ends)
    with pytest.raises(RecordError):
        file.write_rows(ring.samples, parts)
    monkeypatch.undo()
    times = read_ring_file(tmp_path / CURRENT_RING_NAME).times_s
    assert times == pytest.approx(np.arange(900, 1700) * 0.001)  # the 200 oldest may be written over
    file.close()


def test_previous_ring_file_remains_next_to_new_one(tmp_path: Path) -> None:
    written(tmp_path, 20)[0].close()
    create_ring_file(tmp_path, CURRENT_RING_NAME, ScopeRing.from_layout(OF)).close()
    assert read_ring_file(tmp_path / PREVIOUS_RING_NAME).times_s.size == 20
    assert read_ring_file(tmp_path / CURRENT_RING_NAME).times_s.size == 0


def test_second_writer_does_not_write_to_same_file(tmp_path: Path) -> None:
    file, _ = written(tmp_path, 20)
    with raises_code(RecordError, "in-use", "now.ring"):
        create_ring_file(tmp_path, CURRENT_RING_NAME, ScopeRing.from_layout(OF))
    assert read_ring_file(tmp_path / CURRENT_RING_NAME).times_s.size == 20
    file.close()


def test_full_disk_is_reported_and_leaves_empty_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_fd: int, _at: int, _size: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    with raises_code(RecordError, "disk-full", "now.ring"):
        create_ring_file(tmp_path, CURRENT_RING_NAME, ScopeRing.from_layout(OF))
    assert (tmp_path / CURRENT_RING_NAME).stat().st_size == 0


def test_ring_file_is_written_without_preallocation_and_locks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(os, "posix_fallocate")
    monkeypatch.delattr(os, "pwrite")
    monkeypatch.setitem(__import__("sys").modules, "fcntl", None)
    file, ring = written(tmp_path)
    np.testing.assert_array_equal(
        read_ring_file(tmp_path / CURRENT_RING_NAME).times_s, ring.get_record_between(0.0, 9.0).times_s
    )
    file.close()


def test_truncated_or_newer_ring_file_is_rejected(tmp_path: Path) -> None:
    written(tmp_path, 20)[0].close()
    path = tmp_path / CURRENT_RING_NAME
    whole = path.read_bytes()
    path.write_bytes(whole[:-100])
    with raises_code(RecordError, "cut-off"):
        read_ring_file(path)
    path.write_bytes(whole[:14] + b"\x07\x00\x00\x00" + whole[18:])
    with raises_code(RecordError, "newer-version", "file version 7"):
        read_ring_file(path)
    path.write_bytes(whole[:40] + b"\xff" * 60 + whole[100:])
    with raises_code(RecordError, "damaged"):
        read_ring_file(path)
