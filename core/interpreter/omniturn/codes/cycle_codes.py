"""Codes of canned cycles and threads."""

from __future__ import annotations

from functools import partial
from math import inf

from core.interpreter.omniturn.codes.code_entry import (
    ActionKind,
    Chapter,
    CodeEntry,
    ErrorTemplate,
    FMeaning,
    RejectionCondition,
    WordLimit,
    WordRule,
    make_flow_entry,
    names,
)

# fmt: off
_CONTOUR = "X.2Z0\nX.3Z-.1\nZ-.3\nX.55Z-.5"
_COARSE = "S500\nG35\nG92X.6Z.1\nG33X.57Z-.5I.01K.4\nG36\nG92X.6Z.1"
_NOT_READY = {
    RejectionCondition.NOSE_COMPENSATION: ErrorTemplate(
        "cycle-nose-comp", "{code} cannot run while nose compensation is active.",
            "Write G40 and a departure move before the cycle."),
    RejectionCondition.TOOL_NOT_MOVED: ErrorTemplate(
        "tool-first-move",
        "{code} is the first move after the T word on line {line}, so its start point is unknown.",
            "Program a move to X and Z of the start point before the cycle."),
    RejectionCondition.NO_FEED: ErrorTemplate(
        "feed-missing",
        "{code}: no cutting feed is active.", "Write F on the {code} line."),
}
"""Error templates for cycles that start without a known point or a known feed."""
_LENGTH = partial(
    WordRule, minimum=0, excludes_minimum=True,
    invalid_error=ErrorTemplate(
        "cycle-length",
        "{word}: {letter} ({what}) must be greater than 0.", "Write {letter} with a number greater than 0."),
)
_NEEDS = ErrorTemplate("word-missing", "{code} needs {letter}, {what}.", "Add {letter}.")
_make_required_rule = partial(_LENGTH, missing_error=_NEEDS)
_DEPTH = WordRule(
    "the bottom of the hole",
    missing_error=ErrorTemplate("word-missing", "{code} needs Z, the bottom of the hole.", "Add Z."),
)
_OPPOSITE_CORNER_RULE = WordRule(
            "the corner opposite the start point",
    missing_error=ErrorTemplate(
        "word-missing",
        "{code} needs the {letter} coordinate of the corner opposite the start point.", "Add {letter}."),
)
_CUT = _make_required_rule("the maximum depth of cut")
_LEFT = WordRule(
            "the stock that the cycle leaves per side", minimum=0,
    invalid_error=ErrorTemplate(
        "cycle-length",
        "{word}: U, the stock that the cycle leaves per side, cannot be negative.",
        "Remove the sign."),
)
_DESCRIBED = WordRule(
    "the subroutine that describes the contour",
    no_number_error=ErrorTemplate(
        "word-missing",
        "P must be followed by the number of the subroutine that describes the contour.",
            "Write the number of the subroutine after P."),
)
_contour = partial(
    CodeEntry, action_kind=ActionKind.CONTOUR, handler="cycles.roughing_cycles:plan_contour_cycle",
        f_meaning=FMeaning.FEED,
    rejection_conditions=_NOT_READY,
    mdi_error_text=
                "{code} cannot cut a contour in MDI, because a contour needs more than one line.",
)
_CONTOUR_CYCLE = names(
    "contour-open corner-both corner-size cycle-contour-empty cycle-contour-line cycle-contour-long "
    "cycle-ignored cycle-modes cycle-no-way cycle-nothing cycle-quadrant "
    "cycle-start-near cycle-undercut"
)
_LEAD = WordRule(
    "the lead", minimum=0, excludes_minimum=True, maximum=WordLimit.LEAD,
    missing_error=ErrorTemplate(
        "thread-lead-missing", "K, the lead, is missing.", "Write K, the lead per revolution.", "F"),
    invalid_error=ErrorTemplate(
        "thread-lead-range", "{word}: the lead must be above 0 and at most {most}.", "Correct K."),
)
_FIRST_PASS = partial(
    WordRule, "the depth of the first pass", minimum=0, excludes_minimum=True,
    missing_error=ErrorTemplate("thread-depth",
    "I, the depth of the first pass, is missing.", "Write I, the depth of the first pass."),
    invalid_error=ErrorTemplate(
        "thread-depth", "I, the depth of the first pass, must be above 0.",
        "Write I, the depth of the first pass.", "I"),
)
_PULLOUT_RULE = WordRule(
    "the pull-out from the thread",
    unwanted_number_error=ErrorTemplate(
        "thread-word",
        "{word}: {letter} must not have a number in this line.",
            "Write {letter} without a number."),
)
_END = WordRule(
    "the end of the thread",
    missing_error=ErrorTemplate("word-missing", "Z, the end of the thread, is missing.", "Write Z."),
)
_thread = partial(
    CodeEntry, action_kind=ActionKind.MOTION, handler="cycles.threading_cycles:generate_thread_blocks",
        f_meaning=FMeaning.FEED, min_block_count=4,
    rejection_conditions={
        RejectionCondition.SURFACE_SPEED: ErrorTemplate(
            "thread-under-css",
            "G96 is active, but a thread needs the same spindle speed from the first pass to "
            "the last.",
            "Write G97S before the thread line."),
        RejectionCondition.NOSE_COMPENSATION: ErrorTemplate(
            "thread-under-comp",
            "G{on} is active, but a thread cannot be cut with nose compensation.",
            "Write G40 before this line."),
        RejectionCondition.SPINDLE_STOPPED: ErrorTemplate(
            "spindle-stopped",
            "The spindle is stopped, but it must turn to cut a thread.",
            "Start the spindle with M03 or M04."),
    },
)
_coarse = partial(
    CodeEntry, action_kind=ActionKind.MODE, handler="motion.feeds:execute_coarse_feed",
        mode_group="coarse feed",
    mdi_error_text="{code} needs a G92 on the next line, but MDI runs only one line.",
)
_COARSE_ERROR = ErrorTemplate(
    "not-alone",
    "G{number} must be alone on its line.",
    "Write the other words on a separate line.", 1
)
CYCLE_CHAPTERS: tuple[Chapter, ...] = (
    ("Cycles", (
        CodeEntry("G81", "G81ZnFn",
        "Drills to Z, then retracts at rapid.", "X0Z.1\nG81Z-.3F.004",
            action_kind=ActionKind.CYCLE, handler="cycles.drilling_cycles:plan_drilling",
            allowed_words=names("X Z F S"),
            f_meaning=FMeaning.FEED,
            rejection_conditions=_NOT_READY, word_rules={"Z": _DEPTH}, min_block_count=2,
            other_diagnostic_codes=names("cycle-depth")),
        CodeEntry("G83", "G83ZnKnFnRnLnCn", "Drills in pecks of K, retracting to R.",
            "X0Z.1\nG83Z-.65K.2F.004",
            action_kind=ActionKind.CYCLE, handler="cycles.drilling_cycles:plan_pecking",
            allowed_words=names("X Z C K R L F S"),
            f_meaning=FMeaning.FEED, rejection_conditions=_NOT_READY, min_block_count=2,
            word_rules={
                "Z": _DEPTH,
                "K": _make_required_rule("the depth of one peck"),
                "L": WordRule("the retract rate", minimum=0, excludes_minimum=True, maximum=WordLimit.FEED,
                invalid_error=ErrorTemplate(
                    "cycle-rate",
                    "{word}: the retract rate must be above 0 and at most {most}.",
                    "Correct L.")),
                    "C": _LENGTH("the distance before the cut at which the feed begins",
                    no_number_error=_NEEDS),
            },
            other_diagnostic_codes=names("cycle-depth cycle-passes cycle-retract peck-depth")),
        CodeEntry("G74", "G74XnZnInUnFn",
        "Roughs a rectangle in passes of at most I, leaving an allowance of U in X.",
            "G74X.3Z-.5I.05U.01F.006", action_kind=ActionKind.CYCLE,
            handler="cycles.roughing_cycles:plan_box_cycle",
            allowed_words=names("X Z I U F S"), f_meaning=FMeaning.FEED, rejection_conditions=_NOT_READY,
            min_block_count=4,
            word_rules={"X": _OPPOSITE_CORNER_RULE, "Z": _OPPOSITE_CORNER_RULE, "I": _CUT, "U": _LEFT},
            other_diagnostic_codes=names("cycle-nothing cycle-passes")),
        _contour("G75", "G75InUnFnPn",
        "Roughs the contour on the following lines, which end with RF.",
            f"G75I.05U.01F.006\n{_CONTOUR}\nRF", allowed_words=names("I U P F S"), min_block_count=4,
            word_rules={"P": _DESCRIBED, "I": _CUT, "U": _LEFT},
            other_diagnostic_codes=_CONTOUR_CYCLE | names("cycle-passes cycle-plunge")),
        _contour("G78", "G78UnFnPn",
        "Cuts one pass along the contour at a distance of U.", f"G78U.01F.004\n{_CONTOUR}\nRF",
            allowed_words=names("U P F S"), min_block_count=3, word_rules={"P": _DESCRIBED, "U": _LEFT},
            other_diagnostic_codes=_CONTOUR_CYCLE),
        make_flow_entry("RF", "RF", "Ends the contour description for G75 and G78.",
            f"G78U.02F.004\n{_CONTOUR}\nRF",
            handler="flow.loops_and_subroutines:Flow.skip_contour", allowed_words=names("RF"),
            allows_block_delete=False,
            mdi_error_text=
                "{code} ends a contour, but no contour was started.",
                other_diagnostic_codes=names("rf-alone")),
    )),
    ("Threads", (
        _thread("G33", "G33XnZnInKnAnCnPO",
        "Cuts a thread in passes to X with lead K.", "X.24Z.2\nG33X.21Z-.5I.01K.05C",
            allowed_words=names("X Z C I K A P O F S T D"),
            word_rules={
                "X": WordRule("the position of the last pass", missing_error=ErrorTemplate(
                    "word-missing",
                    "X, the position of the last pass, is missing.", "Write X.")),
                    "Z": _END,
                    "I": _FIRST_PASS(),
                    "K": _LEAD,
                    "C": WordRule("infeed angle in degrees", minimum=0, maximum=30, value_without_number=29,
                    invalid_error=ErrorTemplate(
                    "thread-angle",
                    "{word}: the infeed angle must be from 0 to 30 degrees.",
            "Correct the C word; C without a number means 29 degrees.")),
            "P": _PULLOUT_RULE,
            "O": WordRule("the last pass only"),
            },
            other_diagnostic_codes=names(
                "feed-over-speed thread-angle thread-length thread-passes thread-run-up thread-side"
            )),
        _thread("G34", "G34ZnInKnAnPn",
        "Cuts one thread pass at the current X.", "X.24Z.2\nG34Z-.5I.01K.05",
            allowed_words=names("Z I K A P F S T D"),
            word_rules={
                "Z": _END,
                "I": _FIRST_PASS(minimum=-inf, requires_nonzero=True),
                "K": _LEAD,
                "P": _PULLOUT_RULE,
            },
            other_diagnostic_codes=names("feed-over-speed thread-length thread-run-up")),
        _coarse("G35", "G35, G35F2",
        "Allows leads of up to 1 in, or up to 2 in with F2. Write G35 alone on a line, and "
        "G92 with the current point on the next line.", _COARSE,
            allowed_words=names("F"), f_meaning=FMeaning.LEAD_RANGE,
            word_rules={"F": WordRule("thread leads of up to 2 in/rev", minimum=2, maximum=2,
            invalid_error=ErrorTemplate(
                "coarse-range",
                "{word}: with G35, only F2 is allowed (leads up to 2 in/rev).",
                "Write G35 or G35F2."))},
            rejection_conditions={RejectionCondition.WITH_OTHER_WORDS: _COARSE_ERROR,
            RejectionCondition.COARSE_FEED: ErrorTemplate(
                "coarse-order", "G35 is already active.", "Delete the line.", 1)},
            other_diagnostic_codes=names("coarse-preset")),
        _coarse("G36", "G36",
        "Ends G35; the axes must be at the point where G35 started. Write G36 alone on a line, "
        "and G92 on the next line.",
            _COARSE, f_meaning=FMeaning.NONE,
            rejection_conditions={RejectionCondition.WITH_OTHER_WORDS: _COARSE_ERROR,
            RejectionCondition.NO_COARSE_FEED: ErrorTemplate(
                "coarse-order", "G36 ends G35, but G35 is not active.", "Delete the line.", 1)},
            other_diagnostic_codes=names("coarse-place coarse-preset")),
    )),
)
# fmt: on
