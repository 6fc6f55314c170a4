"""The look-alike's lines: ``$`` commands, modes, functions and blocks; errors that stick."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivers.grblhal.peer.slides import PeerBlock, Place, circle, straight

if TYPE_CHECKING:
    from drivers.grblhal.peer.firmware import Firmware

_WORD = re.compile(r"([A-Z])(-?\d*\.?\d+)")
_PLAIN = frozenset(("G4", "G10", "G49", "G53", "G54", "G92.1"))
_MODAL = {
    **dict.fromkeys(("G0", "G1", "G2", "G3", "G33"), "motion"),
    **dict.fromkeys(("G17", "G18"), "plane"),
    **dict.fromkeys(("G20", "G21"), "units"),
    **dict.fromkeys(("G90", "G91"), "distance"),
    **dict.fromkeys(("G94", "G95"), "feed_mode"),
    **dict.fromkeys(("G7", "G8"), "radius"),
}


@dataclass(slots=True)
class Modes:
    """Modal state; a reset brings back these."""

    motion: str = "G0"
    plane: str = "G17"
    units: str = "G21"
    distance: str = "G90"
    feed_mode: str = "G94"
    radius: str = "G8"

    def told(self) -> str:
        """As ``$G`` says it."""
        return (
            f"[GC:{self.motion} G54 {self.plane} {self.units} {self.distance} {self.feed_mode}"
            f" {self.radius} G49 G98 G50 M5 M9 T0 F0 S0.]"
        )


class Program:
    """Carries lines out in order, as far as planner and standstills allow."""

    def __init__(self, firmware: Firmware) -> None:
        self._m = firmware
        self.modes = Modes(radius="G7" if firmware.quirks.diameter else "G8")
        self.settings = {10: 511.0, 13: 0.0, 22: float(firmware.quirks.homing), 32: 2.0}
        self.executed: list[str] = []  # lines that were carried out
        self.end: Place = (0.0, 0.0)  # where the planner's last block ends
        self.error = 0
        self._f = 0.0
        self._waits: str | None = None  # a line that waits for a standstill

    def drop(self) -> None:
        """A stop or a reset."""
        self._waits, self.error, self.end = None, 0, self._m.slides.place

    def pump(self) -> None:
        """Carry out what has come in."""
        machine = self._m
        if self._waits is not None:
            if machine.slides.queue or machine.alarm:
                return
            line, self._waits = self._waits, None
            self._carry_out(line)
        while self._waits is None and not machine.homing and machine.slides.free > 0:
            line_ = machine.next_line()
            if line_ is None:
                return
            self._line(line_)

    def _line(self, line: str) -> None:
        machine = self._m
        if not line:
            self.error = 0
            machine.answer()
        elif line.startswith("$"):
            self.error = 0
            self._system(line)
        elif machine.alarm or machine.jogs:
            self.error = 9
            machine.answer(9)
        elif self.error:
            machine.answer(self.error)
        elif _waits_for_rest(line):
            self._waits = line
            self.pump()
        else:
            self._carry_out(line)

    def _system(self, line: str) -> None:
        machine = self._m
        if line.startswith("$H") and machine.quirks.homing:
            machine.begin_homing()  # answers when it is done
            return
        if line.startswith("$J="):
            machine.answer(self._jogged(line[3:]))
            return
        if line == "$X":
            machine.alarm = 0
        found = re.fullmatch(r"\$(\d+)=(-?[\d.]+)", line)
        if found:
            self.settings[int(found[1])] = float(found[2])
        elif line.startswith("$H"):
            machine.answer(5)
            return
        elif line != "$X" and not self._told(line):
            machine.answer(3)
            return
        machine.answer()

    def _told(self, line: str) -> bool:
        """What a question is answered with."""
        quirks = self._m.quirks
        lathe = "LATHE," if quirks.lathe else ""
        answers: dict[str, Callable[[], list[str]]] = {
            "$I": lambda: [
                "[VER:1.1f.20260817:]",
                "[OPT:VNML+,100,1024,3,16]",
                "[AXS:3:XYZ]",
                f"[NEWOPT:ENUMS,RT+,{lathe}EXPR,TC,SED]",
                f"[AUX IO:{quirks.inputs},{quirks.outputs},0,0]",
            ],
            "$$": lambda: [f"${n}={value:g}" for n, value in sorted(self.settings.items())],
            "$G": lambda: [self.modes.told()],
        }
        if line not in answers:
            return False
        for text in answers[line]():
            self._m.say(text + "\r\n")
        return True

    def _jogged(self, text: str) -> int:
        words = {letter: float(value) for letter, value in _WORD.findall(text) if letter != "G"}
        machine = self._m
        if machine.alarm or (machine.slides.queue and not machine.jogs):
            return 8
        if "F" not in words:
            return 22
        target = self._target(words)
        length, way = straight(self.end, target)
        self.end = target
        machine.queue(PeerBlock(0, length, words["F"] / 60.0, way, jog=True))
        return 0

    def _carry_out(self, line: str) -> None:
        found = _WORD.findall(line)
        codes = [f"{letter}{float(value):g}" for letter, value in found if letter in "GM"]
        words = {letter: float(value) for letter, value in found if letter not in "GM"}
        self.error = self._modal(codes) or self._functions(codes, words) or self._motion(words)
        if not self.error:
            self.executed.append(line)
        self._m.answer(self.error)

    def _modal(self, codes: list[str]) -> int:
        for code in codes:
            if code in {"G7", "G8"} and not self._m.quirks.lathe:
                return 20
            if code in _MODAL:
                setattr(self.modes, _MODAL[code], code)
            elif code[0] == "G" and code not in _PLAIN:
                return 20
        return 0

    def _functions(self, codes: list[str], words: dict[str, float]) -> int:
        machine = self._m
        for code in (code for code in codes if code[0] == "M"):
            if code in {"M3", "M4"}:
                machine.turn(words.get("S", abs(machine.rpm)) * (1.0 if code == "M3" else -1.0))
            elif code == "M5":
                machine.turn(0.0)
            elif code in {"M7", "M8"}:
                machine.outputs["mist" if code == "M7" else "flood"] = True
            elif code == "M9":
                machine.outputs.update(mist=False, flood=False)
            elif code in {"M64", "M65"}:
                port = int(words.get("P", -1))
                if not 0 <= port < machine.quirks.outputs:
                    return 39
                machine.outputs[f"out.{port}"] = code == "M64"
            elif code == "M66":
                machine.read = int(machine.inputs.get(int(words.get("P", -1)), False))
            else:
                return 20
        return 0

    def _target(self, words: dict[str, float]) -> Place:
        scale = 0.5 if self.modes.radius == "G7" else 1.0
        x = words["X"] * scale if "X" in words else self.end[0]
        return x, words.get("Z", self.end[1])

    def _motion(self, words: dict[str, float]) -> int:
        if not {"X", "Z"} & words.keys():
            return 0
        self._f = words.get("F", self._f)
        motion, target = self.modes.motion, self._target(words)
        shape: tuple[float, Callable[[float], Place]] | None = straight(self.end, target)
        if motion in {"G2", "G3"}:
            centre = self.end[0] + words.get("I", 0.0), self.end[1] + words.get("K", 0.0)
            shape = circle(self.end, target, centre, counter=motion == "G3")
        if shape is None or (motion in {"G2", "G3"} and self.modes.plane != "G18"):
            return 33
        if motion == "G33" and (not self._m.quirks.encoder or abs(self._m.spindle.speed) < 1.0):
            return 41
        if motion not in {"G0", "G33"} and self._f <= 0.0:
            return 22
        self._hand_over(motion, shape, words)
        self.end = target
        return 0

    def _hand_over(
        self, motion: str, shape: tuple[float, Callable[[float], Place]], words: dict[str, float]
    ) -> None:
        length, way = shape
        number = int(words.get("N", 0))
        if motion == "G33":
            block = PeerBlock(number, length, words.get("K", 0.0), way, per_rev=True, thread=True)
        elif motion == "G0":
            block = PeerBlock(number, length, 127.0, way, rapid=True)
        else:
            per_rev = self.modes.feed_mode == "G95"
            block = PeerBlock(number, length, self._f if per_rev else self._f / 60.0, way, per_rev=per_rev)
        self._m.queue(block)


def _waits_for_rest(line: str) -> bool:
    """Functions, dwells and threads wait until the planner is empty."""
    return any(letter == "M" or (letter == "G" and float(v) in {4, 33}) for letter, v in _WORD.findall(line))
