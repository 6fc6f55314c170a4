"""Line interpreter of the grblHAL simulator for modes, functions, blocks and ``$`` commands."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Protocol

from drivers.simulators.grblhal_motion import (
    GrblMotion,
    PlannedBlock,
    Position,
    Shape,
    make_arc_path,
    make_line_path,
)
from drivers.simulators.grblhal_settings import (
    SettingRegisters,
    SimulatorBehavior,
    SpindleOrCoolantWait,
    create_spindle_wait,
    make_coolant_delay,
)
from drivers.simulators.spindle_motor import SimulatedSpindle


class ProgramController(Protocol):
    """Interface of the controller for the line interpreter."""

    behavior: SimulatorBehavior
    registers: SettingRegisters
    motion: GrblMotion
    spindle: SimulatedSpindle
    output_states: dict[str, bool]
    auxiliary_inputs: dict[int, bool]
    active_pins: str
    alarm_number: int
    is_reset_required: bool
    homed_axis_mask: int
    is_jogging: bool
    last_input_result: int | None
    programmed_rpm: float
    spindle_percent: int
    time_s: float
    is_in_hold: bool

    @property
    def commanded_rpm(self) -> float: ...

    @property
    def state_name(self) -> str: ...

    @property
    def is_reading_lines(self) -> bool: ...

    def start_homing(self, axis_mask: int) -> None: ...

    def read_next_line(self) -> str | None: ...

    def queue_block(self, block: PlannedBlock) -> None: ...

    def send_text(self, text: str) -> None: ...

    def acknowledge_line(self, error_code: int = 0) -> None: ...

    def command_spindle_speed(self, rpm: float) -> None: ...

    def raise_alarm(self, number: int) -> None: ...


# --- Modal state and the words that change it.


_MODAL_GROUPS = {
    **dict.fromkeys(("G0", "G1", "G2", "G3", "G33"), "motion"),
    **dict.fromkeys(("G17", "G18"), "plane"),
    **dict.fromkeys(("G20", "G21"), "units"),
    **dict.fromkeys(("G90", "G91"), "distance"),
    **dict.fromkeys(("G94", "G95"), "feed_mode"),
    **dict.fromkeys(("G7", "G8"), "radius"),
    **dict.fromkeys(("G96", "G97"), "speed"),
    **dict.fromkeys(("G50", "G51"), "scaling"),
}
_LATHE_CODES = frozenset(("G7", "G8", "G96", "G97"))
_PLAIN_CODES = frozenset(("G4", "G10", "G49", "G53", "G54", "G92.1"))


@dataclass(slots=True)
class ModalState:
    """Modal state of the controller; the default values are those after a reset or stop."""

    motion: str = "G0"
    plane: str = "G17"
    units: str = "G21"
    distance: str = "G90"
    feed_mode: str = "G94"
    radius: str = "G8"
    speed: str = "G97"
    scaling: str = "G50"
    is_hold_disabled: bool = False  # M53 P0

    def apply_code(self, code: str, *, is_lathe_mode: bool) -> int:
        """Apply a G word, and return its error code, or 0 if the word is valid."""
        if code in _LATHE_CODES and not is_lathe_mode:
            return 20
        if code in _MODAL_GROUPS:
            setattr(self, _MODAL_GROUPS[code], code)
        elif code not in _PLAIN_CODES:
            return 20
        return 0

    def format_modes(self, rpm: float, feed: float, outputs: dict[str, bool], *, is_lathe_mode: bool) -> str:
        """Return the modal state as text, in the format of the reply to ``$G``."""
        spindle = "M5" if not rpm else "M3" if rpm > 0.0 else "M4"
        coolant = "M7 " * outputs.get("mist", False) + "M8 " * outputs.get("flood", False) or "M9 "
        radius, speed = (f" {self.radius}", f" {self.speed}") if is_lathe_mode else ("", "")
        scaling = "G51:X" if self.scaling == "G51" else "G50"
        held = "M53 " if self.is_hold_disabled else ""
        return (
            f"[GC:{self.motion} G54{radius} {self.plane} {self.units} {self.distance} {self.feed_mode}"
            f"{speed} G49 G98 {scaling} {spindle} {coolant}{held}T0 F{feed:.0f} S{abs(rpm):.0f}.]"
        )


# --- The ``$`` lines: identity, settings, unlocking, homing and parser state.


_AXES = {"": 7, "X": 1, "Y": 2, "Z": 4}
_BLOCKING = frozenset(("$X", "$J", "$H", "$HX", "$HY", "$HZ"))  # Rejected after a critical alarm.


def format_identity(controller: ProgramController) -> list[str]:
    """Return the lines of the reply to ``$I``.

    If the controller has no auxiliary ports, the line for them is omitted.
    """
    quirks = controller.behavior
    lathe = "LATHE," if controller.registers.is_in_lathe_mode else ""
    home = "HOME," if int(controller.registers[22]) & 1 else ""
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


def execute_system_command(controller: ProgramController, line: str, modes: str) -> int | None:
    """Execute a ``$`` line, and return its error code, or 0 if there is no error.

    Return None if the line is acknowledged later. ``modes`` is the reply to ``$G``.
    """
    command = line.partition("=")[0]
    if controller.is_reset_required and (command in _BLOCKING):
        return 79
    if command.startswith("$H"):
        return _home(controller, command.removeprefix("$H"))
    if command == "$X":
        return _unlock(controller)
    report_lines = _told(controller, line, modes)
    if report_lines:
        controller.send_text("".join(f"{text}\r\n" for text in report_lines))
        return 0
    found = re.fullmatch(r"\$(\d+)=(.*)", line)
    if found is None:
        return 3
    idle = controller.state_name == "Idle" or controller.alarm_number
    return controller.registers.store_setting(int(found[1]), found[2]) if idle else 8


def _told(m: ProgramController, line: str, modes: str) -> list[str]:
    if line == "$I":
        return format_identity(m)
    if line == "$$":
        return m.registers.format_settings()
    return [modes] if line == "$G" else []


def _unlock(m: ProgramController) -> int:
    if not m.alarm_number:
        return 0
    if "E" in m.active_pins:
        return 50
    if int(m.registers[22]) & 5 == 5 and m.homed_axis_mask & 5 != 5:
        return 46
    m.alarm_number = 0
    m.send_text("[MSG:Caution: Unlocked]\r\n")
    return 0


def _home(m: ProgramController, letter: str) -> int | None:
    flags = int(m.registers[22])
    if letter not in _AXES:
        return 3
    if not flags & 1 or (letter and not flags & 2):
        return 5
    m.start_homing(_AXES[letter])
    return None


_WORD = re.compile(r"([A-Z])(-?\d*\.?\d+)")
_WORDS = re.compile(
    r"([A-Z] *[-+]?(\d+\.?\d*|\.\d+) *)*", re.IGNORECASE
)  # A letter without a number is not a word.
_MAX_LINES = 10_000_000

__all__ = ["LineInterpreter", "ModalState"]


class LineInterpreter:
    """Interpreter that executes received lines in order.

    A line may have to wait until the planner has space or the axes are at rest.
    """

    def __init__(self, controller: ProgramController) -> None:
        self._m = controller
        self.modes = ModalState(radius="G7" if controller.behavior.diameter else "G8")
        self.work_offset = [0.0, 0.0, 0.0]  # G54
        self.executed_lines: list[str] = []  # Executed lines.
        self.end_position: Position = (0.0, 0.0)  # End point of the planner's last block.
        self.last_error = 0
        self._f = 0.0
        self._waits: str | None = None  # Line that waits for a standstill.
        self._cuts = False  # A thread, which is acknowledged at its end.
        self.active_wait: SpindleOrCoolantWait | None = (
            None  # Wait of a function, which is acknowledged at its end.
        )

    def format_modes(self) -> str:
        """Return the text of the reply to ``$G``."""
        m = self._m
        return self.modes.format_modes(
            m.programmed_rpm, self._f, m.output_states, is_lathe_mode=m.registers.is_in_lathe_mode
        )

    def discard_lines(self) -> None:
        """Discard pending lines and waits after a stop or a reset."""
        self._waits, self._cuts, self.last_error, self.end_position = None, False, 0, self._m.motion.position
        self.active_wait = None

    def execute_lines(self) -> None:
        """Execute received lines until a line must wait."""
        machine = self._m
        if self.active_wait is not None and not self._end_wait(self.active_wait):
            return
        if (self._waits is not None or self._cuts) and (machine.motion.block_queue or machine.alarm_number):
            return
        if self._cuts:
            self._cuts = False
            machine.acknowledge_line()
        if self._waits is not None:
            line, self._waits = self._waits, None
            self._carry_out(line)
        while (
            self.is_previous_line_complete
            and machine.is_reading_lines
            and machine.motion.free_block_count > 0
        ):
            line_ = machine.read_next_line()
            if line_ is None:
                return
            self._line(line_)

    @property
    def is_previous_line_complete(self) -> bool:
        """Return whether the execution of the previous line is complete."""
        return self._waits is None and not self._cuts and self.active_wait is None

    def _end_wait(self, wait: SpindleOrCoolantWait) -> bool:
        """Acknowledge the function if its wait has ended, and return whether the wait has ended.

        If the spindle did not reach its speed during the wait, alarm 14 is raised.
        """
        if not wait.update_and_check_end(self._m):
            return False
        self.active_wait = None
        if wait.has_failed:
            self._m.command_spindle_speed(0.0)
            self._m.raise_alarm(14)
        self._m.acknowledge_line()
        return True

    def _line(self, line: str) -> None:
        machine = self._m
        if not line:
            self.last_error = 0
            machine.acknowledge_line()
        elif line.startswith("$J=") and not machine.is_reset_required:
            self.last_error = self._jogged(line[3:])
            machine.acknowledge_line(self.last_error)
        elif line.startswith("$"):
            error = execute_system_command(machine, line, self.format_modes())
            self.last_error = error or 0
            if error is not None:
                machine.acknowledge_line(error)
        elif machine.alarm_number or machine.is_jogging:
            self.last_error = 9
            machine.acknowledge_line(9)
        elif self.last_error:
            machine.acknowledge_line(self.last_error)
        elif _waits_for_rest(line):
            self._waits = line
            self.execute_lines()
        else:
            self._carry_out(line)

    def _jogged(self, text: str) -> int:
        words = {letter: float(value) for letter, value in _WORD.findall(text) if letter != "G"}
        machine = self._m
        if machine.alarm_number or (machine.motion.block_queue and not machine.is_jogging):
            return 8
        if "F" not in words:
            return 22
        target = self._target(words)
        length, path = make_line_path(self.end_position, target)
        self.end_position = target
        machine.queue_block(PlannedBlock(0, length, words["F"] / 60.0, path, is_jog=True))
        return 0

    def _carry_out(self, line: str) -> None:
        found = _WORD.findall(line)
        codes = [f"{letter}{float(value):g}" for letter, value in found if letter in "GM"]
        words = {letter: float(value) for letter, value in found if letter not in "GM"}
        if not _WORDS.fullmatch(line):
            self.last_error = 2
            self._m.acknowledge_line(2)
            return
        self.last_error = 27 if words.get("N", 0) > _MAX_LINES else self._obey(codes, words)
        if not self.last_error:
            self.executed_lines.append(line)
        if self.last_error or not (self._cuts or self.active_wait is not None):
            self._m.acknowledge_line(self.last_error)

    def _obey(self, codes: list[str], words: dict[str, float]) -> int:
        if "G95" in codes and not self._m.behavior.encoder:
            return 20
        for code in (code for code in codes if code[0] == "G"):
            error = self.modes.apply_code(code, is_lathe_mode=self._m.registers.is_in_lathe_mode)
            if error:
                return error
        if "G10" in codes:
            self.work_offset = [words.get(letter, 0.0) for letter in "XYZ"]
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
            self._apply_spindle(code, words.get("S", abs(machine.programmed_rpm)))
        elif code in {"M7", "M8"}:
            machine.output_states["mist" if code == "M7" else "flood"] = True
            self.active_wait = make_coolant_delay(machine)
        elif code == "M9":
            machine.output_states.update(mist=False, flood=False)
        elif code == "M53":
            self.modes.is_hold_disabled = port == 0
        elif code in {"M64", "M65"} and machine.behavior.outputs:
            if not 0 <= port < machine.behavior.outputs:
                return 39
            machine.output_states[f"out.{port}"] = code == "M64"
        elif code == "M66" and machine.behavior.inputs:
            machine.last_input_result = int(machine.auxiliary_inputs.get(port, False))
        else:
            return 20
        return 0

    def _apply_spindle(self, code: str, rpm: float) -> None:
        """Command the spindle; the line waits for the speed only after a start, stop or reversal."""
        machine = self._m
        before = math.copysign(1.0, machine.programmed_rpm) if machine.programmed_rpm else 0.0
        direction = {"M3": 1.0, "M4": -1.0, "M5": 0.0}[code]
        machine.command_spindle_speed(direction * rpm)
        if direction != before:
            self.active_wait = create_spindle_wait(machine, is_spindle_on=code != "M5")

    def _target(self, words: dict[str, float]) -> Position:
        scale = 0.5 if self.modes.radius == "G7" else 1.0
        x = words["X"] * scale + self.work_offset[0] if "X" in words else self.end_position[0]
        return x, words["Z"] + self.work_offset[2] if "Z" in words else self.end_position[1]

    def _motion(self, words: dict[str, float]) -> int:
        if not {"X", "Z"} & words.keys():
            return 0
        self._f = words.get("F", self._f)
        motion, target = self.modes.motion, self._target(words)
        shape: Shape | None = make_line_path(self.end_position, target)
        if motion in {"G2", "G3"}:
            centre = self.end_position[0] + words.get("I", 0.0), self.end_position[1] + words.get("K", 0.0)
            shape = make_arc_path(self.end_position, target, centre, counterclockwise=motion == "G3")
        if shape is None or (motion in {"G2", "G3"} and self.modes.plane != "G18"):
            return 33
        error = self._thread_error(words) if motion == "G33" else 0
        if error or (motion not in {"G0", "G33"} and self._f <= 0.0):
            return error or 22
        self._hand_over(motion, shape, words)
        self.end_position = target
        return 0

    def _thread_error(self, words: dict[str, float]) -> int:
        machine = self._m
        if not machine.behavior.encoder:
            return 20
        feed = words.get("K", 0.0) * abs(machine.spindle.speed)
        if words.get("K", 0.0) == 0.0:
            return 39
        if abs(machine.spindle.speed) < 1.0:
            return 41
        return 43 if feed > 0.9 * machine.registers[112] else 0

    def _hand_over(self, motion: str, shape: Shape, words: dict[str, float]) -> None:
        length, path = shape
        number = int(words.get("N", 0))
        if motion == "G33":
            self._cuts = True
            self._m.spindle_percent = 100
            self._m.command_spindle_speed(self._m.programmed_rpm)
            block = PlannedBlock(
                number, length, words.get("K", 0.0), path, is_feed_per_revolution=True, is_thread=True
            )
        elif motion == "G0":
            block = PlannedBlock(number, length, 1e9, path, is_rapid=True)
        else:
            per_rev = self.modes.feed_mode == "G95"
            block = PlannedBlock(
                number, length, self._f if per_rev else self._f / 60.0, path, is_feed_per_revolution=per_rev
            )
        self._m.queue_block(block)


def _waits_for_rest(line: str) -> bool:
    """Return whether a line must wait until the planner is empty.

    This applies to M functions except M64 and M65, and to dwells and threading blocks.
    """
    words = {(letter, float(value)) for letter, value in _WORD.findall(line) if letter in "GM"}
    return any(
        (letter == "M" and v not in {64, 65}) or (letter == "G" and v in {4, 33}) for letter, v in words
    )
