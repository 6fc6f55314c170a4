"""Program lines for a live tool in OmniTurn and SINUMERIK, with C axis and planes XC and ZC."""

from __future__ import annotations

import math
from typing import NamedTuple

from core.extras.shapes.lines.code_lines import CodeWriter, format_short_number, format_sinumerik_number
from core.extras.shapes.shape_fields import ProgramSettings

RAPID_RATE_IN_MIN = 50.0  # in/min, clear of the part in the plane


class RadialHoles(NamedTuple):
    """A row of radial holes around a part, all at the same Z.

    There are ``hole_count`` holes at ``hole_z``, starting at ``start_angle_deg`` in steps of
    ``angle_step_deg``. Each hole is drilled from the radius ``clearance_radius`` to the radius
    ``bottom_radius``.
    """

    clearance_radius: float
    bottom_radius: float
    hole_z: float
    start_angle_deg: float
    hole_count: int
    angle_step_deg: float
    feed_rate: float


class FaceMilling(NamedTuple):
    """Data for milling around the end of a part, repeated at each depth.

    ``path_points`` contains the positions of the tool center as (x, y) from the axis. ``entry_x`` is an X
    at Y 0 that is clear of the part. If ``is_closed`` is False, the tool returns to ``entry_x`` after each
    round. If ``is_closed`` is True, the path goes around the whole part. Its first point is then also clear
    of the part, and the tool moves directly to it.
    """

    entry_x: float
    path_points: list[tuple[float, float]]
    z_levels: list[float]
    feed_rate: float
    is_closed: bool


class CylinderSlots(NamedTuple):
    """Slots in the side of a cylinder.

    Each slot is ``length_z`` long in Z and spans ``angle_span_deg`` degrees around the cylinder.
    ``diameter`` is the diameter of the cylinder. ``bottom_radii`` contains the radius of the slot bottom
    for each pass. The passes alternate in direction. ``clearance_radius`` is a radius clear of the part.
    """

    diameter: float
    start_z: float
    length_z: float
    angle_span_deg: float
    start_angles_deg: list[float]
    bottom_radii: list[float]
    clearance_radius: float
    feed_rate: float


class LiveToolWriter:
    """Writer of program lines for a live tool in OmniTurn.

    M19 stops and locks the spindle as C axis. CA and CI rotate it, and ~PLXC and ~PLZC select the planes.
    """

    def __init__(self, code: CodeWriter, rpm: float) -> None:
        self._code, self._rpm = code, rpm

    @property
    def _setting(self) -> ProgramSettings:
        return self._code.settings

    @property
    def _quick(self) -> str:
        return f"F{format_short_number(RAPID_RATE_IN_MIN * 25.4 / self._setting.mm, 0)}"

    def _write_live_tool_start(self, tool: float, x: float, z: float) -> None:
        """Write the approach, the change from spindle to C axis, and the start of the live tool."""
        self._code.write_tool_start(tool, 0.0, x, z)
        self._code.append_lines("M05", f"M{self._setting.shop.live_tool_codes[0]:02d}", "M19")

    def _released(self) -> None:
        self._code.clear_modal_state()
        self._code.write_retract()
        self._code.append_lines(f"M{self._setting.shop.live_tool_codes[1]:02d}", "M05")

    def _angle(self, word: str, degrees: float) -> None:
        if word == "CA" or degrees:
            wait = f"G04F{format_short_number(_wait(degrees, self._setting.shop.max_c_axis_rpm), 1)}"
            self._code.append_lines(f"{word}{format_short_number(degrees, 3)}", wait)

    def write_holes(self, tool: float, holes: RadialHoles) -> None:
        """Write the moves that drill holes at indexed C angles, as a loop if there are several holes."""
        code = self._code
        self._write_live_tool_start(tool, holes.clearance_radius, holes.hole_z)
        self._angle("CA", holes.start_angle_deg)
        if holes.hole_count > 1:
            code.append_lines(f"LS{holes.hole_count}")
        code.append_lines(
            f"G94F{format_short_number(holes.feed_rate)}{code.format_x(holes.bottom_radius)}",
            f"G00{code.format_x(holes.clearance_radius)}",
        )
        if holes.hole_count > 1:
            self._angle("CI", holes.angle_step_deg)
            code.append_lines("LF")
        self._released()

    def write_face_milling(self, tool: float, faces: FaceMilling) -> None:
        """Write the moves that mill around the face in the XC plane, starting at negative X."""
        code, rate = self._code, f"F{format_short_number(faces.feed_rate)}"
        entry, (first, *rest) = format_short_number(faces.entry_x, 4), faces.path_points
        begin = f"X{format_short_number(first[0], 4)}Y{format_short_number(first[1], 4)}"
        self._write_live_tool_start(tool, -faces.entry_x, self._setting.near)
        code.append_lines(
            f"G94{rate}", "(~PLXC)"
        )  # an earlier shape may have left feed per revolution in force
        for k, z in enumerate(faces.z_levels):
            if k:
                code.append_lines(f"({begin if faces.is_closed else f'X{entry}Y0'}{self._quick})")
            code.append_lines(f"({code.format_z(z)}{rate})", f"({begin}{rate})")
            code.lines += [f"(X{format_short_number(x, 4)}Y{format_short_number(y, 4)})" for x, y in rest]
            if not faces.is_closed:
                code.append_lines(f"(X{entry}Y0)")
        code.append_lines("(END)", f"G00{code.format_x(-faces.entry_x)}")
        self._released()

    def write_slots(self, tool: float, slots: CylinderSlots) -> None:
        """Write the moves that mill slots in the ZC plane, one slot for each start angle of C."""
        code, rate = self._code, format_short_number(slots.feed_rate)
        around = slots.angle_span_deg / 360.0 * math.pi * slots.diameter
        self._write_live_tool_start(tool, -slots.clearance_radius, slots.start_z)
        for k, angle in enumerate(slots.start_angles_deg):
            if k or angle:
                self._angle("CA", angle)
            code.append_lines(f"G94F{rate}", "(~PLZC)", f"(D{format_short_number(slots.diameter, 4)})")
            for level, radius in enumerate(slots.bottom_radii):
                there, back = (
                    f"(X{format_short_number(slots.length_z, 4)}Y{format_short_number(around, 4)}F{rate})",
                    "(X0Y0)",
                )
                down = (
                    f"(Z{format_short_number(2.0 * radius, 4)}F{format_short_number(slots.feed_rate / 2.0)})"
                )
                code.append_lines(down, back if level % 2 else there)
            code.append_lines(f"(Z{format_short_number(2.0 * slots.clearance_radius, 4)}{self._quick})")
            if len(slots.bottom_radii) % 2:
                code.append_lines("(X0Y0)")
            code.append_lines("(END)")
        self._released()


def _wait(degrees: float, c_rpm: float) -> float:
    """Return the dwell in seconds that the C axis needs to rotate by ``degrees``.

    The program needs the dwell because the drive does not report when C is in position.
    """
    return math.ceil(10.0 * (abs(degrees) / (6.0 * c_rpm) + 0.5)) / 10.0


class SinumerikLiveToolWriter(LiveToolWriter):
    """Writer of program lines for a live tool in SINUMERIK.

    M5 stops the spindle before C moves and before a coordinate transformation begins.
    """

    def _write_live_tool_start(self, tool: float, x: float, z: float) -> None:
        self._code.write_tool_start(tool, 0.0, x, z)
        self._code.append_lines("M5", f"S2={format_sinumerik_number(self._rpm, 0)} M2=3", "G94")
        self._code.clear_modal_state()

    def _released(self) -> None:
        self._code.write_retract()
        self._code.append_lines("M2=5")

    def _c(self, degrees: float) -> str:
        name = self._setting.shop.third_axis_name
        return f"{name}{'' if len(name) == 1 else '='}{format_sinumerik_number(degrees, 3)}"

    def _words(self, degrees: bool) -> None:
        """Write DIAMON, which switches X to diameters, or DIAMOF, which switches X to radii.

        TRANSMIT needs radii, because it measures X and Y in the same unit.
        """
        if self._setting.diameter:
            self._code.append_lines("DIAMON" if degrees else "DIAMOF")

    def write_holes(self, tool: float, holes: RadialHoles) -> None:
        """Write the moves that drill the holes, each at its absolute C angle."""
        code = self._code
        self._write_live_tool_start(tool, holes.clearance_radius, holes.hole_z)
        for k in range(holes.hole_count):
            code.append_lines(f"G0 {self._c(holes.start_angle_deg + k * holes.angle_step_deg)}")
            code.clear_modal_state()
            code.write_cut(x=holes.bottom_radius, feed=holes.feed_rate)
            code.write_rapid(holes.clearance_radius)
        self._released()

    def write_face_milling(self, tool: float, faces: FaceMilling) -> None:
        """Write the moves that mill around the face with TRANSMIT, starting at positive X."""
        code, rate = self._code, f"F{format_sinumerik_number(faces.feed_rate)}"
        self._write_live_tool_start(tool, faces.entry_x, self._setting.near)
        self._words(degrees=False)
        code.append_lines("G17", "TRANSMIT")
        for k, z in enumerate(faces.z_levels):
            if k and faces.is_closed:
                code.append_lines(f"G0 {self._xy(*faces.path_points[0])}")
            code.append_lines(f"G1 {code.format_z(z)} {rate}")
            code.lines += [self._xy(x, y) for x, y in faces.path_points]
            if not faces.is_closed:
                code.append_lines(self._xy(faces.entry_x, 0.0))
        code.append_lines(f"G0 {code.format_z(self._setting.near)}", "TRAFOOF", "G18")
        self._words(degrees=True)
        code.clear_modal_state()
        code.write_rapid(x=faces.entry_x)
        self._released()

    def _xy(self, x: float, y: float) -> str:
        return f"X{format_sinumerik_number(x, 4)} Y{format_sinumerik_number(y, 4)}"

    def write_slots(self, tool: float, slots: CylinderSlots) -> None:
        """Write the moves that mill slots with TRACYL.

        Y is measured around the part, starting at C0 and opposite to the direction of C.
        """
        code, degree = self._code, math.pi * slots.diameter / 360.0
        self._write_live_tool_start(tool, slots.clearance_radius, slots.start_z)
        code.append_lines("G19", f"TRACYL({format_sinumerik_number(slots.diameter)})")
        rate, slow = (
            f"F{format_sinumerik_number(each)}" for each in (slots.feed_rate, slots.feed_rate / 2.0)
        )
        for angle in slots.start_angles_deg:
            begin = f"{self._y(-angle * degree)} {code.format_z(slots.start_z)}"
            end = (
                f"{self._y((slots.angle_span_deg - angle) * degree)} "
                f"{code.format_z(slots.start_z - slots.length_z)}"
            )
            code.append_lines(f"G0 {begin}")
            for level, radius in enumerate(slots.bottom_radii):
                code.append_lines(
                    f"G1 {code.format_x(radius)} {slow}", f"{begin if level % 2 else end} {rate}"
                )
            code.append_lines(f"G0 {code.format_x(slots.clearance_radius)}")
        code.append_lines("TRAFOOF", "G18")
        code.clear_modal_state()
        self._released()

    def _y(self, length: float) -> str:
        return f"Y{format_sinumerik_number(length, 4)}"
