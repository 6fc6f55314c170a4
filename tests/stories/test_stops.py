"""Hold and E-stop, wherever the keyboard is, whatever else is pressed, on every layout."""

from __future__ import annotations

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.texts import fragment, text

LONG = "G90G94T1\nM03S600\nG01X3.Z3.F5\nX0Z0\nM30\n"  # minutes
TOOLS = {1: (0.0, 0.0)}
MODIFIERS = ((), ("shift",), ("ctrl",), ("alt",), ("meta",), ("altgr",), ("ctrl", "shift"))


def goes_on(operator: Operator) -> None:
    """From a hold, and until it moves again."""
    operator.reaches("FEED HOLD")
    operator.during(0.4)  # two starts within .3 s are one
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")


def test_pause_key_holds_with_any_modifier_and_lock(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    for modifiers in MODIFIERS:
        operator.key("Pause", *modifiers)
        goes_on(operator)
    for lock in ("Caps_Lock", "Num_Lock"):
        operator.key(lock)
        operator.key("Pause")
        goes_on(operator)
        operator.key(lock)


def test_stop_letters_act_with_any_modifier(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    for key, modifiers in (("h", ("shift",)), ("h", ("ctrl",)), ("h", ("altgr",)), ("space", ("shift",))):
        operator.key(key, *modifiers)
        goes_on(operator)
    for modifiers in (("shift",), ("ctrl",), ("altgr",)):
        operator.key("e", *modifiers)
        operator.reaches("E-STOP")
        released(operator)


def released(operator: Operator) -> None:
    """The E-stop is twisted out by its own two keys, and the drives are on again."""
    operator.answers("u", fragment("screen.twist-e-stop-out"), lambda: operator.state == "DRIVES OFF")
    operator.key("d")
    operator.reaches("READY")


def test_shifted_stop_key_never_releases_estop(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")
    for key in ("e", "Scroll_Lock", "Pause", "h"):
        for modifiers in MODIFIERS:
            if modifiers != ("meta",):  # with it the letters are the window manager's
                operator.key(key, *modifiers)
    operator.keeps(lambda: operator.state == "E-STOP", 0.5, "the stop")
    released(operator)


def back_to_automatic(operator: Operator) -> None:
    """Esc, and in the editor what leaves it."""

    def there() -> bool:
        if operator.page == "EDITOR":
            operator.key("F6" if operator.shows(fragment("editor.leaves-unsaved")) else "F10")
        elif operator.page != "AUTOMATIC":
            operator.key("Escape")
        operator.during(0.2)
        return operator.page == "AUTOMATIC"

    operator.until(there, "the Automatic page")


def test_the_stop_keys_act_on_every_page_and_in_every_field(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    places = {
        "MAIN MENU": ("F1",),
        "MDI": ("F1", "F4"),
        "JOG": ("F1", "F5"),
        "PROGRAMS": ("F1", "F6"),
        "TOOL OFFSETS": ("F1", "F8"),
        "SECONDARY OFFSETS": ("F1", "F9"),
        "ZERO OFFSETS": ("F1", "g"),
        "SPECIAL FUNCTIONS": ("F1", "F10"),
        "SEARCHTO": ("F1", "F2", "F6"),
        "EDITOR": ("F1", "F2", "F3"),
    }
    for page, keys in places.items():
        for key in keys:
            operator.key(key)
            operator.during(0.1)
        operator.opens(page)
        operator.writes("1")
        operator.key("Scroll_Lock", "shift")
        operator.reaches("E-STOP")
        assert operator.page == page
        back_to_automatic(operator)
        released(operator)


def test_repeating_stop_key_stops_and_does_not_release(story: Story) -> None:
    story.server.repeats(200, 15)
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.down("Pause")
    operator.reaches("FEED HOLD")
    operator.during(1.0)
    operator.cycle_start()  # a hold key that is held lets nothing go on
    operator.keeps(lambda: operator.state == "FEED HOLD", 0.6, "the hold")
    operator.sees(fragment("screen.stopping-key-held"))
    operator.up("Pause")
    operator.during(0.4)
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")
    operator.holds("Scroll_Lock", 1.0)
    operator.keeps(lambda: operator.state == "E-STOP", 0.5, "the stop")


@pytest.mark.parametrize("held", ["Right", "F11", "s"])
def test_stop_keys_act_while_another_key_is_down(story: Story, held: str) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.down(held)
    operator.during(1.0)  # it repeats
    operator.key("Pause")
    operator.reaches("FEED HOLD", "SINGLE BLOCK")
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_stop_keys_act_during_mouse_drag(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.points("PATH")
    operator.server.button("left", down=True)
    operator.server.point(600, 500)
    operator.key("Pause")
    goes_on(operator)
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_stop_keys_act_in_file_prompt(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.key("F2")
    operator.sees(text("screen.file-to-be-processed"))
    operator.writes("he e")
    operator.until(lambda: operator.glance["field"] == "he e", "the letters are text")
    assert operator.state == "READY"
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_stop_key_acts_during_text_drag(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.key("F3")
    operator.opens("EDITOR")
    operator.sees("G90G94T1")
    operator.key("a", "ctrl")
    operator.points("G90G94T1")
    operator.server.button("left", down=True)
    x, y = operator.find("G90G94T1")
    for step in range(1, 12):
        operator.server.point(x + 8 * step, y + 6 * step)
        operator.during(0.05)
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


@pytest.mark.parametrize("layout", ["fr", "de", "ru", "us dvorak", "gr"])
def test_stop_keys_act_with_every_keyboard_layout(story: Story, layout: str) -> None:
    story.server.layout(layout)
    operator = story.begins(LONG, tools=TOOLS)
    operator.reaches("DRIVES OFF")
    operator.key(40 if layout in {"ru", "gr"} else "d")  # the place of D on the keyboard
    operator.reaches("READY")
    operator.starts()
    operator.key("Pause", "shift")
    goes_on(operator)
    operator.key(43 if layout in {"ru", "gr"} else "h")
    goes_on(operator)
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")


def test_stop_key_acts_after_a_dead_key(story: Story) -> None:
    story.server.layout("fr")
    operator = story.begins(LONG, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.key("dead_circumflex")
    operator.key("Pause")
    goes_on(operator)
    operator.key("dead_circumflex")
    operator.key("h")
    goes_on(operator)
    operator.key("dead_circumflex")
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")
    operator.key("F2")
    operator.sees(text("screen.file-to-be-processed"))
    released_in_a_field(operator)


def released_in_a_field(operator: Operator) -> None:
    """A dead key in a field is text; the stop key behind it is none."""
    operator.key("dead_circumflex")
    operator.key("Escape")
    operator.key("Escape")
    operator.until(lambda: not operator.shows(text("screen.file-to-be-processed")), "the prompt is gone")
    released(operator)
