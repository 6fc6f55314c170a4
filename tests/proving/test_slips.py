"""The three slips, in every place of our samples where one can be made: an error, or harmless and named here.

G00 left on (the feed of a line is lost, and it goes on by a rapid), a lost point (X4 for X.4), a lost minus.
Nothing is said about stock or tools.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.proving.checks.part_checks import is_serious_finding
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings

PROGRAMS = Path(__file__).parents[2] / "resources" / "programs"
_FEED = re.compile(r"(G9[45])?F\.?\d[\d.]*|G01")
_WORD = re.compile(r"([XZ])(-?)(\d*)\.(\d+)")

# What no proof can call an error, by the number of its line: the tool goes farther away than was meant, or a
# feed to where nothing is cut has become a rapid.
HARMLESS = {
    ("bushing", "point"): {4, 8, 12, 16, 21, 31, 40, 46, 49, 54},
    ("grooves", "point"): {5, 12},
    ("pin", "point"): {18},
    ("pinbar", "point"): {12, 16, 20, 23, 26},
}
# What makes a wrong part, or less of it, without anything that could be known without a drawing: a chamfer is
# not cut, a face keeps its middle, a tool goes on beyond the axis, a stop stands elsewhere (line 5, 7 of
# pinbar), a pass leads outwards, a bar that nobody has described is turned 3 in long where nothing is parted.
ANOTHER_PART = {
    ("bushing", "minus"): {7, 25, 43},
    ("knob", "minus"): {8},
    ("pin", "minus"): {7, 11, 15},
    ("pinbar", "minus"): {5, 15, 25},
    ("bushing", "point"): {7, 37},
    ("knob", "point"): {8},
    ("pin", "point"): {15},
    ("grooves", "point"): {6, 8, 16},
    ("pinbar", "rapid"): {5, 7},
}


def slips(lines: list[str]) -> Iterator[tuple[str, int, str]]:
    """What is lost, the number of the line, and the line as it would be."""
    for at, line in enumerate(lines[1:], start=2):
        code, _, comment = line.partition("(")
        rest = f"({comment}" if comment else ""
        if _FEED.search(code) and not re.search(r"G04|S\d|F300", code) and re.search("[XZ]", code):
            yield "rapid", at, re.sub(r"^(?!G0[23])", "G00", _FEED.sub("", code)) + rest
        for word in _WORD.finditer(code):
            letter, minus, whole, part = word.groups()
            before, behind = code[: word.start()], code[word.end() :] + rest
            if not whole and int(part):
                yield "point", at, f"{before}{letter}{minus}{part}{behind}"
            if minus:
                yield "minus", at, f"{before}{letter}{whole}.{part}{behind}"


@pytest.mark.parametrize("name", ["bushing", "grooves", "knob", "pin", "pinbar"])
@pytest.mark.long
def test_slip_in_sample_gives_error_or_is_listed_as_harmless(name: str) -> None:
    machine = load_machine(None)
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 9)}
    setup = create_power_up_setup(
        machine, tool_offsets=tools, secondary_offsets={1: SecondaryOffset(-0.381, -0.381, 0.381)}
    )
    setting = PartSettings(drives=make_part_settings(machine, {}, {}).drives)
    lines = (PROGRAMS / f"{name}.nc").read_text(encoding="utf-8").splitlines()
    missed: dict[str, set[int]] = {"rapid": set(), "point": set(), "minus": set()}
    made = 0
    for kind, at, line in slips(lines):
        text = "\n".join([*lines[: at - 1], line, *lines[at:]])
        report, _ = prove_program_and_part(ProgramSource(name, text), setup, machine, setting)
        made += 1
        if not any(map(is_serious_finding, report.diagnostics)):
            missed[kind].add(at)
    assert made > 5
    for kind, found in missed.items():
        assert found == HARMLESS.get((name, kind), set()) | ANOTHER_PART.get((name, kind), set()), kind
