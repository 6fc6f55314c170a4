"""The sections of the page of measured parts, and the one that is open."""

from __future__ import annotations

from app.quality.readings_section import ReadingsSection
from app.special.special_functions import SpecialFunctions


class QualityFunctions(SpecialFunctions):
    """As the special functions are; what a gauge sends counts while the section of readings is shown."""

    __slots__ = ()

    def look(self) -> None:
        """Once a frame: of which feature and part a reading is must be seen when it comes."""
        for function in self.functions:
            if isinstance(function, ReadingsSection):
                function.look(seen=function is self.shown)

    def opened(self) -> None:
        """The page comes up: what a gauge has sent meanwhile is of nobody knows which part."""
        super().opened()
        for function in self.functions:
            if isinstance(function, ReadingsSection):
                function.look(seen=False)

    def close(self) -> None:
        """End what a section has under way; the worker is the book's."""
        for function in self.functions:
            function.close()
