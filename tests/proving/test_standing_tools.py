"""Cuts while nothing turns: an error where tool and stock are stated, and one message instead of two."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.part.stock import make_bar_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_proof import prove_program_and_part, require_tool_offsets

ROD = make_bar_stock(19.05, 0.0, -60.0)
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")
BORER = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.4, insert="DCMT070204", diameter=5.0, stick_out=40.0)
DRILL = ToolShape(ToolKind.DRILL, diameter=6.0, point=118.0, length=40.0)
LIVE = ToolShape(ToolKind.DRILL, tip=8, diameter=3.0, point=118.0, length=40.0)
SHAPES = {1: TURNING, 2: BORER, 3: DRILL, 7: LIVE}
HEAD = "G90G94F300G73\nM03S900\n"


def found(
    program: str, shapes: dict[int, ToolShape] | None = None, machine: Machine | None = None
) -> list[tuple[int, str, str]]:
    """Return line, severity and code of the findings of a program in the bar of 3/4 in."""
    machine = machine or load_machine(None)
    tools = {n: ToolOffset(-12.7, -50.8) for n in SHAPES}
    shapes = SHAPES if shapes is None else shapes
    setting = replace(make_part_settings(machine, {}, shapes), stock=ROD)
    setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={})
    report, _ = prove_program_and_part(ProgramSource("P", f"{HEAD}{program}\nM30\n"), setup, machine, setting)
    return [(each.line, str(each.severity), each.code) for each in report.diagnostics]


CROSS = "T7\nX.6Z.1\nM05\nM19\nG04F1\n{on}Z-.4\nF3X.2\nF300X.6\nZ1\nM16"
TURNED = "T1\nX.5Z.1\nX.32\nG95F.004Z-.3\nX.5\nG94F300Z.1\n{stop}X.28\nF4Z-.2\nF300X.5"
HOLE = "T{t}\nX{x}Z.1\n{stop}F4Z-.3\nF300Z1"


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        # a live drill that nobody has switched on, switched off again, and one that runs
        (CROSS.format(on=""), [(9, "error", "cut-standing")]),
        (CROSS.format(on="M15\nM16\n"), [(11, "error", "cut-standing")]),
        (CROSS.format(on="M15\n"), []),
        # turned to r .32, and then to .28 with the spindle stopped
        (TURNED.format(stop="M05\n"), [(11, "error", "cut-standing")]),
        (TURNED.format(stop=""), []),
        # a drill on the axis
        (HOLE.format(t=3, x="0", stop="M05\n"), [(6, "error", "cut-standing")]),
        (HOLE.format(t=3, x="0", stop=""), []),
        (HOLE.format(t=3, x="0", stop="M05\nM15\n"), []),
    ],
)  # fmt: skip
def test_cut_with_stationary_spindle_gives_expected_findings(
    program: str, expected: list[tuple[int, str, str]]
) -> None:
    assert found(program) == expected


def test_assumed_tool_gives_spindle_off_warning_without_error() -> None:
    told = found(TURNED.format(stop="M05\n"), {})
    assert (11, "warning", "spindle-off") in told
    assert all(severity != "error" for _, severity, _ in told)


def test_possible_broach_gives_spindle_off_warning() -> None:
    told = found(HOLE.format(t=2, x=".3", stop="M05\n"))
    assert ("warning", "spindle-off") in {(severity, code) for _, severity, code in told}
    assert "cut-standing" not in {code for *_, code in told}


def test_live_tool_without_m_code_gives_no_stationary_cut_finding() -> None:
    machine = load_machine(None)
    without = replace(machine, m_code_outputs={25: ("catcher", True), 26: ("catcher", False)})
    program = CROSS.format(on="").replace("M16", "")
    assert "cut-standing" not in {code for *_, code in found(program, machine=without)}


@pytest.mark.parametrize(("known", "severity"), [((1,), "error"), ((), "warning")])
def test_missing_tool_offset_is_error_only_if_other_tools_have_offsets(
    known: tuple[int, ...], severity: str
) -> None:
    """T3 has none while T1 has one; or no offset has been entered at all, as in an office."""
    machine = load_machine(None)
    setup = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset(-12.7, -50.8) for n in known}, secondary_offsets={}
    )
    program = ProgramSource("P", f"{HEAD}{HOLE.format(t=3, x='0', stop='')}\nM30\n")
    report, _ = prove_program_and_part(program, setup, machine, make_part_settings(machine, {}, SHAPES))
    report = require_tool_offsets(report, setup)
    (told,) = [each for each in report.diagnostics if each.code == "tool-offset-missing"]
    assert str(told.severity) == severity
