"""Line interpreter of the grblHAL simulator: modes, functions, blocks and ``$`` commands."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Protocol

from drivers.simulators.grblhal_settings import Quirks, Registers, Wait, coolant_wait, spindle_wait
from drivers.simulators.grblhal_slides import Place, PlannedBlock, Shape, Slides, circle, straight
from drivers.simulators.spindle_motor import TurnedSpindle


class Controller(Protocol):
    """Parts of the controller that the line interpreter uses."""

    quirks: Quirks
    registers: Registers
    slides: Slides
    spindle: TurnedSpindle
    outputs: dict[str, bool]
    inputs: dict[int, bool]
    pins: str
    alarm: int
    blocking: bool
    homed: int
    jogs: bool
    read: int | None
    rpm: float
    spindle_percent: int
    k: float
    hold: bool

    @property
    def commanded(self) -> float: ...

    @property
    def state(self) -> str: ...

    @property
    def reads(self) -> bool: ...

    def begin_homing(self, axes: int) -> None: ...

    def next_line(self) -> str | None: ...

    def queue(self, block: PlannedBlock) -> None: ...

    def say(self, text: str) -> None: ...

    def answer(self, error: int = 0) -> None: ...

    def turn(self, rpm: float) -> None: ...

    def raise_alarm(self, number: int) -> None: ...


# --- Modal state and the words that change it.


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
    """Modal state with the values after a reset or stop."""

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
        """Apply a G word and return the error code, or 0 without an error."""
        if code in _LATHE and not lathe:
            return 20
        if code in _MODAL:
            setattr(self, _MODAL[code], code)
        elif code not in _PLAIN:
            return 20
        return 0

    def told(self, rpm: float, feed: float, outputs: dict[str, bool], *, lathe: bool) -> str:
        """Return the modal state as the report of ``$G``."""
        spindle = "M5" if not rpm else "M3" if rpm > 0.0 else "M4"
        coolant = "M7 " * outputs.get("mist", False) + "M8 " * outputs.get("flood", False) or "M9 "
        radius, speed = (f" {self.radius}", f" {self.speed}") if lathe else ("", "")
        scaling = "G51:X" if self.scaling == "G51" else "G50"
        held = "M53 " if self.hold_disabled else ""
        return (
            f"[GC:{self.motion} G54{radius} {self.plane} {self.units} {self.distance} {self.feed_mode}"
            f"{speed} G49 G98 {scaling} {spindle} {coolant}{held}T0 F{feed:.0f} S{abs(rpm):.0f}.]"
        )


# --- The ``$`` lines: identity, settings, unlocking, homing and parser state.


_AXES = {"": 7, "X": 1, "Y": 2, "Z": 4}
_BLOCKING = frozenset(("$X", "$J", "$H", "$HX", "$HY", "$HZ"))  # Rejected after a critical alarm.


def identity(m: Controller) -> list[str]:
    """Return the lines of ``$I``; the auxiliary ports appear only if there are any."""
    quirks = m.quirks
    lathe = "LATHE," if m.registers.lathe else ""
    home = "HOME," if int(m.registers[22]) & 1 else ""
    ports = [f"[AUX IO:{quirks.inputs},{quirks.outputs},0,0]"] if quirks.inputs + quirks.outputs else []
    return [
        "[VER:1.1f.20260817:]",
        f"[OPT:{quirks.build},100,1024,3,16]",
        "[AXS:3:XYZ]",
        f"[NEWOPT:ENUMS,RT+,{home}{lathe}EXPR,TC,SED]",
        "[FIRMWARE:grblHAL]",
        *([f"[SIGNALS:{quirks.signals}]"] if quirks.signals is not None else ()),
        "[NVS STORAGE:EEPROM]",
        "[DRIVER:Simulator]",
        "[DRIVER VERSION:260913]",
        *ports,
    ]


def answer(m: Controller, line: str, modes: str) -> int | None:
    """Execute a ``$`` line and return its error code, or 0 without an error.

    Return None if the acknowledgment follows later. ``modes`` is the report of ``$G``.
    """
    command = line.partition("=")[0]
    if m.blocking and (command in _BLOCKING):
        return 79
    if command.startswith("$H"):
        return _home(m, command.removeprefix("$H"))
    if command == "$X":
        return _unlock(m)
    told = _told(m, line, modes)
    if told:
        m.say("".join(f"{text}\r\n" for text in told))
        return 0
    found = re.fullmatch(r"\$(\d+)=(.*)", line)
    if found is None:
        return 3
    idle = m.state == "Idle" or m.alarm
    return m.registers.store(int(found[1]), found[2]) if idle else 8


def _told(m: Controller, line: str, modes: str) -> list[str]:
    if line == "$I":
        return identity(m)
    if line == "$$":
        return m.registers.told()
    return [modes] if line == "$G" else []


def _unlock(m: Controller) -> int:
    if not m.alarm:
        return 0
    if "E" in m.pins:
        return 50
    if int(m.registers[22]) & 5 == 5 and m.homed & 5 != 5:
        return 46
    m.alarm = 0
    m.say("[MSG:Caution: Unlocked]\r\n")
    return 0


def _home(m: Controller, letter: str) -> int | None:
    flags = int(m.registers[22])
    if letter not in _AXES:
        return 3
    if not flags & 1 or (letter and not flags & 2):
        return 5
    m.begin_homing(_AXES[letter])
    return None


_WORD = re.compile(r"([A-Z])(-?\d*\.?\d+)")
_WORDS = re.compile(
    r"([A-Z] *[-+]?(\d+\.?\d*|\.\d+) *)*", re.IGNORECASE
)  # A letter without a number is not a word.
_MOST_LINES = 10_000_000

__all__ = ["Modes", "Program"]


class Program:
    """Executor of the received lines in order, as the planner and required standstills permit."""

    def __init__(self, machine: Controller) -> None:
        self._m = machine
        self.modes = Modes(radius="G7" if machine.quirks.diameter else "G8")
        self.offset = [0.0, 0.0, 0.0]  # G54
        self.executed: list[str] = []  # Executed lines.
        self.end: Place = (0.0, 0.0)  # End point of the planner's last block.
        self.error = 0
        self._f = 0.0
        self._waits: str | None = None  # Line that waits for a standstill.
        self._cuts = False  # A thread, which is acknowledged at its end.
        self.wait: Wait | None = None  # Wait of a function, which is acknowledged at its end.

    def told(self) -> str:
        """Return the report of ``$G``."""
        m = self._m
        return self.modes.told(m.rpm, self._f, m.outputs, lathe=m.registers.lathe)

    def drop(self) -> None:
        """Discard pending lines and waits after a stop or a reset."""
        self._waits, self._cuts, self.error, self.end = None, False, 0, self._m.slides.place
        self.wait = None

    def pump(self) -> None:
        """Execute the received lines until one has to wait."""
        machine = self._m
        if self.wait is not None and not self._end_wait(self.wait):
            return
        if (self._waits is not None or self._cuts) and (machine.slides.queue or machine.alarm):
            return
        if self._cuts:
            self._cuts = False
            machine.answer()
        if self._waits is not None:
            line, self._waits = self._waits, None
            self._carry_out(line)
        while self.reads_on and machine.reads and machine.slides.free > 0:
            line_ = machine.next_line()
            if line_ is None:
                return
            self._line(line_)

    @property
    def reads_on(self) -> bool:
        """Whether the preceding line is complete."""
        return self._waits is None and not self._cuts and self.wait is None

    def _end_wait(self, wait: Wait) -> bool:
        """Acknowledge the function when its wait is over; a speed that is not reached raises alarm 14."""
        if not wait.is_over(self._m):
            return False
        self.wait = None
        if wait.failed:
            self._m.turn(0.0)
            self._m.raise_alarm(14)
        self._m.answer()
        return True

    def _line(self, line: str) -> None:
        machine = self._m
        if not line:
            self.error = 0
            machine.answer()
        elif line.startswith("$J=") and not machine.blocking:
            self.error = self._jogged(line[3:])
            machine.answer(self.error)
        elif line.startswith("$"):
            error = answer(machine, line, self.told())
            self.error = error or 0
            if error is not None:
                machine.answer(error)
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
        machine.queue(PlannedBlock(0, length, words["F"] / 60.0, way, jog=True))
        return 0

    def _carry_out(self, line: str) -> None:
        found = _WORD.findall(line)
        codes = [f"{letter}{float(value):g}" for letter, value in found if letter in "GM"]
        words = {letter: float(value) for letter, value in found if letter not in "GM"}
        if not _WORDS.fullmatch(line):
            self.error = 2
            self._m.answer(2)
            return
        self.error = 27 if words.get("N", 0) > _MOST_LINES else self._obey(codes, words)
        if not self.error:
            self.executed.append(line)
        if self.error or not (self._cuts or self.wait is not None):
            self._m.answer(self.error)

    def _obey(self, codes: list[str], words: dict[str, float]) -> int:
        if "G95" in codes and not self._m.quirks.encoder:
            return 20
        for code in (code for code in codes if code[0] == "G"):
            error = self.modes.take(code, lathe=self._m.registers.lathe)
            if error:
                return error
        if "G10" in codes:
            self.offset = [words.get(letter, 0.0) for letter in "XYZ"]
            return 0
        return self._functions(codes, words) or self._motion(words)

    def _functions(self, codes: list[str], words: dict[str, float]) -> int:
        for code in (code for code in codes if code[0] == "M"):
            error = self._function(code, words)
            if error:
                return error
        return 0

    def _function(self, code: str, words: dict[str, float]) -> int:
        machine = self._m
        port = int(words.get("P", -1))
        if code in {"M3", "M4", "M5"}:
            self._turn(code, words.get("S", abs(machine.rpm)))
        elif code in {"M7", "M8"}:
            machine.outputs["mist" if code == "M7" else "flood"] = True
            self.wait = coolant_wait(machine)
        elif code == "M9":
            machine.outputs.update(mist=False, flood=False)
        elif code == "M53":
            self.modes.hold_disabled = port == 0
        elif code in {"M64", "M65"} and machine.quirks.outputs:
            if not 0 <= port < machine.quirks.outputs:
                return 39
            machine.outputs[f"out.{port}"] = code == "M64"
        elif code == "M66" and machine.quirks.inputs:
            machine.read = int(machine.inputs.get(port, False))
        else:
            return 20
        return 0

    def _turn(self, code: str, rpm: float) -> None:
        """Command the spindle; only a start, stop or reversal waits for the speed."""
        machine = self._m
        before = math.copysign(1.0, machine.rpm) if machine.rpm else 0.0
        way = {"M3": 1.0, "M4": -1.0, "M5": 0.0}[code]
        machine.turn(way * rpm)
        if way != before:
            self.wait = spindle_wait(machine, on=code != "M5")

    def _target(self, words: dict[str, float]) -> Place:
        scale = 0.5 if self.modes.radius == "G7" else 1.0
        x = words["X"] * scale + self.offset[0] if "X" in words else self.end[0]
        return x, words["Z"] + self.offset[2] if "Z" in words else self.end[1]

    def _motion(self, words: dict[str, float]) -> int:
        if not {"X", "Z"} & words.keys():
            return 0
        self._f = words.get("F", self._f)
        motion, target = self.modes.motion, self._target(words)
        shape: Shape | None = straight(self.end, target)
        if motion in {"G2", "G3"}:
            centre = self.end[0] + words.get("I", 0.0), self.end[1] + words.get("K", 0.0)
            shape = circle(self.end, target, centre, counter=motion == "G3")
        if shape is None or (motion in {"G2", "G3"} and self.modes.plane != "G18"):
            return 33
        error = self._thread_error(words) if motion == "G33" else 0
        if error or (motion not in {"G0", "G33"} and self._f <= 0.0):
            return error or 22
        self._hand_over(motion, shape, words)
        self.end = target
        return 0

    def _thread_error(self, words: dict[str, float]) -> int:
        machine = self._m
        if not machine.quirks.encoder:
            return 20
        feed = words.get("K", 0.0) * abs(machine.spindle.speed)
        if words.get("K", 0.0) == 0.0:
            return 39
        if abs(machine.spindle.speed) < 1.0:
            return 41
        return 43 if feed > 0.9 * machine.registers[112] else 0

    def _hand_over(self, motion: str, shape: Shape, words: dict[str, float]) -> None:
        length, way = shape
        number = int(words.get("N", 0))
        if motion == "G33":
            self._cuts = True
            self._m.spindle_percent = 100
            self._m.turn(self._m.rpm)
            block = PlannedBlock(number, length, words.get("K", 0.0), way, per_rev=True, thread=True)
        elif motion == "G0":
            block = PlannedBlock(number, length, 1e9, way, rapid=True)
        else:
            per_rev = self.modes.feed_mode == "G95"
            block = PlannedBlock(number, length, self._f if per_rev else self._f / 60.0, way, per_rev=per_rev)
        self._m.queue(block)


def _waits_for_rest(line: str) -> bool:
    """Return whether a line waits for an empty planner: functions, dwells and threads except M64 and M65."""
    words = {(letter, float(value)) for letter, value in _WORD.findall(line) if letter in "GM"}
    return any(
        (letter == "M" and v not in {64, 65}) or (letter == "G" and v in {4, 33}) for letter, v in words
    )
