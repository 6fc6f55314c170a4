"""Live tools of the FreeCAD post-processor: milling in the planes XC and ZC, and holes at C angles.

FreeCAD does not show this file in its list. Copy it together with ``omniturn_post.py``.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING or __package__:
    from resources.posts.omniturn_cycles import CycleWriter
    from resources.posts.omniturn_lines import NEAR_MM, number
else:
    from omniturn_cycles import CycleWriter
    from omniturn_lines import NEAR_MM, number

RAPID_MM_MIN = 1270.0  # feed instead of a rapid while a plane is active, because OmniTurn has no rapid there
C_STEP_DEG = 0.02  # resolution of C
MIN_ENTRY_MM = 1.0  # the plane XC cannot be entered on the spindle axis
PECK_CLEARANCE_MM = 0.5
_TOLERANCE_MM = 0.002  # of the lines that replace a helix
_ARC_TOLERANCE_MM = 0.01


class MillPoint(NamedTuple):
    """A position of FreeCAD's path in mm; a coordinate is None while it is unknown."""

    x: float | None = None
    y: float | None = None
    z: float | None = None


class LiveTool:
    """Live tool on the negative X side, with the state of C and of the plane.

    ``side_diameter`` is the diameter of the cylinder whose unrolled side the path shows, or 0 if the path is
    on the face. ``high`` is the highest Z of the paths on the side. Lengths are in mm.
    """

    def __init__(self, writer: CycleWriter, side_diameter: float, high: float) -> None:
        """Begin with a tool that is not in a plane."""
        self.writer, self.radius, self.high = writer, side_diameter / 2.0, high
        self.at = MillPoint()
        self.is_running = self.is_in_plane = False
        self.c: float | None = None  # degrees; None while unknown

    # --- C axis

    def lock_spindle(self) -> None:
        """Write M19, which turns C to 0 by at most one revolution, and a dwell for this time."""
        rpm = self.writer.options.c_rpm
        self.writer.add(f"M19S{number(rpm, 1)}")
        self.writer.dwell(math.ceil(600.0 / rpm) / 10.0 + 0.5)
        self.writer.forget_modes()
        self.c = 0.0

    def rotate(self, angle_deg: float) -> None:
        """Write the shortest rotation of C to an angle, and a dwell for this time."""
        if self.c is None:
            self.lock_spindle()
        assert self.c is not None
        goal = C_STEP_DEG * round(angle_deg / C_STEP_DEG)
        goal += 360.0 * round((self.c - goal) / 360.0)
        turn, rpm = abs(goal - self.c), self.writer.options.c_rpm
        if turn > C_STEP_DEG / 2.0:
            self.writer.add(f"CA{number(goal, 2)}S{number(rpm, 1)}")
            self.writer.dwell(math.ceil(turn / (0.6 * rpm)) / 10.0 + 0.5)
            self.writer.forget_modes()
            self.c = goal

    # --- moves in the plane

    def enter_plane(self, x: float, y: float) -> None:
        """Write the approach, C0 and the start of the plane, and move over the point at the clear height."""
        writer, quick = self.writer, number(RAPID_MM_MIN / self.writer.unit, 4)
        if self.radius:
            self.approach_side(0.0)
        else:
            writer.rapid(-max(math.hypot(x, y), MIN_ENTRY_MM), writer.get_clear_z())
        if self.c != 0.0:
            self.lock_spindle()
        writer.add(f"G94F{quick}")
        writer.forget_modes()
        writer.lines.append("(~PLZC)" if self.radius else "(~PLXC)")
        self.is_in_plane = True
        if self.radius:
            self.add_plane_line(f"D{number(2.0 * writer.round(self.radius))}")
        elif math.hypot(x, y) >= MIN_ENTRY_MM and abs(y) + abs(x - math.hypot(x, y)) > NEAR_MM:
            code = "G03" if y >= 0.0 else "G02"  # around the axis, because a line could pass through it
            self.add_plane_line(f"{code}{self.xy_words(x, y)}I0J0F{quick}")
        self.add_move(x, y, self.clear_height(), RAPID_MM_MIN)

    def leave_plane(self) -> None:
        """Write the retract to the clear height and the end of the plane, if a plane is active.

        Z of the path is unknown after the retract, so the next cut needs a rapid in Z.
        """
        if not self.is_in_plane:
            return
        x, y, z = self.at
        assert x is not None
        assert y is not None
        assert z is not None
        if z < self.clear_height():
            self.add_move(x, y, self.clear_height(), RAPID_MM_MIN)
            self.at = MillPoint(x, y)
        self.writer.lines.append("(END)")
        self.is_in_plane, self.c, self.writer.needs_both = False, None, True
        self.writer.x = -(self.radius + self.high) if self.radius else -math.hypot(x, y)
        self.writer.z = -x if self.radius else max(z, self.writer.get_clear_z())

    def clear_height(self) -> float:
        """Return the Z of FreeCAD's path at which the tool is clear of the part."""
        return self.high if self.radius else self.writer.get_clear_z()

    def add_plane_line(self, words: str) -> None:
        """Append a line of the plane, which has no comment."""
        self.writer.lines.append(f"({words})")

    def xy_words(self, x: float, y: float, names: str = "XY") -> str:
        """Return the words of a point in the plane; X is not a diameter there."""
        words = (names[0] + number(self.writer.round(x)), names[1] + number(self.writer.round(y)))
        return "".join(words)

    def add_move(self, x: float, y: float, z: float, feed_mm_min: float) -> None:
        """Append a straight line of the plane with all its words. Z of the side is a diameter."""
        z_value = 2.0 * self.writer.round(self.radius + z) if self.radius else self.writer.round(z)
        feed = number(feed_mm_min / self.writer.unit, 4)
        self.add_plane_line(f"{self.xy_words(x, y)}Z{number(z_value)}F{feed}")

    def move(self, name: str, values: dict[str, float]) -> None:
        """Write a move of the path."""
        before = self.at
        goal = MillPoint(*(values.get(letter, old) for letter, old in zip("XYZ", before, strict=True)))
        self.at = goal
        if name == "G0" and not self.is_in_plane:
            return  # the plane begins with the next cut, above its start
        (x0, y0, z0), (x, y, z) = before, goal
        if x0 is None or y0 is None or z0 is None or x is None or y is None or z is None:
            self.writer.reject(name, "the position before this cut is unknown; begin with a rapid")
        if not self.is_in_plane:
            self.start_path(name, x0, y0, z0)
        if name == "G0":
            self.add_move(x, y, z, RAPID_MM_MIN)
            return
        feed = self.read_feed(name, values)
        if name == "G1":
            self.add_move(x, y, z, feed)
        else:
            self.add_arc(name, values, (x0, y0, z0), (x, y, z), feed)

    def start_path(self, name: str, x: float, y: float, z: float) -> None:
        """Enter the plane over a point and move down to its Z."""
        self.check_running(name)
        self.enter_plane(x, y)
        if abs(z - self.clear_height()) > NEAR_MM:
            self.add_move(x, y, z, RAPID_MM_MIN)

    def read_feed(self, name: str, values: dict[str, float]) -> float:
        """Return the feed of a cut in mm/min."""
        self.writer.cut_feed = values.get("F", self.writer.cut_feed)
        if self.writer.cut_feed <= 0.0:
            self.writer.reject(name, "the feed is 0; enter the feeds in the tool controller")
        return self.writer.cut_feed * 60.0

    def check_running(self, name: str) -> None:
        """Reject a move of a live tool that is not turning."""
        if not self.is_running:
            self.writer.reject(name, "the live tool is stopped; start its spindle in the tool controller")

    def add_arc(
        self,
        name: str,
        values: dict[str, float],
        start: tuple[float, float, float],
        end: tuple[float, float, float],
        feed: float,
    ) -> None:
        """Append an arc in at most two parts, or a helix in straight lines."""
        (x0, y0, z0), (x, y, z) = start, end
        if abs(values.get("K", 0.0)) > NEAR_MM:
            self.writer.reject(name, "the arc is not in the XY plane of the path")
        cx, cy = x0 + values.get("I", 0.0), y0 + values.get("J", 0.0)
        radius = math.hypot(x0 - cx, y0 - cy)
        if radius < NEAR_MM or abs(math.hypot(x - cx, y - cy) - radius) > _ARC_TOLERANCE_MM:
            self.writer.reject(name, "the end of the arc is not on its circle")
        if 0.0 < math.hypot(x - x0, y - y0) < NEAR_MM:
            self.add_move(x, y, z, feed)  # an arc of the rounding error, not a full circle
            return
        sign = 1.0 if name == "G3" else -1.0
        begin = math.atan2(y0 - cy, x0 - cx)
        sweep = sign * (math.atan2(y - cy, x - cx) - begin) % (2.0 * math.pi) or 2.0 * math.pi
        is_helix = abs(z - z0) > NEAR_MM
        most = 2.0 * math.acos(max(1.0 - _TOLERANCE_MM / radius, 0.0)) if is_helix else math.pi + 1e-9
        count = math.ceil(sweep / most)
        from_words = self.xy_words(x0, y0)
        for part in range(1, count + 1):
            at, share = begin + sign * sweep * part / count, part / count
            to_x, to_y = cx + radius * math.cos(at), cy + radius * math.sin(at)
            if part == count:
                to_x, to_y = x, y
            is_short = self.xy_words(to_x, to_y) == from_words  # an arc to its start is a full circle
            from_words = self.xy_words(to_x, to_y)
            if is_helix or is_short:
                self.add_move(to_x, to_y, z0 + share * (z - z0), feed)
            else:
                code, center = ("G03" if name == "G3" else "G02"), self.xy_words(cx, cy, "IJ")
                rate = number(feed / self.writer.unit, 4)
                self.add_plane_line(f"{code}{self.xy_words(to_x, to_y)}{center}F{rate}")

    # --- holes at C angles

    def drill(self, name: str, values: dict[str, float]) -> None:
        """Write a hole: C turns it under the tool, and the tool returns to the clear height."""
        self.check_running(name)
        self.leave_plane()
        x, y = values.get("X", self.at.x), values.get("Y", self.at.y)
        if x is None or y is None:
            self.writer.reject(name, "the position of the hole is unknown")
        self.at = MillPoint(x, y)
        writer = self.writer
        writer.cycle_feed = values.get("F", writer.cycle_feed)
        plane = writer.read_hole_plane(name, values)
        if self.radius:
            self.drill_side(name, values, x, y)
            return
        rho = math.hypot(x, y)
        writer.rapid(-rho, writer.get_clear_z())
        self.rotate(-math.degrees(math.atan2(y, x)))
        writer.rapid(-rho, plane)
        writer.write_hole(name, values, plane, -rho)
        writer.rapid(-rho, writer.get_clear_z())

    def approach_side(self, z: float) -> None:
        """Write the rapids to a lathe Z over the side of the part: first X, then Z."""
        writer, out = self.writer, -(self.radius + self.high)
        writer.rapid(out, writer.get_clear_z() if writer.z is None else writer.z)
        writer.rapid(out, z)

    def drill_side(self, name: str, values: dict[str, float], x: float, y: float) -> None:
        """Write a radial hole with single moves, because the drilling cycles are along Z."""
        writer, feed = self.writer, self.writer.cycle_feed
        bottom, plane = (-(self.radius + values[letter]) for letter in "ZR")
        if bottom > 0.0:
            writer.reject(name, "the hole is deeper than the spindle axis")
        self.approach_side(-x)
        self.rotate(-math.degrees(y / self.radius))
        peck = values.get("Q", 0.0) if name in {"G73", "G83"} else bottom - plane
        if peck <= 0.0:
            writer.reject(name, "the peck depth Q is missing")
        writer.rapid(plane, -x)
        count = math.ceil((bottom - plane) / peck - NEAR_MM)
        for part in range(1, count + 1):
            if part > 1:
                writer.rapid(max(plane, plane + (part - 1) * peck - PECK_CLEARANCE_MM), -x)
            writer.cut(name, min(plane + part * peck, bottom), -x, feed)
            if part == count and name == "G82" and values.get("P", 0.0) > 0.0:
                writer.dwell(values["P"])
            writer.rapid(plane, -x)
        writer.rapid(-(self.radius + self.high), -x)
