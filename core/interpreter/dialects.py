"""Entry point to the interpreters of all dialects, from text and setup to elementary blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, cached_property
from typing import TYPE_CHECKING

from core.interpreter.shared.interpretation import Interpretation, RefusedPass
from core.interpreter.shared.job_setup import Setup
from core.language.source import Dialect, Source

if TYPE_CHECKING:
    from core.interpreter.omniturn.flow.conditional_calls import Branching, Guide
    from core.interpreter.omniturn.omniturn_program import Program
    from core.language.code_book import CodeBook


_LATHE_AXES = 3


PassFactory = Callable[[Setup], Interpretation]
"""One more pass through a text that has been read."""


def _omniturn(source: Source, strict: bool) -> PassFactory:
    from core.interpreter.omniturn.omniturn_program import read_program

    return _OmniTurn(read_program(source, strict))


class _OmniTurn:
    """An OmniTurn program that has been read."""

    def __init__(self, program: Program) -> None:
        self.program = program

    def __call__(self, setup: Setup) -> Interpretation:
        from core.interpreter.omniturn.omniturn_interpreter import Interpreter

        return Interpreter(self.program.for_one_pass(), setup)


def line_alone(source: Source, setup: Setup) -> Interpretation:
    """Return a pass through one line of MDI in the machine's language, from the state of ``setup.begin``."""
    if refused := _refusal(source.dialect, setup):
        return refused
    return _LINES[source.dialect](source, setup)


def _omniturn_line(source: Source, setup: Setup) -> Interpretation:
    from core.interpreter.omniturn.omniturn_interpreter import Interpreter
    from core.interpreter.omniturn.omniturn_program import read_single

    return Interpreter(read_single(source), setup)


def _sinumerik_line(source: Source, setup: Setup) -> Interpretation:
    from core.interpreter.sinumerik.sinumerik_interpreter import Interpreter

    return Interpreter(source, setup)


def _klartext_line(source: Source, setup: Setup) -> Interpretation:
    from core.interpreter.klartext.klartext_interpreter import Interpreter
    from core.interpreter.klartext.klartext_program import read_single

    assert setup.kinematics is not None  # otherwise, the pass was rejected
    return Interpreter(read_single(source, inch=not setup.metric), setup, setup.kinematics)


_LINES: Mapping[Dialect, Callable[[Source, Setup], Interpretation]] = {
    Dialect.OMNITURN: _omniturn_line,
    Dialect.SINUMERIK: _sinumerik_line,
    Dialect.KLARTEXT: _klartext_line,
}


def _sinumerik(source: Source, _strict: bool) -> PassFactory:
    from core.interpreter.sinumerik.sinumerik_interpreter import Interpreter

    return lambda setup: Interpreter(source, setup)


def _klartext(source: Source, _strict: bool) -> PassFactory:
    from core.interpreter.klartext.klartext_interpreter import Interpreter
    from core.interpreter.klartext.klartext_program import read_program

    program = read_program(source)

    def begin(setup: Setup) -> Interpretation:
        assert setup.kinematics is not None  # otherwise, the pass was rejected
        return Interpreter(program, setup, setup.kinematics)

    return begin


def _refusal(dialect: Dialect, setup: Setup) -> RefusedPass | None:
    """Return a rejected pass if this machine cannot run the dialect; otherwise None."""
    lathe = len(setup.start) == _LATHE_AXES
    if dialect is Dialect.OMNITURN and not lathe:
        why = "An OmniTurn program needs a lathe with X, Z and C; this machine has other axes."
        return RefusedPass(why, "Choose the machine file of a lathe: --machine gt75.")
    if dialect is Dialect.SINUMERIK and not lathe:
        why = "A SINUMERIK turning program needs a lathe with X and Z; this machine has other axes."
        return RefusedPass(why, "Choose the machine file of a lathe: --machine sinumerik-modulo.")
    if dialect is Dialect.KLARTEXT and setup.kinematics is None:
        why = (
            "A Klartext program needs a mill with X, Y, Z and [kinematics]; this machine does "
            "not meet these requirements."
        )
        return RefusedPass(why, "Choose the machine file of a mill: --machine ac-table-mill.")
    return None


NAMES = {Dialect.OMNITURN: "OmniTurn", Dialect.SINUMERIK: "SINUMERIK", Dialect.KLARTEXT: "Klartext"}
"""What sentences call them."""


@cache
def code_book(dialect: Dialect) -> CodeBook:
    """Return the code book of a language, which is read on first use."""
    if dialect is Dialect.OMNITURN:
        from core.interpreter.omniturn.codes.omniturn_book import book

        return book()
    from core.language.code_book_files import BOOKS, read_book

    return read_book(BOOKS / dialect)


# The module of a language is imported when a program needs it.
_READERS: Mapping[Dialect, Callable[[Source, bool], PassFactory]] = {
    Dialect.OMNITURN: _omniturn,
    Dialect.SINUMERIK: _sinumerik,
    Dialect.KLARTEXT: _klartext,
}


class ReadProgram:
    """A program text that is read with its first pass and then shared by all passes.

    Reading a million blocks takes almost a second, which the executor cannot wait. Passes can be created in
    several threads at the same time.
    """

    def __init__(self, source: Source, *, strict: bool = False) -> None:
        self.source = source
        self._strict = strict

    def __reduce__(self) -> tuple[object, ...]:
        """Return the pickle data: the text, which the other process reads again."""
        return _unread, (self.source, self._strict)

    def read(self) -> None:
        """Read the text now, so that the first pass does not have to."""
        _ = self._begin

    def is_same(self, other: ReadProgram) -> bool:
        """Return whether the other program has the same text, read in the same mode."""
        return self.source == other.source and self._strict == other._strict

    def begin(self, setup: Setup) -> Interpretation:
        """Return a new pass with this setup."""
        dialect = self.source.dialect
        if refused := _refusal(dialect, setup):
            return refused
        if setup.begin is not None and setup.begin.single:
            return line_alone(self.source, setup)
        return self._begin(setup)

    def branching(self, setup: Setup, guide: Guide) -> Branching | None:
        """Return a pass that ``guide`` can send to both branches; None if the program reads no input."""
        if _refusal(self.source.dialect, setup) or (setup.begin is not None and setup.begin.single):
            return None
        read = self._begin
        if not isinstance(read, _OmniTurn) or not read.program.asks:
            return None
        from core.interpreter.omniturn.flow.conditional_calls import Branching

        return Branching(read.program.for_one_pass(), setup, guide)

    @property
    def program(self) -> Program | None:
        """The OmniTurn program ready for execution; None for other languages."""
        read = self._begin
        return read.program if isinstance(read, _OmniTurn) else None

    @cached_property
    def _begin(self) -> PassFactory:
        return _READERS[self.source.dialect](self.source, self._strict)


def _unread(source: Source, strict: bool) -> ReadProgram:
    return ReadProgram(source, strict=strict)


def interpretation(source: Source, setup: Setup) -> Interpretation:
    """Return one pass through a program that is read only for this pass."""
    return ReadProgram(source, strict=setup.strict).begin(setup)
