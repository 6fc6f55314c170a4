"""A field that has the keyboard has all of it, but for hold and E-stop."""

from __future__ import annotations

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.texts import text

PART = "G90G94T1\nM03S600\nG01X.5Z.5F5\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}
LETTERS = "+-,.sopcrdatugymvz/ he"
UNMOVED = ("feed_override", "single_block", "state", "outputs", "spindle_auto", "switches")


def leaks(operator: Operator, before: dict[str, object]) -> list[str]:
    """What was changed by typing."""
    return [name for name in UNMOVED if operator.machine.get(name) != before.get(name)]


@pytest.mark.parametrize("drives", [False, True])
def test_every_character_can_be_typed_in_mdi(story: Story, drives: bool) -> None:
    operator = story.begins(PART, tools=TOOLS)
    if drives:
        operator.drives_on()
    operator.reaches("READY" if drives else "DRIVES OFF")
    operator.keys("F1", "F4")
    operator.opens("MDI")
    before = dict(operator.machine)
    operator.writes(LETTERS)
    operator.sees(LETTERS)
    operator.during(1.2)  # a pot turns no faster than a hand
    assert leaks(operator, before) == []
    if not drives:
        operator.key("F5")
        operator.reaches("READY")


def test_every_character_can_be_typed_in_mdi_after_estop(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.reaches("DRIVES OFF")
    operator.keys("F1", "F4")
    operator.opens("MDI")
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")
    before = dict(operator.machine)
    operator.writes(LETTERS)
    operator.sees(LETTERS)
    operator.during(1.2)
    assert leaks(operator, before) == []


PLACES = {
    "the question for a file": ("F2",),
    "tool offsets": ("F8",),
    "secondary offsets": ("F9",),
    "zero offsets": ("F1", "g"),
    "the list of programs": ("F1", "F6"),
    "SEARCHTO": ("F6",),
    "the editor": ("F3",),
    "find in the editor": ("F3", "F4"),
    "the speed limit": ("F10", "1", "Return"),
    "the parts counter": ("F10", "2", "Return"),
    "a tool's number": ("F1", "F5", "t"),
}


@pytest.mark.parametrize("place", list(PLACES))
def test_characters_typed_in_a_field_trigger_no_command(story: Story, place: str) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.until(lambda: text("screen.to-start") in operator.prompt, "ready to start")
    for key in PLACES[place]:
        operator.key(key)
        operator.during(0.3)
    before = dict(operator.machine)
    theme = operator.glance["theme"]
    figures_only = place not in {
        "the question for a file",
        "the list of programs",
        "SEARCHTO",
        "the editor",
        "find in the editor",
    }
    operator.writes(LETTERS.replace("e", "").replace("h", "").replace(" ", "") if figures_only else LETTERS)
    operator.during(1.2)
    assert leaks(operator, before) == []
    assert operator.glance["theme"] == theme
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_on_screen_keyboard_types_and_stop_keys_still_act(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.keys("F1", "F4")
    operator.opens("MDI")
    operator.clicks("LINE", on="MdiLinePanel")
    for letter in ("H", "E", "S", "+"):
        operator.clicks(letter, on="LetterPad")
    operator.sees("HES+")
    assert operator.state == "READY"
    assert operator.machine["single_block"] is False
    operator.key("Pause", "ctrl")
    operator.key("Scroll_Lock", "alt")
    operator.reaches("E-STOP")
