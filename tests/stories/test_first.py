"""The harness itself: a part is made, held and stopped with real keys and with the mouse."""

from __future__ import annotations

from tests.stories.conftest import Story
from tests.texts import text

PART = "G90G94T1\nM03S600\nG01X.5Z.5F10\nX0Z0\nM30\n"
SHORT = PART.replace("X.5Z.5F10", "X.1Z.1F30")
TOOLS = {1: (0.0, 0.0)}


def test_part_is_made_by_keyboard(story: Story) -> None:
    operator = story.begins(SHORT, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
    operator.reaches("READY")
    operator.sees(text("screen.to-start"))
    assert operator.is_at((0.0, 0.0))
    operator.until(lambda: operator.status["execution"] == "PROGRAM_COMPLETED", "status.json")
    operator.until(lambda: len(operator.events("part")) == 1, "the part in the store")


def test_mouse_presses_feed_hold_and_estop(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: operator.slides[0] > 0.5, "a cut")
    operator.clicks("HOLD", on="StationDock")
    operator.reaches("FEED HOLD")
    operator.rests()
    operator.clicks("STOP", on="StationDock")
    operator.reaches("E-STOP")
    operator.sees("TWIST")
