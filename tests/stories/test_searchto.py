"""A tool that was stopped in the part: the way out of it, and on in the pass that broke off."""

from __future__ import annotations

import json
import os
import signal

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import INCH, Operator
from tests.texts import fragment, opening, text

TOOLS = {1: (-0.5, -2.0), 2: (-0.5, -2.0)}
GROOVES = (
    "G90G94F300G72\nT1\nX3.9Z.2\nM03S900\nLS3\nG91Z-.3\nG90G95F.1X1\nF.002X.7\nG04F.3\nG94F300X3.9\nLF\nZ.5\n"
    "T2\nX.5Z.1\nG95F.02Z-.8\nX.48\nG94F300Z.1\nM05\nX2Z1\nM30\n"
)
THREE = (
    "G90G94F300G72\nT1\nX.8Z.2\nM03S900\nLS3\nX.7\nG95F.004Z-.4\nG94F300X.8\nZ.2\n"
    "G10X0Z-.1\nT1\nX.8Z.2\nLF\nM30\n"
)


def tip(operator: Operator) -> tuple[float, float]:
    """X (a diameter) and Z of the tip in the part's frame, inches."""
    x, z = operator.slides[:2]
    return 2 * (x / INCH + 0.5), z / INCH + 2.0


def state_at(line: int, number: int, count: int) -> str:
    """Return the title of the state at a line in one of its passes."""
    return f"{text('search.state-at-line', line=line)}, {text('search.pass', number=number, count=count)}"


def wakes(operator: Operator) -> None:
    operator.reaches("DRIVES OFF", "ALARM")
    if operator.state == "ALARM":  # a computer that stood still at its start
        operator.presses("r", lambda: operator.state != "ALARM")
    operator.presses("d", lambda: operator.state == "READY")


def to_searchto(operator: Operator) -> None:
    operator.presses("F6", lambda: operator.page == "SEARCHTO")


def in_the_second_groove(operator: Operator) -> None:
    """Z-.4, where the feed is slow enough for any hand."""
    wakes(operator)
    operator.starts()
    operator.lets_it_run(
        lambda: (
            operator.machine["line"] == 8 and abs(tip(operator)[1] + 0.4) < 0.002 and tip(operator)[0] < 0.99
        ),
        "the second groove",
        until_line=8,
    )


def stopped_there(operator: Operator) -> None:
    in_the_second_groove(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    operator.answers("u", fragment("screen.twist-e-stop-out"), lambda: operator.state != "E-STOP")
    wakes(operator)
    assert 0.7 < tip(operator)[0] < 1.0


def confirms(operator: Operator) -> None:
    operator.presses("F10", lambda: operator.shows(fragment("search.confirmed")))
    operator.during(1.0)  # what starts was read before it starts
    operator.cycle_start()
    operator.until(lambda: operator.state != "READY", "the start")


def never_in_the_wall(operator: Operator, since: int) -> None:
    """Of all places since then: below X3.9 the tip kept to the groove."""
    places = [each["slides"] for each in operator.seen[since:]]
    for x, z, *_c in places:
        low = 2 * (x / INCH + 0.5) < 3.895
        assert not low or abs(z / INCH + 2.0 + 0.4) < 0.003, (x, z)


def test_restart_at_boring_line_with_tool_in_groove_retracts_x_first(story: Story) -> None:
    operator = story.begins(GROOVES, tools=TOOLS)
    stopped_there(operator)
    since = len(operator.seen)
    to_searchto(operator)
    operator.sees(fragment("search.broke-off", line=8))
    operator.enters("16")  # inside the bore, which is not bored yet
    operator.sees(fragment("search.in-uncut-material", line=16))
    operator.enters("14")
    operator.sees(text("search.state-at-line", line=14))
    operator.sees("1 X")
    confirms(operator)
    operator.until(lambda: tip(operator)[1] > 0.9, "Z clear")
    never_in_the_wall(operator, since)


def test_retract_alone_is_put_in_feed_hold_and_resumed(story: Story) -> None:
    operator = story.begins(GROOVES, tools=TOOLS)
    stopped_there(operator)
    since, stood = len(operator.seen), operator.rests()
    to_searchto(operator)
    operator.presses("F4", lambda: operator.shows(fragment("search.look-at-way-out")))
    operator.sees(fragment("search.look-at-way-out"))
    operator.sees(text("search.leaves-part", feed="20.00 in/min"))
    operator.cycle_start()  # not before it was confirmed
    operator.keeps(lambda: operator.is_at(stood), 0.5, "nothing moves")
    confirms(operator)
    operator.until(lambda: operator.slides[0] > stood[0] + 0.2, "on the way")
    operator.key("h")
    operator.reaches("FEED HOLD")
    held = operator.rests()
    assert abs(held[1] - stood[1]) < 0.02
    assert 2 * (held[0] / INCH + 0.5) < 3.8  # within the groove yet
    operator.cycle_start()
    operator.until(lambda: operator.state == "READY" and tip(operator)[1] > 0.9, "out, and Z clear")
    never_in_the_wall(operator, since)
    assert operator.machine["outputs"] == ["collet"]  # no coolant
    assert operator.status["interrupted"]["line"] == 8  # the job is still to be finished
    with operator.store() as store:
        kept = store.settings.read_setting("under_way")
    assert isinstance(kept, dict)
    assert kept["line"] == 8
    operator.key("F4")
    operator.sees(text("search.tool-is-clear", tool=1))


def test_loop_resumes_in_interrupted_pass_and_part_is_finished(story: Story) -> None:
    operator = story.begins(GROOVES, tools=TOOLS)
    stopped_there(operator)
    since = len(operator.seen)
    to_searchto(operator)
    operator.key("Return")
    operator.sees(state_at(8, 2, 3))
    confirms(operator)
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "the part")
    cut = {
        round(each["slides"][1] / INCH + 2.0, 1)
        for each in operator.seen[since:]
        if 2 * (each["slides"][0] / INCH + 0.5) < 0.75 and each["line"] in {8, 9}
    }
    assert cut == {-0.4, -0.7}  # the first groove is not cut again
    operator.until(lambda: operator.status["interrupted"] is None, "status.json")


def test_bar_program_is_entered_at_third_part_by_keys_and_mouse(story: Story) -> None:
    operator = story.begins(THREE, tools=TOOLS)
    wakes(operator)
    operator.until(lambda: text("screen.to-start") in operator.prompt, "the proof")
    to_searchto(operator)
    operator.enters("7")
    operator.sees(state_at(7, 1, 3))
    operator.key("Right")
    operator.sees(state_at(7, 2, 3))
    operator.clicks("▶")
    operator.sees(state_at(7, 3, 3))
    operator.sees("R0.00000 Z\u22120.20000")  # G10 of two parts
    operator.clicks("◀")
    operator.sees(text("search.pass", number=2, count=3))
    operator.key("Escape")
    operator.enters("7p3")
    operator.sees(state_at(7, 3, 3))
    since = len(operator.seen)
    confirms(operator)
    operator.lets_it_run(lambda: operator.state == "READY" and operator.machine["line"] == 0, "the end")
    deepest = min(each["slides"][1] for each in operator.seen[since:]) / INCH + 2.0
    assert deepest == pytest.approx(-0.6, abs=0.003)  # Z-.4, shifted twice by .1
    assert operator.machine["parts"] == 0  # two parts were left out
    assert not operator.events("part")


def test_killed_control_knows_retract_from_groove_after_restart(story: Story) -> None:
    operator = story.begins(GROOVES, tools=TOOLS)
    in_the_second_groove(operator)
    os.kill(operator.popen.pid, signal.SIGKILL)
    operator.popen.wait()
    with operator.store() as store:
        kept = store.settings.read_setting("under_way")
    assert isinstance(kept, dict), json.dumps(kept)
    again = story.begins(GROOVES)
    wakes(again)
    job = opening("desk.interrupted")
    again.until(lambda: job in again.prompt or again.shows(job), "the job")
    to_searchto(again)
    again.key("F4")
    # The simulated slides stand at home again: clear of the part. A real one would stand in its groove.
    again.sees(fragment("search.tool-is-clear"))
