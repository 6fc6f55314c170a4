"""Functions of the SINUMERIK controls 828D and 840D that the smaller controls 802D and 808D lack.

If a machine replaces an 802D, its machine file specifies the old control (``machine.control``). A program
that the old control would not accept is then also rejected by TurnDesk. The lists follow the manufacturer's
programming guides for turning; ``docs/sinumerik-controls.md`` shows them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from core.language.sinumerik.sinumerik_words import LexedBlock, Word

FULL_CONTROL = "840d"
CONTROL_NAMES = ("802d", "808d", "828d", FULL_CONTROL)
"""Names of the SINUMERIK controls in the machine file."""

_STRUCTURES = """
    ELSE ENDIF CASE WHILE ENDWHILE FOR ENDFOR LOOP ENDLOOP UNTIL GOTOS EXTERN SETAL GROUP_BEGIN GROUP_END
    DISPLOF DISPLON SBLOF SBLON
"""
_MODES = """
    G505 G506 G962 G972 G973 G643 G644 G645 COMPON COMPOF COMPCURV COMPCAD CPRECON CPRECOF CUT2D CUT2DF
    DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH FNORM STOPFIFO STARTFIFO FIFOCTRL DIAM90 WORKPIECE
    CYCLE800 CYCLE832 SPOSA
"""
NAMED_TOOL_FUNCTION = 'T="NAME"'
IF_BLOCK_FUNCTION = "IF without a jump"

_SMALL = frozenset(f"{_STRUCTURES} {_MODES}".split()) | {NAMED_TOOL_FUNCTION, IF_BLOCK_FUNCTION}
MISSING_FUNCTIONS: Mapping[str, frozenset[str]] = {
    "802d": _SMALL | {"CYCLE99", "CYCLE86"},
    "808d": _SMALL - {"CUT2D", "CUT2DF"},
    "828d": frozenset(),
    FULL_CONTROL: frozenset(),
}
"""Functions that a control does not have but TurnDesk does, by control name."""


def find_missing_function(control: str, line: LexedBlock) -> tuple[str, int] | None:
    """Return the first function of a line that a control lacks, with its column, or None otherwise."""
    lacks = MISSING_FUNCTIONS[control]
    if not lacks:
        return None
    return next(((name, column) for name, column in _names(line) if name in lacks), None)


def _names(line: LexedBlock) -> Iterator[tuple[str, int]]:
    if line.called_name:
        yield line.called_name, line.call_column
    if line.control_statement is not None:
        jumps = line.control_statement.target_label or line.control_statement.keyword != "IF"
        yield (
            (str(line.control_statement.keyword) if jumps else IF_BLOCK_FUNCTION),
            line.control_statement.column,
        )
    for word in line.words:
        yield _head(word), word.column


def _head(word: Word) -> str:
    if word.name == "G" and word.value is not None:
        return f"G{int(word.value)}"
    return NAMED_TOOL_FUNCTION if word.name == "T" and word.quoted_name else word.name
