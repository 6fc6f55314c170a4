"""Alarms, E-stops and holds as an operator finds them: number, cause and remedy on every page, and in F7."""

from __future__ import annotations

from app.compose.optional_features import extras
from core.alarms import CATALOG, AlarmCode
from tests.stories.conftest import Story
from tests.stories.operator import Operator, Told
from tests.texts import fragment
from tests.texts import text as wording

LONG = "G90G94F300G72\nT3\nX1.2Z.2\nM03S900\nX.8\nG94F100Z-.2\nF4Z-.9\nX1.2\nG94F300Z.2\nM05\nX2Z2\nM30\n"
STOPS = "G90G94F300G72\nT3\nX1.2Z.2\nM00(CHECK THE BORE)\nX1.3\nM01\nX2Z2\nM30\n"
TOOLS = {3: (-0.5, -2.0)}
PAGES = (
    (("F1", "F2"), "AUTOMATIC"),
    (("F1", "F4"), "MDI"),
    (("F1", "F5"), "JOG"),
    (("F1", "F6"), "PROGRAMS"),
    (("F1", "F8"), "TOOL OFFSETS"),
    (("F1", "F9"), "SECONDARY OFFSETS"),
    (("F1", "F10"), "SPECIAL FUNCTIONS"),
    (("F1", "b"), "PART"),
    (("F1", "q"), "SCOPE"),
    *(
        (("F1", page.key.lower()), page.name)
        for extra in extras().values()
        for page in extra.page_descriptions
        if page.key
    ),
    (("F1",), "MAIN MENU"),
)
OURS = ("setpoint", "too early", "splice", "Error", "queue")  # words of whoever wrote the control


def in_the_cut(operator: Operator) -> None:
    operator.drives_on()
    operator.starts()
    operator.lets_it_run(lambda: operator.machine["line"] == 7, "the cut", until_line=7)
    operator.until(lambda: operator.state == "RUNNING", "feeding")


def in_status(operator: Operator, number: int) -> Told:
    """The alarm as status.json has it."""

    def found() -> list[Told]:
        return [each for each in operator.status.get("alarms", ()) if each["number"] == number]

    operator.until(lambda: bool(found()), f"{number} in status.json")
    return found()[0]


def is_told_on_every_page(operator: Operator, code: AlarmCode, exactly: str = "") -> None:
    entry = CATALOG[code]
    for keys, page in PAGES:
        if page == "MDI" and operator.state == "FEED HOLD":
            continue  # it does not open while a program is under way
        operator.keys(*keys)
        operator.opens(page)
        operator.sees(f"{entry.number}: {entry.text.upper()}")
        operator.sees(exactly or entry.causes[0])
        operator.sees(entry.remedy)


def is_in_f7(operator: Operator, *codes: AlarmCode) -> None:
    operator.key("F7")
    for code in codes:
        entry = CATALOG[code]
        operator.sees(f"{entry.number}  ·  {entry.text.upper()}")
    operator.key("Escape")
    operator.until(
        lambda: not operator.shows(wording("stories.alarms-and-stops").partition("  ·  ")[0]),
        "the list closed",
    )


def test_jammed_axis_is_shown_with_cause_and_remedy_on_every_page(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.breaks("jam", "Z")
    operator.reaches("ALARM")
    number, text = operator.machine["alarms"][0]
    found = [code for code, entry in CATALOG.items() if entry.number == number]
    operator.rests()
    is_told_on_every_page(operator, found[0], "Z")
    is_in_f7(operator, found[0])
    told = in_status(operator, number)
    assert told["text"].startswith(text)
    assert "Z" in told["cause"]
    assert told["remedy"] == CATALOG[found[0]].remedy
    operator.until(lambda: any(each.startswith(str(number)) for each in operator.events("alarm")), "the log")


def test_estop_and_its_reason_are_in_f7_after_computer_restart(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.key("e")
    operator.reaches("E-STOP")
    operator.rests()
    is_told_on_every_page_as_estop(operator)
    is_in_f7(operator, "estop")
    operator.until(lambda: any(each.startswith("701 E-STOP") for each in operator.events("estop")), "the log")
    operator.leaves()
    again = story.begins(LONG)
    again.key("F7")
    again.sees("701  ·  E-STOP")
    again.sees(CATALOG["estop"].remedy)
    assert not again.shows("No alarm")


def is_told_on_every_page_as_estop(operator: Operator) -> None:
    for keys, page in PAGES:
        operator.keys(*keys)
        operator.opens(page)
        operator.sees(fragment("screen.e-stop-make-safe"))
        operator.sees(CATALOG["estop"].causes[0])


def test_every_stop_and_its_cause_are_listed_in_f7(story: Story) -> None:
    operator = story.begins(STOPS, tools=TOOLS)
    operator.drives_on()
    operator.key("o")
    operator.starts()
    operator.reaches("PROGRAM STOP")
    operator.key("s")
    operator.cycle_start()
    operator.reaches("SINGLE BLOCK")
    operator.key("s")
    operator.during(0.4)
    operator.cycle_start()
    operator.reaches("PROGRAM STOP")
    operator.answers("r", fragment("screen.give-up-program"), lambda: operator.state == "READY")
    operator.key("F7")
    for text in (
        "703  ·  RESET",
        wording("log.given-up", what="part.nc"),
        "705  ·  OPTIONAL STOP",
        "706  ·  SINGLE BLOCK",
    ):
        operator.sees(text)
    operator.key("Next")
    operator.sees("704  ·  PROGRAM STOP")
    operator.sees("CHECK THE BORE")


def test_first_of_two_alarms_is_shown_first_and_both_are_listed(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.breaks("drive_fault", "X", "over current")
    operator.reaches("ALARM")
    operator.breaks("spindle_fault", "undervoltage")
    operator.until(lambda: len(operator.machine["alarms"]) == 2, "two alarms")
    operator.sees("X: over current")
    operator.sees(wording("screen.alarm", number=101, what=wording("stories.axis-drive-fault").upper()))
    operator.sees(f"201 {wording('stories.spindle-drive-fault').upper()}")
    operator.keys("F1", "F8")
    operator.sees(wording("screen.alarm", number=101, what=wording("stories.axis-drive-fault").upper()))
    operator.sees(wording("stories.more", count=1))
    is_in_f7(operator, "axis", "spindle")


def test_silent_station_causes_hold_with_reason_and_cycle_resumes(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.breaks("station_silent")
    operator.reaches("FEED HOLD")
    operator.rests()
    is_told_on_every_page(operator, "station-silent")
    assert in_status(operator, 601)["cause"] == CATALOG["station-silent"].causes[0]
    operator.breaks("station_silent", False)
    operator.keys("F1", "F2")
    operator.during(0.5)
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")


def test_computer_stall_is_reported_in_plain_words(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.stops_the_process()
    operator.during(2.5)  # longer than what is queued
    operator.lets_it_go_on()
    operator.reaches("FEED HOLD")
    operator.rests()
    assert operator.machine["alarms"] == []
    screen = operator.screen
    texts = " ".join([screen["prompt"], screen["state"], *(each[0] for each in screen["texts"])])
    assert "slowing this computer down" in texts
    assert not [word for word in OURS if word in texts]
    operator.during(0.5)
    operator.cycle_start()
    operator.reaches("RUNNING", "WAITING")
    operator.lets_it_run(lambda: operator.state == "READY", "the end")
    assert operator.machine["parts"] == 1


def test_f7_distinguishes_feed_hold_by_h_and_by_esc(story: Story) -> None:
    operator = story.begins(LONG, tools=TOOLS)
    in_the_cut(operator)
    operator.key("h")
    operator.reaches("FEED HOLD")
    operator.rests()
    operator.cycle_start()
    operator.reaches("RUNNING")
    operator.during(0.2)
    operator.key("Escape")
    operator.reaches("FEED HOLD")
    operator.key("F7")
    operator.sees(f"by {wording('stories.key-or-finger')}")
    operator.sees(f"by {wording('stories.esc-at-screen')}")
