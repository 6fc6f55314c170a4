"""The interrupted job: a program that began and did not come to its end, and where its tool stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from math import isfinite

from core.message import Message
from core.tool_edges import edge_name

CONTROL_LOST = "THE CONTROL LOST POWER OR ITS PROCESS WAS KILLED"
CLOSED = "TURNDESK WAS CLOSED"
GIVEN_UP = "CANCELED BY RESET"
ESTOP = "E-STOP"

_TEXTS = ("program", "job", "text", "why", "at")
_NUMBERS = ("line", "block", "begun", "tool", "part")


@dataclass(frozen=True, slots=True)
class InterruptedJob:
    """Which job, at which line, with which tool, and where that stands.

    ``where`` is machine positions in the order of ``axes``: mm with X a radius, and degrees. ``part`` is the
    number of the part that was being made, ``begun`` how many elementary blocks of it were begun without a
    gap. ``at`` is the time of day, UTC, ISO 8601.
    """

    program: str  # name of its file
    job: str  # digest of the loaded job: text, offsets, switches
    text: str  # digest of the text alone
    line: int
    block: int  # elementary block, counted through the whole run: the pass of a loop follows from it
    begun: int
    tool: int
    part: int
    axes: tuple[str, ...]
    where: tuple[float, ...]
    why: str
    at: str

    @property
    def words(self) -> str:
        """Program, line, tool, part and cause in a few words, for the log and for sentences."""
        return Message(
            "{program}, line {line}, {tool}, part {part}: {why}",
            program=self.program,
            line=self.line,
            tool=edge_name(self.tool),
            part=self.part,
            why=self.why,
        )


def plain(kept: InterruptedJob) -> dict[str, object]:
    """The interrupted job as JSON can hold it."""
    return asdict(kept) | {"axes": list(kept.axes), "where": list(kept.where)}


def of_plain(value: object) -> InterruptedJob | None:
    """The interrupted job that was stored; None where there is none, or none that can be understood."""
    if not isinstance(value, Mapping):
        return None
    try:
        where = tuple(float(x) for x in value["where"])
        axes = tuple(str(name) for name in value["axes"])
        texts = {name: str(value[name]) for name in _TEXTS}
        numbers = {name: int(value[name]) for name in _NUMBERS}
    except (KeyError, TypeError, ValueError, OverflowError):
        return None
    known = bool(texts["program"]) and len(where) == len(axes) and all(isfinite(x) for x in where)
    return InterruptedJob(**texts, **numbers, axes=axes, where=where) if known else None  # type: ignore[arg-type]


def utc_now() -> str:
    """The time of day, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
