"""The codes of the OmniTurn control, each in one entry: form, words, what F means, group, bounds, refusals.

A code without an entry does not exist. ``handler`` names the function, by file and name in this room, that
carries it out; what a line does before and behind it is told by ``acts``. Where the entry is wrong or lacks
something, making it raises, or ``tests/interpreter/test_code_table.py`` fails. ``docs/language.md`` is the
page of this table (``language_page``), and its examples are proved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import cache, partial
from importlib import import_module
from typing import Any

HEAD = "G90G94F300\nT1\nM03S1000\nX.6Z.1\nG95F.004\n"
"""Before every example: radius mode, the tool at X.6 Z.1, .004 in/rev at 1000 rpm."""

TAIL = "G94F300X.6Z1\nM30\n"


class Acts(Enum):
    """What a code does on its line, and so when: see ``block_execution``."""

    PLAIN = auto()  # no code of its own: a straight move, or none
    WORD = auto()  # a letter
    MODE = auto()  # in force until another of its group
    FRAME = auto()  # its X and Z are no motion
    LOCK = auto()  # the spindle becomes the axis C; before the motion
    SPINDLE = auto()  # starts the spindle; before the motion
    START = auto()  # an M function before the motion
    ARC = auto()
    MOTION = auto()  # motion or rest of a kind of its own
    CYCLE = auto()  # a line that stands for many motions
    CONTOUR = auto()  # a cycle along the lines that follow it, or along a subroutine
    STOP = auto()  # an M function after the motion
    FLOW = auto()  # steers the order of execution


class FWord(Enum):
    """What F means on the line of a code."""

    NONE = auto()  # no F may stand there
    FEED = auto()  # the feed from here on
    SECONDS = auto()
    LEADS = auto()  # how coarse leads may be


class SWord(Enum):
    """What S means on the line of a code."""

    SPEED = auto()  # of the spindle, from here on
    LIMIT = auto()  # of constant surface speed, rpm
    C_SPEED = auto()  # rpm at which C turns


@dataclass(frozen=True, slots=True)
class Code:
    """One code. ``example``: lines that use it between ``HEAD`` and ``TAIL``; ``subroutine`` follows the end.

    ``words`` may stand beside it, G and M apart; ``bounds`` are least and greatest number of those of them
    that the control itself bounds, in their unit; ``refusals`` the diagnostic codes by which it is refused or
    warned of. Raises ValueError where words and the meaning of F contradict each other.
    """

    name: str
    form: str
    what: str
    example: str
    subroutine: str = ""
    acts: Acts = field(kw_only=True)
    handler: str = field(kw_only=True)
    f: FWord = field(kw_only=True)
    s: SWord = SWord.SPEED
    words: frozenset[str] = frozenset()
    group: str = ""  # one line may hold one mode of a group
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    terminal: tuple[str, bool] = ("", False)  # the input that it waits for or asks, and its wanted state
    least_blocks: int = 0  # elementary blocks that it makes at least
    ends_program: bool = False
    calls: bool = False  # a subroutine
    asks: bool = False  # calls only as an input says
    deletable: bool = True  # "/" may stand before it
    under_nose: bool = False  # may stand under G41 and G42 where it moves
    before_corner: bool = False  # may stand between a move with C or R and the next
    in_contour: bool = False  # may stand in the contour of G75 and G78
    not_in_mdi: str = ""  # why it means nothing on a line of its own
    refusals: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        if ("F" in self.words) is not (self.f is not FWord.NONE):
            raise ValueError(f"{self.name}: its words and what F means there contradict each other")
        if self.acts is Acts.MODE and not self.group:
            raise ValueError(f"{self.name}: a mode needs its group")

    @property
    def program(self) -> str:
        """The example as a whole program."""
        return f"{HEAD}{self.example}\n{TAIL}{self.subroutine}"


def names(text: str) -> frozenset[str]:
    """Names with blanks between them, as a set."""
    return frozenset(text.split())


PLAIN_WORDS = names("X Z C CA CI R F S T D")
"""Words of a line without a code of its own, and beside modes and M codes."""

PLAIN = Code(
    "", "", "", "", acts=Acts.PLAIN, handler="straight_moves.statement_move", words=PLAIN_WORDS, f=FWord.FEED
)  # fmt: skip

_CONTOUR = "X.2Z0\nX.3Z-.1\nZ-.3\nX.55Z-.5"
_COMPENSATED = "G00X0Z.2\nG41\nG01Z0D1\nX.4\nZ-.5\nX.55\nG00Z.5\nG40"
_COARSE = "S500\nG35\nG92X.6Z.1\nG33X.57Z-.5I.01K.4\nG36\nG92X.6Z.1"
_SLOWLY = "M05\nG94F30"  # before the spindle is made an axis

_CORNER = names("corner-both corner-next corner-size corner-straight corner-too-large")
_ARC = names(
    "arc-both arc-centre-missing arc-coordinate-missing arc-mode arc-no-chord arc-no-radius "
    "arc-r-sign arc-radius"
)
_NOSE = names(
    "comp-approach comp-gouge comp-no-radius comp-on comp-open comp-radius comp-subroutine comp-with "
    "not-alone"
)
_C_AXIS = names("c-too-little c-unlocked feed-over-speed finer-than-step number-missing word-twice")
_START = names("collet-open speed-missing spindle-locked")
_CYCLE = names("cycle-nose-comp feed-missing tool-first-move word-missing")
_CONTOUR_CYCLE = names(
    "contour-open corner-both corner-size cycle-contour-empty cycle-contour-line cycle-contour-long "
    "cycle-ignored cycle-length cycle-modes cycle-no-way cycle-nothing cycle-quadrant "
    "cycle-start-near cycle-undercut"
)
_THREAD = names(
    "feed-over-speed spindle-stopped thread-depth thread-lead-missing thread-lead-range thread-length "
    "thread-run-up thread-under-comp thread-under-css thread-word word-missing"
)
_PLANE = names(
    "arc-radius c-unlocked feed-missing feed-range plane-feed-mode plane-nose-comp plane-open "
    "plane-side plane-sign plane-word tool-first-move"
)
# What the entries of a kind have in common: beside modes and M codes stand the words of a plain line.
_mode = partial(Code, acts=Acts.MODE, words=PLAIN_WORDS, f=FWord.FEED)
_m_code = partial(Code, words=PLAIN_WORDS, f=FWord.FEED)
_letter = partial(Code, acts=Acts.WORD, f=FWord.NONE)
_flow = partial(Code, acts=Acts.FLOW, f=FWord.NONE)
# fmt: off
CHAPTERS: tuple[tuple[str, tuple[Code, ...]], ...] = (
    ("Moves and corners", (
        _mode("G00", "G00 XnZn", "Rapid from here on, at the first line's F.", "G00X.7\nZ.5",
            handler="feeds.feed_words", group="rapid", refusals=names("rapid-and-feed title-rapid")),
        _mode("G01", "G01 XnZn", "Back to the feed before the rapid.", "Z0\nG00Z.05\nG01Z-.2",
            handler="feeds.feed_words", group="rapid", refusals=names("no-cut-feed")),
        Code("G02", "G02XnZnRn or InKn", "Arc, clockwise seen from above.", "X.3Z0\nG02X.45Z-.15R.15",
            acts=Acts.ARC, handler="arc_moves.arc_move", words=names("X Z I K R F S T D"), f=FWord.FEED,
            least_blocks=1, under_nose=True, before_corner=True, in_contour=True, refusals=_ARC),
        Code("G03", "G03XnZnRn or InKn", "Arc, counter-clockwise.", "X.3Z-.2\nG03X.4Z-.3I.4K-.2",
            acts=Acts.ARC, handler="arc_moves.arc_move", words=names("X Z I K R F S T D"), f=FWord.FEED,
            least_blocks=1, under_nose=True, before_corner=True, in_contour=True, refusals=_ARC),
        Code("G04", "G04Fn", "Dwell n seconds, .1 at least.", "G04F.5",
            acts=Acts.MOTION, handler="dwell.dwell", words=names("F S T D"), f=FWord.SECONDS,
            bounds={"F": (0.1, 3600.0)}, least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            refusals=names("dwell-range dwell-too-short word-missing")),
        Code("F", "Fn", "Feed: in/min under G94, in/rev under G95.", "Z0F.002",
            acts=Acts.WORD, handler="feeds.feed_words", words=names("F"), f=FWord.FEED,
            refusals=names("feed-high feed-low feed-missing feed-range")),
        _letter("C", "XnZnCn", "Chamfer to the next straight line, set back n on both.",
            "X.3Z0\nX.5C.03\nZ-.3", handler="corners.read_corner", refusals=_CORNER),
        _letter("R", "XnZnRn", "Radius n tangent to this and the next straight line.", "X.3Z0\nX.5R.05\nZ-.3",
            handler="corners.read_corner", refusals=_CORNER | names("corner-without-move")),
    )),
    ("Modes", (
        _mode("G70", "G70", "Inch.", "G70\nX.5",
            handler="straight_moves.geometry_modes", group="units", refusals=names("finer-than-step")),
        _mode("G71", "G71", "Metric; stays until G70 or a restart.", "G71\nX12.5Z2.5\nG70",
            handler="straight_moves.geometry_modes", group="units", refusals=names("finer-than-step")),
        _mode("G72", "G72", "X words are diameters.", "G72\nX1.\nG73",
            handler="straight_moves.geometry_modes", group="X words"),
        _mode("G73", "G73", "X words are radii; so at the start.", "G73\nX.5",
            handler="straight_moves.geometry_modes", group="X words"),
        _mode("G90", "G90", "Absolute; G90 or G91 must stand on the first line.", "G90\nX.5Z0",
            handler="straight_moves.geometry_modes", group="distance", refusals=names("first-line")),
        _mode("G91", "G91", "Incremental.", "G91\nX-.1\nG90",
            handler="straight_moves.geometry_modes", group="distance", refusals=names("first-line")),
        Code("G92", "G92XnZn", "The current point gets these coordinates; nothing moves.", "G92X.6Z.2",
            acts=Acts.FRAME, handler="tools_and_offsets.preset", words=names("X Z F S T D"), f=FWord.FEED,
            least_blocks=1, before_corner=True, in_contour=True, refusals=names("word-missing")),
        _mode("G94", "G94Fn", "Feed in inches a minute.", "G94F5\nZ0",
            handler="feeds.feed_words", group="feed mode", refusals=names("feed-over-speed")),
        _mode("G95", "G95Fn", "Feed in inches a revolution; the spindle must turn.", "G95F.003\nZ0",
            handler="feeds.feed_words", group="feed mode", refusals=names("feed-over-speed spindle-stopped")),
    )),
    ("Tools, offsets, nose compensation", (
        _letter("T", "Tn", "Offset n, 1 to 32; the next move says X and Z. T0 takes tool and shift away.",
            "T2\nX.6Z.1", handler="tools_and_offsets.tool_change",
            refusals=names("coarse-tool tool-first-move tool-offset-missing tool-under-css")),
        _letter("D", "Dn", "Secondary offset n on this and later end points; D0 ends it.",
            "X.5Z0\nZ-.4D2\nX.55D0", handler="tools_and_offsets.secondary", refusals=names("comp-d")),
        Code("G10", "G10XnZn", "Adds to the work shift; acts at the next T.", "G10X0Z-.5\nT1\nX.6Z.1",
            acts=Acts.FRAME, handler="tools_and_offsets.work_shift", words=names("X Z F S T D"), f=FWord.FEED,
            least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            refusals=names("shift-without-tool word-missing")),
        Code("G40", "G40", "Nose compensation off; the move before it departs.", _COMPENSATED,
            acts=Acts.MODE, handler="nose_compensation.switch", group="nose compensation", f=FWord.NONE,
            not_in_mdi="ends nose compensation, which looks at the lines around it",
            refusals=names("comp-empty not-alone")),
        Code("G41", "G41", "Nose centre left of the path; the next line approaches, with D.", _COMPENSATED,
            acts=Acts.MODE, handler="nose_compensation.switch", group="nose compensation", f=FWord.NONE,
            not_in_mdi="begins nose compensation, which looks at the lines that follow", refusals=_NOSE),
        Code("G42", "G42", "Nose centre right of the path.",
            "G00X.6Z-.5\nG42\nG01X.5D3\nX.4\nZ0\nX0\nG00Z.3\nG40", acts=Acts.MODE,
            handler="nose_compensation.switch", group="nose compensation", f=FWord.NONE,
            not_in_mdi="begins nose compensation, which looks at the lines that follow", refusals=_NOSE),
    )),
    ("Spindle and C axis", (
        _letter("S", "Sn", "Speed: rpm under G97, ft/min under G96.", "S1500",
            handler="spindle_speed.speed_word", words=names("S"),
            refusals=names("speed-missing speed-range speed-sign")),
        _m_code("M03", "M03Sn", "Spindle forward.", "M03S1200",
            acts=Acts.SPINDLE, handler="spindle_speed.run_block", refusals=_START),
        _m_code("M04", "M04Sn", "Spindle backward.", "M04S800\nG04F2",
            acts=Acts.SPINDLE, handler="spindle_speed.run_block", refusals=_START),
        _m_code("M05", "M05", "Spindle off; S is kept.", "M05",
            acts=Acts.STOP, handler="spindle_speed.stop_block"),
        _mode("G96", "G96Sn", "Constant surface speed, ft/min: rpm follows the radius.",
            "G96S200\nX.3\nG97S1000", handler="spindle_speed.spindle_modes", group="spindle mode",
            refusals=names("speed-range surface-speed-missing")),
        _mode("G97", "G97Sn", "S is rpm again.", "G97S900",
            handler="spindle_speed.spindle_modes", group="spindle mode"),
        _mode("G76", "G76Sn", "Least rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000",
            handler="spindle_speed.spindle_modes", group="speed limits", s=SWord.LIMIT,
            refusals=names("speed-limits word-missing")),
        _mode("G77", "G77Sn", "Greatest rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000",
            handler="spindle_speed.spindle_modes", group="speed limits", s=SWord.LIMIT,
            refusals=names("speed-limits word-missing")),
        Code("G89", "G89", "Stop the spindle and lock it where it is, as M89.",
            f"{_SLOWLY}\nG89\nCI90S60\nG04F2\nM05", acts=Acts.LOCK, handler="c_axis.lock", words=names("S"),
            f=FWord.NONE, s=SWord.C_SPEED, before_corner=True,
            refusals=names("c-disabled not-alone speed-range")),
        _m_code("M19", "M19Sn", "Spindle to angle 0, locked, until M05.",
            f"{_SLOWLY}\nM19S60\nG04F3\nM05", acts=Acts.LOCK, handler="c_axis.lock", s=SWord.C_SPEED,
            refusals=names("c-disabled speed-range")),
        _m_code("M89", "M89", "Stop the spindle and lock it where it is.",
            f"{_SLOWLY}\nM89\nCI45S60\nG04F2\nM05", acts=Acts.LOCK, handler="c_axis.lock", s=SWord.C_SPEED,
            refusals=names("c-disabled speed-range")),
        _letter("CA", "CAn", "Spindle to angle n.", f"{_SLOWLY}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05",
            handler="c_axis.c_move", refusals=_C_AXIS),
        _letter("CI", "CIn", "Spindle on by n degrees; the sign is the direction.",
            f"{_SLOWLY}\nM89\nCI-30S60\nG04F2\nM05", handler="c_axis.c_move", refusals=_C_AXIS),
    )),
    ("Cycles", (
        Code("G81", "G81ZnFn", "Drill to Z, rapid back.", "X0Z.1\nG81Z-.3F.004",
            acts=Acts.CYCLE, handler="drilling_cycles.drill_moves", words=names("X Z F S"), f=FWord.FEED,
            least_blocks=2, refusals=_CYCLE | names("cycle-depth")),
        Code("G83", "G83ZnKnFnRnLnCn", "Drill in pecks of K, clearing to R.", "X0Z.1\nG83Z-.65K.2F.004",
            acts=Acts.CYCLE, handler="drilling_cycles.peck_moves", words=names("X Z C K R L F S"),
            f=FWord.FEED, least_blocks=2,
            refusals=_CYCLE | names("cycle-depth cycle-length cycle-passes cycle-rate cycle-retract")),
        Code("G74", "G74XnZnInUnFn", "Rough a box in passes of I at most, leaving U in X.",
            "G74X.3Z-.5I.05U.01F.006", acts=Acts.CYCLE, handler="roughing_cycles.box_moves",
            words=names("X Z I U F S"), f=FWord.FEED, least_blocks=4,
            refusals=_CYCLE | names("cycle-length cycle-nothing cycle-passes")),
        Code("G75", "G75InUnFnPn", "Rough to the contour that follows, up to RF.",
            f"G75I.05U.01F.006\n{_CONTOUR}\nRF", acts=Acts.CONTOUR, handler="roughing_cycles.contour_moves",
            words=names("I U P F S"), f=FWord.FEED, least_blocks=4,
            not_in_mdi="cuts a contour, and its lines would have to follow",
            refusals=_CYCLE | _CONTOUR_CYCLE | names("cycle-passes cycle-plunge")),
        Code("G78", "G78UnFnPn", "One pass along the contour, U away.", f"G78U.01F.004\n{_CONTOUR}\nRF",
            acts=Acts.CONTOUR, handler="roughing_cycles.contour_moves", words=names("U P F S"), f=FWord.FEED,
            least_blocks=3, not_in_mdi="cuts a contour, and its lines would have to follow",
            refusals=_CYCLE | _CONTOUR_CYCLE),
        _flow("RF", "RF", "Ends the contour of G75 and G78.", f"G78U.02F.004\n{_CONTOUR}\nRF",
            handler="loops_and_subroutines.Flow.contour", words=names("RF"), deletable=False,
            not_in_mdi="ends a contour, and there is none", refusals=names("rf-alone")),
    )),
    ("Threads", (
        Code("G33", "G33XnZnInKnAnCnPO", "Thread in passes to X, lead K.", "X.24Z.2\nG33X.21Z-.5I.01K.05C",
            acts=Acts.MOTION, handler="threading_cycles.thread_blocks",
            words=names("X Z C I K A P O F S T D"), f=FWord.FEED, bounds={"C": (0.0, 30.0)}, least_blocks=4,
            refusals=_THREAD | names("thread-angle thread-passes thread-side")),
        Code("G34", "G34ZnInKnAnPn", "One thread pass at this X.", "X.24Z.2\nG34Z-.5I.01K.05",
            acts=Acts.MOTION, handler="threading_cycles.thread_blocks", words=names("Z I K A P F S T D"),
            f=FWord.FEED, least_blocks=4, refusals=_THREAD),
        Code("G35", "G35, G35F2", "Leads to 1 in, or 2; alone, then G92 of this point.", _COARSE,
            acts=Acts.MODE, handler="coarse_feeds.coarse_line", group="coarse feed", words=names("F"),
            f=FWord.LEADS, bounds={"F": (2, 2)}, not_in_mdi="needs a G92 on the next line",
            refusals=names("coarse-order coarse-preset coarse-range not-alone")),
        Code("G36", "G36", "Ends G35, where it was begun; alone, then G92.", _COARSE,
            acts=Acts.MODE, handler="coarse_feeds.coarse_line", group="coarse feed", f=FWord.NONE,
            not_in_mdi="needs a G92 on the next line",
            refusals=names("coarse-order coarse-place coarse-preset not-alone")),
    )),
    ("Flow", (
        _flow("LS", "LSn", "The lines up to LF n times.", "LS3\nG91\nZ-.1\nG90\nLF",
            handler="loops_and_subroutines.Flow.steer", words=names("LS"), deletable=False,
            not_in_mdi="begins a loop, and its lines and LF would have to follow",
            refusals=names("loop-open word-missing")),
        _flow("LF", "LF", "Ends a loop.", "LS2\nX.55\nX.6\nLF",
            handler="loops_and_subroutines.Flow.steer", words=names("LF"), deletable=False,
            not_in_mdi="ends a loop, and there is none", refusals=names("loop-unopened")),
        _flow("P", "Pn", "Runs subroutine n.", "P4", "}4\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("P"), calls=True,
            not_in_mdi="calls a subroutine, and those stand in programs",
            refusals=names("recursion subroutine-missing")),
        _flow("}", "}n", "Begins subroutine n, after the end of the program.", "M98P5", "}5\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.steer", words=names("}"), deletable=False,
            not_in_mdi="begins a subroutine, and those stand in programs",
            refusals=names("subroutine-open subroutine-twice word-missing")),
        _flow("M98", "M98Pn", "Runs subroutine n.", "M98P2", "}2\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("P M"), calls=True,
            not_in_mdi="calls a subroutine, and those stand in programs",
            refusals=names("recursion subroutine-missing")),
        _flow("M99", "M99", "Ends a subroutine.", "M98P3", "}3\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.steer", words=names("M"), deletable=False,
            not_in_mdi="ends a subroutine, and there is none", refusals=names("m99-outside")),
        _flow("M95", "M95", "Subroutine 1 if TB2-9 is closed.", "M95", "}1\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("M"), terminal=("TB2-9", True), calls=True,
            asks=True, not_in_mdi="calls a subroutine, and those stand in programs",
            refusals=names("recursion subroutine-missing")),
        _flow("M97", "M97InCnPn", "Subroutine P if input I is on (C1) or off (C0).", "M97I10C1P6",
            "}6\nX.55\nM99\n", handler="loops_and_subroutines.Flow.call", words=names("C I P M"),
            bounds={"C": (0, 1)}, calls=True, asks=True,
            not_in_mdi="calls a subroutine, and those stand in programs",
            refusals=names("condition input-number recursion subroutine-missing")),
        _m_code("M91", "M91", "Waits until TB2-5 is open.", "M91",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-5", False)),
        _m_code("M92", "M92", "Waits until TB2-5 is closed.", "M92",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-5", True)),
        _m_code("M93", "M93", "Waits until TB2-7 is open.", "M93",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-7", False)),
        _m_code("M94", "M94", "Waits until TB2-7 is closed.", "M94",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-7", True)),
        _m_code("M00", "M00", "Stops; the comment says what the operator must do.",
            "M00(TURN THE PART ROUND)", acts=Acts.STOP, handler="m_codes.program_stop"),
        _m_code("M01", "M01", "Stops when Optional Stop is on.", "M01(LOOK AT THE TOOL)",
            acts=Acts.STOP, handler="m_codes.program_stop"),
        _m_code("M02", "M02", "Ends; M functions stay as they are.", "/M02",
            acts=Acts.STOP, handler="m_codes.program_end", ends_program=True,
            refusals=names("after-end no-end")),
        _m_code("M30", "M30", "Ends; M functions off. Repeats under Cycle Repeat.", "/M30",
            acts=Acts.STOP, handler="m_codes.program_end", ends_program=True,
            refusals=names("after-end no-end")),
        _m_code("M31", "M31", "Cancels Cycle Repeat.", "M31",
            acts=Acts.STOP, handler="m_codes.repeat_off"),
        _letter("/", "/", "First on a line: skipped while Block Delete is on.", "/X.55",
            handler="omniturn_statement.statement"),
        _letter("()", "(text)", "Comment, shown to the operator from its line on.", "X.55(WATCH THE CHUCK)",
            handler="omniturn_statement.statement"),
    )),
    ("The machine", (
        _m_code("M08", "M08", "Coolant on.", "M08", acts=Acts.START, handler="m_codes.coolant"),
        _m_code("M09", "M09", "Coolant off.", "M09", acts=Acts.STOP, handler="m_codes.coolant"),
        _m_code("M12", "M12", "Clamps the collet.", "M12", acts=Acts.START, handler="m_codes.collet"),
        _m_code("M13", "M13", "Unclamps the collet.", "M13\nG04F.5\nM12",
            acts=Acts.START, handler="m_codes.collet", refusals=names("unclamp-turning")),
    )),
    ("Plane switching", (
        _flow("~PLXC", "(~PLXC) … (END)", "A mill on the face: X and Y across it, by X and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLXC)\n(X.25Y0)\n(X.25Y.2)\n(END)\nM28\nM05",
            handler="plane_switching.plane_line",
            not_in_mdi="belongs to plane switching, whose lines would have to follow",
            refusals=_PLANE | names("plane-centre plane-h-late plane-reach")),
        _flow("~PLZC", "(~PLZC) … (END)", "A mill on the side: X along, Y around it, by Z and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLZC)\n(D1.)\n(X.25Y.2)\n(X.5Y0)\n(END)\nM28\nM05",
            handler="plane_switching.plane_line",
            not_in_mdi="belongs to plane switching, whose lines would have to follow",
            refusals=_PLANE | names("plane-d-late plane-diameter")),
    )),
)
"""All codes in the order of the page: the title of each chapter, and its codes."""
# fmt: on

G_CODES = {int(code.name[1:]): code for _, codes in CHAPTERS for code in codes if code.name[0] == "G"}
"""By number. Modes and one-shot codes: the latter act on their own line alone, and a line may hold one."""

M_CODES = {
    int(code.name[1:]): code
    for _, codes in CHAPTERS
    for code in codes
    if code.name[0] == "M" and code.acts is not Acts.FLOW
}
"""M codes of the control itself, by number; all others are the machine file's."""

FLOW_CODES = {code.name: code for _, codes in CHAPTERS for code in codes if code.acts is Acts.FLOW}
"""What steers the order of execution; ``words`` is exactly what stands on such a line."""


def carry_out(code: Code) -> Callable[..., Any]:
    """The function that carries a code out; its file is loaded when the first program needs it."""
    return _function(code.handler)


@cache
def _function(handler: str) -> Callable[..., Any]:
    file, *path = handler.split(".")
    found: Any = import_module(f"{__package__}.{file}")
    for name in path:
        found = getattr(found, name)
    function: Callable[..., Any] = found
    return function
