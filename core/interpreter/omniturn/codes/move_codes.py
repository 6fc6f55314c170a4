"""Codes of moves, corners, modes, tools, offsets, nose compensation, the spindle and the C axis."""

from __future__ import annotations

from functools import partial

from core.interpreter.omniturn.codes.code_entry import (
    PLAIN_WORDS,
    Acts,
    Chapter,
    Code,
    FWord,
    Limit,
    Refusal,
    SWord,
    Together,
    When,
    WordRule,
    letter,
    m_code,
    mode,
    names,
)

# fmt: off
_COMPENSATED = "G00X0Z.2\nG41\nG01Z0D1\nX.4\nZ-.5\nX.55\nG00Z.5\nG40"
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
    Code, acts=Acts.ARC, handler="motion.arc_moves:arc_move", words=names("X Z I K R F S T D"), f=FWord.FEED,
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
    Code, acts=Acts.MODE, handler="motion.nose_compensation:switch", group="nose compensation", f=FWord.NONE,
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
_SLOWLY = "M05\nG94F30"  # precedes locking the spindle as the C axis
_start = partial(
    Code, acts=Acts.SPINDLE, handler="setup.spindle_and_dwell:run_block", words=PLAIN_WORDS, f=FWord.FEED,
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
    Code, acts=Acts.WORD, f=FWord.NONE, handler="motion.c_axis:c_move",
    apart=(Together(("C", "CA", "CI"), Refusal(
        "word-twice",
        "The line contains both {first} and {word}.", "Keep only one of the conflicting words.")),),
    not_when={When.C_FREE: Refusal(
        "c-unlocked",
        "{word} rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 or M89 before this line.")},
    further=names("c-too-little feed-over-speed finer-than-step speed-missing"),
)
MOVE_CHAPTERS: tuple[Chapter, ...] = (
    ("Moves and corners", (
        mode("G00", "G00 XnZn",
                "From here on, all moves are rapid moves; the rapid rate is the F in the first "
                "line of the program.", "G00X.7\nZ.5",
            handler="motion.feeds:feed_words", group="rapid", further=names("title-rapid"),
            not_when={When.WITH_FEED: Refusal(
                "rapid-and-feed",
                "G00 cannot be combined with F, G94 or G95, because each of these words "
                "cancels the rapid mode.",
                "Split the line.", 1)}),
        mode("G01", "G01 XnZn",
        "Returns to the feed that was active before the rapid.", "Z0\nG00Z.05\nG01Z-.2",
            handler="motion.feeds:feed_words", group="rapid",
            not_when={When.NO_CUT_FEED: Refusal(
                "no-cut-feed",
                "G01 returns to the last cutting feed, but no cutting feed has been set after "
                "the first line.",
                "Set a cutting feed with G95Fn or G94Fn.", 1)}),
        _arc("G02", "G02XnZnRn or InKn", "Clockwise arc, as seen from above.", "X.3Z0\nG02X.45Z-.15R.15"),
        _arc("G03", "G03XnZnRn or InKn", "Counterclockwise arc.", "X.3Z-.2\nG03X.4Z-.3I.4K-.2"),
        Code("G04", "G04Fn",
        "Dwell of n seconds; the minimum is 0.1 s.", "G04F.5",
            acts=Acts.MOTION, handler="setup.spindle_and_dwell:dwell", words=names("F S T D"),
            f=FWord.SECONDS,
            rules={"F": WordRule(
                "seconds", least=0.1,
                missing=Refusal("word-missing", "G04 does not contain a dwell time.",
            "Write G04F with the time in seconds."),
                wrong=Refusal(
                    "dwell-range", "G04F{value} is too short: the shortest dwell is 0.1 s.", "Correct F."))},
            least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            further=names("dwell-long dwell-too-short")),
        Code("F", "Fn", "Feed: in/min under G94, in/rev under G95.", "Z0F.002",
            acts=Acts.WORD, handler="motion.feeds:feed_words", words=names("F"), f=FWord.FEED,
            rules={"F": WordRule(
                "feed in inches per minute or per revolution", least=0.00005, most=Limit.FEED_IN_FORCE,
                wrong=Refusal(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Raise F."),
                too_great=Refusal(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Lower F."))},
            further=names("feed-high feed-low feed-missing")),
        letter("C", "XnZnCn",
        "Chamfer to the next straight line, set back by n on both lines.",
            "X.3Z0\nX.5C.03\nZ-.3", handler="motion.corners:read_corner", rules={"C": _CORNER_SIZE},
            apart=(Together(("R", "C"), _CORNER_BOTH),), further=_CORNER),
        letter("R", "XnZnRn",
        "Corner radius n, tangent to this straight line and the next one.", "X.3Z0\nX.5R.05\nZ-.3",
            handler="motion.corners:read_corner", rules={"R": _CORNER_SIZE},
            apart=(Together(("R", "C"), _CORNER_BOTH),), further=_CORNER,
            not_when={When.NO_STRAIGHT_MOVE: Refusal(
                "corner-without-move",
                "{word} programs a corner at the end of a straight move, but the line does not "
                "contain a straight move.",
            "Write the chamfer or radius on the line with X or Z.")}),
    )),
    ("Modes", (
        mode("G70", "G70", "Inches.", "G70\nX.5",
            handler="motion.straight_moves:geometry_modes", group="units", further=names("finer-than-step")),
        mode("G71", "G71",
        "Metric units, active until G70 or a restart.", "G71\nX12.5Z2.5\nG70",
            handler="motion.straight_moves:geometry_modes", group="units", further=names("finer-than-step")),
        mode("G72", "G72", "X words are diameters.", "G72\nX1.\nG73",
            handler="motion.straight_moves:geometry_modes", group="X words"),
        mode("G73", "G73",
        "X words are radii; this is the setting at program start.", "G73\nX.5",
            handler="motion.straight_moves:geometry_modes", group="X words"),
        mode("G90", "G90",
        "Absolute positions; the first line must contain G90 or G91.", "G90\nX.5Z0",
            handler="motion.straight_moves:geometry_modes", group="distance", further=names("first-line")),
        mode("G91", "G91", "Incremental.", "G91\nX-.1\nG90",
            handler="motion.straight_moves:geometry_modes", group="distance", further=names("first-line")),
        Code("G92", "G92XnZn", "Sets the coordinates of the current point; no axis moves.", "G92X.6Z.2",
            acts=Acts.FRAME, handler="setup.tools_and_offsets:preset", words=names("X Z F S T D"),
            f=FWord.FEED,
            one_of=_PLACE, least_blocks=1, before_corner=True, in_contour=True,
            further=names("preset-thread")),
        mode("G94", "G94Fn", "Feed in inches per minute.", "G94F5\nZ0",
            handler="motion.feeds:feed_words", group="feed mode", further=names("feed-over-speed")),
        mode("G95", "G95Fn",
        "Feed in inches per revolution; the spindle must be turning.", "G95F.003\nZ0",
            handler="motion.feeds:feed_words", group="feed mode",
            further=names("feed-over-speed spindle-stopped")),
    )),
    ("Tools, offsets, nose compensation", (
        letter("T", "Tn",
        "Tool offset n, from 1 to 32; the next move must contain X and Z. T0 cancels "
        "the tool offset and the work shift.",
            "T2\nX.6Z.1", handler="setup.tools_and_offsets:tool_change",
            not_when={When.COARSE: Refusal(
                "coarse-tool",
                "T is not allowed between G35 and G36.", "Write G36 before the T word.", "T")},
            further=names("tool-first-move tool-offset-missing tool-under-css")),
        letter("D", "Dn",
        "Applies secondary offset n at this end point and at all later end points; D0 "
        "cancels the offset.",
            "X.5Z0\nZ-.4D2\nX.55D0", handler="setup.tools_and_offsets:secondary", further=names("comp-d")),
        Code("G10", "G10XnZn",
            "Adds X and Z to the work shift; the new shift takes effect at the next T word.",
            "G10X0Z-.5\nT1\nX.6Z.1",
            acts=Acts.FRAME, handler="setup.tools_and_offsets:work_shift",
            words=names("X Z F S T D"), f=FWord.FEED,
            one_of=_PLACE, least_blocks=1, under_nose=True, before_corner=True, in_contour=True,
            further=names("shift-without-tool")),
        Code("G40", "G40",
        "Turns nose compensation off; the preceding move is the departure from the "
        "contour.", _COMPENSATED,
            acts=Acts.MODE, handler="motion.nose_compensation:switch", group="nose compensation",
            f=FWord.NONE,
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
        letter("S", "Sn", "Spindle speed in rpm with G97, surface speed in ft/min with G96.", "S1500",
            handler="setup.spindle_and_dwell:speed_word", words=names("S"),
            rules={"S": WordRule(
                "rpm", least=0, most=Limit.RPM, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word} is above the spindle maximum of {most} rpm.", "Lower S."))}),
        _start("M03", "M03Sn", "Spindle forward.", "M03S1200"),
        _start("M04", "M04Sn", "Spindle reverse.", "M04S800\nG04F2"),
        m_code("M05", "M05",
        "Turns the spindle off; the S value is retained.", "M05",
            acts=Acts.STOP, handler="setup.spindle_and_dwell:stop_block"),
        mode("G96", "G96Sn", "Constant surface speed in ft/min; the rpm changes with the radius.",
            "G96S200\nX.3\nG97S1000", handler="setup.spindle_and_dwell:spindle_modes", group="spindle mode",
            rules={"S": WordRule(
                "surface speed in ft/min, or in m/min with G71",
                least=0, most=Limit.SURFACE, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word}: this surface speed is too high for any tool.", "Write G97 if S is in rpm."))},
            further=names("surface-speed-missing")),
        mode("G97", "G97Sn", "S is in rpm again.", "G97S900",
            handler="setup.spindle_and_dwell:spindle_modes", group="spindle mode"),
        mode("G76", "G76Sn", "Minimum rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000",
            handler="setup.spindle_and_dwell:spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        mode("G77", "G77Sn", "Maximum rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000",
            handler="setup.spindle_and_dwell:spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        Code("G89", "G89",
        "Stops the spindle and locks it in place, like M89.",
            f"{_SLOWLY}\nG89\nCI90S60\nG04F2\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock",
            words=names("S"),
            f=FWord.NONE, s=SWord.C_SPEED, before_corner=True, rules={"S": _C_SPEED},
            not_when={When.NO_C: _NO_C, When.WITH_M: Refusal(
                "not-alone",
                "G89 locks the spindle and cannot be combined with M codes.", "Split the line.")}),
        m_code("M19", "M19Sn",
        "Turns the spindle to angle 0 and locks it until M05.",
            f"{_SLOWLY}\nM19S60\nG04F3\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock", s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        m_code("M89", "M89",
        "Stops the spindle and locks it in place.",
            f"{_SLOWLY}\nM89\nCI45S60\nG04F2\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock",
            s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        _c_word("CA", "CAn", "Turns the spindle to angle n.",
            f"{_SLOWLY}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05",
            rules={"C": _ANGLE, "S": _C_SPEED}),
        _c_word("CI", "CIn",
        "Turns the spindle by n degrees; the sign sets the direction.",
            f"{_SLOWLY}\nM89\nCI-30S60\nG04F2\nM05", rules={"C": _ANGLE, "S": _C_SPEED}),
    )),
)
# fmt: on
