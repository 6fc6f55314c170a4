"""Trial of a program from a drawing: proof, and comparison of the part with the drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from app.compose.known_part import known_part
from app.compose.machine.machine_setup import setup_for
from core.extras.drawings.drawing_view import Profile, Side
from core.extras.drawings.part_against_drawing import Comparison, compared
from core.extras.drawings.profile_program import NoseOffset
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, Source
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock_spec import StockSpec
from core.part.tool_shape import ToolShape
from core.proving.part_proof import prove_with_part
from core.tool_edges import edge_key

_SPARE = 10.0  # mm of stock beyond the part
_HOME = ToolOffset(12.7, -76.2)


@dataclass(frozen=True, slots=True)
class TrialStock:
    """Stock of a trial in mm: bar diameter, material in front of the face, and predrilled hole."""

    diameter: float
    before_face: float = 0.0
    hole: float = 0.0


@dataclass(frozen=True, slots=True)
class Trial:
    """Result of a trial.

    ``comparison`` is None if the program makes no part, ``errors`` are from the proof.
    """

    comparison: Comparison | None
    errors: tuple[str, ...] = ()


def tried(
    text: str,
    profile: Profile,
    stock: TrialStock,
    nose: NoseOffset | None,
    machine: Machine,
    shapes: Mapping[int, ToolShape],
    watch: Callable[[float], None] | None = None,
    dialect: Dialect = Dialect.OMNITURN,
) -> Trial:
    """Prove the program with all tools at one position and the required nose offset, and compare the part."""
    of_edge = nose is not None and nose.quadrant
    secondary = {nose.number: SecondaryOffset(nose.x, nose.z, nose.r)} if nose and not of_edge else {}
    tools = dict.fromkeys(range(1, 33), _HOME)
    if nose is not None and of_edge:
        edge = replace(_HOME, nose_radius=nose.r, quadrant=nose.quadrant)
        tools |= {edge_key(n, nose.number): edge for n in tools}
    setup = setup_for(machine, tools=tools, secondary=secondary)
    setting = known_part(machine, {}, shapes)
    front = profile.front + stock.before_face
    length = front - profile.back + _SPARE
    bar = StockSpec("bar", stock.diameter, stock.hole, length, front)
    setting = replace(setting, stock=bar, clamping=None, gang={}, travel=None)
    report, part = prove_with_part(Source("drawing", text, dialect), setup, machine, setting, watch=watch)
    errors = tuple(_said(each) for each in report.diagnostics if each.severity is Severity.ERROR)
    made = None if part is None or part.last is None else part.last
    side = None if made is None else made.bore if profile.side is Side.INSIDE else made.outside
    return Trial(compared(profile, side) if side else None, errors)


def _said(found: Diagnostic) -> str:
    return Message("LINE {line}: {value} {hint}", line=found.line, value=found.text, hint=found.hint).strip()
