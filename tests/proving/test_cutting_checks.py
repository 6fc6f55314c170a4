"""Cuts without a tool, in an open collet, with a live tool or spindle at rest; inputs that are not there."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove
from tests.worked import FOLDER

HEAD = ("G90G94F300", "M03S1000")
MILL = ("G90G94F300", "T1", "X-.5Z.1", "G94F20", "M19S60", "G04F3")


def proved(*lines: str, machine: Machine | None = None) -> ProofReport:
    machine = machine or load_machine(None)
    tools = {n: ToolOffset() for n in range(1, 9)}
    return prove(
        ProgramSource("A", "\n".join((*lines, ""))),
        create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={}),
        machine,
    )


def checks(report: ProofReport) -> list[tuple[str, str, int]]:
    """Check, weight and line of each finding of a check."""
    return [(d.check_name, str(d.severity), d.line) for d in report.diagnostics if d.check_name]


CASES: list[tuple[tuple[str, ...], list[tuple[str, str, int]]]] = [
    # no T at all: a shop whose home is part zero may work so, and is told
    ((*HEAD, "X.5Z.1", "G95F.004Z-.2", "X.6", "M30"), [("no-tool", "warning", 4)]),
    ((*HEAD, "X.5Z.1", "F20Z-.2", "M30"), [("no-tool", "warning", 4)]),
    # T after the first cut; T0 and then a cut
    ((*HEAD, "X.5Z.1", "G95F.004Z-.2", "T1", "X.5Z.1", "M30"), [("no-tool", "error", 4)]),
    ((*HEAD, "T1", "X.5Z.1", "G95F.004Z-.2", "T0", "X.4Z.1", "M30"), [("no-tool", "error", 7)]),
    ((*HEAD, "T1", "X.5Z.1", "T0", "F50X.4Z-.1", "Z-.2", "T2", "X.5Z.1", "T0", "F9X.1Z1", "M30"),
     [("no-tool", "error", 6), ("no-tool", "error", 11)]),
    # moves to a place are no cuts, and G92 says where the point stands
    ((*HEAD, "X.5Z.1", "F100Z.5", "T1", "X.5Z.1", "G95F.004Z-.2", "M30"), []),
    ((*HEAD, "X.5Z.1", "G92X.5Z.1", "G95F.004Z-.2", "M30"), []),
    ((*HEAD, "T1", "X.5Z.1", "T0", "G92X.5Z.1", "G95F.004Z-.2", "M30"), []),
    # G96: at the axis the spindle goes to its highest speed, 3500 rpm, where no G77 limits it;
    # 300 ft/min at .2 in of radius are 2865 rpm
    ((*HEAD, "T1", "G96S300", "X.5Z.1", "G95F.004Z0", "X0", "X.5", "M30"),
     [("no-speed-limit", "warning", 7)]),
    ((*HEAD, "T1", "G96S300", "X.5Z.1", "G95F.004Z0", "X.2", "X.5", "M30"), []),
    ((*HEAD, "T1", "G96S300", "G77S2500", "X.5Z.1", "G95F.004Z0", "X0", "X.5", "M30"), []),
    ((*HEAD, "T1", "G96S300", "G76S1000", "X.5Z.1", "G95F.004Z0", "X0", "X.5", "M30"),
     [("no-speed-limit", "warning", 8)]),
    # 5000 ft/min at .5 in of radius are 19099 rpm, over twice 3500; 3000 ft/min are less than 1000 m/min
    ((*HEAD, "T1", "G96S5000", "G77S2500", "X.5Z.1", "G95F.004Z-.2", "M30"), [("surface-speed", "error", 7)]),
    ((*HEAD, "T1", "G96S3000", "G77S2500", "X.5Z.1", "G95F.004Z-.2", "M30"), []),
    # the collet
    ((*HEAD, "T1", "X.5Z.1", "M13", "G95F.004Z-.2", "Z-.3", "M12", "Z-.5", "M30"),
     [("collet-open", "error", 6)]),
    ((*HEAD, "T1", "X.5Z.1", "M13", "G02X.6Z0R.5F9", "M12", "M30"), [("collet-open", "error", 6)]),
    ((*HEAD, "T1", "X.24Z.2", "M13", "G33X.21Z-.5I.01K.05C", "M12", "M30"), [("collet-open", "error", 6)]),
    ((*HEAD, "T1", "X.5Z.1", "M13", "F20Z-.2", "M12", "M30"), [("collet-open", "warning", 6)]),
    ((*HEAD, "T1", "X.5Z.1", "M13", "F20X.4", "M12", "M30"), [("collet-open", "warning", 6)]),
    # bar work: a stop or a gripper goes away from the spindle with the collet open, also at speed
    ((*HEAD, "T1", "X0Z-1", "M13", "F50Z.025", "M12", "G95F.004X.2", "M30"), []),
    ((*HEAD, "T1", "X0Z-1", "M13", "G00X.5Z1", "M12", "M30"), []),
    # it ends open, and the next cycle cuts before it closes
    ((*HEAD, "T1", "X.5Z.1", "G95F.004Z-.2", "M05", "M13", "M30"), [("collet-open", "warning", 8)]),
    (("G90G94F300", "M12", *HEAD[1:], "T1", "X.5Z.1", "G95F.004Z-.2", "M05", "M13", "M30"), []),
    # the live tool
    ((*MILL, "(~PLXC)", "(X.25Y0)", "(X.25Y.2)", "(END)", "M30"), [("live-tool-off", "error", 8)]),
    ((*MILL, "M27", "(~PLXC)", "(X.25Y0)", "(END)", "M28", "M30"), []),
    ((*MILL, "M27", "M28", "(~PLXC)", "(X.25Y0)", "(END)", "M30"), [("live-tool-off", "error", 10)]),
    ((*MILL, "M25", "(~PLXC)", "(X.25Y0)", "(END)", "M30"), [("live-tool-off", "error", 9)]),
    ((*MILL, "X-.4", "M30"), [("live-tool-off", "warning", 7)]),
    ((*MILL, "M15", "X-.4", "M30"), []),
    # the spindle: stopped by the program itself; by hand it may be switched (a program without M03)
    ((*HEAD, "T1", "X.5Z.1", "M05", "F20Z-.2", "M30"), [("spindle-off", "warning", 6)]),
    ((*HEAD, "T1", "X.5Z.1", "M05", "F20Z-.2", "M03", "Z-.3", "M05", "X.6", "M30"),
     [("spindle-off", "warning", 6), ("spindle-off", "warning", 10)]),
    (("G90G94F300", "T1", "X.5Z.1", "F20Z-.2", "M30"), []),
    ((*HEAD, "T1", "X.5Z.1", "M05", "M15", "F20Z-.2", "M30"), []),
    # where it begins
    (("G91G94F300", "X.1", "G90", "T1", "X.5Z.1", "M30"), [("start-place", "warning", 2)]),
    (("G90G94F300", "T1", "G91", "X.1Z.1", "G90", "M30"), [("start-place", "warning", 4)]),
    (("G90G94F300", "T1", "X.5Z.1", "G91X.1", "G90", "M30"), []),
    # inputs
    ((*HEAD, "M97I17C1P1", "M30", "}1", "G04F1", "M99"), [("no-input", "error", 3)]),
    ((*HEAD, "M97I16C1P1", "M30", "}1", "G04F1", "M99"), []),
]  # fmt: skip


@pytest.mark.parametrize(("lines", "expected"), CASES, ids=[" ".join(lines) for lines, _ in CASES])
def test_check_finds_its_error_and_nothing_else(
    lines: tuple[str, ...], expected: list[tuple[str, str, int]]
) -> None:
    assert checks(proved(*lines)) == expected


def test_finding_names_first_block_and_remedy() -> None:
    (found,) = [d for d in proved(*HEAD, "X.5Z.1", "G95F.004Z-.2", "M30").diagnostics if d.check_name]
    assert (found.block_number, found.line) == (3, 4)  # M03, X.5Z.1, Z-.2
    assert "Write T" in found.hint


def test_live_tool_check_is_skipped_without_live_tool_output() -> None:
    machine = load_machine(None)
    without = replace(machine, m_code_outputs={25: ("catcher", True), 26: ("catcher", False)})
    assert checks(proved(*MILL, "(~PLXC)", "(X.25Y0)", "(END)", "M30", machine=without)) == []


def test_wait_for_missing_input_is_rejected() -> None:
    machine = load_machine(None)
    inputs = {name: each for name, each in machine.inputs.items() if name != "TB2-7"}
    report = proved(*HEAD, "M94", "M93", "M30", machine=replace(machine, inputs=inputs))
    assert checks(report) == [("no-input", "error", 3)]
    assert "never end" in report.errors[0].message


def test_the_worked_examples_have_no_error_by_a_check() -> None:
    if not FOLDER.exists():
        pytest.skip(f"the worked examples are not here: {FOLDER}")
    for path in sorted(FOLDER.glob("*.nc")):
        report = proved(*path.read_text("utf-8").splitlines())
        assert [d.format_one_line(path.name) for d in report.errors if d.check_name] == []


def test_json_report_has_check_block_and_count(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.nc"
    path.write_text("\n".join((*HEAD, "T1", "X.5Z.1", "M13", "G95F.004Z-.2", "M12", "M30", "")))
    offsets = tmp_path / "o.toml"
    offsets.write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
    assert main(["prove", str(path), "--json", "--offsets", str(offsets)]) == 1
    (found,) = json.loads(capsys.readouterr().out)["diagnostics"]
    assert (found["check"], found["n"], found["line"], found["count"]) == ("collet-open", 5, 6, 1)
