"""The lines of a live tool in SINUMERIK: spindle 2, C by its own name, TRANSMIT and TRACYL."""

from __future__ import annotations

import math

from core.extras.shapes.lines.live_lines import Faces, Holes, LiveLines, Slots
from core.extras.shapes.number_words import figure


class SinumerikLiveLines(LiveLines):
    """M5 holds the spindle: what moves C behind it, or begins a plane, finds the part at rest."""

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
        """X as a radius and back: TRANSMIT counts X and Y alike."""
        if self._setting.diameter:
            self._code.write("DIAMON" if degrees else "DIAMOF")

    def holes(self, tool: float, holes: Holes) -> None:
        """Each hole with its angle; words of C are absolute."""
        code = self._code
        self._held(tool, holes.out, holes.at)
        for k in range(holes.many):
            code.write(f"G0 {self._c(holes.angle + k * holes.step)}")
            code.forget()
            code.cut(x=holes.deep, feed=holes.rate)
            code.rapid(holes.out)
        self._released()

    def faces(self, tool: float, faces: Faces) -> None:
        """In TRANSMIT, round the face from where X is positive."""
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
        """In TRACYL, where Y counts round the part from C0, against C."""
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
