"""Rotation of C while the tool is on the spindle centerline, before a move outward along X.

All dialects with a virtual mill use this module.
"""

from __future__ import annotations

from math import degrees

from core.interpreter.shared.diagnostic_log import DiagnosticLog

_SAME = 1e-9  # degrees; a smaller angle is not a turn
_WARNING_ANGLE_DEG = 1.0  # degrees; C may turn by this angle without a warning


def needs_centerline_rotation(log: DiagnosticLog, line: int, turn_rad: float) -> bool:
    """Return whether C must rotate by ``turn_rad`` radians on the centerline.

    A large rotation is logged as a warning, because the tool does not move during the rotation.
    """
    angle = abs(degrees(turn_rad))
    if angle > _WARNING_ANGLE_DEG:
        text = "The path passes through the spindle centerline, where C turns by {angle} degrees."
        hint = (
            "At the spindle centerline, the tool does not move while C turns; route the path around the "
            "centerline."
        )
        log.add_warning(line, 1, "plane-centre", text, hint, angle=f"{angle:.0f}")
    return angle > _SAME
