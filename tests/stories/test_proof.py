"""What the proof refuses before anything moves, as the operator sees it."""

from __future__ import annotations

import pytest

from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.texts import opening, text

TOOLS = {1: (0.0, 0.0)}
HEAD = "G90G94F300\nT1\nM03S600\nX.5Z.5\n"
BAR = f"{HEAD}M97I10C1P1\nM30\n}}1\nM05\nZ9\nM99\n"


def beyond(place: str) -> str:
    """Return how the finding begins that Z would leave its travel; ``place`` is in inches."""
    return opening("findings.would-go-to", axis="Z", place=place, unit="in")


def is_refused(operator: Operator, line: int, why: str, remedy: str) -> None:
    """The prompt line says line, reason and remedy, and both palms start nothing."""
    operator.drives_on()

    def told() -> bool:
        prompt = operator.prompt
        return prompt.startswith(text("screen.will-not-run", why=f"LINE {line}: ")) and why in prompt

    operator.until(told, f"the refusal of line {line} with {why!r}")
    operator.sees(remedy)
    stands = operator.slides
    operator.cycle_start()
    operator.keeps(lambda: operator.state == "READY", 1.0, "READY")
    assert operator.is_at(stands)
    assert operator.status["execution"] in {"READY", "PROGRAM_STOPPED", "INTERRUPTED", "STOPPED"}
    assert operator.events("part") == []


def test_limit_violation_with_bar_end_input_rejects_program(story: Story) -> None:
    operator = story.begins(BAR, tools=TOOLS)
    at = text("findings.input-at", number=10, state="on", line=5)
    why = text("findings.with-input", input=at, what=beyond("9.0000"))
    is_refused(operator, 9, why, "check the Z word")


def test_limit_violation_under_block_delete_rejects_program(story: Story) -> None:
    operator = story.begins(f"{HEAD}/G91Z6\n/G90\nZ0\nM30\n", tools=TOOLS)
    is_refused(operator, 5, beyond("6.5000"), "check the Z word")


@pytest.mark.parametrize(
    ("lines", "line", "why", "remedy"),
    [
        ("M13\nG95F.004Z-.2\nM12\n", 6, text("findings.cuts-with-open-collet"), "Close the collet with M12"),
        (
            "T0\nX.5Z.4\nF5Z.3\n",
            7,
            text("findings.cuts-after", what="the tool cancel (T0) on line 5"),
            "Write T and the tool number",
        ),
        (
            "M05\nX-.5Z.1\nF20\nM19S60\nG04F3\n(~PLXC)\n(X.25Y0)\n(END)\n",
            11,
            text("findings.mills-without-live-tool"),
            "M15 or M27",
        ),
        ("M97I99C1P1\nM30\n}1\nG04F1\nM99\n", 5, text("findings.no-input", number=99), "Correct the number"),
        ("X.4 RETRACT\n", 5, text("findings.text-outside", text="RETRACT"), "Write (RETRACT)."),
    ],
)
def test_error_that_could_cause_a_crash_is_reported_with_remedy(
    story: Story, lines: str, line: int, why: str, remedy: str
) -> None:
    end = "" if "M30" in lines else "M30\n"
    is_refused(story.begins(f"{HEAD}{lines}{end}", tools=TOOLS), line, why, remedy)


def test_program_without_tool_may_start_with_a_warning(story: Story) -> None:
    operator = story.begins("G90G94F300\nM03S600\nX.5Z.5\nF20Z.3\nM30\n", tools=TOOLS)
    operator.drives_on()
    operator.sees(text("screen.line-what", line=4, what=text("desk.cuts-without-tool").partition(":")[0]))
    assert text("screen.to-start") in operator.prompt


def test_bar_program_with_valid_branches_runs_both_branches(story: Story) -> None:
    good = BAR.replace("Z9", "Z.8").replace("F300", "F100")
    operator = story.begins(good, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
    operator.reaches("READY")
    assert operator.is_at((0.5 * 25.4, 0.5 * 25.4))
