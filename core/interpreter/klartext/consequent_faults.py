"""Suppression of errors that are only consequences of an earlier error.

The control stops at its first error. The interpreter continues, so that one pass reports all independent
errors. After a rejected TOOL CALL, however, the tool axis and the speed are unknown, and after a rejected
block, the start of an arc is unknown. Errors that may be consequences of such a block are reported only after
the block is corrected.
"""

from __future__ import annotations

import re

from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import (
    ARC_END,
    ARITHMETIC,
    COMPENSATION,
    CYCLE_MISSING,
    CYCLE_UNKNOWN,
    DIRECTION,
    FEED_MISSING,
    FILE_MISSING,
    INPUT_VALUE,
    M128_ON,
    M_UNDEFINED,
    NO_POLE,
    NO_PROBE,
    NOT_SUPPORTED,
    NOT_WITH_M128,
    PREVIOUS,
    Q_UNDEFINED,
    RADIUS_TOO_LARGE,
    ROUNDING,
    TOOL_AXIS_MISSING,
    TOOL_UNKNOWN,
    WRONG_RPM,
    MissingValueError,
)
from core.language.klartext.klartext_nodes import KlartextLine

_OF_TOOLS = frozenset({TOOL_AXIS_MISSING, WRONG_RPM, FEED_MISSING, RADIUS_TOO_LARGE, ROUNDING})
_OF_PATHS = frozenset(
    {ARC_END, DIRECTION, NO_POLE, PREVIOUS, ROUNDING, COMPENSATION, RADIUS_TOO_LARGE, FEED_MISSING}
)
_OF_CYCLES = frozenset({CYCLE_MISSING})
_OF_PLANES = frozenset({M128_ON, NOT_WITH_M128})
_OF_VALUES = frozenset({Q_UNDEFINED, ARITHMETIC, INPUT_VALUE})
_ALL = _OF_TOOLS | _OF_PATHS | _OF_CYCLES | _OF_PLANES | _OF_VALUES
_LACKING = frozenset({NOT_SUPPORTED, M_UNDEFINED, TOOL_UNKNOWN, CYCLE_UNKNOWN, NO_PROBE, FILE_MISSING})
"""What control, machine or shop lacks: the same wherever it stands, so it is told at its first place."""

_SPINDLE = frozenset({3, 4, 13, 14})
_CALLS = frozenset({89, 99})  # M functions that call a cycle

_BEGINS = (  # start of a block that cannot be read, and the possible consequences
    (re.compile(r"TOOL"), _OF_TOOLS),
    (
        re.compile(r"L\b|LP|LN|C[CPRT]?\b|CTP|APPR|DEP|RND|CHF|F[LCS]|FPOL|I?[XYZ]|SPL"),
        _OF_PATHS | {WRONG_RPM},
    ),
    (re.compile(r"SEL\s+PGM"), frozenset({FILE_MISSING})),
    (re.compile(r"CYCL|CONTOUR|PATTERN|GLOBAL|SEL|DECLARE|QC"), _OF_CYCLES | _OF_VALUES),
    (re.compile(r"PLANE|FUNCTION|TRANS"), _OF_PLANES | {Q_UNDEFINED}),
    (re.compile(r"M\s*[0-9]"), frozenset({WRONG_RPM}) | _OF_PLANES),
    (re.compile(r"Q|FN"), _OF_VALUES),
    (re.compile(r"LBL|STOP|BLK|TCH|\*|END|BEGIN"), frozenset[str]()),
)


class Consequences:
    """The uncertain state after the errors of a pass."""

    def __init__(self) -> None:
        self._silent: set[str] = set()
        self._said: set[str] = set()
        self._cycles = False  # the tool, the cycle or a cycle parameter is uncertain
        self._unknown: set[tuple[str, int]] = set()  # parameters without a value because of an error

    def follows(self, problem: ProgramError, node: nodes.Node | None) -> bool:
        """Return whether an error may be a consequence of an earlier error.

        The consequences of the error itself are recorded.
        """
        found = problem.diagnostic
        parameter = problem.parameter if isinstance(problem, MissingValueError) else None
        silent = found.code in self._silent or parameter in self._unknown
        silent = silent or (self._cycles and _runs_a_cycle(node) and found.code in _ALL)
        if parameter is not None:
            self._unknown.add(parameter)
        silent = silent or (found.code in _LACKING and found.message in self._said)
        self._said.add(found.message)
        self._keep(node)
        return silent

    def unreadable(self, text: str) -> None:
        """Record a block that cannot be read, given as it is written."""
        follows = next((codes for begins, codes in _BEGINS if begins.match(text.upper())), _ALL)
        self._silent |= follows
        self._cycles = self._cycles or bool(follows & (_OF_CYCLES | {TOOL_AXIS_MISSING}))

    def _keep(self, node: nodes.Node | None) -> None:
        self._unknown |= _parameters_of(node)
        match node:
            case nodes.ToolCall() | nodes.ToolDef():
                self._silent |= _OF_TOOLS
                self._cycles = True
            case nodes.Move() | nodes.Codes() | nodes.Stop():
                self._silent |= _OF_PATHS if isinstance(node, nodes.Move) else _OF_PLANES
                if any(code.number in _SPINDLE for code in node.codes):
                    self._silent.add(WRONG_RPM)
            case nodes.Pole() | nodes.Corner() | nodes.Datum() | nodes.Transform():
                self._silent |= _OF_PATHS
            case nodes.Cycle() | nodes.CycleLine() | nodes.PatternDef() | nodes.ContourDef():
                self._silent |= _OF_CYCLES
                self._cycles = True
            case nodes.Plane() | nodes.TipControl():
                self._silent |= _OF_PLANES
            case nodes.ProgramCall() | nodes.Selection():
                self._silent |= _ALL
            case _:
                pass


def _parameters_of(node: nodes.Node | None) -> set[tuple[str, int]]:
    """Return the parameters that a block would have set."""
    match node:
        case nodes.Assign() | nodes.SystemRead():
            return {(node.kind, node.q)}
        case nodes.Plane() | nodes.TipControl():
            return {("Q", 120), ("Q", 121), ("Q", 122)}
        case _:
            return set()


def ends_the_pass(node: nodes.Node | None) -> bool:
    """Return whether the program flow is unknown after an error in this block."""
    return isinstance(node, (nodes.Jump, nodes.Call, nodes.ErrorMessage))


def _runs_a_cycle(node: nodes.Node | None) -> bool:
    if isinstance(node, nodes.CycleCall):
        return True
    return isinstance(node, (nodes.Move, nodes.Codes)) and any(c.number in _CALLS for c in node.codes)


def told_once(lines: list[KlartextLine]) -> None:
    """Remove syntax errors that only repeat: the same missing function, or further lines of one cycle."""
    said: set[str] = set()
    cycle = ""
    for index, line in enumerate(lines):
        if line.error is None:
            cycle = "" if line.node is not None else cycle
            continue
        part = _OF_A_CYCLE.match(line.code.upper())
        goes_on = part is not None and part.group(1) == cycle and part.group(2) != "0"
        cycle = part.group(1) if part is not None else ""
        if goes_on or (line.error.code in _LACKING and line.error.message in said):
            lines[index] = line._replace(error=None)
        said.add(line.error.message)


_OF_A_CYCLE = re.compile(r"((?:CYCL DEF|TCH PROBE) ?[0-9]+) ?\. ?([0-9]+)")
