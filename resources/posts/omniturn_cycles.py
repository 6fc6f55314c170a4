"""Drilling, tapping and threading of the FreeCAD post-processor.

FreeCAD does not show this file in its list. Copy it together with ``omniturn_post.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING or __package__:
    from resources.posts.omniturn_lines import NEAR_MM, LineWriter, number
else:
    from omniturn_lines import NEAR_MM, LineWriter, number

MAX_INFEED_ANGLE_DEG = 30.0
MAX_TAP_PITCH_MM = 5.08  # .2 in/rev, the highest feed of the control without G35
REVERSAL_S = 0.5  # dwell in which the spindle reverses


class CycleWriter(LineWriter):
    """Writer of the cycles on the spindle axis."""

    def drill(self, name: str, values: dict[str, float]) -> None:
        """Write a drilling cycle on the spindle axis."""
        self.cycle_feed = values.get("F", self.cycle_feed)
        plane, high = self.approach_hole(name, values)
        self.write_hole(name, values, plane, 0.0)
        if self.returns_to_start:
            self.rapid(0.0, high)

    def write_hole(self, name: str, values: dict[str, float], plane: float, x: float) -> None:
        """Write the cycle of a hole along Z from R, where the tool is, back to R. ``x`` is a radius."""
        bottom = values["Z"]
        if name in {"G73", "G83"}:
            peck = values.get("Q", 0.0)
            if peck <= 0.0:
                self.reject(name, "the peck depth Q is missing")
            self.cycle(name, "G83" + self.word("Z", bottom) + self.word("K", peck))
        elif values.get("P", 0.0) > 0.0:
            self.cut(name, x, bottom, self.cycle_feed)
            self.dwell(values["P"])
            self.rapid(x, plane)
        else:
            self.cycle(name, "G81" + self.word("Z", bottom))

    def tap(self, name: str, values: dict[str, float], pitch: float) -> None:
        """Write the moves of a tap in a floating holder: feed in at the pitch, reverse, and feed out.

        ``pitch`` is in mm. F of the command is not used, because its meaning depends on the version of
        FreeCAD.
        """
        forward, reverse = ("M3", "M4") if name == "G84" else ("M4", "M3")
        if pitch <= 0.0:
            self.reject(name, f"the pitch is unknown; enter it in the tool, or use --pitch {self.tool}=PITCH")
        if pitch > MAX_TAP_PITCH_MM:
            self.reject(name, f"a pitch of {pitch:g} mm is more than the largest feed of the control")
        if self.spindle_code != forward:
            self.reject(name, f"the spindle must turn with {forward}; select it in the tool controller")
        if values.get("S", self.speed) != self.speed:
            self.reject(name, "S differs from the spindle speed of the tool controller")
        plane, high = self.approach_hole(name, values)
        words = f"G95F{number(pitch / self.unit, 6)}"
        self.add(words + self.word("Z", values["Z"]))
        self.add(f"M0{reverse[1:]}")
        self.dwell(max(values.get("P", 0.0), REVERSAL_S))
        self.add(words + self.word("Z", plane))
        self.is_rapid, self.feed_words, self.z = False, words, plane
        self.spindle(forward, self.speed)
        if self.returns_to_start:
            self.rapid(0.0, high)

    def approach_hole(self, name: str, values: dict[str, float]) -> tuple[float, float]:
        """Write the rapids to R above a hole on the spindle axis; return R and the highest Z of them."""
        if abs(values.get("X", self.x or 0.0)) > NEAR_MM or abs(values.get("Y", 0.0)) > NEAR_MM:
            self.reject(name, "the hole is not on the spindle axis; name a live tool with --face")
        start, plane = self.z, self.read_hole_plane(name, values)
        high = max(plane, start) if start is not None else plane
        if start is not None and start < plane:
            self.rapid(self.x, plane)  # first in Z, so that the tool does not cross the part on its way to X0
        self.rapid(0.0, high)
        self.rapid(0.0, plane)
        return plane, high

    def read_hole_plane(self, name: str, values: dict[str, float]) -> float:
        """Return R of a cycle, at which the feed begins. Reject a hole whose bottom is not below R."""
        if "Z" not in values or "R" not in values:
            self.reject(name, "the cycle has no Z or no R")
        if values["Z"] >= values["R"]:
            self.reject(name, "the bottom of the hole is not below R")
        return values["R"]

    def cycle(self, name: str, words: str) -> None:
        """Write a line with a drilling cycle, after which the tool is at the start point again."""
        self.check_spindle(name)
        feed = self.feed(name, self.cycle_feed)
        self.add(words if not feed else feed + words)

    def thread(self, name: str, values: dict[str, float]) -> None:
        """Write the thread of a G76 as FreeCAD's turning operations use it.

        P is the lead, I the distance from the current X to the crest, J the first depth, K the full depth,
        Q the infeed angle and H the number of spring passes.
        """
        missing = [letter for letter in "PIJK" if not values.get(letter)] + ([] if "Z" in values else ["Z"])
        if self.x is None or self.z is None or self.needs_both or missing:
            self.reject(name, f"the thread needs a known position and {' '.join(missing) or 'X Z'}")
        self.check_spindle(name)
        line_x, line_z, inward = self.x, self.z, -1.0 if values["I"] < 0.0 else 1.0
        first, depth = values["J"], values["K"]
        if not 0.0 < first <= depth or values.get("Q", 0.0) > MAX_INFEED_ANGLE_DEG:
            self.reject(name, f"use 0 < J <= K, and Q up to {MAX_INFEED_ANGLE_DEG:g} degrees")
        crest = line_x + values["I"]
        self.rapid(crest + inward * first, line_z)
        words = "G33" + self.word("X", crest + inward * depth) + self.word("Z", values["Z"])
        words += "I" + number(2.0 * self.round(first)) + "K" + number(values["P"] / self.unit, 8)
        self.add(words + (f"C{number(values['Q'], 2)}" if values.get("Q") else ""))
        for _ in range(int(values.get("H", 0.0))):
            self.add(words + "O")
        self.rapid(line_x, line_z)
