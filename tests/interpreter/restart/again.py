"""A program run whole and run from one of its lines: what comes from that line on, block by block."""

from __future__ import annotations

from dataclasses import replace

from core.interpreter.dialects import interpret_program
from core.interpreter.restart.restart_approach import (
    CurrentMachineState,
    OperatorChoices,
    make_lathe_pass_start,
)
from core.interpreter.restart.restart_point import RestartPoint, RestartRejection
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.shared.checkpoint import PassStart
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Severity
from core.language.source import ProgramSource

STANDS = (33.0, 44.0)  # where the slides are when the restart is asked for, mm
TURNED = 500.0  # degrees from where C has to be


def all_of(source: ProgramSource, setup: InterpreterSetup) -> list[Block]:
    """The elementary blocks of a pass that has no errors."""
    taken = interpret_program(source, setup)
    blocks = list(taken.generate_blocks())
    errors = [each for each in taken.diagnostics if each.severity is Severity.ERROR]
    assert not errors, errors
    return blocks


def begun(setup: InterpreterSetup, found: RestartPoint) -> InterpreterSetup:
    """The circumstances of a restart from where the slides stand.

    A spindle that is no axis has been turned by hand to the same angle: M19 would turn it from there.
    """
    point = found.checkpoint
    angle = point.c + point.modal.offset_c + (TURNED if point.modal.c_locked else 0.0)
    at = (*STANDS, angle)
    return replace(setup, start=at, begin=beginning(found, at))


def beginning(found: RestartPoint, at: tuple[float, ...]) -> PassStart:
    """A restart at a machine that stands still with its collet as it was."""
    return make_lathe_pass_start(found, CurrentMachineState(at, ModalState()), OperatorChoices())


def of_each_line(
    source: ProgramSource, setup: InterpreterSetup, passes: int = 0
) -> list[RestartPoint | RestartRejection]:
    """What SEARCHTO says of every line, in order; of one in a loop or a subroutine, of all its passes.

    ``passes``: of so many first ones and of the last.
    """
    rebuild = OmniturnRestartSearch(source, setup, lambda _count: None)
    said: list[RestartPoint | RestartRejection] = []
    for line in range(1, len(source.lines) + 1):
        answer = rebuild.find_restart_point(line, 1)
        said.append(answer)
        count = answer.visit.visit_count if isinstance(answer, RestartPoint) else 1
        later = [n for n in range(2, count + 1) if not passes or n <= passes or n == count]
        said += [rebuild.find_restart_point(line, number) for number in later]
    return said


def told(block: Block) -> dict[str, object]:
    """Everything about a block that decides what the machine does and shows; whole turns of C apart."""
    names = [name for name in Block.__slots__ if name != "modal"]
    everything = {name: getattr(block, name) for name in names}
    everything["modal"] = block.modal._replace(offset_c=0.0)
    everything["machine c"] = round(block.mc % 360.0, 6) % 360.0
    everything["plane"] = repr(block.plane)
    return everything
