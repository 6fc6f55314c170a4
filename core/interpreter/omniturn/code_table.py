"""The codes of the OmniTurn control, each in one entry: form, words, what F means, group, bounds, refusals.

A code without an entry does not exist. ``handler`` names the function, by file and name in this room, that
carries it out; what a line does before and behind it is told by ``acts``. Where the entry is wrong or lacks
something, making it raises, or ``tests/interpreter/test_code_table.py`` fails. ``docs/language.md`` is the
page of this table (``language_page``), and its examples are proved.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from importlib import import_module
from math import inf
from typing import Any

from core.interpreter.omniturn.code_entry import (
    Acts,
    Code,
    FWord,
    Limit,
    Refusal,
    SWord,
    Together,
    When,
    WordRule,
    names,
)

PLAIN_WORDS = names("X Z C CA CI R F S T D")
"""Words of a line without a code of its own, and beside modes and M codes."""

PLAIN = Code(
    "", "", "", "", acts=Acts.PLAIN, handler="straight_moves.statement_move", words=PLAIN_WORDS, f=FWord.FEED
)  # fmt: skip

_CONTOUR = "X.2Z0\nX.3Z-.1\nZ-.3\nX.55Z-.5"
_COMPENSATED = "G00X0Z.2\nG41\nG01Z0D1\nX.4\nZ-.5\nX.55\nG00Z.5\nG40"
_COARSE = "S500\nG35\nG92X.6Z.1\nG33X.57Z-.5I.01K.4\nG36\nG92X.6Z.1"
_SLOWLY = "M05\nG94F30"  # before the spindle is made an axis

# fmt: off
# Sentences and rules that several entries share.
_CORNER_BOTH = Refusal("corner-both", "The line has both C and R.", "Keep only one of the conflicting words.")
_CORNER_SIZE = WordRule(
    "the corner size", least=0, over=True,
    wrong=Refusal(
        "corner-size",
        "{word}: the corner size must be a number greater than 0.",
            "Write the size as a number greater than 0."
    ),
)
_CORNER = names("corner-next corner-straight corner-too-large")
_ARC_MODE = Refusal(
    "arc-mode", "Arcs cannot be incremental in diameter mode.", "Use G90 or G73 for the arc."
)
_ARC_BOTH = Refusal("arc-both",
"The arc has both R and {letter}.", "Use either R, or I and K.")
_arc = partial(
    Code, acts=Acts.ARC, handler="arc_moves.arc_move", words=names("X Z I K R F S T D"), f=FWord.FEED,
    rules={
        "R": WordRule("the radius", least=0, over=True, wrong=Refusal(
            "arc-r-sign", "R must be greater than 0.", "Use I and K for larger arcs.", "R")),
    },
    one_of=Together(("R", "I", "K"), Refusal(
        "arc-centre-missing", "The arc has neither R nor I and K.", "Add R, or I and K.")),
    apart=(Together(("R", "I"), _ARC_BOTH), Together(("R", "K"), _ARC_BOTH)),
    not_when={When.INCREMENTAL_DIAMETERS: _ARC_MODE},
    least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
    further=names("arc-coordinate-missing arc-no-chord arc-no-radius arc-over-half arc-radius"),
)
_PLACE = Together(
    ("X", "Z"), Refusal("word-missing", "G{number} needs X or Z.", "Write the coordinates.")
)
_ALONE = Refusal(
    "not-alone",
    "G{number} must be alone on its line.",
    "Write the other words on a separate line.", 1
)
_nose_on = partial(
    Code, acts=Acts.MODE, handler="nose_compensation.switch", group="nose compensation", f=FWord.NONE,
    not_in_mdi=
                "{code} cannot start nose compensation in MDI, because nose compensation needs more "
                "than one line.",
    not_when={
        When.WITH_OTHERS: _ALONE,
        When.NOSE_COMPENSATION: Refusal(
            "comp-on",
            "G{number} is not allowed while G{on} is active.",
            "End G{on} first: move off the part, then write G40.", 1),
    },
    further=names("comp-approach comp-gouge comp-no-radius comp-open comp-radius comp-subroutine comp-with"),
)
_start = partial(
    Code, acts=Acts.SPINDLE, handler="spindle_speed.run_block", words=PLAIN_WORDS, f=FWord.FEED,
    not_when={
        When.C_LOCKED: Refusal(
            "spindle-locked",
            "M{number} starts the spindle, but the spindle is locked as the C axis.",
            "Release the spindle with M05 first.", "M"),
        When.NO_SPEED: Refusal(
            "speed-missing",
            "M{number} starts the spindle, but no spindle speed S is programmed.",
            "Write S on this line.", "M"),
        When.COLLET_OPEN: Refusal(
            "collet-open", "M{number} starts the spindle with the collet open.",
            "Close the collet with M12 first.", "M"),
    },
)
_SPEED_SIGN = Refusal(
    "speed-sign",
    "{word}: spindle speed cannot be negative; M03 and M04 set the direction.", "Remove the sign."
)
_SPEED_LIMIT = WordRule(
    "rpm", least=0,
    missing=Refusal("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
    wrong=Refusal("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
)
_C_SPEED = WordRule(
            "C axis speed in rpm, without a sign", least=0, over=True, most=Limit.C_RPM,
    wrong=Refusal("speed-range",
    "{word}: the C axis speed must be above 0 and at most {most} rpm.", "Correct S."),
)
_NO_C = Refusal(
    "c-disabled",
    "{name} needs a C axis, but the C axis is disabled in the machine file.",
            "Enable the C axis (axis.C.enabled)."
)
_ANGLE = WordRule(
    "angle in degrees; absolute (like CA) under G90, incremental (like CI) under G91",
    numberless=Refusal("number-missing", "{word} has no number.", "Write the angle in degrees."),
)
_c_word = partial(
    Code, acts=Acts.WORD, f=FWord.NONE, handler="c_axis.c_move",
    apart=(Together(("C", "CA", "CI"), Refusal(
        "word-twice",
        "The line contains both {first} and {word}.", "Keep only one of the conflicting words.")),),
    not_when={When.C_FREE: Refusal(
        "c-unlocked",
        "{word} rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 or M89 before this line.")},
    further=names("c-too-little feed-over-speed finer-than-step speed-missing"),
)
_NOT_READY = {
    When.NOSE_COMPENSATION: Refusal(
        "cycle-nose-comp", "{code} cannot run while nose compensation is active.",
            "Write G40 and a departure move before the cycle."),
    When.TOOL_NOT_MOVED: Refusal(
        "tool-first-move",
        "{code} is the first move after the T word on line {line}, so its start point is unknown.",
            "Program a move to X and Z of the start point before the cycle."),
    When.NO_FEED: Refusal(
        "feed-missing",
        "{code}: no cutting feed is active.", "Write F on the {code} line."),
}
"""A cycle begins at a known point with a known feed."""
_LENGTH = partial(
    WordRule, least=0, over=True,
    wrong=Refusal(
        "cycle-length",
        "{word}: {letter} ({what}) must be greater than 0.", "Write {letter} with a number greater than 0."),
)
_NEEDS = Refusal("word-missing", "{code} needs {letter}, {what}.", "Add {letter}.")
_needed = partial(_LENGTH, missing=_NEEDS)
_DEPTH = WordRule(
    "the bottom of the hole",
    missing=Refusal("word-missing", "{code} needs Z, the bottom of the hole.", "Add Z."),
)
_OPPOSITE = WordRule(
            "the corner opposite the start point",
    missing=Refusal(
        "word-missing",
        "{code} needs the {letter} coordinate of the corner opposite the start point.", "Add {letter}."),
)
_CUT = _needed("the maximum depth of cut")
_LEFT = WordRule(
            "the stock that the cycle leaves per side", least=0,
    wrong=Refusal(
        "cycle-length",
        "{word}: U, the stock that the cycle leaves per side, cannot be negative.",
        "Remove the sign."),
)
_DESCRIBED = WordRule(
    "the subroutine that describes the contour",
    numberless=Refusal(
        "word-missing",
        "P must be followed by the number of the subroutine that describes the contour.",
            "Write the number of the subroutine after P."),
)
_contour = partial(
    Code, acts=Acts.CONTOUR, handler="roughing_cycles.contour_moves", f=FWord.FEED, not_when=_NOT_READY,
    not_in_mdi=
                "{code} cannot cut a contour in MDI, because a contour needs more than one line.",
)
_CONTOUR_CYCLE = names(
    "contour-open corner-both corner-size cycle-contour-empty cycle-contour-line cycle-contour-long "
    "cycle-ignored cycle-modes cycle-no-way cycle-nothing cycle-quadrant "
    "cycle-start-near cycle-undercut"
)
_LEAD = WordRule(
    "the lead", least=0, over=True, most=Limit.LEAD,
    missing=Refusal(
        "thread-lead-missing", "K, the lead, is missing.", "Write K, the lead per revolution.", "F"),
    wrong=Refusal(
        "thread-lead-range", "{word}: the lead must be above 0 and at most {most}.", "Correct K."),
)
_FIRST_PASS = partial(
    WordRule, "the depth of the first pass", least=0, over=True,
    missing=Refusal("thread-depth",
    "I, the depth of the first pass, is missing.", "Write I, the depth of the first pass."),
    wrong=Refusal(
        "thread-depth", "I, the depth of the first pass, must be above 0.",
        "Write I, the depth of the first pass.", "I"),
)
_PULL_OUT = WordRule(
    "the pull-out from the thread",
    numbered=Refusal(
        "thread-word",
        "{word}: {letter} must not have a number in this line.",
            "Write {letter} without a number."),
)
_END = WordRule(
    "the end of the thread",
    missing=Refusal("word-missing", "Z, the end of the thread, is missing.", "Write Z."),
)
_thread = partial(
    Code, acts=Acts.MOTION, handler="threading_cycles.thread_blocks", f=FWord.FEED, least_blocks=4,
    not_when={
        When.SURFACE_SPEED: Refusal(
            "thread-under-css",
            "G96 is active, but a thread needs the same spindle speed from the first pass to "
            "the last.",
            "Write G97S before the thread line."),
        When.NOSE_COMPENSATION: Refusal(
            "thread-under-comp",
            "G{on} is active, but a thread cannot be cut with nose compensation.",
            "Write G40 before this line."),
        When.STANDING: Refusal(
            "spindle-stopped",
            "The spindle is stopped, but it must turn to cut a thread.",
            "Start the spindle with M03 or M04."),
    },
)
_coarse = partial(
    Code, acts=Acts.MODE, handler="coarse_feeds.coarse_line", group="coarse feed",
    not_in_mdi="{code} needs a G92 on the next line, but MDI runs only one line.",
)
_COARSE_ALONE = Refusal(
    "not-alone",
    "G{number} must be alone on its line.",
    "Write the other words on a separate line.", 1
)
_plane = partial(
    Code, acts=Acts.FLOW, f=FWord.NONE, handler="plane_switching.plane_line",
    not_in_mdi=
                "{code} cannot be used in MDI, because plane switching needs more than one line.",
    not_when={
        When.C_FREE: Refusal(
            "c-unlocked",
            "(~{name}) rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 before the (~PLXC) or (~PLZC) line.", 1),
        When.PER_REV: Refusal(
            "plane-feed-mode",
            "(~{name}) needs a feed in inches per minute, but G95 is active.",
            "Write G94 with F before the (~PLXC) or (~PLZC) line.", 1),
        When.NOSE_COMPENSATION: Refusal(
            "plane-nose-comp",
            "(~{name}) cannot run while nose compensation is active.",
            "Write G40 before the (~PLXC) or (~PLZC) line.", 1),
        When.TOOL_NOT_MOVED: Refusal(
            "tool-first-move",
            "No X and Z move is programmed after the T word on line {line}.",
            "Program a move to X and Z before the (~PLXC) or (~PLZC) line.", 1),
    },
)
_PLANE = names("arc-radius feed-missing feed-range plane-open plane-side plane-sign plane-word")
# What the entries of a kind have in common: beside modes and M codes stand the words of a plain line.
_mode = partial(Code, acts=Acts.MODE, words=PLAIN_WORDS, f=FWord.FEED)
_m_code = partial(Code, words=PLAIN_WORDS, f=FWord.FEED)
_letter = partial(Code, acts=Acts.WORD, f=FWord.NONE)
_flow = partial(Code, acts=Acts.FLOW, f=FWord.NONE)
CHAPTERS: tuple[tuple[str, tuple[Code, ...]], ...] = (
    ("Moves and corners", (
        _mode("G00", "G00 XnZn",
                "From here on, all moves are rapid moves; the rapid rate is the F in the first "
                "line of the program.", "G00X.7\nZ.5",
            handler="feeds.feed_words", group="rapid", further=names("title-rapid"),
            not_when={When.WITH_FEED: Refusal(
                "rapid-and-feed",
                "G00 cannot be combined with F, G94 or G95, because each of these words "
                "cancels the rapid mode.",
                "Split the line.", 1)}),
        _mode("G01", "G01 XnZn",
        "Returns to the feed that was active before the rapid.", "Z0\nG00Z.05\nG01Z-.2",
            handler="feeds.feed_words", group="rapid",
            not_when={When.NO_CUT_FEED: Refusal(
                "no-cut-feed",
                "G01 returns to the last cutting feed, but no cutting feed has been set after "
                "the first line.",
                "Set a cutting feed with G95Fn or G94Fn.", 1)}),
        _arc("G02", "G02XnZnRn or InKn", "Clockwise arc, as seen from above.", "X.3Z0\nG02X.45Z-.15R.15"),
        _arc("G03", "G03XnZnRn or InKn", "Counterclockwise arc.", "X.3Z-.2\nG03X.4Z-.3I.4K-.2"),
        Code("G04", "G04Fn",
        "Dwell of n seconds; the minimum is 0.1 s.", "G04F.5",
            acts=Acts.MOTION, handler="dwell.dwell", words=names("F S T D"), f=FWord.SECONDS,
            rules={"F": WordRule(
                "seconds", least=0.1,
                missing=Refusal("word-missing", "G04 does not contain a dwell time.",
            "Write G04F with the time in seconds."),
                wrong=Refusal(
                    "dwell-range", "G04F{value} is too short: the shortest dwell is 0.1 s.", "Correct F."))},
            least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            further=names("dwell-long dwell-too-short")),
        Code("F", "Fn", "Feed: in/min under G94, in/rev under G95.", "Z0F.002",
            acts=Acts.WORD, handler="feeds.feed_words", words=names("F"), f=FWord.FEED,
            rules={"F": WordRule(
                "feed in inches per minute or per revolution", least=0.00005, most=Limit.FEED_IN_FORCE,
                wrong=Refusal(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Raise F."),
                too_great=Refusal(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Lower F."))},
            further=names("feed-high feed-low feed-missing")),
        _letter("C", "XnZnCn",
        "Chamfer to the next straight line, set back by n on both lines.",
            "X.3Z0\nX.5C.03\nZ-.3", handler="corners.read_corner", rules={"C": _CORNER_SIZE},
            apart=(Together(("R", "C"), _CORNER_BOTH),), further=_CORNER),
        _letter("R", "XnZnRn",
        "Corner radius n, tangent to this straight line and the next one.", "X.3Z0\nX.5R.05\nZ-.3",
            handler="corners.read_corner", rules={"R": _CORNER_SIZE},
            apart=(Together(("R", "C"), _CORNER_BOTH),), further=_CORNER,
            not_when={When.NO_STRAIGHT_MOVE: Refusal(
                "corner-without-move",
                "{word} programs a corner at the end of a straight move, but the line does not "
                "contain a straight move.",
            "Write the chamfer or radius on the line with X or Z.")}),
    )),
    ("Modes", (
        _mode("G70", "G70", "Inches.", "G70\nX.5",
            handler="straight_moves.geometry_modes", group="units", further=names("finer-than-step")),
        _mode("G71", "G71",
        "Metric units, active until G70 or a restart.", "G71\nX12.5Z2.5\nG70",
            handler="straight_moves.geometry_modes", group="units", further=names("finer-than-step")),
        _mode("G72", "G72", "X words are diameters.", "G72\nX1.\nG73",
            handler="straight_moves.geometry_modes", group="X words"),
        _mode("G73", "G73",
        "X words are radii; this is the setting at program start.", "G73\nX.5",
            handler="straight_moves.geometry_modes", group="X words"),
        _mode("G90", "G90",
        "Absolute positions; the first line must contain G90 or G91.", "G90\nX.5Z0",
            handler="straight_moves.geometry_modes", group="distance", further=names("first-line")),
        _mode("G91", "G91", "Incremental.", "G91\nX-.1\nG90",
            handler="straight_moves.geometry_modes", group="distance", further=names("first-line")),
        Code("G92", "G92XnZn", "Sets the coordinates of the current point; no axis moves.", "G92X.6Z.2",
            acts=Acts.FRAME, handler="tools_and_offsets.preset", words=names("X Z F S T D"), f=FWord.FEED,
            one_of=_PLACE, least_blocks=1, before_corner=True, in_contour=True,
            further=names("preset-thread")),
        _mode("G94", "G94Fn", "Feed in inches per minute.", "G94F5\nZ0",
            handler="feeds.feed_words", group="feed mode", further=names("feed-over-speed")),
        _mode("G95", "G95Fn",
        "Feed in inches per revolution; the spindle must be turning.", "G95F.003\nZ0",
            handler="feeds.feed_words", group="feed mode", further=names("feed-over-speed spindle-stopped")),
    )),
    ("Tools, offsets, nose compensation", (
        _letter("T", "Tn",
        "Tool offset n, from 1 to 32; the next move must contain X and Z. T0 cancels "
        "the tool offset and the work shift.",
            "T2\nX.6Z.1", handler="tools_and_offsets.tool_change",
            not_when={When.COARSE: Refusal(
                "coarse-tool",
                "T is not allowed between G35 and G36.", "Write G36 before the T word.", "T")},
            further=names("tool-first-move tool-offset-missing tool-under-css")),
        _letter("D", "Dn",
        "Applies secondary offset n at this end point and at all later end points; D0 "
        "cancels the offset.",
            "X.5Z0\nZ-.4D2\nX.55D0", handler="tools_and_offsets.secondary", further=names("comp-d")),
        Code("G10", "G10XnZn",
            "Adds X and Z to the work shift; the new shift takes effect at the next T word.",
            "G10X0Z-.5\nT1\nX.6Z.1",
            acts=Acts.FRAME, handler="tools_and_offsets.work_shift", words=names("X Z F S T D"), f=FWord.FEED,
            one_of=_PLACE, least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            further=names("shift-without-tool")),
        Code("G40", "G40",
        "Turns nose compensation off; the preceding move is the departure from the "
        "contour.", _COMPENSATED,
            acts=Acts.MODE, handler="nose_compensation.switch", group="nose compensation", f=FWord.NONE,
            not_in_mdi=
                "{code} cannot end nose compensation in MDI, because nose compensation needs more than "
                "one line.",
            not_when={When.WITH_OTHERS: _ALONE}, further=names("comp-empty")),
        _nose_on("G41", "G41",
        "Turns nose compensation on, with the nose center to the left of the path. The "
        "next line is the approach and must contain D.",
            _COMPENSATED),
        _nose_on("G42", "G42", "Turns nose compensation on, with the nose center to the right of the path.",
            "G00X.6Z-.5\nG42\nG01X.5D3\nX.4\nZ0\nX0\nG00Z.3\nG40"),
    )),
    ("Spindle and C axis", (
        _letter("S", "Sn", "Spindle speed in rpm with G97, surface speed in ft/min with G96.", "S1500",
            handler="spindle_speed.speed_word", words=names("S"),
            rules={"S": WordRule(
                "rpm", least=0, most=Limit.RPM, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word} is above the spindle maximum of {most} rpm.", "Lower S."))}),
        _start("M03", "M03Sn", "Spindle forward.", "M03S1200"),
        _start("M04", "M04Sn", "Spindle reverse.", "M04S800\nG04F2"),
        _m_code("M05", "M05",
        "Turns the spindle off; the S value is retained.", "M05",
            acts=Acts.STOP, handler="spindle_speed.stop_block"),
        _mode("G96", "G96Sn", "Constant surface speed in ft/min; the rpm changes with the radius.",
            "G96S200\nX.3\nG97S1000", handler="spindle_speed.spindle_modes", group="spindle mode",
            rules={"S": WordRule(
                "surface speed in ft/min, or in m/min with G71",
                least=0, most=Limit.SURFACE, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word}: this surface speed is too high for any tool.", "Write G97 if S is in rpm."))},
            further=names("surface-speed-missing")),
        _mode("G97", "G97Sn", "S is in rpm again.", "G97S900",
            handler="spindle_speed.spindle_modes", group="spindle mode"),
        _mode("G76", "G76Sn", "Minimum rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000",
            handler="spindle_speed.spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        _mode("G77", "G77Sn", "Maximum rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000",
            handler="spindle_speed.spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        Code("G89", "G89",
        "Stops the spindle and locks it in place, like M89.",
            f"{_SLOWLY}\nG89\nCI90S60\nG04F2\nM05", acts=Acts.LOCK, handler="c_axis.lock", words=names("S"),
            f=FWord.NONE, s=SWord.C_SPEED, before_corner=True, rules={"S": _C_SPEED},
            not_when={When.NO_C: _NO_C, When.WITH_M: Refusal(
                "not-alone",
                "G89 locks the spindle and cannot be combined with M codes.", "Split the line.")}),
        _m_code("M19", "M19Sn",
        "Turns the spindle to angle 0 and locks it until M05.",
            f"{_SLOWLY}\nM19S60\nG04F3\nM05", acts=Acts.LOCK, handler="c_axis.lock", s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        _m_code("M89", "M89",
        "Stops the spindle and locks it in place.",
            f"{_SLOWLY}\nM89\nCI45S60\nG04F2\nM05", acts=Acts.LOCK, handler="c_axis.lock", s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        _c_word("CA", "CAn", "Turns the spindle to angle n.",
            f"{_SLOWLY}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05",
            rules={"C": _ANGLE, "S": _C_SPEED}),
        _c_word("CI", "CIn",
        "Turns the spindle by n degrees; the sign sets the direction.",
            f"{_SLOWLY}\nM89\nCI-30S60\nG04F2\nM05", rules={"C": _ANGLE, "S": _C_SPEED}),
    )),
    ("Cycles", (
        Code("G81", "G81ZnFn",
        "Drills to Z, then retracts at rapid.", "X0Z.1\nG81Z-.3F.004",
            acts=Acts.CYCLE, handler="drilling_cycles.drill_moves", words=names("X Z F S"), f=FWord.FEED,
            not_when=_NOT_READY, rules={"Z": _DEPTH}, least_blocks=2, further=names("cycle-depth")),
        Code("G83", "G83ZnKnFnRnLnCn", "Drills in pecks of K, retracting to R.", "X0Z.1\nG83Z-.65K.2F.004",
            acts=Acts.CYCLE, handler="drilling_cycles.peck_moves", words=names("X Z C K R L F S"),
            f=FWord.FEED, not_when=_NOT_READY, least_blocks=2,
            rules={
                "Z": _DEPTH,
                "K": _needed("the depth of one peck"),
                "L": WordRule("the retract rate", least=0, over=True, most=Limit.FEED, wrong=Refusal(
                    "cycle-rate",
                    "{word}: the retract rate must be above 0 and at most {most}.",
                    "Correct L.")),
                    "C": _LENGTH("the distance before the cut at which the feed begins", numberless=_NEEDS),
            },
            further=names("cycle-depth cycle-passes cycle-retract peck-depth")),
        Code("G74", "G74XnZnInUnFn",
        "Roughs a rectangle in passes of at most I, leaving an allowance of U in X.",
            "G74X.3Z-.5I.05U.01F.006", acts=Acts.CYCLE, handler="roughing_cycles.box_moves",
            words=names("X Z I U F S"), f=FWord.FEED, not_when=_NOT_READY, least_blocks=4,
            rules={"X": _OPPOSITE, "Z": _OPPOSITE, "I": _CUT, "U": _LEFT},
            further=names("cycle-nothing cycle-passes")),
        _contour("G75", "G75InUnFnPn",
        "Roughs the contour on the following lines, which end with RF.",
            f"G75I.05U.01F.006\n{_CONTOUR}\nRF", words=names("I U P F S"), least_blocks=4,
            rules={"P": _DESCRIBED, "I": _CUT, "U": _LEFT},
            further=_CONTOUR_CYCLE | names("cycle-passes cycle-plunge")),
        _contour("G78", "G78UnFnPn",
        "Cuts one pass along the contour at a distance of U.", f"G78U.01F.004\n{_CONTOUR}\nRF",
            words=names("U P F S"), least_blocks=3, rules={"P": _DESCRIBED, "U": _LEFT},
            further=_CONTOUR_CYCLE),
        _flow("RF", "RF", "Ends the contour description for G75 and G78.", f"G78U.02F.004\n{_CONTOUR}\nRF",
            handler="loops_and_subroutines.Flow.contour", words=names("RF"), deletable=False,
            not_in_mdi=
                "{code} ends a contour, but no contour was started.", further=names("rf-alone")),
    )),
    ("Threads", (
        _thread("G33", "G33XnZnInKnAnCnPO",
        "Cuts a thread in passes to X with lead K.", "X.24Z.2\nG33X.21Z-.5I.01K.05C",
            words=names("X Z C I K A P O F S T D"),
            rules={
                "X": WordRule("the position of the last pass", missing=Refusal(
                    "word-missing",
                    "X, the position of the last pass, is missing.", "Write X.")),
                    "Z": _END,
                    "I": _FIRST_PASS(),
                    "K": _LEAD,
                    "C": WordRule("infeed angle in degrees", least=0, most=30, bare=29, wrong=Refusal(
                    "thread-angle",
                    "{word}: the infeed angle must be from 0 to 30 degrees.",
            "Correct the C word; C without a number means 29 degrees.")),
            "P": _PULL_OUT,
            "O": WordRule("the last pass only"),
            },
            further=names("feed-over-speed thread-angle thread-length thread-passes thread-run-up "
                "thread-side")),
        _thread("G34", "G34ZnInKnAnPn",
        "Cuts one thread pass at the current X.", "X.24Z.2\nG34Z-.5I.01K.05",
            words=names("Z I K A P F S T D"),
            rules={
                "Z": _END,
                "I": _FIRST_PASS(least=-inf, nonzero=True),
                "K": _LEAD,
                "P": _PULL_OUT,
            },
            further=names("feed-over-speed thread-length thread-run-up")),
        _coarse("G35", "G35, G35F2",
        "Allows leads of up to 1 in, or up to 2 in with F2. Write G35 alone on a line, and "
        "G92 with the current point on the next line.", _COARSE,
            words=names("F"), f=FWord.LEADS,
            rules={"F": WordRule("thread leads of up to 2 in/rev", least=2, most=2, wrong=Refusal(
                "coarse-range",
                "{word}: with G35, only F2 is allowed (leads up to 2 in/rev).",
                "Write G35 or G35F2."))},
            not_when={When.WITH_OTHERS: _COARSE_ALONE, When.COARSE: Refusal(
                "coarse-order", "G35 is already active.", "Delete the line.", 1)},
            further=names("coarse-preset")),
        _coarse("G36", "G36",
        "Ends G35; the axes must be at the point where G35 started. Write G36 alone on a line, "
        "and G92 on the next line.",
            _COARSE, f=FWord.NONE,
            not_when={When.WITH_OTHERS: _COARSE_ALONE, When.NOT_COARSE: Refusal(
                "coarse-order", "G36 ends G35, but G35 is not active.", "Delete the line.", 1)},
            further=names("coarse-place coarse-preset")),
    )),
    ("Program flow", (
        _flow("LS", "LSn",
        "Repeats the following lines n times, up to the line with LF.", "LS3\nG91\nZ-.1\nG90\nLF",
            handler="loops_and_subroutines.Flow.steer", words=names("LS"), deletable=False,
            not_in_mdi=
                "{code} cannot start a loop in MDI; a loop needs more than one line, with LF at the end.",
            further=names("loop-open word-missing")),
        _flow("LF", "LF", "Ends a loop.", "LS2\nX.55\nX.6\nLF",
            handler="loops_and_subroutines.Flow.steer", words=names("LF"), deletable=False,
            not_in_mdi=
                "{code} ends a loop, but no loop was started.", further=names("loop-unopened")),
        _flow("P", "Pn", "Runs subroutine n.", "P4", "}4\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("P"), calls=True,
            not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        _flow("}", "}n",
        "Marks the start of subroutine n; subroutines are written after the end of the program.",
        "M98P5", "}5\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.steer", words=names("}"), deletable=False,
            not_in_mdi=
                "{code} cannot define a subroutine in MDI; subroutines are possible only in a program.",
            further=names("subroutine-open subroutine-twice word-missing")),
        _flow("M98", "M98Pn", "Runs subroutine n.", "M98P2", "}2\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("P M"), calls=True,
            not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        _flow("M99", "M99", "Ends a subroutine.", "M98P3", "}3\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.steer", words=names("M"), deletable=False,
            not_in_mdi=
                "{code} ends a subroutine, but no subroutine was started.", further=names("m99-outside")),
        _flow("M95", "M95",
        "Runs subroutine 1 if TB2-9 is closed.", "M95", "}1\nX.55\nM99\n",
            handler="loops_and_subroutines.Flow.call", words=names("M"), terminal=("TB2-9", True), calls=True,
            asks=True, not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        _flow("M97", "M97InCnPn",
        "Runs subroutine P if input I is on (with C1) or off (with C0).", "M97I10C1P6",
            "}6\nX.55\nM99\n", handler="loops_and_subroutines.Flow.call", words=names("C I P M"),
            calls=True, asks=True, not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            rules={
                "C": WordRule(
                "required state of the input, on (1) or off (0)", least=0, most=1, whole=True, wrong=Refusal(
                    "condition",
                    "The line contains {word}, which is neither C1 (on) nor C0 (off).",
                    "Write C1 or C0.")),
                    "I": WordRule("the number of the input", least=1, whole=True, wrong=Refusal(
                    "input-number",
                    "The line contains {word}, which is not an input number.",
                    "Write the number of the input.")),
            },
            further=names("recursion subroutine-missing")),
        _m_code("M91", "M91", "Waits until TB2-5 is open.", "M91",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-5", False)),
        _m_code("M92", "M92", "Waits until TB2-5 is closed.", "M92",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-5", True)),
        _m_code("M93", "M93", "Waits until TB2-7 is open.", "M93",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-7", False)),
        _m_code("M94", "M94", "Waits until TB2-7 is closed.", "M94",
            acts=Acts.START, handler="m_codes.wait_for_input", terminal=("TB2-7", True)),
        _m_code("M00", "M00", "Stops the program; the comment shows the operator what to do.",
            "M00(TURN THE PART AROUND)", acts=Acts.STOP, handler="m_codes.program_stop"),
        _m_code("M01", "M01", "Stops the program if Optional Stop is on.", "M01(CHECK THE TOOL)",
            acts=Acts.STOP, handler="m_codes.program_stop"),
        _m_code("M02", "M02",
        "Ends the program without changing the M functions.", "/M02",
            acts=Acts.STOP, handler="m_codes.program_end", ends_program=True,
            further=names("after-end no-end")),
        _m_code("M30", "M30",
        "Ends the program and turns the M functions off. With Cycle Repeat on, the "
        "program repeats.", "/M30",
            acts=Acts.STOP, handler="m_codes.program_end", ends_program=True,
            further=names("after-end no-end")),
        _m_code("M31", "M31", "Turns Cycle Repeat off.", "M31",
            acts=Acts.STOP, handler="m_codes.repeat_off"),
        _letter("/", "/",
        "At the start of a line, skips the line while Block Delete is on.", "/X.55",
            handler="omniturn_statement.statement_of"),
        _letter("()", "(text)",
        "Comment. The screen shows it to the operator from this line on.", "X.55(WATCH THE CHUCK)",
            handler="omniturn_statement.statement_of"),
    )),
    ("Machine functions", (
        _m_code("M08", "M08", "Turns the coolant on.", "M08", acts=Acts.START, handler="m_codes.coolant"),
        _m_code("M09", "M09", "Turns the coolant off.", "M09", acts=Acts.STOP, handler="m_codes.coolant"),
        _m_code("M12", "M12", "Clamps the collet.", "M12", acts=Acts.START, handler="m_codes.collet"),
        _m_code("M13", "M13", "Unclamps the collet.", "M13\nG04F.5\nM12",
            acts=Acts.START, handler="m_codes.collet", not_when={When.TURNING: Refusal(
                "unclamp-turning", "M13 opens the collet while the spindle turns.",
                "Stop the spindle with M05 first.", "M")}),
    )),
    ("Plane switching", (
        _plane("~PLXC", "(~PLXC) … (END)",
        "Mills the face: program X and Y across the face; the machine moves X and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLXC)\n(X.25Y0)\n(X.25Y.2)\n(END)\nM28\nM05",
            further=_PLANE | names("plane-centre plane-h-late plane-reach")),
        _plane("~PLZC", "(~PLZC) … (END)",
        "Mills the side: program X along the part and Y around it; the machine moves Z and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLZC)\n(D1.)\n(X.25Y.2)\n(X.5Y0)\n(END)\nM28\nM05",
            further=_PLANE | names("plane-d-late plane-diameter")),
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

LETTERS = {code.name: code for _, codes in CHAPTERS for code in codes if code.acts is Acts.WORD}
"""Words that have an entry of their own."""

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
