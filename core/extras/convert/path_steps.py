"""Steps of a turning program in a language-independent form: moves, spindle, tools and M codes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class StepKind(StrEnum):
    """Kind of a step of a turning program."""

    RAPID = "rapid"
    FEED = "feed"
    ARC = "arc"
    THREAD = "thread"
    HOME = "home"
    TOOL = "tool"
    SPINDLE = "spindle"
    DWELL = "dwell"
    M = "m"
    PRESET = "preset"
    NOSE = "nose"
    END = "end"


MOVE_KINDS = frozenset({StepKind.RAPID, StepKind.FEED, StepKind.ARC, StepKind.THREAD})


@dataclass(frozen=True, slots=True)
class SpindleState:
    """State of the spindle in a source program.

    ``direction`` is 1 for M03, -1 for M04 and 0 for a stopped spindle. ``speed`` is in rpm or, if
    ``is_css`` is True, in mm/s. ``max_rpm`` is the maximum rpm if ``is_css`` is True, otherwise 0.
    """

    direction: int = 0
    speed: float = 0.0
    is_css: bool = False
    max_rpm: float = 0.0


def has_same_speed(one: SpindleState, other: SpindleState) -> bool:
    """Return whether two spindle states are equal or differ only in the maximum speed."""
    return (one.direction, one.speed, one.is_css) == (other.direction, other.speed, other.is_css)


@dataclass(frozen=True, slots=True)
class PathStep:
    """One step of a turning program, in mm with X as a radius; an unknown coordinate is None.

    - ``x z``: end point; in a HOME step, only the axes that move have a value
    - ``cx cz``: center of an arc; ``clockwise`` is as seen with X+ toward the operator, as in OmniTurn
    - ``feed``: in mm/min, or in mm/rev if ``per_rev`` is True; the lead of a thread
    - ``number``: tool, M code, dwell in seconds, or the G code 40, 41 or 42 of nose compensation
    - ``comment``: comments of the source, separated by line feeds
    """

    kind: StepKind
    line: int
    x: float | None = None
    z: float | None = None
    cx: float = 0.0
    cz: float = 0.0
    clockwise: bool = False
    feed: float = 0.0
    per_rev: bool = False
    number: float = 0.0
    spindle: SpindleState = SpindleState()
    comment: str = ""
