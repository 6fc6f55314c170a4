"""Variables: R parameters of all programs; numbers, arrays and texts that DEF and PROC name in one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.sinumerik_alarms import NOT_DEFINED

LARGEST_ARRAY = 10_000

Refuse = Callable[[int | str, str, str], ProgramError]
"""Makes the error to raise of its code, text and hint."""


@dataclass(slots=True)
class Scope:
    """What DEF and PROC have named in one program: numbers by name, elements as ``NAME[2]``, texts."""

    numbers: dict[str, float] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)

    def define(self, name: str, value: float, size: int | None) -> None:
        """A number, or an array of ``size`` elements that all have this value."""
        if size is None:
            self.numbers[name] = value
            return
        self.sizes[name] = size
        self.numbers.update((f"{name}[{i}]", value) for i in range(size))


class Variables:
    """All variables that a line can see."""

    def __init__(self) -> None:
        self.r: dict[int, float] = {}
        self.scope = Scope()

    def value(self, asked: Parameter, worth: Callable[[Formula], float], refuse: Refuse) -> float:
        """What an R parameter or a variable holds. Raises what ``refuse`` makes where it holds nothing."""
        if asked.letters.startswith("$"):
            text = f"{asked.letters} is a system variable, which is not read here."
            raise refuse("system-variable", text, "Write the value, or an R parameter that has it.")
        name = place_name(asked.letters, asked.number, worth, refuse)
        if asked.letters == "R" and name[1:].isdigit():
            found = self.r.get(int(name[1:]))
        else:
            found = self.scope.numbers.get(name)
        if found is None:
            raise refuse(*self._missing(asked, name))
        return found

    def keep(self, name: str, value: float) -> bool:
        """This place holds a value from now on; False where no DEF has named it."""
        if name[0] == "R" and name[1:].isdigit():
            self.r[int(name[1:])] = value
        elif name in self.scope.numbers:
            self.scope.numbers[name] = value
        else:
            return False
        return True

    def _missing(self, asked: Parameter, name: str) -> tuple[int | str, str, str]:
        if name in self.scope.texts:
            return "text-variable", f"{name} is a text, and no number.", "Use a variable of REAL or INT."
        if asked.letters in self.scope.sizes:
            size = self.scope.sizes[asked.letters]
            text = f"{name} is no element of {asked.letters}, which has {size}."
            return "array-index", text, f"Elements are {asked.letters}[0] to {asked.letters}[{size - 1}]."
        if asked.letters == "R":
            return (
                "r-unset",
                f"{name} has no value: the program has not set it.",
                f"Write {name}=… before it.",
            )
        text = f"the name {name} is not defined: no DEF has named it."
        return NOT_DEFINED, text, f"Write DEF REAL {name} before it."


def place_name(
    letters: str, number: int | Formula | None, worth: Callable[[Formula], float], refuse: Refuse
) -> str:
    """The name of a place: R7, LENGTH, TABLE[2]. Raises the error for an index that is no whole number."""
    if number is None or isinstance(number, int):
        return f"{letters}{'' if number is None else number}"
    index = worth(number)
    if abs(index - round(index)) > 1e-9 or index < 0:
        raise refuse(
            "array-index", f"{letters}[{index:g}] does not exist.", "An index is a whole number from 0."
        )
    return f"R{round(index)}" if letters == "R" else f"{letters}[{round(index)}]"
