"""HOLES1 and HOLES2: a row and a circle of places at each of which the cycle of MCALL drills, in TRANSMIT."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin

from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import Cycle
from core.interpreter.sinumerik.sinumerik_state import State
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message

PATTERNS = frozenset({"HOLES1", "HOLES2"})
_MOST = 1000


def no_cycle(line: Line) -> ProgramError:
    """A pattern without a cycle to drill with."""
    text = Message("{call} uses the cycle called with MCALL, but no MCALL is active.", call=line.call)
    hint = "Write MCALL CYCLE81( ) or another cycle before this block."
    return line.refuse(line.call_column, "pattern-cycle", text, hint)


def places(state: State, line: Line) -> Iterator[Block]:
    """A rapid to each place, X and Y of the face. Raises ProgramError."""
    cycle = Cycle(state, line)
    plane = state.transformation
    if plane is None or not plane.along_z:
        text = Message("{call} uses positions in X and Y, but this lathe has no Y axis.", call=line.call)
        raise cycle.refused(
            "not-in-subset", text, "Write TRANSMIT before this block, or program the positions after MCALL."
        )
    number = cycle.whole("NUM", 0, 0, _MOST)
    if not number:
        raise cycle.wrong(
            "NUM", "{name} is the number of holes and must be greater than 0", "Correct the value."
        )
    found = _row(cycle, number) if line.call == "HOLES1" else _circle(cycle, number)
    for k, (x, y) in enumerate(found, 1):
        yield plane.over(cycle.statement, x, y, f"{line.call} {k}/{number}")


def _row(cycle: Cycle, number: int) -> list[tuple[float, float]]:
    """Along STA1 from SPCA, SPCO: the first FDIS away, DBH between them."""
    x, y, angle = cycle.length("SPCA"), cycle.length("SPCO"), radians(cycle.number("STA1"))
    first, apart = cycle.length("FDIS"), cycle.size("DBH")
    if number > 1 and not apart:
        raise cycle.wrong(
            "DBH",
            "{name} is the distance between the holes and must be greater than 0",
            "Correct the value.",
        )
    ways = [first + apart * k for k in range(number)]
    return [(x + way * cos(angle), y + way * sin(angle)) for way in ways]


def _circle(cycle: Cycle, number: int) -> list[tuple[float, float]]:
    """Round CPA, CPO on RAD from STA1 on, INDA between them; without it all round."""
    x, y, radius = cycle.length("CPA"), cycle.length("CPO"), cycle.over_zero("RAD")
    first, apart = cycle.number("STA1"), cycle.number("INDA") or 360.0 / number
    angles = [radians(first + apart * k) for k in range(number)]
    return [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]
