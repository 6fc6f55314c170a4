"""The checks of the part: one entry each, from which the findings and ``docs/checks.md`` come."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.language.diagnostics import Severity


@dataclass(frozen=True, slots=True)
class Check:
    """One check: what it looks for, how it decides, and what to do when it finds something."""

    severity: Severity
    looks_for: str
    decides: str
    remedy: str


_ERROR, _WARNING = Severity.ERROR, Severity.WARNING

CHECKS: Mapping[str, Check] = {
    "rapid-into-stock": Check(
        _ERROR,
        "A rapid, or a feed of 100 in/min and more, takes off metal.",
        "The edge meets more than .001 in of metal in r and in Z.",
        "Stop short of the metal and feed in: look for a G00 left on, and for a sign or a decimal point.",
    ),
    "feed-into-holder": Check(
        _ERROR,
        "Metal is fed into holder, shank or boring bar.",
        "At a feed an outline that cannot cut meets more than .001 in, or a cut is deeper than the edge.",
        "Use a longer or slimmer tool, or another direction of cut, or less depth.",
    ),
    "holder-into-stock": Check(
        _ERROR,
        "Holder, shank or boring bar runs into metal at a rapid.",
        "An outline that cannot cut overlaps metal by more than .001 in.",
        "Use a longer or slimmer tool, or another direction of cut.",
    ),
    "into-chuck": Check(
        _ERROR,
        "A tool, or its holder, runs into chuck, jaws or collet.",
        "An outline comes into the contour that the machine file gives under [clamping].",
        "Let the part stick out further, or stop earlier.",
    ),
    "neighbour-tool": Check(
        _ERROR,
        "Another tool of the gang plate runs into the stock.",
        'With [tooling] kind = "gang": its outline, placed by its tool offset, overlaps metal.',
        "Take another way there, a shorter tool, or another place on the plate.",
    ),
    "spindle-overspeed": Check(
        _ERROR,
        "The spindle turns faster than chuck or collet may.",
        "A commanded speed over max_rpm under [clamping] of the machine file.",
        "Lower S, or limit G96 by G77.",
    ),
    "larger-than-stock": Check(
        _ERROR,
        "The part is larger than its stock: a contour is cut in the air outside the bar.",
        "A feed along Z beside the stock, .1 in and longer, stays .08 in and more outside of it.",
        "Check the stock, and X as a radius or a diameter.",
    ),
    "cuts-air": Check(
        _WARNING,
        "A feed goes on where there is no metal.",
        "It stays more than .08 in from all metal for 5 s and .2 in of its way.",
        "Look for a lost minus or decimal point; move there by a rapid.",
    ),
    "unmade-cut": Check(
        _ERROR,
        "A cutting move leads away from the part, and nothing is cut where the program seems to mean it.",
        "A feed of .1 in and more leads away from the part and cuts nothing, and the next goes on there.",
        "Look for a lost minus (Z.5 for Z-.5) or a lost decimal point (X4 for X.4).",
    ),
    "part-off-unsupported": Check(
        _WARNING,
        "What is parted off is long and held by nothing.",
        "It is longer than five times its diameter.",
        "Support it, or part it off in two steps.",
    ),
    "through-part": Check(
        _ERROR,
        "The tool retracts through the part.",
        "A rapid right behind a cut takes off metal at a smaller radius than the cut.",
        "Go out along X before Z, or in a bore along Z before X.",
    ),
    "drill-too-deep": Check(
        _ERROR,
        "A drill goes deeper than its flutes are long.",
        "The hole is deeper than the cutting length of the drill.",
        "Use a longer drill, or peck and check the length that was entered.",
    ),
    "wrong-spindle-direction": Check(
        _WARNING,
        "The spindle turns against the cutting edge.",
        "M04 with a right-hand drill, tap or reamer; M03 with a left-hand one.",
        "Change M03 and M04, or the hand that the tool's shape says.",
    ),
    "chip-load": Check(
        _WARNING,
        "The feed is larger than the nose can cut.",
        "A feed per turn over .8 of the nose radius along a turned face.",
        "Lower F, or look for a lost decimal point (F.03 for F.003).",
    ),
}
