"""Data folder of the tour: the operator's folder remains as it is, and an unsuitable one gets no tour."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

import pytest

from app.cli import main
from app.cli.command_parser import copy_screen_options
from app.compose.demo_store import open_demo_data_folder
from app.compose.program_proving import get_samples_folder
from app.desk.command_errors import CommandError
from app.desk.data_folder import find_data_folder
from app.desk.programs.program_choice import LAST_PROGRAM_SETTING
from app.desk.screen_settings import SETTINGS_KEY
from app.extras.tour import tour_command
from app.extras.tour.extra import EXTRA
from app.extras.tour.tour_setup import SHOWN_SETTING, is_first_start, save_tour_shown, use_tour_folder
from app.screen import display
from core.extras.tour.tour_script import FAULTY_PROGRAM_NAME, PROGRAM_NAME
from core.file_lock import lock_file
from core.store.production.part_cycles import CycleRow, save_cycle
from core.store.store import Store
from core.store.store_errors import StoreError
from tests.coded import raises_code
from tests.extras.tour.contents import read_contents


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The data folder of a demo that was never used."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    return open_demo_data_folder(None)


def change_setting(name: str, value: object) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        with Store.open(folder) as store:
            store.settings.save_setting(name, value).result()

    return change


def add_program(folder: Path) -> None:
    (folder / "programs").mkdir()
    (folder / "programs" / "own.nc").write_text("M30\n")


def start_run(folder: Path) -> None:
    with Store.open(folder) as store:
        store.runs.record_run_start("bushing.nc").result()


def damage(folder: Path) -> None:
    (folder / "turndesk.db").write_bytes(b"this is no store" * 999)


def test_unused_demo_begins_with_the_tour(folder: Path) -> None:
    assert is_first_start(folder)
    assert EXTRA.begins_with_show(folder)


def test_sample_program_alone_does_not_count_as_use(folder: Path) -> None:
    change_setting(LAST_PROGRAM_SETTING, str(get_samples_folder() / "bushing.nc"))(folder)
    assert is_first_start(folder)


@pytest.mark.parametrize(
    "change",
    [
        change_setting(SHOWN_SETTING, True),
        change_setting(LAST_PROGRAM_SETTING, "/shop/own.nc"),
        change_setting("completed_lessons", [1]),
        add_program,
        start_run,
        damage,
        save_tour_shown,
    ],
)
def test_used_or_damaged_demo_begins_without_the_tour(folder: Path, change: Callable[[Path], None]) -> None:
    change(folder)
    assert not is_first_start(folder)
    assert not EXTRA.begins_with_show(folder)


def test_finished_part_counts_as_use(folder: Path) -> None:
    with Store.open(folder) as store:
        store.write(lambda c: save_cycle(c, CycleRow("1", "bushing.nc", 1, "2026-01-01 10:00:00"))).result()
    assert not is_first_start(folder)


def test_folder_without_a_store_counts_as_unused(tmp_path: Path) -> None:
    assert is_first_start(tmp_path)


def test_tour_folder_replaces_the_operators_folder_and_is_deleted(folder: Path) -> None:
    before = read_contents(folder)
    with use_tour_folder() as own:
        assert find_data_folder() == own
        assert own.parent == folder
        assert {path.name for path in (own / "programs").iterdir()} == {PROGRAM_NAME, FAULTY_PROGRAM_NAME}
        with Store.open(own) as store:
            store.offsets.secondary_offsets.change_row(1, "wear", {"x": -1.0}).result()
            assert set(store.offsets.tool_offsets.read_rows()) == {1, 3, 11, 12}
    assert find_data_folder() == folder
    assert read_contents(folder) == before


def test_tour_speaks_the_operators_language_without_the_card_of_the_first_job(folder: Path) -> None:
    change_setting(SETTINGS_KEY, {"language": "es", "first_job": True})(folder)
    with use_tour_folder() as own, Store.open(own, read_only=True) as store:
        assert store.settings.read_setting(SETTINGS_KEY) == {"language": "es", "first_job": False}


def test_folder_of_a_killed_tour_is_deleted_at_the_next_start(folder: Path) -> None:
    left = folder / ".tour.abcdefgh.unfinished"
    (left / "programs").mkdir(parents=True)
    assert is_first_start(folder)
    assert not left.exists()


def test_second_start_during_the_tour_begins_without_a_tour(folder: Path) -> None:
    with use_tour_folder():
        assert not is_first_start(folder)
    assert is_first_start(folder)


def test_tour_is_not_marked_as_shown_while_a_screen_uses_the_store(folder: Path) -> None:
    with Store.open(folder):
        save_tour_shown(folder)
    assert is_first_start(folder)


def test_folder_that_cannot_be_written_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "file" / "home"))
    with pytest.raises((OSError, StoreError)), use_tour_folder():
        pass
    assert find_data_folder() == tmp_path / "file" / "home"


@pytest.mark.parametrize(
    "more", [["--program", "part.nc"], ["--kiosk"], ["--machine", "gt75"], ["--offsets", "o.toml"]]
)
def test_start_with_other_options_begins_without_the_tour(
    folder: Path, more: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(folder.parent))
    args = copy_screen_options(main.build_parser(()).parse_args(["--demo", *more]))
    main._open_demo(args)
    assert not getattr(args, "opening_show_class", "")


def test_plain_demo_start_begins_with_the_tour(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(folder.parent))
    args = copy_screen_options(main.build_parser(()).parse_args(["--demo"]))
    main._open_demo(args)
    assert args.opening_show_class == EXTRA.opening_show_class


def test_tour_without_a_display_is_rejected(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(display, "find_display_error", lambda: "no display found")
    with raises_code(CommandError, "no-screen", "no display found"):
        tour_command.run(Namespace(from_screen=False))
    assert is_first_start(folder)


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The shows that the command has begun."""
    found = list[str]()

    def show(class_name: str) -> int:
        found.append(class_name)
        return 0

    monkeypatch.setattr(main, "run_opening_show", show)
    return found


def test_tour_is_rejected_while_a_screen_of_the_same_folder_is_open(folder: Path, shown: list[str]) -> None:
    with Store.open(folder), raises_code(CommandError, "screen-open", "close the screen"):
        tour_command.run(main.build_parser(["tour"]).parse_args(["tour"]))
    assert shown == []


@pytest.mark.parametrize("name", ["control.lock", "control-drivers.lock", "control-4.lock"])
@pytest.mark.skipif(sys.platform == "win32", reason="the control has no process of its own")
def test_tour_is_rejected_while_a_control_is_running(folder: Path, shown: list[str], name: str) -> None:
    with (folder / name).open("w") as lock:
        lock_file(lock.fileno())
        with raises_code(CommandError, "screen-open", "close the screen"):
            tour_command.run(Namespace(from_screen=False))
    assert shown == []


def test_tour_begins_after_the_control_was_killed(folder: Path, shown: list[str]) -> None:
    (folder / "control.lock").touch()  # a killed control leaves its file, but the kernel releases the lock
    assert tour_command.run(Namespace(from_screen=False)) == 0
    assert shown == [EXTRA.opening_show_class]


def test_tour_of_the_special_function_begins_although_its_screen_is_open(
    folder: Path, shown: list[str]
) -> None:
    with Store.open(folder):
        assert tour_command.run(main.build_parser(["tour"]).parse_args(["tour", "--from-screen"])) == 0
    assert shown == [EXTRA.opening_show_class]


def test_option_of_the_special_function_is_not_in_the_help() -> None:
    assert "from-screen" not in main.build_parser(["tour"]).format_help()


def test_tour_creates_no_store_in_a_folder_without_one(tmp_path: Path) -> None:
    save_tour_shown(tmp_path)
    assert list(tmp_path.iterdir()) == []
