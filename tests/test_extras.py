"""Optional features: the table, their places in lists, and TurnDesk without one of them."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from pathlib import Path

import pytest

import resources
from app.cli import main
from app.compose import optional_features
from app.compose.machine.driver_modules import load_all_drivers
from app.compose.optional_features import (
    FEATURE_NAMES,
    extras,
    insert_items_after,
    list_drawing_suffixes,
    map_command_modules,
)
from app.special.special_functions import SpecialFunctionsModel
from core.machine.machine_file import parse_machine
from core.table_schema import MachineFileError
from tests.attached import attached
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine

HOUSE = Path(__file__).parents[1]


@pytest.fixture
def no_features(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """As if the folders of all optional features were deleted."""
    found = importlib.util.find_spec
    monkeypatch.setattr(
        optional_features, "find_spec", lambda name: None if "extras" in name else found(name)
    )
    extras.cache_clear()
    yield
    extras.cache_clear()


def test_every_folder_of_a_feature_is_in_the_table() -> None:
    folders = {each.parent.name for each in (HOUSE / "app" / "extras").glob("*/extra.py")}
    cores = {each.name for each in (HOUSE / "core" / "extras").iterdir() if (each / "__init__.py").exists()}
    assert folders <= set(FEATURE_NAMES)  # one that is left out has no folder
    assert cores <= folders


def test_every_command_of_a_feature_has_a_module() -> None:
    assert all(importlib.util.find_spec(module) for module in map_command_modules().values())
    assert set(map_command_modules()) <= set(main.list_commands())


def test_addition_is_inserted_after_the_item_that_it_names() -> None:
    assert insert_items_after("ab", str, [("x", "a"), ("y", "x")]) == ["a", "x", "y", "b"]


def test_additions_after_the_same_item_retain_their_order() -> None:
    assert insert_items_after("ab", str, [("x", "a"), ("y", "a")]) == ["a", "x", "y", "b"]


def test_an_addition_may_follow_one_that_is_added_later() -> None:
    assert insert_items_after("ab", str, [("y", "x"), ("x", "a")]) == ["a", "x", "y", "b"]


def test_addition_whose_item_is_missing_is_placed_last() -> None:
    assert insert_items_after("ab", str, [("x", "gone")]) == ["a", "b", "x"]


def test_feature_without_its_required_feature_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    name = next(iter(extras()))
    monkeypatch.setattr(type(extras()[name]), "required_features", ("gone",))
    extras.cache_clear()
    assert name not in extras()
    monkeypatch.undo()
    extras.cache_clear()
    assert name in extras()


def test_feature_is_listed_after_the_features_it_requires() -> None:
    for name, each in extras().items():
        assert all(FEATURE_NAMES.index(need) < FEATURE_NAMES.index(name) for need in each.required_features)


@pytest.mark.usefixtures("no_features")
def test_f10_lists_lathe_tool_lives_without_features(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    names = {each.name for each in attached(desk_on(FakeMachine()), SpecialFunctionsModel).functions}
    assert "TOOL LIFE" in names
    assert "JOBS" not in names


@pytest.mark.usefixtures("no_features")
def test_feature_commands_are_unknown_without_features(capsys: pytest.CaptureFixture[str]) -> None:
    assert set(main.list_commands()) == set(main.CORE_COMMANDS)
    with pytest.raises(SystemExit) as stopped:
        main.main(["share", "status"])
    assert stopped.value.code == 2
    assert "share" in capsys.readouterr().err


@pytest.mark.usefixtures("no_features")
def test_drawing_suffixes_are_not_listed_without_features() -> None:
    assert list_drawing_suffixes() == ()


def test_a_folder_of_a_feature_with_only_caches_counts_as_absent(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(
        optional_features, "find_spec", lambda name: None if name.endswith(".extra") else found(name)
    )
    extras.cache_clear()
    assert extras() == {}
    extras.cache_clear()


@pytest.mark.parametrize(
    ("signal", "old", "new"),
    [
        ("io.in.estop", 'estop = { at = "IN-1"', 'estop = { at = "pendant.BTN_B"'),
        ("io.in.hold", 'hold  = { at = "IN-3"', 'hold  = { at = "pendant.BTN_B"'),
        ("io.analog.handwheel", "[io.in]", '[io.analog]\nhandwheel = { at = "pendant.REL_DIAL" }\n[io.in]'),
    ],
)
def test_signal_at_device_of_missing_feature_is_rejected(signal: str, old: str, new: str) -> None:
    own = [each for each in load_all_drivers() if each.address_prefix != "pendant."]
    text = resources.read_machine_file("gt75.toml")
    assert old in text
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text.replace(old, new), "own.toml", own)
    assert (f"{signal}.at", "absent-device") in [(each.path, each.code) for each in caught.value.findings]
