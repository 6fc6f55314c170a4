"""The code book of Klartext: words of older and of newer controls than the iTNC 530."""

from __future__ import annotations

from core.language.code_book import Entry

_HOLE = "CYCL DEF 200 DRILLING ~\n Q200=PREDEF ~\n Q201=-8 ~\n Q206=+150 ~\n Q202=+4 ~\n Q203=+0"


def other_controls() -> tuple[Entry, ...]:
    """GLOBAL DEF, PRESET SELECT, FUNCTION DWELL, LN; blocks without L, M94 C, S(VC=), WMAT."""
    return (
        Entry(
            "GLOBAL DEF",
            "n Q..=..",
            "Defines parameters for all later cycles, which use them through PREDEF.",
            f"GLOBAL DEF 100 GENERAL ~\n Q200=+2 ~\n Q204=+50\n{_HOLE}\nCYCL CALL",
            f"{_HOLE}\nCYCL CALL",
            "no GLOBAL DEF",
        ),
        Entry(
            "PRESET SELECT",
            "#n",
            "Activates a row of the preset table, as cycle 247 does.",
            "PRESET SELECT #0",
            'PRESET SELECT "VICE"',
            "with a name",
        ),
        Entry(
            "FUNCTION DWELL",
            "TIME..",
            "Dwells for the given number of seconds.",
            "FUNCTION DWELL TIME0.5",
            "FUNCTION DWELL REV5",
            "revolutions",
        ),
        Entry(
            "LN",
            "X.. Y.. Z.. NX.. NY.. NZ..",
            (
                "Moves in a straight line; NX, NY and NZ are the surface normal. Compensation along "
                "the normal is not available: a block with DL, DR, DR2 or TX TY TZ is rejected."
            ),
            "LN X+10 Y+5 Z+20 NX+0.1 NY+0.2 NZ+0.97 F300",
            "TOOL CALL 1 Z S1000 F200 DR+0.1\nLN X+10 Y+5 Z+20 NX+0.1 NY+0.2 NZ+0.97 F300",
            "3D compensation",
        ),
        Entry(
            "R+",
            "",
            (
                "In a block that moves one axis (X+10 R+ F300; L is optional), R+ lengthens the move "
                "by the tool radius and R- shortens it."
            ),
            "X+30 R+ F300",
            "L X+30 Y+10 R+ F300",
            "one axis",
        ),
        Entry(
            "S(VC=",
            "n)",
            "S(VC=…) in TOOL CALL sets the spindle speed from a cutting speed in m/min and the tool radius.",
            "TOOL CALL 1 Z S(VC=60) F300",
            "TOOL DEF 7 L+0 R+0\nTOOL CALL 7 Z S(VC=60) F300",
            "radius",
        ),
        Entry(
            "WMAT",
            '"name"',
            "Specifies the material. TurnDesk ignores this block and reports it.",
            'WMAT "STEEL"',
        ),
    )
