"""The part view with real keys: a slip is seen before anything moves, and the part follows the run."""

from __future__ import annotations

from tests.stories.conftest import Story
from tests.texts import opening, text

SHAFT = "G90G94F100\nM03S1500\nT1\nX.6Z.05\nX.4\nG95F.008Z-.5\nX.45Z-.6\nX.55\nG94F100Z.05\nM30\n"
SLIP = SHAFT.replace("M30", "X.3\nG00Z-.3\nX.55\nM30")
TOOLS = {1: (-0.5, -2.0)}


def test_g00_left_active_by_mistake_is_shown_before_any_motion(story: Story) -> None:
    operator = story.begins(SLIP, tools=TOOLS)
    operator.find("remaining", on="PathView")
    operator.key("v")
    operator.find(text("screen.line-what", line=11, what=opening("desk.rapid-into-stock")), on="PathView")
    operator.keys("j", "j", "j", "j", "j", "j", "j", "j", "j")  # back before its first move
    operator.find("PART  ·  ", on="PathView")
    slides = operator.slides[:2]
    operator.key("k")
    operator.find(text("screen.line-what", line=11, what=opening("desk.rapid-into-stock")), on="PathView")
    assert operator.slides[:2] == slides
    assert operator.state == "DRIVES OFF"


def test_part_view_follows_run_and_remains_after_its_end(story: Story) -> None:
    operator = story.begins(SHAFT, tools=TOOLS)
    operator.drives_on()
    operator.find("remaining", on="PathView")
    operator.key("v")
    operator.find("PART  ·  T1", on="PathView")
    operator.starts()
    operator.find("LINE 4", on="PathView")
    operator.find("LINE 6", on="PathView")
    operator.key("j")  # the run leads: a key of the time line changes nothing
    operator.find("LINE 8", on="PathView")
    operator.reaches("READY")
    operator.find("LINE 9", on="PathView")
    operator.keys("v", "v", "v")
    operator.find("remaining", on="PathView")
