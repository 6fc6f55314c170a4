"""What is the same for all programs that are proved together: machine, setup, part and what is wanted.

Without --machine each program is proved on a machine that can run it: Klartext on a shipped mill.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import Setup
    from core.language.source import Source
    from core.machine.machine_model import Machine
    from core.proving.program_tools import PartSetting


@dataclass(frozen=True)
class OtherOffsets:
    """Offsets to compare with: the name of their file, and the setup with them."""

    name: str
    setup: Setup


@dataclass(frozen=True)
class ProofJob:
    """What is the same for all programs that are proved together."""

    machine: Machine
    setup: Setup
    setting: PartSetting
    ideal: bool = False
    optional_stop: bool = False
    reported: bool = False  # a section of a report is wanted too
    other: OtherOffsets | None = None

    @cached_property
    def packed(self) -> bytes:
        """The job as it is sent."""
        import pickle

        return pickle.dumps(self)


@dataclass(slots=True)
class FittingJobs:
    """The job of all programs, and one for each shipped machine that some of them need; ``make`` makes it."""

    args: argparse.Namespace
    make: Callable[[argparse.Namespace], ProofJob]
    _made: dict[str, ProofJob] = field(default_factory=dict)  # by machine; empty: the one of the options

    def machine_of(self, source: Source) -> str:
        """The name of the shipped machine that is taken for this program; empty: the one of the options."""
        if self.args.machine is not None:
            return ""
        from app.compose.machine.fitting_machine import fitting_machine

        return fitting_machine(source)

    def of(self, machine: str) -> ProofJob:
        """The job on this machine. Raises CommandError."""
        if machine not in self._made:
            args = self.args
            if machine:
                args = argparse.Namespace(**{**vars(args), "machine": machine})
            self._made[machine] = self.make(args)
        return self._made[machine]


def on_machine(what: str, machine: str) -> str:
    """The line that says on which machine something is proved."""
    return f"turndesk: {what} is proved on the shipped {machine}; --machine chooses another one\n"
