"""Options of the FreeCAD post-processor.

FreeCAD does not show this file in its list. Copy it together with ``omniturn_post.py``.
"""

from __future__ import annotations

import argparse
import math
import re
import shlex
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING or __package__:
    from resources.posts.omniturn_lines import MAX_TOOL_NUMBER, PostError
else:
    from omniturn_lines import MAX_TOOL_NUMBER, PostError

_LARGEST_NUMBER = 1e6
_CONTROL_CODES = frozenset({1, 2, 3, 4, 5, 8, 9, 12, 13, 19, 30, 31, 89, *range(91, 100)})
"""M codes with another meaning on the control, such as the start of the spindle."""

TOOLTIP = """
Writes programs for OmniTurn-style lathes with TurnDesk. Lengths are in mm. Options:
--inches            inches instead of millimeters
--per-rev           feeds per revolution instead of feeds per minute
--rapid RATE        rapid rate in mm/min or in/min (default: 300 in/min)
--change-z Z        Z of the tool change (default: the highest Z of the job)
--no-comments       no comments
--face 5,6          tools that are live tools on the face
--side 7=30         live tool on the side, and the diameter at which its path is unrolled
--live 15,16        M codes that start and stop the live tools
--c-rpm RPM         speed of C (default: 60)
--pitch 4=1.25      pitch of a tap, if the tool has no pitch
--shift G55=0,-20   X (radius) and Z of another part zero
--parts N           number of parts
--part-length L     length from part to part, including the cut-off width
--bar-stop T        stop for the bar feed (default: no bar feed, the zero moves along the bar)
--bar-feed RATE     feed of the bar in mm/min or in/min (default: 500 mm/min, 20 in/min)
--facing-stock L    Z of the end of the bar after the bar feed (default: 0)
"""


def parse_options(argument_text: str) -> argparse.Namespace:
    """Return the options of the job. Raises PostError if an option is unknown or invalid."""
    parser = argparse.ArgumentParser(prog="omniturn_post", add_help=False, allow_abbrev=False)
    for name in ("inches", "per-rev", "no-comments", "no-show-editor"):  # FreeCAD adds the last to some jobs
        parser.add_argument(f"--{name}", action="store_true")
    for name, value in (("rapid", 0.0), ("c-rpm", 60.0), ("part-length", 0.0), ("bar-feed", 0.0)):
        parser.add_argument(f"--{name}", type=_read_number, default=value)
    parser.add_argument("--facing-stock", type=_read_number, default=0.0)
    parser.add_argument("--change-z", type=_read_number)
    parser.add_argument("--parts", type=int, default=1)
    parser.add_argument("--bar-stop", type=int, default=0)
    parser.add_argument("--face", type=_read_tools, default=())
    parser.add_argument("--live", type=_read_codes)
    for name in ("side", "pitch"):
        parser.add_argument(f"--{name}", type=_read_tool_value, action="append", default=[])
    parser.add_argument("--shift", type=_read_shift, action="append", default=[])
    try:
        options = parser.parse_args(shlex.split(argument_text))
    except (SystemExit, ValueError) as error:
        raise PostError(f"unknown or invalid option in {argument_text!r}; {TOOLTIP.strip()}") from error
    options.side, options.pitch, options.shift = dict(options.side), dict(options.pitch), dict(options.shift)
    options.bar_feed = options.bar_feed or (20.0 if options.inches else 500.0)
    for name, reason in _list_faults(options):
        raise PostError(f"--{name}: {reason}")
    return options


def _list_faults(options: argparse.Namespace) -> Iterable[tuple[str, str]]:
    """Yield the name and the fault of each option that cannot be used."""
    for name in ("rapid", "part_length", "facing_stock"):
        if getattr(options, name) < 0.0:
            yield name.replace("_", "-"), "use a positive value"
    for name in ("c_rpm", "bar_feed", "parts"):
        if getattr(options, name) <= 0:
            yield name.replace("_", "-"), "use a value greater than 0"
    yield from _list_tool_faults(options)
    if options.parts > 1 and not options.part_length:
        yield "part-length", "enter the length from part to part"
    if options.parts == 1 and (options.bar_stop or options.part_length):
        yield "parts", "enter the number of parts"
    if options.facing_stock >= options.part_length > 0.0:
        yield "facing-stock", "it must be less than the part length"


def _list_tool_faults(options: argparse.Namespace) -> Iterable[tuple[str, str]]:
    """Yield the name and the fault of each option with a tool number that cannot be used."""
    tools = [*options.face, *options.side, *options.pitch, *([options.bar_stop] if options.bar_stop else [])]
    for tool in tools:
        if not 1 <= tool <= MAX_TOOL_NUMBER:
            yield "face, --side, --pitch or --bar-stop", f"T{tool} does not exist"
    if set(options.face) & set(options.side):
        yield "side", "a tool is on the face or on the side, not on both"
    if any(value <= 0.0 for value in (*options.side.values(), *options.pitch.values())):
        yield "side or --pitch", "use a value greater than 0"
    if (options.face or options.side) and options.live is None:
        yield "live", "enter the two M codes that start and stop the live tools of this lathe"


def _read_number(text: str) -> float:
    """Return a number; raises ValueError if it is not a number, infinite or too large for a program."""
    value = float(text)
    if not math.isfinite(value) or abs(value) > _LARGEST_NUMBER:
        raise ValueError(text)
    return value


def _read_tools(text: str) -> tuple[int, ...]:
    return tuple(int(each) for each in text.split(","))


def _read_codes(text: str) -> tuple[int, int]:
    start, stop = (int(each) for each in text.split(","))
    if not (0 < start < 100 and 0 < stop < 100 and start != stop) or _CONTROL_CODES & {start, stop}:
        raise ValueError(text)
    return start, stop


def _read_tool_value(text: str) -> tuple[int, float]:
    tool, value = text.split("=")
    return int(tool), _read_number(value)


def _read_shift(text: str) -> tuple[str, tuple[float, float]]:
    found = re.fullmatch(r"(G5[5-9])=([^,]+),([^,]+)", text)
    if found is None:
        raise ValueError(text)
    return found[1], (_read_number(found[2]), _read_number(found[3]))
