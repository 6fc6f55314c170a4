"""The codes of the OmniTurn control: which there are, which exclude each other, which words they take."""

from __future__ import annotations

from typing import NamedTuple

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

# --- What every code of the language does, with an example of our own that the tests prove.


HEAD = "G90G94F300\nT1\nM03S1000\nX.6Z.1\nG95F.004\n"
"""Before every example: radius mode, the tool at X.6 Z.1, .004 in/rev at 1000 rpm."""

TAIL = "G94F300X.6Z1\nM30\n"


class Entry(NamedTuple):
    """One code: how it is written, what it does, and lines that use it between ``HEAD`` and ``TAIL``."""

    code: str
    form: str
    what: str
    example: str
    subroutine: str = ""  # lines that follow the end of the program

    @property
    def program(self) -> str:
        """The example as a whole program."""
        return f"{HEAD}{self.example}\n{TAIL}{self.subroutine}"


_CONTOUR = "X.2Z0\nX.3Z-.1\nZ-.3\nX.55Z-.5"
_COMPENSATED = "G00X0Z.2\nG41\nG01Z0D1\nX.4\nZ-.5\nX.55\nG00Z.5\nG40"
_COARSE = "S500\nG35\nG92X.6Z.1\nG33X.57Z-.5I.01K.4\nG36\nG92X.6Z.1"
_SLOWLY = "M05\nG94F30"  # before the spindle is made an axis

MOVES = (
    Entry("G00", "G00 XnZn", "Rapid from here on, at the first line's F.", "G00X.7\nZ.5"),
    Entry("G01", "G01 XnZn", "Back to the feed before the rapid.", "Z0\nG00Z.05\nG01Z-.2"),
    Entry("G02", "G02XnZnRn or InKn", "Arc, clockwise seen from above.", "X.3Z0\nG02X.45Z-.15R.15"),
    Entry("G03", "G03XnZnRn or InKn", "Arc, counter-clockwise.", "X.3Z-.2\nG03X.4Z-.3I.4K-.2"),
    Entry("G04", "G04Fn", "Dwell n seconds, .1 at least.", "G04F.5"),
    Entry("F", "Fn", "Feed: in/min under G94, in/rev under G95.", "Z0F.002"),
    Entry("C", "XnZnCn", "Chamfer to the next straight line, set back n on both.", "X.3Z0\nX.5C.03\nZ-.3"),
    Entry("R", "XnZnRn", "Radius n tangent to this and the next straight line.", "X.3Z0\nX.5R.05\nZ-.3"),
)

MODES = (
    Entry("G70", "G70", "Inch.", "G70\nX.5"),
    Entry("G71", "G71", "Metric; stays until G70 or a restart.", "G71\nX12.5Z2.5\nG70"),
    Entry("G72", "G72", "X words are diameters.", "G72\nX1.\nG73"),
    Entry("G73", "G73", "X words are radii; so at the start.", "G73\nX.5"),
    Entry("G90", "G90", "Absolute; G90 or G91 must stand on the first line.", "G90\nX.5Z0"),
    Entry("G91", "G91", "Incremental.", "G91\nX-.1\nG90"),
    Entry("G92", "G92XnZn", "The current point gets these coordinates; nothing moves.", "G92X.6Z.2"),
    Entry("G94", "G94Fn", "Feed in inches a minute.", "G94F5\nZ0"),
    Entry("G95", "G95Fn", "Feed in inches a revolution; the spindle must turn.", "G95F.003\nZ0"),
)

TOOLS = (
    Entry(
        "T",
        "Tn",
        "Offset n, 1 to 32; the next move says X and Z. T0 takes tool and shift away.",
        "T2\nX.6Z.1",
    ),
    Entry("D", "Dn", "Secondary offset n on this and later end points; D0 ends it.", "X.5Z0\nZ-.4D2\nX.55D0"),
    Entry("G10", "G10XnZn", "Adds to the work shift; acts at the next T.", "G10X0Z-.5\nT1\nX.6Z.1"),
    Entry("G40", "G40", "Nose compensation off; the move before it departs.", _COMPENSATED),
    Entry("G41", "G41", "Nose centre left of the path; the next line approaches, with D.", _COMPENSATED),
    Entry(
        "G42", "G42", "Nose centre right of the path.", "G00X.6Z-.5\nG42\nG01X.5D3\nX.4\nZ0\nX0\nG00Z.3\nG40"
    ),
)

SPINDLE = (
    Entry("S", "Sn", "Speed: rpm under G97, ft/min under G96.", "S1500"),
    Entry("M03", "M03Sn", "Spindle forward.", "M03S1200"),
    Entry("M04", "M04Sn", "Spindle backward.", "M04S800\nG04F2"),
    Entry("M05", "M05", "Spindle off; S is kept.", "M05"),
    Entry(
        "G96", "G96Sn", "Constant surface speed, ft/min: rpm follows the radius.", "G96S200\nX.3\nG97S1000"
    ),
    Entry("G97", "G97Sn", "S is rpm again.", "G97S900"),
    Entry("G76", "G76Sn", "Least rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000"),
    Entry("G77", "G77Sn", "Greatest rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000"),
    Entry(
        "G89",
        "G89",
        "Stop the spindle and lock it where it is, as M89.",
        f"{_SLOWLY}\nG89\nCI90S60\nG04F2\nM05",
    ),
    Entry("M19", "M19Sn", "Spindle to angle 0, locked, until M05.", f"{_SLOWLY}\nM19S60\nG04F3\nM05"),
    Entry("M89", "M89", "Stop the spindle and lock it where it is.", f"{_SLOWLY}\nM89\nCI45S60\nG04F2\nM05"),
    Entry("CA", "CAn", "Spindle to angle n.", f"{_SLOWLY}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05"),
    Entry(
        "CI",
        "CIn",
        "Spindle on by n degrees; the sign is the direction.",
        f"{_SLOWLY}\nM89\nCI-30S60\nG04F2\nM05",
    ),
)

CYCLE_ENTRIES = (
    Entry("G81", "G81ZnFn", "Drill to Z, rapid back.", "X0Z.1\nG81Z-.3F.004"),
    Entry("G83", "G83ZnKnFnRnLnCn", "Drill in pecks of K, clearing to R.", "X0Z.1\nG83Z-.65K.2F.004"),
    Entry(
        "G74",
        "G74XnZnInUnFn",
        "Rough a box in passes of I at most, leaving U in X.",
        "G74X.3Z-.5I.05U.01F.006",
    ),
    Entry(
        "G75",
        "G75InUnFnPn",
        "Rough to the contour that follows, up to RF.",
        f"G75I.05U.01F.006\n{_CONTOUR}\nRF",
    ),
    Entry("G78", "G78UnFnPn", "One pass along the contour, U away.", f"G78U.01F.004\n{_CONTOUR}\nRF"),
    Entry("RF", "RF", "Ends the contour of G75 and G78.", f"G78U.02F.004\n{_CONTOUR}\nRF"),
)

THREAD_ENTRIES = (
    Entry("G33", "G33XnZnInKnAnCnPO", "Thread in passes to X, lead K.", "X.24Z.2\nG33X.21Z-.5I.01K.05C"),
    Entry("G34", "G34ZnInKnAnPn", "One thread pass at this X.", "X.24Z.2\nG34Z-.5I.01K.05"),
    Entry("G35", "G35, G35F2", "Leads to 1 in, or 2; alone, then G92 of this point.", _COARSE),
    Entry("G36", "G36", "Ends G35, where it was begun; alone, then G92.", _COARSE),
)

FLOW = (
    Entry("LS", "LSn", "The lines up to LF n times.", "LS3\nG91\nZ-.1\nG90\nLF"),
    Entry("LF", "LF", "Ends a loop.", "LS2\nX.55\nX.6\nLF"),
    Entry("P", "Pn", "Runs subroutine n.", "P4", "}4\nX.55\nM99\n"),
    Entry("}", "}n", "Begins subroutine n, after the end of the program.", "M98P5", "}5\nX.55\nM99\n"),
    Entry("M98", "M98Pn", "Runs subroutine n.", "M98P2", "}2\nX.55\nM99\n"),
    Entry("M99", "M99", "Ends a subroutine.", "M98P3", "}3\nX.55\nM99\n"),
    Entry("M95", "M95", "Subroutine 1 if TB2-9 is closed.", "M95", "}1\nX.55\nM99\n"),
    Entry(
        "M97", "M97InCnPn", "Subroutine P if input I is on (C1) or off (C0).", "M97I10C1P6", "}6\nX.55\nM99\n"
    ),
    Entry("M91", "M91", "Waits until TB2-5 is open.", "M91"),
    Entry("M92", "M92", "Waits until TB2-5 is closed.", "M92"),
    Entry("M93", "M93", "Waits until TB2-7 is open.", "M93"),
    Entry("M94", "M94", "Waits until TB2-7 is closed.", "M94"),
    Entry("M00", "M00", "Stops; the comment says what the operator must do.", "M00(TURN THE PART ROUND)"),
    Entry("M01", "M01", "Stops when Optional Stop is on.", "M01(LOOK AT THE TOOL)"),
    Entry("M02", "M02", "Ends; M functions stay as they are.", "/M02"),
    Entry("M30", "M30", "Ends; M functions off. Repeats under Cycle Repeat.", "/M30"),
    Entry("M31", "M31", "Cancels Cycle Repeat.", "M31"),
    Entry("/", "/", "First on a line: skipped while Block Delete is on.", "/X.55"),
    Entry("()", "(text)", "Comment, shown to the operator from its line on.", "X.55(WATCH THE CHUCK)"),
)

MACHINE = (
    Entry("M08", "M08", "Coolant on.", "M08"),
    Entry("M09", "M09", "Coolant off.", "M09"),
    Entry("M12", "M12", "Clamps the collet.", "M12"),
    Entry("M13", "M13", "Unclamps the collet.", "M13\nG04F.5\nM12"),
)

PLANES = (
    Entry(
        "~PLXC",
        "(~PLXC) … (END)",
        "A mill on the face: X and Y across it, by X and C.",
        "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLXC)\n(X.25Y0)\n(X.25Y.2)\n(END)\nM28\nM05",
    ),
    Entry(
        "~PLZC",
        "(~PLZC) … (END)",
        "A mill on the side: X along, Y around it, by Z and C.",
        "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLZC)\n(D1.)\n(X.25Y.2)\n(X.5Y0)\n(END)\nM28\nM05",
    ),
)

CHAPTERS = (
    ("Moves and corners", MOVES),
    ("Modes", MODES),
    ("Tools, offsets, nose compensation", TOOLS),
    ("Spindle and C axis", SPINDLE),
    ("Cycles", CYCLE_ENTRIES),
    ("Threads", THREAD_ENTRIES),
    ("Flow", FLOW),
    ("The machine", MACHINE),
    ("Plane switching", PLANES),
)
