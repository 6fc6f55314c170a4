"""What the smaller controls of the SINUMERIK family lack: 802D and 808D beside 828D and 840D.

A machine that has replaced an 802D says so in its file (``machine.control``), so that a program which its old
control would not have read is refused here too. The lists are recalled from the makers' programming guides of
the turning versions; ``docs/sinumerik-controls.md`` shows them.
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
    """The first thing of a line that a control has not, with its column; None where it has all."""
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
