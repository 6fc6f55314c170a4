"""Every G function and word of SINUMERIK turning: its group, what it means here, and an example that runs.

The code book (``sinumerik_book``, printed as ``docs/sinumerik-codes.md``) is made of these tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

MOTION = "motion"
DWELL = "dwell"
BLOCKWISE = "acts in its block"
TRANSFORMATION = "transformation"
LANGUAGE_MODE = "language mode"
PLANE = "plane"
COMPENSATION = "tool radius compensation"
SETTABLE = "settable offset"
SUPPRESSION = "suppression of offsets"
EXACT = "exact stop or continuous path"
EXACT_ONCE = "exact stop of the block"
EXACT_WHEN = "when an exact stop is reached"
UNIT = "unit of length"
ABSOLUTE = "absolute or incremental"
FEED_AND_SPEED = "kind of feed and spindle speed"
FEED_ON_ARCS = "feed on arcs"
APPROACH = "approach and retract"
CORNER = "outside corners"
ACCELERATION = "acceleration"
FEED_FORWARD = "feedforward"
AREA = "working area"
TRANSVERSE = "diameter or radius"
COMPRESSOR = "compressor"
DYNAMICS = "dynamics"
CONTOUR_PLANE = "plane of the compensation"
FEED_PROFILE = "feed profile"
BUFFER = "buffer of blocks"
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


_BLANK = "the proof takes its stock from --stock, the page PART or the moves"
_BUFFERED = "the whole program is read before it begins"
_EXACT_PATH = "the path is never rounded here, so no corner is cut off"
_TIP = "F counts on the path of the tip here"
_ARC_IK = "G1 X20 Z0 F200|G3 X30 Z-5 I0 K-5"
_ARC_THROUGH = "G1 X20 Z0 F200|CIP X20 Z-20 I1=30 K1=-10"
_LAW = "the time law of this machine keeps to the acceleration of its axes"

FUNCTIONS: Mapping[str, Entry] = {
    "G0": Entry(MOTION, "Rapid; all axes end together.", "G0 X40 Z2"),
    "G1": Entry(MOTION, "Line at feed.", "G1 X40 Z-10 F200"),
    "G2": Entry(MOTION, "Arc clockwise: I K, CR=, AR=.", "G1 X20 Z0 F200|G2 X30 Z-5 CR=5"),
    "G3": Entry(MOTION, "Arc counter-clockwise.", "G1 X20 Z0 F200|G3 X30 Z-5 I0 K-5"),
    "CIP": Entry(MOTION, "Arc through the point I1= K1=.", "G1 X20 Z0 F200|CIP X20 Z-20 I1=30 K1=-10"),
    "CT": Entry(MOTION, "Arc that goes on from the path before it.", "G1 X20 Z0 F200|Z-10|CT X30 Z-15"),
    "G33": Entry(
        MOTION,
        "Thread of constant lead: K along Z, I along X; SF= its start angle. Blocks may follow.",
        "S400 M3|G0 X18 Z8|G33 Z-20 K2|G0 X24",
    ),
    "G34": Entry(
        MOTION,
        "As G33 with a lead that grows by F, mm a revolution each revolution.",
        "S400 M3|G0 X18 Z8|G34 Z-20 K1 F0.1|G0 X24",
    ),
    "G35": Entry(MOTION, "As G34 with a lead that shrinks.", "S400 M3|G0 X18 Z8|G35 Z-20 K3 F0.1|G0 X24"),
    "G331": Entry(
        MOTION,
        "A tap goes in: the spindle, held as C, turns with Z by the lead K (under 0 left-hand).",
        "SPOS=0|S100|G331 Z-10 K1|G332 Z10 K1",
    ),
    "G332": Entry(
        MOTION, "It comes out again, the spindle turns back.", "SPOS=0|S100|G331 Z-10 K1|G332 Z10 K1"
    ),
    "G4": Entry(DWELL, "Dwell: F seconds, S revolutions.", "G4 F0.5"),
    "G9": Entry(EXACT_ONCE, "Exact stop at the end of this block.", "G9 G1 X30 F200|Z-5"),
    "G60": Entry(EXACT, "Exact stop at the end of every block.", "G60 G1 X30 F200|Z-5"),
    "G64": Entry(EXACT, "Continuous path: corners by the acceleration of the axes.", "G64 G1 X30 F200|Z-5"),
    **{
        f"G{code}": Entry(EXACT, "As G64: no corner is rounded off.", f"G{code} G1 X30 F200")
        for code in (641, 642, 643, 644, 645)
    },
    **{
        f"G{code}": Entry(EXACT_WHEN, "Taken: an exact stop always waits for the position.", f"G{code} G60")
        for code in (601, 602, 603)
    },
    "G17": Entry(PLANE, "Plane X Y: no arcs and no radius compensation on this lathe.", "G17|G18"),
    "G18": Entry(PLANE, "Plane Z X, the turning plane.", "G18"),
    "G19": Entry(PLANE, "Plane Y Z: no arcs and no radius compensation on this lathe.", "G19|G18"),
    "G40": Entry(COMPENSATION, "Radius compensation off, with the next move.", "G40"),
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
    "NORM": Entry(APPROACH, "To the contour and off it straight, square to its end.", "NORM"),
    "KONT": Entry(APPROACH, "To the contour and off it round its end point.", "KONT"),
    "G450": Entry(CORNER, "Round an outside corner on an arc.", "G450"),
    "G451": Entry(CORNER, "Round an outside corner by the intersection.", "G451"),
    "G500": Entry(SETTABLE, "No settable offset.", "G500"),
    **{
        f"G{code}": Entry(SETTABLE, f"Settable offset {code - 53}.", f"G{code} G0 X40 Z2")
        for code in range(54, 60)
    },
    "G505": Entry(SETTABLE, "The fifth settable offset, kept as G58.", "G505 G0 X40 Z2"),
    "G506": Entry(SETTABLE, "The sixth settable offset, kept as G59.", "G506 G0 X40 Z2"),
    "G53": Entry(SUPPRESSION, "Without settable and programmed offsets; D stays.", "G53 G0 X80"),
    "G153": Entry(SUPPRESSION, "As G53.", "G153 G0 X80"),
    "SUPA": Entry(SUPPRESSION, "As G53.", "SUPA G0 X80 D0"),
    "G70": Entry(UNIT, "Inches; F stays in mm.", "G70 G0 X1.5 Z0.1"),
    "G71": Entry(UNIT, "Millimetres.", "G71 G0 X40 Z2"),
    "G700": Entry(UNIT, "Inches, F too.", "G700 G1 X1.5 F8"),
    "G710": Entry(UNIT, "Millimetres, F too.", "G710 G1 X40 F200"),
    "G90": Entry(ABSOLUTE, "Positions.", "G90 G0 X40"),
    "G91": Entry(ABSOLUTE, "Distances.", "G91 G0 X4"),
    "G94": Entry(FEED_AND_SPEED, "F in mm/min; ends a constant surface speed.", "G94 G1 X40 F200"),
    "G95": Entry(FEED_AND_SPEED, "F in mm a revolution.", "S500 M3|G95 G1 X40 F0.2"),
    "G96": Entry(
        FEED_AND_SPEED,
        "Constant surface speed, S in m/min, and F in mm a revolution.",
        "G96 S150 LIMS=2000 M3|G1 X40 F0.2",
    ),
    "G961": Entry(FEED_AND_SPEED, "As G96, F in mm/min.", "G961 S150 LIMS=2000 M3|G1 X40 F200"),
    "G962": Entry(FEED_AND_SPEED, "As G96, F as it is.", "G95|G962 S150 LIMS=2000 M3|G1 X40 F0.2"),
    "G97": Entry(
        FEED_AND_SPEED,
        "The spindle keeps its speed, S in rpm, F in mm a revolution.",
        "G96 S150 LIMS=2000 M3|G97|G1 X40 F0.2",
    ),
    "G971": Entry(FEED_AND_SPEED, "As G97, F in mm/min.", "G971 S500 M3|G1 X40 F200"),
    "G972": Entry(FEED_AND_SPEED, "As G97, F as it is.", "G972 S500 M3|G94 G1 X40 F200"),
    "G973": Entry(FEED_AND_SPEED, "As G97, without LIMS.", "G973 S500 M3|G1 X40 F0.2"),
    "CFC": Entry(FEED_ON_ARCS, "F counts on the contour.", "CFC", idle=_TIP),
    "CFIN": Entry(FEED_ON_ARCS, "As CFC inside arcs.", "CFIN", idle=_TIP),
    "CFTCP": Entry(FEED_ON_ARCS, "F counts on the path of the tip.", "CFTCP"),
    "BRISK": Entry(ACCELERATION, "Taken.", "BRISK", idle=_LAW),
    "SOFT": Entry(ACCELERATION, "Taken.", "SOFT", idle=_LAW),
    "DRIVE": Entry(ACCELERATION, "Taken.", "DRIVE", idle=_LAW),
    "FFWON": Entry(FEED_FORWARD, "Taken.", "FFWON", idle="feedforward is the drives'"),
    "FFWOF": Entry(FEED_FORWARD, "Taken.", "FFWOF", idle="feedforward is the drives'"),
    "WALIMON": Entry(AREA, "G25 and G26 bound the working area.", "WALIMON"),
    "WALIMOF": Entry(AREA, "G25 and G26 bound no working area.", "WALIMOF"),
    "DIAMON": Entry(TRANSVERSE, "X is a diameter.", "DIAMON G0 X40"),
    "DIAMOF": Entry(TRANSVERSE, "X is a radius.", "DIAMOF G0 X20"),
    "DIAM90": Entry(TRANSVERSE, "X is a diameter as a position, a radius as a distance.", "DIAM90 G0 X40"),
    "COMPOF": Entry(COMPRESSOR, "Taken.", "COMPOF"),
    **{
        name: Entry(COMPRESSOR, "Taken.", name, idle=_EXACT_PATH)
        for name in ("COMPON", "COMPCURV", "COMPCAD")
    },
    **{
        name: Entry(DYNAMICS, "Taken.", name, idle=_LAW)
        for name in ("DYNNORM", "DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH")
    },
    "CUT2D": Entry(CONTOUR_PLANE, "Taken: compensation is in the plane.", "CUT2D"),
    "CUT2DF": Entry(CONTOUR_PLANE, "As CUT2D.", "CUT2DF"),
    "FNORM": Entry(FEED_PROFILE, "Taken: F holds all along a block.", "FNORM"),
    "STOPFIFO": Entry(BUFFER, "Taken.", "STOPFIFO", idle=_BUFFERED),
    "STARTFIFO": Entry(BUFFER, "Taken.", "STARTFIFO", idle=_BUFFERED),
    "FIFOCTRL": Entry(BUFFER, "Taken.", "FIFOCTRL", idle=_BUFFERED),
    "WORKPIECE": Entry(
        PICTURE,
        "The blank of the maker's picture; taken.",
        'WORKPIECE(,,,"CYLINDER",0,0,-80,-60,40)',
        idle=_BLANK,
    ),
    "TRANSMIT": Entry(
        TRANSFORMATION,
        "X and Y mill the face of the part, which C turns under the tool; under DIAMON X is a diameter, Y is "
        "none. Arcs and radius compensation lie in G17. TRANS and ROT begin anew.",
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y0 F200|G3 X0 Y15 I-15 J0|G0 Z5|TRAFOOF|G18",
    ),
    "TRACYL": Entry(
        TRANSFORMATION,
        "TRACYL(40): Y is measured round the part on 40 mm, Z along it, X is how far out the tool stands. "
        "Arcs and radius compensation lie in G19.",
        "T1 D1|G0 X44 Z-5|G19|TRACYL(40)|G1 X38 F200|G1 Y10 Z-15|G0 X44|TRAFOOF|G18",
    ),
    "TRAFOOF": Entry(TRANSFORMATION, "TRANSMIT or TRACYL off.", "TRAFOOF"),
    "G290": Entry(LANGUAGE_MODE, "The language of this control: taken.", "G290"),
    "CPRECOF": Entry(PRECISION, "Taken.", "CPRECOF"),
    "CPRECON": Entry(PRECISION, "Taken.", "CPRECON", idle=_EXACT_PATH),
    "G74": Entry(BLOCKWISE, "To home, rapid, in axes named with 0: X1=0 Z1=0.", "G74 X1=0 Z1=0"),
    "G75": Entry(
        BLOCKWISE,
        "To a fixed point of the machine file, rapid, in axes named; the value of an axis says nothing.",
        "G75 X1=0 Z1=0|G0 X60|G75 X0",
    ),
    "G110": Entry(BLOCKWISE, "Pole, from where the tool stands.", "G110 X0 Z0"),
    "G111": Entry(BLOCKWISE, "Pole in the workpiece.", "G111 X20 Z0|G0 RP=10 AP=30"),
    "G112": Entry(BLOCKWISE, "Pole, from the last pole.", "G111 X20 Z0|G112 X4 Z1"),
    "G25": Entry(BLOCKWISE, "Lowest spindle speed S, or lower end X Z of the working area.", "G25 S50"),
    "G26": Entry(BLOCKWISE, "Highest spindle speed S, or upper end X Z of the working area.", "G26 S2000"),
    "TRANS": Entry(BLOCKWISE, "Zero shifted; alone: no programmed frame.", "TRANS X2 Z-10"),
    "ATRANS": Entry(BLOCKWISE, "Zero shifted further.", "TRANS Z-10|ATRANS Z-5"),
    "ROT": Entry(BLOCKWISE, "Coordinates turned by RPL=, from Z towards X.", "ROT RPL=30|G0 X20 Z5|ROT"),
    "AROT": Entry(BLOCKWISE, "Turned further.", "ROT RPL=30|AROT RPL=-30"),
    "SCALE": Entry(BLOCKWISE, "Coordinates times a factor an axis.", "SCALE X2 Z2|G0 X20 Z5|SCALE"),
    "ASCALE": Entry(BLOCKWISE, "Scaled further.", "SCALE Z2|ASCALE Z0.5"),
    "MIRROR": Entry(BLOCKWISE, "An axis counted the other way.", "MIRROR Z0|G0 X20 Z5|MIRROR"),
    "AMIRROR": Entry(BLOCKWISE, "Mirrored further.", "MIRROR Z0|AMIRROR Z0"),
}
"""G functions and words without a value, by the group in which each excludes the others."""

WORDS: Mapping[str, Entry] = {
    "X": Entry("axis", "Position across the axis; X=AC( ) and X=IC( ) for one word.", "G0 X40"),
    "Z": Entry("axis", "Position along the axis.", "G0 Z=IC(-4)"),
    "Y": Entry(
        "axis",
        "Of TRANSMIT and TRACYL alone.",
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y5 F200|TRAFOOF|G18",
    ),
    "C": Entry("axis", "Angle; C=DC( ) short way, C=ACP( ) and C=ACN( ) by direction.", "G0 C=DC(90)"),
    "I": Entry("arc", "Centre from the start along X, a radius; I=AC( ). Lead along X beside G33.", _ARC_IK),
    "K": Entry("arc", "Centre from the start along Z; K=AC( ). Lead along Z beside G33.", _ARC_IK),
    "J": Entry(
        "arc",
        "Centre from the start along Y, in TRANSMIT and TRACYL.",
        "T1 D1|G0 X40 Z2|DIAMOF|G17|TRANSMIT|G1 X15 Y0 F200|G3 X0 Y15 I-15 J0|G0 Z5|TRAFOOF|G18",
    ),
    "CR": Entry("arc", "Radius; under 0 more than half a turn.", "G1 X20 Z0 F200|G2 X30 Z-5 CR=5"),
    "AR": Entry("arc", "Opening angle.", "G1 X20 Z0 F200|G3 X30 Z-5 AR=90"),
    "I1": Entry("arc", "X of the point on the way of CIP.", _ARC_THROUGH),
    "K1": Entry("arc", "Z of the point on the way of CIP.", _ARC_THROUGH),
    "RP": Entry("polar", "Distance from the pole of G110 to G112.", "G111 X20 Z0|G1 RP=10 AP=90 F200"),
    "AP": Entry("polar", "Angle about the pole, from Z towards X.", "G111 X20 Z0|G1 RP=10 AP=90 F200"),
    "ANG": Entry("line", "Angle of a line from Z towards X, with one end coordinate.", "G1 X40 ANG=150 F200"),
    "CHF": Entry("corner", "Chamfer, its length.", "G1 X40 CHF=2 F200|Z-10"),
    "CHR": Entry("corner", "Chamfer, its leg.", "G1 X40 CHR=2 F200|Z-10"),
    "RND": Entry("corner", "Rounding, its radius.", "G1 X40 RND=2 F200|Z-10"),
    "RNDM": Entry("corner", "Rounding of every corner until RNDM=0.", "G1 RNDM=1 X40 F200|Z-10|RNDM=0"),
    "FRC": Entry("feed", "Feed of the corner of this block.", "G1 X40 CHF=2 FRC=80 F200|Z-10"),
    "FRCM": Entry("feed", "Feed of all corners until FRCM=0.", "G1 FRCM=80 X40 CHF=2 F200|Z-10"),
    "F": Entry("feed", "Feed: mm/min under G94, mm a revolution under G95.", "G1 X40 F200"),
    "FB": Entry("feed", "Feed of this block alone.", "G1 X40 F200|Z-10 FB=50|X44"),
    "OVR": Entry("feed", "Feed in per cent of F, 1 to 200.", "OVR=50 G1 X40 F200|OVR=100"),
    "S": Entry("spindle", "Speed: rpm, or m/min under G96.", "S500 M3"),
    "LIMS": Entry("spindle", "Highest speed under G96, G961, G97.", "LIMS=2000"),
    "SPOS": Entry("spindle", "The spindle stops and is held at this angle, by its drive or as C.", "SPOS=90"),
    "SPOSA": Entry("spindle", "As SPOS: the block ends when the spindle is at its angle.", "SPOSA=90"),
    "WAITS": Entry("spindle", "Waits for SPOSA, which has waited itself.", "SPOSA=90|WAITS(1)"),
    "SETMS": Entry("spindle", "Which spindle is the master: only spindle 1.", "SETMS(1)"),
    "SF": Entry(
        "thread",
        "Start angle of a thread: the tool begins so much of the lead further back.",
        "S400 M3|G0 X18 Z8|G33 Z-20 K2 SF=180|G0 X24",
    ),
    **{name: Entry("thread", "Taken.", f"{name}=2", idle=_LAW) for name in ("DITS", "DITE")},
    "T": Entry("tool", 'Tool by number, or by name T="ROUGHER"; D1 becomes active.', "T1 D1"),
    "D": Entry("tool", "Cutting edge 1 to 9 of the tool; D0: no tool offset.", "T1|D1|D0"),
    "RPL": Entry("frame", "Angle of ROT and AROT.", "ROT RPL=30|ROT"),
    "OFFN": Entry(
        "path",
        "Allowance beside the contour of G41 and G42, in TRANSMIT.",
        "T1 D1|G0 X60 Z2|DIAMOF|G17|TRANSMIT|OFFN=1|G42 G1 X15 Y-15 F200|Y15|G40 X40|TRAFOOF|G18",
    ),
    "ADIS": Entry("path", "Taken.", "G641 ADIS=0.5", idle=_EXACT_PATH),
    "ADISPOS": Entry("path", "Taken.", "G641 ADISPOS=0.5", idle=_EXACT_PATH),
    "X1": Entry("axis", "X of the machine, beside G74 and G75.", "G74 X1=0"),
    "Z1": Entry("axis", "Z of the machine, beside G74 and G75.", "G74 Z1=0"),
    "FP": Entry("axis", "Which fixed point of G75, 1 to 4; 1 without it.", "G75 X1=0 FP=1"),
}
"""Words with a value."""

M_FUNCTIONS: Mapping[int, Entry] = {
    0: Entry("stop", "Stop until Cycle Start.", "M0"),
    1: Entry("stop", "Stop where the switch for it is on.", "M1"),
    2: Entry("end", "End of the program.", "M2"),
    30: Entry("end", "End of the program.", "M30"),
    17: Entry("end", "End of a subprogram.", "M17"),
    3: Entry("spindle", "Spindle clockwise; also M1=3.", "S500 M3"),
    4: Entry("spindle", "Spindle counter-clockwise; also M1=4.", "S500 M4"),
    5: Entry("spindle", "Spindle stops; also M1=5.", "S500 M3|M5"),
    19: Entry("spindle", "The spindle stops at 0 degrees, as SPOS=0.", "M19"),
    70: Entry("spindle", "The spindle becomes the axis C.", "M70|G0 C90"),
    6: Entry("tool", "Tool change: T has changed the tool before.", "T1|M6"),
    7: Entry("coolant", "Coolant on.", "M7"),
    8: Entry("coolant", "Coolant on.", "M8"),
    9: Entry("coolant", "Coolant off.", "M9"),
    **{
        code: Entry("gear", "Gear step: taken.", f"M{code}", idle="this spindle has one gear step")
        for code in range(40, 46)
    },
}
"""M functions; the machine file adds its own."""
