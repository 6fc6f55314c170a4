"""Post-processor of FreeCAD (workbench Path or CAM) that writes OmniTurn programs for TurnDesk.

Copy this file to FreeCAD's folder of macros. It needs only the Python of FreeCAD. The path is in the XZ
plane, X is a radius, and lengths are in mm, with feeds in mm/s, as in every path of FreeCAD. Y must be 0.
The post raises PostError for each command that it cannot write; it never leaves out a move.
"""

from __future__ import annotations

import argparse
import math
import re
import shlex
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterable

TOOLTIP = """
Writes programs for OmniTurn-style lathes with TurnDesk. Options:
--inches            inches instead of millimeters
--per-rev           feeds per revolution instead of feeds per minute
--rapid RATE        rapid rate in mm/min or in/min (default: 300 in/min)
--change-z Z        Z of the tool change, in mm (default: the highest Z of the job)
--no-comments       no comments
"""
MM_PER_INCH = 25.4
STEP_IN = 0.00005  # resolution of X and Z, on the radius
MAX_TOOL_NUMBER = 32
MIN_DWELL_S = 0.1
MAX_INFEED_ANGLE_DEG = 30.0
_NEAR_MM = 1e-6
_ARC_TOLERANCE_MM = 0.01
_LONGEST_COMMENT = 60
_NOT_IN_COMMENTS = re.compile(r"[^ -'*-~]")
_NO_EFFECT = frozenset({"G18", "G21", "G40", "G43", "G49", "G54", "G80", "G90", "G94", "M2", "M30"})
_CYCLES = frozenset({"G73", "G81", "G82", "G83"})
_REASONS = {
    "G41": "use a path with the nose radius included",
    "G42": "use a path with the nose radius included",
    "G84": "tapping is not supported; write the tap moves in the editor",
    "G74": "tapping is not supported; write the tap moves in the editor",
    "G91": "incremental positions are not supported",
    "G95": "FreeCAD feeds are per minute; use --per-rev",
}


class PostError(ValueError):
    """Error raised for a command that the post-processor cannot write.

    The text contains the operation and the reason.
    """


def number(value: float, places: int = 5) -> str:
    """Format a number without unnecessary zeros, such as ``.5`` or ``-1.25``."""
    text = f"{value:.{places}f}".rstrip("0").rstrip(".")
    return re.sub(r"^(-?)0\.", r"\1.", "0" if text in {"-0", ""} else text)


def parse_options(argument_text: str) -> argparse.Namespace:
    """Return the options of the job. Raises PostError if an option is unknown or invalid."""
    parser = argparse.ArgumentParser(prog="omniturn_post", add_help=False)
    parser.add_argument("--inches", action="store_true")
    parser.add_argument("--per-rev", action="store_true")
    parser.add_argument("--rapid", type=float, default=0.0)
    parser.add_argument("--change-z", type=float)
    parser.add_argument("--no-comments", action="store_true")
    parser.add_argument("--no-show-editor", action="store_true")  # FreeCAD adds it to some jobs
    try:
        options = parser.parse_args(shlex.split(argument_text))
    except (SystemExit, ValueError) as error:
        raise PostError(f"unknown or invalid option in {argument_text!r}; {TOOLTIP.strip()}") from error
    if options.rapid < 0.0:
        raise PostError(f"--rapid {options.rapid:g}: use a positive rate")
    return options


class Writer:
    """Writer of the program lines, with the modal state after the last line.

    Positions are in mm, with X as a radius. ``x`` and ``z`` are None while the position is unknown.
    """

    def __init__(self, options: argparse.Namespace, clear_z: float) -> None:
        """Begin a program. ``clear_z`` is the Z of the tool change, in mm."""
        self.options = options
        self.clear_z = clear_z
        self.unit = MM_PER_INCH if options.inches else 1.0
        self.lines: list[str] = []
        self.comment = ""
        self.label = ""
        self.x: float | None = None
        self.z: float | None = None
        self.tool = 0
        self.speed = 0.0
        self.is_rapid = False
        self.feed_words = ""
        self.needs_both = True
        self.returns_to_start = True  # G98
        self.cut_feed = 0.0  # mm/s, of the last cut
        self.cycle_feed = 0.0
        rate = options.rapid or (300.0 if options.inches else 7620.0)
        self.add(f"G90G94F{number(rate, 3)}{'G70' if options.inches else 'G71'}G72")

    # --- lines and words

    def add(self, text: str) -> None:
        """Append a line, together with the comment that ``note`` has set for it."""
        comment = "" if self.options.no_comments else self.comment
        self.lines.append(text + (f"({comment})" if comment else ""))
        self.comment = ""

    def note(self, text: str) -> None:
        """Set the comment of the next line, with only the characters that the control accepts."""
        self.comment = _NOT_IN_COMMENTS.sub(" ", text)[:_LONGEST_COMMENT].strip()

    def reject(self, name: str, reason: str) -> NoReturn:
        """Raise PostError for a command of the current operation."""
        raise PostError(f"{self.label or 'path'}, {name}: {reason}")

    def round(self, value: float) -> float:
        """Convert a length in mm to the unit of the program, rounded to the resolution of the control."""
        if self.options.inches:
            return round(round(value / MM_PER_INCH / STEP_IN) * STEP_IN, 5) + 0.0
        return round(value, 4) + 0.0

    def word(self, letter: str, value: float) -> str:
        """Return the word of a length in mm; X is written as a diameter."""
        rounded = self.round(value)
        return letter + number(2.0 * rounded if letter == "X" else rounded)

    def position(self, x: float, z: float) -> str:
        """Return the words of the coordinates that change."""
        words = ""
        if self.needs_both or self.x is None or self.round(x) != self.round(self.x):
            words += self.word("X", x)
        if self.needs_both or self.z is None or self.round(z) != self.round(self.z):
            words += self.word("Z", z)
        return words

    def feed(self, name: str, feed: float) -> str:
        """Return the words of a feed in mm/s, or an empty string if it is already active."""
        if feed <= 0.0:
            self.reject(name, "the feed is 0; enter the feeds in the tool controller")
        per_minute = feed * 60.0 / self.unit
        words = f"G94F{number(per_minute, 4)}"
        if self.options.per_rev:
            if self.speed <= 0.0:
                self.reject(name, "--per-rev needs a spindle speed in the tool controller")
            words = f"G95F{number(per_minute / self.speed, 6)}"
        if not self.is_rapid and words == self.feed_words:
            return ""
        self.is_rapid, self.feed_words = False, words
        return words

    # --- moves

    def rapid(self, x: float | None, z: float | None) -> None:
        """Write a rapid.

        If a coordinate is unknown, nothing is written until a later rapid specifies it.
        """
        if x is None or z is None:
            self.x, self.z = x, z
            return
        words = self.position(x, z)
        if words:
            self.add(("" if self.is_rapid else "G00") + words)
            self.is_rapid, self.needs_both = True, False
        self.x, self.z = x, z

    def cut(self, name: str, x: float | None, z: float | None, feed: float, arc: str = "") -> None:
        """Write a straight cut, or an arc with the words ``arc``."""
        if x is None or z is None or self.x is None or self.z is None or self.needs_both:
            self.reject(name, "the position before this cut is unknown; begin with a rapid in X and Z")
        words = self.word("X", x) + self.word("Z", z) if arc else self.position(x, z)
        if words:
            self.add(self.feed(name, feed) + arc[:3] + words + arc[3:])
        self.x, self.z = x, z

    def arc(self, name: str, values: dict[str, float], x: float | None, z: float | None, feed: float) -> None:
        """Write an arc of the XZ plane; an arc of more than 180° is divided at its middle.

        G02 and G03 are exchanged, because FreeCAD views the plane with X+ up, and OmniTurn with X+ down. An
        arc that ends at its start because of rounding is not written, because the control would cut a full
        circle.
        """
        if x is None or z is None or self.x is None or self.z is None:
            self.reject(name, "the position before this arc is unknown")
        if abs(values.get("J", 0.0)) > _NEAR_MM:
            self.reject(name, "the arc is not in the XZ plane")
        center_x, center_z = self.x + values.get("I", 0.0), self.z + values.get("K", 0.0)
        radius = math.hypot(self.x - center_x, self.z - center_z)
        if radius < _NEAR_MM or abs(math.hypot(x - center_x, z - center_z) - radius) > _ARC_TOLERANCE_MM:
            self.reject(name, "the end of the arc is not on its circle")
        if 0.0 < math.hypot(x - self.x, z - self.z) < _NEAR_MM:
            return
        sign = 1.0 if name == "G3" else -1.0  # seen with Z to the right and X+ up
        begin = math.atan2(self.x - center_x, self.z - center_z)
        sweep = sign * (math.atan2(x - center_x, z - center_z) - begin) % (2.0 * math.pi) or 2.0 * math.pi
        parts = 1 if sweep <= math.pi + 1e-9 else 2
        for part in range(1, parts + 1):
            at = begin + sign * sweep * part / parts
            end_x, end_z = (
                (x, z)
                if part == parts
                else (
                    center_x + radius * math.sin(at),
                    center_z + radius * math.cos(at),
                )
            )
            words = self.word("I", center_x - self.x) + self.word("K", center_z - self.z)
            if self.position(end_x, end_z):
                self.cut(name, end_x, end_z, feed, ("G02" if name == "G3" else "G03") + words)

    # --- tools, spindle, cycles

    def change_tool(self, name: str, value: float) -> None:
        """Retract to the Z of the tool change and select a tool; the next rapid has X and Z."""
        if value != int(value) or not 1 <= value <= MAX_TOOL_NUMBER:
            self.reject(name, f"T{value:g} does not exist; use T1 to T{MAX_TOOL_NUMBER}")
        self.retract()
        self.tool = int(value)
        self.add(f"T{self.tool}")
        self.x = self.z = None
        self.needs_both = True

    def retract(self) -> None:
        """Move to the Z of the tool change if a tool is active."""
        if self.tool and self.x is not None and self.z is not None and self.z < self.clear_z:
            self.rapid(self.x, self.clear_z)

    def spindle(self, name: str, speed: float) -> None:
        """Start the spindle."""
        if speed <= 0.0:
            self.reject(name, "the spindle speed is 0; enter it in the tool controller")
        self.speed = speed
        self.add(f"G97{'M03' if name == 'M3' else 'M04'}S{number(speed, 1)}")

    def drill(self, name: str, values: dict[str, float]) -> None:
        """Write a drilling cycle on the spindle axis."""
        self.cycle_feed = values.get("F", self.cycle_feed)
        if abs(values.get("X", self.x or 0.0)) > _NEAR_MM or abs(values.get("Y", 0.0)) > _NEAR_MM:
            self.reject(name, "the hole is not on the spindle axis")
        if "Z" not in values or "R" not in values:
            self.reject(name, "the cycle has no Z or no R")
        start, bottom, plane = self.z, values["Z"], values["R"]
        if bottom >= plane:
            self.reject(name, "the bottom of the hole is not below R")
        high = max(plane, start) if start is not None else plane
        if start is not None and start < plane:
            self.rapid(self.x, plane)  # first in Z, so that the tool does not cross the part on its way to X0
        self.rapid(0.0, high)
        self.rapid(0.0, plane)
        if name in {"G73", "G83"}:
            peck = values.get("Q", 0.0)
            if peck <= 0.0:
                self.reject(name, "the peck depth Q is missing")
            self.cycle(name, "G83" + self.word("Z", bottom) + self.word("K", peck))
        elif values.get("P", 0.0) > 0.0:
            self.cut(name, 0.0, bottom, self.cycle_feed)
            self.dwell(values["P"])
            self.rapid(0.0, plane)
        else:
            self.cycle(name, "G81" + self.word("Z", bottom))
        if self.returns_to_start:
            self.rapid(0.0, high)

    def cycle(self, name: str, words: str) -> None:
        """Write a line with a drilling cycle, after which the tool is at the start point again."""
        feed = self.feed(name, self.cycle_feed)
        self.add(words if not feed else feed + words)

    def dwell(self, seconds: float) -> None:
        """Write a dwell; the control needs at least 0.1 s."""
        self.add(f"G04F{number(max(seconds, MIN_DWELL_S), 3)}")

    def thread(self, name: str, values: dict[str, float]) -> None:
        """Write the thread of a G76 as FreeCAD's turning operations use it.

        P is the lead, I the distance from the current X to the crest, J the first depth, K the full depth,
        Q the infeed angle and H the number of spring passes.
        """
        missing = [letter for letter in "PIJK" if not values.get(letter)] + ([] if "Z" in values else ["Z"])
        if self.x is None or self.z is None or self.needs_both or missing:
            self.reject(name, f"the thread needs a known position and {' '.join(missing) or 'X Z'}")
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

    # --- commands

    def write(self, command: Any) -> None:
        """Write the lines of one command of a path."""
        name = str(command.Name).strip()
        if name.startswith(("(", ";")):
            self.note(name.strip("();"))
            return
        name = re.sub(r"^([GM])0+(?=\d)", r"\1", name.upper())
        values = dict(command.Parameters)
        for axis in "YABC":
            if abs(values.get(axis, 0.0)) > _NEAR_MM:
                self.reject(name, f"{axis} is not 0; the path must be in the XZ plane")
        if name in {"G0", "G1", "G2", "G3"}:
            x, z = values.get("X", self.x), values.get("Z", self.z)
            if name == "G0":
                self.rapid(x, z)
                return
            self.cut_feed = values.get("F", self.cut_feed)
            if name == "G1":
                self.cut(name, x, z, self.cut_feed)
            else:
                self.arc(name, values, x, z, self.cut_feed)
        elif name in _CYCLES:
            self.drill(name, values)
        elif name == "G76":
            self.thread(name, values)
        else:
            self.write_function(name, values)

    def write_function(self, name: str, values: dict[str, float]) -> None:
        """Write a command that does not move an axis."""
        if name == "M6":
            self.change_tool(name, values.get("T", 0.0))
        elif name in {"M3", "M4"}:
            self.spindle(name, values.get("S", self.speed))
        elif name in {"M0", "M1", "M5", "M8", "M9"}:
            self.add(f"M{int(name[1:]):02d}")
        elif name == "M7":
            self.add("M08")
        elif name == "G4":
            self.dwell(values.get("P", 0.0))
        elif name in {"G98", "G99"}:
            self.returns_to_start = name == "G98"
        elif name not in _NO_EFFECT:
            self.reject(name, _REASONS.get(name, "this command does not exist in OmniTurn"))

    def end(self, *, coolant: bool) -> str:
        """Return the program with its last lines."""
        self.retract()
        if coolant:
            self.add("M09")
        self.add("M05")
        self.add("M30")
        return "\n".join(self.lines) + "\n"


def list_operations(objects: Iterable[Any]) -> list[Any]:
    """Return the active objects that have a path, in order, with the members of groups."""
    found: list[Any] = []
    for each in objects:
        base = getattr(each, "Base", None)
        if not getattr(each, "Active", True) or not getattr(base, "Active", True):
            continue
        if hasattr(each, "Path"):
            found.append(each)
        elif hasattr(each, "Group"):
            found.extend(list_operations(each.Group))
    return found


def find_clear_z(operations: Iterable[Any]) -> float:
    """Return the highest Z of all moves, in mm."""
    heights = [
        value
        for each in operations
        for command in each.Path.Commands
        for letter, value in dict(command.Parameters).items()
        if (letter == "Z" or (letter == "R" and command.Name in _CYCLES)) and command.Name[:1] == "G"
    ]
    return max(heights, default=0.0)


def post(objects: Iterable[Any], argument_text: str = "") -> str:
    """Return the program for the objects of a job. Raises PostError if it cannot be written."""
    operations = list_operations(objects)
    options = parse_options(argument_text)
    clear_z = find_clear_z(operations) if options.change_z is None else options.change_z
    writer = Writer(options, clear_z)
    coolant = False
    for each in operations:
        writer.label = str(getattr(each, "Label", ""))
        writer.note(writer.label)
        mode = getattr(each, "CoolantMode", getattr(getattr(each, "Base", None), "CoolantMode", "None"))
        wanted = mode in {"Flood", "Mist"}
        if each.Path.Commands and wanted != coolant and hasattr(each, "ToolController"):
            writer.add("M08" if wanted else "M09")
            coolant = wanted
        for command in each.Path.Commands:
            writer.write(command)
    if not writer.tool:
        raise PostError("the job has no tool change; add a tool controller")
    return writer.end(coolant=coolant)


def export(objects: Iterable[Any], filename: str, argument_text: str) -> str:
    """Write the program to a file, as FreeCAD requires; ``-`` returns it without a file."""
    text = post(objects, argument_text)
    if filename != "-":
        with open(filename, "w", encoding="ascii", newline="\n") as file:
            file.write(text)
    return text
