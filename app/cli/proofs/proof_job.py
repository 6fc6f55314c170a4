"""Data common to programs that are proved together: the machine, setup, part and options.

Without --machine, each program is proved on a machine that can run it, such as a shipped mill for Klartext.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import InterpreterSetup
    from core.language.source import ProgramSource
    from core.machine.machine_model import Machine
    from core.proving.program_tools import PartSettings


@dataclass(frozen=True)
class ComparisonOffsets:
    """Name of the offsets file of --compare, and the setup that uses its offsets."""

    offsets_file_name: str
    setup: InterpreterSetup


@dataclass(frozen=True)
class ProofJob:
    """Common data of programs that are proved together: machine, setup, part and options."""

    machine: Machine
    setup: InterpreterSetup
    part_settings: PartSettings
    uses_ideal_times: bool = False
    is_optional_stop_on: bool = False
    needs_report_section: bool = False  # whether a section for a report is required
    comparison_offsets: ComparisonOffsets | None = None

    @cached_property
    def pickled_job(self) -> bytes:
        """Return the job as bytes, pickled for a worker."""
        import pickle

        return pickle.dumps(self)


@dataclass(slots=True)
class ProofJobsByMachine:
    """Proof jobs by machine, created on first use by calling ``create_job``.

    There is one job for the machine that the options specify, and one for each shipped machine that a
    program needs.
    """

    arguments: argparse.Namespace
    create_job: Callable[[argparse.Namespace], ProofJob]
    # by machine; the empty name means the machine of the options
    _made: dict[str, ProofJob] = field(default_factory=dict)

    def select_machine_name(self, source: ProgramSource) -> str:
        """Return the name of the shipped machine for this program.

        An empty string means the machine that the options specify.
        """
        if self.arguments.machine is not None:
            return ""
        from app.compose.machine.machine_selection import select_mill_for_program

        return select_mill_for_program(source)

    def get_job(self, machine: str) -> ProofJob:
        """Return the proof job for a machine name.

        Raises CommandError if the machine or an option is invalid.
        """
        if machine not in self._made:
            args = self.arguments
            if machine:
                args = argparse.Namespace(**{**vars(args), "machine": machine})
            self._made[machine] = self.create_job(args)
        return self._made[machine]


def describe_machine_choice(program_name: str, machine: str) -> str:
    """Return a message that names the shipped machine on which a program is proved."""
    return f"turndesk: {program_name} is proved on the shipped {machine}; --machine chooses another one\n"
