"""T, D, G10, G92: which machine point the program's numbers mean. Machine figures worked out by hand."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import Preset, ToolChange, WorkShift
from core.interpreter.shared.job_setup import ToolOffset
from tests.interpreter.programs import INCH, Pass, body, passed, setup

TOOLS = {1: ToolOffset(0.5 * INCH, -2 * INCH), 2: ToolOffset(-0.25 * INCH, 1 * INCH)}


def machine(result: Pass) -> list[tuple[float, float]]:
    """Machine (x, z) at the end of each move, inches."""
    return [(round(b.mx / INCH, 5), round(b.mz / INCH, 5)) for b in result.moves]


@pytest.mark.parametrize(
    ("program", "points"),
    [
        (("X1Z1",), [(1, 1)]),
        (("T1", "X1Z1"), [(1.5, -1)]),
        (("T1", "X1Z1", "T2", "X1Z1"), [(1.5, -1), (0.75, 2)]),
        (("G72T1", "X1Z1"), [(1, -1)]),
        (("T1X1Z1",), [(1.5, -1)]),
        (("T1", "X1Z1", "T0", "X1"), [(1.5, -1), (1, -1)]),
        (("G10X.1Z3", "X1Z1", "T1", "X1Z1"), [(1, 1), (1.6, 2)]),
        (("G10Z3", "G10Z-1", "T1", "X1Z1"), [(1.5, 1)]),
        (("G10Z3", "T1", "X1Z1", "T2", "X1Z1"), [(1.5, 2), (0.75, 5)]),
        (("G72", "G10X.2Z0", "T1", "X1Z1"), [(1.1, -1)]),
        (("G10Z3", "T1", "T0", "T1", "X1Z1"), [(1.5, -1)]),
        (("X1Z1", "G92X0Z0", "X.5Z.25"), [(1, 1), (1.5, 1.25)]),
        (("X1Z1", "G92Z5", "Z4"), [(1, 1), (1, 0)]),
        (("X1Z1", "G72G92X1", "X0"), [(1, 1), (0.5, 1)]),
        (("T1", "X1Z1", "G92X0Z0", "Z1", "T1", "X1Z1"), [(1.5, -1), (1.5, 0), (1.5, -1)]),
        (("T1", "G92X0Z1", "Z.1"), [(0, -0.9)]),
        (("G91X1Z1", "T1", "X1Z1"), [(1, 1), (2, 2)]),
    ],
)
def test_machine_positions_with_offsets(program: tuple[str, ...], points: list[tuple[float, float]]) -> None:
    result = passed(body(*program), setup(tools=TOOLS))
    assert result.errors == []
    assert machine(result) == points


@pytest.mark.parametrize(
    ("program", "ends"),
    [
        (("X.125Z0", "Z-.75D4", "X.2D0"), [(0.125, 0), (0.1245, -0.75), (0.2, -0.75)]),
        (("X1Z1", "D3", "Z0", "X2", "D0", "X2"), [(1, 1), (1.1, 0.2), (2.1, 0.2), (2, 0)]),
        (("X1Z1D3", "X1Z1D4"), [(1.1, 1.2), (0.9995, 1)]),
        (("X1Z1", "G91", "X.5D3", "X.5", "X.5D0"), [(1, 1), (1.6, 1.2), (2.1, 1.2), (2.5, 1)]),
        (("X1Z1D3", "T1", "X1Z1"), [(1.1, 1.2), (1, 1)]),
        (("T1D3", "X1Z1"), [(1.1, 1.2)]),
        (("X1Z1D3", "G92X1Z1", "X1Z1"), [(1.1, 1.2), (1.1, 1.2)]),
        (("X1Z1D32",), [(1, 1)]),
    ],
)
def test_program_positions_with_secondary_offsets(
    program: tuple[str, ...], ends: list[tuple[float, float]]
) -> None:
    given = setup(tools=TOOLS, secondary={4: (-0.0005, 0), 3: (0.1, 0.2)})
    result = passed(body(*program), given)
    assert result.errors == []
    assert result.ends == ends


def test_machine_does_not_move_when_offsets_change() -> None:
    result = passed(body("X1Z1", "G10Z3", "T1", "G92X7Z8", "T2"), setup(tools=TOOLS))
    after = [(block.mx, block.mz) for block in result.blocks[1:]]
    assert after == [pytest.approx((INCH, INCH))] * len(after)
    changes = [block for block in result.blocks if isinstance(block.action, ToolChange | Preset)]
    assert [(b.x0, b.z0) == (b.x, b.z) for b in changes] == [True] * 3


def test_actions_describe_tool_preset_and_shift() -> None:
    result = passed(body("T1D2", "G92X1Z2", "G72G10X.5Z-1", "T0"), setup(tools=TOOLS))
    tool, preset, shift, none = result.actions[1:5]
    assert tool == ToolChange(1)
    assert preset == Preset(INCH, 2 * INCH)
    assert shift == WorkShift(0.25 * INCH, -INCH)
    assert none == ToolChange(0)
    assert result.blocks[1].modal.secondary == 2


def test_a_new_tool_clears_preset_and_secondary_offset() -> None:
    result = passed(body("G92X1Z1", "X2Z2D3", "T2"), setup(tools=TOOLS))
    modal = result.blocks[-2].modal
    assert (modal.tool, modal.preset_x, modal.preset_z) == (2, 0, 0)
    assert (modal.secondary, modal.secondary_offset_x, modal.secondary_offset_z, modal.compensation_code) == (
        0,
        0,
        0,
        40,
    )


@pytest.mark.parametrize("end", ["M30", "M02"])
def test_program_end_clears_work_shift(end: str) -> None:
    result = passed(f"G90F300\nG10Z3\nT1\nX1Z1\nG10Z1\n{end}\n", setup(tools=TOOLS))
    final = result.interpreter.modal_state
    assert (final.shift_z, final.pending_shift_z, final.tool) == (0, 0, 1)
    assert result.blocks[-1].mz == pytest.approx(2 * INCH)


@pytest.mark.parametrize(
    ("program", "warnings"),
    [
        (("G10Z1",), [(3, 0, "shift-without-tool")]),
        (("G10Z1", "T1"), []),
        (("T1", "X1Z1", "G10Z1"), [(5, 0, "shift-without-tool")]),
        (("G10Z1", "T0"), [(3, 0, "shift-without-tool")]),
        (("LS3", "T1", "X1Z1", "G10Z-.5", "LF"), []),  # every pass but the last is followed by a T
        (("G96S300", "T1"), [(4, 1, "tool-under-css")]),
        (("G96S300", "G97S500", "T1"), []),
        (("T7",), [(3, 1, "tool-offset-missing")]),
        (("T7", "X1Z1", "T7"), [(3, 1, "tool-offset-missing")]),
    ],
)
def test_questionable_offsets_cause_warnings(
    program: tuple[str, ...], warnings: list[tuple[int, int, str]]
) -> None:
    assert passed(body(*program), setup(tools=TOOLS)).warnings == warnings


def test_interpreter_lists_used_tools_and_missing_offsets() -> None:
    interpreter = passed(body("T2", "X0Z0", "T7", "X0Z0", "T2", "T9", "T0"), setup(tools=TOOLS)).interpreter
    assert interpreter.used_tools == [2, 7, 9]
    assert interpreter.tools_without_offset == [7, 9]


def test_missing_tool_offset_counts_as_zero() -> None:
    result = passed(body("T7", "X1Z1"), setup(tools=TOOLS))
    assert machine(result) == [(1, 1)]
    assert not result.interpreter.has_errors
