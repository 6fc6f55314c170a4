"""A lathe with C, and programs on it: the shortest way from text to blocks, findings and times."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import InterpreterSetup, ZeroOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.proving.program_timeline import Timeline, iter_timed_blocks

MODULO = load_shipped_machine("sinumerik-modulo")
LINEAR = load_shipped_machine("sinumerik-linear")
START = (10.0, 50.0, 0.0)  # X20 Z50 C0 under DIAMON


class Passed(NamedTuple):
    """What became of a program."""

    blocks: list[Block]
    found: list[Diagnostic]

    @property
    def errors(self) -> list[Diagnostic]:
        return [each for each in self.found if each.severity is Severity.ERROR]

    @property
    def moves(self) -> list[Block]:
        return [block for block in self.blocks if block.moves]


def source(text: str, *subprograms: ProgramSource, name: str = "part.mpf") -> ProgramSource:
    """Program text with these files beside it."""
    return ProgramSource(name, text, Dialect.SINUMERIK, subprograms)


def setup(
    machine: Machine = MODULO,
    start: tuple[float, float, float] = START,
    zero: Mapping[int, ZeroOffset] | None = None,
) -> InterpreterSetup:
    """Circumstances on this machine."""
    return replace(
        create_power_up_setup(machine, tool_offsets={}, secondary_offsets={}), start=start, zero=zero or {}
    )


def run(text: str | ProgramSource, around: InterpreterSetup | None = None) -> Passed:
    """The blocks of a program and all findings."""
    program = interpret_program(text if isinstance(text, ProgramSource) else source(text), around or setup())
    blocks = list(program.generate_blocks())
    return Passed(blocks, list(program.diagnostics))


def good(text: str | ProgramSource, around: InterpreterSetup | None = None) -> list[Block]:
    """The moving blocks of a program without findings."""
    passed = run(text, around)
    assert passed.found == []
    return passed.moves


def refused(text: str | ProgramSource, around: InterpreterSetup | None = None) -> Diagnostic:
    """The one error of a program."""
    (error,) = run(text, around).errors
    return error


def times(
    text: str, machine: Machine = MODULO, around: InterpreterSetup | None = None
) -> list[tuple[Block, float]]:
    """Every block with the seconds that it takes by feeds and limits alone."""
    timeline = Timeline.from_program(source(text), around or setup(machine), machine, is_ideal=True)
    found = [(block, t1 - t0) for block, t0, t1 in iter_timed_blocks(timeline)]
    assert not timeline.has_errors, timeline.diagnostics
    return found
