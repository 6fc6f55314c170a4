"""The code book of Klartext: path functions, tools, planes, cycles, Q parameters, by the manual's words."""

from __future__ import annotations

from core.language.code_book import CodeBook, Entry
from core.language.klartext.cycle_words import MEANINGS
from core.language.klartext.klartext_contour_book import contours
from core.language.klartext.klartext_cycle_book import cycles, m_functions, transformations
from core.language.klartext.klartext_milling_book import milling
from core.language.klartext.klartext_other_controls_book import other_controls
from core.language.klartext.klartext_refused_book import refused

HEAD = "BEGIN PGM EXAMPLE MM\nTOOL DEF 1 L+0 R+4\nTOOL CALL 1 Z S3000 F500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"
"""Before every example: tool 1 of radius 4 mm, the spindle on, 50 mm above the workpiece's zero."""

TAIL = "L Z+50 R0 FMAX\nM30\n"

_OUTSIDE = "L X-30 Y+0 R0 FMAX\nL Z-2 F200\n"  # beside the contour, at depth
_ON = "L X+0 Y+0 RL F300\n"
_AWAY = "\nL Y+60\nL X-30 R0"


def _frame() -> tuple[Entry, ...]:
    program = "BEGIN PGM EXAMPLE MM\nEND PGM EXAMPLE MM\n"
    blank = "BLK FORM 0.1 Z X-50 Y-50 Z-20\nBLK FORM 0.2 X+50 Y+50 Z+0"
    return (
        Entry(
            "BEGIN PGM",
            "name MM",
            "Marks the start of the program and sets its unit, millimeters or inches.",
            program,
            "BEGIN PGM EXAMPLE\nEND PGM EXAMPLE\n",
            "needs MM or INCH",
            whole=True,
        ),
        Entry(
            "END PGM",
            "name MM",
            "Ends the program, as M30 does.",
            program,
            "BEGIN PGM EXAMPLE MM\n",
            "END PGM",
            whole=True,
        ),
        Entry(
            "BLK FORM 0.1",
            "Z X.. Y.. Z..",
            "Tool axis, and MIN point of the blank: the corner with the smallest coordinates.",
            blank,
            "BLK FORM 0.1 X-50 Y-50 Z-20",
            "tool axis",
        ),
        Entry(
            "BLK FORM 0.2",
            "X.. Y.. Z..",
            "MAX point of the blank: the corner with the largest coordinates.",
            blank,
            "BLK FORM 0.2 X+50 Y+50",
            "Z is missing",
        ),
        Entry(
            "STOP",
            "M..",
            "Stops the program; the block may also contain M functions.",
            "STOP M9",
            "STOP X+3",
            "X+3",
        ),
        Entry(
            "*", "- text", "Heading that structures the program and has no other effect.", "* - FIRST SIDE"
        ),
    )


def _tools() -> tuple[Entry, ...]:
    return (
        Entry(
            "TOOL DEF",
            "n L.. R..",
            "Length and radius of a tool that is defined in the program.",
            "TOOL DEF 7 L+0 R+3\nTOOL CALL 7 Z S2000 F300\nL Z+50 R0 FMAX M3",
            "TOOL DEF 7 W+3",
            "TOOL DEF",
        ),
        Entry(
            "TOOL CALL",
            "n Z S.. F.. DL.. DR..",
            (
                "Calls a tool by number or name, with the tool axis, speed in rpm, feed, and the "
                "values added to length and radius."
            ),
            "TOOL CALL 1 Z S2500 F400 DL+0.1 DR-0.02",
            "TOOL CALL 1 Z W3",
            "TOOL CALL",
        ),
    )


def _paths() -> tuple[Entry, ...]:
    polar = "CC X+0 Y+0\n"
    return (
        Entry("L", "X.. Y.. Z.. R0 F.. M..", "Straight line.", "L X+10 IY+5 R0 F300", "L X+10 X+5", "X"),
        Entry(
            "CC",
            "X.. Y..",
            "Sets the circle center and the pole for the following blocks.",
            "CC X+10 Y+0",
            "CC W+3",
            "CC",
        ),
        Entry(
            "C",
            "X.. Y.. DR+",
            "Arc around the circle center CC.",
            "L X+10 Y+0 R0 F500\nCC X+0 Y+0\nC X+0 Y+10 DR+",
            "L X+10 Y+0 R0 F500\nCC X+0 Y+0\nC X+0 Y+10",
            "Direction",
        ),
        Entry(
            "CR",
            "X.. Y.. R.. DR+",
            "Arc with a given radius; a negative R gives an arc of more than 180 degrees.",
            "CR X+10 Y+10 R+10 DR-",
            "CR X+10 Y+10 DR-",
            "CR needs R",
        ),
        Entry(
            "CT",
            "X.. Y..",
            "Arc that continues tangentially from the previous element.",
            "L X+20 Y+0 R0 F400\nCT X+30 Y+10",
            "CC X+0 Y+0\nCT",
            "CT",
        ),
        Entry(
            "LP",
            "PR.. PA..",
            "Straight line to a point in polar coordinates around CC.",
            polar + "LP PR+20 PA+30 R0 F400",
            "LP PR+20 PA+30 R0 F400",
            "CC missing",
        ),
        Entry(
            "CP",
            "PA.. IZ.. DR+",
            "Arc around CC through a given angle; adding the tool axis makes a helix.",
            polar + "LP PR+20 PA+0 R0 F400\nCP IPA+720 IZ-4 DR+",
            "CP IPA+90 DR+",
            "CC missing",
        ),
        Entry(
            "CTP",
            "PR.. PA..",
            "Tangential arc to a point in polar coordinates.",
            polar + "L X+10 Y+0 R0 F400\nCTP PR+20 PA+30",
            "CTP PR+20 PA+30",
            "CC missing",
        ),
        Entry(
            "RND",
            "R..",
            "Rounds the corner between the preceding element and the following element.",
            "L X+20 Y+0 R0 F400\nRND R3\nL X+20 Y+20",
            "L X+20 Y+0 R0 F400\nRND R30\nL X+20 Y+20",
            "Rounding",
        ),
        Entry(
            "CHF",
            "n",
            "Chamfers the corner between two straight lines.",
            "L X+20 Y+0 R0 F400\nCHF 2\nL X+20 Y+20",
            "L X+20 Y+0 R0 F400\nCHF 40\nL X+20 Y+20",
            "not possible",
        ),
        Entry(
            "FU",
            "n",
            (
                "Feed per revolution, or feed per tooth with FZ (the number of teeth is CUT in the "
                "tool table), based on the programmed S."
            ),
            "L X+10 R0 FU0.1",
            "L X+10 R0 FZ0.1",
            "CUT",
        ),
        Entry(
            "FMAX",
            "",
            "Rapid for this block only; afterward, the previously programmed feed applies again.",
            "L X+10 R0 F400\nL X+20 FMAX\nL X+30",
            "L X+20 FMAX F400",
            "F is programmed twice",
        ),
        Entry("R0", "", "Turns radius compensation off.", "L X+10 R0 F400"),
        Entry(
            "RL",
            "",
            "Radius compensation: the tool is left of the contour.",
            _OUTSIDE + _ON + "L Y+40" + _AWAY,
            _OUTSIDE + _ON + "L X+1\nL X+0",
            "radius",
        ),
        Entry(
            "RR",
            "",
            "Radius compensation: the tool is right of the contour.",
            "L X+30 Y+0 R0 FMAX\nL Z-2 F200\nL X+0 Y+0 RR F300\nL Y+40\nL Y+60\nL X+30 R0",
        ),
    )


def _approach() -> tuple[Entry, ...]:
    begin, contour = "L X-30 Y-10 R0 FMAX\nL Z-2 F200\n", "\nL Y+40\n"
    out = "DEP LT LEN10\nL X-30 R0"

    def entry(head: str, words: str, what: str, polar: str = "") -> Entry:
        place = polar or "X+0 Y+0"
        approach = (
            f"{begin}{'CC X+0 Y-10' + chr(10) if polar else ''}{head} {place} {words} RL F300{contour}{out}"
        )
        return Entry(
            head,
            f"{'PR.. PA..' if polar else 'X.. Y..'} {words}",
            what,
            approach,
            f"{begin}{head} {place} RL F300{contour}{out}",
            f"{head} needs",
        )

    def leave(head: str, words: str, what: str, pole: str = "") -> Entry:
        return Entry(
            head,
            words,
            what,
            f"{begin}{pole}{_ON}{contour}{head} {words}\nL X-60 R0",
            f"{begin}{_ON}{contour}{head}\nL X-60 R0",
            f"{head} needs",
        )

    pole = "PR+10 PA+90"
    return (
        entry("APPR LT", "LEN10", "Approaches the contour on a straight line, tangentially."),
        entry("APPR LN", "LEN10", "Approaches the contour on a straight line at a right angle."),
        entry("APPR CT", "CCA90 R5", "Approaches the contour on an arc, tangentially."),
        entry("APPR LCT", "R5", "Approaches the contour on a line and an arc, both tangential."),
        entry("APPR PLT", "LEN10", "Same as APPR LT, with the point in polar coordinates.", pole),
        entry("APPR PLN", "LEN10", "Same as APPR LN, with the point in polar coordinates.", pole),
        entry("APPR PCT", "CCA90 R5", "Same as APPR CT, with the point in polar coordinates.", pole),
        entry("APPR PLCT", "R5", "Same as APPR LCT, with the point in polar coordinates.", pole),
        leave("DEP LT", "LEN10", "Leaves the contour on a straight line, tangentially."),
        leave("DEP LN", "LEN10", "Leaves the contour on a straight line at a right angle."),
        leave("DEP CT", "CCA90 R5", "Leaves the contour on an arc, tangentially."),
        leave("DEP LCT", "X-30 Y+60 R5", "Leaves the contour on an arc and a line, both tangential."),
        leave(
            "DEP PLCT",
            "PR+70 PA+120 R5",
            "Same as DEP LCT, with the point in polar coordinates.",
            "CC X+0 Y-10\n",
        ),
    )


def _flow() -> tuple[Entry, ...]:
    return (
        Entry(
            "LBL",
            "n",
            "Marks the start of a subprogram or of a section to be repeated; LBL 0 ends a subprogram.",
            "CALL LBL 1",
            "LBL 1\nLBL 1",
            "twice",
            behind="LBL 1\nL IX+5 R0 F300\nLBL 0\n",
        ),
        Entry(
            "CALL LBL",
            "n REP ..",
            "Calls a subprogram; with REP, repeats the section from LBL to this block.",
            "LBL 3\nL IX+5 R0 F300\nCALL LBL 3 REP 4",
            "CALL LBL 9",
            "Label not found",
        ),
        Entry(
            "CALL PGM",
            "name",
            "Calls another program as a subprogram.",
            "CALL PGM SLOT.H",
            "CALL PGM NOWHERE.H",
            "NOWHERE",
            files=(("SLOT.H", "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n"),),
        ),
        Entry(
            "SEL PGM",
            '"name"',
            "Selects the program for CALL SELECTED PGM.",
            'SEL PGM "SLOT.H"\nCALL SELECTED PGM',
            "SEL PGM",
            "needs a file name",
            files=(("SLOT.H", "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n"),),
        ),
        Entry(
            "CALL SELECTED",
            "PGM",
            "Runs the program selected by SEL PGM.",
            'SEL PGM "SLOT.H"\nCALL SELECTED PGM',
            "CALL SELECTED PGM",
            "No program is selected",
            files=(("SLOT.H", "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n"),),
        ),
        Entry(
            "SEL TABLE",
            '"name.D"',
            "Selects the datum table for CYCL DEF 7.1 #n and TRANS DATUM TABLE TABLINEn.",
            'SEL TABLE "VICE.D"\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #2\nL X+0 Y+0 R0 FMAX',
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #2",
            "No datum table is selected",
            files=(("VICE.D", "BEGIN VICE .D MM\nNR X Y Z\n0 +0 +0 +0\n2 +10 +5 +0\n[END]\n"),),
        ),
        Entry(
            "SEL PATTERN",
            '"name.PNT"',
            "Selects the point table for CYCL CALL PAT.",
            'SEL PATTERN "HOLES.PNT"\nL X+0 Y+0 R0 FMAX',
            'SEL PATTERN "NONE.PNT"',
            "not in the same folder",
            files=(("HOLES.PNT", "BEGIN HOLES .PNT MM\nNR X Y Z\n0 +10 +5 +0\n1 +20 +5 +0\n[END]\n"),),
        ),
    )


def _parameters() -> tuple[Entry, ...]:
    def function(number: int, words: str, what: str, refused: str, why: str) -> Entry:
        return Entry(f"FN {number}", words, what, f"Q1 = 4\nQ2 = 2\nFN {number}{words}\nLBL 99", refused, why)

    def jump(number: int, word: str, what: str) -> Entry:
        return function(
            number,
            f": IF +Q1 {word} +Q2 GOTO LBL 99",
            what,
            f"FN {number}: IF +1 {word} +1 GOTO LBL 77",
            "Label not found",
        )

    return (
        Entry(
            "Q",
            "n = formula",
            (
                "Assigns a value to a Q parameter: + - * / % ^, parentheses, SIN COS TAN ASIN ACOS "
                "ATAN SQRT SQ LN LOG EXP NEG INT ABS FRAC SGN PI."
            ),
            "Q5 = 3 + 2 * SIN 30\nL X+Q5 R0 F300",
            "Q5 = 3 / 0",
            "Arithmetical",
        ),
        Entry(
            "QL",
            "n = formula",
            "Assigns a value to a local parameter, which is valid until its program ends.",
            "QL5 = 3\nL X+QL5 R0 F300",
            "L X+QL7 R0 F300",
            "no value",
        ),
        Entry(
            "QR",
            "n = formula",
            "Assigns a value to a parameter that retains the value after the program ends.",
            "QR5 = 3\nL X+QR5 R0 F300",
            "QR900 = 3",
            "QR499",
        ),
        function(0, ": Q5 = +Q1", "Assigns a value.", "FN 0: Q5 = Q1 + 3", "FN 0"),
        function(1, ": Q5 = +Q1 + +Q2", "Adds two values.", "FN 1: Q5 = +1", "FN 1 needs"),
        function(2, ": Q5 = +Q1 - +Q2", "Subtracts one value from another.", "FN 2: Q5 = +1", "FN 2 needs"),
        function(3, ": Q5 = +Q1 * +Q2", "Multiplies two values.", "FN 3: Q5 = +1", "FN 3 needs"),
        function(
            4, ": Q5 = +Q1 DIV +Q2", "Divides one value by another.", "FN 4: Q5 = +1 DIV +0", "Arithmetical"
        ),
        function(5, ": Q5 = SQRT +Q1", "Square root.", "FN 5: Q5 = SQRT -4", "Arithmetical"),
        function(6, ": Q5 = SIN +Q1", "Sine of an angle in degrees.", "FN 6: Q5 = +Q1", "FN 6 needs SIN"),
        function(7, ": Q5 = COS +Q1", "Cosine of an angle in degrees.", "FN 7: Q5 = +Q1", "FN 7 needs COS"),
        function(
            8, ": Q5 = +Q1 LEN +Q2", "Square root of the sum of two squares.", "FN 8: Q5 = +1", "FN 8 needs"
        ),
        jump(9, "EQU", "Jumps if the two values are equal."),
        jump(10, "NE", "Jumps if the two values are not equal."),
        jump(11, "GT", "Jumps if the first value is greater."),
        jump(12, "LT", "Jumps if the first value is less."),
        function(
            13,
            ": Q5 = +Q1 ANG +Q2",
            "Angle calculated from the lengths of two sides.",
            "FN 13: Q5 = +1",
            "FN 13 needs",
        ),
        Entry(
            "FN 14",
            ": ERROR = n",
            "Ends the program with an error that the program defines.",
            "FN 9: IF +1 EQU +1 GOTO LBL 98\nFN 14: ERROR = 1000\nLBL 98",
            "FN 14: ERROR = 1000",
            "Error raised by the program",
        ),
        function(
            15,
            ": PRINT Q1",
            ("Prints on the original control. This control prints nothing and shows a message."),
            "",
            "",
        ),
        function(
            16,
            ": F-PRINT A.A",
            ("Prints to a file on the original control. This control prints nothing and shows a message."),
            "",
            "",
        ),
        function(
            17,
            ": SYSWRITE ID50 NR22 IDX1 = +0",
            (
                "On the original control, writes to the tool table. This control does not change any "
                "value in the tool table, and it rejects values that would move an axis."
            ),
            "FN 17: SYSWRITE ID50 NR4 IDX1 = +0.5",
            "DL of tool 1",
        ),
        function(
            18,
            ": SYSREAD Q5 = ID20 NR1",
            "Reads a system value of the control.",
            "FN 18: SYSREAD Q5 = ID9999 NR1",
            "FN 18",
        ),
        Entry(
            "FN 20",
            ": WAIT FOR SYNC",
            (
                "Stops the look-ahead until all earlier blocks have run. TurnDesk does not "
                "need this wait and reports the block."
            ),
            "FN 20: WAIT FOR SYNC",
            "FN 20: WAIT FOR I95==0",
            "PLC",
        ),
        Entry(
            "FN 38",
            ": SEND",
            "Sends a string to the control's log. TurnDesk ignores this block and reports it.",
            'FN 38: SEND /"DEPTH %f" / +5',
        ),
    )


def _planes() -> tuple[Entry, ...]:
    def plane(kind: str, words: str, what: str, refused: str, why: str) -> Entry:
        way = "MOVE DIST20 F1000"
        return Entry(
            f"PLANE {kind}",
            words,
            what,
            f"PLANE {kind} {words} {way}\nPLANE RESET MOVE F1000",
            f"PLANE {kind} {refused}",
            why,
            insert=f"PLANE {kind} {words} {way}",
        )

    return (
        plane("AXIAL", "A+30 C+0", "Tilts the plane by the angles of the rotary axes.", "MOVE", "angle"),
        plane(
            "SPATIAL",
            "SPA+30 SPB+0 SPC+0",
            "Tilts the plane by three spatial angles.",
            "SPA+30 MOVE",
            "missing",
        ),
        plane(
            "POINTS",
            "P1X+0 P1Y+0 P1Z+0 P2X+10 P2Y+0 P2Z+0 P3X+0 P3Y+8 P3Z+6",
            "Tilts the plane by three points.",
            "P1X+0 P1Y+0 P1Z+0 MOVE",
            "missing",
        ),
        plane(
            "VECTOR",
            "BX+1 BY+0 BZ+0 NX+0 NY-0.5 NZ+1",
            "Tilts the plane by a normal vector and a base vector.",
            "BX+1 MOVE",
            "missing",
        ),
        plane(
            "EULER",
            "EULPR+0 EULNU+30 EULROT+0",
            "Tilts the plane by Euler angles.",
            "EULPR+0 MOVE",
            "missing",
        ),
        plane(
            "PROJECTED",
            "PROPR+0 PROMIN+20 ROT+0",
            "Tilts the plane by projection angles.",
            "PROPR+0 MOVE",
            "missing",
        ),
        plane(
            "RELATIV",
            "SPA+20",
            "Tilts the plane by one additional angle, starting from the active plane.",
            "SPA+10 SPB+10 MOVE",
            "one of",
        ),
        Entry(
            "PLANE RESET",
            "MOVE",
            "Cancels the tilted plane.",
            "PLANE AXIAL A+30 C+0 TURN F1000\nPLANE RESET TURN F1000",
            "PLANE RESET MOVE DIST5 DIST6",
            "DIST",
        ),
        Entry(
            "MOVE",
            "DIST.. F..",
            (
                "The rotary axes turn, and the position of the tool tip relative to the "
                "workpiece does not change."
            ),
            "PLANE AXIAL A+30 C+0 MOVE DIST20 F1000\nPLANE RESET MOVE F1000",
            "PLANE AXIAL A+30 TURN DIST20 F1000",
            "DIST",
        ),
        Entry(
            "TURN",
            "F..",
            "The rotary axes turn; the linear axes do not move.",
            "PLANE AXIAL A+30 C+0 TURN F1000\nPLANE RESET TURN F1000",
            "PLANE AXIAL A+30 TURN MOVE",
            "cannot contain both",
        ),
        Entry(
            "STAY",
            "",
            "No axis moves; the program must turn the rotary axes with Q120 to Q122.",
            "PLANE AXIAL A+30 C+0 STAY\nPLANE RESET STAY",
            "PLANE AXIAL A+30 STAY F500",
            "STAY does not move any axis",
        ),
        Entry(
            "FUNCTION TCPM",
            "F TCP AXIS POS PATHCTRL AXIS",
            (
                "The position of the tool tip relative to the workpiece does not change while "
                "the rotary axes move."
            ),
            "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL IA+5 R0 F300\nFUNCTION RESET TCPM",
            "FUNCTION TCPM AXIS SPAT",
            "AXIS SPAT",
        ),
        Entry(
            "FUNCTION RESET TCPM",
            "",
            "Ends TCPM.",
            "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nFUNCTION RESET TCPM",
        ),
    )


BOOK = CodeBook(
    (
        ("Program", _frame()),
        ("Tools", _tools()),
        ("Paths", _paths()),
        ("Approach and departure", _approach()),
        ("Labels and programs", _flow()),
        ("Q parameters", _parameters()),
        ("Tilted planes", _planes()),
        ("Coordinate transformations", transformations()),
        ("Cycles", cycles()),
        ("Back boring, slots and older cycles", milling()),
        ("Contours for SL cycles", contours()),
        ("M functions", m_functions()),
        ("Words of older and newer controls", other_controls()),
        ("Rejected codes", refused()),
    ),
    head=HEAD,
    tail=TAIL,
    comment=";",
    meanings=MEANINGS,
)
"""All of it."""
