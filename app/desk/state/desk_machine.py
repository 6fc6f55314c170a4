"""The machine as the screen presents it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.machine.machine_model import Machine


@dataclass(frozen=True, slots=True)
class DeskMachine:
    """Name, axes and start buttons of the machine.

    ``model`` is the machine as its machine file describes it, or None without a file. ``one_hand`` is True if
    no real axis or spindle moves, so that the palm buttons may be pressed one after the other.
    """

    name: str = ""
    model: Machine | None = None
    two_hand: bool = True
    with_c: bool = True
    one_hand: bool = False

    @property
    def language(self) -> str:
        """The programming language of the machine, which MDI also uses."""
        return self.model.language if self.model is not None else "omniturn"

    @property
    def third_axis(self) -> str:
        """The name of the third axis."""
        return self.model.third_axis if self.model is not None else "C"

    @property
    def table_turns(self) -> bool:
        """Whether the rotary axes turn the table and not the head."""
        return self.model is None or self.model.table_turns
