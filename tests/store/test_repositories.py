"""The repositories of one store share its connection, and none writes where the store does not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from app.desk.persistence import NullRunRecords, Persistence
from core.store.offsets.touch_off import TouchPosition
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_rows import FieldValue, OffsetKind
from core.store.user_records import UserRow
from tests.coded import raises_code

AT = "2026-01-01T00:00:00.000Z"
ANNA = UserRow("ANNA", 3, b"salt", b"hash")
WRITES: dict[str, Callable[[Store], object]] = {
    "offsets": lambda store: store.offsets.tool_offsets.change_row(1, "set", {"x": 1.0}),
    "touch": lambda store: store.offsets.tool_offsets.set_touched_offset(1, TouchPosition(1.0, 1.0), "touch"),
    "undo": lambda store: store.offsets.undo_last_step(),
    "programs": lambda store: store.programs.save_version("a.nc", b"M30", "saved"),
    "runs": lambda store: store.runs.record_run_start("a.nc"),
    "parts": lambda store: store.runs.add_parts("a.nc"),
    "cycles": lambda store: store.cycles.record_row(CycleRow("1", "a.nc", 1, AT)),
    "stops": lambda store: store.cycles.record_row(ProductionStopRow("1", "", "a.nc", AT, 2.0, "held")),
    "jobs": lambda store: store.jobs.add_job("a.nc", 3),
    "events": lambda store: store.events.log_event("start", "a.nc"),
    "settings": lambda store: store.settings.save_setting("theme", "dark"),
    "people": lambda store: store.people.save_user(ANNA),
}


@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_no_repository_of_a_read_only_store_writes(
    store: Store, folder: Path, write: Callable[[Store], object]
) -> None:
    with Store.open(folder, read_only=True) as reader, raises_code(StoreError, "read-only"):
        write(reader)


@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_no_repository_of_a_closed_store_writes(store: Store, write: Callable[[Store], object]) -> None:
    store.close()
    with raises_code(StoreError, "closed"):
        write(store)


@pytest.mark.parametrize("kind", OffsetKind)
def test_each_table_changes_only_its_own_rows(store: Store, kind: OffsetKind) -> None:
    number = 54 if kind is OffsetKind.ZERO else 2
    fields: dict[OffsetKind, dict[str, FieldValue]] = {
        OffsetKind.SHAPE: {"kind": "drill"},
        OffsetKind.MILL_TOOL: {"length": 5.0},
    }
    store.offsets.get_table(kind).change_row(number, "set", fields.get(kind, {"x": 5.0})).result()
    rows = {each: store.offsets.get_table(each).read_rows() for each in OffsetKind}
    assert [each for each in OffsetKind if rows[each]] == [kind]
    assert list(rows[kind]) == [number]
    assert [change.kind for change in store.offsets.read_history()] == [kind]
    assert store.offsets.get_table(kind).remove_row(number, "sold").result() is True
    assert store.offsets.get_table(kind).read_rows() == {}


def test_jobs_move_to_position_and_unknown_job_is_rejected(store: Store) -> None:
    first, second = (store.jobs.add_job(name, 5).result() for name in ("a.nc", "b.nc"))
    store.jobs.move_job(second, 1).result()
    assert [row.id for row in store.jobs.read_jobs()] == [second, first]
    store.jobs.remove_job(second).result()
    with raises_code(StoreError, "job-gone"):
        store.jobs.remove_job(second).result()
    with raises_code(StoreError, "part-count"):
        store.jobs.add_job("a.nc", 0).result()
    assert store.jobs.clear_jobs(remove_all=True).result() == 1


def test_the_last_user_of_service_level_is_not_removed(store: Store) -> None:
    store.people.save_user(ANNA).result()
    store.people.save_user(UserRow("BEN", 1, b"salt", b"hash")).result()
    with raises_code(StoreError, "last-service-person"):
        store.people.remove_user("ANNA").result()
    with raises_code(StoreError, "unknown-person"):
        store.people.remove_user("CARL").result()
    assert [row.name for row in store.people.read_users().rows] == ["ANNA", "BEN"]
    assert store.people.remove_all_users().result() == 2


def test_rename_transfers_the_loaded_text(store: Store) -> None:
    store.programs.save_loaded_version("a.nc", b"M30", "loaded to run").result()
    store.programs.rename_program("a.nc", "b.nc").result()
    store.runs.add_parts("b.nc", 2).result()
    assert (store.runs.read_part_count("a.nc"), store.runs.read_part_count("b.nc")) == (0, 2)
    assert len(store.runs.read_records_by_text()) == 1


def test_records_are_dropped_and_changes_rejected_without_store() -> None:
    nothing = Persistence()
    nothing.runs.add_parts("a.nc", 3)
    assert (nothing.runs.read_part_count("a.nc"), nothing.runs.read_records_by_text()) == (0, {})
    with raises_code(StoreError, "nothing-stored"):
        nothing.require_store()
    with pytest.raises(StoreError) as refused:
        NullRunRecords("the disk is full").read_records_by_text()
    assert str(refused.value) == "the disk is full"
