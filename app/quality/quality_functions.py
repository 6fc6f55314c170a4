"""The sections of the page of measured parts, and the one that is open."""

from __future__ import annotations

from dataclasses import dataclass

from app.quality.readings_section import ReadingsSection
from app.special.special_functions import SpecialFunctions


@dataclass(slots=True)
class QualityFunctions(SpecialFunctions):
    """As the special functions are; what a gauge sends is taken up while the page is shown."""

    def look(self) -> None:
        """Once a frame: a gauge speaks to the section of readings, whichever is open."""
        for function in self.functions:
            if isinstance(function, ReadingsSection):
                function.look()

    def close(self) -> None:
        """End what a section has under way; the worker is the book's."""
        for function in self.functions:
            function.close()
