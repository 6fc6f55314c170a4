"""The checks of the proof: one entry each, from which the findings and ``docs/checks.md`` come."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.language.diagnostics import Diagnostic, Severity

STOCK, TOOL, KIND, HOLES = "stock", "tool", "kind of tool", "earlier holes"


@dataclass(frozen=True, slots=True)
class Check:
    """One check: what it looks for, how it decides, and what to do when it finds something.

    ``rests_on`` is what it takes from stock and tools: where these are not stated, it is only assumed.
    ``KIND`` is the kind of tool, which a comment may give; ``HOLES`` are those of drills without a size.
    """

    severity: Severity
    looks_for: str
    decides: str
    remedy: str
    rests_on: tuple[str, ...] = (STOCK, TOOL)


_ERROR, _WARNING = Severity.ERROR, Severity.WARNING

CHECKS: Mapping[str, Check] = {
    "rapid-into-stock": Check(
        _ERROR,
        "A rapid, or a feed of 100 in/min and more, takes off metal.",
        "The edge meets more than .001 in of metal in r and in Z.",
        "Stop short of the metal and feed in: look for a rapid left on, and for a sign or a decimal point.",
    ),
    "feed-into-holder": Check(
        _ERROR,
        "Metal is fed into holder, shank or boring bar.",
        "At a feed an outline that cannot cut meets more than .001 in.",
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
        "An outline comes into the contour that the machine file gives under [clamping], or within .001 in "
        "of it.",
        "Let the part stick out further, or stop earlier.",
        (TOOL,),
    ),
    "near-chuck": Check(
        _WARNING,
        "A tool, or its holder, nearly touches chuck, jaws or collet.",
        "Less than .01 in of Z is left between an outline and the contour under [clamping].",
        "Let the part stick out further, or stop earlier.",
        (TOOL,),
    ),
    "into-tailstock": Check(
        _ERROR,
        "A tool, or its holder, runs into the tailstock's centre or quill.",
        "An outline comes into the contour of quill and centre that the machine file gives under [clamping].",
        "Take another way there, or a slimmer holder; draw the quill back for what needs the face.",
        (TOOL,),
    ),
    "neighbour-tool": Check(
        _ERROR,
        "Another tool of the gang plate runs into the stock.",
        'With [tooling] kind = "gang": its outline, placed by its tool offset, overlaps metal.',
        "Take another way there, a shorter tool, or another place on the plate.",
        (STOCK,),
    ),
    "tools-in-one-place": Check(
        Severity.NOTE,
        "Two tools have the same offset.",
        "The offsets of two described tools are less than .04 in apart.",
        "Remove the offset of the tool that is not mounted.",
        (),
    ),
    "spindle-overspeed": Check(
        _ERROR,
        "The spindle turns faster than chuck or collet may.",
        "A commanded speed over max_rpm under [clamping] of the machine file.",
        "Lower S, or limit the speed under G96.",
        (),
    ),
    "drill-without-limit": Check(
        _ERROR,
        "A drill works on the axis under constant surface speed.",
        "A drill, centre drill, reamer or tap cuts under G96 with no limit in force: the spindle runs at its "
        "highest speed.",
        "Program the speed of a drill in rpm.",
        (TOOL,),
    ),
    "cut-standing": Check(
        _ERROR,
        "A tool is fed into the part while neither tool nor spindle turns.",
        "A drill, reamer, mill, turning tool or parting blade meets more than .001 in of material while no "
        "live tool is on and the spindle, which has turned before, is stopped or held as C. Not where the "
        "machine file has no M code for a live tool.",
        "Start the spindle, or the live tool, before this move.",
    ),
    "stock-whips": Check(
        _WARNING,
        "The spindle turns so fast that the stock may whirl.",
        "More than half of the first critical speed of what sticks out, as a bar of brass held at one end.",
        "Lower S, limit the speed under G96, let the part stick out less, or support it.",
    ),
    "larger-than-stock": Check(
        _ERROR,
        "The part is larger than its stock: a contour is cut in the air outside the bar.",
        "A feed along Z beside the stock, .1 in and longer, stays .08 in and more outside of it.",
        "Check the stock, and X as a radius or a diameter.",
        (STOCK,),
    ),
    "cuts-air": Check(
        _WARNING,
        "A feed goes on where there is no metal.",
        "One stays more than .08 in from all metal for 5 s and .2 in, or several in a row for 20 s.",
        "Look for a lost minus or decimal point; move there by a rapid.",
    ),
    "unmade-cut": Check(
        _ERROR,
        "A cutting move leads away from the part, and nothing is cut where the program seems to mean it.",
        "A feed leads away from the part, or out before its face; feeds between two rapids, or those of a "
        "live tool, come near no metal; a rapid goes in and out beside the part with nothing cut; a tool "
        "that comes to the part is never fed; a drill is fed into a hole that is there already.",
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
    "rubs-surface": Check(
        _WARNING,
        "The tool rubs along the finished surface.",
        "A described turning tool returns along Z by a rapid, .1 in and more, on the radius it has turned.",
        "Move X away from the part before Z.",
    ),
    "drill-too-deep": Check(
        _ERROR,
        "A drill goes deeper than its flutes are long.",
        "The hole is deeper than the cutting length of the drill; without a length the proof says so.",
        "Use a longer drill, or peck and check the length that was entered.",
    ),
    "drill-off-axis": Check(
        _ERROR,
        "A drill, reamer or tap cuts beside the spindle axis.",
        "It takes off material more than .004 in off the axis while the spindle turns.",
        "Move to X0 before drilling, and check the X offset of the tool.",
        (TOOL,),
    ),
    "past-stock": Check(
        _ERROR,
        "A tool is fed beyond the far end of the stock.",
        "A cut ends more than .1 in, and a drill more than .1 in and its diameter, beyond the stated stock.",
        "Check Z, the length of the stock and how far it sticks out of the chuck.",
        (STOCK,),
    ),
    "no-bore": Check(
        _ERROR,
        "A boring tool enters solid material.",
        "A tool that works in a bore is fed .04 in and more into material that has no bore yet.",
        "Drill the bore first, or check the bore of the stock.",
        (STOCK, KIND),
    ),
    "tap-no-hole": Check(
        _ERROR,
        "A tap cuts more than its thread: it has no hole, or goes beyond the bottom of the hole.",
        "It takes off more than its pitch in r.",
        "Drill the hole for the tap, deep enough for its chamfer.",
        (STOCK, TOOL, HOLES),
    ),
    "wrong-spindle-direction": Check(
        _ERROR,
        "The spindle turns against the cutting edge.",
        "M04 with a right-hand drill, reamer or tap, M03 with a left-hand one; M04 with a turning or boring "
        "tool in front of the axis that is mounted upright; or one edge is made to cut both ways.",
        "Reverse the spindle, or correct the hand in the shape of the tool.",
    ),
    "wrong-side": Check(
        _WARNING,
        "An insert cuts with its back.",
        "Fed backwards over .02 in and two nose radii deep, or into a wall that is steeper than its back.",
        "Use a tool of the other hand, a slimmer insert, or cut from the other side.",
    ),
    "arc-loop": Check(
        _ERROR,
        "An insert is fed around a loop through the part.",
        "An arc through more than 200° meets material; not of a round insert.",
        "Check the direction of the arc, and the signs of its center.",
    ),
    "hollow-at-edge": Check(
        _WARNING,
        "An arc hollows out the front edge of the part, where an edge is usually rounded.",
        "A quarter circle, radius up to .118 in, begins along Z at the face and ends away from the axis.",
        "Check the direction of the arc: the other one rounds the edge.",
    ),
    "over-axis": Check(
        _ERROR,
        "An outside tool cuts beyond the axis.",
        "Behind the face it cuts more than .06 in beyond the axis, where it is not mounted, or .004 in on a "
        "cut along Z.",
        "Look at the sign of X, and for a lost decimal point (X-03 for X-.03).",
    ),
    "past-part-off": Check(
        _ERROR,
        "The bar is cut far behind where the part is parted off.",
        "A feed along Z ends more than .5 in, and more than the part is long, behind the deepest part-off.",
        "Look for a lost decimal point (Z-3 for Z-.3).",
    ),
    "contour-past-part-off": Check(
        _WARNING,
        "An arc of the contour is not on the part.",
        "An insert cuts an arc more than .008 in on the bar's side of the deepest part-off.",
        "Check the Z of the part-off: the part would lack what is behind it.",
    ),
    "part-off-left": Check(
        _WARNING,
        "A parting tool stops just before the axis.",
        "It comes nearer than .04 in to the axis, not to it, and nothing falls off.",
        "Go on to X0 or a little beyond: look for a lost minus.",
    ),
    "depth-of-cut": Check(
        _WARNING,
        "One pass is deeper than usual for its insert.",
        "With a stated stock, the mean depth: over .5 of the cutting edge of a C or S insert, .4 of W, .3 of "
        "T and D, .2 of V (Widia's limits for medium geometries, nose radius left off; CNMG432 where no "
        "insert is stated). The material is not known: soft metal may allow more.",
        "Take it off in several passes: look for a lost or exchanged digit in X.",
    ),
    "depth-breaks-tool": Check(
        _ERROR,
        "One pass is deeper than its insert or its boring bar can take.",
        "With a stated stock and a spindle that turns, the mean depth: over 2/3 of the cutting edge of a "
        "stated C or S insert, half of W, T and D, a quarter of V, .4 of a round one, or over half the "
        "diameter of a boring bar.",
        "Take it off in several passes: look for a lost or exchanged digit in X.",
    ),
    "blade-turns": Check(
        _ERROR,
        "A parting or grooving blade turns along Z.",
        "Further than it is wide, and deeper than .01 in (parting) or .8 of its width (grooving: Ingersoll).",
        "Check the tool number; widen a groove by plunges side by side.",
    ),
    "chip-load": Check(
        _WARNING,
        "The feed per revolution is larger than the edge can cut.",
        "Over .8 of the nose radius, .12 of the width of a groover, .04 of the diameter of a drill, .1 of a "
        "reamer.",
        "Lower F, or look for a lost decimal point (F.03 for F.003).",
    ),
    "feed-breaks-tool": Check(
        _ERROR,
        "The feed per revolution is far over what the edge can cut.",
        "An insert: more than twice its nose radius, and more than .006 in. A drill, a reamer or a blade: "
        "more than five times the limit of chip-load.",
        "Lower F: look for a lost decimal point, or for millimeters in a program in inches.",
    ),
    "thread-run-up": Check(
        _WARNING,
        "A thread begins before the slide has the speed of its lead, or ends while it brakes.",
        "The metal begins nearer to the start of the pass than v²/2a of the slide; or the pass stops in "
        "metal and v²/2a is more than a lead.",
        "Start farther away, lower S, end in a groove, or pull out while the slide moves along Z.",
    ),
    "thread-in-air": Check(
        _WARNING,
        "The first passes of a thread cut nothing.",
        "With a stated stock, three passes and more stay outside the metal.",
        "Begin at the diameter of the first pass: check X where the thread starts.",
    ),
    "thread-cuts-nothing": Check(
        _ERROR,
        "A thread is cut beside the part.",
        "With a stated stock, no pass of one lead between the same two places in Z meets any material.",
        "Check X and Z of the thread, and whether X is a diameter.",
    ),
    "thread-form": Check(
        _WARNING,
        "A thread does not fit its lead.",
        "It is deeper than a sharp V of the lead.",
        "Check K, X of the last pass, and the X where it starts.",
    ),
    "thread-pitch": Check(
        _ERROR,
        "A thread is not cut by the pitch of its insert.",
        "The lead is not a multiple of the pitch that the shape of the tool states.",
        "Check K and the insert. Leave the pitch of a partial-profile insert out of its shape.",
        (TOOL,),
    ),
    "tap-pitch": Check(
        _ERROR,
        "A tap is not fed by its pitch.",
        "The feed of a turn is off by more than .08 of the pitch that its shape or its comment gives.",
        "Write F as the pitch: 1 divided by the threads per inch.",
        (TOOL,),
    ),
    "tap-reversal": Check(
        _ERROR,
        "A tap is drawn out of its thread and not turned out.",
        "It leaves by a rapid, with the spindle stopped or not reversed, by another feed, or the spindle "
        "needs more than .5 in to stand. Not asked of a holder that reverses by itself, as its comment says.",
        "Reverse the spindle at the bottom and feed out by the pitch.",
        (TOOL,),
    ),
}

PROGRAM_CHECKS: Mapping[str, Check] = {
    "no-tool": Check(
        _ERROR,
        "A cut with no tool in force.",
        "A move that cuts before the first T or after T0; a warning where the program names no tool at all.",
        "Write T with the tool's number before it.",
    ),
    "collet-open": Check(
        _ERROR,
        "A cut with the collet open.",
        "Metal is cut behind M13; a warning where a feed does not lead away as a bar is pulled, or the next "
        "cycle would begin with an open collet.",
        "Close the collet with M12.",
    ),
    "live-tool-off": Check(
        _ERROR,
        "A live tool stands while it mills.",
        "A move of plane switching with no live tool on; a warning with the spindle held as C.",
        "Switch it on by the M code that the machine file gives.",
    ),
    "no-speed-limit": Check(
        _WARNING,
        "Constant surface speed without a limit.",
        "A cut under G96 without G77 asks for more than the spindle's highest speed, as at the axis.",
        "Write G77S with the highest speed for this chuck and bar after G96.",
    ),
    "surface-speed": Check(
        _ERROR,
        "An rpm where a surface speed is meant.",
        "S under G96 is over 1000 m/min (3280 ft/min), and asks for twice the spindle's speed.",
        "Correct S, or write G97 for rpm.",
    ),
    "spindle-off": Check(
        _WARNING,
        "A cut with the spindle stopped.",
        "A feed by time after M05, with no live tool on; an error with a feed per turn, G33 or G96.",
        "Start it with M03 or M04.",
    ),
    "start-place": Check(
        _WARNING,
        "The first move is incremental.",
        "G91 before any move to a place: it begins where the slides stand.",
        "Begin with X and Z under G90.",
    ),
    "no-input": Check(
        _ERROR,
        "The machine has no such input.",
        "M91 to M97 ask for one that the machine file does not name.",
        "Correct the number, or name it under [io.in].",
    ),
    "unreached-branch": Check(
        _WARNING,
        "Lines that no way through the program has reached.",
        "Calls by inputs, block delete and loops are followed both ways, as far as the proof goes.",
        "Look at the call, or prove again with the inputs that lead there.",
    ),
}
"""What is found without the stock: beside tool, collet, spindle, inputs and ways through the program."""


def is_serious(found: Diagnostic) -> bool:
    """Return whether a finding is an error, or would be one if what it assumes were stated."""
    if found.severity is Severity.ERROR:
        return True
    return bool(found.assumed) and not found.silenced and CHECKS[found.check].severity is Severity.ERROR
