"""To look at a program is no job: what is on the desk changes by a deliberate act."""

from __future__ import annotations

from tests.stories.conftest import Story
from tests.texts import text

PART = "G90G94F300\nT1\nX2Z2\nM30\n"
TOOLS = {1: (-0.5, -2.0)}


def test_viewing_program_in_list_leaves_loaded_job_unchanged(story: Story) -> None:
    (story.home / "programs").mkdir(parents=True)
    (story.home / "programs" / "other.nc").write_text("G90G94F300\nT1\nX1Z1\nM30\n")
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.sees(text("screen.to-start"))
    operator.keys("F1", "F6")
    operator.opens("PROGRAMS")
    operator.writes("other")
    operator.key("F3")
    operator.opens("EDITOR")
    operator.sees("X1Z1")
    operator.key("F1")
    operator.opens("MAIN MENU")
    operator.sees(text("editor.only-looked-at", name="other.nc", other="part.nc"))
    operator.key("F2")
    operator.starts()
    operator.reaches("READY")
    assert operator.slides[:2] == [round((2 - 0.5) * 25.4, 4), 0.0]
    assert operator.events("load") == ["part.nc"]
    operator.until(lambda: operator.status["program"] == "part.nc", "status.json")


def test_edit_without_marked_program_asks_for_name_and_creates_no_job(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.keys("F1", "F6")
    operator.opens("PROGRAMS")
    operator.writes("zzzz")
    operator.key("F10")
    operator.sees(text("screen.no-program-marked"))
    assert operator.page == "PROGRAMS"
    operator.key("F3")
    operator.opens("EDITOR")
    operator.sees(text("screen.new-file"))
    operator.key("Escape")
    assert not list(story.home.rglob("zzzz*"))
