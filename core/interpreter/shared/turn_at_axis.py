"""Standing on the axis of a virtual mill: C turns until the way leads out along X, in every language."""

from __future__ import annotations

from math import degrees

from core.interpreter.shared.diagnostic_log import Log

_SAME = 1e-9  # degrees that are no turn
_TOLD = 1.0  # degrees that C turns there without a word about it


def turns_at_axis(log: Log, line: int, turn: float) -> bool:
    """Whether C turns there, by ``turn`` radians; a large turn is told, as the tool stands meanwhile."""
    angle = abs(degrees(turn))
    if angle > _TOLD:
        text = "The path passes through the spindle centerline, where C turns by {angle} degrees."
        hint = (
            "At the spindle centerline, the tool does not move while C turns; route the path around the "
            "centerline."
        )
        log.warn(line, 1, "plane-centre", text, hint, angle=f"{angle:.0f}")
    return angle > _SAME
