"""The code book of SINUMERIK turning, from the word table, the jumps and what is refused of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from core.language.code_book import CodeBook, Entry
from core.language.sinumerik import word_table
from core.language.sinumerik.calls_book import CALLS
from core.language.sinumerik.cycle_words import MEANINGS
from core.language.sinumerik.cycles_book import STANDARD_CYCLES
from core.language.sinumerik.word_table import FUNCTIONS, M_FUNCTIONS, WORDS
from core.message import Message

HEAD = "G0 X60 Z10\n"
"""Before every example: tool 1 is in, its offsets are 0, and the spindle stands."""

TAIL = "M30\n"

_ARC = "G1 X40 Z0 F200\n"
_REFUSED: Mapping[str, tuple[str, str]] = {
    "G0": ("G0 X50 X40", "X"),
    "G1": ("G1 X=IC( F200", "12080"),
    "G2": (_ARC + "G2 X50 Z-5 CR=1", "CR"),
    "G3": (_ARC + "G3 X50 Z-5 I30 K-5", "radius"),
    "G4": ("G4 F-1", "dwell"),
    "G17": ("G17 G18", "12060"),
    "G53": ("G53", "moves an axis"),
    "G70": ("G70 G71", "12060"),
    "G90": ("G90 G91", "12060"),
    "G94": ("G94 G95", "12060"),
    "G96": ("G96 G97", "12060"),
    "G500": ("G500 G54", "12060"),
    "TRANS": ("TRANS Y3", "Y"),
    "ATRANS": ("ATRANS Y3", "Y"),
    "X": ("G0 X=QC(3)", "12080"),
    "Z": ("G0 Z=DC(3)", "rotary axis"),
    "C": ("M5\nG0 C=QC(3)", "12080"),
    "I": (_ARC + "G3 X50 Z-5 I=IC(3) K-5", "12080"),
    "K": (_ARC + "G3 X50 Z-5 I0 K=IC(3)", "12080"),
    "CR": (_ARC + "G2 X50 Z-5 CR=0", "CR"),
    "AR": (_ARC + "G2 X50 Z-5 AR=400", "AR"),
    "CHF": (_ARC + "G1 X50 CHF=40\nZ-10", "CHF"),
    "CHR": (_ARC + "G1 X50 CHR=40\nZ-10", "CHR"),
    "RND": (_ARC + "G1 X50 RND=40\nZ-10", "RND"),
    "F": ("G1 Z8 F-1", "F"),
    "S": ("S-900 M3", "S"),
    "LIMS": ("LIMS=-5", "LIMS"),
    "M3": ("M3", "S"),
    "M19": ("M19 M5", "in the same block"),
    "CIP": (_ARC + "CIP X50 Z-5", "I1"),
    "CT": (_ARC + "Z-5\nCT Z-9 CR=4", "CR"),
    "G33": ("S400 M3\nG33 X40 K2", "Z"),
    "G9": ("G9 G9", "12060"),
    "G60": ("G60 G64", "12060"),
    "G41": ("G41 G1 X40 Z0 F200\nZ-10\nM30", "G41"),
    "G42": ("T1 D1\nG42 G2 X50 Z-5 CR=50 F200", "straight line"),
    "NORM": ("NORM KONT", "12060"),
    "G450": ("G450 G451", "12060"),
    "G505": ("G505 G54", "12060"),
    "SUPA": ("SUPA", "moves an axis"),
    "DIAMON": ("DIAMON DIAMOF", "12060"),
    "G74": ("G74 X1=5", "home"),
    "G75": ("G75 X1=0 M8", "only the axes to move"),
    "G110": ("G110 X=IC(3)", "plain number"),
    "G25": ("G26 S500\nG25 S600", "above the maximum speed"),
    "G26": ("G26 S0", "limit"),
    "ROT": ("ROT X30", "RPL"),
    "SCALE": ("SCALE X0", "factor"),
    "MIRROR": ("MIRROR Z0 G1", "separate block"),
    "I1": (_ARC + "G2 X50 Z-5 CR=5 I1=3", "I1"),
    "RP": ("G0 RP=10", "both"),
    "AP": ("G0 RP=10 AP=30 X5", "combined with"),
    "ANG": ("G1 X40 Z5 ANG=30 F200", "ANG"),
    "RNDM": ("RNDM=-1", "RNDM"),
    "FRC": (_ARC + "G1 X50 CHF=2 FRC=0 F100\nZ-10", "FRC"),
    "FB": ("G1 X40 F200 FB=0", "FB"),
    "OVR": ("OVR=300", "OVR"),
    "SPOS": ("SPOS=400", "SPOS"),
    "SPOSA": ("SPOSA=-10", "SPOSA"),
    "WAITS": ("WAITS(2)", "one spindle"),
    "SETMS": ("SETMS(2)", "one spindle"),
    "SF": ("S400 M3\nG33 Z-20 K2\nG33 Z-30 K2 SF=90", "SF"),
    "G34": ("S400 M3\nG34 Z-20 K2", "F"),
    "G35": ("S400 M3\nG35 Z-20 K1 F0.5", "decreases to 0"),
    "G331": ("S100\nG331 Z-20 K1", "C axis"),
    "G332": ("S100\nG332 Z-20 K1", "C axis"),
    "TRANSMIT": ("S400 M3\nTRANSMIT", "M5"),
    "TRACYL": ("TRACYL", "diameter"),
    "TRAFOOF": ("TRAFOOF X3", "separate block"),
    "Y": ("G0 Y3", "no Y axis"),
    "J": (_ARC + "G2 X50 Z-5 J3", "I and K"),
    "OFFN": ("OFFN=1", "TRANSMIT"),
    "T": ("T1.5", "whole number"),
    "D": ("T1\nD10", "D"),
    "RPL": ("TRANS X3 RPL=4", "ROT"),
    "X1": ("G74 X1=5", "home"),
    "Z1": ("G74 Z1=5", "home"),
    "FP": ("G75 X1=0 FP=4", "1 fixed points for X"),
    "K1": (_ARC + "G2 X50 Z-5 CR=5 K1=3", "K1"),
    "FRCM": ("FRCM=-1", "FRCM"),
    "DITS": ("DITS=-3", "DITS"),
    "DITE": ("DITE=-3", "DITE"),
    "ADIS": ("ADIS=-1", "ADIS"),
    "ADISPOS": ("ADISPOS=-1", "ADISPOS"),
    "AROT": ("AROT X30", "RPL"),
    "ASCALE": ("ASCALE X0", "factor"),
    "AMIRROR": ("AMIRROR Z0 G1", "separate block"),
    "M0": ("M0 M30", "in the same block"),
    "M1": ("M1 M30", "in the same block"),
    "M2": ("M2 M30", "in the same block"),
    "M17": ("M17 M30", "in the same block"),
    "M30": ("M30 M2", "in the same block"),
    "M4": ("M4", "S"),
    "M5": ("S500 M3 M5", "in the same block"),
    "M70": ("M70 M5", "in the same block"),
    "M6": ("S500 M6 M3 M8 M40 M0 M25", "maximum is 5"),
    "M7": ("M7 M9", "in the same block"),
    "M8": ("M8 M9", "in the same block"),
    "M9": ("M9 M8", "in the same block"),
    **{
        f"M{code}": (f"M{code} M{85 - code if code != 42 else 40}", "in the same block")
        for code in range(40, 46)
    },
}


def _of_table(table: Iterable[tuple[str, word_table.Entry]]) -> tuple[tuple[str, tuple[Entry, ...]], ...]:
    """Chapters of a table: one a group, in the order of the table."""
    groups: dict[str, list[Entry]] = {}
    for name, told in table:
        refused, why = _REFUSED.get(name) or (f"{name} {name}", "12060")  # twice is two of a group
        meaning = (
            Message("{meaning} This word has no effect because {idle}.", meaning=told.meaning, idle=told.idle)
            if told.idle
            else told.meaning
        )
        entry = Entry(name, "", meaning, told.example.replace("|", "\n"), refused, why)
        groups.setdefault(told.group, []).append(entry)
    return tuple((group.capitalize(), tuple(entries)) for group, entries in groups.items())


def _flow() -> tuple[Entry, ...]:
    return (
        Entry("GOTOF", "label", "Jumps forward.", "GOTOF LATER\nG0 Z5\nLATER:", "GOTOF NOWHERE", "14080"),
        Entry(
            "GOTOB",
            "label",
            "Jumps backward.",
            "R1=0\nAGAIN: R1=R1+1\nIF R1<3 GOTOB AGAIN",
            "GOTOB NOWHERE",
            "14080",
        ),
        Entry(
            "GOTO",
            "label",
            "Jumps forward, or backward if the label is not in a later block.",
            "GOTO LATER\nG0 Z5\nLATER:",
            "GOTO NOWHERE",
            "14080",
        ),
        Entry(
            "IF",
            "condition",
            "Runs the blocks up to ELSE or ENDIF, or makes a jump, only if the condition is true.",
            "R1=2\nIF R1==2\nG0 Z5\nELSE\nG0 Z6\nENDIF",
            "IF R1==2\nG0 Z5",
            "12640",
        ),
        Entry(
            "ELSE",
            "",
            "Runs the blocks that follow ELSE if the condition is not true.",
            "R1=2\nIF R1==2\nG0 Z5\nELSE\nG0 Z6\nENDIF",
            "ELSE",
            "ELSE",
        ),
        Entry("ENDIF", "", "Ends IF.", "R1=2\nIF R1==2\nG0 Z5\nENDIF", "ENDIF", "ENDIF"),
        Entry(
            "WHILE",
            "condition",
            "Repeats the blocks while the condition is true.",
            "R1=0\nWHILE R1<3\nR1=R1+1\nENDWHILE",
            "WHILE R1<3",
            "12640",
        ),
        Entry("ENDWHILE", "", "Ends WHILE.", "R1=0\nWHILE R1<3\nR1=R1+1\nENDWHILE", "ENDWHILE", "ENDWHILE"),
        Entry(
            "FOR",
            "R1 = 1 TO 5",
            "Repeats the blocks while a counter counts up.",
            "FOR R1=1 TO 3\nG0 Z=IC(-1)\nENDFOR",
            "FOR R1=1",
            "FOR needs TO",
        ),
        Entry("ENDFOR", "", "Ends FOR.", "FOR R1=1 TO 3\nG0 Z=IC(-1)\nENDFOR", "ENDFOR", "ENDFOR"),
        Entry(
            "LOOP",
            "",
            "Repeats the blocks until a jump leaves the loop.",
            "R1=0\nLOOP\nR1=R1+1\nIF R1>3 GOTOF OUT\nENDLOOP\nOUT:",
            "LOOP",
            "12640",
        ),
        Entry(
            "ENDLOOP",
            "",
            "Ends LOOP.",
            "R1=0\nLOOP\nR1=R1+1\nIF R1>3 GOTOF OUT\nENDLOOP\nOUT:",
            "ENDLOOP",
            "ENDLOOP",
        ),
        Entry(
            "REPEAT",
            "",
            "Repeats the blocks up to UNTIL; with a label, repeats the blocks from the label to "
            "this block, for example twice with P=2.",
            "R1=0\nREPEAT\nR1=R1+1\nUNTIL R1>3",
            "REPEAT",
            "12640",
        ),
        Entry(
            "UNTIL",
            "condition",
            "Ends REPEAT when the condition is true.",
            "R1=0\nREPEAT\nR1=R1+1\nUNTIL R1>3",
            "UNTIL R1>3",
            "UNTIL",
        ),
        Entry(
            "DEF",
            "REAL name = ..",
            "Defines variables of the program: REAL, INT, BOOL, CHAR, STRING. REAL name[5] is an "
            "array, and REAL name[2,3] an array with two dimensions (the maximum is three). A "
            "name begins with two letters or _.",
            "DEF REAL DEPTH = 2.5\nG0 Z=-DEPTH",
            "DEF AXIS NAME",
            "AXIS",
        ),
        Entry(
            "SET",
            "(.., .., ..)",
            (
                "Sets the values of the elements of an array in order (the last index changes "
                "fastest); an omitted element retains its value. After DEF, you can omit SET "
                "and write only the parentheses."
            ),
            "DEF REAL DEPTHS[2,2]\nDEPTHS[0,1]=SET(-3, , -5)\nG0 Z=DEPTHS[1,1]",
            "DEF REAL DEPTHS[2]=(1, 2, 3)",
            "more elements",
        ),
        Entry(
            "REP",
            "(value, n)",
            "Assigns one value to n elements of an array, or to all remaining elements if n is omitted.",
            "DEF REAL DEPTHS[3]=REP(-2)\nDEPTHS[1]=REP(-4, 1)\nG0 Z=DEPTHS[1]+DEPTHS[2]",
            "DEF REAL DEPTHS[3]=REP()",
            "REP accepts only a value",
        ),
        Entry(
            "R",
            "n = formula",
            (
                "Assigns a value to an R parameter: + - * / DIV MOD, parentheses, SIN COS TAN ASIN "
                "ACOS ATAN2 SQRT POT ABS LN EXP TRUNC ROUND MINVAL MAXVAL."
            ),
            "R1=2*SIN(30)\nG0 Z=R1",
            "R1=1/0",
            "divides by zero",
        ),
        Entry(
            "$P_TOOLNO",
            "",
            (
                "Number of the active tool; $P_TOOL is the active D number, and $P_TOOLR is the nose "
                "radius in mm. Other system variables are rejected."
            ),
            "T1 D1\nR1=$P_TOOLNO",
            "R1=$AA_IM[X]",
            "system variable",
        ),
        Entry(
            "$AA_IW",
            "[X]",
            (
                "Position of X, Z or C in program coordinates, with X as set by DIAMON; $P_EP[X] has "
                "the same value."
            ),
            "G0 X40\nR1=$AA_IW[X]",
            "R1=$AA_IW[Q]",
            "system variable",
        ),
        Entry(
            "MSG",
            '("text")',
            "Shows a message to the operator; an empty text clears the message.",
            'MSG("FINISH")\nMSG()',
            "MSG FINISH",
            "MSG",
        ),
        Entry(
            "STOPRE",
            "",
            "Preprocessing stop: no later block is prepared until this block is finished.",
            "STOPRE",
            "STOPRE X3",
            "STOPRE",
        ),
        Entry("RET", "", "Returns from a subprogram.", "M30", "RET X3", "RET", whole=True),
    )


_M_CODES = [(f"M{code}", entry) for code, entry in M_FUNCTIONS.items()]
BOOK = CodeBook(
    (
        *_of_table(FUNCTIONS.items()),
        *((f"Words: {group.lower()}", entries) for group, entries in _of_table(WORDS.items())),
        *((f"M functions: {group.lower()}", entries) for group, entries in _of_table(_M_CODES)),
        ("Jumps, loops, variables", _flow()),
        ("Subprograms and repeats", CALLS),
        ("Standard cycles", STANDARD_CYCLES),
    ),
    head=HEAD,
    tail=TAIL,
    comment=";",
    meanings=MEANINGS,
)
"""All of it."""
