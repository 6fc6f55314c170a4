"""R parameters, variables defined by DEF and PROC, and readable system variables."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product

from core.interpreter.shared.formula_values import convert_to_whole_number
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter, get_index_formulas
from core.language.sinumerik.block_reader import MAX_R_NUMBER, ValueList
from core.language.sinumerik.sinumerik_alarms import NAME_NOT_DEFINED, WRONG_FIRST_INDEX, WRONG_OTHER_INDEX
from core.message import Message
from core.tool_edges import FIRST_NAMED_TOOL, get_tool_number

UNSET_PARAMETER_CODE = "r-unset"
MAX_ARRAY_SIZE = 10_000
MAX_DIMENSIONS = 3

ErrorFactory = Callable[[int | str, str, str], ProgramError]
"""Function that makes the error to raise from its code, text and hint."""


@dataclass(slots=True)
class VariableScope:
    """The variables of one program: numbers by name, array elements such as ``NAME[2,0]``, and strings."""

    numbers: dict[str, float] = field(default_factory=dict)
    strings: dict[str, str] = field(default_factory=dict)
    array_dimensions: dict[str, tuple[int, ...]] = field(default_factory=dict)

    def define_variable(self, name: str, value: float, sizes: tuple[int, ...]) -> None:
        """Define a number with this value or, if ``sizes`` is given, an array filled with this value.

        An earlier definition of the name is removed.
        """
        self.remove_variable(name)
        if not sizes:
            self.numbers[name] = value
            return
        self.array_dimensions[name] = sizes
        self.numbers.update(dict.fromkeys(self.list_element_names(name), value))

    def define_string(self, name: str, text: str) -> None:
        """Define a string. An earlier definition of the name is removed."""
        self.remove_variable(name)
        self.strings[name] = text

    def remove_variable(self, name: str) -> None:
        """Remove a number, an array or a string, if the name is defined."""
        names = self.list_element_names(name) if name in self.array_dimensions else [name]
        for each in names:
            self.numbers.pop(each, None)
        self.array_dimensions.pop(name, None)
        self.strings.pop(name, None)

    def copy(self) -> VariableScope:
        """Return an independent copy of the variables."""
        return VariableScope(dict(self.numbers), dict(self.strings), dict(self.array_dimensions))

    def list_element_names(self, name: str) -> list[str]:
        """Return the names of an array's elements in the order in which they are filled.

        The last index changes first.
        """
        places = product(*(range(size) for size in self.array_dimensions[name]))
        return [f"{name}[{','.join(map(str, each))}]" for each in places]


class Variables:
    """All variables that a program line can read."""

    def __init__(self) -> None:
        self.r_parameters: dict[str, float] = {}
        self.variable_scope = VariableScope()

    def get_value(
        self, parameter: Parameter, compute_formula: Callable[[Formula], float], make_error: ErrorFactory
    ) -> float:
        """Return the value of an R parameter or a variable.

        Raises the error that ``make_error`` returns if the value is missing, if an index is invalid, or if
        the parameter is a system variable that TurnDesk cannot read.
        """
        if parameter.letters.startswith("$"):
            text = Message(
                "{letters} is a system variable, which TurnDesk cannot read.", letters=parameter.letters
            )
            raise make_error("system-variable", text, "Write the value, or an R parameter that contains it.")
        name = format_variable_name(parameter.letters, parameter.number, compute_formula, make_error)
        found = (self.r_parameters if parameter.letters == "R" else self.variable_scope.numbers).get(name)
        if found is None:
            raise make_error(*self.describe_missing_value(parameter.letters, name))
        return found

    def assign_values(
        self,
        variable_name: str,
        first_element: str,
        values: ValueList,
        compute_formula: Callable[[Formula], float],
        make_error: ErrorFactory,
    ) -> int:
        """Assign values to elements, starting at ``first_element``.

        Returns the number of surplus values. Raises the error that ``make_error`` returns if the number of
        elements of REP is not a whole number of 0 or more.
        """
        places = (
            _r_places() if variable_name == "R" else self.variable_scope.list_element_names(variable_name)
        )
        places = places[places.index(first_element) :]
        formulas, surplus = list(values.formulas), len(values.formulas) - len(places)
        if values.is_repeated:
            count = len(places)
            if values.repeat_count is not None:
                count = _check_repeat_count(compute_formula(values.repeat_count), make_error)
            formulas, surplus = formulas * min(count, len(places)), count - len(places)
        for place, formula in zip(places, formulas, strict=False):
            if formula is not None:
                self.set_value(place, compute_formula(formula))
        return max(surplus, 0)

    def set_value(self, name: str, value: float) -> bool:
        """Set the value of a variable and return True, or return False if the variable is not defined."""
        if name[0] == "R" and name[1:].isdigit():
            self.r_parameters[f"R{int(name[1:])}"] = value
        elif name in self.variable_scope.numbers:
            self.variable_scope.numbers[name] = value
        else:
            return False
        return True

    def get_number(self, name: str) -> float:
        """Return the value of a variable, or 0 if it has no value."""
        if name[0] == "R" and name[1:].isdigit():
            return self.r_parameters.get(f"R{int(name[1:])}", 0.0)
        return self.variable_scope.numbers.get(name, 0.0)

    def describe_missing_value(self, letters: str, name: str) -> tuple[int | str, str, str]:
        """Return the code, text and hint of the error for a variable that does not contain a number."""
        if name in self.variable_scope.strings:
            return (
                "text-variable",
                Message("{name} is text, not a number.", name=name),
                ("Use a variable of type REAL or INT."),
            )
        if letters in self.variable_scope.array_dimensions:
            sizes = self.variable_scope.array_dimensions[letters]
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
            return WRONG_OTHER_INDEX if right else WRONG_FIRST_INDEX, text, hint
        if letters == "R":
            return (
                UNSET_PARAMETER_CODE,
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
        return NAME_NOT_DEFINED, text, Message("Write DEF REAL {word} before this block.", word=name)


def format_variable_name(
    letters: str,
    number: int | Formula | None,
    compute_formula: Callable[[Formula], float],
    make_error: ErrorFactory,
) -> str:
    """Return the name of a variable or element, such as R7, LENGTH or TABLE[2].

    Raises the error that ``make_error`` returns if an index is negative or not a whole number, or if an R
    parameter has more than one index or an index above 299.
    """
    if number is None:
        return letters
    if isinstance(number, int) and (letters != "R" or number <= MAX_R_NUMBER):
        return f"{letters}{number}"
    indices = (
        [float(number)] if isinstance(number, int) else list(map(compute_formula, get_index_formulas(number)))
    )
    for place, index in enumerate(indices):
        is_too_high = letters == "R" and (place or index > MAX_R_NUMBER)
        if convert_to_whole_number(index) is None or index < 0 or is_too_high:
            code = WRONG_OTHER_INDEX if place else WRONG_FIRST_INDEX
            text = Message(
                "{letters}[{item}] does not exist.",
                letters=letters,
                item=",".join(f"{each:g}" for each in indices),
            )
            raise make_error(code, text, _INDEX_HINTS.get(letters, _ARRAY_INDEX_HINT))
    written = ",".join(str(round(each)) for each in indices)
    return f"R{written}" if letters == "R" else f"{letters}[{written}]"


_ARRAY_INDEX_HINT = "Use a whole number of 0 or more as the index."
_INDEX_HINTS = {"R": Message("Use a parameter from R0 to R{most_r}.", most_r=MAX_R_NUMBER)}


def _check_repeat_count(count: float, make_error: ErrorFactory) -> int:
    """Return the number of elements that REP fills.

    Raises the error that ``make_error`` returns if the number is not a whole number of 0 or more.
    """
    whole = convert_to_whole_number(count)
    if whole is None or whole < 0:
        text = Message("REP cannot fill {count} elements.", count=f"{count:g}")
        raise make_error("array-values", text, "Write a whole number of 0 or more.")
    return whole


def _r_places() -> list[str]:
    return [f"R{number}" for number in range(MAX_R_NUMBER + 1)]


def read_system_value(name: str, modal: ModalState, edge: ToolOffset) -> float | None:
    """Return the value of a system variable, or None if it is unsupported or unknown.

    ``edge`` is the offset of the active T and D. $P_TOOL is the D number. $P_TOOLR is the nose radius in
    mm, or 0 with D0; it is unknown under G70. $P_TOOLNO is the number of the tool; it is unknown if the
    tool has only a name.
    """
    if name == "$P_TOOL":
        return float(modal.edge or 0)
    if name == "$P_TOOLNO" and get_tool_number(modal.tool) < FIRST_NAMED_TOOL:
        return float(get_tool_number(modal.tool))
    if name == "$P_TOOLR" and modal.metric:
        return edge.nose_radius if modal.edge else 0.0
    return None


_POSITION = re.compile(r"\$(?:AA_IW|P_EP)\[([A-Z][0-9]?)\]")


def get_position_axis(name: str) -> str:
    """Return the axis whose position a system variable contains, or an empty string for any other name."""
    match = _POSITION.fullmatch(name)
    return match[1] if match else ""
