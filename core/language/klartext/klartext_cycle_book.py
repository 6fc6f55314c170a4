"""The code book of Klartext: coordinate transformations, cycles, M functions."""

from __future__ import annotations

from core.language.code_book import Entry
from core.message import Message


def transformations() -> tuple[Entry, ...]:
    """TRANS, and the cycles that shift, mirror, turn, scale and tilt."""
    go = "\nL X+20 Y+0 R0 F400"

    def older(number: int, name: str, line: str, what: str, refused: str, why: str) -> Entry:
        return Entry(
            Message("CYCL DEF {number}", number=number),
            f".0 {name}",
            what,
            f"CYCL DEF {number}.0 {name}\nCYCL DEF {number}.1 {line}{go}",
            f"CYCL DEF {number}.0 {name}\nCYCL DEF {number}.1 {refused}{go}",
            why,
            insert=f"CYCL DEF {number}.0 {name}\nCYCL DEF {number}.1 {line}",
        )

    return (
        Entry(
            "TRANS DATUM",
            "AXIS X.. Y.. Z..",
            "Shifts the datum; RESET cancels the shift.",
            f"TRANS DATUM AXIS X+10 Y-5{go}\nTRANS DATUM RESET",
            "TRANS DATUM X+10",
            "AXIS or RESET",
        ),
        Entry(
            "TRANS MIRROR",
            "AXIS X",
            "Mirrors axes; RESET cancels the mirroring.",
            f"TRANS MIRROR AXIS X{go}\nTRANS MIRROR RESET",
            "TRANS MIRROR X",
            "AXIS or RESET",
        ),
        Entry(
            "TRANS ROTATION",
            "ROT..",
            "Rotates the plane; RESET cancels the rotation.",
            f"TRANS ROTATION ROT+30{go}\nTRANS ROTATION RESET",
            "TRANS ROTATION 30",
            "ROT",
        ),
        Entry(
            "TRANS SCALE",
            "SCL..",
            "Enlarges or reduces the contour; RESET cancels the scaling.",
            f"TRANS SCALE SCL0.5{go}\nTRANS SCALE RESET",
            "TRANS SCALE 0.5",
            "SCL",
        ),
        older(7, "DATUM SHIFT", "X+10", "Shifts the datum, axis by axis.", "W+10", "W"),
        older(8, "MIRRORING", "X", "Mirrors axes; without an axis, cancels mirroring.", "W", "W"),
        older(10, "ROTATION", "ROT+30", "Rotates the plane; ROT+0 cancels the rotation.", "30", "ROT"),
        older(
            11,
            "SCALING",
            "SCL0.5",
            "Enlarges or reduces the contour; SCL1 cancels the scaling.",
            "SCL0",
            "SCL",
        ),
        older(
            19,
            "WORKING PLANE",
            "A+0 B+0 C+0",
            "Tilts the plane by spatial or axis angles; the program must turn the axes.",
            "W3",
            "not an axis",
        ),
        Entry(
            "CYCL DEF 247",
            "DATUM SETTING Q339=n",
            "Activates a preset.",
            "CYCL DEF 247 DATUM SETTING ~\n  Q339=+0",
            "CYCL DEF 247 DATUM SETTING ~\n  Q339=",
            "Q339",
        ),
    )


_HEIGHTS = "Q203=+0 Q204=30"
_HOLE = "Q200=2 Q201=-20 Q206=150"
_MILL = "Q207=400 Q351=+1 Q201=-10 Q202=5"
_INFEED = f"Q369=0 Q206=150 Q338=0 Q200=2 {_HEIGHTS} Q370=1"
_OF_A_CYCLE = {
    200: ("DRILLING", "Drills in several pecks.", f"{_HOLE} Q202=5 Q210=0 {_HEIGHTS} Q211=0"),
    201: ("REAMING", "Reams a hole and retracts at a feed rate.", f"{_HOLE} Q211=0 Q208=300 {_HEIGHTS}"),
    202: (
        "BORING",
        (
            "Bores, stops the spindle at the angle Q336, moves the edge off the wall as set in "
            "Q214, and retracts."
        ),
        f"{_HOLE} Q211=0 Q208=300 {_HEIGHTS} Q214=0 Q336=+0",
    ),
    203: (
        "UNIVERSAL DRILLING",
        "Drills in pecks of decreasing depth, with chip breaking.",
        f"{_HOLE} Q202=5 Q210=0 {_HEIGHTS} Q212=0.2 Q213=3 Q205=1 Q211=0 Q208=500 Q256=0.2",
    ),
    205: (
        "UNIVERSAL PECKING",
        "Drills deep holes in pecks, with chip breaking and a start point below the surface.",
        f"{_HOLE} Q202=8 {_HEIGHTS} Q212=0.5 Q205=2 Q258=0.5 Q259=1 Q257=4 Q256=0.2 Q211=0 Q379=0 Q253=750",
    ),
    206: ("TAPPING", "Taps with a floating tap holder.", f"{_HOLE} Q211=0 {_HEIGHTS}"),
    207: (
        "RIGID TAPPING",
        "Taps at a feed calculated from pitch and speed.",
        f"Q200=2 Q201=-20 Q239=+1 {_HEIGHTS}",
    ),
    208: (
        "BORE MILLING",
        "Mills a hole on a helical path.",
        f"{_HOLE} Q334=0.5 {_HEIGHTS} Q335=20 Q342=0 Q351=+1",
    ),
    209: (
        "TAPPING W/ CHIP BRKG",
        "Taps at a feed calculated from pitch and speed, with chip breaking.",
        f"Q200=2 Q201=-20 Q239=+1 {_HEIGHTS} Q257=5 Q256=0 Q336=+0",
    ),
    241: (
        "SINGLE-LIP D.H.DRLNG",
        (
            "Drills deep holes: moves slowly to a start point in the hole, then drills at "
            "the drilling speed with coolant."
        ),
        f"{_HOLE} Q211=0 {_HEIGHTS} Q379=5 Q253=750 Q208=1000 Q426=3 Q427=50 Q428=500 Q429=8 Q430=9 Q435=0",
    ),
    251: (
        "RECTANGULAR POCKET",
        "Mills a rectangular pocket; walls and floor are finished last.",
        f"Q215=0 Q218=60 Q219=40 Q220=6 Q368=0.2 Q224=+0 Q367=0 {_MILL} {_INFEED} Q366=1 Q385=500",
    ),
    252: (
        "CIRCULAR POCKET",
        "Mills a circular pocket; walls and floor are finished last.",
        f"Q215=0 Q223=50 Q368=0.2 {_MILL} {_INFEED} Q366=1 Q385=500",
    ),
    253: (
        "SLOT MILLING",
        "Mills a slot; walls and floor are finished last.",
        f"Q215=0 Q218=60 Q219=12 Q368=0.2 Q374=+30 Q367=0 {_MILL} {_INFEED} Q366=2 Q385=500",
    ),
    256: (
        "RECTANGULAR STUD",
        "Mills a rectangular stud from a larger blank.",
        f"Q218=60 Q424=70 Q219=40 Q425=50 Q220=6 Q368=0 Q224=+0 Q367=0 {_MILL} {_INFEED}",
    ),
    257: (
        "CIRCULAR STUD",
        "Mills a round stud from a larger blank.",
        f"Q223=50 Q222=60 Q368=0 {_MILL} {_INFEED} Q376=+0",
    ),
    240: (
        "CENTERING",
        "Center-drills to a depth.",
        f"Q200=2 Q343=+0 Q201=-2 Q344=-8 Q206=150 Q211=0 {_HEIGHTS}",
    ),
}
_OF_AN_OLDER = {
    1: ("PECKING", "Drills in pecks.", ("SET UP 2", "DEPTH -20", "PECKG 5", "DWELL 0", "F150")),
    2: (
        "TAPPING",
        "Taps with a floating tap holder.",
        ("SET UP 2", "DEPTH -20", "DWELL 0", "F1000"),
    ),
    3: (
        "SLOT MILLING",
        "Mills a slot from the current tool position.",
        ("SET UP -2", "DEPTH -5", "PECKG -2.5 F100", "X+30", "Y+12", "F300"),
    ),
    4: (
        "POCKET MILLING",
        "Mills a rectangular pocket around the current tool position.",
        ("SET UP 2", "DEPTH -5", "PECKG 2.5 F100", "X40", "Y30", "F300 DR+"),
    ),
    5: (
        "CIRCULAR POCKET",
        "Mills a circular pocket around the current tool position.",
        ("SET UP 2", "DEPTH -5", "PECKG 2.5 F100", "RADIUS 20", "F300 DR+"),
    ),
    17: (
        "RIGID TAPPING",
        "Taps at a feed calculated from pitch and speed.",
        ("SET UP 2", "DEPTH -20", "PITCH +1"),
    ),
    18: (
        "THREAD CUTTING",
        "Cuts a thread from the current tool position and stops the spindle.",
        ("DEPTH -20", "PITCH +1"),
    ),
}


def cycles() -> tuple[Entry, ...]:
    """Machining cycles, patterns, and how they are called."""
    above = "L X+10 Y+10 Z+2 R0 FMAX\n"

    def hole(number: int, name: str, what: str, parameters: str) -> Entry:
        body = f"CYCL DEF {number} {name} ~\n  " + parameters.replace(" Q", " ~\n  Q")
        call = "\nL X+10 Y+20 R0 FMAX M99"
        return Entry(
            Message("CYCL DEF {number}", number=number),
            name,
            what,
            body + call,
            body.replace("Q201=-", "Q201=+") + call,
            "positive (upward)",
            insert=body,
        )

    def older(number: int, name: str, what: str, lines: tuple[str, ...]) -> Entry:
        head = f"CYCL DEF {number}.0"
        told = [
            f"{head} {name}",
            *(
                Message("CYCL DEF {number}.{part} {line}", number=number, part=part, line=line)
                for part, line in enumerate(lines, start=1)
            ),
        ]
        body = "\n".join(told)
        without = "\n".join(told[:-1])
        return Entry(
            Message("CYCL DEF {number}", number=number),
            f".0 {name}",
            what,
            f"{above}{body}\nCYCL CALL",
            f"{above}{without}\nCYCL CALL",
            f"{number}",
            insert=body,
        )

    drill = "CYCL DEF 200 DRILLING ~\n  " + _OF_A_CYCLE[200][2].replace(" Q", " ~\n  Q") + "\n"
    turned = "Q246=+360 Q247=+0 Q241=6 Q200=2 Q203=+0 Q204=30 Q301=1 Q365=0"
    rows = "Q225=+0 Q226=+0 Q237=+10 Q238=+8 Q242=3 Q243=2 Q224=+0 Q200=2 Q203=+0 Q204=30 Q301=1"
    circle = f"CYCL DEF 220 POLAR PATTERN ~\n  Q216=+0 Q217=+0 Q244=40 Q245=+0 {turned}".replace(
        " Q", " ~\n  Q", 20
    )
    square = f"CYCL DEF 221 CARTESIAN PATTERN ~\n  {rows}".replace(" Q", " ~\n  Q")
    return (
        *(hole(number, *told) for number, told in _OF_A_CYCLE.items()),
        Entry(
            "CYCL DEF 220",
            "POLAR PATTERN",
            "Runs the previously defined cycle at positions on a circle.",
            drill + circle,
            circle,
            "cycle",
            insert=circle,
        ),
        Entry(
            "CYCL DEF 221",
            "CARTESIAN PATTERN",
            "Runs the previously defined cycle at positions that are arranged in rows.",
            drill + square,
            square,
            "cycle",
            insert=square,
        ),
        *(older(number, *told) for number, told in _OF_AN_OLDER.items()),
        Entry(
            "CYCL DEF 9",
            ".0 DWELL TIME",
            "Dwells.",
            "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.5",
            "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL -1",
            "is negative",
            insert="CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.5",
        ),
        Entry(
            "CYCL DEF 12",
            ".0 PGM CALL",
            "Defines a program as the cycle that CYCL CALL runs.",
            "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM SLOT.H\nCYCL CALL",
            "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM NOWHERE.H\nCYCL CALL",
            "NOWHERE",
            files=(("SLOT.H", "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n"),),
        ),
        Entry(
            "CYCL DEF 13",
            ".0 ORIENTATION",
            "The angle at which M19 stops the spindle.",
            "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 90\nM19",
            "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 400",
            "angle",
        ),
        Entry(
            "CYCL DEF 32",
            ".0 TOLERANCE",
            (
                "Tolerance: the permitted deviation from the path. This value has no effect "
                "because the control always follows the path exactly."
            ),
            "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.02",
        ),
        Entry(
            "PATTERN DEF",
            "POS1 (X.. Y.. Z..) ROW1 PAT1 FRAME1 CIRC1 PITCHCIRC1",
            (
                "Defines the points for CYCL CALL PAT: single points, a row, a grid or a frame, a "
                "circle or part of a circle."
            ),
            drill + "PATTERN DEF ROW1 (X+0 Y+0 D+10 NUM3 ROT+30 Z+0)\nCYCL CALL PAT FMAX",
            "PATTERN DEF ROW1 (X+0 Y+0 D+10)",
            "NUM",
        ),
        Entry(
            "CYCL CALL PAT",
            "F.. M..",
            "Runs the cycle at every point of PATTERN DEF.",
            drill + "PATTERN DEF POS1 (X+10 Y+5 Z+0) POS2 (X+20 Y+5 Z+0)\nCYCL CALL PAT FMAX",
            drill + "CYCL CALL PAT FMAX",
            "PATTERN DEF",
        ),
        Entry(
            "CYCL CALL",
            "M..",
            "Runs the cycle at the current tool position.",
            drill + "L X+10 Y+5 R0 FMAX\nCYCL CALL",
            "CYCL CALL",
            "cycle",
        ),
        Entry(
            "CYCL CALL POS",
            "X.. Y.. Z.. F..",
            "Moves to a position and runs the cycle there.",
            drill + "CYCL CALL POS X+10 Y+5 Z+0 FMAX",
            "CYCL CALL POS X+10 Y+5 Z+0 FMAX",
            "cycle",
        ),
    )


_UNHEEDED = (
    *(90, 94, 97, 98, 105, 106, 107, 108, 109, 110, 111),
    *(112, 113, 118, 120, 124, 134, 135, 141, 148),
)


def m_functions() -> tuple[Entry, ...]:
    """M functions, those without effect too."""

    def code(number: int, what: str, example: str = "", refused: str = "", why: str = "") -> Entry:
        return Entry(
            f"M{number}", "", what, example or f"M{number}", refused or f"M{number} M{number}", why or "twice"
        )

    ignored = "Has no effect on this control; the control shows a message."
    drill = "CYCL DEF 200 DRILLING ~\n  " + _OF_A_CYCLE[200][2].replace(" Q", " ~\n  Q") + "\n"
    return (
        code(0, "Stops the program and the spindle, and turns the coolant off."),
        code(1, "Optional stop."),
        code(2, "End of the program."),
        code(3, "Spindle on, clockwise.", "M3", "M3 M4", "spindle"),
        code(4, "Spindle on, counterclockwise."),
        code(5, "Spindle stop."),
        code(6, "Tool change; the program stops and asks for the tool."),
        code(8, "Turns the coolant on."),
        code(9, "Turns the coolant off."),
        code(13, "Spindle on, clockwise, and coolant on."),
        code(14, "Spindle on, counterclockwise, and coolant on."),
        code(
            19,
            (
                "Stops the spindle and holds it at the angle of cycle 13, or at 0 degrees if cycle "
                "13 is not defined."
            ),
            "M19",
            "M19 M3",
            "spindle",
        ),
        code(30, "End of the program."),
        code(
            89,
            "Runs the cycle after every positioning block, until M99 or another cycle.",
            drill + "L X+10 Y+5 R0 FMAX M89\nL X+20 R0 FMAX\nL X+30 R0 FMAX M99",
        ),
        code(
            91,
            "The coordinates of the block are machine coordinates.",
            "L Z+0 R0 FMAX M91",
            "M128\nL Z+0 R0 FMAX M91",
            "M128",
        ),
        code(
            92,
            (
                "The coordinates of the block refer to the second datum of the machine (fixed_points "
                "of its axes in the machine file), where tools are changed."
            ),
            "L Z-20 R0 FMAX M92",
            "L Z-20 R0 FMAX M91 M92",
            "different datums",
        ),
        code(
            99,
            "Runs the cycle after this block.",
            drill + "L X+10 Y+5 R0 FMAX M99",
            "L X+10 Y+5 R0 FMAX M99",
            "cycle",
        ),
        code(
            101,
            (
                "On the original control, changes to a replacement tool when tool life is used up. "
                "This control does not change the tool; it shows a message."
            ),
        ),
        code(102, "Ends M101."),
        code(
            103,
            ("When Z moves down, limits the feed to F percent of the programmed feed."),
            "M103 F20\nL X+10 Z-2 R0 F500\nM103",
            "M103 FMAX",
            "its factor",
        ),
        code(115, "Ends M114, which is not supported."),
        code(
            116,
            (
                "When only rotary axes move, F is measured in mm along the path of the tool tip on "
                "the workpiece, based on the distance of the tool tip from the axes."
            ),
            "M116\nL X+40 Y+0 R0 FMAX\nL C+30 R0 F500\nM117",
        ),
        code(117, "Ends M116; F of rotary axes is measured in degrees again."),
        code(
            126,
            (
                "Rotary axes without limits take the shortest path. This is the default unless M127 "
                "is programmed first."
            ),
        ),
        code(
            127,
            (
                "Rotary axes without limits turn by the difference between the position "
                "values, not by the shortest path: from 350 to 10, they turn back through 340 "
                "degrees."
            ),
        ),
        code(
            136,
            (
                "F is the feed per spindle revolution, based on the programmed S; the previously "
                "programmed feed no longer applies."
            ),
            "M136\nL X+10 R0 F0.2\nM137\nL X+20 R0 F500",
            "L X+5 R0 F500\nM136\nL X+10",
            "No feed",
        ),
        code(137, "Ends M136; the previously programmed feed no longer applies."),
        code(
            128,
            (
                "The position of the tool tip relative to the workpiece does not change while "
                "the rotary axes move."
            ),
            "M128\nL IA+5 R0 F300\nM129",
        ),
        code(129, "Ends M128."),
        code(145, "Ends M144, which is not supported."),
        code(140, "Retracts from the workpiece along the tool axis.", "M140 MB 20", "M140", "needs MB"),
        *(code(number, ignored) for number in _UNHEEDED),
    )
