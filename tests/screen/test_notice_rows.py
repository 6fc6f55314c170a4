"""What stands on every page until somebody does something: rows that move no target under a finger."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.compose.runs.journal import Journal
from app.desk.programs.program_loading import LoadingPhase
from app.desk.status.interrupted_notice import NoticeRow, _describe_uncertainty
from app.desk.translation import tr
from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, set_language
from app.screen.window.key_table import RELOAD_KEY
from app.screen.window.window_bars import NoticeRows
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import POWER_LOST_REASON, MachineState
from core.ports import ALL_UNKNOWN_PARTS, UnknownPart
from tests.interrupted import broken_off
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key, window_on
from tests.texts import Pattern, begins, text


@pytest.mark.parametrize(
    "page",
    [
        page_table.AUTOMATIC,
        page_table.MENU,
        page_table.JOG,
        page_table.PROGRAMS,
        page_table.TOOLS,
        page_table.SPECIAL,
        page_table.ZERO,
    ],
)
def test_interruption_and_full_disk_are_shown_on_every_page(hands: Hands, page: str) -> None:
    hands.machine.now = replace(hands.machine.now, interrupted=broken_off())
    hands.desk.storage_state.set_store_readers(lambda: "the disk is full", lambda: "20 parts")
    hands.frame.open_page(page)
    hands.window.refresh()
    rows = hands.frame.notice_rows
    assert rows.isVisible()
    assert [row.text.split(" LINE")[0] for row in rows.notice_rows] == [
        "INTERRUPTED: PIN.NC",
        text("screen.not-kept", why="the disk is full"),
    ]
    assert rows.notice_rows[1].values_text.startswith("NOT SAVED YET: 20 parts.")
    assert not rows.geometry().intersects(hands.frame.current_page.geometry())
    assert "NOT SAVED" in [lamp.label for lamp in hands.frame.strip.lamps]
    hands.machine.now = replace(hands.machine.now, interrupted=None)
    hands.desk.storage_state.set_store_readers()
    hands.window.refresh()
    assert not rows.isVisible()


def test_notice_row_does_not_move_target_during_jog_by_touch(hands: Hands) -> None:
    time = [100.0]
    hands.desk.station_controls.clock = lambda: time[0]
    hands.frame.open_page(page_table.JOG)
    now = hands.desk.read_snapshot()
    hands.desk.desk_control.read_snapshot = lambda: replace(now, state=MachineState.JOG)
    hands.window.refresh()
    stands = hands.frame.current_page.geometry()
    hands.desk.storage_state.set_store_readers(lambda: "the disk is full")
    hands.desk.desk_control.read_snapshot = lambda: replace(now, state=MachineState.IDLE)  # between two steps
    time[0] += 1.0
    hands.window.refresh()
    assert hands.frame.current_page.geometry() == stands
    assert "NOT SAVED" in [lamp.label for lamp in hands.frame.strip.lamps]  # the lamp says it at once
    time[0] += 3.0
    hands.window.refresh()
    assert hands.frame.current_page.geometry() != stands
    assert hands.frame.notice_rows.isVisible()


def test_executed_part_of_interrupted_program_remains_drawn(hands: Hands) -> None:
    hands.load("pin")
    job = hands.desk.program_loader.loaded_program.job
    assert job is not None
    found = broken_off(program="pin.nc", text=job.text_digest, tool=1, block=9, line=8)
    hands.machine.now = replace(hands.machine.now, interrupted=found)
    hands.window.refresh()
    tip = hands.page.path_view._tip
    assert tip is not None
    tool = job.setup.tools[1]
    assert (tip.active_block_number, tip.stop_position) == (
        9,
        (found.where[1] - tool.z, found.where[0] - tool.x),
    )
    hands.machine.now = replace(hands.machine.now, interrupted=replace(found, text="changed"))
    hands.window.refresh()
    assert hands.page.path_view._tip is not None
    assert hands.page.path_view._tip.active_block_number == 0


def test_touch_on_notice_row_acts_like_its_key(hands: Hands) -> None:
    hands.load("pin")
    hands.machine.now = replace(
        hands.machine.now, interrupted=broken_off(program="pin.nc"), state=MachineState.IDLE
    )
    hands.window.refresh()
    rows = hands.frame.notice_rows
    assert [key for key, _label in rows.notice_rows[0].keys] == ["F6", "Y"]
    hands.frame.open_page(page_table.JOG)
    hands.window.refresh()
    assert rows.notice_rows[0].keys == ()  # there these keys mean other things
    hands.key(Key.Key_F1)


@pytest.mark.parametrize("page", [page_table.AUTOMATIC, page_table.JOG, page_table.SPECIAL, page_table.TOOLS])
def test_unresponsive_machine_is_shown_on_every_page(hands: Hands, page: str) -> None:
    hands.frame.open_page(page)
    hands.machine.now = replace(hands.machine.now, unknown=ALL_UNKNOWN_PARTS)
    hands.window.refresh()
    (row,) = hands.frame.notice_rows.notice_rows
    assert (row.text, row.color_name) == (text("screen.spindle-may-turn"), "alarm")
    assert begins(row.values_text, "screen.not-known", what=Pattern("POSITIONS, SPINDLE, OUTPUTS, INPUTS.*"))
    assert text("screen.spindle-unknown") in [lamp.label for lamp in hands.frame.strip.lamps]
    hands.machine.now = replace(hands.machine.now, unknown=frozenset({UnknownPart.OUTPUTS}))
    hands.window.refresh()
    (row,) = hands.frame.notice_rows.notice_rows
    assert row.text == text("screen.machine-not-heard", what="OUTPUTS")


def test_notice_row_with_key_is_touch_sized(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    told = (NoticeRow("INTERRUPTED", "T1", (("F6", "SEARCHTO"),)), NoticeRow("NOT SAVED", "20 parts"))
    monkeypatch.setattr("app.screen.window.window_frame.make_notices", lambda *_what, **_more: told)
    hands.window.refresh()
    rows = hands.frame.notice_rows
    rows.grab()
    assert len(rows.notice_rows) == 2
    assert rows._places
    for box, *_ in rows._places:
        assert box.height() >= FINGERTIP_PX
        assert rows.find_full_area().contains(box)
    with_key, read = rows._find_row_height(rows.notice_rows[0]), rows._find_row_height(rows.notice_rows[1])
    assert read < with_key
    assert rows.height() == with_key + read


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize(("unit", "wide"), [(6.4, 858), (8.0, 1070), (10.8, 1610)])
def test_uncertain_state_after_power_cut_is_shown_in_full_next_to_keys(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, unit: float, wide: int, language: str
) -> None:
    """At 1024x600 and 1280x800 its last words, to look at tool and part, were cut off."""
    assert qapp is not None
    load_fonts()
    set_language(language)
    drawn: list[str] = []
    real = QPainter.drawText

    def spy(painter: QPainter, *what: object) -> object:
        drawn.extend(each for each in what if isinstance(each, str))
        return real(painter, *what)  # type: ignore[call-overload]

    place = "X R−0.12500 Z −3.12130"
    stood = tr("WAS AT {stood}, NOW AT {now} FROM HOME").format(stood=place, now=place)
    unsure = _describe_uncertainty(broken_off(why=POWER_LOST_REASON))
    rows = NoticeRows(ScreenTheme(DARK_PALETTE, unit), lambda _key: None)
    keys = (("F6", "SEARCHTO"), ("Y", tr("FROM LINE 1")))
    rows.notice_rows = (NoticeRow("INTERRUPTED", f"{stood}{unsure}", keys),)
    rows.resize(wide, rows.needed_height_px)
    rows.resize(wide, rows.needed_height_px)  # as the window does, which asks in every frame
    monkeypatch.setattr(QPainter, "drawText", spy)
    rows.grab()
    set_language("en")
    lines = len(drawn) - 1 - 2 * len(keys)
    assert " ".join(drawn[1 : 1 + lines]) == rows.notice_rows[0].values_text
    rows.notice_rows = (NoticeRow("INTERRUPTED", "T1", keys),)
    drawn.clear()
    rows.grab()
    assert drawn[:2] == ["INTERRUPTED", "T1"]  # what fits has one line


@pytest.mark.parametrize(
    ("page", "state", "can_reload"),
    [
        (page_table.AUTOMATIC, MachineState.IDLE, True),
        (page_table.AUTOMATIC, MachineState.RUN, False),  # No program can be loaded during a run.
        (page_table.JOG, MachineState.IDLE, False),  # The key has no function on this page.
    ],
)
def test_changed_program_offers_reload_only_where_its_key_reloads_it(
    hands: Hands, page: str, state: MachineState, can_reload: bool
) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    hands.desk.storage_state.set_file_readers(lambda: "DIFFERENT", lambda: None, lambda: True)
    hands.frame.open_page(page)
    hands.window.refresh()
    row = next(row for row in hands.frame.notice_rows.notice_rows if row.text == "DIFFERENT")
    assert row.keys == (((RELOAD_KEY, "RELOAD"),) if can_reload else ())


def test_missing_program_file_offers_no_reload(hands: Hands) -> None:
    hands.desk.storage_state.set_file_readers(lambda: "MISSING", lambda: None, lambda: False)
    hands.window.refresh()
    row = next(row for row in hands.frame.notice_rows.notice_rows if row.text == "MISSING")
    assert row.keys == ()


def load_last_program(hands: Hands) -> Path:
    """Load the last program of the list from a folder of its own, and return its path."""
    assert hands.desk.program_choice.load_by_name("zulu.nc")
    loader = hands.desk.program_loader
    hands.sees(lambda: loader.loaded_program.phase is LoadingPhase.READY)
    path = loader.loaded_program.path
    assert path is not None
    assert path.name == "zulu.nc"
    return path


def change_file(hands: Hands, path: Path) -> None:
    path.write_text(path.read_text(encoding="utf-8") + "(CHANGED)\n", encoding="utf-8")
    hands.desk.storage_state.set_file_readers(lambda: "DIFFERENT", lambda: None, lambda: True)
    hands.window.refresh()


@pytest.fixture
def folder_hands(qtbot: QtBot, machine: FakeMachine, journal: Journal, tmp_path: Path) -> Iterator[Hands]:
    own = tmp_path / "programs"
    own.mkdir()
    for name in ("alpha.nc", "zulu.nc"):
        shutil.copy(SAMPLES / "pin.nc", own / name)
    desk = desk_on(machine, own, SAMPLES, keep=journal)
    with window_on(qtbot, desk, machine) as window:
        yield Hands(qtbot, window, desk, machine)


@pytest.mark.parametrize("is_touched", [True, False])
def test_reload_loads_the_changed_file_of_the_loaded_program(folder_hands: Hands, is_touched: bool) -> None:
    hands = folder_hands
    path = load_last_program(hands)
    change_file(hands, path)
    row = next(row for row in hands.frame.notice_rows.notice_rows if row.text == "DIFFERENT")
    if is_touched:
        hands.window.press_key(row.keys[0][0])
    else:
        hands.key(Key.Key_F2, Qt.KeyboardModifier.ShiftModifier)
    loader = hands.desk.program_loader

    def is_new() -> bool:
        source = loader.loaded_program.source
        return source is not None and "(CHANGED)" in source.lines

    hands.sees(is_new)
    assert loader.loaded_program.path == path
    assert not hands.page.file_prompt.isVisible()


@pytest.mark.parametrize("difference", ["", "MISSING"])
def test_reload_key_keeps_a_program_whose_file_cannot_be_reloaded(
    folder_hands: Hands, difference: str
) -> None:
    hands = folder_hands
    load_last_program(hands)
    loaded = hands.desk.program_loader.loaded_program
    hands.desk.storage_state.set_file_readers(lambda: difference, lambda: None, lambda: False)
    hands.key(Key.Key_F2, Qt.KeyboardModifier.ShiftModifier)
    assert hands.desk.program_loader.loaded_program is loaded
    assert hands.desk.prompt_notice == (difference or "THE PROGRAM FILE HAS NOT CHANGED")


def test_reload_key_does_not_load_during_a_run(folder_hands: Hands) -> None:
    hands = folder_hands
    change_file(hands, load_last_program(hands))
    loaded = hands.desk.program_loader.loaded_program
    hands.machine.now = replace(hands.machine.now, state=MachineState.RUN)
    hands.key(Key.Key_F2, Qt.KeyboardModifier.ShiftModifier)
    assert hands.desk.program_loader.loaded_program is loaded
