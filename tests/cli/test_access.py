"""Commands that change something while there are levels."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

import resources
from app.cli.main import build_parser, list_commands
from core.access.access_table import AccessLevel
from core.message import CodedError
from core.store.store import Store
from core.store.user_records import UserRow, save_user
from tests.cli.say import Say, codes, home, say
from tests.extras.modules import of_extras

__all__ = ["home", "say"]


@pytest.fixture
def people(home: Path) -> None:
    """ANNA of SERVICE, BEN of SETUP; no PIN fits what is stored of theirs."""
    with Store.open(home) as store:
        for name, level in (("ANNA", AccessLevel.SERVICE), ("BEN", AccessLevel.SETUP)):
            row = UserRow(name, level, b"salt", b"hash")
            store.write(partial(save_user, row=row)).result(60)


@pytest.fixture
def no_sign_in(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if the feature that checks PINs was deleted."""
    monkeypatch.setattr("app.compose.optional_features.extras", dict)


@pytest.mark.parametrize("words", [
    ("offsets", "set", "T3", "x=1", "z=-1", "--as", "ben"),
    ("offsets", "set", "D4", "x=-.0005", "--as", "anna"),
])  # fmt: skip
@pytest.mark.usefixtures("people", "no_sign_in")
def test_without_sign_in_no_user_can_change_anything(
    words: tuple[str, ...], say: Say, home: Path, refusals: list[CodedError]
) -> None:
    assert say(*words, typed="4711")[0] == 2
    assert codes(refusals) == ["no-sign-in"]
    with Store.open(home) as store:
        assert store.offsets.read_history() == ()


@pytest.mark.usefixtures("people", "no_sign_in")
def test_unrestricted_changes_are_allowed_without_sign_in(say: Say, home: Path) -> None:
    assert say("offsets", "set", "D4", "x=-.0005")[0] == 0
    with Store.open(home) as store:
        assert [(row.number, row.who) for row in store.offsets.read_history()] == [(4, "shop")]


@pytest.mark.usefixtures("people", "no_sign_in")
def test_without_sign_in_a_change_that_needs_a_level_is_refused(say: Say, refusals: list[CodedError]) -> None:
    assert say("offsets", "set", "T3", "x=1", "z=-1")[0] == 2
    assert codes(refusals) == ["unknown-person"]


# --- every command ---------------------------------------------------------------------------------------

CHANGES: dict[str, tuple[str, ...]] = {
    "offsets set": ("T3", "x=1", "z=-1"), "offsets clear": ("T",), "offsets undo": (),
    "store restore": ("{file}",), "store import": ("{home}",), "setup load": ("{file}",),
    "access add": ("dora",), "access pin": ("anna",), "access remove": ("anna",),
    "machine accept": ("{machine}",),
    "jobs add": ("pin.nc", "5"), "jobs move": ("1", "1"), "jobs remove": ("1",), "jobs clear": (),
    "share begin": (), "share publish": (), "share take": ("PIN.NC",), "share keep": ("PIN.NC",),
    "serial receive": ("--port", "/dev/null"),
    "prove": ("{program}", "--stock", "bar:1.0", "--keep-stock"),
    "run": ("{program}", "--headless", "--stock", "bar:1.0", "--keep-stock"),
}  # fmt: skip
"""Each command that changes something, with what it needs to come to the question who does it."""
for _each in of_extras("options"):
    CHANGES |= getattr(_each, "CHANGES", {})

READS = {
    "expand", "trace", "alarms", "parts", "shift", "scope", "offsets show", "offsets history",
    "where", "help", "report-bug",
    "store verify", "access list", "access table", "jobs list", "share status", "share compare",
    "machine check", "machine hal", "serial ports", "serial send", "setup completion",
    "store upgrade",  # what the screen does when it starts
    "store backup", "store export", "setup save",  # to a file of whoever asks; the store stays as it is
    "machine peer",  # the other end of a machine that is simulated
    "setup desktop",  # the menu of the system's user
    "access reset",  # for those whose PINs are forgotten, at the machine's own keyboard
}  # fmt: skip
"""Commands that change nothing here that a level could guard."""
for _module in of_extras("options"):
    READS |= getattr(_module, "READS", set())


def commands(parser: argparse.ArgumentParser, *words: str) -> Iterator[tuple[str, bool]]:
    """Each command with its action, and whether it takes ``--as``."""
    below = [each for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
    if not below:
        yield " ".join(words), any("--as" in each.option_strings for each in parser._actions)
    for each in below:
        for name, choice in each.choices.items():
            yield from commands(choice, *words, name)


def _installed(command: str) -> bool:
    """Whether a command exists here: it is not one of an optional feature that is absent."""
    return command.split(maxsplit=1)[0] in list_commands()


def test_every_command_declares_its_user_or_is_read_only() -> None:
    found = dict(commands(build_parser()))
    assert {name for name, asks in found.items() if asks} == {name for name in CHANGES if _installed(name)}
    assert {name for name, asks in found.items() if not asks} == {name for name in READS if _installed(name)}


@pytest.mark.parametrize("command", [name for name in CHANGES if _installed(name)])
def test_every_change_checks_its_access_rule_first(
    command: str, say: Say, people: None, home: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    (tmp_path / "own.toml").write_text(resources.read_machine_file("gt75.toml"))
    (tmp_path / "part.nc").write_text("G90G94F200\nT1\nX.5Z0\nM30\n")
    (home / "programs").mkdir()
    given = {"home": home, "folder": home / "programs", "file": tmp_path / "b.db",
             "machine": tmp_path / "own.toml", "program": tmp_path / "part.nc"}  # fmt: skip
    words = [word.format(**given) for word in CHANGES[command]]
    status, told = say(*command.split(), *words, "--as", "nobody")
    assert (status, codes(refusals), "nobody" in told) == (2, ["unknown-person"], True), told
    assert list((home / "programs").iterdir()) == []


@pytest.mark.parametrize(("words", "level"), [
    (words, level) for words, level in (
        (("share", "publish"), "SETUP"), (("share", "publish", "--claim"), "SERVICE"),
        (("share", "begin"), "SERVICE"), (("share", "take", "PIN.NC"), "SETUP"),
        (("share", "keep", "PIN.NC"), "SETUP"), (("serial", "receive", "--port", "/dev/null"), "SETUP"),
    ) if _installed(words[0])
])  # fmt: skip
def test_rejected_share_or_receive_command_names_the_required_level(
    words: tuple[str, ...], level: str, say: Say, people: None, refusals: list[CodedError]
) -> None:
    status, told = say(*words)  # the system's user, of no level
    assert (status, codes(refusals)) == (2, ["unknown-person"])
    assert level in told
    assert "shop" in told


@pytest.mark.parametrize(("typed", "terminal", "code"), [
    ("", False, "not-a-terminal"), ("RESET", False, "not-a-terminal"), ("yes", True, "not-confirmed"),
    ("", True, "not-confirmed"),
])  # fmt: skip
@pytest.mark.parametrize("left", [0, 50, 100, 4000])
def test_unreadable_store_is_not_restored_without_confirmation_at_terminal(
    left: int, typed: str, terminal: bool, code: str, say: Say, people: None, home: Path, tmp_path: Path,
    refusals: list[CodedError],
) -> None:  # fmt: skip
    """Cut to 50 bytes it let everybody restore without a PIN."""
    assert say("store", "backup", tmp_path / "b.db")[0] == 0
    file = home / "turndesk.db"
    cut = file.read_bytes()[:left]
    file.write_bytes(cut)
    for command in (("store", "restore"), ("setup", "load")):
        status, _ = say(*command, tmp_path / "b.db", typed=typed, terminal=terminal)
        assert (status, codes(refusals)) == (2, [code])
    assert file.read_bytes() == cut


def test_protected_commands_are_rejected_when_users_cannot_be_read(
    say: Say, people: None, home: Path, refusals: list[CodedError]
) -> None:
    (home / "turndesk.db").write_bytes(b"no store any more")
    words = ("serial", "receive", "--port", "/dev/null")
    assert say(*words, typed="RESET", terminal=True)[0] == 2
    assert codes(refusals) == ["not-a-database"]
