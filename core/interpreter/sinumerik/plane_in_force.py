"""What the rest of the interpreter asks of TRANSMIT or TRACYL while one of them is on."""

from __future__ import annotations

from typing import Protocol

from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.sinumerik_statement import Statement


class PlaneInForce(Protocol):
    """The plane of a transformation; see ``transformed_plane``."""

    @property
    def name(self) -> str:
        """The word that has begun it."""
        ...

    @property
    def along_z(self) -> bool:
        """Whether the depth is Z, along which drilling cycles drill."""
        ...

    @property
    def plane(self) -> int:
        """G17 or G19, in which its arcs and its compensation lie."""
        ...

    @property
    def depth(self) -> float:
        """Where the tool stands square to the plane, as the program counts: mm."""
        ...

    def down_to(self, statement: Statement, depth: float, feed: float | None, text: str) -> Block:
        """A move square to the plane to a depth as the program counts it, in mm; feed None is a rapid."""
        ...

    def over(self, statement: Statement, x: float, y: float, text: str) -> Block:
        """A rapid to a place of the plane, mm."""
        ...
