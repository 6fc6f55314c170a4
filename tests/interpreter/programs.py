"""Programs as text, passed through the interpreter; figures in inches as a program's reader knows them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import Program, read_program
from core.interpreter.shared.actions import Action
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, SecondaryOffset, ToolOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource

INCH = 25.4
ALL_TOOLS: Mapping[int, ToolOffset] = {number: ToolOffset() for number in range(1, 33)}
OUTPUTS = {25: ("catcher", True), 26: ("catcher", False), 15: ("live", True), 16: ("live", False)}


def inches(**values: float) -> dict[str, float]:
    """Keyword lengths in mm."""
    return {name: value * INCH for name, value in values.items()}


def setup(
    *,
    tools: Mapping[int, ToolOffset] = ALL_TOOLS,
    secondary: Mapping[int, tuple[float, ...]] | None = None,
    limits: ControlLimits | None = None,
    inputs: Callable[[str], bool] = lambda _terminal: False,
    block_delete: bool = False,
    metric: bool = False,
    last_rapid: float = 100.0,
    start: tuple[float, float] = (0.0, 0.0),
) -> InterpreterSetup:
    """Circumstances; lengths in inches, the rapid rate in in/min; ``secondary`` are X, Z and, if any, R."""
    pairs = {n: SecondaryOffset(*(v * INCH for v in each)) for n, each in (secondary or {}).items()}
    return InterpreterSetup(
        tools=tools,
        secondary=pairs,
        limits=limits or ControlLimits(m_code_outputs=OUTPUTS),
        inputs=inputs,
        block_delete=block_delete,
        metric=metric,
        last_rapid=last_rapid * INCH / 60,
        start=(start[0] * INCH, start[1] * INCH, 0.0),
    )


@dataclass(frozen=True)
class Pass:
    """What one pass through a program gave."""

    program: Program
    interpreter: Interpreter
    blocks: list[Block]

    @property
    def moves(self) -> list[Block]:
        """The blocks in which an axis moves."""
        return [block for block in self.blocks if block.moves]

    @property
    def actions(self) -> list[Action]:
        """What the other blocks do."""
        return [block.action for block in self.blocks if block.action is not None]

    @property
    def ends(self) -> list[tuple[float, float]]:
        """(x, z) at the end of each move, inches."""
        return [(round(b.x / INCH, 5), round(b.z / INCH, 5)) for b in self.moves]

    @property
    def feeds(self) -> list[tuple[str, float]]:
        """(kind, in/min or in/rev) of each move."""
        return [(str(b.kind), round(in_feed(b), 6)) for b in self.moves]

    @property
    def errors(self) -> list[tuple[int, int, str]]:
        """(line, column, code) of the errors."""
        return [place(d) for d in self.interpreter.diagnostics if d.severity is Severity.ERROR]

    @property
    def warnings(self) -> list[tuple[int, int, str]]:
        """(line, column, code) of the warnings."""
        return [place(d) for d in self.interpreter.diagnostics if d.severity is Severity.WARNING]

    @property
    def notes(self) -> list[tuple[int, int, str]]:
        """(line, column, code) of the notes."""
        return [place(d) for d in self.interpreter.diagnostics if d.severity is Severity.NOTE]


def place(found: Diagnostic) -> tuple[int, int, str]:
    """Where a finding is and what it is."""
    return found.line, found.column, found.code


def in_feed(block: Block) -> float:
    """Feed of a block as programmed in inches."""
    return block.feed / INCH * (1 if block.per_rev else 60)


def passed(text: str, given: InterpreterSetup | None = None, *, strict: bool = False) -> Pass:
    """A program gone through to its end; lines may be separated by blanks or line ends."""
    program = read_program(ProgramSource("PART", text), strict)
    interpreter = Interpreter(program, given or setup())
    return Pass(program, interpreter, list(interpreter.generate_blocks()))


def lines(*each: str) -> str:
    """Lines put together, the last with its end."""
    return "\n".join(each) + "\n"


def body(*each: str) -> str:
    """Lines between a usual head (rapid 300 in/min, spindle at 1000) and M30; the first is line 3."""
    return lines("G90G94F300", "M03S1000", *each, "M30")
