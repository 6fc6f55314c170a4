"""How fast TurnDesk should be, by the rows of docs/speed.md, and why it is not where it is not.

A reason is what a profile showed (docs/decisions/0002-no-compiled-core.md), not an excuse:
who gets rid of it takes it out here. Goals are seconds of processor time, MiB, or ms where the row says ms.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple


class Goal(NamedTuple):
    """The goal of a row, and the reason why it is not met.

    ``most`` is in the unit of the row. ``memory`` is in MiB, and ``peer`` is the time as a multiple of the
    time of rs274; 0 means that there is no such goal.
    """

    most: float
    why: str
    memory: float = 0.0
    peer: float = 0.0


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
    "prove 100,000 blocks": Goal(
        0.33, f"{_IMPORTS}; the proof itself takes two fifths of the time", peer=1.0
    ),
    "prove 1,000,000 blocks": Goal(
        1.2,
        "smoothing the corners between rounded coordinates takes a third of the time; the block table, the "
        "segments and the limits take a fifth, the plan takes a seventh, and reading the lines into columns "
        "takes a tenth; starting the process and reading the text take 0.35 s",
        memory=170.0,
        peer=0.35,
    ),
    "prove 60,000 lines with the part": Goal(
        2.5,
        "each short line is cut from the part and checked separately, half of the time for each",
    ),
    "prove 2,282 thread passes with the part": Goal(
        0.3,
        "each pass is cut from the part and checked separately, although most passes are alike; the plan of "
        "all passes takes a tenth of the time",
    ),
    "profile --list, spline of 24,000 points, 1.3 MB": Goal(
        1.0,
        "reading the file into arcs takes half of the time; joining the ends of 48,000 arcs takes the rest",
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
        1.0,
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


def goal_of(name: str, pattern: str, kind: str = "most") -> str:
    """Return the goal of a row as the table shows it; a dash if there is none of this kind."""
    goal = getattr(GOALS.get(name), kind, 0.0)
    return pattern.format(goal) if goal else "–"


def not_met(figures: Mapping[str, Sequence[float]]) -> Iterator[str]:
    """Yield a sentence for each row that exceeds a goal: of its time, of its memory or of the peer."""
    for name, found in figures.items():
        goal = GOALS.get(name)
        if goal is not None and any(
            most and figure > most
            for figure, most in zip(found, (goal.most, goal.memory, goal.peer), strict=False)
        ):
            yield f"{name}: {goal.why}."
