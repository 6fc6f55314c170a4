"""A program of a drawing: nothing is written, in any of the three ways."""

from __future__ import annotations

from tests.extras.shapes.stories.test_programs_without_writing import LIST, every_way, kept, on_the_smallest
from tests.stories.conftest import Story
from tests.stories.ways_of_input import Hand
from tests.texts import fragment

NECK, PIN = "M60 0 V10 H40 V15 H20 V0", "M120 0 V12 H100 V0"  # 30 mm across; 24 across
DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="140mm" height="40mm" viewBox="0 0 140 40">'
    f'<path d="{NECK}" fill="none" stroke="black"/><path d="{PIN}" fill="none" stroke="black"/></svg>'
)


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
        hand.press("PROGRAMS", "_MenuTiles")
    operator.opens("PROGRAMS")
    operator.sees("axle.svg")
    if way == "keys":
        operator.writes("axle")
        operator.until(lambda: not operator.shows("bushing.nc"), "axle.svg alone")
    else:
        hand.press("axle.svg", "TablePanel")
    hand.function("F3", "EDIT")
    hand.function("F1", "CREATE")
    operator.sees(fragment("shapes.left-and-right"))
    if way == "keys":
        operator.keys("Down", "Down", "Right")
    else:
        hand.press("2", "SketchPanel")
    operator.sees("◂ 2 ▸")
    operator.sees(fragment("shapes.left-and-right"))
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
