"""Suppression of errors that are only consequences of an earlier error.

The control stops at its first error. The interpreter continues, so that one pass reports all independent
errors. After a rejected TOOL CALL, however, the tool axis and the speed are unknown. After any rejected
block, the start of a following arc is unknown. An error that may be a consequence of a rejected block is
reported only when that block has been corrected.
"""

from __future__ import annotations

import re

from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import (
    ARC_END_INCORRECT,
    ARITHMETIC_ERROR,
    COMPENSATION_NOT_PERMITTED,
    CYCLE_MISSING,
    CYCLE_UNKNOWN,
    DIRECTION_UNDEFINED,
    FEED_MISSING,
    FILE_MISSING,
    INPUT_VALUE_INCORRECT,
    M128_ACTIVE,
    M_FUNCTION_UNDEFINED,
    NOT_ALLOWED_WITH_M128,
    NOT_SUPPORTED,
    PATH_FUNCTION_NOT_POSSIBLE,
    POLE_MISSING,
    PROBE_MISSING,
    Q_PARAMETER_UNDEFINED,
    RADIUS_TOO_LARGE,
    ROUNDING_NOT_POSSIBLE,
    TOOL_AXIS_MISSING,
    TOOL_UNKNOWN,
    WRONG_RPM,
    MissingValueError,
)
from core.language.klartext.klartext_nodes import KlartextLine

_TOOL_CODES = frozenset({TOOL_AXIS_MISSING, WRONG_RPM, FEED_MISSING, RADIUS_TOO_LARGE, ROUNDING_NOT_POSSIBLE})
_PATH_CODES = frozenset(
    {
        ARC_END_INCORRECT,
        DIRECTION_UNDEFINED,
        POLE_MISSING,
        PATH_FUNCTION_NOT_POSSIBLE,
        ROUNDING_NOT_POSSIBLE,
        COMPENSATION_NOT_PERMITTED,
        RADIUS_TOO_LARGE,
        FEED_MISSING,
    }
)
_CYCLE_CODES = frozenset({CYCLE_MISSING})
_PLANE_CODES = frozenset({M128_ACTIVE, NOT_ALLOWED_WITH_M128})
_VALUE_CODES = frozenset({Q_PARAMETER_UNDEFINED, ARITHMETIC_ERROR, INPUT_VALUE_INCORRECT})
_ALL_CODES = _TOOL_CODES | _PATH_CODES | _CYCLE_CODES | _PLANE_CODES | _VALUE_CODES
_MISSING_CODES = frozenset(
    {NOT_SUPPORTED, M_FUNCTION_UNDEFINED, TOOL_UNKNOWN, CYCLE_UNKNOWN, PROBE_MISSING, FILE_MISSING}
)
"""Codes for functions, tools and files that the control or machine does not have.

These errors do not depend on the line and are reported only at the first place.
"""

_SPINDLE = frozenset({3, 4, 13, 14})
_CALLS = frozenset({89, 99})  # M functions that call a cycle

_BEGINS = (  # start of a block that cannot be read, and the possible consequences
    (re.compile(r"TOOL"), _TOOL_CODES),
    (
        re.compile(r"L\b|LP|LN|C[CPRT]?\b|CTP|APPR|DEP|RND|CHF|F[LCS]|FPOL|I?[XYZ]|SPL"),
        _PATH_CODES | {WRONG_RPM},
    ),
    (re.compile(r"SEL\s+PGM"), frozenset({FILE_MISSING})),
    (re.compile(r"CYCL|CONTOUR|PATTERN|GLOBAL|SEL|DECLARE|QC"), _CYCLE_CODES | _VALUE_CODES),
    (re.compile(r"PLANE|FUNCTION|TRANS"), _PLANE_CODES | {Q_PARAMETER_UNDEFINED}),
    (re.compile(r"M\s*[0-9]"), frozenset({WRONG_RPM}) | _PLANE_CODES),
    (re.compile(r"Q|FN"), _VALUE_CODES),
    (re.compile(r"LBL|STOP|BLK|TCH|\*|END|BEGIN"), frozenset[str]()),
)


class ConsequentFaultFilter:
    """Filter for errors that may be consequences of earlier errors in the same pass."""

    def __init__(self) -> None:
        self._silent: set[str] = set()
        self._said: set[str] = set()
        self._cycles = False  # the tool, the cycle or a cycle parameter is uncertain
        self._unknown: set[tuple[str, int]] = set()  # parameters without a value because of an error

    def is_consequence(self, error: ProgramError, node: nodes.Node | None) -> bool:
        """Return whether an error may be a consequence of an earlier error.

        The method also records the possible consequences of this error.
        """
        found = error.diagnostic
        parameter = error.parameter if isinstance(error, MissingValueError) else None
        silent = found.code in self._silent or parameter in self._unknown
        silent = silent or (self._cycles and _runs_a_cycle(node) and found.code in _ALL_CODES)
        if parameter is not None:
            self._unknown.add(parameter)
        silent = silent or (found.code in _MISSING_CODES and found.message in self._said)
        self._said.add(found.message)
        self._keep(node)
        return silent

    def record_unreadable_block(self, text: str) -> None:
        """Record a block that cannot be parsed, because later errors may be its consequences."""
        follows = next((codes for begins, codes in _BEGINS if begins.match(text.upper())), _ALL_CODES)
        self._silent |= follows
        self._cycles = self._cycles or bool(follows & (_CYCLE_CODES | {TOOL_AXIS_MISSING}))

    def _keep(self, node: nodes.Node | None) -> None:
        self._unknown |= _assigned_parameters(node)
        match node:
            case nodes.ToolCall() | nodes.ToolDefinition():
                self._silent |= _TOOL_CODES
                self._cycles = True
            case nodes.PathFunction() | nodes.MFunctionBlock() | nodes.StopBlock():
                self._silent |= _PATH_CODES if isinstance(node, nodes.PathFunction) else _PLANE_CODES
                if any(code.number in _SPINDLE for code in node.m_functions):
                    self._silent.add(WRONG_RPM)
            case nodes.Pole() | nodes.CornerBlock() | nodes.DatumShift() | nodes.CoordinateTransform():
                self._silent |= _PATH_CODES
            case (
                nodes.CycleDefinition()
                | nodes.CycleLine()
                | nodes.PatternDefinition()
                | nodes.ContourDefinition()
            ):
                self._silent |= _CYCLE_CODES
                self._cycles = True
            case nodes.PlaneBlock() | nodes.TcpmSwitch():
                self._silent |= _PLANE_CODES
            case nodes.ProgramCall() | nodes.SelectionBlock():
                self._silent |= _ALL_CODES
            case _:
                pass


def _assigned_parameters(node: nodes.Node | None) -> set[tuple[str, int]]:
    """Return the Q parameters that a rejected block would have assigned."""
    match node:
        case nodes.Assignment() | nodes.SystemRead():
            return {(node.parameter_kind, node.parameter_number)}
        case nodes.PlaneBlock() | nodes.TcpmSwitch():
            return {("Q", 120), ("Q", 121), ("Q", 122)}
        case _:
            return set()


def makes_flow_unknown(node: nodes.Node | None) -> bool:
    """Return whether the program flow is unknown after an error in this block."""
    return isinstance(node, (nodes.ConditionalJump, nodes.LabelCall, nodes.ErrorMessageBlock))


def _runs_a_cycle(node: nodes.Node | None) -> bool:
    if isinstance(node, nodes.CycleCall):
        return True
    return isinstance(node, (nodes.PathFunction, nodes.MFunctionBlock)) and any(
        c.number in _CALLS for c in node.m_functions
    )


def remove_repeated_errors(lines: list[KlartextLine]) -> None:
    """Remove syntax errors that repeat an earlier error.

    An error repeats an earlier one if it names the same missing function, or if it is in a later line of
    the same cycle.
    """
    said: set[str] = set()
    cycle = ""
    for index, line in enumerate(lines):
        if line.error is None:
            cycle = "" if line.node is not None else cycle
            continue
        part = _CYCLE_LINE_PATTERN.match(line.block_text.upper())
        goes_on = part is not None and part.group(1) == cycle and part.group(2) != "0"
        cycle = part.group(1) if part is not None else ""
        if goes_on or (line.error.code in _MISSING_CODES and line.error.message in said):
            lines[index] = line._replace(error=None)
        said.add(line.error.message)


_CYCLE_LINE_PATTERN = re.compile(r"((?:CYCL DEF|TCH PROBE) ?[0-9]+) ?\. ?([0-9]+)")
