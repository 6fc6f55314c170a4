"""R parameters, the variables of DEF and PROC, and readable system variables."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product

from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter, indices_of
from core.language.sinumerik.block_reader import Values
from core.language.sinumerik.sinumerik_alarms import FIRST_INDEX, NOT_DEFINED, OTHER_INDEX
from core.language.sinumerik.sinumerik_words import MOST_R
from core.message import Message
from core.tool_edges import NAMED_TOOLS, tool_of

UNSET = "r-unset"
LARGEST_ARRAY = 10_000
MOST_DIMENSIONS = 3

Refuse = Callable[[int | str, str, str], ProgramError]
"""Makes the error to raise of its code, text and hint."""


@dataclass(slots=True)
class Scope:
    """Variables of one program: numbers by name, array elements as ``NAME[2,0]``, and strings."""

    numbers: dict[str, float] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    sizes: dict[str, tuple[int, ...]] = field(default_factory=dict)

    def define(self, name: str, value: float, sizes: tuple[int, ...]) -> None:
        """Define a number, or with ``sizes`` an array whose elements all have this value."""
        if not sizes:
            self.numbers[name] = value
            return
        self.sizes[name] = sizes
        self.numbers.update(dict.fromkeys(self.elements(name), value))

    def elements(self, name: str) -> list[str]:
        """Return the names of an array's elements in fill order; the last index changes first."""
        places = product(*(range(size) for size in self.sizes[name]))
        return [f"{name}[{','.join(map(str, each))}]" for each in places]


class Variables:
    """All variables that a line can read."""

    def __init__(self) -> None:
        self.r: dict[str, float] = {}
        self.scope = Scope()

    def value(self, asked: Parameter, worth: Callable[[Formula], float], refuse: Refuse) -> float:
        """Return the value of an R parameter or a variable. Raises the error of ``refuse`` if it has none."""
        if asked.letters.startswith("$"):
            text = Message(
                "{letters} is a system variable, which TurnDesk cannot read.", letters=asked.letters
            )
            raise refuse("system-variable", text, "Write the value, or an R parameter that contains it.")
        name = place_name(asked.letters, asked.number, worth, refuse)
        found = (self.r if asked.letters == "R" else self.scope.numbers).get(name)
        if found is None:
            raise refuse(*self.missing(asked.letters, name))
        return found

    def fill(self, letters: str, first: str, values: Values, worth: Callable[[Formula], float]) -> int:
        """Assign values to elements from ``first`` on; return the number of values without an element."""
        places = _r_places() if letters == "R" else self.scope.elements(letters)
        places = places[places.index(first) :]
        formulas = list(values.formulas)
        if values.repeated:
            times = len(places) if values.times is None else round(worth(values.times))
            formulas *= max(times, 0)
        for place, formula in zip(places, formulas, strict=False):
            if formula is not None:
                self.keep(place, worth(formula))
        return max(len(formulas) - len(places), 0)

    def keep(self, name: str, value: float) -> bool:
        """Set a value; return False if the variable is not defined."""
        if name[0] == "R" and name[1:].isdigit():
            self.r[f"R{int(name[1:])}"] = value
        elif name in self.scope.numbers:
            self.scope.numbers[name] = value
        else:
            return False
        return True

    def number(self, name: str) -> float:
        """Return the value of a variable, or 0 if it has none."""
        if name[0] == "R" and name[1:].isdigit():
            return self.r.get(f"R{int(name[1:])}", 0.0)
        return self.scope.numbers.get(name, 0.0)

    def missing(self, letters: str, name: str) -> tuple[int | str, str, str]:
        """Return code, text and hint of the error for a variable without a number."""
        if name in self.scope.texts:
            return (
                "text-variable",
                Message("{name} is text, not a number.", name=name),
                ("Use a variable of type REAL or INT."),
            )
        if letters in self.scope.sizes:
            sizes = self.scope.sizes[letters]
            index = name[len(letters) :].strip("[]").split(",")
            right = index[0].isdigit() and int(index[0]) < sizes[0]
            text = Message(
                "{name} is not an element of {letters}, which has {text} elements.",
                name=name,
                letters=letters,
                text=" by ".join(map(str, sizes)),
            )
            last = ",".join(str(size - 1) for size in sizes)
            hint = Message(
                "Use indices from 0; the last element is {letters}[{last}].", letters=letters, last=last
            )
            return OTHER_INDEX if right else FIRST_INDEX, text, hint
        if letters == "R":
            return (
                UNSET,
                (
                    Message(
                        "{name} has no value and is treated as 0: neither the program nor the operator has "
                        "set it.",
                        name=name,
                    )
                ),
                Message(
                    "Write {name}=… before this block, or set the value in R PARAMETERS (F10).", name=name
                ),
            )
        text = Message("the name {jump} is not defined with DEF.", jump=name)
        return NOT_DEFINED, text, Message("Write DEF REAL {word} before this block.", word=name)


def place_name(
    letters: str, number: int | Formula | None, worth: Callable[[Formula], float], refuse: Refuse
) -> str:
    """Return the name of a variable or element, such as R7, LENGTH or TABLE[2].

    Raises the error of ``refuse`` if an index is not a whole number of 0 or more.
    """
    if number is None or isinstance(number, int):
        return f"{letters}{'' if number is None else number}"
    indices = [worth(each) for each in indices_of(number)]
    for place, index in enumerate(indices):
        if abs(index - round(index)) > 1e-9 or index < 0 or (letters == "R" and place):
            code = OTHER_INDEX if place else FIRST_INDEX
            text = Message(
                "{letters}[{item}] does not exist.",
                letters=letters,
                item=",".join(f"{each:g}" for each in indices),
            )
            raise refuse(code, text, "Use a whole number of 0 or more as the index.")
    written = ",".join(str(round(each)) for each in indices)
    return f"R{written}" if letters == "R" else f"{letters}[{written}]"


def _r_places() -> list[str]:
    return [f"R{number}" for number in range(MOST_R + 1)]


def system_value(name: str, modal: Modal, edge: ToolOffset) -> float | None:
    """Return the value of a system variable; None if it is not supported or not known.

    ``edge`` is the row of T and D. $P_TOOL is D, and $P_TOOLR is the nose radius in mm, or 0 with D0. The
    radius is unknown under G70, and the tool number is unknown for a tool without a number.
    """
    if name == "$P_TOOL":
        return float(modal.edge or 0)
    if name == "$P_TOOLNO" and tool_of(modal.tool) < NAMED_TOOLS:
        return float(tool_of(modal.tool))
    if name == "$P_TOOLR" and modal.metric:
        return edge.nose_radius if modal.edge else 0.0
    return None


_POSITION = re.compile(r"\$(?:AA_IW|P_EP)\[([A-Z][0-9]?)\]")


def position_asked(name: str) -> str:
    """Return the axis whose position a system variable reads; empty for any other name."""
    match = _POSITION.fullmatch(name)
    return match[1] if match else ""
