"""The code book of SINUMERIK: its standard cycles, each with an example and a refusal."""

from __future__ import annotations

from core.language.code_book import Entry
from core.language.sinumerik.cycle_names import CYCLES, CYCLES_OUTSIDE, CYCLES_TAKEN
from core.message import Message

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
        "CYCLE81",
        "Drills a hole along Z with G17: rapid to SDIS before RFP, feed to DP (or to a "
        "depth of DPR), then rapid to RTP.",
        _HOLE + "CYCLE81(5, 0, 2, -12)", _HOLE + "CYCLE81(5, 0, 2, 12)", "DP",
    ),
    _entry(
        "CYCLE82",
        "Same as CYCLE81, with a dwell of DTB seconds at the bottom; a negative DTB "
        "specifies revolutions.",
        _HOLE + "CYCLE82(5, 0, 2, -12, , 0.5)", _HOLE + "CYCLE82(5, 0, 2)", "DP",
    ),
    _entry(
        "CYCLE83",
        (
                "Drills a deep hole in pecks: the first peck drills to FDEP or by the distance "
                "FDPR, and each subsequent peck is shorter by DAM. With VARI 1, the drill "
                "leaves the hole after each peck; with VARI 0, it retracts by _VRT."),
        _HOLE + "CYCLE83(5, 0, 2, -30, , -10, , 2, 0.2, 0, 1, 1)",
        _HOLE + "CYCLE83(5, 0, 2, -30, , -40)", "FDEP",
    ),
    _entry(
        "CYCLE84",
        (
                "Rigid tapping, without a compensating chuck: the spindle stops at POSS and is "
                "then synchronized with Z at the pitch PIT (negative for a left-hand thread) "
                "or the pitch of the thread size MPIT. The speed is SST rpm into the hole and "
                "SST1 rpm out of the hole. With _VARI 1 and 2, the cycle taps in steps of "
                "_DAM. SDAC is the spindle state after the cycle: 3, 4, or 5 for a stopped "
                "spindle."),
        "G94 F100 G17\nG0 X0 Z5\nCYCLE84(5, 0, 2, -12, , , 5, , 1, 0, 100, 100)",
        _HOLE + "CYCLE84(5, 0, 2, -12, , , 5, , 1, 0, 100, 100)", "C axis",
    ),
    _entry(
        "CYCLE840",
        (
                "Taps with a compensating chuck: the tap feeds in at the pitch PIT, at the pitch of "
                "" "the thread size MPIT, or at F with ENC 1; the spindle reverses, and the tap "
                "feeds out."),
        _HOLE + "CYCLE840(5, 0, 2, -12, , , 0, 3, 0, , 1)", "G17\nCYCLE840(5, 0, 2, -12, , , 0, 3, 0, , 1)",
        "61102",
    ),
    _entry(
        "CYCLE86",
        "Bores; at the bottom of the hole, the spindle stops at the angle POSS, and "
        "the edge moves off the wall by RPA along X and by RPAP along Z.",
        _HOLE + "CYCLE86(5, 0, 2, -12, , 0, 3, -1, 0, 1, 0)",
        _HOLE + "CYCLE86(5, 0, 2, -12, , 0, 5, -1, 0, 1, 0)", "61102",
    ),
    _entry(
        "CYCLE87",
        "Bores; at the bottom of the hole, the spindle stops and the program waits for Cycle Start.",
        _HOLE + "CYCLE87(5, 0, 2, -12, , 3)", _HOLE + "CYCLE87(5, 0, 2, -12, , 5)", "61102",
    ),
    _entry(
        "CYCLE88",
        "Same as CYCLE87, with a dwell before the stop.",
        _HOLE + "CYCLE88(5, 0, 2, -12, , 0.5, 3)", _HOLE + "CYCLE88(5, 0, 2, 12, , 0, 3)", "DP",
    ),
    _entry(
        "CYCLE85",
        "Reams or bores: feeds in at FFR and out at RFF.",
        _HOLE + "CYCLE85(5, 0, 2, -12, , 0, 80, 200)",
        _HOLE + "CYCLE85(5, 0, 2, -12, , 0, -80)", "FFR",
    ),
    _entry(
        "CYCLE89",
        "Same as CYCLE85, but feeds in and out at the active feed.", _HOLE + "CYCLE89(5, 0, 2, -12, , 1)",
        "G18\nCYCLE89(5, 0, 2, -12)", "G17",
    ),
    _entry(
        "CYCLE92",
        (
                "Cuts the part off at SPL with the active edge, starting at the diameter SPD: "
                "first to _DIAG1 at _FF1, then to _DIAG2 at _FF2 and _SS2 rpm. _SV1 is a "
                "surface speed if its limit _SV2 is specified, otherwise rpm; _SDAC is 3 or 4. "
                "Depths are diameters."),
        _CUT + "T1 D1\nG0 X50 Z-30\nCYCLE92(40, -30, 10, -1, , 1, 0, 0, 0, 0.1, 0.05, 500)",
        _CUT + "T1 D1\nCYCLE92(40, -30, 60, -1, , 1, 0, 0, 0, 0.1, 0.05, 500)", "_DIAG1",
    ),
    _entry(
        "CYCLE93",
        (
                "Cuts a groove with square flanks, WIDG wide and DIAG deep, from the point SPD "
                "(a diameter), SPL. VARI 5 cuts toward minus Z and VARI 1 toward plus Z; VARI "
                "7 and 3 do the same for inside grooves. The tool width is the distance from "
                "cutting edge D to cutting edge _DN, or to D+1."),
        _CUT + "T1 D1\nG0 X44 Z-10\nCYCLE93(40, -12, 6, 4, , , , , , , , 0.1, 0.1, 1.5, 0.5, 5)",
        _CUT + "T1 D1\nCYCLE93(40, -12, 6, 4, , , , , , , , 0.1, 0.1, 1.5, 0.5, 5, , 4)", "D4",
    ),
    _entry(
        "CYCLE94",
        (
                "Cuts an undercut of form E or F (DIN 509) at diameter SPD and shoulder SPL, "
                "based on the tip quadrant of the tool: 3 is outside with the shoulder toward "
                "minus Z, 4 is outside with the shoulder toward plus Z, and 2 and 1 are the "
                "corresponding quadrants inside. VARI 1 to 4 replaces the tip quadrant."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE94(40, -12, "E")', _CUT + 'T1 D1\nCYCLE94(40, -12, "G")', "FORM",
    ),
    _entry(
        "CYCLE940",
        (
                "Cuts an undercut of form E or F (DIN 509), or a thread undercut of form A or "
                "B (DIN 76), at diameter SPD and shoulder SPL. _LAGE 0 and 1 are outside, 2 "
                "and 3 inside; with 0 and 2, the shoulder is toward plus Z. For A and B, _PITI "
                "selects the pitch from the table of DIN 76, starting with 0.2. _VARI 1 "
                "roughs, 2 finishes, and 3 does both in passes of _MID."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE940(40, -12, "E", 1, 2, 0.1)',
        _CUT + 'T1 D1\nCYCLE940(40, -12, "T", 1, 2, 0.1)', "FORM",
    ),
    _entry(
        "CYCLE96",
        (
                "Cuts a thread undercut (DIN 76) at the shoulder SPL, for a coarse thread of size "
                "DIATH: forms A and B (short) are external, forms C and D (short) are internal; "
                "VARI " "has the same meaning as in CYCLE94."),
        _CUT + 'T1 D1\nG0 X50 Z5\nCYCLE96(30, -20, "A")', _CUT + 'T1 D1\nCYCLE96(7, -20, "A")', "DIATH",
    ),
    _entry(
        "CYCLE95",
        "Turns a contour from the stock. The contour is described in a subprogram or between two "
        "labels (\"START:END\"). Parameters: passes of MID, allowances FALZ, FALX (radius) " "or "
        "FAL, and feeds FF1, FF2 for plunging into reliefs and FF3 for finishing. VARI 1 to 4 "
        "rough, 5 to 8 finish, and 9 to 12 do both, each in this order: along Z " "outside, along X "
        "outside, along Z inside, along X inside. The nose radius is taken into account.",
        _CUT + 'CYCLE95("KONTUR", 2, 0.1, 0.2, , 0.3, 0.1, 0.12, 9)',
        _CUT + 'CYCLE95("KONTUR", , 0.1, 0.2, , 0.3, 0.1, 0.12, 9)', "MID", _KONTUR,
    ),
    _entry(
        "CYCLE97",
        (
                "Cuts a thread from SPL to FPL at the diameters DM1 and DM2, with lead PIT or "
                "size MPIT: NRC passes to TDEP less FAL, then NID passes without infeed. NUMT "
                "is the number of starts. VARI 1 and 2 use equal depths of cut, and 3 and 4 "
                "equal chip cross sections; VARI 2 and 4 cut internal threads. With IANG, the "
                "tool feeds in along a flank."),
        "S800 M3\nG0 X44 Z6\nCYCLE97(1.5, , 0, -20, 40, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 3, 1)",
        "S800 M3\nG0 X44 Z6\nCYCLE97( , 7, 0, -20, 40, 40, 4, 2, 0.92, 0, 0, , 4, 1, 3, 1)", "MPIT",
    ),
    _entry(
        "CYCLE98",
        "Cuts three connected threads from PO1 DM1 via PO2 DM2 and PO3 DM3 to PO4 DM4, "
        "with leads PP1 to PP3; the other parameters are as in CYCLE97.",
        "S300 M3\nCYCLE98(0, 30, -20, 30, -40, 36, -50, 36, 6, 3, 0.92, 0, 0, , 4, 1, 1.5, 2, 2, 1)",
        "S300 M3\nCYCLE98(0, 30, -20, 30, -10, 36, -50, 36, 6, 3, 0.92, 0, 0, , 4, 1, 1.5, 2, 2, 1)",
        "PO3",
    ),
    _entry(
        "CYCLE99",
        (
                "Cuts a thread from SPL, DM1 to FPL, DM2, as in CYCLE97. VARI 300101 and "
                "300102 use equal depths of cut, for external and internal threads; 300103 and "
                "300104 use equal chip cross sections; 3002.. feeds in along both flanks "
                "alternately."),
        "S800 M3\nG0 X44 Z6\nCYCLE99(0, 40, -20, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 1.5, 300103, 1)",
        "S800 M3\nG0 X44 Z6\nCYCLE99(0, 40, -20, 40, 4, 2, 0.92, 0.05, 30, , 4, 1, 1.5, 300109, 1)", "VARI",
    ),
    _entry(
        "HOLES1",
        "Row of NUM holes with TRANSMIT: the row starts at the point X SPCA, Y SPCO and runs at "
        "the angle STA1. The first hole is FDIS from this point, and the spacing is DBH.",
        _FACE + "MCALL CYCLE81(5, 0, 2, -3)\nHOLES1(20, 0, 90, -10, 10, 3)\nMCALL\nTRAFOOF",
        "MCALL CYCLE81(5, 0, 2, -3)\nHOLES1(20, 0, 90, -10, 10, 3)", "TRANSMIT",
    ),
    _entry(
        "HOLES2",
        "Bolt circle of NUM holes with TRANSMIT: the center is at X CPA, Y CPO, and "
        "the radius is RAD. The first hole is at angle STA1, and INDA is the angle "
        "between holes. With INDA 0, the holes are spaced over the full circle.",
        _FACE + "MCALL CYCLE81(5, 0, 2, -3)\nHOLES2(0, 0, 15, 0, 0, 6)\nMCALL\nTRAFOOF",
        _FACE + "HOLES2(0, 0, 15, 0, 0, 6)", "MCALL",
    ),
    *(
        Entry(
            name, "( )", Message((
                "Accepted, but has no effect because {why}."), why=why), Message("{name}()", name=name),
            "CYCLE800(1)" if name == "CYCLE800" else "CYCLE832(", name,
        )
        for name, why in CYCLES_TAKEN.items()
    ),
    *(
        Entry(name, "( )", Message("Rejected: {why}.", why=why), "", Message("{name}()", name=name), name)
        for name, why in CYCLES_OUTSIDE.items()
    ),
)  # fmt: skip
"""Standard cycles, and those that are refused by name."""
