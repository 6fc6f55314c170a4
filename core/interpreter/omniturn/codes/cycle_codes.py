"""Codes of canned cycles and threads."""

from __future__ import annotations

from functools import partial
from math import inf

from core.interpreter.omniturn.codes.code_entry import (
    Acts,
    Chapter,
    Code,
    FWord,
    Limit,
    Refusal,
    When,
    WordRule,
    flow,
    names,
)

# fmt: off
_CONTOUR = "X.2Z0\nX.3Z-.1\nZ-.3\nX.55Z-.5"
_COARSE = "S500\nG35\nG92X.6Z.1\nG33X.57Z-.5I.01K.4\nG36\nG92X.6Z.1"
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
    Code, acts=Acts.CONTOUR, handler="cycles.roughing_cycles:contour_moves", f=FWord.FEED,
    not_when=_NOT_READY,
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
    Code, acts=Acts.MOTION, handler="cycles.threading_cycles:thread_blocks", f=FWord.FEED, least_blocks=4,
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
    Code, acts=Acts.MODE, handler="motion.feeds:coarse_line", group="coarse feed",
    not_in_mdi="{code} needs a G92 on the next line, but MDI runs only one line.",
)
_COARSE_ALONE = Refusal(
    "not-alone",
    "G{number} must be alone on its line.",
    "Write the other words on a separate line.", 1
)
CYCLE_CHAPTERS: tuple[Chapter, ...] = (
    ("Cycles", (
        Code("G81", "G81ZnFn",
        "Drills to Z, then retracts at rapid.", "X0Z.1\nG81Z-.3F.004",
            acts=Acts.CYCLE, handler="cycles.drilling_cycles:drill_moves", words=names("X Z F S"),
            f=FWord.FEED,
            not_when=_NOT_READY, rules={"Z": _DEPTH}, least_blocks=2, further=names("cycle-depth")),
        Code("G83", "G83ZnKnFnRnLnCn", "Drills in pecks of K, retracting to R.", "X0Z.1\nG83Z-.65K.2F.004",
            acts=Acts.CYCLE, handler="cycles.drilling_cycles:peck_moves", words=names("X Z C K R L F S"),
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
            "G74X.3Z-.5I.05U.01F.006", acts=Acts.CYCLE, handler="cycles.roughing_cycles:box_moves",
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
        flow("RF", "RF", "Ends the contour description for G75 and G78.", f"G78U.02F.004\n{_CONTOUR}\nRF",
            handler="flow.loops_and_subroutines:Flow.contour", words=names("RF"), deletable=False,
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
)
# fmt: on
