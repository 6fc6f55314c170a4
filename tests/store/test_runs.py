"""What each program has done, its other name, and the log by kinds."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.desk.stored_part import StoredPart, load_stored_part
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import export_store
from core.store.store_file import make_stock_setting_key
from tests.coded import raises_code


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path) as store:
        yield store


def test_cycle_time_of_zero_is_not_the_best(store: Store) -> None:
    """As older versions kept it of parts that a restart had finished."""
    for seconds in (0.0, 31.5, 32.0):
        store.runs.record_cycle("pin.nc", seconds).result()
    assert store.runs.read_run_records()[0].best == 31.5


def test_best_and_latest_cycle_are_recorded(store: Store) -> None:
    for seconds in (31.5, 29.25, 30.0):
        store.runs.record_cycle("pin.nc", seconds)
    store.runs.record_run_start("pin.nc")
    store.runs.record_run_end("pin.nc", "COMPLETE").result(60)
    (row,) = store.runs.read_run_records()
    assert (row.cycles, row.best, row.latest, row.outcome) == (3, 29.25, 30.0, "COMPLETE")
    assert row.started is not None


def test_program_that_was_only_counted_or_proved_is_listed(store: Store) -> None:
    store.runs.add_parts("counted.nc")
    store.runs.record_proof("proved.nc", "PROVED", 12.5).result(60)
    rows = {row.program: row for row in store.runs.read_run_records()}
    assert (rows["counted.nc"].parts, rows["counted.nc"].best) == (1, None)
    assert (rows["proved.nc"].proof, rows["proved.nc"].planned) == ("PROVED", 12.5)


def test_renamed_program_retains_its_data(store: Store) -> None:
    store.programs.save_version("old.nc", b"M30", "test")
    store.runs.add_parts("old.nc")
    store.runs.record_cycle("old.nc", 10.0)
    store.programs.rename_program("old.nc", "new.nc").result(60)
    assert [row.program for row in store.runs.read_run_records()] == ["new.nc"]
    assert store.runs.read_part_count("new.nc") == 1
    assert store.programs.load_version("new.nc") == b"M30"
    assert store.programs.list_versions("old.nc") == ()


def test_versions_of_old_and_new_name_are_not_mixed(store: Store) -> None:
    store.programs.save_version("old.nc", b"old", "test")
    store.programs.save_version("new.nc", b"deleted long ago", "test")
    store.programs.rename_program("old.nc", "new.nc").result(60)
    assert store.programs.load_version("new.nc") == b"deleted long ago"
    assert store.programs.load_version("old.nc") == b"old"


@pytest.mark.parametrize("name", ["", "a/b", "..", " x"])
def test_rename_to_invalid_name_is_rejected_and_changes_nothing(store: Store, name: str) -> None:
    store.runs.add_parts("pin.nc").result(60)
    with raises_code(StoreError, "invalid-name"):
        store.programs.rename_program("pin.nc", name).result(60)
    assert store.runs.read_part_count("pin.nc") == 1


def test_events_are_filtered_by_kind(store: Store) -> None:
    for kind, text in (("alarm", "Z"), ("start", "pin"), ("alarm", "spindle"), ("end", "pin")):
        store.events.log_event(kind, text).result(60)
    assert [event.text for event in store.events.read_events(kinds={"alarm"})] == ["spindle", "Z"]
    assert [event.text for event in store.events.read_events("SPIN", kinds={"alarm", "end"})] == ["spindle"]
    assert len(store.events.read_events()) == 4
    assert store.events.read_events(kinds={"nothing"}) == ()


def test_export_contains_runs_as_csv(store: Store, tmp_path: Path) -> None:
    store.runs.record_run_start("pin.nc")
    store.runs.record_cycle("pin.nc", 30.5)
    store.runs.record_run_end("pin.nc", 'ALARM 102, "X"')
    store.runs.add_parts("pin.nc")
    store.runs.record_proof("ring.nc", "2 ERRORS: line 4", None).result(60)
    export_store(store, tmp_path / "out")
    with (tmp_path / "out" / "runs.csv").open(newline="", encoding="utf-8") as file:
        pin, ring = csv.DictReader(file)
    assert (pin["program"], pin["parts"], pin["cycles"], pin["best_s"], pin["latest_s"]) == (
        "pin.nc",
        "1",
        "1",
        "30.5",
        "30.5",
    )
    assert pin["outcome"] == 'ALARM 102, "X"'
    assert pin["started"].endswith("Z")
    assert (ring["proof"], ring["planned_s"], ring["started"]) == ("2 ERRORS: line 4", "", "")


def test_export_without_runs_contains_header_only(store: Store, tmp_path: Path) -> None:
    export_store(store, tmp_path / "out")
    told = (tmp_path / "out" / "runs.csv").read_text(encoding="utf-8").splitlines()
    assert told == ["program,parts,started,outcome,cycles,best_s,latest_s,proved,proof,planned_s"]


def test_stock_of_program_is_saved_renamed_and_deleted(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        assert store.settings.read_setting(make_stock_setting_key("PIN")) is None
        store.settings.save_setting(make_stock_setting_key("PIN"), "bar:.5").result()
        store.settings.save_setting(make_stock_setting_key("KNOB"), "bar:30mm").result()
        store.programs.rename_program("PIN", "KNOB").result()
        assert (
            store.settings.read_setting(make_stock_setting_key("PIN")),
            store.settings.read_setting(make_stock_setting_key("KNOB")),
        ) == (None, "bar:.5")
        store.settings.save_setting(make_stock_setting_key("KNOB"), None).result()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.settings.read_setting(make_stock_setting_key("KNOB")) is None
        with raises_code(StoreError, "read-only"):
            store.settings.save_setting(make_stock_setting_key("KNOB"), "bar:1")


def test_part_settings_follow_renamed_program(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        said = StoredPart("bar:1", 20.0, {"cuts-air": "it waits there"})
        for key, value in said.make_stored_settings("PIN").items():
            store.settings.save_setting(key, value).result()
        store.programs.rename_program("PIN", "KNOB").result()
        assert load_stored_part(store.settings.read_setting, "PIN") == StoredPart()
        assert load_stored_part(store.settings.read_setting, "KNOB") == said


def test_invalid_part_settings_are_ignored() -> None:
    kept: dict[str, object] = {
        "stock:PIN": 3,
        "part:PIN": {"stick_out": True, "silenced": "all"},
    }
    assert load_stored_part(kept.get, "PIN") == StoredPart()
