"""Klartext programs interpreted on the machine of the worked tables."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from core.geometry.rotary_axes import Kinematics
from core.interpreter.klartext.klartext_interpreter import Interpreter
from core.interpreter.klartext.klartext_program import read_program
from core.interpreter.klartext.klartext_state import State
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, ToolOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource
from tests.klartext.table import AC

HOME = (0.0, 0.0, 0.0, 0.0, 0.0)
TOOL = "TOOL CALL 1 Z S3000 F500\n"


@dataclass
class Ran:
    """What came of a program."""

    blocks: list[Block]
    diagnostics: list[Diagnostic]
    state: State
    errors: list[Diagnostic] = field(init=False)
    planes: list[Block] = field(init=False)

    def __post_init__(self) -> None:
        self.errors = [d for d in self.diagnostics if d.severity is Severity.ERROR]
        self.planes = [block for block in self.blocks if block.kind is BlockKind.PLANE]

    @property
    def codes(self) -> list[str]:
        """Codes of the errors."""
        return [error.code for error in self.errors]

    @property
    def warned(self) -> list[str]:
        """Codes of the warnings."""
        return [d.code for d in self.diagnostics if d.severity is Severity.WARNING]

    def axes(self, block: Block) -> dict[str, float]:
        """Machine positions of all axes at the end of a block, by name."""
        assert block.travel is not None
        return dict(zip(self.state.kinematics.axis_names, block.travel.end, strict=True))


def whole(text: str, unit: str = "MM") -> str:
    """A program of these blocks."""
    return f"BEGIN PGM T {unit}\n{text.strip()}\nEND PGM T {unit}\n"


def run(text: str, machine: Kinematics = AC, *, unit: str = "MM", tool: str = TOOL, **setup: Any) -> Ran:
    """Interpret the blocks, behind a TOOL CALL unless told otherwise."""
    return run_file(whole(tool + text, unit), machine, **setup)


def run_file(text: str, machine: Kinematics = AC, **setup: Any) -> Ran:
    """Interpret a whole program."""
    return run_source(ProgramSource("T.H", text), machine, **setup)


def run_source(source: ProgramSource, machine: Kinematics = AC, **setup: Any) -> Ran:
    """Interpret a program with the programs that it calls."""
    around: dict[str, Any] = {
        "start": HOME[: len(machine.axis_names)],
        "limits": ControlLimits(max_rpm=12000.0),
    }
    around |= {"tools": {1: ToolOffset()}, **setup}
    interpreter = Interpreter(read_program(source), InterpreterSetup(kinematics=machine, **around), machine)
    blocks = list(interpreter.generate_blocks())
    return Ran(blocks, interpreter.diagnostics, interpreter.state)
