"""Standard cycles of SINUMERIK by name, with their parameters in order, and the cycles that are rejected."""

from __future__ import annotations

from collections.abc import Mapping

_DRILL = "RTP RFP SDIS DP DPR"
_MODES = "_GMODE _DMODE _AMODE"

CYCLE_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    name: tuple(parameters.split())
    for name, parameters in {
        "CYCLE81": f"{_DRILL} DTB {_MODES}",
        "CYCLE82": f"{_DRILL} DTB {_MODES}",
        "CYCLE83": f"{_DRILL} FDEP FDPR DAM DTB DTS FRF VARI _AXN _MDEP _VRT _DTD _DIS1 {_MODES}",
        "CYCLE84": f"{_DRILL} DTB SDAC MPIT PIT POSS SST SST1 _AXN _PITA _TECHNO _VARI _DAM _VRT "
        f"_PITM _PTAB _PTABA {_MODES}",
        "CYCLE840": f"{_DRILL} DTB SDR SDAC ENC MPIT PIT _AXN _PITA _TECHNO _PITM _PTAB _PTABA {_MODES}",
        "CYCLE85": f"{_DRILL} DTB FFR RFF {_MODES}",
        "CYCLE86": f"{_DRILL} DTB SDIR RPA RPO RPAP POSS {_MODES}",
        "CYCLE87": f"{_DRILL} SDIR",
        "CYCLE88": f"{_DRILL} DTB SDIR",
        "CYCLE89": f"{_DRILL} DTB",
        "CYCLE92": "SPD SPL _DIAG1 _DIAG2 _RC _SDIS _SV1 _SV2 _SDAC _FF1 _FF2 _SS2 _DIAGM _VARI _DN "
        "_DMODE _AMODE",
        "CYCLE93": "SPD SPL WIDG DIAG STA1 ANG1 ANG2 RCO1 RCO2 RCI1 RCI2 FAL1 FAL2 IDEP DTB VARI _VRT _DN",
        "CYCLE94": "SPD SPL FORM VARI",
        "CYCLE940": "SPD SPL FORM _LAGE _SDIS _FFP _VARI _EPD _EPL _R1 _R2 _STA _VRT _MID _FAL _FALX _FALZ "
        "_PITI _PTAB _PTABA _DMODE _AMODE",
        "CYCLE95": "NPP MID FALZ FALX FAL FF1 FF2 FF3 VARI DT DAM _VRT",
        "CYCLE96": "DIATH SPL FORM VARI",
        "CYCLE97": "PIT MPIT SPL FPL DM1 DM2 APP ROP TDEP FAL IANG NSP NRC NID VARI NUMT _VRT",
        "CYCLE98": "PO1 DM1 PO2 DM2 PO3 DM3 PO4 DM4 APP ROP TDEP FAL IANG NSP NRC NID PP1 PP2 PP3 "
        "VARI NUMT _VRT",
        "CYCLE99": "SPL DM1 FPL DM2 APP ROP TDEP FAL IANG NSP NRC NID PIT VARI NUMTH _SDIS _MID _GDEP "
        "_PIT1 _FDEP _GST _GUD _IFLANK _PITA _PITM _PTAB _PTABA _DMODE _AMODE",
        "HOLES1": "SPCA SPCO STA1 FDIS DBH NUM",
        "HOLES2": "CPA CPO RAD STA1 INDA NUM",
    }.items()
}
"""Names of the cycle parameters as in the manuals, in call order.

Names that begin with _ are from newer cycles.
"""

_MASK = (
    "newer controls generate this cycle from an input form, and the coding of its "
    "parameters differs between software versions"
)
_MILL = "pockets and slots are not supported; write their path as moves of X, Z and C"
_PROBE = "this lathe has no probe for measuring cycles"
_SWIVEL = "this lathe has no swivel head; remove this cycle"

UNSUPPORTED_CYCLES: Mapping[str, str] = {
    "CYCLE62": f"{_MASK}; specify the contour in CYCLE95",
    "CYCLE930": f"{_MASK}; write the groove with CYCLE93",
    **dict.fromkeys(("CYCLE950", "CYCLE951", "CYCLE952"), f"{_MASK}; write the contour with CYCLE95"),
    **dict.fromkeys(("LONGHOLE", "SLOT1", "SLOT2", "POCKET1", "POCKET2", "POCKET3", "POCKET4"), _MILL),
    **dict.fromkeys(("CYCLE60", "CYCLE61", "CYCLE63", "CYCLE64", "CYCLE70", "CYCLE71", "CYCLE72"), _MILL),
    **dict.fromkeys(("CYCLE73", "CYCLE74", "CYCLE75", "CYCLE76", "CYCLE77", "CYCLE78", "CYCLE79"), _MILL),
    **dict.fromkeys(("CYCLE90", "CYCLE899", "CYCLE801", "CYCLE802"), _MILL),
    **dict.fromkeys((f"CYCLE{number}" for number in (*range(971, 980), *range(994, 999), 982, 9960)), _PROBE),
    **dict.fromkeys(("CYCLE806", "CYCLE996"), _SWIVEL),
}
"""Standard cycles that this control rejects, with the replacement."""

SWIVEL_CYCLE = "CYCLE800"
IGNORED_CYCLES: Mapping[str, str] = {
    SWIVEL_CYCLE: "this lathe has no swivel position to reset",
    "CYCLE832": "the path is followed exactly, regardless of the tolerance",
}
"""Standard cycles that do nothing on this control, with the reason.

CYCLE800 is ignored only with empty parentheses.
"""
