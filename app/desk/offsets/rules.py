"""What a typed value does: it corrects a secondary offset, it becomes a tool offset."""

from __future__ import annotations

from app.desk.offsets.dialogue import Mode, Step
from app.desk.offsets.figures import Triple, added, to_mm
from core.store.rows import SECONDARY_REACH, TOOL_REACH, Kind


class SecondaryRules:
    """F9, in the control's words: X halved and added, Z added, R becomes the value."""

    kind, letter, reach = Kind.SECONDARY, "D", SECONDARY_REACH
    _WORDS = ("Offset Number?", "X DIAMETER CORRECTION?", "Z CORRECTION?", "R?")

    def question(self, step: Step, _mode: Mode) -> str:
        """The prompt of this step."""
        return self._WORDS[step]

    def value(self, step: Step, old: float, typed: float, mode: Mode) -> float:
        """What ``old`` (mm) becomes."""
        if step is Step.R:
            return to_mm(typed, mode.metric)
        return added(old, typed / 2 if step is Step.X else typed, mode.metric)

    def refusal(self, _step: Step, _old: Triple | None) -> str:
        """Bare Return keeps, always."""
        return ""


class ToolRules:
    """F8: every value becomes what is typed. X as a diameter or a radius, as the control shows it."""

    kind, letter, reach = Kind.TOOL, "T", TOOL_REACH

    def question(self, step: Step, mode: Mode) -> str:
        """The prompt of this step."""
        x = "X DIAMETER?" if mode.diameter else "X RADIUS?"
        return ("Tool Number?", x, "Z?", "NOSE RADIUS?")[step]

    def value(self, step: Step, _old: float, typed: float, mode: Mode) -> float:
        """What is typed, mm and X as a radius."""
        return to_mm(typed / 2 if step is Step.X and mode.diameter else typed, mode.metric)

    def refusal(self, step: Step, old: Triple | None) -> str:
        """A tool that was never set has nothing to keep: half an offset would run into the part."""
        if old is None and step in {Step.X, Step.Z}:
            return f"this tool was never set; type {step.name}"
        return ""
