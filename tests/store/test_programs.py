"""Programs and versions, part counts, events, settings."""

from __future__ import annotations

import pytest

from core.store.offsets.offset_tables import ChangeReason
from core.store.program_records import check_new_program_name
from core.store.store import Store, StoreError
from core.store.store_export import import_programs_and_offsets
from core.store.store_rows import EventRow
from tests.coded import raises_code


def test_every_save_is_a_version(store: Store) -> None:
    assert store.programs.save_version("PIN.nc", b"G90\r\n", "new").result() == 1
    assert store.programs.save_version("PIN.nc", b"G91\r\n", "wrong mode").result() == 2
    assert store.programs.load_version("PIN.nc") == b"G91\r\n"
    assert store.programs.load_version("PIN.nc", 1) == b"G90\r\n"
    newest, first = store.programs.list_versions("PIN.nc")
    assert (newest.number, newest.why, first.number, first.size) == (2, "wrong mode", 1, 5)
    assert [(row.name, row.newest_version) for row in store.programs.list_programs()] == [("PIN.nc", 2)]


def test_identical_text_creates_no_new_version(store: Store) -> None:
    store.programs.save_version("a", b"G90", "x")
    assert store.programs.save_version("a", b"G90", "again").result() == 1
    assert len(store.programs.list_versions("a")) == 1


def test_return_to_an_old_text_creates_a_version(store: Store) -> None:
    for text in (b"1", b"2", b"1"):
        store.programs.save_version("a", text, "x").result()
    assert [row.number for row in store.programs.list_versions("a")] == [3, 2, 1]


def test_arbitrary_bytes_are_saved_unchanged(store: Store) -> None:
    text = bytes(range(256))
    store.programs.save_version("odd", text, "x").result()
    assert store.programs.load_version("odd") == text


_DEVICES = ["NUL", "con.nc", "COM1.nc", "Lpt9", "AUX .nc", "com².tar.nc", "PRN.H"]


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "a\\b", "a\0", " a", "a\n", "x" * 201, "C:a"])
def test_invalid_file_name_is_rejected(store: Store, name: str) -> None:
    with raises_code(StoreError, "invalid-name"):
        store.programs.save_version(name, b"", "x").result()
    with raises_code(StoreError, "invalid-name"):
        check_new_program_name(name)
    assert store.programs.list_programs() == ()


@pytest.mark.parametrize("name", _DEVICES)
def test_new_name_of_a_windows_device_is_rejected(store: Store, name: str) -> None:
    store.programs.save_version("pin.nc", b"1", "x").result()
    with raises_code(StoreError, "device-name", repr(name)):
        check_new_program_name(name)
    with raises_code(StoreError, "device-name", repr(name)):
        store.programs.rename_program("pin.nc", name).result()
    assert [row.name for row in store.programs.list_programs()] == ["pin.nc"]


def test_new_name_with_a_final_period_is_rejected(store: Store) -> None:
    store.programs.save_version("pin.nc", b"1", "x").result()
    with raises_code(StoreError, "invalid-name"):
        store.programs.rename_program("pin.nc", "part.").result()
    assert [row.name for row in store.programs.list_programs()] == ["pin.nc"]


@pytest.mark.parametrize("name", [*_DEVICES, "part."])
def test_versions_of_an_existing_program_are_saved_under_any_earlier_name(store: Store, name: str) -> None:
    store.programs.save_loaded_version(name, b"1", "run").result()
    assert store.programs.load_version(name) == b"1"


@pytest.mark.parametrize("name", ["NULL.nc", "COM0.nc", "COM10.nc", "part.com1", "CONE.nc", "a.b", "-nul"])
def test_name_that_only_resembles_a_device_is_accepted(store: Store, name: str) -> None:
    store.programs.save_version("pin.nc", b"1", "x").result()
    store.programs.rename_program("pin.nc", name).result()
    assert [row.name for row in store.programs.list_programs()] == [name]


def test_missing_program_and_version_are_refused(store: Store) -> None:
    store.programs.save_version("a", b"", "x").result()
    with raises_code(StoreError, "no-program", "'b'"):
        store.programs.load_version("b")
    with raises_code(StoreError, "no-program", "version 2 of program 'a'"):
        store.programs.load_version("a", 2)
    assert store.programs.list_versions("b") == ()


def test_damaged_text_is_not_returned(store: Store) -> None:
    store.programs.save_version("a", b"X1.000", "x").result()
    store.write(lambda c: c.execute("UPDATE program_versions SET text = X'58'").close()).result()
    with raises_code(StoreError, "damaged-version"):
        store.programs.load_version("a")


def test_parts_are_counted_by_program(store: Store) -> None:
    store.runs.add_parts("a")
    store.runs.add_parts("a")
    store.runs.add_parts("b").result()
    assert (
        store.runs.read_part_count("a"),
        store.runs.read_part_count("b"),
        store.runs.read_part_count("c"),
    ) == (
        2,
        1,
        0,
    )
    store.runs.reset_parts("a").result()
    assert (store.runs.read_part_count("a"), store.runs.read_part_count("b")) == (0, 1)


def test_events_are_listed_newest_first_and_searched(store: Store) -> None:
    rows = [EventRow("2026-01-01T00:00:00.000Z", "alarm", "X following error", 12, "one-alarm102.scope")]
    rows.append(EventRow("2026-01-01T00:00:01.000Z", "start", "PIN.nc"))
    store.events.log_events(rows)
    store.events.log_event("stop", "feed hold").result()
    assert [row.kind for row in store.events.read_events()] == ["stop", "start", "alarm"]
    assert store.events.read_events(search_text="FOLLOWING") == (rows[0],)
    assert store.events.read_events(search_text="%") == ()  # no pattern, a text
    assert len(store.events.read_events(limit=1)) == 1


def test_settings_are_stored_as_json(store: Store) -> None:
    store.settings.save_setting("theme", {"dark": True, "size": [1, 2]}).result()
    assert store.settings.read_setting("theme") == {"dark": True, "size": [1, 2]}
    store.settings.save_setting("theme", None).result()
    assert store.settings.read_setting("theme") is None


def test_setting_that_is_not_json_is_rejected(store: Store) -> None:
    with raises_code(StoreError, "unstorable-setting", "theme"):
        store.settings.save_setting("theme", object()).result()
    with raises_code(StoreError, "unstorable-setting", "pot"):
        store.settings.save_setting("pot", float("nan")).result()


def test_failed_operation_is_rolled_back_and_writer_continues(store: Store) -> None:
    def breaks(connection: object) -> None:
        raise KeyError("a bug")

    with pytest.raises(KeyError):
        store.write(breaks).result()
    with raises_code(StoreError, "constraint"):
        store.write(lambda c: c.execute("INSERT INTO settings VALUES ('k', NULL)").close()).result()
    assert store.write_error == ""  # nothing is wrong with the disk
    assert store.programs.save_version("a", b"", "x").result() == 1
    assert store.settings.read_setting("k") is None


def test_failed_import_imports_nothing(store: Store) -> None:
    with raises_code(StoreError, "invalid-name"):
        store.write(
            lambda c: import_programs_and_offsets(
                c, {"good": b"1", "bad/name": b"2"}, {}, ChangeReason("import", "import")
            )
        ).result()
    assert store.programs.list_programs() == ()


def test_closed_store_refuses_writes(store: Store) -> None:
    store.close()
    with raises_code(StoreError, "closed"):
        store.events.log_event("start", "late")


def test_part_count_is_corrected_by_hand_and_never_negative(store: Store) -> None:
    store.runs.add_parts("a", 2).result()
    assert store.runs.read_part_count("a") == 2
    store.runs.add_parts("a")
    store.runs.add_parts("a", -1).result()
    assert store.runs.read_part_count("a") == 2
    store.runs.add_parts("a", -5).result()
    assert store.runs.read_part_count("a") == 0
    assert store.runs.read_part_count("b") == 0
