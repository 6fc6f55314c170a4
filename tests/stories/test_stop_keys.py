"""Stop keys reach the control while Qt's thread is frozen, and only where TurnDesk has the keyboard.

In real time, because the control is a process of its own then.
"""

from __future__ import annotations

import pytest

from app.desk.stop_keys.stop_records import SOURCE_SCREEN
from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.test_stalls import frozen, ready
from tests.stories.x11 import another_client
from tests.texts import text

STOPS = [("Pause", "FEED HOLD"), ("Escape", "FEED HOLD"), ("Scroll_Lock", "E-STOP")]


def cutting(story: Story) -> Operator:
    operator = ready(story, in_real_time=True)
    operator.starts()
    operator.until(lambda: operator.slides[0] > 0.5, "a cut")
    return operator


@pytest.mark.parametrize(("key", "state"), STOPS)
def test_stop_key_acts_once_and_during_the_stall(story: Story, key: str, state: str) -> None:
    operator = cutting(story)
    stops = len(operator.events("stop", "alarm", "estop"))
    number = operator.freezes(3.0)
    operator.during(0.3)
    operator.once = True
    operator.key(key)
    operator.reaches(state)
    assert not operator.answered(number), "it acted only after the stall"
    operator.once = False
    operator.until(lambda: operator.answered(number), "the screen again")
    operator.keeps(lambda: operator.state == state, 1.0, state)
    operator.until(lambda: len(operator.events("stop", "alarm", "estop")) > stops, "its entry")
    assert len(operator.events("stop", "alarm", "estop")) == stops + 1
    assert operator.page == "AUTOMATIC"


@pytest.mark.parametrize("button", ["left", "right"])
@pytest.mark.parametrize(("label", "state"), [("STOP", "E-STOP"), ("PAUSE", "FEED HOLD")])
def test_click_on_drawn_stop_control_acts_once_and_during_the_stall(
    story: Story, label: str, state: str, button: str
) -> None:
    operator = cutting(story)
    stops = len(operator.events("stop", "alarm", "estop"))
    operator.points(label, on="StationDock")
    number = operator.freezes(3.0)
    operator.during(0.3)
    operator.server.button(button, down=True)
    operator.server.button(button, down=False)
    operator.reaches(state)
    assert not operator.answered(number), "it acted only after the stall"
    operator.until(lambda: operator.answered(number), "the screen again")
    operator.keeps(lambda: operator.state == state, 1.0, state)
    operator.until(lambda: len(operator.events("stop", "alarm", "estop")) > stops, "its entry")
    assert len(operator.events("stop", "alarm", "estop")) == stops + 1


@pytest.mark.parametrize(("key", "state"), [("h", "FEED HOLD"), ("space", "FEED HOLD"), ("e", "E-STOP")])
def test_letter_acts_during_the_stall_if_no_field_can_be_open(story: Story, key: str, state: str) -> None:
    operator = cutting(story)
    operator.during(0.5)
    stops = len(operator.events("stop", "alarm", "estop"))
    number = operator.freezes(3.0)
    operator.during(0.3)
    operator.once = True
    operator.key(key)
    operator.reaches(state)
    assert not operator.answered(number), "it acted only after the stall"
    operator.once = False
    operator.until(lambda: operator.answered(number), "the screen again")
    operator.keeps(lambda: operator.state == state, 1.0, state)
    operator.until(lambda: len(operator.events("stop", "alarm", "estop")) > stops, "its entry")
    # A frozen screen causes a feed hold too, after 3 s; that one names another cause.
    (entry,) = operator.events("stop", "alarm", "estop")[stops:]
    assert state == "E-STOP" or SOURCE_SCREEN in entry


def test_letters_for_field_that_opens_after_the_stall_are_text(story: Story) -> None:
    operator = ready(story, in_real_time=True)
    operator.key("s")
    operator.during(0.5)
    with frozen(operator):
        operator.key("F2")  # opens the file prompt after the stall
        operator.writes("he e")
    operator.until(lambda: operator.screen["field"] == "he e", "what was typed")
    assert operator.state == "READY"


def test_text_typed_at_once_after_the_key_that_opens_a_field_stops_nothing(story: Story) -> None:
    operator = ready(story, in_real_time=True)
    operator.once = True
    for _ in range(5):
        operator.key("F2")
        operator.writes("eeh e")
        operator.until(lambda: operator.screen["field"] == "eeh e", "what was typed")
        operator.key("Escape")
        operator.until(lambda: operator.screen["field"] == "", "the field closed")
    assert operator.state == "READY"


def test_click_on_program_that_covers_drawn_stop_control_stops_nothing(story: Story) -> None:
    operator = cutting(story)
    operator.points("PAUSE", on="StationDock")
    with another_client(operator.server, "cover"):
        operator.during(0.5)
        operator.server.button("left", down=True)
        operator.server.button("left", down=False)
        operator.keeps(lambda: operator.state == "RUNNING", 1.0, "the cut")


@pytest.mark.parametrize("what", ["window", "grab"])
def test_keys_typed_in_another_program_stop_nothing(story: Story, what: str) -> None:
    operator = cutting(story)
    with another_client(operator.server, what):
        operator.during(0.5)
        operator.once = True
        for key, _ in STOPS:
            operator.key(key)
        operator.keeps(lambda: operator.state == "RUNNING", 1.0, "the cut")
        operator.once = False


def test_estop_pressed_in_stall_is_shown_and_can_be_released(story: Story) -> None:
    operator = ready(story, in_real_time=True)
    with frozen(operator):
        operator.key("Scroll_Lock")
        operator.reaches("E-STOP")
    operator.answers("u", text("screen.twist-e-stop-out"), lambda: operator.state != "E-STOP")
    operator.reaches("DRIVES OFF")
