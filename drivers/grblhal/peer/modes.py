"""The look-alike's modal state, and the words that change it."""

from __future__ import annotations

from dataclasses import dataclass

_MODAL = {
    **dict.fromkeys(("G0", "G1", "G2", "G3", "G33"), "motion"),
    **dict.fromkeys(("G17", "G18"), "plane"),
    **dict.fromkeys(("G20", "G21"), "units"),
    **dict.fromkeys(("G90", "G91"), "distance"),
    **dict.fromkeys(("G94", "G95"), "feed_mode"),
    **dict.fromkeys(("G7", "G8"), "radius"),
    **dict.fromkeys(("G96", "G97"), "speed"),
    **dict.fromkeys(("G50", "G51"), "scaling"),
}
_LATHE = frozenset(("G7", "G8", "G96", "G97"))
_PLAIN = frozenset(("G4", "G10", "G49", "G53", "G54", "G92.1"))


@dataclass(slots=True)
class Modes:
    """A reset and a stop bring back these."""

    motion: str = "G0"
    plane: str = "G17"
    units: str = "G21"
    distance: str = "G90"
    feed_mode: str = "G94"
    radius: str = "G8"
    speed: str = "G97"
    scaling: str = "G50"
    hold_disabled: bool = False  # M53 P0

    def take(self, code: str, *, lathe: bool) -> int:
        """A word; the error, 0 for none."""
        if code in _LATHE and not lathe:
            return 20
        if code in _MODAL:
            setattr(self, _MODAL[code], code)
        elif code not in _PLAIN:
            return 20
        return 0

    def told(self, rpm: float, feed: float, outputs: dict[str, bool], *, lathe: bool) -> str:
        """As ``$G`` says it."""
        spindle = "M5" if not rpm else "M3" if rpm > 0.0 else "M4"
        coolant = "M7 " * outputs.get("mist", False) + "M8 " * outputs.get("flood", False) or "M9 "
        radius, speed = (f" {self.radius}", f" {self.speed}") if lathe else ("", "")
        scaling = "G51:X" if self.scaling == "G51" else "G50"
        held = "M53 " if self.hold_disabled else ""
        return (
            f"[GC:{self.motion} G54{radius} {self.plane} {self.units} {self.distance} {self.feed_mode}"
            f"{speed} G49 G98 {scaling} {spindle} {coolant}{held}T0 F{feed:.0f} S{abs(rpm):.0f}.]"
        )
