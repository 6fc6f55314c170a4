"""Records as files: saved and opened to the bit; damaged, foreign and newer ones are refused."""

from __future__ import annotations

import errno
import io
import json
import os
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.records.record import MAX_RECORD_BYTES, Channel, RecordError, ScopeRecord
from core.records.record_file import RECORD_SUFFIX, open_record, save_csv, save_record, write_csv_lines
from tests.coded import raises_code

NAN = float("nan")
CHANNELS = (Channel("X demand", "mm"), Channel("spindle load", "%"), Channel("input guard, left", "", True))


def record() -> ScopeRecord:
    columns = {
        "X demand": np.array([0.1, 1.0 / 3.0, -2.0]),
        "spindle load": np.array([NAN, 12.5, NAN]),
        "input guard, left": np.array([NAN, 0.0, 1.0]),
    }
    return ScopeRecord(
        CHANNELS, np.array([5.0, 5.001, 5.25]), columns, 1_700_000_000.5, 1000.0, {"program": "PIN"}
    )


def test_opened_record_equals_saved_record_bit_for_bit(tmp_path: Path) -> None:
    save_record(record(), tmp_path / f"one{RECORD_SUFFIX}")
    found, wanted = open_record(tmp_path / f"one{RECORD_SUFFIX}"), record()
    np.testing.assert_array_equal(found.times_s, wanted.times_s)
    for name, column in wanted.values_by_channel.items():
        np.testing.assert_array_equal(found.values_by_channel[name], column, name)
    assert (found.channels, found.about) == (wanted.channels, wanted.about)
    assert (found.start_time_utc_s, found.sampling_rate_hz) == (
        wanted.start_time_utc_s,
        wanted.sampling_rate_hz,
    )
    assert [each.name for each in tmp_path.iterdir()] == ["one.scope"]


def test_csv_has_full_precision_and_leaves_unknown_values_empty() -> None:
    out = io.StringIO()
    write_csv_lines(record(), out.write)
    assert out.getvalue().splitlines() == [
        "t [s],X demand [mm],spindle load [%],input guard  left",
        "0.000000,0.1,,",
        "0.001000,0.3333333333333333,12.5,0",
        "0.250000,-2.0,,1",
    ]


@pytest.mark.parametrize("cut", [30, 300, -30])
def test_truncated_file_is_rejected(tmp_path: Path, cut: int) -> None:
    path = tmp_path / "cut.scope"
    save_record(record(), path)
    path.write_bytes(path.read_bytes()[:cut])
    with raises_code(RecordError, "cut-off", "cut.scope"):
        open_record(path)


def test_damaged_file_is_rejected_at_every_damage_position(tmp_path: Path) -> None:
    path = tmp_path / "bad.scope"
    save_record(record(), path)
    whole = path.read_bytes()
    for at in range(0, len(whole) - 4, 11):
        path.write_bytes(whole[:at] + bytes(255 - byte for byte in whole[at : at + 4]) + whole[at + 4 :])
        try:
            found = open_record(path)
        except RecordError as error:
            assert "bad.scope" in str(error)  # noqa: PT017  either it is refused, or nothing is lost
        else:
            np.testing.assert_array_equal(
                found.values_by_channel["X demand"], record().values_by_channel["X demand"]
            )


@pytest.mark.parametrize("text", [b"", b"G01X1\n", b"\x00" * 5000, b"PNG no record"])
def test_file_of_another_type_is_rejected(tmp_path: Path, text: bytes) -> None:
    path = tmp_path / "part.nc"
    path.write_bytes(text)
    with raises_code(RecordError, "not-a-record", "part.nc"):
        open_record(path)


def test_zip_archive_with_other_content_is_rejected(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "other.zip", "w") as archive:
        archive.writestr("readme.txt", "hello")
    with raises_code(RecordError, "not-a-record", "other.zip"):
        open_record(tmp_path / "other.zip")


def test_pickled_objects_in_archive_are_never_executed(tmp_path: Path) -> None:
    """An archive of numpy may hold pickled objects, which are programs."""
    path = tmp_path / "evil.scope"
    with path.open("wb") as file:
        np.savez(file, about=np.array([{"version": 1}], dtype=object))
    with raises_code(RecordError, "damaged", "evil.scope"):
        open_record(path)


def changed(path: Path, **changes: object) -> None:
    """The same record, described in another way."""
    save_record(record(), path)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    told = json.loads(arrays["about"].tobytes()) | changes
    arrays["about"] = np.frombuffer(json.dumps(told).encode(), dtype=np.uint8)
    with path.open("wb") as file:
        np.savez(file, **arrays)


def test_newer_file_version_is_rejected(tmp_path: Path) -> None:
    changed(tmp_path / "new.scope", version=9)
    with raises_code(RecordError, "newer-version", "file version 9"):
        open_record(tmp_path / "new.scope")


@pytest.mark.parametrize(
    "changes",
    [
        {"version": "x"},
        {"channels": 3},
        {"channels": [["a", "b"]]},
        {"about": None},
        {"started": "noon"},
        {"channels": [["X", "mm", False]] * 9},
        {"started": 1e300},
        {"started": -1e9},
        {"started": NAN},
        {"rate": float("inf")},
        {"rate": 10**400},
        {"channels": [["a\ud800", "mm", False], *CHANNELS[1:]]},
        {"channels": [["a\nb", "mm", False], *CHANNELS[1:]]},
        {"about": {"program": "\udfff"}},
    ],
)
def test_inconsistent_description_is_rejected(tmp_path: Path, changes: dict[str, object]) -> None:
    changed(tmp_path / "odd.scope", **changes)
    with raises_code(RecordError, "damaged", "odd.scope"):
        open_record(tmp_path / "odd.scope")


@pytest.mark.parametrize("times", [[0.0, NAN, 1.0], [0.0, np.inf, np.inf], [2.0, 1.0, 3.0]])
def test_non_increasing_times_are_rejected(tmp_path: Path, times: list[float]) -> None:
    save_record(replace(record(), times_s=np.array(times)), tmp_path / "odd.scope")
    with raises_code(RecordError, "damaged", "odd.scope"):
        open_record(tmp_path / "odd.scope")


def test_infinite_value_is_read_as_nan(tmp_path: Path) -> None:
    columns = {**record().values_by_channel, "spindle load": np.array([1.0, np.inf, -np.inf])}
    save_record(replace(record(), values_by_channel=columns), tmp_path / "one.scope")
    found = open_record(tmp_path / "one.scope").values_by_channel["spindle load"]
    np.testing.assert_array_equal(found, [1.0, NAN, NAN])


def test_zip_bomb_is_rejected_before_unpacking(tmp_path: Path) -> None:
    path = tmp_path / "bomb.scope"
    save_record(record(), path)
    data = bytearray(path.read_bytes())
    entry = data.index(b"PK\x01\x02")  # of the directory: it says what a member unpacks to
    data[entry + 24 : entry + 28] = (2**32 - 2).to_bytes(4, "little")
    path.write_bytes(data)
    with raises_code(RecordError, "damaged", "bomb.scope", MAX_RECORD_BYTES >> 20):
        open_record(path)


def test_library_error_text_is_not_included_in_message(tmp_path: Path) -> None:
    path = tmp_path / "odd.scope"
    with path.open("wb") as file:
        np.savez(file, about=np.frombuffer(b'{"version": "' + b"x" * 5000, dtype=np.uint8))
    with raises_code(RecordError, "damaged") as raised:
        open_record(path)
    assert "Unterminated" not in str(raised.value)


def test_missing_file_is_reported(tmp_path: Path) -> None:
    with raises_code(RecordError, "not-found", "gone.scope"):
        open_record(tmp_path / "gone.scope")


@pytest.mark.parametrize("save", [save_record, save_csv])
def test_full_disk_is_reported_and_old_file_remains(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, save: object
) -> None:
    path = tmp_path / "one.scope"
    path.write_text("old")

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "open", full)
    assert callable(save)
    with raises_code(RecordError, "disk-full", "one.scope"):
        save(record(), path)
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["one.scope"]
