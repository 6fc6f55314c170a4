"""Signing in with a PIN, users in F10, and the service reset."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from app.desk.access import UserAccess
from app.extras.access.access_levels import AccessLevelsFunction
from app.extras.access.sign_in import RESET_DELAY_S, PinSignIn
from app.programs.program_list_model import ProgramListModel
from core.access.access_table import AccessLevel, ProtectedChange
from core.extras.access import pins
from core.extras.access.pins import (
    PinError,
    PinHash,
    WrongPinCounter,
    calculate_retry_delay,
    check_pin,
    hash_pin,
    is_pin_correct,
)
from core.store.store_file import STORE_FILE_NAME
from core.store.user_records import UserRow
from tests.desk.levels_room import LIMIT
from tests.extras.access.pin_room import PINS, TODAY, PinRoom
from tests.texts import begins, shows
from tests.texts import text as wording

HOUSE = Path(__file__).parents[3]
OPERATORS = {
    ProtectedChange.WEAR,
    ProtectedChange.COUNTS,
    ProtectedChange.INSERTS,
    ProtectedChange.READINGS,
    ProtectedChange.JOBS,
    ProtectedChange.SCREEN,
    ProtectedChange.INPUTS,
    ProtectedChange.BACKUPS,
}


# --- signing in ------------------------------------------------------------------------------------------


def test_header_shows_the_current_user_level(room: PinRoom) -> None:
    room.enter_people()
    assert room.access.header_text == "OPERATOR"
    room.sign_in("BEN")
    assert room.access.header_text.replace("\u2068", "").replace("\u2069", "") == "BEN · SETUP"
    room.access.sign_out()
    assert room.access.header_text == "OPERATOR"
    assert room.log("access") == [
        (wording("log.signed-in", name="BEN", level="SETUP"), "BEN"),
        (wording("log.signed-out", name="BEN", why=""), "BEN"),
    ]


def test_repeated_wrong_pins_increase_the_delay_and_are_logged(room: PinRoom) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    assert shows(room.desk.prompt_notice, "desk.wrong-pin", seconds=5)
    room.sign_in("BEN")  # the right one, but too early
    assert room.access.user_name == ""
    assert room.desk.prompt_notice == wording("desk.too-many-pins", seconds=5)
    room.at += 5.0
    room.sign_in("BEN")
    assert room.access.user_name == "BEN"
    assert room.log("access")[2] == (wording("log.wrong-pin", name="BEN", count=3), "operator")


def test_first_wrong_pin_states_no_delay_and_a_later_one_rounds_up(room: PinRoom) -> None:
    """The first two attempts are free; after the third, 5 s less 4.7 s leave 0.3 s, so 1 s is shown."""
    room.enter_people()
    room.sign_in("BEN", "0815")
    assert shows(room.desk.prompt_notice, "desk.wrong-pin-now")
    room.sign_in("BEN", "0815")
    room.sign_in("BEN", "0815")
    room.at += 4.7
    room.sign_in("BEN")
    assert room.access.user_name == ""
    assert room.desk.prompt_notice == wording("desk.too-many-pins", seconds=1)


def test_wrong_pin_count_survives_a_restart(room: PinRoom) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    room.settle()
    again = UserAccess(room.journal, read_time_s=lambda: 7.0)
    assert PinSignIn(again).wrong_pin_counter.get_remaining_delay(7.0) == 5.0


def test_wrong_pin_delays_are_limited() -> None:
    assert [calculate_retry_delay(count) for count in range(12)] == [
        0,
        0,
        0,
        5,
        10,
        20,
        40,
        80,
        160,
        300,
        300,
        300,
    ]
    wrong = WrongPinCounter()
    for moment in (0.0, 1.0, 2.0):
        wrong.count_wrong_pin(moment)
    assert wrong.get_remaining_delay(4.0) == 3.0
    wrong.reset_count()
    assert wrong.get_remaining_delay(4.0) == 0.0


@pytest.mark.parametrize("pin", ["", "123", "1234567890123", "12a4", "1111", "12 34", "١٢٣٤"])
def test_invalid_pin_is_rejected(pin: str) -> None:
    with pytest.raises(PinError):
        check_pin(pin)


def test_stored_pin_hash_uses_scrypt() -> None:
    """RFC 7914, chapter 12: the third vector has the N, r and p of older hashes, and our length in front."""
    old = "7023bdcb3afd7348461c06cd81fd38ebfda8fbba904f8e3ea9b543f6545da1f2"
    for kept in (
        PinHash(b"SodiumChloride", bytes.fromhex(old)),
        PinHash(b"SodiumChloride", bytes((14, 8, 1)) + bytes.fromhex(old)),
        hash_pin("pleaseletmein", b"SodiumChloride"),
    ):
        assert is_pin_correct("pleaseletmein", kept)
        assert not is_pin_correct("pleaseletmeIn", kept)
    assert hash_pin("4711") != hash_pin("4711")  # each has a salt of its own


def test_pin_check_has_the_required_scrypt_cost() -> None:
    """Older hashes took 0.03 s of an idle core: 32 times the work is 0.9 s."""
    work = TODAY.block_size * TODAY.parallelism << TODAY.log2_n
    assert work >= 32 * (8 * 1 << 14)


@pytest.mark.parametrize("damage", [b"", b"\x04\x08", bytes(31), bytes(34), bytes(40)])
def test_hash_of_another_length_matches_no_pin(damage: bytes) -> None:
    assert not is_pin_correct("4711", PinHash(b"salt", damage))


def test_old_hash_is_upgraded_when_its_pin_is_entered(room: PinRoom, monkeypatch: pytest.MonkeyPatch) -> None:
    room.enter_people()
    old = room.access.user_list.rows
    monkeypatch.setattr(pins, "DEFAULT_COST", pins.ScryptCost(5, 8, 1))
    room.sign_in("BEN", "9999")
    assert room.store.people.read_users().rows == old
    room.at += 300.0
    room.sign_in("BEN")
    now = room.store.people.read_users().find_user("BEN")
    assert now is not None
    assert (room.access.user_name, room.access.user_list.find_user("BEN")) == ("BEN", now)
    assert now.hash[:3] == bytes((5, 8, 1))
    assert is_pin_correct(PINS["BEN"], PinHash(now.salt, now.hash))
    assert {row for row in old if row.name != "BEN"} < set(room.store.people.read_users().rows)


def test_user_without_a_pin_cannot_sign_in(room: PinRoom) -> None:
    room.journal.require_store().people.save_user(UserRow("DORA", AccessLevel.SERVICE, b"", b"")).result()
    room.access.reload()
    room.sign_in("DORA", "4711")
    assert room.access.user_name == ""
    assert begins(room.desk.prompt_notice, "desk.no-pin", name="DORA")


def test_the_store_does_not_hold_the_pin(room: PinRoom, tmp_path: Path) -> None:
    room.journal.require_store().people.save_user(
        UserRow("DORA", AccessLevel.SERVICE, *hash_pin("660391827455"))
    ).result()
    room.settle()
    for path in (tmp_path / "home").glob("turndesk.db*"):
        assert b"660391827455" not in path.read_bytes()


# --- time ------------------------------------------------------------------------------------------------


def test_level_times_out_after_a_warning(room: PinRoom) -> None:
    room.enter_people()
    room.sign_in("ANNA")
    room.at += 569.0
    room.desk.clear_prompt_line()
    room.run(1)
    assert room.desk.prompt_notice == ""
    room.at += 1.0
    room.run(1)
    assert shows(room.desk.prompt_notice, "desk.level-ends", seconds=30)
    room.access.record_activity()
    room.at += 599.0
    room.run(1)
    assert room.access.user_name == "ANNA"
    room.at += 1.0
    room.run(1)
    assert (room.access.user_name, room.access.access_level) == ("", AccessLevel.OPERATOR)
    assert shows(room.desk.prompt_notice, "desk.was-away")
    assert room.log("access")[-1] == (
        wording("log.signed-out", name="ANNA", why=wording("log.without-input", minutes=10)),
        "ANNA",
    )


def test_levels_return_with_a_store_that_was_missing_at_startup(room: PinRoom, tmp_path: Path) -> None:
    """Else whoever was there then could enter himself as the first one, beside those of the store."""
    room.enter_people()
    store, room.journal._store = room.journal._store, None
    folder, room.journal._folder = room.journal._folder, damaged_home(tmp_path)
    again = UserAccess(room.journal, read_time_s=lambda: room.at)
    room.desk.user_access = again  # type: ignore[misc]
    again.access_level = AccessLevel.OPERATOR
    PinSignIn(again)
    assert (again.user_list.is_access_restricted, again.user_list.rows) == (True, ())
    room.journal._store, room.journal._folder = store, folder
    room.at += 1.0
    room.run(1)
    assert shows(again.find_refusal_reason(ProtectedChange.PEOPLE), "screen.level-needed", level="SERVICE")
    assert [row.name for row in again.user_list.rows] == ["ANNA", "BEN", "CARLA"]
    again.close()


def damaged_home(tmp_path: Path) -> Path:
    folder = tmp_path / "damaged"
    folder.mkdir()
    (folder / STORE_FILE_NAME).write_bytes(b"SQLite format 3")
    return folder


def test_unreadable_users_leave_the_strictest_level(room: PinRoom, tmp_path: Path) -> None:
    room.journal._store, store = None, room.journal._store
    room.journal._folder = damaged_home(tmp_path)
    room.access.reload()
    may = {act for act in ProtectedChange if not room.access.find_refusal_reason(act)}
    assert may == OPERATORS
    reset = room.find(AccessLevelsFunction).service_reset
    assert reset.find_start_refusal(room.desk.read_snapshot()) == wording("desk.press-e-stop-first")
    reset.remove_all_users()
    room.session.worker.wait_for_results(LIMIT)
    room.at += 2.0
    room.run(1)
    assert [room.access.find_refusal_reason(act) for act in ProtectedChange] == [""] * len(ProtectedChange)
    room.journal._store = store


# --- people ----------------------------------------------------------------------------------------------


def typed(levels: AccessLevelsFunction, *texts: str) -> None:
    for text in texts:
        for sign in text:
            levels.handle_key(sign)
        levels.handle_key("Enter")


def test_first_user_has_service_level_and_enables_access_levels(room: PinRoom) -> None:
    levels = room.find(AccessLevelsFunction)
    levels.make_function_keys()["F3"].action()
    typed(levels, "anna", "4711")
    assert levels.make_table(room.desk.read_snapshot()).entry_prompt == wording("desk.same-pin-again")
    typed(levels, "4711")
    room.settle()
    assert [(row.name, row.level) for row in room.access.user_list.rows] == [("ANNA", 3)]
    levels.make_function_keys()["F3"].action()
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    typed(levels, "", "4711")  # Return on her name, and her PIN
    room.settle()
    levels.make_function_keys()["F3"].action()
    typed(levels, "Ben", "2", "2580", "2580")
    room.settle()
    assert [(row.name, row.level) for row in room.access.user_list.rows] == [("ANNA", 3), ("BEN", 2)]
    assert room.log("access")[-1] == (wording("log.entered", name="BEN", level="SETUP"), "ANNA")


def test_different_pins_are_not_stored(room: PinRoom) -> None:
    levels = room.find(AccessLevelsFunction)
    levels.make_function_keys()["F3"].action()
    typed(levels, "anna", "4711", "4712")
    room.settle()
    assert not room.access.user_list.is_access_restricted
    assert wording("desk.two-different-pins").upper() in room.desk.prompt_notice.upper()


def test_a_pin_is_not_shown(room: PinRoom) -> None:
    room.enter_people()
    levels = room.find(AccessLevelsFunction)
    levels.activate_selected_row()
    for sign in "4711":
        levels.handle_key(sign)
    assert levels.make_table(room.desk.read_snapshot()).text == "●●●●"
    assert not levels.accepts_key("x")
    levels.on_close()
    assert levels.entry.text == ""


# --- service reset ---------------------------------------------------------------------------------------


def pressed(room: PinRoom) -> Callable[[], None]:
    room.enter_people()
    room.desk.station_keys.press_estop()
    room.run()
    levels = room.find(AccessLevelsFunction)
    levels.make_function_keys()["F9"].action()
    assert begins(room.desk.prompt_notice, "desk.take-all-pins-away")
    levels.service_reset.start()
    return levels.service_reset.start


def test_ten_minutes_of_estop_reset_all_pins(room: PinRoom) -> None:
    pressed(room)
    room.at += RESET_DELAY_S - 1.0
    room.run(1)
    assert room.access.user_list.is_access_restricted
    assert room.access.header_text == wording("desk.pins-reset-in", time="0:01")
    room.at += 1.0
    room.run(1)
    room.settle()
    assert not room.access.user_list.is_access_restricted
    assert room.access.header_text == ""
    told = [text for text, _who in room.log("access")]
    assert begins(told[0], "desk.reset-begun")
    assert told[-1] == wording("desk.reset-done")


def test_pin_reset_requires_estop_and_ends_with_it(room: PinRoom) -> None:
    room.enter_people()
    room.find(AccessLevelsFunction).ask_for_pin_reset()
    assert begins(room.desk.prompt_notice, "desk.e-stop-for-reset")
    pressed(room)
    room.at += 300.0
    room.run(1)
    room.desk.station_controls.estop(is_pressed=False)
    room.run()
    room.at += RESET_DELAY_S
    room.run(1)
    room.settle()
    assert room.access.user_list.is_access_restricted
    assert room.log("access")[-1][0] == wording("desk.reset-given-up")


def test_pin_entry_cancels_the_reset(room: PinRoom) -> None:
    pressed(room)
    room.sign_in("ANNA")
    room.run(1)
    room.at += RESET_DELAY_S
    room.run(1)
    room.settle()
    assert room.access.user_list.is_access_restricted


def test_change_begun_at_a_level_is_not_completed_after_sign_out(room: PinRoom) -> None:
    """What was begun in a level is not ended by whoever finds it open when that level has fallen back."""
    room.enter_people()
    room.sign_in("ANNA")
    levels, programs = room.find(AccessLevelsFunction), room.desk.page_registry.find_model(ProgramListModel)
    assert programs is not None
    levels.make_function_keys()["F3"].action()
    typed(levels, "eve", "3", "1357")
    programs.program_transfer.open_chooser((), None, is_export=False)
    room.at += 600.0
    room.run(1)
    typed(levels, "1357")
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    room.desk.clear_prompt_line()
    programs.program_transfer.worker.wait_for_results(LIMIT)
    programs.program_transfer._carry((HOUSE / "setup.cfg",), HOUSE, replace=True)
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert not programs.program_transfer.worker.is_busy
    room.settle()
    assert room.access.user_list.find_user("EVE") is None
