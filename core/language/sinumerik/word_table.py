"""Every G function and word of SINUMERIK turning: its group, what it means here, and an example that runs.

The code book (``sinumerik_book``, printed as ``docs/sinumerik-codes.md``) is made of these tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

MOTION = "motion"
DWELL = "dwell"
BLOCKWISE = "non-modal functions"
TRANSFORMATION = "transformation"
LANGUAGE_MODE = "language mode"
PLANE = "plane"
COMPENSATION = "tool radius compensation"
SETTABLE = "settable offset"
SUPPRESSION = "offset suppression"
EXACT = "exact stop or continuous path"
EXACT_ONCE = "exact stop in one block"
EXACT_WHEN = "exact stop criterion"
UNIT = "unit of length"
ABSOLUTE = "absolute or incremental"
FEED_AND_SPEED = "feed type and spindle speed"
FEED_ON_ARCS = "feed on arcs"
APPROACH = "approach and retract"
CORNER = "outside corners"
ACCELERATION = "acceleration"
FEED_FORWARD = "feedforward"
AREA = "working area"
TRANSVERSE = "diameter or radius"
COMPRESSOR = "compressor"
DYNAMICS = "dynamics"
CONTOUR_PLANE = "compensation plane"
FEED_PROFILE = "feed profile"
BUFFER = "block buffer"
PRECISION = "contour precision"
PICTURE = "picture"


class Entry(NamedTuple):
    """One function: what it does here, and blocks of an example, ``|`` between them.

    ``idle``: why it makes no difference here, which is said where a program writes it.
    """

    group: str
    meaning: str
    example: str = ""
    idle: str = ""


_BLANK = (
    "TurnDesk proves the program with the stock that is set by --stock or on the "
    "PART page, or that is assumed from the moves"
)
_BUFFERED = "the control reads the whole program before the program starts"
_EXACT_PATH = "the programmed path is followed exactly and corners are never rounded"
_TIP = "on this control, F always applies to the path of the tool tip"
_ARC_IK = "G1 X20 Z0 F200|G3 X30 Z-5 I0 K-5"
_ARC_THROUGH = "G1 X20 Z0 F200|CIP X20 Z-20 I1=30 K1=-10"
_LAW = "the velocity profile always stays within the axis acceleration limits of this machine"

FUNCTIONS: Mapping[str, Entry] = {
    "G0": Entry(MOTION, "Rapid; all axes arrive at the same time.", "G0 X40 Z2"),
    "G1": Entry(MOTION, "Straight line at the feed rate.", "G1 X40 Z-10 F200"),
    "G2": Entry(
        MOTION, "Clockwise arc, defined by I and K, by CR= or by AR=.", "G1 X20 Z0 F200|G2 X30 Z-5 CR=5"
    ),
    "G3": Entry(MOTION, "Counterclockwise arc.", "G1 X20 Z0 F200|G3 X30 Z-5 I0 K-5"),
    "CIP": Entry(
        MOTION, "Arc through the intermediate point I1= K1=.", "G1 X20 Z0 F200|CIP X20 Z-20 I1=30 K1=-10"
    ),
    "CT": Entry(
        MOTION, "Arc that continues tangentially from the previous path.", "G1 X20 Z0 F200|Z-10|CT X30 Z-15"
    ),
    "G33": Entry(
        MOTION,
        (
            "Cuts a thread of constant lead: K along Z, I along X; SF= is the start angle. "
            "More thread blocks can follow."
        ),
        "S400 M3|G0 X18 Z8|G33 Z-20 K2|G0 X24",
    ),
    "G34": Entry(
        MOTION,
        "Same as G33, with a lead that increases by F (mm/rev per revolution).",
        "S400 M3|G0 X18 Z8|G34 Z-20 K1 F0.1|G0 X24",
    ),
    "G35": Entry(
        MOTION, "Same as G34, with a lead that decreases.", "S400 M3|G0 X18 Z8|G35 Z-20 K3 F0.1|G0 X24"
    ),
    "G331": Entry(
        MOTION,
        (
            "Rigid tapping into the hole: the spindle runs as the C axis, synchronized "
            "with Z at the lead K (a negative K cuts a left-hand thread)."
        ),
        "SPOS=0|S100|G331 Z-10 K1|G332 Z10 K1",
    ),
    "G332": Entry(
        MOTION,
        "Retracts the tap from the hole with the spindle in reverse.",
        "SPOS=0|S100|G331 Z-10 K1|G332 Z10 K1",
    ),
    "G4": Entry(DWELL, "Dwell, with F in seconds or S in revolutions.", "G4 F0.5"),
    "G9": Entry(EXACT_ONCE, "Exact stop at the end of this block.", "G9 G1 X30 F200|Z-5"),
    "G60": Entry(EXACT, "Exact stop at the end of every block.", "G60 G1 X30 F200|Z-5"),
    "G64": Entry(
        EXACT,
        "Continuous-path mode; the axis accelerations determine the speed in corners.",
        "G64 G1 X30 F200|Z-5",
    ),
    **{
        f"G{code}": Entry(EXACT, "Same as G64; corners are not rounded.", f"G{code} G1 X30 F200")
        for code in (641, 642, 643, 644, 645)
    },
    **{
        f"G{code}": Entry(
            EXACT_WHEN,
            ("Accepted. On this control, an exact stop always waits until the axes are in position."),
            f"G{code} G60",
        )
        for code in (601, 602, 603)
    },
    "G17": Entry(
        PLANE, "Plane X Y; this lathe supports neither arcs nor radius compensation in this plane.", "G17|G18"
    ),
    "G18": Entry(PLANE, "Plane Z X, the plane for turning.", "G18"),
    "G19": Entry(
        PLANE, "Plane Y Z; this lathe supports neither arcs nor radius compensation in this plane.", "G19|G18"
    ),
    "G40": Entry(COMPENSATION, "Turns radius compensation off, starting with the next move.", "G40"),
    "G41": Entry(
        COMPENSATION,
        "The tool stays left of the contour.",
        "T1 D1|G0 X8 Z10|G41 G1 X20 Z0 F200|Z-20|X14|G40 X8 Z-15",
    ),
    "G42": Entry(
        COMPENSATION,
        "The tool stays right of the contour.",
        "T1 D1|G0 X60 Z10|G42 G1 X20 Z0 F200|Z-20|X40|G40 X60 Z10",
    ),
    "NORM": Entry(
        APPROACH,
        ("Approaches and leaves the contour on a straight line, perpendicular to the contour."),
        "NORM",
    ),
    "KONT": Entry(
        APPROACH, "Approaches and leaves the contour on a path around the end point of the contour.", "KONT"
    ),
    "G450": Entry(CORNER, "Goes around outside corners on an arc.", "G450"),
    "G451": Entry(CORNER, "Goes around outside corners through the intersection point.", "G451"),
    "G500": Entry(SETTABLE, "Turns the settable offset off.", "G500"),
    **{
        f"G{code}": Entry(SETTABLE, f"Settable offset {code - 53}.", f"G{code} G0 X40 Z2")
        for code in range(54, 60)
    },
    "G505": Entry(SETTABLE, "The fifth settable offset, stored as G58.", "G505 G0 X40 Z2"),
    "G506": Entry(SETTABLE, "The sixth settable offset, stored as G59.", "G506 G0 X40 Z2"),
    "G53": Entry(SUPPRESSION, "Suppresses settable and programmed offsets; D remains active.", "G53 G0 X80"),
    "G153": Entry(SUPPRESSION, "Same as G53.", "G153 G0 X80"),
    "SUPA": Entry(SUPPRESSION, "Same as G53.", "SUPA G0 X80 D0"),
    "G70": Entry(UNIT, "Positions are in inches; F remains in mm.", "G70 G0 X1.5 Z0.1"),
    "G71": Entry(UNIT, "Millimeters.", "G71 G0 X40 Z2"),
    "G700": Entry(UNIT, "Positions and F are in inches.", "G700 G1 X1.5 F8"),
    "G710": Entry(UNIT, "Positions and F are in millimeters.", "G710 G1 X40 F200"),
    "G90": Entry(ABSOLUTE, "Absolute positions.", "G90 G0 X40"),
    "G91": Entry(ABSOLUTE, "Incremental distances.", "G91 G0 X4"),
    "G94": Entry(FEED_AND_SPEED, "Feed F in mm/min; cancels constant surface speed.", "G94 G1 X40 F200"),
    "G95": Entry(FEED_AND_SPEED, "Feed F in mm/rev.", "S500 M3|G95 G1 X40 F0.2"),
    "G96": Entry(
        FEED_AND_SPEED,
        "Constant surface speed, with S in m/min and F in mm/rev.",
        "G96 S150 LIMS=2000 M3|G1 X40 F0.2",
    ),
    "G961": Entry(FEED_AND_SPEED, "Same as G96, with F in mm/min.", "G961 S150 LIMS=2000 M3|G1 X40 F200"),
    "G962": Entry(
        FEED_AND_SPEED,
        "Same as G96; the feed type does not change.",
        "G95|G962 S150 LIMS=2000 M3|G1 X40 F0.2",
    ),
    "G97": Entry(
        FEED_AND_SPEED,
        "Constant spindle speed, with S in rpm and F in mm/rev.",
        "G96 S150 LIMS=2000 M3|G97|G1 X40 F0.2",
    ),
    "G971": Entry(FEED_AND_SPEED, "Same as G97, with F in mm/min.", "G971 S500 M3|G1 X40 F200"),
    "G972": Entry(
        FEED_AND_SPEED, "Same as G97; the feed type does not change.", "G972 S500 M3|G94 G1 X40 F200"
    ),
    "G973": Entry(FEED_AND_SPEED, "Same as G97, without LIMS.", "G973 S500 M3|G1 X40 F0.2"),
    "CFC": Entry(FEED_ON_ARCS, "F applies to the contour.", "CFC", idle=_TIP),
    "CFIN": Entry(FEED_ON_ARCS, "Same as CFC, for inside arcs.", "CFIN", idle=_TIP),
    "CFTCP": Entry(FEED_ON_ARCS, "F applies to the path of the tool tip.", "CFTCP"),
    "BRISK": Entry(ACCELERATION, "Accepted.", "BRISK", idle=_LAW),
    "SOFT": Entry(ACCELERATION, "Accepted.", "SOFT", idle=_LAW),
    "DRIVE": Entry(ACCELERATION, "Accepted.", "DRIVE", idle=_LAW),
    "FFWON": Entry(FEED_FORWARD, "Accepted.", "FFWON", idle="the drives perform the feedforward control"),
    "FFWOF": Entry(FEED_FORWARD, "Accepted.", "FFWOF", idle="the drives perform the feedforward control"),
    "WALIMON": Entry(AREA, "Turns on the working area limits of G25 and G26.", "WALIMON"),
    "WALIMOF": Entry(AREA, "Turns off the working area limits of G25 and G26.", "WALIMOF"),
    "DIAMON": Entry(TRANSVERSE, "X is a diameter.", "DIAMON G0 X40"),
    "DIAMOF": Entry(TRANSVERSE, "X is a radius.", "DIAMOF G0 X20"),
    "DIAM90": Entry(
        TRANSVERSE,
        ("X is a diameter in absolute positions and a radius in incremental distances."),
        "DIAM90 G0 X40",
    ),
    "COMPOF": Entry(COMPRESSOR, "Accepted.", "COMPOF"),
    **{
        name: Entry(COMPRESSOR, "Accepted.", name, idle=_EXACT_PATH)
        for name in ("COMPON", "COMPCURV", "COMPCAD")
    },
    **{
        name: Entry(DYNAMICS, "Accepted.", name, idle=_LAW)
        for name in ("DYNNORM", "DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH")
    },
    "CUT2D": Entry(CONTOUR_PLANE, "Accepted. Tool radius compensation acts in the active plane.", "CUT2D"),
    "CUT2DF": Entry(CONTOUR_PLANE, "Same as CUT2D.", "CUT2DF"),
    "FNORM": Entry(FEED_PROFILE, "Accepted. The feed F is constant throughout a block.", "FNORM"),
    "STOPFIFO": Entry(BUFFER, "Accepted.", "STOPFIFO", idle=_BUFFERED),
    "STARTFIFO": Entry(BUFFER, "Accepted.", "STARTFIFO", idle=_BUFFERED),
    "FIFOCTRL": Entry(BUFFER, "Accepted.", "FIFOCTRL", idle=_BUFFERED),
    "WORKPIECE": Entry(
        PICTURE,
        "Defines the blank for the original control's simulation; accepted.",
        'WORKPIECE(,,,"CYLINDER",0,0,-80,-60,40)',
        idle=_BLANK,
    ),
    "TRANSMIT": Entry(
        TRANSFORMATION,
        (
            "Mills the face of the part: X and Y are programmed across the face, and C "
            "turns the part under the tool. With DIAMON, X is a diameter, but Y is not. "
            "Arcs and radius compensation are programmed in the plane G17. TRANS and ROT "
            "start from zero."
        ),
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y0 F200|G3 X0 Y15 I-15 J0|G0 Z5|TRAFOOF|G18",
    ),
    "TRACYL": Entry(
        TRANSFORMATION,
        (
            "With TRACYL(40), Y is measured around the part on a diameter of 40 mm, Z is "
            "measured along the part, and X is the radial position of the tool. Arcs and radius "
            "compensation are programmed in the plane G19."
        ),
        "T1 D1|G0 X44 Z-5|G19|TRACYL(40)|G1 X38 F200|G1 Y10 Z-15|G0 X44|TRAFOOF|G18",
    ),
    "TRAFOOF": Entry(TRANSFORMATION, "Turns TRANSMIT or TRACYL off.", "TRAFOOF"),
    "G290": Entry(LANGUAGE_MODE, "Selects the SINUMERIK language mode; accepted.", "G290"),
    "CPRECOF": Entry(PRECISION, "Accepted.", "CPRECOF"),
    "CPRECON": Entry(PRECISION, "Accepted.", "CPRECON", idle=_EXACT_PATH),
    "G74": Entry(
        BLOCKWISE,
        ("Moves axes to home at rapid; program each of these axes with the value 0: X1=0 Z1=0."),
        "G74 X1=0 Z1=0",
    ),
    "G75": Entry(
        BLOCKWISE,
        (
            "Moves the programmed axes at rapid to a fixed point that is defined in the "
            "machine file; the axis values are ignored."
        ),
        "G75 X1=0 Z1=0|G0 X60|G75 X0",
    ),
    "G110": Entry(BLOCKWISE, "Pole relative to the current tool position.", "G110 X0 Z0"),
    "G111": Entry(BLOCKWISE, "Pole in workpiece coordinates.", "G111 X20 Z0|G0 RP=10 AP=30"),
    "G112": Entry(BLOCKWISE, "Pole relative to the last pole.", "G111 X20 Z0|G112 X4 Z1"),
    "G25": Entry(
        BLOCKWISE,
        "Sets the minimum spindle speed S, or the lower limits X and Z of the working area.",
        "G25 S50",
    ),
    "G26": Entry(
        BLOCKWISE,
        "Sets the maximum spindle speed S, or the upper limits X and Z of the working area.",
        "G26 S2000",
    ),
    "TRANS": Entry(
        BLOCKWISE, "Shifts the zero; TRANS without an axis cancels the programmed frame.", "TRANS X2 Z-10"
    ),
    "ATRANS": Entry(BLOCKWISE, "Adds a zero shift to the current frame.", "TRANS Z-10|ATRANS Z-5"),
    "ROT": Entry(
        BLOCKWISE, "Rotates the coordinates by the angle RPL=, from Z toward X.", "ROT RPL=30|G0 X20 Z5|ROT"
    ),
    "AROT": Entry(BLOCKWISE, "Adds a rotation to the current frame.", "ROT RPL=30|AROT RPL=-30"),
    "SCALE": Entry(
        BLOCKWISE, "Scales the coordinates by a separate factor for each axis.", "SCALE X2 Z2|G0 X20 Z5|SCALE"
    ),
    "ASCALE": Entry(BLOCKWISE, "Adds scaling to the current frame.", "SCALE Z2|ASCALE Z0.5"),
    "MIRROR": Entry(BLOCKWISE, "Mirrors an axis.", "MIRROR Z0|G0 X20 Z5|MIRROR"),
    "AMIRROR": Entry(BLOCKWISE, "Adds mirroring to the current frame.", "MIRROR Z0|AMIRROR Z0"),
}
"""G functions and words without a value, by the group in which each excludes the others."""

WORDS: Mapping[str, Entry] = {
    "X": Entry(
        "axis",
        (
            "Position perpendicular to the spindle axis; X=AC( ) is absolute and X=IC( ) "
            "incremental, for this word only."
        ),
        "G0 X40",
    ),
    "Z": Entry("axis", "Position along the spindle axis.", "G0 Z=IC(-4)"),
    "Y": Entry(
        "axis",
        "Position in Y, only with TRANSMIT and TRACYL.",
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y5 F200|TRAFOOF|G18",
    ),
    "C": Entry(
        "axis",
        ("Angle; C=DC( ) takes the shortest path, and C=ACP( ) and C=ACN( ) set the direction."),
        "G0 C=DC(90)",
    ),
    "I": Entry(
        "arc",
        (
            "Arc center along X relative to the start point, as a radius value and not a "
            "diameter; I=AC( ) is absolute. With G33, the lead along X."
        ),
        _ARC_IK,
    ),
    "K": Entry(
        "arc",
        ("Arc center along Z relative to the start point; K=AC( ) is absolute. With G33, the lead along Z."),
        _ARC_IK,
    ),
    "J": Entry(
        "arc",
        "Arc center along Y relative to the start point, with TRANSMIT and TRACYL.",
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y0 F200|G3 X0 Y15 I-15 J0|G0 Z5|TRAFOOF|G18",
    ),
    "CR": Entry(
        "arc",
        "Radius; a negative value gives an arc of more than half a circle.",
        "G1 X20 Z0 F200|G2 X30 Z-5 CR=5",
    ),
    "AR": Entry("arc", "Included angle of an arc.", "G1 X20 Z0 F200|G3 X30 Z-5 AR=90"),
    "I1": Entry("arc", "X coordinate of the intermediate point for CIP.", _ARC_THROUGH),
    "K1": Entry("arc", "Z coordinate of the intermediate point for CIP.", _ARC_THROUGH),
    "RP": Entry(
        "polar", "Distance from the pole that G110, G111 or G112 sets.", "G111 X20 Z0|G1 RP=10 AP=90 F200"
    ),
    "AP": Entry(
        "polar", "Angle about the pole, measured from Z toward X.", "G111 X20 Z0|G1 RP=10 AP=90 F200"
    ),
    "ANG": Entry(
        "line",
        (
            "Angle of a line, measured from Z toward X; program the angle with one "
            "coordinate of the end point."
        ),
        "G1 X40 ANG=150 F200",
    ),
    "CHF": Entry("corner", "Chamfer with a given length.", "G1 X40 CHF=2 F200|Z-10"),
    "CHR": Entry("corner", "Chamfer with a given leg length.", "G1 X40 CHR=2 F200|Z-10"),
    "RND": Entry("corner", "Corner rounding with a given radius.", "G1 X40 RND=2 F200|Z-10"),
    "RNDM": Entry(
        "corner", "Rounds every corner until RNDM=0 is programmed.", "G1 RNDM=1 X40 F200|Z-10|RNDM=0"
    ),
    "FRC": Entry("feed", "Feed for the corner of this block.", "G1 X40 CHF=2 FRC=80 F200|Z-10"),
    "FRCM": Entry(
        "feed", "Feed for all corners until FRCM=0 is programmed.", "G1 FRCM=80 X40 CHF=2 F200|Z-10"
    ),
    "F": Entry("feed", "Feed: mm/min under G94, mm/rev under G95.", "G1 X40 F200"),
    "FB": Entry("feed", "Feed for this block only.", "G1 X40 F200|Z-10 FB=50|X44"),
    "OVR": Entry("feed", "Feed as a percentage of F, from 1 to 200.", "OVR=50 G1 X40 F200|OVR=100"),
    "S": Entry("spindle", "Spindle speed in rpm, or surface speed in m/min with G96.", "S500 M3"),
    "LIMS": Entry("spindle", "Maximum spindle speed with G96, G961 and G97.", "LIMS=2000"),
    "SPOS": Entry(
        "spindle",
        ("The spindle stops and remains at this angle, held by its drive or as the C axis."),
        "SPOS=90",
    ),
    "SPOSA": Entry(
        "spindle", "Same as SPOS; the block ends when the spindle has reached its angle.", "SPOSA=90"
    ),
    "WAITS": Entry(
        "spindle",
        (
            "Waits for SPOSA. This is not necessary on this control, because SPOSA itself waits "
            "until the spindle is at its angle."
        ),
        "SPOSA=90|WAITS(1)",
    ),
    "SETMS": Entry("spindle", "Selects the master spindle; only spindle 1 is possible.", "SETMS(1)"),
    "SF": Entry(
        "thread",
        "Start angle of a thread; the tool starts farther back by the corresponding fraction of the lead.",
        "S400 M3|G0 X18 Z8|G33 Z-20 K2 SF=180|G0 X24",
    ),
    **{name: Entry("thread", "Accepted.", f"{name}=2", idle=_LAW) for name in ("DITS", "DITE")},
    "T": Entry(
        "tool", 'Selects the tool by number, or by name with T="ROUGHER"; D1 becomes active.', "T1 D1"
    ),
    "D": Entry("tool", "Cutting edge 1 to 9 of the tool; D0 turns the tool offset off.", "T1|D1|D0"),
    "RPL": Entry("frame", "Rotation angle for ROT and AROT.", "ROT RPL=30|ROT"),
    "OFFN": Entry(
        "path",
        "Stock allowance on the contour for G41 and G42, with TRANSMIT.",
        "T1 D1|G0 X60 Z2|DIAMOF|G17|TRANSMIT|OFFN=1|G42 G1 X15 Y-15 F200|Y15|G40 X40|TRAFOOF|G18",
    ),
    "ADIS": Entry("path", "Accepted.", "G641 ADIS=0.5", idle=_EXACT_PATH),
    "ADISPOS": Entry("path", "Accepted.", "G641 ADISPOS=0.5", idle=_EXACT_PATH),
    "X1": Entry("axis", "Machine axis X, for G74 and G75.", "G74 X1=0"),
    "Z1": Entry("axis", "Machine axis Z, for G74 and G75.", "G74 Z1=0"),
    "FP": Entry("axis", "Fixed point for G75, 1 to 4; 1 if FP is omitted.", "G75 X1=0 FP=1"),
}
"""Words with a value."""

M_FUNCTIONS: Mapping[int, Entry] = {
    0: Entry("stop", "Stops the program until Cycle Start.", "M0"),
    1: Entry("stop", "Stops the program if the optional stop switch is on.", "M1"),
    2: Entry("end", "End of the program.", "M2"),
    30: Entry("end", "End of the program.", "M30"),
    17: Entry("end", "End of a subprogram.", "M17"),
    3: Entry("spindle", "Turns the spindle on clockwise; also M1=3.", "S500 M3"),
    4: Entry("spindle", "Turns the spindle on counterclockwise; also M1=4.", "S500 M4"),
    5: Entry("spindle", "Stops the spindle; also M1=5.", "S500 M3|M5"),
    19: Entry("spindle", "The spindle stops at 0 degrees, like SPOS=0.", "M19"),
    70: Entry("spindle", "The spindle becomes the C axis.", "M70|G0 C90"),
    6: Entry("tool", "Tool change; on this control, T has already changed the tool.", "T1|M6"),
    7: Entry("coolant", "Turns the coolant on.", "M7"),
    8: Entry("coolant", "Turns the coolant on.", "M8"),
    9: Entry("coolant", "Turns the coolant off.", "M9"),
    **{
        code: Entry("gear", "Gear selection; accepted.", f"M{code}", idle="this spindle has only one gear")
        for code in range(40, 46)
    },
}
"""M functions; the machine file adds its own."""
