"""An E-stop with the boring bar in its bore: no start leads through the wall, and the way out is offered."""

from __future__ import annotations

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.test_interrupted import twists_the_estop_out
from tests.texts import shows

BORE = (
    "G90G94F300G73\nT1\nX.9Z-.3\nX.9Z.2\nT3\nX0Z.2\nM03S900\nG95F.02Z-1\nG94F300Z.2\n"
    "T2\nX.3Z.2\nG95F.01Z-.8\nX.28\nG94F300Z.2\nX.4\nG95F.003Z-.8\nX.38\nG94F300Z.2\nX2Z2\nM30\n"
)
TOOLS = {1: (-0.5, -2.0), 2: (-0.5, -2.0), 3: (-0.5, -2.0)}
DEEP = (-2.0 - 0.4) * 25.4  # machine Z in the bore, line 16
CLEAR = -2.0 * 25.4  # machine Z before the face


def stops_in_the_bore(operator: Operator) -> None:
    operator.drives_on()
    operator.starts()
    operator.lets_it_run(
        lambda: operator.machine["line"] == 16 and operator.slides[1] < DEEP, "the bore", until_line=16
    )
    operator.key("e")
    operator.reaches("E-STOP")
    twists_the_estop_out(operator)
    operator.drives_on()


def test_start_through_bore_wall_is_blocked_after_estop_in_bore(story: Story) -> None:
    operator = story.begins(BORE, tools=TOOLS)
    stops_in_the_bore(operator)
    stands = operator.rests()
    operator.key("y")
    operator.during(1.5)
    operator.cycle_start()
    operator.keeps(lambda: operator.is_at(stands) and operator.state == "READY", 1.0, "nothing begins")
    assert operator.machine["start_code"] == "first-move-crosses"


def test_line_1_starts_after_retract_from_bore(story: Story) -> None:
    operator = story.begins(BORE, tools=TOOLS)
    stops_in_the_bore(operator)
    operator.key("F6")
    operator.key("F4")
    operator.until(lambda: "F10" in operator.prompt, "the way out is shown")
    operator.key("F10")
    operator.until(lambda: shows(operator.prompt, "search.start-way-out"), "the way out is confirmed")
    operator.cycle_start()
    operator.until(lambda: operator.slides[1] > CLEAR and operator.state == "READY", "out of the bore")
    operator.key("Escape")
    operator.until(lambda: shows(operator.prompt, "desk.was-interrupted"), "the start is offered again")
    operator.key("y")
    operator.during(1.5)
    operator.cycle_start()
    operator.until(lambda: operator.state == "RUNNING", "line 1 is begun")
