"""Tool life by parts and by cutting time, with counts, a warning and the end of the tool life."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from core.message import CodedError, Message

MAX_LIMIT_PARTS = 1_000_000
MAX_LIMIT_SECONDS = 60.0 * 100_000
DEFAULT_WARNING_SHARE = 0.9  # share of the life at which a warning is shown


class ToolLifeError(CodedError, ValueError):
    """Error raised for invalid tool life limits; the message names the limit and the remedy."""


class ToolLifeState(Enum):
    """The state of a tool's life: no limit, OK, warning or used up."""

    NO_LIMIT = "no limit"
    OK = "good"
    WARNING = "warned"
    USED_UP = "spent"


@dataclass(frozen=True, slots=True)
class ToolLife:
    """The life of one tool since its insert was changed.

    A limit of 0 means no limit. If ``stops`` is True, no further part starts after the end of the tool
    life.
    """

    number: int
    limit_parts: int = 0
    limit_seconds: float = 0.0
    parts: int = 0
    seconds: float = 0.0
    warn: float = DEFAULT_WARNING_SHARE
    stops: bool = False

    @property
    def share(self) -> float:
        """Return the used fraction of the tool life, or 0 without a limit.

        With two limits, this is the greater of both fractions.
        """
        by_parts = self.parts / self.limit_parts if self.limit_parts else 0.0
        by_time = self.seconds / self.limit_seconds if self.limit_seconds else 0.0
        return max(by_parts, by_time)

    @property
    def state(self) -> ToolLifeState:
        """Return the state of the tool life.

        The state is WARNING from the used fraction ``warn`` on, and USED_UP at the limit.
        """
        if not (self.limit_parts or self.limit_seconds):
            return ToolLifeState.NO_LIMIT
        if self.share >= 1.0 - 1e-9:
            return ToolLifeState.USED_UP
        return ToolLifeState.WARNING if self.share >= self.warn - 1e-9 else ToolLifeState.OK

    @property
    def remaining_part_count(self) -> int | None:
        """Return the number of complete parts until the end of the tool life, or None if it is unknown.

        For a time limit, the number is calculated from the average time per part.
        """
        left = []
        if self.limit_parts:
            left.append(max(0, self.limit_parts - self.parts))
        if self.limit_seconds and self.parts and self.seconds > 0.0:
            left.append(
                math.ceil(max(0.0, self.limit_seconds - self.seconds) / (self.seconds / self.parts) - 1e-9)
            )
        return min(left) if left else None

    @property
    def words(self) -> str:
        """Return the used tool life as text, such as ``50 of 50 parts`` or ``31 of 30 min``.

        With two limits, the text refers to the limit that will be reached first.
        """
        by_parts = self.parts / self.limit_parts if self.limit_parts else -1.0
        by_time = self.seconds / self.limit_seconds if self.limit_seconds else -1.0
        if by_parts < 0.0 and by_time < 0.0:
            return Message(
                "{parts} parts, {seconds} min", parts=self.parts, seconds=f"{self.seconds / 60.0:.1f}"
            )
        if by_parts >= by_time:
            return Message("{parts} of {limit_parts} parts", parts=self.parts, limit_parts=self.limit_parts)
        return Message(
            "{seconds} of {limit_seconds} min",
            seconds=f"{self.seconds / 60.0:.1f}",
            limit_seconds=f"{self.limit_seconds / 60.0:g}",
        )


def check_tool_life(life: ToolLife) -> None:
    """Check the limits and the warning fraction of a tool life.

    The limits are 0 to 1,000,000 parts and 0 to 100,000 min, where 0 means no limit. The warning fraction
    is above 0 and at most 1. Raises ToolLifeError for any other value.
    """
    if not 0 <= life.limit_parts <= MAX_LIMIT_PARTS:
        raise ToolLifeError(
            Message(
                "T{number}: tool life must be 0 to {parts_most} parts; 0 means no limit",
                number=life.number,
                parts_most=MAX_LIMIT_PARTS,
            ),
            "limit-in-parts",
        )
    if not (math.isfinite(life.limit_seconds) and 0.0 <= life.limit_seconds <= MAX_LIMIT_SECONDS):
        raise ToolLifeError(
            Message(
                "T{number}: tool life must be 0 to {seconds_most} cutting minutes; 0 means no limit",
                number=life.number,
                seconds_most=f"{MAX_LIMIT_SECONDS / 60.0:g}",
            ),
            "limit-in-minutes",
        )
    if not 0.0 < life.warn <= 1.0:
        raise ToolLifeError(
            Message(
                "T{number}: the tool-life warning must be set between 1 and 100 % of the tool life",
                number=life.number,
            ),
            "warning-share",
        )
