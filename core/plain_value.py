"""Base class of small immutable values that are quick to define at startup.

TurnDesk loads dozens of these classes when it starts. For each frozen dataclass, Python compiles six
functions, which takes 0.3 ms. A class with an explicit ``__init__`` needs almost no time. Its attributes
are ``Final``, so mypy rejects assignments to them.
"""

from __future__ import annotations


class ValueObject:
    """A value that equals another value of the same class if all attributes in ``__slots__`` are equal."""

    __slots__: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in self.__slots__)

    def __hash__(self) -> int:
        return hash((self.__class__, *(getattr(self, name) for name in self.__slots__)))

    def __repr__(self) -> str:
        words = (f"{name}={getattr(self, name)!r}" for name in self.__slots__)
        return f"{self.__class__.__name__}({', '.join(words)})"
