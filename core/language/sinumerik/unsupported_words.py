"""Words of the SINUMERIK language that TurnDesk does not execute, with their alternatives.

These words are rejected by name, so that they are not treated as subprograms or variables.
"""

from __future__ import annotations

from collections.abc import Mapping

_SINGLE_CHANNEL_REASON = "this control has a single channel with fixed axes"
_FEEDS = "only the path feed can be programmed; write F, FB or OVR"
_LIMITS = "axis limits are set in the machine file; remove this word"
_SYNCHRONOUS = "synchronized actions are not supported"
_INTERRUPTS = "interrupts from an input are not supported; stop with M0 or M1"
_MEASURES = "measuring in the program is not supported; touch off the tool on the Jog page"
_STOPS = "travel to a fixed stop is not supported"
_NO_INDEPENDENT_AXES = "axes cannot move independently of the path; write G0 or G1 with the axis"
_ISO = "the external language mode is not supported"
_TOOL_AXIS = "this lathe has no orientation axes"
_SMOOTH = "smooth approach and retraction are not supported; write G41 or G42 with NORM or KONT"
_SIX = "this control has six settable offsets; write G54 to G59"
_SPLINE = "this type of curve is not supported; write lines and arcs"
_FILES = "programs cannot read or write files"
_FRAMES = "this frame function is not supported; write TRANS, ROT, SCALE or MIRROR"
_PUNCHES = "this lathe has no punching unit"
_READ_AHEAD_REASON = "the control reads the whole program before the program starts; remove this word"
_OSCILLATES = "oscillation is not supported"
_TOOLS = "tools are managed on the tool offset page (F8)"
_CONTOURS = "contour tables are not supported; specify the contour in CYCLE95"
_RETRACTS = "automatic retraction is not supported"

_WORDS_BY_REASON = {
    _SPLINE: (
        "ASPLINE BSPLINE CSPLINE POLY POLYPATH INVCW INVCCW BAUTO BNAT BTAN EAUTO ENAT ETAN "
        "SPLINEPATH SPATH UPATH"
    ),
    _TOOL_AXIS: (
        "TRAORI ORIWKS ORIMKS ORIAXES ORIVECT ORIEULER ORIRPY ORIS TCARR TCOABS TCOFR TOFRAME TOROT "
        "PAROT CUT3DC CUT3DF"
    ),
    _SINGLE_CHANNEL_REASON: (
        "GEOAX GET GETD RELEASE COUPON COUPOF COUPDEF COUPDEL COUPRES WAITC WAITM WAITE WAITP SETM "
        "CLEARM TRAILON TRAILOF LEADON LEADOF EGDEF EGON EGONSYN EGOFS EGOFC EGDEL CTABDEF CTABEND"
    ),
    _FEEDS: "FGROUP FA FD FDA FZ OVRA OVRRAP SVC STW",
    _LIMITS: (
        "FL VELOLIM VELOLIMA JERKLIM JERKLIMA BRISKA SOFTA DRIVEA JERKA PROTA PROTS PROTD CPROTDEF "
        "NPROTDEF CPROT NPROT COLLPAIR"
    ),
    _NO_INDEPENDENT_AXES: "POS POSA POSP OEMIPO REPOS REPOSA REPOSL REPOSQ REPOSH REPOSHA REPOSQA",
    _SYNCHRONOUS: (
        "WHEN WHENEVER EVERY CANCEL ID IDS DELDTG DELDT SYNFCT FTOC FTOCON FTOCOF LOCK UNLOCK PUTFTOC "
        "PUTFTOCF FCTDEF"
    ),
    _INTERRUPTS: "SETINT CLRINT DISABLE ENABLE PRIO BLSYNC",
    _RETRACTS: "LIFTFAST LFON LFOF LFTXT LFWP LFPOS POLF POLFMASK POLFMLIN ALF",
    _MEASURES: "MEAS MEAW MEAC MEASA MEAWA MEASURE",
    _STOPS: "FXS FXST FXSW FOC FOCON FOCOF",
    _FILES: (
        "WRITE READ DELETE ISFILE FILEDATE FILEINFO FILESIZE FILESTAT FILETIME EXTOPEN EXTCLOSE "
        "CALLPATH PCALL EXECSTRING EXECTAB"
    ),
    _FRAMES: "CTRANS CROT CROTS CSCALE CMIRROR CFINE MEAFRAME ROTS AROTS CRPL ADDFRAME",
    _PUNCHES: "SPOF SON PON SONS PONS PDELAYON PDELAYOF SPP SPN",
    _READ_AHEAD_REASON: "IPTRLOCK IPTRUNLOCK DELAYFSTON DELAYFSTOF STOLF",
    _OSCILLATES: "OSP1 OSP2 OST1 OST2 OSB OSE OSNSC OSCILL OSCTRL WAITOS",
    _TOOLS: (
        "SETPIECE SETDNO GETDNO CHKDNO GETT GETSELT GETEXET NEWT DELT SETTA TCA TLIFT DZERO "
        "DELTOOLENV TOOLENV GETTCOR SETTCOR DELDL"
    ),
    _CONTOURS: "CONTPRON CONTDCON EXECUTE INTERSEC CALCDAT",
    "this word is not supported; write SPOS, or M3 and M4": "SPCOF SPCON ASPOS",
}

UNSUPPORTED_WORDS: Mapping[str, str] = {
    "G63": (
        "this word is not supported; write CYCLE840, which feeds the tap at its lead and reverses the spindle"
    ),
    "G93": "inverse-time feed is not supported; write G94 or G95 with F",
    "G931": "feed specified by travel time is not supported; write G94 or G95 with F",
    "G5": "G5 is not supported; write the arc with CIP",
    "KONTC": "approach on a curve is not supported; write KONT or NORM",
    "KONTT": "approach on a curve is not supported; write KONT or NORM",
    "TURN": "a helix needs a third linear axis",
    "DIAMCYCOF": "this word is not supported; write DIAMON, DIAMOF or DIAM90",
    "DISC": "this word is not supported; write G450 or G451",
    "EXTCALL": (
        "external calls are not supported. Put the file in the main program's folder and call it by name"
    ),
    "TRAANG": "this lathe has no inclined axis",
    "TRACON": "chained transformations are not supported",
    "FLIN": "this feed profile is not supported; write G1 with F in each block",
    "FCUB": "this feed profile is not supported; write G1 with F in each block",
    "FPO": "this feed profile is not supported; write G1 with F in each block",
    "SAVE": "SAVE is only allowed after PROC",
    "GOTOC": "this word is not supported; write GOTO, GOTOF or GOTOB",
    "ACC": "accelerations are set in the machine file; remove this word",
    "ACCLIMA": "accelerations are set in the machine file; remove this word",
    "FGREF": "F always applies to the path of the tool tip; remove this word",
    "PRESETON": "machine positions cannot be preset; write TRANS",
    "AXTOSPI": "the axis of a spindle is defined in the machine file",
    "SPITOAX": "the axis of a spindle is defined in the machine file",
    "MMC": "program dialogs are not supported; write MSG",
    **dict.fromkeys(
        ("DEFINE", "DEFAULT", "ENDPROC"), "macros are not supported; write out the words of the macro"
    ),
    **{word: why for why, words in _WORDS_BY_REASON.items() for word in words.split()},
    "CYCLE": "the cycle number is missing; write, for example, CYCLE95",
    "G291": _ISO,
    **dict.fromkeys((f"G{code}" for code in (147, 148, 247, 248, 340, 341, 347, 348)), _SMOOTH),
    **dict.fromkeys((f"G{code}" for code in range(507, 600)), _SIX),
}
