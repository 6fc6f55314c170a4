"""A program of shapes: nothing is written, in any of the three ways."""

from __future__ import annotations

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.ways_of_input import PANEL, WAYS, Hand
from tests.stories.x11 import MODIFIERS
from tests.texts import fragment
from tests.texts import text as wording

LIST = "SHAPES  ·  IN THIS PROGRAM, BY LINE"

every_way = pytest.mark.parametrize("way", WAYS)
on_the_smallest = pytest.mark.parametrize("story", [PANEL], indirect=True, ids=["1024x600"])


def kept(story: Story, operator: Operator, name: str) -> list[str]:
    """The lines of a program in the folder, once it is saved."""
    path = story.home / "programs" / name
    operator.until(path.exists, f"{name} saved")
    return path.read_text().splitlines()


def to_shapes(hand: Hand) -> None:
    """From the text to the shapes; Shift is held until the key has come."""
    if not hand.by_keys:
        hand.press("SHAPES")
        return
    hand.operator.down(MODIFIERS["shift"])
    hand.operator.key("F3")
    hand.operator.up(MODIFIERS["shift"])


@on_the_smallest
@every_way
def test_a_program_is_made_of_shapes(story: Story, way: str) -> None:
    operator = story.begins()
    hand = Hand(operator, way)
    hand.function("F2", "FILE")
    operator.sees(wording("screen.file-to-be-processed"))
    hand.function("F2", "FILE")
    operator.opens("PROGRAMS")
    if way != "keys":
        hand.press("NAME TO FIND OR CREATE", "TablePanel")
    hand.types("zq", "LetterPad")
    operator.sees(fragment("programs.none-of-that-name"))
    hand.function("F3", "EDIT")
    hand.function("F1", "CREATE")
    operator.sees(fragment("editor.saves-and-loads"))
    to_shapes(hand)
    operator.sees(LIST)
    hand.row("N   HEAD", "the start of the program", "n")
    hand.function("F2", "WRITE")
    operator.sees(LIST)
    hand.row("F   FACE", "the end of the part faced square", "f")
    if way != "keys":
        hand.function("F9", "KEYPAD")
    hand.fill("START DIAMETER", ".55")
    hand.function("F2", "WRITE")
    operator.sees(LIST)
    hand.function("F10", "BACK")
    operator.sees(fragment("editor.saves-and-loads"))
    to_shapes(hand)
    operator.until(lambda: operator.shows("START DIAMETER") and operator.shows(".55"), "the form again")
    hand.function("F10", "BACK")
    hand.function("F3", "SAV+LOAD")
    operator.opens("AUTOMATIC")
    lines = kept(story, operator, "zq.nc")
    assert lines[0].startswith("G90G94F300G72(HEAD")
    assert lines[-1] == "M30"
    at = next(n for n, line in enumerate(lines) if "0P55" in line)
    assert "FACE" in lines[at]
    assert "X-.032" in "".join(lines[at:])  # past the centre by the nose, on the diameter: what is proposed
    operator.sees("zq.nc")
