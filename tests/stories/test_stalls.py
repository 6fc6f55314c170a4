"""The times of the events themselves: what waited behind a stall of the screen starts nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import fragment, text

PART = "G90G94T1\nM03S600\nG01X2.Z2.F5\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}
Stall = Callable[[Operator], "Iterator[None]"]


def ready(story: Story, *, in_real_time: bool = False) -> Operator:
    operator = story.begins(PART, tools=TOOLS, in_real_time=in_real_time)
    operator.drives_on()
    operator.until(lambda: text("screen.to-start") in operator.prompt, "ready to start")
    return operator


@contextmanager
def frozen(operator: Operator) -> Iterator[None]:
    """Qt's thread does something else for three seconds; the control goes on."""
    number = operator.freezes(3.0)
    operator.during(0.3)
    operator.once = True
    yield
    operator.once = False
    assert not operator.answered(number), "it took longer than the screen was frozen"
    operator.until(lambda: operator.answered(number), "the screen again")


@contextmanager
def stopped(operator: Operator) -> Iterator[None]:
    """The whole process is stopped, as by a computer that swaps."""
    operator.stops_the_process()
    operator.once = True
    yield
    operator.during(1.0)
    operator.once = False
    operator.lets_it_go_on()


STALLS = pytest.mark.parametrize("stall", [frozen, stopped])


@STALLS
def test_palm_buttons_pressed_two_seconds_apart_start_nothing(story: Story, stall: Stall) -> None:
    operator = ready(story)
    with stall(operator):  # type: ignore[attr-defined]
        operator.down("F11")
        operator.during(2.0)
        operator.down("F12")
        operator.during(0.1)
        operator.up("F11", "F12")
    operator.keeps(lambda: operator.state == "READY", 1.0, "no start")
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")


@STALLS
def test_palm_buttons_pressed_in_stall_start_nothing(story: Story, stall: Stall) -> None:
    operator = ready(story)
    with stall(operator):  # type: ignore[attr-defined]
        operator.cycle_start()
    operator.sees(fragment("screen.screen-stood-still"))
    operator.keeps(lambda: operator.state == "READY", 1.0, "no start")


@STALLS
def test_palm_buttons_down_through_end_of_stall_start_nothing(story: Story, stall: Stall) -> None:
    operator = ready(story)
    with stall(operator):  # type: ignore[attr-defined]
        operator.down("F11", "F12")
    operator.keeps(lambda: operator.state == "READY", 1.0, "no start by palms from before")


@STALLS
def test_arrow_pressed_in_stall_does_not_jog(story: Story, stall: Stall) -> None:
    operator = ready(story)
    operator.keys("F1", "F5")
    operator.opens("JOG")
    stands = operator.slides
    with stall(operator):  # type: ignore[attr-defined]
        operator.down("Right")
        operator.during(0.5)
    operator.keeps(lambda: operator.is_at(stands), 1.0, "rest with the arrow held")
    operator.up("Right")
    operator.during(0.1)
    operator.down("Right")
    operator.reaches("JOG")


def test_step_key_pressed_in_stall_makes_no_step(story: Story) -> None:
    operator = ready(story)
    operator.keys("F1", "F5")
    operator.opens("JOG")
    operator.clicks(".1", on="JogPad")
    with frozen(operator):
        operator.key("Right")
    operator.keeps(lambda: operator.is_at((0.0, 0.0)), 1.0, "rest")
    operator.key("Right")
    operator.until(lambda: operator.slides[1] > 0.09 * INCH, "a step")


def test_drives_key_pressed_in_stall_does_not_enable_drives(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.reaches("DRIVES OFF")
    with frozen(operator):
        operator.key("d")
    operator.keeps(lambda: operator.state == "DRIVES OFF", 1.0, "the drives")
    operator.key("d")
    operator.reaches("READY")


def test_mouse_click_in_stall_starts_nothing(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.reaches("DRIVES OFF")
    at = operator.find("DRIVES")
    with frozen(operator):
        operator.server.point(*at)
        operator.server.button("left", down=True)
        operator.server.button("left", down=False)
    operator.keeps(lambda: operator.state == "DRIVES OFF", 1.0, "the drives")


def test_mdi_line_is_not_started_by_keys_pressed_in_stall(story: Story) -> None:
    operator = ready(story)
    operator.keys("F1", "F4")
    operator.opens("MDI")
    operator.enters("G90G94F5X.1")
    operator.sees(fragment("stories.line-ready"))
    with frozen(operator):
        operator.cycle_start()
    operator.keeps(lambda: operator.is_at((0.0, 0.0)), 1.0, "rest")


@pytest.mark.parametrize("key", ["Pause", "Scroll_Lock", "h", "Escape"])
def test_stop_key_acts_however_late(story: Story, key: str) -> None:
    operator = ready(story)
    operator.starts()
    operator.until(lambda: operator.slides[0] > 0.5, "a cut")
    with stopped(operator):
        operator.key(key)
        operator.during(1.0)
    operator.reaches("E-STOP" if key == "Scroll_Lock" else "FEED HOLD")


def test_mouse_stop_acts_however_late(story: Story) -> None:
    operator = ready(story)
    operator.starts()
    operator.until(lambda: operator.slides[0] > 0.5, "a cut")
    at = operator.find("HOLD", on="StationDock")
    with frozen(operator):
        operator.server.point(*at)
        operator.server.button("left", down=True)
        operator.server.button("left", down=False)
    operator.reaches("FEED HOLD")


def test_text_typed_in_stall_is_entered_and_following_key_acts(story: Story) -> None:
    operator = ready(story)
    with frozen(operator):
        operator.key("F2")
        operator.writes("bush")
    operator.until(lambda: operator.glance["field"] == "bush", "what was typed")
    operator.sees(text("screen.file-to-be-processed"))
    with frozen(operator):
        operator.key("BackSpace")
        operator.writes("hing")
        operator.key("Escape")
        operator.key("s")
    operator.until(lambda: bool(operator.machine["single_block"]), "a key after the field was left")
    assert operator.glance["field"] == ""


def test_late_answer_is_ignored_and_following_key_is_dropped(story: Story) -> None:
    operator = ready(story)
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")
    operator.key("u")
    operator.sees(text("screen.twist-e-stop-out"))
    with frozen(operator):
        operator.key("y")
        operator.key("s")
    operator.sees(fragment("screen.screen-stood-still"))
    operator.keeps(lambda: operator.state == "E-STOP", 1.0, "the E-stop")
    assert not operator.machine["single_block"]
