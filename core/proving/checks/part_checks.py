"""The checks of the proof, one entry per check, for the findings and for ``docs/checks.md``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.language.diagnostics import Diagnostic, Severity

STOCK, TOOL, TOOL_KIND, EARLIER_HOLES = "stock", "tool", "tool type", "previously drilled holes"
_ERROR, _WARNING = Severity.ERROR, Severity.WARNING


@dataclass(frozen=True, slots=True)
class PartCheck:
    """One check with its purpose, its condition and the remedy.

    ``required_data`` lists the data of stock and tools on which the check depends. If these data are not
    specified, the finding is based on assumptions. ``TOOL_KIND`` means that only the kind of tool is
    required, which a comment may name. ``EARLIER_HOLES`` means that the check depends on holes of earlier
    drills, whose diameter may be unknown.
    """

    severity: Severity
    purpose: str
    condition: str
    remedy: str
    required_data: tuple[str, ...] = (STOCK, TOOL)


PART_CHECKS: Mapping[str, PartCheck] = {
    "rapid-into-stock": PartCheck(
        _ERROR,
        "A rapid, or a feed of 100 in/min or more, removes material.",
        "The cutting edge enters material by more than .001 in, both on the radius and in Z.",
        "Stop short of the material and feed in; look for a rapid that is still active, and "
        "for a wrong sign or decimal point.",
    ),
    "feed-into-holder": PartCheck(
        _ERROR,
        "A feed move runs the holder, shank or boring bar into material.",
        "During a feed move, the non-cutting part of a tool outline overlaps material by more than .001 in.",
        "Use a longer or slimmer tool, another cutting direction, or a smaller depth of cut.",
    ),
    "holder-into-stock": PartCheck(
        _ERROR,
        "A holder, shank or boring bar collides with material during a rapid.",
        "The non-cutting part of a tool outline overlaps material by more than .001 in.",
        "Use a longer or slimmer tool, or another cutting direction.",
    ),
    "into-chuck": PartCheck(
        _ERROR,
        "A tool or its holder collides with the chuck, jaws or collet.",
        "A tool outline overlaps the contour that the machine file defines under [clamping], "
        "or comes within .001 in of that contour.",
        "Increase the part stick-out, or stop the move earlier.",
        (TOOL,),
    ),
    "near-chuck": PartCheck(
        _WARNING,
        "A tool or its holder nearly touches the chuck, jaws or collet.",
        "The Z clearance between the outline of the tool or holder and the contour "
        "that the machine file defines under [clamping] is less than .01 in.",
        "Increase the part stick-out, or stop the move earlier.",
        (TOOL,),
    ),
    "into-tailstock": PartCheck(
        _ERROR,
        "A tool or its holder collides with the tailstock center or quill.",
        "The outline of a tool or holder overlaps the contour of the quill and center "
        "defined under [clamping] in the machine file.",
        "Use a different path or a slimmer holder; retract the quill for work on the face.",
        (TOOL,),
    ),
    "neighbour-tool": PartCheck(
        _ERROR,
        "Another tool on the gang plate collides with the stock.",
        'With [tooling] kind = "gang", the outline of another tool, positioned by its '
        "tool offset, overlaps material.",
        "Use a different path, a shorter tool, or another position on the gang plate.",
        (STOCK,),
    ),
    "tools-in-one-place": PartCheck(
        Severity.NOTE,
        "Two tools have the same offset.",
        "The offsets of two tools with defined shapes are less than .04 in apart.",
        "Remove the offset of the tool that is not mounted.",
        (),
    ),
    "spindle-overspeed": PartCheck(
        _ERROR,
        "The spindle turns faster than the chuck or collet allows.",
        "The commanded speed is higher than max_rpm under [clamping] in the machine file.",
        "Lower S, or limit the speed under G96.",
        (),
    ),
    "drill-without-limit": PartCheck(
        _ERROR,
        "A drill cuts on the spindle centerline with constant surface speed active.",
        "A drill, center drill, reamer or tap cuts under G96 without an active speed limit, "
        "so the spindle runs at its maximum speed.",
        "Program the speed of a drill in rpm.",
        (TOOL,),
    ),
    "cut-standing": PartCheck(
        _ERROR,
        "A tool feeds into the part while neither the tool nor the spindle turns.",
        "With no live tool running, a drill, reamer, mill, turning tool or parting blade "
        "cuts more than .001 in of material while the spindle is stopped, or while the "
        "spindle is clamped as the C axis after turning. Not checked if the machine file has "
        "no M code for a live tool.",
        "Start the spindle or the live tool before this move.",
    ),
    "stock-whips": PartCheck(
        _WARNING,
        "The spindle turns so fast that the stock may whip.",
        "The spindle speed is more than half the first critical speed of the protruding "
        "stock. The critical speed is calculated for a brass bar clamped at one end.",
        "Lower S, limit the speed under G96, reduce the overhang of the part, or support it.",
    ),
    "larger-than-stock": PartCheck(
        _ERROR,
        "The part is larger than its stock, so a contour is cut in air outside the bar.",
        "A feed move of .1 in or more along Z, next to the stock, stays at least .08 in outside the stock.",
        "Check the stock size, and check whether X is a radius or a diameter.",
        (STOCK,),
    ),
    "cuts-air": PartCheck(
        _WARNING,
        "A tool feeds through air without cutting.",
        "A feed move stays more than .08 in away from all material for 5 s and .2 in "
        "of travel, or several consecutive feed moves do so for 20 s.",
        "Look for a missing minus sign or decimal point; use a rapid to move through air.",
    ),
    "unmade-cut": PartCheck(
        _ERROR,
        "A cutting move feeds away from the part, so the cut that was probably intended is not made.",
        "One of these cases applies: a feed move goes away from the part or out past the "
        "part face; none of the feed moves between two rapids, or of a live tool, comes near "
        "material; the tool moves in and out alongside the part in rapid without a cut; a "
        "tool that reaches the part makes no feed moves; a drill feeds into an existing hole.",
        "Look for a missing minus sign (Z.5 for Z-.5) or a missing decimal point (X4 for X.4).",
    ),
    "part-off-unsupported": PartCheck(
        _WARNING,
        "The parted-off piece is long and unsupported.",
        "The parted-off piece is longer than five times its diameter.",
        "Support the part, or part it off in two steps.",
    ),
    "through-part": PartCheck(
        _ERROR,
        "The tool retracts through the part.",
        "A rapid directly after a cut removes material at a smaller radius than the cut.",
        "Retract along X before you move Z; in a bore, retract along Z before you move X.",
    ),
    "rubs-surface": PartCheck(
        _WARNING,
        "The tool rubs along the finished surface.",
        "A turning tool with a defined shape returns in rapid along Z, by .1 in or more, at "
        "the radius that it has just turned.",
        "Move X away from the part before you move Z.",
    ),
    "drill-too-deep": PartCheck(
        _ERROR,
        "A drill goes deeper than its flute length.",
        "The hole is deeper than the cutting length of the drill. A drill without a "
        "defined cutting length is reported.",
        "Use a longer drill, or peck and check the entered flute length.",
    ),
    "drill-off-axis": PartCheck(
        _ERROR,
        "A drill, reamer or tap is not on the spindle centerline when it cuts.",
        "A drill, center drill, reamer or tap cuts at a distance of more than .004 in "
        "from the spindle centerline while the spindle turns.",
        "Move to X0 before drilling, and check the X offset of the tool.",
        (TOOL,),
    ),
    "past-stock": PartCheck(
        _ERROR,
        "A tool feeds past the far end of the stock.",
        "A cut ends more than .1 in (for a drill, .1 in plus its diameter) beyond the end of "
        "the specified stock.",
        "Check Z, the length of the stock and how far it sticks out of the chuck.",
        (STOCK,),
    ),
    "no-bore": PartCheck(
        _ERROR,
        "A boring tool enters solid material.",
        "An internal tool feeds .04 in or more into material that has no bore yet.",
        "Drill the bore first, or check the bore of the stock.",
        (STOCK, TOOL_KIND),
    ),
    "tap-no-hole": PartCheck(
        _ERROR,
        "A tap removes more material than its thread, because the tap hole is missing or the "
        "tap goes past the bottom of the hole.",
        "The thread depth that the tap cuts, measured on the radius, is greater than the pitch.",
        "Drill the tap hole, deep enough for the chamfer of the tap.",
        (STOCK, TOOL, EARLIER_HOLES),
    ),
    "wrong-spindle-direction": PartCheck(
        _ERROR,
        "The spindle turns in the wrong direction for the cutting edge.",
        "M04 is used with a right-hand drill, reamer or tap, or M03 with a left-hand "
        "drill, reamer or tap; M04 is used with a turning or boring tool mounted "
        "upright in front of the spindle centerline; or the same cutting edge is used "
        "in both spindle directions.",
        "Reverse the spindle, or correct the hand in the tool shape.",
    ),
    "wrong-side": PartCheck(
        _WARNING,
        "An insert cuts with its trailing edge.",
        "The insert feeds backward at a depth of more than .02 in and more than two nose "
        "radii, or into a wall steeper than its trailing edge.",
        "Use a tool of the opposite hand or a slimmer insert, or cut from the other side.",
    ),
    "arc-loop": PartCheck(
        _ERROR,
        "A tool with a cutting insert is fed through the part along a large arc.",
        "An arc of more than 200° cuts material. Not checked for a round insert.",
        "Check the direction of the arc and the signs of its center coordinates.",
    ),
    "hollow-at-edge": PartCheck(
        _WARNING,
        "An arc cuts a concave shape into the front edge of the part, where the edge is usually rounded.",
        "An arc of 90° with a radius of up to .118 in starts in the Z direction at the "
        "part face and ends in the X direction, away from the spindle centerline.",
        "Check the direction of the arc; the opposite direction rounds the edge.",
    ),
    "over-axis": PartCheck(
        _ERROR,
        "An external tool cuts past the spindle centerline.",
        "Between the face and the chuck, the tool cuts more than .06 in past the "
        "spindle centerline (.004 in when cutting along Z), on the side opposite to "
        "where the tool is mounted.",
        "Check the sign of X, and look for a missing decimal point (X-03 for X-.03).",
    ),
    "past-part-off": PartCheck(
        _ERROR,
        "The bar is cut far past the part-off.",
        "A feed move along Z ends on the bar side of the part-off position nearest the "
        "chuck, past this position by more than .5 in and by more than the part length.",
        "Look for a missing decimal point (Z-3 for Z-.3).",
    ),
    "contour-past-part-off": PartCheck(
        _WARNING,
        "An arc of the contour is missing from the finished part.",
        "An insert cuts an arc more than .008 in past the part-off position nearest "
        "the chuck, on the bar side.",
        "Check the Z position of the part-off; everything past this position would be missing from the part.",
    ),
    "part-off-left": PartCheck(
        _WARNING,
        "A parting tool stops just short of the spindle centerline.",
        "The tool comes within .04 in of the spindle centerline but does not reach the "
        "centerline, and the part is not cut off.",
        "Feed to X0 or slightly past it; look for a missing minus sign.",
    ),
    "depth-of-cut": PartCheck(
        _WARNING,
        "One pass is deeper than usual for the insert.",
        "If the stock is specified, the mean depth of cut is more than .5 of the cutting "
        "edge length of a C or S insert, .4 for a W insert, .3 for a T or D insert, or .2 "
        "for a V insert (Widia's limits for medium geometries, without the nose radius; "
        "CNMG432 if no insert is specified). TurnDesk does not know the stock material; a "
        "soft material may allow more.",
        "Use several passes; look for a missing or wrong digit in X.",
    ),
    "depth-breaks-tool": PartCheck(
        _ERROR,
        "One pass is deeper than the insert or the boring bar can cut.",
        "If the stock is specified and the spindle is running, the mean depth of cut is more "
        "than 2/3 of the cutting edge length of a specified C or S insert, half of the edge "
        "length of a W, T or D insert, a quarter of the edge length of a V insert, .4 of a "
        "round insert, or half the diameter of a boring bar.",
        "Use several passes; look for a missing or wrong digit in X.",
    ),
    "blade-turns": PartCheck(
        _ERROR,
        "A parting or grooving blade turns along Z.",
        "The blade turns along Z by more than its width. The depth of cut is more than .01 "
        "in for a parting blade, or more than .8 of the blade width for a grooving blade "
        "(Ingersoll's limit). For a face grooving blade (tip quadrant 7), the same applies to "
        "X.",
        "Check the tool number; widen a groove with adjacent plunges.",
    ),
    "chip-load": PartCheck(
        _WARNING,
        "The feed per revolution is too high for the cutting edge.",
        "The feed per revolution is more than .8 of the nose radius, .12 of the width of a "
        "grooving tool, or .04 of the diameter of a drill (.1 of a reamer).",
        "Lower F, or look for a missing decimal point (F.03 for F.003).",
    ),
    "feed-breaks-tool": PartCheck(
        _ERROR,
        "The feed per revolution is far too high for the cutting edge.",
        "The feed per revolution is more than twice the nose radius of an insert and more "
        "than .006 in, or it is more than five times the chip-load limit of a drill, reamer "
        "or blade.",
        "Lower F; look for a missing decimal point, or for millimeters in an inch program.",
    ),
    "thread-run-up": PartCheck(
        _WARNING,
        "A thread starts before the Z axis has reached the speed required for the "
        "lead, or ends while the axis decelerates.",
        "The distance from the start of the pass to the material is less than the "
        "acceleration distance v²/2a of the Z axis, or the pass stops in material and v²/2a "
        "is more than one lead.",
        "Start farther from the material, lower S, end in a groove, or pull out while "
        "the tool moves along Z.",
    ),
    "thread-in-air": PartCheck(
        _WARNING,
        "The first passes of a thread cut nothing.",
        "If the stock is specified, three or more passes stay outside the material.",
        "Start at the diameter of the first pass; check X at the start of the thread.",
    ),
    "thread-cuts-nothing": PartCheck(
        _ERROR,
        "A thread pass does not touch the part.",
        "If the stock is specified, none of the passes with the same lead and the same Z "
        "range cuts any material.",
        "Check X and Z of the thread, and check whether X is a diameter.",
    ),
    "thread-form": PartCheck(
        _WARNING,
        "A thread is too deep for its lead.",
        "The thread is deeper than a sharp V thread of the same lead.",
        "Check K, the X of the last pass and the X where the thread starts.",
    ),
    "thread-pitch": PartCheck(
        _ERROR,
        "The lead of a thread does not match the pitch of its insert.",
        "The lead is not a multiple of the pitch in the tool shape.",
        "Check K and the insert. For a partial-profile insert, leave the pitch out of the tool shape.",
        (TOOL,),
    ),
    "tap-pitch": PartCheck(
        _ERROR,
        "The feed of a tap does not match its pitch.",
        "The feed per revolution differs from the pitch in the tool shape or comment by more "
        "than .08 of the pitch.",
        "Program the pitch as F. The pitch is 1 divided by the number of threads per inch.",
        (TOOL,),
    ),
    "tap-reversal": PartCheck(
        _ERROR,
        "A tap is pulled out of its thread instead of being backed out.",
        "The tap is retracted at rapid, with the spindle stopped, with the spindle not "
        "reversed, or at a feed that differs from the feed into the hole; or the tap travels "
        "more than .5 in before the spindle stops. Not checked if the comment says that the "
        "holder reverses automatically.",
        "Reverse the spindle at the bottom of the hole, and feed out at the pitch.",
        (TOOL,),
    ),
}

PROGRAM_CHECKS: Mapping[str, PartCheck] = {
    "no-tool": PartCheck(
        _ERROR,
        "A cutting move is programmed with no tool active.",
        "A cutting move is programmed before the first T or after T0. This is only a "
        "warning if the program never calls a tool.",
        "Write T and the tool number before this move.",
    ),
    "collet-open": PartCheck(
        _ERROR,
        "A cutting move is programmed with the collet open.",
        "A cutting move is programmed after M13. This is only a warning if the move is a "
        "feed move in any direction other than straight out from the spindle (as in a bar "
        "pull), or if the next cycle would start with the collet open.",
        "Close the collet with M12.",
    ),
    "live-tool-off": PartCheck(
        _ERROR,
        "A milling move is programmed while the live tool is off.",
        "A cutting move for milling the face or milling around the part is programmed with "
        "no live tool running. If the spindle is locked as the C axis, a cutting move with "
        "no live tool running is only a warning.",
        "Turn on the live tool with its M code from the machine file.",
    ),
    "no-speed-limit": PartCheck(
        _WARNING,
        "Constant surface speed has no speed limit.",
        "A cut under G96 without G77 requires more than the maximum spindle speed, for "
        "example at the spindle centerline.",
        "Write G77Sn after G96, where n is the maximum rpm for this chuck and bar.",
    ),
    "surface-speed": PartCheck(
        _ERROR,
        "S is an rpm value where a surface speed is expected.",
        "S under G96 is over 1000 m/min (3280 ft/min) and requires more than twice the "
        "maximum spindle speed.",
        "Correct S, or write G97 if S is in rpm.",
    ),
    "spindle-off": PartCheck(
        _WARNING,
        "A cutting move is programmed with the spindle stopped.",
        "A move in feed per minute is programmed after M05 with no live tool running. "
        "With feed per revolution, G33 or G96, this is an error.",
        "Start the spindle with M03 or M04.",
    ),
    "start-place": PartCheck(
        _WARNING,
        "The first move is incremental.",
        "G91 is programmed before any absolute move, so the first move starts from the "
        "current axis position.",
        "Start with a move to X and Z under G90.",
    ),
    "no-input": PartCheck(
        _ERROR,
        "The program uses an input that the machine does not have.",
        "M91 to M97 use an input that the machine file does not define.",
        "Correct the number, or define the input under [io.in].",
    ),
    "unreached-branch": PartCheck(
        _WARNING,
        "Some lines of the program are not reached during proving.",
        "The lines were not reached although TurnDesk proves both branches of "
        "input-dependent calls, block delete and loops, within its limits.",
        "Check the call, or prove the program again with the inputs that lead to the lines not reached.",
    ),
}
"""Checks that do not need the stock. They cover tool, collet, spindle, inputs and program paths."""


def is_serious_finding(finding: Diagnostic) -> bool:
    """Return whether a finding is an error, or would be an error if the assumed data were specified."""
    if finding.severity is Severity.ERROR:
        return True
    return (
        bool(finding.assumptions)
        and not finding.downgrade_reason
        and PART_CHECKS[finding.check_name].severity is Severity.ERROR
    )
