"""Common interface to the interpreters of all program dialects.

An interpreter converts a program text and a setup to elementary blocks.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, cached_property
from typing import TYPE_CHECKING

from core.interpreter.shared.interpretation import InterpreterPass, RejectedPass
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import Dialect, ProgramSource

if TYPE_CHECKING:
    from core.interpreter.omniturn.flow.conditional_calls import BranchingPass, BranchRecord
    from core.interpreter.omniturn.omniturn_program import Program
    from core.language.code_book import CodeBook


_LATHE_AXES = 3


PassFactory = Callable[[InterpreterSetup], InterpreterPass]
"""Function that makes another interpreter pass through a program that has already been read."""


def _omniturn(source: ProgramSource, strict: bool) -> PassFactory:
    from core.interpreter.omniturn.omniturn_program import read_program

    return _OmniTurn(read_program(source, strict))


class _OmniTurn:
    """A parsed OmniTurn program from which interpreter passes can be started."""

    def __init__(self, program: Program) -> None:
        self.program = program

    def __call__(self, setup: InterpreterSetup) -> InterpreterPass:
        from core.interpreter.omniturn.omniturn_interpreter import Interpreter

        return Interpreter(self.program.copy_for_pass(), setup)


def interpret_mdi_line(source: ProgramSource, setup: InterpreterSetup) -> InterpreterPass:
    """Return a pass through one MDI line in the machine's dialect.

    The pass starts from the state ``setup.begin``.
    """
    if refused := _refusal(source.dialect, setup):
        return refused
    return _LINE_INTERPRETERS[source.dialect](source, setup)


def _omniturn_line(source: ProgramSource, setup: InterpreterSetup) -> InterpreterPass:
    from core.interpreter.omniturn.omniturn_interpreter import Interpreter
    from core.interpreter.omniturn.omniturn_program import read_mdi_line

    return Interpreter(read_mdi_line(source), setup)


def _sinumerik_line(source: ProgramSource, setup: InterpreterSetup) -> InterpreterPass:
    from core.interpreter.sinumerik.sinumerik_interpreter import Interpreter

    return Interpreter(source, setup)


def _klartext_line(source: ProgramSource, setup: InterpreterSetup) -> InterpreterPass:
    from core.interpreter.klartext.klartext_interpreter import Interpreter
    from core.interpreter.klartext.klartext_mdi import read_mdi_block

    assert setup.kinematics is not None  # otherwise, the pass was rejected
    return Interpreter(read_mdi_block(source, is_inch=not setup.metric), setup, setup.kinematics)


_LINE_INTERPRETERS: Mapping[Dialect, Callable[[ProgramSource, InterpreterSetup], InterpreterPass]] = {
    Dialect.OMNITURN: _omniturn_line,
    Dialect.SINUMERIK: _sinumerik_line,
    Dialect.KLARTEXT: _klartext_line,
}


def _sinumerik(source: ProgramSource, _strict: bool) -> PassFactory:
    from core.interpreter.sinumerik.sinumerik_interpreter import Interpreter

    return lambda setup: Interpreter(source, setup)


def _klartext(source: ProgramSource, _strict: bool) -> PassFactory:
    from core.interpreter.klartext.klartext_interpreter import Interpreter
    from core.interpreter.klartext.klartext_program import read_program

    program = read_program(source)

    def start_pass(setup: InterpreterSetup) -> InterpreterPass:
        assert setup.kinematics is not None  # otherwise, the pass was rejected
        return Interpreter(program, setup, setup.kinematics)

    return start_pass


def _refusal(dialect: Dialect, setup: InterpreterSetup) -> RejectedPass | None:
    """Return a rejected pass if this machine cannot run the dialect, or None otherwise."""
    lathe = len(setup.start) == _LATHE_AXES
    if dialect is Dialect.OMNITURN and not lathe:
        why = "An OmniTurn program needs a lathe with X, Z and C; this machine has other axes."
        return RejectedPass(why, "Choose the machine file of a lathe: --machine gt75.")
    if dialect is Dialect.SINUMERIK and not lathe:
        why = "A SINUMERIK turning program needs a lathe with X and Z; this machine has other axes."
        return RejectedPass(why, "Choose the machine file of a lathe: --machine sinumerik-modulo.")
    if dialect is Dialect.KLARTEXT and setup.kinematics is None:
        why = (
            "A Klartext program needs a mill with X, Y, Z and [kinematics]; this machine does "
            "not meet these requirements."
        )
        return RejectedPass(why, "Choose the machine file of a mill: --machine ac-table-mill.")
    return None


DIALECT_NAMES = {Dialect.OMNITURN: "OmniTurn", Dialect.SINUMERIK: "SINUMERIK", Dialect.KLARTEXT: "Klartext"}
"""Names of the program languages in messages."""


@cache
def get_code_book(dialect: Dialect) -> CodeBook:
    """Return the code book of a dialect, which is loaded on first use."""
    if dialect is Dialect.OMNITURN:
        from core.interpreter.omniturn.codes.omniturn_book import build_code_book

        return build_code_book()
    from core.language.code_book_files import CODE_BOOKS_FOLDER, read_code_book

    return read_code_book(CODE_BOOKS_FOLDER / dialect)


# The module of a language is imported when a program needs it.
_READERS: Mapping[Dialect, Callable[[ProgramSource, bool], PassFactory]] = {
    Dialect.OMNITURN: _omniturn,
    Dialect.SINUMERIK: _sinumerik,
    Dialect.KLARTEXT: _klartext,
}


class SharedProgram:
    """A program that is parsed once, for its first interpreter pass, and then shared by all passes.

    Parsing a million blocks takes almost a second, which is too long for the executor to wait. Several
    threads can start passes at the same time.
    """

    def __init__(self, source: ProgramSource, *, strict: bool = False) -> None:
        self.source = source
        self._strict = strict

    def __reduce__(self) -> tuple[object, ...]:
        """Return pickle data that contain only the program text.

        The receiving process parses the text again.
        """
        return _unread, (self.source, self._strict)

    def parse_text(self) -> None:
        """Parse the program now, so that the first pass does not have to parse it."""
        _ = self._begin

    def has_same_source(self, other: SharedProgram) -> bool:
        """Return whether another program has the same text and the same parsing mode."""
        return self.source == other.source and self._strict == other._strict

    def start_pass(self, setup: InterpreterSetup) -> InterpreterPass:
        """Start a new interpreter pass through the program with this setup, and return it."""
        dialect = self.source.dialect
        if refused := _refusal(dialect, setup):
            return refused
        if setup.begin is not None and setup.begin.is_mdi_line:
            return interpret_mdi_line(self.source, setup)
        return self._begin(setup)

    def start_branching_pass(
        self, setup: InterpreterSetup, branch_record: BranchRecord
    ) -> BranchingPass | None:
        """Start a pass that can execute both branches of conditional calls, and return it.

        ``branch_record`` selects the branches. Returns None if the program does not read any inputs.
        """
        if _refusal(self.source.dialect, setup) or (setup.begin is not None and setup.begin.is_mdi_line):
            return None
        read = self._begin
        if not isinstance(read, _OmniTurn) or not read.program.input_dependent_calls:
            return None
        from core.interpreter.omniturn.flow.conditional_calls import BranchingPass

        return BranchingPass(read.program.copy_for_pass(), setup, branch_record)

    @property
    def omniturn_program(self) -> Program | None:
        """Return the OmniTurn program ready for execution, or None for other dialects."""
        read = self._begin
        return read.program if isinstance(read, _OmniTurn) else None

    @cached_property
    def _begin(self) -> PassFactory:
        return _READERS[self.source.dialect](self.source, self._strict)


def _unread(source: ProgramSource, strict: bool) -> SharedProgram:
    return SharedProgram(source, strict=strict)


def interpret_program(source: ProgramSource, setup: InterpreterSetup) -> InterpreterPass:
    """Return a single pass through a program that is not shared with other passes."""
    return SharedProgram(source, strict=setup.strict).start_pass(setup)
