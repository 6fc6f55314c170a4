"""Machine data that the screen shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.machine.machine_model import Machine


@dataclass(frozen=True, slots=True)
class DeskMachine:
    """Machine data for the screen: name, axes and start buttons.

    ``machine`` is the machine as its machine file describes it, or None without a file.
    ``allows_one_hand_start`` is True if no real axis or spindle moves, so that the palm buttons may be
    pressed one after the other.
    """

    name: str = ""
    machine: Machine | None = None
    has_two_hand_start: bool = True
    has_c_axis: bool = True
    allows_one_hand_start: bool = False

    @property
    def program_language(self) -> str:
        """Return the program language of the machine, which MDI also uses."""
        return self.machine.mdi_language if self.machine is not None else "omniturn"

    @property
    def third_axis_name(self) -> str:
        """Return the name of the third axis."""
        return self.machine.third_axis_name if self.machine is not None else "C"

    @property
    def is_table_rotary(self) -> bool:
        """Return whether the rotary axes move the table instead of the head."""
        return self.machine is None or self.machine.has_rotary_table
