"""The line of MDI and its history, key by key."""

from __future__ import annotations

from collections.abc import Iterable

from app.desk.persistence import Persistence
from app.mdi.mdi_model import KEPT, KEY, LONGEST, MdiLine
from core.store.store_errors import StoreError


def press(typing: MdiLine, keys: Iterable[str]) -> MdiLine:
    for key in keys:
        assert typing.type(key)
    return typing


def test_characters_go_in_at_the_cursor_and_are_taken_out_there() -> None:
    typing = press(MdiLine(), ["X", "5", "Left", ".", "Right", "0"])
    assert (typing.text, typing.at) == ("X.50", 4)
    press(typing, ["Back", "Left", "Left", "Delete"])
    assert (typing.text, typing.at) == ("X5", 1)
    press(typing, ["Left", "Left", "Back"])  # nothing is before the first character
    assert (typing.text, typing.at) == ("X5", 0)


def test_a_line_is_no_longer_than_the_screen_shows() -> None:
    assert len(press(MdiLine(), ["X"] * (LONGEST + 5)).text) == LONGEST


def test_keys_that_mean_nothing_here_are_left_alone() -> None:
    typing = MdiLine()
    assert not typing.type("Tab")
    assert not typing.type("F5")
    assert typing.text == ""


def test_history_brings_lines_back_and_the_unfinished_one_too() -> None:
    typing = MdiLine()
    for line in ("G90", "X1", "X2"):
        typing.put(line)
        typing.done()
    press(typing, ["Z", "Up", "Up"])
    assert (typing.text, typing.back) == ("X1", 2)
    press(typing, ["Up", "Up", "Up"])  # the oldest is the end
    assert (typing.text, typing.back) == ("G90", 3)
    press(typing, ["Down", "Down", "Down", "Down"])
    assert (typing.text, typing.back) == ("Z", 0)


def test_the_same_line_twice_is_kept_once_and_an_empty_one_never() -> None:
    typing = MdiLine()
    for line in ("X1", "X1", "  ", "X2"):
        typing.put(line)
        typing.done()
    assert typing.history == ["X1", "X2"]


def test_the_history_is_kept_and_what_is_none_is_forgotten() -> None:
    keep = Persistence()
    typing = MdiLine(keep)
    for number in range(KEPT + 3):
        typing.put(f"X{number}")
        typing.done()
    again = MdiLine(keep)
    assert (len(again.history), again.history[0], again.history[-1]) == (KEPT, "X3", f"X{KEPT + 2}")
    keep.save_setting(KEY, {"X": 1})
    assert MdiLine(keep).history == []
    keep.save_setting(KEY, ["X1", 7])
    assert MdiLine(keep).history == ["X1"]


def test_a_store_that_fails_takes_no_line_away() -> None:
    class Broken(Persistence):
        def setting(self, key: str) -> object:
            raise StoreError(f"{key} is gone")

        def save_setting(self, key: str, value: object) -> None:
            raise StoreError(f"{key} cannot take {value}")

    typing = MdiLine(Broken())
    typing.put("X1")
    typing.done()
    assert typing.history == ["X1"]


def test_a_refused_line_stays_in_the_history_with_its_place() -> None:
    typing = MdiLine()
    press(typing, "G01X")
    typing.refuse(4)
    assert (typing.history, typing.refused) == (["G01X"], {"G01X": 4})
    assert typing.text == "G01X"  # to be mended where it stands
    press(typing, "1")
    typing.done()
    assert typing.history == ["G01X", "G01X1"]
    assert "G01X1" not in typing.refused
    press(typing, "G01X")
    typing.done()  # what was wrong with it has been put right elsewhere, such as a tool that was never set
    assert not typing.refused
