"""Error and warning texts with remedies, for source lines that are changed or not convertible."""

from __future__ import annotations

from collections.abc import Mapping

from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.message import Message

ERRORS: Mapping[str, tuple[str, str]] = {
    "angle-word": (
        "{word}: an angle is converted only with either X or Z.",
        "Write the end point with X and Z.",
    ),
    "arc-centre": ("The arc has neither R nor a center.", "Write R, or I and K."),
    "arc-radius": (
        "The arc's radius is {first} at its start and {last} at its end.",
        "Correct the end point or the center.",
    ),
    "arc-short": (
        "The arc is too short for the resolution of the other control, which may cut a full circle.",
        "Replace the arc with a straight move.",
    ),
    "arc-too-small": (
        "R{radius} is too small for an arc between these points.",
        "Correct R or the end point.",
    ),
    "bad-word": ("{text} cannot be read as a word.", "Correct the text."),
    "c-axis": (
        "{word} moves the C axis or a live tool; this conversion supports only turning.",
        "Write these lines for the C axis of this control by hand.",
    ),
    "c-axis-target": (
        "The line uses the C axis, a live tool or a move that a lathe with only X and Z does not have.",
        "Write this line for the other control by hand.",
    ),
    "code-unknown": (
        "{word} is not supported by the conversion.",
        "Replace the code with moves, or remove it if it is not needed.",
    ),
    "comp-cycle": (
        "{word} is active in a cycle or on an arc where OmniTurn cannot start nose compensation.",
        "Start and end nose compensation on straight moves outside the cycle.",
    ),
    "corner": (
        "{word}: the corner does not fit between this move and the next one.",
        "Write the corner as separate moves.",
    ),
    "cycle-contour": (
        "The contour of the cycle from N{first} to N{last} was not found.",
        "Correct P and Q of the cycle.",
    ),
    "cycle-empty": (
        "The contour of the cycle has no moves after its first one.",
        "Add the moves of the contour, or remove the cycle.",
    ),
    "cycle-incremental": ("{word} is not converted while G91 is active.", "Write G90 before the cycle."),
    "cycle-nested": ("{word} is in the contour of another cycle.", "Write the contour with moves only."),
    "cycle-offset": (
        "{word}: a segment of the contour is too short for the distance of the cycle.",
        "Reduce the distance, or write the contour with longer segments.",
    ),
    "cycle-positive": ("{word}: this value must be greater than zero.", "Correct the value."),
    "cycle-sideways": (
        "{word}: the end point of the cuts next to the first one does not match their step.",
        "Write both words, or neither of them.",
    ),
    "cycle-start": ("The cycle starts inside its contour.", "Start the cycle outside the contour."),
    "cycle-undercut": (
        "The contour of the cycle moves back in {axis}, so that a pass cannot reach it.",
        "Cut the undercut with separate moves.",
    ),
    "cycle-word": ("{word} is missing in the cycle.", "Add the word to the cycle."),
    "division": ("The expression divides by zero or has no value.", "Correct the expression."),
    "dwell-negative": ("{word}: a dwell cannot be negative.", "Correct the time."),
    "endless": (
        "The program executes more than {most} lines.",
        "Correct the loop, or shorten the program.",
    ),
    "expression": ("{text} cannot be evaluated.", "Write the number."),
    "feed-missing": ("No feed F is programmed for this move.", "Write F on this line or earlier."),
    "feed-no-point": (
        "{word}: the value of a feed per revolution without a decimal point depends on a parameter.",
        "Write F with a decimal point.",
    ),
    "feed-resolution": (
        "The feed {feed} is too small for the decimal places of F on the other control.",
        "Write a larger feed, or a feed with fewer decimal places.",
    ),
    "file-empty": ("The file contains no moves.", "Choose a file that contains a turning program."),
    "hole-plane": (
        "{word} drills along Y while G18 is active.",
        "Write G17 before the cycle.",
    ),
    "home-feed": (
        "The move to machine home is not a rapid, but the other control always moves there in rapid.",
        "Write G00 on this line.",
    ),
    "input-of-lathe": (
        "The line depends on an input of this lathe.",
        "Write this line for the other control by hand.",
    ),
    "inverse-time": ("G93 (inverse time feed) is not supported.", "Write feeds with G94 or G95."),
    "label": ("The target {word} does not exist in this file.", "Add the line number, or correct the jump."),
    "lead-resolution": (
        "The lead {lead} has more decimal places than F of the other control, so that the end of the thread "
        "would be displaced.",
        "Write the program in inches, or write a lead with fewer decimal places.",
    ),
    "m-code": (
        "{word} has no meaning on this machine.",
        "Define the M code under [m_codes] in the machine file, or leave it out with --skip-m {number}.",
    ),
    "m-code-target": (
        "{word} turns a function of this lathe on or off.",
        "Write the code of the other lathe by hand, and leave this code out with --skip-m {number}.",
    ),
    "machine-point": (
        "The move without a tool offset does not end at machine home.",
        "Select a tool before this move, or move to X0 and Z0.",
    ),
    "motion-missing": (
        "No G code for a move is active here.",
        "Write G00 or G01 on this line.",
    ),
    "no-point": (
        "{word} has no decimal point, and its value depends on a parameter of the other control.",
        "Use --no-point 1 if X1000 is 1000 units, or --no-point 0.001 if X1000 is 1 mm (.1 in).",
    ),
    "offset-dependent": (
        "The move depends on the tool offsets of this lathe, because no move after T has set X and Z.",
        "Write an absolute X and Z in the first move after T.",
    ),
    "parentheses": ("The comment has no closing parenthesis.", "Add the parenthesis."),
    "plane": (
        "{word} is not possible while the plane of {plane} is active.",
        "Write G18 before this line if the program is a turning program.",
    ),
    "position": (
        "The position in {axis} is unknown here, because no earlier line programs it.",
        "Write an absolute X and Z before this line.",
    ),
    "preset-before-move": (
        "G92 presets {axis} at a position that depends on the tool offset, because T{number} has not moved "
        "in {axis} since its tool change.",
        "Set the tool offset for part zero and remove this G92, or move to an absolute X and Z before it.",
    ),
    "preset-target": (
        "A position preset at an unknown position, or before a tool change, cannot be converted.",
        "Write the moves in the coordinates of part zero.",
    ),
    "spindle-start": (
        "{word} stops the spindle, and neither M03 nor M04 follows before the cut.",
        "Add M03 or M04 after the tool change.",
    ),
    "subprogram": (
        "The subprogram {word} is not in this file.",
        "Add the subprogram to the file, after the main program.",
    ),
    "preset-cancelled": (
        "{word} cancels a position preset, so that the positions after it depend on the other control.",
        "Write the positions that apply after this line, and remove the preset and this code.",
    ),
    "spindle-negative": (
        "{word}: spindle speed cannot be negative.",
        "Remove the sign; M03 and M04 set the direction.",
    ),
    "spindle-speed": ("{word}: no speed is programmed for the spindle.", "Write S before the first cut."),
    "spindle-zero": ("{word}: the spindle cannot turn at this speed.", "Write M05 to stop the spindle."),
    "surface-speed": ("G96 is active, but S is missing.", "Write S with G96."),
    "thread-chain": (
        "The thread is not followed by a rapid straight out in X, so it cannot be cut in separate passes.",
        "End the thread with a rapid in X.",
    ),
    "thread-degression": ("{word}: R must be 1 or more.", "Correct R."),
    "thread-ends": (
        "{word}: OmniTurn cannot cut a thread with a tapered entry.",
        "Remove L and E, and start the thread in front of the part or in a groove.",
    ),
    "thread-lead": ("The thread has no lead.", "Write F with the lead of the thread."),
    "tool-post": (
        "LinuxCNC calculates G02, G03, G41 and G42 in Z and X, whatever side the tool post is on.",
        "Select the rear tool post: leave out --tool-post front.",
    ),
    "too-many-moves": (
        "The program makes more than {most} moves.",
        "Correct the loop or the cycle, or convert the program in parts.",
    ),
    "too-many-passes": ("{word} makes more than 1000 passes.", "Correct the depth of a pass."),
    "tool-and-offset": (
        "{word}: the tool and its offset have different numbers, so that T of the other control would change "
        "the tool.",
        "Write the offset with the number of the tool; add a second cutting edge (D2) by hand.",
    ),
    "tool-number": ("{word}: OmniTurn has the tools T1 to T32.", "Change the tool number."),
    "unit": (
        "The program selects neither inches nor millimeters before this line.",
        "Add G20 or G21 at the start, or use --unit.",
    ),
    "variable": (
        "The variable {word} has no value, or its value comes from the other machine.",
        "Assign the value at the start of the program.",
    ),
    "work-offset": (
        "{word} selects a second work offset, whose values are stored in the other control.",
        "Write the shift as G10 before T in the converted program, or convert each part separately.",
    ),
    "word-twice": (
        "{word} and {other} on the same line contradict each other.",
        "Remove one of them, or write two lines.",
    ),
}
WARNINGS: Mapping[str, tuple[str, str]] = {
    "approach-joined": (
        "OmniTurn needs X and Z in the first move after T, so the first moves are joined to one rapid.",
        "Check that the path from the tool change position to this point is clear.",
    ),
    "block-delete": (
        "{word}: the line is converted as if block delete were off, and / is left out.",
        "Check whether this line must be executed.",
    ),
    "contour-action": (
        "Line {line} of the contour switches something; roughing does not execute it.",
        "Check that a G70 executes this line, or move it before the cycle.",
    ),
    "cycle-version": (
        "{word}: newer LinuxCNC versions add a move straight out at the end of this contour.",
        "Check the end of the contour, or write this move at its end.",
    ),
    "dwell-short": (
        "{word} is shorter than the shortest dwell of OmniTurn; 0.1 s is used.",
        "Check the dwell.",
    ),
    "dwell-unit": (
        "{word}: the unit of a dwell is a setting of the Mach control; seconds are assumed.",
        "Check the dwell.",
    ),
    "far-side-tool": (
        "T{number} cuts only at negative X, so it is on the other side of the part.",
        "Mount the tool on that side too, or edit the program: "
        "mirror the moves of this tool and reverse the spindle.",
    ),
    "feed-limited": (
        "{word} is above the maximum feed of this machine; the maximum is used.",
        "Check the feed.",
    ),
    "feed-rounded": (
        "The feed {feed} is rounded to {rounded}.",
        "No action is needed.",
    ),
    "home-fixed-point": (
        "A move to machine home becomes G75, which moves to fixed point 1 of the other lathe.",
        "Check that its machine data (MD30600 of X and Z) contain a safe point for the tool change.",
    ),
    "home-stored-point": (
        "A move to machine home becomes G30, which moves to a point that is stored in the other control.",
        "Store a safe point for the tool change there with G30.1.",
    ),
    "home-position": (
        "{word} moves to a position of the other machine; the converted program moves to machine home.",
        "Check that the path to home is clear.",
    ),
    "left-out": ("{word} has no counterpart and is left out.", "Check that the code is not needed."),
    "machine-code": (
        "{word} does what the machine file of this machine defines.",
        "Check that this is the function of the code on the other control.",
    ),
    "maximum-speed-added": (
        "The program has no maximum spindle speed for G96; the maximum of this lathe, {rpm} rpm, is used.",
        "Check that this speed is permitted on the other lathe and for its chuck.",
    ),
    "minimum-speed": (
        "{word}: the other control has no minimum spindle speed, so the code is left out.",
        "Check the spindle speed at large diameters.",
    ),
    "nose-offset": (
        "Nose compensation uses D{number}.",
        "Enter the nose radius in secondary offset D{number}.",
    ),
    "nose-start": (
        "LinuxCNC does not cut the contour within one nose radius of the end of this approach.",
        "Check that the contour starts more than one nose radius away from the finished part.",
    ),
    "nose-table": (
        "T{number} uses nose compensation.",
        "Enter the nose radius and the tip orientation of T{number} on the other control.",
    ),
    "not-executed": (
        "The program does not execute the lines {first} to {last}, so that they are not converted.",
        "Check that these lines are not needed.",
    ),
    "offset-cancelled": (
        "{word} cancels the tool offset; the converted program cancels it at the next T or home.",
        "Check the moves that follow.",
    ),
    "peck-clearance": (
        "The distance before the next peck is a parameter of the other control; {value} mm is used.",
        "Check the pecks.",
    ),
    "plane": (
        "{word} has no effect on straight moves in X and Z and is left out.",
        "Check that the program is a turning program.",
    ),
    "rapid-path": (
        "The other control may move X and Z in G00 each at its own rate, so that the path is not straight.",
        "Check each rapid with both axes for collisions, or set the control to straight rapids.",
    ),
    "repeat": (
        "M99 repeats the main program; the converted program ends with M30.",
        "Turn on Cycle Repeat to make several parts.",
    ),
    "replaced": ("{word} is replaced by {replacement}.", "Check that the codes have the same function."),
    "secondary-offset": (
        "D{number} of T{tool} is left out, because the other control has one offset for each tool.",
        "Enter the correction in the wear offset of T{tool}.",
    ),
    "speed-limited": (
        "{word} is above the maximum spindle speed of this machine; the maximum is used.",
        "Check the speed.",
    ),
    "speed-rounded": (
        "S{speed} is rounded to S{whole}.",
        "No action is needed.",
    ),
    "tapping": (
        "The program taps with a reversal of the spindle, which may take longer on the other lathe.",
        "Replace these moves with the tapping cycle of the other control, or try them without a part.",
    ),
    "thread-pull-out": (
        "The thread's pull-out at an angle is replaced by a pull-out straight in X at the end of the thread.",
        "Check that the thread has a relief groove.",
    ),
    "tool-change-place": (
        "T{number} is changed at the last position of T{before}; this lathe does not move for a tool change.",
        "Check that the turret can index there, or move to machine home before T{number}.",
    ),
    "tool-of-offset": (
        "{word}: the tool of the converted program is T{number}, because OmniTurn has one number for both.",
        "Check the number of the tool.",
    ),
}
NOTES: Mapping[str, tuple[str, str]] = {
    "block-delete-kept": (
        "{word}: the new lines are skipped if block delete is on, as in the old program.",
        "Set block delete as on the other control.",
    ),
    "no-change": (
        "{word} changes nothing at this point, so the converted program does not contain it.",
        "No action is needed.",
    ),
    "rapid-rate": (
        "Rapids move at the rate of the other lathe instead of {rate}.",
        "Reduce the rapid override there if this is too fast.",
    ),
    "shift-contained": (
        "The coordinates of the converted program contain the work shift or the preset of this line.",
        "No action is needed.",
    ),
    "slow-rapid": (
        "Moves at {rate} without G00 become G1 with this feed, because they may be cuts.",
        "Write G00 before the moves that are rapids.",
    ),
    "spindle-restarted": (
        "The tool change stops the spindle, so the converted program starts it again after T{number}.",
        "No action is needed.",
    ),
    "work-offset-g54": (
        "{word}: part zero of the converted program is in G54.",
        "Set G54 to this part zero.",
    ),
    "work-offset-used": (
        "{word}: part zero of the converted program is in the tool offsets.",
        "Set the tool offsets for this part zero.",
    ),
}
PROOF_ERRORS: Mapping[str, tuple[str, str]] = {
    "proof-differs": (
        "The converted program moves differently: {what} is {made} instead of {wanted}.",
        "Report this program; the converted program is not written.",
    ),
    "proof-length": (
        "The converted program has {made} steps instead of {wanted}.",
        "Report this program; the converted program is not written.",
    ),
    "target": ("The other control rejects the converted line {made}: {message}", "{hint}"),
}


def make_error(line: int, column: int, code: str, /, **values: object) -> ProgramError:
    """Return the error that ends the conversion at a position in the source program."""
    text, hint = ERRORS.get(code) or PROOF_ERRORS[code]
    return ProgramError(_finding(line, column, Severity.ERROR, code, text, hint, values))


def make_warning(line: int, column: int, code: str, /, **values: object) -> Diagnostic:
    """Return a warning for a source line whose conversion does not have exactly the same effect."""
    text, hint = WARNINGS[code]
    return _finding(line, column, Severity.WARNING, code, text, hint, values)


def make_note(line: int, column: int, code: str, /, **values: object) -> Diagnostic:
    """Return a note that the converted program does not need a word of the source program."""
    text, hint = NOTES[code]
    return _finding(line, column, Severity.NOTE, code, text, hint, values)


def _finding(
    line: int, column: int, severity: Severity, code: str, text: str, hint: str, values: dict[str, object]
) -> Diagnostic:
    return Diagnostic(line, column, severity, code, Message(text, **values), Message(hint, **values))
