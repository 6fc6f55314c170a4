"""The spindle's pot, switch and load in a thread pass; a prove-out that begins where the machine stands."""

from __future__ import annotations

from functools import partial

import pytest

from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import fragment, shows
from tests.texts import text as wording

TOOLS = {4: (0.0, 0.0)}
# Two passes of 20 turns, .025 in a side: X.262 is where they pull out to.
THREAD = "G90G94F300G73\nM03S300\nT4\nX.3Z.5\nX.237\nG33X.231Z-1.5I.025K.1P\nG00X.4\nM30\n"
OUT = (0.237 + 3 * 0.025) * INCH
POINTS = "G90G94F300\nX0Z0\nM03S1000\nX.5\nG01F20Z-.5\nX.7\nM30\n"


def cutting(operator: Operator, z: float) -> bool:
    """Whether the tool is in the thread, behind ``z`` inches."""
    x, at, *_ = operator.slides
    return bool(operator.machine["line"] == 6 and x < 0.24 * INCH and at < z * INCH)


def in_a_pass(story: Story) -> Operator:
    operator = story.begins(THREAD, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: cutting(operator, 0.0), "a thread pass")
    return operator


def test_thread_is_finished_after_pot_is_turned_to_half_in_a_pass(story: Story) -> None:
    operator = in_a_pass(story)
    operator.keys(*["comma"] * 5)
    operator.until(lambda: operator.machine["turning"] < 200, "a slower spindle")
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
    operator.reaches("READY")
    assert operator.machine["alarms"] == []
    assert operator.events("thread") == []
    assert operator.slides[0] == pytest.approx(0.4 * INCH, abs=0.01)
    operator.until(lambda: operator.status["execution"] == "PROGRAM_COMPLETED", "status.json")
    operator.until(lambda: len(operator.events("part")) == 1, "the part in the store")


@pytest.mark.parametrize("how", ["switch", "stall"])
def test_spindle_stop_in_a_pass_retracts_tool_from_thread(story: Story, how: str) -> None:
    operator = in_a_pass(story)
    if how == "switch":
        operator.key("a")
    else:
        operator.breaks("spindle_bog", 0.0)
    operator.reaches("ALARM")
    operator.sees(wording("stories.spindle-lost-in-thread").upper())
    operator.sees(fragment("executor.retracted-from-thread"))
    x, z, *_ = operator.rests()
    assert x == pytest.approx(OUT, abs=0.01)
    assert z < 0.0
    assert operator.machine["turning"] == 0 or operator.machine["rpm"] < 300
    operator.until(
        lambda: any(shows(text, "stories.left-thread") for text in operator.events("alarm")), "the log"
    )
    operator.until(lambda: "205" in str(operator.status), "status.json")


def stands_at(operator: Operator, line: int) -> bool:
    return bool(operator.machine["line"] == line)


def pressed(operator: Operator) -> None:
    """Both palms, when they are offered; what moves then may be over in a blink."""
    operator.until(lambda: "PALM" in operator.prompt, "the palms")
    operator.during(0.6)
    operator.cycle_start()


def test_program_from_current_position_runs_after_single_block(story: Story) -> None:
    """Two starts in single block, single block off, Cycle Start."""
    operator = story.begins(POINTS, tools=TOOLS)
    operator.drives_on()
    operator.key("s")
    operator.until(lambda: operator.machine["single_block"], "single block")
    for line in (2, 3):
        pressed(operator)
        operator.until(partial(stands_at, operator, line), "the next block")
        operator.reaches("SINGLE BLOCK")
        operator.during(0.5)
    operator.key("s")
    operator.until(lambda: not operator.machine["single_block"], "single block off")
    pressed(operator)
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
    operator.reaches("READY")
    assert operator.machine["alarms"] == []
    assert operator.is_at((0.7 * INCH, -0.5 * INCH))
    operator.until(lambda: operator.status["execution"] == "PROGRAM_COMPLETED", "status.json")
