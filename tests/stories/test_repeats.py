"""A held key is one press, however the X server repeats it; what asked is not what answers."""

from __future__ import annotations

import pytest

from core.store.store import Store
from tests.stories.conftest import INCH, Story
from tests.stories.operator import Operator
from tests.texts import fragment, opening, text

PART = "G90G94T1\nM03S600\nG01X.5Z.5F5\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}
HELD = 2.0  # s: dozens of repeats
TRIES = 8  # of what a computer that stands still ends, and rightly


def ready(story: Story) -> Operator:
    """Drives on, a program that may be started, keys that repeat as fast as a server lets them."""
    story.server.repeats(200, 15)
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.until(lambda: text("screen.to-start") in operator.prompt, "ready to start")
    return operator


@pytest.mark.parametrize(("held", "other"), [("F11", "F12"), ("F12", "F11")])
def test_palm_button_taped_down_starts_nothing(story: Story, held: str, other: str) -> None:
    operator = ready(story)
    operator.down(held)
    operator.during(HELD)
    operator.down(other)
    operator.keeps(lambda: operator.state == "READY", 1.0, "no start")
    operator.sees(fragment("stories.palm-held-too-long"))
    operator.up(other)
    operator.down(other)
    operator.keeps(lambda: operator.state == "READY", 0.7, "no start by the other palm alone")
    operator.up(held, other)
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")


def test_palm_button_left_down_after_start_starts_nothing_more(story: Story) -> None:
    operator = ready(story)
    operator.down("F11", "F12")
    operator.reaches("RUNNING", "WAITING")
    operator.up("F12")
    operator.key("Pause")
    operator.reaches("FEED HOLD")
    operator.down("F12")
    operator.keeps(lambda: operator.state == "FEED HOLD", 1.0, "the hold")


def test_palm_button_down_through_loss_of_keyboard_is_ignored(story: Story) -> None:
    operator = ready(story)
    operator.down("F11")
    operator.minimises()
    operator.comes_back()
    operator.down("F12")
    operator.keeps(lambda: operator.state == "READY", 1.0, "no start")


def test_reset_key_held_down_does_not_cancel_program(story: Story) -> None:
    operator = ready(story)
    operator.starts()
    operator.until(lambda: operator.slides[0] > 0.5, "a cut")
    operator.key("Pause")
    operator.reaches("FEED HOLD")
    operator.holds("r", HELD)
    assert operator.state == "FEED HOLD"
    operator.sees(fragment("screen.give-up-program"))
    for _ in range(3):
        operator.key("r")
    operator.down("r")
    operator.key("y")  # while the key that asked is down it is no answer
    operator.up("r")
    operator.keeps(lambda: operator.state == "FEED HOLD", 0.5, "the program")
    operator.answers("r", fragment("screen.give-up-program"), lambda: operator.state == "READY")


def test_answer_key_pressed_with_the_question_is_ignored(story: Story) -> None:
    operator = ready(story)
    operator.starts()
    operator.key("Pause")
    operator.reaches("FEED HOLD")
    operator.writes("try")  # somebody thinks that he is in the editor
    operator.keeps(lambda: operator.state == "FEED HOLD", 0.5, "the program")


def test_step_jog_key_held_down_makes_one_step(story: Story) -> None:
    operator = ready(story)
    operator.keys("F1", "F5")
    operator.opens("JOG")
    operator.clicks(".1", on="JogPad")
    operator.holds("Right", HELD)
    operator.until(lambda: operator.slides[1] > 0.05 * INCH, "the step")
    x, z, *_ = operator.rests()
    assert (x, z) == (pytest.approx(0.0, abs=0.01), pytest.approx(0.1 * INCH, abs=0.01))
    operator.key("Right")
    operator.until(lambda: operator.slides[1] > 0.15 * INCH, "the next step")
    assert operator.rests()[1] == pytest.approx(0.2 * INCH, abs=0.01)


def test_jog_continues_while_its_key_repeats(story: Story) -> None:
    operator = ready(story)
    operator.keys("F1", "F5")
    operator.opens("JOG")
    assert any(jogs_through(operator) for _ in range(TRIES)), "the jog through its repeats"
    operator.rests()


def jogs_through(operator: Operator) -> bool:
    """Whether the jog has gone on all the while; a computer that stands still ends it, and rightly."""
    operator.down("Right")
    operator.until(lambda: operator.state == "JOG" or "JOG STOPPED" in operator.prompt, "the jog")
    since = len(operator.seen) - 1
    operator.during(HELD)
    went_on = all(each["state"] == "JOG" for each in operator.seen[since:])
    operator.up("Right")
    operator.reaches("READY")
    return went_on


def test_return_key_held_down_switches_no_output(story: Story) -> None:
    operator = ready(story)
    operator.keys("F10", "3", "Return")
    operator.sees("TERMINAL")
    before = operator.machine["outputs"]
    operator.holds("Return", HELD)
    operator.keys("Return", "Return")
    asked = text("screen.switch-on", name="coolant")
    operator.sees(asked)
    assert operator.machine["outputs"] == before
    operator.answers("Return", asked, lambda: "coolant" in operator.machine["outputs"])


def test_delete_key_held_down_deletes_nothing(story: Story) -> None:
    programs = story.home / "programs"
    programs.mkdir(parents=True)
    (programs / "mine.nc").write_text(PART)
    operator = ready(story)
    operator.keys("F1", "F6")
    operator.opens("PROGRAMS")
    operator.writes("mine")
    operator.sees("mine.nc")
    operator.holds("F6", HELD)
    operator.keys("F6", "F6")
    operator.sees(opening("programs.delete", name="mine.nc"))
    assert (programs / "mine.nc").exists()
    operator.answers(
        "F6", opening("programs.delete", name="mine.nc"), lambda: not (programs / "mine.nc").exists()
    )


def test_f10_held_down_leaves_no_text_unsaved(story: Story) -> None:
    operator = ready(story)
    operator.key("F3")
    operator.opens("EDITOR")
    operator.sees("G90G94T1")
    operator.writes("(MINE)")
    operator.until(lambda: "(MINE)" in operator.glance["field"], "typed")
    operator.holds("F10", HELD)
    operator.keys("F10", "F10")
    assert operator.page == "EDITOR"
    assert "(MINE)" in operator.glance["field"]
    operator.key("F6")
    operator.opens("AUTOMATIC")
    assert (story.folder / "part.nc").read_text() == PART


def test_clear_key_held_down_does_not_clear_offsets(story: Story) -> None:
    with Store.open(story.home) as store:
        store.offsets.secondary_offsets.change_row(5, "before the story", {"x": 1.0}).result()
    operator = ready(story)
    operator.key("F9")
    operator.opens("SECONDARY OFFSETS")
    operator.holds("c", HELD)
    operator.keys("c", "c")
    operator.sees(fragment("screen.clear-secondary"))
    with operator.store() as store:
        assert 5 in store.offsets.secondary_offsets.read_rows()

    def cleared() -> bool:
        with operator.store() as store:
            return not store.offsets.secondary_offsets.read_rows()

    operator.answers("c", fragment("screen.clear-secondary"), cleared)


def test_switch_key_held_down_toggles_once(story: Story) -> None:
    operator = ready(story)
    operator.holds("s", HELD)
    assert operator.machine["single_block"] is True


def test_key_held_down_repeats_text_in_a_field(story: Story) -> None:
    operator = ready(story)
    operator.key("F2")
    operator.sees(text("screen.file-to-be-processed"))
    operator.holds("x", 1.0)
    operator.until(lambda: operator.glance["field"].count("x") > 5, "a row of letters")
    operator.holds("BackSpace", 1.5)
    operator.until(lambda: operator.glance["field"].count("x") == 0, "gone again")
    operator.holds("Escape", 0.6)  # closes the prompt, and goes no further
    assert not operator.shows(text("screen.file-to-be-processed"))


def test_home_key_held_down_homes_nothing(story: Story) -> None:
    story.server.repeats(200, 15)
    lost = {
        "absolute = true                 # false": "home = { order = 2, speed = 60 }\nabsolute = false  # "
    }
    operator = story.begins(PART, tools=TOOLS, changes=lost)
    operator.drives_on()
    operator.keys("F1", "F5")
    operator.opens("JOG")
    operator.holds("Home", HELD)
    operator.keys("Home", "Home")
    operator.sees(fragment("jog.home"))
    assert operator.state == "READY"
    operator.answers("Home", fragment("jog.home"), lambda: operator.state != "READY", yes="Return")
    operator.reaches("HOMING")
