"""Control's totals when tool use was last stored, so that a restart adds only the difference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

TOTALS_SETTING = "tool_totals"  # key of the setting


@dataclass(frozen=True, slots=True)
class ToolUseTotals:
    """Totals of a control at the time when tool use was last stored.

    They are the finished parts, the cutting seconds of each tool, and the tools of the current part.
    """

    control_identity: str
    finished_part_count: int = 0
    cutting_seconds_by_tool: Mapping[int, float] = field(default_factory=dict)
    current_part_tools: frozenset[int] = frozenset()

    @property
    def setting_value(self) -> dict[str, object]:
        """Return the totals in the form in which they are stored as a setting."""
        cut = {str(number): seconds for number, seconds in self.cutting_seconds_by_tool.items()}
        return {
            "control": self.control_identity,
            "ends": self.finished_part_count,
            "cut": cut,
            "in_part": sorted(self.current_part_tools),
        }

    @classmethod
    def from_setting(cls, value: object) -> ToolUseTotals | None:
        """Return the totals from a stored setting, or None if the setting is missing or damaged."""
        match value:
            case {
                "control": str() as control,
                "ends": int() as ends,
                "cut": dict() as cut,
                "in_part": list() as in_part,
            }:
                try:
                    seconds = {int(number): float(each) for number, each in cut.items()}
                    return cls(control, ends, seconds, frozenset(map(int, in_part)))
                except (TypeError, ValueError):
                    return None
            case _:
                return None
