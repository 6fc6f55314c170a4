"""The codes of the OmniTurn control: which there are, which exclude each other, which words they take."""

from __future__ import annotations

MODAL_GROUPS: dict[int, str] = {
    90: "distance",
    91: "distance",
    94: "feed mode",
    95: "feed mode",
    0: "rapid",
    1: "rapid",
    70: "units",
    71: "units",
    72: "X words",
    73: "X words",
    96: "spindle mode",
    97: "spindle mode",
    40: "nose compensation",
    41: "nose compensation",
    42: "nose compensation",
    35: "coarse feed",
    36: "coarse feed",
    76: "speed limits",
    77: "speed limits",
}
"""Modal G codes and the group in which one line may hold one of them."""

ONE_SHOT = frozenset({2, 3, 4, 10, 33, 34, 74, 75, 78, 81, 83, 89, 92})
"""G codes that act on their own line alone; a line may hold one."""

ARCS = frozenset({2, 3})
THREADS = frozenset({33, 34})
FRAME = frozenset({10, 92})
"""One-shot codes whose X and Z are no motion."""

CONTOUR_CYCLES = frozenset({75, 78})
CYCLES = CONTOUR_CYCLES | {74, 81, 83}

WORDS: dict[int | None, frozenset[str]] = {
    None: frozenset({"X", "Z", "C", "CA", "CI", "R", "F", "S", "T", "D"}),
    2: frozenset({"X", "Z", "I", "K", "R", "F", "S", "T", "D"}),
    3: frozenset({"X", "Z", "I", "K", "R", "F", "S", "T", "D"}),
    4: frozenset({"F", "S", "T", "D"}),
    10: frozenset({"X", "Z", "F", "S", "T", "D"}),
    89: frozenset({"S"}),
    92: frozenset({"X", "Z", "F", "S", "T", "D"}),
    33: frozenset({"X", "Z", "I", "K", "A", "C", "P", "O", "F", "S", "T", "D"}),
    34: frozenset({"Z", "I", "K", "A", "P", "F", "S", "T", "D"}),
    74: frozenset({"X", "Z", "I", "U", "F", "S"}),
    75: frozenset({"I", "U", "P", "F", "S"}),
    78: frozenset({"U", "P", "F", "S"}),
    81: frozenset({"X", "Z", "F", "S"}),
    83: frozenset({"X", "Z", "K", "R", "L", "C", "F", "S"}),
}
"""Words besides G and M that a line may hold, by its one-shot code."""

FLOW_WORDS: dict[str, frozenset[str]] = {
    "LS": frozenset({"LS"}),
    "LF": frozenset({"LF"}),
    "}": frozenset({"}"}),
    "RF": frozenset({"RF"}),
    "P": frozenset({"P"}),
    "M95": frozenset({"M"}),
    "M97": frozenset({"M", "I", "C", "P"}),
    "M98": frozenset({"M", "P"}),
    "M99": frozenset({"M"}),
}
"""Lines that steer the order of execution, and exactly what stands on them."""

ASKS = frozenset({"M95", "M97"})
"""Calls that depend on an input."""

CALLS = ASKS | {"P", "M98"}
ENDS = frozenset({2, 30})
"""M codes that end the program."""

M_BEFORE = frozenset({3, 4, 8, 12, 13, 91, 92, 93, 94})
"""M codes that act before the motion of their line."""

M_AFTER = frozenset({0, 1, 2, 5, 9, 30, 31})
"""M codes that act after the motion of their line."""

M_FLOW = frozenset({95, 97, 98, 99})
M_POSITIONING = frozenset({19, 89})
M_KNOWN = M_BEFORE | M_AFTER | M_FLOW | M_POSITIONING
"""M codes of the control itself; all others are the machine file's."""
