"""A block of 100 by 100 with four chamfers of 10 by 45 degrees, told in three ways."""

from __future__ import annotations

import re

_DATUMS = ("X+0 Y+10 Z+0", "X+90 Y+0 Z+0", "X+100 Y+90 Z+0", "X+10 Y+100 Z+0")
_AXIAL = ("A+45 C+0", "A+45 C+90", "A+45 C+180", "A+45 C+270")
_POINTS = (
    "P2X+1 P2Y+0 P2Z+0 P3X+0 P3Y+1 P3Z+1",
    "P2X+0 P2Y+1 P2Z+0 P3X-1 P3Y+0 P3Z+1",
    "P2X-1 P2Y+0 P2Z+0 P3X+0 P3Y-1 P3Z+1",
    "P2X+0 P2Y-1 P2Z+0 P3X+1 P3Y+0 P3Z+1",
)


def _program(planes: list[str]) -> str:
    blocks = [
        "BEGIN PGM FOURSIDES MM",
        "BLK FORM 0.1 Z X+0 Y+0 Z-40",
        "BLK FORM 0.2 X+100 Y+100 Z+0",
        "TOOL CALL 1 Z S4000 F600",
        "L X+50 Y+50 Z+120 R0 FMAX M3",
    ]
    for datum, plane in zip(_DATUMS, planes, strict=True):
        blocks += [f"TRANS DATUM AXIS {datum}", f"{plane} ; tilt", "CALL LBL 1"]
    blocks += [
        "PLANE RESET TURN MB MAX FMAX",
        "TRANS DATUM RESET",
        "M30",
        "LBL 1",
        "L X-15 Y-7.071 R0 FMAX",
        "L Z+3 FMAX",
        "L Z+0 F250",
        "L X+115 F600",
        "L Z+60 FMAX",
        "PLANE RESET STAY",
        "LBL 0",
        "END PGM FOURSIDES MM",
    ]
    return "".join(f"{number} {block}\n" for number, block in enumerate(blocks))


AXIAL = _program([f"PLANE AXIAL {angles} TURN MB MAX FMAX" for angles in _AXIAL])
POINTS = _program(
    [f"PLANE POINTS P1X+0 P1Y+0 P1Z+0 {points} TURN MB MAX FMAX SYM+ TABLE ROT" for points in _POINTS]
)
SYM_MINUS = re.sub(r"SYM\+", "SYM-", POINTS)
