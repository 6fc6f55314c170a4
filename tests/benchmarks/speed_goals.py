"""How fast TurnDesk should be, by the rows of docs/speed.md, and why it is not where it is not.

A reason is what a profile showed (docs/decisions/0002-no-compiled-core.md), not an excuse:
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
    "Python needs 0.05 s to compile 95 dataclasses, 0.03 s to import numpy, 0.02 s for a bare "
    "interpreter and 0.06 s for other modules"
)

GOALS: Mapping[str, Goal] = {
    "prove 200 blocks": Goal(
        0.15,
        f"{_IMPORTS}; the model of the part takes 0.015 s, its proof 0.006 s, and the arguments and files "
        "0.03 s",
    ),
    "turndesk --help": Goal(
        0.066,
        "argparse and typing take twice the time of a bare interpreter; the optional features take half",
    ),
    "turndesk --version": Goal(
        0.066,
        "argparse and typing take twice the time of a bare interpreter; the optional features take half",
    ),
    "headless, to the first setpoint": Goal(0.2, f"{_IMPORTS}; the executor and the drivers take the rest"),
    "window usable": Goal(
        0.5,
        "Qt takes 0.1 s, 270 dataclasses take 0.13 s, numpy takes 0.03 s, other modules of TurnDesk take "
        "0.12 s, and the page models and the window take 0.08 s",
    ),
    "prove 1,000,000 blocks": Goal(
        1.2,
        "smoothing the corners between rounded coordinates takes a third of the time; the block table, the "
        "segments and the limits take a sixth, the plan takes a fifth, and reading the lines into columns "
        "takes a seventh; starting the process and reading the text take 0.35 s",
        memory=200.0,
    ),
    "expand 1,000,000 blocks": Goal(
        3.0,
        "the look-ahead for the times takes half of the time; writing the lines one by one takes the rest",
    ),
    "expand --json 1,000,000 blocks": Goal(
        3.0,
        "the look-ahead for the times takes two fifths of the time; writing 330 MB by columns takes the rest",
    ),
    "prove 200 blocks, read again": Goal(
        2.0,
        "the proof makes hundreds of numpy calls on short arrays; the look-ahead takes a third of the time, "
        "and reading the text and creating the blocks take another third",
    ),
    "prove 20,000 blocks, read again": Goal(
        50.0, "the look-ahead over arrays takes three quarters of the time"
    ),
    "prove 20,000 blocks with F on each, read again": Goal(
        40.0, "the look-ahead over arrays takes three quarters of the time"
    ),
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
