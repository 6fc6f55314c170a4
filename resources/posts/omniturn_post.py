"""Post-processor of FreeCAD (workbench Path or CAM) that writes OmniTurn programs for TurnDesk.

Copy this file and the four other files ``omniturn_*.py`` to FreeCAD's folder of macros. They need only the
Python of FreeCAD. The path of a turning tool is in the XZ plane, X is a radius, and Y must be 0. Lengths are
in mm, with feeds in mm/s, as in every path of FreeCAD. The post raises PostError for each command that it
cannot write; it never leaves out a move.
"""

from __future__ import annotations

import os
import re
import sys
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING or __package__:
    from resources.posts.omniturn_cycles import CycleWriter
    from resources.posts.omniturn_lines import NEAR_MM, PostError, number
    from resources.posts.omniturn_milling import LiveTool
    from resources.posts.omniturn_options import TOOLTIP, parse_options
else:
    sys.path.append(os.path.dirname(os.path.abspath(__file__)))  # FreeCAD loads only this file
    from omniturn_cycles import CycleWriter
    from omniturn_lines import NEAR_MM, PostError, number
    from omniturn_milling import LiveTool
    from omniturn_options import TOOLTIP, parse_options

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable

__all__ = ["TOOLTIP", "PostError", "export", "post"]

_NO_EFFECT = frozenset({"G18", "G21", "G40", "G43", "G49", "G80", "G90", "G94", "M2", "M30"})
_CYCLES = frozenset({"G73", "G81", "G82", "G83"})
_TAPPING = frozenset({"G74", "G84"})
_ZERO_OFFSETS = frozenset({"G54", "G55", "G56", "G57", "G58", "G59"})
_REASONS = {
    "G41": "use a path with the nose radius included",
    "G42": "use a path with the nose radius included",
    "G91": "incremental positions are not supported",
    "G95": "FreeCAD feeds are per minute; use --per-rev",
}


class JobHeights(NamedTuple):
    """Highest Z of the moves of a job in mm: on the face and at the turned diameters, and on the side."""

    clear_z: float
    side: float


class Writer(CycleWriter):
    """Writer of the commands of FreeCAD's paths."""

    def __init__(self, options: argparse.Namespace, heights: JobHeights) -> None:
        """Begin a program."""
        super().__init__(options, heights.clear_z)
        self.heights = heights
        self.live: LiveTool | None = None
        self.tool_pitch = 0.0  # mm, of the tool of the operation

    def prepare_tool(self) -> None:
        """Stop the live tool before, and lock the spindle if the next tool is a live tool."""
        if self.live and self.live.is_running:
            self.add(f"M{self.options.live[1]:02d}")
        is_side = self.tool in self.options.side
        self.is_live = is_side or self.tool in self.options.face
        if self.live or self.is_live:
            self.stop_spindle()
        self.live = None
        if self.is_live:
            self.live = LiveTool(self, self.options.side.get(self.tool, 0.0), self.heights.side)
            self.live.lock_spindle()

    def retract(self) -> None:
        """Leave the plane of a live tool and move to the Z of the tool change."""
        if self.live:
            self.live.leave_plane()
        super().retract()

    def spindle(self, name: str, speed: float) -> None:
        """Start the spindle or, with a live tool, the live tool."""
        if self.live is None:
            super().spindle(name, speed)
            return
        if name == "M4" or speed <= 0.0:
            self.reject(name, "the live tool has no reverse and needs a speed; use M3 with S")
        if self.live.is_running and speed != self.speed:
            self.reject(name, "the speed of a live tool is set by hand; use another tool number for it")
        self.speed = speed
        if not self.live.is_running:
            self.note(f"LIVE TOOL {number(speed, 1)} RPM")
            self.add(f"M{self.options.live[0]:02d}")
            self.live.is_running = True

    # --- commands

    def write(self, command: Any) -> None:
        """Write the lines of one command of a path."""
        name = str(command.Name).strip()
        if name.startswith(("(", ";")):
            self.note(name.strip("();"))
            return
        name = re.sub(r"^([GM])0+(?=\d)", r"\1", name.upper())
        values = dict(command.Parameters)
        for axis in "ABC":
            if abs(values.get(axis, 0.0)) > NEAR_MM:
                self.reject(name, f"{axis} is not 0; rotary axes are not supported")
        if not (self.live and self.write_live(name, values)):
            self.write_common(name, values)

    def write_common(self, name: str, values: dict[str, float]) -> None:
        """Write a command of a turning tool, or one that does not move an axis."""
        if abs(values.get("Y", 0.0)) > NEAR_MM:
            self.reject(name, "Y is not 0; the path must be in the XZ plane, or name a live tool with --face")
        if name in {"G0", "G1", "G2", "G3"}:
            self.move(name, values)
        elif name in _CYCLES:
            self.drill(name, values)
        elif name in _TAPPING:
            self.tap(name, values, self.options.pitch.get(self.tool, self.tool_pitch))
        elif name == "G76":
            self.thread(name, values)
        else:
            self.write_function(name, values)

    def move(self, name: str, values: dict[str, float]) -> None:
        """Write a move of a turning tool."""
        x, z = values.get("X", self.x), values.get("Z", self.z)
        if name == "G0":
            self.rapid(x, z)
            return
        self.cut_feed = values.get("F", self.cut_feed)
        if name == "G1":
            self.cut(name, x, z, self.cut_feed)
        else:
            self.arc(name, values, x, z, self.cut_feed)

    def write_live(self, name: str, values: dict[str, float]) -> bool:
        """Write a command of a live tool; return False if it is a command of all tools."""
        assert self.live is not None
        if name in {"G0", "G1", "G2", "G3"}:
            self.live.move(name, values)
        elif name in _CYCLES:
            self.live.drill(name, values)
        elif name in _TAPPING or name == "G76":
            self.reject(name, "a live tool cannot tap or cut a thread, because it has one direction")
        elif name == "M5":
            self.retract()
            if self.live.is_running:
                self.add(f"M{self.options.live[1]:02d}")
            self.live.is_running = False
        else:
            if name[:1] == "M" or name == "G4":
                self.live.leave_plane()
            return False
        return True

    def write_function(self, name: str, values: dict[str, float]) -> None:
        """Write a command that does not move an axis."""
        if name == "M6":
            self.change_tool(name, values.get("T", 0.0))
        elif name in {"M3", "M4"}:
            self.spindle(name, values.get("S", self.speed))
        elif name == "M5":
            self.stop_spindle()
        elif name in {"M0", "M1", "M8", "M9"}:
            self.add(f"M{int(name[1:]):02d}")
        elif name == "M7":
            self.add("M08")
        elif name == "G4":
            self.dwell(values.get("P", 0.0))
        elif name in {"G98", "G99"}:
            self.returns_to_start = name == "G98"
        elif name in _ZERO_OFFSETS:
            self.select_zero(name)
        elif name not in _NO_EFFECT:
            self.reject(name, _REASONS.get(name, "this command does not exist in OmniTurn"))

    def select_zero(self, name: str) -> None:
        """Select the work shift of a zero offset; without --shift, only G54 is known."""
        shift = self.options.shift.get(name, (0.0, 0.0) if name == "G54" else None)
        if shift is None:
            self.reject(name, f"the position of this zero is unknown; use --shift {name}=X,Z in mm")
        self.shift_zero(name, shift)

    def end(self, *, coolant: bool) -> str:
        """Return the program with its last lines, and with the loop for several parts."""
        self.retract()
        if self.live and self.live.is_running:
            self.add(f"M{self.options.live[1]:02d}")
        if coolant:
            self.add("M09")
        self.add("M05")
        lines = [*self.lines, "M30"]
        if self.options.parts > 1:
            if self.shift != (0.0, 0.0):
                self.add("G10" + self.word("X", -self.shift[0]) + self.word("Z", -self.shift[1]))
            first, *part = self.lines
            lines = [first, *self.list_loop_lines(), "M30", "}1", *part, "M99"]
        return "\n".join(lines) + "\n"

    def list_loop_lines(self) -> list[str]:
        """Return the loop that calls subroutine 1 for each part, with the bar feed or the work shift.

        Before a bar feed, the end of the bar must be where the last part was cut off.
        """
        options = self.options
        loop = f"LS{options.parts}"
        if not options.bar_stop:
            return [loop, "P1", "G10X0" + self.word("Z", -options.part_length), "LF"]
        end, rate = options.facing_stock - options.part_length, number(options.bar_feed, 3)
        clear = self.word("Z", self.clear_z)
        return [
            *(loop, "M05", f"T{options.bar_stop}", f"G00X0{clear}"),
            *(f"G00{self.word('Z', end)}", "M13", f"G94F{rate}{self.word('Z', options.facing_stock)}"),
            *("M12", f"G00{clear}", "P1", "LF"),
        ]


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


def find_heights(operations: Iterable[Any], side_tools: Iterable[int]) -> JobHeights:
    """Return the highest Z of all moves; the paths of ``side_tools`` have a Z of their own."""
    heights: dict[bool, list[float]] = {True: [], False: []}
    is_side, sides = False, frozenset(side_tools)
    for command in (command for each in operations for command in each.Path.Commands):
        values, name = dict(command.Parameters), str(command.Name).upper()
        if re.fullmatch("M0*6", name):
            is_side = values.get("T") in sides
        reads_r = name in _CYCLES | _TAPPING
        heights[is_side] += [
            value
            for letter, value in values.items()
            if (letter == "Z" or (letter == "R" and reads_r)) and name[:1] == "G"
        ]
    return JobHeights(max(heights[False], default=0.0), max(heights[True], default=0.0))


def read_pitch(operation: Any) -> float:
    """Return the pitch of the tool of an operation in mm, or 0 if the tool has none."""
    tool = getattr(getattr(operation, "ToolController", None), "Tool", None)
    pitch = getattr(tool, "Pitch", 0.0)
    return float(getattr(pitch, "Value", pitch) or 0.0)


def post(objects: Iterable[Any], argument_text: str = "") -> str:
    """Return the program for the objects of a job. Raises PostError if it cannot be written."""
    operations = list_operations(objects)
    options = parse_options(argument_text)
    heights = find_heights(operations, options.side)
    if options.side and options.change_z is None and not heights.clear_z:
        raise PostError("all paths are on the side; enter the Z of the tool change with --change-z")
    highest_shift = max([0.0, *(z for _, z in options.shift.values())])
    clear_z = max(heights.clear_z + highest_shift, 0.0) if options.change_z is None else options.change_z
    if clear_z < 0.0 or (options.bar_stop and clear_z <= options.facing_stock):
        raise PostError("--change-z: the tool change must be in front of the part and of the facing stock")
    writer = Writer(options, heights._replace(clear_z=clear_z))
    coolant = False
    for each in operations:
        if writer.live:
            writer.live.leave_plane()
        writer.label, writer.tool_pitch = str(getattr(each, "Label", "")), read_pitch(each)
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
