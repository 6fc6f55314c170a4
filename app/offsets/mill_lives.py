"""Tool life of a mill in its tool table: the column CUR.TIME, what each tool has cut since it was fresh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.desk.desk import Desk
from core.production.tool_life import ToolLife


def _none() -> Mapping[int, ToolLife]:
    return {}


@dataclass(slots=True)
class MillLives:
    """``lives`` by tool, the same object while nothing changes; ``set_used`` a tool's cutting seconds, 0 of a
    fresh tool."""

    lives: Callable[[], Mapping[int, ToolLife]] = _none
    set_used: Callable[[int, float], None] = lambda _number, _seconds: None

    def close(self) -> None:
        """Nothing of it runs."""

    @classmethod
    def of(cls, desk: Desk) -> MillLives:
        """Those of this desk; a desk that counts nothing has none."""
        found = desk.attached(cls)
        return found if found is not None else cls()
