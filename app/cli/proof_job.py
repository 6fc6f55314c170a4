"""What is the same for all programs that are proved together: machine, setup, part and what is wanted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import Setup
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
