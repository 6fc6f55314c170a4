"""``turndesk access``, and PINs on the command line."""

from __future__ import annotations

import json
import sqlite3
import time
import zipfile
from contextlib import closing
from pathlib import Path

import pytest

import resources
from app.extras.access import access_command
from core.extras.access import pins
from core.message import CodedError
from core.store.store import Store
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole
from tests.cli.say import Say, codes
from tests.texts import text as wording


@pytest.fixture
def people(say: Say) -> None:
    """ANNA of SERVICE, BEN of SETUP."""
    assert say("access", "add", "anna", typed="4711 4711") == (0, "ANNA entered: SERVICE\n")
    entered = say("access", "add", "ben", "--level", "setup", "--as", "anna", typed="4711 2580 2580")
    assert entered == (0, "BEN entered: SETUP\n")


def test_commands_are_unrestricted_without_access_levels(say: Say, home: Path) -> None:
    assert say("access", "list") == (0, "levels are off: everybody may change everything\n")
    assert say("offsets", "set", "T3", "x=1", "z=-1")[0] == 0
    assert say("offsets", "set", "T3", "x=1.01", "--as", "dora")[0] == 0
    with Store.open(home) as store:
        assert [row.who for row in store.offsets.read_history()] == ["dora", "command line"]


def test_change_needs_level_and_pin_and_records_the_name(
    say: Say, people: None, home: Path, refusals: list[CodedError]
) -> None:
    status, told = say("offsets", "set", "T3", "x=1", "z=-1")
    assert (status, codes(refusals)) == (2, ["unknown-person"])
    for value in ("TOOL OFFSETS", "SETUP", "shop", "--as", "ANNA, BEN"):
        assert value in told
    assert say("offsets", "set", "T3", "x=1", "z=-1", "--as", "ben", typed="2580")[0] == 0
    assert say("offsets", "set", "D4", "x=-.0005")[0] == 0  # a correction is the operator's
    with Store.open(home) as store:
        assert [(row.number, row.who) for row in store.offsets.read_history()] == [(4, "shop"), (3, "BEN")]


def test_wrong_pin_changes_nothing_is_logged_and_adds_a_delay(
    say: Say, people: None, home: Path, monkeypatch: pytest.MonkeyPatch, refusals: list[CodedError]
) -> None:
    waited: list[float] = []
    monkeypatch.setattr(time, "sleep", waited.append)
    for _ in range(4):
        status, told = say("offsets", "clear", "T", "--as", "ben", typed="0815")
        assert (status, codes(refusals), "BEN" in told) == (2, ["wrong-pin"], True)
    status, told = say("offsets", "set", "G54", "z=-1", "--as", "ben", typed="2580")
    assert (status, "4 wrong PINs in a row; try again in 10 s" in told) == (0, True)
    assert waited == [5.0, 10.0]
    with Store.open(home) as store:
        assert store.events.read_events("wrong PIN")[0].text == wording("cli.wrong-pin", name="BEN", count=4)


def test_aborted_pin_check_counts_as_a_wrong_pin(
    say: Say, people: None, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A script that ends it before the answer is written would guess as often as it likes."""

    def ended(_pin: str, _kept: object) -> bool:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("core.extras.access.pins.is_pin_correct", ended)
        for _ in range(3):
            assert say("offsets", "clear", "T", "--as", "ben", typed="0815")[0] != 0
            monkeypatch.setattr(time, "sleep", lambda _seconds: None)
    waited: list[float] = []
    monkeypatch.setattr(time, "sleep", waited.append)
    assert say("offsets", "clear", "T", "--as", "ben", typed="2580")[0] == 0
    assert waited == [5.0]
    with Store.open(home) as store:
        assert store.settings.read_setting("wrong PINs") is None


@pytest.mark.parametrize("words", [
    ["store", "restore", "{backup}"], ["store", "import", "{home}"], ["setup", "load", "{backup}"],
    ["machine", "accept", "{machine}"], ["access", "remove", "anna"], ["access", "pin", "anna"],
    ["access", "add", "carl"],
])  # fmt: skip
def test_service_changes_are_rejected_below_service_level(
    words: list[str], say: Say, people: None, home: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    (tmp_path / "own.toml").write_text(resources.read_machine_file("gt75.toml"))
    (home / "programs").mkdir()
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    given = {"backup": tmp_path / "b.db", "home": home, "machine": tmp_path / "own.toml"}
    status, told = say(*(word.format(**given) for word in words), "--as", "ben", typed="2580")
    assert (status, codes(refusals)) == (2, ["level-too-low"])
    for value in ("SERVICE", "BEN", "SETUP", "--as", "ANNA"):
        assert value in told


def test_restore_is_logged_with_the_user_name(say: Say, people: None, home: Path, tmp_path: Path) -> None:
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    assert say("store", "restore", tmp_path / "b.db", "--as", "anna", typed="4711")[0] == 0
    (tmp_path / "own.toml").write_text(resources.read_machine_file("gt75.toml"))
    assert say("machine", "accept", tmp_path / "own.toml", "--as", "anna", typed="4711")[0] == 0
    with Store.open(home) as store:
        restored = store.events.read_events("restored from")[0]
        (replaced,) = home.glob("turndesk-replaced-*.db")
        saved = wording("cli.previous-data", path=replaced)
        assert restored.text == wording("cli.restored-event", path=tmp_path / "b.db", saved=saved)
        assert restored.who == "ANNA"
        assert "accepted by ANNA" in store.events.read_events("machine file")[0].text


def test_unreadable_store_can_be_replaced(say: Say, people: None, home: Path, tmp_path: Path) -> None:
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    (home / "turndesk.db").write_bytes(b"no store any more")
    assert say("store", "restore", tmp_path / "b.db", typed="RESET", terminal=True)[0] == 0
    assert say("access", "list")[1].startswith("levels are off")
    with Store.open(home) as store:
        assert store.events.read_events("restored from")[0].who == "shop (service reset at the keyboard)"


def damage_people(home: Path, change: str) -> None:
    with closing(sqlite3.connect(home / "turndesk.db")) as connection, connection:
        connection.execute(change)


def test_missing_people_row_does_not_bypass_access_levels(
    say: Say, people: None, home: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    """The list said that levels are off."""
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    damage_people(home, "DELETE FROM people")
    listed = json.loads(say("access", "list", "--json")[1])
    assert listed == {"on": True, "damaged": True, "people": []}
    assert not say("access", "list")[1].startswith("levels are off")
    assert say("store", "restore", tmp_path / "b.db", "--as", "anna", typed="4711")[0] == 2
    assert codes(refusals) == ["unknown-person"]


# --- backups ---------------------------------------------------------------------------------------------


def hashes(path: Path) -> list[bytes]:
    with closing(sqlite3.connect(path)) as connection:
        return [bytes(row[0]) for row in connection.execute("SELECT hash FROM people WHERE hash <> x''")]


def test_backup_contains_no_hashes_and_restore_leaves_the_users(
    say: Say, people: None, home: Path, tmp_path: Path
) -> None:
    stored, copy = hashes(home / "turndesk.db"), tmp_path / "b.db"
    assert len(stored) == 2
    assert say("store", "backup", copy)[0] == 0
    assert say("setup", "save", tmp_path / "s.zip")[0] == 0
    with zipfile.ZipFile(tmp_path / "s.zip") as setup:
        taken = setup.read("store.db")
    for each in stored:
        assert each not in copy.read_bytes()
        assert each not in taken
    with closing(sqlite3.connect(copy)) as connection:
        assert [row[0] for row in connection.execute("SELECT name FROM people")] == ["ANNA", "BEN"]
    assert say("access", "remove", "ben", "--as", "anna", typed="4711")[0] == 0
    assert say("store", "restore", copy, "--as", "anna", typed="4711")[0] == 0
    assert hashes(home / "turndesk.db") == stored[:1]
    assert say("store", "verify")[0] == 0


def test_backup_gives_a_new_machine_the_names_without_pins(
    say: Say, people: None, home: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    home.rename(tmp_path / "before")
    assert say("store", "restore", tmp_path / "b.db")[0] == 0
    assert json.loads(say("access", "list", "--json")[1])["on"]
    assert say("offsets", "clear", "T", "--as", "anna", typed="4711")[0] == 2
    assert codes(refusals) == ["no-pin"]
    assert say("access", "reset", typed="RESET", terminal=True)[0] == 0


def test_old_hash_is_upgraded_on_the_command_line(
    say: Say, people: None, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pins, "DEFAULT_COST", pins.ScryptCost(5, 8, 1))
    assert say("offsets", "set", "G54", "z=-1", "--as", "ben", typed="2580")[0] == 0
    assert [each[0] for each in hashes(home / "turndesk.db")] == [4, 5]


def test_stock_is_stored_only_from_setup_level_up(
    say: Say, people: None, tmp_path: Path, refusals: list[CodedError]
) -> None:
    (tmp_path / "part.nc").write_text("G90G94F200\nT1\nX.5Z0\nM30\n")
    words = ("prove", tmp_path / "part.nc", "--stock", "bar:1.0", "--keep-stock")
    status, told = say(*words)
    assert (status, codes(refusals)) == (2, ["unknown-person"])
    assert "STOCK AND CHECKS" in told
    assert "SETUP" in told
    assert say(*words, "--as", "ben", typed="2580")[0] in {0, 1}
    assert "STOCK" not in say("prove", tmp_path / "part.nc")[1]


def test_first_user_must_have_service_level(say: Say, refusals: list[CodedError]) -> None:
    status, told = say("access", "add", "ben", "--level", "setup", typed="2580 2580")
    assert (status, codes(refusals), "SERVICE" in told) == (2, ["last-service-person"], True)


@pytest.mark.parametrize(("typed", "code"), [
    ("123 123", "pin-length"), ("1111 1111", "pin-too-simple"), ("4711 4712", "pins-differ"),
    ("", "pin-length"),
])  # fmt: skip
def test_invalid_pin_is_rejected(typed: str, code: str, say: Say, refusals: list[CodedError]) -> None:
    status, _ = say("access", "add", "anna", typed=typed)
    assert (status, codes(refusals)) == (2, [code])
    assert say("access", "list")[1].startswith("levels are off")


def test_pin_can_be_changed_and_a_user_removed(say: Say, people: None, refusals: list[CodedError]) -> None:
    assert say("access", "pin", "ben", "--as", "anna", typed="4711 3698 3698")[0] == 0
    assert say("offsets", "set", "G54", "z=-1", "--as", "ben", typed="3698")[0] == 0
    assert say("access", "remove", "ben", "--as", "anna", typed="4711") == (0, "BEN is taken away\n")
    assert say("access", "list") == (0, "SERVICE   ANNA\n")
    assert say("access", "add", "anna", "--as", "anna", typed="4711")[1].count("ANNA") == 1
    assert codes(refusals) == ["name-in-use"]
    assert say("access", "pin", "ben")[1].count("ben") == 1
    assert codes(refusals) == ["unknown-person"]


def test_the_table_is_printed(say: Say) -> None:
    assert "SERVICE   accepting a changed machine file\n" in say("access", "table")[1]
    assert json.loads(say("access", "table", "--json")[1])["ZERO OFFSETS"]["level"] == "SETUP"


def test_service_reset_requires_typing_at_the_machine(
    say: Say, people: None, home: Path, monkeypatch: pytest.MonkeyPatch, refusals: list[CodedError]
) -> None:
    say("access", "reset", typed="RESET")
    assert codes(refusals) == ["not-a-terminal"]
    say("access", "reset", typed="no", terminal=True)
    assert codes(refusals) == ["not-confirmed"]
    monkeypatch.setenv("SSH_CONNECTION", "10.0.0.7 50000 10.0.0.8 22")
    say("access", "reset", typed="RESET", terminal=True)
    assert codes(refusals) == ["not-a-terminal"]
    assert "ANNA" in say("access", "list")[1]
    monkeypatch.delenv("SSH_CONNECTION")
    assert say("access", "reset", typed="RESET", terminal=True)[0] == 0
    assert say("access", "list")[1].startswith("levels are off")
    with Store.open(home) as store:
        row = store.events.read_events("service reset")[0]
    assert (row.who, "2 users and their PINs" in row.text) == ("shop", True)


def test_access_json_output_matches_its_declared_keys(turndesk: Turndesk, filled: Path) -> None:
    declared_alone([whole(turndesk("access", "list", "--json"))], access_command.ACCESS_LIST_OUTPUT.keys)
    declared_alone([whole(turndesk("access", "table", "--json"))], access_command.ACCESS_TABLE_OUTPUT.keys)
