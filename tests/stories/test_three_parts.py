"""From the first start of an empty control to the third part: by keyboard, by mouse, by touch."""

from __future__ import annotations

import pytest

from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import text

PART = "(THREE OF THESE)\nG90G94T1\nM03S600\nM08\nG01X.2Z-.2F30\nX0Z0\nM09\nM05\nM30\n"


def on_the_shelf(story: Story) -> None:
    """A program that somebody has put into the folder, and nothing else: no offset was ever set."""
    programs = story.home / "programs"
    programs.mkdir(parents=True)
    (programs / "again.nc").write_text(PART)


def made(operator: Operator, parts: int) -> None:
    """So many parts, and everybody says so."""
    operator.lets_it_run(lambda: operator.machine["parts"] == parts, f"part {parts}")
    operator.reaches("READY")
    operator.until(lambda: operator.is_at((0.0, -INCH)), "the tip of T1 at X0 Z0")
    operator.until(lambda: operator.status["parts"] == parts, "status.json")
    operator.until(lambda: len(operator.events("part")) == parts, "the store's log")


def parts_in_the_store(operator: Operator) -> int:
    """Return how many parts the store has counted."""
    with operator.store() as store:
        return store.runs.read_part_count("again.nc")


def at_the_end(operator: Operator) -> None:
    """Screen, status file, store and slides tell the same."""
    made(operator, 3)
    assert operator.status["execution"] == "PROGRAM_COMPLETED"
    assert operator.status["program"] == "again.nc"
    assert operator.machine["outputs"] == ["collet"]
    operator.until(lambda: operator.machine["rpm"] == 0, "the spindle at rest")
    operator.until(lambda: parts_in_the_store(operator) == 3, "the store")
    with operator.store() as store:
        assert store.offsets.tool_offsets.read_rows()[1].offset == (
            pytest.approx(0.0),
            pytest.approx(-1.0 * INCH),
        )
    operator.sees(text("screen.to-start"))


def test_three_parts_are_made_by_keyboard(story: Story) -> None:
    on_the_shelf(story)
    operator = story.begins()
    operator.drives_on()
    operator.key("F8")
    operator.opens("TOOL OFFSETS")
    for value in ("0", "-1"):
        operator.writes(value)
        operator.key("Return")
        operator.during(0.2)
    operator.until(lambda: tool_set(operator), "T1 kept")
    operator.key("Escape")
    operator.opens("AUTOMATIC")
    operator.key("F2")
    operator.sees(text("screen.file-to-be-processed"))
    operator.writes("again")
    operator.key("Return")
    for part in (1, 2, 3):
        operator.starts()
        made(operator, part)
    at_the_end(operator)


def tool_set(operator: Operator) -> bool:
    """Whether T1 is in the store."""
    with operator.store() as store:
        return (
            1 in store.offsets.tool_offsets.read_rows()
            and store.offsets.tool_offsets.read_rows()[1].offset[1] != 0.0
        )


def mouse_and_key(operator: Operator) -> None:
    """One mouse has no two palms: the other hand is on the keyboard."""
    operator.points("F11", on="StationDock")
    operator.server.button("left", down=True)
    operator.down("F12")
    operator.during(0.5)
    operator.up("F12")
    operator.server.button("left", down=False)


def test_three_parts_are_made_by_mouse(story: Story) -> None:
    on_the_shelf(story)
    operator = story.begins()
    operator.reaches("DRIVES OFF")
    operator.clicks("D", on="LampStrip")
    operator.reaches("READY")
    operator.clicks("TOOLS", on="FunctionKeyBar")
    operator.opens("TOOL OFFSETS")
    operator.clicks("T1  X R?", on="EntryPanel")  # the pad of figures comes
    for keys in (("0",), ("−", "1")):
        for key in keys:
            operator.clicks(key, on="NumberPad")
        operator.clicks("ENTER", on="NumberPad")
        operator.during(0.2)
    operator.until(lambda: tool_set(operator), "T1 kept")
    operator.clicks("MENU", on="FunctionKeyBar")
    operator.opens("MAIN MENU")
    operator.clicks("AUTO", on="FunctionKeyBar")
    operator.opens("AUTOMATIC")
    operator.clicks("FILE", on="FunctionKeyBar")
    operator.clicks("again.nc", on="FilePrompt")
    for part in (1, 2, 3):
        operator.starts(lambda: mouse_and_key(operator))
        made(operator, part)
    at_the_end(operator)


def test_three_parts_are_made_by_touch(story: Story) -> None:
    on_the_shelf(story)
    operator = story.begins()
    operator.reaches("DRIVES OFF")
    operator.touches("D", on="LampStrip")
    operator.reaches("READY")
    operator.touches("TOOLS", on="FunctionKeyBar")
    operator.opens("TOOL OFFSETS")
    operator.touches("T1  X R?", on="EntryPanel")
    for keys in (("0",), ("−", "1")):
        for key in keys:
            operator.touches(key, on="NumberPad")
        operator.touches("ENTER", on="NumberPad")
        operator.during(0.2)
    operator.until(lambda: tool_set(operator), "T1 kept")
    operator.touches("MENU", on="FunctionKeyBar")
    operator.opens("MAIN MENU")
    operator.touches("AUTO", on="FunctionKeyBar")
    operator.opens("AUTOMATIC")
    operator.touches("FILE", on="FunctionKeyBar")
    operator.touches("again.nc", on="FilePrompt")
    for part in (1, 2, 3):
        operator.starts(lambda: operator.touches("F11", "F12", on="StationDock"))
        made(operator, part)
    at_the_end(operator)
