"""The sections of the page of measured parts, and the one that is open; made when it is first opened."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.desk.background_work import Latest
from app.special.special_functions import SpecialFunction, SpecialFunctions

Make = Callable[[], Sequence[SpecialFunction]]


class QualityFunctions(SpecialFunctions):
    """As the special functions are; what a gauge sends counts while the section of readings is shown."""

    __slots__ = ("_made", "_make")

    def __init__(self, make: Make, worker: Latest) -> None:
        self._make = make
        self._made: Sequence[SpecialFunction] = ()
        super().__init__((), worker)

    @property
    def functions(self) -> Sequence[SpecialFunction]:
        """The sections; the start of the desk does not wait for them."""
        if not self._made:
            self._made = tuple(self._make())
        return self._made

    @functions.setter
    def functions(self, _none: Sequence[SpecialFunction]) -> None:
        """They are made here and nowhere else."""

    def look(self) -> None:
        """Once a frame: of which feature and part a reading is must be seen when it comes."""
        for section in self.functions:
            section.listen(seen=section is self.current)

    def opened(self) -> None:
        """The page comes up: what a gauge has sent meanwhile is of nobody knows which part."""
        super().opened()
        for section in self.functions:
            section.listen(seen=False)

    def close(self) -> None:
        """End what a section has under way; the worker is the book's."""
        for function in self._made:
            function.close()
