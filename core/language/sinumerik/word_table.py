"""Vocabulary of SINUMERIK turning: G functions by group, words with a value, and M functions.

The code book (``code_books/sinumerik``) explains each word. Tests compare its chapters with this table.
"""

from __future__ import annotations

from collections.abc import Mapping

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

_NAMES_OF_GROUP = {
    MOTION: "G0 G1 G2 G3 CIP CT G33 G34 G35 G331 G332",
    DWELL: "G4",
    EXACT_ONCE: "G9",
    EXACT: "G60 G64 G641 G642 G643 G644 G645",
    EXACT_WHEN: "G601 G602 G603",
    PLANE: "G17 G18 G19",
    COMPENSATION: "G40 G41 G42",
    APPROACH: "NORM KONT",
    CORNER: "G450 G451",
    SETTABLE: "G500 G54 G55 G56 G57 G58 G59 G505 G506",
    SUPPRESSION: "G53 G153 SUPA",
    UNIT: "G70 G71 G700 G710",
    ABSOLUTE: "G90 G91",
    FEED_AND_SPEED: "G94 G95 G96 G961 G962 G97 G971 G972 G973",
    FEED_ON_ARCS: "CFC CFIN CFTCP",
    ACCELERATION: "BRISK SOFT DRIVE",
    FEED_FORWARD: "FFWON FFWOF",
    AREA: "WALIMON WALIMOF",
    TRANSVERSE: "DIAMON DIAMOF DIAM90",
    COMPRESSOR: "COMPOF COMPON COMPCURV COMPCAD",
    DYNAMICS: "DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH",
    CONTOUR_PLANE: "CUT2D CUT2DF",
    FEED_PROFILE: "FNORM",
    BUFFER: "STOPFIFO STARTFIFO FIFOCTRL",
    PICTURE: "WORKPIECE",
    TRANSFORMATION: "TRANSMIT TRACYL TRAFOOF",
    LANGUAGE_MODE: "G290",
    PRECISION: "CPRECOF CPRECON",
    BLOCKWISE: "G74 G75 G110 G111 G112 G25 G26 TRANS ATRANS ROT AROT SCALE ASCALE MIRROR AMIRROR",
}

FUNCTIONS: Mapping[str, str] = {
    name: group for group, names in _NAMES_OF_GROUP.items() for name in names.split()
}
"""G functions and words without a value, with the group in which each excludes the others."""

_WORDS = """
    X Y Z C X1 Z1 FP I J K CR AR I1 K1 RP AP ANG CHF CHR RND RNDM FRC FRCM F FB OVR
    S LIMS SPOS SPOSA WAITS SETMS SF DITS DITE T D RPL OFFN ADIS ADISPOS
"""
WORDS = frozenset(_WORDS.split())
"""Words with a value."""

M_FUNCTIONS = frozenset({0, 1, 2, 30, 17, 3, 4, 5, 19, 70, 6, 7, 8, 9, *range(40, 46)})
"""M functions; the machine file adds its own."""

_WITHOUT_EFFECT = {
    "on this control, F always applies to the path of the tool tip": "CFC CFIN",
    "the velocity profile always stays within the axis acceleration limits of this machine": (
        "BRISK SOFT DRIVE DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH DITS DITE"
    ),
    "the drives perform the feedforward control": "FFWON FFWOF",
    "the programmed path is followed exactly and corners are never rounded": (
        "COMPON COMPCURV COMPCAD CPRECON ADIS ADISPOS"
    ),
    "the control reads the whole program before the program starts": "STOPFIFO STARTFIFO FIFOCTRL",
    (
        "TurnDesk proves the program with the stock that is set by --stock or on the "
        "PART page, or that is assumed from the moves"
    ): "WORKPIECE",
    "this spindle has only one gear": "M40 M41 M42 M43 M44 M45",
}

IDLE: Mapping[str, str] = {name: why for why, names in _WITHOUT_EFFECT.items() for name in names.split()}
"""Functions and words that have no effect on this control, with the reason that a note states."""
