"""What stopped does not turn by itself: switch, pot and single block, with the machine's own word for it."""

from __future__ import annotations

from functools import partial

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.texts import text as wording

CUT = "G90G94T1\nM03S600\nG01X1.Z1.F60\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}
SAID = wording("screen.spindle-starts", rpm=600, direction="FORWARD")


def turns(operator: Operator) -> bool:
    return bool(abs(operator.machine["turning"]) > 0)


def held_in_the_cut(story: Story) -> Operator:
    operator = story.begins(CUT, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: operator.machine["turning"] == 600, "the spindle")
    operator.until(lambda: abs(operator.slides[1]) > 1.0, "the cut")
    operator.key("h")
    operator.reaches("FEED HOLD")
    operator.rests()
    return operator


def finished(operator: Operator) -> None:
    """To the end, and screen, status, store and slides agree."""
    operator.reaches("READY")
    operator.until(lambda: operator.is_at((0.0, 0.0)), "the end of the program")
    operator.until(lambda: operator.status.get("parts") == 1, operator.status)
    operator.until(lambda: len(operator.events("part")) == 1, "the part in the store's log")


def test_spindle_auto_in_feed_hold_waits_for_cycle_start(story: Story) -> None:
    operator = held_in_the_cut(story)
    operator.key("a")
    operator.until(lambda: not turns(operator), "at rest")
    operator.key("a")
    operator.until(lambda: SAID in operator.prompt, "the announcement")
    operator.keeps(lambda: not turns(operator), 1.5, "the spindle is stopped")
    stood = operator.rests()
    assert operator.slides == stood
    operator.cycle_start()
    operator.until(lambda: operator.machine["turning"] == 600, "the spindle")
    finished(operator)


def ended_at(operator: Operator, line: int) -> bool:
    return (operator.state, operator.machine["line"]) == ("SINGLE BLOCK", line)


def test_single_block_steps_through_every_block(story: Story) -> None:
    operator = story.begins("G90G94T1\nG00X.3Z.3\nX.3\nX.3\nG01X.4F20\nX0Z0\nM30\n", tools=TOOLS)
    operator.drives_on()
    operator.key("s")
    operator.until(lambda: wording("screen.to-start") in operator.prompt, "ready to start")
    operator.cycle_start()
    for line in range(1, 7):  # T1 is a step of its own
        operator.until(partial(ended_at, operator, line), f"line {line}")
        operator.during(0.5)
        operator.cycle_start()
    operator.reaches("READY")


def test_computer_stall_in_cut_causes_hold_and_cycle_start_resumes(story: Story) -> None:
    operator = story.begins(CUT.replace("F60", "F20"), tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: abs(operator.slides[1]) > 1.0, "the cut")
    operator.stops_the_process()
    operator.during(3.0)
    operator.lets_it_go_on()
    operator.reaches("FEED HOLD")
    stood = operator.rests()
    operator.keeps(lambda: operator.slides == stood, 1.0, "at rest")
    operator.during(0.5)
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")
    operator.key("h")
    operator.reaches("FEED HOLD")


def test_opened_guard_holds_and_cycle_start_is_needed_after_closing(story: Story) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    operator.ask("break", name="set_input", values=["guard", False])
    operator.drives_on()
    operator.cycle_start()
    operator.until(lambda: "guard" in operator.machine["refused"], "refused with its reason")
    operator.ask("break", name="set_input", values=["guard", True])
    operator.during(0.5)
    operator.starts()
    operator.until(lambda: operator.machine["turning"] == 600, "the spindle")
    operator.until(lambda: abs(operator.slides[1]) > 1.0, "the cut")
    operator.ask("break", name="set_input", values=["guard", False])
    operator.reaches("FEED HOLD")
    operator.until(lambda: not turns(operator), "at rest")
    stood = operator.rests()
    operator.ask("break", name="set_input", values=["guard", True])
    operator.until(lambda: SAID in operator.prompt, "the announcement")
    operator.keeps(lambda: not turns(operator), 1.5, "the spindle is stopped")
    assert operator.slides == stood
    operator.cycle_start()
    operator.until(lambda: operator.machine["turning"] == 600, "the spindle")
    finished(operator)
    assert any("604" in text for text in operator.events("stop"))
