"""A program of shapes, and one of a drawing: nothing is written, in any of the three ways."""

from __future__ import annotations

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.ways_of_input import PANEL, WAYS, Hand
from tests.texts import fragment
from tests.texts import text as wording

LIST = "SHAPES  ·  IN THIS PROGRAM, BY LINE"
NECK, PIN = "M60 0 V10 H40 V15 H20 V0", "M120 0 V12 H100 V0"  # 30 mm across; 24 across
DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="140mm" height="40mm" viewBox="0 0 140 40">'
    f'<path d="{NECK}" fill="none" stroke="black"/><path d="{PIN}" fill="none" stroke="black"/></svg>'
)

every_way = pytest.mark.parametrize("way", WAYS)
on_the_smallest = pytest.mark.parametrize("story", [PANEL], indirect=True, ids=["1024x600"])


def kept(story: Story, operator: Operator, name: str) -> list[str]:
    """The lines of a program in the folder, once it is saved."""
    path = story.home / "programs" / name
    operator.until(path.exists, f"{name} saved")
    return path.read_text().splitlines()


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
        hand.press("NAME TO FIND OR CREATE", "SheetPanel")
    hand.types("zq", "LetterPad")
    operator.sees(fragment("programs.none-of-that-name"))
    hand.function("F3", "EDIT")
    hand.function("F1", "CREATE")
    operator.sees(fragment("editor.saves-and-loads"))
    hand.shapes()
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
    hand.shapes()
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


@on_the_smallest
@every_way
def test_a_program_is_made_of_a_drawing(story: Story, way: str) -> None:
    """Of two contours the second is the part: picked on the drawing by pointer and finger."""
    folder = story.home / "programs"
    folder.mkdir(parents=True)
    (folder / "axle.svg").write_text(DRAWING)
    operator = story.begins()
    hand = Hand(operator, way)
    hand.function("F1", "MENU")
    if way == "keys":
        operator.key("F6")
    else:
        hand.press("PROGRAMS", "_Tiles")
    operator.opens("PROGRAMS")
    operator.sees("axle.svg")
    if way == "keys":
        operator.writes("axle")
        operator.until(lambda: not operator.shows("bushing.nc"), "axle.svg alone")
    else:
        hand.press("axle.svg", "SheetPanel")
    hand.function("F3", "EDIT")
    hand.function("F1", "CREATE")
    operator.sees(fragment("stories.left-and-right"))
    if way == "keys":
        operator.keys("Down", "Down", "Right")
    else:
        hand.press("2", "SketchPanel")
    operator.sees("◂ 2 ▸")
    operator.sees(fragment("stories.left-and-right"))
    hand.function("F2", "WRITE")
    operator.sees(LIST)
    hand.function("F10", "BACK")
    hand.function("F3", "SAV+LOAD")
    operator.opens("AUTOMATIC")
    lines = kept(story, operator, "axle.nc")
    assert lines[-1] == "M30"
    text = "".join(lines)
    assert "X.9449" in text  # 24 / 25.4
    assert "X1.1811" not in text  # 30 / 25.4 is the other one's
