"""The machine as the screen presents it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.machine.machine_model import Machine


@dataclass(frozen=True, slots=True)
class DeskMachine:
    """Name, axes and start buttons of the machine.

    ``model`` is the machine as its file describes it, None without a file. ``one_hand``: no real axis or
    spindle moves, so the palm buttons may be pressed one after the other.
    """

    name: str = ""
    model: Machine | None = None
    two_hand: bool = True
    with_c: bool = True
    one_hand: bool = False

    @property
    def language(self) -> str:
        """The machine's own programming language, in which MDI is typed."""
        return self.model.language if self.model is not None else "omniturn"

    @property
    def third_axis(self) -> str:
        """The name of the third axis."""
        return self.model.third_axis if self.model is not None else "C"

    @property
    def table_turns(self) -> bool:
        """Whether the rotary axes turn the table."""
        return self.model is None or self.model.table_turns
