"""Nothing moves before everything was seen released and pressed anew."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.x11 import another_client

PART = "G90G94T1\nM03S600\nG01X.5Z.5F5\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}


def at_jog(story: Story) -> Operator:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.keys("F1", "F5")
    operator.opens("JOG")
    return operator


def minimised(operator: Operator) -> None:
    operator.minimises()
    operator.reaches("READY")
    operator.comes_back()


def other_workspace(operator: Operator) -> None:
    operator.server.run("xdotool", "set_num_desktops", "2")
    operator.server.run("xdotool", "set_desktop", "1")
    operator.reaches("READY")
    operator.server.run("xdotool", "set_desktop", "0")
    operator.comes_back()


def other_window(operator: Operator) -> None:
    with another_client(operator.server, "window"):
        operator.reaches("READY")
    operator.comes_back()


def screen_lock(operator: Operator) -> None:
    """A locker grabs keyboard and pointer; no release comes here meanwhile."""
    with another_client(operator.server, "grab"):
        operator.reaches("READY")
    operator.until(lambda: bool(operator.glance["active"]), "the keyboard back")


WAYS: tuple[Callable[[Operator], None], ...] = (minimised, other_workspace, other_window, screen_lock)


@pytest.mark.parametrize("way", WAYS)
def test_interrupted_jog_does_not_resume_automatically(story: Story, way: Callable[[Operator], None]) -> None:
    operator = at_jog(story)
    operator.down("Right")
    operator.reaches("JOG")
    way(operator)
    stands = operator.rests()
    operator.keeps(lambda: operator.is_at(stands), 1.5, "rest with the arrow still held")
    operator.up("Right")
    operator.during(0.1)
    operator.down("Right")
    operator.reaches("JOG")
    operator.up("Right")
    operator.reaches("READY")


@pytest.mark.parametrize("way", WAYS)
def test_key_pressed_in_another_window_does_not_jog(story: Story, way: Callable[[Operator], None]) -> None:
    operator = at_jog(story)
    stands = operator.slides

    def pressed_meanwhile(operator: Operator) -> None:
        operator.down("Right")

    if way is minimised:
        operator.minimises()
        pressed_meanwhile(operator)
        operator.comes_back()
    elif way is screen_lock:
        with another_client(operator.server, "grab"):
            operator.until(lambda: not operator.glance["active"], "the lock")
            pressed_meanwhile(operator)
    elif way is other_window:
        with another_client(operator.server, "window"):
            operator.until(lambda: not operator.glance["active"], "the other window")
            pressed_meanwhile(operator)
        operator.comes_back()
    else:
        operator.server.run("xdotool", "set_num_desktops", "2")
        operator.server.run("xdotool", "set_desktop", "1")
        operator.until(lambda: not operator.glance["active"], "the other workspace")
        pressed_meanwhile(operator)
        operator.server.run("xdotool", "set_desktop", "0")
        operator.comes_back()
    operator.keeps(lambda: operator.is_at(stands), 1.5, "rest")


def test_arrow_down_while_page_opens_does_not_jog(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    stands = operator.slides
    operator.down("Right")
    operator.during(0.8)
    operator.keys("F1", "F5")
    operator.opens("JOG")
    operator.keeps(lambda: operator.is_at(stands), 1.0, "rest")


def test_menu_in_front_ends_jog_without_resuming(story: Story) -> None:
    operator = at_jog(story)
    operator.down("Right")
    operator.reaches("JOG")
    operator.ask("menu")
    operator.reaches("READY")
    operator.server.point(5, 795)
    operator.server.button("left", down=True)  # beside it: it closes
    operator.server.button("left", down=False)
    stands = operator.rests()
    operator.keeps(lambda: operator.is_at(stands), 1.5, "rest with the arrow still held")


def test_a_mouse_that_leaves_the_window_ends_the_jog(story: Story) -> None:
    operator = at_jog(story)
    operator.points("Z+", on="JogPad")
    operator.server.button("left", down=True)
    operator.reaches("JOG")
    operator.server.point(1279, 799)
    operator.reaches("READY")
    stands = operator.rests()
    operator.points("Z+", on="JogPad")
    operator.keeps(lambda: operator.is_at(stands), 1.0, "rest with the button still down")
    operator.server.button("left", down=False)


def test_mouse_button_down_when_window_returns_does_not_jog(story: Story) -> None:
    operator = at_jog(story)
    operator.points("Z+", on="JogPad")
    operator.server.button("left", down=True)
    operator.reaches("JOG")
    operator.minimises()
    operator.reaches("READY")
    operator.comes_back()
    stands = operator.rests()
    operator.keeps(lambda: operator.is_at(stands), 1.0, "rest")
    operator.server.button("left", down=False)


def test_lost_key_release_ends_jog(story: Story) -> None:
    """A client that takes the keyboard without taking the focus swallows the release."""
    operator = at_jog(story)
    operator.down("Right")
    operator.reaches("JOG")
    with another_client(operator.server, "keys"):
        operator.up("Right")
        operator.reaches("READY")
    operator.rests()


def test_touches_that_leave_window_end_jog(story: Story) -> None:
    operator = at_jog(story)
    at = operator.find("Z+", on="JogPad")
    operator.finger(1, at)
    operator.reaches("JOG")
    operator.ask("touch", fingers=[(1, "move", 1279, 10)])
    operator.reaches("READY")
    operator.ask("touch", fingers=[(1, "move", *at)])
    stands = operator.rests()
    operator.keeps(lambda: operator.is_at(stands), 0.7, "rest with the finger back")
    operator.ask("touch", fingers=[(1, "release", *at)])
