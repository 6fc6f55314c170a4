"""Vocabulary of SINUMERIK turning, with G functions by group, words with a value, and M functions.

The code book (``code_books/sinumerik``) explains each word. Tests compare the chapters of the code book
with this table.
"""

from __future__ import annotations

from collections.abc import Mapping

MOTION_GROUP = "motion"
DWELL_GROUP = "dwell"
NON_MODAL_GROUP = "non-modal functions"
TRANSFORMATION_GROUP = "transformation"
LANGUAGE_MODE_GROUP = "language mode"
PLANE_GROUP = "plane"
COMPENSATION_GROUP = "tool radius compensation"
SETTABLE_OFFSET_GROUP = "settable offset"
SUPPRESSION_GROUP = "offset suppression"
EXACT_STOP_GROUP = "exact stop or continuous path"
BLOCK_EXACT_STOP_GROUP = "exact stop in one block"
EXACT_STOP_CRITERION_GROUP = "exact stop criterion"
UNIT_GROUP = "unit of length"
DISTANCE_MODE_GROUP = "absolute or incremental"
FEED_TYPE_GROUP = "feed type and spindle speed"
ARC_FEED_GROUP = "feed on arcs"
APPROACH_GROUP = "approach and retract"
CORNER_GROUP = "outside corners"
ACCELERATION_GROUP = "acceleration"
FEEDFORWARD_GROUP = "feedforward"
WORKING_AREA_GROUP = "working area"
DIAMETER_GROUP = "diameter or radius"
COMPRESSOR_GROUP = "compressor"
DYNAMICS_GROUP = "dynamics"
COMPENSATION_PLANE_GROUP = "compensation plane"
FEED_PROFILE_GROUP = "feed profile"
BLOCK_BUFFER_GROUP = "block buffer"
CONTOUR_PRECISION_GROUP = "contour precision"
PICTURE_GROUP = "picture"

_NAMES_BY_GROUP = {
    MOTION_GROUP: "G0 G1 G2 G3 CIP CT G33 G34 G35 G331 G332",
    DWELL_GROUP: "G4",
    BLOCK_EXACT_STOP_GROUP: "G9",
    EXACT_STOP_GROUP: "G60 G64 G641 G642 G643 G644 G645",
    EXACT_STOP_CRITERION_GROUP: "G601 G602 G603",
    PLANE_GROUP: "G17 G18 G19",
    COMPENSATION_GROUP: "G40 G41 G42",
    APPROACH_GROUP: "NORM KONT",
    CORNER_GROUP: "G450 G451",
    SETTABLE_OFFSET_GROUP: "G500 G54 G55 G56 G57 G58 G59 G505 G506",
    SUPPRESSION_GROUP: "G53 G153 SUPA",
    UNIT_GROUP: "G70 G71 G700 G710",
    DISTANCE_MODE_GROUP: "G90 G91",
    FEED_TYPE_GROUP: "G94 G95 G96 G961 G962 G97 G971 G972 G973",
    ARC_FEED_GROUP: "CFC CFIN CFTCP",
    ACCELERATION_GROUP: "BRISK SOFT DRIVE",
    FEEDFORWARD_GROUP: "FFWON FFWOF",
    WORKING_AREA_GROUP: "WALIMON WALIMOF",
    DIAMETER_GROUP: "DIAMON DIAMOF DIAM90",
    COMPRESSOR_GROUP: "COMPOF COMPON COMPCURV COMPCAD",
    DYNAMICS_GROUP: "DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH",
    COMPENSATION_PLANE_GROUP: "CUT2D CUT2DF",
    FEED_PROFILE_GROUP: "FNORM",
    BLOCK_BUFFER_GROUP: "STOPFIFO STARTFIFO FIFOCTRL",
    PICTURE_GROUP: "WORKPIECE",
    TRANSFORMATION_GROUP: "TRANSMIT TRACYL TRAFOOF",
    LANGUAGE_MODE_GROUP: "G290",
    CONTOUR_PRECISION_GROUP: "CPRECOF CPRECON",
    NON_MODAL_GROUP: "G74 G75 G110 G111 G112 G25 G26 TRANS ATRANS ROT AROT SCALE ASCALE MIRROR AMIRROR",
}

GROUP_BY_FUNCTION: Mapping[str, str] = {
    name: group for group, names in _NAMES_BY_GROUP.items() for name in names.split()
}
"""G functions and words without a value, each with its group. Members of a group exclude each other."""

_WORDS = """
    X Y Z C X1 Z1 FP I J K CR AR I1 K1 RP AP ANG CHF CHR RND RNDM FRC FRCM F FB OVR
    S LIMS SPOS SPOSA WAITS SETMS SF DITS DITE T D RPL OFFN ADIS ADISPOS
"""
VALUE_WORDS = frozenset(_WORDS.split())
"""Words with a value."""

M_FUNCTIONS = frozenset({0, 1, 2, 30, 17, 3, 4, 5, 19, 70, 6, 7, 8, 9, *range(40, 46)})
"""M functions of the language. The machine file adds others."""

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

INEFFECTIVE_WORDS: Mapping[str, str] = {
    name: why for why, names in _WITHOUT_EFFECT.items() for name in names.split()
}
"""Functions and words that have no effect on this control, with the reason for the note."""
