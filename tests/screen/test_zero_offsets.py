"""G54 to G59 by keys alone: entered, refused, undone, cleared, looked back at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.offsets.cell_table_view import ZeroOffsetsPage
from app.screen import page_table
from core.executor.snapshot import MachineState
from core.store.store import Store
from core.store.store_rows import ZeroOffsetRow
from tests.offset_store import use_store
from tests.screen.hands import Hands, Key
from tests.screen.yes import yes
from tests.texts import begins
from tests.texts import text as wording


@pytest.fixture
def store(hands: Hands, tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path / "home") as store:
        use_store(hands.desk, store)
        yield store


def opened(hands: Hands) -> ZeroOffsetsPage:
    """From the main menu."""
    hands.key(Key.Key_F1)
    hands.key(Key.Key_G)
    page = hands.frame.current_page
    assert isinstance(page, ZeroOffsetsPage)
    assert hands.frame.title_line.page_title == page_table.ZERO
    return page


def enter(hands: Hands, text: str) -> None:
    hands.type(text)
    hands.key(Key.Key_Return)


def test_values_are_overwritten_and_saved(hands: Hands, store: Store) -> None:
    page = opened(hands)
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == f"G54  {wording('screen.x-radius')}")
    enter(hands, "1.5-.25")
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(x=1.25)})
    hands.sees(lambda: hands.prompt() == wording("screen.saved", names="G54"))
    hands.key(Key.Key_Tab)
    hands.key(Key.Key_Tab)
    hands.sees(lambda: page.entry_panel.entry_texts.question_text == f"G54  {wording('screen.c-degrees')}")
    hands.type("-15")
    hands.sees(lambda: page.entry_panel.entry_texts.change_description == "G54 C   +0.000  →  −15.000")
    hands.key(Key.Key_Return)
    hands.sees(lambda: page.content_panel.stored_rows == {54: ZeroOffsetRow(x=1.25, c=-15.0)})
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Left)
    enter(hands, "33")
    hands.sees(lambda: store.offsets.zero_offsets.read_rows().get(55) == ZeroOffsetRow(z=33.0))


def test_rejected_entry_is_explained_and_remains_for_correction(hands: Hands, store: Store) -> None:
    page = opened(hands)
    enter(hands, "9999")
    assert hands.prompt() == wording(
        "screen.refused",
        why=wording(
            "screen.out-of-range", field="G54 X", value="+9999.000", unit="mm", low="-5000", high=5000
        ),
    )
    assert page.model.text == "9999"
    hands.key(Key.Key_Delete)
    enter(hands, "2+")
    assert begins(hands.prompt(), "screen.refused")
    assert store.offsets.zero_offsets.read_rows() == {}


def test_return_without_entry_moves_on_and_changes_nothing(hands: Hands, store: Store) -> None:
    page = opened(hands)
    for _ in range(18):
        hands.key(Key.Key_Return)
    assert (page.model.row_index, page.model.column_index) == (0, 0)
    assert store.offsets.zero_offsets.read_history() == ()


def test_offset_is_cleared_restored_by_undo_and_listed_in_history(hands: Hands, store: Store) -> None:
    page = opened(hands)
    enter(hands, "7")
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(x=7.0)})
    hands.sees(lambda: hands.prompt() == wording("screen.saved", names="G54"))
    hands.key(Key.Key_C)
    assert begins(hands.prompt(), "screen.clear-zero")
    yes(hands.window)
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {})
    hands.sees(lambda: not page.model.offset_book.is_saving and page.content_panel.stored_rows == {})
    hands.key(Key.Key_F4)
    yes(hands.window)
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(x=7.0)})
    hands.sees(lambda: hands.prompt() == wording("screen.taken-back", names="G54"))
    hands.key(Key.Key_F5)
    hands.sees(page.history_list.isVisible)
    assert [entry[1] for entry in page.history_list.history_entries] == ["G54", "G54", "G54"]
    assert page.history_list.history_entries[-1][2] == "not set  →  X +7.000  Z +0.000  C +0.000"
    hands.key(Key.Key_Escape)
    hands.sees(page.content_panel.isVisible)


def test_zero_offset_cannot_be_changed_while_program_runs(hands: Hands, store: Store) -> None:
    opened(hands)
    hands.machine.now = replace(hands.machine.now, state=MachineState.RUN)
    hands.sees(lambda: hands.prompt() == wording("screen.program-runs-no-zero"))
    enter(hands, "3")
    hands.key(Key.Key_F4)
    hands.key(Key.Key_C)
    hands.key(Key.Key_C)
    assert store.offsets.zero_offsets.read_history() == ()


def test_esc_first_cancels_entry_and_then_leaves_page(hands: Hands, store: Store) -> None:
    page = opened(hands)
    hands.type("12")
    hands.key(Key.Key_Escape)
    assert page.model.text == ""
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is hands.page
    assert store.offsets.zero_offsets.read_rows() == {}


def test_page_opens_from_other_offset_tables_and_returns(hands: Hands, store: Store) -> None:
    assert store.offsets.zero_offsets.read_rows() == {}
    hands.key(Key.Key_F8)
    hands.key(Key.Key_F10)
    assert isinstance(hands.frame.current_page, ZeroOffsetsPage)
    hands.key(Key.Key_F9)
    assert hands.frame.title_line.page_title == page_table.SECCMP


def test_change_without_store_shows_reason(hands: Hands) -> None:
    page = opened(hands)
    enter(hands, "3")
    hands.sees(lambda: hands.prompt() == wording("screen.no-offsets-kept"))
    assert page.content_panel.stored_rows == {}


def test_program_is_reloaded_when_offset_changes(hands: Hands, store: Store) -> None:
    hands.load("bushing")
    before = hands.desk.program_loader.loaded_program
    opened(hands)
    enter(hands, "4")
    hands.sees(
        lambda: (
            store.offsets.zero_offsets.read_rows() != {}
            and hands.desk.program_loader.loaded_program.job is not before.job
        )
    )


def test_zero_is_set_so_that_current_position_reads_typed_value(hands: Hands, store: Store) -> None:
    """At machine Z -83.5 the face is touched with 1.5 to come off: Z 1.5 lies there, so zero is at -85."""
    page = opened(hands)
    hands.machine.now = replace(hands.machine.now, actual=(12.0, -83.5, 735.0))
    hands.key(Key.Key_Tab)
    hands.type("1.5")
    hands.key(Key.Key_F2)
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(z=-85.0)})
    hands.sees(lambda: hands.prompt() == wording("screen.saved", names="G54"))
    hands.key(Key.Key_Tab)
    hands.key(Key.Key_F2)
    hands.sees(lambda: store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(z=-85.0, c=15.0)})
    assert store.offsets.zero_offsets.read_history()[1].why == "Z position set to 1.5"
    assert page.model.text == ""


def test_zero_cannot_be_set_from_unhomed_axis(hands: Hands, store: Store) -> None:
    opened(hands)
    hands.machine.now = replace(hands.machine.now, homed=(False, True, True))
    hands.key(Key.Key_F2)
    assert hands.prompt() == wording("screen.position-unknown", axis="X")
    assert store.offsets.zero_offsets.read_history() == ()
