"""A part that was broken off: by the E-stop, by R, by a closed or killed control; and the next start."""

from __future__ import annotations

import os
import signal

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.stories.x11 import another_client
from tests.texts import fragment, opening, shows
from tests.texts import text as wording

PART = "G90G94F300G72\nT3\nX1.2Z.2\nM03S900\nX.8\nG95F.05Z-.2\nF.005Z-1\nX1.2\nG94F300Z.2\nM05\nX2Z2\nM30\n"
TOOLS = {3: (-0.5, -2.0)}
IN_THE_LOG = wording("log.interrupted", program="part.nc", line=7, tool="T3", part=1, why="E-STOP")
CUT = (-2.0 - 0.3) * 25.4  # machine Z in the middle of line 7


def in_the_cut(operator: Operator) -> None:
    operator.drives_on()
    operator.starts()
    operator.lets_it_run(
        lambda: operator.machine["line"] == 7 and operator.slides[1] < CUT, "the cut", until_line=7
    )


def stored(operator: Operator) -> tuple[object, int]:
    """Return the interrupted job and the parts that the store has; it is written behind the screen."""
    with operator.store() as store:
        return store.settings.read_setting("under_way"), store.runs.read_part_count("part.nc")


def twists_the_estop_out(operator: Operator) -> None:
    operator.answers("u", fragment("screen.twist-e-stop-out"), lambda: operator.state != "E-STOP")


def shows_the_job_on_every_page(operator: Operator) -> None:
    for keys, page in (
        (("F1", "F2"), "AUTOMATIC"),
        (("F1", "F4"), "MDI"),
        (("F1", "F5"), "JOG"),
        (("F1", "F6"), "PROGRAMS"),
        (("F1", "F8"), "TOOL OFFSETS"),
        (("F1", "F10"), "SPECIAL FUNCTIONS"),
        (("F1", "F2"), "AUTOMATIC"),
    ):
        operator.keys(*keys)
        operator.opens(page)
        operator.sees(opening("desk.interrupted", program="part.nc", line=7, passed="", tool=3, part=1))
        operator.sees(wording("stories.from-home"))


def is_not_begun_by_the_palms(operator: Operator) -> None:
    stands = operator.rests()
    operator.cycle_start()
    operator.until(lambda: shows(operator.machine["refused"], "stories.line-was-interrupted"), "a sentence")
    operator.keeps(lambda: operator.is_at(stands) and operator.state == "READY", 1.0, "nothing begins")


def test_palm_buttons_start_nothing_after_estop_in_cut_and_job_is_shown(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    twists_the_estop_out(operator)
    operator.drives_on()
    shows_the_job_on_every_page(operator)
    is_not_begun_by_the_palms(operator)
    stood = operator.rests()
    told = operator.status["interrupted"]
    assert (told["line"], told["tool"], told["part"]) == (7, 3, 1)
    with operator.store() as store:
        kept = store.settings.read_setting("under_way")
    assert isinstance(kept, dict)
    assert kept["where"][:2] == pytest.approx(stood[:2], abs=0.05)
    assert kept["why"] == "E-STOP"
    operator.until(lambda: bool(operator.events("interrupted")), "an entry of the log")
    assert operator.events("interrupted") == [IN_THE_LOG]


def test_canceled_program_leaves_job_and_y_allows_restart(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.key("h")
    operator.reaches("FEED HOLD")
    operator.answers("r", fragment("screen.give-up-program"), lambda: operator.state == "READY")
    is_not_begun_by_the_palms(operator)
    operator.key("y")
    operator.sees(opening("desk.begins-at-line-1"))
    operator.key("Escape")
    operator.sees(fragment("desk.was-interrupted"))
    is_not_begun_by_the_palms(operator)
    operator.key("y")
    operator.sees(opening("desk.begins-at-line-1"))
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "the part")
    operator.reaches("READY")
    operator.until(lambda: operator.status["interrupted"] is None, "status.json")
    operator.until(lambda: bool(operator.events("cleared")), "an entry of the log")
    assert [text for text in operator.events("cleared") if shows(text, "stories.begins-anew")]


def test_killed_control_restarts_with_its_interrupted_job(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.during(1.5)  # a note of the place is a second old at most
    killed = operator.slides
    os.kill(operator.popen.pid, signal.SIGKILL)
    operator.popen.wait()
    again = story.begins(PART)
    again.sees(opening("desk.interrupted", program="part.nc", line=7, passed="", tool=3, part=1))
    again.sees(wording("stories.power-lost"))
    with again.store() as store:
        kept = store.settings.read_setting("under_way")
    assert isinstance(kept, dict)
    assert kept["where"][1] == pytest.approx(killed[1], abs=900 / 60 * 0.005 * 25.4 * 3)  # 3 s of this feed
    again.drives_on()
    is_not_begun_by_the_palms(again)
    again.key("F6")
    again.opens("SEARCHTO")
    again.sees(fragment("search.broke-off", line=7))
    assert again.status["interrupted"]["line"] == 7


def test_part_is_finished_by_searchto_and_notice_row_closes(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    twists_the_estop_out(operator)
    operator.drives_on()
    operator.key("F6")
    operator.opens("SEARCHTO")
    operator.sees(fragment("search.broke-off", line=7))
    operator.key("Return")
    operator.sees(fragment("search.compare"))
    operator.key("F10")
    operator.sees(fragment("search.start-restart"))
    operator.during(1.0)  # what starts was read
    operator.cycle_start()
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "the part")
    operator.reaches("READY")
    operator.until(lambda: not operator.shows(opening("desk.interrupted")), "nothing is interrupted")
    operator.until(lambda: operator.status["interrupted"] is None, "status.json")
    operator.until(lambda: stored(operator) == (None, 1), "the store")


@pytest.mark.parametrize("keys", [("y", "F11", "F12"), ("F11", "y", "F12")], ids=" ".join)
def test_answer_and_palm_buttons_pressed_together_start_nothing(story: Story, keys: tuple[str, ...]) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    twists_the_estop_out(operator)
    operator.drives_on()
    operator.sees(opening("desk.interrupted", program="part.nc", line=7))
    operator.during(1.0)
    stood = operator.rests()
    operator.once = True
    operator.down(*keys)
    operator.keeps(lambda: operator.is_at(stood) and operator.state == "READY", 1.5, "nothing begins")
    operator.up(*keys)
    operator.keeps(lambda: operator.is_at(stood) and operator.state == "READY", 0.5, "nothing begins")


def test_field_prompt_during_estop_names_only_keys_that_work(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.keys("F1", "F4")
    operator.opens("MDI")
    operator.key("Scroll_Lock")
    operator.reaches("E-STOP")
    operator.sees(fragment("stories.release-by-hand-or-u"))
    operator.key("F1")
    operator.sees(wording("screen.e-stop-make-safe", how=wording("stories.release-by-u")))
    twists_the_estop_out(operator)
    operator.reaches("DRIVES OFF")


def promises_a_key(operator: Operator) -> bool:
    """Return whether the prompt names the key that holds the feed."""
    return shows(operator.prompt, "stories.keys-that-stop") or shows(operator.prompt, "stories.h-holds-feed")


def test_prompt_offers_no_key_while_another_window_has_keyboard(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.until(lambda: promises_a_key(operator), "how to hold")
    with another_client(operator.server, "window"):
        operator.until(lambda: shows(operator.prompt, "stories.keyboard-elsewhere"), "the truth")
    operator.comes_back()
    operator.until(lambda: promises_a_key(operator) or operator.state != "RUNNING", "back")


def test_another_program_replaces_interrupted_job_only_on_confirmation(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    (story.home / "programs").mkdir(exist_ok=True)
    (story.home / "programs" / "other.nc").write_text("G90G94F300\nT3\nX2Z2\nM30\n")
    in_the_cut(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    operator.key("F2")
    operator.enters("other.nc")
    operator.sees(fragment("desk.gives-job-up", name="other.nc"))
    operator.key("Escape")
    operator.keeps(
        lambda: operator.shows(opening("desk.interrupted", program="part.nc", line=7)), 0.5, "the job"
    )
    operator.keys("F1", "F6")
    operator.opens("PROGRAMS")
    operator.enters("other")
    operator.sees(fragment("desk.gives-job-up", name="other.nc"))  # from the list too
    operator.key("Escape")
    operator.key("F2")
    operator.enters("other.nc")
    operator.sees(fragment("desk.gives-job-up", name="other.nc"))
    job = opening("desk.interrupted")
    operator.until(lambda: operator.says_yes(lambda: not operator.shows(job)), "it is given up")
    operator.until(lambda: bool(operator.events("cleared")), "an entry of the log")
    assert operator.events("cleared") == [wording("log.replaced-by", what=IN_THE_LOG, name="other.nc")]


def test_computer_shutdown_in_cut_leaves_interrupted_job(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    os.kill(operator.popen.pid, signal.SIGTERM)
    operator.until(lambda: operator.popen.poll() is not None, "the end")
    told = operator.status
    assert (told["available"], told["interrupted"]["line"]) == (False, 7)
    again = story.begins(PART)
    again.sees(opening("desk.interrupted", program="part.nc", line=7, passed="", tool=3, part=1))
    again.sees(wording("stories.control-closed"))
    again.drives_on()
    is_not_begun_by_the_palms(again)


def test_palm_button_and_y_held_down_start_nothing(story: Story) -> None:
    """What lies on the keyboard answers no question, and starts nothing with it."""
    operator = story.begins(PART, tools=TOOLS)
    in_the_cut(operator)
    operator.key("h")
    operator.reaches("FEED HOLD")
    operator.key("r")
    operator.sees(fragment("screen.give-up-program"))
    operator.during(0.6)
    operator.down("y")  # and stays: it gives the program up, and answers nothing more
    operator.reaches("READY")
    operator.during(2.0)
    operator.cycle_start()
    operator.until(lambda: shows(operator.machine["refused"], "stories.line-was-interrupted"), "a sentence")
    operator.up("y")
    is_not_begun_by_the_palms(operator)
