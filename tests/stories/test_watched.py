"""What is late, jammed or broken is seen and told: a stalled control, a slide at rest, a thread that dies."""

from __future__ import annotations

import pytest

from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import fragment
from tests.texts import text as wording

DWELL = "G90G94T1\nM03S600\nM08\nG01X.05Z0F20\nG04F5\nX.1\nM30\n"
STOP = "G90G94T1\nM03S600\nM08\nG01X.05Z0F20\nM00\nX.1\nM30\n"
CUT = "G90G94T1\nM03S600\nM08\nG01X0Z-5.F10\nM30\n"
TOOLS = {1: (0.0, 0.0)}
FED = {"[machine]\n": "[machine]\nfeeder = true\n"}


def stalls(operator: Operator, seconds: float) -> None:
    """The whole process, as a computer that swaps."""
    operator.stops_the_process()
    operator.during(seconds)
    operator.lets_it_go_on()


def cutting(operator: Operator) -> None:
    operator.drives_on()
    operator.starts()
    operator.until(lambda: operator.slides[1] < -8.0, "a cut")
    assert operator.machine["lit"] == ["collet", "coolant"]


@pytest.mark.parametrize("text", [DWELL, STOP], ids=["in a dwell", "at M00"])
def test_stall_at_standstill_is_reported_and_blocks_unread_start(story: Story, text: str) -> None:
    operator = story.begins(text, tools=TOOLS, changes=FED, in_real_time=True)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: operator.is_at((0.05 * INCH, 0.0)) and operator.machine["rpm"] > 590, "standstill")
    operator.reaches("WAITING" if text is DWELL else "PROGRAM STOP")
    stalls(operator, 0.7)
    operator.until(lambda: operator.machine["outputs"] == ["collet"], "coolant off")
    operator.reaches("FEED HOLD" if text is DWELL else "PROGRAM STOP")
    operator.sees(wording("screen.spindle-starts", rpm=600, direction="FORWARD"))
    operator.sees(wording("screen.output-comes-on", output="COOLANT"))
    operator.until(lambda: operator.machine["rpm"] == 0, "a spindle that stands")
    operator.keeps(lambda: operator.is_at((0.05 * INCH, 0.0)), 1.0, "rest")
    operator.cycle_start()
    operator.until(lambda: operator.machine["outputs"] == ["collet", "coolant"], "coolant")
    operator.until(lambda: not operator.is_at((0.05 * INCH, 0.0)), "feeding")
    assert operator.machine["rpm"] > 500
    operator.reaches("READY")
    operator.until(lambda: operator.was_prompted(fragment("screen.not-counted")), "it is no part")
    assert operator.machine["parts"] == 0
    operator.until(lambda: len(operator.events("uncounted")) == 1, "told in the store")
    (said,) = operator.events("disturbed")
    assert "SWITCHED OFF: SPINDLE, COOLANT" in said
    operator.until(lambda: operator.status["parts"] == 0, "status.json")


def test_axis_jammed_off_its_position_raises_alarm_and_does_not_jump(story: Story) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    operator.drives_on()
    operator.during(0.5)
    operator.breaks("jam", "Z")
    operator.breaks("push", "Z", 1.9)
    operator.reaches("ALARM")
    operator.sees(wording("stories.axis-out-of-place").upper())
    operator.breaks("jam", "Z", False)
    operator.keeps(lambda: operator.is_at((0.0, 1.9)), 1.0, "no leap when it comes free")
    operator.until(lambda: operator.status["alarms"] != [], "status.json")
    operator.key("r")
    operator.reaches("DRIVES OFF")
    operator.key("d")
    operator.reaches("READY")
    operator.keeps(lambda: operator.is_at((0.0, 1.9)), 1.0, "no leap with the drives on")


def test_encoder_failure_at_start_of_hold_stops_machine(story: Story) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    cutting(operator)
    before = operator.breaks("encoder_stuck", "Z")[1]
    operator.key("Pause")
    operator.reaches("ALARM")
    operator.rests()
    assert abs(operator.slides[1] - before) < 10.0
    assert operator.machine["lit"] == ["collet"]
    operator.until(lambda: any(text.startswith(("116", "117", "102")) for text in operator.events("alarm")))


def test_axis_pushed_by_hand_with_drives_off_is_reported(story: Story) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    operator.reaches("DRIVES OFF")
    operator.during(1.0)
    operator.breaks("push", "X", 0.5)
    operator.sees(wording("stories.axis-moved-unasked").upper())


@pytest.mark.parametrize(
    ("port", "call"), [("io", "switch_to_safe_state"), ("axes", "stop"), ("spindle", "start_coasting")]
)
def test_estop_with_failing_driver_switches_off_other_outputs(story: Story, port: str, call: str) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    cutting(operator)
    operator.ask("spoil", port=port, call=call)
    operator.key("e", "shift")
    operator.reaches("E-STOP")
    operator.until(lambda: operator.machine["turning"] == 0, "a spindle that stands")
    operator.rests()
    assert operator.machine["lit"] == ["collet"]
    operator.sees(wording("stories.not-made-safe").upper())
    operator.sees(wording("stories.press-e-stop"))


def test_dead_control_thread_stops_machine_and_is_shown_on_screen(story: Story) -> None:
    operator = story.begins(CUT, tools=TOOLS)
    cutting(operator)
    operator.ask("kill")
    operator.sees(wording("stories.control-silent"))
    operator.sees(fragment("stories.control-does-not-answer"))
    operator.until(lambda: operator.machine["turning"] == 0, "a spindle that stands")
    operator.rests()
    assert operator.machine["lit"] == ["collet"]
    operator.until(lambda: any(text.startswith("908") for text in operator.events("alarm")), "in the store")
