"""Typical programming slips and their sound twins, proved as ``prove`` proves them with stock and tools.

``jobs.toml`` holds complete sound jobs. Each further file lists kinds of slips; an entry is an array of
the job, the number of a line, this line with the slip, the same line of a sound twin, the weight that a
machinist gives the slip, and further lines (of the program with the slip) where its consequence may be
reported. An empty line means that the line was forgotten; a line feed in a line stands for an additional
line.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from app.compose.specified_stock import StockContext, read_stock
from app.offsets.offsets_file import read_tool_shapes
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import ClampingModel
from core.proving.part_proof import prove_program_and_part, require_tool_offsets

CATALOGUE = Path(__file__).parent / "slip_catalogue"
JOBS: dict[str, dict[str, Any]] = tomllib.loads((CATALOGUE / "jobs.toml").read_text())
INCH = 25.4
NOSE = 0.0156 * INCH

ERRORS = 129  # slips that are reported as errors
# Slips that the proof does not report at their place, with the cause.
MISSED = {
    "Z zero at the wrong face 2": "a deeper hole within flutes and bar: only a drawing shows it",
    "Z zero at the wrong face 3": "G92 defines part zero: the whole part moves with it",
    "digits exchanged 3": "a taper for a chamfer: only a drawing shows it",
    "radius for a diameter 1": "a longer taper: only a drawing shows it",
    "retract through the part 3": "Z+ beside the axis after a part-off: many programs leave so",
}


@dataclass(frozen=True)
class Entry:
    """One slip with its twin; lines are counted from 1."""

    name: str
    job: str
    line: int
    slip: str
    twin: str
    weight: str
    lines: frozenset[int]


def _entries() -> list[Entry]:
    found = []
    for path in sorted(CATALOGUE.glob("*.toml")):
        if path.stem == "jobs":
            continue
        for kind, rows in tomllib.loads(path.read_text()).items():
            for number, (job, line, slip, twin, weight, *others) in enumerate(rows, start=1):
                lines = frozenset({line, *others})
                found.append(Entry(f"{kind} {number}", job, line, slip, twin, weight, lines))
    return found


ENTRIES = _entries()


def findings(job: str, line: int, text: str, folder: Path) -> list[tuple[int, str, str]]:
    """Return line, severity and check of each error and warning of a job with one line replaced."""
    told = JOBS[job]
    lines = told["program"].strip().splitlines()
    lines[line - 1] = text
    shapes_file = folder / "tools.toml"
    shapes_file.write_text(told["tools"])
    shapes = read_tool_shapes(shapes_file)
    machine = replace(load_machine(None), clamping=ClampingModel(diameter=3.0 * INCH), tooling_kind="single")
    tools = {n: ToolOffset(-12.7, -50.8, shape.nose_radius) for n, shape in shapes.items()}
    setup = create_power_up_setup(
        machine, tool_offsets=tools, secondary_offsets={1: SecondaryOffset(-NOSE, -NOSE, NOSE)}
    )
    setting = make_part_settings(machine, tools, shapes, told["stick_out"] * INCH)
    before = StockContext(lambda path: ProgramSource(path.name, ""), setup, machine, setting)
    setting = replace(setting, stock=read_stock(told["stock"], before))
    report, _ = prove_program_and_part(ProgramSource(job, "\n".join(lines) + "\n"), setup, machine, setting)
    report = require_tool_offsets(report, setup)
    return [
        (d.line, str(d.severity), d.check_name or d.code)
        for d in report.diagnostics
        if str(d.severity) != "note"
    ]


def test_catalog_has_forty_kinds_with_three_entries_each() -> None:
    kinds = [entry.name.rpartition(" ")[0] for entry in ENTRIES]
    assert {kinds.count(kind) for kind in kinds} == {3}
    assert len(ENTRIES) >= 120


@pytest.mark.long
def test_every_slip_is_found_except_known_misses(tmp_path: Path) -> None:
    missed, errors = set(), 0
    for entry in ENTRIES:
        told = findings(entry.job, entry.line, entry.slip, tmp_path)
        weights = {weight for line, weight, _ in told if line in entry.lines}
        errors += "error" in weights
        if not weights:
            missed.add(entry.name)
    assert missed == set(MISSED)
    assert errors >= ERRORS


@pytest.mark.long
def test_correct_twin_gives_no_error_or_warning(tmp_path: Path) -> None:
    for entry in ENTRIES:
        assert findings(entry.job, entry.line, entry.twin, tmp_path) == [], entry.name
