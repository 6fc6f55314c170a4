"""Functions that smaller SINUMERIK controls lack: 802D and 808D compared with 828D and 840D.

The machine file of a machine that replaces an 802D specifies the old control (``machine.control``). A program
that the old control would not accept is then rejected here too. The lists follow the manufacturer's
programming guides for turning; ``docs/sinumerik-controls.md`` shows them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from core.language.sinumerik.sinumerik_words import Line, Word

WHOLE = "840d"
CONTROLS = ("802d", "808d", "828d", WHOLE)
"""Names in the machine file."""

_STRUCTURES = """
    ELSE ENDIF CASE WHILE ENDWHILE FOR ENDFOR LOOP ENDLOOP UNTIL GOTOS EXTERN SETAL GROUP_BEGIN GROUP_END
    DISPLOF DISPLON SBLOF SBLON
"""
_MODES = """
    G505 G506 G962 G972 G973 G643 G644 G645 COMPON COMPOF COMPCURV COMPCAD CPRECON CPRECOF CUT2D CUT2DF
    DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH FNORM STOPFIFO STARTFIFO FIFOCTRL DIAM90 WORKPIECE
    CYCLE800 CYCLE832 SPOSA
"""
NAMED_TOOL = 'T="NAME"'
IF_BLOCK = "IF without a jump"

_SMALL = frozenset(f"{_STRUCTURES} {_MODES}".split()) | {NAMED_TOOL, IF_BLOCK}
LACKS: Mapping[str, frozenset[str]] = {
    "802d": _SMALL | {"CYCLE99", "CYCLE86"},
    "808d": _SMALL - {"CUT2D", "CUT2DF"},
    "828d": frozenset(),
    WHOLE: frozenset(),
}
"""By control, what it has not and this one has."""


def lacking(control: str, line: Line) -> tuple[str, int] | None:
    """Return the first function of a line that a control lacks, with its column.

    Returns None if the control has all functions of the line.
    """
    lacks = LACKS[control]
    if not lacks:
        return None
    return next(((name, column) for name, column in _names(line) if name in lacks), None)


def _names(line: Line) -> Iterator[tuple[str, int]]:
    if line.call:
        yield line.call, line.call_column
    if line.jump is not None:
        jumps = line.jump.target or line.jump.steering != "IF"
        yield (str(line.jump.steering) if jumps else IF_BLOCK), line.jump.column
    for word in line.words:
        yield _head(word), word.column


def _head(word: Word) -> str:
    if word.name == "G" and word.value is not None:
        return f"G{int(word.value)}"
    return NAMED_TOOL if word.name == "T" and word.string else word.name
