"""Program lines for a live tool, also in SINUMERIK: spindle as C axis, and the planes XC and ZC."""

from __future__ import annotations

import math
from typing import NamedTuple

from core.extras.shapes.lines.code_lines import Code, figure, plain
from core.extras.shapes.shape_fields import Setting

QUICK = 50.0  # in/min, clear of the part in the plane


class Holes(NamedTuple):
    """Radial holes: ``many`` holes at Z ``at``, from ``angle`` on in steps of ``step``.

    Each hole goes from the radius ``out`` to the radius ``deep``.
    """

    out: float
    deep: float
    at: float
    angle: float
    many: int
    step: float
    rate: float


class Faces(NamedTuple):
    """Milling around the end of a part: ``path`` of the tool center as (x, y) from the axis, for each depth.

    ``entry`` is X clear of the part at Y 0, to which the tool returns after each round. If the path leads
    ``around`` the part, the tool goes directly to its first point, which is also clear of the part.
    """

    entry: float
    path: list[tuple[float, float]]
    levels: list[float]
    rate: float
    around: bool


class Slots(NamedTuple):
    """Slots in a cylinder of diameter ``across``, each ``along`` Z and ``turn`` degrees around it.

    ``depths`` are the radii of the mill's end, one for each pass in alternating directions. ``out`` is the
    radius clear of the part.
    """

    across: float
    at: float
    along: float
    turn: float
    angles: list[float]
    depths: list[float]
    out: float
    rate: float


class LiveLines:
    """Writer for a live tool in OmniTurn.

    M19 holds the spindle, CA and CI turn it, and ~PLXC and ~PLZC select the planes.
    """

    def __init__(self, code: Code, rpm: float) -> None:
        self._code, self._rpm = code, rpm

    @property
    def _setting(self) -> Setting:
        return self._code.setting

    @property
    def _quick(self) -> str:
        return f"F{plain(QUICK * 25.4 / self._setting.mm, 0)}"

    def _held(self, tool: float, x: float, z: float) -> None:
        """Write the approach, stop and hold the spindle, and start the live tool."""
        self._code.begin(tool, 0.0, x, z)
        self._code.write("M05", f"M{self._setting.shop.live[0]:02d}", "M19")

    def _released(self) -> None:
        self._code.forget()
        self._code.away()
        self._code.write(f"M{self._setting.shop.live[1]:02d}", "M05")

    def _angle(self, word: str, degrees: float) -> None:
        if word == "CA" or degrees:
            wait = f"G04F{plain(_wait(degrees, self._setting.shop.c_rpm), 1)}"
            self._code.write(f"{word}{plain(degrees, 3)}", wait)

    def holes(self, tool: float, holes: Holes) -> None:
        """Write drilled and indexed holes, as a loop if there are several."""
        code = self._code
        self._held(tool, holes.out, holes.at)
        self._angle("CA", holes.angle)
        if holes.many > 1:
            code.write(f"LS{holes.many}")
        code.write(f"G94F{plain(holes.rate)}{code.x(holes.deep)}", f"G00{code.x(holes.out)}")
        if holes.many > 1:
            self._angle("CI", holes.step)
            code.write("LF")
        self._released()

    def faces(self, tool: float, faces: Faces) -> None:
        """Write milling in the plane XC, from the side of negative X."""
        code, rate = self._code, f"F{plain(faces.rate)}"
        entry, (first, *rest) = plain(faces.entry, 4), faces.path
        begin = f"X{plain(first[0], 4)}Y{plain(first[1], 4)}"
        self._held(tool, -faces.entry, self._setting.near)
        code.write(f"G94{rate}", "(~PLXC)")  # an earlier shape may have left feed per revolution in force
        for k, z in enumerate(faces.levels):
            if k:
                code.write(f"({begin if faces.around else f'X{entry}Y0'}{self._quick})")
            code.write(f"({code.z(z)}{rate})", f"({begin}{rate})")
            code.lines += [f"(X{plain(x, 4)}Y{plain(y, 4)})" for x, y in rest]
            if not faces.around:
                code.write(f"(X{entry}Y0)")
        code.write("(END)", f"G00{code.x(-faces.entry)}")
        self._released()

    def slots(self, tool: float, slots: Slots) -> None:
        """Write slots in the plane ZC, starting at each angle of C."""
        code, rate = self._code, plain(slots.rate)
        around = slots.turn / 360.0 * math.pi * slots.across
        self._held(tool, -slots.out, slots.at)
        for k, angle in enumerate(slots.angles):
            if k or angle:
                self._angle("CA", angle)
            code.write(f"G94F{rate}", "(~PLZC)", f"(D{plain(slots.across, 4)})")
            for level, radius in enumerate(slots.depths):
                there, back = f"(X{plain(slots.along, 4)}Y{plain(around, 4)}F{rate})", "(X0Y0)"
                down = f"(Z{plain(2.0 * radius, 4)}F{plain(slots.rate / 2.0)})"
                code.write(down, back if level % 2 else there)
            code.write(f"(Z{plain(2.0 * slots.out, 4)}{self._quick})")
            if len(slots.depths) % 2:
                code.write("(X0Y0)")
            code.write("(END)")
        self._released()


def _wait(degrees: float, c_rpm: float) -> float:
    """Return the dwell in seconds until C is in position, because the drive does not report it."""
    return math.ceil(10.0 * (abs(degrees) / (6.0 * c_rpm) + 0.5)) / 10.0


class SinumerikLiveLines(LiveLines):
    """Writer for a live tool in SINUMERIK: M5 stops the spindle before C moves or a plane begins."""

    def _held(self, tool: float, x: float, z: float) -> None:
        self._code.begin(tool, 0.0, x, z)
        self._code.write("M5", f"S2={figure(self._rpm, 0)} M2=3", "G94")
        self._code.forget()

    def _released(self) -> None:
        self._code.away()
        self._code.write("M2=5")

    def _c(self, degrees: float) -> str:
        name = self._setting.shop.third_axis
        return f"{name}{'' if len(name) == 1 else '='}{figure(degrees, 3)}"

    def _words(self, degrees: bool) -> None:
        """Switch X between radius and diameter, because TRANSMIT measures X and Y in the same unit."""
        if self._setting.diameter:
            self._code.write("DIAMON" if degrees else "DIAMOF")

    def holes(self, tool: float, holes: Holes) -> None:
        """Write each hole with its absolute angle of C."""
        code = self._code
        self._held(tool, holes.out, holes.at)
        for k in range(holes.many):
            code.write(f"G0 {self._c(holes.angle + k * holes.step)}")
            code.forget()
            code.cut(x=holes.deep, feed=holes.rate)
            code.rapid(holes.out)
        self._released()

    def faces(self, tool: float, faces: Faces) -> None:
        """Write milling with TRANSMIT around the face, from the side of positive X."""
        code, rate = self._code, f"F{figure(faces.rate)}"
        self._held(tool, faces.entry, self._setting.near)
        self._words(degrees=False)
        code.write("G17", "TRANSMIT")
        for k, z in enumerate(faces.levels):
            if k and faces.around:
                code.write(f"G0 {self._xy(*faces.path[0])}")
            code.write(f"G1 {code.z(z)} {rate}")
            code.lines += [self._xy(x, y) for x, y in faces.path]
            if not faces.around:
                code.write(self._xy(faces.entry, 0.0))
        code.write(f"G0 {code.z(self._setting.near)}", "TRAFOOF", "G18")
        self._words(degrees=True)
        code.forget()
        code.rapid(x=faces.entry)
        self._released()

    def _xy(self, x: float, y: float) -> str:
        return f"X{figure(x, 4)} Y{figure(y, 4)}"

    def slots(self, tool: float, slots: Slots) -> None:
        """Write slots with TRACYL.

        Y is measured around the part from C0, in the opposite direction of C.
        """
        code, degree = self._code, math.pi * slots.across / 360.0
        self._held(tool, slots.out, slots.at)
        code.write("G19", f"TRACYL({figure(slots.across)})")
        rate, slow = (f"F{figure(each)}" for each in (slots.rate, slots.rate / 2.0))
        for angle in slots.angles:
            begin = f"{self._y(-angle * degree)} {code.z(slots.at)}"
            end = f"{self._y((slots.turn - angle) * degree)} {code.z(slots.at - slots.along)}"
            code.write(f"G0 {begin}")
            for level, radius in enumerate(slots.depths):
                code.write(f"G1 {code.x(radius)} {slow}", f"{begin if level % 2 else end} {rate}")
            code.write(f"G0 {code.x(slots.out)}")
        code.write("TRAFOOF", "G18")
        code.forget()
        self._released()

    def _y(self, length: float) -> str:
        return f"Y{figure(length, 4)}"
