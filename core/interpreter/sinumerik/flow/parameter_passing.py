"""What a call hands over to PROC: values, VAR by reference, defaults; and what SAVE brings back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import chain, repeat

from core.interpreter.shared.job_setup import ZeroOffset
from core.interpreter.shared.modal_state import Modal
from core.interpreter.sinumerik.flow.variables import Scope, place_name
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_state import Motion, State
from core.language.formulas import Parameter as Variable
from core.language.sinumerik.call_arguments import Argument, Parameter
from core.language.sinumerik.program_jumps import Jump
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message

TOO_MANY = 12330
"""The alarm of a call whose arguments do not fit the parameters."""

NO_VARIABLE = 12320
OTHER_SIZE = 12360
"""Those of an argument of VAR that is no variable, and of an array with other sizes; recalled as 12330 is."""

_GROUPS = ("absolute", "metric", "diameter", "per_rev", "feed", "settable")


@dataclass(frozen=True, slots=True)
class Saved:
    """Modal G functions and the frame at the call of a program with SAVE."""

    modal: Modal
    motion: Motion
    plane: int
    settable: ZeroOffset
    programmed: ProgrammedFrame

    @classmethod
    def of(cls, state: State) -> Saved:
        """What is in force now."""
        return cls(state.modal, state.motion, state.plane, state.settable, state.programmed)

    def bring_back(self, state: State) -> None:
        """G functions and frame as they were; F, S and M stay what the program has made them."""
        state.motion, state.plane = self.motion, self.plane
        state.settable, state.programmed = self.settable, self.programmed
        kept = {name: getattr(self.modal, name) for name in _GROUPS}
        if self.modal.per_rev == state.modal.per_rev:
            kept["feed"] = state.modal.feed
        state.adopt(state.modal._replace(**kept, rapid=self.motion == 0))
        state.derive_offsets()


def handed_over(state: State, line: Line, heading: Jump | None) -> tuple[Scope, list[tuple[str, str]]]:
    """The variables that the program begins with, and its VAR parameters with the caller's place of each.

    Raises ProgramError where the arguments do not fit.
    """
    parameters = () if heading is None else heading.parameters
    arguments = line.arguments or ()
    if len(arguments) > len(parameters):
        text = Message(
            "{call} accepts {parameters_count}, but the call passes {arguments_count}.",
            call=line.call,
            parameters_count=_count(len(parameters)),
            arguments_count=len(arguments),
        )
        hint = "Correct the call, or the PROC line of the subprogram."
        raise line.refuse(arguments[len(parameters)].column, TOO_MANY, text, hint)
    made = _HandOver(state, line)
    left_out = Argument(None, None, line.call_column)
    for parameter, argument in zip(parameters, chain(arguments, repeat(left_out)), strict=False):
        (made.array if parameter.sizes else made.value)(parameter, argument)
    return made.scope, made.references


class _HandOver:
    """What a call hands over, parameter by parameter."""

    def __init__(self, state: State, line: Line) -> None:
        self._state, self._line = state, line
        self.scope = Scope()
        self.references: list[tuple[str, str]] = []

    def value(self, parameter: Parameter, argument: Argument) -> None:
        """A number or a text. What is left out is 0, and an empty text. Raises ProgramError."""
        given = argument if argument.given else parameter.default
        name = parameter.name
        if parameter.by_reference:
            self.references.append((name, self._place(parameter, argument)))
        if given is None:
            if parameter.kind in {"STRING", "AXIS"}:
                self.scope.texts[name] = ""
            else:
                self.scope.numbers[name] = 0.0
        elif given.text is not None:
            self.scope.texts[name] = given.text
        elif given.formula is not None:
            value = self._state.worth(given.formula, partial(self._line.refuse, given.column))
            whole = parameter.kind != "INT" or value.is_integer()
            self.scope.numbers[name] = value if whole else float(round(value))

    def array(self, parameter: Parameter, argument: Argument) -> None:
        """An array of VAR: its elements go in, and come back element by element. Raises ProgramError."""
        line, outer, formula = self._line, self._state.variables.scope, argument.formula
        name = formula.letters if isinstance(formula, Variable) and formula.number is None else ""
        sizes = outer.sizes.get(name, ())
        if not sizes:
            text = Message(
                "{parameter} of {call} is a VAR array, so the call must pass an array.",
                parameter=parameter.name,
                call=line.call,
            )
            raise line.refuse(
                argument.column, NO_VARIABLE, text, "Pass the name of an array without an index."
            )
        asked = tuple(
            size if each is None else each for each, size in zip(parameter.sizes, sizes, strict=False)
        )
        if asked != sizes or len(parameter.sizes) != len(sizes):
            text = Message(
                "{name} has {text} elements, but this size does not match the dimensions of {parameter}.",
                name=name,
                text=" by ".join(map(str, sizes)),
                parameter=parameter.name,
            )
            hint = "Use the array sizes given in the PROC line."
            raise line.refuse(argument.column, OTHER_SIZE, text, hint)
        self.scope.define(parameter.name, 0.0, sizes)
        for inside, outside in zip(self.scope.elements(parameter.name), outer.elements(name), strict=True):
            self.scope.numbers[inside] = outer.numbers[outside]
            self.references.append((inside, outside))

    def _place(self, parameter: Parameter, argument: Argument) -> str:
        """The caller's variable that VAR writes back to. Raises ProgramError."""
        state, line, formula = self._state, self._line, argument.formula
        if not isinstance(formula, Variable):
            text = Message(
                "{parameter} of {call} is a VAR parameter, so the call must pass a variable.",
                parameter=parameter.name,
                call=line.call,
            )
            raise line.refuse(argument.column, TOO_MANY, text, "Pass a variable or an R parameter.")
        refuse = partial(line.refuse, line.call_column)
        return place_name(formula.letters, formula.number, lambda index: state.worth(index, refuse), refuse)


def _count(count: int) -> str:
    if not count:
        return "no parameters"
    return Message("{count} parameter" if count == 1 else "{count} parameters", count=count)
