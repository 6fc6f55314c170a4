"""How fast TurnDesk should be, by the rows of docs/speed.md, and why it is not where it is not.

A reason is what a profile showed (docs/decisions/0096, 0102, 0103 and 0114), not an excuse:
who gets rid of it takes it out here. Goals are seconds of processor time, MiB, or ms where the row says ms.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple


class Goal(NamedTuple):
    """``most``: as the figure of its row; ``memory``: MiB at most, 0: no goal; ``why`` it is not met."""

    most: float
    why: str
    memory: float = 0.0


_IMPORTS = (
    "95 dataclasses, which Python compiles, are .05 s of it, numpy .03, a bare interpreter .02, "
    "other modules .06"
)

GOALS: Mapping[str, Goal] = {
    "prove 200 blocks": Goal(
        0.15, f"{_IMPORTS}; the part made is .015, the proof of it .006, arguments and files .03"
    ),
    "headless, to the first setpoint": Goal(0.2, f"{_IMPORTS}; executor and drivers come on top"),
    "window usable": Goal(
        0.5,
        "Qt is .1 s of it, 270 dataclasses .13, numpy .03, our other modules .12, desk and window .08",
    ),
    "prove 1,000,000 blocks": Goal(
        1.2,
        "easing the joints of rounded words is a third of the work, table, pieces and limits a sixth, "
        "the plan a fifth, lines into columns a seventh; start and text are .35 s",
        memory=200.0,
    ),
    "expand 1,000,000 blocks": Goal(
        3.0, "the same look-ahead, for the times, is half of it; the rest writes the lines one by one"
    ),
    "expand --json 1,000,000 blocks": Goal(
        3.0, "the same look-ahead, for the times, is two fifths of it; the rest writes 330 MB, by columns"
    ),
    "prove 200 blocks, read anew": Goal(
        2.0,
        "hundreds of calls of numpy on short arrays; look-ahead is a third, reading and blocks another",
    ),
    "prove 20,000 blocks, read anew": Goal(50.0, "look-ahead over arrays is three quarters of it"),
}


def goal_of(name: str, pattern: str) -> str:
    """The goal of a row as the table shows it; a dash where there is none."""
    goal = GOALS.get(name)
    return "–" if goal is None else pattern.format(goal.most)


def not_met(figures: Mapping[str, Sequence[float]]) -> Iterator[str]:
    """A sentence for each row whose figure, or whose memory beside it, is over its goal."""
    for name, (figure, *memory) in figures.items():
        goal = GOALS.get(name)
        if goal is not None and (figure > goal.most or (goal.memory and memory and memory[0] > goal.memory)):
            yield f"{name}: {goal.why}."
