"""The list of programs by keys alone, on real folders; a stick is a folder that says it is mounted."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.compose.runs.journal import Journal
from app.programs.program_commands import add_missing_extension, remove_extension
from app.programs.program_list_model import ProgramListModel, make_program_details
from app.programs.programs_view import ProgramsPage
from app.programs.removable_media import UsbStick, list_usb_sticks
from app.screen import page_table
from app.screen.window_layout import FINGERTIP_PX
from core.executor.commands import FeedHold, LoadJob
from core.executor.snapshot import MachineState
from core.language.source import load_source
from tests.attached import attached
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key, window_on
from tests.screen.yes import yes
from tests.texts import begins, fragment, pattern, shows
from tests.texts import text as wording


@dataclass
class Shop(Hands):
    """The operator, the folders and the store behind the screen."""

    own: Path = Path()
    stick: Path = Path()
    journal: Journal | None = None

    @property
    def programs(self) -> ProgramsPage:
        page = self.frame.current_page
        assert isinstance(page, ProgramsPage)
        return page

    def open_list(self) -> None:
        self.key(Key.Key_F1)
        self.key(Key.Key_F6)
        self.sees(lambda: bool(self.programs.model.all_programs) and not self.programs.model.worker.is_busy)

    def rows(self) -> list[str]:
        return [row.cells[0] for row in self.programs.table_panel.table.rows]

    def settle(self) -> None:
        self.sees(lambda: not self.programs.model.worker.is_busy)

    def open_stick(self) -> None:
        self.settle()
        self.sees(lambda: self.rows()[:1] == ["STICK"])
        self.key(Key.Key_Return)
        self.sees(lambda: self.rows()[:1] == [".."])
        self.settle()


@pytest.fixture
def shop(qtbot: QtBot, machine: FakeMachine, journal: Journal, tmp_path: Path) -> Iterator[Shop]:
    own, stick = tmp_path / "programs", tmp_path / "STICK"
    for folder in (own, stick):
        folder.mkdir()
    shutil.copy(SAMPLES / "pin.nc", own / "alpha.nc")
    shutil.copy(SAMPLES / "bushing.nc", own / "beta.nc")
    desk = desk_on(machine, own, SAMPLES, keep=journal)
    attached(desk, ProgramListModel).program_transfer.folder_chooser.list_usb_sticks = lambda: (
        UsbStick("STICK", stick, 1_000_000),
    )
    with window_on(qtbot, desk, machine) as window:
        yield Shop(qtbot, window, desk, machine, own, stick, journal)


def test_a_name_is_found_by_typing_and_loaded_by_return(shop: Shop) -> None:
    shop.open_list()
    assert shop.frame.title_line.page_title == page_table.PROGRAMS
    shop.type("alp")
    shop.sees(lambda: shop.rows() == ["alpha.nc"])
    shop.sees(lambda: shop.programs.path_view.picture is not None)
    shop.key(Key.Key_Return)
    assert shop.frame.current_page is shop.page
    shop.sees(lambda: shop.prompt().startswith(wording("screen.to-start")))
    assert any(isinstance(command, LoadJob) for command in shop.machine.posted)
    shop.sees(
        lambda: (
            shop.journal is not None
            and any(row.proof for row in shop.journal.runs.read_records_by_text().values())
        )
    )
    shop.open_list()
    shop.sees(
        lambda: (
            shop.programs.model.selected_program is not None
            and shop.programs.model.selected_program.run_row.proof == "PROVED"
        )
    )


def test_other_program_cannot_be_loaded_while_one_runs(shop: Shop) -> None:
    shop.open_list()
    shop.machine.now = replace(shop.machine.now, state=MachineState.HOLD)
    shop.key(Key.Key_Return)
    assert shows(shop.desk.prompt_notice, "screen.program-runs-no-other")
    assert shop.programs.model.search_field.text == ""


def test_letters_of_name_switch_nothing_during_cycle(shop: Shop) -> None:
    shop.open_list()
    shop.machine.now = replace(shop.machine.now, state=MachineState.RUN)
    shop.type("cap")
    assert shop.programs.model.search_field.text == "cap"
    assert not shop.machine.now.cycle_repeat
    assert not shop.machine.now.no_count
    assert shop.machine.now.spindle_auto
    shop.type("bevel")
    assert not shop.desk.station_controls.is_estop_pressed
    shop.key(Key.Key_Escape)
    assert not any(isinstance(command, FeedHold) for command in shop.machine.posted)
    assert shop.programs.model.search_field.text == ""
    shop.type("capbevel")
    shop.key(Key.Key_F3)
    assert shop.frame.title_line.page_title == page_table.EDITOR


def test_name_of_copy_can_be_typed_during_cycle(shop: Shop) -> None:
    shop.open_list()
    shop.machine.now = replace(shop.machine.now, state=MachineState.RUN)
    shop.key(Key.Key_F4)
    shop.type("c")
    assert shop.programs.model.name_field.text == "c"  # it takes the place of the name that is offered
    assert not shop.machine.now.cycle_repeat


def test_programs_are_sorted_by_name_date_run_parts_and_size(shop: Shop) -> None:
    assert shop.journal is not None
    shop.journal.keep(load_source(SAMPLES / "knob.nc"))
    shop.journal.runs.record_run_start("knob.nc")
    shop.sees(lambda: shop.journal is not None and bool(shop.journal.require_store().runs.read_run_records()))
    shop.open_list()
    assert shop.rows() == sorted(shop.rows())
    shop.key(Key.Key_F2)  # the recently loaded programs
    shop.key(Key.Key_F2)
    shop.key(Key.Key_F2)
    shop.sees(lambda: shop.rows()[0] == "knob.nc")
    assert shop.programs.table_panel.table.title.endswith("BY LAST RUN")
    shop.key(Key.Key_F2)
    shop.key(Key.Key_F2)
    largest = max(shop.programs.model.all_programs, key=lambda program: program.size_bytes).name
    shop.sees(lambda: shop.rows()[0] == largest)


def show_recent(shop: Shop, *paths: Path) -> None:
    """Put the programs at the top of the recently loaded ones, and open the list that shows them."""
    for path in paths:
        shop.desk.recent_programs.add(str(path))
    shop.open_list()
    shop.key(Key.Key_F2)
    model = shop.programs.model
    shop.sees(lambda: model.is_recent_view and not model.recent_worker.is_busy)


def test_recent_program_outside_the_folder_is_loaded_with_enter(shop: Shop, tmp_path: Path) -> None:
    outside = Path(shutil.copy(SAMPLES / "pin.nc", tmp_path / "visitor.nc"))
    show_recent(shop, shop.own / "beta.nc", outside)
    assert shop.rows()[:2] == ["visitor.nc", "beta.nc"]
    assert ("TYPE", "OTHER FOLDER") in make_program_details(shop.programs.model.listed_programs[0])
    shop.programs.model.select_row(0)
    shop.key(Key.Key_Return)
    shop.sees(lambda: shop.desk.program_loader.loaded_program.path == outside)
    assert shop.frame.current_page.NAME == page_table.AUTOMATIC
    assert shop.desk.recent_programs.paths[0] == outside


def test_recent_list_follows_what_is_loaded(shop: Shop) -> None:
    for name in ("alpha", "beta"):
        assert shop.desk.program_choice.load_by_name(name)
    assert shop.desk.recent_programs.paths[:2] == (shop.own / "beta.nc", shop.own / "alpha.nc")


def test_missing_recent_program_is_named_with_the_reason_and_removed(shop: Shop, tmp_path: Path) -> None:
    gone = tmp_path / "gone.nc"
    show_recent(shop, shop.own / "alpha.nc", gone)
    before = shop.desk.program_loader.loaded_program.path
    shop.programs.model.select_row(0)
    shop.key(Key.Key_Return)
    assert "gone.nc" in shop.prompt()
    assert "THE FILE NO LONGER EXISTS" in shop.prompt()
    assert shop.frame.current_page.NAME == page_table.PROGRAMS
    assert shop.desk.program_loader.loaded_program.path == before
    shop.key(Key.Key_F6)
    shop.sees(lambda: "gone.nc" not in shop.rows())
    assert gone not in shop.desk.recent_programs.paths


def test_the_selected_file_of_two_with_one_name_remains_selected(shop: Shop, tmp_path: Path) -> None:
    other = tmp_path / "stick" / "beta.nc"
    other.parent.mkdir()
    other.write_text((shop.own / "beta.nc").read_text())
    show_recent(shop, shop.own / "beta.nc", other)
    shop.sees(
        lambda: (
            [each.path for each in shop.programs.model.listed_programs][:2] == [other, shop.own / "beta.nc"]
        )
    )
    shop.key(Key.Key_Down)
    model = shop.programs.model
    assert model.selected_program is not None
    assert model.selected_program.path == shop.own / "beta.nc"
    model.reload_list()
    shop.sees(lambda: not model.worker.is_busy and not model.recent_worker.is_busy)
    assert model.selected_program is not None
    assert model.selected_program.path == shop.own / "beta.nc"


def test_remove_leaves_the_file_of_a_recent_program(shop: Shop) -> None:
    show_recent(shop, shop.own / "alpha.nc")
    shop.programs.model.select_row(0)
    shop.key(Key.Key_F6)
    shop.sees(lambda: "alpha.nc" not in shop.rows())
    assert (shop.own / "alpha.nc").is_file()


def test_remove_without_a_recent_program_is_rejected(shop: Shop) -> None:
    show_recent(shop)
    for path in shop.desk.recent_programs.paths:
        shop.desk.recent_programs.remove(path)
    shop.programs.model.reload_list()
    shop.sees(lambda: shop.rows() == [])
    shop.programs.model.remove_recent_program()
    assert shop.desk.prompt_notice == "SELECT A PROGRAM FIRST"


def test_program_outside_the_folder_is_not_renamed(shop: Shop, tmp_path: Path) -> None:
    outside = Path(shutil.copy(SAMPLES / "pin.nc", tmp_path / "visitor.nc"))
    show_recent(shop, outside)
    shop.programs.model.select_row(0)
    shop.key(Key.Key_F5)
    assert not shop.programs.model.name_question
    assert "visitor.nc" in shop.prompt()


def test_copy_gets_typed_name_and_extension(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F4)
    shop.sees(lambda: shop.programs.table_panel.table.entry_prompt == wording("programs.name-of-copy"))
    shop.key(Key.Key_Delete)
    shop.type("gamma")
    shop.key(Key.Key_Return)
    shop.sees(lambda: "gamma.nc" in shop.rows())
    assert (shop.own / "gamma.nc").read_bytes() == (shop.own / "alpha.nc").read_bytes()


def test_typed_text_is_inserted_before_extension(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F4)
    shop.key(Key.Key_Backspace)
    shop.type("a2")
    shop.key(Key.Key_Return)
    shop.sees(lambda: "alpha2.nc" in shop.rows())


@pytest.mark.parametrize(
    ("name", "offered"), [("a.nc", "a"), ("1.5 pin.NC", "1.5 pin"), ("bare", "bare"), ("a.h.nc", "a.h.nc")]
)
def test_offered_name_completes_to_original_name(name: str, offered: str) -> None:
    assert remove_extension(name) == offered
    assert add_missing_extension(offered, Path(name)) == name


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("BETA.NC", wording("screen.name-is-there", name="beta.nc")),
        ("", wording("programs.nothing-entered")),
        ("a/b", fragment("programs.bad-name")),
        (".x", fragment("programs.would-be-hidden")),
    ],
)
def test_invalid_name_is_rejected(shop: Shop, name: str, why: str) -> None:
    shop.open_list()
    shop.key(Key.Key_F4)
    shop.key(Key.Key_Delete)
    shop.type(name)
    shop.key(Key.Key_Return)
    shop.sees(lambda: why in shop.prompt())
    assert sorted(path.name for path in shop.own.iterdir()) == ["alpha.nc", "beta.nc"]


def test_versions_follow_renamed_program(shop: Shop) -> None:
    assert shop.journal is not None
    shop.journal.save_version("alpha.nc", b"old", "test")
    shop.open_list()
    shop.key(Key.Key_F5)
    shop.key(Key.Key_Delete)
    shop.type("zeta")
    shop.key(Key.Key_Return)
    shop.sees(lambda: "zeta.nc" in shop.rows() and "alpha.nc" not in shop.rows())
    assert shop.journal.read_version_text("zeta.nc", 1) == b"old"


def test_delete_asks_once_and_saves_text_as_version(shop: Shop) -> None:
    assert shop.journal is not None
    text = (shop.own / "alpha.nc").read_bytes()
    shop.open_list()
    shop.key(Key.Key_F6)
    assert begins(shop.prompt(), "programs.delete", name="alpha.nc")
    shop.key(Key.Key_Escape)
    shop.key(Key.Key_F6)
    shop.key(Key.Key_F6)
    assert (shop.own / "alpha.nc").exists()
    yes(shop.window)
    shop.sees(lambda: "alpha.nc" not in shop.rows())
    assert shop.journal.read_version_text("alpha.nc", 1) == text


@pytest.mark.parametrize("key", [Key.Key_F5, Key.Key_F6])
def test_sample_program_cannot_be_changed(shop: Shop, key: Key) -> None:
    shop.open_list()
    shop.type("knob")
    shop.sees(lambda: shop.rows() == ["knob.nc"])
    shop.key(key)
    assert shop.prompt() == wording("programs.sample-stays")


def test_running_program_is_not_deleted(shop: Shop) -> None:
    shop.load("alpha")
    shop.machine.now = replace(shop.machine.now, state=MachineState.HOLD)
    shop.open_list()
    shop.key(Key.Key_F6)
    assert shop.desk.prompt_notice == wording("screen.program-being-cut", name="alpha.nc")


def test_export_to_stick_asks_before_overwriting(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F9)
    shop.key(Key.Key_F4)
    shop.settle()
    shop.open_stick()
    shop.key(Key.Key_F4)
    shop.sees(lambda: shows(shop.prompt(), "programs.copied-safe"))
    assert (shop.stick / "alpha.nc").read_bytes() == (shop.own / "alpha.nc").read_bytes()
    assert [path.name for path in shop.stick.iterdir()] == ["alpha.nc"]
    (shop.stick / "alpha.nc").write_text("M30\n")
    shop.settle()
    shop.key(Key.Key_F4)
    shop.sees(lambda: shows(shop.prompt(), "programs.other-text-there"))
    shop.key(Key.Key_F4)
    shop.settle()
    assert (shop.stick / "alpha.nc").read_text() == "M30\n"
    shop.sees(lambda: shows(shop.prompt(), "programs.other-text-there"))
    yes(shop.window)
    shop.sees(lambda: shows(shop.prompt(), "programs.copied-safe"))
    assert (shop.stick / "alpha.nc").read_bytes() == (shop.own / "alpha.nc").read_bytes()


def test_esc_leaves_existing_file_on_stick(shop: Shop) -> None:
    (shop.stick / "ALPHA.NC").write_text("M30\n")
    shop.open_list()
    shop.key(Key.Key_F9)
    shop.open_stick()
    shop.key(Key.Key_F4)
    shop.sees(lambda: shows(shop.prompt(), "programs.other-text-there"))
    shop.key(Key.Key_Escape)
    shop.key(Key.Key_F4)
    shop.sees(lambda: shows(shop.prompt(), "programs.other-text-there"))
    assert (shop.stick / "ALPHA.NC").read_text() == "M30\n"


def test_imported_program_is_proved_and_errors_are_reported(shop: Shop) -> None:
    shutil.copy(SAMPLES / "grooves.nc", shop.stick / "good.nc")
    (shop.stick / "bad.nc").write_text("G90G72F10\nG99X1\nM30\n")
    shop.open_list()
    shop.key(Key.Key_F8)
    shop.open_stick()
    shop.key(Key.Key_F5)
    shop.sees(
        lambda: shop.prompt().startswith(wording("programs.imported-not-proved", count=2, found="bad.nc"))
    )
    assert {"good.nc", "bad.nc"} <= {path.name for path in shop.own.iterdir()}


def test_import_asks_before_replacing_and_saves_old_text(shop: Shop) -> None:
    assert shop.journal is not None
    old = (shop.own / "alpha.nc").read_bytes()
    shutil.copy(SAMPLES / "grooves.nc", shop.stick / "alpha.nc")
    shop.open_list()
    shop.key(Key.Key_F8)
    shop.open_stick()
    shop.key(Key.Key_Down)
    shop.key(Key.Key_Return)
    shop.sees(lambda: shows(shop.prompt(), "programs.other-text-there"))
    assert (shop.own / "alpha.nc").read_bytes() == old
    yes(shop.window)
    shop.sees(lambda: shows(shop.prompt(), "programs.imported-proved"))
    assert (shop.own / "alpha.nc").read_bytes() == (SAMPLES / "grooves.nc").read_bytes()
    assert shop.journal.read_version_text("alpha.nc", 1) == old


def test_file_that_is_not_a_program_is_not_imported(shop: Shop) -> None:
    (shop.stick / "photo.nc").write_bytes(bytes(range(256)))
    shop.open_list()
    shop.key(Key.Key_F8)
    shop.open_stick()
    shop.key(Key.Key_F5)
    shop.sees(
        lambda: begins(shop.prompt(), "screen.refused", why=pattern("programs.no-program", name="photo.nc"))
    )
    assert not (shop.own / "photo.nc").exists()


def test_removed_stick_is_reported(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F9)
    shop.open_stick()
    shutil.rmtree(shop.stick)
    shop.key(Key.Key_F4)
    shop.sees(lambda: begins(shop.prompt(), "screen.refused"))


def test_copy_without_selected_location_asks_to_open_one(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F9)
    shop.settle()
    shop.key(Key.Key_F4)
    assert begins(shop.prompt(), "programs.open-place")


def test_only_mounted_media_are_found_on_both_levels(tmp_path: Path) -> None:
    for path in ("one", "user/two", "user/gone"):
        (tmp_path / path).mkdir(parents=True)
    mounted = {tmp_path / "one", tmp_path / "user" / "two"}
    found = list_usb_sticks((tmp_path, tmp_path / "nothing"), mounted.__contains__, tmp_path / "no list")
    assert [stick.label for stick in found] == ["one", "two"]


def test_f2_twice_opens_program_list_from_question(shop: Shop) -> None:
    shop.key(Key.Key_F2)
    assert shop.page.file_prompt.isVisible()
    shop.key(Key.Key_F2)
    assert shop.frame.title_line.page_title == page_table.PROGRAMS
    assert not shop.page.file_prompt.isVisible()
    shop.key(Key.Key_Escape)
    assert shop.frame.current_page is shop.page


def test_copy_is_named_by_touch_only(shop: Shop) -> None:
    shop.open_list()
    shop.key(Key.Key_F4)
    pad = shop.programs.letter_pad
    shop.sees(lambda: pad.isVisible() and len(pad._places) == 43)
    for _ in range(8):
        touch(shop, 10)  # DEL
    for place in (33, 22):  # z, a
        touch(shop, place)
    touch(shop, 21)  # RETURN
    shop.sees(lambda: "za.nc" in shop.rows())
    shop.sees(lambda: not pad.isVisible())


def test_new_program_is_created_by_touch_only(shop: Shop) -> None:
    """Letters came only behind the first letter of a keyboard, and a name that nobody has led nowhere."""
    shop.window.resize(1024, 600)
    shop.open_list()
    table, pad = shop.programs.table_panel, shop.programs.letter_pad
    assert not pad.isVisible()
    table.grab()
    entry, *_ = table._places[-1]
    QTest.mouseClick(table, Qt.MouseButton.LeftButton, pos=entry.center().toPoint())
    shop.sees(lambda: pad.isVisible() and len(pad._places) == 43)
    for box, *_ in pad._places:
        assert min(box.width(), box.height()) >= FINGERTIP_PX - 1
        assert pad.find_full_area().adjusted(-0.1, -0.1, 0.1, 0.1).contains(box)
    assert not table.geometry().intersects(pad.geometry())
    for place in (33, 33, 22):  # z, z, a
        touch(shop, place)
    shop.sees(lambda: shop.rows() == [])
    assert "F3" in shop.prompt()
    keys = shop.frame.key_bar
    keys.grab()
    box = next(box for box, *_ in keys._places if box.center().x() > keys.width() * 0.2)
    QTest.mouseClick(keys, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    shop.sees(lambda: shop.frame.title_line.page_title == page_table.EDITOR)
    shop.sees(lambda: shop.frame.key_bar.key_labels[0] == "CREATE")


def letters_are(shop: Shop, shown: bool) -> bool:
    return shop.programs.letter_pad.isVisible() is shown


def test_touch_hides_letter_pad(shop: Shop) -> None:
    shop.open_list()
    table = shop.programs.table_panel
    for shown in (True, False):
        table.grab()
        entry, *_ = table._places[-1]
        QTest.mouseClick(table, Qt.MouseButton.LeftButton, pos=entry.center().toPoint())
        shop.sees(partial(letters_are, shop, shown))
    assert shop.programs.detail_panel.isVisible()


def touch(shop: Shop, place: int) -> None:
    pad = shop.programs.letter_pad
    box, *_ = pad._places[place]
    QTest.mouseClick(pad, Qt.MouseButton.LeftButton, pos=QPoint(*map(int, box.center().toTuple())))
