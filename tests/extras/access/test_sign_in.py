"""Signing in with a PIN, users in F10, and the service reset."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from app.desk.access import Access
from app.extras.access.access_levels import AccessLevels
from app.extras.access.sign_in import WAIT, SignIn
from app.programs.program_list import ProgramList
from core.access.access_table import Act, Level
from core.extras.access import pins
from core.extras.access.pins import Hashed, PinError, WrongPins, check_pin, hashed, is_pin, wait_after
from core.store.people import PersonRow
from core.store.store_file import FILE_NAME
from tests.desk.levels_room import LIMIT
from tests.extras.access.pin_room import PINS, TODAY, PinRoom
from tests.texts import begins, shows
from tests.texts import text as wording

HOUSE = Path(__file__).parents[3]
OPERATORS = {Act.WEAR, Act.COUNTS, Act.INSERTS, Act.READINGS, Act.JOBS, Act.SCREEN, Act.INPUTS, Act.BACKUPS}


# --- signing in ------------------------------------------------------------------------------------------


def test_the_header_says_who_is_in_force(room: PinRoom) -> None:
    room.enter_people()
    assert room.access.words == "OPERATOR"
    room.sign_in("BEN")
    assert room.access.words.replace("\u2068", "").replace("\u2069", "") == "BEN · SETUP"
    room.access.sign_out()
    assert room.access.words == "OPERATOR"
    assert room.log("access") == [
        (wording("log.signed-in", name="BEN", level="SETUP"), "BEN"),
        (wording("log.signed-out", name="BEN", why=""), "BEN"),
    ]


def test_wrong_pins_wait_longer_and_longer_and_are_logged(room: PinRoom) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    assert shows(room.desk.notice, "desk.wrong-pin", seconds=5)
    room.sign_in("BEN")  # the right one, but too early
    assert room.access.name == ""
    assert room.desk.notice == wording("desk.too-many-pins", seconds=5)
    room.at += 5.0
    room.sign_in("BEN")
    assert room.access.name == "BEN"
    assert room.log("access")[2] == (wording("log.wrong-pin", name="BEN", count=3), "operator")


def test_a_new_start_does_not_forget_how_many_were_wrong(room: PinRoom) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    room.settle()
    again = Access(room.journal, clock=lambda: 7.0)
    assert SignIn(again).wrong.left(7.0) == 5.0


def test_the_waits_are_bounded() -> None:
    assert [wait_after(count) for count in range(12)] == [0, 0, 0, 5, 10, 20, 40, 80, 160, 300, 300, 300]
    wrong = WrongPins()
    for moment in (0.0, 1.0, 2.0):
        wrong.wrong(moment)
    assert wrong.left(4.0) == 3.0
    wrong.right()
    assert wrong.left(4.0) == 0.0


@pytest.mark.parametrize("pin", ["", "123", "1234567890123", "12a4", "1111", "12 34", "١٢٣٤"])
def test_what_is_no_pin_is_refused(pin: str) -> None:
    with pytest.raises(PinError):
        check_pin(pin)


def test_what_is_kept_of_a_pin_is_scrypt() -> None:
    """RFC 7914, chapter 12: the third vector has the N, r and p of older hashes, and our length in front."""
    old = "7023bdcb3afd7348461c06cd81fd38ebfda8fbba904f8e3ea9b543f6545da1f2"
    for kept in (
        Hashed(b"SodiumChloride", bytes.fromhex(old)),
        Hashed(b"SodiumChloride", bytes((14, 8, 1)) + bytes.fromhex(old)),
        hashed("pleaseletmein", b"SodiumChloride"),
    ):
        assert is_pin("pleaseletmein", kept)
        assert not is_pin("pleaseletmeIn", kept)
    assert hashed("4711") != hashed("4711")  # each has a salt of its own


def test_a_try_costs_what_half_a_second_holds() -> None:
    """Older hashes took 0.03 s of an idle core: 32 times the work is 0.9 s."""
    work = TODAY.r * TODAY.p << TODAY.log2_n
    assert work >= 32 * (8 * 1 << 14)


@pytest.mark.parametrize("damage", [b"", b"\x04\x08", bytes(31), bytes(34), bytes(40)])
def test_no_pin_fits_a_hash_of_another_length(damage: bytes) -> None:
    assert not is_pin("4711", Hashed(b"salt", damage))


def test_an_old_hash_is_made_anew_when_its_pin_is_entered(
    room: PinRoom, monkeypatch: pytest.MonkeyPatch
) -> None:
    room.enter_people()
    old = room.access.people.rows
    monkeypatch.setattr(pins, "COST", pins.Cost(5, 8, 1))
    room.sign_in("BEN", "9999")
    assert room.store.people.read_people().rows == old
    room.at += 300.0
    room.sign_in("BEN")
    now = room.store.people.read_people().named("BEN")
    assert now is not None
    assert (room.access.name, room.access.people.named("BEN")) == ("BEN", now)
    assert now.hash[:3] == bytes((5, 8, 1))
    assert is_pin(PINS["BEN"], Hashed(now.salt, now.hash))
    assert {row for row in old if row.name != "BEN"} < set(room.store.people.read_people().rows)


def test_who_has_no_pin_is_let_in_by_none(room: PinRoom) -> None:
    room.journal.opened().people.save_person(PersonRow("DORA", Level.SERVICE, b"", b"")).result()
    room.access.reload()
    room.sign_in("DORA", "4711")
    assert room.access.name == ""
    assert begins(room.desk.notice, "desk.no-pin", name="DORA")


def test_the_store_does_not_hold_the_pin(room: PinRoom, tmp_path: Path) -> None:
    room.journal.opened().people.save_person(
        PersonRow("DORA", Level.SERVICE, *hashed("660391827455"))
    ).result()
    room.settle()
    for path in (tmp_path / "home").glob("turndesk.db*"):
        assert b"660391827455" not in path.read_bytes()


# --- time ------------------------------------------------------------------------------------------------


def test_a_level_falls_back_and_says_so_before(room: PinRoom) -> None:
    room.enter_people()
    room.sign_in("ANNA")
    room.at += 569.0
    room.desk.clear()
    room.run(1)
    assert room.desk.notice == ""
    room.at += 1.0
    room.run(1)
    assert shows(room.desk.notice, "desk.level-ends", seconds=30)
    room.access.used()
    room.at += 599.0
    room.run(1)
    assert room.access.name == "ANNA"
    room.at += 1.0
    room.run(1)
    assert (room.access.name, room.access.level) == ("", Level.OPERATOR)
    assert shows(room.desk.notice, "desk.was-away")
    assert room.log("access")[-1] == (
        wording("log.signed-out", name="ANNA", why=wording("log.without-input", minutes=10)),
        "ANNA",
    )


def test_levels_come_back_with_a_store_that_was_away_at_the_start(room: PinRoom, tmp_path: Path) -> None:
    """Else whoever was there then could enter himself as the first one, beside those of the store."""
    room.enter_people()
    store, room.journal._store = room.journal._store, None
    folder, room.journal._folder = room.journal._folder, damaged_home(tmp_path)
    again = Access(room.journal, clock=lambda: room.at)
    room.desk.access = again  # type: ignore[misc]
    again.level = Level.OPERATOR
    SignIn(again)
    assert (again.people.on, again.people.rows) == (True, ())
    room.journal._store, room.journal._folder = store, folder
    room.at += 1.0
    room.run(1)
    assert shows(again.refusal(Act.PEOPLE), "screen.level-needed", level="SERVICE")
    assert [row.name for row in again.people.rows] == ["ANNA", "BEN", "CARLA"]
    again.close()


def damaged_home(tmp_path: Path) -> Path:
    folder = tmp_path / "damaged"
    folder.mkdir()
    (folder / FILE_NAME).write_bytes(b"SQLite format 3")
    return folder


def test_people_that_cannot_be_read_leave_the_strictest_level(room: PinRoom, tmp_path: Path) -> None:
    room.journal._store, store = None, room.journal._store
    room.journal._folder = damaged_home(tmp_path)
    room.access.reload()
    may = {act for act in Act if not room.access.refusal(act)}
    assert may == OPERATORS
    reset = room.find(AccessLevels).service_reset
    assert reset.why_not(room.desk.snapshot()) == wording("desk.press-e-stop-first")
    reset.reset()
    room.session.worker.settle(LIMIT)
    room.at += 2.0
    room.run(1)
    assert [room.access.refusal(act) for act in Act] == [""] * len(Act)
    room.journal._store = store


# --- people ----------------------------------------------------------------------------------------------


def typed(levels: AccessLevels, *texts: str) -> None:
    for text in texts:
        for sign in text:
            levels.typed(sign)
        levels.typed("Enter")


def test_the_first_one_is_of_service_and_switches_levels_on(room: PinRoom) -> None:
    levels = room.find(AccessLevels)
    levels.keys()["F3"].action()
    typed(levels, "anna", "4711")
    assert levels.sheet(room.desk.snapshot()).question == wording("desk.same-pin-again")
    typed(levels, "4711")
    room.settle()
    assert [(row.name, row.level) for row in room.access.people.rows] == [("ANNA", 3)]
    levels.keys()["F3"].action()
    assert shows(room.desk.notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    typed(levels, "", "4711")  # Return on her name, and her PIN
    room.settle()
    levels.keys()["F3"].action()
    typed(levels, "Ben", "2", "2580", "2580")
    room.settle()
    assert [(row.name, row.level) for row in room.access.people.rows] == [("ANNA", 3), ("BEN", 2)]
    assert room.log("access")[-1] == (wording("log.entered", name="BEN", level="SETUP"), "ANNA")


def test_two_different_pins_keep_nothing(room: PinRoom) -> None:
    levels = room.find(AccessLevels)
    levels.keys()["F3"].action()
    typed(levels, "anna", "4711", "4712")
    room.settle()
    assert not room.access.people.on
    assert wording("desk.two-different-pins").upper() in room.desk.notice.upper()


def test_a_pin_is_not_shown(room: PinRoom) -> None:
    room.enter_people()
    levels = room.find(AccessLevels)
    levels.act()
    for sign in "4711":
        levels.typed(sign)
    assert levels.sheet(room.desk.snapshot()).text == "●●●●"
    assert not levels.takes("x")
    levels.left()
    assert levels.entry.text == ""


# --- service reset ---------------------------------------------------------------------------------------


def pressed(room: PinRoom) -> Callable[[], None]:
    room.enter_people()
    room.desk.station.press_estop()
    room.run()
    levels = room.find(AccessLevels)
    levels.keys()["F9"].action()
    assert begins(room.desk.notice, "desk.take-all-pins-away")
    levels.service_reset.begin()
    return levels.service_reset.begin


def test_ten_minutes_of_estop_take_all_pins_away(room: PinRoom) -> None:
    pressed(room)
    room.at += WAIT - 1.0
    room.run(1)
    assert room.access.people.on
    assert room.access.words == wording("desk.pins-reset-in", time="0:01")
    room.at += 1.0
    room.run(1)
    room.settle()
    assert not room.access.people.on
    assert room.access.words == ""
    told = [text for text, _who in room.log("access")]
    assert begins(told[0], "desk.reset-begun")
    assert told[-1] == wording("desk.reset-done")


def test_the_reset_needs_the_estop_and_ends_with_it(room: PinRoom) -> None:
    room.enter_people()
    room.find(AccessLevels).ask_reset()
    assert begins(room.desk.notice, "desk.e-stop-for-reset")
    pressed(room)
    room.at += 300.0
    room.run(1)
    room.desk.hands.estop(pressed=False)
    room.run()
    room.at += WAIT
    room.run(1)
    room.settle()
    assert room.access.people.on
    assert room.log("access")[-1][0] == wording("desk.reset-given-up")


def test_a_pin_ends_the_reset(room: PinRoom) -> None:
    pressed(room)
    room.sign_in("ANNA")
    room.run(1)
    room.at += WAIT
    room.run(1)
    room.settle()
    assert room.access.people.on


def test_who_has_gone_away_finishes_nothing_by_other_hands(room: PinRoom) -> None:
    """What was begun in a level is not ended by whoever finds it open when that level has fallen back."""
    room.enter_people()
    room.sign_in("ANNA")
    levels, programs = room.find(AccessLevels), room.desk.pages.find(ProgramList)
    assert programs is not None
    levels.keys()["F3"].action()
    typed(levels, "eve", "3", "1357")
    programs.transfer.begin((), None, out=False)
    room.at += 600.0
    room.run(1)
    typed(levels, "1357")
    assert shows(room.desk.notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    room.desk.clear()
    programs.transfer.worker.settle(LIMIT)
    programs.transfer._carry((HOUSE / "setup.cfg",), HOUSE, replace=True)
    assert shows(room.desk.notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert not programs.transfer.worker.busy
    room.settle()
    assert room.access.people.named("EVE") is None
