"""The code book of SINUMERIK: its standard cycles, each with an example and a refusal."""

from __future__ import annotations

from core.language.code_book import Entry
from core.language.sinumerik.cycle_names import CYCLES, CYCLES_OUTSIDE, CYCLES_TAKEN

_CUT = "S900 M3 G95 F0.1\n"
_HOLE = "S900 M3 G94 F100 G17\nG0 X0 Z5\n"
_FACE = "T1 D1\nG94 F100 G17\nG0 X40 Z5\nDIAMOF\nTRANSMIT\n"
_KONTUR = (("KONTUR.spf", "G1 X20 Z0\nX20 Z-10 RND=2\nX30\nX50 Z-25\nM17\n"),)


def _entry(
    name: str, what: str, example: str, refused: str, why: str, files: tuple[tuple[str, str], ...] = ()
) -> Entry:
    return Entry(name, f"({', '.join(CYCLES[name])})", what, example, refused, why, files=files)


STANDARD_CYCLES = (
    _entry(
        "CYCLE81", (
            "Hole along Z under G17: rapid to SDIS before RFP, feed to DP (or DPR deep), "
            "rapid to RTP."),
        _HOLE + "CYCLE81(5, 0, 2, -12)", _HOLE + "CYCLE81(5, 0, 2, 12)", "DP",
    ),
    _entry(
        "CYCLE82", (
            "Same as CYCLE81, with a dwell of DTB seconds at the bottom; a negative DTB is "
            "in revolutions."),
        _HOLE + "CYCLE82(5, 0, 2, -12, , 0.5)", _HOLE + "CYCLE82(5, 0, 2)", "DP",
    ),
    _entry(
        "CYCLE83",
        (
            "Deep hole drilled in pecks: the first to FDEP or by FDPR, each next peck "
            "smaller by DAM; VARI 1 leaves the hole after each peck, VARI 0 retracts by _VRT."),
        _HOLE + "CYCLE83(5, 0, 2, -30, , -10, , 2, 0.2, 0, 1, 1)",
        _HOLE + "CYCLE83(5, 0, 2, -30, , -40)", "FDEP",
    ),
    _entry(
        "CYCLE84",
        (
            "Tapping without a compensating chuck: the spindle stops at POSS, then turns "
            "with Z by PIT (negative: left-hand) or MPIT, in at SST rpm and out at SST1 rpm; "
            "_VARI 1 and 2 work in steps of _DAM. SDAC is the spindle state afterward: 3, 4, "
            "or 5 for a stopped spindle."),
        "G94 F100 G17\nG0 X0 Z5\nCYCLE84(5, 0, 2, -12, , , 5, , 1, 0, 100, 100)",
        _HOLE + "CYCLE84(5, 0, 2, -12, , , 5, , 1, 0, 100, 100)", "C axis",
    ),
    _entry(
        "CYCLE840",
        (
            "Tapping with a compensating chuck: feeds in by PIT or MPIT, or at F with ENC 1; "
            "the spindle reverses, and the tap feeds out."),
        _HOLE + "CYCLE840(5, 0, 2, -12, , , 0, 3, 0, , 1)", "G17\nCYCLE840(5, 0, 2, -12, , , 0, 3, 0, , 1)",
        "61102",
    ),
    _entry(
        "CYCLE86",
        (
            "Boring: at the bottom, the spindle stops at POSS and the edge lifts by RPA "
            "along X and by RPAP along Z."),
        _HOLE + "CYCLE86(5, 0, 2, -12, , 0, 3, -1, 0, 1, 0)",
        _HOLE + "CYCLE86(5, 0, 2, -12, , 0, 5, -1, 0, 1, 0)", "61102",
    ),
    _entry(
        "CYCLE87", (
            "Boring: at the bottom, the spindle stops and the program waits for Cycle Start."),
        _HOLE + "CYCLE87(5, 0, 2, -12, , 3)", _HOLE + "CYCLE87(5, 0, 2, -12, , 5)", "61102",
    ),
    _entry(
        "CYCLE88", (
            "Same as CYCLE87, with a dwell before the stop."),
        _HOLE + "CYCLE88(5, 0, 2, -12, , 0.5, 3)", _HOLE + "CYCLE88(5, 0, 2, 12, , 0, 3)", "DP",
    ),
    _entry(
        "CYCLE85", (
            "Reaming and boring: feeds in at FFR and out at RFF."),
        _HOLE + "CYCLE85(5, 0, 2, -12, , 0, 80, 200)",
        _HOLE + "CYCLE85(5, 0, 2, -12, , 0, -80)", "FFR",
    ),
    _entry(
        "CYCLE89", (
            "Same as CYCLE85, but in and out at the active feed."), _HOLE + "CYCLE89(5, 0, 2, -12, , 1)",
        "G18\nCYCLE89(5, 0, 2, -12)", "G17",
    ),
    _entry(
        "CYCLE92",
        (
            "Parts off at SPL with the active edge from the diameter SPD: to _DIAG1 at _FF1, "
            "then to _DIAG2 at _FF2 and _SS2 rpm. _SV1 is a surface speed if its limit _SV2 "
            "is given, otherwise rpm; _SDAC is 3 or 4. Depths are diameters."),
        _CUT + "T1 D1\nG0 X50 Z-30\nCYCLE92(40, -30, 10, -1, , 1, 0, 0, 0, 0.1, 0.05, 500)",
        _CUT + "T1 D1\nCYCLE92(40, -30, 60, -1, , 1, 0, 0, 0, 0.1, 0.05, 500)", "_DIAG1",
    ),
    _entry(
        "CYCLE93",
        (
            "Groove with square flanks from the point SPD (a diameter), SPL: WIDG wide, DIAG "
            "deep; VARI 5 toward minus Z, 1 toward plus Z, 7 and 3 inside. The tool width is "
            "the distance from D to _DN, or to D+1."),
        _CUT + "T1 D1\nG0 X44 Z-10\nCYCLE93(40, -12, 6, 4, , , , , , , , 0.1, 0.1, 1.5, 0.5, 5)",
        _CUT + "T1 D1\nCYCLE93(40, -12, 6, 4, , , , , , , , 0.1, 0.1, 1.5, 0.5, 5, , 4)", "D4",
    ),
    _entry(
        "CYCLE94",
        (
            "Undercut E or F (DIN 509) at the shoulder SPL of the diameter SPD, based on the "
            "tip quadrant of the tool: 3 outside with the shoulder toward minus Z, 4 outside "
            "toward plus Z; 2 and 1 inside. VARI 1 to 4 replaces the tip quadrant."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE94(40, -12, "E")', _CUT + 'T1 D1\nCYCLE94(40, -12, "G")', "FORM",
    ),
    _entry(
        "CYCLE940",
        (
            "Undercut E or F (DIN 509), A or B (DIN 76) at the shoulder SPL of the diameter "
            "SPD. _LAGE 0 and 1 are outside, 2 and 3 inside; 0 and 2 have the shoulder "
            "toward plus Z. For A and B, _PITI counts the leads of DIN 76, starting at 0.2; "
            "_VARI 1 roughs, 2 finishes, 3 does both in passes of _MID."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE940(40, -12, "E", 1, 2, 0.1)',
        _CUT + 'T1 D1\nCYCLE940(40, -12, "T", 1, 2, 0.1)', "FORM",
    ),
    _entry(
        "CYCLE96",
        (
            "Undercut (DIN 76) at the shoulder SPL after a coarse thread of size DIATH: A, B "
            "(short) outside, C and D (short) inside; VARI as in CYCLE94."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE96(30, -20, "A")', _CUT + 'T1 D1\nCYCLE96(7, -20, "A")', "DIATH",
    ),
    _entry(
        "CYCLE95",
        (
            "Turns the contour of a subprogram or between two labels (\"START:END\") from the "
            "stock: passes of MID, allowances FALZ, FALX (radius) or FAL, feeds FF1, FF2 "
            "into reliefs, FF3 for finishing. VARI 1 to 4 rough, 5 to 8 finish, 9 to 12 do "
            "both: along Z outside, along X outside, along Z inside, along X inside. The "
            "nose radius is taken into account."),
        _CUT + 'CYCLE95("KONTUR", 2, 0.1, 0.2, , 0.3, 0.1, 0.12, 9)',
        _CUT + 'CYCLE95("KONTUR", , 0.1, 0.2, , 0.3, 0.1, 0.12, 9)', "MID", _KONTUR,
    ),
    _entry(
        "CYCLE97",
        (
            "Thread from SPL to FPL at the diameters DM1 and DM2, lead PIT or size MPIT: NRC "
            "passes to TDEP less FAL, then NID passes without infeed; NUMT starts; VARI 1 "
            "and 2 use equal depths, 3 and 4 equal chips, 2 and 4 inside; IANG feeds in "
            "along a flank."),
        "S800 M3\nG0 X44 Z6\nCYCLE97(1.5, , 0, -20, 40, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 3, 1)",
        "S800 M3\nG0 X44 Z6\nCYCLE97( , 7, 0, -20, 40, 40, 4, 2, 0.92, 0, 0, , 4, 1, 3, 1)", "MPIT",
    ),
    _entry(
        "CYCLE98",
        (
            "Three connected threads: from PO1 DM1 via PO2 DM2 and PO3 DM3 to PO4 DM4, leads "
            "PP1 to PP3; the rest as in CYCLE97."),
        "S300 M3\nCYCLE98(0, 30, -20, 30, -40, 36, -50, 36, 6, 3, 0.92, 0, 0, , 4, 1, 1.5, 2, 2, 1)",
        "S300 M3\nCYCLE98(0, 30, -20, 30, -10, 36, -50, 36, 6, 3, 0.92, 0, 0, , 4, 1, 1.5, 2, 2, 1)",
        "PO3",
    ),
    _entry(
        "CYCLE99",
        (
            "Thread from SPL, DM1 to FPL, DM2, as in CYCLE97. VARI 300101 and 300102: equal "
            "depths, outside and inside; 300103 and 300104: equal chips; 3002..: on both "
            "flanks alternately."),
        "S800 M3\nG0 X44 Z6\nCYCLE99(0, 40, -20, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 1.5, 300103, 1)",
        "S800 M3\nG0 X44 Z6\nCYCLE99(0, 40, -20, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 1.5, 300109, 1)", "VARI",
    ),
    _entry(
        "HOLES1",
        (
            "Row of NUM holes in TRANSMIT from X SPCA, Y SPCO along STA1; the first hole is "
            "FDIS away, and the spacing is DBH."),
        _FACE + "MCALL CYCLE81(5, 0, 2, -3)\nHOLES1(20, 0, 90, -10, 10, 3)\nMCALL\nTRAFOOF",
        "MCALL CYCLE81(5, 0, 2, -3)\nHOLES1(20, 0, 90, -10, 10, 3)", "TRANSMIT",
    ),
    _entry(
        "HOLES2",
        (
            "Bolt circle of NUM holes in TRANSMIT around X CPA, Y CPO with radius RAD; the "
            "first hole is at STA1, and INDA is the angle between holes; INDA 0 spaces them "
            "over the full circle."),
        _FACE + "MCALL CYCLE81(5, 0, 2, -3)\nHOLES2(0, 0, 15, 0, 0, 6)\nMCALL\nTRAFOOF",
        _FACE + "HOLES2(0, 0, 15, 0, 0, 6)", "MCALL",
    ),
    *(
        Entry(
            name, "( )", f"Accepted. No effect: {why}.", f"{name}()",
            "CYCLE800(1)" if name == "CYCLE800" else "CYCLE832(", name,
        )
        for name, why in CYCLES_TAKEN.items()
    ),
    *(
        Entry(name, "( )", f"Rejected: {why}.", "", f"{name}()", name)
        for name, why in CYCLES_OUTSIDE.items()
    ),
)  # fmt: skip
"""Standard cycles, and those that are refused by name."""
