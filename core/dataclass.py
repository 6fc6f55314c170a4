"""``dataclass`` as Python's own, made in a tenth of the time.

Python before 3.13 compiles up to six texts for every dataclass, half a millisecond; a short proof makes a
hundred of them, the desk five hundred. Here all classes share what compares, hashes, shows and refuses, and
only ``__init__`` is compiled, when the first object is made. Whoever reads a class reads one of Python's:
``fields``, ``replace`` and ``match`` know it, and mypy checks it as such.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, NoReturn

__all__ = ["dataclass"]

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(*, frozen: bool = False, slots: bool = False, eq: bool = True) -> Callable[[type], type]:
        """Makes a class a dataclass: what it takes, and what comes of it, as ``dataclasses.dataclass``."""

        def made(cls: type) -> type:
            own = frozenset(vars(cls))
            cls.__doc__ = cls.__doc__ or cls.__name__  # Python's own would work out a signature for it
            cls = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots)(cls)
            for name, method in _methods(cls, frozen=frozen, eq=eq):
                if name not in own:
                    setattr(cls, name, method)
            if eq and (cls.__hash__ is None or "__hash__" not in own):
                cls.__hash__ = _hash_of(cls) if frozen else None
            return cls

        return made


def _methods(cls: type, *, frozen: bool, eq: bool) -> Iterator[tuple[str, Callable[..., Any]]]:
    """What a class gets that has not its own."""
    yield "__init__", _init_of_first_object(cls, frozen=frozen)
    yield "__repr__", _shown
    if eq:
        yield "__eq__", _equality_of(cls)
    if frozen:
        yield "__setattr__", _refuse_assignment
        yield "__delattr__", _refuse_deletion
        yield "__getstate__", _state
        yield "__setstate__", _set_state


def _init_of_first_object(cls: type, *, frozen: bool) -> Callable[..., None]:
    """The first object's ``__init__``: it puts the compiled one in its place."""

    def init(self: object, *values: object, **named: object) -> None:
        compiled = _compiled_init(cls, frozen=frozen)
        type.__setattr__(cls, "__init__", compiled)
        compiled(self, *values, **named)

    return init


def _compiled_init(cls: type, *, frozen: bool) -> Callable[..., None]:
    every = fields(cls)
    taken = [each for each in every if each.init]
    by_name = [_parameter(each) for each in taken if each.kw_only]
    head = ["self", *(_parameter(each) for each in taken if not each.kw_only)]
    head += ["*", *by_name] if by_name else []
    body = [_assignment(each, frozen=frozen) for each in every if each.init or _has_default(each)]
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    names: dict[str, Any] = {"FACTORY": MISSING, "set_attribute": object.__setattr__}
    names |= {f"default_{each.name}": each.default for each in every}
    names |= {f"make_{each.name}": each.default_factory for each in every}
    exec(f"def __init__({', '.join(head)}):\n " + "\n ".join(body or ["pass"]), names)
    init: Callable[..., None] = names["__init__"]
    init.__qualname__ = f"{cls.__qualname__}.__init__"
    return init


def _has_default(each: Field[Any]) -> bool:
    return each.default is not MISSING or each.default_factory is not MISSING


def _parameter(each: Field[Any]) -> str:
    if each.default_factory is not MISSING:
        return f"{each.name}=FACTORY"
    return each.name if each.default is MISSING else f"{each.name}=default_{each.name}"


def _assignment(each: Field[Any], *, frozen: bool) -> str:
    """One line of ``__init__``; what a factory makes is made anew for each object."""
    value = each.name if each.init else f"default_{each.name}"
    if each.default_factory is not MISSING:
        anew = f"make_{each.name}()"
        value = f"{anew} if {each.name} is FACTORY else {each.name}" if each.init else anew
    return f"set_attribute(self, {each.name!r}, {value})" if frozen else f"self.{each.name} = {value}"


def _compared(cls: type) -> Callable[[Any], tuple[Any, ...]]:
    """All that counts for equality, as a tuple: what is the same object in two tuples is equal, also nan."""
    names = [each.name for each in fields(cls) if each.compare]
    if len(names) > 1:
        return attrgetter(*names)
    return lambda this: tuple(getattr(this, name) for name in names)


def _equality_of(cls: type) -> Callable[[object, object], bool]:
    compared = _compared(cls)

    def equal(self: object, other: object) -> bool:
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    return equal


def _hash_of(cls: type) -> Callable[[object], int]:
    compared = _compared(cls)
    return lambda self: hash(compared(self))


@recursive_repr("...")
def _shown(self: Any) -> str:
    shown = ", ".join(f"{each.name}={getattr(self, each.name)!r}" for each in fields(self) if each.repr)
    return f"{self.__class__.__qualname__}({shown})"


def _refuse_assignment(_self: object, name: str, _value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_deletion(_self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    """What pickle keeps of an object that refuses assignment."""
    return [getattr(self, each.name) for each in fields(self)]


def _set_state(self: Any, state: list[Any]) -> None:
    for each, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, each.name, value)
