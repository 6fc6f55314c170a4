"""F8 and F9 by keys alone: a wear correction between two parts, undo, clear, history, a tool."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.desk.programs.program_loading import LoadingPhase
from app.offsets.secondary_offsets_view import SecondaryOffsetsPage
from app.offsets.tool_offsets_view import ToolOffsetsPage
from app.screen import page_table
from app.screen.panel import Panel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.commands import ChangeOffsets, LoadJob, UseOffsetTables
from core.executor.snapshot import MachineState
from core.store.store import Store
from core.store.store_rows import ToolOffsetRow
from tests.offset_store import use_store
from tests.screen.hands import Hands, Key
from tests.screen.yes import yes
from tests.texts import begins, shows
from tests.texts import text as wording


@pytest.fixture
def store(hands: Hands, tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "home") as store:
        use_store(hands.desk, store)
        yield store


def page_of(hands: Hands) -> SecondaryOffsetsPage:
    page = hands.frame.current_page
    assert isinstance(page, SecondaryOffsetsPage)
    return page


def tools_of(hands: Hands) -> ToolOffsetsPage:
    page = hands.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    return page


def in_force(hands: Hands) -> float:
    """X of T1 that the control was told last; 0 before that."""
    used = [command for command in hands.machine.posted if isinstance(command, UseOffsetTables)]
    return used[-1].tools[1].x if used else 0.0


def answer(hands: Hands, *texts: str) -> None:
    for text in texts:
        hands.type(text)
        hands.key(Key.Key_Return)


def test_correction_is_entered_shown_and_used_in_next_cycle(hands: Hands, store: Store) -> None:
    hands.load("bushing")
    hands.key(Key.Key_F9)
    page = page_of(hands)
    assert hands.frame.title_line.page_title == page_table.SECCMP
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == wording("screen.offset-number"))
    assert (page.entry_panel.entry_texts.subject_text, page.entry_panel.entry_texts.footer_text) == (
        "Secondary offset number:",
        "Press Esc to exit offset adjustment screen        Press C to clear all offsets",
    )
    answer(hands, "1")
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == wording("screen.x-diameter-correction"))
    answer(hands, ".5-.502", "")
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == "R?")
    assert page.entry_panel.entry_texts.change_description.endswith("→  X −0.00100  Z +0.00000  R 0.00000")
    answer(hands, "")
    hands.sees(lambda: 1 in page.content_panel.offsets)
    assert store.offsets.secondary_offsets.read_rows()[1].x == pytest.approx(-0.001 * 25.4)
    hands.sees(lambda: hands.prompt() == wording("screen.saved", names="D1"))
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is hands.page
    hands.sees(lambda: hands.prompt().startswith(wording("screen.to-start")))
    job = [command.job for command in hands.machine.posted if isinstance(command, LoadJob)][-1]
    assert job.setup.secondary[1].x == pytest.approx(-0.001 * 25.4)


def test_rejected_entry_is_explained_and_remains_for_correction(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F9)
    page = page_of(hands)
    answer(hands, "2", "0,5")
    assert hands.prompt() == wording(
        "screen.refused",
        why=wording("screen.no-number", what=",", entry="0,5", hint=wording("screen.decimal-point")),
    )
    assert page.entry_panel.entry_texts.text == "0,5"
    hands.key(Key.Key_Backspace)
    hands.key(Key.Key_Delete)
    answer(hands, ".005", "", "")
    hands.sees(lambda: 2 in page.content_panel.offsets)
    assert store.offsets.secondary_offsets.read_rows()[2].x == pytest.approx(0.0025 * 25.4)


def test_signs_and_c_are_entry_keys_not_switches(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F9)
    before = (hands.desk.station_controls.feed_pot.wanted, hands.desk.station_controls.spindle_pot.wanted)
    hands.type("1+1-/.,")
    hands.type("c")
    assert not hands.machine.now.cycle_repeat
    assert (
        hands.desk.station_controls.feed_pot.wanted,
        hands.desk.station_controls.spindle_pot.wanted,
    ) == before
    assert page_of(hands).entry_panel.entry_texts.text == "1+1-/.,"
    hands.sees(lambda: {"C", "/", "S", "O", "D", "R"} <= hands.frame.strip.hidden_keys)
    hands.type("sodrt")  # no letter is a switch while figures are typed
    assert not hands.machine.now.single_block
    assert hands.prompt() == wording("screen.entry-key", key="t")
    hands.type("1")  # the next one that it takes answers nothing
    assert not shows(hands.prompt(), "screen.entry-key")


def test_clear_asks_once_and_undo_restores_everything(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F9)
    page = page_of(hands)
    for number in ("1", "32"):
        answer(hands, number, ".005", "", "")
        hands.sees(
            lambda: (
                not page.model.offset_book.is_saving
                and page.entry_panel.entry_texts.question_text == wording("screen.offset-number")
            )
        )
    hands.key(Key.Key_C)
    assert begins(hands.prompt(), "screen.clear-secondary")
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is page
    hands.key(Key.Key_C)
    hands.key(Key.Key_C)
    assert page.content_panel.offsets
    yes(hands.window)
    hands.sees(lambda: page.content_panel.offsets == {})
    hands.key(Key.Key_F4)
    yes(hands.window)
    hands.sees(lambda: sorted(page.content_panel.offsets) == [1, 32])


def test_history_is_scrolled_and_closed(hands: Hands, store: Store) -> None:
    for step in range(40):
        store.offsets.secondary_offsets.change_row(1, f"change {step}", {"z": step + 1.0})
    store.write(lambda _connection: None).result(60)
    hands.key(Key.Key_F9)
    page = page_of(hands)
    hands.key(Key.Key_F5)
    hands.sees(page.history_list.isVisible)
    assert len(page.history_list.history_entries) == 40
    assert page.history_list.history_entries[0][3] == "change 39"
    hands.sees(lambda: page.history_list.rows > 1)
    hands.key(Key.Key_PageDown)
    assert page.history_list.first_row == page.history_list.rows
    hands.key(Key.Key_Escape)
    hands.sees(page.content_panel.isVisible)


def test_a_correction_while_a_part_runs_is_proved_meanwhile(hands: Hands, store: Store) -> None:
    """Announced and proved with the new offset under the running part; reading anew waits for its end."""
    hands.load("bushing")
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    loads = sum(isinstance(command, LoadJob) for command in hands.machine.posted)
    hands.key(Key.Key_F9)
    hands.sees(lambda: begins(hands.prompt(), "screen.running-part-keeps-offsets"))
    answer(hands, "1", ".005", "", "")
    hands.sees(
        lambda: (
            hands.prompt() == wording("screen.saved", names="D1") + wording("screen.counts-from-next-start")
        )
    )
    hands.sees(lambda: len(renewals(hands)) == 2)
    announced, ready = renewals(hands)
    assert announced == ChangeOffsets()
    assert ready.job is not None
    assert ready.proof is not None
    assert (ready.proof.digest, ready.proof.errors) == (ready.job.digest, ())
    assert ready.job.setup.secondary[1].x == pytest.approx(0.0025 * 25.4)
    assert sum(isinstance(command, LoadJob) for command in hands.machine.posted) == loads
    hands.machine.idle()  # a machine that did not take it up: it is read anew
    hands.sees(lambda: sum(isinstance(c, LoadJob) for c in hands.machine.posted) == loads + 1)
    hands.sees(lambda: hands.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    used = [command for command in hands.machine.posted if isinstance(command, UseOffsetTables)]
    assert used[-1].secondary[1].x == pytest.approx(0.0025 * 25.4)


def renewals(hands: Hands) -> list[ChangeOffsets]:
    return [command for command in hands.machine.posted if isinstance(command, ChangeOffsets)]


def test_offsets_are_metric_if_control_is_metric(hands: Hands, store: Store) -> None:
    store.offsets.secondary_offsets.change_row(1, "inch", {"z": 2.54}).result(60)
    use_store(hands.desk, store)
    hands.key(Key.Key_F9)
    modal = hands.machine.now.modal._replace(metric=True)
    hands.machine.now = replace(hands.machine.now, modal=modal)
    answer(hands, "1")
    hands.sees(lambda: "Z +2.5400" in page_of(hands).entry_panel.entry_texts.change_description)


def test_a_tool_is_set_with_f8_and_refused_while_running(hands: Hands, store: Store) -> None:
    hands.load("pin")
    hands.key(Key.Key_F8)
    page = tools_of(hands)
    assert hands.frame.title_line.page_title == page_table.TOOLS
    for _ in range(8):
        hands.key(Key.Key_Down)
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == "T9  X R?")
    answer(hands, "-.5", "-3-.25")
    hands.sees(lambda: 9 in page.model.offset_book.tool_offsets)
    hands.key(Key.Key_Right)
    answer(hands, ".0156")
    hands.sees(
        lambda: page.entry_panel.entry_texts.change_description == "T9   NOSE RADIUS 0.00000 → 0.01560"
    )
    assert store.offsets.tool_offsets.read_rows()[9] == ToolOffsetRow(
        -0.5 * 25.4, -3.25 * 25.4, 0.0156 * 25.4
    )
    hands.machine.now = replace(hands.machine.now, state=MachineState.HOLD)
    answer(hands, "1")
    hands.sees(lambda: hands.prompt() == wording("screen.program-runs-wear-only"))
    assert store.offsets.tool_offsets.read_rows()[9].nose_radius == 0.0156 * 25.4


def test_wear_is_entered_between_two_parts(hands: Hands, store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "touched off", {"x": -12.7, "z": -76.2}).result(60)
    use_store(hands.desk, store)
    hands.load("pin")
    hands.key(Key.Key_F8)
    for _ in range(4):
        hands.key(Key.Key_Right)
    hands.sees(lambda: tools_of(hands).entry_panel.entry_texts.question_text == "T1  WEAR X Ø?")
    hands.type("-.0005")
    hands.key(Key.Key_F2)
    hands.sees(lambda: hands.prompt() == wording("screen.saved", names="T1"))
    hands.type("-.0002")
    hands.key(Key.Key_F2)
    hands.sees(lambda: store.offsets.tool_offsets.read_rows()[1].wear_x == pytest.approx(-0.00035 * 25.4))
    hands.sees(lambda: in_force(hands) == pytest.approx(-12.7 - 0.00035 * 25.4))
    hands.key(Key.Key_F4)
    yes(hands.window)
    hands.sees(lambda: store.offsets.tool_offsets.read_rows()[1].wear_x == pytest.approx(-0.00025 * 25.4))


def test_remark_accepts_letters_that_are_keys_elsewhere(hands: Hands, store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "touched off", {"x": 1.0, "z": 1.0}).result(60)
    use_store(hands.desk, store)
    hands.key(Key.Key_F8)
    for _ in range(7):
        hands.key(Key.Key_Right)
    hands.key(Key.Key_Return)
    hands.type("she Dares")
    hands.sees(lambda: {"S", "H", "E", "R", "D"} & hands.frame.strip.hidden_keys != set())
    hands.key(Key.Key_Return)
    hands.sees(lambda: store.offsets.tool_offsets.read_rows()[1].remark == "she Dares")
    assert hands.machine.now.state is MachineState.IDLE
    assert not hands.machine.now.single_block


def test_remark_is_typed_by_touch(hands: Hands, store: Store) -> None:
    """The pad has figures; a text had no letters, and none of it could be typed."""
    store.offsets.tool_offsets.change_row(1, "touched off", {"x": 1.0, "z": 1.0}).result(60)
    use_store(hands.desk, store)
    hands.window.resize(1024, 600)
    hands.key(Key.Key_F8)
    page = tools_of(hands)
    page.set_number_pad_visible(True)
    page.model.select_cell(1, 7)
    hands.sees(page.letter_pad.isHidden)
    page.handle_touched_key("Enter")  # on the pad: it opens the remark
    hands.sees(lambda: not page.letter_pad.isHidden())
    for place in (11, 13):  # of the rows of ten: w, r
        touch(hands, page.letter_pad, place)
    page.letter_pad._places[-1][1]()
    hands.sees(lambda: store.offsets.tool_offsets.read_rows()[1].remark == "wr")
    hands.sees(
        lambda: (
            page.letter_pad.isHidden() and not page.number_pad.isHidden() and page.content_panel.isVisible()
        )
    )


def test_offset_change_without_store_is_rejected(hands: Hands) -> None:
    hands.key(Key.Key_F9)
    answer(hands, "1")
    hands.sees(lambda: hands.prompt() == wording("screen.no-offsets-kept"))


def test_offset_is_entered_by_touch_only(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F9)
    page = page_of(hands)
    hands.sees(lambda: len(page.content_panel._places) == 4 + 2)  # with the scroll keys
    assert page.number_pad.isHidden()  # until a finger is there
    touch(hands, page.content_panel, ZONES[2])  # the upper half of the right column
    assert page.model.offset_number == 0
    assert page.content_panel.first_enlarged_number == 17
    touch(hands, page.content_panel, 0)
    assert page.model.offset_number == 17
    assert page.content_panel.first_enlarged_number == 0
    point, two, enter = 13, 9, 20  # places on the pad, row by row
    for key in (point, two, enter, enter, enter):
        spot, *_ = page.number_pad._places[key]
        QTest.mouseClick(
            page.number_pad, Qt.MouseButton.LeftButton, pos=QPoint(*map(int, spot.center().toTuple()))
        )
    yes(hands.window)
    hands.sees(lambda: 17 in page.content_panel.offsets)
    assert store.offsets.secondary_offsets.read_rows()[17].x == pytest.approx(0.1 * 25.4)


ZONES = range(-4, 0)  # Places of the four half columns, which follow the scroll keys.


def touch(hands: Hands, panel: Panel, place: int) -> None:
    """A finger in the middle of a place, which is large enough for one; then what is shown now."""
    hands.window.refresh()
    hands.window.grab()
    assert all(min(box.width(), box.height()) >= FINGERTIP_PX for box, *_ in panel._places)
    box, *_ = panel._places[place]
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=QPoint(*map(int, box.center().toTuple())))
    hands.window.grab()


@pytest.mark.parametrize(("zone", "first"), [(0, 1), (1, 9), (2, 17), (3, 25)])
@pytest.mark.parametrize("size", [(1024, 600), (1920, 1080)])
def test_every_offset_is_reached_by_touch(
    hands: Hands, store: Store, zone: int, first: int, size: tuple[int, int]
) -> None:
    hands.window.resize(*size)
    hands.key(Key.Key_F9)
    page = page_of(hands)
    for place in range(8):
        touch(hands, page.content_panel, ZONES[zone])
        touch(hands, page.content_panel, place)
        assert page.model.offset_number == first + place
        hands.key(Key.Key_Escape)


def test_enlarged_offsets_close_by_touch_and_by_esc(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F9)
    page = page_of(hands)
    touch(hands, page.content_panel, ZONES[1])
    touch(hands, page.content_panel, 8)  # ALL 32
    assert (page.content_panel.first_enlarged_number, page.model.offset_number) == (0, 0)
    touch(hands, page.content_panel, ZONES[1])
    hands.key(Key.Key_Escape)
    assert page.content_panel.first_enlarged_number == 0
    assert hands.frame.current_page is page
    touch(hands, page.content_panel, 3)
    answer(hands, "7")  # typed all the same
    hands.sees(lambda: page.content_panel.first_enlarged_number == 0)
    assert page.model.offset_number == 7


def test_effect_is_shown_for_entered_and_for_saved_change(hands: Hands, store: Store) -> None:
    hands.load("bushing")
    hands.key(Key.Key_F9)
    page = page_of(hands)
    hands.key(Key.Key_F6)
    hands.sees(lambda: begins(hands.prompt(), "screen.nothing-changed-yet"))
    answer(hands, "1")
    hands.type("-.002")
    hands.key(Key.Key_F6)
    hands.sees(lambda: page.effect_view.is_comparing)
    assert not page.content_panel.isVisible()
    # half of the diameter, and what R does to it is nothing here
    hands.sees(lambda: begins(hands.prompt(), "screen.apart-at-circle", far="0.00100 in"))
    whole = page.effect_view.first_projection
    hands.key(Key.Key_F6)
    hands.sees(lambda: begins(hands.prompt(), "screen.apart-table", far="0.00100 in"))
    before = page.effect_view.first_projection
    assert whole is not None
    assert before is not None
    assert 0.0254 * before.pixels_per_mm >= 0.05 * page.effect_view.width()
    hands.key(Key.Key_Z)
    assert page.effect_view.first_projection != before
    hands.key(Key.Key_F6)
    hands.sees(page.content_panel.isVisible)
    answer(hands, "", "", "")
    hands.sees(lambda: 1 in page.content_panel.offsets)
    hands.sees(lambda: hands.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    hands.key(Key.Key_F6)
    hands.sees(lambda: begins(hands.prompt(), "screen.apart-at-circle", far="0.00100 in"))
    hands.key(Key.Key_Escape)
    hands.sees(page.content_panel.isVisible)
    assert hands.frame.current_page is page


def test_effect_is_not_shown_without_program(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F8)
    hands.key(Key.Key_F6)
    assert begins(hands.prompt(), "screen.load-program-for-effect")


def test_tools_are_scrolled_and_cells_selected_by_touch(hands: Hands, store: Store) -> None:
    hands.key(Key.Key_F8)
    table = tools_of(hands).content_panel
    hands.window.grab()
    shown = table.rows
    touch(hands, table, 1)  # a page down
    hands.sees(lambda: tools_of(hands).model.tool_number == shown + 1)
    assert table.first_row == 1
    touch(hands, table, 3 + 8 * (shown - 1) + 4)  # after three keys: the last row that is shown, wear X
    hands.sees(lambda: tools_of(hands).entry_panel.entry_texts.question_text == f"T{shown + 1}  WEAR X Ø?")
    number, *_ = table._places[3 + 8 * 1]
    QTest.mouseClick(
        table, Qt.MouseButton.LeftButton, pos=QPoint(int(number.left()) + 9, int(number.center().y()))
    )
    hands.sees(lambda: (tools_of(hands).model.tool_number, tools_of(hands).model.column_index) == (3, 0))
