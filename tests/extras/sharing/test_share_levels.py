"""Who may share programs on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

import resources
from core.message import CodedError
from core.store.store import Store
from tests.cli.conftest import refusals
from tests.cli.say import Say, any_pin, codes, home, say
from tests.cli.test_access import people

__all__ = ["any_pin", "home", "people", "refusals", "say"]
pytestmark = pytest.mark.usefixtures("any_pin")


def test_sharing_is_logged_with_the_user_name(say: Say, people: None, home: Path, tmp_path: Path) -> None:
    (tmp_path / "shop").mkdir()
    table = f'[sharing]\nfolder = "{tmp_path / "shop"}"\ndesk = "LATHE 1"\n'
    (tmp_path / "own.toml").write_text(f"{resources.read_machine_file('gt75.toml')}\n{table}")
    named = ("--machine", tmp_path / "own.toml", "--as")
    assert say("share", "begin", *named, "ben")[0] == 2
    assert say("share", "begin", *named, "anna")[0] == 0
    assert say("share", "publish", *named, "ben")[0] == 0
    assert say("share", "status", *named[:2])[0] == 0  # looking is everybody's
    with Store.open(home) as store:
        told = [(row.text, row.who) for row in store.events.read_events(kinds={"change"})]
    assert told == [("share publish", "BEN"), ("share begin", "ANNA")]


def test_copying_a_shared_program_needs_setup_level(
    say: Say, people: None, home: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    file, shop = tmp_path / "lathe.toml", tmp_path / "shop"
    shop.mkdir()
    file.write_text(resources.read_machine_file("gt75.toml") + f'\n[sharing]\nfolder = "{shop}"\n')
    assert say("share", "begin", "--machine", file, "--as", "anna")[0] == 0
    status, told = say("share", "take", "peg.nc", "--machine", file)
    assert (status, codes(refusals)) == (2, ["unknown-person"])
    assert "PROGRAMS" in told
    assert "SETUP" in told
    status, told = say("share", "take", "peg.nc", "--as", "ben", "--machine", file)
    assert (status, codes(refusals), "peg.nc" in told) == (2, ["not-shared-program"], True)
