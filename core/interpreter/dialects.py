"""One door to the interpreters of all dialects: text and circumstances in, elementary blocks out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol, runtime_checkable

from core.interpreter.begin import Checkpoint
from core.interpreter.blocks import Block
from core.interpreter.modal import Modal
from core.interpreter.refused import Refused
from core.interpreter.series import Series
from core.interpreter.setup import Setup
from core.language.diagnostics import Diagnostic
from core.language.dialect import Dialect
from core.language.source import Source

_LATHE_AXES = 3


class Interpretation(Protocol):
    """One pass through a program, in whatever language. It raises nothing: see ``diagnostics``."""

    @property
    def source_blocks(self) -> int:
        """Lines that hold more than a comment."""
        ...

    @property
    def diagnostics(self) -> Sequence[Diagnostic]:
        """All findings so far, those of reading the text first; grows while blocks are taken."""
        ...

    @property
    def modal(self) -> Modal:
        """The state after the last block that was taken."""
        ...

    @property
    def used_tools(self) -> Sequence[int]:
        """Tool numbers asked for so far, in the order of first use."""
        ...

    @property
    def missing_tools(self) -> Sequence[int]:
        """Those of them whose offset has never been set."""
        ...

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """The elementary blocks, made as they are asked for. To be called once."""
        ...


@runtime_checkable
class InSeries(Protocol):
    """An interpretation that can also hand on whole series of moves; the blocks are the same."""

    def series(self) -> Iterator[Block | Series]:
        """``blocks``, series of straight moves in one. To be called once, instead of it."""
        ...


class Line(Interpretation, Protocol):
    """One line of MDI."""

    @property
    def checkpoint(self) -> Checkpoint:
        """What the next line inherits."""
        ...


def _omniturn(source: Source, setup: Setup) -> Interpretation:
    if len(setup.start) != _LATHE_AXES:
        why = "An OmniTurn program needs a lathe with X, Z and C; this machine has other axes."
        return Refused(why, "Choose the machine file of a lathe.")
    from core.interpreter.program import read_program
    from core.interpreter.run import Interpreter

    if setup.begin is not None and setup.begin.single:
        return line_alone(source, setup)
    return Interpreter(read_program(source, setup.strict), setup)


def line_alone(source: Source, setup: Setup) -> Line:
    """One line of MDI, beginning with what ``setup.begin`` says; MDI speaks OmniTurn alone."""
    from core.interpreter.run import Interpreter
    from core.interpreter.single import read_single

    return Interpreter(read_single(source), setup)


def _sinumerik(source: Source, setup: Setup) -> Interpretation:
    if len(setup.start) != _LATHE_AXES:
        why = "A SINUMERIK turning program needs a lathe with X and Z; this machine has other axes."
        return Refused(why, "Choose the machine file of a lathe.")
    if setup.begin is not None:
        why = "A SINUMERIK program begins with its first block."
        return Refused(why, "Start it from the beginning.")
    from core.interpreter.sinumerik.run import Interpreter

    return Interpreter(source, setup)


def _klartext(source: Source, setup: Setup) -> Interpretation:
    if setup.kinematics is None:
        why = "A Klartext program needs a mill with X, Y and Z, and its [kinematics]; this machine is none."
        return Refused(why, "Choose the machine file of a mill: --machine ac-table-mill.")
    if setup.begin is not None:
        return Refused("A Klartext program begins with its first block.", "Start it from the beginning.")
    from core.interpreter.klartext.program import read_program
    from core.interpreter.klartext.run import Interpreter

    return Interpreter(read_program(source), setup, setup.kinematics)


# A language is loaded when a program of it is: the others cost nothing.
_INTERPRETERS: Mapping[Dialect, Callable[[Source, Setup], Interpretation]] = {
    Dialect.OMNITURN: _omniturn,
    Dialect.SINUMERIK: _sinumerik,
    Dialect.KLARTEXT: _klartext,
}


def interpretation(source: Source, setup: Setup) -> Interpretation:
    """One pass through this program."""
    return _INTERPRETERS[source.dialect](source, setup)


def passed_on(interpreter: Interpretation) -> Iterator[Block | Series]:
    """The elementary blocks as whoever goes through a whole program takes them: in series where there are."""
    return interpreter.series() if isinstance(interpreter, InSeries) else interpreter.blocks()
