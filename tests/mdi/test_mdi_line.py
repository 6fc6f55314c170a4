"""The line of MDI and its history, key by key."""

from __future__ import annotations

from collections.abc import Iterable

from app.desk.persistence import Persistence
from app.mdi.mdi_model import HISTORY_SETTING, MAX_HISTORY_LINES, MAX_LINE_LENGTH, MdiInput
from core.store.store_errors import StoreError


def press(typing: MdiInput, keys: Iterable[str]) -> MdiInput:
    for key in keys:
        assert typing.handle_key(key)
    return typing


def test_characters_are_inserted_and_deleted_at_cursor() -> None:
    typing = press(MdiInput(), ["X", "5", "Left", ".", "Right", "0"])
    assert (typing.text, typing.cursor_index) == ("X.50", 4)
    press(typing, ["Back", "Left", "Left", "Delete"])
    assert (typing.text, typing.cursor_index) == ("X5", 1)
    press(typing, ["Left", "Left", "Back"])  # nothing is before the first character
    assert (typing.text, typing.cursor_index) == ("X5", 0)


def test_line_length_is_limited_to_screen_width() -> None:
    assert len(press(MdiInput(), ["X"] * (MAX_LINE_LENGTH + 5)).text) == MAX_LINE_LENGTH


def test_unused_keys_are_not_handled() -> None:
    typing = MdiInput()
    assert not typing.handle_key("Tab")
    assert not typing.handle_key("F5")
    assert typing.text == ""


def test_history_recalls_lines_and_unfinished_line() -> None:
    typing = MdiInput()
    for line in ("G90", "X1", "X2"):
        typing.set_text(line)
        typing.store_started_line()
    press(typing, ["Z", "Up", "Up"])
    assert (typing.text, typing.recall_index) == ("X1", 2)
    press(typing, ["Up", "Up", "Up"])  # the oldest is the end
    assert (typing.text, typing.recall_index) == ("G90", 3)
    press(typing, ["Down", "Down", "Down", "Down"])
    assert (typing.text, typing.recall_index) == ("Z", 0)


def test_repeated_line_is_stored_once_and_empty_line_never() -> None:
    typing = MdiInput()
    for line in ("X1", "X1", "  ", "X2"):
        typing.set_text(line)
        typing.store_started_line()
    assert typing.history_lines == ["X1", "X2"]


def test_history_is_stored_and_invalid_entries_are_dropped() -> None:
    keep = Persistence()
    typing = MdiInput(keep)
    for number in range(MAX_HISTORY_LINES + 3):
        typing.set_text(f"X{number}")
        typing.store_started_line()
    again = MdiInput(keep)
    assert (len(again.history_lines), again.history_lines[0], again.history_lines[-1]) == (
        MAX_HISTORY_LINES,
        "X3",
        f"X{MAX_HISTORY_LINES + 2}",
    )
    keep.save_setting(HISTORY_SETTING, {"X": 1})
    assert MdiInput(keep).history_lines == []
    keep.save_setting(HISTORY_SETTING, ["X1", 7])
    assert MdiInput(keep).history_lines == ["X1"]


def test_failed_store_does_not_lose_history() -> None:
    class Broken(Persistence):
        def setting(self, key: str) -> object:
            raise StoreError(f"{key} is gone")

        def save_setting(self, key: str, value: object) -> None:
            raise StoreError(f"{key} cannot take {value}")

    typing = MdiInput(Broken())
    typing.set_text("X1")
    typing.store_started_line()
    assert typing.history_lines == ["X1"]


def test_rejected_line_stays_in_history_with_error_position() -> None:
    typing = MdiInput()
    press(typing, "G01X")
    typing.add_rejected_line(4)
    assert (typing.history_lines, typing.error_columns_by_line) == (["G01X"], {"G01X": 4})
    assert typing.text == "G01X"  # to be mended where it stands
    press(typing, "1")
    typing.store_started_line()
    assert typing.history_lines == ["G01X", "G01X1"]
    assert "G01X1" not in typing.error_columns_by_line
    press(typing, "G01X")
    # what was wrong with it has been put right elsewhere, such as a tool that was never set
    typing.store_started_line()
    assert not typing.error_columns_by_line
