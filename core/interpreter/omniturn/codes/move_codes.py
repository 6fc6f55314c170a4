"""Codes of moves, corners, modes, tools, offsets, nose compensation, the spindle and the C axis."""

from __future__ import annotations

from functools import partial

from core.interpreter.omniturn.codes.code_entry import (
    PLAIN_WORDS,
    ActionKind,
    Chapter,
    CodeEntry,
    ErrorTemplate,
    FMeaning,
    RejectionCondition,
    SMeaning,
    WordGroup,
    WordLimit,
    WordRule,
    make_letter_entry,
    make_m_code_entry,
    make_mode_entry,
    names,
)

# fmt: off
_COMPENSATED = "G00X0Z.2\nG41\nG01Z0D1\nX.4\nZ-.5\nX.55\nG00Z.5\nG40"
_CORNER_BOTH = ErrorTemplate("corner-both", "The line has both C and R.",
    "Keep only one of the conflicting words.")
_CORNER_SIZE = WordRule(
    "the corner size", minimum=0, excludes_minimum=True,
    invalid_error=ErrorTemplate(
        "corner-size",
        "{word}: the corner size must be a number greater than 0.",
            "Write the size as a number greater than 0."
    ),
)
_CORNER = names("corner-next corner-straight corner-too-large")
_ARC_MODE = ErrorTemplate(
    "arc-mode", "Arcs cannot be incremental in diameter mode.", "Use G90 or G73 for the arc."
)
_ARC_BOTH = ErrorTemplate("arc-both",
"The arc has both R and {letter}.", "Use either R, or I and K.")
_arc = partial(
    CodeEntry, action_kind=ActionKind.ARC, handler="motion.arc_moves:make_arc_block",
        allowed_words=names("X Z I K R F S T D"), f_meaning=FMeaning.FEED,
    word_rules={
        "R": WordRule("the radius", minimum=0, excludes_minimum=True, invalid_error=ErrorTemplate(
            "arc-r-sign", "R must be greater than 0.", "Use I and K for larger arcs.", "R")),
    },
    required_words=WordGroup(("R", "I", "K"), ErrorTemplate(
        "arc-centre-missing", "The arc has neither R nor I and K.", "Add R, or I and K.")),
    exclusive_words=(WordGroup(("R", "I"), _ARC_BOTH), WordGroup(("R", "K"), _ARC_BOTH)),
    rejection_conditions={RejectionCondition.INCREMENTAL_DIAMETERS: _ARC_MODE},
    min_block_count=1, is_allowed_with_compensation=True, is_allowed_after_corner=True,
    is_allowed_in_contour=True,
    other_diagnostic_codes=names(
                "arc-coordinate-missing arc-no-chord arc-no-radius arc-over-half arc-radius"
            ),
)
_PLACE = WordGroup(
    ("X", "Z"), ErrorTemplate("word-missing", "G{number} needs X or Z.", "Write the coordinates.")
)
_ALONE_ERROR = ErrorTemplate(
    "not-alone",
    "G{number} must be alone on its line.",
    "Write the other words on a separate line.", 1
)
_make_compensation_entry = partial(
    CodeEntry, action_kind=ActionKind.MODE, handler="motion.nose_compensation:execute_compensation_code",
        mode_group="nose compensation", f_meaning=FMeaning.NONE,
    mdi_error_text=
                "{code} cannot start nose compensation in MDI, because nose compensation needs more "
                "than one line.",
    rejection_conditions={
        RejectionCondition.WITH_OTHER_WORDS: _ALONE_ERROR,
        RejectionCondition.NOSE_COMPENSATION: ErrorTemplate(
            "comp-on",
            "G{number} is not allowed while G{on} is active.",
            "End G{on} first: move off the part, then write G40.", 1),
    },
    other_diagnostic_codes=names(
                "comp-approach comp-gouge comp-no-radius comp-open comp-radius comp-subroutine comp-with"
            ),
)
_LOCK_PREPARATION = "M05\nG94F30"  # precedes locking the spindle as the C axis
_start = partial(
    CodeEntry, action_kind=ActionKind.SPINDLE, handler="setup.spindle_and_dwell:run_spindle",
        allowed_words=PLAIN_WORDS, f_meaning=FMeaning.FEED,
    rejection_conditions={
        RejectionCondition.C_LOCKED: ErrorTemplate(
            "spindle-locked",
            "M{number} starts the spindle, but the spindle is locked as the C axis.",
            "Release the spindle with M05 first.", "M"),
        RejectionCondition.NO_SPEED: ErrorTemplate(
            "speed-missing",
            "M{number} starts the spindle, but no spindle speed S is programmed.",
            "Write S on this line.", "M"),
        RejectionCondition.COLLET_OPEN: ErrorTemplate(
            "collet-open", "M{number} starts the spindle with the collet open.",
            "Close the collet with M12 first.", "M"),
    },
)
_SPEED_SIGN = ErrorTemplate(
    "speed-sign",
    "{word}: spindle speed cannot be negative; M03 and M04 set the direction.", "Remove the sign."
)
_SPEED_LIMIT = WordRule(
    "rpm", minimum=0,
    missing_error=ErrorTemplate("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
    invalid_error=ErrorTemplate("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
)
_C_SPEED = WordRule(
            "C axis speed in rpm, without a sign", minimum=0, excludes_minimum=True, maximum=WordLimit.C_RPM,
    invalid_error=ErrorTemplate("speed-range",
    "{word}: the C axis speed must be above 0 and at most {most} rpm.", "Correct S."),
)
_NO_C = ErrorTemplate(
    "c-disabled",
    "{name} needs a C axis, but the C axis is disabled in the machine file.",
            "Enable the C axis (axis.C.enabled)."
)
_ANGLE = WordRule(
    "angle in degrees; absolute (like CA) under G90, incremental (like CI) under G91",
    no_number_error=ErrorTemplate("number-missing", "{word} has no number.", "Write the angle in degrees."),
)
_c_word = partial(
    CodeEntry, action_kind=ActionKind.WORD, f_meaning=FMeaning.NONE, handler="motion.c_axis:move_c_axis",
    exclusive_words=(WordGroup(("C", "CA", "CI"), ErrorTemplate(
        "word-twice",
        "The line contains both {first} and {word}.", "Keep only one of the conflicting words.")),),
    rejection_conditions={RejectionCondition.C_NOT_LOCKED: ErrorTemplate(
        "c-unlocked",
        "{word} rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 or M89 before this line.")},
    other_diagnostic_codes=names("c-too-little feed-over-speed finer-than-step speed-missing"),
)
MOVE_CHAPTERS: tuple[Chapter, ...] = (
    ("Moves and corners", (
        make_mode_entry("G00", "G00 XnZn",
                "From here on, all moves are rapid moves; the rapid rate is the F in the first "
                "line of the program.", "G00X.7\nZ.5",
            handler="motion.feeds:execute_feed_words", mode_group="rapid",
            other_diagnostic_codes=names("title-rapid"),
            rejection_conditions={RejectionCondition.WITH_FEED: ErrorTemplate(
                "rapid-and-feed",
                "G00 cannot be combined with F, G94 or G95, because each of these words "
                "cancels the rapid mode.",
                "Split the line.", 1)}),
        make_mode_entry("G01", "G01 XnZn",
        "Returns to the feed that was active before the rapid.", "Z0\nG00Z.05\nG01Z-.2",
            handler="motion.feeds:execute_feed_words", mode_group="rapid",
            rejection_conditions={RejectionCondition.NO_CUT_FEED: ErrorTemplate(
                "no-cut-feed",
                "G01 returns to the last cutting feed, but no cutting feed has been set after "
                "the first line.",
                "Set a cutting feed with G95Fn or G94Fn.", 1)}),
        _arc("G02", "G02XnZnRn or InKn", "Clockwise arc, as seen from above.", "X.3Z0\nG02X.45Z-.15R.15"),
        _arc("G03", "G03XnZnRn or InKn", "Counterclockwise arc.", "X.3Z-.2\nG03X.4Z-.3I.4K-.2"),
        CodeEntry("G04", "G04Fn",
        "Dwell of n seconds; the minimum is 0.1 s.", "G04F.5",
            action_kind=ActionKind.MOTION, handler="setup.spindle_and_dwell:execute_dwell",
            allowed_words=names("F S T D"),
            f_meaning=FMeaning.SECONDS,
            word_rules={"F": WordRule(
                "seconds", minimum=0.1,
                missing_error=ErrorTemplate("word-missing", "G04 does not contain a dwell time.",
            "Write G04F with the time in seconds."),
                invalid_error=ErrorTemplate(
                    "dwell-range", "G04F{value} is too short: the shortest dwell is 0.1 s.", "Correct F."))},
            min_block_count=1, is_allowed_with_compensation=True, is_allowed_after_corner=True,
            is_allowed_in_contour=True,
            other_diagnostic_codes=names("dwell-long dwell-too-short")),
        CodeEntry("F", "Fn", "Feed: in/min under G94, in/rev under G95.", "Z0F.002",
            action_kind=ActionKind.WORD, handler="motion.feeds:execute_feed_words", allowed_words=names("F"),
            f_meaning=FMeaning.FEED,
            word_rules={"F": WordRule(
                "feed in inches per minute or per revolution", minimum=0.00005, maximum=WordLimit.ACTIVE_FEED,
                invalid_error=ErrorTemplate(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Raise F."),
                too_large_error=ErrorTemplate(
                    "feed-range", "Feed {value} is out of range: {least} to {most}.", "Lower F."))},
            other_diagnostic_codes=names("feed-high feed-low feed-missing")),
        make_letter_entry("C", "XnZnCn",
        "Chamfer to the next straight line, set back by n on both lines.",
            "X.3Z0\nX.5C.03\nZ-.3", handler="motion.corners:read_corner", word_rules={"C": _CORNER_SIZE},
            exclusive_words=(WordGroup(("R", "C"), _CORNER_BOTH),), other_diagnostic_codes=_CORNER),
        make_letter_entry("R", "XnZnRn",
        "Corner radius n, tangent to this straight line and the next one.", "X.3Z0\nX.5R.05\nZ-.3",
            handler="motion.corners:read_corner", word_rules={"R": _CORNER_SIZE},
            exclusive_words=(WordGroup(("R", "C"), _CORNER_BOTH),), other_diagnostic_codes=_CORNER,
            rejection_conditions={RejectionCondition.NO_STRAIGHT_MOVE: ErrorTemplate(
                "corner-without-move",
                "{word} programs a corner at the end of a straight move, but the line does not "
                "contain a straight move.",
            "Write the chamfer or radius on the line with X or Z.")}),
    )),
    ("Modes", (
        make_mode_entry("G70", "G70", "Inches.", "G70\nX.5",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="units",
            other_diagnostic_codes=names("finer-than-step")),
        make_mode_entry("G71", "G71",
        "Metric units, active until G70 or a restart.", "G71\nX12.5Z2.5\nG70",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="units",
            other_diagnostic_codes=names("finer-than-step")),
        make_mode_entry("G72", "G72", "X words are diameters.", "G72\nX1.\nG73",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="X words"),
        make_mode_entry("G73", "G73",
        "X words are radii; this is the setting at program start.", "G73\nX.5",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="X words"),
        make_mode_entry("G90", "G90",
        "Absolute positions; the first line must contain G90 or G91.", "G90\nX.5Z0",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="distance",
            other_diagnostic_codes=names("first-line")),
        make_mode_entry("G91", "G91", "Incremental.", "G91\nX-.1\nG90",
            handler="motion.straight_moves:execute_dimension_modes", mode_group="distance",
            other_diagnostic_codes=names("first-line")),
        CodeEntry("G92", "G92XnZn", "Sets the coordinates of the current point; no axis moves.", "G92X.6Z.2",
            action_kind=ActionKind.FRAME, handler="setup.tools_and_offsets:set_preset",
            allowed_words=names("X Z F S T D"),
            f_meaning=FMeaning.FEED,
            required_words=_PLACE, min_block_count=1, is_allowed_after_corner=True,
            is_allowed_in_contour=True,
            other_diagnostic_codes=names("preset-thread")),
        make_mode_entry("G94", "G94Fn", "Feed in inches per minute.", "G94F5\nZ0",
            handler="motion.feeds:execute_feed_words", mode_group="feed mode",
            other_diagnostic_codes=names("feed-over-speed")),
        make_mode_entry("G95", "G95Fn",
        "Feed in inches per revolution; the spindle must be turning.", "G95F.003\nZ0",
            handler="motion.feeds:execute_feed_words", mode_group="feed mode",
            other_diagnostic_codes=names("feed-over-speed spindle-stopped")),
    )),
    ("Tools, offsets, nose compensation", (
        make_letter_entry("T", "Tn",
        "Tool offset n, from 1 to 32; the next move must contain X and Z. T0 cancels "
        "the tool offset and the work shift.",
            "T2\nX.6Z.1", handler="setup.tools_and_offsets:change_tool",
            rejection_conditions={RejectionCondition.COARSE_FEED: ErrorTemplate(
                "coarse-tool",
                "T is not allowed between G35 and G36.", "Write G36 before the T word.", "T")},
            other_diagnostic_codes=names("tool-first-move tool-offset-missing tool-under-css")),
        make_letter_entry("D", "Dn",
        "Applies secondary offset n at this end point and at all later end points; D0 "
        "cancels the offset.",
            "X.5Z0\nZ-.4D2\nX.55D0", handler="setup.tools_and_offsets:select_secondary_offset",
            other_diagnostic_codes=names("comp-d")),
        CodeEntry("G10", "G10XnZn",
            "Adds X and Z to the work shift; the new shift takes effect at the next T word.",
            "G10X0Z-.5\nT1\nX.6Z.1",
            action_kind=ActionKind.FRAME, handler="setup.tools_and_offsets:add_work_shift",
            allowed_words=names("X Z F S T D"), f_meaning=FMeaning.FEED,
            required_words=_PLACE, min_block_count=1, is_allowed_with_compensation=True,
            is_allowed_after_corner=True, is_allowed_in_contour=True,
            other_diagnostic_codes=names("shift-without-tool")),
        CodeEntry("G40", "G40",
        "Turns nose compensation off; the preceding move is the departure from the "
        "contour.", _COMPENSATED,
            action_kind=ActionKind.MODE, handler="motion.nose_compensation:execute_compensation_code",
            mode_group="nose compensation",
            f_meaning=FMeaning.NONE,
            mdi_error_text=
                "{code} cannot end nose compensation in MDI, because nose compensation needs more than "
                "one line.",
            rejection_conditions={RejectionCondition.WITH_OTHER_WORDS: _ALONE_ERROR},
            other_diagnostic_codes=names("comp-empty")),
        _make_compensation_entry("G41", "G41",
        "Turns nose compensation on, with the nose center to the left of the path. The "
        "next line is the approach and must contain D.",
            _COMPENSATED),
        _make_compensation_entry("G42", "G42",
            "Turns nose compensation on, with the nose center to the right of the path.",
            "G00X.6Z-.5\nG42\nG01X.5D3\nX.4\nZ0\nX0\nG00Z.3\nG40"),
    )),
    ("Spindle and C axis", (
        make_letter_entry("S", "Sn", "Spindle speed in rpm with G97, surface speed in ft/min with G96.",
            "S1500",
            handler="setup.spindle_and_dwell:execute_speed_word", allowed_words=names("S"),
            word_rules={"S": WordRule(
                "rpm", minimum=0, maximum=WordLimit.RPM, invalid_error=_SPEED_SIGN,
                too_large_error=ErrorTemplate(
                    "speed-range",
                    "{word} is above the spindle maximum of {most} rpm.", "Lower S."))}),
        _start("M03", "M03Sn", "Spindle forward.", "M03S1200"),
        _start("M04", "M04Sn", "Spindle reverse.", "M04S800\nG04F2"),
        make_m_code_entry("M05", "M05",
        "Turns the spindle off; the S value is retained.", "M05",
            action_kind=ActionKind.STOP, handler="setup.spindle_and_dwell:stop_spindle"),
        make_mode_entry("G96", "G96Sn", "Constant surface speed in ft/min; the rpm changes with the radius.",
            "G96S200\nX.3\nG97S1000", handler="setup.spindle_and_dwell:execute_spindle_modes",
            mode_group="spindle mode",
            word_rules={"S": WordRule(
                "surface speed in ft/min, or in m/min with G71",
                minimum=0, maximum=WordLimit.SURFACE_SPEED, invalid_error=_SPEED_SIGN,
                too_large_error=ErrorTemplate(
                    "speed-range",
                    "{word}: this surface speed is too high for any tool.", "Write G97 if S is in rpm."))},
            other_diagnostic_codes=names("surface-speed-missing")),
        make_mode_entry("G97", "G97Sn", "S is in rpm again.", "G97S900",
            handler="setup.spindle_and_dwell:execute_spindle_modes", mode_group="spindle mode"),
        make_mode_entry("G76", "G76Sn", "Minimum rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000",
            handler="setup.spindle_and_dwell:execute_spindle_modes", mode_group="speed limits",
            s_meaning=SMeaning.SPEED_LIMIT,
            word_rules={"S": _SPEED_LIMIT}, other_diagnostic_codes=names("speed-limits")),
        make_mode_entry("G77", "G77Sn", "Maximum rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000",
            handler="setup.spindle_and_dwell:execute_spindle_modes", mode_group="speed limits",
            s_meaning=SMeaning.SPEED_LIMIT,
            word_rules={"S": _SPEED_LIMIT}, other_diagnostic_codes=names("speed-limits")),
        CodeEntry("G89", "G89",
        "Stops the spindle and locks it in place, like M89.",
            f"{_LOCK_PREPARATION}\nG89\nCI90S60\nG04F2\nM05", action_kind=ActionKind.SPINDLE_LOCK,
                handler="motion.c_axis:lock_spindle",
            allowed_words=names("S"),
            f_meaning=FMeaning.NONE, s_meaning=SMeaning.C_SPEED, is_allowed_after_corner=True,
            word_rules={"S": _C_SPEED},
            rejection_conditions={RejectionCondition.C_DISABLED: _NO_C,
            RejectionCondition.WITH_M: ErrorTemplate(
                "not-alone",
                "G89 locks the spindle and cannot be combined with M codes.", "Split the line.")}),
        make_m_code_entry("M19", "M19Sn",
        "Turns the spindle to angle 0 and locks it until M05.",
            f"{_LOCK_PREPARATION}\nM19S60\nG04F3\nM05", action_kind=ActionKind.SPINDLE_LOCK,
                handler="motion.c_axis:lock_spindle", s_meaning=SMeaning.C_SPEED,
            word_rules={"S": _C_SPEED}, rejection_conditions={RejectionCondition.C_DISABLED: _NO_C}),
        make_m_code_entry("M89", "M89",
        "Stops the spindle and locks it in place.",
            f"{_LOCK_PREPARATION}\nM89\nCI45S60\nG04F2\nM05", action_kind=ActionKind.SPINDLE_LOCK,
                handler="motion.c_axis:lock_spindle",
            s_meaning=SMeaning.C_SPEED,
            word_rules={"S": _C_SPEED}, rejection_conditions={RejectionCondition.C_DISABLED: _NO_C}),
        _c_word("CA", "CAn", "Turns the spindle to angle n.",
            f"{_LOCK_PREPARATION}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05",
            word_rules={"C": _ANGLE, "S": _C_SPEED}),
        _c_word("CI", "CIn",
        "Turns the spindle by n degrees; the sign sets the direction.",
            f"{_LOCK_PREPARATION}\nM89\nCI-30S60\nG04F2\nM05", word_rules={"C": _ANGLE, "S": _C_SPEED}),
    )),
)
# fmt: on
