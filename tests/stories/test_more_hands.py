"""More ways in which a hand, a lock or a menu could move what nobody meant."""

from __future__ import annotations

import pytest

from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import fragment, text

PART = "G90G94T1\nM03S600\nG01X2.Z2.F5\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}
CAPS_LOCK = 66  # the code of the key


def at_jog(story: Story) -> Operator:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.keys("F1", "F5")
    operator.opens("JOG")
    return operator


def test_popup_window_does_not_block_stop_keys(story: Story) -> None:
    """No field has a menu; but one that did would have the keyboard for itself."""
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.key("F2")
    operator.sees(text("screen.file-to-be-processed"))
    operator.writes("bush")
    operator.until(lambda: operator.glance["field"] == "bush", "typed")
    operator.points("bush")
    operator.server.button("right", down=True)
    operator.server.button("right", down=False)
    operator.ask("menu")
    operator.during(0.3)
    operator.key("Pause")
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_the_number_pad_without_num_lock_moves_nothing(story: Story) -> None:
    operator = at_jog(story)
    operator.down("KP_Left")
    operator.sees(fragment("stories.num-lock-off"))
    operator.keeps(lambda: operator.is_at((0.0, 0.0)), 0.7, "rest")
    operator.up("KP_Left")


def test_locked_shift_modifier_does_not_select_rapid(story: Story) -> None:
    """Caps Lock as Shift Lock, as some set it: the modifier is there, and no hand on the key."""
    story.server.run("setxkbmap", "-option", "caps:shiftlock")
    story.server.layout("us")
    operator = at_jog(story)
    operator.server.down(CAPS_LOCK)
    operator.server.up(CAPS_LOCK)
    operator.down("Right")
    operator.reaches("JOG")
    start = operator.slides[1]
    operator.during(0.8)
    operator.up("Right")
    operator.reaches("READY")
    # 100 in/min would have gone 34 mm in .8 s; the speed that is chosen goes a quarter of that at most
    assert 0 < operator.rests()[1] - start < 0.6 * 100 / 60 * INCH * 0.8


def test_right_mouse_button_does_not_jog_but_stops(story: Story) -> None:
    operator = at_jog(story)
    operator.points("Z+", on="JogPad")
    operator.server.button("right", down=True)
    operator.keeps(lambda: operator.is_at((0.0, 0.0)), 0.7, "rest")
    operator.server.button("right", down=False)
    operator.clicks("AUTO", on="FunctionKeyBar") if operator.page == "MAIN MENU" else operator.key("F1")
    operator.key("F2")
    operator.opens("AUTOMATIC")
    operator.starts()
    operator.points("HOLD", on="StationDock")
    operator.server.button("right", down=True)
    operator.reaches("FEED HOLD")


def test_accidental_touch_does_not_release_estop(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    stop, twist = operator.find("STOP", on="StationDock"), operator.find("TWIST", on="StationDock")
    for first, second in ((stop, twist), (twist, stop)):
        operator.finger(1, first)
        operator.ask("touch", fingers=[(1, "stationary", *first), (2, "press", *second)])
        operator.ask("touch", fingers=[(2, "stationary", *second), (1, "release", *first)])
        operator.ask("touch", fingers=[(2, "release", *second)])
        operator.reaches("E-STOP")
        operator.keeps(lambda: operator.state == "E-STOP", 0.5, "the stop")
    operator.touches("TWIST", on="StationDock")
    operator.reaches("DRIVES OFF")


def test_mouse_wheel_and_plus_key_in_stall_do_not_raise_override(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.points("−", on="StationDock")
    x, y = operator.find("−", on="StationDock")
    number = operator.freezes(2.0)
    operator.during(0.3)
    operator.server.point(x + 30, y)
    for _ in range(4):
        operator.server.button("wheel up", down=True)
        operator.server.button("wheel up", down=False)
    operator.server.down("plus")
    operator.during(0.8)  # held, it repeats
    operator.server.up("plus")
    operator.until(lambda: operator.answered(number), "the screen again")
    operator.keeps(lambda: operator.machine["feed_override"] == 1.0, 1.2, "the feed override")


@pytest.mark.parametrize("way", ["keys", "double tap"])
def test_reset_pressed_twice_does_not_cancel_program(story: Story, way: str) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.during(0.4)
    operator.key("Pause")
    operator.reaches("FEED HOLD")
    for _ in range(4):
        if way == "keys":
            operator.key("r")
        else:
            operator.clicks("RESET", on="LampStrip")
    operator.keeps(lambda: operator.state == "FEED HOLD", 0.7, "the program")
    operator.clicks("YES", on="PromptLine")
    operator.reaches("READY")
